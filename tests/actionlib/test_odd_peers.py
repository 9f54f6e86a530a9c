"""Goals and requests that come in odd ways: from a shell, out of order, twice, from a node that has ended."""

import pytest

SENT = """
(defvar *results* nil)
(subscribe "count/result" "actionlib_tutorials/FibonacciActionResult"
  (lambda (m) (let ((status (actionlib_tutorials-msg:status m)))
                (setf *results* (append *results* (list (actionlib_msgs-msg:status status)))))))
(defvar *goals* (advertise "count/goal" "actionlib_tutorials/FibonacciActionGoal"))
(defvar *cancels* (advertise "count/cancel" "actionlib_msgs/GoalID"))
(serve)
"""


def test_a_goal_that_somebody_typed_has_no_id(lisp):
    lisp(SENT + "(publish-msg *goals* (:order :goal) 1)")
    assert lisp("(wait-duration 1.5) *results*") == "(3)"


def test_a_goal_that_is_sent_twice_is_done_once(lisp):
    lisp(SENT + '(dotimes (i 2) (publish-msg *goals* (:id :goal_id) "g" (:order :goal) 1))')
    assert lisp("(wait-duration 3) *results*") == "(3)"


def test_a_request_to_cancel_that_overtakes_its_goal(lisp):
    lisp(SENT + '(publish-msg *cancels* :id "g") (wait-duration 0.1) (publish-msg *goals* (:id :goal_id) "g" (:order :goal) 5)')
    assert lisp("(wait-duration 0.1) *results*") == "(8)"


def test_cancelling_all_goals_before_a_time(lisp):
    lisp(
        SENT
        + """(publish-msg *goals* (:id :goal_id) "early" (:stamp :goal_id) (ros-time) (:order :goal) 9)
                   (wait-duration 1.5)
                   (publish-msg *cancels* :stamp (- (ros-time) 1)) (wait-duration 1)
                   (publish-msg *goals* (:id :goal_id) "late" (:stamp :goal_id) (ros-time) (:order :goal) 1)"""
    )
    assert lisp("(wait-duration 3) *results*") == "(2 3)"


def test_a_client_of_a_node_that_has_ended(lisp):
    lisp('(both) (start-ros-node "m")')
    condition = lisp.condition("(actionlib-lisp:send-goal *client* (goal 1))")
    assert condition.report() == "The node of the client of action count has ended."
    assert condition.hint == "A client lives as long as the node that made it: make a new one."


def test_a_goal_that_cannot_be_sent_is_not_tracked(lisp):
    lisp("(both)")
    assert lisp.error("(actionlib-lisp:send-goal *client* (actionlib-lisp:make-action-goal-msg *client* :order 1.5))") == (
        "The value\n  1.5\nis not of type\n  INTEGER"
    )
    assert lisp.error("(actionlib-lisp:state *client*)") == "The client tracks no goal."


@pytest.mark.parametrize(
    "told",
    [
        """(publish-msg (advertise "count/status" "actionlib_msgs/GoalStatusArray")
         :status_list (vector (make-message "actionlib_msgs/GoalStatus" (:id :goal_id) (actionlib-lisp:goal-id *client*) :status 200)))""",
        """(publish-msg (advertise "count/result" "actionlib_tutorials/FibonacciActionResult")
         (:id :goal_id :status) (actionlib-lisp:goal-id *client*) (:status :status) 200)""",
    ],
)
def test_a_state_that_there_is_not_loses_the_goal(lisp, told, capsys):
    lisp(f"(client) (actionlib-lisp:send-goal *client* (goal 1)) {told}")
    assert lisp("(list (actionlib-lisp:wait-for-result *client* 20) (actionlib-lisp:state *client*))") == "(T :LOST)"
    assert "ERROR" not in capsys.readouterr().out


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("seed", range(6))
def test_in_whatever_order_the_messages_are_looked_at(seed):
    from cramhy_runtime import kernel
    from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
    from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
    from cramhy_runtime.repl.session import Session
    from lisp_text import LispText
    from tests_of_actions import PRELUDE

    lisp = LispText(Session(time="virtual", turtlesim=False, seed=seed, time_limit=3600), PRELUDE.format(name=f"ACTION-SEED-{seed}"))
    try:
        assert (
            lisp("""(both)
                       (note (actionlib-lisp:send-goal-and-wait *client* (goal 2) 0 0))
                       (progn (actionlib-lisp:send-goal *client* (goal 5)) (actionlib-lisp:cancel-goal *client*))
                       (actionlib-lisp:wait-for-result *client* 0)
                       (note (member (actionlib-lisp:state *client*) '(:preempted :recalled)))
                       (progn (actionlib-lisp:send-goal *client* (goal 5)) (actionlib-lisp:send-goal *client* (goal 1)))
                       (actionlib-lisp:wait-for-result *client* 0)
                       (note (actionlib-lisp:state *client*))
                       (note (nth-value 1 (actionlib:call-goal *client* (goal 1))))
                       (list (first *notes*) (and (second *notes*) t) (cddr *notes*))""")
            == "(:SUCCEEDED T (:SUCCEEDED :SUCCEEDED))"
        )
    finally:
        PACKAGE.value = COMMON_LISP_USER
        kernel.stop()


def test_a_second_server_of_an_action_would_do_its_goals_twice(lisp):
    condition = lisp.condition("(serve) (serve)")
    assert condition.report() == "The action count has a server already, on this node."
    assert condition.hint == "Two servers would both do what a client wants once. A server ends with its node: (shutdown-ros-node)."
    assert lisp('(start-ros-node "m") (both) (actionlib:call-goal *client* (goal 1)) (actionlib-lisp:state *client*)') == ":SUCCEEDED"


@pytest.mark.parametrize(
    "text, value, type_",
    [
        ('(actionlib-lisp:make-simple-action-client nil "actionlib_tutorials/FibonacciAction")', "NIL", "STRING"),
        ('(start-action-server 4 "actionlib_tutorials/FibonacciAction" #\'count-up :separate-thread t)', "4", "STRING"),
        ('(start-action-server "x" "actionlib_tutorials/FibonacciAction" 4 :separate-thread t)', "4", "FUNCTION"),
        ("(client) (actionlib-lisp:send-goal *client* (goal 1) :done-cb 4)", "4", "FUNCTION"),
        ("(both) (actionlib:call-goal *client* (goal 1) :feedback-cb 4)", "4", "FUNCTION"),
        ('(both) (actionlib:call-goal *client* (goal 1) :timeout "soon")', '"soon"', "(OR NULL REAL)"),
        ('(client) (actionlib-lisp:wait-for-server *client* "soon")', '"soon"', "(OR NULL REAL)"),
    ],
)
def test_what_an_action_is_made_of(lisp, text, value, type_):
    assert lisp.error(text, "type-error") == f"The value\n  {value}\nis not of type\n  {type_}"


def test_a_time_that_is_over_already_is_no_wait_for_ever(lisp):
    assert lisp("(client) (actionlib-lisp:wait-for-server *client* -1)") == "NIL"
    lisp("(both)")
    assert lisp("(multiple-value-list (actionlib:call-goal *client* (goal 1) :timeout -1 :result-timeout -1))") == "(NIL :TIMEOUT)"
