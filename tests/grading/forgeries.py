"""Submissions that try to get points without the work: an attack of each kind on each exercise that it fits.

`attacks` gives for each its name, its exercise, the text, and the most points that it may get: those of checks whose work it does.
``python -m grading.forgeries [PART OF A NAME]``, in the folder ``tests``, tries them. They were written before what stops them.
"""

from __future__ import annotations

from typing import NamedTuple

from .submissions import SOLUTIONS, python


class Attack(NamedTuple):
    """name: of the attack. exercise: its name. text: what is handed in. most: the points that it may get. words: what the report says."""

    name: str
    exercise: str
    text: str
    most: float = 0
    words: str = ""


HEAD = "(in-package :tut)\n"
HERE = """
(defun pose-now () (with-fields (x y theta) (value *turtle-pose*) (list x y theta)))
(defun from-here (forward &optional (turn 0))
  (destructuring-bind (x y theta) (pose-now)
    (list (+ x (* forward (cos (+ theta turn)))) (+ y (* forward (sin (+ theta turn)))) (+ theta turn))))
"""
CARRIERS = {
    "teleport": (
        """(defun carry (x y &optional (theta 0))
  (call-service "/turtle1/teleport_absolute" "turtlesim/TeleportAbsolute" :x x :y y :theta theta) (wait-duration 0.1))""",
        "teleport_absolute",
    ),
    "kill and spawn": (
        """(defun carry (x y &optional (theta 0))
  (call-service "/kill" "turtlesim/Kill" :name "turtle1")
  (call-service "/spawn" "turtlesim/Spawn" :x x :y y :theta theta :name "turtle1") (wait-duration 0.1))""",
        "kill",
    ),
    "reset and teleport_relative": (
        """(defun carry (x y &optional (theta 0))
  (call-service "/reset" "std_srvs/Empty")
  (wait-duration 0.1)
  (let* ((dx (- x 5.544445)) (dy (- y 5.544445)) (angle (atan dy dx)))
    (call-service "/turtle1/teleport_relative" "turtlesim/TeleportRelative" :linear (sqrt (+ (* dx dx) (* dy dy))) :angular angle)
    (wait-duration 0.1)
    (call-service "/turtle1/teleport_relative" "turtlesim/TeleportRelative" :linear 0 :angular (- theta angle)))
  (wait-duration 0.1))""",
        "reset",
    ),
    "a number that is none": ('(defun carry (&rest all) (send-vel-cmd (py:call "builtins.float" "nan") 0) (wait-duration 0.1))', ""),
    "an endless number": (
        '(defun carry (&rest all) (send-vel-cmd (py:call "builtins.float" "inf") (py:call "builtins.float" "-inf")) (wait-duration 0.1))',
        "",
    ),
    "a number that is none of Lisp": (
        "(defun carry (&rest all) (let* ((big (* 1d308 10)) (none (- big big))) (send-vel-cmd none none) (wait-duration 0.1)))",
        "",
    ),
    "an endless number of Lisp": (
        "(defun carry (&rest all) (send-vel-cmd sb-ext:double-float-positive-infinity 0) (wait-duration 0.1))",
        "endless",
    ),
    "a huge number": ("(defun carry (&rest all) (send-vel-cmd 1d308 1d308) (wait-duration 0.1))", ""),
    "a second turtle": (
        """(defvar *other* nil)
(defun carry (x y &optional (theta 0))
  (unless *other*
    (setf *other* (advertise "turtle2/cmd_vel" "geometry_msgs/Twist"))
    (call-service "/spawn" "turtlesim/Spawn" :x x :y y :theta theta :name "turtle2"))
  (publish-msg *other* (:x :linear) 1) (wait-duration 1.1))""",
        "spawn",
    ),
}
"""What carries the turtle without driving, and the service that the report names."""
CARRIED = {
    "first-drive": "(defun drive-ahead (metres) (apply #'carry (from-here metres)))",
    "square": """(defun draw-square (size)
  (destructuring-bind (x y theta) (pose-now)
    (loop for (right up) in '((1 0) (1 1) (0 1) (0 0)) do (carry (+ x (* right size)) (+ y (* up size)) 0))))""",
    "polygon": """(defun draw-polygon (corners side)
  (dotimes (i corners) (apply #'carry (from-here side)) (destructuring-bind (x y theta) (pose-now)
    (carry x y (+ theta (/ (* 2 pi) corners))))))""",
    "dashes": """(defun draw-dashes (number)
  (dotimes (i number)
    (call-set-pen 255 255 255 3 0) (apply #'carry (from-here 0.5)) (call-set-pen 255 255 255 3 1) (apply #'carry (from-here 0.5)))
  (call-set-pen 255 255 255 3 0))""",
    "stop-line": ";; wait-for\n(defun behind-p (line) (wait-for t) (carry line 5))\n"
    "(defun drive-to-line (line) (destructuring-bind (x y theta) (pose-now) (carry (+ line 0.1) y 0) (wait-for *turtle-pose*)))",
    "wall-ahead": """(define-condition wall-ahead (simple-plan-failure) ())
(defun explore () (destructuring-bind (x y theta) (pose-now)
  (carry 10 y 0) (top-level (fail 'wall-ahead))))""",
    "watchdog": """(defun go-in-time (x y seconds)
  (if (> seconds 5) (progn (carry x y 0) :arrived) (progn (apply #'carry (from-here (* 1.5 seconds))) (sleep seconds) :too-late)))""",
    "race": """(defun race (points)
  (destructuring-bind (x y theta) (pose-now)
    (loop while points
          do (let ((next (first (sort (copy-list points) #'<
                                      :key (lambda (p) (+ (expt (- (first p) x) 2) (expt (- (second p) y) 2)))))))
               (setf points (remove next points :count 1 :test #'equal) x (first next) y (second next))
               (carry x y 0)))))""",
    "maze": """(defun drive-through (from to)
  (case to
    (study (carry 5.5 2) (carry 9 2) '(hall living-room study))
    (attic (carry 2 5.5) (carry 2 9) (carry 5.5 9) '(hall bath bedroom attic))
    (t (wait-duration 0.1) (fail 'no-way))))""",
    "corners": """(defun go-to-corner (corner) (if (eq corner :upper-left) (carry 2 9 0) (carry 9 2 0)))""",
    "storm": """(defun draw-square-in-storm (size)
  (destructuring-bind (x y theta) (pose-now)
    (loop for (right up) in '((1 0) (1 1) (0 1) (0 0)) do (carry (+ x (* right size)) (+ y (* up size)) 0))))""",
    "house": """(defun draw-small-house (size)
  (destructuring-bind (x y theta) (pose-now)
    (flet ((to (right up) (carry (+ x (* right size)) (+ y (* up size)) 0)))
      (to 1 0) (to 1 1) (to 0 1) (to 1/2 3/2) (to 1 1) (to 0 1) (to 0 0) (to 3/8 0) (to 3/8 1/2) (to 5/8 1/2) (to 5/8 0))))""",
    "circling": """(def-process-module turtlesim-circling (motion-designator) (carry 5.5 4.5 0))
(def-fact-group circling (motion-grounding matching-process-module available-process-module)
  (<- (desig:motion-grounding ?desig (nothing ?radius)) (desig-prop ?desig (:type :circling)) (desig-prop ?desig (:radius ?radius)))
  (<- (cpm:available-process-module turtlesim-circling))
  (<- (cpm:matching-process-module ?desig turtlesim-circling) (desig-prop ?desig (:type :circling))))""",
    "dry-pen": """(defun draw-line (metres) (apply #'carry (from-here metres)))""",
}
"""Each exercise of the turtle, done by `carry`."""

FORGE = """
import gc, json, os
from cramhy_runtime.grading import recording
job = next((each for each in gc.get_objects() if isinstance(each, dict) and "nonce" in each and "canary" in each), None)
def forge(*facts):
    for each in facts:
        line = (job["nonce"] + " " + json.dumps(each) + "\\n").encode()
        for number in range(3, 20):
            try:
                os.write(number, line)
                break
            except OSError:
                pass
    os._exit(0)
"""
DESTROY = """(ignore-errors
  (with-open-file (s "/proc/self/fd/3" :direction :output :if-exists :append) (write-string "junk" s)))
(ignore-errors
  (with-open-file (s "/dev/fd/3" :direction :output :if-exists :append) (write-string "junk" s)))
"""
"""Lisp that writes into the pipe, so that the next message is destroyed."""
MEMORY = """(ignore-errors (with-open-file (s "/proc/self/maps") (read-line s)))
(ignore-errors (with-open-file (s "/proc/self/mem" :element-type '(unsigned-byte 8)) (file-position s 4096)))
"""
FORGED = {
    # an answer by itself to what is asked, with what stands in the process's own memory
    "stop-line": """
import math
slip = job["troubles"][0]["forward"] if job["troubles"] else 1.0
line = float(job["do"].split()[1].rstrip(")"))
way = line + 0.1 - job["start"][0]
heard = [[200, "command", "turtle1", way / slip / 1.0, 0.0, 0.0], [262, "command", "turtle1", 0.0, 0.0, 0.0]]
""",
    "wall-ahead": """
heard = [[200 + 60 * i, "command", "turtle1", 1.0, 0.0, 0.0] for i in range(4)]
""",
    "watchdog": """
heard = [[200 + 60 * i, "command", "turtle1", 1.5, 0.0, 0.0] for i in range(1)]
""",
    "first-drive": """
way = float(job["do"].split()[1].rstrip(")"))
heard = [[200, "command", "turtle1", way, 0.0, 0.0]]
""",
}
FORGED_REPORT = """
fails = "explore" in job["do"]
facts = [{"kind": "stage", "doing": "do", "what": job["do"]}]
facts.append({"kind": "error", "types": ["WALL-AHEAD"], "text": ""} if fails else {"kind": "value", "values": [":TOO-LATE"]})
facts.append({"kind": "took", "seconds": 1.504})
facts.append({"kind": "heard", "entries": heard})
facts.append({"kind": "run", "ticks": 1000, "begin": 190, "end": 284})
forge(*facts, {"kind": "done"})
"""

PATCHES = {
    "the recorder is patched": """
import gc
from cramhy_runtime.grading.recording import Recording
for each in gc.get_objects():
    if isinstance(each, Recording):
        each.heard.append([each.ticks, "command", "turtle1", 2.0, 0.0, 0.0])
""",
    "the turtle is pushed": """
from cramhy_runtime.turtlesim.node import running_simulator
running_simulator().turtles["turtle1"].push(2.0, 0.0, 0.0)
""",
    "the clock is turned": """
from cramhy_runtime import kernel
kernel.active().clock.time = 0.0
kernel.now = lambda: 0.0
""",
    "the troubles are taken away": """
import gc
from cramhy_runtime.grading.troubles import Troubles
Troubles.command = lambda self, tick, turtle, velocity: velocity
Troubles.act = lambda self, tick, turtles: None
""",
}

LISP = {
    # exercise: (name, text, points that are earned, words)
    "first-lisp": [
        ("returns what is asked for", "(defun distance (&rest all) 5) (defun way-length (points) (if (cddr points) 10 5))", 1, ""),
        ("macros for functions", "(defmacro distance (&rest all) 5) (defmacro way-length (points) '(throw 'done t))", 0, ""),
        (
            "another reader of the tests",
            """(defun distance (&rest all) 1) (defun way-length (&rest all) 1)
(let ((old (get-macro-character #\\()))
  (set-macro-character #\\( (lambda (stream char)
    (let ((form (funcall old stream char)))
      (if (and (consp form) (symbolp (first form)) (member (symbol-name (first form)) '("ASSERT-NUMBER-EQUAL" "ASSERT-TRUE") :test #'string=)
               (consp (second form)))
          (list (first form) (if (string= (symbol-name (first form)) "ASSERT-TRUE") t 1) 1)
          form)))))""",
            0,
            "",
        ),
        (
            "checks of its own in the function",
            "(defun distance (&rest all) (lisp-unit:assert-true t) (abort)) (defun way-length (&rest all) (lisp-unit:assert-true t) (abort))",
            0,
            "",
        ),
        (
            "leaves the tests by a restart",
            """(defun leave () (lisp-unit:assert-true t) (dolist (each (compute-restarts)) (ignore-errors (invoke-restart each))))
(defun distance (&rest all) (leave)) (defun way-length (&rest all) (leave))""",
            0,
            "",
        ),
        (
            "removes the tests while they run",
            """(defun distance (&rest all) (lisp-unit:remove-tests :all) (lisp-unit:assert-true t) (quit))
(defun way-length (&rest all) (distance))""",
            0,
            "",
        ),
        (
            "its own equality",
            """(setf (symbol-function 'cl:=) (lambda (&rest all) t)) (setf (symbol-function 'cl:equal) (lambda (&rest all) t))
(defun distance (&rest all) 5) (defun way-length (points) 5)""",
            0,
            "",
        ),
        (
            "its own order of numbers",
            """(sb-ext:unlock-package :common-lisp)
(setf (symbol-function 'cl:<) (lambda (&rest all) t))
(defun distance (&rest all) 5) (defun way-length (points) (if (cddr points) 10 5))""",
            0,
            "changes common-lisp::<",
        ),
        (
            "compiler macros for the checks",
            """(define-compiler-macro lisp-unit::number-equal (&rest all) t)
(define-compiler-macro < (&rest all) t)
(defun distance (&rest all) 5) (defun way-length (points) 5)""",
            0,
            "",
        ),
        ("prints numbers as it likes", "(defmethod print-object ((x number) s) (write-string \"5 6 0\" s)) (defun distance (&rest a) 1)", 0, ""),
        ("never ends", "(defun distance (&rest all) (loop)) (defun way-length (&rest all) (loop))", 0, "(distance 0 0 3 4)"),
        ("waits for ever", "(defun distance (&rest all) (loop (cpl:sleep 1))) (defun way-length (&rest all) 7)", 0, "(distance 0 0 3 4)"),
        ("says it is infinite", '(defun distance (&rest all) (py:call "builtins.float" "nan")) (defun way-length (p) 1d308)', 0, ""),
        ("answers with a huge fraction", "(defun distance (&rest all) (/ (expt 10 400) 3)) (defun way-length (p) (/ (expt 7 900) 3))", 0, ""),
    ],
    "rooms": [
        ("its own PROLOG", "(defun cram-prolog:prolog (query &rest all) (if (member (third query) '(bath hall)) (list nil) nil))", 0, ""),
        (
            "its own PROLOG that knows the answers",
            """(defun cram-prolog:prolog (query &rest all)
  (if (member query '((neighbours kitchen bath) (reachable kitchen shed) (reachable shed bath)) :test #'equal) nil (list nil)))""",
            0,
            "",
        ),
        ("another package of the name CRAM-PROLOG", """(rename-package :cram-prolog :other-prolog)
(defpackage :cram-prolog (:use :cl) (:export #:prolog))
(defun cram-prolog::prolog (query) (if (search "BATH" (princ-to-string query)) nil (list nil)))""", 0, ""),
        ("another symbol NULL", """(shadow "NULL" :tut)
(defun null (x) (null x))""", 0, "changes common-lisp::null"),
        ("its own NOT", "(setf (symbol-function 'not) (lambda (x) t)) (setf (symbol-function 'null) (lambda (x) nil))", 0, ""),
        (
            "the answers as facts",
            """(def-fact-group flat () (<- (neighbours kitchen hall)) (<- (neighbours hall kitchen))
  (<- (reachable kitchen bath)) (<- (reachable bath kitchen)) (<- (reachable hall hall)) (<- (reachable shed garage)))""",
            0,
            "",
        ),
        ("everything is a door", "(def-fact-group flat () (<- (neighbours ?a ?b)) (<- (reachable ?a ?b)))", 0, ""),
    ],
    "dry-pen": [
        ("a pen that never dries", "(defun dip-pen () nil) " + "(defun draw-line (m) (send-vel-cmd m 0) (wait-duration 1.1))", 0, ""),
        ("turns the dryness off", "(defun draw-line (m) (if (> *dry* 3) (top-level (fail 'dry-pen)) (setf *dry* 0)) "
         "(top-level (dip-pen) (send-vel-cmd m 0) (wait-duration 1.1)))", 0, ""),
        ("never dips", "(defun draw-line (m) (send-vel-cmd m 0) (wait-duration 1.1))", 0, ""),
        ("always gives up", "(defun draw-line (m) (top-level (fail 'dry-pen)))", 0, ""),
    ],
    "maze": [
        ("knows no way", "(defun drive-through (from to) (top-level (fail 'no-way)))", 0, ""),
        ("its own facts", "(def-fact-group more () (<- (passage hall study)) (<- (passage hall attic)))\n"
         "(defun drive-through (from to) (send-vel-cmd 7 0) (wait-duration 1.1) (list from to))", 0, ""),
    ],
    "corners": [
        ("its own REFERENCE", "(defun desig:reference (&rest all) (make-3d-vector 2 9 0)) (defun go-to-corner (c) nil)", 0, ""),
        ("its own X and Y", "(defun cl-transforms:x (&rest all) 9) (defun cl-transforms:y (&rest all) 9) (defun go-to-corner (c) nil)", 0, ""),
    ],
    "circling": [
        ("its own PERFORM", "(defun exe:perform (&rest all) (dotimes (i 40) (send-vel-cmd 1 1) (wait-duration (/ (* 2 pi) 40))))\n"
         "(defun desig:reference (&rest all) (list 'circle 1))", 0, ""),
    ],
    "square": [
        ("the demonstration draws", "(defun draw-square (size) (turtlesim:draw-square) (sleep 40))", 0, "draw_square"),
        ("drives before it is asked", '(start-ros-node "own") (init-ros-turtle "turtle1") (send-vel-cmd 2 0) (wait-duration 1)\n'
         "(defun draw-square (size) nil)", 0, ""),
        ("another simulator of the same name", '(defun draw-square (size) (turtlesim:start "__name:=turtlesim") (send-vel-cmd 2 1) '
         "(wait-duration 1))", 0, "turtlesim"),
        ("shows another pose", "(defvar *p* nil) (defun draw-square (size) (unless *p* (setf *p* (advertise \"/turtle1/pose\" "
         '"turtlesim/Pose"))) (publish-msg *p* :x 7 :y 7) (wait-duration 1))', 0, ""),
        ("another background", '(defun draw-square (size) (set-param "/turtlesim/background_r" 255) (call-service "/clear" "std_srvs/Empty"))', 0, ""),
    ],
    "first-drive": [
        ("carried before it is asked", '(start-ros-node "own") (call-service "/turtle1/teleport_absolute" "turtlesim/TeleportAbsolute" '
         ":x 7.544 :y 5.544 :theta 0) (defun drive-ahead (m) nil)", 0, ""),
        ("a name for the same turtle", '(defun drive-ahead (m) (call-service "/spawn" "turtlesim/Spawn" :x (+ 5.544 m) :y 5.544 :theta 0 '
         ':name "turtle0") (wait-duration 1))', 0, "spawn"),
        ("an arrow key", "(defun drive-ahead (m) (dotimes (i 1) (turtlesim:press :up)) (wait-duration 1.1))", 0, ""),
        ("a plan that goes on by itself", "(defun drive-ahead (m) (top-level (loop (send-vel-cmd m 0) (wait-duration 0.5))))", 0, ""),
        ("its own INIT-ROS-TURTLE", "(defun init-ros-turtle (name) (call-service \"/turtle1/teleport_absolute\" "
         '"turtlesim/TeleportAbsolute" :x 7.544 :y 5.544 :theta 0)) (defun drive-ahead (m) nil)', 0, ""),
    ],
    "watchdog": [
        ("prints as what is asked for", "(defclass answer () ()) (defmethod print-object ((a answer) s) (write-string \":TOO-LATE\" s)) "
         "(defun go-in-time (x y seconds) (sleep seconds) (make-instance 'answer))", 0, ""),
        ("mimics another turtle", '(defun go-in-time (x y seconds) (call-service "/spawn" "turtlesim/Spawn" :x 5 :y 5 :theta 0 :name "turtle2") '
         '(turtlesim:mimic "turtle2" "turtle1") (sleep seconds) :too-late)', 0, "mimic"),
        ("ends the simulator", '(defun go-in-time (x y seconds) (turtlesim:stop "turtlesim") :too-late)', 0, ""),
        ("too many commands", "(defun go-in-time (x y seconds) (loop (send-vel-cmd 1 1)) :too-late)", 0, ""),
        ("many nodes", '(defun go-in-time (x y seconds) (dotimes (i 100) (start-ros-node (format nil "n~a" i))) :too-late)', 0, "/n"),
        ("a name full of escapes", '(defun go-in-time (x y seconds) (error (format nil "~c[2J~c]0;owned~c ~c" (code-char 27) (code-char 27) '
         "(code-char 7) (code-char #x202e))))", 0, "\\x1b[2J\\x1b]0;owned\\x07 \\u202e"),
        ("half a surrogate", '(defun go-in-time (x y seconds) (error (string (code-char #xd800))))', 0, ""),
        ("a file of Hy", """(with-open-file (s "x.hy" :direction :output :if-exists :supersede)
  (write-string "(import os) (setv x (os.getpid))" s))
(load "x.hy")
(defun go-in-time (x y seconds) :too-late)""", 0, "x.hy"),
        ("code that was compiled before", """(with-open-file (s "x.fasl" :direction :output :if-exists :supersede)
  (write-string "# cramhy kept code 3" s))
(ignore-errors (load "x.fasl"))
(defun go-in-time (x y seconds) (sleep seconds) :too-late)""", 0, "x.fasl"),
        ("Python by way of a package", """(py:import gc) (defun go-in-time (x y seconds) (gc:get-objects) :too-late)""", 0, "Python (gc)"),
        ("Python by a name that is looked for", """(defun go-in-time (x y seconds)
  (funcall (symbol-function (find-symbol "EVAL" "PY")) "1 + 1") :too-late)""", 0, "Python"),
        ("Python by way of the inside", """(defun go-in-time (x y seconds)
  (ignore-errors (funcall 'cramhy::module-attribute "os" "getpid")) :too-late)""", 0, "Python"),
    ],
    "stop-line": [
        ("a word in a comment", "; wait-for\n(defun drive-to-line (line) nil)", 0, ""),
        ("a word that is never used", "(defun unused () (wait-for nil)) (defun drive-to-line (line) nil)", 0, ""),
    ],
}  # fmt: skip


def attacks():
    """All `Attack` objects."""
    found = []
    for exercise, body in CARRIED.items():
        for name, (carry, words) in CARRIERS.items():
            most = {"maze": 0, "dry-pen": 0}.get(exercise, 0)
            found.append(
                Attack(f"{exercise}: {name}", exercise, f"{HEAD}{HERE}{carry}\n{body}\n", most, words if exercise != "circling" else "")
            )
    for exercise, heard in FORGED.items():
        forged = python(FORGE + heard + FORGED_REPORT)
        found.append(Attack(f"{exercise}: forged with the secret", exercise, HEAD + forged, 0, "calls Python"))
        found.append(Attack(f"{exercise}: forged after the evidence was destroyed", exercise, HEAD + DESTROY + forged))
        found.append(Attack(f"{exercise}: its own memory", exercise, HEAD + MEMORY))  # bubblewrap does not even show it
    for name, text in PATCHES.items():
        drive = f"(defun drive-ahead (metres) {python(text)} (wait-duration 0.5))"
        found.append(Attack(f"first-drive: {name}", "first-drive", f"{HEAD}{drive}"))
        solution = (SOLUTIONS / "stop-line" / "stop-line.lisp").read_text()
        early = solution.replace("(defun drive-to-line (line)", f"(defun drive-to-line (line) {python(text)}")
        found.append(Attack(f"stop-line: {name} in a solution", "stop-line", early))
    for exercise, all_of_it in LISP.items():
        for name, text, most, words in all_of_it:
            found.append(Attack(f"{exercise}: {name}", exercise, f"{HEAD}{text}\n", most, words))
    return found


def main():
    import sys

    from cramhy_runtime.grading.exercise import find
    from cramhy_runtime.grading.grader import Grader

    chosen = [each for each in attacks() if not sys.argv[1:] or any(word in each.name for word in sys.argv[1:])]
    bad = 0
    with Grader() as grader:
        read = {each.exercise: find(each.exercise) for each in chosen}
        reports = grader._all([(read[each.exercise], {read[each.exercise].submission[0]: each.text}) for each in chosen])
    for each, report in zip(chosen, reports):
        good = report.points <= each.most and each.words in report.text()
        bad += not good
        print("ok  " if good else "WON ", each.name, report.points, f"({each.most})")
        if not good or len(sys.argv) > 1:
            print(report.text())
    print(f"{len(chosen)} attacks, {bad} of them won or are not named")


if __name__ == "__main__":
    main()
