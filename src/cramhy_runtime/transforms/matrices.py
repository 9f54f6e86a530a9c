"""Rotations and transforms as matrices: two-dimensional Lisp arrays, row by row. Source: cl-transforms.md 4.4."""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.arrays import LispArray, SimpleArray
from cramhy_runtime.lisp_core.floats import ZERO
from cramhy_runtime.lisp_core.conditions import error

from .coercion import instance, real, wrong_type
from .poses import Pose, Transform, make_transform, pose_to_transform
from .quaternions import Quaternion, general, quaternion
from .vectors import Vector3, normalize_vector, point


def _matrix(rows):
    return SimpleArray((len(rows), len(rows[0]) if rows else 0), [item for row in rows for item in row])


def _rows(matrix):
    """The rows of a Lisp matrix."""
    if not isinstance(matrix, LispArray) or len(matrix.dimensions) != 2:
        return wrong_type(matrix, "(ARRAY * (* *))", "MATRIX")
    items, width = matrix.active(), matrix.dimensions[1]
    return [items[start : start + width] for start in range(0, len(items), width or 1)]


def _square(matrix, size, at_least=False):
    rows = _rows(matrix)
    height, width = matrix.dimensions
    if (height, width) == (size, size) or at_least and min(height, width) >= size:
        return rows
    return error(
        "The assertion (EQUAL (ARRAY-DIMENSIONS CL-TRANSFORMS::MATRIX) '(~D ~D)) failed: the matrix is ~D by ~D.", size, size, height, width
    )


def _rotation_rows(components):
    x, y, z, w = components
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]


def quaternion_to_matrix(q):
    """The 3 by 3 rotation matrix."""
    instance(q, Quaternion, "Q")
    return _matrix([list(row) for row in _rotation_rows(q._components)])


def matrix_to_quaternion(matrix):
    """The rotation of a matrix, whose first 3 by 3 elements are taken to be orthonormal."""
    return _quaternion_of([[real(item) for item in row[:3]] for row in _square(matrix, 3, at_least=True)[:3]])


def _quaternion_of(rows):
    trace = rows[0][0] + rows[1][1] + rows[2][2] + 1
    if trace > 1e-6:
        s = 0.5 / math.sqrt(trace)
        return quaternion(((rows[2][1] - rows[1][2]) * s, (rows[0][2] - rows[2][0]) * s, (rows[1][0] - rows[0][1]) * s, 0.25 / s))
    i = max(range(3), key=lambda index: rows[index][index])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2 * math.sqrt(1 + rows[i][i] - rows[j][j] - rows[k][k])
    components = [0.0, 0.0, 0.0, (rows[k][j] - rows[j][k]) / s]
    components[i] = 0.25 * s
    components[j], components[k] = (rows[j][i] + rows[i][j]) / s, (rows[k][i] + rows[i][k]) / s
    return quaternion(tuple(components))


def transform_to_matrix(transform):
    """The 4 by 4 matrix; its last row is three singles and an integer, as in the original."""
    instance(transform, Transform, "TRANSFORM")
    rows = [[*row, moved] for row, moved in zip(_rotation_rows(general(transform.rotation)), point(transform.translation))]
    return _matrix([*rows, [ZERO, ZERO, ZERO, 1]])


def pose_to_matrix(pose):
    """The 4 by 4 matrix of a pose."""
    instance(pose, Pose, "POSE")
    return transform_to_matrix(pose_to_transform(pose))


def matrix_to_transform(matrix):
    """The transform of a 4 by 4 matrix."""
    rows = _square(matrix, 4)
    return make_transform(Vector3(*(real(row[3]) for row in rows[:3])), matrix_to_quaternion(matrix))


def transpose_2d_matrix(matrix):
    """A new matrix with rows and columns exchanged."""
    return _matrix([list(column) for column in zip(*_rows(matrix))])


def transpose_rot_matrix(matrix):
    """The transpose of a 3 by 3 matrix."""
    _square(matrix, 3)
    return transpose_2d_matrix(matrix)


invert_rot_matrix = transpose_rot_matrix


def column_vectors_to_quaternion(x, y, z):
    """The rotation whose matrix has the directions of three vectors as its columns."""
    columns = [normalize_vector(instance(v, Vector3, name))._components for v, name in ((x, "X"), (y, "Y"), (z, "Z"))]
    return _quaternion_of(list(zip(*columns)))
