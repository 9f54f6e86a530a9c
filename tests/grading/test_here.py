"""Without processes, as in a browser, a submission gets the same points."""

from __future__ import annotations

import subprocess
import sys

import pytest
from systems import needs_processes

from cramhy_runtime.grading import Grader
from cramhy_runtime.grading.exercise import find

from .submissions import cases

NAMES = [
    "solution of first-lisp",
    "solution of dry-pen",
    "start of dry-pen",
    "broken",
    "quit in the plan",
    "prints that it is right",
    "teleports",
]


@pytest.fixture(scope="module")
def grader():
    with Grader(apart=False) as made:
        yield made


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("case", [case for case in cases() if case.name in NAMES], ids=lambda case: case.name)
def test_the_points_are_the_same(case, grader):
    exercise = find(case.exercise)
    report = grader.grade_texts(exercise, case.texts)
    assert report.points == (exercise.points if case.points is None else case.points), report.text()
    assert case.words in report.text() and report.held == []


IN_A_TAB = """
from cramhy_runtime.browser import left_out
left_out.install()
from cramhy_runtime.grading import Grader
from cramhy_runtime.grading.exercise import find
with Grader(apart=False) as grader:
    print(grader.grade_texts(find("first-lisp"), {"first-lisp.lisp": "(in-package :tut) (defun distance (x1 y1 x2 y2) 5)"}).points)
"""


@pytest.mark.soak
@needs_processes
def test_nothing_is_asked_for_that_a_tab_does_not_have():
    done = subprocess.run([sys.executable, "-c", IN_A_TAB], capture_output=True, text=True)
    assert done.stdout == "0\n", done.stderr
