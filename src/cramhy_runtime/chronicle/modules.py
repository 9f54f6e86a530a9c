"""What process modules do: their state, the designator that is being executed, and those that wait in the queue."""

from __future__ import annotations

from cramhy_runtime.cpl.tree.tree_report import short
from ..process_modules.registry import running
from ..ros.messages import message_class_exact
from ..ros.wire import ros_text
from .goals import goals


class Modules:
    """Watches the running modules. `take` gives all of them as a ``cramhy_msgs/ProcessModules`` when something has changed, or ``None``."""

    def __init__(self, now):
        self.now = now
        self.module_type = message_class_exact("cramhy_msgs/ProcessModule")
        self.type = message_class_exact("cramhy_msgs/ProcessModules")
        self.seen = ()
        self.texts = {}  # id of a designator -> (the designator, its text), of those that are shown now

    def begin(self):
        """There is nothing to prepare: the modules are found in their registry."""

    def end(self):
        self.seen, self.texts = (), {}

    def take(self):
        """All modules, if one of them, or which they are, has changed since the last call."""
        modules = running().modules
        if not modules and not self.seen:
            return None
        now = [(name, *_state(module)) for name, module in modules.items()]
        places = [goals(shown[0]) for _, _, *shown in now]  # they may come to be known while it executes
        key = [(name, state, where, *map(id, shown)) for (name, state, *shown), where in zip(now, places)]
        if key == self.seen:
            return None
        self.seen = key
        before, self.texts = self.texts, {}
        told = []
        for (name, state, *shown), where in zip(now, places):
            for designator in shown:
                self.texts[id(designator)] = before.get(id(designator)) or (designator, ros_text(short(designator)))
            executes, *queue = ["" if designator is None else self.texts[id(designator)][1] for designator in shown]
            told.append(self.module_type(ros_text(str(getattr(name, "name", name))), state, executes, queue, sum(where, ())))
        return self.type(stamp=self.now(), modules=told)


def _state(module):
    """(state, what it executes, what waits ...) of a module."""
    status = getattr(module, "status_fluent", None)
    if status is None:  # an object of another kind, registered by `with-process-module-registered-running`
        return "RUNNING", None
    request = getattr(module, "request", None)
    queue = list(getattr(module, "queue", ()))
    if hasattr(module, "unfinished"):  # an asynchronous one
        first, *others = [*module.unfinished, *module.pending] or [None]
        return status.stored.name, first, *others
    return status.stored.name, None if request is None else request.input, *[waiting.input for waiting in queue]
