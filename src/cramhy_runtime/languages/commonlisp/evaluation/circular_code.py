"""Code that contains itself: ``#1=(progn #1#)`` is a text that can be read and a program that no compiler can finish.

A quoted list may be circular; that is data. So may be what stands in a call of a user's macro, which makes of it what it likes: there
each expansion is looked at. Elsewhere a circle is an error before anything looks at the form, because macros of Common Lisp, special
forms and the compiler all walk lists to their ends.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import CompileError, error
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.packages import sym

QUOTE, MACROLET = sym("QUOTE"), sym("MACROLET")
_OPEN, _DONE = 1, 2
_MANY = 10_000  # conses: more than most forms have, fewer than one would wait for


def refuse_circular_code(form, place=lambda part: None):
    """Signal a compile-error when ``form`` contains itself outside of a quoted constant and of calls of users' macros.

    place: the position of a list in the user's text, or ``None``. Returns whether there is a circle in a call of a user's macro, so that
    expansions have to be looked at, too.
    """
    if form.__class__ is not Cons or _ends(form):
        return False
    if _circle(form, _is_quoted) is None:
        return False
    local = set()
    part = _circle(form, lambda cell: _is_quoted(cell) or _calls_user_macro(cell) or _calls_local_macro(cell, local))
    if part is None:
        return True
    return error(CompileError("The form contains itself. Only a quoted list may be circular.", position=place(part) or place(form)))


def _is_quoted(cell):
    return cell.car is QUOTE


def _calls_user_macro(cell):
    return isinstance(cell.car, Symbol) and cell.car.macro is not None and not (cell.car.package and cell.car.package.built_in)


def _calls_local_macro(cell, local):
    """Whether ``cell`` is a call of one of the macros ``local``; those of a ``macrolet`` form come to them when the walk reaches it."""
    if cell.car is MACROLET and cell.cdr.__class__ is Cons:
        definitions, seen = cell.cdr.car, set()
        while definitions.__class__ is Cons and id(definitions) not in seen:
            seen.add(id(definitions))
            if definitions.car.__class__ is Cons:
                local.add(definitions.car.car)
            definitions = definitions.cdr
    return cell.car.__class__ is Symbol and cell.car in local


def _circle(form, is_opaque):
    """A list in ``form`` that contains itself, ``None`` if there is none. Conses that are opaque are not looked into."""
    state, path = {}, [form]  # the state of a cons: its parts are being looked at, or have been
    while path:
        cell = path[-1]
        before = state.get(id(cell))
        if before is not None:
            path.pop()
            state[id(cell)] = _DONE
            continue
        state[id(cell)] = _OPEN
        if is_opaque(cell):
            continue
        for part in (cell.cdr, cell.car):
            if part.__class__ is Cons:
                seen = state.get(id(part))
                if seen is _OPEN:
                    return part
                if seen is None:
                    path.append(part)
    return None


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
