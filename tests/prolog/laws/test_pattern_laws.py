"""Variables, patterns, bindings and lazy lists of CRAM-UTILITIES (invariants 50 to 54; sections 2 to 4)."""

import pytest


@pytest.mark.law("prolog", 50)
def test_a_forced_lazy_list_is_a_literal_list(lisp):
    assert (
        lisp("""(let ((l (lazy-list ((n 1)) (if (< n 4) (cont n (1+ n)) (finish n)))))
                     (list (lazy-list-p l) (equal (force-ll l) '(1 2 3 4)) (lazy-list-p l) (eq l (force-ll l))))""")
        == "(T T NIL T)"
    )


@pytest.mark.law("prolog", 51)
def test_lazy_mapcar_calls_its_function_once_per_element_it_delivers(lisp):
    assert (
        lisp("""(let* ((l (lazy-mapcar (lambda (x y) (note x) (+ x y)) '(1 2 3) '(10 20 30 40))) (at-first (copy-list *notes*)))
                     (lazy-car l) (lazy-car l)
                     (let ((second (lazy-car (lazy-cdr l))))
                       (lazy-elt l 1)
                       (list at-first second *notes* (force-ll l) *notes*)))""")
        == "((1) 22 (1 2) (11 22 33) (1 2 3))"
    )


@pytest.mark.law("prolog", 52)
def test_lazy_mapcan_concatenates_and_skips_nil(lisp):
    assert lisp("(force-ll (lazy-mapcan #'identity '((1) nil (2))))") == "(1 2)"
    assert lisp("(force-ll (lazy-mapcan #'identity '(nil nil)))") == "NIL"
    assert lisp.error("(force-ll (lazy-mapcan (lambda (x) (if (eql x 1) (list x) x)) '(1 2)))").startswith("Applied fun #<FUNCTION")
    assert lisp.error("(force-ll (lazy-mapcan (lambda (x) (if (eql x 1) (list x) x)) '(1 2)))").endswith(
        " to 2 but result 2 is not a list\n"
    )


@pytest.mark.law("prolog", 53)
def test_pat_match_is_one_sided(lisp):
    assert lisp.error("(pat-match '(a) '(?x))") == "Found variable ?X on right hand side of pattern match."
    assert lisp.error("(pat-match '!?x '(1))") == "Segvar !?X must be car of a cons-cell."
    assert lisp("(multiple-value-list (pat-match '(p !?m q) '(p 1 2 q)))") == "(((?M 1 2)) T)"


@pytest.mark.law("prolog", 54)
def test_rename_vars(lisp):
    assert (
        lisp("""(let ((renamed (rename-vars '(?x (?_ . ?y) ?x a))))
                     (destructuring-bind (x (anonymous . y) again a) renamed
                       (list (eq x again) (eq anonymous '?_) (is-genvar x) (is-genvar y) (eq x y) a
                             (subseq (symbol-name x) 0 3))))""")
        == '(T T T T NIL A "?X-")'
    )
    assert lisp("(symbol-name (first (rename-vars '(?x) :gensym-var-names nil)))") == '"?X"'


# ---------------------------------------------------------------------------------------------------------- sections 2 and 3


@pytest.mark.soak(all_but=10)
@pytest.mark.parametrize(
    "form, result",
    [
        ("(mapcar #'is-var (list '? '?? ':?x '#:?x '?_ 'x? '! nil \"?x\" '(?x)))", "(T T T T T NIL NIL NIL NIL NIL)"),
        ("(list (is-unnamed-var '?_) (is-unnamed-var '?x) (is-unnamed-var ':?_))", "(T NIL NIL)"),
        ("(mapcar #'is-segvar '(!? !?foo !?_ ?x ! (!?x)))", "(T T T NIL NIL NIL)"),
        ("(mapcar #'is-segform '((!?x) (!? 1) (a !?x) !?x nil))", "(T T NIL NIL NIL)"),
        ("(list (var-name '?x) (var-name '!?x) (symbol-package (var-name '#:!?x)))", "(?X ?X NIL)"),
        ('(list (is-var (gen-var)) (symbol-package (gen-var)) (search "?FOO" (symbol-name (gen-var "?FOO"))))', "(T NIL 0)"),
        ("(list (is-genvar (gen-var)) (is-genvar '?x))", "(T NIL)"),
        ("(multiple-value-list (add-bdg '?x 1 nil))", "(((?X . 1)) T)"),
        ("(multiple-value-list (add-bdg '?_ 1 '((?y . 2))))", "(((?Y . 2)) T)"),
        ("(multiple-value-list (add-bdg '?x '(1) '((?x ?y) (?y . 1))))", "(((?X ?Y) (?Y . 1)) T)"),
        ("(multiple-value-list (add-bdg '?x 2 '((?x . 1))))", "(NIL NIL)"),
        ("(var-value '?x '((?x . (?y)) (?y . 1)))", "(1)"),
        ("(var-value '?z '((?x . 1)))", "?Z"),
        ("(var-value '(?x) '((?x . 1)))", "(?X)"),
        ("(substitute-vars '(?x (?y . ?z) a) '((?x . ?y) (?y . 1)))", "(1 (1 . ?Z) A)"),
        (
            "(list (is-bound '?x nil) (is-bound '?x '((?x . ?y))) (is-bound '?x '((?x . nil))) (is-bound '(?x) nil) (is-bound 1 nil))",
            "(NIL NIL T T T)",
        ),
        ("(list (is-ground '(1 ?x) nil) (is-ground '(1 ?x) '((?x . ?y))) (is-ground '(1 ?x) '((?x . 2))))", "(NIL NIL T)"),
        ("(vars-in '(?x (?y . ?x) ?_ !?z b))", "(?_ ?Y ?X)"),
        ("(with-vars-bound (?x ?y) '((?x . 1)) (list ?x ?y))", "(1 ?Y)"),
        ("(with-vars-strictly-bound (?x) '((?x . 1)) ?x)", "1"),
        ("(with-pat-vars-bound (?x (?y)) '(1 (2)) (list ?y ?x))", "(2 1)"),
        (
            "(list (patterns-eq '(?x (a)) '(?y (a))) (patterns-eq '(?x) '(a)) (patterns-eq '(a) '(b)) (patterns-eq '(1 a) '(1 a)))",
            "(T NIL NIL T)",
        ),
        (
            "(list (bindings-equal '((?x . (1))) '((?y . 2) (?x . (1)))) (bindings-equal '((?x . 1)) nil) (bindings-equal nil '((?x . 1)))"
            " (bindings-equal '((?x . nil)) nil))",
            "(T NIL T T)",
        ),
        ("(map-tree #'1+ '(1 (2 . 3) nil))", "(2 (3 . 4) NIL)"),
        ("(multiple-value-list (pat-match '(?p ?p) '(nil z)))", "(NIL NIL)"),
        ('(multiple-value-list (pat-match \'("a") (list (copy-seq "a"))))', "(NIL NIL)"),
        ('(multiple-value-list (pat-match \'("a") \'("a") :test #\'equal))', "(NIL T)"),
        ("(multiple-value-list (pat-match '(?x ?y) '(1 2) '((?x . 1)) :test #'equal))", "(((?Y . 2) (?X . 1)) T)"),
        ("(list (pat-match-p '(a ?x) '(a b)) (pat-match-p '(a ?x) '(b b)))", "(T NIL)"),
        ("(let ((b (pat-match '(!?m ?last) '(1 2 3)))) (list (var-value '?m b) (var-value '?last b)))", "((1 2) 3)"),
        ("(let ((b (pat-match '(!?m ?m) '(1 2 (1 2))))) (var-value '?m b))", "(1 2)"),
        ("(list (pat-match-p '(p !?m) '(p 1 . 2)) (pat-match-p '(p !?m) '(p)))", "(NIL T)"),
        ("(multiple-value-list (unify '(?u ?v ?u) '((?v) k (k))))", "(((?V . K) (?U ?V)) T)"),
        ("(multiple-value-list (unify '?x '?y))", "(((?X . ?Y)) T)"),
        ("(multiple-value-list (unify '(1 ?x) '(2 3)))", "(NIL NIL)"),
        ("(list (unify-p '(a ?x) '(?y b)) (unify-p '(a) '(a b)) (unify-p '?x 1 '((?x . 2))) (unify-p '?_ '?_))", "(T NIL NIL T)"),
        ("(multiple-value-list (unify '(?x . ?y) (lazy-mapcar #'1+ '(1 2)) nil))", "(((?Y 3) (?X . 2)) T)"),
    ],
)
def test_patterns(lisp, form, result):
    assert lisp(f"{form}".replace("(lazy-mapcar #'1+ '(1 2))", "(let ((l (lazy-mapcar #'1+ '(1 2)))) (force-ll l))")) == result


@pytest.mark.parametrize(
    "form, text",
    [
        ("(var-name 'x)", "No variable."),
        ("(unify '(a . !?x) '(a b))", "Found segvar that is not in car of a cons-cell while unifying !?X and (B)"),
        ("(with-vars-strictly-bound (?x) nil ?x)", "Couldn't resolve variable ?X."),
        ("(with-pat-vars-bound (a ?x) '(b 1) ?x)", "Pattern (A ?X) does not match (B 1) in with-pat-vars-bound."),
        ("(patterns-eq 'a '(a))", "The value\n  A\nis not of type\n  LIST"),
        ('(gen-var "x")', 'The assertion (IS-VAR (MAKE-SYMBOL "x")) failed: the name of a variable starts with a question mark.'),
        ("(is-genvar 'x)", "The assertion (IS-VAR VAR) failed: X is not a variable."),
    ],
)
def test_what_patterns_refuse(lisp, form, text):
    assert lisp.error(form) == text


def test_warnings_of_patterns(lisp):
    assert lisp("(with-pat-vars-bound (a b) '(a b) :body)") == ":BODY"
    assert lisp("(multiple-value-list (unify '(a !?x) '(a 1 2)))") == "(((?X 1 2)) T)"
    assert lisp.warnings == [
        "Pattern (A B) does not contain any variables in with-pat-vars-bound",
        "Using segvars in unify... This is not implementet properly at the moment.",
    ]


# ---------------------------------------------------------------------------------------------------------------- section 4


@pytest.mark.parametrize(
    "form, result",
    [
        ("(list (lazy-car nil) (lazy-cdr nil) (force-ll nil) (lazy-list-p nil) (lazy-list-p '(1)))", "(NIL NIL NIL NIL NIL)"),
        ("(force-ll (lazy-list ((n 0)) (cond ((> n 5) nil) ((evenp n) (cont n (1+ n))) (t (next (1+ n))))))", "(0 2 4)"),
        ("(lazy-elt (lazy-mapcar #'1+ '(1 2 3)) 2)", "4"),
        ("(lazy-elt '(1) 7)", "NIL"),
        ("(force-ll (lazy-filter #'evenp '(1 2 3 4)))", "(2 4)"),
        ("(force-ll (lazy-filter (lambda (x) (values (evenp x) (= x 2))) '(1 2 3 4)))", "(2)"),
        ("(list (lazy-fold #'+ '(1 2 3)) (lazy-fold #'cons '(1 2) :initial-value nil))", "(6 ((NIL . 1) . 2))"),
        ("(force-ll (lazy-append '(1) nil (lazy-mapcar #'1+ '(1 2)) '(9)))", "(1 2 3 9)"),
        ("(force-ll (lazy-take 2 '(1 2 3)))", "(1 2)"),
        ("(force-ll (lazy-take 0 '(1)))", "NIL"),
        ("(force-ll (lazy-skip 2 (lazy-mapcar #'1+ '(1 2 3))))", "(4)"),
        ("(force-ll (lazy-flatten '(1 (2 (3)) nil 4)))", "(1 2 3 4)"),
        ("(force-ll (lazy-rests '(1 2)))", "((1 2) (2))"),
        (
            "(let ((sum 0)) (list (lazy-dolist (x (lazy-mapcar #'1+ '(1 2)) sum) (incf sum x)) (lazy-dolist (x nil :none) (error \"!\"))"
            " (lazy-dolist (x '(1 2)) (return x))))",
            "(5 :NONE 1)",
        ),
        (
            "(let* ((l (lazy-mapcar #'1+ '(1 2 3))) (c (copy-lazy-list l))) (list (eq l c) (force-ll c) (force-ll l)))",
            "(NIL (2 3 4) (2 3 4))",
        ),
        ("(let* ((n 0) (p (delay (incf n)))) (list (delay-p p) (delay-p 1) (force p) (force p) (force 7) n))", "(T NIL 1 1 7 1)"),
        ("(let ((l (lazy-list ((n 0)) (note n) (cont n (1+ n))))) (lazy-elt (lazy-take 3 l) 2) *notes*)", "(0 1 2)"),
    ],
)
def test_lazy_lists(lisp, form, result):
    assert lisp(form) == result


@pytest.mark.parametrize(
    ("form", "result"),
    [
        ("(lazy-list ((n 0)) (cont *level* (1+ n)))", "(1 1)"),
        ("(lazy-mapcar (lambda (n) (declare (ignore n)) *level*) '(1 2))", "(1 1)"),
        ("(lazy-mapcan (lambda (n) (list n *level*)) '(1 2))", "(1 1)"),
        ("(lazy-mapcan (lambda (n) (lazy-list () (if (< n 3) (finish *level*)))) '(1 2))", "(1 1)"),
        ("(lazy-filter (lambda (n) (= n *level*)) '(0 1 0 1))", "(1 1)"),
        ("(lazy-list ((n 0)) (cont (lazy-car (lazy-list () (finish *level*))) (1+ n)))", "(1 1)"),
        ("(prolog '(and (member ?x (0 0)) (lisp-fun level ?x ?level)))", "(1 1)"),
    ],
)
def test_a_lazy_list_can_keep_special_bindings_the_first_element_too(lisp, form, result):
    lisp("(defvar *level* 0) (defun level (x) (declare (ignore x)) *level*)")
    assert (
        lisp(f"""(let ((l (with-lazy-list-dynamic-environment ((*level* 1)) {form})))
                      (flet ((level-of (x) (if (listp x) (cdr (assoc '?level x)) x)))
                        (list (level-of (lazy-elt l 0)) (level-of (lazy-elt l 1)))))""")
        == result
    )


def test_the_forms_of_the_environment_are_evaluated_for_each_element(lisp):
    assert (
        lisp("""(defvar *level* 0)
                   (let* ((n 0) (l (with-lazy-list-dynamic-environment ((*level* (incf n))) (lazy-list () (cont *level*)))))
                     (list n (force-ll (lazy-take 3 l)) n *level*))""")
        == "(1 (1 2 3) 3 0)"
    )
