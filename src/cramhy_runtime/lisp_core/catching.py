"""Exits to whoever waits for them, wherever on the stack that is: ``handler-case`` as compiled code has it, ``catch`` and ``throw``.

Each task has its own handlers, in `kernel.Task.handlers`: a form puts its own there, and puts back what was there before when it is left.
So nothing has to be done when the baton goes to another task. ``conditions.py`` asks them.
"""

from __future__ import annotations

from cramhy_runtime.kernel.active import ACTIVE
from cramhy_runtime.kernel.typing_names import Any
from .condition_types import DECIDED, DECIDED_ELSEWHERE, Condition, SimpleControlError, matches
from .data import Symbol
from .dynamic import bind, special, unbind
from .ports import PORTS
from .python_exceptions import from_python

EVERYBODY = ("every handler on its way",)
"""The mark of an exception that a handler raised: whoever was to be asked was asked when it left the handler."""


# ---------------------------------------------------------------------------------------------------------------- handlers


def handlers_in_force() -> Any:
    """The handlers of the task that runs: ``None``, or a pair of the innermost and those around.

    The innermost are a list of (type specifier, function) or a `Cluster`. The pair is made when they are put in force, so it stands for
    that one time. `kernel.Task.handlers` is where a form puts it, and what was there before when the form is left.
    """
    running = ACTIVE.value
    return None if running is None else running.current.handlers


class Cluster:
    """Handlers of one form that are more than a list of (type specifier, function).

    A form that is written for Python's ``try`` need not make a function of its body. It puts them in force (see `handlers_in_force`),
    and calls `offer_late` for what passes it.
    """

    __slots__ = ()

    def offer(self, condition, clusters):
        """Handle ``condition`` and leave by an exit, or return: that declines. ``clusters``: the pair of these handlers and those around.

        Code of users runs while those around are in force (ANSI 9.1.4), and `raised_by_handler` is told what it raises.
        """


class HandlerExit(BaseException):
    """Unwinds to the ``handler-case`` whose clause was chosen."""

    __slots__ = ("token", "index", "condition")

    def __init__(self, token, index, condition):
        self.token, self.index, self.condition = token, index, condition


class Case(Cluster):
    """The handlers of a ``handler-case`` that was compiled in place. ``specifiers``: the list of its clauses' types.

    All runs of the form share it. A run is told from the others by the pair that it puts in force (`handlers_in_force`).
    """

    __slots__ = ("known", "specifiers")

    def __init__(self, specifiers):
        self.specifiers = specifiers
        self.known = {}  # class of a condition → its clause, where nothing but the class decides

    def offer(self, condition, clusters):
        """Leave the form if ``condition`` is of the type of a clause."""
        exit_ = self.exit_for(condition, clusters)
        if exit_ is not None:
            raise exit_

    def exit_for(self, condition, run):
        """The `CaseExit` that unwinds to the first clause to whose type ``condition`` belongs; ``None`` if there is none."""
        index = self.clause_for(condition)
        if index < 0:
            return None
        exit_ = CaseExit()
        exit_.token, exit_.index, exit_.condition = run, index, condition
        return exit_

    def clause_for(self, condition):
        """The number of the first clause to whose type ``condition`` belongs; -1 if there is none."""
        found = self.known.get(condition.__class__)
        return self._clause_for(condition) if found is None else found

    def _clause_for(self, condition):
        known, found, cls = True, -1, condition.__class__
        for index, specifier in enumerate(self.specifiers):
            fits = matches(condition, specifier)
            known = known and (isinstance(specifier, type) or specifier is True or (specifier, cls) in DECIDED)
            if fits:
                found = index
                break
        if known:
            if not self.known:
                DECIDED_ELSEWHERE.append(self.known)
            self.known[cls] = found
        return found


class CaseExit(HandlerExit):
    """Unwinds to a run of a form with a `Case`, its token."""

    __slots__ = ()
    __init__ = BaseException.__init__  # a method of Python's would take longer than all else that is done to make one


CATCHABLE = (HandlerExit, Exception, Condition)
"""What a form with a `Case` looks at when it is left by it: see `caught`."""


def caught(exception, run):
    """(the clause, the condition) for which a form with a `Case` is left by ``exception``; or that goes on, as it is about another form.

    run: the pair that the form put in force. An exception of foreign code, which was not signalled, is offered to the clauses now.
    """
    if exception.__class__ is CaseExit:
        if exception.token is not run:
            raise exception
        exception.__traceback__ = exception.__context__ = None  # no circle of the exit and the frames that it passed
        return exception.index, exception.condition
    if isinstance(exception, Condition):
        asked = exception.signalled
    else:
        asked = isinstance(exception, HandlerExit) or getattr(exception, "__lisp_asked__", None) is EVERYBODY
    if not asked:
        condition = from_python(exception)
        index = run[0].clause_for(condition)
        if index >= 0:
            return index, condition
    raise exception


# --------------------------------------------------------------------------------------------------------- catch and throw

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
    return PORTS.signals.error(SimpleControlError("attempt to THROW to a tag that does not exist: ~S", tag))
