"""The functions of the package ACTIONLIB-LISP: an action client that sends a goal and goes on, or waits for its end.

Repaired: a goal that was aborted, rejected or recalled is finished for `wait_for_result` and `send_goal_and_wait`; the original
waits on. A plan that is evaporated while it waits in `send_goal_and_wait` cancels its goal. Source: roslisp.md 13.1.
"""

from __future__ import annotations

from .. import kernel
from cramhy_runtime.ground import conditions
from cramhy_runtime.ground.condition_types import SimpleError
from cramhy_runtime.ground.data import truth
from cramhy_runtime.ground.packages import keyword
from ..ros.roslisp import logging
from . import goals
from .client import ActionClient

LOG_TOPIC = ("ACTIONLIB",)


def make_simple_action_client(action_name, action_type):
    """A client of the action ``action_name`` (a string) of ``action_type``, ``"package/NameAction"``."""
    return ActionClient(action_name, action_type)


def wait_for_server(client, timeout=0):
    """Wait until the server gives a sign of life, at most ``timeout`` seconds (0: for ever); T, or NIL when there was none."""
    return True if _client(client).wait_for_server(timeout) else None


def is_connected(client):
    """Whether the server was heard of within the last two seconds."""
    return True if _client(client).connected else None


def send_goal(client, goal, *, done_cb=None, active_cb=None, feedback_cb=None):
    """Send ``goal``, forgetting the one before; T. The callbacks: done-cb gets state and result, active-cb nothing, feedback-cb
    the feedback."""
    finished = _function(done_cb)
    done = None if finished is None else lambda goal: finished(keyword(goal.state), goal.result)
    _client(client).send(goal, done, _function(active_cb), _function(feedback_cb))
    return True


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
    client = _client(client)
    return True if _wait(client, _goal(client), timeout) else None


def _wait(client, goal, timeout):
    why = f"the end of the goal {goal.id} of action {client.name}"
    return client.waiting.wait(lambda: goal.done, why, goals.time_limit(timeout))


def state(client):
    """The state of the goal, a keyword: :pending :active :preempted :succeeded :aborted :rejected :recalled :lost."""
    return keyword(_goal(_client(client)).state)


def comm_state(client):
    """How far client and server have agreed on the goal, a keyword such as :waiting-for-goal-ack."""
    return keyword(_goal(_client(client)).communication)


def goal_status(client):
    """What the server last said of the goal, a keyword."""
    return keyword(goals.NAMES[_goal(_client(client)).status])


def terminal_state(client):
    """The state in which the goal ended, a keyword; NIL while it goes on."""
    terminal = _goal(_client(client)).terminal
    return None if terminal is None else keyword(goals.NAMES[terminal])


def goal_id(client):
    """The id of the goal, a string."""
    return _goal(_client(client)).id


def result(client):
    """The result message of the goal; NIL while there is none."""
    return _goal(_client(client)).result


def cancel_goal(client):
    """Ask the server to give up the goal; T."""
    client = _client(client)
    client.cancel(_goal(client))
    return True


def cancel_all_goals(client):
    """Ask the server to give up the goals of all clients; T."""
    _client(client).cancel_all()
    return True


def stop_tracking_goal(client):
    """Forget the goal; the server goes on with it. T."""
    client = _client(client)
    _goal(client)
    client.forget()
    return True


def goal_class(client):
    """The class of the goals of a client: ``make-action-goal-msg`` makes one."""
    return _client(client).action.goal


def _client(client):
    return client if isinstance(client, ActionClient) else conditions.type_error(client, "ACTIONLIB-LISP:SIMPLE-ACTION-CLIENT")


def _goal(client):
    if client.goal is None:
        return conditions.error(SimpleError("The client tracks no goal."))
    return client.goal


def _function(designator):
    return goals.function_of(designator) if truth(designator) else None
