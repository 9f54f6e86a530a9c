"""The built-in predicates other than control: comparison, lists, strings, numbers, and access to Lisp.

Predicates that are facts in the original belong to the same fact groups here, so the same rules hold for extending them. Source:
prolog.md section 7.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.output import standard_output
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.conditions import Error, SimpleError, SimpleWarning, error, handler_case, type_error, warn
from cramhy_runtime.lisp_core.data import Cons, Symbol, UndefinedFunction, list_from, one, truth

from cramhy_runtime.utilities.lazy_lists import lazy_take
from ..terms.deep_terms import LIST_SUSPECTED, refuse_endless
from .function_calls import BREAK_ON_LISP_ERRORS, call_lisp, compare, lisp_fun, lisp_fun_goal, lisp_pred_goal
from ..engine.machine import Machine, fail
from .native_predicates import step_predicate, test
from ..symbols import sym
from ..terms.terms import Var, deref, elements, ground, import_term, list_end, raw, resolve, undo, unify, value_of

_MISC, _LISTS, _MATH = "CRAM-PROLOG::MISC-UTILS", "CRAM-PROLOG::LIST-UTILS", "CRAM-PROLOG::MATH-UTILS"
_STRINGS, _DEBUGGING = "CRAM-PROLOG::STRING-UTILS", "CRAM-PROLOG::DEBUGGING"
_STRUCTURES, _TYPES = "CRAM-PROLOG::LISP-DATA-STRUCTS", "CRAM-PROLOG::LISP-TYPES"


_NOT_GIVEN = object()


def bound(term):
    """Whether ``term`` is anything but an unset variable."""
    return deref(term).__class__ is not Var


# ---------------------------------------------------------------------------------------------------------------- comparison


@test("CRAM-PROLOG::==", _MISC)
def _unifies(m, a, b):
    return m.unify(a, b)


@test("EQUAL", _MISC)
def _equal(m, a, b):
    return m.unify(a, b)  # ground terms: unification is the test with EQUAL


@test("CRAM-PROLOG::BOUND")
def _bound(m, pattern):
    return bound(pattern)


@test("CRAM-PROLOG::GROUND")
def _ground(m, pattern):
    return ground(pattern)


def _define_comparison(operator):
    @test(operator, _MATH, calls_lisp=True)
    def comparison(m, a, b):
        return compare(m, sym(operator), resolve(a, m.names), resolve(b, m.names))


for _operator in ("<", ">", "<=", ">="):
    _define_comparison(_operator)


# --------------------------------------------------------------------------------------------------------------------- lists


def _member(m, step):
    """Give each element in turn; for a list with an unset end also all its extensions."""
    _, k, element, lst = step
    trail = m.trail
    height, count = len(trail), 0
    element = deref(element)
    while True:
        while lst.__class__ is not Cons:
            if lst is None:
                return fail(m)
            lst = deref(lst)
            if lst.__class__ is Var:
                m.choices.append((_member_of_extension, k, height, element, lst))
                lst.ref = Cons(element, Var())
                trail.append(lst)
                return k
            if lst.__class__ is not Cons and lst is not None:
                return fail(m)
        item, lst = lst.car, lst.cdr
        if element.__class__ is Var:
            if lst is not None:
                m.choices.append([_next_member, k, height, element, lst])
            if item is not element:
                element.ref = item
                trail.append(element)
            return k
        if unify(element, item, trail):
            if lst is not None:
                m.choices.append([_next_member, k, height, element, lst])
            return k
        if len(trail) > height:
            undo(trail, height)
        count += 1
        if count == LIST_SUSPECTED:
            refuse_endless(lst, value_of)


def _next_member(m, step):
    """Choice point: the elements of a list that are left. It moves along the list while ``element`` just gets each of them as its value."""
    _, k, _, element, lst = step
    if element.__class__ is Var and lst.__class__ is Cons:
        item, rest = lst.car, lst.cdr
        if rest is None:
            m.choices.pop()
        else:
            step[4] = rest
        if item is not element:
            element.ref = item
            m.trail.append(element)
        return k
    m.choices.pop()
    return _member(m, (_member, k, element, lst))


def _member_of_extension(m, step):
    _, k, _, element, lst = step
    m.choices.pop()
    rest = Var()
    lst.ref = Cons(Var(), rest)
    m.trail.append(lst)
    return _member(m, (_member, k, element, rest))


step_predicate("MEMBER", _LISTS, 2)(_member)


def _subset(m: Machine, subset: object, lst: object) -> bool:
    """Whether each element of a list is among those of another one, as far as both unify. No variable gets a value."""
    trail = m.trail
    height = len(trail)
    for wanted in elements(subset):
        for item in elements(lst):
            found = m.unify(wanted, item)
            if len(trail) > height:
                undo(trail, height)
            if found:
                break
        else:
            return False
    return True


test("CRAM-PROLOG::SUBSET", _LISTS)(_subset)


@test("LENGTH", _LISTS, calls_lisp=True)
def _length(m, lst, n):
    if not bound(lst):
        return False
    if list_end(lst) is None:
        return m.unify(n, sum(1 for _ in elements(lst)))
    return lisp_fun(m, sym("LENGTH"), (resolve(lst, m.names),), n)


@step_predicate("APPEND", _LISTS, 3)
def _append(m, step):
    """One solution if the first list is known; otherwise all ways to split the third."""
    _, k, a, b, c = step
    trail = m.trail
    a, count = deref(a), 0
    while a.__class__ is Cons:
        count += 1
        if count == LIST_SUSPECTED:
            refuse_endless(a, value_of)
        rest, whole = Var(), deref(c)
        if whole.__class__ is Cons:
            if not unify(a.car, whole.car, trail):
                return fail(m)
            c = whole.cdr
        elif whole.__class__ is Var:
            whole.ref = Cons(a.car, rest)
            trail.append(whole)
            c = rest
        else:
            return fail(m)
        a = deref(a.cdr)
    if a is None:
        return k if unify(b, c, trail) else fail(m)
    if a.__class__ is not Var:
        return fail(m)
    m.choices.append((_append_longer, k, len(trail), a, b, c))
    a.ref = None
    trail.append(a)
    return k if unify(b, c, trail) else fail(m)


def _append_longer(m, step):
    _, k, _, a, b, c = step
    m.choices.pop()
    first, rest, end = Var(), Var(), Var()
    whole = deref(c)
    if whole.__class__ is Cons:
        first, end = whole.car, whole.cdr
    elif whole.__class__ is Var:
        whole.ref = Cons(first, end)
        m.trail.append(whole)
    else:
        return fail(m)
    a.ref = Cons(first, rest)
    m.trail.append(a)
    return _append(m, (_append, k, rest, b, end))


def _list_copy(m, term):
    """A copy of a list that a Lisp function may change. Anything but a proper list is passed as it is; the function signals an error."""
    if list_end(term) is not None:
        return resolve(term, m.names)
    return list_from([resolve(item, m.names) for item in elements(term)])


@test("SORT", _LISTS, calls_lisp=True)
def _sort(m, lst, pred, key_or_result, result=_NOT_GIVEN):
    keyed = result is not _NOT_GIVEN
    if not all(bound(term) for term in ((lst, pred, key_or_result) if keyed else (lst, pred))):
        return False
    key = [sym(":KEY"), resolve(key_or_result)] if keyed else []
    return lisp_fun(m, sym("SORT"), [_list_copy(m, lst), resolve(pred), *key], result if keyed else key_or_result)


@test("REDUCE", _LISTS, calls_lisp=True)
def _reduce(m, function, lst, result):
    return bound(function) and bound(lst) and lisp_fun(m, sym("REDUCE"), [resolve(function), _list_copy(m, lst)], result)


@test("MAX", _MATH, calls_lisp=True)
def _max(m, lst, result):
    return bound(lst) and lisp_fun(m, sym("REDUCE"), [sym("MAX"), _list_copy(m, lst)], result)


@test("CRAM-PROLOG::TAKE")
def _take(m, n, lst, result):
    count, whole = resolve(n), deref(lst)
    if not isinstance(count, int) or isinstance(count, bool):
        return type_error(count, "INTEGER")
    if whole is not None and whole.__class__ is not Cons:
        return type_error(resolve(whole), "LIST")
    return m.unify(result, lazy_take(count, whole))


# ------------------------------------------------------------------------------------------------------------------- strings


@test("CRAM-PROLOG::STRING-CONCAT", _STRINGS, calls_lisp=True)
def _string_concat(m, s1, s2, s3):
    if bound(s1) and bound(s2):
        return lisp_fun(m, sym("CONCATENATE"), [sym("STRING"), resolve(s1), resolve(s2)], s3)
    return _prolog_error(m, "Not implemented.")


# ----------------------------------------------------------------------------------------------------------------- debugging


def _applied(m, function, arguments):
    """Run a Python function as the original runs its functions through ``(lisp-fun apply ...)``: errors become warnings."""
    runner = Symbol("APPLY")
    runner.function = function
    done, _ = call_lisp(runner, arguments, "function", sym("APPLY"))
    return done


@test("FORMAT", _DEBUGGING)
def _format(m, *terms):
    return _applied(m, lambda *items: PORTS.printer.format_to(standard_output(), *items), [resolve(term, m.names) for term in terms])


@test("WARN", _DEBUGGING)
def _warn(m, *terms):
    if not terms:
        warn(SimpleWarning("[PROLOG WARNING] "))
        return True
    datum, *arguments = (resolve(term, m.names) for term in terms)
    return _applied(m, lambda: warn(SimpleWarning(f"[PROLOG WARNING] {datum}", *arguments)), ())


@test("ERROR", _DEBUGGING)
def _prolog_error(m, *terms):
    datum, *arguments = [resolve(term, m.names) for term in terms] or [""]
    return _applied(m, lambda: error(SimpleError(f"[PROLOG ERROR] {datum}", *arguments)), ())


# ------------------------------------------------------------------------------------------------------------- Lisp's objects


@step_predicate("CRAM-PROLOG::LISP-FUN")
def _lisp_fun(m, step):
    m.goes_on = step[1]
    return step[1] if lisp_fun_goal(m, *step[2:]) else fail(m)


test("CRAM-PROLOG::LISP-PRED", calls_lisp=True)(lisp_pred_goal)


@test("CRAM-PROLOG::GENERATE-VALUES")
def _generate_values(m, values, call):
    call = resolve(call, m.names)
    function = call.car if isinstance(call, Cons) else call
    if not isinstance(function, Symbol) or isinstance(function.function, UndefinedFunction) or list_end(call) is not None:
        return error("Generator function `~a' not valid", function)
    return m.unify(values, import_term(one(function.function(*(call.cdr or ()))), m.names))


@test("CRAM-PROLOG::ASSERT-TYPE")
def _assert_type(m, obj, type_, tag):
    if not truth(BREAK_ON_LISP_ERRORS.value):
        return True
    obj, type_, tag = resolve(obj, m.names), raw(type_, m.names), resolve(tag, m.names)
    if isinstance(type_, Cons) and type_.car is not sym("OR"):
        return error("[~a]: in ~a, composite types can only be constructed with OR", tag, type_)
    if not PORTS.types.predicate(type_)(obj):
        return error("[~a]: ~a had to be of type ~a", tag, obj, type_)
    return True


def _quietly(thunk):
    """The value of ``thunk``, or ``None`` when it signals an error."""
    return handler_case([(Error, lambda condition: None)], thunk)


def _lisp_type_of(m, obj, type_):
    if not bound(obj):
        return False
    if not bound(type_):
        return lisp_fun(m, sym("TYPE-OF"), (resolve(obj, m.names),), type_)
    value, specifier = resolve(obj, m.names), resolve(type_, m.names)
    if specifier.__class__ is Symbol and PORTS.classes.find(specifier, False) is not None:
        return bool(PORTS.types.predicate(specifier)(value))  # to ask for a class runs no code of a user, and signals nothing
    return bool(_quietly(lambda: PORTS.types.predicate(specifier)(value)))


test("CRAM-PROLOG::LISP-TYPE", _TYPES, calls_lisp=True)(_lisp_type_of)


@test("CRAM-PROLOG::INSTANCE-OF", _TYPES, calls_lisp=True)
def _instance_of(m, type_, obj):
    if bound(obj):
        return _lisp_type_of(m, obj, type_)
    return bound(type_) and lisp_fun(m, sym("MAKE-INSTANCE"), (resolve(type_, m.names),), obj)


@test("SLOT-VALUE", _STRUCTURES, calls_lisp=True)
def _slot_value(m, obj, slot, value):
    if not bound(value):
        return _get_slot_value(m, obj, slot, value)
    new, instance, name = (resolve(term, m.names) for term in (value, obj, slot))
    return _applied(m, lambda: sym("SLOT-VALUE").setf_function(new, instance, name), ())


@test("CRAM-PROLOG::GET-SLOT-VALUE", _STRUCTURES, calls_lisp=True)
def _get_slot_value(m, obj, slot, value):
    return lisp_fun(m, sym("SLOT-VALUE"), (resolve(obj, m.names), resolve(slot, m.names)), value)


@test("SYMBOL-VALUE", _STRUCTURES, calls_lisp=True)
def _symbol_value(m, symbol, value):
    return lisp_fun(m, sym("SYMBOL-VALUE"), (resolve(symbol, m.names),), value)


@test("CRAM-PROLOG::SET-SYMBOL-VALUE", _STRUCTURES, calls_lisp=True)
def _set_symbol_value(m, symbol, value):
    return lisp_fun(m, sym("SET"), (resolve(symbol, m.names), resolve(value, m.names)), Var())
