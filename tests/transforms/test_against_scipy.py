"""The same rotations as `scipy.spatial.transform` makes, which also has its components in the order x y z w."""

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from cramhy_runtime.lisp_core.arrays import LispArray
from cramhy_runtime.transforms import matrices, poses, quaternions, vectors
from cramhy_runtime.transforms.poses import Transform
from cramhy_runtime.transforms.quaternions import Quaternion
from cramhy_runtime.transforms.vectors import Vector3

scipy = pytest.importorskip("scipy.spatial.transform")
Rotation, Slerp = scipy.Rotation, scipy.Slerp

numbers = st.floats(-10, 10, allow_nan=False, allow_subnormal=False)
doubles = numbers.map(float)
points = st.builds(Vector3, numbers, numbers, numbers)
units = st.builds(Quaternion, numbers, numbers, numbers, numbers).filter(lambda q: math.hypot(*q) > 0.1).map(quaternions.normalize)
transforms = st.builds(Transform, points, units)
ours = settings(deadline=None)


def rotation(q):
    return Rotation.from_quat(list(q))


def same(q, theirs, tolerance=1e-9):
    """Whether ``q`` and the rotation ``theirs`` turn alike: q and -q do."""
    them = theirs.as_quat()
    return min(max(abs(a - b) for a, b in zip(q, them)), max(abs(a + b) for a, b in zip(q, them))) < tolerance


def near(a, b, tolerance=1e-9):
    return all(abs(p - q) <= tolerance for p, q in zip(a, b, strict=True))


@ours
@given(units, units, points)
def test_products_inverses_and_rotated_vectors(a, b, v):
    assert same(quaternions.q_star(a, b), rotation(a) * rotation(b))
    assert same(quaternions.q_inv(a), rotation(a).inv())
    assert near(quaternions.rotate(a, v), rotation(a).apply(list(v)))


@ours
@given(points, doubles)
def test_an_axis_and_an_angle(axis, angle):
    length = math.hypot(*axis)
    assume(length > 1e-3)
    q = quaternions.axis_angle_to_quaternion(axis, angle)
    assert same(q, Rotation.from_rotvec([component / length * angle for component in axis]))
    vector_part, turned = quaternions.quaternion_to_axis_angle(q)
    half = math.hypot(*vector_part)
    if half > 1e-3:
        assert same(q, Rotation.from_rotvec([component / half * turned for component in vector_part]))


@ours
@given(doubles, doubles, doubles)
def test_roll_pitch_and_yaw(roll, pitch, yaw):
    q = quaternions.euler_to_quaternion(ax=roll, ay=pitch, az=yaw)
    assert same(q, Rotation.from_euler("xyz", [roll, pitch, yaw]))
    back = quaternions.quaternion_to_euler(q, just_values=True)
    assert same(q, Rotation.from_euler("xyz", list(back)), 1e-2)
    if abs(abs(back.cdr.car) - math.pi / 2) > 1e-2:
        for angle, theirs in zip((*back, quaternions.get_yaw(q)), (*rotation(q).as_euler("xyz"), rotation(q).as_euler("xyz")[2])):
            assert abs(math.remainder(angle - theirs, 2 * math.pi)) < 1e-6  # pi and -pi are the same angle


@ours
@given(units)
def test_matrices(q):
    matrix = rotation(q).as_matrix()
    assert near(matrices.quaternion_to_matrix(q).active(), matrix.flatten())
    assert same(matrices.matrix_to_quaternion(LispArray((3, 3), [float(item) for item in matrix.flatten()])), rotation(q), 1e-7)
    assert same(matrices.column_vectors_to_quaternion(*(Vector3(*column) for column in matrix.T)), rotation(q), 1e-7)


@ours
@given(transforms, transforms, points)
def test_transforms_are_matrices(a, b, p):
    import numpy

    def matrix(transform):
        return numpy.array(matrices.transform_to_matrix(transform).active(), float).reshape(4, 4)

    assert near(matrices.transform_to_matrix(poses.transform_star(a, b)).active(), (matrix(a) @ matrix(b)).flatten(), 1e-8)
    assert near(poses.transform_point(a, p), (matrix(a) @ [*p, 1])[:3], 1e-8)
    assert near(matrices.transform_to_matrix(poses.transform_inv(a)).active(), numpy.linalg.inv(matrix(a)).flatten(), 1e-8)
    assert near(
        matrices.transform_to_matrix(poses.transform_diff(a, b)).active(), (matrix(a) @ numpy.linalg.inv(matrix(b))).flatten(), 1e-8
    )


@ours
@given(units, units, st.floats(0, 1).map(float))
def test_spherical_interpolation_takes_the_shorter_way(a, b, ratio):
    assume(1e-4 < (rotation(a).inv() * rotation(b)).magnitude() < math.pi - 1e-3)
    assert same(quaternions.slerp(a, b, ratio), Slerp([0, 1], Rotation.concatenate([rotation(a), rotation(b)]))([ratio])[0], 1e-7)


@ours
@given(points, points, numbers.map(float))
def test_vectors(a, b, ratio):
    import numpy

    p, q = numpy.array(list(a)), numpy.array(list(b))
    assert near(vectors.cross_product(a, b), numpy.cross(p, q))
    assert math.isclose(vectors.dot_product(a, b), p @ q, abs_tol=1e-9)
    assert math.isclose(vectors.v_dist(a, b), numpy.linalg.norm(p - q), abs_tol=1e-9)
    assert near(vectors.interpolate_vector(a, b, ratio), p + ratio * (q - p), 1e-8)
