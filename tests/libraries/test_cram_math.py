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
    ],
)
def test_values(values, form, value):
    assert values(form) == value


def test_a_matrix_without_an_inverse(values):
    with pytest.raises(Condition) as caught:
        values("(cma:invert-double-matrix (cma:make-double-matrix 2 2))")
    assert "has no inverse" in caught.value.report()
