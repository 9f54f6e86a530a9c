"""What the expansions of standard macros call: the functions of the package CRAMHY.

A macro only rearranges forms; the work is done here. Users do not call these by name.
"""

from __future__ import annotations

from .. import conditions
from ..collections.hash_tables import need_table
from ..compiler.support import function_of
from ..conditions import CaseFailure, SimpleProgramError, SimpleTypeError, error, program_error
from ..data import Cons, MultipleValues, list_from, truth
from ..packages import is_symbol, keyword, sym, symbol_name
from ..streams.streams import StringOutputStream
from ..types.type_names import simplified_type
from .compilation_unit import expansion_place

# ------------------------------------------------------------------------------------------------------------ destructuring


def check_shape(lst, least, most, what, lambda_list):
    """Check that ``lst`` has ``least`` to ``most`` elements (no upper bound: nil); returns it."""
    count, cell = 0, lst
    while isinstance(cell, Cons):
        count += 1
        cell = cell.cdr
    improper = cell is not None and not (most is None and count >= least)
    if improper or count < least or (most is not None and count > most):
        wanted = f"exactly {least}" if least == most else f"at least {least}" if most is None else f"between {least} and {most}"
        kind = "invalid number of" if improper else "too few" if count < least else "too many"
        condition = SimpleProgramError("Error while parsing arguments to ~A:~%  ~A elements in~%    ~:S~%  to satisfy lambda list~%    "
                                       "~:S:~%  ~A expected, but got ~A", what, kind, lst, lambda_list, wanted,
                                       "a non-list" if improper else count)
        if what.startswith(("DEFMACRO", "MACROLET")):
            condition.position = expansion_place()  # the call is wrong, not the macro
        return error(condition)
    return lst


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
                return program_error("Error while parsing arguments to ~A:~%  unknown keyword: ~S; expected one of ~{~S~^, ~}", what, key,
                                     known)
    return table


def key_given_p(table, key):
    return True if key in table else None


def key_value(table, key):
    return table.get(key)


# --------------------------------------------------------------------------------------------------------- choice and checks


def case_failure(value, operator, possibilities):
    return error(CaseFailure(value, operator, possibilities))


def ask_for_value(value, operator, possibilities):
    """Signal that no clause fits, with a restart STORE-VALUE; returns the value to try next."""
    return conditions.restart_case([(sym("STORE-VALUE"), lambda new: new, "Supply a new value.")],
                                   lambda: error(CaseFailure(value, operator, possibilities)))


def check_type_failed(value, place, kind, name):
    text, kind = name, simplified_type(kind)
    condition = SimpleTypeError("The value of ~S is ~S, which is not ~:[of type ~S~;~:*~A~].", place, value, text, kind,
                                datum=value, expected_type=kind)
    where = symbol_name(place) if is_symbol(place) else "the place"
    return conditions.restart_case([(sym("STORE-VALUE"), lambda new: new, f"Supply a new value for {where}.")], lambda: error(condition))


# ---------------------------------------------------------------------------------------------------------------- conditions


def handler_bind(clauses, thunk):
    return conditions.handler_bind([(clause.car, function_of(clause.cdr.car)) for clause in clauses or ()], thunk)


def handler_case(clauses, thunk, no_error):
    return conditions.handler_case([(clause.car, clause.cdr.car) for clause in clauses or ()], thunk, no_error)


def restart_report(report):
    """The report of a restart: a string, or a function of a stream made into one that gives the text."""
    if report is None or isinstance(report, str):
        return report

    def text():
        stream = StringOutputStream()
        report(stream)
        return stream.text() if hasattr(stream, "text") else stream.get_text()

    return text


def restart_case(clauses, thunk):
    """``restart-case``: clauses are lists (name function report interactive test)."""
    return conditions.restart_case([tuple(clause) for clause in clauses or ()], thunk)


def signal_with_restarts(operator, *arguments):
    """Signal as ``operator`` does, in the form of a ``restart-case``: its restarts belong to the condition (ANSI, RESTART-CASE)."""
    return conditions.signal_with_restarts(symbol_name(operator), *arguments)


def with_condition_restarts(condition, restarts, thunk):
    return conditions.with_condition_restarts(condition, list(restarts or ()), thunk)


def restart_bind(bindings, thunk):
    restarts = []
    for name, function, *options in bindings or ():
        options = {option.name: value for option, value in zip(options[::2], options[1::2])}
        restarts.append(conditions.Restart(name, function, restart_report(options.get("REPORT-FUNCTION")),
                                           options.get("INTERACTIVE-FUNCTION"), options.get("TEST-FUNCTION")))
    return conditions.restart_bind(restarts, thunk)


def with_simple_restart(name, report, thunk):
    return conditions.with_simple_restart(name, report, thunk)


def next_method_exists(next_method):
    return next_method.exists


# ----------------------------------------------------------------------------------------------------------------- iteration


def hash_table_iterator(table):
    """The generator function of ``with-hash-table-iterator``: T, key and value a call, nil at the end."""
    entries = iter(need_table(table).items())
    return lambda: next((MultipleValues((True, key, value)) for key, value in entries), None)


# -------------------------------------------------------------------------------------------------------------- places, plists


def put_property(plist, indicator, value):
    """The property list with ``indicator`` set: changed in place when it is there, else extended in front."""
    cell = plist
    while isinstance(cell, Cons):
        if cell.car is indicator or _eql(cell.car, indicator):
            cell.cdr.car = value
            return plist
        cell = cell.cdr.cdr
    return Cons(indicator, Cons(value, plist))


def _eql(a, b):
    return type(a) is type(b) and not isinstance(a, str) and a == b


def remove_property(plist, indicator):
    """Two values: the property list without ``indicator``, and whether it was there."""
    items = list(plist or ())
    for index in range(0, len(items) - 1, 2):
        if items[index] is indicator or _eql(items[index], indicator):
            return MultipleValues((list_from(items[:index] + items[index + 2:]), True))
    return MultipleValues((plist, None))
