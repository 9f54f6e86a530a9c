"""ACTIONLIB: the server, and the client that waits for its goal (roslisp.md 13.2)."""

import pytest

CALL = "(defun call (n &rest options) (multiple-value-bind (result state) (apply #'actionlib:call-goal *client* (goal n) options)" \
       " (list (sequence-of result) state)))"  # fmt: skip


@pytest.fixture
def call(lisp):
    """`lisp` with a server, a client, and ``(call n ...)`` for ``call-goal``: (the result's sequence, the state)."""
    lisp("(both)" + CALL)
    return lisp


def test_a_call_returns_result_and_state(call):
    assert call("(call 2)") == "(#(2 2) :SUCCEEDED)"
    assert call("(call 13)") == "(#() :ABORTED)"


def test_a_call_that_takes_too_long_is_cancelled(call):
    assert call("(call 10 :timeout 2.5 :result-timeout 3)") == "(NIL :TIMEOUT)"
    assert call("(wait-duration 2) (call 1)") == "(#(1 1) :SUCCEEDED)"
    assert call("(actionlib-lisp:state *client*)") == ":SUCCEEDED"


def test_feedback_is_signalled_and_called_back(call):
    assert (
        call("""(let (seen)
                     (handler-bind ((actionlib:feedback-signal (lambda (s) (push (sequence-of (actionlib:feedback s)) seen))))
                       (call 2 :feedback-cb (lambda (f) (note (sequence-of f)))))
                     (list seen *notes*))""")
        == "((#(2) #(1)) (#(1) #(2)))"
    )


def test_a_handler_of_feedback_may_abort_the_goal(call):
    assert (
        call("""(handler-bind ((actionlib:feedback-signal
                                    (lambda (s) (when (equalp (sequence-of (actionlib:feedback s)) #(2))
                                                  (invoke-restart 'actionlib:abort-goal)))))
                     (call 10))""")
        == "(NIL :ABORTED)"
    )
    assert call("(wait-duration 2) (actionlib-lisp:state *client*)") == ":PREEMPTED"


def test_the_restart_takes_what_the_call_returns(call):
    assert (
        call("""(handler-bind ((actionlib:feedback-signal (lambda (s) (declare (ignore s)) (invoke-restart 'actionlib:abort-goal :enough))))
                  (actionlib:call-goal *client* (goal 10)))""")
        == ":ENOUGH :ABORTED"
    )


def test_a_silent_server_is_an_error(call):
    from cramhy_runtime.ros import graph

    node = graph.active().lisp_node
    assert call("(wait-duration 0.1)") == "T"
    for name in ("/count/status", "/count/feedback", "/count/result"):
        node.unadvertise(name)
    assert call("""(let ((start (ros-time)))
                     (handler-case (call 3) (actionlib:server-lost (e) (list (format nil "~a" e) (round (- (ros-time) start))))))""") == (
        '("Client lost connection to server." 2)'
    )


def test_evaporation_of_a_call_cancels_its_goal(call):
    assert (
        call("""(top-level (pursue (wait-duration 1.5) (call 10)))
                   (wait-duration 3) (actionlib-lisp:state *client*)""")
        == ":PREEMPTED"
    )


def test_falling_off_the_end_aborts_the_goal_and_is_logged(call, capsys):
    assert call("(call 15)") == "(#() :ABORTED)"
    text = "Reached the end of exec callback COUNT-UP without succeeding, aborting, or preempting"
    assert text in capsys.readouterr().out


def test_an_error_aborts_the_goal_and_is_told(call, capsys):
    assert (
        call("""(subscribe "count/result" "actionlib_tutorials/FibonacciActionResult"
                     (lambda (m) (note (actionlib_msgs-msg:text (actionlib_tutorials-msg:status m)))))
                   (call 14)""")
        == "(#() :ABORTED)"
    )
    assert call("*notes*") == '("no 14")'
    assert "[(ACTIONLIB) ERROR]" in (text := capsys.readouterr().out) and "Error in the exec callback of count: no 14" in text


def test_a_newer_goal_preempts_the_one_that_is_worked_on(lisp):
    lisp("(both)" + CALL)
    assert (
        lisp("""(defvar *first* *client*) (client) (actionlib-lisp:wait-for-server *client*)
                   (actionlib-lisp:send-goal *first* (goal 10)) (wait-duration 1.5)
                   (list (call 1) (actionlib-lisp:state *first*))""")
        == "((#(1 1) :SUCCEEDED) :PREEMPTED)"
    )


def test_the_server_reports_four_times_a_second_and_forgets_after_ten_seconds(call):
    call("""(defvar *lengths* nil)
            (subscribe "count/status" "actionlib_msgs/GoalStatusArray"
              (lambda (m) (push (length (actionlib_msgs-msg:status_list m)) *lengths*)))
            (call 1) (setf *lengths* nil) (wait-duration 9.9)""")
    assert call("(list (length *lengths*) (remove-duplicates *lengths*))") in ("(39 (1))", "(40 (1))")
    assert call("(wait-duration 0.5) (first *lengths*)") == "0"


def test_what_belongs_into_a_callback_is_an_error_elsewhere(lisp):
    text = "This operation can only be called while in a callback thread"
    for form in ("(succeed-current)", "(publish-feedback :sequence #(1))", "(cancel-request-received)"):
        assert lisp.error(form) == text
    assert lisp.condition("(abort-current)").hint == "This belongs into the exec callback of an action server (def-exec-callback)."


def test_a_server_in_ones_own_task_ends_with_the_node(lisp):
    assert (
        lisp("""(cpl:top-level (cpl:par (start-action-server "count" "actionlib_tutorials/FibonacciAction" #'count-up)
                                           (progn (client) (actionlib-lisp:wait-for-server *client*)
                                                  (note (actionlib-lisp:send-goal-and-wait *client* (goal 1) 0 0))
                                                  (shutdown-ros-node))))
                   *notes*""")
        == "(:SUCCEEDED)"
    )


def test_when_the_node_ends_a_goal_that_is_worked_on_ends_too(lisp):
    assert (
        lisp("""(both) (actionlib-lisp:send-goal *client* (goal 1000) :done-cb (lambda (s r) (note (list s r))))
                   (wait-duration 1.5) (shutdown-ros-node) (start-ros-node "m") (wait-duration 10)
                   (list (actionlib-lisp:state *client*) *notes*)""")
        == "(:LOST ((:LOST NIL)))"
    )


def test_a_plan_in_the_callback_may_have_branches(lisp, capsys):
    callback = """(def-exec-callback branchy (order)
                    (top-level (par (wait-duration 1)
                                    (progn (publish-feedback :sequence #(7)) (note (cancel-request-received)) (when (= order 2) {0}))))
                    {0})
                  (start-action-server "b" "actionlib_tutorials/FibonacciAction" #'branchy :separate-thread t)
                  (setf *client* (actionlib:make-action-client "b" "actionlib_tutorials/FibonacciAction"))
                  (actionlib:wait-for-server *client*)"""
    lisp(callback.format("(succeed-current :sequence (vector order))") + CALL)
    assert lisp("(list (call 1 :feedback-cb (lambda (f) (note (sequence-of f)))) *notes*)") == "((#(1) :SUCCEEDED) (NIL #(7)))"
    assert lisp("(call 2)") == "(#() :ABORTED)"
    assert "A branch of a plan cannot end the goal that the exec callback around it works on." in capsys.readouterr().out


SHAPES = """
(defvar *pose* nil)
(subscribe "turtle1/pose" "turtlesim/Pose" (lambda (m) (setf *pose* m)))
(defvar *commands* (advertise "turtle1/cmd_vel" "geometry_msgs/Twist"))
(defun drive (linear angular seconds)
  (loop with end = (+ (ros-time) seconds) while (< (ros-time) end)
        do (when (cancel-request-received) (preempt-current))
           (publish-msg *commands* (:x :linear) linear (:z :angular) angular)
           (wait-duration 0.1)))
(def-exec-callback draw-shape (edges radius)
  (let* ((corner (/ (* 2 pi) edges)) (side (* 2 radius (sin (/ pi edges)))))
    (when (< edges 3) (abort-current))
    (loop repeat edges do (drive side 0 1.0) (drive 0 corner 1.0))
    (succeed-current :interior_angle (- pi corner) :apothem (* radius (cos (/ pi edges))))))
(start-action-server "turtle_shape" "turtle_actionlib/ShapeAction" #'draw-shape :separate-thread t)
(setf *client* (actionlib:make-action-client "turtle_shape" "turtle_actionlib/ShapeAction"))
(actionlib:wait-for-server *client*)
(defun shape (edges radius)
  (multiple-value-bind (result state)
      (actionlib:call-goal *client* (actionlib:make-action-goal *client* :edges edges :radius radius))
    (list state (round (* 1000 (turtle_actionlib-msg:interior_angle result))) (round (* 1000 (turtle_actionlib-msg:apothem result))))))
"""


def test_a_shape_server_in_lisp_drives_the_turtle(lisp):
    from cramhy_runtime.turtlesim.node import start_turtlesim

    start_turtlesim()
    lisp(SHAPES)
    lisp(
        "(wait-duration 0.1) (defvar *start* (with-fields (x y) *pose* (list x y)))"
        "(defvar *far* 0) (defvar *times* 0)"
        '(subscribe "turtle1/pose" "turtlesim/Pose" (lambda (m) (with-fields (x y) m'
        "  (setf *far* (max *far* (+ (abs (- x (first *start*))) (abs (- y (second *start*)))))))))"
    )
    assert lisp("(shape 4 1.5)") == "(:SUCCEEDED 1571 1061)"
    assert lisp("(< 3.5 *far* 4.8)") == "T"  # the opposite corner of a square of 2.12 m
    assert lisp("(shape 2 1.0)") == "(:ABORTED 0 0)"
    assert (
        lisp("""(progn (actionlib-lisp:send-goal *client* (actionlib:make-action-goal *client* :edges 5 :radius 1.0))
                          (wait-duration 2.0) (actionlib-lisp:cancel-goal *client*) (actionlib-lisp:wait-for-result *client* 0)
                          (wait-duration 1.1)
                          (list (actionlib-lisp:state *client*) (turtlesim-msg:linear_velocity *pose*)))""")
        == "(:PREEMPTED 0.0d0)"
    )


@pytest.mark.soak
def test_a_file_that_was_compiled_before_makes_the_packages_too(tmp_path):
    import subprocess
    import sys

    (tmp_path / "acts.lisp").write_text(
        '(defun done () (actionlib:succeed-current :sequence #(1)))\n(handler-case (done) (error (e) (format t "~a~%" e)))\n'
    )
    for _ in range(2):
        run = [sys.executable, "-m", "cramhy_runtime.cli", "run", str(tmp_path / "acts.lisp"), "--time", "virtual"]
        assert (
            subprocess.run(run, capture_output=True, text=True, timeout=120).stdout
            == "This operation can only be called while in a callback thread\n"
        )


@pytest.mark.soak
def test_naming_a_package_or_loading_a_system_makes_them():
    import subprocess
    import sys

    program = (
        "from cramhy_runtime.session import boot; boot()\n"
        "from cramhy_runtime.lisp_core import packages\n"
        "from cramhy_runtime.languages.commonlisp.systems import systems\n"
        "import sys\n"
        "assert 'cramhy_runtime.actionlib.client' not in sys.modules\n"
        "systems.load_system('actionlib-lisp')\n"
        "assert packages.find_package('ACTIONLIB').lookup('CALL-GOAL')[1] == 'external'\n"
        "assert packages.find_package('ACTIONLIB-LISP').lookup('CANCEL-AT-BEFORE-TIME')[1] == 'external'\n"
        "print('made')"
    )
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120).stdout == "made\n"
