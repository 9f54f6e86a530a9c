"""The rooms that stand on tasks pass their tests in WebAssembly, on the back end "jspi": in Node, with Pyodide.

One run of pytest there takes all files, since Pyodide takes seconds to start. `make test` takes the laws; `make soak` takes all files.
"""

from __future__ import annotations

from xml.etree import ElementTree

import pytest
from systems import SOAK
from node import KEPT, pyodide, run_pytest

from cramhy_runtime.browser import pyodide_files
from cramhy_runtime.browser.pyodide_files import UnfitPyodide

LAWS = {
    "kernel": ("test_baton.py", "test_virtual_time.py", "test_jspi.py"),
    "cpl": ("laws/test_cleanup_laws.py",),
    "process_modules": ("laws/test_module_laws.py",),
    "designators": ("laws/test_location_laws.py",),
}
"""The files that run in `make test`, and the rooms."""
NOT_THERE = {
    "kernel/test_random_programs.py": "hypothesis has a compiled part",
    "cpl/laws/test_random_plans.py": "hypothesis has a compiled part",
    "cpl/test_fluents_at_random.py": "hypothesis has a compiled part",
    "designators/test_designators_at_random.py": "hypothesis has a compiled part",
    "designators/test_clause_index.py": "hypothesis has a compiled part",
    "kernel/test_signals.py": "no processes",
    "kernel/test_terminals.py": "no terminals",
}


def paths():
    if not SOAK:
        return [f"tests/{room}/{name}" for room, names in LAWS.items() for name in names]
    return [*(f"tests/{room}" for room in LAWS), *(f"--ignore=tests/{name}" for name in NOT_THERE)]


@pytest.fixture(scope="module")
def results():
    """For each room the results of its tests: (name, "passed", "skipped" or the text of what failed)."""
    done = run_pytest("--junitxml=/compiled/results.xml", "-W", "ignore", *([] if SOAK else ["-k", "not jspi-hy"]), *paths())
    report = KEPT / "compiled" / "results.xml"
    assert done.returncode in (0, 1) and report.exists(), done.stdout[-5000:]
    found = {room: [] for room in LAWS}
    for case in ElementTree.parse(report).getroot().iter("testcase"):
        room = case.get("classname").split(".")[1]
        failure = next((each.get("message") + "\n" + (each.text or "") for each in case if each.tag in ("failure", "error")), None)
        found[room].append((case.get("name"), failure or ("skipped" if case.find("skipped") is not None else "passed")))
    report.unlink()
    return found


@pytest.mark.parametrize(
    ("room", "at_least"),
    [
        ("kernel", 110 if SOAK else 70),
        ("cpl", 190 if SOAK else 45),
        ("process_modules", 50 if SOAK else 35),
        ("designators", 80 if SOAK else 30),
    ],
)
@pytest.mark.timeout(3600 if SOAK else 400)
def test_a_room_passes_its_tests(results, room, at_least):
    outcomes = [outcome for _, outcome in results[room]]
    assert {name: outcome for name, outcome in results[room] if outcome not in ("passed", "skipped")} == {}
    assert outcomes.count("passed") >= at_least


# ---------------------------------------------------------------------------------------------------------------- Pyodide


def test_what_is_mended_in_pyodide_stands_in_it_once():
    text = (pyodide() / "pyodide.asm.mjs").read_text(encoding="utf-8")
    for before, after in pyodide_files.MENDED:
        assert (text.count(before), text.count(after)) == (0, 1)


@pytest.mark.parametrize("times", [0, 2])
def test_another_pyodide_is_refused(times):
    (first, _), (second, _) = pyodide_files.MENDED
    with pytest.raises(UnfitPyodide) as refused:
        pyodide_files.mended(first + second * times)
    assert str(refused.value) == (
        f"pyodide.asm.mjs is not that of Pyodide 314.0.7: a passage that has to be changed occurs {times} times and not once. "
        "Take the package pyodide 314.0.7 of npm, as it is."
    )


@pytest.mark.parametrize(
    ("package", "complaint"),
    [
        (None, "There is no Pyodide in {}: its package.json is missing, or is not that of the package pyodide."),
        ("[]", "There is no Pyodide in {}: its package.json is missing, or is not that of the package pyodide."),
        (
            '{"name": "left-pad", "version": "1"}',
            "There is no Pyodide in {}: its package.json is missing, or is not that of the package pyodide.",
        ),
        ('{"name": "pyodide", "version": "0.29.0"}', "{} holds Pyodide 0.29.0, and cramhy needs 314.0.7."),
        (
            '{"name": "pyodide", "version": "314.0.7"}',
            "{} lacks pyodide.mjs, pyodide.asm.mjs, pyodide.asm.wasm, python_stdlib.zip, pyodide-lock.json of Pyodide 314.0.7.",
        ),
    ],
)
def test_a_folder_without_the_pyodide_that_is_needed(tmp_path, package, complaint):
    if package is not None:
        (tmp_path / "package.json").write_text(package)
    with pytest.raises(UnfitPyodide) as refused:
        pyodide_files.copied(tmp_path, tmp_path / "out")
    advice = " Fetch it with: npm pack pyodide@314.0.7, and unpack that; or in a clone of cramhy: make pyodide."
    assert str(refused.value) == complaint.format(tmp_path) + advice
    assert not (tmp_path / "out").exists()
