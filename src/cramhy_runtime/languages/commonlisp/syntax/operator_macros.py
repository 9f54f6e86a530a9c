"""The macros of operators: by the template of their declaration, or by an expander written in Hy.

The standard macros and those of the plan language for which a template is not enough are written in Hy, in ``hy_src/cramhy``, with Hy's
quasiquote; `define_operator` enters them here. What they return is made of Hy models and of the forms that they were given; `hy_models`
turns it into Lisp data. So a macro is written once and serves ``.lisp`` files, the REPL and ``.hy`` files.
"""

from __future__ import annotations


from cramhy_runtime.lisp_core.conditions import CompileError, Condition, error
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.packages import COMMON_LISP, find_package, find_package_or_error, keyword, sym
from ...operators import TABLES, operator_of
from ...operators.grammar import UnknownOption, WrongShape, fill, match
from .macro_shapes import EXAMPLES, SHAPES
from .macro_symbols import symbol_in


def export(table):
    """Export the operators of ``table`` from their packages, as far as these are there."""
    for operator in table.values():
        home = find_package(operator.package)
        if home is not None:
            home.export(home.intern(operator.name))


def define_all():
    """Define the macros of all packages that are there."""
    for table in TABLES:
        if find_package(table.package) is not None:
            define(table)


def define(table):
    """Define those macros of ``table`` that have a template."""
    for operator in table.values():
        if operator.expansion is not None:
            symbol = find_package_or_error(operator.package).intern(operator.name)
            symbol.macro = _expander(operator, symbol)


def _expander(operator, symbol):
    home = symbol.package

    def word(text):
        if text.isdigit():
            return int(text)
        return keyword(text[1:].upper()) if text.startswith(":") else symbol_in(text, home)

    def expander(form, environment):
        try:
            return fill(operator.template, match(operator.pattern, form.cdr), word)
        except UnknownOption as problem:
            known = list_from([sym(":" + name) for name in problem.known])
            return error(CompileError("~A has no option ~S: it has ~{~S~^, ~}.", operator.name, problem.key, known))
        except WrongShape as problem:
            return malformed(form, symbol, problem)

    return describe_macro(expander, operator)


def define_operator(package, name, function):
    """Enter a macro written in Hy: ``function`` gets the forms of the call as Python arguments, returns models or forms.

    package: the Lisp package in which unqualified symbols of the expansion are read, and that of the macro unless ``name`` says
    ``package::name``. A function with a keyword parameter ``environment`` gets the lexical environment of the call too.
    """
    home = find_package_or_error(package)
    owner, _, short = name.upper().rpartition("::")
    owner = find_package_or_error(owner) if owner else home
    symbol = owner.intern(short)
    looks_around = "environment" in function.__code__.co_varnames[: function.__code__.co_argcount + function.__code__.co_kwonlyargcount]

    def expander(form, environment):
        try:
            expansion = function(*(form.cdr or ()), **({"environment": environment} if looks_around else {}))
        except Condition:
            raise
        except (TypeError, ValueError, AttributeError, IndexError) as problem:
            return malformed(form, symbol, problem)
        from .hy_models import from_hy  # a program that was compiled before needs no Hy

        return from_hy(expansion, home, form)

    symbol.macro, expander.source = describe_macro(expander, operator_of(symbol)), function
    if short not in owner.external:
        owner.export(symbol)
    return symbol


def describe_macro(expander, operator):
    """Let ``expander`` say what its ``operator`` is for, if it is declared as one; returns it."""
    if operator is not None:
        expander.documentation = operator.documentation
    return expander


def malformed(form, symbol, problem):
    """Signal that a call of the macro ``symbol`` has not the shape that it must have."""
    why = str(problem)
    for marker in ("positional argument", "unpack", "iterable", "takes", "missing", "has no attribute", "out of range"):
        if marker in why:
            why = "it has the wrong number of parts, or a part is not a list."
            break
    operator = operator_of(symbol)
    shape = SHAPES.get(symbol.name) if symbol.package is COMMON_LISP else operator and operator.shape
    example = f", for example {EXAMPLES[symbol.name]}" if symbol.package is COMMON_LISP and symbol.name in EXAMPLES else "."
    hint = None if shape is None else f"It is written {shape}{example}"
    return error(CompileError("The ~A form ~S is malformed: ~A", symbol, form, why), hint=hint)
