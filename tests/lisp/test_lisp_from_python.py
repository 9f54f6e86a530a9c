"""Lisp from Python: what a program in Python sees of functions, classes, structures, conditions and lists (docs/python.md)."""

from __future__ import annotations

import importlib
import inspect
import re
import sys
from pathlib import Path

import pytest

from cramhy_runtime.lisp_core.conditions import Condition, TypeError_
from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import delete_package, find_package, keyword
from cramhy_runtime.languages.commonlisp.systems import importer

PAGE = Path(__file__).parents[2] / "docs" / "python.md"
FURTHER = """
(defclass base () ((id :initarg :id :initform 7)))
(defclass kid (base) ((name :initarg :name) (tags :initarg :tags :initform nil)) (:default-initargs :name "K"))
(defmethod initialize-instance :after ((kid kid) &key) (push :made (slot-value kid 'tags)))
(defun optional (a &optional (b (+ 1 1)) c) (list a b c))
(defun many (a &rest more) (list a more))
(defun text () (make-string 3 :initial-element #\\a))
(defun divide (a b) (/ a b))
(defun key () :some-key)
(defun apply-it (f) (funcall f 1))
(defun two () (values 1 2))
(defgeneric pace (robot &key factor) (:documentation "How fast."))
(defmethod pace (robot &key (factor 1)) (* 3 factor))
(defvar *top-speed* 3 "The top speed.")
"""


@pytest.fixture
def robots(session, tmp_path, monkeypatch):
    """The module of the page's Lisp package, with some definitions more."""
    definitions = re.search(r"```lisp\n(\(defpackage :robots.*?)```", PAGE.read_text(), re.S)[1]
    (tmp_path / "robots.lisp").write_text(definitions + FURTHER)
    monkeypatch.syspath_prepend(str(tmp_path))
    importer.install()
    yield importlib.import_module("robots")
    sys.modules.pop("robots", None)
    delete_package(find_package("ROBOTS"))


def test_the_example_of_the_page(robots):
    exec(re.search(r"```python\n(.*?)```", PAGE.read_text(), re.S)[1], {})


def test_functions_show_their_parameters(robots):
    assert str(inspect.signature(robots.area)) == "(width, *, height=2)"
    assert str(inspect.signature(robots.optional)) == "(a, b=(+ 1 1), c=NIL)"
    assert str(inspect.signature(robots.many)) == "(a, /, *more)"
    assert str(inspect.signature(robots.pace)) == "(robot, *, factor=NIL)"
    assert robots.pace.__doc__ == "How fast." and robots.pace(1, factor=2) == 6


def test_optional_parameters_may_be_left_out_or_named(robots):
    assert list(robots.optional(1)) == [1, 2, None]
    assert list(robots.optional(1, c=5)) == [1, 2, 5]
    assert list(robots.many(1, 2, 3)[1]) == [2, 3]
    assert tuple(robots.two()) == (1, 2)
    assert robots.apply_it(lambda n: n + 1) == 2


def test_instances_have_slots_as_attributes_and_initforms(robots):
    kid = robots.Kid(id=8)
    assert (kid.id, kid.name, list(kid.tags)) == (8, "K", [keyword("MADE")])
    assert isinstance(kid, robots.Base) and re.fullmatch(r"#<(ROBOTS::)?KID \{[0-9A-F]+\}>", repr(kid))
    kid.name = "new"
    assert kid.name == "new"
    with pytest.raises(Condition) as caught:
        robots.Kid(nam="x")
    assert "Invalid initialization argument:\n  :NAM" in str(caught.value)
    with pytest.raises(AttributeError):
        kid.no_such_slot


def test_a_python_subclass_takes_part(robots):
    class Loud(robots.Kid):
        def __init__(self, volume, **initargs):
            super().__init__(**initargs)
            self.volume = volume

        def name_twice(self):
            return self.name * 2

    loud = Loud(5, name="ab")
    assert (loud.volume, loud.name_twice(), loud.id, list(loud.tags)) == (5, "abab", 7, [keyword("MADE")])
    assert robots.pace(loud) == 3


def test_structures(robots):
    pose = robots.Pose(x=1)
    pose.y = 5
    assert (robots.pose_x(pose), robots.pose_y(pose)) == (1, 5)
    assert robots.make_pose(x=3).x == 3
    with pytest.raises(AttributeError):
        pose.z = 1
    with pytest.raises(Condition):
        robots.Pose(z=1)


def test_conditions_are_exceptions(robots):
    with pytest.raises(robots.LowBattery) as caught:
        robots.check(3)
    assert caught.value.level == 3 and isinstance(caught.value, Exception)
    with pytest.raises(robots.LowBattery):
        raise robots.LowBattery(level=1)
    with pytest.raises(ZeroDivisionError):
        robots.divide(1, 0)
    with pytest.raises(ArithmeticError):
        robots.divide(1, 0)
    with pytest.raises(TypeError_):
        robots.divide(1, "a")


def test_lists_behave_as_sequences():
    numbers = lisp_list(1, 2, 3)
    assert (len(numbers), numbers[0], numbers[-1], numbers[1:], 2 in numbers, bool(numbers)) == (3, 1, 3, [2, 3], True, True)
    assert list(numbers) == [1, 2, 3] and sum(numbers) == 6 and sorted(numbers, reverse=True) == [3, 2, 1]
    with pytest.raises(IndexError):
        numbers[3]
    assert len(Cons(1, 2)) == 1 and bool(list_from([None]))


def test_texts_and_keywords(robots):
    text = robots.text()
    assert text == "aaa" and f"{text}!" == "aaa!" and text[0] == "a" and "a" in text and list(text) == ["a"] * 3
    assert robots.key() is keyword("SOME-KEY") and repr(robots.key()) == ":SOME-KEY"


@pytest.mark.soak
def test_variables_and_the_directory(robots):
    assert robots.top_speed == 3
    robots.top_speed = 4
    assert robots.top_speed == 4
    names = dir(robots)
    assert {"area", "top_speed", "Kid", "Pose", "LowBattery", "pace"} <= set(names) and "width" not in names
    with pytest.raises(AttributeError, match="defines no function or variable for the Python name 'NoSuchClass'"):
        robots.NoSuchClass
