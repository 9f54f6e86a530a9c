"""Designators: descriptions of things that a plan talks about before it knows which thing it will be.

A designator is a list of ``(key value)`` pairs, ``(a motion (type driving) (speed 5))``, that is *resolved* when its meaning is needed:
a location to a pose, a motion to a command for a process module, an object to what perception saw. The list is kept as it was
given: ordered, with repeated keys, neither copied nor checked. Source: designators.md sections 2, 3 and 5.

Designators are equal by identity; that two describe the same thing is said by equating them, see ``equating.py``.
"""

from __future__ import annotations

import itertools
from weakref import ref

from ..lisp.condition_types import SimpleError, SimpleWarning
from ..lisp.conditions import error, type_error, warn
from ..lisp.data import UNBOUND, Cons, Keyword, Symbol, list_from
from ..lisp.dynamic import binding, special
from ..lisp.objects.classes import find_class_or_error
from ..lisp.objects.generic import GenericFunction, generic, when_methods_change
from ..lisp.objects.generic_errors import no_applicable_method
from ..lisp.objects.instances import make_instance, plan_for
from ..lisp.packages import is_symbol, keyword, near_names, symbol_name
from ..utilities.small_functions import current_timestamp
from .protocol import equate
from .symbols import DESIG_PROPS

A, ALL = keyword("A"), keyword("ALL")
DESCRIPTION = keyword("DESCRIPTION")
IN_ERROR_TEXT = special(Symbol("*IN-ERROR-TEXT*"))
"""Whether the text of an error is made, which must not become an error itself."""
_object_ids = itertools.count(1)
_live = {}  # a weak reference to each living designator, in the order of their making: a run must not depend on addresses
_classes = {}  # type keyword -> class, or the symbol that is to name it
_types = {}  # class -> the first keyword registered for it
_quick = {}  # type keyword -> class, for the kinds whose instances are made by their constructor alone


class DesignatorError(SimpleError):
    """Something about a designator is wrong, mostly that it cannot be resolved.

    ``hint`` is text for a student, why it could not be: ``None`` when there is nothing to say. It is found
    when somebody asks: by ``told``, a function of no arguments, or by ``explain``.
    """

    lisp_name = "CRAM-DESIGNATORS::DESIGNATOR-ERROR"
    initargs = {**SimpleError.initargs, "DESIGNATOR": "designator"}
    designator = None

    def report(self):
        if self.format_control is UNBOUND:
            return "DESIGNATOR-ERROR"
        with binding(IN_ERROR_TEXT, True):
            return super().report()

    @property
    def hint(self):
        if self.told is not None:
            return self.told()
        return self.explain(self.about) if self.about is not None else None

    told = None
    explain = None  # the function of hints.py, which knows the clauses that were tried
    about = None  # the designator that could not be resolved; the slot DESIGNATOR stays as the original leaves it


class Designator:
    """The root of all designators; see the table of slots in designators.md 2."""

    __slots__ = ("description", "parent", "successor", "effective", "timestamp", "data", "quantifier", "solutions",
                 "current_solution", "_object_id", "callbacks", "resolver", "__weakref__", "__dict__")
    lisp_name = "CRAM-DESIGNATORS::DESIGNATOR"
    initargs = {"DESCRIPTION": "description", "PARENT": "parent", "SUCCESSOR": "successor", "EFFECTIVE": "effective",
                "TIMESTAMP": "timestamp", "DATA": "data", "QUANTIFIER": "quantifier", "OBJECT-ID": "object_id",
                "SOLUTIONS": "solutions", "CURRENT-SOLUTION": "current_solution"}

    def __init__(self, description=None, parent=None):
        self.description = description
        self.parent = parent
        self.successor = None
        self.effective = None
        self.timestamp = None
        self.data = None
        self.quantifier = A
        self.solutions = UNBOUND
        self.current_solution = None
        self._object_id = None
        self.callbacks = None
        self.resolver = None  # the kernel task that resolves it now
        _live[ref(self, _live.pop)] = None

    @property
    def object_id(self):
        if self._object_id is None:
            self._object_id = Symbol(f"OBJ-ID-{next(_object_ids)}")
        return self._object_id

    @object_id.setter
    def object_id(self, new):
        self._object_id = new

    def __repr__(self):
        return f"<{type(self).__name__} {self.description!r}>"


class DesignatorIdMixin:
    """Designators with an ``object-id``; equated ones have the same."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::DESIGNATOR-ID-MIXIN"


class EquateNotificationMixin:
    """Designators that tell of being equated."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::EQUATE-NOTIFICATION-MIXIN"


class ObjectDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """An object in the world; perception sets its ``data``."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::OBJECT-DESIGNATOR"


class ActionDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """Something to be done; resolved by Prolog to a plan function and its arguments."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::ACTION-DESIGNATOR"


class MotionDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """A movement; resolved by Prolog to a command for a process module."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::MOTION-DESIGNATOR"


class LocationDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """A place; resolved by generators and validators."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::LOCATION-DESIGNATOR"


class HumanDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """A human; perception sets its ``data``."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::HUMAN-DESIGNATOR"


class ObjectDesignatorData:
    """What perception knows of an object: meant for the ``data`` of an object designator. Unset slots are unbound."""

    lisp_name = "CRAM-DESIGNATORS::OBJECT-DESIGNATOR-DATA"
    initargs = {"POSE": "pose", "COLOR": "color", "OBJECT-IDENTIFIER": "object_identifier"}

    def __init__(self, pose=UNBOUND, color=UNBOUND, object_identifier=None):
        self.pose, self.color = pose, color
        self.object_identifier = object_identifier or Symbol(f"OBJECT-{next(_object_ids)}")


def register_designator_class(type_, cls):
    """Make `make_designator` accept the keyword ``type_``; a later registration replaces an earlier one.

    ``cls`` may be a symbol that will name a class by the time that one is made.
    """
    _classes[type_] = cls
    _quick.pop(type_, None)
    _types.clear()
    for known, registered in _classes.items():
        _types.setdefault(registered, known)
    return type_


for _name, _class in (("OBJECT", ObjectDesignator), ("ACTION", ActionDesignator), ("MOTION", MotionDesignator),
                      ("LOCATION", LocationDesignator), ("HUMAN", HumanDesignator)):
    register_designator_class(keyword(_name), _class)

STANDARD = frozenset(_types)
"""The classes that come with CRAM."""


def type_keyword(designator):
    """The keyword of its exact class, or ``None`` if that is not registered."""
    return _types.get(designator.__class__)


def new(cls, description):
    """A designator of the class ``cls``, made as ``make-instance`` makes it."""
    if cls in STANDARD and not plan_for(cls).custom:
        return cls(description)
    return make_instance(cls, DESCRIPTION, description)


make_designator = generic("DESIG::MAKE-DESIGNATOR", "(class description &optional parent)", documentation="""
A new designator of the class that the keyword ``class`` stands for; equated to ``parent`` if there is one.""")


@make_designator.method(None, None)
def _make_designator(class_, description, parent=None):
    cls = _classes.get(class_)
    if cls is None:
        if not isinstance(class_, type):
            return _undefined_type(class_)
        cls = class_
    elif cls.__class__ is Symbol:
        cls = find_class_or_error(cls)
        register_designator_class(class_, cls)
    designator = new(cls, description)
    if parent is not None:
        equate(parent, designator)
    return designator


@when_methods_change
def _methods_changed(generic_function):
    _quick.clear()


class QuickMaking(GenericFunction):
    """``make-designator`` while nobody has added methods."""

    def __call__(self, *arguments):
        cls = None
        if len(arguments) == 2 and arguments[0].__class__ is Keyword:
            cls = _quick.get(arguments[0])
        if cls is not None:
            return cls(arguments[1])
        made = self.lookup(arguments)(*arguments)
        cls = made.__class__
        if cls in STANDARD and _classes.get(arguments[0]) is cls and not plan_for(cls).custom:
            _quick[arguments[0]] = cls
        return made


make_designator.take_shortcut(QuickMaking)


def _undefined_type(type_):
    known = sorted(key.name.lower() for key in _classes)
    name = symbol_name(type_).lower() if is_symbol(type_) else ""
    if name in known and not isinstance(type_, Keyword):
        hint = f"The type is a keyword: write :{name}."
    elif near := near_names(name, known):
        hint = f"Did you mean {' or '.join(near)}?"
    else:
        hint = f"The types of designators are {', '.join(known[:-1])} and {known[-1]}."
    return error(SimpleError("Designator type `~a' undefined", type_), hint=hint)


def make_all_designator(class_, description=None):
    """What the macro ``all`` makes: a designator with the quantifier ``:all``."""
    designator = make_designator(class_, description)
    designator.quantifier = ALL
    return designator


def get_all_designators():
    """All living designators, the oldest first."""
    return list_from(living())


def living():
    return [designator for reference in list(_live) if (designator := reference()) is not None]


# ------------------------------------------------------------------------------------------------------- derived designators


def merge_desig_descriptions(designator, new_description):
    """``new_description`` with the old pairs whose keys it lacks in front, reversed, one per key (designators.md 3.3)."""
    merged, keys = new_description, [pair.car for pair in pairs(new_description)]
    for pair in pairs_of(designator):
        if not any(key is pair.car for key in keys):
            merged = Cons(pair, merged)
            keys.append(pair.car)
    return merged


def copy_designator(old_designator, *, new_description=None):
    """A new, unequated designator of the same type with the merged description."""
    return make_designator(type_keyword(old_designator), merge_desig_descriptions(old_designator, new_description))


def extend_designator_properties(designator, property_extension):
    """A new, unequated designator of the same class, ``property_extension`` appended to the description."""
    return new(designator.__class__, list_from(list(pairs_of(designator)), property_extension))


def update_designator_properties(new_properties, old_properties):
    """``old_properties`` with each new one in front, in place of all of its key."""
    result = list(pairs(old_properties))
    for pair in pairs(new_properties):
        result = [pair, *(old for old in result if old.car is not pair.car)]
    return list_from(result)


def make_effective_designator(parent, *, new_properties=None, data_object=None, timestamp=None):
    """A new, unequated designator of the class of ``parent`` that is effective and stands for ``data_object``."""
    designator = new(parent.__class__, new_properties if new_properties is not None else parent.description)
    designator.data = data_object
    designator.effective = True
    designator.timestamp = current_timestamp() if timestamp is None else timestamp
    return designator


# ---------------------------------------------------------------------------------------------------------------- properties


def check_key(key):
    """Warn of a property name that is an ordinary symbol: keys are keywords."""
    if isinstance(key, Keyword) or not isinstance(key, Symbol) or key.package is None or key.package is DESIG_PROPS:
        return
    warn(SimpleWarning("Designator property ~s has not been declared properly. This may cause problems. To fix it, use the macro "
                       "DEF-DESIG-PACKAGE and declare the symbol as a designator property.", key))


def pairs(description):
    """The entries of a description, which must be lists; another one is a type-error, as in the original."""
    if description is not None and not isinstance(description, Cons):
        type_error(description, "LIST")
    for entry in description or ():
        yield entry if isinstance(entry, Cons) else type_error(entry, "LIST")


def pairs_of(designator):
    """The entries of its description."""
    if not isinstance(designator, Designator):
        no_applicable_method("CRAM-DESIGNATORS:DESCRIPTION", 1, designator)
    return pairs(designator.description)


def value_of(pair):
    """The second element of a property; nil if it has none."""
    rest = pair.cdr
    if isinstance(rest, Cons):
        return rest.car
    return None if rest is None else type_error(rest, "LIST")


def desig_prop_value(desig, prop_name):
    """The value of the first pair with the key ``prop_name``; nil if there is none, or no designator."""
    if prop_name.__class__ is not Keyword:
        check_key(prop_name)
    if desig is not None:
        for pair in pairs_of(desig):
            if pair.car is prop_name:
                return value_of(pair)
    return None


def desig_prop_values(designator, property_name):
    """The values of all pairs with the key ``property_name``, in order."""
    check_key(property_name)
    return list_from([value_of(pair) for pair in pairs_of(designator) if pair.car is property_name])
