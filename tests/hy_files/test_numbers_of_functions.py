"""The numbers that public functions give in Python and Hy are Python's own: ``float`` and ``int``, never single-floats of Lisp."""

import csv
import importlib
import inspect
import io
import json
from pathlib import Path

import hy
import numpy
import pytest

import cramhy
from cramhy_runtime import cpl
from cramhy_runtime.designators import Motion
from cramhy_runtime.lisp_core.classes import make_instance
from cramhy_runtime.lisp_core.data import Cons, lisp_list
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.ros import python as ros
from cramhy_runtime.ros.python import message_class, ros_node

try:
    import pandas
except ImportError:  # no dependency of ours; where it is installed, its tables are compared as well
    pandas = None

MODULES = [cramhy, *map(importlib.import_module, [
    "cramhy_runtime.cpl", "cramhy_runtime.prolog", "cramhy_runtime.designators", "cramhy_runtime.process_modules", "cramhy_runtime.occasions",
    "cramhy_runtime.ros.python", "cramhy_runtime.actionlib.python", "cramhy_runtime.projection.python", "cramhy_runtime.testing",
    "cramhy_runtime.robot", "cramhy_runtime.episodes",
])]  # fmt: skip
WITHOUT_NUMBERS = Path(__file__).with_name("functions_without_numbers.txt")


def names_of(module):
    """The public names of ``module`` that are functions, as Hy writes them."""
    names = getattr(module, "__all__", None) or [name for name in vars(module) if not name.startswith("_")]
    found = [(name, getattr(module, name)) for name in [*names, *("xyzw" if module is cramhy else "")]]
    return {
        hy.unmangle(name)
        for name, thing in found
        if callable(thing) and not inspect.isclass(thing) and str(getattr(thing, "__module__", "cramhy")).startswith("cramhy")
    }


VECTOR = cramhy.make_3d_vector(1, 2.5, 3)
QUATERNION = cramhy.make_quaternion(0, 0, 0, 1)
TURNED = hy.eval(hy.read("(cramhy.euler->quaternion :az 0.5)"), {"cramhy": cramhy})
POSE = cramhy.make_pose(VECTOR, TURNED)
TRANSFORM = cramhy.make_transform(VECTOR, TURNED)
TWIST, WRENCH = cramhy.make_twist(VECTOR, VECTOR), cramhy.make_wrench(VECTOR, VECTOR)
MATRIX = cramhy._functions["hyx_quaternion_XgreaterHthan_signXmatrix"](TURNED)
POINT = cramhy.make_quad_tree_point(x=1.5, y=2)
BARRIER = cramhy.make_synchronization_barrier(3)
EVENT = make_instance(sym("CRAM-OCCASIONS-EVENTS:EVENT"))

CALLS = {
    "value": [(2.5,), (cpl.make_fluent(value=2.5),), (cpl.make_fluent(value=2.5) + 1,)],
    "peek-value": [(cpl.make_fluent(value=2.5),)],
    "fl-and": [(1, 2.5)],
    "fl-or": [(2.5, 1)],
    "fl-funcall": [(lambda x: x * 2, 1.25)],
    "+": [(1, 2.5), (0.1, 0.2), ()],
    "-": [(1, 2.5), (0.1,)],
    "*": [(3, 0.1), ()],
    "/": [(1, 0.3), (0.1, 3)],
    "semaphore-count": [(cramhy.make_semaphore(),)],
    "queue-count": [(cramhy.make_queue(),)],
    "mailbox-count": [(cramhy.make_mailbox(),)],
    "increment-barrier-threshold": [(BARRIER,)],
    "decrement-barrier-threshold": [(BARRIER,)],
    "lazy-car": [(lisp_list(2.5, 1),)],
    "lazy-cdr": [(lisp_list(1, 2.5),)],
    "lazy-elt": [(lisp_list(1, 2.5), 1)],
    "force-ll": [(lisp_list(1, 2.5),)],
    "lazy-append": [(lisp_list(2.5), lisp_list(1))],
    "lazy-take": [(1, lisp_list(2.5, 1))],
    "lazy-skip": [(1, lisp_list(1, 2.5))],
    "lazy-flatten": [(lisp_list(lisp_list(2.5), lisp_list(1)),)],
    "lazy-rests": [(lisp_list(2.5),)],
    "copy-lazy-list": [(lisp_list(2.5),)],
    "force": [(2.5,)],
    "var-value": [(sym("?X"), lisp_list(Cons(sym("?X"), 2.5)))],
    "add-bdg": [(sym("?X"), 2.5, None)],
    "pat-match": [(sym("?X"), 2.5)],
    "unify": [(sym("?X"), 2.5)],
    "prolog": [(lisp_list(sym("CRAM-PROLOG::MEMBER"), sym("?X"), lisp_list(2.5)),)],
    "random-with-minimum": [(2.5, 1.5), (5, 1)],
    "copy-object": [(2.5,), (VECTOR,)],
    "current-timestamp": [()],
    "microsecond-timestamp-function": [lambda function: function()()],
    "minimum": [(lisp_list(2.5, 3.5),)],
    "maximum": [(lisp_list(2.5, 1),)],
    "equalize-two-list-lengths": [(lisp_list(2.5), lisp_list(1, 2))],
    "equalize-lists-of-lists-lengths": [(lisp_list(lisp_list(2.5)), lisp_list(lisp_list(1)))],
    "object-id": [(2.5,)],
    "alpha-network-size": [()],
    "desig-prop-value": [(Motion(speed=2.5), sym("KEYWORD:SPEED"))],
    "desig-prop-values": [(Motion(speed=2.5), sym("KEYWORD:SPEED"))],
    "symbol-codes": [("visualization_msgs/Marker",)],
    "symbol-code": [("visualization_msgs/Marker", sym("KEYWORD:CUBE"))],
    "debug-level": [("driver",)],
    "num-subscribers": [lambda function: function(ros.advertise("number", "std_msgs/Float64"))],
    "publish": [("speed", message_class("std_msgs/Float64")(data=2.5))],
    "unadvertise": [("speed",)],
    "get-param": [("number",), ("whole",), ("list",), ("tree",), ("missing", 2.5)],
    "set-param": [("number", 2.5)],
    "delete-param": [lambda function: (ros.set_param("spare", 1), function("spare"))[1]],
    "ros-time": [()],
    "msg-slot-value": [(message_class("geometry_msgs/Point")(x=2.5), sym("GEOMETRY_MSGS-MSG:X"))],
    "now": [()],
    "event-timestamp": [(EVENT,)],
    "episode-knowledge-zero-time": [()],
    "episode-knowledge-max-time": [()],
    "durable-copy": [(2.5,), ([2.5],)],
    "make-3d-vector": [(1.0, 2.5, 3.0)],
    **{name: [(VECTOR,)] for name in ("copy-3d-vector", "x", "y", "z", "v-inv", "v-norm", "normalize-vector", "v-")},
    **{name: [(VECTOR, VECTOR)] for name in ("dot-product", "cross-product", "v-dist", "v+", "v*-pairwise", "v/-pairwise")},
    **{name: [()] for name in ("make-identity-vector", "make-identity-rotation", "make-identity-transform", "make-identity-pose")},
    **{name: [()] for name in ("make-identity-twist", "make-identity-wrench", "euler->quaternion")},
    "interpolate-vector": [(VECTOR, VECTOR, 0.5)],
    "v*": [(VECTOR, 2.5), (VECTOR, 2)],
    "make-quaternion": [(0.0, 0.0, 0.0, 1.0)],
    **{name: [(QUATERNION,), (TURNED,)] for name in "copy-quaternion w q-inv squared-norm q-norm normalize quaternion->axis-angle".split()},
    **{name: [(QUATERNION,), (TURNED,)] for name in "quaternion->euler get-yaw q- quaternion->matrix".split()},
    "yaw": [(0.5,)],
    **{name: [(QUATERNION, TURNED)] for name in "q-dot angle-between-quaternions".split()},
    **{name: [(QUATERNION, TURNED), ()] for name in ("q*", "q+")},
    "q-scale": [(TURNED, 2.5)],
    "axis-angle->quaternion": [(VECTOR, 0.5)],
    "rotate": [(TURNED, VECTOR)],
    "normalize-angle": [(7.5,), (7,)],
    "slerp": [(QUATERNION, TURNED, 0.5)],
    "make-transform": [(VECTOR, TURNED)],
    **{name: [(TRANSFORM,)] for name in "copy-transform transform-inv translation rotation transform->pose transform->matrix".split()},
    **{name: [(TRANSFORM, TRANSFORM)] for name in ("transform-diff", "transform*")},
    "transform-point": [(TRANSFORM, VECTOR)],
    "transform": [(TRANSFORM, VECTOR), (TRANSFORM, POSE)],
    "transform-pose": [(TRANSFORM, POSE)],
    "make-pose": [(VECTOR, TURNED)],
    "make-2d-pose": [(1, 2.5, 0.5)],
    **{name: [(POSE,)] for name in "copy-pose reference-transform pose->transform origin orientation pose->matrix".split()},
    "make-twist": [(VECTOR, VECTOR)],
    "copy-twist": [(TWIST,)],
    "make-wrench": [(VECTOR, VECTOR)],
    "copy-wrench": [(WRENCH,)],
    "matrix->quaternion": [(MATRIX,)],
    "matrix->transform": [(cramhy._functions["hyx_transform_XgreaterHthan_signXmatrix"](TRANSFORM),)],
    "invert-rot-matrix": [(MATRIX,)],
    "transpose-rot-matrix": [(MATRIX,)],
    "transpose-2d-matrix": [(MATRIX,)],
    "column-vectors->quaternion": [tuple(cramhy.make_3d_vector(*axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))],
    "quad-tree-point-x": [(POINT,)],
    "quad-tree-point-y": [(POINT,)],
}
"""The arguments with which each function is called, or what calls it."""
LITERALS = {"transform->matrix", "pose->matrix", "q*", "q+"}
"""Functions that give numbers which the original has in its text, ``0.0`` and ``1.0``: a matrix in its last row, a product of nothing."""


PARAMETERS = {"number": 2.5, "whole": 3, "list": [2.5, 1], "tree": {"a": 2.5, "b": {"c": [0.1]}}}


def numbers_in(value, depth=0):
    """All numbers in what a function gave."""
    if isinstance(value, (int, float, complex)) and not isinstance(value, bool):
        yield value
    elif depth > 6 or value is None or isinstance(value, (str, bool)):
        return
    elif isinstance(value, Cons):
        yield from numbers_in(value.car, depth + 1)
        yield from numbers_in(value.cdr, depth + 1)
    elif isinstance(value, dict):
        for each in value.values():
            yield from numbers_in(each, depth + 1)
    elif hasattr(value, "components"):
        yield from (getattr(value, name) for name in "xyzw" if hasattr(value, name))
    elif hasattr(value, "tolist"):
        yield from numbers_in(value.tolist(), depth + 1)
    elif isinstance(value, (list, tuple)) or hasattr(value, "storage"):
        for each in getattr(value, "storage", value):
            yield from numbers_in(each, depth + 1)
    else:
        for name in ("origin", "orientation", "translation", "rotation", "linear", "angular", "force", "torque"):
            if hasattr(value, name):
                yield from numbers_in(getattr(value, name), depth + 1)


def functions():
    found = {}
    for module in MODULES:
        for name in names_of(module):
            found.setdefault(name, []).append(getattr(module, hy.mangle(name)))
    return found


def without_numbers():
    text = WITHOUT_NUMBERS.read_text(encoding="utf-8")
    return {name for line in text.splitlines() if line and line[0] not in "#[" for name in line.split()}


def called():
    """(name, what it gave) for each function and each of its calls, with a node and the parameters that some ask for."""
    for name, calls in CALLS.items():
        for function in functions()[name]:
            for each in calls:
                yield name, each(function) if callable(each) else function(*each)


def as_texts(number):
    """``number`` in all ways in which programs write numbers into files."""
    stream = io.StringIO()
    csv.writer(stream).writerow([number])
    texts = [str(number), repr(number), f"{number}", stream.getvalue().strip(), json.dumps(number), str(numpy.array([number]).tolist()[0])]
    if pandas is not None:
        frame = pandas.DataFrame({"number": [number]})
        texts += [str(frame["number"].tolist()[0]), frame.to_csv(index=False, header=False).strip()]
    return texts


@pytest.fixture
def node():
    with cpl.plan(clock="virtual"), ros_node("driver"):
        ros.advertise("speed", "std_msgs/Float64")
        for name, value in PARAMETERS.items():
            ros.set_param(name, value)
        yield


def test_each_public_function_is_called_or_gives_no_numbers():
    known = {*CALLS, *without_numbers()}
    assert sorted(set(functions()) - known) == [], "call it in CALLS, or name it in functions_without_numbers.txt below the reason"
    assert sorted(known - set(functions())) == []
    assert sorted(set(CALLS) & without_numbers()) == []


@pytest.mark.soak
def test_functions_give_numbers_of_python(node):
    silent, others = set(CALLS), []
    for name, value in called():
        for number in numbers_in(value):
            silent.discard(name)
            if name in LITERALS and number in (0, 1):
                assert isinstance(number, (int, float))
            elif type(number) not in (int, float):
                others.append((name, type(number).__name__))
            assert set(as_texts(number)) == {repr(int(number) if isinstance(number, int) else float(number))}, name
    assert others == [] and silent == set()
