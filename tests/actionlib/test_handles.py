"""ACTIONLIB's client: goals that are sent and followed by handles, several at a time (roslisp.md 13)."""

import pytest

EXPORTS = """*status-publish-interval* *gc-interval* start-action-server publish-feedback succeed-current preempt-current abort-current
cancel-request-received def-exec-callback exec-callback-tag *action-server-timeout* server-lost simple-state result goal-id
make-action-client send-goal send-goal-and-wait cancel-goal wait-for-server connected-to-server wait-for-result call-goal feedback-signal
abort-goal feedback goal make-action-goal""".split()
TAGS = "exec-callback-tag", "abort-goal"


@pytest.fixture
def client(lisp):
    """`lisp` with a server that works on one goal at a time, and a client of ACTIONLIB."""
    lisp("""(serve) (setf *client* (actionlib:make-action-client "count" "actionlib_tutorials/FibonacciAction"))
            (actionlib:wait-for-server *client*)
            (defun send (n &rest options) (apply #'actionlib:send-goal *client* (actionlib:make-action-goal *client* :order n) options))""")
    return lisp


def test_all_names_of_the_original_and_no_others_are_exported_and_defined(lisp):
    """A package that uses ACTIONLIB may have names of its own for all else, such as a class ACTION-CLIENT."""
    for name in EXPORTS:
        assert lisp(f'(nth-value 1 (find-symbol "{name.upper()}" :actionlib))') == ":EXTERNAL", name
        kinds = "(fboundp 'actionlib:{0}) (macro-function 'actionlib:{0}) (find-class 'actionlib:{0} nil) (boundp 'actionlib:{0})"
        assert name in TAGS or lisp(f"(and (or {kinds.format(name)}) t)") == "T", name
    assert lisp("(loop for name being the external-symbols of :actionlib count t)") == str(len(EXPORTS))


def test_a_goal_is_sent_and_followed(client):
    assert client("(defvar *h* (send 2)) (list (typep *h* 'actionlib::client-goal-handle) (stringp (actionlib:goal-id *h*)))") == "(T T)"
    assert client("(list (actionlib::terminal-state *h*) (actionlib:result *h*))") == "(NIL NIL)"
    assert client("(wait-duration 0.5) (list (actionlib::comm-state *h*) (actionlib::goal-status *h*))") == "(:ACTIVE :ACTIVE)"
    assert client("(multiple-value-list (actionlib:wait-for-result *h* 0.5))") == "(NIL :TIMEOUT)"
    assert client("(multiple-value-list (actionlib:wait-for-result *h* 0))") == "(NIL :TIMEOUT)"
    assert client("(multiple-value-bind (result state) (actionlib:wait-for-result *h*) (list (sequence-of result) state))") == (
        "(#(2 2) :SUCCEEDED)"
    )
    assert client("(list (actionlib::comm-state *h*) (actionlib::terminal-state *h*) (sequence-of (actionlib:result *h*)))") == (
        "(:DONE :SUCCEEDED #(2 2))"
    )


def test_a_goal_waits_for_the_server_s_word(client):
    assert client("(actionlib::comm-state (send 2))") == ":WAITING-FOR-GOAL-ACK"


def test_callbacks(client):
    client("""(send 2 :active-cb (lambda () (note :active)) :feedback-cb (lambda (f) (note (sequence-of f)))
                      :done-cb (lambda (state result) (note (list state (sequence-of result)))))""")
    assert client("(wait-duration 3) *notes*") == "(:ACTIVE #(1) #(2) (:SUCCEEDED #(2 2)))"


def test_two_goals_are_tracked_side_by_side(client):
    """The server preempts the first for the second, and each handle knows of its own."""
    client("(defvar *one* (send 9)) (wait-duration 1.5) (defvar *two* (send 1))")
    assert (
        client("""(list (nth-value 1 (actionlib:wait-for-result *one*)) (actionlib::terminal-state *one*)
                           (nth-value 1 (actionlib:wait-for-result *two*)) (actionlib::terminal-state *two*))""")
        == "(:PREEMPTED :PREEMPTED :SUCCEEDED :SUCCEEDED)"
    )
    assert client("(list (sequence-of (actionlib:result *one*)) (sequence-of (actionlib:result *two*)))") == "(#(3) #(1 1))"


def test_a_call_beside_a_goal_that_was_sent_loses_none_of_them(client):
    client("(defvar *one* (send 9)) (wait-duration 1.5)")
    assert client("(nth-value 1 (actionlib:call-goal *client* (goal 1)))") == ":SUCCEEDED"
    assert client("(actionlib::terminal-state *one*)") == ":PREEMPTED"


def test_calls_of_two_branches_of_a_plan_on_one_client(client):
    assert (
        client("""(let (one two)
                       (cpl:top-level (par (setf one (nth-value 1 (actionlib:call-goal *client* (goal 5))))
                                           (progn (wait-duration 1.5) (setf two (nth-value 1 (actionlib:call-goal *client* (goal 1)))))))
                       (list one two))""")
        == "(:PREEMPTED :SUCCEEDED)"
    )


def test_one_goal_is_cancelled_by_its_handle(client):
    client("(defvar *h* (send 9)) (wait-duration 1.5) (actionlib:cancel-goal *h*)")
    assert client("(list (nth-value 1 (actionlib:wait-for-result *h* 5)) (actionlib::terminal-state *h*))") == "(:PREEMPTED :PREEMPTED)"


def test_goals_up_to_a_time_are_cancelled(client):
    client("(defvar *early* (send 9)) (wait-duration 1.5) (actionlib::cancel-at-before-time *client* (- (ros-time) 1)) (wait-duration 1)")
    client("(defvar *late* (send 1))")
    assert client(
        """(list (nth-value 1 (actionlib:wait-for-result *late*)) (actionlib::terminal-state *early*) (actionlib::terminal-state *late*))"""
    ) == ("(:SUCCEEDED :PREEMPTED :SUCCEEDED)")
    assert client.error('(actionlib::cancel-at-before-time *client* "now")', "type-error")


def test_all_goals_are_cancelled(client):
    client("(defvar *h* (send 9)) (wait-duration 1.5) (actionlib::cancel-all-goals *client*)")
    assert client("(list (nth-value 1 (actionlib:wait-for-result *h* 5)) (actionlib::terminal-state *h*))") == "(:PREEMPTED :PREEMPTED)"


def test_the_client_stands_for_its_newest_goal(client):
    client("(send 1)")
    assert client("(list (sequence-of (actionlib:wait-for-result *client*)) (actionlib::terminal-state *client*))") == "(#(1 1) :SUCCEEDED)"
    assert client("(stringp (actionlib:goal-id *client*))") == "T"


def test_a_handle_whose_server_falls_silent_is_lost(client):
    from cramhy_runtime.ros import graph

    client("(defvar *h* (send 9)) (wait-duration 0.5)")
    for name in ("/count/status", "/count/feedback", "/count/result"):
        graph.active().lisp_node.unadvertise(name)
    assert (
        client("""(list (multiple-value-list (actionlib:wait-for-result *h*)) (actionlib::terminal-state *h*)
                        (actionlib::goal-status *h*) (actionlib:connected-to-server *client*))""")
        == "((NIL :LOST) :LOST :LOST NIL)"
    )


@pytest.mark.parametrize("function", ["send-goal", "call-goal", "send-goal-and-wait"])
def test_a_goal_is_sent_only_to_a_server_that_is_there(lisp, function):
    lisp("""(setf *client* (actionlib:make-action-client "nobody" "actionlib_tutorials/FibonacciAction"))""")
    assert lisp.error(f"(actionlib:{function} *client* (goal 1))") == "Not connected to an action server. Cannot send goal."
    assert lisp.condition(f"(actionlib:{function} *client* (goal 1))").hint == (
        "Wait for the server of the action nobody first: (actionlib:wait-for-server client)."
    )


@pytest.mark.parametrize("form", ["(actionlib:send-goal 4 (goal 1))", "(actionlib:cancel-goal 4)", "(actionlib:result nil)"])
def test_what_is_no_client_is_a_type_error(client, form):
    assert client.error(form, "type-error")


def test_the_simple_client_still_forgets_the_goal_before(lisp):
    lisp("(both) (defvar *states* nil) (actionlib-lisp:send-goal *client* (goal 9) :done-cb (lambda (s r) (push s *states*)))")
    assert lisp("(actionlib-lisp:send-goal *client* (goal 1)) (actionlib-lisp:wait-for-result *client* 0)") == "T"
    assert lisp("(list *states* (actionlib-lisp:state *client*))") == "(NIL :SUCCEEDED)"


def test_goals_that_are_over_are_not_kept(client):
    for _ in range(3):
        client("(actionlib:wait-for-result (send 1))")
    assert len(client.value("*client*").tracked) == 0


def test_callbacks_by_their_places_are_those_of_the_original(client):
    client("""(send 1 (lambda (state result) (note (list state (sequence-of result)))) (lambda (f) (note (sequence-of f)))
                      (lambda () (note :began)) (lambda (state) (note state)))""")
    assert client("(wait-duration 3) *notes*") == "(:PENDING :BEGAN :ACTIVE #(1) :DONE (:SUCCEEDED #(1 1)))"


def test_the_simple_state_of_a_goal(client):
    assert client("(progn (defvar *h* (send 2)) (actionlib:simple-state *h*))") == ":WAITING-FOR-ACK"
    assert client("(wait-duration 0.5) (actionlib:simple-state *h*)") == ":ACTIVE"
    assert client("(wait-duration 5) (actionlib:simple-state *h*)") == ":DONE"
    assert " ".join(client.error("(actionlib:simple-state 5)").split()) == "The value 5 is not of type ACTIONLIB::CLIENT-GOAL-HANDLE"


def test_send_goal_and_wait_is_call_goal(client):
    goal = "(actionlib:make-action-goal *client* :order {})"
    assert client(
        f"(multiple-value-bind (result state) (actionlib:send-goal-and-wait *client* {goal.format(2)}) (list (sequence-of result) state))"
    ) == ("(#(2 2) :SUCCEEDED)")
    assert client(f"(actionlib:send-goal-and-wait *client* {goal.format(9)} :exec-timeout 1.5 :result-timeout 1)") == "NIL :TIMEOUT"
    assert client(f"(actionlib:send-goal-and-wait *client* {goal.format(1)} :feedback-cb (lambda (f) (note (sequence-of f)))) *notes*") == (
        "(#(1))"
    )


def test_how_long_a_server_may_be_silent_is_a_variable(client):
    assert client("(list actionlib:*action-server-timeout* actionlib:*status-publish-interval* actionlib:*gc-interval*)") == (
        "(2.0 0.25 10.0)"
    )
    assert client("(list (actionlib:connected-to-server *client*) (let ((actionlib:*action-server-timeout* 0)) (wait-duration 0.1)"
                  " (actionlib:connected-to-server *client*)))") == "(T NIL)"  # fmt: skip
    problem = client.error("(let ((actionlib:*action-server-timeout* :long)) (actionlib:connected-to-server *client*))")
    assert " ".join(problem.split()) == "The value :LONG is not of type REAL"


def test_a_callback_may_leave_by_its_tag(lisp):
    lisp("(actionlib:def-exec-callback leaves (order) (throw 'actionlib:exec-callback-tag (* 2 order)) (note :never))")
    assert lisp('(leaves (make-message "actionlib_tutorials/FibonacciGoal" :order 4))') == "8"


def test_a_feedback_signal_has_the_handle_of_the_goal(client):
    assert client("""(let (seen)
                       (handler-bind ((actionlib:feedback-signal (lambda (s) (push (type-of (actionlib:goal s)) seen)
                                                                             (actionlib:cancel-goal (actionlib:goal s)))))
                         (list (nth-value 1 (actionlib:call-goal *client* (goal 9))) (remove-duplicates seen))))""") == (
        "(:PREEMPTED (ACTIONLIB::CLIENT-GOAL-HANDLE))"
    )


def test_an_exec_callback_has_documentation_and_declarations(lisp):
    lisp("""(actionlib:def-exec-callback documented (order) "What it does." (declare (ignorable order)) (actionlib:succeed-current))""")
    assert lisp("(documentation 'documented 'function)") == '"What it does."'


def test_an_exec_callback_that_is_called_and_ends_no_goal_is_an_error(lisp):
    lisp("(actionlib:def-exec-callback idle (order) (* 2 order))")
    assert lisp.error('(idle (make-message "actionlib_tutorials/FibonacciGoal" :order 4))') == (
        "Reached the end of exec callback IDLE without succeeding, aborting, or preempting"
    )
