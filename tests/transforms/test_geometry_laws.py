"""The invariants of cl-transforms.md section 10 that are about geometry, as a user types them."""

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime.transforms.poses import Transform
from cramhy_runtime.transforms.quaternions import Quaternion, normalize
from cramhy_runtime.transforms.vectors import Vector3

numbers = st.floats(-10, 10, allow_nan=False, allow_subnormal=False)
points = st.builds(Vector3, numbers, numbers, numbers)
quaternions = st.builds(Quaternion, numbers, numbers, numbers, numbers).filter(lambda q: math.hypot(*q) > 0.1)
units = quaternions.map(normalize)
transforms = st.builds(Transform, points, units)
with_text = settings(deadline=None, max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])


def holds(lisp, function, *arguments):
    """Call the value of the lambda expression ``function``, compiled once, with objects."""
    known = lisp.__dict__.setdefault("functions", {})
    if function not in known:
        known[function] = lisp.value(function)
    assert known[function](*arguments) is True, arguments


@pytest.mark.law("cl-transforms", 1)
def test_a_vector_prints_its_doubles(lisp):
    assert lisp("(make-3d-vector 1 2 3)") == "#<3D-VECTOR (1.0d0 2.0d0 3.0d0)>"


@pytest.mark.law("cl-transforms", 2)
def test_a_vector_has_three_reals(lisp):
    assert lisp.error('(make-3d-vector "a" 0 0)', "type-error") == 'The value\n  "a"\nis not of type\n  REAL'
    assert lisp.error("(make-3d-vector 1 2)", "program-error") == "invalid number of arguments: 2"


@pytest.mark.law("cl-transforms", 3)
def test_sums_of_one_vector(lisp):
    assert lisp("(eq (v+ *x*) *x*)") == "T"
    assert lisp("(let ((array #(1 2 3))) (eq (v+ array) array))") == "T"
    assert lisp.error("(v+)", "program-error") == "invalid number of arguments: 0"
    assert lisp("(v- *x*)") == "#<3D-VECTOR (1.0d0 0.0d0 0.0d0)>"


@pytest.mark.law("cl-transforms", 4)
def test_sums_and_differences(lisp):
    assert lisp("(v+ #(1 2 3) #(1 1 1) #(10 0 0))") == "#<3D-VECTOR (12.0d0 3.0d0 4.0d0)>"
    assert lisp("(v- #(1 2 3) #(1 1 1) #(1 1 1))") == "#<3D-VECTOR (-1.0d0 0.0d0 1.0d0)>"


@pytest.mark.law("cl-transforms", 5)
def test_the_scalar_stands_behind_the_vector(lisp):
    assert lisp.error("(v* 2 *x*)", "type-error") == (
        "The value\n  #<3D-VECTOR (1.0d0 0.0d0 0.0d0)>\nis not of type\n  REAL\nwhen binding CL-TRANSFORMS::SCALAR"
    )
    assert lisp("(v* *x* 2)") == "#<3D-VECTOR (2.0d0 0.0d0 0.0d0)>"


@pytest.mark.law("cl-transforms", 6)
def test_the_vector_product_is_right_handed(lisp):
    assert lisp("(cross-product *x* *y*)") == "#<3D-VECTOR (0.0d0 0.0d0 1.0d0)>"
    assert lisp("(cross-product *y* *x*)") == "#<3D-VECTOR (0.0d0 0.0d0 -1.0d0)>"


@pytest.mark.law("cl-transforms", 7)
def test_lengths(lisp):
    assert lisp("(list (v-norm #(3 4 0)) (v-norm (make-3d-vector 3 4 0)))") == "(5.0 5.0d0)"
    assert lisp("(v-dist #(3 4 0) #(0 0 0))") == "5.0d0"
    assert lisp("(list (dot-product #(1 2 3) #(1 2 3)) (dot-product (make-3d-vector 1 2 3) #(1 2 3)))") == "(14 14.0d0)"


@pytest.mark.law("cl-transforms", 8)
def test_divisions_by_zero(lisp):
    for text in ("(normalize-vector #(0 0 0))", "(v/-pairwise *x* *y*)"):
        assert lisp.error(text, "division-by-zero") == "arithmetic error DIVISION-BY-ZERO signalled"


@pytest.mark.law("cl-transforms", 9)
def test_the_hamilton_product(lisp):
    assert lisp("(q* (make-quaternion 1 2 3 4) (make-quaternion 5 6 7 8))") == "#<QUATERNION (24.0d0 48.0d0 48.0d0 -6.0d0)>"


@pytest.mark.law("cl-transforms", 10)
@with_text
@given(a=quaternions, b=quaternions, c=quaternions)
def test_quaternions_are_a_field_but_for_the_order(lisp, a, b, c):
    holds(lisp, "(lambda (a) (near (q* a (q-inv a)) '(0 0 0 1)))", a)
    holds(lisp, "(lambda (a b) (near (q-inv (q* a b)) (q* (q-inv b) (q-inv a))))", a, b)
    holds(lisp, "(lambda (a b c) (near (q* (q* a b) c) (q* a (q* b c))))", a, b, c)
    holds(lisp, "(lambda (a b c) (near (q* a (q+ b c)) (q+ (q* a b) (q* a c))))", a, b, c)


@pytest.mark.law("cl-transforms", 11)
def test_equality_of_quaternions(lisp):
    assert lisp("(q= (make-identity-rotation) 1)") == "T"
    assert (
        lisp("(let ((q (make-quaternion 1 2 3 4))) (list (q= q (q- q)) (q= q (copy-quaternion q)) (equal q (copy-quaternion q))))")
        == "(NIL T NIL)"
    )


@pytest.mark.law("cl-transforms", 12)
def test_who_normalises_and_who_says_so(lisp):
    assert lisp("(q-norm (make-quaternion 0 0 0 2))") == "2.0d0"
    assert lisp.warnings("(defvar *pose* (make-pose *x* (make-quaternion 0 0 0 2)))") == ""
    assert lisp("(orientation *pose*)") == "#<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>"
    assert lisp.warnings("(defvar *transform* (make-transform *x* (make-quaternion 0 0 0 2)))") == (
        "WARNING:\n   Normalized rotation component to #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>\n"
    )
    assert lisp("(rotation *transform*)") == "#<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>"
    for silent in (
        "(make-transform *x* (make-quaternion 0 0 0 2) :validate-args :no-warn)",
        "(make-instance 'transform :rotation (make-quaternion 0 0 0 2))",
    ):
        assert lisp.warnings(f"(defparameter *made* {silent})") == ""
        assert lisp("(rotation *made*)") == "#<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>"


@pytest.mark.law("cl-transforms", 13)
def test_how_transforms_are_validated(lisp):
    assert lisp("(rotation (make-transform *x* (make-quaternion 0 0 0 2) :validate-args nil))") == "#<QUATERNION (0.0d0 0.0d0 0.0d0 2.0d0)>"
    assert lisp.error("(make-transform *x* (make-quaternion 0 0 0 2) :validate-args t)") == (
        "Rotation component #<QUATERNION (0.0d0 0.0d0 0.0d0 2.0d0)> not normalized"
    )
    assert lisp("(translation (make-transform 'anywhere (make-identity-rotation) :validate-args t))") == "ANYWHERE"


@pytest.mark.law("cl-transforms", 14)
def test_a_pose_without_rotation_is_an_error(lisp):
    text = "Attempted to normalize quaternion #<QUATERNION (0.0d0 0.0d0 0.0d0 0.0d0)> with norm 0.0d0"
    assert lisp.error("(make-pose *x* (make-quaternion 0 0 0 0))") == text
    assert lisp.error("(make-instance 'pose :orientation (make-quaternion 0 0 0 0))") == text
    assert lisp.condition("(make-pose *x* (make-quaternion 0 0 0 0))").hint == (
        "A message that nobody filled in has the orientation (0 0 0 0), which is no rotation; (make-identity-rotation) is the one that "
        "turns nothing."
    )


@pytest.mark.law("cl-transforms", 15)
def test_an_axis_is_normalised(lisp):
    for axis in ("*z*", "(make-3d-vector 0 0 2)", "#(0 0 1)"):
        assert lisp(f"(axis-angle->quaternion {axis} (/ pi 2))") == "#<QUATERNION (0.0d0 0.0d0 0.7071067811865475d0 0.7071067811865476d0)>"
    assert lisp.error("(axis-angle->quaternion #(0 0 0) 1.0)") == "Can't normalize #(0 0 0)"


@pytest.mark.law("cl-transforms", 16)
def test_an_angle_is_a_float(lisp):
    text = "The value\n  0\nis not of type\n  FLOAT\nwhen binding CL-TRANSFORMS::ANGLE"
    assert lisp.error("(axis-angle->quaternion *z* 0)", "type-error") == lisp.error("(yaw 0)", "type-error") == text
    assert lisp.condition("(yaw 3)").hint == "An angle must be a float: write 3.0."
    assert lisp("(axis-angle->quaternion *z* 0.0)") == "#<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>"


@pytest.mark.law("cl-transforms", 17)
def test_the_axis_of_a_rotation_is_its_vector_part(lisp):
    assert lisp("(quaternion->axis-angle (axis-angle->quaternion *z* 1.0d0))") == (
        "#<3D-VECTOR (0.0d0 0.0d0 0.479425538604203d0)> 0.9999999999999998d0"
    )
    assert (
        lisp(
            "(multiple-value-bind (axis angle) (quaternion->axis-angle (q- (yaw 1.0d0))) (near (list angle (z axis))"
            " (list (- (* 2 pi) 1) -0.479425538604203d0)))"
        )
        == "T"
    )


@pytest.mark.law("cl-transforms", 18)
def test_the_angle_of_a_rotation_is_real(lisp):
    assert lisp("(quaternion->axis-angle (make-quaternion 0 0 0 1.1))") == "#<3D-VECTOR (0.0d0 0.0d0 0.0d0)> 0.0d0"


@pytest.mark.law("cl-transforms", 19)
def test_a_quarter_turn(lisp):
    assert lisp("(near (rotate (axis-angle->quaternion *z* (/ pi 2)) *x*) *y*)") == "T"


@pytest.mark.law("cl-transforms", 20)
def test_only_rotations_rotate(lisp):
    assert lisp.error("(rotate (make-quaternion 0 0 0 2) *x*)") == (
        "The assertion (CL-TRANSFORMS:IS-NORMALIZED CL-TRANSFORMS::Q) failed with CL-TRANSFORMS::Q = "
        "#<QUATERNION (0.0d0 0.0d0 0.0d0 2.0d0)>."
    )
    assert lisp("(rotate (make-quaternion 0 0 0 2) *x* :normalize t)") == "#<3D-VECTOR (1.0d0 0.0d0 0.0d0)>"
    assert lisp("(rotate (make-quaternion 0 0 0 2) *x* :normalize nil)") == "#<3D-VECTOR (1.0d0 0.0d0 0.0d0)>"


@pytest.mark.law("cl-transforms", 21)
@with_text
@given(a=units, b=units, v=points)
def test_rotating_by_a_product(lisp, a, b, v):
    holds(lisp, "(lambda (a b v) (near (rotate (q* a b) v :normalize t) (rotate a (rotate b v))))", a, b, v)


@pytest.mark.law("cl-transforms", 22, 23)
def test_roll_pitch_and_yaw(lisp):
    lisp("(defvar *q* (euler->quaternion :ax 0.1d0 :ay 0.2d0 :az 0.3d0))")
    assert lisp("(near *q* '(0.0342707985504821d0 0.1060205110617956d0 0.1435721750273919d0 0.9833474432563558d0))") == "T"
    assert lisp("(destructuring-bind (&key ax ay az) (quaternion->euler *q*) (near (list ax ay az) '(0.1d0 0.2d0 0.3d0)))") == "T"
    assert lisp("(mapcar (lambda (angle) (/ (round angle 1d-9) 1000000000)) (quaternion->euler *q* :just-values t))") == "(1/10 1/5 3/10)"
    assert lisp("(euler->quaternion)") == "#<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>"
    assert lisp("(near (euler->quaternion :az 2) (yaw 2.0) 1d-6)") == "T"


@pytest.mark.law("cl-transforms", 24)
def test_at_the_poles_roll_is_zero(lisp):
    for pitch, yaw in (("(/ pi 2)", "0.2d0"), ("(- (/ pi 2))", "0.4d0")):
        assert (
            lisp(f"""(destructuring-bind (roll pitch yaw)
                            (quaternion->euler (euler->quaternion :ax 0.1d0 :ay {pitch} :az 0.3d0) :just-values t)
                          (list (eql roll 0) (near (list pitch yaw) (list {pitch} {yaw}))))""")
            == "(T T)"
        )


@pytest.mark.law("cl-transforms", 25)
@with_text
@given(angle=st.floats(-3.1415, 3.1415).map(float))
def test_yaw_there_and_back(lisp, angle):
    holds(lisp, "(lambda (angle) (< (abs (- (get-yaw (yaw angle)) angle)) 1d-9))", angle)
    assert lisp("(get-yaw (yaw pi))") == "3.141592653589793d0"


@pytest.mark.law("cl-transforms", 26)
def test_angles_are_brought_into_one_turn(lisp):
    assert lisp("(mapcar #'normalize-angle (list 4.0 pi (- pi) 0.5 -3 (* 3 pi) -4 10))") == (
        "(-2.2831853071795862d0 3.141592653589793d0 -3.141592653589793d0 0.5 -3 3.141592653589793d0 2.2831853071795862d0 "
        "-2.5663706143591725d0)"
    )


@pytest.mark.law("cl-transforms", 27)
@with_text
@given(a=transforms, b=transforms, p=points)
def test_transforms_compose_like_matrices(lisp, a, b, p):
    holds(lisp, "(lambda (a b p) (near (transform-point (transform* a b) p) (transform-point a (transform-point b p))))", a, b, p)


@pytest.mark.law("cl-transforms", 28)
@with_text
@given(a=transforms)
def test_the_transform_back(lisp, a):
    holds(
        lisp,
        "(lambda (a) (let ((one (transform* a (transform-inv a)))) (and (near (translation one) '(0 0 0))"
        " (near (rotation one) '(0 0 0 1)))))",
        a,
    )
    assert lisp("(near (translation (transform-inv *a*)) '(-2 1 -3))") == "T"


@pytest.mark.law("cl-transforms", 29)
def test_the_last_transform_is_applied_first(lisp):
    assert lisp("(near (transform-point *a* *x*) '(1 3 3))") == "T"
    assert lisp("(near (translation (transform* *a* (make-transform *x* (make-identity-rotation)))) '(1 3 3))") == "T"
    assert lisp("(near (translation (transform* (make-transform *x* (make-identity-rotation)) *a*)) '(2 2 3))") == "T"
    assert lisp("(eq (transform* *a*) *a*)") == "T"
    assert lisp.error("(transform*)", "program-error") == "invalid number of arguments: 0"


@pytest.mark.law("cl-transforms", 30)
@with_text
@given(to=transforms, origin=transforms, p=points)
def test_the_difference_of_transforms(lisp, to, origin, p):
    holds(
        lisp,
        "(lambda (to from p) (near (transform-point (transform* (transform-diff to from) from) p) (transform-point to p)))",
        to,
        origin,
        p,
    )


@pytest.mark.law("cl-transforms", 31)
def test_what_can_be_transformed(lisp):
    assert lisp.error("(transform-point (make-identity-pose) *x*)", "type-error") == (
        "The value\n  #<POSE \n   #<3D-VECTOR (0.0d0 0.0d0 0.0d0)>\n   #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>>\n\nis not of type\n"
        "  CL-TRANSFORMS:TRANSFORM\nwhen binding CL-TRANSFORMS::TRANS"
    )
    assert lisp.error("(transform-point *a* '(1 2 3))", "type-error") == (
        "The value\n  (1 2 3)\nis not of type\n  CL-TRANSFORMS:POINT\nwhen binding CL-TRANSFORMS::P"
    )
    assert lisp.condition("(transform-point *a* '(1 2 3))").hint == (
        "A list is no point; a vector such as #(1 2 3) is, or (make-3d-vector 1 2 3)."
    )
    assert lisp("(transform-point (make-identity-transform) #(1 0 0))") == "#<3D-VECTOR (1.0d0 0.0d0 0.0d0)>"


@pytest.mark.law("cl-transforms", 32)
def test_poses_on_the_plane(lisp):
    assert lisp.error("(make-2d-pose 1 2 0)", "type-error") == "The value\n  0\nis not of type\n  FLOAT\nwhen binding CL-TRANSFORMS::ANGLE"
    assert lisp("(orientation (make-2d-pose 1 2 0.5d0))") == "#<QUATERNION (0.0d0 0.0d0 0.24740395925452294d0 0.9689124217106447d0)>"
    assert lisp("(origin (make-2d-pose 1 2 0.5d0))") == "#<3D-VECTOR (1.0d0 2.0d0 0.0d0)>"


@pytest.mark.law("cl-transforms", 33)
def test_poses_and_transforms_have_the_same_numbers(lisp):
    assert (
        lisp(
            "(let* ((pose (make-2d-pose 1 2 0.5)) (back (transform->pose (pose->transform pose))))"
            " (list (near (origin back) (origin pose) 1d-30) (q= (orientation back) (orientation pose))))"
        )
        == "(T T)"
    )


@pytest.mark.law("cl-transforms", 34)
@with_text
@given(q=units)
def test_matrices_of_rotations(lisp, q):
    holds(lisp, "(lambda (q) (let ((back (matrix->quaternion (quaternion->matrix q)))) (or (near back q) (near (q- back) q))))", q)
    for diagonal, text in (
        ("((1 0 0) (0 -1 0) (0 0 -1))", "(1.0d0 0.0d0 0.0d0 0.0d0)"),
        ("((-1 0 0) (0 1 0) (0 0 -1))", "(0.0d0 1.0d0 0.0d0 0.0d0)"),
        ("((-1 0 0) (0 -1 0) (0 0 1))", "(0.0d0 0.0d0 1.0d0 0.0d0)"),
    ):
        assert lisp(f"(matrix->quaternion #2A{diagonal})") == f"#<QUATERNION {text}>"


@pytest.mark.law("cl-transforms", 35)
def test_matrices_of_transforms(lisp):
    assert lisp("(loop with matrix = (transform->matrix *a*) for column below 4 collect (aref matrix 3 column))") == "(0.0 0.0 0.0 1)"
    assert lisp.error("(matrix->transform #2A((1 0) (0 1)))") == (
        "The assertion (EQUAL (ARRAY-DIMENSIONS CL-TRANSFORMS::MATRIX) '(4 4)) failed: the matrix is 2 by 2."
    )
    assert lisp("(near (translation (matrix->transform (transform->matrix *a*))) '(1 2 3))") == "T"


@pytest.mark.law("cl-transforms", 36)
def test_spherical_interpolation(lisp):
    for ratio, angle in (("0", 0), ("1", 2), ("0.5", 1), ("2.0", 4 - 2 * math.pi)):
        assert lisp(f"(< (abs (- (get-yaw (slerp (make-identity-rotation) (yaw 2d0) {ratio})) {float(angle)!r}d0)) 1d-9)") == "T"
    assert lisp.error("(slerp 1.0 (yaw 2d0) 0.5)", "type-error") == (
        "The value of CL-TRANSFORMS::Q1 is 1.0, which is not of type QUATERNION."
    )


@pytest.mark.law("cl-transforms", 37)
def test_linear_interpolation(lisp):
    assert lisp("(interpolate-vector (make-3d-vector 0 0 0) (make-3d-vector 2 4 6) 0.5)") == "#<3D-VECTOR (1.0d0 2.0d0 3.0d0)>"
    assert lisp("(interpolate-vector (make-3d-vector 0 0 0) (make-3d-vector 2 4 6) 2)") == "#<3D-VECTOR (4.0d0 8.0d0 12.0d0)>"
    assert lisp.error("(interpolate-vector #(0 0 0) *x* 0.5)", "type-error") == (
        "The value of CL-TRANSFORMS::V-0 is #(0 0 0), which is not of type 3D-VECTOR."
    )


@pytest.mark.law("cl-transforms", 38)
def test_the_bearing_of_a_turtle(lisp):
    assert (
        lisp("""(let ((seen (transform-point (transform-inv (pose->transform (make-2d-pose 1 1 (/ pi 2)))) (make-3d-vector 1 3 0))))
                     (list (near seen '(2 0 0)) (< (abs (atan (y seen) (x seen))) 1d-9)))""")
        == "(T T)"
    )
