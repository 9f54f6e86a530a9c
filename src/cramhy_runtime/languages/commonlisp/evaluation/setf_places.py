"""Places: what ``setf`` and its relatives can assign (ANSI 5.1).

`setf_expansion` gives the five parts of a place: temporaries and their forms, store variables, the storing form and the
reading form. A place ``(f a b)`` is stored through the function ``(setf f)`` unless something else is known about ``f``: a
``defsetf`` or ``define-setf-expander``, a macro, or one of the places with a rule of their own here. The expanders are kept
in ``symbol.compiler_data``.
"""

from __future__ import annotations

import functools

from cramhy_runtime.lisp_core.conditions import CompileError, error
from cramhy_runtime.lisp_core.data import Cons, Keyword, MultipleValues, Symbol, lisp_list, list_from, one
from cramhy_runtime.lisp_core.packages import COMMON_LISP, is_symbol, redefined, sym, symbol_package
from ..packages.package_errors import check_symbol
from .definitions import data
from .evaluator import macro_lambda
from ..syntax.body_parts import body_parts
from ..syntax.lambda_lists import destructure, gensym, parse, support
from cramhy_runtime.storage.dependency_tracing import run
from ..syntax.macros import checked_environment, macroexpand_1
from ..syntax.operator_macros import malformed

LET_STAR, PROGN, SETQ = sym("LET*"), sym("PROGN"), sym("SETQ")
FUNCALL, FUNCTION, SETF = sym("FUNCALL"), sym("FUNCTION"), sym("SETF")


def setf_expansion(place, environment=None):
    """(temporaries, forms, stores, storing form, reading form) of ``place``; the first three are Python lists."""
    if is_symbol(place):
        expansion, expanded = macroexpand_1(place, environment)
        if expanded:
            return setf_expansion(expansion, environment)
        store = gensym("NEW")
        return [], [], [store], lisp_list(SETQ, place, store), place
    if not isinstance(place, Cons) or not is_symbol(place.car):
        return error(CompileError("~S is not a place that SETF can assign.", place))
    head = place.car
    if not isinstance(head, Symbol):  # NIL and T may be names of local functions
        return _function_place(place, environment)
    local = environment.function(head) if environment is not None else None
    if local is None:
        expander = (head.compiler_data or {}).get("setf-expander")
        if expander is not None:
            return run(expander, place, environment)
    expansion, expanded = macroexpand_1(place, environment)  # knows that a local function hides a macro
    if expanded:
        return setf_expansion(expansion, environment)
    return _function_place(place, environment)


def _function_place(place, environment):
    head = place.car
    temporaries, forms, arguments = [], [], []
    for argument in place.cdr or ():
        if _constant(argument):
            arguments.append(argument)
        else:
            temporary = gensym("PLACE")
            temporaries.append(temporary)
            forms.append(argument)
            arguments.append(temporary)
    store = gensym("NEW")
    setter = lisp_list(SETF, head)
    storing = lisp_list(FUNCALL, lisp_list(FUNCTION, setter), store, *arguments)
    local = environment.function(("setf", head)) if environment is not None else None
    if local is None and symbol_package(head) is COMMON_LISP and isinstance(head, Symbol):
        storing = lisp_list(PROGN, storing, store)
    return temporaries, forms, [store], storing, Cons(head, list_from(arguments))


def _constant(form):
    if isinstance(form, Cons):
        return form.car in (sym("QUOTE"), FUNCTION)
    return not isinstance(form, Symbol) or isinstance(form, Keyword)


def _let(bindings, *body):
    bindings = list(bindings)
    if not bindings:
        return body[0] if len(body) == 1 else lisp_list(PROGN, *body)
    return lisp_list(LET_STAR, list_from([lisp_list(variable, form) for variable, form in bindings]), *body)


def store_form(place, value, environment):
    """The form that assigns the value of the form ``value`` to ``place``."""
    if is_symbol(place):
        expansion, expanded = macroexpand_1(place, environment)
        return store_form(expansion, value, environment) if expanded else lisp_list(SETQ, place, value)
    updater = _updater(place, environment)
    if updater is not None:  # which may be a macro, for which the forms are to stand as they are
        return Cons(updater, list_from([*place.cdr, value] if place.cdr is not None else [value]))
    temporaries, forms, stores, storing, _ = setf_expansion(place, environment)
    if len(stores) == 1:
        return _let([*zip(temporaries, forms), (stores[0], value)], storing)
    bound = lisp_list(sym("MULTIPLE-VALUE-BIND"), list_from(stores), value, storing)
    return _let(zip(temporaries, forms), bound)


def _updater(place, environment):
    """The updater of a short ``defsetf`` for ``place``, or ``None``."""
    if not isinstance(place, Cons) or not isinstance(place.car, Symbol):
        return None
    if environment is not None and environment.function(place.car) is not None:
        return None
    return getattr((place.car.compiler_data or {}).get("setf-expander"), "updater", None)


# ------------------------------------------------------------------------------------------------------------------- macros


def macro(name):
    """Enter the decorated ``(form, environment) -> form`` as the macro ``name`` of Common Lisp."""

    def define(function):
        symbol = sym(name)

        @functools.wraps(function)
        def expander(form, environment):
            try:
                return function(form, environment)
            except (TypeError, ValueError) as problem:
                return malformed(form, symbol, problem)

        symbol.macro = expander
        return function

    return define


def _pairs(form):
    parts = list(form.cdr or ())
    if len(parts) % 2:
        error(CompileError("~S takes pairs of a place and a value, but the last place of ~S has no value.", form.car, form))
    return list(zip(parts[::2], parts[1::2]))


@macro("SETF")
def _setf(form, environment):
    forms = [store_form(place, value, environment) for place, value in _pairs(form)]
    return forms[0] if len(forms) == 1 else Cons(PROGN, list_from(forms))


@macro("PSETF")
def _psetf(form, environment):
    pairs = [(setf_expansion(place, environment), value) for place, value in _pairs(form)]

    def nested(rest, setters):
        if not rest:
            return lisp_list(PROGN, *setters, None)
        (temporaries, forms, stores, setter, _), value = rest[0]
        return _let(zip(temporaries, forms), _bind_stores(stores, value, nested(rest[1:], [*setters, setter])))

    return nested(pairs, [])


def _bind_stores(stores, value, body):
    """A form that binds the store variables of a place to the value, or several to the values, of the form ``value``."""
    if len(stores) == 1:
        return _let([(stores[0], value)], body)
    return lisp_list(sym("MULTIPLE-VALUE-BIND"), list_from(stores), value, body)


@macro("PSETQ")
def _psetq(form, environment):
    return _psetf(form, environment)


@macro("SHIFTF")
def _shiftf(form, environment):
    *places, value = list(form.cdr)
    expansions = [setf_expansion(place, environment) for place in places]
    values = [getter for *_, getter in expansions[1:]] + [value]
    setters = [setter for _, _, _, setter, _ in expansions]
    results = [gensym("RESULT") for _ in expansions[0][2]]
    body = lisp_list(PROGN, *setters, results[0] if len(results) == 1 else Cons(sym("VALUES"), list_from(results)))
    for (_, _, stores, _, _), new in reversed(list(zip(expansions, values))):
        body = _bind_stores(stores, new, body)
    body = _bind_stores(results, expansions[0][4], body)
    return _let([pair for place in expansions for pair in zip(place[0], place[1])], body)


@macro("ROTATEF")
def _rotatef(form, environment):
    places = [setf_expansion(place, environment) for place in form.cdr or ()]
    if not places:
        return None
    body = lisp_list(PROGN, *[place[3] for place in places], None)
    for index in reversed(range(len(places))):
        body = _bind_stores(places[index][2], places[(index + 1) % len(places)][4], body)
    return _let([pair for place in places for pair in zip(place[0], place[1])], body)


def modify(place, environment, arguments, compute):
    """A form that stores the value of ``compute(reading form, *arguments)`` in ``place`` and returns it.

    arguments: forms. They are evaluated after the subforms of ``place`` and before it is read (ANSI 5.1.3), so that an argument that
    changes the place counts.
    """
    temporaries, forms, stores, setter, getter = setf_expansion(place, environment)
    bindings = [*zip(temporaries, forms)]
    if not all(_constant(argument) or _is_variable(argument, environment) for argument in arguments):
        values = [argument if _constant(argument) else gensym("VALUE") for argument in arguments]
        bindings += [(value, argument) for value, argument in zip(values, arguments) if value is not argument]
        arguments = values
    new = compute(getter, *arguments)
    if is_symbol(getter):
        return _let(bindings, lisp_list(SETQ, getter, new))
    return _let([*bindings, (stores[0], new)], setter)


def _is_variable(form, environment):
    return is_symbol(form) and not macroexpand_1(form, environment)[1]


def _modifier(name, operator):
    @macro(name)
    def expand(form, environment):
        place, *delta = list(form.cdr)
        return modify(place, environment, delta or [1], lambda old, delta: lisp_list(sym(operator), old, delta))

    return expand


_modifier("INCF", "+")
_modifier("DECF", "-")


@macro("PUSH")
def _push(form, environment):
    item, place = list(form.cdr)
    if _is_variable(place, environment):
        return lisp_list(SETQ, place, lisp_list(sym("CONS"), item, place))
    value = gensym("ITEM")  # evaluated before the subforms of the place
    return _let([(value, item)], modify(place, environment, [], lambda old: lisp_list(sym("CONS"), value, old)))


@macro("PUSHNEW")
def _pushnew(form, environment):
    item, place, *keys = list(form.cdr)
    value = gensym("ITEM")
    return _let([(value, item)], modify(place, environment, [], lambda old: lisp_list(sym("ADJOIN"), value, old, *keys)))


@macro("POP")
def _pop(form, environment):
    (place,) = list(form.cdr)
    temporaries, forms, stores, setter, getter = setf_expansion(place, environment)
    if is_symbol(getter):
        return lisp_list(sym("PROG1"), lisp_list(sym("CAR"), getter), lisp_list(SETQ, getter, lisp_list(sym("CDR"), getter)))
    old = gensym("LIST")
    bindings = [*zip(temporaries, forms), (old, getter), (stores[0], lisp_list(sym("CDR"), old))]
    return _let(bindings, setter, lisp_list(sym("CAR"), old))


@macro("REMF")
def _remf(form, environment):
    place, indicator = list(form.cdr)
    temporaries, forms, stores, setter, getter = setf_expansion(place, environment)
    key, found = gensym("INDICATOR"), gensym("FOUND")
    removal = lisp_list(support("REMOVE-PROPERTY"), getter, key)
    changed = lisp_list(sym("MULTIPLE-VALUE-BIND"), lisp_list(stores[0], found), removal, setter, found)
    return _let([*zip(temporaries, forms), (key, indicator)], changed)


@macro("DEFINE-MODIFY-MACRO")
def _define_modify_macro(form, environment):
    """``(define-modify-macro name lambda-list function [doc])``

    The lambda list takes the forms after the place apart; only &optional and &rest are allowed in it.
    """
    name, lambda_list, function, *text = list(form.cdr)
    quote = sym("QUOTE")
    parsed = parse(lambda_list)
    if parsed.has_keys or parsed.aux:
        return error(CompileError("&KEY is not allowed in a DEFINE-MODIFY-MACRO lambda list: ~S", lambda_list))
    variables = [*parsed.required, *(variable for variable, _, _ in parsed.optional)]
    arguments = lisp_list(sym("LAMBDA"), lambda_list, Cons(sym("LIST*"), list_from([*variables, parsed.rest])))
    return lisp_list(support("DEFINE-MODIFIER"), lisp_list(quote, name), arguments, lisp_list(quote, function), *text[:1])


def define_modifier(name, arguments, function, documentation=None):
    """What ``define-modify-macro`` does when it is run: ``arguments`` gives the list of the forms after the place."""

    def expand(form, environment):
        place, *rest = list(form.cdr)
        forms = list(one(arguments(*rest)) or ())
        return modify(place, environment, forms, lambda old, *arguments: lisp_list(function, old, *arguments))

    check_symbol(name, "defining ~S as a macro", name)
    redefined(name)
    name.macro = expand
    expand.documentation = documentation
    return name


@macro("DEFSETF")
def _defsetf(form, environment):
    """Both forms of ``defsetf``."""
    name, second, *rest = list(form.cdr)
    quote = sym("QUOTE")
    if not rest or isinstance(rest[0], str) and isinstance(second, Symbol):
        return lisp_list(support("DEFINE-SETF-FUNCTION"), lisp_list(quote, name), lisp_list(quote, second), *rest)
    stores, *body = rest
    documentation, declarations, body = body_parts(body)
    arguments = gensym("ARGUMENTS")
    values = gensym("STORES")
    bindings = destructure(second, arguments, f"the place {name.name}")
    bindings += destructure(stores, values, f"the place {name.name}")
    let = lisp_list(
        LET_STAR,
        list_from([lisp_list(variable, value) for variable, value in bindings]),
        *declarations,
        Cons(sym("BLOCK"), Cons(name, list_from(body))),
    )
    return lisp_list(
        support("DEFINE-SETF-FORM"),
        lisp_list(quote, name),
        len(list(stores or ())),
        lisp_list(sym("LAMBDA"), lisp_list(arguments, values), let),
        documentation,
    )


def _define_place(name, expander, documentation):
    check_symbol(name, "defining a setf-expander for ~S", name)
    data(name)["setf-expander"] = expander
    data(name)["setf-documentation"] = documentation
    return name


def define_setf_function(name, updater, documentation=None):
    """Short ``defsetf``: ``(setf (name a) v)`` is ``(updater a v)``."""

    def expander(place, environment):
        temporaries, forms, stores, _, getter = _function_place(place, environment)
        return temporaries, forms, stores, Cons(updater, list_from([*(getter.cdr or ()), stores[0]])), getter

    expander.updater = updater
    return _define_place(name, expander, documentation)


def define_setf_form(name, count, function, documentation=None):
    """Long ``defsetf``: ``function`` gets the argument forms and the store variables, and gives the storing form."""

    def expander(place, environment):
        temporaries, forms, _, _, getter = _function_place(place, environment)
        stores = [gensym("NEW") for _ in range(count)]
        return temporaries, forms, stores, one(function(getter.cdr, list_from(stores))), getter

    expander.source = function
    return _define_place(name, expander, documentation)


@macro("DEFINE-SETF-EXPANDER")
def _define_setf_expander(form, environment):
    name, lambda_list, *body = list(form.cdr)
    function, documentation = macro_lambda(name, lambda_list, list_from(body))
    return lisp_list(support("DEFINE-EXPANDER"), lisp_list(sym("QUOTE"), name), function, documentation)


def define_expander(name, function, documentation=None):
    """What ``define-setf-expander`` does when it is run: ``function`` returns the five values."""

    def expander(place, environment):
        temporaries, forms, stores, setter, getter = function(place, environment)
        return list(temporaries or ()), list(forms or ()), list(stores or ()), setter, getter

    expander.source = function
    return _define_place(name, expander, documentation)


def get_setf_expansion(place, environment=None):
    """``get-setf-expansion``: the five values, as Lisp lists."""
    temporaries, forms, stores, setter, getter = setf_expansion(place, checked_environment(environment))
    return MultipleValues((list_from(temporaries), list_from(forms), list_from(stores), setter, getter))


# ------------------------------------------------------------------------------------------------ places with their own rules


def place_rule(name):
    def define(function):
        data(sym(name))["setf-expander"] = function
        return function

    return define


@place_rule("THE")
def _the_place(place, environment):
    kind, inner = list(place.cdr)
    temporaries, forms, stores, setter, getter = setf_expansion(inner, environment)
    return temporaries, forms, stores, setter, lisp_list(sym("THE"), kind, getter)


@place_rule("VALUES")
def _values_place(place, environment):
    temporaries, forms, stores, setters, getters = [], [], [], [], []
    for inner in place.cdr or ():
        parts = setf_expansion(inner, environment)
        temporaries += [*parts[0], *parts[2][1:]]
        forms += [*parts[1], *[None] * len(parts[2][1:])]
        stores.append(parts[2][0])
        setters.append(parts[3])
        getters.append(parts[4])
    values = sym("VALUES")
    return temporaries, forms, stores, Cons(values, list_from(setters)), Cons(values, list_from(getters))


@place_rule("GETF")
def _getf_place(place, environment):
    inner, indicator, *default = list(place.cdr)
    temporaries, forms, stores, setter, getter = setf_expansion(inner, environment)
    key, store = gensym("INDICATOR"), gensym("NEW")
    defaults = [gensym("DEFAULT") for _ in default]
    changed = lisp_list(support("WITH-PROPERTY"), getter, key, store)
    storing = lisp_list(LET_STAR, lisp_list(lisp_list(stores[0], changed)), setter, store)
    return ([*temporaries, key, *defaults], [*forms, indicator, *default], [store], storing, lisp_list(sym("GETF"), getter, key, *defaults))


@place_rule("APPLY")
def _apply_place(place, environment):
    function, *arguments = list(place.cdr)
    if not (isinstance(function, Cons) and function.car is FUNCTION):
        return error(CompileError("SETF of APPLY needs #'NAME as the function: ~S", place))
    temporaries = [gensym("ARGUMENT") for _ in arguments]
    store = gensym("NEW")
    setter = lisp_list(FUNCTION, lisp_list(SETF, function.cdr.car))
    return (
        temporaries,
        arguments,
        [store],
        lisp_list(sym("APPLY"), setter, store, *temporaries),
        lisp_list(sym("APPLY"), function, *temporaries),
    )


@place_rule("CAR")
def _car_place(place, environment):
    return _function_place(place, environment)


def _subform_place(name, combine):
    """A place such as (ldb spec integer), whose integer is itself a place."""

    @place_rule(name)
    def expander(place, environment):
        spec, inner = list(place.cdr)
        temporaries, forms, stores, setter, getter = setf_expansion(inner, environment)
        selector, store = gensym("SPEC"), gensym("NEW")
        storing = lisp_list(LET_STAR, lisp_list(lisp_list(stores[0], lisp_list(sym(combine), store, selector, getter))), setter, store)
        return [selector, *temporaries], [spec, *forms], [store], storing, lisp_list(sym(name), selector, getter)

    return expander


_subform_place("LDB", "DPB")
_subform_place("MASK-FIELD", "DEPOSIT-FIELD")
