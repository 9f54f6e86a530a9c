"""UIOP's macros. Each becomes a call of a function with the body as a function (UIOP's manual)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import keyword, sym, symbol_name
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from ..sbcl.atomics import stored
from ..syntax.lambda_lists import gensym

if TYPE_CHECKING:
    from collections.abc import Callable

LAMBDA, PROGN, LET, FUNCTION = sym("LAMBDA"), sym("PROGN"), sym("LET"), sym("FUNCTION")


def _function(variables: Any, body: Any) -> Any:
    return Cons(LAMBDA, Cons(list_from(list(variables)), list_from(list(body))))


def _let(bindings: Any, body: Any) -> Any:
    return Cons(LET, Cons(list_from(list(bindings)), list_from(list(body))))


def _quoted(thing: Any) -> Any:
    return lisp_list(sym("QUOTE"), thing)


def _call(name: str, *forms: Any) -> Any:
    return lisp_list(sym(f"UIOP::{name}"), *forms)


def _if_let(environment: Any, bindings: Any, *branches: Any) -> Any:
    pairs = [bindings] if isinstance(bindings, Cons) and isinstance(bindings.car, Symbol) else list(bindings or ())
    test = Cons(sym("AND"), list_from([pair.car for pair in pairs]))
    return _let(pairs, [lisp_list(sym("IF"), test, *branches)])


def _nest(environment: Any, *things: Any) -> Any:
    *outer, inner = things
    for form in reversed(outer):
        inner = list_from([*form, inner])
    return inner


def _while_collecting(environment: Any, collectors: Any, *body: Any) -> Any:
    names = list(collectors or ())
    lists = [gensym(symbol_name(name)) for name in names]
    argument = gensym("ITEM")
    functions = [
        lisp_list(name, lisp_list(argument), lisp_list(sym("PUSH"), argument, where), argument) for name, where in zip(names, lists)
    ]
    results = Cons(sym("VALUES"), list_from([lisp_list(sym("REVERSE"), where) for where in lists]))
    return _let(
        [lisp_list(where, None) for where in lists], [Cons(sym("FLET"), Cons(list_from(functions), list_from(list(body)))), results]
    )


def _modifying(operator: str) -> Callable[..., Any]:
    def expand(environment: Any, place: Any, *arguments: Any) -> Any:
        return stored(place, environment, lambda old: lisp_list(sym(operator), old, *arguments), gives_old=False)

    return expand


def _around(name: str, default: bool = False) -> Callable[..., Any]:
    """A macro ``((variable argument ...) form ...)``: a call with a function of the variable. default: the argument may be missing."""

    def expand(environment: Any, head: Any, *body: Any) -> Any:
        variable, *arguments = list(head)
        if default and not arguments:
            arguments = [variable]
        first, rest = arguments[:1], arguments[1:]
        return _call(name, *first, _function([variable], body), *rest)

    return expand


def _around_nothing(name: str) -> Callable[..., Any]:
    """A macro ``((argument ...) form ...)``: a call with a function of nothing first."""

    def expand(environment: Any, arguments: Any, *body: Any) -> Any:
        return _call(name, _function([], body), *(arguments or ()))

    return expand


def _current_directory(environment: Any, arguments: Any, *body: Any) -> Any:
    return _call("CALL-WITH-CURRENT-DIRECTORY", *(arguments or (None,)), _function([], body))


def _null(name: str) -> Callable[..., Any]:
    def expand(environment: Any, head: Any, *body: Any) -> Any:
        variable, *options = list(head)
        return _call(name, _function([variable], body), *options)

    return expand


def _temporary_file(environment: Any, options: Any, *body: Any) -> Any:
    words = list(options or ())
    table = {symbol_name(name): value for name, value in zip(words[::2], words[1::2])}
    stream, path = table.pop("STREAM", None), table.pop("PATHNAME", None)
    variables = [variable for variable in (stream, path) if variable is not None]
    forms = list(body)
    closing = next((index for index, form in enumerate(forms) if isinstance(form, Keyword) and form.name == "CLOSE-STREAM"), None)
    before, after = (forms, None) if closing is None else (forms[:closing], forms[closing + 1 :])
    arguments = [item for name, value in table.items() for item in (keyword(name), value)]
    wants = [keyword("WANT-STREAM-P"), True if stream is not None else None, keyword("WANT-PATHNAME-P"), True if path is not None else None]
    if after is not None:
        variable = path if path is not None else gensym("PATHNAME")
        ignored = lisp_list(sym("DECLARE"), lisp_list(sym("IGNORABLE"), variable))
        arguments += [keyword("AFTER"), _function([variable], [ignored, *after])]
    return _call("CALL-WITH-TEMPORARY-FILE", _function(variables, before), *wants, *arguments)


def _muffled(name: str) -> Callable[..., Any]:
    def expand(environment: Any, conditions: Any, *body: Any) -> Any:
        return _call("CALL-WITH-MUFFLED-CONDITIONS", _function([], body), *(conditions if name == "" and conditions else (sym(name),)))

    return expand


def _body_alone(environment: Any, arguments: Any, *body: Any) -> Any:
    return Cons(PROGN, list_from(list(body)))


def _pathname_defaults(environment: Any, defaults: Any, *body: Any) -> Any:
    value = defaults.car if isinstance(defaults, Cons) else _call("*NIL-PATHNAME*").car
    return _let([lisp_list(sym("*DEFAULT-PATHNAME-DEFAULTS*"), value)], body)


def _enough_pathname(environment: Any, head: Any, *body: Any) -> Any:
    variable, *words = list(head)
    table = {symbol_name(name): value for name, value in zip(words[::2], words[1::2])}
    return _call(
        "CALL-WITH-ENOUGH-PATHNAME",
        table.get("PATHNAME", variable),
        table.get("DEFAULTS", sym("*DEFAULT-PATHNAME-DEFAULTS*")),
        _function([variable], body),
    )


def _staging(environment: Any, head: Any, *body: Any) -> Any:
    variable, *given = list(head)
    return _call("CALL-WITH-STAGING-PATHNAME", *(given or [variable]), _function([variable], body))


def _define_package(environment: Any, name: Any, *options: Any) -> Any:
    defined = lisp_list(sym("UIOP::PACKAGE-DEFINED"), _quoted(name), _quoted(list_from(list(options))))
    return lisp_list(sym("EVAL-WHEN"), lisp_list(keyword("COMPILE-TOPLEVEL"), keyword("LOAD-TOPLEVEL"), keyword("EXECUTE")), defined)


def _renamed(operator: str) -> Callable[..., Any]:
    def expand(environment: Any, *forms: Any) -> Any:
        return Cons(sym(operator), list_from(list(forms)))

    return expand


MACROS = {
    "IF-LET": _if_let,
    "NEST": _nest,
    "WHILE-COLLECTING": _while_collecting,
    "APPENDF": _modifying("APPEND"),
    "LATEST-TIMESTAMP-F": _modifying("UIOP::LATEST-TIMESTAMP"),
    "OS-COND": _renamed("COND"),
    "COMPATFMT": _renamed("IDENTITY"),
    "WITH-OUTPUT": _around("CALL-WITH-OUTPUT", default=True),
    "WITH-INPUT": _around("CALL-WITH-INPUT", default=True),
    "WITH-OUTPUT-FILE": _around("CALL-WITH-OUTPUT-FILE"),
    "WITH-INPUT-FILE": _around("CALL-WITH-INPUT-FILE"),
    "WITH-NULL-OUTPUT": _null("CALL-WITH-NULL-OUTPUT"),
    "WITH-NULL-INPUT": _null("CALL-WITH-NULL-INPUT"),
    "WITH-TEMPORARY-FILE": _temporary_file,
    "WITH-STAGING-PATHNAME": _staging,
    "WITH-CURRENT-DIRECTORY": _current_directory,
    "WITH-SAFE-IO-SYNTAX": _around_nothing("CALL-WITH-SAFE-IO-SYNTAX"),
    "WITH-MUFFLED-CONDITIONS": _muffled(""),
    "WITH-MUFFLED-COMPILER-CONDITIONS": _muffled("UIOP::*UNINTERESTING-COMPILER-CONDITIONS*"),
    "WITH-MUFFLED-LOADER-CONDITIONS": _muffled("UIOP::*UNINTERESTING-LOADER-CONDITIONS*"),
    "WITH-FATAL-CONDITION-HANDLER": _body_alone,
    "WITH-OPTIMIZATION-SETTINGS": _body_alone,
    "WITH-SAVED-DEFERRED-WARNINGS": _body_alone,
    "WITH-UPGRADABILITY": _body_alone,
    "WITH-DEPRECATION": _body_alone,
    "WITH-PATHNAME-DEFAULTS": _pathname_defaults,
    "WITH-ENOUGH-PATHNAME": _enough_pathname,
    "DEFINE-PACKAGE": _define_package,
    "UIOP-DEBUG": lambda environment, *forms: None,
}
