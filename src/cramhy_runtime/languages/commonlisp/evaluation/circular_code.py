"""Code that contains itself: ``#1=(progn #1#)`` is a text that can be read and a program that no compiler can finish.

A quoted list may be circular; that is data. Elsewhere a circle is an error before anything looks at the form, because macros,
special forms and the compiler all walk lists to their ends.
"""

from __future__ import annotations

from cramhy_runtime.ground.conditions import CompileError, error
from cramhy_runtime.ground.data import Cons
from cramhy_runtime.ground.packages import sym

QUOTE = sym("QUOTE")
_OPEN, _DONE = 1, 2
_MANY = 10_000  # conses: more than most forms have, fewer than one would wait for


def refuse_circular_code(form, place=lambda part: None):
    """Signal a compile-error when ``form`` contains itself outside of a quoted constant.

    place: the position of a list in the user's text, or ``None``.
    """
    if form.__class__ is not Cons or _ends(form):
        return
    state, path = {}, [form]  # the state of a cons: its parts are being looked at, or have been
    while path:
        cell = path[-1]
        before = state.get(id(cell))
        if before is not None:
            path.pop()
            state[id(cell)] = _DONE
            continue
        state[id(cell)] = _OPEN
        if cell.car is QUOTE:
            continue
        for part in (cell.cdr, cell.car):
            if part.__class__ is Cons:
                seen = state.get(id(part))
                if seen is _OPEN:
                    error(
                        CompileError("The form contains itself. Only a quoted list may be circular.", position=place(part) or place(form))
                    )
                if seen is None:
                    path.append(part)


def _ends(form):
    """Whether a walk through ``form``, without its quoted constants, ends after a few thousand conses. Then it has no circle, and needs
    no notes of where the walk has been, which cost more than the walk: once code is kept, Python tells a hook of each ``id()``."""
    rest, steps = [form], _MANY
    while rest:
        cell = rest.pop()
        while cell.__class__ is Cons:
            steps -= 1
            if not steps:
                return False
            part = cell.car
            if part is QUOTE:
                break
            if part.__class__ is Cons:
                rest.append(part)
            cell = cell.cdr
    return True
