"""The pytest plugin: plans in test functions, and the tests of Lisp systems as tests of pytest.

Lisp systems can be imported as Python modules from the first test on. Every test starts with a fresh kernel in virtual time, so
no test waits on the wall clock and none hears of another's tasks; the turtlesim starts with the first ROS node, as in the REPL.
The fixture ``virtual_time`` gives a test a kernel of its own, on either back end (docs/testing.md). Nothing is loaded before a test
imports a Lisp system, asks for one of the fixtures, or a Lisp file of tests is collected:
one named ``test-*``, ``*-test`` or ``*-tests``, or one in a folder ``tests`` that defines tests of lisp-unit or FiveAM. It is loaded with
the system of which it is a part. A ``.asd`` file is collected when it is named on the command line. A file ``test_*.hy`` that stays Hy
is collected as pytest's own modules are (``languages/hy/collected_tests.py``). A file with such a name and without tests is an error of
collection.
"""

from __future__ import annotations

import importlib.abc
import importlib.machinery
import importlib.util
import os
import sys
from pathlib import Path
from types import TracebackType

import pytest

from .languages.hy import collected_tests
from .languages.which_language import goes_on_in_lisp


class _SystemsOnDemand(importlib.abc.MetaPathFinder):
    """Makes the image when a module is imported that Python does not know; then Lisp systems are found."""

    def find_spec(self, name, path=None, target=None):
        if path is not None or "." in name or name.startswith("_") or "cramhy_runtime.session" in sys.modules:
            return None
        from cramhy_runtime.languages.commonlisp.systems import systems

        find = getattr(systems, "find_asd", None)  # missing while that module is being imported, and looks for a module of another system
        if find is None or find(name.replace("_", "-")) is None:
            return None
        from cramhy_runtime.session import fresh_start

        fresh_start()
        return importlib.util.find_spec(name)


class _HyStaysHy(importlib.abc.MetaPathFinder):
    """Finds modules in Hy before pytest does, which would read a test file, or a plugin, as Python to rewrite its assertions."""

    def __init__(self, config):
        self.config = config

    def find_spec(self, name, path=None, target=None):
        if "hy" not in sys.modules:
            return None
        spec = importlib.machinery.PathFinder.find_spec(name, path)
        if spec is None or not str(spec.origin).endswith(".hy"):
            return None
        if name != "hy" and not name.startswith("hy."):  # while those are imported, the keeper cannot be
            from cramhy_runtime.languages import kept_hy

            kept_hy.watch()
            spec.loader = kept_hy.Loader(name, spec.loader.path)
        if collected_tests.rewrites(name, spec.origin, self.config):
            spec.loader = collected_tests.RewritingLoader(name, spec.origin)
            spec.loader.config = self.config
            spec.cached = None
        return spec


def pytest_addoption(parser):
    parser.addini("cramhy_images", "test: what a test defines is gone in the next one; module: it stays (test)", default="test")
    parser.addoption(
        "--lisp-limit", type=float, default=60.0, metavar="SECONDS", help="end a test of lisp-unit or FiveAM that takes longer (60)"
    )

    parser.addoption(
        "--cramhy-time", choices=["virtual", "wall"], help="the time of each test; it counts before the variable CRAMHY_TIME (virtual)"
    )


def pytest_configure(config):
    if config.getoption("--cramhy-time"):
        os.environ["CRAMHY_TIME"] = config.getoption("--cramhy-time")
    config.args[:] = collected_tests.lisp_names_of_arguments(config.args)
    sys.meta_path.insert(0, _HyStaysHy(config))
    sys.meta_path.append(_SystemsOnDemand())


@pytest.fixture
def cramhy():
    """A fresh `Session`, in virtual time unless ``--cramhy-time`` or CRAMHY_TIME says otherwise; ``cramhy.evaluate_text("(+ 1 2)")``."""
    from cramhy_runtime import kernel
    from cramhy_runtime.repl.session import Session
    from cramhy_runtime.session import time_setting

    yield Session(time=time_setting.decide())
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


def _may_define(module):
    """Whether a module may have defined something when it was imported: not Python's own, and not what the kernel loads for a run."""
    return not module.startswith("cramhy_runtime.kernel.") and module.partition(".")[0] not in {"greenlet", *sys.stdlib_module_names}


@pytest.fixture(autouse=True)
def _image_of_its_own(request):
    """What a test defines goes with it: facts, classes of designators, process modules. What it imports for the first time stays, since
    Python will not run those modules again. The setting ``cramhy_images = module`` leaves images to the tests themselves."""
    images = sys.modules.get("cramhy_runtime.kernel.images")
    if images is None or request.config.getini("cramhy_images") != "test":
        yield
        return
    from cramhy_runtime import kernel

    modules = set(sys.modules)
    with kernel.at_hand():
        image = images.Image(as_now=True)
    image.enter()
    yield
    kernel.stop()
    if not any(map(_may_define, set(sys.modules) - modules)):
        image.leave()
        image.forget()


@pytest.fixture(autouse=True)
def _fresh_kernel(request, _image_of_its_own):
    if "cramhy_runtime.session" not in sys.modules or "cramhy" in request.fixturenames or "session" in request.fixturenames:
        yield
        return
    from cramhy_runtime import kernel
    from cramhy_runtime.session import fresh_start

    fresh_start()
    yield
    kernel.stop()


# -------------------------------------------------------------------------------------------------------- tests in Lisp files


def pytest_collect_file(file_path, parent):
    if file_path.suffix not in (".lisp", ".hy", ".asd"):
        return None
    named = parent.session.isinitpath(file_path)
    if file_path.suffix == ".hy" and not goes_on_in_lisp(file_path):
        if not named and not collected_tests.named_like_tests(file_path, parent.config):
            return None
        from cramhy_runtime.languages import kept_hy  # with Hy, which teaches Python to import it

        kept_hy.watch()
        return HyModule.from_parent(parent, path=file_path)
    if not named:
        from cramhy_runtime.languages.commonlisp.systems import unit_tests

        if not (unit_tests.looks_like_tests(file_path) or unit_tests.named_like_tests(file_path)):
            return None
    return LispFile.from_parent(parent, path=file_path)


def pytest_pycollect_makeitem(collector, name, obj):
    return collected_tests.make_item(collector, name, obj)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    """A module that imports a Lisp system needs a kernel, and a Lisp file that was collected before has ended its own."""
    if isinstance(collector, pytest.Module) and "cramhy_runtime.session" in sys.modules:
        from cramhy_runtime import kernel
        from cramhy_runtime.session import fresh_start

        if kernel.active() is None:
            fresh_start()
    return (yield)


class HyModule(collected_tests.HyModule):
    """A file of plain Hy with test functions. A form that cannot be compiled is told as ``hy FILE`` tells it."""

    def collect(self):
        try:
            return super().collect()
        except self.CollectError as refused:
            if not _of_hys_compiler(refused.__cause__):
                raise
            problem = refused.__cause__
        raise self.CollectError(_explained(problem)) from None


def _of_hys_compiler(problem):
    """Whether ``problem`` is about a form of Hy that could not be read or compiled."""
    errors = sys.modules.get("hy.errors")
    return errors is not None and isinstance(problem, errors.HyError)


def _without_compiler(traceback):
    """``traceback`` up to the line that imports: without the frames of Python's importer and Hy's compiler."""
    kept = []
    while traceback is not None and "importlib" not in traceback.tb_frame.f_code.co_filename:
        kept.append(traceback)
        traceback = traceback.tb_next
    shorter = None
    for entry in reversed(kept):
        shorter = TracebackType(shorter, entry.tb_frame, entry.tb_lasti, entry.tb_lineno)
    return shorter


class LispFile(pytest.File):
    """A file with tests of lisp-unit or FiveAM, or the definition of a system that has some."""

    def collect(self):
        from cramhy_runtime import kernel
        from cramhy_runtime.session import fresh_start
        from cramhy_runtime.languages.commonlisp.systems import unit_tests
        from cramhy_runtime.lisp_core.conditions import Condition

        fresh_start()
        try:
            tests = unit_tests.load_asd_tests(self.path) if self.path.suffix == ".asd" else unit_tests.tests_of_file(self.path)
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
        from cramhy_runtime import kernel
        from cramhy_runtime.session import fresh_start
        from cramhy_runtime.languages.commonlisp.systems import unit_tests

        unit_tests.limit_tests(self.config.getoption("--lisp-limit"))
        fresh_start()
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
            from cramhy_runtime.languages.commonlisp.systems import test_reports

            return "\n\n".join(map(test_reports.shown, excinfo.value.failures))
        return _explained(excinfo.value)

    def reportinfo(self):
        file, line, *_ = self.test.place
        return Path(file), line - 1, f"{self.test.package.name}::{self.test.name}"


class ChecksFailed(Exception):
    """A test of a Lisp library in which checks failed; ``failures`` say which."""

    def __init__(self, failures):
        super().__init__(f"{len(failures)} checks failed")
        self.failures = failures


def _explained(problem):
    """What, where and why, as at the REPL; a Python error of the plugin itself keeps its Python text."""
    from cramhy_runtime import kernel
    from cramhy_runtime.languages.commonlisp.tools.advice import explanation
    from cramhy_runtime.repl.session import condition_of

    with kernel.at_hand():  # that of the test has ended
        return explanation(condition_of(problem))


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_makereport(item, call):
    """A signal that ends the process ends pytest, and is not the failure of a test. Frames of Hy's compiler are not shown."""
    if call.excinfo is None:
        return
    problem = call.excinfo.value
    errors = sys.modules.get("cramhy_runtime.kernel.errors")
    if errors is not None and isinstance(problem, errors.Terminated):
        pytest.exit(str(problem), returncode=problem.code)
    if _of_hys_compiler(problem) and (traceback := _without_compiler(call.excinfo.tb)) is not None:
        problem.__cause__, problem.__suppress_context__ = None, True  # what Hy's parser said to its compiler
        hint = getattr(problem, "hint", None)
        hint = hint() if callable(hint) else hint
        if hint and hint not in getattr(problem, "__notes__", ()):
            problem.add_note(hint)
        call.excinfo = pytest.ExceptionInfo.from_exc_info((type(problem), problem, traceback))
