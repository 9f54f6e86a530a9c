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
