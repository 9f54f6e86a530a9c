"""Vectors, rotations and poses in Python: they compare by value, can be keys, and vectors are not changed."""

import copy
import pickle

import pytest

from cramhy_runtime.lisp_core.condition_types import TypeError_
from cramhy_runtime.lisp_core.equality import eql, equal
from cramhy_runtime.tf.stamped import PointStamped, PoseStamped
from cramhy_runtime.transforms.poses import Pose, Transform
from cramhy_runtime.transforms.quaternions import Quaternion
from cramhy_runtime.transforms.vectors import Vector3, copy_3d_vector, make_3d_vector

MAKERS = {
    "vector": lambda x: Vector3(x, 2, 3),
    "quaternion": lambda x: Quaternion(0, 0, x, 0),
    "pose": lambda x: Pose(Vector3(x, 2, 3)),
    "transform": lambda x: Transform(Vector3(x, 2, 3)),
    "point": lambda x: PointStamped("map", 0.0, x, 2.0, 3.0),
    "pose in a frame": lambda x: PoseStamped("map", 0.0, Vector3(x, 2, 3)),
}


@pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS)
def test_equal_values_are_equal(make):
    one, other, different = make(1.0), make(1.0), make(5.0)
    assert one == other and not one != other and one != different and one != 3
    assert len({one, other, different}) == 2 and other in [one]
    for copied in (copy.copy(one), copy.deepcopy(one), pickle.loads(pickle.dumps(one))):
        assert copied == one and type(copied) is type(one)
    assert eql(one, other) is None and equal(one, other) is None  # Lisp's objects are equal to themselves only


@pytest.mark.parametrize("make", [Vector3, Quaternion, lambda *c: PointStamped("map", 0.0, *c)])
@pytest.mark.parametrize("name", "xyz")
def test_a_component_cannot_be_assigned(make, name):
    made = make(1.0, 2.0, 3.0)
    with pytest.raises(AttributeError, match="is not changed after it was made. Make a new one"):
        setattr(made, name, 5.0)
    assert tuple(made)[:3] == (1.0, 2.0, 3.0)


def test_a_copy_may_differ():
    assert copy_3d_vector(Vector3(1, 2, 3), x=5) == Vector3(5, 2, 3)


def test_lisp_can_change_a_slot(lisp):
    assert lisp("(let ((v (cl-transforms:make-3d-vector 1 2 3))) (setf (slot-value v 'cl-transforms:x) 5) (cl-transforms:x v))") == "5.0d0"


@pytest.mark.parametrize("number", ["float32", "float64", "int64", "uint8"])
def test_numbers_of_numpy_are_components(number):
    numpy = pytest.importorskip("numpy")
    made = make_3d_vector(*numpy.array([1, 2, 3], number))
    assert made == make_3d_vector(1, 2, 3) and [type(part) for part in made.components] == [float] * 3
    with pytest.raises(TypeError_, match="REAL"):
        make_3d_vector(True, 2, 3)
