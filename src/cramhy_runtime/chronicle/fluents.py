"""What fluents are: those that programs and plans make, but not the nets that are computed from them, nor the statuses of tasks.

Nobody keeps a list of fluents, so at first the garbage collector is asked for those that live, and then a hook tells of new ones. A
fluent counts its pulses; so it is looked at only where that number is another than at the last look, at the end of an instant.
"""

from __future__ import annotations

import gc
import math
import re
from weakref import ref

from cramhy_runtime.cpl.fluents.fluents import Fluent, peek_value
from cramhy_runtime.cpl.fluents.nets import Net
from ..cpl.hooks import on_make_fluent_hook
from ..cpl.statuses import ALL
from ..process_modules.modules import own_fluents
from cramhy_runtime.cpl.tree.tree_report import cut
from ..cpl.fluents.fluents import living_fluents
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.printing import princ_to_string
from ..ros.messages import RosMessage, message_class_exact
from ..ros.wire import ros_text
from .texts import value_text

MOST = 1000
"""Fluents that are watched; with more, the oldest are let go."""
_KEY = "CHRONICLE"
_of_a_task = re.compile(r"-STATUS\d+$")


class Watched:
    __slots__ = ("fluent", "id", "pulses")

    def __init__(self, fluent, id_):
        self.fluent, self.id, self.pulses = ref(fluent), id_, None


class Fluents:
    """Watches the fluents. `take` gives those that are new or have pulsed as a ``cramhy_msgs/Fluents``, or ``None``."""

    def __init__(self, now):
        self.now = now
        self.fluent_type, self.type = message_class_exact("cramhy_msgs/Fluent"), message_class_exact("cramhy_msgs/Fluents")
        self.watched = {}
        self.gone = []

    def begin(self):
        gc.collect()  # those that nobody has any more, but in circles of their own
        for fluent in living_fluents():
            self.add(fluent)
        on_make_fluent_hook.add(lambda *arguments: self.add(arguments[0]), _KEY)

    def end(self):
        on_make_fluent_hook.remove(_KEY)
        self.watched.clear()

    def add(self, fluent):
        if not isinstance(fluent, Fluent) or isinstance(fluent, Net):
            return
        self.watched[fluent.number] = Watched(fluent, str(fluent.number))
        if len(self.watched) > MOST:
            self._let_go(next(iter(self.watched)))

    def _let_go(self, number):
        """Watch a fluent no more, and tell that to whoever has been told of it."""
        watched = self.watched.pop(number)
        if watched.pulses is not None:
            self.gone.append(watched.id)

    def take(self):
        """What has changed since the last call."""
        changed = []
        for number, watched in list(self.watched.items()):
            fluent = watched.fluent()
            if fluent is None:
                self._let_go(number)
            elif fluent.pulses != watched.pulses:
                new = watched.pulses is None
                if new and _is_status_of_a_task(fluent):
                    self._let_go(number)
                    continue
                watched.pulses = fluent.pulses
                text, amount = _value(fluent)
                name, internal = fluent.name, True if fluent in own_fluents else None
                name = ros_text(cut(name if name.__class__ is str else princ_to_string(name)))
                changed.append(self.fluent_type(watched.id, name, ros_text(text), amount, internal))
        gone, self.gone = self.gone, []
        return self.type(stamp=self.now(), fluents=changed, removed=gone) if changed or gone else None


def _is_status_of_a_task(fluent):
    return getattr(fluent, "stored", None) in ALL and _of_a_task.search(str(getattr(fluent.name, "name", fluent.name)))


def _value(fluent):
    """(its value printed, the value as a number or not-a-number)."""
    try:
        value = one(peek_value(fluent))
    except (Condition, Exception) as problem:  # of a class of the user's, whose value is computed by the user's code
        return f"(no value: {type(problem).__name__})", math.nan
    if not isinstance(value, RosMessage) and is_real(value):
        try:
            return value_text(value), float(value)
        except OverflowError:
            pass
    return value_text(value), math.nan
