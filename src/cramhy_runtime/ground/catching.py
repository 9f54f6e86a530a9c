"""Exits to whoever waits for them, wherever on the stack that is: ``catch`` and ``throw``, and ``handler-case`` as compiled code has it."""

from __future__ import annotations

from .condition_types import DECIDED, Condition, SimpleControlError, matches
from .conditions import BREAK_ON_SIGNALS, EVERYBODY, HANDLERS, Cluster, HandlerExit, error, from_python, make_condition, signal_error
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


# -------------------------------------------------------------------------------------------------------- handler-case in place


class Case(HandlerExit, Cluster):
    """The handlers of a ``handler-case`` that was compiled in place, for one run of it, and the exit that unwinds to it.

    ``specifiers``: the list of its clauses' types. ``index``: which clause was chosen, for ``condition``.
    """

    __init__ = BaseException.__init__  # a method of Python's would take longer than all else that is done to enter the form
    token = None

    def offer(self, condition, outer):
        """Leave the form if ``condition`` is of the type of a clause."""
        if self.fits(condition):
            raise self

    def fits(self, condition):
        """Whether ``condition`` is of the type of a clause; that is noted."""
        index, cell, cls = 0, self.specifiers, condition.__class__
        while cell is not None:
            decided = DECIDED.get((cell.car, cls))
            if matches(condition, cell.car) if decided is None else decided:
                self.index, self.condition = index, condition
                return True
            index, cell = index + 1, cell.cdr
        return False


def error_in_case(case, datum, *arguments):
    """``error`` in the very function whose ``handler-case`` is ``case``.

    Returns ``case``, for the function to raise, if a clause fits: then no frame is to be unwound. Else it does what `error` does.
    """
    condition = make_condition(datum, arguments)
    if HANDLERS.value[0] is case and BREAK_ON_SIGNALS.value is None:
        condition.signalled = True
        if case.fits(condition):
            return case
    signal_error(condition)


def enter_case(specifiers):
    """Put the handlers of a ``handler-case`` in force; they are undone by `dynamic.unbind`."""
    case = Case()
    case.specifiers = specifiers
    bind(HANDLERS, (case, HANDLERS.value))
    return case


def foreign_case(exception, case):
    """Offer an exception of foreign code to the ``case`` that it passes, and let it go on."""
    asked = exception.signalled if isinstance(exception, Condition) else getattr(exception, "__lisp_asked__", None) is EVERYBODY
    if not asked:
        case.offer(from_python(exception), HANDLERS.value[1])
    raise exception


def caught(exit_, case):
    """The condition for which ``case`` was left; any other exit goes on."""
    if exit_ is not case:
        raise exit_
    condition = case.condition
    case.__traceback__ = case.__context__ = case.condition = None  # no circle of the exit and the frames that it passed
    return condition
