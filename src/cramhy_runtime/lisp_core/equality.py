"""The four equalities of Common Lisp: ``eq``, ``eql``, ``equal`` and ``equalp``.

Python has one ``==``, for which ``True == 1 == 1.0``. Lisp asks more precisely: ``eql`` is identity, and for numbers and
characters same type and same value; ``equal`` also looks into conses, strings, bit vectors and pathnames; ``equalp`` also
into vectors, structures and hash tables, and ignores case and the types of numbers.

Each equality has a hash key (`eql_key` ...) with the law: ``x`` and ``y`` are equal exactly if their keys are equal in
Python. Hash tables are Python dictionaries under these keys. A key that names an object by its ``id`` is valid as long as the
object lives, so whoever stores the key keeps the object too. Source: ANSI 5.3; checked against SBCL.
"""

from __future__ import annotations

from math import copysign

from .arrays import LispArray, is_bit_vector
from cramhy_runtime.kernel.active import checkpoint
from .data import FLOATS, LONG, WRITABLE_STRINGS, Character, Cons, FreshString, Keyword, LispString, Symbol, is_ratio, list_parts

from .ports import PORTS

LISP_NAMES = "eq eql equal equalp"


def eq(x, y):
    """``eq``: the same object. Numbers of equal type and value count as the same, as small ones do in SBCL."""
    return eql(x, y)


EQUAL_TO_THEMSELVES = frozenset((Symbol, Keyword, Character, Cons, str, *WRITABLE_STRINGS))
"""Classes whose objects are ``eql`` to themselves only, for a quick answer."""


def eql(x, y):
    """``eql``: the same object, or numbers of the same type and value (``0.0`` and ``-0.0`` differ)."""
    if x is y:
        return True
    cls = x.__class__
    if cls is not y.__class__:
        return True if (x is False and y is None) or (x is None and y is False) else None
    if cls is int:
        return True if x == y else None
    if cls in EQUAL_TO_THEMSELVES:
        return None
    if cls in FLOATS:
        if x == y:
            return True if x or copysign(1.0, x) == copysign(1.0, y) else None
        return True if x != x and y != y else None
    return True if (isinstance(x, complex) or is_ratio(x)) and x == y else None


def equal(x, y):
    """``equal``: ``eql``, or conses, strings, bit vectors or pathnames with equal contents."""
    passed = 0
    while True:
        if x is y:
            return True
        if x.__class__ is not Cons:
            break
        if y.__class__ is not Cons or equal(x.car, y.car) is None:
            return None
        x, y = x.cdr, y.cdr
        passed += 1
        if not passed & 255:
            checkpoint()
    if isinstance(x, (str, LispString)):
        return True if isinstance(y, (str, LispString)) and str(x) == str(y) else None
    if is_bit_vector(x):
        return True if is_bit_vector(y) and list(x) == list(y) else None
    if hasattr(x.__class__, "__fspath__"):
        return True if x == y else None
    return eql(x, y)


def equalp(x, y):
    """``equalp``: equal contents, whatever the case of characters, the types of numbers and the kinds of vectors."""
    passed = 0
    while True:
        if x is y:
            return True
        if x.__class__ is not Cons:
            break
        if y.__class__ is not Cons or equalp(x.car, y.car) is None:
            return None
        x, y = x.cdr, y.cdr
        passed += 1
        if not passed & 255:
            checkpoint()
    if is_number(x):
        return True if is_number(y) and x == y else None
    if x.__class__ is Character:
        return True if y.__class__ is Character and folded(x.char) == folded(y.char) else None
    shape = _array_shape(x)
    if shape is not None:
        return _all_equalp(_array_elements(x), _array_elements(y)) if shape == _array_shape(y) else None
    slots = _slots(x)
    if slots is not None:
        return _all_equalp(slots, _slots(y)) if x.__class__ is y.__class__ else None
    if hasattr(x, "equalp_table"):
        return x.equalp_table(y)
    return equal(x, y)


def _all_equalp(first, second):
    return True if all(equalp(x, y) for x, y in zip(first, second, strict=True)) else None


def is_number(x):
    """Whether ``x`` is a number in Lisp; ``True`` is not."""
    return (isinstance(x, (int, float, complex)) and x is not True and x is not False) or is_ratio(x)


def folded(char):
    """The one-character string ``char`` without its case, as ``char-equal`` sees it."""
    if char < "\x80":
        return char.lower()
    lower = char.lower()
    return lower if len(lower) == 1 and lower.upper() == char else char


def _array_shape(x):
    # The dimensions that equalp compares (up to the fill pointer), or None for what is no array.
    if isinstance(x, (list, str, LispString)):
        return (len(x),)
    return x.shape() if isinstance(x, LispArray) else None


def _array_elements(x):
    if isinstance(x, (str, LispString)):
        return [Character(char) for char in str(x)]
    return x.active() if isinstance(x, LispArray) else x


def _slots(x):
    # The slot values of a structure, or None for other objects: only structures are compared slot by slot.
    if not hasattr(x.__class__, "lisp_structure"):
        return [getattr(x, name) for name in x.__class__.equalp_slots] if hasattr(x.__class__, "equalp_slots") else None
    return [value for _, value in PORTS.classes.slots(x)]


# ---------------------------------------------------------------------------------------------------------------- hash keys

_OWN_KEY = {int, Symbol, Keyword, Character, type(None)}


def eql_key(x):
    """A hashable Python value that is the same exactly for ``eql`` objects. It may hold ``id(x)``: keep ``x`` alive."""
    cls = x.__class__
    if cls in _OWN_KEY:
        return x
    if cls in EQUAL_TO_THEMSELVES:
        return (id(x), None)
    if cls in FLOATS:
        if x != x:
            return (cls, "nan")
        return (cls, float(x)) if x else (cls, 0.0, copysign(1.0, x))
    if cls is bool:
        return (True,) if x else None
    if isinstance(x, complex):
        return (cls, x.real, x.imag)
    return x if is_ratio(x) else (id(x), None)


eq_key = eql_key


def equal_key(x):
    """The same for ``equal``."""
    cls = x.__class__
    if cls is str:
        return x
    if cls is FreshString:
        return str(x)
    if cls in _OWN_KEY:
        return x
    if isinstance(x, (str, LispString)):
        return str(x)
    if isinstance(x, Cons):
        return _cons_key(x, equal_key)
    if is_bit_vector(x):
        return ("bits", tuple(x))
    if hasattr(x.__class__, "__fspath__"):
        return ("content", x)
    return eql_key(x)


def _cons_key(cell, key):
    items, end = list_parts(cell)
    keys = []
    for start in range(0, len(items), LONG):
        checkpoint()
        keys += map(key, items[start : start + LONG])
    return ("cons", *keys, key(end))


def equalp_key(x):
    """The same for ``equalp``."""
    if isinstance(x, Symbol) or x is None:
        return x
    if is_number(x):
        return ("number", x)
    if x.__class__ is Character:
        return folded(x.char)
    if isinstance(x, Cons):
        return _cons_key(x, equalp_key)
    shape = _array_shape(x)
    if shape is not None:
        if isinstance(x, (str, LispString)):
            return (shape, tuple(map(folded, str(x))))
        return (shape, tuple(map(equalp_key, _array_elements(x))))
    slots = _slots(x)
    if slots is not None:
        return (x.__class__, tuple(map(equalp_key, slots)))
    if hasattr(x, "equalp_table"):
        return x.equalp_table_key()
    return equal_key(x)


OWN_KEYS = {"EQ": frozenset(_OWN_KEY), "EQL": frozenset(_OWN_KEY), "EQUAL": frozenset((*_OWN_KEY, str)), "EQUALP": frozenset()}
"""The classes whose objects are their own hash keys, by the name of the equality."""
KEYS = {"EQ": eq_key, "EQL": eql_key, "EQUAL": equal_key, "EQUALP": equalp_key}
"""The hash key of each equality, by the name of the equality."""
