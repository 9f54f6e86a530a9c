"""Calling Lisp from a proof: ``lisp-fun``, ``lisp-pred`` and the comparisons.

A variable among the arguments is replaced by its value, or passed as its symbol if it has no value. All other arguments, also lists
with variables in them, are passed as they are written. The first value is unified with the result; variables in returned data are
the variables of the proof. An ``error`` in the call becomes a warning and the goal fails, unless ``*break-on-lisp-errors*`` is true.
Plan failures and other conditions that are not errors pass. Source: prolog.md section 8.
"""

from __future__ import annotations

import operator
from collections.abc import Callable

from cramhy_runtime import kernel
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.lisp_core.catching import CATCHABLE, Case, HandlerExit, caught
from cramhy_runtime.lisp_core.conditions import Error, SimpleWarning, StorageCondition, type_error, undefined_function, warn
from cramhy_runtime.lisp_core.data import Cons, Keyword, MultipleValues, Symbol, UndefinedFunction, is_ratio, lisp_list, truth
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.source_places import exception_position

from cramhy_runtime.utilities.lazy_lists import force_ll
from cramhy_runtime.utilities.patterns import NOTHING, for_lisp
from ..engine.failing_calls import note_place
from ..symbols import CUT, PROLOG, sym
from ..terms.terms import TermTail, Var, import_term, raw, resolve, undo, unify

FINDERS: list[Callable[[Symbol], Callable[..., Any] | None]] = []
"""Functions that find what a symbol without a function means in another language, or give ``None``."""

BREAK_ON_LISP_ERRORS = special(PROLOG.intern("*BREAK-ON-LISP-ERRORS*"))


def resolve_argument(m, term):
    """The argument of a Lisp function for a variable: its value, or its symbol."""
    kind = term.__class__
    if kind is Symbol or kind is int or kind is str:
        return term
    return resolve(term, m.names)


def raw_argument(m, term):
    """The argument of a Lisp function for a list that is written in the goal: the list as it is written."""
    return raw(term, m.names)


def as_variable(term):
    """``term`` if it is a variable, or else a variable with that value. A list that is passed as it is written shows such variables."""
    if term.__class__ is Var:
        return term
    variable = Var()
    variable.ref = term
    return variable


def argument(m, term):
    """The argument of a Lisp function for an argument term of a goal."""
    return resolve(term, m.names) if term.__class__ is Var else raw(term, m.names) if term.__class__ is Cons else term


def call_lisp(function, arguments, kind, written, m=None):
    """Call ``function``. Returns (True, value), or (False, condition) after a warning about the error in it.

    ``kind`` is ``function`` or ``predicate``, ``written`` the function term as the goal has it, ``m`` the proof of the goal.
    """
    if BREAK_ON_LISP_ERRORS.value is not None and truth(BREAK_ON_LISP_ERRORS.value):
        return True, _apply(function, arguments)
    inside = None
    task = kernel.current()
    task.handlers = run = _ERRORS, task.handlers
    try:
        return True, _apply(function, arguments)
    except RecursionError:
        problem = StorageCondition("Control stack exhausted.")
    except CATCHABLE as left:
        if isinstance(left, HandlerExit):
            inside = exception_position(left)  # before `caught` takes the frames from it
        problem = caught(left, run)[1]
    finally:
        task.handlers = run[1]
    warning = SimpleWarning(f"An error occurred while executing the lisp {kind} `~a': `~a'", written, problem)
    if m is not None:
        note_place(warning, m, kind, written, arguments, problem, inside)
    warn(warning)
    return False, problem


_ERRORS = Case(lisp_list(Error))


def _apply(function, arguments):
    if function.__class__ is not Symbol and function.__class__ is not Keyword:
        return type_error(function, "SYMBOL")
    if function.package is not CUT:
        for item in arguments:
            if item.__class__ in _SEEN_OTHERWISE:
                arguments = [_whole(item) for item in arguments]
                break
    code = function.function
    if code.__class__ is UndefinedFunction:
        found = next(filter(None, (find(function) for find in FINDERS)), None)
        if found is None:
            return undefined_function(function, tuple(arguments), {})
        code = found
    value = code(*arguments)
    if value.__class__ is MultipleValues:
        return value[0] if len(value) else None
    return value


_SEEN_OTHERWISE = frozenset((Cons, bool, NOTHING.__class__))
"""The classes of the arguments that may be another object in Lisp: lazy lists, and what Prolog tells from ``nil``."""


def _whole(item):
    """``item`` as Lisp sees it. A lazy list of ``findall`` is computed, as plan code expects of a list."""
    if item.__class__ is Cons:
        cell = item
        while cell.__class__ is Cons:
            cell = cell.cdr
        if cell.__class__ is TermTail:
            force_ll(item)
    return for_lisp(item)


def lisp_value(m, function, arguments):
    """Call ``function`` and return its first value as a term, or ``NotImplemented`` after a warning about an error in it."""
    done, value = call_lisp(function, arguments, "function", function, m)
    if not done:
        return NotImplemented
    kind = value.__class__
    if kind is Cons or kind is Symbol or kind is Keyword or kind is bool:
        return import_term(value, m.names)
    if RESULTS and kind not in _ATOMS and function in RESULTS:
        return RESULTS[function](value)
    return value


RESULTS: dict[Symbol, Callable[[Any], Any]] = {}
"""The symbol of a function that was written in Hy → what makes Lisp data of its result. Such a result may be a collection of Python."""
_ATOMS = frozenset((int, float, str, type(None)))


def lisp_fun(m, function, arguments, result):
    """Call ``function`` and unify its first value with ``result``. Returns whether that succeeds. The arguments are prepared already."""
    value = lisp_value(m, function, arguments)
    if value is NotImplemented:
        return False
    trail = m.trail
    height = len(trail)
    if unify(result, value, trail):
        return True
    undo(trail, height)
    return False


def lisp_pred(m, predicate, arguments):
    """Whether ``predicate`` is true for the arguments. It is a symbol as it is written, never the value of a variable."""
    done, value = call_lisp(predicate, arguments, "predicate", predicate, m)
    return done and truth(value)


_COMPARISONS = {sym("<"): operator.lt, sym(">"): operator.gt, sym("<="): operator.le, sym(">="): operator.ge}


def compare(m, name, a, b):
    """Compare two numbers. For other arguments the Lisp function signals its error; where Lisp is not loaded, it is the same one."""
    if _is_real(a) and _is_real(b):
        return _COMPARISONS[name](a, b)
    function = name if name.function.__class__ is not UndefinedFunction else _REFUSING
    done, value = call_lisp(function, (a, b), "predicate", name, m)
    return done and truth(value)


def _is_real(thing):
    return (isinstance(thing, (int, float)) and thing.__class__ is not bool) or is_ratio(thing)


_REFUSING = Symbol("REFUSE")
_REFUSING.function = lambda *arguments: type_error(next(thing for thing in arguments if not _is_real(thing)), "REAL")


def lisp_fun_goal(m, *terms):
    """``(lisp-fun function argument... result)`` as a goal with argument terms."""
    if not terms:
        return False
    function = resolve(terms[0], m.names)
    return lisp_fun(m, function, [argument(m, term) for term in terms[1:-1]], terms[-1] if len(terms) > 1 else None)


def lisp_pred_goal(m, predicate, *terms):
    """``(lisp-pred predicate argument...)`` as a goal with argument terms."""
    return lisp_pred(m, raw(predicate, m.names), [argument(m, term) for term in terms])
