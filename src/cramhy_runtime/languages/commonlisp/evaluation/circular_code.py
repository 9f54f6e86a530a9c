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


def refuse_circular_code(form, place=lambda part: None):
    """Signal a compile-error when ``form`` contains itself outside of a quoted constant.

    place: the position of a list in the user's text, or ``None``.
    """
    if form.__class__ is not Cons or _is_tree(form):
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


def _is_tree(form):
    """Whether no cons of ``form`` is in two places outside of a quoted constant. Most code is so, and this is found fast."""
    seen, rest = set(), [form]
    while rest:
        cell = rest.pop()
        while cell.__class__ is Cons:
            if id(cell) in seen:
                return False
            seen.add(id(cell))
            part = cell.car
            if part is QUOTE:
                break
            if part.__class__ is Cons:
                rest.append(part)
            cell = cell.cdr
    return True
