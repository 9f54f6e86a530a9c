"""Fixtures for all rooms: where the shared references lie, and a session in virtual time."""

from __future__ import annotations

import gc
import os
from pathlib import Path

import late_threads
import pytest
import soak_marks
from systems import BACKENDS, SOAK

from cramhy_runtime.session import Image

try:
    from hypothesis import HealthCheck, settings
except ImportError:  # a part of it is compiled, and not for WebAssembly
    settings = None

REPOSITORY = Path(__file__).parents[1]
SHARED = REPOSITORY.parent / "shared"


LONG = (
    "webassembly",
    "robot_world",
    "course",
    "docs",
    "libraries",
    "grading",
    "session",
    "test_standard_page.py",
    "newcomer",
    "test_interpreters.py",
    "test_missing_systems.py",
    "soak",
    "view",
    "rosbridge",
    "repl",
    "tutorials",
    "slides",
    "test_house.py",
    "test_invariants.py",
    "test_clause_index.py",
    "test_against_reference.py",
    "test_anomalies.py",
    "test_collecting.py",
)
"""Folders and files whose tests take seconds: they come first, so that on two processors neither waits for the other at the end."""

# What hypothesis makes up is the same each time, so that a change is not blamed for what an unlucky draw finds; the soak draws anew.
os.environ["CRAMHY_HISTORY"] = ""  # what tests type is not the user's
os.environ["CRAMHY_AS_ROOT"] = "yes"  # CI is root in a container, and grades what stands in the tests
if settings is not None:
    unhurried = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])  # both would look at the wall clock
    settings.register_profile("steady", unhurried, derandomize=True, max_examples=50)
    settings.register_profile("soak", unhurried)
    settings.load_profile("soak" if SOAK else "steady")

if "CRAMHY_LATE" in os.environ:
    late_threads.install(os.environ["CRAMHY_LATE"])


def whole_files(config):
    """Whether every case is asked for: by `make soak`, by naming files or tests, or by an expression for marks of one's own."""
    named = [argument for argument in config.args if "::" in argument or argument.endswith(".py")]
    return SOAK or config.option.markexpr or len(named) == len(config.args)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Long files come first. Tests for the soak are told as deselected: to skip 25,000 one by one took half a minute."""
    items.sort(key=lambda item: not any(part in LONG for part in item.path.parts))
    config.stash[soak_marks.WRONG] = soak_marks.leave_on_cases(items)
    left_out = [] if whole_files(config) else [item for item in items if item.get_closest_marker("soak")]
    config.stash[soak_marks.LEFT_OUT] = len(left_out)
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if not item.get_closest_marker("soak")]


def pytest_sessionfinish(session):
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["left_out"] = session.config.stash.get(soak_marks.LEFT_OUT, 0)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    node.config.stash[soak_marks.LEFT_OUT] = getattr(node, "workeroutput", {}).get("left_out", 0)


def pytest_terminal_summary(terminalreporter, config):
    if count := config.stash.get(soak_marks.LEFT_OUT, 0):
        terminalreporter.write_line(f"{count} tests with the mark soak were deselected: make soak runs them.")


@pytest.fixture(scope="session")
def shared():
    """The folder of the shared references; tests that need it are skipped where it is missing."""
    if not SHARED.is_dir():
        pytest.skip("the shared references are not beside this checkout")
    return SHARED


@pytest.fixture(autouse=True, scope="module")
def image_of_its_own():
    """Each file of tests has an image of its own, with what all files have defined when they were imported.

    What is there after it stays, so the collector need not look at it again: it took a third of the time of a run.
    """
    with Image(as_now=True):
        yield
    gc.collect()
    gc.freeze()


@pytest.fixture(params=BACKENDS)
def backend(request):
    """The name of a back end: a test that takes it runs on each that there can be on this system."""
    if request.param == "greenlet":
        pytest.importorskip("greenlet")
    return request.param


@pytest.fixture
def session():
    """A session in virtual time, without the turtle."""
    from cramhy_runtime import kernel
    from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
    from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
    from cramhy_runtime.repl.session import Session

    made = Session(time="virtual", turtlesim=False)
    made.package = "CRAM-USER"
    yield made
    kernel.stop()
    PACKAGE.value = COMMON_LISP_USER
