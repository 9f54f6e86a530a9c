"""``catch`` and ``throw``: exits to whoever waits for a tag, wherever on the stack that is."""

from __future__ import annotations

from .condition_types import SimpleControlError
from .conditions import error
from .data import Symbol
from .dynamic import bind, special, unbind

_catchers = special(Symbol("*CATCH-TAGS*"), ())


class ThrowExit(BaseException):
    def __init__(self, tag, value):
        self.tag, self.value = tag, value


def catch(tag, thunk):
    """``catch``: the values of ``thunk``, or those thrown to ``tag``."""
    bind(_catchers, (tag, _catchers.value))
    try:
        return thunk()
    except ThrowExit as exit_:
        if exit_.tag is not tag:
            raise
        return exit_.value
    finally:
        unbind(1)


def throw(tag, value):
    """``throw``: a control-error when no ``catch`` for ``tag`` is active."""
    tags = _catchers.value
    while tags:
        if tags[0] is tag:
            raise ThrowExit(tag, value)
        tags = tags[1]
    return error(SimpleControlError("attempt to THROW to a tag that does not exist: ~S", tag))
