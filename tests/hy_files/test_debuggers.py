"""Python's tools show lines of Hy: ``pdb`` where a plan says ``(breakpoint)``, and ``coverage`` with our plugin."""

import pdb
import sys

import pytest

pytestmark = pytest.mark.soak

PLAIN = """\
(require cramhy *)
(import cramhy_runtime.cpl *)
(defn drive [speed]
  (if (> speed 3)
    (do
      (setv twice (* 2 speed))
      {stop}
      (+ twice 1))
    (setv never (+ 4 speed))))
(print (top-level (par (drive 5)
                       (sleep 1))))
"""
LISP = """\
(require cramhy *)
(in-package :cram-user)
(defun drive (speed)
  (if (> speed 3)
      (progn
        (print speed)
        (+ speed 1))
      (drive
        4)))
(print (top-level (par (drive 5)
                       (sleep 1))))
"""


@pytest.mark.parametrize("way", [["-m", "hy"], ["-m", "cramhy_runtime.cli", "run"]])
def test_a_breakpoint_in_a_branch_of_a_plan_stops_there(write, python, way):
    write("plan.hy", PLAIN.format(stop="(breakpoint)"))
    shown = python(*way, "plan.hy", input="p twice\nw\nc\n").stdout
    there = "plan.hy(7)drive()\n-> (breakpoint)" if sys.version_info >= (3, 13) else "plan.hy(8)drive()\n-> (+ twice 1))"
    assert f"{there}\n(Pdb) 10\n" in shown
    assert "plan.hy(10)<lambda>()\n-> (print (top-level (par (drive 5)\n" in shown
    assert shown.endswith("11\n")


def test_pdb_stops_at_a_line_of_a_hy_file(write, python):
    path = write("plan.hy", "(defn drive [speed]\n  (setv twice (* 2 speed))\n  (+ twice 1))\n(print (drive 5))\n")
    if pdb.Pdb().lookupmodule(str(path)) is None:
        pytest.skip("this pdb takes lines of .py files only")
    shown = python("-m", "pdb", "-m", "hy", "plan.hy", input=f"b {path}:3\nc\np twice\nc\nq\n").stdout
    assert "plan.hy(3)drive()\n-> (+ twice 1))\n(Pdb) 10\n" in shown


@pytest.mark.parametrize("way", [["-m", "hy"], ["-m", "cramhy_runtime.cli", "run"]])
@pytest.mark.parametrize(("text", "missing"), [(PLAIN.format(stop="None"), "9"), (LISP, "8")])
def test_coverage_reports_the_lines_of_a_file(write, python, way, text, missing):
    pytest.importorskip("coverage")
    write("plan.hy", text)
    write(".coveragerc", "[run]\ncore = ctrace\nplugins = cramhy_runtime.coverage_plugin\ninclude = */plan.hy\n")
    done = python("-m", "coverage", "run", *way, "plan.hy")
    assert done.returncode == 0, done.stderr
    table = python("-m", "coverage", "report", "-m").stdout
    (line,) = [line for line in table.splitlines() if line.startswith("plan.hy")]
    assert line.split()[-1] == missing, table
