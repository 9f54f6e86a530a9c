"""Matrices of Lisp and arrays of numpy, each made of the other."""

from __future__ import annotations

from typing import Any

from cramhy_runtime.lisp_core.arrays import LispArray, SimpleArray
from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Cons, python_list
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.robot_world.costmaps.arrays import np
from cramhy_runtime.transforms.vectors import Vector3

DOUBLE = sym("DOUBLE-FLOAT")


def lisp_matrix(array: Any) -> LispArray:
    """The Lisp matrix of double-floats with the elements of ``array``."""
    return SimpleArray(array.shape, [float(value) for value in array.ravel().tolist()], DOUBLE)


def numpy_matrix(matrix: Any) -> Any:
    """The numpy array of a Lisp matrix, or of a list of rows. Anything else, or an element that is not a real, is a type error."""
    if isinstance(matrix, np.ndarray):
        return matrix
    if isinstance(matrix, LispArray) and len(matrix.dimensions) == 2:
        return _floats(matrix.active()).reshape(matrix.dimensions)
    if isinstance(matrix, Cons):
        rows = [_floats(python_list(row)) if isinstance(row, Cons) else type_error(row, "LIST") for row in python_list(matrix)]
        if len({len(row) for row in rows}) == 1:
            return np.array(rows)
    return type_error(matrix, "(ARRAY T (* *))")


def numpy_vector(value: Any) -> Any:
    """The numpy array of a 3d-vector, a list or a Lisp vector; of something with an origin (a pose) that of its place."""
    value = getattr(value, "origin", value)
    if isinstance(value, Vector3):
        return np.array(value.components)
    if isinstance(value, Cons):
        return _floats(python_list(value))
    if isinstance(value, (list, LispArray)):
        elements = value if isinstance(value, list) else value.active()
        return _floats(elements)
    return type_error(value, sym("CL-TRANSFORMS::POINT"))


def _floats(elements: list[Any]) -> Any:
    return np.array([float(element) if is_real(element) else type_error(element, "REAL") for element in elements])
