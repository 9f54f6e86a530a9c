"""Looks at a session at the end of its instants, and tells what is new to the recorders and to the board for whoever looks on.

For recordings it looks at every instant, so that in virtual time a recording is a function of the run. For pages it looks as often as they
may be told. Nothing of it is there before somebody asks; see `chronicle.start` and `chronicle.record`.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import Cell
from .. import kernel
from cramhy_runtime.lisp_core.condition_types import SimpleWarning
from cramhy_runtime.lisp_core.conditions import Condition, warn
from cramhy_runtime.kernel.looking_on import looking_on
from ..ros import graph
from ..ros.messages import message_class_exact
from .service_node import Board
from .fluents import Fluents
from .modules import Modules
from .plans import Plans
from .merge import State
from .robots import Robots
from .world import World

NAMES = {
    "world": "the turtles",
    "tasks": "the tasks of plans",
    "fluents": "fluents",
    "modules": "process modules",
    "robots": "the robot's world",
}

_active = Cell(None, fresh=True)


class Chronicler:
    """The watch on one kernel. ``listeners`` are functions of (kind, message), told of everything; ``board`` is for those who look on."""

    def __init__(self):
        self.kernel, self.graph = kernel.active(), graph.active()
        now = self.kernel.now
        self.sources = {"world": World(now), "tasks": Plans(), "fluents": Fluents(now), "modules": Modules(now), "robots": Robots(now)}
        self.state = State()
        self.listeners = []
        self.board = None
        self.pace_type = message_class_exact("cramhy_msgs/Pace")
        self._looking = False
        self.sources["world"].begin()
        self.sources["tasks"].begin(self.look)
        self.sources["fluents"].begin()
        self.sources["modules"].begin()
        self.sources["robots"].begin()
        self.kernel.watch_instants(self._instant)

    def open_board(self):
        """Be there for those who look on. They are told of plans that ended before, too, as far as the session remembers them."""
        if self.board is None:
            if "tasks" in self.sources and not self.state.sums["tasks"]:
                finished = self.sources["tasks"].finished()
                if finished is not None:
                    self.state.add("tasks", finished)
            self.board = Board(self)
            for kind, message in self.state.messages().items():
                self.board.add(kind, message)
            if self.kernel.clock.virtual:
                kernel.pace().on_change.append(self.board.tell_pace)
        return self.board

    def close_board(self):
        if self.board is not None:
            pace = self.kernel.clock.pace if self.kernel.clock.virtual else None
            if pace is not None and self.board.tell_pace in pace.on_change:
                pace.on_change.remove(self.board.tell_pace)
            self.board.close()
            self.board = None

    def close(self):
        """Look no more."""
        self.close_board()
        self.kernel.unwatch_instants(self._instant)
        for source in self.sources.values():
            source.end()

    def _instant(self):
        if self.listeners or self.board is not None and self.board.due:
            self.look()

    def look(self):
        """Take what is new from everything that is watched."""
        if self._looking:  # what is looked at is printed, and that may call functions of the user's which let others run
            return
        self._looking = True
        if "tasks" in self.sources:
            self.sources["tasks"].every = bool(self.listeners)
        try:
            news = []
            with looking_on():
                for kind, source in list(self.sources.items()):
                    try:
                        message = source.take()
                    except (Condition, Exception) as problem:
                        self._give_up(kind, problem)
                        continue
                    if message is not None:
                        news.append((kind, message))
            for kind, message in news:
                self.state.add(kind, message)
                for listener in self.listeners:
                    listener(kind, message)
                if self.board is not None:
                    self.board.add(kind, message)
        finally:
            self._looking = False
        if self.board is not None:
            self.board.publish()

    def _give_up(self, kind, problem):
        """Tell of one kind no more. Whatever goes wrong there, the plan and what is told of others do not suffer from it."""
        source = self.sources.pop(kind)
        warn(SimpleWarning("~a", f"Changes of {NAMES[kind]} can be told no more: {type(problem).__name__}: {problem}"))
        source.end()

    # ------------------------------------------------------------------------------------------------------- plan time

    def pace_message(self):
        """How plan time passes, a ``cramhy_msgs/Pace``."""
        pace = kernel.pace()
        return self.pace_type(
            stamp=self.kernel.now(),
            virtual=True if pace.virtual else None,
            paused=True if pace.paused else None,
            speed=pace.speed or 0.0,
            busy=True if pace.busy else None,
        )

    def set_pace(self, paused, speed):
        """Let plan time pass with ``speed`` (``None``: as fast as the machine computes), or stand still."""
        pace = kernel.pace()
        if speed != pace.speed or not pace.virtual:
            pace.set_speed(speed)
        if paused != pace.paused:
            pace.pause() if paused else pace.resume()

    def step(self, seconds):
        kernel.pace().step(seconds)

    def move_thing(self, name, x, y, z):
        """Put an object of the robot's world somewhere by hand; where it lies then. Errors: ValueError."""
        if "robots" not in self.sources:
            raise ValueError("Changes of the robot's world can be told no more, so nothing is moved by hand.")
        return self.sources["robots"].move(name, x, y, z)

    def seek(self, stamp):
        raise ValueError(
            "Time goes one way in a session with plans. /cramhy/get_history tells what was before; a recording "
            "(--record, cramhy replay) can be sought through."
        )


def active():
    """The `Chronicler` of the active kernel, made when there is none."""
    if there() is None:
        if _active.value is not None:  # of a session that is over
            _active.value.look()
            _active.value.close()
        _active.value = Chronicler()
    return _active.value


def there():
    """The `Chronicler` of the active kernel, or ``None``."""
    return _active.value if _active.value is not None and _active.value.kernel is kernel.active() else None


def dismiss():
    """Close the chronicler if nobody needs it any more."""
    if _active.value is not None and _active.value.board is None and not _active.value.listeners:
        _active.value.close()
        _active.value = None
