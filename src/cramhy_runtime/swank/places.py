"""Places in texts as Emacs knows them: a buffer or a file, and how many characters stand before."""

from __future__ import annotations

import os

from cramhy_runtime.session import lookup

from .wire import Name


def location(place):
    """The location of a `lookup.Place`."""
    if place.file.startswith("<"):
        source = "".join(lookup.text_lines(place.file))
        return [Name(":location"), [Name(":source-form"), source], [Name(":position"), (place.offset or 0) + 1], None]
    path = os.path.abspath(place.file)
    where = [Name(":line"), place.line, max(0, place.column - 1)] if place.offset is None else [Name(":position"), place.offset + 1]
    hints = [Name(":snippet"), place.snippet] if place.snippet else None
    return [Name(":location"), [Name(":file"), path], where, hints]


def location_of(position):
    """The location of (file, line, column), exactly; an ``:error`` where there is none."""
    if not position:
        return error("The place of this is not known.")
    filename, line, *rest = position
    found = lookup.place("", filename, line or 1, (rest[0] if rest else None) or 1)
    return location(found._replace(snippet=""))


def error(text):
    """What stands in the place of a location that is not known."""
    return [Name(":error"), text]
