"""What named-readtables takes from SB-IMPL in order to look through a readtable: without it, it asks for each of a million characters.

Source: SBCL's structure ``readtable``.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Character, Cons, list_from
from cramhy_runtime.lisp_core.hash_tables import HashTable
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.kernel.typing_names import Any

from ..collections.array_making import make_array
from ..printer.standard_printers import function_name
from ..reader.readtables import STANDARD, DispatchTable, Readtable

BASE_CHARACTERS = 128


def character_macro_array(readtable: Readtable) -> Any:
    """``sb-impl::character-macro-array``: a vector with the function, or nil, of each base character."""
    functions = [readtable.macros.get(chr(code)) for code in range(BASE_CHARACTERS)]
    return make_array(BASE_CHARACTERS, initial_contents=functions)


def character_macro_hash_table(readtable: Readtable) -> HashTable:
    """``sb-impl::character-macro-hash-table``: a new table with the functions of all other characters."""
    return _table({char: function for char, function in readtable.macros.items() if ord(char) >= BASE_CHARACTERS})


def dispatch_tables(readtable: Readtable) -> Any:
    """``sb-impl::dispatch-tables``: a list of pairs of a dispatching character and a new table with its functions."""
    dispatching = {char: function for char, function in readtable.macros.items() if isinstance(function, DispatchTable)}
    return list_from([Cons(Character(char), _table(function.functions)) for char, function in dispatching.items()])


def set_dispatch_tables(tables: Any, readtable: Readtable) -> Any:
    """``(setf sb-impl::dispatch-tables)``: to nil only, then no character is dispatching."""
    if tables is not None:
        error("The dispatch tables of a readtable can be set to NIL only. Use SET-DISPATCH-MACRO-CHARACTER.")
    for char in [char for char, function in readtable.macros.items() if isinstance(function, DispatchTable)]:
        readtable.forget(char)
    return tables


def _table(functions: dict[str, Any]) -> HashTable:
    table = HashTable("EQL")
    for char, function in functions.items():
        table.put(Character(char), function)
    return table


def fun_name(function: Any) -> Any:
    """``sb-impl::%fun-name``: the name of a function; dispatching characters call functions that all have one name."""
    if isinstance(function, DispatchTable):
        parameters = list_from([sym("CL-USER::STREAM"), sym("CL-USER::CHAR")])
        return list_from([sym("LAMBDA"), parameters, sym(":IN"), sym("SB-IMPL::%MAKE-DISPATCH-MACRO-CHAR")])
    return function_name(function)


def assert_not_standard_readtable(readtable: Any, operation: Any) -> None:
    """``sb-impl::assert-not-standard-readtable``: an error if it is the standard readtable, which nobody changes."""
    if readtable is STANDARD:
        error("~S would modify the standard readtable.", operation)
