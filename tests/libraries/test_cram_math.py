"""cram-math: the names of CRAM's, and no more: matrices, samples, polygons, angles."""

import pytest

from cramhy_runtime.lisp_core.conditions import Condition

NAMES = """sample sample-discrete invalid-probability-distribution sample-from-distribution-matrix double-matrix width height make-double-matrix
    make-double-vector double-vector-size fill-double-matrix double-matrix-from-array double-matrix-from-grid grid-from-double-matrix mref
    map-double-matrix map-double-matrix-into double-matrix-transpose double-matrix-product m.+ m.- m.* m./ m+ m- m* m/ determinant gauss
    average 2d-point polygon point-in-polygon degrees->radians radians->degrees""".split()
"""As CRAM's master exports them, and ``average``, which is of devel. Nothing stands behind ``mref`` there either."""

SQUARE = "(cma:make-double-matrix 2 2 :initial-contents '((1 2) (3 4)))"


def polygon(*points):
    corners = " ".join(f"(make-instance 'cma:2d-point :x {x} :y {y})" for x, y in points)
    return f"(make-instance 'cma:polygon :vertices (list {corners}))"


@pytest.mark.soak(all_but=14)
@pytest.mark.parametrize(
    ("form", "value"),
    [
        ("(cma:degrees->radians 180)", "3.141592653589793d0"),
        ("(round (cma:radians->degrees pi))", "180 0.0d0"),
        ("(cma:average '(1 2 3 4))", "5/2"),
        ("(cma:make-double-matrix 3 2 :initial-contents '((1 2 3) (4 5 6)))", "#2A((1.0d0 2.0d0 3.0d0) (4.0d0 5.0d0 6.0d0))"),
        ("(cma:make-double-matrix 2 1 :initial-contents '(1 2))", "#2A((1.0d0 2.0d0))"),
        ("(cma:make-double-matrix 2 1 :initial-element 7)", "#2A((7.0d0 7.0d0))"),
        ("(let ((m (cma:make-double-matrix 3 2))) (list (cma:width m) (cma:height m) (typep m 'cma:double-matrix)))", "(3 2 T)"),
        ("(cma:make-double-vector 2 :initial-contents '(1 2))", "#2A((1.0d0) (2.0d0))"),
        ("(cma:double-vector-size (cma:make-double-vector 3))", "3"),
        (f"(cma:fill-double-matrix {SQUARE} :initial-element 5)", "#2A((5.0d0 5.0d0) (5.0d0 5.0d0))"),
        (f"(cma:fill-double-matrix {SQUARE})", "#2A((1.0d0 2.0d0) (3.0d0 4.0d0))"),
        ("(cma:double-matrix-from-array #(1 2))", "#2A((1.0d0) (2.0d0))"),
        ("(cma:double-matrix-from-array #2A((1 2)))", "#2A((1.0d0 2.0d0))"),
        (f"(let ((m {SQUARE})) (eq m (cma:double-matrix-from-array #2A((5 6) (7 8)) m)))", "T"),
        (f"(let ((m {SQUARE})) (equalp m (cma:double-matrix-from-grid (cma:grid-from-double-matrix m))))", "T"),
        (f"(cma:map-double-matrix #'+ {SQUARE} {SQUARE})", "#2A((2.0d0 4.0d0) (6.0d0 8.0d0))"),
        (f"(let ((m {SQUARE})) (list (eq m (cma:map-double-matrix-into m #'- m)) m))", "(T #2A((-1.0d0 -2.0d0) (-3.0d0 -4.0d0)))"),
        (f"(cma:double-matrix-transpose {SQUARE})", "#2A((1.0d0 3.0d0) (2.0d0 4.0d0))"),
        (f"(cma:double-matrix-product {SQUARE} {SQUARE})", "#2A((7.0d0 10.0d0) (15.0d0 22.0d0))"),
        (f"(list (cma:m.+ {SQUARE} 1d0) (cma:m.- {SQUARE} 1d0))", "(#2A((2.0d0 3.0d0) (4.0d0 5.0d0)) #2A((0.0d0 1.0d0) (2.0d0 3.0d0)))"),
        (f"(list (cma:m.* {SQUARE} 2d0) (cma:m./ {SQUARE} 2d0))", "(#2A((2.0d0 4.0d0) (6.0d0 8.0d0)) #2A((0.5d0 1.0d0) (1.5d0 2.0d0)))"),
        (
            f"(list (cma:m+ {SQUARE} {SQUARE}) (cma:m- {SQUARE} {SQUARE}))",
            "(#2A((2.0d0 4.0d0) (6.0d0 8.0d0)) #2A((0.0d0 0.0d0) (0.0d0 0.0d0)))",
        ),
        (
            f"(list (cma:m* {SQUARE} {SQUARE}) (cma:m/ {SQUARE} {SQUARE}))",
            "(#2A((1.0d0 4.0d0) (9.0d0 16.0d0)) #2A((1.0d0 1.0d0) (1.0d0 1.0d0)))",
        ),
        (f"(let ((m {SQUARE})) (list (eq m (cma:m+ m m m)) m))", "(T #2A((2.0d0 4.0d0) (6.0d0 8.0d0)))"),
        ("(cma:determinant (cma:make-double-matrix 3 3 :initial-contents '((0 1 2) (1 0 3) (4 -3 8))))", "-2.0d0"),
        (
            "(multiple-value-list (cram-math::invert-matrix (cma:make-double-matrix 2 2 :initial-contents '((2 0) (0 4)))))",
            "(#2A((0.5d0 0.0d0) (0.0d0 0.25d0)) 8.0d0)",
        ),
        (
            "(let ((zero (cma:make-double-vector 1))) (funcall (cma:gauss (cma:make-double-matrix 1 1 :initial-element 1d0) zero) zero))",
            "0.3989422804014327d0",
        ),
        ("(cma:sample-from-distribution-matrix (cma:make-double-matrix 2 2 :initial-contents '((0 0) (5 0))))", "(0 1)"),
        (
            "(let ((m (cma:make-double-matrix 2 1 :initial-contents '((1 3)))) (n 0)) (dotimes (i 2000) (incf n (first"
            " (cma:sample-from-distribution-matrix m)))) (< 1300 n 1700))",
            "T",
        ),
        ("(let ((n 0)) (dotimes (i 1000) (incf n (cma:sample-discrete '((0 . 0.2) (1 . 0.8))))) (< 720 n 880))", "T"),
        ("(cma:sample (lambda (x) (if (< x 0.5) :a :b)) (lambda (v) (if (eq v :a) 1 0)))", ":A"),
        (
            f"(mapcar (lambda (x y) (cma:point-in-polygon (make-instance 'cma:2d-point :x x :y y) {polygon((0, 0), (4, 0), (4, 4), (2, 1))}))"
            " '(3 1 2 5 3.9) '(1 1 2 1 3.5))",
            "(T NIL NIL NIL T)",
        ),
    ],
)
def test_values(values, form, value):
    assert " ".join(values(form).split()) == value


@pytest.mark.parametrize(
    ("form", "text"),
    [
        ("(cram-math::invert-matrix (cma:make-double-matrix 2 2))", "has no inverse"),
        ("(cma:sample-from-distribution-matrix (cma:make-double-matrix 2 2))", "The probabilities are 0 everywhere"),
        (
            f"(cma:double-matrix-product {SQUARE} (cma:make-double-matrix 2 1))",
            "A matrix of 2 columns cannot be multiplied with one of 1 rows.",
        ),
        ("(cma:double-vector-size (cma:make-double-matrix 2 1))", "A vector is a matrix of one column, and this one has 2."),
        ("(cma:determinant (cma:make-double-matrix 2 1))", "is not square"),
        ("(cma:sample #'identity (constantly -1) 3)", "No sample was drawn in 3 trials"),
        ("(make-instance 'cma:polygon)", "A polygon needs its corners"),
    ],
)
def test_what_is_wrong_is_told(values, form, text):
    with pytest.raises(Condition) as caught:
        values(form)
    assert text in caught.value.report()


def test_the_exported_names_are_the_original_s(values):
    names = values("(let (names) (do-external-symbols (name :cram-math) (push (string-downcase name) names)) names)")
    assert sorted(names.replace('"', " ").strip("()").split()) == sorted(NAMES)
