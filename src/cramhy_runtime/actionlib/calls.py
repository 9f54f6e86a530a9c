"""The client of the package ACTIONLIB: `call_goal` sends a goal and returns with its end, `send_goal` goes on.

Each feedback is signalled as a ``feedback-signal`` in the task that waits, so that the plan around it can look at it and, by the
restart ``abort-goal``, give the goal up. A server that falls silent for two seconds is the error ``server-lost``. Whoever leaves
the call otherwise cancels the goal. A goal is sent only while the server gives signs of life. Source: roslisp.md 13.2.
"""

from __future__ import annotations

from collections import deque

from .. import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Condition, Error, SimpleError
from cramhy_runtime.lisp_core.data import Keyword, MultipleValues, truth
from cramhy_runtime.lisp_core.packages import ensure_package, find_package, keyword
from ..ros.messages import load_package
from . import goals
from .client import CONNECTED, ActionClient, send_with_callbacks

ACKNOWLEDGE = 1.0
"""Seconds that a server has to tell the end of a goal that was given up, if the caller does not say otherwise."""


class ServerLost(Error):
    """The server of a goal gave no sign of life for two seconds."""

    lisp_name = "ACTIONLIB::SERVER-LOST"

    def report(self):
        return "Client lost connection to server."


class FeedbackSignal(Condition):
    """The server told how far it is; ``goal`` is the handle of the goal, ``feedback`` the message. Not to handle it is fine."""

    lisp_name = "ACTIONLIB::FEEDBACK-SIGNAL"
    initargs = {"GOAL": "goal", "FEEDBACK": "feedback"}

    def __init__(self, goal=None, feedback=None, **slots):
        super().__init__(**slots)
        self.goal, self.feedback = goal, feedback

    def report(self):
        return f"Feedback of an action: {self.feedback!r}"


def _signal(thing):
    return thing if isinstance(thing, FeedbackSignal) else conditions.type_error(thing, "FEEDBACK-SIGNAL")


def goal(signal):
    """The handle of the goal that a ``feedback-signal`` is about."""
    return _signal(signal).goal


def feedback(signal):
    """The feedback message of a ``feedback-signal``."""
    return _signal(signal).feedback


class HandlingClient(ActionClient):
    """The client of ACTIONLIB, whose goals are followed by their handles."""

    lisp_name = "ACTIONLIB::ACTION-CLIENT"


class GoalHandle:
    """A goal that `send_goal` sent: what there is to know of it, and how to cancel it, while other goals of the client go on."""

    lisp_name = "ACTIONLIB::CLIENT-GOAL-HANDLE"

    def __init__(self, client, goal):
        self.client, self.goal = client, goal

    def __repr__(self):
        return f"#<CLIENT-GOAL-HANDLE {self.goal.id} {self.goal.communication}>"


def send_goal(client, goal, *callbacks):
    """Send ``goal`` and go on; returns a `GoalHandle`. Goals that were sent before are tracked as ever.

    The callbacks are optional: done-cb, which gets state and result, feedback-cb, which gets the feedback, active-cb, without arguments,
    and state-change-cb, which gets the simple state when it changes. They may be named, too: ``:active-cb function``.
    """
    _check_connected(client)
    names = ("DONE-CB", "FEEDBACK-CB", "ACTIVE-CB", "STATE-CHANGE-CB")
    named = bool(callbacks) and isinstance(callbacks[0], Keyword)
    pairs = list(zip((key.name for key in callbacks[::2]), callbacks[1::2], strict=True)) if named else list(zip(names, callbacks))
    given = dict(reversed(pairs))
    if not named and len(callbacks) > len(names) or given.keys() - set(names):
        return conditions.program_error(
            "ACTIONLIB:SEND-GOAL takes a client, a goal, and up to four callbacks: done, feedback, active, state change."
        )
    done, feedback, active, change = map(given.get, names)
    return GoalHandle(client, send_with_callbacks(client, goal, done, active, feedback, alone=False, state_change_cb=change))


def send_goal_and_wait(client, goal, *, exec_timeout=None, result_timeout=None, feedback_cb=None):
    """As `call_goal`, whose ``timeout`` is ``exec_timeout``."""
    return call_goal(client, goal, timeout=exec_timeout, result_timeout=result_timeout, feedback_cb=feedback_cb)


def simple_state(handle):
    """The state of a goal that was sent, a keyword: ``:waiting-for-ack``, ``:pending``, ``:active`` or ``:done``."""
    if not isinstance(handle, GoalHandle):
        return conditions.type_error(handle, "ACTIONLIB::CLIENT-GOAL-HANDLE")
    return keyword(handle.goal.simple_state)


def make_action_client(action_name, action_type):
    """A client of the action ``action_name`` (a string) of ``action_type``, ``"package/NameAction"``."""
    name = goals.check_name(action_type)
    package = name.partition("/")[0]
    if load_package(package) is None:
        return conditions.error(
            SimpleError("Package for action `~a' doesn't seem to be loaded", name), hint=f"There is no package of messages {package}."
        )
    return HandlingClient(action_name, name)


def _check_connected(client):
    """An error if ``client`` is none, or if its server gave no sign of life lately."""
    if not isinstance(client, ActionClient):
        conditions.type_error(client, "ACTIONLIB::ACTION-CLIENT")
    if not client.connected:
        conditions.error(
            SimpleError("Not connected to an action server. Cannot send goal."),
            hint=f"Wait for the server of the action {client.name} first: (actionlib:wait-for-server client).",
        )


def call_goal(client, goal, *, timeout=None, result_timeout=None, feedback_cb=None):
    """Send ``goal`` and wait for its end: its result and the keyword of its state; NIL and :TIMEOUT after ``timeout`` seconds.

    A goal whose time is over is cancelled; the server then has ``result_timeout`` seconds (1) to tell its end. feedback_cb: a function that
    is called with each feedback before it is signalled. The restart ``abort-goal`` cancels the goal and returns its argument, or NIL, and
    :ABORTED. A client that is not connected to its server is an error.
    """
    _check_connected(client)
    feedbacks = deque()

    def note(message):
        feedbacks.append(message)
        client.waiting.changed()

    callback = goals.function_of(feedback_cb) if truth(feedback_cb) else None
    limit = goals.time_limit(timeout)
    sent = client.send(goal, feedback=note, alone=False)
    handle = GoalHandle(client, sent)

    def follow():
        while True:
            if not _wait(client, sent, feedbacks, limit):
                return None
            while feedbacks:
                message = feedbacks.popleft()
                if callback is not None:
                    callback(message)
                conditions.signal_condition(FeedbackSignal(handle, message))
            if sent.done:
                return MultipleValues((sent.result, keyword(sent.state)))

    def abort(result=None):
        client.cancel(sent)
        return MultipleValues((result, keyword("ABORTED")))

    def give_up():
        client.cancel(sent)
        client.waiting.wait(lambda: sent.done, f"the end of the cancelled goal {sent.id}",
                            goals.time_limit(ACKNOWLEDGE if result_timeout is None else result_timeout))  # fmt: skip

    try:
        values = conditions.restart_case([(_abort_goal(), abort, "Preempt the goal.")], follow)
        if values is None:
            give_up()
            values = MultipleValues((None, keyword("TIMEOUT")))
    except BaseException:
        with kernel.cleanup():
            client.cancel(sent)
        raise
    return values


def _abort_goal():
    """The name of the restart. A program in Python has no Lisp that would make its package."""
    return (find_package("ACTIONLIB") or ensure_package("ACTIONLIB")).intern("ABORT-GOAL")


def _wait(client, sent, feedbacks, limit):
    """Wait for the end or feedback: True; False when the time ``limit`` is reached. A silent server is an error."""

    def something():
        return feedbacks or sent.done

    while True:
        patience = goals.setting("*ACTION-SERVER-TIMEOUT*", CONNECTED)
        silent = max(sent.sent, client.heard or 0.0) + patience
        until = silent if limit is None else min(silent, limit)
        if client.waiting.wait(something, f"the end of the goal {sent.id} of action {client.name}", until):
            return True
        if limit is not None and kernel.now() >= limit:
            return False
        if kernel.now() >= max(sent.sent, client.heard or 0.0) + patience:
            conditions.error(ServerLost())
