"""Packages in the manner of CRAM's own, with their test systems, run as they are: ``package.xml``, ``.asd`` with ``:perform`` forms that call
functions through symbols, FiveAM and lisp-unit, threads and mutexes of SB-THREAD, deadlines, Bordeaux-Threads, CFFI.

They stand in ``workspace/src``. ``cram_tray_delivery`` has plans and a log that threads share, and is tested with FiveAM;
``cram_cup_counter`` uses the portability libraries, and is tested with lisp-unit.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.systems import systems

SOURCES = Path(__file__).parent / "workspace" / "src"
WRONG = """
(in-package :cram-tray-delivery-tests)
(in-suite plan-suite)
(deliverable-test hangs (:limit 3) (top-level (wait-for (make-fluent :value nil))))
(test wrong (is (= 4 (length (list 1 2 3)))))
"""


@pytest.fixture
def found(session, monkeypatch):
    """The session, in which the packages of the workspace are found."""
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(SOURCES))
    before = set(systems.systems)
    session.package = "CL-USER"
    yield session
    for name in set(systems.systems) - before:
        systems.forget_system(name)


@pytest.mark.soak
@pytest.mark.parametrize(
    ("system", "counts"), [("cram-tray-delivery", (15, 38)), ("cram-tray-delivery-tests", (15, 38)), ("cram-cup-counter/test", (6, 19))]
)
def test_all_tests_of_the_system_pass(found, system, counts, capsys, tmp_path):
    report = tmp_path / "report.xml"
    assert found.test(system, junit=str(report)) is True
    tests, checks = counts
    assert f"{tests} passed in" in capsys.readouterr().out
    (suite,) = ElementTree.parse(report).getroot()
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == (str(tests), "0", "0")


@pytest.mark.soak
@pytest.mark.parametrize(
    ("system", "summary"),
    [
        ("cram-tray-delivery", "Did 38 checks.\n    Pass: 38 (100%)"),
        ("cram-cup-counter/test", " | 19 assertions total\n | 19 passed\n | 0 failed"),
    ],
)
def test_the_perform_form_of_the_asd_file_runs_the_tests(found, system, summary, capsys):
    assert prin1_to_string(found.evaluate_text(f'(asdf:test-system "{system}")')[0]) == "T"
    assert summary in capsys.readouterr().out


def run(folder, *words):
    return subprocess.run(
        [sys.executable, "-m", *words],
        capture_output=True,
        text=True,
        cwd=folder,
        env={**os.environ, "ROS_PACKAGE_PATH": str(folder), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
    )


@pytest.fixture(scope="module")
def wrong(tmp_path_factory):
    """A copy of the workspace in which a test hangs, and one fails."""
    folder = tmp_path_factory.mktemp("workspace") / "src"
    shutil.copytree(SOURCES, folder, ignore=shutil.ignore_patterns("__pycache__"))
    with open(folder / "cram_tray_delivery" / "tests" / "plan-tests.lisp", "a") as file:
        file.write(WRONG)
    return folder


@pytest.mark.soak
def test_the_exit_code_says_whether_all_passed(wrong):
    done = run(wrong, "cramhy_runtime.cli", "test", "cram-tray-delivery-tests", "--features", "sbcl")
    assert done.returncode == 1, done.stdout + done.stderr
    assert "2 failed, 15 passed in" in done.stdout
    assert "HANGS hangs" in done.stdout and "plan-tests.lisp:" in done.stdout


@pytest.mark.soak
def test_pytest_runs_them_too_and_finds_the_system_beside_that_of_the_tests(wrong, tmp_path):
    package = wrong / "cram_tray_delivery"
    files = package / "cram-tray-delivery-tests.asd", package / "tests" / "time-tests.lisp"
    done = run(tmp_path, "pytest", "-q", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", *map(str, files))
    assert "2 failed, 20 passed in" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 1
