"""What both sides of an action know: its five topics and their types, and the states of a goal.

The numbers of the states are the constants of ``actionlib_msgs/GoalStatus``. Source: roslisp.md 13, wiki.ros.org/actionlib.
"""

from __future__ import annotations

import itertools

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.data import LispString, Symbol, truth
from cramhy_runtime.lisp_core.functions import function_named
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.lisp_core.printing import princ_to_string
from ..ros.messages import message_class, topic_class
from cramhy_runtime.utilities import wait_queue as lines

(PENDING, ACTIVE, PREEMPTED, SUCCEEDED, ABORTED, REJECTED, PREEMPTING, RECALLING, RECALLED, LOST) = range(10)
NAMES = ("PENDING", "ACTIVE", "PREEMPTED", "SUCCEEDED", "ABORTED", "REJECTED", "PREEMPTING", "RECALLING", "RECALLED", "LOST")
KNOWN = range(len(NAMES))
"""What a server may say; the field of a message has room for more, and a goal of which it says that counts as not listed."""
TERMINAL = frozenset((PREEMPTED, SUCCEEDED, ABORTED, REJECTED, RECALLED, LOST))
"""The states that a goal never leaves."""


class Action:
    """An action by the name of its type, ``"turtle_actionlib/ShapeAction"``: the classes of all its messages."""

    def __init__(self, action_type):
        name = check_name(action_type)
        if not name.endswith("Action"):
            conditions.error(
                SimpleError("The action type is invalid. Actions always have the suffix 'Action'"),
                hint=f'It was "{name}"; write for instance "turtle_actionlib/ShapeAction".',
            )
        topic_class(name)  # its errors tell whether the package or the type is missing
        base = name.removesuffix("Action")
        self.name = name
        self.goal, self.result, self.feedback = (message_class(base + part) for part in ("Goal", "Result", "Feedback"))
        self.action_goal, self.action_result, self.action_feedback = (message_class(name + part) for part in ("Goal", "Result", "Feedback"))


GOAL_ID = "actionlib_msgs/GoalID"
STATUS_ARRAY = "actionlib_msgs/GoalStatusArray"
_counter = itertools.count(1)


def new_goal_id(node_name, stamp):
    """The GoalID message for a goal that the node sends at the time ``stamp``."""
    return message_class(GOAL_ID)(stamp=stamp, id=f"{node_name}-{next(_counter)}-{princ_to_string(stamp)}")


def check_name(name):
    """``name``, of an action or of a type, as a Python string; what is no string is a type-error."""
    return str(name) if isinstance(name, (str, LispString)) else conditions.type_error(name, "STRING")


def function_of(designator):
    """The function that ``designator``, itself one or the name of one, stands for; anything else is a type-error."""
    function = function_named(designator) if isinstance(designator, Symbol) else designator
    return function if callable(function) else conditions.type_error(function, "FUNCTION")


def function_or_none(designator):
    """The function that ``designator`` stands for; ``None`` for nil."""
    return function_of(designator) if truth(designator) else None


def check_message(message, cls):
    """``message`` when it is one of class ``cls``, else a type-error."""
    if isinstance(message, cls):
        return message
    return conditions.type_error(message, cls.lisp_name.replace("::", ":"))


def setting(name: str, default: float) -> float:
    """The value of the variable ``name`` of the package ACTIONLIB, in seconds; ``default`` where that package was not made."""
    package = find_package("ACTIONLIB")
    symbol = package.lookup(name)[0] if package is not None else None
    value = getattr(symbol, "value", default)
    return float(value) if is_real(value) else conditions.type_error(value, "REAL")


def time_limit(seconds):
    """The kernel's time when ``seconds`` are over; ``None`` for 0 or NIL, which mean that there is no limit."""
    return lines.time_limit(None if seconds == 0 else seconds)
