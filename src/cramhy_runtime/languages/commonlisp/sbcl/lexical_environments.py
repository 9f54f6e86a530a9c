"""What the library ``sb-cltl2`` asks of the compiler's lexical environments: what a name means in one, and one with more names in it.

An environment is what a macro gets behind ``&environment``, or nil for the global one. Source: CLtL2, 8.5; SBCL's manual, sb-cltl2.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Symbol, lisp_list, list_from, one, python_list
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import keyword, sym
from cramhy_runtime.kernel.typing_names import Any

from ..compiler.environment import Env, LocalFunction, LocalMacro, SpecialVariable, SymbolMacro, Variable, function_key
from ..syntax import macros
from ..syntax.macros import checked_environment
from ..evaluation.forms import SPECIAL_OPERATORS

TYPE, IGNORE = sym("TYPE"), sym("IGNORE")


def variable_information(symbol: Symbol, environment: Env | None) -> object:
    """(kind, whether the environment binds it, its declarations) of a variable, a constant or a symbol macro; nil of no such name."""
    checked_environment(environment)
    found = environment.variable(symbol) if environment is not None else None
    if isinstance(found, SymbolMacro):
        return lisp_list(keyword("SYMBOL-MACRO"), True, None)
    if isinstance(found, Variable):
        facts = [Cons(IGNORE, True)] if found.ignored else []
        facts += [Cons(TYPE, found.type)] if found.type is not None else []
        return lisp_list(keyword("LEXICAL"), True, list_from(facts))
    data = symbol.compiler_data or {}
    kind = (
        "CONSTANT"
        if symbol.constant
        else "SPECIAL"
        if found is not None or symbol.special
        else "SYMBOL-MACRO"
        if "symbol-macro" in data
        else None
    )
    facts = [Cons(TYPE, data["type"])] if "type" in data else []
    return lisp_list(kind and keyword(kind), None, list_from(facts))


def function_information(name: object, environment: Env | None) -> object:
    """(kind, whether it is bound in the environment): of a function, a macro or a special operator; nil of no such name."""
    checked_environment(environment)
    found = environment.function(function_key(name)) if environment is not None else None
    if found is not None:
        return lisp_list(keyword("MACRO" if isinstance(found, LocalMacro) else "FUNCTION"), True)
    macros.ensure_loaded()
    if isinstance(name, Symbol):
        if name in SPECIAL_OPERATORS:
            return lisp_list(keyword("SPECIAL-FORM"), None)
        if name.macro is not None:
            return lisp_list(keyword("MACRO"), None)
    return lisp_list(keyword("FUNCTION") if one(function_of(sym("FBOUNDP"))(name)) is not None else None, None)


def augmented(
    environment: Env | None, variables: Any, specials: Any, types: Any, symbol_macros: Any, functions: Any, expanders: Any
) -> Env:
    """A new environment with these names in it. types, symbol_macros, expanders: pairs of a name and its type, expansion or expander."""
    made = Env(checked_environment(environment))
    declared = {pair.car: pair.cdr for pair in python_list(types)}
    special = set(python_list(specials))
    for name in python_list(variables):
        made.variables[name] = found = SpecialVariable(name) if name in special or name.special else Variable(name, made.scope)
        if name in declared and isinstance(found, Variable):
            found.type = declared[name]
    for name in special - set(python_list(variables)):
        made.variables[name] = SpecialVariable(name)
    for pair in python_list(symbol_macros):
        made.variables[pair.car] = SymbolMacro(pair.cdr)
    for name in python_list(functions):
        made.functions[function_key(name)] = LocalFunction(Variable(sym("LOCAL-FUNCTION"), made.scope))
    for pair in python_list(expanders):
        expander = function_of(pair.cdr)
        made.functions[pair.car] = LocalMacro(lambda form, env, expander=expander: one(expander(form, env)))
    return made


def local_macros(environment: Env | None) -> object:
    """((name . expander)...) and ((name . expansion)...): the macros and symbol macros that the environment has, in a list of two."""
    checked_environment(environment)
    functions: dict[object, object] = {}
    variables: dict[object, object] = {}
    while environment is not None:
        for name, found in environment.functions.items():
            functions.setdefault(name, found)
        for name, found in environment.variables.items():
            variables.setdefault(name, found)
        environment = environment.parent
    expanders = [Cons(name, found.expander) for name, found in functions.items() if isinstance(found, LocalMacro)]
    expansions = [Cons(name, found.expansion) for name, found in variables.items() if isinstance(found, SymbolMacro)]
    return lisp_list(list_from(expanders), list_from(expansions))


__all__ = ["augmented", "checked_environment", "function_information", "local_macros", "variable_information"]
