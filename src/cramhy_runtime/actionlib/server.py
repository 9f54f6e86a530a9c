"""A server of an action that gives its goals to a function, one after the other.

The *exec callback* gets the goal and ends by saying how it went: `succeed_current`, `abort_current` or `preempt_current`, which
leave it at once. One that falls off its end, or has an error, aborts its goal, and the error is logged; the original's client
would wait on. While a goal is worked on, a newer one waits for its turn and lets `cancel_request_received` be true.
What clients are told is in `goal_server`. Source: roslisp.md 13.2.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from .. import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.catching import catch, throw
from cramhy_runtime.lisp_core.condition_types import Error, SimpleError
from cramhy_runtime.lisp_core.data import truth
from cramhy_runtime.lisp_core.printing import princ_to_string
from ..ros.roslisp import logging, node, topics
from . import goals
from .goal_server import GoalServer
from .goals import ABORTED, TERMINAL

LOG_TOPIC = ("ACTIONLIB",)


class ActionServer(GoalServer):
    """Serves the action ``name``: ``callback(goal)`` works on one goal after the other, in the task that calls `run`."""

    def __init__(self, name, action_type, callback):
        self.callback, self.waiting = callback, kernel.Waiting()
        name, here = goals.check_name(name), node.require_node()
        if here.resolve(f"{name}/status") in here.publications:
            conditions.error(
                SimpleError("The action ~a has a server already, on this node.", name),
                hint="Two servers would both do what a client wants once. A server ends with its node: (shutdown-ros-node).",
            )
        super().__init__(here, name, action_type)

    def __repr__(self):
        return f"#<ACTION-SERVER {self.name} {self.action.name}>"

    def advertise(self, topic, message_type):
        return topics.advertise(topic, message_type)

    def subscribe(self, topic, message_type, callback):
        topics.subscribe(topic, message_type, callback)

    def begin_wanted(self):
        self.waiting.changed()

    def end_wanted(self, goal):
        self.waiting.changed()

    def stopped(self):
        super().stopped()
        self.waiting.changed()

    # ---------------------------------------------------------------------------------------------------------- its work

    def run(self):
        """Work on goals until the node ends."""
        while self.node.alive:
            self.waiting.wait(lambda: self.next is not None or not self.node.alive, f"a goal for action {self.name}")
            if self.next is not None and self.node.alive:
                self._work(self.accept())

    def _work(self, goal):
        try:
            conditions.handler_case([(Error, lambda problem: self._failed(goal, problem))], lambda: self._call(goal))
        finally:
            self.current = None
            if goal.state not in TERMINAL:  # the task ends, or something else left the callback
                with kernel.cleanup():
                    self.end(goal, ABORTED, None, "The server gave up.")

    def _call(self, goal):
        task = kernel.current()
        _at_work[task] = (self, goal)
        try:
            catch(goal, lambda: self.callback(goal.message))
        finally:
            del _at_work[task]
        if goal.state not in TERMINAL:
            fell_off_the_end(self._callback_name())

    def _callback_name(self):
        return getattr(self.callback, "__lisp_name__", None) or princ_to_string(self.callback)

    def _failed(self, goal, problem):
        text = problem.report()
        logging.log_text(logging.ERROR, LOG_TOPIC, f"Error in the exec callback of {self.name}: {text}")
        self.end(goal, ABORTED, None, text)


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


def fell_off_the_end(name):
    """Signal the error that the exec callback ``name``, a string, reached its end without ending its goal."""
    conditions.error(
        "Reached the end of exec callback ~a without succeeding, aborting, or preempting",
        name,
        hint="Its last form must be (succeed-current ...), (abort-current ...) or (preempt-current ...).",
    )


def _current():
    task = kernel.current()
    while task is not None:
        if task in _at_work:
            return _at_work[task]
        task = task.parent
    return conditions.error(
        SimpleError("This operation can only be called while in a callback thread"),
        hint="This belongs into the exec callback of an action server (def-exec-callback).",
    )


def end_current(state, result=None):
    """End the goal that the exec callback works on, and leave the callback. What `succeed-current` and its kin expand into."""
    server, goal = _current()
    if kernel.current() not in _at_work:
        return conditions.error(
            SimpleError("A branch of a plan cannot end the goal that the exec callback around it works on."),
            hint="End it after the par, pursue or top-level: (succeed-current ...) leaves the callback.",
        )
    server.finish(goal, state, result)
    return throw(goal, None)


def publish_feedback(feedback=None):
    """Tell the client how far the goal is; the number of subscribers that were reached."""
    server, goal = _current()
    return server.tell(goal, feedback)


def cancel_request_received():
    """Whether somebody wants the goal to be given up that the exec callback works on."""
    return True if _current()[1].cancelled else None


def current_class(part):
    """The class of the ``"result"`` or the ``"feedback"`` of the goal that is worked on."""
    return getattr(_current()[0].action, part)
