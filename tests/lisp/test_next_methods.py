"""The next method is found wherever the body of a method calls it: in templates, in closures, in what macros make."""

import pytest

FORMS = [
    "`(2 ,@(call-next-method))",
    "(append `(2 . ,(call-next-method)))",
    "(coerce `#(2 ,@(call-next-method)) 'list)",
    "(flet ((others () (call-next-method))) (cons 2 (others)))",
    "(cons 2 (next-please))",
    "(with-others (list) (cons 2 list))",
    "(cons 2 (funcall #'call-next-method))",
    "(if (next-method-p) (cons 2 (apply #'call-next-method thing nil)) 'none)",
    "(and '(call-next-method) `(2 1))",
]


@pytest.mark.parametrize("form", FORMS)
def test_the_next_method_is_called(session, form):
    session.package = "CL-USER"
    session.evaluate_text("(defmacro next-please () '(call-next-method))")
    session.evaluate_text("(defmacro with-others ((name) &body body) `(let ((,name (next-please))) ,@body))")
    session.evaluate_text("(fmakunbound 'describe-it)")
    session.evaluate_text("(defmethod describe-it ((thing t)) (list 1))")
    session.evaluate_text(f"(defmethod describe-it ((thing integer)) {form})")
    assert session.evaluate_text("(equal (describe-it 5) '(2 1))") == [True]


OTHER_ARGUMENTS = [
    ("(defmethod f ((x number)) x) (defmethod f ((x integer)) (call-next-method 'a))", "A", "NUMBER", "X"),
    ("(defmethod f ((x number)) x) (defmethod f ((x integer)) (apply #'call-next-method '(a)))", "A", "NUMBER", "X"),
    ("(defmethod f ((x number)) x) (defmethod f ((x integer)) (funcall (lambda (x) (call-next-method x)) 'a))", "A", "NUMBER", "X"),
    ("(defmethod f ((x number)) x) (defmethod f :around ((x integer)) (call-next-method 'a))", "A", "NUMBER", "X"),
    ("(defmethod f ((x number)) x) (defmethod f ((x integer)) (call-next-method 3.5)) (defmethod f ((x fixnum)) (call-next-method 3.5))",
     "3.5", "INTEGER", "X"),
    ("(defmethod f ((x integer)) x) (defmethod f :before ((x number)) x) (defmethod f :around ((x t)) (call-next-method 3.5))",
     "3.5", "INTEGER", "X"),
    ("(defmethod f ((x number) &optional y) y) (defmethod f ((x integer) &optional y) (call-next-method 'a y))", "A", "NUMBER", "X"),
    ("(defmethod f ((x number) &rest y) y) (defmethod f ((x integer) &rest y) (apply #'call-next-method 'a y))", "A", "NUMBER", "X"),
    ("(defmethod f ((x number) &key y) y) (defmethod f ((x integer) &key y) (call-next-method 'a :y y))", "A", "NUMBER", "X"),
    ("(defgeneric f (x) (:method-combination list)) (defmethod f list ((x integer)) x) (defmethod f :around ((x t)) (call-next-method 3.5))",
     "3.5", "INTEGER", "X"),
]  # fmt: skip


@pytest.mark.parametrize("definitions, datum, expected, name", OTHER_ARGUMENTS)
def test_a_next_method_takes_no_argument_of_another_class(session, definitions, datum, expected, name):
    session.package = "CL-USER"
    session.evaluate_text("(fmakunbound 'f)")
    session.evaluate_text(definitions)
    (said,) = session.evaluate_text("(handler-case (f 5) (type-error (e) (princ-to-string e)))")
    assert said == f"The value\n  {datum}\nis not of type\n  {expected}\nwhen binding {name}"


def test_the_next_methods_behind_the_next_one_look_at_other_arguments_when_they_are_called(session):
    session.package = "CL-USER"
    session.evaluate_text("(fmakunbound 'f) (defclass l () ()) (defclass r () ()) (defclass both (l r) ())")
    session.evaluate_text("(defmethod f ((x r)) 'r) (defmethod f ((x l)) (if *on* (call-next-method) 'l)) (defvar *on* nil)")
    session.evaluate_text("(defmethod f ((x both)) (call-next-method (make-instance 'l)))")
    assert session.evaluate_text("(string (f (make-instance 'both)))") == ["L"]
    (said,) = session.evaluate_text(
        "(let ((*on* t)) (handler-case (f (make-instance 'both)) (type-error (e) (type-error-expected-type e))))"
    )
    assert str(said).endswith("R")


@pytest.mark.parametrize("parameters, others", [("((x integer))", ""), ("((x integer) &optional y)", " y")])
def test_at_safety_3_the_same_methods_must_apply_to_other_arguments(session, parameters, others):
    session.package = "CL-USER"
    general = parameters.replace("(x integer)", "(x t)")
    session.evaluate_text(f"(fmakunbound 'f) (defmethod f {general} x)")
    body = f"(declare (optimize (speed 1) (safety 3))) (call-next-method (if (plusp x) 'a -9){others})"
    session.evaluate_text(f"(defmethod f {parameters} {body})")
    assert session.evaluate_text("(f -5)") == [-9]
    (said,) = session.evaluate_text("(handler-case (f 5) (error (e) (princ-to-string e)))")
    assert said.startswith("The methods of #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::F (2)> that apply to (")


def test_a_next_method_takes_other_arguments_of_its_class(session):
    session.package = "CL-USER"
    session.evaluate_text("(fmakunbound 'f) (defmethod f ((x number) &key y) (list x y))")
    session.evaluate_text("(defmethod f ((x integer) &key y) (append (call-next-method 2.5 :y 1) (call-next-method)))")
    assert session.evaluate_text("(equal (f 5 :y 4) '(2.5 1 5 4))") == [True]


def test_a_method_that_is_made_calls_the_next_one_with_what_it_got(session):
    session.package = "CL-USER"
    session.evaluate_text(
        "(define-method-combination wrapping () ((around (:around)) (primary ())) "
        "  `(call-method ,(first around) (,@(rest around) (make-method (list (call-method ,(first primary)))))))"
    )
    session.evaluate_text("(fmakunbound 'f) (defgeneric f (x) (:method-combination wrapping)) (defmethod f ((x integer)) x)")
    session.evaluate_text("(defmethod f :around ((x t)) (call-next-method (if (eql x 1) 'a 7)))")
    assert session.evaluate_text("(equal (f 5) '(7))") == [True]
    assert session.evaluate_text("(handler-case (f 1) (type-error (e) (string (type-error-datum e))))") == ["A"]


@pytest.mark.parametrize("name", "integer stream file-stream string-stream structure-object hash-table t".split())
def test_an_instance_of_a_class_that_is_not_the_users_is_refused(session, name):
    session.package = "CL-USER"
    (said,) = session.evaluate_text(f"(handler-case (make-instance '{name}) (error (e) (princ-to-string e)))")
    assert said.startswith("Cannot allocate an instance of #<") and f"COMMON-LISP:{name.upper()}>" in said
