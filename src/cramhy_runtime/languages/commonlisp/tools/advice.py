"""What a condition is shown as, and what to try: a hint for a condition, written for a student (law 7).

A condition may bring its own (``hint``), a text or a function that gives it. For names that mean nothing here the near ones are
looked up: a variable whose stars were forgotten, a function of another package, a typing mistake.
"""

from __future__ import annotations

from contextlib import contextmanager
from itertools import islice

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.conditions import SimpleStyleWarning, guarded, types
from cramhy_runtime.lisp_core.printing import shown
from cramhy_runtime.lisp_core.data import Symbol, UNBOUND, UndefinedFunction, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.source_places import describe, describe_frame, excerpt, locate
from ..printer.clos_printing import specializer_names
from cramhy_runtime.lisp_core.dispatch.generic_errors import NoApplicableMethodError
from cramhy_runtime.ros.definition_files import why_no_lisp_package
from cramhy_runtime.lisp_core.packages import Package, all_packages, is_symbol, near_names, sym, symbol_name
from cramhy_runtime.lisp_core.ports import PORTS
from ..evaluation.forms import special_operator_p
from ..printer import pprint_dispatch
from ..printer.print_controls import PACKAGE
from ..printer.printer import princ_to_string
from ..streams.streams import ERROR_OUTPUT, output_stream
from .call_advice import glued, of_head, of_lambda_list
from .fluent_advice import fluent_advice
from .operators_around import names_before, undefined_operator
from .words_of_hy import hint_for_operator, hint_for_variable

CONDITION = sym("CONDITION")

COMPILATION_UNIT = sym("CRAMHY::*COMPILATION-UNIT*")
SHOWN_PLACES = 3
"""So many further places of the same thing are named."""
WRONG_PACKAGE = 4
"""So many unknown functions that other packages have are one mistake."""
OF_TOOLS = ("SB-", "ASDF", "UIOP")
"""How packages begin whose names are seldom meant: ``exe:perform`` is, and ``asdf:perform`` is not."""
SHOWN_METHODS = 4
"""A generic function with more methods than these does not list them."""


def report_text(condition):
    """The text of ``condition``, with messages and other long objects in their short form, as SBCL's debugger shows them."""
    with binding(pprint_dispatch.PRINT_PPRINT_DISPATCH, pprint_dispatch.INITIAL):
        if type(condition).report is Condition.report:  # without a :report, a method of print-object may tell what happened
            return shown(condition, lambda: princ_to_string(condition))
        return str(condition)


def explanation(condition):
    """What, where, why and what to try: the lines that describe ``condition``."""
    lines = [f"  {line}" for line in report_text(condition).splitlines() or [""]]
    position = getattr(condition, "position", None)
    if position:
        lines.append(f"  at {describe(position)}")
    shown = getattr(condition, "excerpt", None) or excerpt(position)
    if shown.strip(" ^\n"):
        lines += [f"  {line}" for line in shown.splitlines()]
    also = getattr(condition, "also", None)
    if also:
        more = len(also) - SHOWN_PLACES
        lines.append(f"  also at {', '.join(map(describe, also[:SHOWN_PLACES]))}{f' and {more} more' if more > 0 else ''}")
    lines += _expansion(condition, position)
    with binding(PACKAGE, getattr(condition, "read_in", None) or PACKAGE.value):  # a file was in a package of its own when it failed
        hint = hint_for(condition)
    if hint:
        lines += [f"  {line}" for line in hint.splitlines()]
    return "\n".join(lines)


class LispReporter(kernel.reports.PlainReporter):
    """Describes to the kernel's user what happens in a Lisp text by its place in that text."""

    def describe_frame(self, frame):
        return describe_frame(frame)

    def unhandled(self, task, exception):
        """Tell of an error that ended ``task`` when nobody waited for it, on ``*error-output*``.

        One that no Lisp text has to do with is told as Python does.
        """
        condition = from_python(exception)
        locate(condition, exception)
        if getattr(condition, "position", None) is None:
            super().unhandled(task, exception)
            return
        output = output_stream(ERROR_OUTPUT.value)
        output.fresh_line()
        output.write(f"An error ended {task.name}, and nobody waited for it:\n{explanation(condition)}\n")
        output.flush()


@contextmanager
def typed_meanwhile():
    """In the body nothing is being compiled: what is typed in a debugger is no part of the form in which the debugger was opened."""
    with binding(COMPILATION_UNIT, None):
        yield


def _expansion(condition, position):
    """The macro call in whose expansion the condition arose, when that is not its own place."""
    unit = COMPILATION_UNIT.value
    entry = getattr(condition, "expanding", None) or (unit.expansions[-1] if unit is not None and unit.expansions else None)
    place = entry and entry[1]
    if not place or not position or tuple(place[:2]) == tuple(position[:2]):
        return []
    return [f"  in the expansion of the macro call at {describe(place)}", *(f"  {line}" for line in excerpt(place).splitlines())]


def hint_for(condition):
    """The circumstances, advice, and what else went wrong, a line each, or ``None``."""
    advice = guarded(lambda: _advice(condition), lambda problem: f"What to try could not be told: {' '.join(report_text(problem).split())}")
    return "\n".join(filter(None, [*(getattr(condition, "circumstances", None) or ()), advice, *_beside(condition)])) or None


def _beside(condition):
    """The other failures that ``condition`` brings along: its ``beside``, pairs of words and a condition."""
    others = getattr(condition, "beside", ())
    for words, other in others[:SHOWN_PLACES]:
        text = " ".join(report_text(other).split())
        place = describe(getattr(other, "position", None))
        yield f"{words}: {text}{'' if text.endswith('.') else '.'}" + (f" (at {place})" if place else "")
    if len(others) > SHOWN_PLACES:
        yield f"and {len(others) - SHOWN_PLACES} more failures"


def _advice(condition):
    own = getattr(condition, "hint", None)
    if callable(own):  # what takes time is found out only when it is told
        own = own()
    if own:
        return own
    called = getattr(condition, "called", None)
    if called is not None:
        return of_head(called, getattr(condition, "position", None))
    if forgotten := of_lambda_list(getattr(condition, "lambda_list", None)):
        return forgotten
    name = getattr(condition, "name", None)
    undefined = getattr(condition, "undefined", None)
    if isinstance(name, Symbol):
        if undefined == "variable" or isinstance(condition, types.UnboundVariable):
            operator = undefined_operator(getattr(condition, "position", None))
            if operator is not None:
                called = operator.name.lower()
                taken = f"Nobody has defined {called} here, so ({called} ...) is taken for a call, whose arguments are evaluated."
                return "\n".join(filter(None, [taken, _function(operator)]))
            return _variable(name, getattr(condition, "position", None))
        if undefined == "function" or isinstance(condition, types.UndefinedFunction):
            return _function(name)
        if undefined == "type":
            return _class(name, object)
    if isinstance(condition, types.SimpleTypeError) and condition.expected_type is CONDITION and is_symbol(condition.datum):
        return _class(condition.datum, types.Condition)
    if isinstance(condition, NoApplicableMethodError):
        return _methods(condition.generic_function)
    if isinstance(condition, types.PackageDoesNotExist):
        missing = str(symbol_name(condition.package) if isinstance(condition.package, Symbol) else condition.package)
        near = near_names(missing, [name for package in all_packages() for name in package.names])
        if near:
            return f"Did you mean {' or '.join(near)}?"
        return why_no_lisp_package(missing) or "Is the system that defines it loaded?"
    return fluent_advice(condition)


def _methods(function):
    """What the generic ``function`` has methods for, if these are few, such as ``(TASK) and (FLUENT T)``."""
    methods = getattr(function, "methods", None)
    if not isinstance(methods, list) or not 0 < len(methods) <= SHOWN_METHODS:
        return None
    named = [princ_to_string(specializer_names(method)) for method in methods]
    return f"Methods are defined for {' and '.join(dict.fromkeys(named))}."


def _visible(test):
    package = PACKAGE.value
    for source in [package.internal, package.external, *(other.external for other in package.use)]:
        for name, symbol in source.items():
            if isinstance(symbol, Symbol) and test(symbol):
                yield name


def _variable(symbol, position=None):
    if of_hy := hint_for_variable(symbol.name):
        return of_hy
    starred = f"*{symbol.name}*"
    variables = set(_visible(lambda other: other.value is not UNBOUND and other.special))
    if starred in variables:
        return f"There is a variable {starred}, with stars."
    if is_operator(symbol) or special_operator_p(symbol):
        kind = "a special operator" if special_operator_p(symbol) else "a macro" if symbol.macro is not None else "a function"
        here = PACKAGE.value.lookup(symbol.name)[0] is symbol or symbol.package is None
        written = symbol.name.lower() if here else f"{min(symbol.package.names, key=len)}:{symbol.name}".lower()
        return f"{symbol.name} is {kind}, no variable: a call of it is ({written} ...), in parentheses of its own."
    of_designator = symbol.name.startswith("?")
    near = near_names(symbol.name, variables if of_designator else variables | _parameters_before(position))
    if near:
        return f"Did you mean {' or '.join(near)}?"
    if of_designator:
        return f"A variable in a designator must be bound around it: (let (({symbol.name.lower()} ...)) ...)."
    return None


def _parameters_before(position):
    """The names before ``position`` in its form that may be parameters or variables of it."""
    package = PACKAGE.value
    found = ((name, package.lookup(name)[0]) for name in (names_before(position) if position else ()))
    return {name for name, symbol in found if isinstance(symbol, Symbol) and not is_operator(symbol)}


def _function(symbol):
    if symbol.compiler_data and "advice" in symbol.compiler_data:  # a name that its package explains itself
        return symbol.compiler_data["advice"]
    if of_hy := hint_for_operator(symbol.name):
        return of_hy

    other = elsewhere(symbol)
    if other is not None:
        return f"There is {_qualified(other)} in another package."
    if missing_space := glued(symbol.name):
        return missing_space
    home = users_package_with(symbol.name)
    if home is not None:
        name = min(home.names, key=len).lower()
        return f"There is one in the package {home.name}: (in-package :{name}) goes there; from here it is {name}::{symbol.name.lower()}."
    near = near_names(symbol.name, set(_visible(is_operator)))
    return f"Did you mean {' or '.join(near)}?" if near else None


def _class(symbol, root):
    """Which classes below ``root``, or types, have a name like that of ``symbol``, here or exported by another package."""

    def fits(other):
        if other is symbol:  # a class that others have named, and nobody has defined
            return False
        cls = PORTS.classes.find(other, False)
        return isinstance(cls, type) and issubclass(cls, root) or root is object and PORTS.types.known(other)

    def near_and_fits(other):  # whether a name is near is soon known; for what is no class, all classes are looked at
        return near_names(symbol.name, [other.name]) and fits(other)

    near = near_names(symbol.name, set(_visible(near_and_fits)))
    if near:
        return f"Did you mean {' or '.join(near)}?"
    others = {}
    for package in all_packages():
        for name, other in package.external.items():
            if isinstance(other, Symbol) and name not in others and near_names(symbol.name, [name]) and fits(other):
                others[name] = other
    near = near_names(symbol.name, others)
    return f"Did you mean {' or '.join(_qualified(others[name]) for name in near)}?" if near else None


def is_operator(symbol):
    """Whether ``symbol`` names a function or a macro."""
    return not isinstance(symbol.function, UndefinedFunction) or symbol.macro is not None


def elsewhere(symbol):
    """The operator of the same name that another package exports to users, or ``None``. Packages of tools, such as ASDF, come last."""
    last = None
    for package in all_packages():
        other = package.external.get(symbol.name)
        if isinstance(other, Symbol) and other is not symbol and is_operator(other) and package.name != "CRAMHY":
            if not package.name.startswith(OF_TOOLS):
                return other
            last = last or other
    return last


def users_package_with(name: str) -> Package | None:
    """A package of the user's that has an operator of that name and does not export it, or ``None``."""
    for package in all_packages():
        other = None if package.built_in else package.internal.get(name)
        if isinstance(other, Symbol) and other.package is package and is_operator(other):
            return package
    return None


def _qualified(symbol):
    """``symbol`` with the shortest prefix that can be written."""
    names = [name for package in all_packages() if package.external.get(symbol.name) is symbol for name in package.names]
    return f"{min(names, key=len).lower()}:{symbol.name.lower()}"


def _in_wrong_package(conditions):
    """``conditions``, where several unknown functions that other packages have are one: the text is in the wrong package."""
    strangers = {
        condition: other
        for condition in conditions
        if getattr(condition, "undefined", None) == "function"
        and isinstance(condition.name, Symbol)
        and not (condition.name.compiler_data and "advice" in condition.name.compiler_data)
        and (other := elsewhere(condition.name)) is not None
    }
    if len(strangers) < WRONG_PACKAGE:
        return conditions
    first = next(iter(strangers))
    names = list_from([condition.name.name for condition in strangers])
    whole = SimpleStyleWarning("undefined functions in the package ~A:~%~{~A~^, ~}", first.package.name, names)
    whole.position, whole.package = first.position, first.package
    known = [_qualified(other) for other in islice(strangers.values(), SHOWN_PLACES)]
    whole.hint = f"Other packages have them: {', '.join(known)} ... Is the form (in-package ...) missing above them?"
    return [whole if condition is first else condition for condition in conditions if condition is first or condition not in strangers]


def show_warnings(conditions):
    """Print warnings of the compiler to ``*error-output*``: as comments, with the place in the text."""
    stream = output_stream(ERROR_OUTPUT.value)
    for condition in _in_wrong_package(conditions):
        kind = "STYLE-WARNING" if isinstance(condition, SimpleStyleWarning) else "WARNING"
        stream.fresh_line()
        with binding(PACKAGE, getattr(condition, "package", PACKAGE.value)):  # names are shown as they stand in the text
            text = "".join(f"; {line}".rstrip() + "\n" for line in explanation(condition).splitlines())
        stream.write(f"; caught {kind}:\n{text}")
    stream.flush()
