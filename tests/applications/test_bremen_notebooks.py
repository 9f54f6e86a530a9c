"""The float answers in the notebooks of Bremen's Lisp course are SBCL's.

Each cell without a package that SBCL lacks is typed into both, form by form. The notebooks are not ours to ship: ``cram_teaching`` in the
folder that CRAMHY_APPLICATIONS names.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from cramhy_runtime.repl.session import Session

CHECKOUTS = os.environ.get("CRAMHY_APPLICATIONS")
pytestmark = [
    pytest.mark.skipif(not CHECKOUTS, reason="CRAMHY_APPLICATIONS names no folder with checkouts of CRAM's applications"),
    pytest.mark.skipif(shutil.which("sbcl") is None, reason="sbcl is not installed"),
]
LECTURES = Path(CHECKOUTS or ".") / "cram_teaching" / "lectures"
NOTEBOOKS = sorted([*LECTURES.glob("robot_programming_with_lisp/0*/lecture*.ipynb"), *LECTURES.glob("tutorials/01*.ipynb")])
FLOAT = re.compile(r"\d\.\d")
ENDLESS = re.compile(r"\(loop\s*\)|\(read\b|mapcan|mapcon|nconc", re.I)
TYPED = """
(defun cl-user::typed (text)
  (with-input-from-string (in text)
    (with-output-to-string (answers)
      (handler-case
          (loop for form = (read in nil in) until (eq form in)
                do (let* ((written (prin1-to-string form)) (printed (make-string-output-stream))
                          (values (handler-case
                                      (let ((*standard-output* printed) (*standard-input* (make-string-input-stream "")))
                                        (handler-bind ((warning #'muffle-warning)) (multiple-value-list (eval form))))
                                    (serious-condition () (list :error)))))
                     (format answers "~s => ~{~s~^ ; ~} ~s~%~c" written values (get-output-stream-string printed) (code-char 1))))
        (error () nil)))))
"""


def cells(path):
    """The code of a notebook that comes to an end by itself."""
    found = ["".join(cell["source"]) for cell in json.loads(path.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
    return [text for text in found if not text.lstrip().startswith("%") and not ENDLESS.search(text)]


def lisp_string(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def of_sbcl(texts):
    program = (
        "(setf *random-state* (make-random-state nil))"
        + TYPED
        + "".join(f"(write-string (cl-user::typed {lisp_string(text)}))\n" for text in texts)
    )
    made = subprocess.run(["sbcl", "--script", "/dev/stdin"], input=program, capture_output=True, text=True, timeout=60)
    return made.stdout


def with_floats(answers):
    """The answers that show a float, and no function or address."""
    return [answer for answer in answers.split("\1") if FLOAT.search(answer) and "{" not in answer]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_float_answers_of_a_notebook_are_those_of_sbcl(path):
    texts = cells(path)
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text(TYPED)
    ours = "".join(session.evaluate_text(f"(cl-user::typed {lisp_string(text)})")[0] for text in texts)
    theirs = with_floats(of_sbcl(texts))
    assert len(theirs) > 0 or "oop" in path.stem
    assert [answer for answer in theirs if answer not in with_floats(ours)] == []
