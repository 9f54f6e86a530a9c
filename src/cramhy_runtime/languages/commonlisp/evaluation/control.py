"""``eval``, ``fdefinition``, and the functions on conditions and restarts, as Lisp calls them (ANSI chapters 3, 5, 9)."""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from ..compiler import support
from cramhy_runtime.lisp_core.conditions import handled, type_error
from cramhy_runtime.lisp_core.conditions import make_condition as make
from cramhy_runtime.lisp_core.data import UNBOUND, list_from, one
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import COMMON_LISP, printed, sym
from ..reader.reader import read_from_string
from ..types.internal_types import readable
from .symbols import place_of, symbol_function
from . import compiled_operators  # noqa: F401  it defines macros
from . import setf_places as places
from .evaluator import PACKAGE, evaluate
from cramhy_runtime.lisp_core.restarts import Restart
from cramhy_runtime.lisp_core.functions import functionp

LISP_NAMES = """eval compiled-function-p fdefinition get-setf-expansion
error signal warn cerror break invoke-debugger compute-restarts find-restart invoke-restart invoke-restart-interactively restart-name
abort continue muffle-warning use-value store-value make-condition simple-condition-format-control
simple-condition-format-arguments type-error-datum type-error-expected-type cell-error-name unbound-slot-instance
arithmetic-error-operation arithmetic-error-operands print-not-readable-object stream-error-stream file-error-pathname"""


compiled_function_p = functionp


def eval_(form):
    """``eval``: all values of ``form`` in the null lexical environment."""
    return evaluate(form)


get_setf_expansion = places.get_setf_expansion


def fdefinition(name):
    place = place_of(name)
    return symbol_function(name) if place is None else support.setf_function(place)


def error(datum, *arguments):  # that of Python rooms has the keyword ``hint``
    condition = make(datum, arguments)
    exit_ = handled(condition)
    if exit_ is not None:
        raise exit_
    return conditions.nobody_handled(condition)


signal, warn, cerror, break_ = conditions.signal, conditions.warn, conditions.cerror, conditions.break_
invoke_debugger = conditions.invoke_debugger


def compute_restarts(condition=None):
    return list_from(conditions.compute_restarts(condition))


find_restart, invoke_restart = conditions.find_restart, conditions.invoke_restart
invoke_restart_interactively = conditions.invoke_restart_interactively
abort, continue_, muffle_warning = conditions.abort, conditions.continue_, conditions.muffle_warning
use_value, store_value = conditions.use_value, conditions.store_value


def restart_name(restart):
    """``restart-name``"""
    return restart.name if isinstance(restart, Restart) else type_error(restart, "RESTART")


def make_condition(kind, *arguments):
    """``make-condition``"""
    return conditions.make_condition(conditions.designated(kind), arguments)


def _reader(attribute, kind="Condition"):
    def reader(condition):
        if not isinstance(condition, conditions.Condition):
            return type_error(condition, "CONDITION")
        value = getattr(condition, attribute, UNBOUND)
        return type_error(condition, printed(sym(getattr(conditions, kind).lisp_name))) if value is UNBOUND else value

    return reader


simple_condition_format_control = _reader("format_control", "SimpleCondition")
type_error_datum = _reader("datum", "TypeError_")


_expected_type = _reader("expected_type", "TypeError_")


def type_error_expected_type(condition):
    """The type specifier. The runtime names types by their printed form, which is read here."""
    expected = _expected_type(condition)
    if not isinstance(expected, str):
        return expected
    with binding(PACKAGE, COMMON_LISP):
        return one(read_from_string(readable(expected)))


print_not_readable_object = _reader("object", "PrintNotReadable")
cell_error_name, unbound_slot_instance = _reader("name", "CellError"), _reader("instance", "UnboundSlot")
arithmetic_error_operation, arithmetic_error_operands = [_reader(name, "ArithmeticError_") for name in ("operation", "operands")]
stream_error_stream, file_error_pathname = _reader("stream", "StreamError"), _reader("pathname", "FileError")


_format_arguments = _reader("format_arguments", "SimpleCondition")


def simple_condition_format_arguments(condition):
    """``simple-condition-format-arguments``"""
    arguments = _format_arguments(condition)
    return list_from(arguments) if isinstance(arguments, tuple) else arguments
