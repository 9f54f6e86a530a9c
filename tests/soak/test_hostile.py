"""Hostile programs: recursion without end, endless loops, a thousand branches. A clear error or a right answer, never a dead process.

A process that dies of its stack leaves nothing to catch, so what may kill it runs in a process of its own.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from systems import SOAK

ROOT = Path(__file__).parents[2]

ENDLESS = {
    "a function": "(defun endless (n) (+ 1 (endless n)))",
    "apply": "(defun endless (n) (apply #'endless (list n)))",
    "mapcar": "(defun endless (n) (mapcar #'endless (list n)))",
    "sort keys": "(defun endless (n) (sort (list n 2) #'< :key #'endless))",
    "reduce": "(defun endless (n &optional m) (reduce #'endless (list 1 2)))",
    "a generic function": "(progn (defgeneric endless (n)) (defmethod endless ((n integer)) (+ 1 (endless n))))",
    "around methods": "(progn (defgeneric endless (n)) (defmethod endless ((n integer)) (endless n)) "
    "(defmethod endless :around ((n integer)) (call-next-method)))",
    "initialize-instance": "(progn (defclass endless () ()) (defmethod initialize-instance :after ((x endless) &key) "
    "(make-instance 'endless)) (defun endless (n) (make-instance 'endless)))",
    "print-object": '(progn (defclass endless () ()) (defmethod print-object ((x endless) s) (format s "~a" x)) '
    '(defun endless (n) (format nil "~a" (make-instance \'endless))))',
    "handlers": '(defun endless (n) (handler-bind ((error (lambda (c) (endless c)))) (error "x ~a" n)))',
    "cleanup forms": "(defun endless (n) (unwind-protect (endless n) n))",
    "special variables": "(progn (defvar *deep* 1) (defun endless (n) (let ((*deep* n)) (endless n))))",
    "eval": "(defun endless (n) (eval `(endless ,n)))",
    "a fluent net": "(defun endless (n) (value (fl-funcall #'endless (make-fluent :value n))))",
    "a circular list": "(defun endless (n) (let ((x (list n n))) (setf (car x) x) (prin1-to-string x)))",
    "failure handling": "(defun endless (n) (with-failure-handling ((simple-plan-failure (e) (retry))) (endless n)))",
}
EXHAUSTED = (
    "Control stack exhausted: a function calls itself too deeply, perhaps without end.",
    "The form is nested too deeply to be compiled.",
)


def evaluate(forms, *options):
    """The answers of a fresh ``cramhy eval`` in CRAM-USER; that it lived to answer all is asserted."""
    environment = {**os.environ, "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}"}
    lines = "".join(json.dumps({"form": form}) + "\n" for form in forms)
    done = subprocess.run(
        [sys.executable, "-m", "cramhy_runtime.cli", "eval", "--package", "cram-user", "--no-turtlesim", *options],
        input=lines,
        capture_output=True,
        text=True,
        env=environment,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(answers) == len(forms)
    return answers


@pytest.mark.soak
def test_recursion_without_end_is_an_error_in_the_main_task_and_in_branches(backend):
    forms = []
    for definition in ENDLESS.values():
        forms += [f"(progn (fmakunbound 'endless) {definition})", "(endless 1)", "(top-level (par (sleep 1) (endless 1)))", "(+ 1 2)"]
    answers = evaluate(forms, "--backend", backend)
    for index, name in enumerate(ENDLESS):
        defined, in_main, in_branch, after = answers[4 * index : 4 * index + 4]
        assert defined["error"] is None, name
        for answer in (in_main, in_branch):
            assert answer["error"] and answer["error"]["message"] in EXHAUSTED, (name, answer)
        assert after["values"] == ["3"], name


@pytest.mark.soak(only=("greenlet",))
def test_recursion_that_ends_may_be_deep(backend):
    defined, main, branch = evaluate(
        ["(defun sum (n) (if (= n 0) 0 (+ n (sum (- n 1)))))", "(sum 4000)", "(top-level (par (sum 4000)))"], "--backend", backend
    )
    assert main["values"] == branch["values"] == ["8002000"]


@pytest.mark.soak
def test_branches_within_branches_without_end_are_an_error(backend):
    _, answer, after = evaluate(["(defun endless (n) (par (endless n)))", "(top-level (endless 1))", "(+ 1 2)"], "--backend", backend)
    assert answer["error"]["message"] == "Branches within branches, 1000 deep: a plan starts itself, perhaps without end."
    assert after["values"] == ["3"]


@pytest.mark.soak
def test_a_thousand_branches(backend):
    waits = " ".join(["(sleep 1)"] * 999)
    first, second = evaluate([f"(top-level (par 7 {waits}))", "(+ 1 2)"], "--backend", backend)
    assert first["values"] == ["7"] and second["values"] == ["3"]


@pytest.mark.soak(only=("greenlet",))
def test_thousands_of_tasks_are_evaporated_and_each_cleans_up(backend):
    count = "(let ((n 0)) (dotimes (i 20) (top-level (pursue (sleep 1) {}))) n)"
    branches = " ".join(["(unwind-protect (sleep 1000) (incf n))"] * 100)
    (answer,) = evaluate([count.format(branches)], "--backend", backend)
    assert answer["values"] == ["2000"]


HUGE = {
    "quoted lists": "'" + "(" * 20_000 + ")" * 20_000,
    "calls": "(+ 1 " * 20_000 + ")" * 20_000,
    "vectors": "#(" * 20_000,
    "quotes": "'" * 20_000 + "a",
    "lets": "(let ((x 1)) " * 20_000 + ")" * 20_000,
    "lambdas": "(lambda () " * 20_000 + ")" * 20_000,
    "a wide and": "(and " + "1 " * 20_000 + ")",
    "printing": "(let ((x nil)) (dotimes (i 100000) (setf x (list x))) (prin1-to-string x))",
    "copying": "(let ((x nil)) (dotimes (i 100000) (setf x (list x))) (equal x (copy-tree x)))",
    "a huge array": "(make-array 1000000000000000)",
    "macros": "(defmacro again (n) `(again ,n)) (again 1)",
}


@pytest.mark.soak
@pytest.mark.parametrize("form", HUGE.values(), ids=HUGE)
def test_huge_forms_and_values_are_an_error_at_most(form):
    answer, after = evaluate([form, "(+ 1 2)"])
    assert answer["error"] is None or answer["error"]["type"] in (
        "STORAGE-CONDITION",
        "CRAMHY::COMPILE-ERROR",
        "SB-INT:SIMPLE-READER-ERROR",
        "SB-INT::SIMPLE-READER-ERROR",
        "END-OF-FILE",
    ), answer
    assert after["values"] == ["3"]


REPEATED = """\
(defun plan ()
  (let ((goal (make-fluent :value 0)))
    (top-level
      (with-failure-handling ((simple-plan-failure (e) (declare (ignore e)) (return :failed)))
        (pursue
          (par (whenever ((pulsed goal)) (value goal)) (sleep 10))
          (seq (dotimes (i 3) (sleep 0.1) (setf (value goal) i))
               (unwind-protect (fail "enough ~a" (length (desig:properties (desig:a motion (type any) (goal 1)))))
                 (setf (value goal) nil))))))))"""
PROGRAM = f"""\
import gc, resource, sys
from cramhy_runtime.repl.session import Session

session = Session(time="virtual", backend=sys.argv[1], turtlesim=False)
session.package = "CRAM-USER"
session.evaluate_text({REPEATED!r})

def run(times):
    assert str(session.evaluate_text(f"(dotimes (i {{times}} :done) (plan))")[0]).upper().endswith("DONE")
    gc.collect()
    kilobytes = int(next(line for line in open("/proc/self/status") if line.startswith("VmRSS")).split()[1])
    return len(gc.get_objects()), kilobytes

run(100)
before = run(int(sys.argv[2]))
after = run(int(sys.argv[2]))
print(after[0] - before[0], after[1] - before[1])
"""


@pytest.mark.soak(only=("greenlet",))
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="only Linux tells")
def test_memory_does_not_grow_when_a_plan_is_repeated(backend):
    times = 1000 if SOAK else 200
    environment = {**os.environ, "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}"}
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, backend, str(times)], capture_output=True, text=True, env=environment, timeout=300
    )
    assert done.returncode == 0, done.stderr
    objects, kilobytes = map(int, done.stdout.split())
    print(f"{times} more repetitions on {backend}: {objects:+d} objects, {kilobytes:+d} KiB")
    assert objects < times / 10 + 50 and kilobytes < 4096
