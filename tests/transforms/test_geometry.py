"""cl-transforms: formulas, laws and printed forms. Source: cl-transforms.md, chiefly section 10."""

import math

import pytest

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.arrays import LispArray
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import find_package, keyword, sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.transforms import matrices, poses, quaternions, vectors
from cramhy_runtime.lisp_core.packages import ensure_package
from cramhy_runtime.lisp_core.printing import speak
from cramhy_runtime.transforms.poses import Pose, Transform
from cramhy_runtime.transforms.quaternions import Quaternion
from cramhy_runtime.transforms.vectors import Vector3

X, Y, Z = Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)
A = Transform(Vector3(1, 2, 3), quaternions.yaw(math.pi / 2))

CL_TRANSFORMS = ensure_package("CL-TRANSFORMS")


@pytest.fixture(autouse=True)
def _lisp_is_spoken():
    speak(lisp=True)
    yield
    speak(lisp=False)


def show(obj):
    with binding(sym("*PACKAGE*"), CL_TRANSFORMS):
        return prin1_to_string(obj)


def error_text(thunk, kind=conditions.Error):
    return conditions.handler_case([(kind, lambda condition: condition.report())], thunk)


def near(a, b):
    return all(math.isclose(x, y, abs_tol=1e-7) for x, y in zip(a, b))


@pytest.mark.parametrize(
    "obj, text",
    [
        (vectors.make_3d_vector(1, 9, 0), "#<3D-VECTOR (1.0d0 9.0d0 0.0d0)>"),
        (vectors.make_3d_vector(1.5, 2, 3), "#<3D-VECTOR (1.5d0 2.0d0 3.0d0)>"),
        (vectors.make_3d_vector(SingleFloat(0.1), 0.1, 0), "#<3D-VECTOR (0.10000000149011612d0 0.1d0 0.0d0)>"),
        (quaternions.make_quaternion(0, 0, 0, 1), "#<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>"),
        (quaternions.q_inv(Quaternion()), "#<QUATERNION (-0.0d0 -0.0d0 -0.0d0 1.0d0)>"),
        (quaternions.q_plus(3), "#<QUATERNION (0.0 0.0 0.0 3.0)>"),
        (poses.make_identity_pose(), "#<POSE \n   #<3D-VECTOR (0.0d0 0.0d0 0.0d0)>\n   #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>>"),
        (Transform(Vector3(1, 2, 3)), "#<TRANSFORM \n   #<3D-VECTOR (1.0d0 2.0d0 3.0d0)>\n   #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>>"),
        (
            poses.make_twist(X, Z),
            "#<TWIST \n   TRANSLATION #<3D-VECTOR (1.0d0 0.0d0 0.0d0)>\n   ROTATION #<3D-VECTOR (0.0d0 0.0d0 1.0d0)>>",
        ),
        (quaternions.axis_angle_to_quaternion(Z, math.pi), "#<QUATERNION (0.0d0 0.0d0 1.0d0 6.123233995736766d-17)>"),
        (
            quaternions.axis_angle_to_quaternion(Z, SingleFloat(1.0)),
            "#<QUATERNION (0.0d0 0.0d0 0.4794255495071411d0 0.8775825500488281d0)>",
        ),
        (quaternions.euler_to_quaternion(az=SingleFloat(1.0)), "#<QUATERNION (0.0d0 0.0d0 0.4794255495071411d0 0.8775825500488281d0)>"),
        (vectors.v_dist(Vector3(), Vector3(3, 4, 0)), "5.0d0"),
        (vectors.x(vectors.make_3d_vector(1, 9, 0)), "1.0d0"),
        (lisp_list(Vector3(1, 9, 0)), "(#<3D-VECTOR (1.0d0 9.0d0 0.0d0)>)"),
    ],
)
def test_printed_forms(obj, text):
    assert show(obj) == text


def test_the_package_shows_where_it_is_not_used():
    with binding(sym("*PACKAGE*"), find_package("COMMON-LISP-USER")):
        assert prin1_to_string(X) == "#<CL-TRANSFORMS:3D-VECTOR (1.0d0 0.0d0 0.0d0)>"


def test_the_export_list_is_complete():
    names = """3d-vector angle-between-quaternions axis-angle->quaternion column-vectors->quaternion copy-3d-vector copy-pose
        copy-quaternion copy-transform copy-twist copy-wrench cross-product dot-product euler->quaternion gen-quaternion get-yaw
        interpolate-vector invert-rot-matrix is-normalized make-2d-pose make-3d-vector make-identity-pose make-identity-rotation
        make-identity-transform make-identity-twist make-identity-vector make-identity-wrench make-pose make-quaternion
        make-transform make-twist make-wrench matrix->quaternion matrix->transform normalize normalize-angle normalize-vector
        orientation origin point pose pose->matrix pose->transform q* q+ q- q-dot q-inv q-norm q-scale q= quaternion
        quaternion->axis-angle quaternion->euler quaternion->matrix quaternion-coefficient reference-transform rotate rotation
        slerp squared-norm transform transform* transform->matrix transform->pose transform-diff transform-inv transform-point
        transform-pose translation transpose-2d-matrix transpose-rot-matrix twist v* v*-pairwise v+ v- v-dist v-inv v-norm
        v/-pairwise w wrench x y yaw z"""
    assert sorted(CL_TRANSFORMS.external) == sorted(names.upper().split())


def test_vectors():
    assert vectors.v_plus(X) is X and vectors.v_minus(X) is X
    assert vectors.v_plus([1, 2, 3], [1, 1, 1], [10, 0, 0]).components == (12, 3, 4)
    assert vectors.v_minus([1, 2, 3], [1, 1, 1], [1, 1, 1]).components == (-1, 0, 1)
    assert vectors.v_star(X, 2).components == (2, 0, 0)
    assert vectors.cross_product(X, Y).components == (0, 0, 1) and vectors.cross_product(Y, X).components == (0, 0, -1)
    assert vectors.v_norm(Vector3(3, 4, 0)) == 5 and vectors.dot_product([1, 2, 3], [1, 2, 3]) == 14
    assert vectors.normalize_vector(Vector3(3, 4, 0)).components == (0.6000000000000001, 0.8, 0)
    assert vectors.interpolate_vector(Vector3(), Vector3(2, 4, 6), 0.5).components == (1, 2, 3)
    assert vectors.interpolate_vector(Vector3(), Vector3(2, 4, 6), 2).components == (4, 8, 12)
    assert vectors.x([1, 2, 3]) == 1 and vectors.x(3) == 0.0 and quaternions.w(3) == 3
    assert vectors.copy_3d_vector(X, y=2).components == (1, 2, 0)
    assert show(vectors.v_inv(X)) == "#<3D-VECTOR (-1.0d0 -0.0d0 -0.0d0)>"


@pytest.mark.parametrize(
    "thunk, text",
    [
        (lambda: vectors.make_3d_vector("a", 0, 0), 'The value\n  "a"\nis not of type\n  REAL'),
        (lambda: vectors.make_3d_vector(None, 0, 0), "The value\n  NIL\nis not of type\n  REAL"),
        (lambda: vectors.v_plus(), "invalid number of arguments: 0"),
        (lambda: poses.transform_star(), "invalid number of arguments: 0"),
        (lambda: quaternions.axis_angle_to_quaternion(Z, 0), "The value\n  0\nis not of type\n  FLOAT\nwhen binding CL-TRANSFORMS::ANGLE"),
        (
            lambda: vectors.interpolate_vector([0, 0, 0], X, 1),
            "The value of CL-TRANSFORMS::V-0 is #(0 0 0), which is not of type 3D-VECTOR.",
        ),
        (
            lambda: quaternions.slerp(SingleFloat(1.0), Quaternion(), 0.5),
            "The value of CL-TRANSFORMS::Q1 is 1.0, which is not of type QUATERNION.",
        ),
        (
            lambda: quaternions.normalize(Quaternion(0, 0, 0, 0)),
            "Attempted to normalize quaternion #<QUATERNION (0.0d0 0.0d0 0.0d0 0.0d0)> with norm 0.0d0",
        ),
    ],
)
def test_error_texts(thunk, text):
    assert error_text(thunk).startswith(text)


@pytest.mark.parametrize(
    "thunk, kind",
    [
        (lambda: vectors.normalize_vector(Vector3()), conditions.DivisionByZero),
        (lambda: vectors.v_slash_pairwise(X, X), conditions.DivisionByZero),
        (lambda: vectors.v_star(2, X), conditions.TypeError_),
        (lambda: poses.transform_point(Pose(), X), conditions.TypeError_),
        (lambda: poses.transform_point(A, lisp_list(1, 2, 3)), conditions.TypeError_),
        (lambda: poses.make_2d_pose(1, 2, 0), conditions.TypeError_),
        (lambda: poses.pose_to_transform(A), conditions.TypeError_),
        (lambda: quaternions.rotate(Quaternion(0, 0, 0, 2), X), conditions.Error),
        (lambda: vectors.x(None), conditions.Error),
        (lambda: poses.transform(A, A), conditions.Error),
        (lambda: matrices.matrix_to_transform(LispArray((2, 2), [1, 0, 0, 1])), conditions.Error),
    ],
)
def test_errors(thunk, kind):
    assert error_text(thunk, kind) is not None


def test_quaternions():
    q = quaternions.q_star(quaternions.make_quaternion(1, 2, 3, 4), quaternions.make_quaternion(5, 6, 7, 8))
    assert q.components == (24, 48, 48, -6)
    assert quaternions.q_star() == 1.0 and quaternions.q_plus() == 0.0
    assert quaternions.q_eq(Quaternion(), 1) and not quaternions.q_eq(q, quaternions.q_minus(q))
    assert quaternions.q_minus(Quaternion()).components == (0, 0, 0, -1)
    assert quaternions.is_normalized(Quaternion(0, 0, 0, 1.0001)) is None
    axis, angle = quaternions.quaternion_to_axis_angle(quaternions.axis_angle_to_quaternion(Z, 1.0))
    assert near(axis, (0, 0, 0.479425538604203)) and math.isclose(angle, 1)
    assert quaternions.quaternion_to_axis_angle(Quaternion(0, 0, 0, 1.1))[1] == 0


def test_euler_angles():
    q = quaternions.euler_to_quaternion(ax=0.1, ay=0.2, az=0.3)
    assert near(q, (0.0342707985504821, 0.1060205110617956, 0.1435721750273919, 0.9833474432563558))
    assert near(quaternions.quaternion_to_euler(q, just_values=True), (0.1, 0.2, 0.3))
    assert list(quaternions.quaternion_to_euler(q))[::2] == [keyword("AX"), keyword("AY"), keyword("AZ")]
    for pitch, yaw in ((math.pi / 2, 0.2), (-math.pi / 2, 0.4)):
        roll, _, heading = quaternions.quaternion_to_euler(quaternions.euler_to_quaternion(ax=0.1, ay=pitch, az=0.3), just_values=True)
        assert roll == 0 and isinstance(roll, int) and math.isclose(heading, yaw)


@pytest.mark.parametrize("angle, normal", [(4.0, -2.283185307179586), (math.pi, math.pi), (-math.pi, -math.pi), (10, -2.5663706143591725)])
def test_angles_are_normalised(angle, normal):
    assert math.isclose(quaternions.normalize_angle(angle), normal)


def test_an_angle_in_range_is_returned_untouched():
    half = 0.5
    assert quaternions.normalize_angle(half) is half


def test_transforms():
    assert near(poses.transform_point(A, X), (1, 3, 3))
    assert near(poses.transform_star(A, Transform(X)).translation, (1, 3, 3))
    assert near(poses.transform_star(Transform(X), A).translation, (2, 2, 3))
    assert near(poses.transform_inv(A).translation, (-2, 1, -3))
    assert near(poses.make_2d_pose(1, 2, 0.5).orientation, (0, 0, 0.24740395925452294, 0.9689124217106447))
    turtle = Transform(Vector3(1, 1, 0), quaternions.yaw(math.pi / 2))
    assert near(poses.transform_point(poses.transform_inv(turtle), Vector3(1, 3, 0)), (2, 0, 0))
    assert near(poses.transform_pose(A, Pose(X)).origin, (1, 3, 3)) and near(poses.transform(A, [1, 0, 0]), (1, 3, 3))
    assert poses.copy_pose(Pose(X), origin=Y).origin is Y and poses.reference_transform(A) is A


def test_rotations_that_are_not_unit_length():
    warnings, double = [], Quaternion(0, 0, 0, 2)

    def note(condition):
        warnings.append(condition.report())
        conditions.muffle_warning(condition)

    def check():
        assert poses.make_pose(X, double).orientation.components == (0, 0, 0, 1) and warnings == []
        assert poses.make_transform(X, double).rotation.components == (0, 0, 0, 1)
        assert len(warnings) == 1 and warnings[0].startswith("Normalized rotation component to #<")
        assert poses.make_transform(X, double, validate_args=keyword("NO-WARN")).rotation.components == (0, 0, 0, 1)
        assert poses.make_transform(X, double, validate_args=None).rotation is double

    conditions.handler_bind([(conditions.Warning_, note)], check)
    assert len(warnings) == 1
    assert "not normalized" in error_text(lambda: poses.make_transform(X, double, validate_args=True))
    assert quaternions.rotate(double, X, normalize=True).components == X.components


def test_matrices():
    matrix = matrices.transform_to_matrix(A)
    assert matrix.dimensions == (4, 4) and matrix.active()[12:] == [0.0, 0.0, 0.0, 1]
    back = matrices.matrix_to_transform(matrix)
    assert near(back.translation, A.translation) and near(back.rotation, A.rotation)
    for diagonal, q in (((1, -1, -1), (1, 0, 0, 0)), ((-1, 1, -1), (0, 1, 0, 0)), ((-1, -1, 1), (0, 0, 1, 0))):
        rows = [diagonal[i] if i == j else 0 for i in range(3) for j in range(3)]
        assert matrices.matrix_to_quaternion(LispArray((3, 3), rows)).components == q
    assert matrices.transpose_2d_matrix(LispArray((2, 3), [1, 2, 3, 4, 5, 6])).active() == [1, 4, 2, 5, 3, 6]
    assert near(matrices.column_vectors_to_quaternion(X, Y, Z), (0, 0, 0, 1))


def test_slerp():
    target = quaternions.yaw(2.0)
    for ratio, angle in ((0, 0), (1, 2), (0.5, 1)):
        assert math.isclose(quaternions.get_yaw(quaternions.slerp(Quaternion(), target, ratio)), angle, abs_tol=1e-9)
    assert math.isclose(quaternions.q_norm(quaternions.slerp(Quaternion(), quaternions.yaw(4.0), 0.5)), 1)
