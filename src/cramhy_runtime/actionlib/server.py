"""The server's side of an action: goals come in, one after the other is given to a function, and all clients are told.

The *exec callback* gets the goal and ends by saying how it went: `succeed_current`, `abort_current` or `preempt_current`, which
leave it at once. One that falls off its end, or has an error, aborts its goal, and the error is logged; the original's client
would wait on. While a goal is worked on, a newer one waits for its turn, takes the place of one that waits already, and lets
`cancel_request_received` be true, as in ROS's simple action server.

The server tells the states of its goals four times a second and whenever one changes, and forgets a goal ten seconds after its
end. It lives as long as its node. Source: roslisp.md 13.2, wiki.ros.org/actionlib/DetailedDescription.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from .. import kernel
from cramhy_runtime.ground import conditions
from cramhy_runtime.ground.catching import catch, throw
from cramhy_runtime.ground.condition_types import Error, SimpleError
from cramhy_runtime.ground.data import truth
from cramhy_runtime.ground.printing import princ_to_string
from ..ros.messages import message_class
from ..ros.roslisp import logging, node, topics
from ..ros.roslisp.clock import ros_time
from ..ros.wire import ros_text
from . import goals
from .goals import ABORTED, ACTIVE, PENDING, PREEMPTED, PREEMPTING, RECALLED, SUCCEEDED, TERMINAL, Action

PERIOD = 0.25
"""Seconds between two reports of all states."""
MEMORY = 10.0
"""Seconds for which a finished goal is still reported."""
LOG_TOPIC = ("ACTIONLIB",)
CANCELLED_EARLY = "It was cancelled before it began."


class ServerGoal:
    """A goal that a client sent: its id message, what is asked, its state, and when it ended."""

    def __init__(self, goal_id, message):
        self.id, self.message = goal_id, message
        self.state, self.ended, self.text = PENDING, None, ""
        self.cancelled = False


class ActionServer:
    """Serves the action ``name``: ``callback(goal)`` works on one goal after the other, in the task that calls `run`."""

    def __init__(self, name, action_type, callback):
        self.name, self.action, self.callback = goals.check_name(name), Action(action_type), callback
        self.goals, self.next, self.current = [], None, None
        self.cancelled_ids, self.cancelled_until = {}, 0.0
        self.waiting = kernel.Waiting()
        here = self.node = node.require_node()
        if here.resolve(f"{name}/status") in here.publications:
            conditions.error(
                SimpleError("The action ~a has a server already, on this node.", self.name),
                hint="Two servers would both do what a client wants once. A server ends with its node: (shutdown-ros-node).",
            )
        self.statuses = topics.advertise(f"{name}/status", goals.STATUS_ARRAY)
        self.feedbacks = topics.advertise(f"{name}/feedback", self.action.action_feedback)
        self.results = topics.advertise(f"{name}/result", self.action.action_result)
        topics.subscribe(f"{name}/goal", self.action.action_goal, self._goal)
        topics.subscribe(f"{name}/cancel", goals.GOAL_ID, self._cancel)
        self.timer = here.graph.kernel.call_every(goals.setting("*STATUS-PUBLISH-INTERVAL*", PERIOD), self.report)
        here.on_shutdown.append(self._stop)
        self.report()

    def __repr__(self):
        return f"#<ACTION-SERVER {self.name} {self.action.name}>"

    def _stop(self):
        self.timer.cancel()
        self.waiting.changed()

    # ------------------------------------------------------------------------------------------------- what it hears of

    def _goal(self, message):
        goal_id = message.goal_id
        if not goal_id.id:  # somebody typed it, without an id
            goal_id = goals.new_goal_id(self.node.name, goal_id.stamp or ros_time())
        if any(goal.id.id == goal_id.id for goal in self.goals):
            return  # it was sent twice
        goal = ServerGoal(goal_id, message.goal)
        self.goals.append(goal)
        if self._cancelled_before(goal_id):
            self._end(goal, RECALLED, None, CANCELLED_EARLY)
            return
        if self.next is not None:
            self._end(self.next, RECALLED, None, "A newer goal took its place.")
        self.next = goal
        if self.current is not None:
            self._ask_to_end(self.current)
        self.report()
        self.waiting.changed()

    def _cancelled_before(self, goal_id):
        """Whether the request to cancel the goal overtook it, which is on another topic."""
        early = self.cancelled_ids.pop(goal_id.id, None) is not None
        return early or bool(goal_id.stamp) and goal_id.stamp <= self.cancelled_until

    def _cancel(self, message):
        everything = not message.id and not message.stamp
        if message.id and not any(goal.id.id == message.id for goal in self.goals):
            self.cancelled_ids[message.id] = kernel.now()
        self.cancelled_until = max(self.cancelled_until, message.stamp)
        for goal in list(self.goals):
            if everything or goal.id.id == message.id or message.stamp and goal.id.stamp <= message.stamp:
                if goal is self.next:
                    self.next = None
                    self._end(goal, RECALLED, None, CANCELLED_EARLY)
                elif goal is self.current:
                    self._ask_to_end(goal)

    def _ask_to_end(self, goal):
        goal.cancelled = True
        if goal.state == ACTIVE:
            goal.state = PREEMPTING
            self.report()
        self.waiting.changed()

    # ---------------------------------------------------------------------------------------------------------- its work

    def run(self):
        """Work on goals until the node ends."""
        while self.node.alive:
            self.waiting.wait(lambda: self.next is not None or not self.node.alive, f"a goal for action {self.name}")
            if self.next is not None and self.node.alive:
                self.current, self.next = self.next, None
                self._work(self.current)

    def _work(self, goal):
        goal.state = ACTIVE
        self.report()
        try:
            conditions.handler_case([(Error, lambda problem: self._failed(goal, problem))], lambda: self._call(goal))
        finally:
            self.current = None
            if goal.state not in TERMINAL:  # the task ends, or something else left the callback
                with kernel.cleanup():
                    self._end(goal, ABORTED, None, "The server gave up.")

    def _call(self, goal):
        task = kernel.current()
        _at_work[task] = (self, goal)
        try:
            catch(goal, lambda: self.callback(goal.message))
        finally:
            del _at_work[task]
        if goal.state not in TERMINAL:
            conditions.error(
                "Reached the end of exec callback ~a without succeeding, aborting, or preempting",
                self._callback_name(),
                hint="Its last form must be (succeed-current ...), (abort-current ...) or (preempt-current ...).",
            )

    def _callback_name(self):
        return getattr(self.callback, "__lisp_name__", None) or princ_to_string(self.callback)

    def _failed(self, goal, problem):
        text = problem.report()
        logging.log_text(logging.ERROR, LOG_TOPIC, f"Error in the exec callback of {self.name}: {text}")
        self._end(goal, ABORTED, None, text)

    # ------------------------------------------------------------------------------------------------- what it tells

    def _end(self, goal, state, result, text=""):
        """Tell the clients that ``goal`` is over."""
        goal.state, goal.ended, goal.text = state, kernel.now(), text
        if self.node.alive:
            topics.publish(self.results, self.action.action_result(header=_header(), status=_status(goal),
                                                                   result=self.action.result() if result is None else result))  # fmt: skip
        self.report()

    def finish(self, goal, state, result):
        """End ``goal`` in ``state`` with the result message (``None``: all defaults)."""
        if result is not None:
            goals.check_message(result, self.action.result)
        self._end(goal, state, result)

    def tell(self, goal, feedback):
        """Send the feedback message about ``goal`` (``None``: all defaults)."""
        feedback = self.action.feedback() if feedback is None else goals.check_message(feedback, self.action.feedback)
        return topics.publish(self.feedbacks, self.action.action_feedback(header=_header(), status=_status(goal), feedback=feedback))

    def report(self):
        """Tell the states of all goals, and forget those that ended long ago."""
        if not self.node.alive:
            return
        now, memory = kernel.now(), goals.setting("*GC-INTERVAL*", MEMORY)
        self.goals = [goal for goal in self.goals if goal.ended is None or now - goal.ended < memory]
        if self.cancelled_ids:
            self.cancelled_ids = {name: when for name, when in self.cancelled_ids.items() if now - when < memory}
        statuses = [_status(goal) for goal in self.goals]
        topics.publish(self.statuses, message_class(goals.STATUS_ARRAY)(header=_header(), status_list=statuses))


def _header():
    return message_class("std_msgs/Header")(stamp=ros_time())


def _status(goal):
    return message_class("actionlib_msgs/GoalStatus")(goal_id=goal.id, status=goal.state, text=ros_text(goal.text))


# ------------------------------------------------------------------------------------------------------- Lisp functions


_at_work: dict = per_image({})
"""The task that runs an exec callback → its server and goal. Tasks below it, branches of a plan in the callback, find them too."""


def start_action_server(action_name, action_type, exec_callback, *, separate_thread=None):
    """Serve the action ``action_name``: ``exec_callback`` (a function or its name) is called with each goal.

    separate_thread: true: return the server at once, it works in a task of its own; else work here until the node ends.
    """
    server = ActionServer(action_name, action_type, goals.function_of(exec_callback))
    if truth(separate_thread):
        owner = server.node.graph.kernel
        task = owner.spawn(server.run, name=f"Action server {action_name}", parent=owner.main)
        server.node.on_shutdown.append(lambda: task.cancel("the node was shut down"))
        return server
    server.run()
    return None


def _current(what):
    task = kernel.current()
    while task is not None:
        if task in _at_work:
            return _at_work[task]
        task = task.parent
    return conditions.error(
        SimpleError("There is no current goal to ~a.", what),
        hint="This belongs into the exec callback of an action server (def-exec-callback).",
    )


def end_current(state, result=None):
    """End the goal that the exec callback works on, and leave the callback. What `succeed-current` and its kin expand into."""
    server, goal = _current("end")
    if kernel.current() not in _at_work:
        return conditions.error(
            SimpleError("A branch of a plan cannot end the goal that the exec callback around it works on."),
            hint="End it after the par, pursue or top-level: (succeed-current ...) leaves the callback.",
        )
    server.finish(goal, state, result)
    return throw(goal, None)


def succeed_current(result=None):
    """The goal is reached. From Python; Lisp has the macro."""
    return end_current(SUCCEEDED, result)


def abort_current(result=None):
    """The goal cannot be reached."""
    return end_current(ABORTED, result)


def preempt_current(result=None):
    """The goal was given up, because it was cancelled or another one came."""
    return end_current(PREEMPTED, result)


def publish_feedback(feedback=None):
    """Tell the client how far the goal is; the number of subscribers that were reached."""
    server, goal = _current("give feedback on")
    return server.tell(goal, feedback)


def cancel_request_received():
    """Whether somebody wants the goal to be given up that the exec callback works on."""
    return True if _current("ask about")[1].cancelled else None


def current_class(part):
    """The class of the ``"result"`` or the ``"feedback"`` of the goal that is worked on."""
    return getattr(_current("end" if part == "result" else "give feedback on")[0].action, part)
