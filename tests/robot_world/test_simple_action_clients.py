"""Clients of actions by name. Source: mobile-manipulation.md, section 11, last paragraph."""

import pytest

SERVER = """
(asdf:load-system :actionlib)
(asdf:load-system :cram-simple-actionlib-client)
(actionlib:def-exec-callback counting (order)
  (cpl:sleep (* 0.1 order))
  (actionlib:succeed-current :sequence (coerce (loop for i below order collect i) 'vector)))
(roslisp-utilities:startup-ros :name "caller")
(actionlib:start-action-server "fibonacci" "actionlib_tutorials/FibonacciAction" #'counting :separate-thread t)
(defun goal (order) (roslisp:make-message "actionlib_tutorials/FibonacciGoal" :order order))"""
CALL = """(multiple-value-bind (result status) (actionlib-client:call-simple-action-client 'count :action-goal (goal {}) :action-timeout {})
            (list (and result (roslisp:with-fields (sequence) result sequence)) status))"""


@pytest.fixture
def server(lisp):
    lisp(SERVER)
    yield lisp
    lisp("(roslisp-utilities:shutdown-ros)")


@pytest.mark.parametrize("at_once", ["nil", "t"])
def test_a_call(server, at_once):
    assert server(
        f'(actionlib-client:make-simple-action-client \'count "fibonacci" "actionlib_tutorials/FibonacciAction" 5 :initialize-now {at_once})'
    ) == ("ROBOT-TESTS::COUNT").replace("ROBOT-TESTS::", "")
    assert server(CALL.format(3, 10)) == "(#(0 1 2) :SUCCEEDED)"
    assert server(CALL.format(2, "nil")) == "(#(0 1) :SUCCEEDED)"
    assert server(CALL.format(50, 1)) == "(NIL :TIMEOUT)"


def test_nobody_to_call(server):
    assert server(CALL.format(3, 10).replace("'count", "'nobody")) == "(NIL NIL)"
    server('(actionlib-client:make-simple-action-client \'lost "nowhere" "actionlib_tutorials/FibonacciAction" 2)')
    assert server(CALL.format(3, 10).replace("'count", "'lost")) == "(NIL NIL)"


def test_a_client_connects_anew_when_the_node_starts_again(server):
    server('(actionlib-client:make-simple-action-client \'count "fibonacci" "actionlib_tutorials/FibonacciAction" 5)')
    assert server(CALL.format(1, 10)) == "(#(0) :SUCCEEDED)"
    server("(roslisp-utilities:shutdown-ros)")
    server(SERVER)
    assert server(CALL.format(2, 10)) == "(#(0 1) :SUCCEEDED)"
