"""Integers as bits: shifts, logical operations, and bytes in the sense of ``ldb``.

A negative integer is an endless row of ones to the left, in Common Lisp as in Python, so each operation is Python's own. A
byte specifier is the pair ``(size . position)``. Source: ANSI 12.1.1.3.2.
"""

from __future__ import annotations

import operator

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Cons, boolean
from cramhy_runtime.lisp_core.packages import sym
from .arithmetic import is_integer, need_integer

LISP_NAMES = """ash logand logior logxor logeqv lognot lognand lognor logandc1 logandc2 logorc1 logorc2 logtest logbitp logcount
integer-length byte byte-size byte-position ldb ldb-test dpb mask-field deposit-field boole"""


def ash(integer, count):
    """``integer`` shifted left by ``count`` bits, right when ``count`` is negative."""
    if integer.__class__ is not int or count.__class__ is not int:
        need_integer(integer)
        need_integer(count)
    return integer << count if count >= 0 else integer >> -count


def _fold(name, start, operation):
    def function(*integers):
        result = start
        for integer in integers:
            result = operation(result, integer if integer.__class__ is int else need_integer(integer))
        return result

    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"``cl:{name}``"
    return function


logand = _fold("logand", -1, operator.and_)
logior = _fold("logior", 0, operator.or_)
logxor = _fold("logxor", 0, operator.xor)
logeqv = _fold("logeqv", -1, lambda a, b: ~(a ^ b))


def _pair(name, operation):
    def function(integer1, integer2):
        return operation(need_integer(integer1), need_integer(integer2))

    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"``cl:{name}``"
    return function


lognand = _pair("lognand", lambda a, b: ~(a & b))
lognor = _pair("lognor", lambda a, b: ~(a | b))
logandc1 = _pair("logandc1", lambda a, b: ~a & b)
logandc2 = _pair("logandc2", lambda a, b: a & ~b)
logorc1 = _pair("logorc1", lambda a, b: ~a | b)
logorc2 = _pair("logorc2", lambda a, b: a | ~b)
logtest = _pair("logtest", lambda a, b: boolean(a & b))


def lognot(integer):
    return ~need_integer(integer)


def logbitp(index, integer):
    """Whether the bit of weight ``2**index`` is one."""
    return boolean(need_integer(integer) >> _natural(index) & 1)


def logcount(integer):
    """The number of ones; of zeros for negative integers."""
    need_integer(integer)
    return (integer if integer >= 0 else ~integer).bit_count()


def integer_length(integer):
    """The number of bits that ``integer`` needs, without a sign."""
    need_integer(integer)
    return (integer if integer >= 0 else ~integer).bit_length()


def _natural(integer):
    return integer if need_integer(integer) >= 0 else type_error(integer, sym("UNSIGNED-BYTE"))


def _byte_part(integer):
    return integer if is_integer(integer) and integer >= 0 else type_error(integer, "(MOD 4611686018427387841)")


def byte(size, position):
    if size.__class__ is position.__class__ is int and size >= 0 <= position:
        return Cons(size, position)
    return Cons(_byte_part(size), _byte_part(position))


def _spec(bytespec):
    return bytespec if isinstance(bytespec, Cons) else type_error(bytespec, sym("CONS"))


def byte_size(bytespec):
    return _spec(bytespec).car


def byte_position(bytespec):
    return _spec(bytespec).cdr


def _mask(bytespec):
    """As many ones as ``bytespec`` says; its position is looked at, too, so that the caller can rely on it."""
    try:
        if bytespec.cdr.__class__ is int and bytespec.cdr >= 0:
            return (1 << bytespec.car) - 1
    except (AttributeError, TypeError, ValueError):
        pass
    _byte_part(_spec(bytespec).car)
    return _byte_part(bytespec.cdr)


def ldb(bytespec, integer):
    """The byte of ``integer``, moved to position 0."""
    if bytespec.__class__ is Cons:
        size, position = bytespec.car, bytespec.cdr
        if size.__class__ is position.__class__ is integer.__class__ is int and size >= 0 <= position:
            return integer >> position & (1 << size) - 1
    mask = _mask(bytespec)
    return need_integer(integer) >> bytespec.cdr & mask


def ldb_test(bytespec, integer):
    return boolean(ldb(bytespec, integer))


def dpb(newbyte, bytespec, integer):
    """``integer`` with the byte replaced by the low bits of ``newbyte``."""
    mask = _mask(bytespec)
    return need_integer(integer) & ~(mask << bytespec.cdr) | (need_integer(newbyte) & mask) << bytespec.cdr


def mask_field(bytespec, integer):
    """The byte of ``integer``, where it stands."""
    mask = _mask(bytespec)
    return need_integer(integer) & mask << bytespec.cdr


def deposit_field(newbyte, bytespec, integer):
    """``integer`` with the byte replaced by the same byte of ``newbyte``."""
    mask = _mask(bytespec) << bytespec.cdr
    return need_integer(integer) & ~mask | need_integer(newbyte) & mask


_BOOLE = (
    ("CLR", lambda a, b: 0),
    ("SET", lambda a, b: -1),
    ("1", lambda a, b: a),
    ("2", lambda a, b: b),
    ("C1", lambda a, b: ~a),
    ("C2", lambda a, b: ~b),
    ("AND", lambda a, b: a & b),
    ("IOR", lambda a, b: a | b),
    ("XOR", lambda a, b: a ^ b),
    ("EQV", lambda a, b: ~(a ^ b)),
    ("NAND", lambda a, b: ~(a & b)),
    ("NOR", lambda a, b: ~(a | b)),
    ("ANDC1", lambda a, b: ~a & b),
    ("ANDC2", lambda a, b: a & ~b),
    ("ORC1", lambda a, b: ~a | b),
    ("ORC2", lambda a, b: a | ~b),
)


def boole(op, integer1, integer2):
    """The logical operation ``op``, one of the constants BOOLE-AND, BOOLE-XOR, ..."""
    if op not in range(16):
        return type_error(op, "(UNSIGNED-BYTE 4)")
    return _BOOLE[op][1](need_integer(integer1), need_integer(integer2))


CONSTANTS = {f"BOOLE-{name}": index for index, (name, _) in enumerate(_BOOLE)}
