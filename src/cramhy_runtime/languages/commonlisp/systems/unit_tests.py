"""Tests of lisp-unit and FiveAM, as Python sees them: which a file or system defines, running one, and what failed where.

The libraries themselves are Lisp (``libraries/``); their tests know the place of their definition, and failed checks theirs. A
test that never ends is ended after `limit` seconds: its error is one of the test, and the run goes on.
"""

from __future__ import annotations

import os
import re
import time
from contextlib import nullcontext
from pathlib import Path

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime import kernel
from cramhy_runtime.kernel import signals
from cramhy_runtime.lisp_core import packages
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.conditions import SimpleError, error
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from ...which_language import goes_on_in_lisp
from ..streams.stream_functions import get_output_stream_string, make_string_output_stream
from ..streams.streams import STANDARD_OUTPUT
from . import loader, systems


class Settings:
    """How tests are run. ``limit``: seconds that a test may take, ``None`` for as long as it likes. ``took``: how many seconds each test of
    FiveAM took, by its object."""

    __slots__ = ("limit", "took")

    def __init__(self):
        self.limit: float | None = 60.0
        self.took: dict = {}


settings = Settings()


def limit_tests(seconds):
    """Let each test take ``seconds`` from now on; ``None``: as long as it likes."""
    settings.limit = seconds


class TestTimeout(SimpleError):
    """A test took longer than it may."""

    __test__ = False
    lisp_name = "CRAMHY::TEST-TIMEOUT"


class Failure:
    """A failed check: what the library says about it, and its place as (file, line, column) or ``None``."""

    def __init__(self, text, place=None):
        self.text, self.place = text, place


class Outcome:
    """What came of one test. skipped: the reasons for skipping, if nothing else was checked."""

    def __init__(self, passed=0):
        self.passed = passed
        self.failures: list[Failure] = []
        self.skipped: list[str] = []


class LispTest:
    """A test of one of the libraries; ``place`` is that of its definition."""

    def __init__(self, library, symbol, package, place, object):
        self.library, self.symbol, self.package, self.place, self.object = library, symbol, package, place, object

    @property
    def name(self):
        return self.symbol.name

    def run(self):
        """Run it; the `Outcome`."""
        return _RUNNERS[self.library](self)


def _loaded(package):
    return packages.find_package(package) is not None


def _symbol(name):
    """The symbol ``"LIBRARY::NAME"`` of this image: each image loads the libraries for itself, so `sym` must not remember it."""
    package, _, short = name.rpartition("::")
    return packages.intern(short, package or "COMMON-LISP")


def _call(name, *arguments):
    return _symbol(name).function(*arguments)


def _place(lisp_list):
    return tuple(lisp_list) if lisp_list is not None else None


def defined_tests(files=None):
    """The tests that have been defined, in order; of ``files`` only, if they are given."""
    found = []
    if _loaded("LISP-UNIT"):
        for package, table in _symbol("LISP-UNIT::*TESTS*").value.items():
            found += [LispTest("lisp-unit", name, package, _place(_call("LISP-UNIT::PLACE", test)), test) for name, test in table.items()]
    if _loaded("FIVEAM"):
        case = _call("COMMON-LISP::FIND-CLASS", _symbol("FIVEAM::TEST-CASE"))
        found += [
            LispTest("fiveam", name, _call("FIVEAM::RUNTIME-PACKAGE", test), _place(_call("FIVEAM::PLACE", test)), test)
            for name, test in _symbol("FIVEAM::*TESTS*").value.items()
            if isinstance(test, case)
        ]
    if files is None:
        return found
    files = {os.path.realpath(file) for file in files}
    return [test for test in found if test.place and os.path.realpath(test.place[0]) in files]


# ----------------------------------------------------------------------------------------------------------------- running


def within_limit(thunk):
    """``(cramhy::within-limit thunk)``: call ``thunk``. Taking too long, and errors of Python, are Lisp errors signalled here."""
    limit = nullcontext() if settings.limit is None else signals.interrupted_after(settings.limit, kernel.active())
    late = None
    begun = time.perf_counter()
    try:
        with limit as late:
            return thunk()
    except kernel.Interrupted:
        if late is None or not late.is_set():
            raise
        kernel.interrupt_over()
        return error(TestTimeout(f"The test did not end within {settings.limit:g} seconds, and was stopped."))
    except Exception as problem:
        return error(from_python(problem))
    finally:
        if _loaded("FIVEAM"):
            settings.took[_symbol("FIVEAM::*CURRENT-TEST*").value] = time.perf_counter() - begun


def printed(function, *arguments):
    """What a Lisp function prints to the stream that it gets as its last argument."""
    stream = make_string_output_stream()
    function(*arguments, stream)
    return get_output_stream_string(stream)


def _run_lisp_unit(test):
    with binding(sym("*PACKAGE*"), test.package):
        return _outcome_of_lisp_unit(_call("LISP-UNIT::RUN-TEST", test.object), test.package)


def _outcome_of_lisp_unit(result, package):
    with binding(sym("*PACKAGE*"), package):
        outcome = Outcome(passed=_call("LISP-UNIT::PASS", result))
        for failure in _call("LISP-UNIT::FAIL", result) or ():
            outcome.failures.append(
                Failure(
                    printed(_symbol("LISP-UNIT::PRINT-FAILURES").function, failure).rstrip(" |\n"),
                    _place(_call("LISP-UNIT::PLACE", failure)),
                )
            )
        if _call("LISP-UNIT::EXERR", result) is not None:
            outcome.failures.append(
                Failure(
                    printed(_symbol("LISP-UNIT::PRINT-ERRORS").function, result).rstrip(" |\n"), _place(_call("LISP-UNIT::PLACE", result))
                )
            )
    return outcome


def _run_fiveam(test):
    with binding(_symbol("FIVEAM::*TEST-DRIBBLE*"), None):
        return _outcome_of_fiveam(list(_call("FIVEAM::RUN", test.symbol) or ()), test.object)


def _outcome_of_fiveam(results, test):
    """The `Outcome` of ``test``, an object of FiveAM, from ``results``, the newest first; they may be those of tests that it needs, too."""
    outcome = Outcome()
    kinds = [_call("COMMON-LISP::FIND-CLASS", _symbol(f"FIVEAM::{name}")) for name in ("TEST-PASSED", "TEST-SKIPPED")]
    for result in reversed(results):
        owner = _call("FIVEAM::TEST-CASE", result)
        if isinstance(result, kinds[0]):
            outcome.passed += 1
        elif isinstance(result, kinds[1]):
            outcome.skipped.append(_call("FIVEAM::REASON", result))
        else:
            text = _call("FIVEAM::REASON", result).strip("\n")
            values = _call("FIVEAM::VALUES-TEXT", result)
            if values is not None:  # the user has given a reason, which does not tell the values
                text += "\n" + values.strip("\n")
            name = owner is not test and f"{_call('FIVEAM::NAME', owner).name}: " or ""
            outcome.failures.append(Failure(name + re.sub(r"\n\n+", "\n", text), _place(_call("FIVEAM::PLACE", result))))
    return outcome


_RUNNERS = {"lisp-unit": _run_lisp_unit, "fiveam": _run_fiveam}


# ---------------------------------------------------------------------------------------------------------------- loading

TEST_NAMES = late_pattern(r"(^|[-_])tests?($|[-_])")
DEFINES_TESTS = late_pattern(r"\((?:[\w.+-]+::?)?(?:define-test|def-test|test)[\s(]")


def looks_like_tests(path):
    """Whether a file is one of tests: its name or its folder says so, and a form in it defines one."""
    path = Path(path)
    if path.suffix not in (".lisp", ".hy") or not (TEST_NAMES.search(path.stem) or path.parent.name in ("test", "tests")):
        return False
    try:
        return DEFINES_TESTS.search(path.read_text(encoding="utf-8")) is not None
    except (OSError, UnicodeDecodeError):
        return False


NAMED_LIKE_TESTS = late_pattern(r"^tests?$|^tests?[-_]|[-_]tests?$")


def named_like_tests(path):
    """Whether a file of Lisp has a name that says that there are tests in it: ``tests``, ``test-drive``, ``drive-tests``."""
    path = Path(path)
    return path.suffix in (".lisp", ".hy") and NAMED_LIKE_TESTS.search(path.stem) is not None


def tests_of_file(path):
    """As `load_tests`. No test is an error, except in a helper: a file of a system in which other files define tests."""
    path = Path(path).absolute()
    tests = load_tests(path)
    if not tests:
        system = system_of_file(path)
        if system is None or not defined_tests([component.pathname for component in systems.files_of(system)]):
            error(
                SimpleError("~a", f"There are no tests of lisp-unit or FiveAM in {path.name}, though it is named like a file of tests."),
                hint="If the file is a helper of tests, give it a name that does not begin or end with `test` or `tests`.",
            )
    return tests


def tests_of_folder(folder):
    """The tests in the files of tests below ``folder``. A file that is named like one of tests and has none is an error.

    Files of tests in plain Hy, which pytest runs, are named on ``*standard-output*``.
    """
    files = sorted(file for file in Path(folder).rglob("*") if looks_like_tests(file) or named_like_tests(file))
    plain = [file for file in files if file.suffix == ".hy" and not goes_on_in_lisp(file)]
    if plain:
        names = ", ".join(file.name for file in plain)
        STANDARD_OUTPUT.value.write(f"Not run here, since {'it is' if len(plain) == 1 else 'they are'} in plain Hy: {names}. Run pytest.\n")
    return [test for file in files if file not in plain for test in tests_of_file(file)]


def system_of_file(path):
    """The system of which the file is a part, as the ``.asd`` files in its folder and the three above say; ``None`` if it is in none."""
    path = Path(path).absolute()
    for folder in [path.parent, *path.parent.parents][:4]:
        for asd in sorted(folder.glob("*.asd")):
            systems.load_asd(asd)
            for system in list(systems.systems.values()):
                if system.file == asd and any(component.pathname == path for component in systems.files_of(system)):
                    return system
    return None


def load_tests(path):
    """Load a file with the system of which it is a part; the tests that it defines."""
    path = Path(path).absolute()
    system = system_of_file(path)
    if system is None:
        loader.load_file(path, as_source=True)
    else:
        systems.load_system(system.name)
    return defined_tests([path])


def load_asd_tests(path):
    """Read a file of system definitions and load the systems in it; the tests that their files define."""
    path = Path(path).absolute()
    systems.load_asd(path)
    return _tests_of([system.name for system in list(systems.systems.values()) if system.file == path])


def load_system_tests(name):
    """Load the system ``name`` and those that its ``test-op`` needs, or that stand below its name; the tests in their files."""
    main = systems.find_system(name)
    return _tests_of(
        dict.fromkeys(
            [
                name,
                *(other for step in main.in_order_to.values() for _, others in step for other in others),
                *(other for other in systems.systems if other.startswith(f"{name}/test")),
            ]
        )
    )


def _tests_of(names):
    files = []
    for name in names:
        systems.load_system(name)
        files += [component.pathname for component in systems.files_of(systems.find_system(name))]
    return defined_tests(files)


def run_all(tests):
    """Run ``tests`` with the summaries of their libraries, printed to ``*standard-output*``; a list of (test, outcome, seconds)."""
    return [*_run_all_of_lisp_unit(tests), *_run_all_of_fiveam(tests)]


def _run_all_of_lisp_unit(tests):
    ours = [test for test in tests if test.library == "lisp-unit"]
    for package in dict.fromkeys(test.package for test in ours):
        shown = _symbol("LISP-UNIT::*PRINT-FAILURES*"), True, _symbol("LISP-UNIT::*PRINT-ERRORS*"), True
        results = _call("MAKE-INSTANCE", _symbol("LISP-UNIT::TEST-RESULTS-DB"))
        for test in ours:
            if test.package is package:
                begun = time.perf_counter()
                with binding(sym("*PACKAGE*"), package, *shown):
                    result = _call("LISP-UNIT::RUN-TEST", test.object)
                    _call("LISP-UNIT::RECORD", results, result)
                yield test, _outcome_of_lisp_unit(result, package), time.perf_counter() - begun
        with binding(sym("*PACKAGE*"), package, *shown):
            _call("LISP-UNIT::FINISH", results)
    STANDARD_OUTPUT.value.fresh_line()


def _run_all_of_fiveam(tests):
    names = [test.symbol for test in tests if test.library == "fiveam"]
    if not names:
        return
    settings.took.clear()
    results = list(_call("FIVEAM::RUN", list_from(names)) or ())
    _call("FIVEAM::EXPLAIN!", list_from(results))
    STANDARD_OUTPUT.value.fresh_line()
    for test in defined_tests():  # those that the tests depend on were run, too
        own = [result for result in results if _call("FIVEAM::TEST-CASE", result) is test.object]
        if test.library == "fiveam" and (own or test.object in settings.took):
            yield test, _outcome_of_fiveam(own, test.object), settings.took.get(test.object, 0.0)
