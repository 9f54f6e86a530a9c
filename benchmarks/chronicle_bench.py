"""Looking on: what a session costs while nobody looks, while a page does, and while it is recorded; what a message costs in a file.

    python benchmarks/chronicle_bench.py

Microseconds of the processor per unit, and the bytes of a file. The turtle drives in a curve and draws, and a fluent follows its pose.
There is nothing to compare with: CRAM has logs for this, and ROS a process of its own, rosbag.
"""

from __future__ import annotations

import os
import statistics
import tempfile
import time
from functools import partial

from measuring import Table, rounds

from cramhy_runtime import chronicle, kernel
from cramhy_runtime.chronicle import chronicler
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.repl.session import Session

PLANS = """
(progn
  (roslisp:start-ros-node "bench")
  (defparameter *pose* (make-fluent :name "pose"))
  (roslisp:subscribe "/turtle1/pose" "turtlesim/Pose" (lambda (pose) (setf (value *pose*) pose)))
  (defparameter *pub* (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist"))
  (defun drive (ticks)
    (dotimes (i (ceiling ticks 50))
      (roslisp:publish *pub* (roslisp:make-message "geometry_msgs/Twist" (x linear) 2 (z angular) 1.3))
      (sleep 0.8)))
  (defun pars (n) (top-level (dotimes (i n) (par 1 2))))
  (defun sleeps (n) (top-level (par-loop (length '(1 1 1 1 1 1 1 1 1 1)) (dotimes (i (floor n 10)) (sleep length))))))"""


def measured(table, name, work, count):
    times = rounds(work, count, time.process_time)
    table.line(name, min(times), statistics.median(times), cram="")


def rows(table, session, who):
    def calling(text, count):
        session.evaluate_text(f"({text} {count})")

    measured(table, f"a tick of the turtle, {who}", partial(calling, "drive"), 200)
    measured(table, f"par of two, {who}", partial(calling, "pars"), 200)
    measured(table, f"a sleep of one of ten tasks, {who}", partial(calling, "sleeps"), 500)


def recorded(table, session, folder):
    path = os.path.join(folder, "x.mcap")
    recording = chronicle.record(path)
    rows(table, session, "recorded")
    before, start = recording.messages, time.process_time()
    session.evaluate_text("(drive 2000)")
    each = (time.process_time() - start) / (recording.messages - before) * 1e6
    table.line("all of that, per recorded message", each, each, cram="")
    recording.close()
    count = recording.messages
    table.line("bytes per recorded message", os.path.getsize(path) / count, os.path.getsize(path) / count, cram="")
    start = time.process_time()
    each = 1e6 / sum(1 for _ in chronicle.read(path).messages())
    each *= time.process_time() - start
    table.line("reading it, per message", each, each, cram="")


def main():
    session = Session(time="virtual", seed=1)
    session.package = "CRAM-USER"
    streams.STANDARD_OUTPUT.value = streams.BroadcastStream()
    session.evaluate_text(PLANS)
    table = Table("Looking on", kernel.active().backend.name, "")
    rows(table, session, "unseen")
    chronicle.start()
    rows(table, session, "on a page")
    chronicle.stop()
    assert chronicler.there() is None
    rows(table, session, "unseen again")
    with tempfile.TemporaryDirectory() as folder:
        recorded(table, session, folder)
    table.end()
    kernel.stop()


if __name__ == "__main__":
    main()
