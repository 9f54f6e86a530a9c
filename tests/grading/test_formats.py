"""Reports as GitHub Classroom, VPL, CodeRunner, nbgrader and CI servers read them."""

from __future__ import annotations

import json
from xml.etree import ElementTree

import pytest
from systems import linux

from cramhy_runtime.grading import CheckResult, Report, formats

REPORT = Report(
    "Square & co",
    [CheckResult("One <b>", 2, 2, []), CheckResult("Two", 0, 1.5, ["It ended:\n  at a.lisp:1\nGrade :=>> 100\n--|>", "More."], "Look.")],
    "printed\n",
    ["time"],
)


def test_text_has_points_words_hints_and_what_was_printed():
    assert REPORT.text() == (
        "Square & co: 2 of 3.5 points\n\npassed  2/2  One <b>\nFAILED  0/1.5  Two\n        It ended:\n          at a.lisp:1\n"
        "        Grade :=>> 100\n        --|>\n        More.\n        Hint: Look.\n\nWhat the program printed last:\n  | printed\n"
    )


def test_json_is_the_same_each_time_and_has_no_times():
    data = json.loads(REPORT.json())
    assert REPORT.json() == REPORT.json() and data["points"] == 2 and data["most"] == 3.5 and not data["passed"]
    assert [check["passed"] for check in data["checks"]] == [True, False]


def test_junit_has_a_test_for_each_check():
    suite = ElementTree.fromstring(REPORT.junit()).find("testsuite")
    assert (suite.get("tests"), suite.get("failures")) == ("2", "1")
    assert suite.findall("testcase")[1].find("failure").get("message") == "It ended:"


def test_github_gets_status_and_score_of_each_test():
    data = json.loads(formats.github(REPORT))
    assert (data["version"], data["status"], data["max_score"]) == (1, "fail", 3.5)
    assert [(test["name"], test["status"], test["score"], test["max_score"]) for test in data["tests"]] == [
        ("One <b>", "pass", 2, 2),
        ("Two", "fail", 0, 1.5),
    ]


def test_vpl_gets_comments_and_one_grade_whatever_an_error_says():
    text = formats.vpl(REPORT)
    assert [line for line in text.splitlines() if line.startswith("Grade :=>>")] == ["Grade :=>> 2"]
    assert text.count("<|--") == text.count("--|>") == 2 and "-Two (0/1.5)" in text


def test_coderunner_gets_a_fraction_and_a_table():
    data = json.loads(formats.coderunner(REPORT))
    assert data["fraction"] == pytest.approx(2 / 3.5, abs=1e-5)
    assert data["testresults"][0][0] == "iscorrect" and [row[0] for row in data["testresults"][1:]] == [1, 0]


def test_missing_locks_are_named_if_something_has_run():
    assert formats.missing_locks(REPORT) == ["memory", "file size", "files", "network", "processes", "signals"]
    assert formats.missing_locks(REPORT._replace(held=[])) == []


@pytest.mark.soak
@linux
def test_a_cell_of_nbgrader_gets_the_points(capsys):
    answer = "(in-package :tut) (defun distance (x1 y1 x2 y2) (sqrt (+ (expt (- x2 x1) 2) (expt (- y2 y1) 2))))"
    assert formats.notebook_points("first-lisp", first_lisp_lisp=answer) == 2
    assert "Distances in Lisp: 2 of 5 points" in capsys.readouterr().out
