"""Reports as the platforms of courses read them: GitHub Classroom, Moodle's VPL and CodeRunner. nbgrader calls `notebook_points`.

* GitHub Classroom: its reporter takes the result of a test run as JSON, in base64, in a variable of the workflow. Source: the schema of
  ``classroom-resources/autograding-grading-reporter``, version 1.
* VPL: ``vpl_execution`` prints comments between ``<|--`` and ``--|>``, and a line ``Grade :=>> N``. Source: VPL's documentation for
  teachers.
* CodeRunner: a template grader prints a JSON object with ``fraction`` from 0 to 1, and a table. Source: CodeRunner's documentation,
  "Combinator template grading".
* nbgrader: a cell whose last value is a number gives that many points. Source: nbgrader's documentation, "Autograded answer cells".
"""

from __future__ import annotations

import json

from .report import Report

EXPECTED_LOCKS = ("time", "memory", "file size", "files", "network", "processes", "signals")


def missing_locks(report: Report) -> list[str]:
    """The locks of the sandbox that did not hold while a submission ran; nothing if none ran."""
    return [lock for lock in EXPECTED_LOCKS if lock not in report.held] if report.held else []


def github(report: Report) -> str:
    """The result as GitHub Classroom's reporter reads it, one line of JSON."""
    tests = [
        {
            "name": check.title,
            "status": "pass" if check.passed else "fail",
            "score": check.points,
            "max_score": check.most,
            "message": "\n".join(check.wrong),
            "test_code": "",
            "filename": "",
            "line_no": 0,
            "duration": 0,
        }
        for check in report.checks
    ]
    result = {"version": 1, "status": "pass" if report.passed else "fail", "max_score": report.most, "tests": tests}
    return json.dumps(result, ensure_ascii=False) + "\n"


def vpl(report: Report) -> str:
    """The lines that VPL takes for comments and for the grade. In VPL set the activity's highest grade to the points of the exercise."""
    lines = []
    for check in report.checks:
        said = [f"-{check.title} ({check.points:g}/{check.most:g})"]
        said += [f"{'>' if line.startswith(' ') else ''}{line}" for sentence in check.wrong for line in sentence.splitlines()]
        lines += ["<|--", *map(_harmless, said), "--|>"]
    return "\n".join([*lines, f"Grade :=>> {report.points:g}", ""])


def _harmless(line):
    """A line without what VPL would take for its own: an error text may hold anything."""
    return line.replace(":=>>", ": =>>").replace("<|--", "< |--").replace("--|>", "-- |>")


def coderunner(report: Report) -> str:
    """The JSON object of a template grader, one line."""
    rows = [["iscorrect", "Check", "Points", "What is wrong"]]
    rows += [[int(check.passed), check.title, f"{check.points:g}/{check.most:g}", "\n".join(check.wrong)] for check in report.checks]
    fraction = report.points / report.most if report.most else float(report.passed)
    return json.dumps({"fraction": round(fraction, 6), "testresults": rows, "prologuehtml": "", "epiloguehtml": ""}) + "\n"


def notebook_points(exercise: str, **files: str) -> float:
    """The points of a solution that stands in a notebook, for a cell of nbgrader: ``notebook_points("square", square_lisp=In[3])``.

    exercise: as of `grade`. files: the texts of the files by name, with an underscore for the point. The report is printed for the student.
    """
    from .exercise import find
    from .grader import Grader

    found = find(exercise)
    names = {name.replace(".", "_").replace("-", "_"): name for name in found.submission}
    with Grader() as grader:
        report = grader.grade_texts(found, {names.get(word, word): text for word, text in files.items()})
    print(report.text())
    return report.points


FORMATS = {"text": Report.text, "json": Report.json, "github": github, "vpl": vpl, "coderunner": coderunner}

__all__ = ["coderunner", "FORMATS", "github", "missing_locks", "notebook_points", "vpl"]
