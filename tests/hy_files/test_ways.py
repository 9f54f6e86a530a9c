"""A ``.hy`` file gives the same by ``hy``, by ``cramhy run``, as Python made by ``hy2py``, by an import, and in a test of pytest."""

import re
import sys
from pathlib import Path

import pytest

COURSE = Path(__file__).parents[2] / "tutorials" / "cram_my_beginner_tutorial" / "src"
ORDER = """package control-turtlesim simple-plans motion-designators location-designators action-designators conditions process-modules
selecting-process-modules high-level-plans""".split()

LECTURE = """
(start-ros-node "lecture")
(init-ros-turtle "turtle1")
(drive 5 2)
(print (top-level
         (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
           (navigate-without-pen (list 3 4 0))
           (draw-house))))
(with-fields (x y theta) (value *turtle-pose*)
  (format t "~&~,4f ~,4f ~,4f~%" x y theta))
"""
USES = """\
(require cramhy *)
(in-package :cram-user)
(print :before)
(asdf:load-system :cram-my-beginner-tutorial)
(in-package :tut)
(start-ros-node "uses")
(init-ros-turtle "turtle1")
(print (drive 5 2))
(sleep 2)
(with-fields (x y) (value *turtle-pose*)
  (format t "~&~,3f ~,3f~%" x y))
"""
PLAIN = """\
(require cramhy *)
(import cramhy_runtime.cpl *)
(defn drive [speed]
  "Drive."
  (+ speed 1))
(setv answer (top-level (par (drive 5) (sleep 1))))
(print "drove" answer)
(defn lose []
  (top-level (fail "Lost.")))
"""
PARTS = """\
(require cramhy *)
(defpackage :my-parts (:use :cpl))
(in-package :my-parts)
(defvar *count* 3)
(defun drive (speed)
  (+ speed 1))
(defun lose ()
  (top-level (fail "Lost.")))
"""


def course():
    """The files of the course as one, with a lecture at its end."""
    texts = ((COURSE / f"{name}.hy").read_text().replace("(require cramhy *)\n", "") for name in ORDER)
    return "(require cramhy *)\n" + "".join(texts) + LECTURE


def outcome(done):
    return done.returncode, done.stdout, done.stderr


@pytest.mark.soak
def test_the_course_gives_the_same_output_in_four_ways(write, program, python):
    path = write("course.hy", course())
    first = program("hy", "course.hy")
    assert (first.returncode, first.stderr) == (0, "")
    assert re.search(r"^\d\.\d{4} \d\.\d{4} -?\d\.\d{4}\n\Z", first.stdout, re.M)
    assert outcome(program("hy", "course.hy")) == outcome(first)  # from kept code
    assert outcome(program("run", "course.hy")) == outcome(first)
    made = python("-c", "from hy.cmdline import hy2py_main; hy2py_main()", "course.hy", "-o", "course_in_python.py")
    assert (made.returncode, made.stderr) == (0, "")
    path.unlink()
    assert outcome(python("course_in_python.py")) == outcome(first)


@pytest.mark.soak
@pytest.mark.parametrize("again", [False, True])
def test_what_follows_the_load_of_a_system_may_use_its_package(write, program, again):
    write("uses.hy", USES)
    for _ in range(1 + again):
        first, second = program("hy", "uses.hy"), program("run", "uses.hy")
        assert outcome(first) == outcome(second)
        assert (first.returncode, first.stderr) == (0, "")
        assert first.stdout.startswith("\n:BEFORE ") and "\n1 \n" in first.stdout


@pytest.mark.soak
def test_hy2py_of_plain_hy_runs(write, program, python):
    write("plan.hy", PLAIN)
    made = python("-c", "from hy.cmdline import hy2py_main; hy2py_main()", "plan.hy", "-o", "made.py")
    assert (made.returncode, made.stderr) == (0, "")
    assert outcome(python("made.py")) == outcome(program("hy", "plan.hy")) == (0, "drove 6\n", "")


@pytest.mark.parametrize("way", ["hy", "run"])
def test_a_program_has_its_name_and_its_neighbours(write, program, way):
    write("neighbour.hy", "(setv answer 42)\n")
    write("plan.hy", "(import sys neighbour)\n(print (get sys.argv 0) neighbour.answer __name__)\n")
    done = program(way, "plan.hy")
    assert done.stdout.removeprefix(str(Path(done.args[-1]).parent)).split()[1:] == ["42", "__main__"]
    assert done.stdout.split()[0].endswith("plan.hy")


@pytest.mark.soak
def test_python_imports_both_kinds(write, python):
    write("plan.hy", PLAIN)
    write("parts.hy", PARTS)
    write(
        "main.py",
        """\
import hy
import plan
import parts
from cramhy_runtime.cpl import PlanFailure

print(plan.drive(1), plan.answer, plan.drive.__doc__)
print(parts.drive(1), parts.count)
for lose in (plan.lose, parts.lose):
    try:
        lose()
    except PlanFailure as failure:
        print(failure)
""",
    )
    for _ in range(2):
        done = python("main.py")
        assert outcome(done) == (0, "drove 6\n2 6 Drive.\n2 3\nLost.\nLost.\n", "")


@pytest.mark.soak
def test_pytest_imports_both_kinds(write, python):
    write("plan.hy", PLAIN)
    write("parts.hy", PARTS)
    write(
        "test_plans.py",
        """\
import hy
import pytest
from cramhy_runtime import kernel
from cramhy_runtime.cpl import PlanFailure
import plan
import parts


def test_values():
    assert (plan.drive(1), plan.answer, parts.drive(1)) == (2, 6, 2)


@pytest.mark.parametrize("name", ["plan", "parts"])
def test_failures(name):
    module = __import__(name)
    with pytest.raises(PlanFailure, match="Lost."):
        module.lose()
    assert kernel.now() == 0.0
""",
    )
    words = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", "test_plans.py"]
    done = python(*words, PYTEST_DISABLE_PLUGIN_AUTOLOAD="1")
    assert done.returncode == 0, done.stdout


@pytest.mark.soak
def test_pytest_shows_the_place_of_a_form_that_cannot_be_compiled(write, python):
    write("plan.hy", "(require cramhy *)\n(defn drive []\n  (let ((x 1)) x))\n")
    write("test_plans.py", "import hy\nimport plan\n\ndef test_it():\n    pass\n")
    words = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", "test_plans.py"]
    shown = python(*words, PYTEST_DISABLE_PLUGIN_AUTOLOAD="1").stdout
    assert "plan.hy" in shown and "line 3" in shown
    assert "The let form is malformed: a part of it has another shape; expected: List" in shown


@pytest.mark.soak
def test_the_prompt_of_lisp_shows_that_place_too(write, python):
    write("plan.hy", "(require cramhy *)\n(defn drive []\n  (let ((x 1)) x))\n")
    shown = python("-m", "cramhy_runtime.cli", "repl", input='(load "plan.hy")\n0\n(+ 1 2)\n').stdout
    assert "The let form is malformed: a part of it has another shape; expected: List (i.e., `[ … ]`).\n  at plan.hy:3:8\n" in shown
    assert "  It is written (let [name value ...] form...).\n" in shown
    assert "CL-USER> (+ 1 2)" in shown or "CL-USER> 3" in shown


BENCH = """\
(require cramhy *)
(in-package :cram-user)
(defun fib (n) (if (< n 2) n (+ (fib (- n 1)) (fib (- n 2)))))
(print (fib 20))
(top-level (dotimes (i 500) (par (sleep 1) (sleep 2))))
"""


@pytest.mark.soak
def test_kept_code_runs_as_fast_as_with_cramhy_run(write, program, tmp_path):
    """Processor time of the second run, by the best of three, so that a busy machine does not matter."""
    resource = pytest.importorskip("resource")
    write("bench.hy", BENCH)

    def seconds(way):
        program(way, "bench.hy")
        found = []
        for _ in range(3):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            assert program(way, "bench.hy").returncode == 0
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            found.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        return min(found)

    assert seconds("hy") < 1.7 * seconds("run") + 0.15
    assert list((tmp_path / "__pycache__").glob(f"bench.{sys.implementation.cache_tag}.pyc"))


@pytest.mark.parametrize("way", ["hy", "run"])
def test_a_package_that_is_defined_twice_is_warned_of_once(write, program, way):
    write(
        "twice.hy",
        "(require cramhy *)\n(defpackage :parts (:use :cl) (:export :drive :stop))\n(defpackage :parts (:use :cl) (:export :drive))\n",
    )
    done = program(way, "twice.hy")
    assert done.stderr == "WARNING: PARTS also exports the following symbols:\n  (PARTS:STOP)\n"
