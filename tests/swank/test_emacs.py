"""A real Emacs with SLIME as Debian has it does what its users do. One Emacs does all of it; each test looks at one interaction."""

from __future__ import annotations

import glob
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from slides import test_lecture_38 as lecture_38
from slides.conftest import TUTORIAL, Workspace, environment, stable
from slides.test_lecture_34 import LOAD, control_package
from systems import needs_terminals

HERE = Path(__file__).parent
PLACES = ("/usr/share/emacs/site-lisp/elpa-src/slime-*", "/usr/share/emacs/site-lisp/slime", "~/.emacs.d/elpa/slime-*")
SLIME = next((path for place in PLACES for path in glob.glob(os.path.expanduser(place))), None)
EMACS = shutil.which("emacs")

pytestmark = [
    pytest.mark.skipif(EMACS is None, reason="emacs is not installed"),
    pytest.mark.skipif(SLIME is None, reason="SLIME is not installed"),
]

LINES_34 = [
    *LOAD,
    '(start-ros-node "cram_tutorial_client")',
    '(init-ros-turtle "turtle1")',
    "(value *turtle-pose*)",
    "(value *color-value*)",
    "(progn (turtlesim:press :left) (sleep 2) (turtlesim:press :left) (sleep 2) (turtlesim:press :up) (sleep 2))",
    "(value *turtle-pose*)",
    "(wait-for (< (fl-funcall #'turtlesim-msg:x *turtle-pose*) 5.0))",
    "(dotimes (i 10) (send-vel-cmd 1 1) (sleep 1))",
    "(call-set-pen 255 0 0 10 0)",
    "(dotimes (i 10) (send-vel-cmd 1 1) (sleep 1))",
    "(value *color-value*)",
    "(top-level (par (wait-for (< (fl-funcall #'turtlesim-msg:x *turtle-pose*) 5.0)) (progn (sleep 3) (send-vel-cmd -1 0))))",
]
TWO_ERRORS = """\
(in-package :cl-user)

(defun first-one (x)
  (let ((x))
    (setq 5 x)))

(defun good-one (x)
  (+ x 1))

(defun second-one (x)
  (if x 1 2 3 4))
"""
GOOD = """\
(in-package :tut)

(defun double (x)
  (* 2 x))

(defun unused (x y)
  (list x))

(defvar *factor* 12)

(defun broken-plan (speed angle)
  (+ speed undefined-here angle))

(defun move-to-far ()
  (unwind-protect
       (loop (send-vel-cmd 1 0.5) (sleep 0.05))
    (send-vel-cmd 0 0)))
"""
GREETING = """\
(require cramhy *)
(in-package :tut)
(defun greet-from-hy () "hello")
"""


def lisp(value):
    """``value`` as Emacs reads it."""
    if isinstance(value, (list, tuple)):
        return f"({' '.join(map(lisp, value))})"
    return str(value) if isinstance(value, int) else '"' + str(value).replace("\\", "\\\\").replace('"', '\\"') + '"'


def slime_folders():
    """The folders of SLIME for Emacs' load path."""
    return [SLIME, f"{SLIME}/lib", f"{SLIME}/contrib", *glob.glob("/usr/share/emacs/site-lisp/elpa-src/macrostep-*")]


def between_lectures():
    plans = (TUTORIAL / "simple-plans.hy").read_text().replace("(require cramhy *)\n", "")
    motions = (TUTORIAL / "motion-designators.hy").read_text().replace("(require cramhy *)\n", "")
    start, end = motions.index("(def-fact-group turtle-motion-designators"), motions.index("(defstruct pen-motion")
    return {"simple-plans.lisp": plans, "motions before the slide": motions[:start], "motions after the slide": motions[end:]}


class Told:
    """What Emacs has written: interaction → what it gave, as Emacs prints it."""

    def __init__(self, folder, lectures, output):
        self.lectures, self.output = lectures, output
        text = (folder / "told").read_text() if (folder / "told").exists() else ""
        self.found = dict(line.split("\t", 1) for line in text.splitlines())

    def __getitem__(self, name):
        assert name in self.found, f"Emacs did not come to {name!r}: {self.output[-2000:]}"
        return self.found[name]

    def text(self, name):
        """What an interaction gave, a string."""
        shown = self[name]
        assert shown.startswith('"'), shown
        return re.sub(r"\\(.)", lambda match: {"n": "\n", "t": "\t"}.get(match[1], match[1]), shown[1:-1])


@pytest.fixture(scope="module")
def told(tmp_path_factory, shared):
    folder = tmp_path_factory.mktemp("emacs")
    first = Workspace(folder / "first" / "ros", shared / "slides")
    control_package(first)
    second = Workspace(folder / "second" / "ros", shared / "slides")
    lecture_38.modules_package(second, between_lectures(), "process-modules-3-parts.lisp")
    lines_38 = [
        *LOAD,
        "(get-process-module-names)",
        *lecture_38.NODE,
        "(drive 5 2)",
        " ".join(lecture_38.session_of(second, "par-same-module.lisp")),
        "(sleep 1.5)",
        " ".join(lecture_38.session_of(second, "par-two-modules.lisp")),
        "(value *turtle-pose*)",
    ]
    for name, text in (("two-errors.lisp", TWO_ERRORS), ("good.lisp", GOOD), ("greeting.hy", GREETING)):
        (folder / name).write_text(text)
    program = folder / "cramhy"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m cramhy_runtime.cli "$@"\n')
    program.chmod(0o755)
    (folder / "run.el").write_text(
        f"(setq here {lisp(folder)} lisp {lisp(program)} patience 8 load-system {lisp(LOAD[0])}\n"
        f" slime-folders '{lisp(slime_folders())}\n"
        f" folder-34 {lisp(first.folder)} lines-34 '{lisp(LINES_34)}\n folder-38 {lisp(second.folder)} lines-38 '{lisp(lines_38)})\n"
    )
    environ = {**environment(), "HOME": str(folder), "CRAMHY_TEST_FOLDER": str(folder), "CRAMHY_VIEW": "no"}
    done = subprocess.run(
        [EMACS, "-Q", "--batch", "-l", str(HERE / "interactions.el")], env=environ, capture_output=True, text=True, timeout=120
    )
    return Told(folder, {"lecture 34": (first, LINES_34), "lecture 38": (second, lines_38)}, done.stdout + done.stderr)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("lecture", ["lecture 34", "lecture 38"])
def test_every_line_of_the_lectures_answers_as_at_the_prompt(told, lecture):
    workspace, lines = told.lectures[lecture]
    for folder in list(workspace.folder.rglob("__pycache__")):  # kept code is silent where the first load has warned
        shutil.rmtree(folder)
    answers = workspace.repl(*lines).answers
    found = [stable(told.text(f"{lecture} {number}")) for number in range(len(lines))]
    for line, answer, shown in zip(lines, answers, found, strict=False):
        # The prompt shows the value of a form before it reads the next one, and counts other texts.
        assert sorted(re.sub(r"<repl \d+>", "<repl>", shown).split("\n")) == sorted(
            re.sub(r"<repl \d+>", "<repl>", answer.strip()).split("\n")
        ), line
    assert told[f"{lecture} connects"] == "t" and told[f"{lecture} prompt"] == '"TUT> "'


MOTION = """\
#<A MOTION
    (TYPE DRIVING)
    (SPEED 5)
    (ANGLE 2)>
--------------------
The object is a designator.
Class:             #<STANDARD-CLASS CRAM-DESIGNATORS:MOTION-DESIGNATOR>
:TYPE:             :DRIVING
:SPEED:            5
:ANGLE:            2
Parent:            NIL
Successor:         NIL
Effective:         {effective}
"""
ERROR_IN_PAR = """\
  The variable UNDEFINED-HERE is unbound.
  at good.lisp:12:12
      (+ speed undefined-here angle))
               ^
   [Condition of type UNBOUND-VARIABLE]

Restarts:
 0: [ABORT] Return to Emacs.

Backtrace:
  0: (BROKEN-PLAN 5 2)
"""
EXACTLY = {
    "connect": "t",
    "evaluate": '"3"',
    "evaluate several values": r'"1\n\"two\"\n:THREE"',
    "output": r'"hello\n5"',
    "presentation is there": "t",
    "the last values": '"(5 1)"',
    "previous input": '"(list * **)"',
    "read a line": r'"\"typed\""',
    "package prompt": '"TUT>"',
    "set package": '"CL-USER"',
    "start the turtle": r'"\"/turtle1/set_pen\""',
    "jump to the first error": '(5 "(setq 5 x)))")',
    "jump to the second error": '(11 "(if x 1 2 3 4))")',
    "jump back": "5",
    "compile and load a file": '"42"',
    "compile a definition": '"63"',
    "a note of a definition": "(:style-warning)",
    "the note is where the variable is": '("(defun unused (x y)" "y")',
    "evaluate the last expression": '"=> 15 (4 bits, #xF, #o17, #b1111)"',
    "evaluate a definition": '"12"',
    "print the value into a buffer": '"15"',
    "evaluate and grab output": '("OUT" ":VALUE")',
    "load a file": '"2"',
    "complete": '"(with-failure-handling"',
    "complete a keyword": '(":name")',
    "complete parts of words": '"(multiple-value-bind"',
    "autodoc": '"(mapcar function ===> lst <=== &rest lists)"',
    "autodoc of one's own function": '"(send-vel-cmd lin ===> ang <===)"',
    "autodoc of a plan's operator": '"(par ===> form... <===)"',
    "autodoc of a variable": '"*FACTOR* => 12"',
    "autodoc of a binding": '"(let ===> bindings <=== &body body)"',
    "untrace all": "nil",
    "copy a part into the REPL": '":DRIVING"',
    "let a call return a value": '"(50 2)"',
    "begin a call anew": '"5"',
    "arglist in the echo area": '"(send-vel-cmd lin ang)"',
    "M-. into Lisp": '("control-turtlesim.lisp" "(defun send-vel-cmd (lin ang)")',
    "M-. to a process module": '("process-modules.lisp" "(def-process-module turtlesim-navigation (motion-designator)")',
    "M-. into Hy": r'("greeting.hy" "(defun greet-from-hy () \"hello\")")',
    "M-. into Python": '"topics.py"',
    "M-. back": "t",
    "M-. to nothing": '"No known definition for: no-such-thing-at-all (in CRAM-MY-BEGINNER-TUTORIAL)"',
    "who binds": ":not-implemented",
    "apropos": r'"SEND-VEL-CMD\n  Function: Function to send velocity commands."',
    "expand a macro once": r'"(IF A\n    (UNLESS B C))"',
    "expand all macros": r'"(IF A\n    (IF B\n        NIL\n        C))"',
    "disassemble": '"; Python of DOUBLE"',
    "trace": '"DOUBLE is now traced."',
    "a traced call": r'"0: (DOUBLE 2)\n  0: DOUBLE returned 4\n4"',
    "trace no more": '"DOUBLE is no longer traced."',
    "undefine": '"UNUSED"',
    "change the folder": "t",
    "inspector is left": "t",
    "the locals": '(("SPEED" . "5") ("ANGLE" . "2"))',
    "the source of a frame": '"(+ speed undefined-here angle))"',
    "evaluate in a frame": '"=> (5 2)"',
    "print in a frame": r'"7\n"',
    "disassemble a frame": "t",
    "inspect a local": "t",
    "an error in the debugger": '("Return to level 1 of the debugger." "Return to Emacs.")',
    "back to the first level": "t",
    "leave the debugger": "t",
    "take a restart": '"13"',
    "continue": '"7"',
    "the turtle moves": "t",
    "interrupt, and the turtle stops": "t",
    "the session goes on": '"2"',
    "kill one": "t",
    "connect again": r'(2 "\"COMMON-LISP-USER\"")',
    "disconnect": '"4"',
    "reconnect": '"4"',
    "quit": "t",
}


@pytest.mark.soak(all_but=24)
@pytest.mark.parametrize("name", EXACTLY)
def test_emacs_gets(told, name):
    assert told[name] == EXACTLY[name]


BEGINS = {
    "load the system": "STYLE-WARNING:",
    "start the node": "[(ROSLISP TOP) INFO]",
    "describe a symbol": "CRAM-MY-BEGINNER-TUTORIAL::SEND-VEL-CMD\n  [symbol]\n\nSEND-VEL-CMD names a compiled function:\n  Lambda-list: ",
    "describe a function": "#<FUNCTION MAPCAR>\n  [compiled function]",
    "documentation": "Documentation for the symbol PAR:\n\nOperator:\n (par form...)\n",
    "inspect a designator": MOTION.format(effective="NIL"),
    "inspect a part": ':DRIVING\n--------------------\nThe object is a SYMBOL.\nName:     "DRIVING"\nPackage:  #<PACKAGE "KEYWORD">\n',
    "inspector goes back": MOTION.format(effective="NIL"),
    "resolve the designator": "(DRIVE #S(TURTLE-MOTION :SPEED 5 :ANGLE 2))",
    "inspector goes forth": "(DRIVE #S(TURTLE-MOTION",
    "inspect a fluent": "#<FLUENT TURTLE-POSE\n",
    "an error inside par opens the debugger": ERROR_IN_PAR,
    "the frames": "  0: (BROKEN-PLAN 5 2)\n",
    "return from a frame": "BROKEN-PLAN was not compiled so that its calls can be left.",
    "an aborted form names its condition": "; Evaluation aborted on #<UNBOUND-VARIABLE",
    "the end of a compilation": "Compilation finished. (No warnings)",
    "inspect the condition": "#<UNBOUND-VARIABLE",
}


@pytest.mark.parametrize("name", BEGINS)
def test_emacs_gets_a_text_that_begins_so(told, name):
    assert told.text(name).startswith(BEGINS[name])


CONTAINS = {
    "compile a file with two errors": ['(:error "5 cannot be assigned.")', '(:error "IF takes 2 to 3 parts'],
    "complete fuzzily": ['"multiple-value-bind"', '(15 "bind")'],
    "autodoc of keywords": ["===> name <==="],
    "M-. to a variable": ["control-turtlesim.lisp", "(defvar *turtle-pose* "],
    "record calls": ["DOUBLE", "> 4", "< "],
    "the files of a system": ['"cram-my-beginner-tutorial.asd"', '"control-turtlesim.lisp"'],
    "inspect a recorded call": [
        "The object is a recorded call.",
        "Function:  DOUBLE",
        "Arguments: (4)",
        "Values:    (8)",
        "#<PYTHON call 0 of DOUBLE>",
    ],
    "who calls": ["(DEFUN MOVE-TO)", "(DEFUN ROTATE-TO)", "(DEF-PROCESS-MODULE TURTLESIM-NAVIGATION)"],
    "list the tasks": ["(:id :name :status)", '"main"', '"  Emacs: listener-eval"', '"    [TOP-LEVEL]', '"      [PAR-CHILD-#1/2]'],
    "inspect a fluent": ["Name: ", ":TURTLE-POSE", "Pulses: ", "Tasks that wait for it: ", "[pulse it]"],
}


@pytest.mark.parametrize("name", CONTAINS)
def test_emacs_gets_these_parts(told, name):
    for part in CONTAINS[name]:
        assert part in told[name]


def test_sixty_interactions_and_more_are_looked_at(told):
    looked_at = {*EXACTLY, *BEGINS, *CONTAINS}
    assert len(looked_at) >= 60
    assert set(told.found) - looked_at == {name for name in told.found if name.startswith("lecture ")}


@needs_terminals
def test_emacs_in_a_terminal(tmp_path):
    """Typed keys: M-x slime, a form, an error, q in the debugger, C-c C-c while a form runs, and the end."""
    from repl.terminal import Terminal

    program = tmp_path / "cramhy"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m cramhy_runtime.cli "$@"\n')
    program.chmod(0o755)
    (tmp_path / "init.el").write_text(
        f"(dolist (folder '{lisp(slime_folders())}) (add-to-list 'load-path folder))\n(require 'slime)\n(slime-setup '(slime-fancy))\n"
        f"(setq slime-lisp-implementations nil inferior-lisp-program {lisp(program)} slime-kill-without-query-p t)\n"
        "(setq inhibit-startup-screen t)\n"
    )
    variables = {**environment(), "HOME": str(tmp_path), "TERM": "xterm", "CRAMHY_VIEW": "no"}
    with Terminal("-nw", "-Q", "-l", str(tmp_path / "init.el"), program=[EMACS], variables=variables, size=(40, 100)) as terminal:
        terminal.expect("scratch")
        terminal.press("\x1bx")
        terminal.expect("M-x")
        terminal.press("slime\r")
        terminal.expect("; SLIME")  # the REPL buffer; before that the prompt stands in *inferior-lisp*
        terminal.expect("CL-USER>")
        terminal.press('(concatenate (quote string) "for" "ty-two")\r')
        terminal.expect("forty-two")
        terminal.press("(car 5)\r")
        terminal.expect("Return to Emacs")
        terminal.press("q")
        terminal.expect("aborted")
        terminal.press("(unwind-protect (progn (princ (+ 1000 77)) (sleep 1000)) (princ (+ 40000 321)))\r")
        terminal.expect("1077")
        terminal.press("\x03\x03")
        terminal.expect("40321")
        terminal.press("\x18\x03")
        assert terminal.status() == 0
