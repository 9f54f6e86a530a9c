"""The rest of SB-EXT: numbers, octets, types, hash tables with tests of the user's, and what a program asks of its process.

Source: SBCL's manual, chapter 6, 7 and 11; texts are SBCL's.
"""

from __future__ import annotations

import math
import sys

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import hash_tables
from cramhy_runtime.lisp_core.condition_types import Condition, SeriousCondition
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Cons, LispString, MultipleValues, boolean, lisp_list, list_from, one
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.hash_tables import need_table
from cramhy_runtime.lisp_core.numbers import FIXNUM_LIMIT
from cramhy_runtime.lisp_core.packages import printed, sym, symbol_name
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.utilities.locks import lock_of_table

from ..collections.array_making import make_array
from ..collections.sequence_types import bounds, part
from ..evaluation.evaluator import evaluate
from ..evaluation.forms import constantp
from ..evaluation.process_usage import peak_memory
from ..streams.external_formats import external_format as format_of
from ..types.types import expand_type, is_known_type, type_expander

EMULATED = (2, 2, 9)
"""The version of SBCL whose manual and messages this follows."""
DEFAULT_FORMAT: Any = sym(":DEFAULT")


def float_nan_p(number: Any) -> bool | None:
    """``sb-ext:float-nan-p``"""
    return boolean(math.isnan(number))


def float_infinity_p(number: Any) -> bool | None:
    """``sb-ext:float-infinity-p``"""
    return boolean(math.isinf(number))


def string_to_octets(
    string: Any, *, external_format: Any = DEFAULT_FORMAT, start: int = 0, end: Any = None, null_terminate: Any = None
) -> Any:
    """``sb-ext:string-to-octets``: the bytes of a string in an external format, a vector of (unsigned-byte 8)."""
    if not isinstance(string, (str, LispString)):
        type_error(string, "STRING")
    text = str(string)
    first, last = bounds(start, end, len(text))
    octets = [*text[first:last].encode(_codec(external_format), "replace"), *([0] if null_terminate is not None else [])]
    return make_array(len(octets), element_type=lisp_list(sym("UNSIGNED-BYTE"), 8), initial_contents=octets)


def octets_to_string(vector: Any, *, external_format: Any = DEFAULT_FORMAT, start: int = 0, end: Any = None) -> str:
    """``sb-ext:octets-to-string``: the text whose bytes are in ``vector``."""
    try:
        octets = bytes(part(vector, start, end))
    except (TypeError, ValueError):
        return type_error(vector, "(VECTOR (UNSIGNED-BYTE 8))")
    return octets.decode(_codec(external_format), "replace")


def _codec(designator: Any) -> str:
    return format_of(designator).codec


def valid_type_specifier_p(specifier: Any, environment: Any = None) -> bool | None:
    """``sb-ext:valid-type-specifier-p``"""
    return boolean(is_known_type(specifier.car if isinstance(specifier, Cons) else specifier))


def defined_type_name_p(symbol: Any, environment: Any = None) -> bool | None:
    """``sb-ext:defined-type-name-p``"""
    return boolean(is_known_type(symbol))


def typexpand_1(specifier: Any, environment: Any = None) -> object:
    """``sb-ext:typexpand-1``: two values, what a type of ``deftype`` stands for and T; else the specifier and nil."""
    form = specifier if isinstance(specifier, Cons) else lisp_list(specifier)
    expander = type_expander(form.car)
    return MultipleValues((specifier, None) if expander is None else (expander(form, None), True))


def typexpand(specifier: Any, environment: Any = None) -> object:
    """``sb-ext:typexpand``: as `typexpand_1`, again and again."""
    expanded = expand_type(specifier)
    return MultipleValues((expanded, boolean(expanded is not specifier)))


def get_time_of_day() -> object:
    """``sb-ext:get-time-of-day``: seconds since 1970, and microseconds, by the kernel's clock."""
    moment = kernel.active().epoch + kernel.now()
    return MultipleValues((int(moment), int(moment % 1 * 1_000_000)))


def get_bytes_consed() -> int:
    """``sb-ext:get-bytes-consed``: the most memory that the process had, in bytes; Python does not count what was made."""
    return int(peak_memory() or 0)


def dynamic_space_size() -> int:
    """``sb-ext:dynamic-space-size``: Python has no limit of its own."""
    return sys.maxsize


def assert_version(*least: int) -> None:
    """``sb-ext:assert-version->=``: an error unless the SBCL that is followed here is of this version or later."""
    if EMULATED < least:
        wanted = ".".join(map(str, (*least, 0, 0)[:3]))
        have = ".".join(map(str, EMULATED))
        error(f"SBCL {have}.cramhy is too old for this program (version {wanted} or later is required).")


def no_effect(*arguments: object) -> None:
    """Functions that change how SBCL works inside, of which there is nothing here."""


_exit_hooks: list[Any] = per_image([])


def exit_hooks() -> object:
    """The value of ``sb-ext:*exit-hooks*``: functions that are called when the session ends."""
    return list_from(_exit_hooks)


def set_exit_hooks(hooks: Any) -> None:
    """Assign ``sb-ext:*exit-hooks*``."""
    _exit_hooks[:] = list(hooks or ())
    if _exit_hooks and kernel.active() is not None:
        kernel.active().at_stop(_run_exit_hooks)


def _run_exit_hooks() -> None:
    hooks, _exit_hooks[:] = list(_exit_hooks), []
    for hook in hooks:
        function_of(hook)()


class CompilerNote(Condition):
    """What SBCL's compiler says of code that it could make faster. Here it is never signalled, but programs declare about it."""

    lisp_name = "SB-EXT::COMPILER-NOTE"


class CodeDeletionNote(CompilerNote):
    """What SBCL's compiler says of code that is never reached. Here it is never signalled."""

    lisp_name = "SB-EXT::CODE-DELETION-NOTE"


def constant_form_value(form: Any, environment: Any = None) -> object:
    """``sb-int:constant-form-value``: the value of a form for which ``constantp`` is true; another is an error."""
    if constantp(form, environment) is None:
        return error("~S is not a constant form", form)
    return one(evaluate(form))


def fixnump(thing: Any) -> object:
    """``sb-int:fixnump``: whether ``thing`` is a fixnum."""
    return True if thing.__class__ is int and -FIXNUM_LIMIT <= thing < FIXNUM_LIMIT else None


def wait_until_usable(descriptor: Any, direction: Any, seconds: Any = None, serve_events: object = True) -> object:
    """``sb-sys:wait-until-fd-usable``: whether a descriptor can be read (:input) or written (:output) within so many seconds."""
    from .sockets import ready

    return ready(descriptor, True if symbol_name(direction) == "OUTPUT" else None, seconds)


class InteractiveInterrupt(SeriousCondition):
    """What SBCL signals for Ctrl-C. Here Ctrl-C is no condition: it ends the form through its cleanup."""

    lisp_name = "SB-SYS::INTERACTIVE-INTERRUPT"


def save_lisp_and_die(core: Any, **options: object) -> object:
    """``sb-ext:save-lisp-and-die``: there is no image on disk."""
    return error(
        "Cannot save ~S: cramhy has no images on disk. Compiled files are kept beside their sources; start with `cramhy run`.", core
    )


# ----------------------------------------------------------------------------------------------------------- hash tables


def define_hash_table_test(name: Any, function: Any) -> Any:
    """The work of ``define-hash-table-test``: let the function ``name`` be a test of hash tables. Returns ``name``."""
    hash_tables.define_test(name, function_of(name), function_of(function))
    return name


def call_with_locked_table(table: Any, body: Any) -> object:
    """The work of ``with-locked-hash-table``: the values of ``body()``; others who lock the table wait."""
    with lock_of_table(need_table(table)):
        return body()


def print_symbol_with_prefix(stream: Any, symbol: Any, colon: Any = None, at: Any = None) -> None:
    """``sb-ext:print-symbol-with-prefix``, for a format directive with slashes: a symbol with its package."""
    stream.write(printed(symbol))
