"""Reasons in words why a built-in predicate failed, for goals that have no clauses to look into.

``@explains(functor)`` defines a function of the machine and the argument terms, with the bindings of the call. It returns the reason, or
a pair of the reason and a number from 0 to 1 that says how close the goal was to success: a property whose name is misspelled is closer
than one that is missing. Rooms above add reasons for their predicates.

``declare_harmless`` names predicates that only look at their arguments and at facts, so that proving them twice changes nothing.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol, list_from, truth
from cramhy_runtime.lisp_core.packages import near_names

from ..engine.goal_text import Names, readable, show
from ..symbols import sym
from ..builtins.function_calls import argument, call_lisp
from ..terms.terms import Var, deref, elements, import_term, list_end, raw, resolve, undo, unify, unset_variables

LISP_FUN, LISP_PRED = sym("CRAM-PROLOG::LISP-FUN"), sym("CRAM-PROLOG::LISP-PRED")
_reasons: dict = {}
_harmless: set = set()


def explains(*functors):
    """Decorator: the function ``f(machine, *terms)`` says why a goal with one of ``functors`` failed."""

    def define(function):
        for functor in functors:
            _reasons[sym(functor)] = function
        return function

    return define


def declare_harmless(*functors):
    """Allow goals with these functors in dry proofs, which must change nothing."""
    _harmless.update(sym(functor) for functor in functors)


def harmless(goal):
    """Whether a proof of ``goal`` changes nothing."""
    if goal.car is LISP_PRED or goal.car is LISP_FUN:
        function = goal.cdr.car if goal.cdr.__class__ is Cons else None
        return deref(function) in _HARMLESS_FUNCTIONS
    return goal.car in _harmless


def why(m, goal):
    """(reason, nearness) for a goal that failed. The reason is ``None`` if none is known."""
    if goal.__class__ is not Cons:
        return None, 0
    function = _reasons.get(goal.car)
    if function is None or list_end(goal) is not None:
        return None, 0
    terms = list(elements(goal.cdr))
    code = function.__code__
    if len(terms) + 1 != code.co_argcount and not (code.co_flags & 0x04 and len(terms) + 1 >= code.co_argcount):
        return None, 0  # a handler takes numbers of arguments that mean nothing
    found = function(m, *terms)
    return found if isinstance(found, tuple) else (found, 0)


# ----------------------------------------------------------------------------------------------------------------- comparing


def difference(a, b):
    """A text about the first difference of two terms that do not unify, such as ``driving is not moving``."""
    names, place = Names(), ""
    a, b = deref(a), deref(b)
    while a.__class__ is Cons and b.__class__ is Cons:
        number = 0
        while a.__class__ is Cons and b.__class__ is Cons:
            number += 1
            x, y = deref(a.car), deref(b.car)
            if not _agree(x, y):
                place += f"element {number}: " if not place else f"of it element {number}: "
                break
            a, b = deref(a.cdr), deref(b.cdr)
        else:
            if a is None or b is None:
                return f"{place}one list is shorter than the other"
            x, y = a, b
            place += "after the dot: "
        a, b = x, y
        if a.__class__ is not Cons or b.__class__ is not Cons:
            break
    return f"{place}{show(a, names)} is not {show(b, names)}"


def _agree(a, b):
    trail = []
    same = unify(a, b, trail)
    undo(trail, 0)
    return same


def other_count(functor, given, known):
    """The reason for a goal with ``given`` arguments, if ``functor`` takes the numbers of arguments in ``known``."""
    return f"it has {given} argument{'' if given == 1 else 's'}, and {show(functor)} takes {' or '.join(map(str, sorted(known)))}"


def spelled_like(name, known):
    """The symbols among ``known`` whose names are like that of ``name``, the nearest first."""
    by_name = {symbol.name: symbol for symbol in known}
    return [by_name[near] for near in near_names(name.name, by_name)]


# --------------------------------------------------------------------------------------------------------------- Lisp's calls


def _call(function, values):
    return show(Cons(function, list_from([readable(value) for value in values])))


def returned(function, values, value, *wanted):
    """The reason for a ``lisp-fun`` or ``lisp-pred`` whose value did not fit."""
    value = value[0] if isinstance(value, MultipleValues) and len(value) else value
    text = f"{_call(function, values)} returned {show(value)}"
    return text + (f", which is not {show(wanted[0])}" if wanted else "")


def signalled(function, values, problem):
    """The reason for one that ended with an error."""
    text = " ".join(str(problem).split()) or type(problem).__name__
    return f"{_call(function, values)} signalled an error: {text.rstrip('.')}"


def call_lisp_goal(m, functor, terms):
    """Prove a goal of ``lisp-fun`` or ``lisp-pred`` as the built-in does. Returns whether it succeeds, and the reason if not."""
    if not terms:
        return False, None
    if functor is LISP_PRED:
        function, given, kind = raw(terms[0], m.names), terms[1:], "predicate"
    else:
        function, given, kind = resolve(terms[0], m.names), terms[1:-1], "function"
    values = [argument(m, term) for term in given]
    done, value = call_lisp(function, values, kind, function)
    if not done:
        return False, signalled(function, values, value)
    if functor is LISP_PRED:
        return (True, None) if truth(value) else (False, returned(function, values, value))
    result, height = terms[-1] if len(terms) > 1 else None, len(m.trail)
    term = import_term(value, m.names) if value.__class__ is Cons or isinstance(value, (Symbol, bool)) else value
    if unify(result, term, m.trail):
        return True, None
    undo(m.trail, height)
    return False, returned(function, values, value, result)


# ----------------------------------------------------------------------------------------------------------------- built-ins


@explains("CRAM-PROLOG::==", "EQUAL")
def _unifies(m, a, b):
    return difference(a, b)


def _unset(term, names):
    """ "?x has no value", for the first unset variable of a term; ``None`` if there is none."""
    for variable in unset_variables(deref(term), {}):
        return f"{show(variable, names)} has no value"
    return None


def _define_comparison(operator, words):
    @explains(operator)
    def comparison(m, a, b):
        names = Names()
        missing = [_unset(term, names) for term in (a, b) if deref(term).__class__ is Var]
        return missing[0] if missing else f"{show(a, names)} is not {words} {show(b, names)}"


for _operator, _words in (("<", "less than"), (">", "greater than"), ("<=", "at most"), (">=", "at least")):
    _define_comparison(_operator, _words)


@explains("CRAM-PROLOG::BOUND")
def _bound(m, pattern):
    return f"{show(pattern)} has no value"


@explains("CRAM-PROLOG::GROUND")
def _ground(m, pattern):
    return _unset(pattern, Names())


@explains("MEMBER")
def _member(m, element, lst):
    names = Names()
    if deref(lst) is None:
        return "the list is empty"
    items = list(elements(lst))
    if not items:
        return f"{show(lst, names)} is not a list"
    wanted = deref(element)
    near = spelled_like(wanted, [item for item in map(deref, items) if isinstance(item, Symbol)]) if isinstance(wanted, Symbol) else ()
    text = f"{show(element, names)} is not among {show(lst, names)}"
    return (f"{text}; did you mean {show(near[0])}?", 0.8) if near else text


@explains("LENGTH")
def _length(m, lst, n):
    if deref(lst).__class__ is Var:
        return _unset(lst, Names())
    if list_end(lst) is not None:
        return f"{show(lst)} is not a proper list"
    return f"the list has {sum(1 for _ in elements(lst))} elements, not {show(n)}"


@explains("CRAM-PROLOG::LISP-TYPE")
def _lisp_type(m, obj, type_):
    names = Names()
    return _unset(obj, names) if deref(obj).__class__ is Var else f"{show(obj, names)} is not of type {show(type_, names)}"


@explains("CRAM-PROLOG::INSTANCE-OF")
def _instance_of(m, type_, obj):
    return _lisp_type(m, obj, type_)


@explains("CRAM-PROLOG::FINDALL", "CRAM-PROLOG::BAGOF", "CRAM-PROLOG::SETOF")
def _collection(m, template, goal, result):
    names = Names()
    return f"what the solutions of {show(goal, names)} give is not {show(result, names)}"


@explains("CRAM-PROLOG::RETE-HOLDS")
def _rete_holds(m, pattern):
    return f"no fact that is asserted matches {show(pattern)}"


_HARMLESS_FUNCTIONS = frozenset(
    sym(name)
    for name in """IDENTITY EQ EQL EQUAL EQUALP TYPEP NUMBERP INTEGERP SYMBOLP STRINGP LISTP CONSP
    NULL ATOM KEYWORDP + - * / < > <= >= = 1+ 1- MIN MAX ABS MOD CAR CDR FIRST SECOND THIRD REST LAST NTH LENGTH LIST CONS
    GETF ASSOC ZEROP PLUSP MINUSP EVENP ODDP STRING= STRING-EQUAL""".split()
)
declare_harmless(
    "CRAM-PROLOG::==",
    "EQUAL",
    "<",
    ">",
    "<=",
    ">=",
    "CRAM-PROLOG::BOUND",
    "CRAM-PROLOG::GROUND",
    "MEMBER",
    "LENGTH",
    "APPEND",
    "CRAM-PROLOG::STRING-CONCAT",
    "CRAM-PROLOG::LISP-TYPE",
    "CRAM-PROLOG::RETE-HOLDS",
    "CRAM-PROLOG::GET-SLOT-VALUE",
    "SYMBOL-VALUE",
    "CRAM-PROLOG::ASSERT-TYPE",
)
