"""Images: each holds its own global state, and several live side by side in a process.

As in other Lisps, an image is the whole state of a session: all definitions and all that runs, the packages and the meanings of their
symbols, registries, the ROS graph, the active kernel. A module makes its global state here, as a `Cell` (one value) or with `per_image`
(a table), and uses it as if there were only one image. When another image becomes the current one, the values of the old image are put
away and those of the new one are put in place (`_switch`). So access to the state of the current image costs nothing; only the change
of images costs a few milliseconds.

All images share one baton (law 4): a thread acts in an image while it has the turn. It takes the turn when it enters its first
image, and gives it up when it has left. In between, a kernel that waits for the world outside, or has run for `QUANTUM` while other
threads wait, lets them have the turn (`breathe`, `outside`).

A program that makes no image uses the first one, and pays nothing for it.
"""

from __future__ import annotations

import os
import time
from _thread import allocate_lock, get_ident
from collections import deque
from contextlib import contextmanager
from threading import main_thread

from .budget import budget
from .errors import KernelError
from .typing_names import TYPE_CHECKING, Any, Generic, Protocol, Self, TypeVar

if TYPE_CHECKING:
    from collections.abc import Iterator

QUANTUM = 0.05  # s for which a thread keeps its turn while others wait for theirs
PATIENCE = 60.0  # s; longer waits for the turn are made of waits of this length
T = TypeVar("T")


class Part(Protocol):
    """A piece of global state of which each image has its own.

    It may also have ``new(state)``, for an image that begins with the definitions of cramhy only: ``state`` is the state at that time.
    For a part without this function, such an image begins with `copy`.
    """

    def take(self) -> Any:
        """The state in the current image, for `put`."""

    def put(self, state: Any) -> None:
        """Set the state in the current image."""

    def copy(self, state: Any) -> Any:
        """A copy of STATE for another image: changes in one of the two do not reach the other."""


P = TypeVar("P", bound=Part)

_parts: list[Part] = []
_cores: list[Any] = []  # what each part is in a new image


def part(made: P) -> P:
    """Give each image its own state of ``made``, a `Part`, and return it. A new image begins with the present state."""
    _parts.append(made)
    _cores.append(_new(made, made.take()))
    return made


def _new(made: Any, state: Any) -> Any:
    return getattr(made, "new", made.copy)(state)


def keep_core() -> None:
    """Let new images begin with the present state, when cramhy has defined everything and the user nothing yet."""
    _cores[:] = [_new(each, each.take()) for each in _parts]


def copied(value: Any) -> Any:
    """``value`` for another image: a copy if it has a method ``copy``. All images share other objects."""
    copy = getattr(value, "copy", None)
    return value if copy is None else copy()


class Cell(Generic[T]):
    """One global ``value``, of the current image. ``fresh`` says that it is about something that runs, so a new image begins with VALUE."""

    __slots__ = ("value", "_begins")

    def __init__(self, value: T, fresh: bool = False):
        self.value = value
        self._begins = (copied(value),) if fresh else None  # a copy, since what VALUE holds will change
        part(self)

    def copy(self, state: T) -> Any:
        return copied(self._begins[0] if self._begins else state)

    def take(self) -> T:
        return self.value

    def put(self, state: T) -> None:
        self.value = state


class _Table:
    """A dictionary, list, set or deque whose contents are the image's. Containers in a dictionary are its own, too."""

    def __init__(self, table):
        self.table = table
        self.add = table.update if isinstance(table, (dict, set)) else table.extend

    def take(self):
        return self.table.copy()

    def put(self, state):
        self.table.clear()
        self.add(state)

    def copy(self, state):
        return {key: copied(value) for key, value in state.items()} if isinstance(state, dict) else state.copy()


class _Object:
    """An object whose attributes are the image's."""

    def __init__(self, thing):
        self.thing = thing

    def take(self):
        return dict(vars(self.thing))

    def put(self, state):
        vars(self.thing).clear()
        vars(self.thing).update(state)

    def copy(self, state):
        return {name: copied(value) for name, value in state.items()}


def per_image(thing: T) -> T:
    """Give each image its own contents of ``thing``, and return it: a dictionary, list, set or deque, or an object with attributes. It is
    the same object in all images."""
    part(_Table(thing) if isinstance(thing, (dict, list, set, deque)) else _Object(thing))
    return thing


# ---------------------------------------------------------------------------------------------------------------- the turn


waiting: deque = deque()
"""The locks of the threads that wait for their turn, in order. A kernel looks here whenever time passes."""


class _Turn:
    """Which thread may act in images: first come, first served."""

    def __init__(self):
        self._guard = allocate_lock()
        self._taken = False
        waiting.clear()
        self.since = 0.0

    def take(self):
        with self._guard:
            if not self._taken:
                self._taken = True
                self.since = time.monotonic()
                return
            mine = allocate_lock()
            mine.acquire()
            waiting.append(mine)
        try:
            while not mine.acquire(timeout=PATIENCE):
                pass
        except BaseException:
            with self._guard:
                still_waiting = mine in waiting
                if still_waiting:
                    waiting.remove(mine)
            if not still_waiting:
                self.give()
            raise
        self.since = time.monotonic()

    def give(self):
        with self._guard:
            if waiting:
                waiting.popleft().release()
            else:
                self._taken = False


_turn = _Turn()
_entered: dict[int, list[Image]] = {}  # thread -> the images that it has entered, outermost first


class Image:
    """Another set of all global state. It begins like the process's first image, without definitions of the user.

    The calling thread acts in it from `enter` to `leave`, or ``with image.entered():``. An image may be entered again after it was left,
    but only by one thread at a time. Other images may be entered within; after them this one is the current one again. Each thread that
    uses images enters one.
    """

    def __init__(self, as_now: bool = False):
        """as_now: whether it begins with the present definitions of the current image. Tasks that run there do not run here."""
        self._states = [each.copy(each.take()) for each in _parts] if as_now else None  # while it is not the current one; None: as new
        self._thread: int | None = None

    def may_be_entered(self) -> bool:
        """Whether no other thread is in it."""
        return self._thread in (None, get_ident())

    def enter(self) -> None:
        """Make it the current image. If another thread is in it, it is a KernelError."""
        me = get_ident()
        if not self.may_be_entered():
            raise KernelError("Another thread is in this image. An image is entered by one thread at a time; make one for each.")
        stack = _entered.setdefault(me, [])
        if not stack:
            try:
                _turn.take()
            except BaseException:
                del _entered[me]
                raise
        stack.append(self)
        self._thread = me
        _switch(self)

    def leave(self) -> None:
        """Make the image current in which the thread was before."""
        stack = _entered[get_ident()]
        stack.pop()
        if self not in stack:
            self._thread = None
        _switch(stack[-1] if stack else first)
        if not stack:
            del _entered[get_ident()]
            _turn.give()

    @contextmanager
    def entered(self) -> Iterator[Self]:
        """``with image.entered():`` makes it the current image during the block."""
        self.enter()
        try:
            yield self
        finally:
            self.leave()

    def forget(self) -> None:
        """Drop its state: it is as new when it is entered again. For the current image it is a KernelError."""
        if self is _current[0]:
            raise KernelError("The current image cannot be forgotten. Leave it first.")
        self._states = None


first = Image()
"""The image with which a process begins."""
_current = [first]


def current() -> Image:
    """The image to which global state belongs now."""
    return _current[0]


def entered_by_main_thread() -> Image:
    """The image in which Python's main thread acts, or waits for its turn; it may not be the current one."""
    return (_entered.get(main_thread().ident) or [first])[-1]


def _switch(image: Image) -> None:
    leaving = _current[0]
    if image is leaving:
        return
    leaving._states = [each.take() for each in _parts]
    states, image._states = image._states or (), None
    for number, each in enumerate(_parts):  # parts of modules that were imported meanwhile are as new
        each.put(states[number] if number < len(states) else _new(each, _cores[number]))
    _current[0] = image
    budget.renew()


def breathe():
    """Let a waiting thread have its turn if ours has been long enough. A kernel calls this when no operation is half done."""
    if waiting and time.monotonic() - _turn.since > QUANTUM:
        with outside():
            pass


@contextmanager
def outside():
    """Let other threads act in their images during the block, which must not touch the state of an image."""
    image = _current[0]
    if image._thread is None:
        yield  # nobody has entered an image, and there are no turns
        return
    _turn.give()
    try:
        yield
    finally:
        _turn.take()
        _switch(image)


def _after_fork():
    """Forget threads that waited or had the turn: they do not exist in a forked child."""
    _turn.__init__()
    for thread in [thread for thread in _entered if thread != get_ident()]:
        del _entered[thread]
    if _entered:
        _turn.take()


def in_forked_child(call):
    """Call CALL in each process that this one forks from now on, if the system has forks."""
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=call)


in_forked_child(_after_fork)
