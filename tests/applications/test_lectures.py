"""The lectures of the course, cell by cell: what each cell of their notebooks gives is what SBCL 2.5 gave for it.

The notebooks are not ours to ship: CRAMHY_APPLICATIONS names a folder with a checkout of ``cram_teaching``. ``typed/lectures.json`` has, by
notebook and number of the cell, the printed values or the class of the error, with the addresses of objects left out. It was written by
SBCL, which evaluated the same cells in the same order with ASDF and alexandria. Cells that draw random numbers, that name folders, or that
never end are not in it. Lectures 6 and 7 need ROS, which that SBCL did not have.
"""

from __future__ import annotations

import io
import json
import os
import re
from pathlib import Path

import pytest

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

HERE = Path(__file__).parent
CHECKOUTS = os.environ.get("CRAMHY_APPLICATIONS")
STANDARD_ERRORS = {"DIVISION-BY-ZERO", "END-OF-FILE", "SIMPLE-ERROR", "TYPE-ERROR", "UNBOUND-VARIABLE", "UNDEFINED-FUNCTION"}
OTHERWISE = {("02_simple_world/lecture_2_imperative", 93): "VALUE T"}
"""Where cramhy differs on purpose: two literals of the same characters may be `eq` (docs/differences.md, literals)."""
LECTURES = json.loads((HERE / "typed" / "lectures.json").read_text(encoding="utf-8"))


def cells(notebook):
    """The code of the cells of a notebook."""
    found = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return [text for cell in found if cell["cell_type"] == "code" and (text := "".join(cell["source"])).strip()]


def plain(text):
    """A printed value without the addresses of objects and the parameters of anonymous functions, white space being one blank."""
    text = re.sub(r"\{[0-9A-F]+\}", "{}", " ".join(text.split()))
    return re.sub(r"#<FUNCTION \(LAMBDA .*?\) \{\}>", "#<FUNCTION (LAMBDA) {}>", text)


def given(session, text):
    """What a cell gives: its values, or its error."""
    try:
        return plain("VALUE " + " ; ".join(prin1_to_string(value) for value in session.evaluate_text(text)))
    except Condition as problem:
        return "ERROR " + "-".join(re.findall(r"[A-Z][a-z]*", type(problem).__name__)).upper()
    except TypeError:
        return "ERROR SIMPLE-PROGRAM-ERROR"  # the wrong number of arguments, as the prompt tells it, too


def agree(came, expected):
    """Whether two results are alike. Errors of classes that the standard does not name only have to be errors."""
    error, _, name = expected.partition(" ")
    return came == expected or (error == "ERROR" and name not in STANDARD_ERRORS and came.startswith("ERROR "))


@pytest.mark.skipif(not CHECKOUTS, reason="CRAMHY_APPLICATIONS names no folder with a checkout of cram_teaching")
@pytest.mark.parametrize("lecture", LECTURES)
def test_each_cell_of_a_lecture_gives_what_sbcl_gives(lecture, monkeypatch):
    notebook = Path(CHECKOUTS) / "cram_teaching" / "lectures" / "robot_programming_with_lisp" / f"{lecture}.ipynb"
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(notebook.parent))
    monkeypatch.chdir(notebook.parent)
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    expected, wrong = LECTURES[lecture], []
    with Image():
        session = Session(time="virtual", seed=1, turtlesim=False)
        session.evaluate_text("(setf *print-pretty* nil)")
        for number, text in enumerate(cells(notebook)):
            if wanted := OTHERWISE.get((lecture, number), expected.get(str(number))):
                came = given(session, text)
                if not agree(came, wanted):
                    wrong.append(f"{number}: {text}\n  here: {came}\n  wanted: {wanted}")
    assert not wrong, "\n".join(wrong)
