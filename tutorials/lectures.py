"""Both lectures of the course, typed into the REPL in virtual time.

``make tutorial`` runs this file: every line that the slides show is typed, with its prompt and its answer, the turtle's paper is
written as a picture, and on a terminal the REPL stays open, so that one can go on typing. The tests compare the transcript
with the slides.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

LOAD = ['(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)', "(in-package :tut)"]

LECTURE_34 = [
    *LOAD,
    '(start-ros-node "cram_tutorial_client")',
    '(init-ros-turtle "turtle1")',
    "(value *turtle-pose*)",
    "(value *color-value*)",
    ";; the arrow keys: left, left, up",
    "(progn (turtlesim:press :left) (sleep 1.1) (turtlesim:press :left) (sleep 1.1) (turtlesim:press :up) (sleep 1.1))",
    "(value *turtle-pose*)",
    "(wait-for (< (fl-funcall #'turtlesim-msg:x *turtle-pose*) 5.0))",
    "(dotimes (i 10) (send-vel-cmd 1 1) (sleep 1))",
    "(call-set-pen 255 0 0 10 0)",
    "(dotimes (i 10) (send-vel-cmd 1 1) (sleep 1))",
]

PAR_SAME_MODULE = """\
(top-level
      (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
        (let ((goal (desig:a motion (type moving) (goal (9 1 0))))
              (trajectory (desig:a motion (type driving) (speed 3) (angle 8))))
          (cpl:par
            (pm-execute 'turtlesim-navigation goal)
            (pm-execute 'turtlesim-navigation trajectory)))))"""

PAR_TWO_MODULES = """\
(top-level
      (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
        (let ((goal (desig:a motion (type moving) (goal (9 9 0)))))
          (cpl:par
            (pm-execute 'turtlesim-navigation goal)
            (dotimes (i 10)
              (pm-execute 'turtlesim-pen-control
                (let ((?r (random 255))
                      (?g (random 255))
                      (?b (random 255))
                      (?width (+ 3 (random 5))))
                  (desig:a motion (type setting-pen) (r ?r) (g ?g) (b ?b) (width ?width))))
              (sleep 0.5))))))"""

LECTURE_38 = [
    *LOAD,
    '(start-ros-node "turtle1")',
    '(init-ros-turtle "turtle1")',
    "(drive 5 2)",
    "(sleep 1.5)",
    ";; rosservice call /clear, rosservice call /reset",
    '(call-service "/clear" \'std_srvs-srv:Empty)',
    '(call-service "/reset" \'std_srvs-srv:Empty)',
    PAR_SAME_MODULE,
    "(sleep 1.5)",
    PAR_TWO_MODULES,
]


LOOK = """\
(top-level
      (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
        (let ((goal (desig:a motion (type moving) (goal (3 9 0)))))
          (cpl:par
            (pm-execute 'turtlesim-navigation goal)
            (progn (sleep 1) (cpl:describe-task-tree))))))"""
"""On no slide: the same plan again, and what each of its tasks does after a second."""


class Typist:
    """Types lines into the console, showing them as a terminal would. ``finished()`` is called with the last of them."""

    interactive = False

    def __init__(self, texts, finished=lambda: None):
        self.lines = [line for text in texts for line in text.splitlines()]
        self.finished = finished

    def line(self, prompt):
        from cramhy_runtime.languages.commonlisp.streams import streams

        if not self.lines:
            return None
        line = self.lines.pop(0)
        if not self.lines:
            self.finished()
        streams.CONSOLE_OUTPUT.fresh_line()
        streams.CONSOLE_OUTPUT.write(f"{prompt}{line}\n")
        return line


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--png", type=Path, default=Path("turtle.png"), help="where the turtle's paper is written")
    parser.add_argument("--seed", type=int, default=None, help="shuffle the order of tasks, reproducibly")
    parser.add_argument("--backend", choices=["auto", "threads", "greenlet"], default="auto")
    options = parser.parse_args()
    from cramhy_runtime.cli import program
    from cramhy_runtime.repl.console import Console
    from cramhy_runtime.repl.line_input import standard_lines
    from cramhy_runtime.repl.session import Session

    save = f'(turtlesim:save-paper "{options.png}")'
    texts = [
        ";; Lecture 34: controlling the turtle",
        *LECTURE_34,
        ";; Lecture 38: process modules",
        *LECTURE_38,
        save,
        ";; What a plan is doing, while it is",
        LOOK,
    ]
    stays = sys.stdin.isatty() and sys.stdout.isatty()
    if stays:
        texts.append(";; Go on typing; Ctrl-D ends.")

    def stay():
        console.input = standard_lines()

    console = Console(
        lambda: Session(time="virtual", seed=options.seed, backend=options.backend), Typist(texts, stay) if stays else Typist(texts)
    )
    with program():
        status = console.run()
    sys.exit(status)


if __name__ == "__main__":
    main()
