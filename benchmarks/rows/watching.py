"""Rows of the turtle's world: a tick, and a tick that is recorded."""

from __future__ import annotations

import os
import tempfile

from . import Row, lisp_function

DRIVE = """
(progn
  (roslisp:start-ros-node "bench")
  (defparameter *bench-pose* (make-fluent :name "pose"))
  (roslisp:subscribe "/turtle1/pose" "turtlesim/Pose" (lambda (pose) (setf (value *bench-pose*) pose)))
  (defparameter *bench-pub* (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist"))
  (defun bench-drive (ticks)
    (dotimes (i (ceiling ticks 50))
      (roslisp:publish *bench-pub* (roslisp:make-message "geometry_msgs/Twist" (x linear) 2 (z angular) 1.3))
      (sleep 0.8))))"""


def driving(recorded):
    def prepare(session):
        from cramhy_runtime import chronicle

        drive = lisp_function(DRIVE, "bench-drive")(session)

        def work(count):
            if not recorded:
                drive(count)
                return
            with tempfile.TemporaryDirectory() as folder:
                recording = chronicle.record(os.path.join(folder, "x.mcap"))
                try:
                    drive(count)
                finally:
                    recording.close()

        return work

    return prepare


ROWS = [Row("a tick of the turtle", driving(False), 500), Row("a tick of the turtle, recorded to MCAP", driving(True), 1000, 60)]
