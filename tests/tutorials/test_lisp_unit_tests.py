"""The course's own tests, in lisp-unit, as ``cramhy test`` and pytest run them; and that they would notice a mistake."""

from __future__ import annotations

import shutil
import subprocess
import sys

import pytest

from .course import FOLDER, environment

NAMES = ["relative-angle-to-dont-turn", "relative-angle-to-look-back", "relative-angle-to-type-error"]
SYSTEM = "cram_my_beginner_tutorial/cram-my-beginner-tutorial-tests.asd"


def python(folder, *words):
    return subprocess.run(
        [sys.executable, "-m", *words],
        cwd=folder,
        env={**environment(), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
        capture_output=True,
        text=True,
        timeout=120,
    )


def results(printed):
    """The tests by name, and whether they passed."""
    return {line.partition(":")[0].lower(): line.endswith(", 0 failed.") for line in printed.splitlines() if "assertions passed" in line}


@pytest.fixture
def workspace(tmp_path):
    """A copy of the package in which one may make mistakes."""
    shutil.copytree(FOLDER / "cram_my_beginner_tutorial", tmp_path / "cram_my_beginner_tutorial")
    return tmp_path


@pytest.mark.soak
@pytest.mark.parametrize("what", [".", SYSTEM], ids=["found in a folder", "by the system"])
def test_pytest_runs_them(workspace, what):
    done = python(workspace, "pytest", "-v", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", what)
    assert done.returncode == 0 and "3 passed" in done.stdout, done.stdout + done.stderr


@pytest.mark.soak
@pytest.mark.parametrize("backend", ["threads", "greenlet"])
def test_cramhy_runs_them(workspace, backend):
    done = python(workspace, "cramhy_runtime.cli", "test", "--backend", backend, SYSTEM)
    assert done.returncode == 0 and list(results(done.stdout)) == NAMES


@pytest.mark.soak
@pytest.mark.parametrize(
    "wrong, failures",
    [
        (("(atan (y seen-from-turtle) (x seen-from-turtle))", "(atan (x seen-from-turtle) (y seen-from-turtle))"), NAMES[:2]),
        (("(transform-inv (pose-msg->transform pose-msg))", "(pose-msg->transform pose-msg)"), NAMES[:2]),
        (("(atan (y seen-from-turtle) (x seen-from-turtle))", "(atan (/ (y seen-from-turtle) (x seen-from-turtle)))"), NAMES[1:2]),
        (("(pose-msg->transform pose-msg)) goal)", "(pose-msg->transform pose-msg)) (make-3d-vector (x goal) (y goal) 0))"), NAMES[2:]),
    ],
    ids=["the axes the other way round", "the frames the other way round", "half a turn forgotten", "any goal taken"],
)
def test_they_notice_a_mistake(workspace, wrong, failures):
    plans = workspace / "cram_my_beginner_tutorial" / "src" / "simple-plans.hy"
    right, mistake = wrong
    text = plans.read_text()
    assert right in text
    plans.write_text(text.replace(right, mistake))
    done = python(workspace, "cramhy_runtime.cli", "test", SYSTEM)
    assert done.returncode == 1, done.stdout + done.stderr
    assert [name for name, passed in results(done.stdout).items() if not passed] == failures
