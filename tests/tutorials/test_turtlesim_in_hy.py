"""The course's plans in plain Hy beside those in Common Lisp: the same paper, the same definitions, the same errors; and its picture.

What single functions do is asked in both languages by the other files of this folder.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys

import pytest

from cramhy_runtime.lisp_core.conditions import Condition

from . import course
from .course import FOLDER, environment

IN_LISP, IN_HY = FOLDER / "cram_my_beginner_tutorial", FOLDER / "turtlesim_in_hy"
FILES = sorted(path.stem for path in (IN_LISP / "src").glob("*.hy") if path.stem != "package")
SCENE = [
    "(drive 5 2)",
    "(sleep 1.5)",
    "(move-parallel)",
    "(sleep 1.5)",
    "(call-set-pen 255 0 0 10 0)",
    "(move-simple 2 9)",
    "(perform-draw-house)",
    "(top-level (with-process-modules-running (turtlesim-navigation turtlesim-pen-control) (navigate '(5 14 0))))",
    "(perform-some-motion (desig:a motion (type driving) (speed 1) (angle 1)))",
]


def in_both(act, backend="threads"):
    """What ``act`` gives with a turtle of each language: Common Lisp, Hy."""
    found = []
    for kind in (course.Course, course.CourseInHy):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(course, "KIND", kind)
            with course.image_of(kind), course.course(backend) as turtle:
                found.append(act(turtle))
    return found


@pytest.mark.soak
@pytest.mark.parametrize("backend", course.BACKENDS)
def test_both_draw_the_same_paper_by_as_many_commands(backend):
    """The literal 0.1 is a single-float in Lisp and a double-float in Hy, so the turtles are less than a millimetre apart."""

    def act(turtle):
        values = [turtle(form) for form in SCENE]
        paper = turtle.simulator.canvas.rgb()
        return [value for value in values if type(value) is int], len(turtle.commands), turtle.poses, paper

    (values, count, poses, paper), (hy_values, hy_count, hy_poses, hy_paper) = in_both(act, backend)
    assert (hy_values, hy_count, len(hy_poses)) == (values, count, len(poses)) and count > 100
    assert all(one == pytest.approx(other, abs=1e-3) for one, other in zip(poses, hy_poses))
    assert sum(one != other for one, other in zip(paper, hy_paper)) < 100  # bytes, of 750,000


def definitions(path):
    """The names that a file defines, in their order."""
    text = path.read_text()
    names = re.findall(r"^\((?:defun|defn|def-process-module|def-fact-group|def-cram-function) (\S+)", text, re.M)
    return [name for name in names if name not in ("goal-vector", "word")]  # what only Hy needs


@pytest.mark.parametrize("name", FILES)
def test_each_file_stands_beside_its_like(name):
    lisp, there = IN_LISP / "src" / f"{name}.hy", IN_HY / f"{name.replace('-', '_')}.hy"
    assert definitions(there) == definitions(lisp)
    assert re.findall(r"^ *;; .*", lisp.read_text(), re.M) == re.findall(r"^ *;; .*", there.read_text(), re.M)


def error_of(form):
    def act(turtle):
        try:
            turtle(form)
        except (Condition, ValueError) as problem:
            return type(problem).__name__, str(problem).replace("#(", "(")  # a list of Python is a vector to Lisp

    return act


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "form",
    [
        "(perform-some-motion (desig:a motion (type flying)))",
        "(perform-some-motion (desig:an action (type flying)))",
        "(top-level (with-process-modules-running (turtlesim-pen-control) (navigate '(3 3 0))))",
        "(pm-execute 'turtlesim-navigation (desig:a motion (type driving) (speed 1)))",
        '(send-vel-cmd "fast" 1)',
        "(relative-angle-to (value *turtle-pose*) (value *turtle-pose*))",
        "(pose-msg->transform nil)",
        "(par 1 2)",
    ],
)
def test_the_same_mistakes_have_the_same_texts(form):
    in_lisp, in_hy = in_both(error_of(form))
    assert in_lisp is not None
    assert in_hy == in_lisp


@pytest.mark.soak
def test_lisp_and_python_call_functions_of_hy(tmp_path):
    program = """
import hy
from turtlesim_in_hy import high_level_plans
from turtlesim_in_hy.process_modules import init, move_simple
from turtlesim_in_hy.control_turtlesim import turtle_pose
from cramhy_runtime.repl.session import Session

session = Session(time="virtual")
init()
move_simple(2, 7)
print(round(turtle_pose.value.x), round(turtle_pose.value.y))
print(*session.evaluate_text('''
    (py:import "turtlesim_in_hy.process_modules" :as motions)
    (motions:move-simple 7 2)
    (motions:goto-location "left" "top")
    (cpl:top-level
      (cpm:with-process-modules-running (turtlesim-in-hy::turtlesim-navigation turtlesim-in-hy::turtlesim-pen-control)
        (turtlesim-in-hy::navigate '(5 3 0)))) '''))
print(round(turtle_pose.value.x), round(turtle_pose.value.y))
"""
    done = subprocess.run([sys.executable, "-c", program], cwd=FOLDER, env=environment(), capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    lines = done.stdout.splitlines()
    assert "2 7" in lines and lines[-1] == "5 3"


def hy(folder, *words):
    return subprocess.run(
        [sys.executable, "-m", *words], cwd=folder, env=outside(), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120
    )


def outside():
    """An environment in which the tutorials are not on Python's path."""
    found = environment()
    found["PYTHONPATH"] = found["PYTHONPATH"].replace(str(FOLDER), "")
    return {**found, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}


@pytest.fixture
def copied(tmp_path):
    """A folder into which a user has copied the package."""
    shutil.copytree(IN_HY, tmp_path / "turtlesim_in_hy", ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


@pytest.mark.soak
def test_hy_draws_the_paper_and_says_where_it_is(copied):
    first = hy(copied, "hy", "turtlesim_in_hy/draw.hy")
    assert first.returncode == 0, first.stderr
    assert first.stdout.splitlines()[-1] == f"The turtle's paper is in {copied / 'turtle.svg'}"
    assert "already processing input. Waiting for it to become free." in first.stderr
    again = hy(copied / "turtlesim_in_hy", "hy", "draw.hy", "again.svg")
    assert again.stdout.splitlines()[:-1] == first.stdout.splitlines()[:-1]
    picture = (copied / "turtle.svg").read_bytes()
    assert picture.startswith(b"<svg") and (copied / "turtlesim_in_hy" / "again.svg").read_bytes() == picture


@pytest.mark.soak
def test_a_picture_of_no_kind_is_refused_before_anything_is_drawn(copied):
    done = hy(copied, "hy", "turtlesim_in_hy/draw.hy", "turtle.txt")
    assert done.returncode == 1 and "What kind of picture is turtle.txt to be?" in done.stderr and "TurtleSim" not in done.stdout


@pytest.mark.soak
def test_pytest_runs_the_tests_of_the_package(copied):
    done = hy(copied, "pytest", "-v", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", ".")
    assert done.returncode == 0 and "3 passed" in done.stdout, done.stdout + done.stderr
    plans = copied / "turtlesim_in_hy" / "simple_plans.hy"
    plans.write_text(
        plans.read_text().replace("(atan2 seen-from-turtle.y seen-from-turtle.x)", "(atan2 seen-from-turtle.x seen-from-turtle.y)")
    )
    done = hy(copied, "pytest", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", ".")
    assert "2 failed, 1 passed" in done.stdout, done.stdout + done.stderr
