"""ACTIONLIB-LISP's client of several goals, each with a handle that tells of its transitions (roslisp.md 13.1)."""

import pytest


@pytest.fixture
def client(lisp):
    lisp("""(serve) (setf *client* (actionlib-lisp::make-action-client "count" "actionlib_tutorials/FibonacciAction"))
            (actionlib-lisp:wait-for-server *client*)
            (defun send (n &rest options)
              (apply #'actionlib-lisp:send-goal *client* (actionlib-lisp::make-action-goal-msg *client* :order n) options))""")
    return lisp


def test_its_name_is_internal_and_its_class_is_another_one(client):
    assert client('(nth-value 1 (find-symbol "MAKE-ACTION-CLIENT" :actionlib-lisp))') == ":INTERNAL"
    assert (
        client("(list (type-of *client*) (typep *client* 'actionlib-lisp:simple-action-client))") == "(ACTIONLIB-LISP::ACTION-CLIENT NIL)"
    )
    assert client("(client) (list (type-of *client*) (typep *client* 'actionlib-lisp::action-client))") == (
        "(ACTIONLIB-LISP:SIMPLE-ACTION-CLIENT T)"
    )


def test_a_goal_has_a_handle_that_tells_of_each_transition(client):
    note = "(lambda (handle) (note (list (actionlib-lisp:comm-state handle) (actionlib-lisp:goal-status handle))))"
    sent = f"(setf *h* (send 1 :transition-cb {note}))"
    assert client(f"(defvar *h*) (progn {sent} (list (actionlib-lisp:comm-state *h*) (actionlib-lisp:terminal-state *h*)))") == (
        "(:WAITING-FOR-GOAL-ACK NIL)"
    )
    assert client("(type-of *h*)") == "ACTIONLIB-LISP::CLIENT-GOAL-HANDLE"
    assert client("(wait-duration 3) *notes*") == (
        "((:PENDING :PENDING) (:ACTIVE :ACTIVE) (:WAITING-FOR-RESULT :SUCCEEDED) (:DONE :SUCCEEDED))"
    )
    assert client("(list (actionlib-lisp:terminal-state *h*) (sequence-of (actionlib-lisp:result *h*)))") == "(:SUCCEEDED #(1 1))"


def test_feedback_comes_with_the_handle(client):
    client("(defvar *h* (send 2 :feedback-cb (lambda (handle feedback) (note (list (eq handle *h*) (sequence-of feedback))))))")
    assert client("(wait-duration 3.5) *notes*") == "((T #(1)) (T #(2)))"


def test_goals_are_followed_side_by_side_and_cancelled_one_by_one(client):
    client("(defvar *one* (send 9)) (wait-duration 1.5) (defvar *two* (send 9)) (wait-duration 2.5)")
    assert client("(list (actionlib-lisp:terminal-state *one*) (actionlib-lisp:comm-state *two*))") == "(:PREEMPTED :ACTIVE)"
    assert client("(progn (actionlib-lisp:cancel *two*) (actionlib-lisp:comm-state *two*))") == ":WAITING-FOR-CANCEL-ACK"
    assert client("(wait-duration 2.5) (actionlib-lisp:terminal-state *two*)") == ":PREEMPTED"


def test_cancelling_is_a_transition(client):
    client("(defvar *h* (send 9 :transition-cb (lambda (handle) (note (actionlib-lisp:comm-state handle))))) (wait-duration 0.5)")
    assert client("(progn (setf *notes* nil) (actionlib-lisp:cancel *h*) *notes*)") == "(:WAITING-FOR-CANCEL-ACK)"


def test_a_goal_whose_server_never_answers_is_lost(lisp):
    lisp("""(setf *client* (actionlib-lisp::make-action-client "nobody" "actionlib_tutorials/FibonacciAction"))
            (defvar *h* (actionlib-lisp:send-goal *client* (goal 1) :transition-cb (lambda (handle) (note (actionlib-lisp:comm-state handle)))))""")
    assert lisp("(wait-duration 6) (list *notes* (actionlib-lisp:goal-status *h*) (actionlib-lisp:result *h*))") == "((:DONE) :LOST NIL)"


@pytest.mark.parametrize("option", [":transition-cb 5", ":feedback-cb 5"])
def test_a_callback_that_is_no_function_is_a_type_error(client, option):
    assert client.error(f"(send 1 {option})", "type-error")
