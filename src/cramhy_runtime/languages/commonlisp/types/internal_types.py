"""Types of SBCL's own packages that the runtime's type-errors name: a program may ask ``typep`` with them.

``(type-error-expected-type c)`` of ``(fboundp 1)`` is ``SB-IMPL::FUNCTION-NAME``, for example. They stand in packages that are made when
one of them is asked for.
"""

from __future__ import annotations

import re

from cramhy_runtime.lisp_core.data import Cons, boolean
from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package, is_symbol, sym

from ..collections.sequence_types import is_sequence_type
from ..pathnames.pathname_objects import LogicalHost, UnixHost
from ..pathnames.pathnames import logical_hosts
from .types import define_own_type

_NAMES = re.compile(r"([A-Z][A-Z0-9-]*)(::?)(?=[A-Z])")


def _is_function_name(obj):
    if isinstance(obj, Cons):
        rest = obj.cdr
        return obj.car is sym("SETF") and isinstance(rest, Cons) and is_symbol(rest.car) and rest.cdr is None
    return is_symbol(obj)


_TYPES = {
    "SB-IMPL::FUNCTION-NAME": _is_function_name,
    "SB-C::ABSTRACT-LEXENV": lambda obj: hasattr(obj, "variable") and hasattr(obj, "function"),
    "SB-KERNEL::HOST": lambda obj: isinstance(obj, (LogicalHost, UnixHost)),
    "SB-KERNEL::LOGICAL-HOST": lambda obj: isinstance(obj, LogicalHost),
    "SB-PRETTY::PPRINT-DISPATCH-TABLE": lambda obj: getattr(obj, "lisp_name", None) == "SB-PRETTY:PPRINT-DISPATCH-TABLE",
}
define_own_type(sym("SB-PRETTY:PPRINT-DISPATCH-TABLE"), _TYPES["SB-PRETTY::PPRINT-DISPATCH-TABLE"])
_PREDICATES = {
    "SB-IMPL::STREAM-FILE-STREAM": lambda obj: getattr(obj, "pathname", None) is not None,
    "SB-IMPL::IS-A-VALID-SEQUENCE-TYPE-SPECIFIER-P": is_sequence_type,
    "SB-IMPL::LOGICAL-HOST-NAME-P": lambda obj: str(obj).upper() in logical_hosts,
    "SB-KERNEL::LITERAL": lambda obj: obj.__class__ is str,
    "SB-IMPL::CHARACTER-INPUT-STREAM-P": lambda obj: getattr(obj, "is_input", False) and not hasattr(obj, "read_byte"),
    "SB-IMPL::CHARACTER-OUTPUT-STREAM-P": lambda obj: getattr(obj, "is_output", False) and not hasattr(obj, "write_byte"),
    "SB-IMPL::BINARY-INPUT-STREAM-P": lambda obj: getattr(obj, "is_input", False) and hasattr(obj, "read_byte"),
    "SB-IMPL::BINARY-OUTPUT-STREAM-P": lambda obj: getattr(obj, "is_output", False) and hasattr(obj, "write_byte"),
}


def readable(specifier):
    """The printed form ``specifier`` of a type so that the reader finds each symbol in it; what it names of SBCL's own is there then."""

    def internal(match):
        if ensure_package(match[1]) is COMMON_LISP:
            return ""
        return f"{match[1]}::"

    text = _NAMES.sub(internal, specifier)
    for name, holds in _TYPES.items():
        if name in text:
            define_own_type(sym(name), holds)
    for name, holds in _PREDICATES.items():
        if name in text:
            sym(name).function = lambda obj, holds=holds: boolean(holds(obj))
    return text
