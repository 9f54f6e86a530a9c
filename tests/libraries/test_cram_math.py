"""cram-math: angles, matrices, the normal distribution."""

import pytest

from cramhy_runtime.ground.conditions import Condition


@pytest.mark.parametrize(
    "form, value",
    [
        ("(cma:degrees->radians 180)", "3.141592653589793d0"),
        ("(round (cma:radians->degrees pi))", "180 0.0d0"),
        ("(< (abs (- (cma:normalize-angle (* 5/2 pi)) (/ pi 2))) 1d-9)", "T"),
        ("(cma:average '(1 2 3 4))", "5/2"),
        (
            "(let ((m (cma:make-double-matrix 2 2 :initial-contents '((2 0) (0 4))))) (list (cma:invert-double-matrix m)"
            " (cma:double-matrix-determinant m) (cma:width m) (typep m '(cma:double-matrix 2 2))))",
            "(#2A((0.5d0 0.0d0) (0.0d0 0.25d0)) 8.0d0 2 T)",
        ),
        (
            "(cma:double-matrix-product (cma:make-double-matrix 2 1 :initial-contents '((1 2)))"
            " (cma:double-matrix-transpose (cma:make-double-matrix 2 1 :initial-contents '((3 4)))))",
            "#2A((11.0d0))",
        ),
        ("(cma:double-matrix-determinant (cma:make-double-matrix 3 3 :initial-contents '((0 1 2) (1 0 3) (4 -3 8))))", "-2.0d0"),
        ("(cma:covariance '(#(1 2) #(3 4)))", "#2A((1.0d0 1.0d0) (1.0d0 1.0d0))"),
        ("(funcall (cma:gauss (cma:make-double-matrix 1 1 :initial-element 1) #(0)) #(0))", "0.3989422804014327d0"),
        ("(< (abs (- (cma:angle-difference 3 -3) (- (* 2 pi) 6))) 1d-9)", "T"),
        (
            "(list (cma:square 3) (cma:clamp 5 0 1) (cma:clamp -5 0 1) (cma:clamp 1/2 0 1) (cma:linear-interpolation 2 4 1/4))",
            "(9 1 0 1/2 5/2)",
        ),
        ("(list (cma:mean '(#(1 2) #(3 5))) (cma:variance '(1 3)) (cma:standard-deviation #(1 3)))", "(#(2.0d0 3.5d0) 1 1.0d0)"),
        (
            "(cma:double-vector-sum (cma:make-double-vector 2 :initial-contents '(1 2)) (cma:make-double-vector 2 :initial-element 1))",
            "#(2.0d0 3.0d0)",
        ),
        (
            "(let ((v (cma:make-double-vector 2 :initial-contents '(3 4)))) (list (cma:double-vector-norm v) (cma:double-vector-product v v)"
            " (cma:scale-double-vector v 2) (cma:double-vector-difference v v)))",
            "(5.0d0 25.0d0 #(6.0d0 8.0d0) #(0.0d0 0.0d0))",
        ),
        (
            "(let ((m (cma:make-identity-matrix 2))) (list (cma:double-matrix-sum m m) (cma:double-matrix-difference m m)"
            " (cma:scale-double-matrix m 3) (eq (cma:copy-double-matrix m) m)))",
            "(#2A((2.0d0 0.0d0) (0.0d0 2.0d0)) #2A((0.0d0 0.0d0) (0.0d0 0.0d0)) #2A((3.0d0 0.0d0) (0.0d0 3.0d0)) NIL)",
        ),
        ("(cma:normalize-double-matrix (cma:make-double-matrix 2 2 :initial-element 3))", "#2A((0.25d0 0.25d0) (0.25d0 0.25d0))"),
        ("(multiple-value-list (cma:2d-cov-ellipse (cma:make-double-matrix 2 2 :initial-contents '((4 0) (0 1)))))", "(2.0d0 1.0d0 0.0d0)"),
        (
            "(destructuring-bind (a b angle) (multiple-value-list (cma:2d-cov-ellipse (cma:make-double-matrix 2 2 :initial-contents"
            " '((2 1) (1 2))))) (list (round (* a a)) (round (* b b)) (< (abs (- angle (/ pi 4))) 1d-9)))",
            "(3 1 T)",
        ),
        (
            "(let ((m (cma:make-double-matrix 2 2 :initial-contents '((0 0) (5 0))))) (multiple-value-list (cma:sample-from-distribution-matrix m)))",
            "((0 1))",
        ),
        (
            "(let ((m (cma:make-double-matrix 2 1 :initial-contents '((1 3)))) (n 0)) (dotimes (i 2000) (incf n (first"
            " (cma:sample-from-distribution-matrix m)))) (< 1300 n 1700))",
            "T",
        ),
        (
            "(let ((numbers (loop repeat 2000 collect (cma:sample-gauss 5 2)))) (list (< 4.7 (cma:average numbers) 5.3)"
            " (< 1.7 (cma:standard-deviation numbers) 2.3)))",
            "(T T)",
        ),
        ("(mapcar #'cma:hsv->rgb '((0 1 1) (120 1 1) (240 1 1) (60 1 1/2) (0 0 1)))", "((1 0 0) (0 1 0) (0 0 1) (1/2 1/2 0) (1 1 1))"),
        (
            "(mapcar #'cma:rgb->hsv '((1 0 0) (0 1 0) (0 0 1) (1/2 1/2 0) (1 1 1) (0 0 0)))",
            "((0 1 1) (120 1 1) (240 1 1) (60 1 1/2) (0 0 1) (0 0 0))",
        ),
    ],
)
def test_values(values, form, value):
    assert " ".join(values(form).split()) == value


def test_a_matrix_without_an_inverse(values):
    with pytest.raises(Condition) as caught:
        values("(cma:invert-double-matrix (cma:make-double-matrix 2 2))")
    assert "has no inverse" in caught.value.report()


@pytest.mark.parametrize(
    ("form", "text"),
    [
        (
            "(cma:sample-from-distribution-matrix (cma:make-double-matrix 2 2))",
            "Nothing can be drawn from a matrix whose elements have the sum 0",
        ),
        ("(cma:normalize-double-matrix (cma:make-double-matrix 2 2))", "is no distribution"),
        (
            "(cma:double-matrix-sum (cma:make-double-matrix 2 1) (cma:make-double-matrix 1 2))",
            "Matrices of 1 x 2 and 2 x 1 elements do not fit.",
        ),
    ],
)
def test_matrices_that_do_not_fit(values, form, text):
    with pytest.raises(Condition) as caught:
        values(form)
    assert text in caught.value.report()


def test_everything_that_is_exported_is_defined(values):
    assert (
        values("""(let ((missing nil) (count 0))
                       (do-external-symbols (name :cram-math) (incf count) (unless (or (fboundp name) (find-class name nil) (member name '(cma:double-vector cma:double-matrix)))
                                                                  (push name missing)))
                       (list missing (>= count 34)))""")
        == "(NIL T)"
    )
