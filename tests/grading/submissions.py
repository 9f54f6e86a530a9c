"""Submissions with the points that they must get: solutions, starting files, wrong ones, and malicious ones.

`cases` gives for each its name, its exercise, the texts of its files, and the points. ``python -m grading.submissions [PART OF A NAME]``, in
the folder ``tests``, grades them, and prints what differs and what it took.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from cramhy_runtime.grading.exercise import own_exercises

SOLUTIONS = Path(__file__).parent / "solutions"


class Case(NamedTuple):
    """name: of the submission. exercise: its name. texts: what is handed in. points: that it must get. words: what its report must say."""

    name: str
    exercise: str
    texts: dict[str, str | bytes]
    points: float
    words: str = ""


STARTS = {
    "circling": 0,
    "corners": 0,
    "dashes": 0,
    "dry-pen": 1,
    "first-drive": 0,
    "first-lisp": 0,
    "house": 0,
    "maze": 0,
    "polygon": 0,
    "race": 0,
    "rooms": 0,
    "square": 0,
    "stop-line": 0,
    "storm": 2,
    "wall-ahead": 0,
    "watchdog": 2,
}
"""The points of the starting files."""

WRONG = [
    # the exercise, what stands in the solution, what stands there instead, points, words of the report
    ("square", "(move-to (make-3d-vector x y 0))", "nil", 0, "m of the drawing are missing"),
    ("square", "(+ y size)", "(+ y 2)", 3, "With seed"),
    ("square", "(defun draw-square (size)", "(defun draw-sqare (size)", 0, "is undefined"),
    ("polygon", "(dotimes (corner corners)", "(dotimes (corner 3)", 2, "missing"),
    ("polygon", "(/ (* 2 pi) corners)", "(- (/ (* 2 pi) corners))", 0, "should not be there"),
    ("dashes", "(call-set-pen 255 255 255 3 1)", "nil", 0, "should not be there"),
    ("first-drive", "metres 0)", "(abs metres) 0)", 5, "The turtle ends at"),
    ("first-lisp", "(- y2 y1)", "(+ y2 y1)", 0, "which is not right"),
    ("stop-line", "(> x line)", "(< x line)", 0, "The turtle ends at"),
    ("watchdog", ":too-late", ":late", 2, "should give :TOO-LATE"),
    ("wall-ahead", "(< 1 x 10)", "(< 0.5 x 10.5)", 3, "The turtle ends at"),
    ("dry-pen", "(again 3)", "(again 1)", 1, "ended with an error"),
    ("circling", "(<- (cpm:matching-process-module ?desig turtlesim-circling)", "(<- (nothing ?desig)", 5, ""),
    ("rooms", "(door ?other ?one))", "(door ?one ?other))", 0, "gave NIL, which is not right"),
    ("race", "(shortest begin points)", "points", 0, "did not come to place"),
    ("maze", "(middle room)", "(middle to)", 5, "did not come to place 1"),
]


def python(text):
    """Lisp that runs Python."""
    text = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'(py:call "builtins.exec" "{text}" (py:call "builtins.dict"))\n'


FORGED = """
import os, json
for line in ({{"kind": "stage", "doing": "do", "what": "x"}}, {{"kind": "value", "values": ["1"], "seconds": 1}},
             {{"kind": "run", "heard": {heard}, "ticks": 3000, "begin": 100}}, {{"kind": "done"}}):
    for number in range(1, 20):
        try:
            os.write(number, ({nonce} + " " + json.dumps(line) + "\\n").encode())
        except OSError:
            pass
os._exit(0)
"""
NONCE = """
import gc
found = [each["nonce"] for each in gc.get_objects() if isinstance(each, dict) and "nonce" in each and "canary" in each]
"""
DELETE = """
import os, shutil
for place in ({exercises!r}, {submissions!r}):
    shutil.rmtree(place, ignore_errors=True)
    try:
        os.chmod(place, 0)
    except OSError:
        pass
    try:
        open(os.path.join(place, "square", "exercise.toml"), "w").close()
    except OSError:
        pass
"""
FORK_BOMB = """
import os, threading
while True:
    try:
        os.fork()
    except OSError:
        os.system("sleep 100 &")
"""
KILL = """
import os, signal
for process in (os.getppid(), -1, 0, 1, *(int(name) for name in os.listdir("/proc") if name.isdigit() and int(name) != os.getpid())):
    try:
        os.kill(process, signal.SIGKILL)
    except OSError:
        pass
os.killpg(os.getpgid(os.getppid()), signal.SIGKILL)
"""
DISK = """
import os
number = 0
while True:
    number += 1
    with open(f"file{number}", "wb") as file:
        file.write(b"x" * 3_000_000)
"""
PATCH = """
from cramhy_runtime.languages.commonlisp.systems import unit_tests
class Passed:
    failures, passed, skipped = [], 1, []
unit_tests.LispTest.run = lambda self: Passed
"""
SWALLOW_CPU_SIGNAL = """
import signal
signal.signal(signal.SIGXCPU, signal.SIG_IGN)
while True:
    pass
"""

EMPTY_SQUARE = "(in-package :tut)\n(defun draw-square (size) size)\n"
NO_LISP = "(in-package :tut)\n(defun distance (&rest all) 7)\n(defun way-length (&rest all) 7)\n"


def malicious(exercises, submissions):
    """(name, exercise, text, points, words). exercises, submissions: folders that one of them tries to delete."""
    forged = FORGED.format(nonce="'x'", heard="[[200, 'command', 'turtle1', 2.0, 0.0, 0.0]]")
    known = NONCE + FORGED.format(nonce="found[0]", heard="[[200, 'command', 'turtle1', 2.0, 0.0, 0.0]]")
    return [
        ("empty", "square", "", 0, "DRAW-SQUARE"),
        ("no text", "square", b"\xff\xfe\x00\x01" * 30, 0, "not UTF-8"),
        ("broken", "square", "(in-package :tut)\n(defun draw-square (size)", 0, "cannot be used"),
        ("loop when loaded", "square", "(loop)", 0, "was stopped"),
        ("loop in the plan", "square", "(in-package :tut)\n(defun draw-square (size) (loop))", 0, "(draw-square 2)"),
        ("loop that waits", "square", "(in-package :tut)\n(defun draw-square (size) (loop (cpl:sleep 1)))", 0, "turtle's time"),
        ("loop that ignores the limit", "square", python(SWALLOW_CPU_SIGNAL), 0, "was stopped"),
        ("read-time loop", "square", "#.(loop)", 0, "was stopped"),
        ("quit when loaded", "square", "(cl-user::quit)", 0, "ended the session"),
        ("quit in the plan", "square", "(in-package :tut)\n(defun draw-square (size) (cl-user::quit))", 0, "ended the session"),
        ("exit of the process", "square", python("import os\nos._exit(0)"), 0, "ended the process"),
        ("sleep on the wall clock", "square", python("import time\ntime.sleep(1000)"), 0, "waited for something"),
        (
            "prints that it is right",
            "square",
            EMPTY_SQUARE + '(format t "A square: 6 of 6 points~%passed  3/3~%Grade :=>> 6~%{\\"points\\": 6, \\"passed\\": true}~%")',
            0,
            "The paper is empty",
        ),
        ("forged reports", "square", python(forged), 0, "not from this run"),
        ("forged reports with the secret", "square", python(known), 0, "reports of its own"),
        ("teleports", "square", TELEPORTS, 0, "calls the service teleport_absolute"),
        ("changed checks of the tests", "first-lisp", NO_LISP + CHANGED_CHECKS, 0, ""),
        ("changed runner of the tests", "first-lisp", NO_LISP + python(PATCH), 0, ""),
        ("changed equality", "first-lisp", NO_LISP + CHANGED_EQUALITY, 0, ""),
        ("fork bomb", "square", python(FORK_BOMB), 0, "was stopped"),
        ("10 GB of output", "square", "(loop (write-line (make-string 100000 :initial-element #\\x)))", 0, "printed more than"),
        ("10 GB of output by Python", "square", python("import os\nwhile True:\n    os.write(1, b'x' * 1000000)"), 0, "printed more than"),
        ("kills the others", "square", python(KILL) + EMPTY_SQUARE, 0, ""),
        (
            "deletes the exercise",
            "square",
            python(DELETE.format(exercises=exercises, submissions=submissions)) + EMPTY_SQUARE,
            0,
            "calls Python",
        ),
        ("fills the disk", "square", python(DISK), 0, "No space left on device|wrote too many files"),
        ("takes all memory", "square", python("all = []\nwhile True:\n    all.append(bytearray(50_000_000))"), 0, "memory"),
        ("recursion without end", "square", "(in-package :tut)\n(defun draw-square (size) (+ 1 (draw-square size)))", 0, "error"),
        ("network", "square", python("import socket\nsocket.create_connection(('127.0.0.1', 22))"), 0, "cannot be used"),
    ]


TELEPORTS = """
(in-package :tut)
(defun draw-square (size)
  (with-fields (x y) (value *turtle-pose*)
    (loop for (right up) in '((1 0) (1 1) (0 1) (0 0))
          do (call-service "/turtle1/teleport_absolute" "turtlesim/TeleportAbsolute"
                           :x (+ x (* right size)) :y (+ y (* up size)) :theta 0)))
  (wait-duration 1))
"""
CHANGED_CHECKS = """
(dolist (name '("ASSERT-TRUE" "ASSERT-EQUAL" "ASSERT-NUMBER-EQUAL" "ASSERT-EQL"))
  (setf (macro-function (find-symbol name :lisp-unit)) (lambda (form environment) t)))
"""
CHANGED_EQUALITY = """
(setf (symbol-function 'lisp-unit:number-equal) (lambda (&rest all) t))
(setf (symbol-function 'cl:<) (lambda (&rest all) t))
"""

SHORT = {
    "solution of first-lisp",
    "solution of dry-pen",
    "solution of corners",
    "start of square",
    "wrong watchdog 1",
    "empty",
    "no text",
    "quit in the plan",
    "loop when loaded",
    "prints that it is right",
    "forged reports with the secret",
    "teleports",
    "changed checks of the tests",
    "10 GB of output",
    "kills the others",
    "deletes the exercise",
}
"""What CI grades; the rest is for make soak."""


def cases(exercises=None, submissions="/nowhere"):
    """All `Case` objects. exercises: the folder of the exercises, which one of them tries to delete."""
    exercises = exercises or str(next(iter(own_exercises().values())).parent)
    found = []
    for name, folder in own_exercises().items():
        file = f"{name}.lisp"
        most = None
        found.append(Case(f"solution of {name}", name, {file: (SOLUTIONS / name / file).read_text()}, most, "passed"))
        found.append(Case(f"start of {name}", name, {file: (folder / "start" / file).read_text()}, STARTS[name], "FAILED"))
    numbers = {}
    for name, old, new, points, words in WRONG:
        numbers[name] = numbers.get(name, 0) + 1
        text = (SOLUTIONS / name / f"{name}.lisp").read_text()
        assert old in text, (name, old)
        found.append(Case(f"wrong {name} {numbers[name]}", name, {f"{name}.lisp": text.replace(old, new)}, points, words))
    for name, exercise, text, points, words in malicious(exercises, submissions):
        found.append(Case(name, exercise, {f"{exercise}.lisp": text}, points, words))
    return found


def says(report, words):
    """Whether a report has the words of a case. Some differ between the sandboxes: ``|`` stands between them."""
    return any(each in report.text() for each in words.split("|"))


def hand_in(case, folder):
    """Write the files of a case into a folder of its own below ``folder``; that folder."""
    place = Path(folder, case.name.replace(" ", "-"))
    place.mkdir(parents=True)
    for name, text in case.texts.items():
        (place / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    return place


def main():
    import resource
    import sys
    import tempfile
    import time

    from cramhy_runtime.grading.exercise import Exercise
    from cramhy_runtime.grading.grader import Grader

    chosen = [case for case in cases() if not sys.argv[1:] or any(word in case.name for word in sys.argv[1:])]
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as folder, Grader(sandbox=os.environ.get("SANDBOX"), as_root=True) as grader:
        reports = grader.grade_all([(Exercise.read(own_exercises()[case.exercise]), hand_in(case, folder)) for case in chosen])
    for case, report in zip(chosen, reports):
        good = report.points == (report.most if case.points is None else case.points) and says(report, case.words)
        print("ok  " if good else "DIFF", case.name, report.points, f"({case.points})")
        if not good or os.environ.get("SHOW"):
            print(report.text())
    used = [resource.getrusage(whose) for whose in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    seconds = sum(each.ru_utime + each.ru_stime for each in used)
    print(f"{len(chosen)} submissions, {time.monotonic() - begun:.0f} s, {seconds:.0f} s of processors; load {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
