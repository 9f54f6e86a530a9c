"""Tests of lisp-unit, FiveAM and pytest give points, and a submission that changes the libraries gets none."""

from __future__ import annotations

import pytest
from systems import linux

from cramhy_runtime.grading import Grader
from cramhy_runtime.grading.exercise import Exercise

pytestmark = linux

TOML = """
title = "Doubling"
submission = ["a.{ending}"]
before = []
[limits]
time = 8
[[check]]
title = "tests"
points = 2
tests = "tests.{ending}"
"""
TESTS = {
    "lisp-unit": """(defpackage :t1 (:use :cl :lisp-unit)) (in-package :t1)
(define-test doubles (assert-equal 4 (cl-user::double 2)))
(define-test of-zero (assert-equal 0 (cl-user::double 0)))""",
    "fiveam": """(defpackage :t2 (:use :cl :fiveam)) (in-package :t2)
(test doubles (is (= 4 (cl-user::double 2))))
(test of-zero (is (= 0 (cl-user::double 0))))""",
    "pytest": "import a\n\n\ndef test_doubles():\n    assert a.double(2) == 4\n\n\ndef test_of_zero():\n    assert a.double(0) == 0\n",
}
GOOD = {"lisp": "(defun double (x) (* 2 x))", "py": "def double(x):\n    return 2 * x\n"}
BAD = {"lisp": "(defun double (x) (+ 2 x))", "py": "def double(x):\n    return 2 + x\n"}
CHANGES = {
    "fiveam": '(setf (macro-function (find-symbol "IS" :fiveam)) (lambda (form environment) t))',
    "pytest": "import pytest, _pytest.runner, _pytest.python\n_pytest.python.Function.runtest = lambda self: None\n",
}


@pytest.fixture(scope="module")
def grader():
    with Grader() as made:
        yield made


def exercise(library, folder, more=""):
    ending = "py" if library == "pytest" else "lisp"
    (folder / "exercise.toml").write_text(TOML.format(ending=ending) + more)
    (folder / f"tests.{ending}").write_text(TESTS[library])
    return ending, Exercise.read(folder)


@pytest.mark.soak
@pytest.mark.parametrize("library", TESTS)
def test_right_and_wrong_functions(library, grader, tmp_path):
    ending, made = exercise(library, tmp_path)
    report = grader.grade_texts(made, {f"a.{ending}": GOOD[ending]})
    assert report.points == 2, report.text()
    report = grader.grade_texts(made, {f"a.{ending}": BAD[ending]})
    assert report.points == 0 and "of" in report.text() and "zero failed" in report.text().replace("_", "-").replace("of-zero", "zero"), (
        report.text()
    )
    assert "doubles" not in report.text().replace("doubles (", "")


@pytest.mark.soak
@pytest.mark.parametrize("library", CHANGES)
def test_changed_libraries_are_seen(library, grader, tmp_path):
    ending, made = exercise(library, tmp_path)
    report = grader.grade_texts(made, {f"a.{ending}": CHANGES[library] + "\n" + BAD[ending]})
    assert report.points == 0 and "tests are made of" in report.text(), report.text()


HIDDEN = """
title = "Hidden"
submission = ["a.lisp"]
before = []
[[check]]
title = "Secret"
hidden = true
ask = [["(double 21)", "42"]]
"""


def test_a_hidden_check_shows_nothing_that_its_run_printed(grader, tmp_path):
    (tmp_path / "exercise.toml").write_text(HIDDEN)
    report = grader.grade_texts(Exercise.read(tmp_path), {"a.lisp": '(defun double (x) (format t "asked for ~a" x) (error "~a" x))'})
    assert report.text() == "Hidden: 0 of 1 points\n\nFAILED  0/1  Secret\n        A question ended with an error.\n"
    assert report.held and "21" not in report.json()


def test_only_some_tests_may_count_and_a_missing_one_is_told(grader, tmp_path):
    _, made = exercise("lisp-unit", tmp_path, 'only = ["DOUBLES"]\n')
    assert grader.grade_texts(made, {"a.lisp": BAD["lisp"]}).points == 2
    _, made = exercise("lisp-unit", tmp_path, 'only = ["TRIPLES"]\n')
    assert "No test was run." in grader.grade_texts(made, {"a.lisp": GOOD["lisp"]}).text()
