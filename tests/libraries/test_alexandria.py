"""Alexandria: each form has the values that the library (Debian's 1.4.2) gives on SBCL."""

import pytest

from cramhy_runtime.ground.conditions import Condition


@pytest.mark.parametrize(
    "form, value",
    [
        ("(a:if-let (x 1) (list x) :no)", "(1)"),
        ("(a:if-let ((x 1) (y nil)) (list x y) :no)", ":NO"),
        ("(a:when-let ((x 1) (y 2)) (list x y))", "(1 2)"),
        ("(a:when-let* ((x 1) (y (1+ x))) (list x y))", "(1 2)"),
        ("(a:when-let* ((x nil) (y (car 5))) y)", "NIL"),
        ('(a:switch ("b" :test #\'equal) ("a" 1) ("b" 2) (t 3))', "2"),
        ("(a:switch ((1+ 1) :test = :key '1+) (3 :three) (otherwise :other))", ":THREE"),
        ("(a:switch (5) (4 :four))", "NIL"),
        ("(a:xor nil 3 nil)", "3 T"),
        ("(a:xor 1 2)", "NIL NIL"),
        ("(a:xor)", "NIL T"),
        ("(a:nth-value-or 1 (values 1 nil) (floor 7 2))", "3 1"),
        ("(multiple-value-list (a:multiple-value-prog2 1 (values 2 3) 4))", "(2 3)"),
        ("(let (r) (a:doplist (k v '(:a 1 :b 2) (nreverse r)) (push (list k v) r)))", "((:A 1) (:B 2))"),
        ("(a:destructuring-case '(:point 1 2) ((:point x y) (+ x y)) ((t &rest rest) rest))", "3"),
        ("(a:destructuring-case '(:other 1) ((:point x y) (+ x y)) ((t &rest all) all))", "(:OTHER 1)"),
        ("(macrolet ((twice (x) (a:once-only (x) `(+ ,x ,x)))) (let ((n 0)) (list (twice (incf n)) n)))", "(2 1)"),
        ('(a:parse-body \'("doc" (declare (ignore x)) 1 2) :documentation t)', '(1 2) ((DECLARE (IGNORE X))) "doc"'),
        ("(funcall (a:named-lambda f (n) (if (zerop n) 1 (* n (f (1- n))))) 5)", "120"),
        (
            "(let (r) (list (a:unwind-protect-case (a) 1 (:normal (push :n r)) (:abort (push :a r)) (:always (push a r))) r))",
            "(1 (NIL :N))",
        ),
        ("(let (r) (catch 'x (a:unwind-protect-case () (throw 'x 1) (:normal (push :n r)) (:abort (push :a r)))) r)", "(:A)"),
        ("(let ((x 5)) (a:maxf x 7 6) (a:minf x 3) x)", "3"),
        ("(let ((x (list 1 2 3 2))) (a:removef x 2) (a:appendf x '(9)) x)", "(1 3 9)"),
        ("(let ((p (list :a 1 :b 2))) (a:remove-from-plistf p :a) p)", "(:B 2)"),
        (
            "(let ((h (make-hash-table))) (list (multiple-value-list (a:ensure-gethash 1 h 2)) (multiple-value-list (a:ensure-gethash 1 h 3))))",
            "((2 NIL) (2 T))",
        ),
        ("(type-of (nth-value 1 (a:ignore-some-conditions (division-by-zero) (/ 1 0))))", "DIVISION-BY-ZERO"),
        ("(funcall (a:compose #'1+ #'floor #'car) '(7/2))", "4"),
        ("(multiple-value-list (funcall (a:multiple-value-compose #'list #'floor) 7 2))", "((3 1))"),
        ("(list (funcall (a:conjoin #'numberp #'plusp) 3) (funcall (a:conjoin #'numberp #'plusp) :a))", "(T NIL)"),
        ("(list (funcall (a:disjoin #'symbolp #'plusp) 3) (funcall (a:disjoin #'null #'minusp) 3))", "(T NIL)"),
        ("(funcall (a:rcurry '- 1) 10)", "9"),
        (
            "(let ((n 0)) (list (mapcar (a:curry #'+ (incf n)) (list 1 2)) n (funcall (a:compose #'1+ (lambda (x) (* x 2))) 3)))",
            "((2 3) 1 7)",
        ),
        ("(a:flatten '((1 . 2) nil ((3)) #(4)))", "(1 2 3 #(4))"),
        ("(list (a:proper-list-p '(1 . 2)) (a:circular-list-p (a:circular-list 1 2)) (a:lastcar '(1 2 3)))", "(NIL T 3)"),
        ("(a:circular-tree-p (let ((x (list 1 2))) (setf (car x) x)))", "T"),
        ("(list (a:setp '(1 2)) (a:setp '(1 1)) (a:set-equal '(1 2) '(2 1)) (a:set-equal '(1) '(1 2)))", "(T NIL T NIL)"),
        ("(a:mappend #'list '(1 2) '(3 4))", "(1 3 2 4)"),
        ("(a:map-product 'list '(1 2) '(3 4))", "((1 3) (1 4) (2 3) (2 4))"),
        ("(a:iota 3 :start 1 :step 1/2)", "(1 3/2 2)"),
        ("(a:iota 3 :step 1.0)", "(0.0 1.0 2.0)"),
        ("(a:alist-plist '((a . 1) (b . 2)))", "(A 1 B 2)"),
        ("(a:plist-alist '(a 1 b 2))", "((A . 1) (B . 2))"),
        ("(a:assoc-value '((:a . 1)) :a)", "1 (:A . 1)"),
        (
            "(let ((x (list (cons :a 1)))) (setf (a:assoc-value x :a) 2 (a:assoc-value x :b) 3) (incf (a:assoc-value x :a)) x)",
            "((:B . 3) (:A . 3))",
        ),
        ("(let ((x (list (cons :a 1)))) (setf (a:rassoc-value x 1) :z (a:rassoc-value x 2) :y) x)", "((:Y . 2) (:Z . 1))"),
        ("(list (a:emptyp \"\") (a:sequence-of-length-p '(1 2) 2) (a:length= 2 \"ab\" '(1 2)) (a:length= '(1) '(1 2)))", "(T T T NIL)"),
        ('(list (a:first-elt "abc") (a:last-elt #(1 2)) (a:starts-with 1 \'(1)) (a:ends-with #\\c "abc"))', "(#\\a 2 T T)"),
        ('(a:starts-with-subseq "foo" "foobar" :return-suffix t)', 'T "bar"'),
        ("(a:starts-with-subseq '(1) '(2 1))", "NIL NIL"),
        ('(list (a:ends-with-subseq "bar" "foobar") (a:ends-with-subseq "foobar" "bar"))', "(T NIL)"),
        ("(list (a:rotate (list 1 2 3 4)) (a:rotate (list 1 2 3 4) -1) (a:rotate (vector 1 2 3) 2))", "((4 1 2 3) (2 3 4 1) #(2 3 1))"),
        ("(sort (a:shuffle (a:iota 5)) #'<)", "(0 1 2 3 4)"),
        ("(list (a:extremum '(3 1 2) #'<) (a:extremum '((3) (1)) #'< :key #'car) (a:extremum nil #'<))", "(1 (1) NIL)"),
        ("(let (r) (a:map-combinations (lambda (x) (push x r)) '(1 2 3) :length 2) (reverse r))", "((1 2) (1 3) (2 3))"),
        ("(let (r) (a:map-permutations (lambda (x) (push x r)) '(1 2 3)) (length (remove-duplicates r :test #'equal)))", "6"),
        ("(let (r) (a:map-derangements (lambda (x) (push x r)) '(1 2 3)) (sort r #'< :key #'car))", "((2 3 1) (3 1 2))"),
        (
            "(list (a:clamp 15 0 9) (a:lerp 0.5 1 3) (a:mean '(1 2)) (a:median '(3 1 2)) (a:variance '(1 2 3)) (a:standard-deviation '(1 3)))",
            "(9 2.0 3/2 2 2/3 1.0)",
        ),
        ("(list (a:factorial 10) (a:binomial-coefficient 5 2) (a:count-permutations 5 2) (a:subfactorial 4))", "(3628800 10 20 9)"),
        (
            '(list (a:symbolicate \'foo "-BAR" #\\X) (a:format-symbol t "~A-~A" \'a 1) (a:make-keyword \'x) (a:ensure-symbol "ABC"))',
            "(FOO-BARX A-1 :X ABC)",
        ),
        ("(list (typep 0 'a:positive-integer) (typep 0 'a:non-negative-real) (a:negative-float-p -1.0))", "(NIL T T)"),
        ("(list (a:type= 'list '(or null cons)) (a:featurep '(and :cramhy (not :no-such))))", "(T T)"),
        (
            "(let ((h (a:alist-hash-table '((:a . 1) (:a . 2) (:b . 3))))) (list (a:hash-table-alist h) (a:hash-table-plist h)))",
            "(((:A . 1) (:B . 3)) (:A 1 :B 3))",
        ),
        ("(let (k) (a:maphash-keys (lambda (x) (push x k)) (a:plist-hash-table '(:a 1))) k)", "(:A)"),
        ("(let ((a #2A((1 2) (3 4)))) (list (a:copy-array a) (eq a (a:copy-array a))))", "(#2A((1 2) (3 4)) NIL)"),
    ],
)
def test_what_the_names_do(values, form, value):
    assert values(form.replace("(a:", "(alexandria:").replace("'a:", "'alexandria:")) == value


@pytest.mark.parametrize(
    "form, value",
    [
        ("(alexandria-2:line-up-first 5 (+ 20) / (+ 40))", "1001/25"),
        ("(alexandria-2:line-up-last 5 (- 20) (list 1))", "(1 15)"),
        ('(alexandria-2:subseq* "abc" 1 9)', '"bc"'),
        ("(alexandria-2:row-major-index '(4 3 2 1) 3 2 1 0)", "23"),
        ("(alexandria-2:rmajor-to-indices '(4 3 2 1) 23)", "(3 2 1 0)"),
        ("(alexandria-2:dim-in-bounds-p '(2 2) 0 2)", "NIL"),
        ("(alexandria-2:delete-from-plist* (list :a 1 :b 2 :c 3) :a :c)", "(:B 2) ((:C . 3) (:A . 1))"),
        ("(alexandria-2:clamp 3 1 2)", "2"),
    ],
)
def test_the_second_version(values, form, value):
    assert values(form) == value


@pytest.mark.parametrize(
    "form, text",
    [
        ("(alexandria:eswitch (5) (4 1))", "No keys match in ESWITCH. Value: 5, tested with EQL."),
        ("(alexandria:required-argument :x)", "Required argument :X missing."),
        ('(alexandria:first-elt "")', 'The value\n  ""\nis not of type\n  (AND SEQUENCE (NOT (SATISFIES ALEXANDRIA:EMPTYP)))'),
        ("(alexandria:lastcar '(1 . 2))", "The value\n  (1 . 2)\nis not of type\n  LIST"),
    ],
)
def test_what_is_wrong(values, form, text):
    with pytest.raises(Condition) as caught:
        values(form)
    assert caught.value.report() == text


def test_files(values, tmp_path):
    path = tmp_path / "text"
    values(f'(alexandria:write-string-into-file "one{chr(10)}two" "{path}")')
    assert values(f'(alexandria:read-file-into-string "{path}")') == '"one\ntwo"'


def test_every_name_is_defined(values):
    """Every external symbol is a function, a macro or a type."""
    assert (
        values("""(let (missing)
      (do-external-symbols (symbol :alexandria missing)
        (unless (or (fboundp symbol) (member symbol '(alexandria:array-index alexandria:array-length))
                    (ignore-errors (typep 1 symbol) t))
          (push symbol missing))))""")
        == "NIL"
    )


def test_the_library_is_loaded_when_its_package_is_named(values):
    assert values("(package-name (find-package :alexandria))") == '"ALEXANDRIA"'
    values("(defpackage :plans-with-curry (:use :cl) (:import-from :alexandria #:curry))")
    try:
        assert values("(funcall (plans-with-curry::curry #'+ 1) 2)") == "3"
    finally:
        values("(delete-package :plans-with-curry)")
