"""What portable programs take from the inside of SBCL: the bits of floats, parts of vectors, descriptions of structures.

Such programs choose with ``#+sbcl`` what is fast there. Source: SBCL's own definitions of these names; texts are SBCL's.
"""

from __future__ import annotations

import os
import struct

from cramhy_runtime.lisp_core.condition_types import Error, SimpleError, Warning_
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.kernel.typing_names import Any, NoReturn

from ..collections.sequences import replace, subseq
from ..objects.classes import find_class
from ..objects.protocol import class_slots

WORD, INTEGER = "(SIGNED-BYTE 64)", "(SIGNED-BYTE 32)"


class Bug(SimpleError):
    """What SBCL signals where it finds itself in a state that cannot be; libraries signal it, too."""

    lisp_name = "SB-INT::BUG"


class CompilerError(Error):
    """An error that makes the compiler give up a form."""

    lisp_name = "SB-C::COMPILER-ERROR"


class FatalCompilerError(Error):
    """An error that makes the compiler give up a file. ``condition`` tells which."""

    lisp_name = "SB-C::FATAL-COMPILER-ERROR"
    initargs = {"CONDITION": "condition"}
    condition: Any = None

    def report(self) -> str:
        from cramhy_runtime.lisp_core.printing import princ_to_string

        return princ_to_string(self.condition)


class PackageAtVariance(Warning_):
    """A package is defined again, with less than it has."""

    lisp_name = "SB-INT::PACKAGE-AT-VARIANCE"


def missing_arg() -> NoReturn:
    """``sb-int:missing-arg``: signal that an argument which has no default is missing."""
    error("A required &KEY or &OPTIONAL argument was not supplied.")


def bug(control: str, *arguments: Any) -> NoReturn:
    """``sb-int:bug``: signal the error `Bug` with this text."""
    error(Bug(control, *arguments))


def single_float_bits(number: Any) -> int:
    """``sb-kernel:single-float-bits``: the 32 bits of a single-float as a signed integer."""
    if number.__class__ is not SingleFloat:
        type_error(number, "SINGLE-FLOAT")
    return int(struct.unpack("<i", struct.pack("<f", number))[0])


def double_float_bits(number: Any) -> int:
    """``sb-kernel:double-float-bits``: the 64 bits of a double-float as a signed integer."""
    if number.__class__ is not float:
        type_error(number, "DOUBLE-FLOAT")
    return int(struct.unpack("<q", struct.pack("<d", number))[0])


def double_float_high_bits(number: Any) -> int:
    """``sb-kernel:double-float-high-bits``: sign, exponent and the first bits of a double-float, a signed integer of 32 bits."""
    return double_float_bits(number) >> 32


def double_float_low_bits(number: Any) -> int:
    """``sb-kernel:double-float-low-bits``: the last 32 bits of a double-float."""
    return double_float_bits(number) & 0xFFFFFFFF


def make_single_float(bits: Any) -> Any:
    """``sb-kernel:make-single-float``: the single-float with these 32 bits, a signed integer."""
    return SingleFloat(_unpacked("<i", "<f", bits, INTEGER))


def make_double_float(high: Any, low: Any) -> Any:
    """``sb-kernel:make-double-float``: the double-float with these bits: ``high`` is signed, ``low`` is not."""
    if not 0 <= low <= 0xFFFFFFFF:
        type_error(low, "(UNSIGNED-BYTE 32)")
    return _unpacked("<q", "<d", (high << 32) + low, WORD)


def _unpacked(bits_format: str, float_format: str, bits: Any, expected: str) -> float:
    try:
        return float(struct.unpack(float_format, struct.pack(bits_format, bits))[0])
    except struct.error:
        return type_error(bits, expected)


def shrink_vector(vector: Any, length: int) -> Any:
    """``sb-kernel:shrink-vector``: the first ``length`` elements of a vector."""
    return subseq(vector, 0, length)


def ub8_bash_copy(source: Any, from_: int, target: Any, to: int, count: int) -> None:
    """``sb-kernel:ub8-bash-copy``: copy ``count`` octets of ``source`` into ``target``."""
    replace(target, source, start1=to, end1=to + count, start2=from_, end2=from_ + count)


def find_defstruct_description(name: Any) -> Any:
    """``sb-kernel:find-defstruct-description``: what the functions below ask about a structure: its class."""
    return find_class(name)


def dd_slots(description: Any) -> Any:
    """``sb-kernel:dd-slots``: the slots of a structure, in order."""
    return class_slots(description)


def dsd_name(slot: Any) -> Any:
    """``sb-kernel:dsd-name``"""
    return slot.name


def dsd_type(slot: Any) -> Any:
    """``sb-kernel:dsd-type``"""
    return slot.type


def structure_raw_slot_data(type: Any) -> None:
    """``sb-kernel::structure-raw-slot-data``: nil, since each slot holds one object."""


def posix_getcwd() -> str:
    """``sb-unix:posix-getcwd/``: the current folder, with a slash at its end."""
    return os.path.join(os.getcwd(), "")
