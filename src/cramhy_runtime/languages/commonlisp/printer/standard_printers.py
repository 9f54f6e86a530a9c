"""How objects of the standard classes print: structures, conditions, functions, classes, streams, and what is foreign.

Each is a function of the object and a stream, registered with `define_printer`. The forms are SBCL's. A condition's
report is formatted on the stream it goes to where possible, so that a pretty stream indents the objects in it. Source:
ANSI 22.1.3.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.ports import PORTS
import weakref

from cramhy_runtime.lisp_core.arrays import LispArray
from cramhy_runtime.lisp_core.condition_types import shown_with
from cramhy_runtime.lisp_core.conditions import CaseFailure, Condition, Restart, SimpleCondition, TypeError_
from cramhy_runtime.lisp_core.data import Cons, LispString, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.hash_tables import HashTable, hash_table_test
from ..numbers.complex_numbers import parts
from ..numbers.random_state import RandomState
from cramhy_runtime.lisp_core.packages import Package, all_packages, is_symbol, keyword, sym, symbol_name
from ..syntax.backquote import COMMA, COMMA_KINDS, Comma
from ..streams.streams import SynonymStream
from . import print_controls as controls
from .pretty import NO_OBJECT, call_logical_block
from .print_arrays import print_array
from .print_controls import PRINT_ESCAPE, PRINT_PRETTY, bound, deeper, length_limit, too_deep
from .print_names import in_print_case, integer_text, string_text, symbol_text
from .printer import class_symbol, define_printer, escaping, output_object, print_unreadable


def print_python_object(obj, stream):
    """Print an object whose class has no printer of its own: ``#<...>`` for most."""
    cls = type(obj)
    if getattr(cls, "lisp_structure", None) is not None:
        print_structure(obj, stream)
    elif isinstance(obj, int):
        stream.write(integer_text(int(obj)))
    elif isinstance(obj, (str, float)):
        output_object(str(obj) if isinstance(obj, str) else float(obj), stream)
    elif getattr(cls, "lisp_name", None) is not None:
        print_unreadable(obj, stream, type_=True, identity=True)
    elif callable(obj):
        _print_function(obj, stream)
    else:
        print_unreadable(obj, stream, "PYTHON " + repr(obj))


def print_structure(obj, stream):
    """``#S(NAME :SLOT value)``, one slot per line when they do not fit on one."""
    print_slots(class_symbol(type(obj)), list(PORTS.classes.slots(obj)), stream)


def print_slots(name, slots, stream):
    """Print what looks like a structure ``name`` (a symbol) with ``slots``, a list of (name, value)."""
    if not slots:
        stream.write("#S(")
        output_object(name, stream)
        stream.write(")")
    elif PRINT_PRETTY.value is not None:
        call_logical_block(stream, NO_OBJECT, lambda out, block: _structure_slots(out, block, name, slots), "#S(", ")")
    elif not too_deep(stream):
        limit = length_limit()
        with deeper():
            stream.write("#S(")
            output_object(name, stream)
            for index, (slot, value) in enumerate(slots):
                if index >= limit:
                    stream.write(" ...")
                    break
                stream.write(f" {_slot_keyword(slot)} ")
                output_object(value, stream)
            stream.write(")")


def _structure_slots(out, block, name, slots):
    output_object(name, out)
    for slot, value in slots:
        out.write(" ")
        out.newline("linear")
        block.pop()
        out.write(f"{_slot_keyword(slot)} ")
        out.newline("miser")
        output_object(value, out)


def _slot_keyword(slot):
    return symbol_text(sym(":" + (symbol_name(slot) if is_symbol(slot) else str(slot))))


def _print_condition(condition, stream):
    if not escaping():
        report_to(condition, stream)
    elif isinstance(condition, SimpleCondition) and isinstance(condition.format_control, (str, LispString)):

        def control():
            with bound(controls.PRINT_LINES, 1):
                output_object(condition.format_control, stream)

        print_unreadable(condition, stream, type_=True, identity=True, body=control)
    elif isinstance(condition, TypeError_):

        def datum():
            stream.write("expected-type: ")
            _write_type(condition.expected_type, stream)
            stream.write(" datum: ")
            output_object(condition.datum, stream)

        print_unreadable(condition, stream, type_=True, body=datum)
    else:
        print_unreadable(condition, stream, type_=True, identity=True)


def _write_type(expected, stream):
    if isinstance(expected, str):
        stream.write(expected)
    else:
        output_object(expected, stream)


def report_to(condition, stream):
    """Print the report of ``condition``. Where the report is a format control or a function of a stream, it writes on
    ``stream`` itself, so that lines are broken where that stream's lines end.
    """
    report = type(condition).report
    control = getattr(condition, "format_control", None)
    if report is SimpleCondition.report and isinstance(control, (str, LispString)):
        PORTS.printer.format_to(stream, control, *(condition.format_arguments or ()))
    elif report in _REPORTS:
        with bound(PRINT_ESCAPE, True):
            PORTS.printer.format_to(stream, *_REPORTS[report](condition))
    elif hasattr(report, "write"):
        report.write(condition, stream)
    else:
        stream.write(condition.report())


class _Verbatim:
    """Text that prints as it is, escaped or not."""

    def __init__(self, text):
        self.text = text


def _type_error_report(condition):
    expected = condition.expected_type
    expected = _Verbatim(expected if isinstance(expected, str) else shown_with(expected, "COMMON-LISP"))
    context = condition.context.lstrip("\n") if condition.context else None
    return "~@<The value ~@:_~2@T~S ~@:_is not of type ~@:_~2@T~S~@[ ~@:_~A~]~:@>", condition.datum, expected, context


_REPORTS = {
    TypeError_.report: _type_error_report,
    CaseFailure.report: lambda condition: (
        "~@<~S fell through ~S expression.~@[ ~:_Wanted one of (~{~S~^ ~:_~}).~]~:>",
        condition.datum,
        _Verbatim(str(condition.operator)),
        condition.possibilities,
    ),
}


def _print_restart(restart, stream):
    if escaping():
        print_unreadable(restart, stream, type_=True, identity=True, body=lambda: output_object(restart.name, stream))
    else:
        stream.write(restart.report())


def _print_function(function, stream):
    name = function_name(function)
    proper = name is not None and (getattr(name, "function", None) is function or _setf_function(name) is function)

    def named():
        stream.write(in_print_case("FUNCTION "))
        if name is None and (made := _local_name(function)):
            stream.write(made)
            return
        with bound(PRINT_ESCAPE, True):
            output_object(_python_name(function) if name is None else name, stream)

    print_unreadable(function, stream, identity=not proper, body=named)


def _local_name(function):
    """What SBCL calls a function that a Lisp form made, such as ``(LAMBDA (X) :IN DRIVE)`` or ``(FLET TURN)``; ``None`` for others."""
    top, *outer = getattr(function, "__qualname__", "").split(".<locals>.")
    if top != "toplevel" or not outer:
        return None
    *outer, name = (part.replace("_", "-").upper() for part in outer)
    names = [part for part in outer if not part.startswith(("LFUNCTION", "<"))]
    inside = f" :IN {names[0]}" if names else ""
    if not name.startswith(("LFUNCTION", "<")):
        return f"(FLET {name}{inside})"
    parameters = " ".join(symbol_name(item) for item in PORTS.definitions.lambda_list(function) or ())
    for rest in ("&REST LKEYS", "&REST LGIVEN"):  # the code takes any keywords, and looks at them itself
        required, found, _ = parameters.partition(rest)
        parameters = f"{required}&KEY ..." if found else parameters
    return f"(LAMBDA {f'({parameters})' if parameters or PRINT_PRETTY.value is not None else 'NIL'}{inside})"


def _python_name(function):
    """What stands for the Lisp name of a function of Python: a string such as ``"math.sin"``."""
    name = getattr(function, "__qualname__", None) or type(function).__qualname__
    module = getattr(function, "__module__", None)
    return name if module in (None, "builtins") else f"{module}.{name}"


def _setf_function(name):
    is_setf = isinstance(name, Cons) and name.car is sym("SETF") and isinstance(name.cdr, Cons)
    return getattr(name.cdr.car, "setf_function", None) if is_setf else None


_function_names = weakref.WeakKeyDictionary()


def function_name(function):
    """The Lisp name of ``function``: a symbol, a list such as ``(lambda (x))``, or ``None`` when it has none."""
    name = getattr(function, "__lisp_name__", None)
    if name is not None:
        return name
    try:
        if function in _function_names:
            return _function_names[function]
        # a function of the runtime: found by looking through all packages, once
        for package in all_packages():
            for table in (package.external, package.internal):
                for symbol in table.values():
                    if isinstance(symbol, Symbol) and symbol.function is function:
                        _function_names[function] = symbol
                        return symbol
    except TypeError:
        pass
    return None


def _print_complex(number, stream):
    stream.write("#C(")
    real, imaginary = parts(number)
    output_object(real, stream)
    stream.write(" ")
    output_object(imaginary, stream)
    stream.write(")")


def _print_hash_table(table, stream):
    """``#<HASH-TABLE :TEST EQL :COUNT 0 {1001546603}>``."""

    def contents():
        stream.write(":TEST ")
        with bound(PRINT_ESCAPE, True):
            output_object(hash_table_test(table), stream)
        if table.test.__class__ is not str:
            stream.write(" :HASH-FUNCTION ")
            output_object(table.test.number, stream)
        stream.write(" :COUNT ")
        output_object(len(table), stream)

    print_unreadable(table, stream, type_=True, identity=True, body=contents)


def _print_synonym(stream_object, stream):
    def contents():
        stream.write(":SYMBOL ")
        output_object(stream_object.symbol, stream)

    print_unreadable(stream_object, stream, type_=True, identity=True, body=contents)


def _print_comma(comma, stream):
    if PRINT_PRETTY.value is None:
        return print_slots(COMMA, [(keyword("EXPR"), comma.form), (keyword("KIND"), COMMA_KINDS.index(comma.kind))], stream)
    stream.write(comma.kind)
    if comma.kind == "," and is_symbol(comma.form) and symbol_text(comma.form, escaping())[:1] in "@.":
        stream.write(" ")  # else it would be read as ",@" or ",."
    output_object(comma.form, stream)


_QUOTE = sym("QUOTE")


def _print_random_state(state, stream):
    """``#S(RANDOM-STATE :STATE #.(MAKE-ARRAY ...))``, which is read as a state that gives the same numbers."""
    bytes_ = lisp_list(_QUOTE, lisp_list(sym("UNSIGNED-BYTE"), 32))
    words = lisp_list(_QUOTE, list_from(state.words()))
    stream.write("#S(")
    output_object(sym("RANDOM-STATE"), stream)
    stream.write(" ")
    output_object(keyword("STATE"), stream)
    stream.write(" #.")
    output_object(lisp_list(sym("MAKE-ARRAY"), 627, keyword("ELEMENT-TYPE"), bytes_, keyword("INITIAL-CONTENTS"), words), stream)
    stream.write(")")


def print_package(package, stream):
    if package.name is None:
        return print_unreadable(package, stream, "(deleted)", type_=True, identity=True)
    return print_unreadable(package, stream, string_text(package.name), type_=True)


def _register():
    for cls, function in (
        (object, print_python_object),
        (Condition, _print_condition),
        (Restart, _print_restart),
        (list, print_array),
        (HashTable, _print_hash_table),
        (LispArray, print_array),
        (complex, _print_complex),
        (_Verbatim, lambda obj, stream: stream.write(obj.text)),
        (Comma, _print_comma),
        (SynonymStream, _print_synonym),
        (Package, print_package),
        (RandomState, _print_random_state),
        (bytes, lambda obj, stream: print_array(list(obj), stream)),
    ):
        define_printer(cls, function)


_register()
