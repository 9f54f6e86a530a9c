"""Types as sets of objects that can be met, joined and taken from each other: what ``subtypep`` reasons with.

The objects of Lisp fall into domains that have nothing in common: integers, ratios, floats of both kinds, complex numbers, characters,
symbols, conses, arrays, and instances of all other classes. A `TypeSet` has a part for each domain, in a form that is closed under the
three operations:

* reals and characters: cuts of a line, at which the set begins and ends in turn;
* symbols and element types: a finite set of names, or all but finitely many;
* conses and complex numbers: products of two sets, one for each component;
* arrays: boxes of kinds, element types and shapes;
* instances: conjunctions of classes and of complements of classes.

Objects that have an identity of their own (``(eql #<FOO>)``) stand beside the domains. A set is empty for sure, inhabited for sure,
or it depends on classes that somebody may still define: two classes of users without a common subclass may get one.
Source: ANSI 4.3; Boolean reasoning as in H. Baker, "A Decision Procedure for Common Lisp's SUBTYPEP Predicate", 1992.
"""

from __future__ import annotations

from fractions import Fraction
from math import copysign, inf

from cramhy_runtime.kernel.typing_names import NamedTuple
from cramhy_runtime.lisp_core.arrays import dimensions, element_type, is_simple
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Character, Cons, Keyword, Symbol
from cramhy_runtime.lisp_core.floats import SingleFloat
from ..numbers.complex_numbers import parts
from ..objects.builtin_classes import CLASSES, BuiltInClass, lisp_mro
from ..objects.classes import StructureClass

# --------------------------------------------------------------------------------------------------------------------- lines
# A cut is (value, side): before the value (0) or behind it (1). Between the cuts of 0.0, at 0.5, negative zero ends.

LOW, HIGH = (-inf, -1), (inf, 2)
WHOLE_LINE = (LOW, HIGH)
_EMPTY_LINE = ()


def _meet_lines(first, second):
    found, i, j = [], 0, 0
    while i < len(first) and j < len(second):
        begin, end = max(first[i], second[j]), min(first[i + 1], second[j + 1])
        if begin < end:
            found += [begin, end]
        if first[i + 1] <= second[j + 1]:
            i += 2
        else:
            j += 2
    return tuple(found)


def _complement_line(cuts, low, high):
    cuts = cuts[1:] if cuts[:1] == (low,) else (low, *cuts)
    return cuts[:-1] if cuts[-1:] == (high,) else (*cuts, high)


def _integer_cut(cut):
    """The cut of the integers at the same place, always before one: so equal sets have equal cuts."""
    value, side = cut
    if value in (inf, -inf):
        return cut
    floor = value.__floor__()
    return (floor + 1, 0) if side > 0 or floor != value else (floor, 0)


def _ratio_cut(cut):
    return (cut[0], 0) if abs(cut[0]) != inf and cut[0] == cut[0].__floor__() else cut


def _cleaned(cuts):
    return tuple(cut for index in range(0, len(cuts), 2) if cuts[index] < cuts[index + 1] for cut in cuts[index : index + 2])


def between(low, above, high, below):
    """The cuts of a range: ``low`` and ``high`` are limits or ``None``; ``above`` and ``below`` tell whether they are excluded."""
    begin = LOW if low is None else (low, 1 if above else 0)
    end = HIGH if high is None else (high, 0 if below else 1)
    return (begin, end) if begin < end else _EMPTY_LINE


# ------------------------------------------------------------------------------------------- finite sets and their complements


class Names(NamedTuple):
    """Some names, or with ``others`` all but these."""

    others: bool
    listed: frozenset

    def meet(self, other):
        if self.others and other.others:
            return Names(True, self.listed | other.listed)
        if self.others or other.others:
            positive, negative = (other, self) if self.others else (self, other)
            return Names(False, positive.listed - negative.listed)
        return Names(False, self.listed & other.listed)

    def complement(self):
        return Names(not self.others, self.listed)

    def has(self, name):
        return (name in self.listed) is not self.others

    def empty(self):
        return not self.others and not self.listed


ALL_NAMES, NO_NAMES = Names(True, frozenset()), Names(False, frozenset())

# --------------------------------------------------------------------------------------------------------------------- boxes


class Box(NamedTuple):
    """Arrays: simple or not, their element types, a shape (``None``, or a size or ``None`` for each dimension), shapes that are out."""

    simple: Names
    elements: Names
    shape: tuple | None
    without: tuple

    def meet(self, other):
        shape = _meet_shapes(self.shape, other.shape)
        return Box(self.simple.meet(other.simple), self.elements.meet(other.elements), shape, (*self.without, *other.without))

    def minus(self, other):
        """Boxes that have what is in this one and not in ``other``."""
        yield self.meet(Box(other.simple.complement(), ALL_NAMES, None, ()))
        yield self.meet(Box(other.simple, other.elements.complement(), None, ()))
        yield self.meet(Box(other.simple, other.elements, None, (other.shape,)))
        for shape in other.without:
            yield self.meet(Box(other.simple, other.elements, _meet_shapes(other.shape, shape), ()))

    def empty(self):
        simple = not any(map(self.simple.has, (True, False)))
        return simple or self.elements.empty() or self.shape is _NO_SHAPE or any(_meets_all(self.shape, out) for out in self.without)

    def has(self, array):
        shape = tuple(dimensions(array))
        return (
            self.simple.has(bool(is_simple(array)))
            and self.elements.has(element_key(element_type(array)))
            and _meets_all(shape, self.shape)
            and not any(_meets_all(shape, out) for out in self.without)
        )


_NO_SHAPE = "no shape"


def _meet_shapes(first, second):
    if first is None or second is None:
        return second if first is None else first
    if _NO_SHAPE in (first, second) or len(first) != len(second):
        return _NO_SHAPE
    sizes = [(one if other is None else other) for one, other in zip(first, second)]
    return tuple(sizes) if all(one in (None, size) for one, size in zip(first, sizes)) else _NO_SHAPE


def _meets_all(shape, pattern):
    """Whether all arrays of ``shape`` are of ``pattern``."""
    if pattern is None or shape is _NO_SHAPE:
        return True
    if shape is None or pattern is _NO_SHAPE or len(shape) != len(pattern):
        return False
    return all(wanted is None or wanted == size for size, wanted in zip(shape, pattern))


def element_key(upgraded):
    """A name for an upgraded element type: ``(unsigned-byte 8)`` and T are not symbols."""
    return (upgraded.car.name, upgraded.cdr.car) if isinstance(upgraded, Cons) else upgraded


# ------------------------------------------------------------------------------------------------------------------- classes


def is_subclass(cls, other):
    """Whether all instances of the class ``cls`` are instances of ``other``."""
    return other in lisp_mro(cls) or issubclass(cls, other)


def _kind(cls):
    """``None`` for classes that may get common subclasses with any other; else what keeps their instances apart."""
    if issubclass(cls, Condition):
        return "condition"
    if isinstance(cls, StructureClass):
        return "structure"
    if isinstance(cls, BuiltInClass):
        return None if cls in (CLASSES["FUNCTION"], CLASSES["STREAM"]) else "built-in"
    return None if any(open_class in lisp_mro(cls) for open_class in (CLASSES["FUNCTION"], CLASSES["STREAM"])) else "standard"


def _apart(one, other):
    """Whether two unrelated classes can never have a common subclass."""
    kinds = {_kind(one), _kind(other)}
    return bool(kinds & {"structure", "built-in"}) or kinds == {"condition", "standard"} or kinds == {"condition", None}


def _subclasses(cls):
    for below in type.__subclasses__(cls):
        yield below
        yield from _subclasses(below)


class Classes(NamedTuple):
    """The instances of all classes ``inside`` that are instances of none ``outside``."""

    inside: frozenset
    outside: frozenset

    def meet(self, other):
        return Classes(self.inside | other.inside, self.outside | other.outside)

    def minus(self, other):
        """The instances here that are not in ``other``, class by class."""
        for cls in other.inside:
            yield Classes(self.inside, self.outside | {cls})
        for cls in other.outside:
            yield Classes(self.inside | {cls}, self.outside)

    def has(self, obj):
        above = lisp_mro(type(obj))
        return all(cls in above or isinstance(obj, cls) for cls in self.inside) and not any(
            cls in above or isinstance(obj, cls) for cls in self.outside
        )

    def empty(self):
        """Whether there can be no instances: ``None`` when a class that is not defined yet would decide."""
        if any(is_subclass(cls, out) for cls in self.inside for out in self.outside):
            return True
        least = [cls for cls in self.inside if not any(other is not cls and is_subclass(other, cls) for other in self.inside)]
        if len(least) < 2:
            return False
        common = [cls for cls in _subclasses(least[0]) if all(is_subclass(cls, other) for other in least)]
        if any(not any(is_subclass(cls, out) for out in self.outside) for cls in common):
            return False
        return True if not common and any(_apart(one, other) for one in least for other in least if one is not other) else None


# ------------------------------------------------------------------------------------------------------------------- domains


def _all_empty(answers):
    unknown = False
    for answer in answers:
        if answer is False:
            return False
        unknown = unknown or answer is None
    return None if unknown else True


class _Line:
    """The algebra of cuts between two ends."""

    def __init__(self, low=LOW, high=HIGH):
        self.all = (low, high)

    meet = staticmethod(_meet_lines)

    def join(self, first, second):
        return self.complement(_meet_lines(self.complement(first), self.complement(second)))

    def complement(self, cuts):
        return _complement_line(cuts, *self.all)

    def minus(self, first, second):
        return _meet_lines(first, self.complement(second))

    @staticmethod
    def empty(cuts):
        return not cuts


class _Named:
    """The algebra of finite sets of names and of their complements."""

    all = ALL_NAMES
    meet, empty = Names.meet, Names.empty

    @staticmethod
    def join(first, second):
        return first.complement().meet(second.complement()).complement()

    @staticmethod
    def minus(first, second):
        return first.meet(second.complement())


class _Union:
    """The algebra of unions of parts, which are tuples. ``all`` is the part that contains all others."""

    def __init__(self, meet, minus, empty):
        self._meet, self._minus, self._empty = meet, minus, empty
        self.all = ()

    def meet(self, first, second):
        return self._inhabited(self._meet(one, two) for one in first for two in second)

    def _inhabited(self, parts):
        return tuple(part for part in parts if self._empty(part) is not True)

    @staticmethod
    def join(first, second):
        return (*first, *(part for part in second if part not in first))

    def minus(self, first, second):
        for two in second:
            first = self._inhabited(part for one in first for part in self._minus(one, two))
        return first

    def empty(self, parts):
        return _all_empty(map(self._empty, parts))


def _meet_pairs(one, other):
    return one[0].meet(other[0]), one[1].meet(other[1])


def _minus_pair(one, other):
    yield one[0].minus(other[0]), one[1]
    yield one[0].meet(other[0]), one[1].minus(other[1])


def _empty_pair(pair):
    answers = [part.empty() for part in pair]
    return True if True in answers else None if None in answers else False


_DOMAINS = {
    **{name: _Line() for name in ("integers", "ratios", "singles", "doubles")},
    "characters": _Line((0, 0), (0x110000, 0)),
    "symbols": _Named,
    "keywords": _Named,
    "complexes": _Union(_meet_pairs, _minus_pair, _empty_pair),
    "conses": _Union(_meet_pairs, _minus_pair, _empty_pair),
    "arrays": _Union(Box.meet, Box.minus, Box.empty),
    "instances": _Union(Classes.meet, Classes.minus, Classes.empty),
}

# ----------------------------------------------------------------------------------------------------------------- type sets


class TypeSet:
    """A set of objects.

    domains: what is in the set of each domain, by name; a domain that is not named has nothing in it. named: pairs of an object and whether
    it is in the set, for objects with an identity of their own, of which the domains know only the kind. Sets with the same objects need
    not look equal; `minus` tells.
    """

    __slots__ = ("domains", "named")

    def __init__(self, named=(), **domains):
        self.domains, self.named = domains, named

    def meet(self, other):
        if self is EVERYTHING or other is EVERYTHING:
            return other if self is EVERYTHING else self
        others = other.domains
        domains = {name: _DOMAINS[name].meet(part, others[name]) for name, part in self.domains.items() if name in others}
        return TypeSet(self._named_with(other, lambda one, two: one and two), **domains)

    def join(self, other):
        if self is EVERYTHING or other is EVERYTHING:
            return EVERYTHING
        if not self.domains and not self.named:
            return other
        domains = {**self.domains, **other.domains}
        for name in self.domains.keys() & other.domains.keys():
            domains[name] = _DOMAINS[name].join(self.domains[name], other.domains[name])
        return TypeSet(self._named_with(other, lambda one, two: one or two), **domains)

    def minus(self, other):
        """The objects of this set that are not in ``other``."""
        if other is EVERYTHING:
            return NOTHING
        others, domains = other.domains, {}
        for name, part in self.domains.items():
            domains[name] = _DOMAINS[name].minus(part, others[name]) if name in others else part
        return TypeSet(self._named_with(other, lambda one, two: one and not two), **domains)

    def complement(self):
        return NOTHING if self is EVERYTHING else EVERYTHING if self is NOTHING else EVERYTHING.minus(self)

    def _named_with(self, other, combine):
        if not self.named and not other.named:
            return ()
        objects = [obj for obj, _ in self.named]
        objects += [obj for obj, _ in other.named if not any(obj is known for known in objects)]
        return tuple((obj, combine(self.has(obj), other.has(obj))) for obj in objects)

    def empty(self):
        """``True``, ``False``, or ``None`` when classes that are not defined yet would decide."""
        if self is EVERYTHING or any(inside for _, inside in self.named):
            return False
        return _all_empty(_DOMAINS[name].empty(part) for name, part in self.domains.items())

    def has(self, obj):
        """Whether ``obj`` is in the set."""
        for known, inside in self.named:
            if known is obj:
                return inside
        domain, point = _point(obj)
        part = self.domains.get(domain)
        if part is None or self is EVERYTHING:
            return part is not None
        if isinstance(part, Names):
            return part.has(point)
        if domain in ("arrays", "instances"):
            return any(each.has(obj) for each in part)
        if domain in ("conses", "complexes"):
            return any(first.has(point[0]) and second.has(point[1]) for first, second in part)
        return any(part[index] <= point < part[index + 1] for index in range(0, len(part), 2))


def _point(obj):
    """The domain of an object, and where in the domain it is."""
    if obj is None or obj.__class__ is bool or isinstance(obj, Symbol):
        return "keywords" if obj.__class__ is Keyword else "symbols", obj or None
    line = line_of(obj)
    if line is not None:
        return line, (obj if obj == obj else inf, 0.5 if _is_plus_zero(obj) else 0)
    if obj.__class__ is Character:
        return "characters", (ord(obj.char), 0)
    if isinstance(obj, Cons):
        return "conses", (obj.car, obj.cdr)
    if isinstance(obj, complex):
        return "complexes", parts(obj)
    return "arrays" if CLASSES["ARRAY"] in lisp_mro(type(obj)) else "instances", obj


def line_of(obj):
    """The domain of a real number; ``None`` for other objects."""
    if obj.__class__ is int:
        return "integers"
    if isinstance(obj, float):
        return "singles" if obj.__class__ is SingleFloat else "doubles"
    return "ratios" if isinstance(obj, Fraction) else None


def _is_plus_zero(obj):
    return obj == 0 and isinstance(obj, float) and copysign(1, obj) > 0


def reals(lines, cuts):
    """The set of the numbers of the domains ``lines`` that lie within ``cuts``."""
    at = {"integers": _integer_cut, "ratios": _ratio_cut}
    return TypeSet(**{line: _cleaned(tuple(map(at[line], cuts))) if line in at else cuts for line in lines})


def only(obj):
    """The set of one object, in the sense of ``eql``."""
    if obj is None or obj.__class__ is bool or isinstance(obj, Symbol):
        domain, name = _point(obj)
        return TypeSet(**{domain: Names(False, frozenset([name]))})
    line = line_of(obj)
    if line in ("singles", "doubles") and obj == 0:
        return TypeSet(**{line: ((0, 0.5), (0, 1)) if _is_plus_zero(obj) else ((0, 0), (0, 0.5))})
    if line is not None and obj == obj:
        return reals([line], ((obj, 0), (obj, 1)))
    if obj.__class__ is Character:
        return TypeSet(characters=((ord(obj.char), 0), (ord(obj.char) + 1, 0)))
    if isinstance(obj, complex):
        return TypeSet(complexes=(tuple(map(only, parts(obj))),))
    return TypeSet(named=((obj, True),))


NOTHING = TypeSet()
EVERYTHING = TypeSet()
for _name, _line in (("complexes", ("integers", "ratios")), ("complexes", ("singles",)), ("complexes", ("doubles",))):
    _DOMAINS[_name].all += ((reals(_line, WHOLE_LINE),) * 2,)
_DOMAINS["conses"].all = ((EVERYTHING, EVERYTHING),)
_DOMAINS["arrays"].all = (Box(ALL_NAMES, ALL_NAMES, None, ()),)
_DOMAINS["instances"].all = (Classes(frozenset(), frozenset()),)
EVERYTHING.domains = {name: domain.all for name, domain in _DOMAINS.items()}


def all_of(*domains):
    """All objects of the ``domains``."""
    return TypeSet(**{name: EVERYTHING.domains[name] for name in domains})
