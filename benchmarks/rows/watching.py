"""Rows of the turtle's world: a tick, and a tick that is recorded."""

from __future__ import annotations

import os
import tempfile
import time

from . import Row, lisp_function

DRIVE = """
(progn
  (roslisp:start-ros-node "bench")
  (defparameter *bench-pose* (make-fluent :name "pose"))
  (roslisp:subscribe "/turtle1/pose" "turtlesim/Pose" (lambda (pose) (setf (value *bench-pose*) pose)))
  (defparameter *bench-pub* (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist"))
  (defun bench-clear (n) (declare (ignore n)) (roslisp:call-service "/clear" 'std_srvs-srv:empty))
  (defun bench-drive (ticks)
    (dotimes (i (ceiling ticks 50))
      (roslisp:publish *bench-pub* (roslisp:make-message "geometry_msgs/Twist" (x linear) 2 (z angular) 1.3))
      (sleep 0.8))))"""


def driving(recorded):
    """Work of so many ticks on paper that is empty, since what is on it is recorded first. A recording is begun before the time counts."""

    def prepare(session):
        from cramhy_runtime import chronicle

        drive, clear = lisp_function(DRIVE, "bench-drive")(session), lisp_function(DRIVE, "bench-clear")(session)

        def work(count):
            clear(0)
            with tempfile.TemporaryDirectory() as folder:
                recording = chronicle.record(os.path.join(folder, "x.mcap")) if recorded else None
                begin = time.process_time()
                try:
                    drive(count)
                finally:
                    if recording is not None:
                        recording.close()
                return time.process_time() - begin

        return work

    return prepare


ROWS = [Row("a tick of the turtle", driving(False), 500), Row("a tick of the turtle, recorded to MCAP", driving(True), 1000, 60)]
