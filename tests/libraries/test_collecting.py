"""Tests in Lisp files: pytest collects them, ``cramhy test`` runs them, and their reports name form, values and line."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from xml.etree import ElementTree

import pytest

from cramhy_runtime import cli
from cramhy_runtime.languages.commonlisp.systems import systems, unit_tests

FILES = {
    "proj.asd": """(defsystem "proj"
  :components ((:module "src" :serial t :components ((:file "package") (:file "code"))))
  :in-order-to ((test-op (test-op "proj/tests"))))
(defsystem "proj/tests" :depends-on ("proj" "lisp-unit" "fiveam")
  :components ((:module "tests" :components ((:file "unit") (:file "five")))))
""",
    "src/package.lisp": "(defpackage :sums (:use :cl) (:export #:my-max))",
    "src/code.lisp": "(in-package :sums) (defun my-max (a b) (if (> a b) a a))",
    "tests/unit.lisp": """(defpackage :sums-tests (:use :cl :sums :lisp-unit))
(in-package :sums-tests)
(define-test maximum
  (assert-equal 3 (my-max 3 2))
  (let ((x 2))
    (assert-equal 5 (my-max x 5) x)))
(define-test erring (assert-true t)
  (car 5))
(define-test fine (assert-true t))
""",
    "tests/five.lisp": """(defpackage :sums-five (:use :cl :sums :5am))
(in-package :sums-five)
(def-suite proj) (in-suite proj)
(test five-good (is (= 3 (my-max 3 2))))
(test five-bad
  (is (= 5 (my-max 2 5))))
(test five-skip (skip "not now"))
""",
    "tests/no-tests-here.lisp": "(this is never read",
    "other/endless-test.lisp": """(defpackage :endless (:use :cl :lisp-unit))
(in-package :endless)
(define-test spins (loop))
(define-test waits (cpl:wait-for (cpl:make-fluent :value nil)))
(define-test after (assert-true t))
""",
    "other/test-plan.hy": """(require cramhy *)
(defpackage :hy-plan (:use :cl :lisp-unit))
(in-package :hy-plan)
(define-test in-hy (assert-equal '(1 2) (list 1 2)))
""",
    "broken/broken-tests.lisp": "(defpackage :broken (:use :cl :lisp-unit))\n(in-package :broken)\n(define-test x (let ((x 1 2)) x))\n",
    "good/test-all.lisp": "(defpackage :all-good (:use :cl :5am)) (in-package :all-good) (test good (is (= 1 1)))\n",
}


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A folder with a system that has tests, and the working directory of the test."""
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_pytest(*arguments):
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", *arguments]
    return subprocess.run(command, capture_output=True, text=True, env={**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"})


@pytest.mark.soak
def test_pytest_reports_form_values_and_line(project):
    done = run_pytest("tests", "other", "--lisp-limit", "1")
    assert done.returncode == 1
    assert "5 failed, 4 passed, 1 skipped" in done.stdout, done.stdout + done.stderr
    for text in (
        """\
SUMS-TESTS::MAXIMUM ______________________________
 | Failed Form: (MY-MAX X 5)
 | Expected 5 but saw 2
 | X => 2
  at tests/unit.lisp:6:5
      (assert-equal 5 (my-max x 5) x)))
      ^
""",
        """\
 | Execution error:
 | The value
     5
   is not of type
     LIST
   when binding LIST
  at tests/unit.lisp:8:3
    (car 5))
    ^
""",
        """\
(MY-MAX 2 5)
 evaluated to
2
 which is not
=
 to
5
  at tests/five.lisp:6:3
    (is (= 5 (my-max 2 5))))
    ^
""",
        "The test did not end within 1 seconds, and was stopped.\n  at other/endless-test.lisp:3",
        "main waits for the fluent",
    ):
        assert text in done.stdout.replace(" \n", "\n")


@pytest.mark.soak
def test_a_file_that_cannot_be_loaded_is_an_error_of_collection(project):
    done = run_pytest("broken", "good")
    assert done.returncode == 2
    assert """ERROR collecting broken/broken-tests.lisp""" in done.stdout
    assert (
        """\
  A binding is a variable or (variable value), not (X 1 2).
  at broken/broken-tests.lisp:3:16
"""
        in done.stdout
        or "at broken/broken-tests.lisp:3" in done.stdout
    )


@pytest.mark.soak
def test_an_asd_file_named_on_the_command_line(project):
    assert "3 failed, 2 passed, 1 skipped" in run_pytest("proj.asd").stdout


@pytest.mark.parametrize(
    "name, expected",
    [
        ("tests/unit.lisp", True),
        ("tests/no-tests-here.lisp", False),
        ("src/code.lisp", False),
        ("other/endless-test.lisp", True),
        ("other/test-plan.hy", True),
        ("proj.asd", False),
        ("missing-test.lisp", False),
    ],
)
def test_which_files_look_like_tests(project, name, expected):
    assert unit_tests.looks_like_tests(project / name) is expected


@pytest.fixture
def command(project, session, capsys, monkeypatch):
    """A function: exit status, standard output and standard error of ``cramhy test``."""
    monkeypatch.setattr("cramhy_runtime.ros.search_folders.extra_folders", [str(project)])
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)

    def run(*arguments):
        capsys.readouterr()
        status = cli.main(["test", *arguments, "--no-turtlesim"])
        return status, *capsys.readouterr()

    yield run
    for name in ("proj", "proj/tests"):
        systems.forget_system(name)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("path", ["proj", "proj.asd", "tests"])
def test_cramhy_test_prints_the_libraries_summaries(command, path):
    status, printed, _ = command(path)
    assert status == 1
    assert (
        """\
Unit Test Summary
 | 4 assertions total
 | 3 passed
 | 1 failed
 | 1 execution errors
 | 0 missing tests
"""
        in printed
    )
    assert " | Failed Form: (MY-MAX X 5)\n | Expected 5 but saw 2\n | X => 2\n" in printed
    assert " Did 3 checks.\n    Pass: 1 (33%)\n    Skip: 1 (33%)\n    Fail: 1 (33%)\n" in printed


def test_the_status_is_0_when_all_is_well(command):
    status, printed, _ = command("good/test-all.lisp")
    assert (status, "Pass: 1 (100%)" in printed) == (0, True)


def test_a_test_that_never_ends_is_stopped_and_the_others_run(command):
    status, printed, _ = command("other/endless-test.lisp", "--limit", "0.3")
    assert status == 1
    assert "| The test did not end within 0.3 seconds, and was stopped." in printed and " | 2 execution errors" in printed
    assert "AFTER: 1 assertions passed, 0 failed." in printed


@pytest.mark.parametrize(
    "path, text",
    [
        ("no-such-system", 'cramhy: ASDF:MISSING-COMPONENT\n  Component "no-such-system" not found\n'),
        ("src/code.lisp", "There are no tests of lisp-unit or FiveAM in src/code.lisp."),
        ("tests/no-tests-here.lisp", "end of file"),
        ("nowhere.lisp", "nowhere.lisp"),
        ("broken/broken-tests.lisp", "broken/broken-tests.lisp:3"),
    ],
)
def test_what_is_wrong(command, path, text):
    status, _, problem = command(path)
    assert status == 1 and text in problem


@pytest.mark.soak
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("test_z_python.py", "import cram_my_beginner_tutorial as tut\n\n\ndef test_it():\n    assert tut.drive\n"),
        ("test_z_in_hy.hy", "(require cramhy *)\n(import cram-my-beginner-tutorial :as tut)\n(defn test-it [] (assert tut.drive))\n"),
    ],
    ids=["Python", "Hy"],
)
def test_what_imports_a_system_may_be_collected_after_a_lisp_file(project, name, text):
    (project / name).write_text(text)
    done = run_pytest("good/test-all.lisp", name)
    assert done.returncode == 0 and "2 passed" in done.stdout, done.stdout + done.stderr


def test_cramhy_test_tells_file_line_and_values_of_what_failed(command):
    status, printed, _ = command("proj")
    told = printed.replace(" \n", "\n").partition(" FAILURES ")[2]
    assert status == 1
    for text in (
        " | Failed Form: (MY-MAX X 5)\n | Expected 5 but saw 2\n | X => 2\n"
        "  at tests/unit.lisp:6:5\n      (assert-equal 5 (my-max x 5) x)))\n      ^\n",
        "   when binding LIST\n  at tests/unit.lisp:8:3\n    (car 5))\n    ^\n",
        "(MY-MAX 2 5)\n evaluated to\n2\n which is not\n=\n to\n5\n  at tests/five.lisp:6:3\n    (is (= 5 (my-max 2 5))))\n    ^\n",
        "FAILED tests/unit.lisp:6:5 SUMS-TESTS::MAXIMUM - (MY-MAX X 5) Expected 5 but saw 2 X => 2\n"
        "FAILED tests/unit.lisp:8:3 SUMS-TESTS::ERRING - Execution error: The value 5 is not of type LIST when binding LIST\n"
        "FAILED tests/five.lisp:6:3 SUMS-FIVE::FIVE-BAD - (MY-MAX 2 5) evaluated to 2 which is not = to 5\n",
    ):
        assert text in told
    assert re.search(r"\n3 failed, 2 passed, 1 skipped in \d+\.\d\ds\n\Z", told)


def test_of_a_run_without_failures_it_tells_the_counts_alone(command):
    _, printed, _ = command("good/test-all.lisp")
    assert re.search(r"\n1 passed in \d+\.\d\ds\n\Z", printed) and "FAILURES" not in printed


def test_a_reason_of_the_users_own_hides_no_values(command, project):
    (project / "reasons-test.lisp").write_text(
        "(defpackage :reasons (:use :cl :5am)) (in-package :reasons)\n(test sums\n"
        '  (is (= 5 (+ 1 2)) "Sum ~a." 1)\n  (is-true (evenp 3) "Odd.")\n  (is-false (oddp 3) "Not ~a." 3)\n  (is (oddp (+ 1 3)) "Four."))\n'
    )
    status, printed, _ = command("reasons-test.lisp")
    library, _, told = printed.replace(" \n", "\n").partition(" FAILURES ")
    assert "      Sum 1.\n --------" in library and "evaluated to" not in library  # the original's text
    assert "\nSum 1.\n(+ 1 2)\n evaluated to\n3\n which is not\n=\n to\n5\n  at reasons-test.lisp:3:3\n" in told
    assert "\nOdd.\n(EVENP 3) did not return a true value\n  at reasons-test.lisp:4:3\n" in told
    assert "\nNot 3.\n(ODDP 3) returned the value T, which is true\n  at reasons-test.lisp:5:3\n" in told
    assert "\nFour.\n(+ 1 3)\n evaluated to\n4\n which does not satisfy\nODDP\n  at reasons-test.lisp:6:3\n" in told


def test_a_file_for_ci_servers_has_the_results(command, project):
    status, printed, _ = command("proj", "--junit", "results.xml")
    (suite,) = ElementTree.parse(project / "results.xml").getroot()
    assert {name: suite.get(name) for name in ("tests", "failures", "errors", "skipped")} == {
        "tests": "6", "failures": "3", "errors": "0", "skipped": "1"
    }  # fmt: skip
    cases = {case.get("name"): case for case in suite}
    assert [
        (case.get("classname"), name, case.get("file"), case.get("line"), [child.tag for child in case]) for name, case in cases.items()
    ] == [
        ("SUMS-TESTS", "MAXIMUM", "tests/unit.lisp", "3", ["failure"]),
        ("SUMS-TESTS", "ERRING", "tests/unit.lisp", "7", ["failure"]),
        ("SUMS-TESTS", "FINE", "tests/unit.lisp", "9", []),
        ("SUMS-FIVE", "FIVE-GOOD", "tests/five.lisp", "4", []),
        ("SUMS-FIVE", "FIVE-BAD", "tests/five.lisp", "5", ["failure"]),
        ("SUMS-FIVE", "FIVE-SKIP", "tests/five.lisp", "7", ["skipped"]),
    ]
    failure = cases["MAXIMUM"][0]
    assert failure.get("message") == "(MY-MAX X 5) Expected 5 but saw 2 X => 2" and "at tests/unit.lisp:6:5" in failure.text
    assert all(float(case.get("time")) >= 0 for case in suite) and cases["FIVE-SKIP"][0].get("message") == "not now"


def test_of_tests_that_cannot_be_loaded_the_file_tells_why(command, project):
    status, _, problem = command("broken", "--junit", "results.xml")
    (suite,) = ElementTree.parse(project / "results.xml").getroot()
    assert status == 1 and (suite.get("errors"), len(suite)) == ("1", 1) and "broken/broken-tests.lisp:3" in suite[0][0].text


@pytest.mark.parametrize("good", [True, False])
def test_a_system_that_tests_itself_is_one_test_in_the_file(command, project, good):
    (project / "itself.asd").write_text(f'(defsystem "itself" :perform (test-op (o c) {1 if good else "(car 5)"}))\n')
    status, _, problem = command("itself", "--junit", "results.xml")
    (suite,) = ElementTree.parse(project / "results.xml").getroot()
    assert (status, suite.get("tests"), suite.get("errors")) == (0 if good else 1, "1", "0" if good else "1")
    assert suite[0].get("name") == "itself"
    systems.forget_system("itself")


def test_characters_that_xml_cannot_hold_are_written_as_numbers(command, project):
    (project / "odd-test.lisp").write_text(
        '(defpackage :odd (:use :cl :lisp-unit)) (in-package :odd)\n(define-test odd (assert-equal "<&>" (format nil "a~c]]>\\"" (code-char 1))))\n'
    )
    command("odd-test.lisp", "--junit", "results.xml")
    assert 'Expected "<&>" but saw "a\\x01]]>' in ElementTree.parse(project / "results.xml").getroot()[0][0][0].text


def test_a_file_that_cannot_be_written_is_told_after_the_results(command):
    status, printed, problem = command("good/test-all.lisp", "--junit", "no/such/folder/results.xml")
    assert status == 1 and "1 passed in" in printed
    assert problem.startswith("cramhy: FILE-ERROR\n  Cannot write the results of the tests into no/such/folder/results.xml: No such file")


# ------------------------------------------------------------------------------------------- every test runs, or it is told

NONE = "There are no tests of lisp-unit or FiveAM in {}, though it is named like a file of tests."
MACRO = """(defpackage :by-macro (:use :cl :lisp-unit))
(in-package :by-macro)
(defmacro deftest (name &body body) `(define-test ,name ,@body))
  (deftest of-a-macro (assert-equal 1 2))
"""


@pytest.mark.soak
def test_pytest_finds_tests_of_macros_and_tells_of_lisp_files_without_any(project):
    (project / "odd").mkdir()
    for name in ("empty-test.lisp", "test-empty.lisp", "tests.lisp"):
        (project / "odd" / name).write_text("(defpackage :nothing (:use :cl))\n(in-package :nothing)\n(defun helper () 1)\n")
    (project / "odd" / "macro-tests.lisp").write_text(MACRO.replace("define-test ,", "lisp-unit::define-test ,"))
    (project / "odd" / "helper.lisp").write_text("(this is never read")
    done = run_pytest("odd/macro-tests.lisp")
    assert done.returncode == 1 and "1 failed" in done.stdout, done.stdout
    done = run_pytest("odd")
    assert done.returncode == 2 and "3 errors" in done.stdout and "passed" not in done.stdout, done.stdout
    for name in ("empty-test.lisp", "test-empty.lisp", "tests.lisp"):
        assert NONE.format(name) in done.stdout


@pytest.mark.soak
def test_a_helper_of_a_system_that_has_tests_may_be_named_like_tests(project):
    asd = (project / "proj.asd").read_text()
    (project / "tests" / "test-helper.lisp").write_text("(defpackage :helps (:use :cl))\n")
    (project / "proj.asd").write_text(asd.replace('(:file "unit")', '(:file "test-helper") (:file "unit")'))
    assert '"test-helper"' in (project / "proj.asd").read_text()
    done = run_pytest("tests")
    assert done.returncode == 1 and "3 failed, 2 passed, 1 skipped" in done.stdout, done.stdout


def test_cramhy_test_never_says_passed_when_nothing_ran(command, project):
    (project / "good" / "empty-test.lisp").write_text("(defpackage :nothing (:use :cl))\n")
    status, printed, problem = command("good")
    assert status == 1 and "passed" not in printed and NONE.format("empty-test.lisp") in problem
    (project / "plain").mkdir()
    (project / "plain" / "test_plain.hy").write_text("(defn test-plain [] (assert False))\n")
    status, printed, problem = command("plain")
    assert status == 1 and "passed" not in printed
    assert printed.startswith("Not run here, since it is in plain Hy: test_plain.hy. Run pytest.\n")
    assert "There are no tests of lisp-unit or FiveAM in plain." in problem
