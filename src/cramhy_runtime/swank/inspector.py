"""The inspector of SLIME: a way through objects, back and forth. What an object consists of says `session.inspection`."""

from __future__ import annotations

import re

from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.printing import attempt_to_print
from cramhy_runtime.languages.commonlisp.printer.print_controls import PRINT_LENGTH, PRINT_LEVEL, PRINT_PRETTY
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.session import inspection

from .rpcs import Refused
from .wire import Name

CHUNK = 500  # pieces of a description that are sent at once
LONGEST = 200  # characters of a part


def text_of(obj, pretty=False):
    """How an object is printed, shortened unless ``pretty``."""
    if pretty:
        with binding(PRINT_PRETTY, True):
            return attempt_to_print(prin1_to_string, obj)
    with binding(PRINT_LENGTH, 20, PRINT_LEVEL, 5):
        found = attempt_to_print(prin1_to_string, obj)
    return found if len(found) <= LONGEST else found[: LONGEST - 3] + "..."


def line_of(obj):
    """How an object is printed, shortened, on one line."""
    found = text_of(obj)
    return found if isinstance(obj, str) else re.sub(r"\s*\n\s*", " ", found)


class Inspector:
    """The objects that were looked at, in order, and the one that is shown."""

    def __init__(self, obj):
        self.path, self.at = [obj], 0
        self.parts, self.actions, self.pieces = [], [], []

    @property
    def object(self):
        """The object that is shown."""
        return self.path[self.at]

    def shown(self):
        """The object as Emacs shows it: ``(:title text :id n :content chunk)``."""
        obj = self.object
        found = inspection.inspected(obj)
        self.parts, self.actions, self.pieces = [obj], [], [f"{found.title}\n"]
        width = min(30, max((len(part.label) for part in found.parts), default=0))
        for part in found.parts:
            self.pieces.append(f"{part.label}:{' ' * (width - len(part.label))} ")
            if part.bound:
                self.parts.append(part.value)
                self.pieces.append([Name(":value"), line_of(part.value), len(self.parts) - 1])
            else:
                self.pieces.append("unbound")
            self.pieces.append("\n")
        for action in found.actions:
            self.actions.append(action)
            self.pieces += ["\n", [Name(":action"), f"[{action.label}]", len(self.actions) - 1]]
        return [Name(":title"), text_of(obj), Name(":id"), 0, Name(":content"), self.chunk(0, CHUNK)]

    def chunk(self, start, end):
        """The pieces from ``start`` to before ``end``, with how many there are."""
        if not (isinstance(start, int) and isinstance(end, int)) or start < 0:
            raise Refused("A range is two whole numbers.")
        pieces = self.pieces[start:end]
        return [pieces, len(self.pieces), start, start + len(pieces)]

    def part(self, index):
        """The part number ``index`` of what is shown; 0 is the object itself."""
        if not isinstance(index, int) or not 0 <= index < len(self.parts):
            raise Refused(f"What is inspected has no part {index}.")
        return self.parts[index]

    def go_to(self, obj):
        """Show ``obj``."""
        del self.path[self.at + 1 :]
        self.path.append(obj)
        self.at += 1
        return self.shown()

    def act(self, index):
        """Do the action number ``index``; show its result, or the object anew."""
        if not isinstance(index, int) or not 0 <= index < len(self.actions):
            raise Refused(f"What is inspected has no action {index}.")
        result = self.actions[index].run()
        return self.go_to(result[0]) if isinstance(result, list) and result else self.shown()

    def back(self):
        """Show the object before; ``None`` at the first."""
        if self.at == 0:
            return None
        self.at -= 1
        return self.shown()

    def forth(self):
        """Show the object after; ``None`` at the last."""
        if self.at + 1 >= len(self.path):
            return None
        self.at += 1
        return self.shown()

    def history(self):
        """The way so far, as text."""
        lines = [f"{'*' if index == self.at else ' '} {index} {text_of(obj)}" for index, obj in enumerate(self.path)]
        return "\n".join(["The way through the objects:", *lines])
