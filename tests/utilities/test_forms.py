"""The forms of CRAM-UTILITIES as a plan writes them, each with the values or the text that it gives (cpl.md 13)."""

import re

import pytest

from cramhy_runtime.lisp_core.conditions import Condition

FROM = "(defun from (n) (cut:lazy-list ((i n)) (cut:cont i (+ i 1))))"


@pytest.mark.parametrize(
    ("form", "values"),
    [
        ("(cut:lazy-list ((i 0)) i 5)", "5"),
        ("(cut:lazy-list () nil)", "NIL"),
        ("(cut:force-ll (cut:lazy-list ((i 0) j) (if (< i 2) (cut:cont (list i j) (+ i 1) i) (cut:finish :end))))", "((0 NIL) (1 0) :END)"),
        ("(cut:force-ll (cut:lazy-list ((i 0)) (cond ((> i 5) nil) ((oddp i) (cut:next (+ i 1))) (t (cut:cont i (+ i 1))))))", "(0 2 4)"),
        ("(cut:force-ll (cut:lazy-list ((i 0)) (if (< i 2) (cut:cont i (+ i 1)) (list :a :b))))", "(0 1 :A :B)"),
        (
            "(cut:force-ll (cut:lazy-list ((i 0)) (if (< i 2) (invoke-restart :cont i (+ i 1)) (invoke-restart :rest '(:a :b)))))",
            "(0 1 :A :B)",
        ),
        ("(cut:force-ll (cut:lazy-list ((i 0)) (if (< i 3) (invoke-restart :next (+ i 1)) (invoke-restart :finish i))))", "(3)"),
        ("(cut:lazy-list-p (from 0))", "T"),
        ("(cut:lazy-list-p (list 1))", "NIL"),
        ("(cut:lazy-list-p 5)", "NIL"),
        ("(list (cut:lazy-car nil) (cut:lazy-cdr nil) (cut:lazy-car '(1 2)) (cut:lazy-cdr '(1 2)))", "(NIL NIL 1 (2))"),
        ("(cut:force-ll (cut:lazy-filter (lambda (x) (values (> x 2) (= x 4))) (from 1)))", "(3 4)"),
        ("(cut:force-ll (cut:lazy-filter (lambda (x) (values (> x 2) (= x 2))) '(1 2 3)))", "(3)"),
        ("(cut:lazy-filter #'null nil)", "NIL"),
        ("(cut:copy-lazy-list nil)", "NIL"),
        ("(cut:force-ll (cut:lazy-skip 3 '(1 2 3 4 5)))", "(4 5)"),
        ("(list (cut:lazy-fold #'+ nil) (cut:lazy-fold #'+ nil :initial-value 7) (cut:lazy-fold #'- '(1 2 3)))", "(NIL 7 -4)"),
        ("(let ((n 0)) (cut:lazy-dolist (x nil n) (incf n)))", "0"),
        ("(cut:lazy-dolist (x (from 1)) (when (> x 3) (return x)))", "4"),
        ("(cut:lazy-dolist (x '(1 2) (list x)) x)", "(NIL)"),
        (
            "(let ((x nil)) (setf x (cut:with-lazy-list-dynamic-environment ((*print-base* 2)) (cut:lazy-list ((i 5))"
            " (cut:cont (princ-to-string i) (+ i 1))))) (cut:force-ll (cut:lazy-take 3 x)))",
            '("101" "110" "111")',
        ),
    ],
)
def test_lazy_lists(lisp, form, values):
    lisp(FROM)
    assert lisp(form) == values


@pytest.mark.parametrize(
    ("form", "values"),
    [
        (
            "(list (cut:is-var '?x) (cut:is-var 'x) (cut:is-var nil) (cut:is-unnamed-var 'cut:?_) (cut:is-segvar '!?x) (cut:is-segform '(!?x)))",
            "(T NIL NIL T T T)",
        ),
        (
            "(list (cut:var-name '!?x) (cut:is-genvar (cut:gen-var)) (cut:is-genvar '?x) (subseq (symbol-name (cut:gen-var \"?foo-\")) 0 5))",
            '(?X T NIL "?foo-")',
        ),
        ("(cut:add-bdg '?x 1 nil)", "((?X . 1)) T"),
        ("(cut:add-bdg '?x 2 '((?x . 1)))", "NIL NIL"),
        ("(cut:add-bdg 'cut:?_ 2 '((?x . 1)))", "((?X . 1)) T"),
        ('(cut:add-bdg \'?x "a" \'((?x . ?y) (?y . "a")))', '((?X . ?Y) (?Y . "a")) T'),
        (
            "(list (cut:var-value '?x '((?x . (?y 1)) (?y . 2))) (cut:var-value '(?x) '((?x . 1))) (cut:var-value '?z nil))",
            "((2 1) (?X) ?Z)",
        ),
        ("(cut:pat-match '(?x . ?y) '(1 2 3))", "((?Y 2 3) (?X . 1)) T"),
        ("(cut:pat-match '(a b) '(a b))", "NIL T"),
        ("(cut:pat-match '(?x) '(1 2))", "NIL NIL"),
        ("(cut:pat-match '(?x) 1)", "NIL NIL"),
        ("(cut:pat-match '(!?x b !?y) '(1 b 2 b))", "((?Y 2 B) (?X 1)) T"),
        ("(cut:pat-match '(!?x !?x) '(1 2 1 2))", "((?X 1 2)) T"),
        ("(cut:pat-match '(!?x a) '(a a a))", "((?X A A)) T"),
        ("(cut:pat-match '(!?x) '(1 . 2))", "NIL NIL"),
        ("(cut:pat-match '(!?x) nil)", "((?X)) T"),
        ("(cut:pat-match '(cut:!?_ a) '(1 a))", "NIL T"),
        (
            "(list (cut:pat-match-p '(\"a\") '(\"A\") :test #'equalp) (cut:pat-match-p '(a) '(a) :test (lambda (a b) (and a b (eq a b)))))",
            "(T NIL)",
        ),
        ("(cut:pat-match '(a ?x) '(a 2) '((?y . 1)) :test #'eql)", "((?X . 2) (?Y . 1)) T"),
        ("(cut:pat-match '?x '(?y))", "((?X ?Y)) T"),
        ("(list (cut:vars-in '(?x ?y)) (cut:vars-in '(?x !?w (?y ?x))))", "((?Y ?X) (?Y ?X))"),
        ("(list (cut:is-bound '?x '((?x . ?y))) (cut:is-bound '?x '((?x . 1))) (cut:is-bound '(?x) nil))", "(NIL T T)"),
        ("(list (cut:is-ground '(?x) '((?x . 1))) (cut:is-ground '(?x ?y) '((?x . 1))))", "(T NIL)"),
        ("(list (cut:patterns-eq '(a ?x (b)) '(a ?y (b))) (cut:patterns-eq '(a ?x) '(?x a)) (cut:patterns-eq '(a b) '(a)))", "(T NIL NIL)"),
        (
            "(list (cut:bindings-equal '((?x . 1)) '((?y . 2) (?x . 1))) (cut:bindings-equal '((?x . 1)) nil)"
            ' (cut:bindings-equal \'((?x . "a")) \'((?x . "A")) :test #\'equalp))',
            "(T NIL T)",
        ),
        ("(cut:with-vars-bound (?x ?y) '((?x . 1)) (list ?x ?y))", "(1 ?Y)"),
        ("(cut:with-pat-vars-bound (!?x (?y)) '(1 2 (3)) (list ?x ?y))", "((1 2) 3)"),
        ("(cut:map-tree #'1+ '(1 (2 nil) . 3))", "(2 (3 NIL) . 4)"),
    ],
)
def test_patterns(lisp, form, values):
    assert lisp(form) == values


@pytest.mark.parametrize(
    ("form", "text"),
    [
        ("(cut:lazy-mapcan #'identity '(5))", "Applied fun #<FUNCTION IDENTITY> to 5 but result 5 is not a list\n"),
        ("(cut:var-name 'x)", "No variable."),
        ("(cut:patterns-eq 'a '(a))", "The value\n  A\nis not of type\n  LIST"),
        ("(cut:pat-match '(a ?x) '(?y 1))", "Found variable ?Y on right hand side of pattern match."),
        ("(cut:pat-match '(a . !?x) '(a 1))", "Segvar !?X must be car of a cons-cell."),
        ("(cut:with-vars-strictly-bound (?x ?y) '((?x . 1)) (list ?x ?y))", "Couldn't resolve variable ?Y."),
        ("(cut:with-pat-vars-bound (?x) '(1 2) ?x)", "Pattern (?X) does not match (1 2) in with-pat-vars-bound."),
        ("(cut:pool-value (cut:make-data-pool) 3)", "Data pool does not contain a value for id 3"),
        ("(cut:current-timestamp :x)", "The value\n  :X\nis not of type\n  (MEMBER :REAL :RUN)"),
        ("(cut:make-quad-tree-point :x :left)", "The value\n  :LEFT\nis not of type\n  REAL"),
        (
            "(macroexpand-1 '(cut:choose grasp :parameters (x) :body x))",
            "GRASP has 1 parameters and 0 generators; each parameter needs one.",
        ),
    ],
)
def test_what_is_wrong_says_what(lisp, form, text):
    with pytest.raises(Condition) as caught:
        lisp(form)
    assert caught.value.report() == text


@pytest.mark.parametrize(
    ("form", "values"),
    [
        (
            "(progn (defclass robot () ((arm :initarg :arm) self nothing)) (let* ((r (make-instance 'robot :arm (make-instance 'robot :arm 1))))"
            " (setf (slot-value r 'self) r) (let ((c (cut:copy-object r))) (list (eq c r) (eq (slot-value c 'self) c)"
            " (eq (slot-value c 'arm) (slot-value r 'arm)) (slot-value (slot-value c 'arm) 'arm) (slot-boundp c 'nothing)))))",
            "(NIL T NIL 1 NIL)",
        ),
        (
            "(progn (defstruct pair left) (let* ((p (make-pair :left (list 1))) (c (cut:copy-object p)))"
            " (list (eq p c) (eq (pair-left p) (pair-left c)))))",
            "(NIL T)",
        ),
        ("(progn (defclass arm () ()) (defmethod cut:copy-object ((arm arm)) :mine) (cut:copy-object (make-instance 'arm)))", ":MINE"),
        ('(handler-case (cut:deprecate "old") (cut:deprecation-warning (w) (list :warned (princ-to-string w))))', '(:WARNED "old")'),
        ('(handler-case (cut:style-warn "odd ~a" 1) (style-warning (w) (princ-to-string w)))', '"odd 1"'),
        ("(cut:flet* ((f (x) (+ x 1)) (g (x) (* 2 (f x)))) (g 3))", "8"),
        ('(cut:ensure-unused-string "a" (lambda (s) (find s \'("a" "a-1") :test #\'string=)))', '"a-2"'),
        (
            "(list (cut:minimum '(3 1 2)) (cut:maximum #(3 1/2 2.0)) (cut:minimum nil)"
            " (cut:maximum '(3 1) :key #'-) (cut:minimum '(1 2) :test #'>))",
            "(1 3 NIL 1 2)",
        ),
        ("(list (cut:compare 1 1) (cut:compare \"a\" \"A\" :test #'string-equal) (cut:compare '(1) '(1 2) :key #'car))", "(T T T)"),
        ('(cut:sanitize-filename "a b/c-d_1.ä")', '"a_b_c-d_1__"'),
        ("(cut:equalize-two-list-lengths '(1 2 3) '(a))", "(1 2 3) (A NIL NIL)"),
        ("(cut:equalize-two-list-lengths 1 '(a b))", "(1 NIL) (A B)"),
        ("(cut:equalize-two-list-lengths nil '(a) :return-as-list t)", "((NIL) (A))"),
        ("(cut:equalize-lists-of-lists-lengths '((1) (2 3) (4)) '((a b) (c)))", "(1 NIL 2 3 4) (A B C NIL NIL)"),
        (
            "(let ((pool (cut:make-data-pool))) (list (cut:new-pool-value pool :a) (cut:new-pool-value pool) (cut:pool-value pool 0)"
            " (setf (cut:pool-value pool 0) 7) (cut:pool-value pool 0) (progn (cut:delete-pool-value pool 0)"
            " (handler-case (cut:pool-value pool 0) (cut:pool-value-unbound () :unbound)))))",
            "(0 1 :A 7 7 :UNBOUND)",
        ),
        (
            "(progn (sleep 2.5) (list (cut:current-timestamp) (cut:current-timestamp :real) (typep (cut:current-timestamp :run) 'cut:timestamp)"
            " (let ((cut:*timestamp-function* (lambda () 7))) (cut:current-timestamp)) (cut:current-string-timestamp)))",
            '(2.5d0 2.5d0 T 7 "20101218161112")',
        ),
        (
            "(let ((f (cut:microsecond-timestamp-function :relative t))) (cut:set-timestamp-function f) (sleep 1.5)"
            " (prog1 (list (cut:current-timestamp) (> (funcall (cut:microsecond-timestamp-function)) 1d9)) (cut:set-default-timestamp-function)))",
            "(1.5d0 T)",
        ),
        ('(list #+#.(cut:function-bound-feature "CAR" "CL") 1 #+#.(cut:function-bound-feature "NO-SUCH" "CL") 2)', "(1)"),
        (
            "(top-level (with-tags (cut:choose grasp :parameters (x y) :generators (3 (+ x 1)) :body (list x y (cpl-impl:name grasp)))))",
            '(3 4 "[TAG-GRASP]")',
        ),
    ],
)
def test_the_rest(lisp, form, values):
    assert re.sub(r"(?<=\])-\d+", "", lisp(form)) == values  # without the numbers of tasks


@pytest.mark.soak
def test_a_quad_tree_finds_what_a_search_of_all_points_finds(lisp):
    assert (
        lisp("""
      (let ((tree (cut:quad-tree)) (points nil) (wrong 0))
        (flet ((distance (p q) (sqrt (+ (expt (- (cut:quad-tree-point-x p) (cut:quad-tree-point-x q)) 2)
                                        (expt (- (cut:quad-tree-point-y p) (cut:quad-tree-point-y q)) 2)))))
          (dotimes (i 300)
            (push (cut:quad-tree-insert tree (cut:make-quad-tree-point :x (- (random 200.0) 100) :y (- (random 20) 10))) points))
          (dotimes (i 100)
            (let* ((q (cut:make-quad-tree-point :x (- (random 300.0) 150) :y (- (random 30.0) 15)))
                   (nearest (cut:minimum points :key (lambda (p) (distance p q))))
                   (found (cut:quad-tree-closest-point-in-range tree q 20)))
              (unless (if (<= (distance nearest q) 20) (and found (= (distance found q) (distance nearest q))) (null found)) (incf wrong))
              (unless (= (length (cut:quad-tree-poins-in-range tree q 20)) (count-if (lambda (p) (<= (distance p q) 20)) points))
                (incf wrong)))))
        (list wrong (typep tree 'cut:quad-tree)))""")
        == "(0 T)"
    )
