"""What both sides of an action know: its five topics and their types, the states of a goal, and who waits for a change.

The numbers of the states are the constants of ``actionlib_msgs/GoalStatus``. Source: roslisp.md 13, wiki.ros.org/actionlib.
"""

from __future__ import annotations

import itertools

from .. import kernel
from ..lisp import conditions
from ..lisp.condition_types import SimpleError
from ..lisp.data import LispString
from ..lisp.printer.printer import princ_to_string
from ..ros.messages import message_class, topic_class

(PENDING, ACTIVE, PREEMPTED, SUCCEEDED, ABORTED, REJECTED, PREEMPTING, RECALLING, RECALLED, LOST) = range(10)
NAMES = ("PENDING", "ACTIVE", "PREEMPTED", "SUCCEEDED", "ABORTED", "REJECTED", "PREEMPTING", "RECALLING", "RECALLED", "LOST")
KNOWN = range(len(NAMES))
"""What a server may say; the field of a message has room for more, and a goal of which it says that counts as not listed."""
TERMINAL = frozenset((PREEMPTED, SUCCEEDED, ABORTED, REJECTED, RECALLED, LOST))
"""The states that a goal never leaves."""


class Action:
    """An action by the name of its type, ``"turtle_actionlib/ShapeAction"``: the classes of all its messages."""

    def __init__(self, action_type):
        if not isinstance(action_type, (str, LispString)):
            conditions.type_error(action_type, "STRING")
        name = str(action_type)
        if not name.endswith("Action"):
            problem = SimpleError("The action type is invalid. Actions always have the suffix 'Action'")
            problem.hint = f'It was "{name}"; write for instance "turtle_actionlib/ShapeAction".'
            conditions.error(problem)
        topic_class(name)  # its errors tell whether the package or the type is missing
        base = name.removesuffix("Action")
        self.name = name
        self.goal, self.result, self.feedback = (message_class(base + part) for part in ("Goal", "Result", "Feedback"))
        self.action_goal, self.action_result, self.action_feedback = (
            message_class(name + part) for part in ("Goal", "Result", "Feedback")
        )


GOAL_ID = "actionlib_msgs/GoalID"
STATUS_ARRAY = "actionlib_msgs/GoalStatusArray"
_counter = itertools.count(1)


def new_goal_id(node_name, stamp):
    """The GoalID message for a goal that the node sends at the time ``stamp``."""
    return message_class(GOAL_ID)(stamp=stamp, id=f"{node_name}-{next(_counter)}-{princ_to_string(stamp)}")


def check_message(message, cls):
    """``message`` when it is one of class ``cls``, else a type-error."""
    if isinstance(message, cls):
        return message
    return conditions.type_error(message, cls.lisp_name.replace("::", ":"))


class Waiting:
    """Tasks that wait for a change of something. `wait` parks until a condition holds; `changed` has them look again."""

    def __init__(self):
        self._tasks = []

    def changed(self):
        for task in self._tasks:
            kernel.unpark(task)

    def wait(self, condition, why, until=None):
        """Park the current task until ``condition()`` is true: True; or until the kernel's time ``until``: False."""
        task = kernel.current()
        self._tasks.append(task)
        try:
            while not condition():
                if not kernel.park(why, until) and not condition():
                    return False
            return True
        finally:
            self._tasks.remove(task)


def time_limit(seconds):
    """The kernel's time when ``seconds`` are over; ``None`` for 0 or NIL, which mean that there is no limit."""
    seconds = 0 if seconds is None else float(seconds)
    return kernel.now() + seconds if seconds > 0 else None
