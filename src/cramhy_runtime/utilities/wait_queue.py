"""A line of tasks that wait for the same thing, and are served in order: what locks, semaphores, mailboxes and barriers are made of.

Nothing here is an operating system's lock: one task runs at a time, so looking and getting in line are one step, and time is the
kernel's. Three laws make the tools above simple. Who stands in front is served first, and what it waited for is given to it at that
moment, so that nobody who comes later can take it away. A task that is evaporated or killed in line leaves it; what it had been
given already goes back. A line that can never move is a deadlock, and the report says what each task stands in line for.

trio's ``ParkingLot`` is the model; handing the thing over instead of only waking is what keeps the order.
"""

from __future__ import annotations

from collections import deque

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import type_error


class Place:
    """One task's place in a line: what it ``wants``, and what it got once it is ``served``."""

    __slots__ = ("task", "wants", "served", "got")

    def __init__(self, task, wants):
        self.task, self.wants, self.served, self.got = task, wants, False, None


class Line:
    """The tasks that wait, the first in front. ``give_back(place)`` is called for one that was served and died before it knew."""

    __slots__ = ("places", "give_back")

    def __init__(self, give_back=None):
        self.places = deque()
        self.give_back = give_back

    def __len__(self):
        return len(self.places)

    @property
    def first(self):
        return self.places[0]

    def stand(self, why, until=None, wants=None):
        """Wait in line: the `Place` when served, ``None`` when the clock has reached ``until`` before."""
        place = Place(kernel.current(), wants)
        self.places.append(place)
        try:
            while not place.served:
                if until is not None and kernel.now() >= until:
                    return None
                kernel.park(why, until)
            return place
        except BaseException:
            if place.served and self.give_back is not None:
                self.give_back(place)
            raise
        finally:
            if not place.served:
                self.places.remove(place)

    def serve(self, got=None):
        """Give the first in line what it waits for."""
        place = self.places.popleft()
        place.served, place.got = True, got
        kernel.unpark(place.task)
        return place

    def serve_all(self, got=None):
        while self.places:
            self.serve(got)


def time_limit(timeout):
    """The moment at which a wait of ``timeout`` seconds is over; ``None`` for one that has no limit."""
    if timeout is None:
        return None
    try:
        return kernel.now() + max(float(timeout), 0.0)
    except (TypeError, ValueError):
        return type_error(timeout, "(OR NULL REAL)")


def need(thing, kind, name):
    """``thing`` if it is of the Python class ``kind``, else a type-error that names the Lisp type ``name``."""
    return thing if isinstance(thing, kind) else type_error(thing, name)
