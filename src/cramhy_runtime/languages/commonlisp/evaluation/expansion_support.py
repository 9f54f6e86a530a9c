"""What the expansions of standard macros call: the functions of the package CRAMHY.

A macro only rearranges forms; the work is done here. Users do not call these by name.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.functions import check_shape  # noqa: F401  macros name it here

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.hash_tables import need_table
from ..collections.list_search import without_property
from ..compiler.support import function_of, next_method_exists  # noqa: F401  macros name the second one here
from cramhy_runtime.lisp_core.conditions import CaseFailure, SimpleTypeError, error, program_error
from cramhy_runtime.lisp_core.data import MultipleValues, boolean, python_list, truth
from cramhy_runtime.lisp_core.packages import is_symbol, keyword, sym, symbol_name
from ..streams.streams import StringOutputStream
from ..types.type_names import simplified_type

# ------------------------------------------------------------------------------------------------------------ destructuring


def key_table(arguments, known, allow_others, what):
    """The keyword arguments of ``what`` in the list ``arguments`` as a dict; unknown and odd ones are errors."""
    items = list(arguments or ())
    if len(items) % 2:
        return program_error("Error while parsing arguments to ~A:~%  odd number of elements in keyword/value list: ~S", what, arguments)
    table = {}
    for index in range(0, len(items), 2):
        table.setdefault(items[index], items[index + 1])
    allow = keyword("ALLOW-OTHER-KEYS")
    names = set(known or ())
    if not allow_others and not truth(table.get(allow)):
        for key in table:
            if key not in names and key is not allow:
                return program_error(
                    "Error while parsing arguments to ~A:~%  unknown keyword: ~S; expected one of ~{~S~^, ~}", what, key, known
                )
    return table


def key_given_p(table, key):
    """Whether the keyword ``key`` is in what `key_table` made."""
    return True if key in table else None


def key_value(table, key):
    """The argument of the keyword ``key`` in what `key_table` made, nil if it was not given."""
    return table.get(key)


# --------------------------------------------------------------------------------------------------------- choice and checks


def case_failure(value, operator, possibilities):
    """Signal that no clause of ``ecase`` or ``etypecase`` fits: ``possibilities`` is the list of the keys or types."""
    return error(CaseFailure(value, operator, possibilities))


def ask_for_value(value, operator, possibilities):
    """Signal that no clause fits, with a restart STORE-VALUE; returns the value to try next."""
    return conditions.restart_case(
        [(sym("STORE-VALUE"), lambda new: new, "Supply a new value.", conditions.ask_value)],
        lambda: error(CaseFailure(value, operator, possibilities)),
    )


def check_type_failed(value, place, kind, name):
    """Signal that the value of ``place`` is not of the type ``kind``, which the program may call ``name``. Returns the new value."""
    kind = simplified_type(kind)
    condition = SimpleTypeError(
        "The value of ~S is ~S, which is not ~:[of type ~S~;~:*~A~].", place, value, name, kind, datum=value, expected_type=kind
    )
    where = symbol_name(place) if is_symbol(place) else "the place"
    return conditions.restart_case(
        [(sym("STORE-VALUE"), lambda new: new, f"Supply a new value for {where}.", conditions.ask_value)], lambda: error(condition)
    )


# ---------------------------------------------------------------------------------------------------------------- conditions


def handler_bind(bindings, thunk):
    """``handler-bind`` as code walkers see it: bindings are lists (type function)."""
    return conditions.handler_bind([(binding.car, function_of(binding.cdr.car)) for binding in bindings or ()], thunk)


def handler_case(clauses, thunk, no_error):
    """``handler-case``: clauses are lists (type function); ``no_error`` gets the values of ``thunk``."""
    return conditions.handler_case([(clause.car, clause.cdr.car) for clause in clauses or ()], thunk, no_error)


def restart_report(report):
    """The report of a restart: a string, or a function of a stream made into one that gives the text."""
    if report is None or isinstance(report, str):
        return report

    def text():
        stream = StringOutputStream()
        report(stream)
        return stream.text()

    return text


def restart_case(clauses, thunk):
    """``restart-case``: clauses are lists (name function report interactive test)."""
    return conditions.restart_case([tuple(clause) for clause in clauses or ()], thunk)


def signal_with_restarts(operator, *arguments):
    """Signal as ``operator`` does, in the form of a ``restart-case``: its restarts belong to the condition (ANSI, RESTART-CASE)."""
    return conditions.signal_with_restarts(symbol_name(operator), *arguments)


def with_condition_restarts(condition, restarts, thunk):
    """``with-condition-restarts``: while ``thunk`` runs, the list ``restarts`` belongs to ``condition``."""
    return conditions.with_condition_restarts(condition, list(restarts or ()), thunk)


def restart_bind(bindings, thunk):
    """``restart-bind``: bindings are lists (name function option value ...); their functions return to where they were invoked."""
    restarts = []
    for name, function, *options in bindings or ():
        options = {option.name: value for option, value in zip(options[::2], options[1::2])}
        restarts.append(
            conditions.Restart(
                name,
                function,
                restart_report(options.get("REPORT-FUNCTION")),
                options.get("INTERACTIVE-FUNCTION"),
                options.get("TEST-FUNCTION"),
            )
        )
    return conditions.restart_bind(restarts, thunk)


def with_simple_restart(name, report, thunk):
    """``with-simple-restart``, see `conditions.with_simple_restart`."""
    return conditions.with_simple_restart(name, report, thunk)


def next_values(next_method, changed, others, *given):
    """``call-next-method`` in the body of a method that was called with ``given``; ``changed`` gets ``others``, a list, if any."""
    return next_method(*given) if others is None else changed(*python_list(others))


# ----------------------------------------------------------------------------------------------------------------- iteration


def hash_table_iterator(table):
    """The generator function of ``with-hash-table-iterator``: T, key and value a call, nil at the end."""
    entries = iter(need_table(table).items())
    return lambda: next((MultipleValues((True, key, value)) for key, value in entries), None)


# -------------------------------------------------------------------------------------------------------------- property lists


def remove_property(plist, indicator):
    """What ``remf`` becomes. Two values: the property list without ``indicator``, changed in place, and whether it was there."""
    rest, found = without_property(plist, indicator)
    return MultipleValues((rest, boolean(found)))
