"""The line that tells how far a plan has come, while it runs in virtual time for more than a second of the wall's.

    ; 124.2 s, waits for the fluent FN-FL<6, the time 151 s (sleep 50)

In virtual time nothing else tells that something goes on. In the wall's time there is no such line: there the time is what the clock shows.

The line stands below the cursor, which stays where it is. So it does not matter whether the plan has begun a line of its own. Before
anything is written to the terminal, the line is erased; until it is drawn again, the terminal looks as if it had never been there. Only a
terminal that can draw gets it.

The kernel calls us at the end of instants (`Kernel.watch_instants`), so nothing needs a thread of its own, and what a plan does and when is
the same with the line and without it.
"""

from __future__ import annotations

import os
import sys
import time
import unicodedata
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime import kernel
from cramhy_runtime.cpl.tree.tree_report import waits_for
from cramhy_runtime.kernel.terminals import draws

SOON = 1.0
"""Seconds of the wall's clock after which the line comes."""
OFTEN = 0.2
"""Seconds of the wall's clock from one drawing to the next."""
MOST_NAMED = 4
"""Things that it says are waited for."""
_LEAST = (3, 20)
"""Lines and columns; on a smaller terminal there is no room."""

# Move down and up again, so that there is a line below; remember the place; draw there; come back.
_DRAW = "\x1bD\x1bM\x1b7\x1b[1B\r{}\x1b[K\x1b8"
_ERASE = "\x1b[J"  # all behind and below the cursor


class Progress:
    """Draws the line on standard output. clock: a function that gives the seconds of the wall's clock."""

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self._clock = clock
        self._due: float | None = None  # when the line is drawn next
        self._watched: list[Any] = []  # the files whose writing erases it first

    @contextmanager
    def during(self) -> Iterator[None]:
        """While the block runs a plan, the line is shown as needed. A block in a block, as a form in the debugger, begins anew."""
        active, before = kernel.active(), self._due
        if active is None or not _draws():
            yield
            return
        self._due = self._clock() + SOON
        active.watch_instants(self._look)
        try:
            yield
        finally:
            active.unwatch_instants(self._look)
            if before is not None:
                active.watch_instants(self._look)  # `unwatch_instants` forgets it for the outer block, too
            self._due = before
            self._erase()

    def _look(self) -> None:
        now = self._clock()
        if self._due is None or now < self._due:
            return
        active = kernel.active()
        if not active.clock.virtual or not kernel.pace().busy:  # the main task waits for the user
            self._due = now + SOON
            return
        self._due = now + OFTEN
        try:
            self._draw(line(active))
        except Exception:  # a user's object that cannot be printed, a terminal that was closed: the plan shall not suffer from it
            self._due = None

    def _draw(self, text):
        import shutil  # takes 3 ms, and most forms are done before there is a line

        size = shutil.get_terminal_size()
        if (size.lines, size.columns) < _LEAST or size.columns < _LEAST[1]:
            return
        file = sys.stdout
        self._erase()
        file.write(_DRAW.format(fitting(text, size.columns - 1)))
        file.flush()
        for each in {id(each): each for each in (file, sys.stderr) if draws(each)}.values():
            self._watch(each)

    def _watch(self, file):
        """Let the next text that is written to ``file`` erase the line first."""
        write = file.write

        def erase_and_write(text):
            self._erase()
            return write(text)

        file.write = erase_and_write
        self._watched.append(file)

    def _erase(self):
        if self._watched:
            for file in self._watched:
                del file.write  # its own one comes back
            self._watched.clear()
            try:
                sys.stdout.write(_ERASE)
                sys.stdout.flush()
            except (OSError, ValueError):
                pass  # the terminal was closed


def _draws():
    """Whether standard output understands `_DRAW`. The consoles of Windows before its Terminal do not."""
    return draws(sys.stdout) and (os.name != "nt" or "WT_SESSION" in os.environ)


def line(active: Any) -> str:
    """The time that the kernel ``active`` has reached, and what the tasks of its plans wait for, those with branches left out."""
    owners = [task.owner for task in active.tasks]
    leaves = [owner.kernel_task for owner in owners if owner is not None and not any(child.alive for child in owner.children)]
    waited = list(dict.fromkeys(waits_for(task) for task in leaves or [active.main] if not task.ready))
    named = ", ".join(waited[:MOST_NAMED]) + (f" and {len(waited) - MOST_NAMED} more" if len(waited) > MOST_NAMED else "")
    return f"; {active.now():.1f} s, " + (f"waits for {named}" if named else "computes")


def fitting(text: str, columns: int) -> str:
    """As much of ``text`` as fits into so many columns, without signs that do something else than to be shown."""
    fits, width = "", 0
    for sign in " ".join(text.split()):
        sign = sign if sign.isprintable() else "?"
        width += 2 if unicodedata.east_asian_width(sign) in "WF" else 0 if unicodedata.combining(sign) else 1
        if width > columns:
            break
        fits += sign
    return fits


__all__ = ["Progress", "fitting", "line"]
