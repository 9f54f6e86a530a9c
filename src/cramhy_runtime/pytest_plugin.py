"""The pytest plugin: plans in test functions, and the tests of Lisp systems as tests of pytest.

Lisp systems can be imported as Python modules from the first test on. Every test starts with a fresh kernel in virtual time, so
no test waits on the wall clock and none hears of another's tasks; the turtlesim starts with the first ROS node, as in the REPL.
The fixture ``virtual_time`` gives a test a kernel of its own, on either back end (docs/testing.md). Nothing is loaded before a test
imports a Lisp system, asks for one of the fixtures, or a Lisp file of tests is collected:
one named ``test*``, ``*-test`` or ``*-tests`` or in a folder ``tests``, that defines tests of lisp-unit or FiveAM. It is loaded with
the system of which it is a part. A ``.asd`` file is collected when it is named on the command line.
"""

from __future__ import annotations

import importlib.abc
import importlib.util
import os
import sys
from pathlib import Path

import pytest


class _SystemsOnDemand(importlib.abc.MetaPathFinder):
    """Makes the image when a module is imported that Python does not know; then Lisp systems are found."""

    def find_spec(self, name, path=None, target=None):
        if path is not None or "." in name or name.startswith("_") or "cramhy_runtime.image" in sys.modules:
            return None
        from cramhy_runtime.lisp.systems import systems

        if systems.find_asd(name.replace("_", "-")) is None:
            return None
        from cramhy_runtime import image

        image.fresh_start()
        return importlib.util.find_spec(name)


def pytest_addoption(parser):
    parser.addoption("--lisp-limit", type=float, default=60.0, metavar="SECONDS",
                     help="end a test of lisp-unit or FiveAM that takes longer")


def pytest_configure(config):
    sys.meta_path.append(_SystemsOnDemand())


@pytest.fixture
def cramhy():
    """A fresh `Session` in virtual time; ``cramhy.evaluate_text("(+ 1 2)")``."""
    from cramhy_runtime import kernel
    from cramhy_runtime.repl.session import Session

    yield Session(time="virtual")
    kernel.stop()


@pytest.fixture
def virtual_time(request):
    """A kernel in virtual time, as `cramhy_runtime.testing.virtual_time` gives it; ``virtual_time.now()``.

    Its parameter, if it is given one, is the back end, or a dictionary of options: for a test on both back ends
    ``@pytest.mark.parametrize("virtual_time", ["threads", "greenlet"], indirect=True)``.
    """
    from cramhy_runtime import testing

    options = getattr(request, "param", {})
    with testing.virtual_time(**({"backend": options} if isinstance(options, str) else options)) as clock:
        yield clock


@pytest.fixture(autouse=True)
def _fresh_kernel(request):
    if "cramhy_runtime.image" not in sys.modules or "cramhy" in request.fixturenames or "session" in request.fixturenames:
        yield
        return
    from cramhy_runtime import image, kernel

    image.fresh_start()
    yield
    kernel.stop()


# -------------------------------------------------------------------------------------------------------- tests in Lisp files


def pytest_collect_file(file_path, parent):
    if file_path.suffix not in (".lisp", ".hy", ".asd"):
        return None
    if not parent.session.isinitpath(file_path):
        from cramhy_runtime.lisp.systems import unit_tests

        if not unit_tests.looks_like_tests(file_path):
            return None
    return LispFile.from_parent(parent, path=file_path)


class LispFile(pytest.File):
    """A file with tests of lisp-unit or FiveAM, or the definition of a system that has some."""

    def collect(self):
        from cramhy_runtime import image, kernel
        from cramhy_runtime.lisp.systems import unit_tests
        from cramhy_runtime.lisp.conditions import Condition

        image.fresh_start()
        try:
            tests = unit_tests.load_asd_tests(self.path) if self.path.suffix == ".asd" else unit_tests.load_tests(self.path)
        except (Exception, Condition) as problem:
            raise self.CollectError(_explained(problem)) from None
        finally:
            kernel.stop()
        return [LispItem.from_parent(self, name=test.name.lower(), test=test) for test in tests]


class LispItem(pytest.Item):
    """A test; the report names the failing form, its values, and the line of Lisp."""

    def __init__(self, *, test, **others):
        super().__init__(**others)
        self.test = test

    def runtest(self):
        from cramhy_runtime import image, kernel
        from cramhy_runtime.lisp.systems import unit_tests

        unit_tests.limit = self.config.getoption("--lisp-limit")
        image.fresh_start()
        try:
            outcome = self.test.run()
        finally:
            kernel.stop()
        if outcome.failures:
            raise ChecksFailed(outcome.failures)
        if outcome.skipped and not outcome.passed:
            pytest.skip("; ".join(outcome.skipped))

    def repr_failure(self, excinfo):
        if isinstance(excinfo.value, ChecksFailed):
            return "\n\n".join(map(_shown, excinfo.value.failures))
        return _explained(excinfo.value)

    def reportinfo(self):
        file, line, *_ = self.test.place
        return Path(file), line - 1, f"{self.test.package.name}::{self.test.name}"


class ChecksFailed(Exception):
    """A test of a Lisp library in which checks failed; ``failures`` say which."""

    def __init__(self, failures):
        super().__init__(f"{len(failures)} checks failed")
        self.failures = failures


def _shown(failure):
    from cramhy_runtime.lisp.evaluation.places_in_source import describe, excerpt

    place = [f"  at {describe(failure.place)}", excerpt(failure.place)] if failure.place else []
    return os.linesep.join([failure.text, *place])


def _explained(problem):
    """What, where and why, as at the REPL; a Python error of the plugin itself keeps its Python text."""
    from cramhy_runtime.lisp.tools.advice import explanation
    from cramhy_runtime.repl.session import condition_of

    return explanation(condition_of(problem))


def pytest_runtest_makereport(item, call):
    """A signal that ends the process ends pytest, and is not the failure of a test."""
    errors = sys.modules.get("cramhy_runtime.kernel.errors")
    if errors is not None and call.excinfo is not None and isinstance(call.excinfo.value, errors.Terminated):
        pytest.exit(str(call.excinfo.value), returncode=call.excinfo.value.code)
