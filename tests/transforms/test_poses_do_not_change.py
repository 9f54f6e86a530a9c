"""Vectors, quaternions, poses and transforms compare by value in Python, so nothing of them is assigned there. Lisp's `slot-value` can."""

import copy
import pickle

import pytest

from cramhy_runtime.tf.stamped import PointStamped, PoseStamped, TransformStamped, VectorStamped
from cramhy_runtime.transforms.poses import Pose, Transform, Twist, Wrench
from cramhy_runtime.transforms.quaternions import Quaternion
from cramhy_runtime.transforms.vectors import Vector3

MADE = {cls.__name__: cls for cls in (Vector3, Quaternion, Pose, Transform, Twist, Wrench)}
MADE |= {cls.__name__: lambda cls=cls: cls("map", 1.0) for cls in (PointStamped, PoseStamped, VectorStamped)}
MADE["TransformStamped"] = lambda: TransformStamped("map", "base", 1.0)
COPIES = {"Pose": "copy_pose(pose, origin=...)", "Vector3": "copy_3d_vector(v, x=5)", "Twist": "copy_twist(twist, translation=...)"}
WITHOUT_COPY = ("PointStamped", "TransformStamped", "VectorStamped")


def parts(made):
    return [name for name in dir(type(made)) if hasattr(getattr(type(made), name), "set_by_lisp")]


@pytest.mark.parametrize("kind", MADE)
def test_no_part_is_assigned(kind):
    made = MADE[kind]()
    before = hash(made)
    assert len(parts(made)) >= 2
    for name in parts(made):
        with pytest.raises(AttributeError) as problem:
            setattr(made, name, getattr(made, name))
        told = str(problem.value)
        assert told.startswith(f"A {kind} is not changed after it was made. Make a new one: {kind}(...)")
        assert told.endswith("(...).") if kind in WITHOUT_COPY else COPIES.get(kind, "copy_") in told
    assert hash(made) == before and made == MADE[kind]() == copy.deepcopy(made) == pickle.loads(pickle.dumps(made))


@pytest.mark.parametrize("kind", MADE)
def test_classes_of_users_are_theirs(kind):
    made = MADE[kind]()
    derived = type("Own", (type(made),), {"__module__": "own"})
    own = derived.__new__(derived)
    vars(own).update(vars(made))
    for name in parts(made):
        setattr(own, name, getattr(made, name))
        assert getattr(own, name) == getattr(made, name)


def test_lisp_can(lisp):
    changed = "(let ((p (make-pose *x* (make-identity-rotation)))) (setf (slot-value p 'origin) *y*) (y (origin p)))"
    assert lisp(changed) == "1.0d0"
