"""The client's side of an action: the goals that it has sent, and in which state each is.

The client learns of its goal in two ways. Several times a second the server lists the states of all goals, and when one is over
it sends the result. Both go through one state machine, so that it does not matter which comes first:

    waiting-for-goal-ack → pending → active → preempting / recalling / waiting-for-cancel-ack → waiting-for-result → done

A goal that the server never lists is lost after five seconds, and so is one whose server falls silent for that long, or no longer
lists it; the original waits for ever in the second case. The callbacks of a goal run in the tasks of the subscribers, as all
callbacks of topics. ``goal`` is the newest goal, which ACTIONLIB-LISP speaks of; ACTIONLIB may send several and tracks each.
Source: roslisp.md 13.1.
"""

from __future__ import annotations

from .. import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.packages import keyword
from ..ros.messages import message_class
from ..ros.roslisp import node, topics
from ..ros.roslisp.clock import ros_time
from . import goals
from .goals import ABORTED, ACTIVE, KNOWN, LOST, PENDING, PREEMPTED, PREEMPTING, RECALLING, SUCCEEDED, TERMINAL, Action

PATIENCE = 5.0
"""Seconds after which a goal is lost that the server does not list, or whose server is silent."""
CONNECTED = 2.0
"""Seconds for which a sign of the server's life counts."""


class Goal:
    """A goal that was sent: its id, its state on the way (``communication``, a keyword's name) and at the end (``terminal``, a
    number of GoalStatus), what the server last said of it (``status``), its result, and the callbacks."""

    def __init__(self, goal_id, done, active, feedback):
        self.id, self.done_callback, self.active_callback, self.feedback_callback = goal_id, done, active, feedback
        self.change_callback = self.told = None  # who hears of changes of the simple state, and the last one that was told
        self.transition_callback = None  # who hears of changes of `communication`
        self.communication = "WAITING-FOR-GOAL-ACK"
        self.status, self.terminal, self.result = PENDING, None, None
        self.was_active = False
        self.sent = kernel.now()
        self.watch = None  # the timer that looks whether the server is silent

    @property
    def done(self):
        return self.communication == "DONE"

    @property
    def state(self):
        """The name of its state as users see it: one of those of GoalStatus, recalling as pending, preempting as active."""
        if self.done:
            return goals.NAMES[self.terminal]
        return "ACTIVE" if self.was_active else "PENDING"

    @property
    def simple_state(self):
        """The name of its state as ACTIONLIB's client knows it."""
        if self.done or self.communication == "WAITING-FOR-RESULT":
            return "DONE"
        if self.was_active:
            return "ACTIVE"
        return "WAITING-FOR-ACK" if self.communication == "WAITING-FOR-GOAL-ACK" else "PENDING"

    def move(self, communication):
        """Be in the state ``communication`` on the way, and call the callback for transitions if it is another one than before."""
        if communication != self.communication:
            self.communication = communication
            if self.transition_callback is not None:
                self.transition_callback()

    def tell_change(self):
        """Call the callback for changes, if the simple state is another one than it told last."""
        state = self.simple_state
        if self.change_callback is not None and state not in (self.told, "WAITING-FOR-ACK"):
            self.told = state
            self.change_callback(keyword(state))


class ActionClient:
    """A client of the action that is called ``name``; it belongs to the Lisp program's node. It may follow several goals at a time."""

    lisp_name = "ACTIONLIB-LISP::ACTION-CLIENT"

    def __init__(self, name, action_type):
        self.name, self.action = goals.check_name(name), Action(action_type)
        self.goal, self.tracked, self.heard, self.waiting = None, {}, None, kernel.Waiting()
        here = node.require_node()
        self.node = here
        self.goals = topics.advertise(f"{name}/goal", self.action.action_goal)
        self.cancels = topics.advertise(f"{name}/cancel", goals.GOAL_ID)
        self.subscribers = [
            topics.subscribe(f"{name}/status", goals.STATUS_ARRAY, self._status),
            topics.subscribe(f"{name}/feedback", self.action.action_feedback, self._feedback),
            topics.subscribe(f"{name}/result", self.action.action_result, self._result),
        ]

    def __repr__(self):
        return f"#<{self.lisp_name.rpartition('::')[2]} {self.name} {self.action.name}>"

    @property
    def connected(self):
        """Whether the server gave a sign of life within the last two seconds."""
        return self.heard is not None and kernel.now() - self.heard < goals.setting("*ACTION-SERVER-TIMEOUT*", CONNECTED)

    def wait_for_server(self, timeout=0):
        """Wait for a sign of life, at most ``timeout`` seconds (0: for ever); whether there was one."""
        return self.waiting.wait(lambda: self.connected, f"the server of action {self.name}", goals.time_limit(timeout))

    # ------------------------------------------------------------------------------------------------------ what it sends

    def send(self, message, done=None, active=None, feedback=None, alone=True):
        """Send a goal and track it from now on; the one before is forgotten if this is to be ``alone``. Returns the `Goal`."""
        goals.check_message(message, self.action.goal)
        if not self.node.alive:
            conditions.error(
                SimpleError("The node of the client of action ~a has ended.", self.name),
                hint="A client lives as long as the node that made it: make a new one.",
            )
        if alone and self.goal is not None:
            self.forget(self.goal)
        now = ros_time()
        goal_id = goals.new_goal_id(self.node.name, now)
        goal = self.goal = self.tracked[goal_id.id] = Goal(goal_id.id, done, active, feedback)
        try:
            topics.publish(self.goals, self.action.action_goal(header=_header(now), goal_id=goal_id, goal=message))
        except BaseException:  # it has a wrong value in a field
            self.forget(goal)
            raise
        self._watch_goal(goal)
        return goal

    def cancel(self, goal):
        """Ask the server to give up ``goal``; not when it is over."""
        if not goal.done and goal.communication != "WAITING-FOR-RESULT":
            if goal.communication not in ("PREEMPTING", "RECALLING"):
                goal.move("WAITING-FOR-CANCEL-ACK")
            self._cancel(goal.id)

    def cancel_all(self):
        """Ask the server to give up the goals of all clients."""
        self._await_cancelling(self.tracked.values())
        self._cancel("")

    def cancel_until(self, time):
        """Ask the server to give up the goals of all clients that were sent at ``time`` or before, in seconds since 1970."""
        epoch = self.node.graph.kernel.epoch
        self._await_cancelling(goal for goal in self.tracked.values() if epoch + goal.sent <= time)
        self._cancel("", time)

    def _await_cancelling(self, asked):
        for goal in asked:
            if goal.communication in ("WAITING-FOR-GOAL-ACK", "PENDING", "ACTIVE"):
                goal.move("WAITING-FOR-CANCEL-ACK")

    def _cancel(self, goal_id, stamp=0.0):
        if self.node.alive:
            topics.publish(self.cancels, message_class(goals.GOAL_ID)(id=goal_id, stamp=stamp))

    def forget(self, goal):
        """Track ``goal`` no more. For a task that waits for its end it is lost."""
        if self.goal is goal:
            self.goal = None
        if not goal.done:
            goal.communication, goal.terminal = "DONE", LOST
        self._let_go(goal)
        self.waiting.changed()

    def _let_go(self, goal):
        self.tracked.pop(goal.id, None)
        if goal.watch is not None:
            goal.watch.cancel()
            goal.watch = None

    # --------------------------------------------------------------------------------------------------- what it hears of

    def _sign_of_life(self):
        self.heard = kernel.now()
        self.waiting.changed()

    def _status(self, message):
        self._sign_of_life()
        for goal in list(self.tracked.values()):
            if not goal.done:  # a callback of another one may have ended it
                self._note_status(goal, message)

    def _note_status(self, goal, message):
        status = next((entry.status for entry in message.status_list if entry.goal_id.id == goal.id and entry.status in KNOWN), None)
        if status is not None:
            self._update(goal, status)
        elif goal.communication not in ("WAITING-FOR-GOAL-ACK", "WAITING-FOR-CANCEL-ACK", "WAITING-FOR-RESULT"):
            self._finish(goal, LOST)
        elif kernel.now() >= goal.sent + PATIENCE:
            self._finish(goal, LOST)

    def _update(self, goal, status):
        goal.status = status
        if not goal.was_active and status in (ACTIVE, PREEMPTING, PREEMPTED, SUCCEEDED, ABORTED):
            goal.was_active = True
            if goal.active_callback is not None:
                goal.active_callback()
            if goal.done:
                return
        if status in TERMINAL:
            goal.move("WAITING-FOR-RESULT")
        elif status in (PREEMPTING, RECALLING) or goal.communication != "WAITING-FOR-CANCEL-ACK":
            goal.move(goals.NAMES[status])
        goal.tell_change()
        self.waiting.changed()

    def _feedback(self, message):
        self._sign_of_life()
        goal = self.tracked.get(message.status.goal_id.id)
        if goal is not None and goal.feedback_callback is not None and not goal.done:
            goal.feedback_callback(message.feedback)

    def _result(self, message):
        self._sign_of_life()
        goal = self.tracked.get(message.status.goal_id.id)
        if goal is not None and not goal.done:
            status = message.status.status
            if status in KNOWN:
                self._update(goal, status)
            goal.result = message.result
            self._finish(goal, status if status in TERMINAL else LOST)

    def _finish(self, goal, terminal):
        if goal.done:
            return
        goal.terminal = terminal
        if terminal == LOST:
            goal.status = LOST
        self._let_go(goal)
        goal.move("DONE")
        self.waiting.changed()
        goal.tell_change()
        if goal.done_callback is not None:
            goal.done_callback(goal)

    def _watch_goal(self, goal):
        """Look again when the server may have been silent for too long."""
        silent_since = max(goal.sent, self.heard or 0.0)
        goal.watch = kernel.call_at(silent_since + PATIENCE, lambda: self._look_after(goal))

    def _look_after(self, goal):
        goal.watch = None
        if goal.done:
            return
        if kernel.now() >= max(goal.sent, self.heard or 0.0) + PATIENCE or not self.node.alive:
            owner = self.node.graph.kernel
            owner.spawn(lambda: self._finish(goal, LOST), name=f"Lost goal of {self.name}", parent=owner.main)
        else:
            self._watch_goal(goal)


def _header(stamp):
    return message_class("std_msgs/Header")(stamp=stamp)


def send_with_callbacks(client, message, done_cb, active_cb, feedback_cb, alone, state_change_cb=None):
    """`ActionClient.send` with the callbacks of a Lisp program, nil or functions: done-cb gets the state, a keyword, and the result.

    state-change-cb gets the simple state, ``:pending``, ``:active`` or ``:done``, whenever it changes.
    """
    finished = goals.function_or_none(done_cb)
    done = None if finished is None else lambda goal: finished(keyword(goal.state), goal.result)
    change = goals.function_or_none(state_change_cb)
    goal = client.send(message, done, goals.function_or_none(active_cb), goals.function_or_none(feedback_cb), alone)
    goal.change_callback = change
    return goal
