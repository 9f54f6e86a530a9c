"""The client of a tf2 buffer server, with a server in Lisp that knows its transforms from a transformer."""

import pytest

SERVER = """
(defvar *asked* nil)
(defvar *mute* nil)
(roslisp:start-ros-node "client")
(defvar *status* (roslisp:advertise "tf2_buffer_server/status" "actionlib_msgs/GoalStatusArray"))
(defvar *result* (roslisp:advertise "tf2_buffer_server/result" "tf2_msgs/LookupTransformActionResult"))
(roslisp:advertise "tf2_buffer_server/feedback" "tf2_msgs/LookupTransformActionFeedback")
(defun answer (id code text &optional transform (status 3))
  (roslisp:publish *result*
    (if transform
        (roslisp:make-msg "tf2_msgs/LookupTransformActionResult" (id goal_id status) id (status status) status
                          (transform result) (to-msg transform))
        (roslisp:make-msg "tf2_msgs/LookupTransformActionResult" (id goal_id status) id (status status) status
                          (error error result) code (error_string error result) text))))
(defun serve (message)
  (roslisp:with-fields ((id (id goal_id)) (target (target_frame goal)) (source (source_frame goal)) (time (source_time goal))
                        (timeout (timeout goal)) (fixed (fixed_frame goal)) (advanced (advanced goal)) (then (target_time goal))) message
    (push (list target source time timeout fixed advanced then) *asked*)
    (unless *mute*
      (handler-case (answer id 0 "" (lookup-transform *tf* target source :time time :timeout timeout))
        (timeout-error (problem) (answer id 5 (error-description problem)))))))
(roslisp:subscribe "tf2_buffer_server/goal" "tf2_msgs/LookupTransformActionGoal" #'serve)
(defun beat () (loop (roslisp:publish *status* (roslisp:make-msg "actionlib_msgs/GoalStatusArray")) (roslisp:wait-duration 0.2)))
(defmacro with-server (&body body) `(roslisp:with-parallel-thread (#'beat "server") ,@body))
"""


@pytest.fixture
def server(lisp):
    lisp(SERVER)
    lisp('(told "map" "base" 1.0 1) (told "map" "base" 2.0 2)')
    lisp("(defvar *client* (with-server (make-instance 'cl-tf2:buffer-client)))")
    return lisp


def test_the_server_answers(server):
    assert server('(with-server (x (translation (lookup-transform *client* "map" "base" :time 1.5))))') == "1.5d0"
    assert server(
        '(with-server (transform-point-stamped *client* :target-frame "map" :point (make-point-stamped "base" 1.5 #(1 0 0))))'
    ) == ('#<POINT-STAMPED \n   FRAME-ID: "map" STAMP: 1.5d0\n   V: (2.5d0 0.0d0 0.0d0)>')


def test_all_options_reach_the_server(server):
    server('(with-server (lookup-transform *client* "map" "base" :time 1.5 :timeout 2.5 :target-time 2.0 :fixed-frame "map"))')
    assert server("(first *asked*)") == '("map" "base" 1.5d0 2.5d0 "map" T 2.0d0)'
    server('(with-server (lookup-transform *client* "map" "base"))')
    assert server("(first *asked*)") == '("map" "base" 0.0d0 0.0d0 "" NIL 0.0d0)'


def test_no_server_is_an_error_after_ten_seconds(lisp):
    lisp('(roslisp:start-ros-node "alone")')
    before = lisp.value("(roslisp:ros-time)")
    assert lisp.error("(make-instance 'cl-tf2:buffer-client)", "timeout-error") == "Waiting for action server timed out."
    assert lisp.value("(roslisp:ros-time)") - before == pytest.approx(10, abs=1e-3)
    assert lisp.error("(make-instance 'cl-tf2:buffer-client :timeout 1)", "timeout-error")
    assert lisp.value("(roslisp:ros-time)") - before == pytest.approx(11, abs=1e-3)
    assert lisp.condition("(make-instance 'cl-tf2:buffer-client :timeout 1)").hint == (
        "Nobody serves the action tf2_buffer_server (tf2_msgs/LookupTransformAction). A CL-TF:TRANSFORM-LISTENER needs no server."
    )


def test_errors_of_the_server_are_conditions(server):
    assert server.error('(with-server (lookup-transform *client* "map" "nope" :timeout 1))', "timeout-error") == (
        "No transform was published between frames nope and map"
    )
    for code, kind in enumerate("lookup-error connectivity-error extrapolation-error invalid-argument-error timeout-error".split(), 1):
        server(
            f'(defun serve-badly (message) (roslisp:with-fields ((id (id goal_id))) message (answer id {code} "code {code}")))'
            "(setf *mute* t)"
        )
        if code == 1:
            server('(roslisp:subscribe "tf2_buffer_server/goal" "tf2_msgs/LookupTransformActionGoal" (lambda (m) (serve-badly m)))')
        assert server.error('(with-server (lookup-transform *client* "map" "base"))', kind) == f"code {code}"


def test_a_goal_that_does_not_succeed(server):
    server("""(setf *mute* t)
              (roslisp:subscribe "tf2_buffer_server/goal" "tf2_msgs/LookupTransformActionGoal"
                (lambda (message) (roslisp:with-fields ((id (id goal_id))) message (answer id 0 "" (at "a" "b" 0.0 1) 4))))""")
    assert server.error('(with-server (lookup-transform *client* "map" "base"))', "transform-stamped-error") == (
        "Action call did not succeed. Status: ABORTED"
    )


def test_a_server_that_falls_silent_is_no_wait_for_ever(server):
    server("(setf *mute* t)")
    assert server.error('(lookup-transform *client* "map" "base")', "transform-stamped-error") == (
        "Action call did not succeed. Status: LOST"
    )


def test_tasks_that_ask_at_once_all_get_their_answers(server):
    server('(told "map" "cup" 1.0 7)')
    assert (
        server("""(with-server
                       (let ((answers nil))
                         (cpl:top-level
                           (cpl:par
                             (push (x (translation (lookup-transform *client* "map" "base" :time 1.5 :timeout 2))) answers)
                             (push (x (translation (lookup-transform *client* "map" "cup" :timeout 2))) answers)))
                         (sort answers #'<)))""")
        == "(1.5d0 7.0d0)"
    )


def test_a_lookup_that_is_evaporated_cancels_its_goal(server):
    server(
        "(setf *mute* t) (defvar *cancelled* 0)"
        '(roslisp:subscribe "tf2_buffer_server/cancel" "actionlib_msgs/GoalID" (lambda (id) (declare (ignore id)) (incf *cancelled*)))'
    )
    assert (
        server("""(with-server
                       (cpl:top-level (cpl:pursue (lookup-transform *client* "map" "base" :timeout 60) (cpl:sleep 1)))
                       (roslisp:wait-duration 0.1)
                       *cancelled*)""")
        == "1"
    )
