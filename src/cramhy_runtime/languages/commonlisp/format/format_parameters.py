"""The prefix parameters of a ``format`` directive: numbers, characters, ``V`` and ``#``, each checked for its kind. Source: ANSI 22.3."""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Character
from .format_parser import ARGUMENT_MARK, REMAINING_MARK

NO_CHARACTER = ""
"""The default of a parameter that is a character and may be missing."""


def parameters(directive, state, *defaults):
    """The values of the directive's parameters; those not given or nil have their default."""
    given = directive.params
    if not given:
        return defaults
    if len(given) > len(defaults):
        directive.complain(f"Too many parameters, expected no more than {len(defaults)}", given[len(defaults)][0])
    values = list(defaults)
    for index, (offset, value) in enumerate(given):
        if value is ARGUMENT_MARK:
            value = state.next(directive, offset)
            if isinstance(value, Character):
                value = value.char
        elif value is REMAINING_MARK:
            value = state.remaining
        if value is not None:
            values[index] = value if directive.char in "[^" else _checked(value, defaults[index])
    return values


def _checked(value, default):
    """``value`` if it is of the kind of the parameter with this default: a character, or an integer."""
    if default.__class__ is str:
        return value if value.__class__ is str and len(value) == 1 else type_error(value, "CHARACTER")
    if value.__class__ is int:
        return value
    return type_error(Character(value) if value.__class__ is str and len(value) == 1 else value, "INTEGER")
