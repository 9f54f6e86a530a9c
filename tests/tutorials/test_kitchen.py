"""The kitchen's package and its twin in Hy: their own tests, and a table that is the same whatever the seed, also when the plan is stopped."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

from .course import FOLDER, environment

sys.path.insert(0, str(Path(__file__).parents[1]))

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

KITCHEN = FOLDER / "kitchen"
SET = """((BOWL-1 -3.28 -0.06 0.78) (BOWL-2 -3.28 0.68 0.78) (CUP-1 -3.4 0.09 0.79)
 (CUP-2 -3.16 0.53 0.79) (SPOON-1 -3.16 -0.06 0.75) (SPOON-2 -3.4 0.68 0.75)
 (BOTTLE-1 -3.28 0.31 0.85))"""
BEGIN = """(ros-load:load-system "cram_my_pick_place_tutorial" :cram-my-pick-place-tutorial)
(in-package :kitchen) (init-kitchen) (roslisp:set-debug-level '(pick-place) :error) (roslisp:set-debug-level '(kitchen) :error)"""


def run(folder, *words):
    return subprocess.run(
        [sys.executable, "-m", *words],
        cwd=folder,
        env={**environment(), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
        capture_output=True,
        text=True,
        timeout=300,
    )


@pytest.fixture
def ask(request):
    """What a form in the package prints, in a session with a seed."""
    session = Session(time="virtual", seed=getattr(request, "param", None), turtlesim=False)
    session.evaluate_text(BEGIN)
    yield lambda form: prin1_to_string(session.evaluate_text(form)[0])
    kernel.stop()


def test_the_packages_own_tests_pass():
    done = run(KITCHEN, "cramhy_runtime.cli", "test", "cram_my_pick_place_tutorial/cram-my-pick-place-tutorial-tests.asd")
    assert done.returncode == 0 and "6 passed" in done.stdout, done.stdout + done.stderr


@pytest.mark.soak
def test_the_tests_of_the_twin_pass(tmp_path):
    shutil.copytree(KITCHEN / "kitchen_in_hy", tmp_path / "kitchen_in_hy", ignore=shutil.ignore_patterns("__pycache__"))
    done = run(tmp_path, "pytest", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", "kitchen_in_hy")
    assert done.returncode == 0 and "6 passed" in done.stdout, done.stdout + done.stderr


@pytest.mark.soak
def test_a_plan_that_was_stopped_goes_on_where_it_was(ask):
    """The spoon of the second guest alone is missing, and another one is in the hand."""
    ask("(lay-out-dishes)")
    for name, pose in (("spoon-1", "-3.16d0 -0.06d0 0.756d0 90"), ("spoon-2", "1.42d0 0.95d0 0.9d0")):
        ask(f"(btr-utils:move-object '{name} (pose {pose}))")
    for name, pose in (
        ("bowl-1", "-3.28d0 -0.06d0 0.786d0"),
        ("bowl-2", "-3.28d0 0.68d0 0.786d0"),
        ("cup-1", "-3.4d0 0.09d0 0.796d0"),
        ("cup-2", "-3.16d0 0.53d0 0.796d0"),
        ("bottle-1", "-3.28d0 0.31d0 0.85d0"),
    ):
        ask(f"(btr-utils:move-object '{name} (pose {pose}))")
    ask("(btr:simulate btr:*current-bullet-world* 100)")
    ask("(with-simulated-robot (get-ready) (fetch (search-counter :spoon)))")
    assert ask("(held)") == "(SPOON-2)"
    assert ask("(set-table-for-two)") == "NIL"
    assert ask("(things)").split() == SET.split() and ask("(held)") == "NIL"


@pytest.mark.soak
@pytest.mark.parametrize("ask", [None, *range(5)], indirect=True)
def test_the_table_is_the_same_with_every_seed(ask):
    ask("(lay-out-dishes)")
    ask("(set-table-for-two)")
    assert ask("(things)").split() == SET.split()


@pytest.mark.soak
def test_make_kitchen_writes_a_picture_and_a_movie_and_says_where(tmp_path):
    done = subprocess.run(
        [sys.executable, str(KITCHEN / "make_kitchen.py")], cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0 and "debugger invoked" not in done.stdout, done.stdout + done.stderr
    assert SET in done.stdout and f";; The picture is {tmp_path / 'kitchen.png'}, the movie {tmp_path / 'kitchen.gif'}" in done.stdout
    assert (tmp_path / "kitchen.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "kitchen.gif").read_bytes().startswith(b"GIF8")
