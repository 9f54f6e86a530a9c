"""The classes of Common Lisp that Python has already: INTEGER, STRING, LIST, FUNCTION and their relatives.

Python's classes are not arranged as Lisp's are (``None`` is a symbol and a list, ``True`` a symbol), so the system classes of
ANSI figure 4-8 are empty Python classes here, related as the standard says, and `lisp_mro` tells for each Python class which
of them its instances belong to. Method dispatch, ``class-of`` and ``typep`` look there. Other classes (of users, of the
runtime's rooms) are themselves.
"""

from __future__ import annotations

import types as python_types
from fractions import Fraction
from pathlib import PurePath

from cramhy_runtime.lisp_core.arrays import BitVector, LispArray, SimpleArray, SimpleBitVector, TypedVector, Vector
from cramhy_runtime.lisp_core.classes import BigInteger
from cramhy_runtime.lisp_core.conditions import Condition, Restart
from cramhy_runtime.lisp_core.data import Character, Cons, Keyword, LispString, Symbol
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.packages import Package, sym
from cramhy_runtime.kernel.images import Cell


class BuiltInClass(type):
    """The metaclass of the system classes. They have no instances of their own."""

    lisp_name = "BUILT-IN-CLASS"

    def __instancecheck__(cls, instance):
        return cls in lisp_mro(type(instance))

    def __call__(cls, *arguments):
        raise TypeError(f"{cls.__name__} is a class of Lisp data that Python has another class for")


_HIERARCHY = """
SYMBOL CHARACTER NUMBER SEQUENCE ARRAY FUNCTION HASH-TABLE STREAM PACKAGE PATHNAME RANDOM-STATE READTABLE RESTART
COMPLEX:NUMBER REAL:NUMBER RATIONAL:REAL FLOAT:REAL INTEGER:RATIONAL RATIO:RATIONAL FIXNUM:INTEGER BIGNUM:INTEGER
SINGLE-FLOAT:FLOAT DOUBLE-FLOAT:FLOAT LIST:SEQUENCE CONS:LIST NULL:SYMBOL,LIST VECTOR:ARRAY,SEQUENCE SIMPLE-ARRAY:ARRAY
STRING:VECTOR BIT-VECTOR:VECTOR SIMPLE-VECTOR:VECTOR,SIMPLE-ARRAY SIMPLE-STRING:STRING,SIMPLE-ARRAY
SIMPLE-BIT-VECTOR:BIT-VECTOR,SIMPLE-ARRAY COMPILED-FUNCTION:FUNCTION LOGICAL-PATHNAME:PATHNAME
"""

STRUCTURES = ("HASH-TABLE", "PACKAGE", "RANDOM-STATE", "READTABLE", "RESTART")
"""System classes that are structures in SBCL, so that methods on STRUCTURE-OBJECT apply to their instances."""

CLASSES = {}
"""The system classes by name."""


def _make_classes():
    for entry in _HIERARCHY.split():
        name, _, supers = entry.partition(":")
        bases = tuple(CLASSES[other] for other in supers.split(",")) if supers else (object,)
        CLASSES[name] = BuiltInClass(name.title().replace("-", ""), bases, {"lisp_name": name})


_make_classes()

_MAP = {
    int: "FIXNUM",
    bool: "SYMBOL",
    float: "DOUBLE-FLOAT",
    SingleFloat: "SINGLE-FLOAT",
    Fraction: "RATIO",
    complex: "COMPLEX",
    type(None): "NULL",
    Symbol: "SYMBOL",
    Keyword: "SYMBOL",
    Cons: "CONS",
    str: "SIMPLE-STRING",
    LispString: "STRING",
    Character: "CHARACTER",
    list: "SIMPLE-VECTOR",
    SimpleBitVector: "SIMPLE-BIT-VECTOR",
    BitVector: "BIT-VECTOR",
    TypedVector: "VECTOR",
    Vector: "VECTOR",
    LispArray: "ARRAY",
    SimpleArray: "SIMPLE-ARRAY",
    bytes: "VECTOR",
    bytearray: "VECTOR",
    Package: "PACKAGE",
    PurePath: "PATHNAME",
    Restart: "RESTART",
    python_types.FunctionType: "COMPILED-FUNCTION",
    python_types.BuiltinFunctionType: "COMPILED-FUNCTION",
}

_mro_cache: dict = {}


def forget():
    """Drop what is remembered about class precedence: a class has been redefined."""
    _mro_cache.clear()


def lisp_mro(cls):
    """The class precedence list of the instances of the Python class ``cls``: a tuple, most specific class first."""
    found = _mro_cache.get(cls)
    if found is None:
        found = _mro_cache[cls] = tuple(_compute_mro(cls))
    return found


def _compute_mro(cls):
    if cls is BigInteger:
        return [CLASSES["BIGNUM"] if base is CLASSES["FIXNUM"] else base for base in lisp_mro(int)]
    if cls in CLASSES.values():
        return _system_mro(cls)
    result = []
    for base in cls.__mro__:
        name = _MAP.get(base) or _named(base)
        if name is not None:
            # The Python classes themselves stay in front, so that Python code may specialize methods on them: a keyword is a Symbol.
            above = cls.__mro__[len(result) : -1]
            return [*result, *above, *_system_mro(CLASSES[name])]
        result.append(base)
    result.pop()  # object, which is T, comes last
    if issubclass(cls, type):
        if _standard_object.value not in result:  # that of a user has it
            result.append(_standard_object.value)
    else:
        if "__call__" in _attributes_of(cls) or any(vars(base).get("lisp_name") == "GENERIC-FUNCTION" for base in result):
            result += [CLASSES["COMPILED-FUNCTION"], CLASSES["FUNCTION"]]
        named = any("lisp_name" in vars(base) for base in result)
        if named and _standard_object.value not in result and not issubclass(cls, Condition) and not _is_structure(cls):
            result.append(_standard_object.value)
    return [*result, object]


def _system_mro(cls):
    if cls.lisp_name in STRUCTURES:
        return (*cls.__mro__[:-1], _structure_object.value, object)
    return cls.__mro__


def _named(cls):
    # A class of the runtime may say by its lisp_name that it is what a system class means: a hash table, a stream.
    name = vars(cls).get("lisp_name")
    return name if name in CLASSES else None


def _attributes_of(cls):
    names = set()
    for base in cls.__mro__:
        names.update(vars(base))
    return names


_standard_object = Cell(object)
_structure_object = Cell(object)


def _is_structure(cls):
    return any(vars(base).get("lisp_name") == "STRUCTURE-OBJECT" for base in cls.__mro__)


def set_standard_object(cls):
    """Called once by ``slots.py`` with the class STANDARD-OBJECT."""
    _standard_object.value = cls


def set_structure_object(cls):
    """Called once by ``structures.py`` with the class STRUCTURE-OBJECT."""
    _structure_object.value = cls
    forget()


def system_class(symbol):
    """The system class that ``symbol`` names, or ``None``. T is ``object``."""
    if symbol is True:
        return object
    if isinstance(symbol, Symbol) and symbol.package is _CL:
        return CLASSES.get(symbol.name)
    return None


_CL = sym("CAR").package
