"""The functions of the package ACTIONLIB-LISP: an action client that sends a goal and goes on, or waits for its end.

A simple client follows one goal. One that `make_action_client` makes follows several: each goal that it sends has a handle. Where a
function is about one goal, it takes the client, for its newest goal, or a handle, also one of ACTIONLIB (`calls.send_goal`).

Repaired: a goal that was aborted, rejected or recalled is finished for `wait_for_result` and `send_goal_and_wait`; the original
waits on. A plan that is evaporated while it waits in `send_goal_and_wait` cancels its goal. Source: roslisp.md 13.1.
"""

from __future__ import annotations

from .. import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.data import MultipleValues
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.packages import keyword
from ..ros.roslisp import logging
from . import goals
from .calls import GoalHandle
from .client import ActionClient, send_with_callbacks

LOG_TOPIC = ("ACTIONLIB",)


class SimpleActionClient(ActionClient):
    """A client that follows one goal at a time."""

    lisp_name = "ACTIONLIB-LISP::SIMPLE-ACTION-CLIENT"


class ClientGoalHandle(GoalHandle):
    """A goal of a client that follows several."""

    lisp_name = "ACTIONLIB-LISP::CLIENT-GOAL-HANDLE"


def make_simple_action_client(action_name, action_type):
    """A client of the action ``action_name`` (a string) of ``action_type``, ``"package/NameAction"``, that follows one goal at a time."""
    return SimpleActionClient(action_name, action_type)


def make_action_client(action_name, action_type):
    """A client of the action ``action_name`` of ``action_type``, as above, whose goals are followed by their handles, several at a time."""
    return ActionClient(action_name, action_type)


def wait_for_server(client, timeout=0):
    """Wait until the server gives a sign of life, at most ``timeout`` seconds (0: for ever); T, or NIL when there was none."""
    return True if _client(client).wait_for_server(timeout) else None


def is_connected(client):
    """Whether the server was heard of within the last two seconds."""
    return True if _client(client).connected else None


def send_goal(client, goal, *, done_cb=None, active_cb=None, feedback_cb=None, transition_cb=None):
    """Send ``goal`` and go on.

    A simple client forgets the goal before; T. done-cb gets state and result at the end, active-cb nothing when the work begins,
    feedback-cb the feedback. A client of `make_action_client` gives a handle of the goal; transition-cb gets that handle whenever its
    `comm_state` changes, and feedback-cb the handle and the feedback.
    """
    if type(client) is ActionClient:
        return _send_with_handle(client, goal, transition_cb, feedback_cb)
    send_with_callbacks(_client(client), goal, done_cb, active_cb, feedback_cb, alone=True)
    return True


def _send_with_handle(client, goal, transition_cb, feedback_cb):
    moved, heard = goals.function_or_none(transition_cb), goals.function_or_none(feedback_cb)
    handle = ClientGoalHandle(client, None)
    handle.goal = sent = client.send(goal, feedback=None if heard is None else lambda message: heard(handle, message), alone=False)
    if moved is not None:
        sent.transition_callback = lambda: moved(handle)
    return handle


def send_goal_and_wait(client, goal, execute_timeout, preempt_timeout):
    """Send ``goal`` and wait for its end; the state keyword.

    When ``execute_timeout`` seconds are over the goal is cancelled, and then its end is waited for, at most ``preempt_timeout``
    seconds (0: no limit). Whoever leaves this in another way cancels the goal too.
    """
    client = _client(client)
    sent = client.send(goal)
    try:
        if not _wait(client, sent, execute_timeout):
            logging.log_text(logging.INFO, LOG_TOPIC, "Reached execute timeout.")
            client.cancel(sent)
            if not _wait(client, sent, preempt_timeout):
                logging.log_text(logging.INFO, LOG_TOPIC, "Reached preempt timeout.")
    except BaseException:
        with kernel.cleanup():
            client.cancel(sent)
        raise
    return keyword(sent.state)


def wait_for_result(client, timeout):
    """Wait until the goal is finished, at most ``timeout`` seconds (0: for ever); T, or NIL when it was not."""
    return True if _wait(_client_of(client), _goal(client), timeout) else None


def wait_for_the_result(goal, timeout=None):
    """``actionlib:wait-for-result``: wait until the goal is finished. Two values: its result message, or NIL, and the keyword of its state.

    After ``timeout`` seconds, if they are given, they are NIL and :TIMEOUT.
    """
    sent = _goal(goal)
    limit = None if timeout is None else kernel.now() + max(float(timeout), 0.0)
    if _client_of(goal).waiting.wait(lambda: sent.done, f"the end of the goal {sent.id}", limit):
        return MultipleValues((sent.result, keyword(sent.state)))
    return MultipleValues((None, keyword("TIMEOUT")))


def _wait(client, goal, timeout):
    why = f"the end of the goal {goal.id} of action {client.name}"
    return client.waiting.wait(lambda: goal.done, why, goals.time_limit(timeout))


def state(client):
    """The state of the goal, a keyword: :pending :active :preempted :succeeded :aborted :rejected :recalled :lost."""
    return keyword(_goal(client).state)


def comm_state(client):
    """How far client and server have agreed on the goal, a keyword such as :waiting-for-goal-ack."""
    return keyword(_goal(client).communication)


def goal_status(client):
    """What the server last said of the goal, a keyword."""
    return keyword(goals.NAMES[_goal(client).status])


def terminal_state(client):
    """The state in which the goal ended, a keyword; NIL while it goes on."""
    terminal = _goal(client).terminal
    return None if terminal is None else keyword(goals.NAMES[terminal])


def goal_id(client):
    """The id of the goal, a string."""
    return _goal(client).id


def result(client):
    """The result message of the goal; NIL while there is none."""
    return _goal(client).result


def cancel_goal(client):
    """Ask the server to give up the goal; T."""
    _client_of(client).cancel(_goal(client))
    return True


def cancel_all_goals(client):
    """Ask the server to give up the goals of all clients; T."""
    _client(client).cancel_all()
    return True


def cancel_at_before_time(client, time):
    """Ask the server to give up the goals of all clients that were sent at ``time`` (a time of ROS, in seconds) or before; T."""
    if not is_real(time):
        conditions.type_error(time, "REAL")
    _client(client).cancel_until(float(time))
    return True


def stop_tracking_goal(client):
    """Forget the goal; the server goes on with it. T."""
    _client_of(client).forget(_goal(client))
    return True


def goal_class(client):
    """The class of the goals of a client: ``make-action-goal-msg`` makes one."""
    return _client(client).action.goal


def _client(client):
    return client if isinstance(client, ActionClient) else conditions.type_error(client, "ACTIONLIB-LISP:SIMPLE-ACTION-CLIENT")


def _client_of(client):
    return client.client if isinstance(client, GoalHandle) else _client(client)


def _goal(client):
    """The goal of a handle, or the newest one of a client."""
    goal = client.goal if isinstance(client, GoalHandle) else _client(client).goal
    return conditions.error(SimpleError("The client tracks no goal.")) if goal is None else goal
