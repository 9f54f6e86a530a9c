"""The macros that ``(require cramhy *)`` gives to plain Hy: the operators, and the functions of our packages.

An operator expands as `expansion` says. A function is called by a macro too, since only macros can be required, and so that quoted
names and keywords among its arguments are those of Lisp: ``(pm-execute 'navigation d)``. Whoever defines a function of the same name
calls that one; a variable of that name that holds no function does not stand in the way. Names may have the prefix of a package, as on
the slides: ``(cpl:par ...)``, ``(cut:force-ll ...)``.
"""

from __future__ import annotations

import builtins
import importlib
from keyword import iskeyword
from types import FunctionType

import hy
from hy import models
from hy.errors import HySyntaxError

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import UndefinedFunction
from cramhy_runtime.lisp_core.packages import find_package, registered
from ..operators import OPERATORS, operator_of
from ..operators.declaration import hy_shape
from ..operators.grammar import WrongShape
from . import calls, properties
from .call_parts import lisp_call
from .expansion import expand, expression, word
from .goal_functions import named
from .lisp_data import (
    DESIGNATORS,
    GOALS,
    NO_FUNCTOR,
    call_of,
    constant_form,
    function_form,
    insertion,
    is_backquoted,
    is_quoted,
    lisp_data,
    package_of,
    refuse_case,
    refuse_code_in_designator,
    template_form,
)
from .module_names import if_global, is_bound
from .users_names import may_be_the_users

WITHOUT_PREFIX = (
    "CRAM-LANGUAGE",
    "CRAM-DESIGNATORS",
    "CRAM-PROCESS-MODULES",
    "CRAM-EXECUTIVE",
    "CRAM-PROLOG",
    "CRAM-UTILITIES",
    "CRAM-LANGUAGE-DESIGNATOR-SUPPORT",
    "CRAM-DESIGNATOR-PROPERTIES",
    "ROSLISP",
    "ROSLISP-UTILS",
    "ROSLISP-UTILITIES",
    "CRAM-PROJECTION",
    "CRAM-OCCASIONS-EVENTS",
    "CRAM-EXECUTION-TRACE",
    "ACTIONLIB",
    "CL-TRANSFORMS",
    "CL-TF",
)
"""The packages whose names are known as they are. Where two of them have one name, the first counts."""

WITH_PREFIX = (*WITHOUT_PREFIX, "CRAM-LANGUAGE-IMPLEMENTATION", "ACTIONLIB-LISP", "CL-TRANSFORMS-STAMPED", "TURTLESIM")


def _tell_prompt(module):
    """A macro is used in ``module``. It may be at a prompt that a program has begun, where nobody requires what is there already."""
    if "_hy_repl" in vars(module):
        importlib.import_module("cramhy").attend_prompt([module])


# --------------------------------------------------------------------------------------------------------------- operators


def operator_macro(operator, body=None):
    """The Hy macro of an operator. body: the macro of bodies.hy that says what a call stands for, if there is one."""

    def macro(_hy_compiler, *arguments):
        _tell_prompt(_hy_compiler.module)
        written = _hy_compiler.this
        try:
            if operator.name in DESIGNATORS:
                refuse_code_in_designator(arguments)
                refuse_case(models.List(arguments))
                arguments = properties.in_designator(arguments)
            elif operator.name == "WITH-DESIG-PROPS" and isinstance(arguments[0], models.Sequence):
                arguments = (models.List(map(properties.key, arguments[0])), *arguments[1:])
            call, form = lisp_call(operator, arguments, package_of(_hy_compiler.module.__name__))
            if body is not None:
                return with_places(body(_hy_compiler, *arguments), written)
            return with_places(expand(_hy_compiler, operator, arguments, call, form), written)
        except WrongShape as problem:
            raise refusal(_hy_compiler, written, _malformed(operator, written, problem)) from None
        except Condition as problem:
            raise refusal(_hy_compiler, written, _with_hint(problem)) from None
        except ValueError as problem:
            raise refusal(_hy_compiler, written, str(problem)) from None

    macro.__doc__ = f"{hy_shape(operator)}\n\n{operator.documentation}"
    macro.operator = operator  # for the Tab key
    return macro


def with_places(model, call):
    """``model``, the expansion of ``call``, whose functions have the place of the name that is called.

    By default Hy gives all of an expansion the place of the call. Python says of a call of an attribute that it happens where the
    attribute's name stands, at the end of its place: an error would be shown in the last line of a call that has several.
    """
    if getattr(call, "start_line", 1) == getattr(call, "end_line", 1) or not isinstance(call, models.Expression):
        return model
    return _with_places(model, call[0])


def _with_places(model, name):
    if not isinstance(model, models.Sequence) or hasattr(model, "_start_line"):
        return model
    parts = [_with_places(part, name) for part in model]
    if isinstance(model, models.Expression) and parts and isinstance(parts[0], models.Expression):
        parts[0] = parts[0].replace(name)
    return type(model)(parts) if type(model) in (models.Expression, models.List, models.Tuple) else model


def refusal(compiler, call, text):
    """The error of syntax that a call is written wrongly, with the place of the call also where Hy does not know the source."""
    problem = HySyntaxError(text, call, compiler.filename, compiler.source)
    problem.lineno, problem.offset = getattr(call, "start_line", 1), getattr(call, "start_column", 1)
    return problem


def _malformed(operator, call, problem):
    return f"The form {hy.repr(call).removeprefix(chr(39))} is malformed: {problem}\nIt is written {hy_shape(operator)}."


def _with_hint(problem):
    hint = getattr(problem, "hint", None)
    return f"{problem}\n{hint}" if hint else str(problem)


# --------------------------------------------------------------------------------------------------------------- functions


def function_macro(symbol, name=None):
    """The Hy macro that calls the function of a symbol. name: the Hy name that a function of the user's may have as well, if any."""
    package, lisp_name = symbol.package.name, symbol.name

    def macro(_hy_compiler, *arguments):
        _tell_prompt(_hy_compiler.module)
        here, names = package_of(_hy_compiler.module.__name__), {}
        if lisp_name in GOALS and arguments and (is_quoted(arguments[0]) or is_backquoted(arguments[0])):
            arguments = (models.Expression([arguments[0][0], named(arguments[0][1], names)]), *arguments[1:])
        local = name is not None and is_bound(_hy_compiler, mangle(name))  # of the operator around: it takes keywords as objects
        try:
            arguments = properties.in_call(lisp_name, arguments)
            made = lisp_arguments(symbol.function, arguments, here, NO_FUNCTOR if lisp_name in GOALS else None, all_objects=local)
        except (ValueError, Condition) as problem:
            raise refusal(_hy_compiler, _hy_compiler.this, str(problem)) from None
        if lisp_name in GOALS and made:
            made[0] = insertion("in-goal", made[0], here, NO_FUNCTOR) if made[0] is arguments[0] else asked(made[0], names, here)
        elif lisp_name == "VAR-VALUE" and made and made[0] is arguments[0]:
            made[0] = insertion("inserted", made[0], here)
        theirs = local or name is not None and may_be_the_users(name, _hy_compiler)
        function = function_form(package, lisp_name)
        if any(map(_is_keyword, made)) and not calls.takes_keywords(symbol.function):
            if theirs or any(map(_is_mapping, made)):
                function = expression(call_of("function"), models.String(package), models.String(lisp_name))
            else:
                made = _with_keyword_objects(made, here)
        called = expression(_users_or(function, name, _hy_compiler) if theirs else function, *made)
        return with_places(called, _hy_compiler.this)

    macro.symbol = symbol  # for the Tab key
    return macro


def _users_or(function, name, compiler):
    """A form for the function that ``name`` means in the user's code, or else that of the form ``function``."""
    there = if_global(compiler, mangle(name))
    if there is not None:
        return expression(word("if"), there, expression(call_of("users-or-ours"), word(name), function), function)
    users = expression(word("try"), word(name), expression(word("except"), models.List([word("NameError")]), word("None")))
    return expression(call_of("users-or-ours"), users, function)


def _is_keyword(model):
    return isinstance(model, models.Keyword) or _is_mapping(model)


def _is_mapping(model):
    return isinstance(model, models.Expression) and model[:1] == (word("unpack-mapping"),)


def _with_keyword_objects(arguments, package):
    """Arguments for a function that takes keywords as Lisp passes them, behind the others."""
    others, keywords, rest = [], [], list(arguments)
    while rest:
        argument = rest.pop(0)
        if isinstance(argument, models.Keyword):
            keywords += [constant_form(lisp_data(argument, package)), rest.pop(0)]
        else:
            others.append(argument)
    return others + keywords


def lisp_arguments(function, arguments, package, functor=None, all_objects=False):
    """Hy models for the arguments of a function of ours: quoted data is Lisp's, a keyword in the place of a parameter is an object.

    functor: as of `template_form`, for the functions of goals. all_objects: whether each keyword is an object.
    """
    positional = len(arguments) if all_objects else _positional(function)
    made, position, rest = [], 0, list(arguments)
    while rest:
        argument = rest.pop(0)
        if isinstance(argument, models.Keyword):
            if position >= positional and rest:
                made += [argument, _argument(rest.pop(0), package, functor)]
                continue
        made.append(_argument(argument, package, functor))
        position += 1
    return made


def _argument(model, package, functor=None):
    """An argument that is an object of Lisp as it stands, a quoted name or a keyword, as a constant; any other as it is."""
    if is_quoted(model) or is_backquoted(model):
        refuse_case(model[1])
    if is_quoted(model):
        return constant_form(lisp_data(model[1], package))
    if is_backquoted(model):
        return template_form(model[1], package, functor)
    return constant_form(lisp_data(model, package)) if isinstance(model, models.Keyword) else model


def asked(form, names, package):
    """``form``, which makes a goal, with the functions of Hy that ``lisp-fun`` calls in it: ``names``, as `named` has found them."""
    for symbol, function in names.items():
        meant = expression(word("fn"), models.List(), function)
        form = expression(call_of("asking"), form, constant_form(lisp_data(symbol, package)), meant)
    return form


def _positional(function):
    """The number of positional parameters of a function of ours; a keyword in their place is an object."""
    function = getattr(function, "python", function)
    function = getattr(function, "traced", function)
    code = getattr(function, "__code__", None)
    if code is not None:
        method = 1 if not isinstance(function, FunctionType) and hasattr(function, "__self__") else 0
        return code.co_argcount - method
    shape = getattr(function, "shape", None)
    if shape is not None and hasattr(shape, "required"):
        return shape.required
    return 0


# ----------------------------------------------------------------------------------------------------------------- the table


def mangle(name):
    """As ``hy.mangle``, at once for names of letters and hyphens, of which there are thousands."""
    prefix, colon, short = name.rpartition(":")
    if name.replace("-", "").replace(":", "").isalnum() and name[0].isalpha() and name.isascii():
        return f"hyx_{prefix}XcolonX{short}".replace("-", "_").replace(":", "XcolonX") if colon else name.replace("-", "_")
    return hy.mangle(name)


def macros():
    """Mangled name → macro, of all operators and functions."""
    core = builtins._hy_macros
    found = {}
    bodies = importlib.import_module("cramhy.bodies")._hy_macros
    made = {operator: operator_macro(operator, bodies.get(mangle(operator.name.lower()))) for operator in OPERATORS.values()}
    found.update((name, macro) for name, macro in bodies.items() if not name.startswith("_"))
    for name in WITHOUT_PREFIX:
        for short, symbol in _functions(name):
            mangled = mangle(short)
            if mangled not in core and mangled not in found:
                found[mangled] = function_macro(symbol, short)
    for name in WITH_PREFIX:
        package = find_package(name)
        if package is None:
            continue
        prefixes = [each.lower() for each in package.names]
        for short, symbol in _functions(name):
            macro = function_macro(symbol)
            for prefix in prefixes:
                found[mangle(f"{prefix}:{short}")] = found[mangle(f"{prefix}::{short}")] = macro
        for symbol in (*package.external.values(), *package.internal.values()):
            macro = made.get(operator_of(symbol))
            if macro is not None:
                for prefix in prefixes:
                    found[mangle(f"{prefix}::{symbol.name.lower()}")] = macro
                    if symbol.name in package.external:
                        found[mangle(f"{prefix}:{symbol.name.lower()}")] = macro
    for operator, macro in made.items():
        mangled = mangle(operator.name.lower())
        if mangled not in core:
            found[mangled] = _beside_builtin(mangled, macro) if hasattr(builtins, mangled) else macro
    return found


def _beside_builtin(name, operator):
    """The macro of an operator that has the name of a function of Python, which takes one argument: ``all``."""

    def macro(_hy_compiler, *arguments):
        if len(arguments) == 1:
            python = models.Expression(map(models.Symbol, (".", "hy", "I", "builtins", name)))
            return expression(python, *arguments)
        return operator(_hy_compiler, *arguments)

    macro.__doc__, macro.operator = operator.__doc__, operator.operator
    return macro


def functions():
    """Mangled name → function, of the functions of our packages: what ``(import cramhy *)`` gives, for ``map`` and the like.

    Packages that are made on demand, such as ACTIONLIB and CL-TF, are not among them: Lisp's own start imports ``cramhy``, too.
    """
    found = {}
    for name in filter(registered, WITHOUT_PREFIX):
        for short, symbol in _functions(name):
            mangled = mangle(short)
            if mangled not in found and not hasattr(builtins, mangled) and not iskeyword(mangled):
                found[mangled] = _OF_PYTHON.get(mangled) or calls.function(symbol.package.name, symbol.name)
    return found


_OF_PYTHON = {"get_param": calls.get_param, "set_param": calls.set_param, "has_param": calls.has_param}
"""Functions that are called with values of Python and answer with them, as the macros of their names do."""


def _functions(package_name):
    """(name in Hy, symbol) of the functions that a package exports and that are not Common Lisp's."""
    package = find_package(package_name)
    if package is None:
        return
    for name, symbol in package.external.items():
        function = getattr(symbol, "function", None)
        if function is None or isinstance(function, UndefinedFunction) or symbol.macro is not None:
            continue
        if symbol.package is not None and symbol.package.name != "COMMON-LISP":
            yield name.lower(), symbol
