"""ACTIONLIB-LISP: the client that sends a goal and goes on (roslisp.md 13.1)."""

import pytest

AL = "actionlib-lisp:"


def test_a_goal_is_sent_and_its_end_is_waited_for(lisp):
    assert lisp("(both)") == "T"
    assert lisp(f"(let ((start (ros-time))) (list ({AL}send-goal-and-wait *client* (goal 3) 0 0) (round (- (ros-time) start))))") == (
        "(:SUCCEEDED 3)"
    )
    assert lisp(f"(sequence-of ({AL}result *client*))") == "#(3 3)"
    assert lisp(f"(list ({AL}state *client*) ({AL}comm-state *client*) ({AL}terminal-state *client*) ({AL}goal-status *client*))") == (
        "(:SUCCEEDED :DONE :SUCCEEDED :SUCCEEDED)"
    )


def test_callbacks_tell_when_it_begins_goes_on_and_ends(lisp):
    lisp("(both)")
    assert (
        lisp(f"""({AL}send-goal *client* (goal 2)
                      :active-cb (lambda () (note :active))
                      :feedback-cb (lambda (f) (note (sequence-of f)))
                      :done-cb (lambda (state result) (note (list state (sequence-of result)))))""")
        == "T"
    )
    assert lisp(f"(list ({AL}wait-for-result *client* 0) *notes*)") == "(T (:ACTIVE #(1) #(2) (:SUCCEEDED #(2 2))))"


def test_the_states_on_the_way(lisp):
    lisp("(both)")
    assert lisp(f"""(progn ({AL}send-goal *client* (goal 3)) (note ({AL}comm-state *client*)))
                    (wait-duration 0.5) (note ({AL}comm-state *client*)) (note ({AL}state *client*))
                    (progn ({AL}cancel-goal *client*) (note ({AL}comm-state *client*)) (note ({AL}state *client*)))
                    (wait-duration 0.1) (note ({AL}comm-state *client*)) (note ({AL}state *client*))
                    ({AL}wait-for-result *client* 0) (note ({AL}comm-state *client*)) (note ({AL}state *client*))
                    *notes*""") == (
        "(:WAITING-FOR-GOAL-ACK :ACTIVE :ACTIVE :WAITING-FOR-CANCEL-ACK :ACTIVE :PREEMPTING :ACTIVE :DONE :PREEMPTED)"
    )
    assert lisp(f"(sequence-of ({AL}result *client*))") == "#(2)"


@pytest.mark.parametrize("order, state", [(13, ":ABORTED"), (14, ":ABORTED"), (15, ":ABORTED")])
def test_an_aborted_goal_is_finished(lisp, order, state):
    """The original waits on (differences.md)."""
    lisp("(both)")
    assert lisp(f"({AL}send-goal-and-wait *client* (goal {order}) 0 0)") == state
    assert lisp(f"({AL}send-goal *client* (goal {order})) (list ({AL}wait-for-result *client* 60) ({AL}state *client*))") == f"(T {state})"


def test_a_result_that_takes_too_long(lisp):
    lisp("(both)")
    assert lisp(f"({AL}send-goal *client* (goal 5)) (list ({AL}wait-for-result *client* 2) ({AL}state *client*))") == "(NIL :ACTIVE)"
    assert lisp(f"({AL}wait-for-result *client* 0)") == "T"


def test_the_execute_timeout_cancels_the_goal(lisp, capsys):
    lisp("(both)")
    capsys.readouterr()
    assert lisp(f"({AL}send-goal-and-wait *client* (goal 10) 2.5 0)") == ":PREEMPTED"
    assert "[(ACTIONLIB) INFO]" in (text := capsys.readouterr().out) and text.endswith(": Reached execute timeout.\n")


def test_the_preempt_timeout(lisp, capsys):
    lisp("(both)")
    capsys.readouterr()
    assert lisp(f"({AL}send-goal-and-wait *client* (goal 10) 2.5 0.1)") == ":ACTIVE"
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(": ")[1] for line in lines] == ["Reached execute timeout.", "Reached preempt timeout."]


def test_a_newer_goal_takes_the_place_of_the_one_before(lisp):
    lisp("(both)")
    assert (
        lisp(f"""({AL}send-goal *client* (goal 9) :done-cb (lambda (s r) (declare (ignore r)) (note s)))
                    (wait-duration 1.5)
                    (list ({AL}send-goal-and-wait *client* (goal 1) 0 0) *notes*)""")
        == "(:SUCCEEDED NIL)"
    )


def test_evaporation_cancels_the_goal(lisp):
    lisp("(both)")
    assert (
        lisp(f"""(subscribe "count/cancel" "actionlib_msgs/GoalID" (lambda (m) (note (actionlib_msgs-msg:id m))))
                    (top-level (pursue (wait-duration 1.5) (note ({AL}send-goal-and-wait *client* (goal 10) 0 0))))
                    (wait-duration 3)
                    (list ({AL}state *client*) (equal *notes* (list ({AL}goal-id *client*))))""")
        == "(:PREEMPTED T)"
    )


def test_cancelling_all_goals_of_all_clients(lisp):
    lisp("(both)")
    assert (
        lisp(f"""(defvar *other* *client*) (client) ({AL}wait-for-server *client*)
                    ({AL}send-goal *other* (goal 9)) (wait-duration 0.5)
                    ({AL}send-goal *client* (goal 9))
                    (wait-duration 0.1) ({AL}cancel-all-goals *client*)
                    (wait-duration 3) (list ({AL}state *other*) ({AL}state *client*))""")
        == "(:PREEMPTED :RECALLED)"
    )


def test_without_a_server(lisp):
    lisp("(client)")
    assert lisp(f"(list ({AL}wait-for-server *client* 3) ({AL}is-connected *client*))") == "(NIL NIL)"
    assert lisp(f"(let ((start (ros-time))) (list ({AL}send-goal-and-wait *client* (goal 3) 0 0) (round (- (ros-time) start))))") == (
        "(:LOST 5)"
    )


def test_a_server_that_goes_away_loses_the_goal(lisp):
    """The original waits for ever (differences.md)."""
    lisp("(serve) (client)")
    server = "(:LOST T NIL)"
    lisp(
        f"({AL}wait-for-server *client*) ({AL}send-goal *client* (goal 1000) :done-cb (lambda (s r) (note (list s r))))(wait-duration 2.6)"
    )
    from cramhy_runtime.ros import graph

    node = graph.active().lisp_node
    for name in ("/count/status", "/count/feedback", "/count/result"):
        node.unadvertise(name)  # as if its process had been killed
    assert (
        lisp(
            f"(let ((start (ros-time))) ({AL}wait-for-result *client* 0) "
            f"(list ({AL}state *client*) (< 4 (- (ros-time) start) 5.1) ({AL}is-connected *client*)))"
        )
        == server
    )
    assert lisp("*notes*") == "((:LOST NIL))"


def test_a_goal_can_be_forgotten(lisp):
    lisp("(both)")
    assert lisp(f"({AL}send-goal *client* (goal 1) :done-cb (lambda (s r) (note (list s r)))) ({AL}stop-tracking-goal *client*)") == "T"
    assert lisp("(wait-duration 3) *notes*") == "NIL"
    for function in "state result comm-state goal-id goal-status terminal-state cancel-goal stop-tracking-goal".split():
        assert lisp.error(f"({AL}{function} *client*)") == "The client tracks no goal."
    assert lisp.error(f"({AL}wait-for-result *client* 1)") == "The client tracks no goal."


def test_the_id_of_a_goal(lisp):
    lisp("(both)")
    assert lisp(f"({AL}send-goal *client* (goal 1)) (subseq ({AL}goal-id *client*) 0 3)") == '"/n-"'


@pytest.mark.parametrize(
    "form, text",
    [
        (f'({AL}make-simple-action-client "x" "actionlib_tutorials/Fibonacci")',
         "The action type is invalid. Actions always have the suffix 'Action'"),
        (f'({AL}make-simple-action-client "x" "actionlib_tutorials/NoAction")', "No datatype actionlib_tutorials/NoAction known"),
        (f'({AL}send-goal *client* 3)', "The value\n  3\nis not of type\n  ACTIONLIB_TUTORIALS-MSG:FIBONACCIGOAL"),
        (f'({AL}send-goal 3 (goal 1))', "The value\n  3\nis not of type\n  ACTIONLIB-LISP:SIMPLE-ACTION-CLIENT"),
        (f'({AL}make-action-goal-msg *client* :ordr 3)', "Could not find field ORDR in (FIBONACCIGOAL (ORDER . 0))"),
    ],
)  # fmt: skip
def test_mistakes(lisp, form, text):
    lisp("(client)")
    assert lisp.error(form) == text


def test_an_error_in_a_callback_is_logged_and_the_goal_goes_on(lisp, capsys):
    lisp("(both)")
    assert (
        lisp(f"""({AL}send-goal *client* (goal 2) :feedback-cb (lambda (f) (declare (ignore f)) (error "oh"))
                                                    :done-cb (lambda (s r) (declare (ignore r)) (note s)))
                    ({AL}wait-for-result *client* 0) (wait-duration 0.1) *notes*""")
        == "(:SUCCEEDED)"
    )
    assert "Error during subscriber callback: 'oh'" in capsys.readouterr().out
