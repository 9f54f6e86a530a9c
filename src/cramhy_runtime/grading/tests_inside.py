"""Tests of lisp-unit, FiveAM and pytest, run in the process of the submission, whose functions they call.

Here the verdict is made beside the submission, so a submission that knows cramhy's inside could change it. What makes that hard:

* the tests are the exercise's own, and are loaded after the submission, so nothing that it defines replaces them;
* a `Guard` has noted the functions of the libraries before the submission was loaded, and sees if one of them is another one afterwards;
* two tests are added under names that nobody could know: one must pass, the other must fail. If a check no longer checks, they tell.

Points that must be safe come from questions and from what the turtle did, whose verdicts are made elsewhere (``judging.py``).
"""

from __future__ import annotations

from pathlib import Path

MOST_TEXT = 600


class Tampered(Exception):
    """A submission has changed what tests it."""


class Guard:
    """The functions of the libraries of tests as they are now."""

    def __init__(self):
        from cramhy_runtime.languages.commonlisp.systems import systems

        for name in ("lisp-unit", "fiveam"):
            systems.load_system(name)
        self.before = self._functions()

    def check(self):
        """Raise `Tampered` if a function of a library is another one now."""
        now = self._functions()
        changed = [name for name, function in self.before.items() if now.get(name) is not function]
        if changed:
            raise Tampered(f"The submission changes {', '.join(sorted(changed)[:3])}, which the tests are made of. Give it another name.")

    @staticmethod
    def _functions():
        from cramhy_runtime.lisp_core.packages import find_package
        from cramhy_runtime.languages.commonlisp.systems import loader, unit_tests

        found = {}
        for package in map(find_package, ("LISP-UNIT", "FIVEAM")):
            for symbol in (*package.internal.values(), *package.external.values()):
                if symbol.package is package:
                    found[f"{package.name}::{symbol.name}"] = symbol.macro or symbol.function
        for module in (unit_tests, loader):
            found |= {f"{module.__name__}.{name}": value for name, value in vars(module).items() if callable(value)}
        for kind in (unit_tests.LispTest, unit_tests.Outcome):
            found |= {f"{kind.__name__}.{name}": value for name, value in vars(kind).items() if callable(value)}
        return found


def run(tests, folder, canary, guard):
    """The results: a list of {"name", "passed", "text"}. Raises `Tampered`, and what loading the tests raises.

    tests: {"name", "text", "only"}: the file's name and text, and the names of the tests that count, ``None`` for all. folder: a `Path`.
    canary: letters that the submission could not know. guard: a `Guard`, made before the submission was loaded.
    """
    if tests["name"].endswith(".py"):
        results = _run_pytest(tests, folder, canary)
    else:
        guard.check()
        results = _run_lisp(tests, folder, canary)
        guard.check()
    kept = [result for result in results if not _is_canary(result, canary)]
    verdicts = [result["passed"] for result in results if _is_canary(result, canary)]
    if sorted(verdicts) != [False, True]:
        raise Tampered("The checks of the tests no longer check. The submission changes something that the tests are made of.")
    return kept


def _is_canary(result, canary):
    return canary.lower() in result["name"].lower()


CANARIES = {
    "lisp-unit": """
(lisp-unit:define-test good-{0} (lisp-unit:assert-equal 1 1) (lisp-unit:assert-true t) (lisp-unit:assert-number-equal 2 2))
(lisp-unit:define-test bad-{0} (lisp-unit:assert-equal 1 2))
""",
    "fiveam": """
(fiveam:test good-{0} (fiveam:is (= 1 1)) (fiveam:is-true t))
(fiveam:test bad-{0} (fiveam:is (= 1 2)))
""",
}


def _run_lisp(tests, folder, canary):
    from cramhy_runtime.languages.commonlisp.systems import loader, unit_tests

    library = "fiveam" if "fiveam" in tests["text"].lower() or "5am" in tests["text"].lower() else "lisp-unit"
    file, other = folder / f"tests-{canary}-{tests['name']}", folder / f"canary-{canary}.lisp"
    file.write_text(tests["text"], encoding="utf-8")
    other.write_text(CANARIES[library].format(canary), encoding="utf-8")
    for path in (file, other):
        loader.load_file(path, as_source=True)
    wanted = None if tests["only"] is None else {name.upper() for name in tests["only"]}
    results = []
    unit_tests.limit_tests(None)  # the limits of the process count
    for test in unit_tests.defined_tests([file, other]):
        if wanted is None or test.name.upper() in wanted or canary.upper() in test.name.upper():
            outcome = test.run()
            text = "\n".join(failure.text for failure in outcome.failures)
            passed = not outcome.failures and bool(outcome.passed)
            results.append({"name": test.name, "passed": passed, "text": text[:MOST_TEXT]})
    return results


PYTHON_CANARY = """
def test_good_{0}():
    assert 1 == 1


def test_bad_{0}():
    assert 1 == 2
"""


class _Collector:
    """A plugin of pytest that keeps what came of each test."""

    def __init__(self):
        self.results = {}

    def pytest_runtest_logreport(self, report):
        name = report.nodeid.rpartition("::")[2]
        before = self.results.get(name, {"name": name, "passed": False, "text": ""})
        if report.when == "call" and report.passed:
            before["passed"] = True
        elif report.failed:
            before = {"name": name, "passed": False, "text": str(report.longreprtext)[-MOST_TEXT:]}
        self.results[name] = before

    def pytest_collectreport(self, report):
        if report.failed:
            self.results[report.nodeid] = {"name": "loading", "passed": False, "text": str(report.longreprtext)[-MOST_TEXT:]}


def _run_pytest(tests, folder, canary):
    from cramhy_runtime import kernel

    try:
        import pytest
    except ImportError:
        raise RuntimeError("The tests of this exercise are written for pytest, which is missing here: pip install pytest.")
    place = folder / f"tests_{canary}"
    place.mkdir()
    file = place / f"test_{canary}_{Path(tests['name']).name}"
    file.write_text(tests["text"], encoding="utf-8")
    other = place / f"test_canary_{canary}.py"
    other.write_text(PYTHON_CANARY.format(canary), encoding="utf-8")
    settings = place / "pytest.ini"
    settings.write_text("[pytest]\n", encoding="utf-8")
    collector = _Collector()
    words = [str(file), str(other), "-q", "-c", str(settings), "--rootdir", str(place), "-p", "no:cacheprovider", "--import-mode=importlib"]
    try:
        pytest.main([*words, "-p", "no:faulthandler", "-s"], plugins=[collector])
    finally:
        if kernel.active() is None:  # our plugin has given each test one, and stopped it
            kernel.start()
    wanted = tests["only"]
    results = list(collector.results.values())
    return [result for result in results if wanted is None or result["name"] in wanted or _is_canary(result, canary)]
