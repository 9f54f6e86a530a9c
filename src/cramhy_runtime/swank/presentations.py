"""Presentations: objects that Emacs shows as text and can name again, so that a result in the REPL buffer can be part of a later form.

Emacs writes such an object as a form that looks it up by its number. The numbers belong to a connection.
"""

from __future__ import annotations

from .rpcs import Refused

MOST = 10_000
"""So many objects are kept; the oldest go first."""


class Presentations:
    """Numbered objects."""

    def __init__(self):
        self.objects = {}
        self.last = 0

    def add(self, obj):
        """The number of ``obj``."""
        self.last += 1
        self.objects[self.last] = obj
        if len(self.objects) > MOST:
            del self.objects[next(iter(self.objects))]
        return self.last

    def find(self, number):
        """The object of that number. `Refused` if there is none any more."""
        try:
            return self.objects[number]
        except (KeyError, TypeError):
            raise Refused(f"The object with the number {number} is not kept any more.") from None


def of(connection):
    """The `Presentations` of a connection."""
    if connection.presentations is None:
        connection.presentations = Presentations()
    return connection.presentations
