"""What is global belongs to an image, and several images live side by side in a process.

An image is what a Lisp means by the word: all that is defined and all that is under way, the packages and what their symbols
mean, registries, the ROS graph, the active kernel. A module that has something global makes it here, as a `Cell` (one value) or
as `per_image` (a table), and uses it as if there were but one image. When another image becomes the current one, the values go
with the one that leaves and come with the one that enters (`_switch`). So what belongs to the image that runs is always where
everybody finds it, and costs nothing; only the change of images costs, a few milliseconds.

All images share one baton (law 4): a thread acts in an image while it has the turn. It takes the turn when it enters its first
image, and gives it up when it has left; between, a kernel that waits for the world outside, or has run for `QUANTUM` while other
threads wait, lets them have theirs (`breathe`, `outside`).

A program that makes no image has one all the same, the first, and pays nothing for it.
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
    """Something of which each image has its own.

    It may also have ``new(state)``: ``state``, what it was when all that comes with us was defined, for an image that begins with no
    more than that. A part without this function begins as `copy` says.
    """

    def take(self) -> Any:
        """What it is in the current image, to be given to `put` later."""

    def put(self, state: Any) -> None:
        """Let it be this in the current image."""

    def copy(self, state: Any) -> Any:
        """The same for another image: what is changed in one of the two is not changed in the other."""


P = TypeVar("P", bound=Part)

_parts: list[Part] = []
_cores: list[Any] = []  # what each part is in a new image


def part(made: P) -> P:
    """Let each image have its own of ``made``, a `Part`; returns it. What it is now is what a new image begins with."""
    _parts.append(made)
    _cores.append(_new(made, made.take()))
    return made


def _new(made: Any, state: Any) -> Any:
    return getattr(made, "new", made.copy)(state)


def keep_core() -> None:
    """Let new images begin with what the current one is now: all that comes with us is defined, and the user has defined nothing yet."""
    _cores[:] = [_new(each, each.take()) for each in _parts]


def copied(value: Any) -> Any:
    """``value`` for another image: a copy of what can be changed and says so by its ``copy``; other objects all images share."""
    copy = getattr(value, "copy", None)
    return value if copy is None else copy()


class Cell(Generic[T]):
    """One global ``value``, of the current image. ``fresh``: it is about something that runs, and in a new image nothing does."""

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
    """Let each image have its own contents of ``thing``, which stays the same object: a dictionary, list, set or deque, or an object
    with attributes. Returns it."""
    part(_Table(thing) if isinstance(thing, (dict, list, set, deque)) else _Object(thing))
    return thing


# ---------------------------------------------------------------------------------------------------------------- the turn


waiting: deque = deque()
"""The locks of the threads that wait for their turn, in their order. A kernel looks here whenever time passes."""


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
    """All that is global, once more. It begins as the process's first one did, with nothing of the user's.

    The calling thread acts in it from `enter` to `leave`, or ``with image.entered():``. An image may be entered again after it was left,
    but by one thread at a time. Other images may be entered within; then this one is the current one again. Threads that use images
    enter one, each of them.
    """

    def __init__(self, as_now: bool = False):
        """as_now: whether it begins as the current image is now, with what is defined there. What runs there does not run here."""
        self._states = [each.copy(each.take()) for each in _parts] if as_now else None  # while it is not the current one; None: as new
        self._thread: int | None = None

    def may_be_entered(self) -> bool:
        """Whether no other thread is in it."""
        return self._thread in (None, get_ident())

    def enter(self) -> None:
        """Make it the current image."""
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
        """Make that image the current one in which the thread was before."""
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
        """While the block runs, it is the current image."""
        self.enter()
        try:
            yield self
        finally:
            self.leave()

    def forget(self) -> None:
        """Let it be as new when it is entered again; what it held may go."""
        if self is _current[0]:
            raise KernelError("The current image cannot be forgotten. Leave it first.")
        self._states = None


first = Image()
"""The image that a process begins with."""
_current = [first]


def current() -> Image:
    """The image that everything global belongs to now."""
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
    """Let a thread that waits have its turn if ours is long enough. For a kernel, where nothing is half done."""
    if waiting and time.monotonic() - _turn.since > QUANTUM:
        with outside():
            pass


@contextmanager
def outside():
    """While the block runs, other threads may act in their images; it touches nothing that belongs to one."""
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
    """The threads that waited, or had the turn, did not come along into a forked child."""
    _turn.__init__()
    for thread in [thread for thread in _entered if thread != get_ident()]:
        del _entered[thread]
    if _entered:
        _turn.take()


def in_forked_child(call):
    """From now on CALL is called in each process that this one forks, where the system has forks at all."""
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=call)


in_forked_child(_after_fork)
