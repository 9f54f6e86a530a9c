"""``subtypep``: is every object of one type also of another?

The specifiers are turned into sets of objects (``type_sets.py``), and the answer is whether what lies in the first and not in the second
is empty. What a specifier says only by a Lisp function (``satisfies``), and a type that is not defined, may be any set: such parts are
tried as nothing and as everything, and an answer that depends on the choice is unknown (second value ``nil``). Source: ANSI SUBTYPEP;
checked against SBCL.
"""

from __future__ import annotations

from itertools import product

from cramhy_runtime.lisp_core.conditions import SimpleError, error
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol
from cramhy_runtime.lisp_core.packages import sym
from ..collections.element_types import upgraded_element_type
from ..objects.builtin_classes import CLASSES, BuiltInClass, lisp_mro
from ..objects.classes import class_name, symbol_class
from .type_sets import ALL_NAMES, EVERYTHING, NOTHING, WHOLE_LINE, Box, Classes, Names, TypeSet, all_of, between, element_key, only, reals
from .specifier_shapes import bad_operator, bad_specifier, check_specifier, is_operator
from .types import bounds, expand_type, is_known_type, is_star, same_specifier

LISP_NAMES = "subtypep"

_CL = sym("CAR").package
_FIXNUMS = (-(2**62), 2**62 - 1)
_REALS = {
    "INTEGER": ("integers",),
    "RATIONAL": ("integers", "ratios"),
    "SINGLE-FLOAT": ("singles",),
    "SHORT-FLOAT": ("singles",),
    "DOUBLE-FLOAT": ("doubles",),
    "LONG-FLOAT": ("doubles",),
    "FLOAT": ("singles", "doubles"),
    "REAL": ("integers", "ratios", "singles", "doubles"),
}
"""Types of reals with a low and a high limit → the lines that they lie on."""


def _integers(low, high):
    return reals(["integers"], between(low, False, high, False))


def _characters(*ranges):
    return TypeSet(characters=tuple((limit, 0) for limits in ranges for limit in limits))


def _union(*sets):
    result = NOTHING
    for each in sets:
        result = result.join(each)
    return result


def _arrays(simple=None, elements=None, shape=None):
    """The arrays that are simple, if that is asked for, of one of the element types, of the shape."""
    kinds = Names(False, frozenset([True])) if simple else ALL_NAMES
    named = ALL_NAMES if elements is None else Names(False, frozenset(map(element_key, elements)))
    return TypeSet(arrays=(Box(kinds, named, shape, ()),))


_OF_CHARACTERS, _OF_BASE_CHARACTERS = [sym("CHARACTER"), sym("BASE-CHAR")], [sym("BASE-CHAR")]
_VECTORS = {
    "VECTOR": (False, None),
    "SIMPLE-VECTOR": (True, [True]),
    "STRING": (False, _OF_CHARACTERS),
    "SIMPLE-STRING": (True, _OF_CHARACTERS),
    "BASE-STRING": (False, _OF_BASE_CHARACTERS),
    "SIMPLE-BASE-STRING": (True, _OF_BASE_CHARACTERS),
    "BIT-VECTOR": (False, [sym("BIT")]),
    "SIMPLE-BIT-VECTOR": (True, [sym("BIT")]),
}
"""Kinds of vectors: whether they are simple, and their element types."""
_FUNCTIONS = TypeSet(instances=(Classes(frozenset([CLASSES["FUNCTION"]]), frozenset()),))
_CONSES, _COMPLEXES, _CHARACTERS = all_of("conses"), all_of("complexes"), all_of("characters")
_BASE_RANGE, _STANDARD_RANGES = (0, 128), ((10, 11), (32, 127))
_PREDICATES = {
    **{f"{name}P": name for name in "ARRAY CONS FLOAT FUNCTION INTEGER KEYWORD LIST NUMBER PACKAGE RATIONAL REAL STREAM".split()},
    **{f"{name}P": name for name in "CHARACTER COMPLEX PATHNAME STRING SYMBOL VECTOR".split()},
    **{f"{name}-P": name for name in "BIT-VECTOR HASH-TABLE SIMPLE-BIT-VECTOR SIMPLE-STRING SIMPLE-VECTOR RANDOM-STATE".split()},
    **{name: name for name in ("ATOM", "NULL")},
    "READTABLEP": "READTABLE",
}
"""What the predicates of the standard say: (satisfies symbolp) is the type SYMBOL."""
_PLAIN = {
    "ATOM": _CONSES.complement(),
    "CONS": _CONSES,
    "NULL": only(None),
    "BOOLEAN": only(None).join(only(True)),
    "LIST": _CONSES.join(only(None)),
    "SEQUENCE": _union(_CONSES, only(None), _arrays(shape=(None,))),
    "SYMBOL": all_of("symbols", "keywords"),
    "KEYWORD": all_of("keywords"),
    "NUMBER": all_of("complexes", *_REALS["REAL"]),
    "COMPLEX": _COMPLEXES,
    "RATIO": reals(["ratios"], WHOLE_LINE),
    "BIT": _integers(0, 1),
    "FIXNUM": _integers(*_FIXNUMS),
    "BIGNUM": _integers(None, _FIXNUMS[0] - 1).join(_integers(_FIXNUMS[1] + 1, None)),
    "UNSIGNED-BYTE": _integers(0, None),
    "SIGNED-BYTE": _integers(None, None),
    "CHARACTER": _CHARACTERS,
    "BASE-CHAR": _characters(_BASE_RANGE),
    "EXTENDED-CHAR": _CHARACTERS.minus(_characters(_BASE_RANGE)),
    "STANDARD-CHAR": _characters(*_STANDARD_RANGES),
    "ARRAY": all_of("arrays"),
    "SIMPLE-ARRAY": _arrays(simple=True),
    "*": EVERYTHING,
    **{name: reals(lines, WHOLE_LINE) for name, lines in _REALS.items()},
    **{name: _arrays(simple, elements, (None,)) for name, (simple, elements) in _VECTORS.items()},
}
"""The types that a name of Common Lisp stands for, without those that are classes of instances."""


def subtypep(type_1, type_2, environment=None):
    """``cl:subtypep``: two values, whether it is so, and whether that is certain."""
    answer = _is_subtype(type_1, type_2)
    return MultipleValues((True if answer else None, None if answer is None else True))


_MOST_PARTS = 6
"""Types with more parts that may be anything are not compared: each doubles the work."""


def _is_subtype(first, second):
    if first is second and (first is None or first is True or isinstance(first, (type, Symbol))):
        return True
    unknown = _Parts()
    difference = _difference(first, second, _Reading(unknown, ()))
    if not unknown:
        return difference.empty()
    if len(unknown) > _MOST_PARTS:
        return None
    differences = [_difference(first, second, _Reading(unknown, choice)) for choice in product((False, True), repeat=len(unknown))]
    if all(difference.empty() for difference in differences):
        return True
    always = EVERYTHING
    for difference in differences:
        always = always.meet(difference)
    return False if always.empty() is False or _has_no_functions(first, second, unknown) else None


def _has_no_functions(first, second, unknown):
    """Whether ``first`` is a type of functions with arguments, which has members, and ``second`` has no functions, or no plain ones."""
    if not isinstance(first, Cons) or first.car is not sym("FUNCTION"):
        return False
    readings = [_Reading(unknown, choice) for choice in product((False, True), repeat=len(unknown))]
    plain = _FUNCTIONS
    for others in ("GENERIC-FUNCTION", "STANDARD-OBJECT", "STREAM"):
        plain = plain.minus(readings[0].of(sym(others)))
    return all(plain.meet(reading.of(second)).empty() for reading in readings)


def _difference(first, second, reading):
    return reading.of(first).minus(reading.of(second))


class _Parts(list):
    """The parts that may be any set: pairs of a specifier and the component of the objects that it speaks about."""

    def index_of(self, specifier, place):
        for index, (known, its_place) in enumerate(self):
            if its_place == place and same_specifier(known, specifier):
                return index
        self.append((specifier, place))
        return len(self) - 1


class _Reading:
    """Reads specifiers as sets of objects.

    unknown: the `_Parts` met so far. choice: for each of them whether it is everything; those that have no choice yet are nothing.
    """

    def __init__(self, unknown, choice):
        self.unknown, self.choice, self.place = unknown, choice, ""

    def of(self, specifier):
        """The `TypeSet` of a type specifier."""
        specifier = expand_type(specifier)
        if specifier is True or specifier is None or specifier is False:
            return EVERYTHING if specifier else NOTHING
        if isinstance(specifier, Cons):
            return self._compound(specifier, specifier.car)
        if isinstance(specifier, type):
            return self._class(specifier)
        if not isinstance(specifier, Symbol):
            return bad_specifier(specifier)
        if specifier.package is _CL and specifier.name in _PLAIN:
            return _PLAIN[specifier.name]
        if is_operator(specifier):
            return bad_operator(specifier)
        cls = symbol_class(specifier)
        return self._anything(specifier) if cls is None else self._class(cls)

    def _anything(self, specifier, within=EVERYTHING):
        index = self.unknown.index_of(specifier, self.place)
        return within if index < len(self.choice) and self.choice[index] else NOTHING

    def _class(self, cls):
        if cls is object:
            return EVERYTHING
        system = next((above for above in lisp_mro(cls) if isinstance(above, BuiltInClass) and vars(above)["lisp_name"] in _PLAIN), None)
        if system is not None:
            name = class_name(cls)
            if isinstance(name, Symbol) and name.package is _CL and name.name in _PLAIN:
                return _PLAIN[name.name]
            return self._anything(name, _PLAIN[vars(system)["lisp_name"]])
        return TypeSet(instances=(Classes(frozenset([cls]), frozenset()),))

    def _compound(self, specifier, head):
        if head is True or head is None or not isinstance(head, Symbol):
            return bad_specifier(specifier)
        if head.package is not _CL:
            return self._anything(specifier)
        name, arguments = head.name, check_specifier(specifier)
        if name in _REALS:
            return reals(_REALS[name], between(*bounds(arguments)))
        if name in _VECTORS and name != "VECTOR":
            return _arrays(*_VECTORS[name], (_size(arguments),))
        reader = getattr(self, f"_{name.lower().replace('-', '_')}_type", None)
        if reader is None:
            return bad_specifier(specifier) if is_known_type(head) else self._anything(specifier)
        return reader(arguments, specifier)

    def _and_type(self, arguments, _):
        result = EVERYTHING
        for argument in arguments:
            result = result.meet(self.of(argument))
        return result

    def _or_type(self, arguments, _):
        return _union(*map(self.of, arguments))

    def _not_type(self, arguments, _):
        return self.of(arguments[0]).complement()

    def _member_type(self, arguments, _):
        return _union(*map(only, arguments))

    _eql_type = _member_type

    def _satisfies_type(self, arguments, specifier):
        name = arguments[0]
        known = _PREDICATES.get(name.name) if isinstance(name, Symbol) and name.package is _CL else None
        return self._anything(specifier) if known is None else self.of(sym(known))

    def _mod_type(self, arguments, _):
        return _integers(0, arguments[0] - 1)

    def _unsigned_byte_type(self, arguments, _):
        return _integers(0, None) if _unlimited(arguments) else _integers(0, 2 ** arguments[0] - 1)

    def _signed_byte_type(self, arguments, _):
        limit = None if _unlimited(arguments) else 2 ** (arguments[0] - 1)
        return _integers(None, None) if limit is None else _integers(-limit, limit - 1)

    def _cons_type(self, arguments, _):
        return TypeSet(conses=(tuple(self._component(each, place) for each, place in zip([*arguments, True, True], "ad")),))

    def _component(self, specifier, place):
        whole, self.place = self.place, self.place + place
        try:
            return EVERYTHING if is_star(specifier) else self.of(specifier)
        finally:
            self.place = whole

    def _complex_type(self, arguments, _):
        if _unlimited(arguments):
            return _COMPLEXES
        part = self._component(arguments[0], "c")
        if part.minus(_PLAIN["REAL"]).empty() is False:
            return error(SimpleError("The component type for COMPLEX is not a subtype of REAL: ~S", arguments[0]))
        return _COMPLEXES.meet(TypeSet(complexes=((part, part),)))

    def _array_type(self, arguments, _):
        return self._array(False, arguments)

    def _simple_array_type(self, arguments, _):
        return self._array(True, arguments)

    def _array(self, simple, arguments):
        element, shape = [*arguments, sym("*"), sym("*")][:2]
        sizes = [sym("*")] * shape if isinstance(shape, int) else list(shape or ()) if not is_star(shape) else None
        return _arrays(simple, _elements(element), None if sizes is None else tuple(None if is_star(size) else size for size in sizes))

    def _vector_type(self, arguments, _):
        return _arrays(False, None if _unlimited(arguments) else _elements(arguments[0]), (_size(arguments[1:]),))

    def _function_type(self, arguments, specifier):
        return self._anything(specifier, _FUNCTIONS) if arguments else _FUNCTIONS

    def _values_type(self, _, specifier):
        return error(SimpleError("VALUES type illegal in this context:~%  ~S", specifier))


def _unlimited(arguments):
    return not arguments or is_star(arguments[0])


def _size(arguments):
    return None if _unlimited(arguments) else arguments[0]


def _elements(specifier):
    return None if is_star(specifier) else [upgraded_element_type(specifier)]
