"""Type specifiers: ``typep``, ``type-of``, ``deftype``.

A specifier is turned into a Python predicate once (`type_predicate`); for symbols the predicate lies in a table, for lists it is
remembered with the list. Compiled code with a constant specifier may keep the predicate. Classes are types; a class that is
defined later is found then, because unknown names are not remembered. ``subtypep`` is in ``type_relations.py``, ``coerce`` in
``coercion.py``. Source: ANSI chapter 4; texts are SBCL's.
"""

from __future__ import annotations

import operator
from types import BuiltinFunctionType, FunctionType

from fractions import Fraction
from pathlib import PurePath

from ..collections.element_types import upgraded_element_type
from cramhy_runtime.lisp_core.arrays import (
    BASE_CHAR,
    STRING_KINDS,
    LispArray,
    TypedVector,
    Vector,
    array_type,
    dimensions,
    element_type,
    is_bit_vector,
    is_simple,
)
from cramhy_runtime.lisp_core.conditions import SimpleError, error
from cramhy_runtime.lisp_core.data import (
    Character,
    Cons,
    Keyword,
    LispString,
    Symbol,
    UndefinedFunction,
    lisp_list,
    list_from,
    one,
    python_list,
    truth,
)
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.equality import eql, equal
from ..pathnames.pathname_objects import Pathname
from ..numbers.arithmetic import is_integer, is_number, is_rational, is_real
from ..numbers.complex_numbers import parts
from ..objects.builtin_classes import BuiltInClass, lisp_mro
from ..objects.class_objects import StandardClass, StandardObject
from cramhy_runtime.lisp_core.classes import when_classes_change
from ..objects.classes import class_name, class_of, symbol_class
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from ..objects.structures import StructureObject
from cramhy_runtime.lisp_core.numbers import FIXNUM_LIMIT
from cramhy_runtime.lisp_core.packages import Package, is_symbol, sym
from cramhy_runtime.storage.dependency_tracing import run
from cramhy_runtime.lisp_core.ports import PORTS
from ..packages.package_errors import check_symbol
from ..syntax.declaration_names import check_type_name
from .specifier_shapes import bad_operator, bad_specifier, check_specifier, is_operator

LISP_NAMES = "typep type-of upgraded-complex-part-type"


# --------------------------------------------------------------------------------------------------------- atomic specifiers


def _is_function(obj):
    return callable(obj) and not isinstance(obj, (type, Symbol)) and obj.__class__ is not UndefinedFunction


def _is_generic_function(obj):
    """Also of a function that becomes one when a program defines a method on it."""
    return isinstance(obj, GenericFunction) or hasattr(obj.__class__, "acts_as_generic") or getattr(obj, "opening", None) is not None


def _is_string(obj):
    return isinstance(obj, (str, LispString)) or (obj.__class__ is Vector and obj.element_type in STRING_KINDS)


def _is_base_string(obj):
    return _is_string(obj) and element_type(obj) is BASE_CHAR


def _is_vector(obj):
    return isinstance(obj, (list, str, LispString, Vector, bytes, bytearray)) or (isinstance(obj, LispArray) and len(obj.dimensions) == 1)


def _is_array(obj):
    return isinstance(obj, (list, str, LispString, LispArray, bytes, bytearray))


def _is_simple(obj):
    return _is_array(obj) and is_simple(obj)


def _is_standard_character(obj):
    return obj.__class__ is Character and (obj.char == "\n" or " " <= obj.char <= "~")


_ATOMIC = {
    "ARRAY": _is_array,
    "SIMPLE-ARRAY": _is_simple,
    "VECTOR": _is_vector,
    "STRING": _is_string,
    "SIMPLE-STRING": lambda obj: _is_string(obj) and _is_simple(obj),
    "BASE-STRING": _is_base_string,
    "SIMPLE-BASE-STRING": lambda obj: _is_base_string(obj) and _is_simple(obj),
    "BIT-VECTOR": is_bit_vector,
    "SIMPLE-BIT-VECTOR": lambda obj: is_bit_vector(obj) and _is_simple(obj),
    "SIMPLE-VECTOR": lambda obj: obj.__class__ is list,
    "SEQUENCE": lambda obj: obj is None or obj is False or isinstance(obj, Cons) or _is_vector(obj),
    "LIST": lambda obj: obj is None or obj is False or isinstance(obj, Cons),
    "CONS": lambda obj: isinstance(obj, Cons),
    "ATOM": lambda obj: not isinstance(obj, Cons),
    "NULL": lambda obj: obj is None or obj is False,
    "SYMBOL": lambda obj: isinstance(obj, Symbol) or obj is None or obj.__class__ is bool,
    "KEYWORD": lambda obj: obj.__class__ is Keyword,
    "BOOLEAN": lambda obj: obj is None or obj.__class__ is bool,
    "CHARACTER": lambda obj: obj.__class__ is Character,
    "BASE-CHAR": lambda obj: obj.__class__ is Character and obj.char < "\x80",
    "STANDARD-CHAR": _is_standard_character,
    "EXTENDED-CHAR": lambda obj: obj.__class__ is Character and obj.char >= "\x80",
    "NUMBER": is_number,
    "REAL": is_real,
    "RATIONAL": is_rational,
    "INTEGER": is_integer,
    "RATIO": lambda obj: obj.__class__ is Fraction,
    "COMPLEX": lambda obj: isinstance(obj, complex),
    "FLOAT": lambda obj: isinstance(obj, float),
    "FIXNUM": lambda obj: is_integer(obj) and -FIXNUM_LIMIT <= obj < FIXNUM_LIMIT,
    "BIGNUM": lambda obj: is_integer(obj) and not -FIXNUM_LIMIT <= obj < FIXNUM_LIMIT,
    "BIT": lambda obj: is_integer(obj) and (obj == 0 or obj == 1),
    "UNSIGNED-BYTE": lambda obj: is_integer(obj) and obj >= 0,
    "SIGNED-BYTE": is_integer,
    "FUNCTION": _is_function,
    "COMPILED-FUNCTION": _is_function,
    "GENERIC-FUNCTION": _is_generic_function,
    "STANDARD-GENERIC-FUNCTION": _is_generic_function,
    "PACKAGE": lambda obj: isinstance(obj, Package),
    "PATHNAME": lambda obj: isinstance(obj, (Pathname, PurePath)),
    "CLASS": lambda obj: isinstance(obj, type),
    "STANDARD-CLASS": lambda obj: isinstance(obj, type) and issubclass(class_of(obj), StandardClass),
    "STRUCTURE-OBJECT": lambda obj: StructureObject in lisp_mro(obj.__class__),
    "STANDARD-OBJECT": lambda obj: StandardObject in lisp_mro(obj.__class__),
    "*": lambda obj: True,
}
for _name in ("SINGLE-FLOAT", "SHORT-FLOAT"):
    _ATOMIC[_name] = lambda obj: obj.__class__ is SingleFloat
for _name in ("DOUBLE-FLOAT", "LONG-FLOAT"):
    _ATOMIC[_name] = lambda obj: isinstance(obj, float) and obj.__class__ is not SingleFloat
_BUILT_IN = {sym(name): predicate for name, predicate in _ATOMIC.items()}
_predicates = dict(_BUILT_IN)
_compound: dict = {}
"""Predicates of list specifiers by the id of the list, with the list, which so stays alive."""

_expanders: dict = {}


@when_classes_change
def forget_predicates():
    """Drop what was computed: a class or a type has been defined again."""
    _predicates.clear()
    _predicates.update(_BUILT_IN)
    _compound.clear()


def typep(object, type_specifier, environment=None):
    """``cl:typep``: ``True`` or ``None``."""
    predicate = _predicates.get(type_specifier) if type_specifier.__class__ is Symbol else None
    return True if (predicate or type_predicate(type_specifier))(object) else None


def type_test(specifier):
    """As `type_predicate`, but ``None`` for what is no type."""
    known = _predicates.get(specifier) if specifier.__class__ is Symbol else None
    if known is not None:
        return known
    return type_predicate(specifier) if is_known_type(specifier) else None


def type_predicate(specifier):
    """The Python predicate (object -> truth value) for a type specifier; an unknown one is an error."""
    if isinstance(specifier, Symbol):
        return _predicates.get(specifier) or _symbol_predicate(specifier)
    if isinstance(specifier, Cons):
        known = _compound.get(id(specifier))
        if known is None:
            if len(_compound) > 5000:
                _compound.clear()
            known = _compound[id(specifier)] = (specifier, _compound_predicate(specifier))
        return known[1]
    if specifier is True:
        return lambda obj: True
    if specifier is None:
        return lambda obj: False
    if isinstance(specifier, type):
        return _class_predicate(specifier)
    return bad_specifier(specifier)


def declared_predicate(specifier):
    """As `type_predicate`, for a declaration: of a function type, which ``typep`` refuses, it tests that it is a function (ANSI 4.2.3)."""
    return type_predicate(_without_function_types(specifier))


def _without_function_types(specifier):
    head = specifier.car if isinstance(specifier, Cons) else specifier
    if isinstance(head, Symbol) and head in _expanders:
        expansion = expand_type(specifier)
        found = _without_function_types(expansion)
        return specifier if found is expansion else found
    if not isinstance(specifier, Cons) or head.__class__ is not Symbol or head.package is not _CL:
        return specifier
    if head.name == "FUNCTION":
        return head
    parts = python_list(specifier.cdr) if head.name in ("AND", "OR", "NOT", "CONS") else []
    found = list(map(_without_function_types, parts))
    return specifier if all(map(operator.is_, parts, found)) else Cons(head, list_from(found))


def _class_predicate(cls):
    if cls is object:
        return lambda obj: True
    if isinstance(cls, BuiltInClass):
        return lambda obj: cls in lisp_mro(obj.__class__)
    if cls is class_of(object):  # the class of the class T, which is Python's own
        return lambda obj: isinstance(obj, cls) or obj is object
    return lambda obj: isinstance(obj, cls) or cls in lisp_mro(obj.__class__)


def _symbol_predicate(symbol):
    if symbol in _expanders:
        predicate = type_predicate(expand_type(symbol))
    else:
        cls = symbol_class(symbol)
        if cls is None:
            return bad_operator(symbol) if is_operator(symbol) else unknown_type(symbol)
        predicate = _class_predicate(cls)
    _predicates[symbol] = predicate
    return predicate


def unknown_type(specifier):
    return error(SimpleError("unknown type specifier: ~S", specifier))


# ------------------------------------------------------------------------------------------------------- compound specifiers


def _compound_predicate(specifier):
    head = specifier.car
    if isinstance(head, Symbol) and head.package is _CL:
        maker = _MAKERS.get(head.name)
        return bad_specifier(specifier) if maker is None else maker(check_specifier(specifier), specifier)
    if isinstance(head, Symbol) and head in _expanders:
        return type_predicate(expand_type(specifier))
    if is_symbol(head):
        return bad_specifier(specifier) if head is True or head is None else unknown_type(specifier)
    return bad_specifier(specifier)


_CL = sym("CAR").package


def is_star(item):
    return isinstance(item, Symbol) and item.name == "*"


def _and(arguments, _):
    predicates = [type_predicate(argument) for argument in arguments]
    if len(predicates) == 2:
        first, second = predicates
        return lambda obj: first(obj) and second(obj)
    return lambda obj: all(predicate(obj) for predicate in predicates)


def _or(arguments, _):
    predicates = [type_predicate(argument) for argument in arguments]
    if len(predicates) == 2:
        first, second = predicates
        return lambda obj: first(obj) or second(obj)
    return lambda obj: any(predicate(obj) for predicate in predicates)


def _not(arguments, _):
    predicate = type_predicate(arguments[0])
    return lambda obj: not predicate(obj)


def _member(arguments, _):
    return lambda obj: any(eql(obj, argument) for argument in arguments)


def _satisfies(arguments, _):
    symbol = arguments[0]
    return lambda obj: truth(one(symbol.function(obj)))


def bounds(arguments):
    """(low, low is exclusive, high, high is exclusive) of a numeric specifier; ``None`` for no bound."""
    result = []
    for argument in [*arguments, None, None][:2]:
        exclusive = isinstance(argument, Cons)
        limit = argument.car if exclusive else argument
        result += [None if is_star(limit) else limit, exclusive]
    return result


def _range(kind):
    def make(arguments, _):
        low, above, high, below = bounds(arguments)
        predicate = _ATOMIC[kind]
        if kind == "INTEGER" and low.__class__ is high.__class__ is int:
            return _integers_between(low + above, high - below)

        def holds(obj):
            return (
                predicate(obj)
                and (low is None or (obj > low if above else obj >= low))
                and (high is None or (obj < high if below else obj <= high))
            )

        return holds

    return make


def _integers_between(least, greatest):
    """The predicate of the integers from ``least`` to ``greatest``."""
    return lambda obj: (obj.__class__ is int or is_integer(obj)) and least <= obj <= greatest


def _mod(arguments, _):
    return _integers_between(0, arguments[0] - 1)


def _unsigned_byte(arguments, _):
    if not arguments or is_star(arguments[0]):
        return _ATOMIC["UNSIGNED-BYTE"]
    return _integers_between(0, 2 ** arguments[0] - 1)


def _signed_byte(arguments, _):
    if not arguments or is_star(arguments[0]):
        return is_integer
    limit = 2 ** (arguments[0] - 1)
    return _integers_between(-limit, limit - 1)


def _cons(arguments, _):
    car, cdr = [(lambda obj: True) if is_star(part) else type_predicate(part) for part in [*arguments, True, True][:2]]
    return lambda obj: isinstance(obj, Cons) and car(obj.car) and cdr(obj.cdr)


def _sized(kind):
    def make(arguments, _):
        predicate, size = _ATOMIC[kind], arguments[0] if arguments else None
        if size is None or is_star(size):
            return predicate
        return lambda obj: predicate(obj) and dimensions(obj) == (size,)

    return make


def _vector(arguments, _):
    kind, size = [*arguments, sym("*"), sym("*")][:2]
    return _array_test(_is_vector, kind, size if is_star(size) else lisp_list(size))


def _array(kind):
    def make(arguments, _):
        element, shape = [*arguments, sym("*"), sym("*")][:2]
        return _array_test(_ATOMIC[kind], element, shape)

    return make


def _array_test(predicate, kind, shape):
    upgraded = None if is_star(kind) else upgraded_element_type(kind)
    wanted = [sym("*")] * shape if is_integer(shape) else None if is_star(shape) else list(shape or ())

    open_ended = wanted is None or len(wanted) == 1 and is_star(wanted[0])

    def holds(obj):
        if obj.__class__ is TypedVector and open_ended and obj.element_type is upgraded:  # every kind of array that `predicate` may ask for
            return True
        if not predicate(obj) or (not is_star(kind) and not same_specifier(element_type(obj), upgraded)):
            return False
        if wanted is None:
            return True
        found = dimensions(obj)
        return len(found) == len(wanted) and all(is_star(size) or size == given for size, given in zip(wanted, found))

    return holds


def same_specifier(first, second):
    """Whether two specifiers are equal as trees."""
    return equal(first, second) is not None


def _function(arguments, specifier):
    if arguments:
        return error(SimpleError("Function types are not a legal argument to TYPEP:~%  ~S", specifier))
    return _is_function


def _values(arguments, specifier):
    return error(SimpleError("VALUES type illegal in this context:~%  ~S", specifier))


def _complex(arguments, _):
    if not arguments or is_star(arguments[0]):
        return _ATOMIC["COMPLEX"]
    fits = type_predicate(arguments[0])
    return lambda obj: isinstance(obj, complex) and all(map(fits, parts(obj)))


_MAKERS = {
    "AND": _and,
    "OR": _or,
    "NOT": _not,
    "MEMBER": _member,
    "EQL": _member,
    "SATISFIES": _satisfies,
    "MOD": _mod,
    "CONS": _cons,
    "UNSIGNED-BYTE": _unsigned_byte,
    "SIGNED-BYTE": _signed_byte,
    "VECTOR": _vector,
    "ARRAY": _array("ARRAY"),
    "SIMPLE-ARRAY": _array("SIMPLE-ARRAY"),
    "FUNCTION": _function,
    "VALUES": _values,
    "COMPLEX": _complex,
    **{name: _range(name) for name in "INTEGER RATIONAL REAL FLOAT SINGLE-FLOAT DOUBLE-FLOAT SHORT-FLOAT LONG-FLOAT".split()},
    **{
        name: _sized(name)
        for name in """STRING SIMPLE-STRING BASE-STRING SIMPLE-BASE-STRING SIMPLE-VECTOR BIT-VECTOR
       SIMPLE-BIT-VECTOR""".split()
    },
}
COMPOUND_NAMES = frozenset(_MAKERS)
"""Names that head a compound type specifier; some, such as SATISFIES, are no types alone."""

# ------------------------------------------------------------------------------------------------------------------- deftype


def define_type(symbol, expander, documentation=None, lambda_list=None):
    """``deftype``: make ``symbol`` a type specifier; returns it.

    expander: a function of the whole specifier, a list ``(symbol . arguments)``, and an environment (nil), as macro functions
    are; it returns the specifier that is meant. Optional arguments default to ``*`` (ANSI 3.4.8), which the macro sees to.
    """
    check_symbol(symbol, "defining ~S as a type specifier", symbol)
    check_type_name(symbol)
    if symbol in _BUILT_IN:
        return error(SimpleError("~S is a type of Common Lisp and cannot be defined again. Choose another name.", symbol))
    expander.__doc__, expander.__lisp_lambda_list__ = documentation, lambda_list
    _expanders[symbol] = expander
    forget_predicates()
    return symbol


def define_own_type(symbol, predicate):
    """Make ``symbol`` a type of the runtime's own, of the objects for which the Python function ``predicate`` holds."""
    if symbol not in _BUILT_IN:
        _BUILT_IN[symbol] = _predicates[symbol] = predicate


def type_expander(symbol):
    """The function that ``deftype`` gave ``symbol``, with its documentation and lambda list; ``None`` when there is none."""
    return _expanders.get(symbol)


def expand_type(specifier):
    """``specifier`` with types of ``deftype`` expanded at its head, a class by its name; the same object if there is nothing to do."""
    if isinstance(specifier, type):
        name = class_name(specifier)
        return name if symbol_class(name) is specifier else specifier
    while True:
        head = specifier.car if isinstance(specifier, Cons) else specifier
        expander = _expanders.get(head) if isinstance(head, Symbol) else None
        if expander is None:
            return specifier
        form = specifier if isinstance(specifier, Cons) else lisp_list(specifier)
        specifier = one(run(expander, form, None))


def expand_without_parameters(specifier):
    """As `expand_type`, for a symbol whose ``deftype`` has no parameters; other specifiers as they are."""
    expander = _expanders.get(specifier) if specifier.__class__ is Symbol else None
    return specifier if expander is None or expander.__lisp_lambda_list__ is not None else expand_type(specifier)


def is_known_type(specifier):
    """Whether ``specifier`` names a type; used by checks that must not fail."""
    if isinstance(specifier, Symbol):
        return specifier in _BUILT_IN or specifier in _expanders or symbol_class(specifier) is not None
    return True


# ------------------------------------------------------------------------------------------------------------------- type-of


def type_of(object):
    """``cl:type-of``: what SBCL answers."""
    cls = object.__class__
    if cls is int:
        if object in (0, 1):
            return sym("BIT")
        if 0 <= object < FIXNUM_LIMIT:
            return lisp_list(sym("INTEGER"), 0, FIXNUM_LIMIT - 1)
        if -FIXNUM_LIMIT <= object < 0:
            return sym("FIXNUM")
        return lisp_list(sym("INTEGER"), FIXNUM_LIMIT) if object > 0 else sym("BIGNUM")
    if object is None or object is False:
        return sym("NULL")
    if object is True:
        return sym("BOOLEAN")
    if cls is Keyword:
        return sym("KEYWORD")
    if cls is Character:
        kind = "STANDARD-CHAR" if _is_standard_character(object) else "BASE-CHAR" if object.char < "\x80" else "EXTENDED-CHAR"
        return sym(kind)
    if isinstance(object, complex):
        return lisp_list(sym("COMPLEX"), _part_type(object))
    if _is_array(object):
        return array_type(object)
    if isinstance(object, FunctionType | BuiltinFunctionType):
        return sym("COMPILED-FUNCTION")
    cls = class_of(object)
    name = class_name(cls)
    return name if not isinstance(cls, StandardClass) or symbol_class(name) is cls else cls  # it may have lost its name


def _part_type(number):
    real, imaginary = parts(number)
    if isinstance(real, float):
        kind = class_name(class_of(real))
    else:
        kind = sym("INTEGER" if real.__class__ is imaginary.__class__ is int else "RATIONAL")
    return PORTS.types.simplified(lisp_list(kind, *sorted((real, imaginary))))


def upgraded_complex_part_type(typespec, environment=None):
    return typespec
