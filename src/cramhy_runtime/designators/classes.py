"""Designators: descriptions of things that a plan talks about before it knows which thing it will be.

A designator is a list of ``(key value)`` pairs, ``(a motion (type driving) (speed 5))``. It is *resolved* when its meaning is needed:
a location to a pose, a motion to a command for a process module, an object to the data of perception. The list is kept as it was
given: ordered, with repeated keys, neither copied nor checked. Source: designators.md sections 2, 3 and 5.

Designators are equal by identity. Equating two says that they describe the same thing, see ``equating.py``.
"""

from __future__ import annotations

import functools
import itertools
from copy import deepcopy
from operator import call, is_not
from weakref import ref

from cramhy_runtime.kernel.images import Cell, per_image
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.lisp_core.condition_types import SimpleError, SimpleWarning
from cramhy_runtime.lisp_core.conditions import error, type_error, warn
from cramhy_runtime.lisp_core.data import UNBOUND, UNSUPPLIED, Cons, Keyword, Symbol, list_from
from cramhy_runtime.lisp_core.dynamic import binding, special
from cramhy_runtime.lisp_core.classes import find_class_or_error
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic, when_methods_change
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.classes import make_instance
from cramhy_runtime.lisp_core.packages import is_symbol, keyword, near_names, symbol_name
from cramhy_runtime.lisp_core.pickling import class_reference, referenced
from ..utilities.lazy_lists import LazyTail
from ..utilities.patterns import NOTHING
from ..utilities.small_functions import current_timestamp
from .protocol import equate
from .symbols import DESIG_PROPS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from cramhy_runtime.kernel import Task
    from .signatures import MakeDesignator

A, ALL = keyword("A"), keyword("ALL")
DESCRIPTION = keyword("DESCRIPTION")
IN_ERROR_TEXT = special(Symbol("*IN-ERROR-TEXT*"))
"""True while the text of an error is made, which must not cause an error itself."""
_object_ids = itertools.count(1)
_classes: dict[Any, Any] = per_image({})  # type keyword -> class, or the symbol that is to name it
_types: dict[type, Any] = per_image({})  # class -> the first keyword registered for it
_makers: dict[Any, Any] = per_image({})  # type keyword -> the function of a description that makes such a designator, until methods change


class DesignatorError(SimpleError):
    """An error of a ``designator``: mostly, it cannot be resolved.

    ``hint`` is a text for a student that says why, or ``None``. It is computed on demand: by ``told``, a function of no arguments, or by
    ``explain``.
    """

    lisp_name = "CRAM-DESIGNATORS::DESIGNATOR-ERROR"
    initargs = {**SimpleError.initargs, "DESIGNATOR": "designator"}
    designator: Designator | None = None

    def report(self) -> str:
        if self.format_control is UNBOUND:
            return "DESIGNATOR-ERROR"
        with binding(IN_ERROR_TEXT, True):
            return super().report()

    @property
    def hint(self) -> str | None:  # type: ignore[override]  # nobody sets it
        if self.told is not None:
            return self.told()
        return self.explain(self.about) if self.about is not None else None

    told: Callable[[], str | None] | None = None
    explain: Callable[[Designator], str | None] | None = None  # the function of hints.py, which knows the clauses that were tried
    about: Designator | None = None  # that could not be resolved; the slot DESIGNATOR stays as the original leaves it


class _Slots:
    """The slots of a designator. One is made as an object of this class, since assignments to a `Designator` are checked, which is slow."""

    __slots__ = (
        "description",
        "parent",
        "successor",
        "effective",
        "timestamp",
        "data",
        "quantifier",
        "solutions",
        "current_solution",
        "_object_id",
        "callbacks",
        "resolver",
        "_attached",
        "__weakref__",
    )
    if TYPE_CHECKING:
        description: Cons | None
        parent: Designator | None
        successor: Designator | None
        effective: bool | None
        timestamp: float | None
        data: Any
        quantifier: Keyword
        solutions: object
        current_solution: Any
        _object_id: object
        callbacks: list[Callable[[Designator], object]] | None
        resolver: Task[object] | None  # the kernel task that resolves it now
        _attached: dict[str, Any] | None


def setter(name: str) -> Callable[[Designator, object], None]:
    """The function that sets the slot ``name`` of a designator. An assignment is checked (``python_kinds.py``), and slower."""
    return getattr(_Slots, name).__set__  # type: ignore[no-any-return]


class _Living(list["ref[Designator]"]):
    """Weak references to designators, in the order of their making: a run must not depend on addresses.

    Those to designators that are gone stay for a while; a reference that removes itself takes as long as the rest of a designator.
    """

    __slots__ = ("limit",)

    def __init__(self) -> None:
        super().__init__()
        self.limit = 64

    def copy(self) -> _Living:
        """Those for another image."""
        found = _Living()
        found[:] = self
        return found

    def shorten(self) -> None:
        """Remove the references to designators that are gone."""
        self[:] = itertools.compress(self, map(_lives, map(call, self)))
        self.limit = 2 * len(self) + 64


_lives = functools.partial(is_not, None)
_live = Cell(_Living(), fresh=True)
_new = object.__new__


def _made(cls: Any, description: Cons | None = None) -> Any:
    """A designator of the class ``cls``: what `Designator.__init__` does, in one call, since plans make many."""
    made: Any = _new(_Slots)
    made.description = description
    made.parent = made.successor = made.effective = made.timestamp = made.data = None
    made.quantifier = A
    made.solutions = UNBOUND
    made.current_solution = made._object_id = made.callbacks = made.resolver = made._attached = None
    living_ones = _live.value
    living_ones.append(ref(made))
    if len(living_ones) > living_ones.limit:
        living_ones.shorten()
    made.__class__ = cls
    return made


class Designator(_Slots):
    """The root of all designators; see the table of slots in designators.md 2."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::DESIGNATOR"
    initargs = {
        "DESCRIPTION": "description",
        "PARENT": "parent",
        "SUCCESSOR": "successor",
        "EFFECTIVE": "effective",
        "TIMESTAMP": "timestamp",
        "DATA": "data",
        "QUANTIFIER": "quantifier",
        "OBJECT-ID": "object_id",
        "SOLUTIONS": "solutions",
        "CURRENT-SOLUTION": "current_solution",
    }

    def __init__(self, description: Cons | None = None, parent: Designator | None = None):
        like = _made(_Slots, description)
        for name in _Slots.__slots__[:-1]:  # all but __weakref__
            setattr(self, name, getattr(like, name))
        self.parent = parent
        _live.value.append(ref(self))

    @property
    def object_id(self) -> object:
        """A symbol for the thing. Equated designators have the same one."""
        if self._object_id is None:
            self._object_id = Symbol(f"OBJ-ID-{next(_object_ids)}")
        return self._object_id

    @object_id.setter
    def object_id(self, new: object) -> None:
        self._object_id = new

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.description!r}>"

    # A copy is a designator of its own, which is not equated to the old one. One that was pickled keeps those that it is equated to.

    def __copy__(self) -> Designator:
        made = blank(self.__class__)
        _fill(made, {name: value for name, value in _state(self).items() if name not in _EQUATED})
        return made

    def __deepcopy__(self, memo: dict[int, object]) -> Designator:
        made = memo[id(self)] = blank(self.__class__)
        lazy = _lazy_slot(self)
        state = {name: value for name, value in _state(self).items() if name not in _EQUATED}
        _fill(made, {name: value if name == lazy else deepcopy(value, memo) for name, value in state.items()})
        return made

    def __reduce__(self) -> tuple[object, ...]:
        state, lazy = _state(self), _lazy_slot(self)
        state[lazy] = _computed(state.get(lazy))
        return blank, class_reference(self.__class__), state

    def __setstate__(self, state: dict[str, object]) -> None:
        _fill(self, state)


def attached(designator: Designator) -> dict[str, Any]:
    """The dict in which rooms keep what they found out of ``designator``. Its copies know that, too."""
    found = designator._attached
    if found is None:
        found = designator._attached = {}
    return found


def blank(cls: type[Any], name: Symbol | None = None) -> Designator:
    """A designator of the class ``cls``, or of the one with the Lisp name ``name`` if there is one, with nothing in it."""
    cls = referenced(cls, name)
    made: Designator = cls.__new__(cls)
    Designator.__init__(made)
    return made


def _lazy_slot(designator: Any) -> str:
    """The name of the slot with the lazy list of the solutions."""
    return str(designator._lazy)


_EQUATED = ("parent", "successor", "_object_id")
_OF_THE_PROCESS = ("resolver", "callbacks", "__weakref__", "__dict__")


def _state(designator: Designator) -> dict[str, Any]:
    """The slots of ``designator`` that a copy has, too."""
    slots = [slot for cls in type(designator).__mro__ for slot in getattr(cls, "__slots__", ()) if slot not in _OF_THE_PROCESS]
    state = {slot: getattr(designator, slot) for slot in slots if hasattr(type(designator), slot) and _has(designator, slot)}
    if designator._attached:
        state["_attached"] = dict(designator._attached)
    return {**state, **getattr(designator, "__dict__", {})}


def _computed(solutions: Any) -> Any:
    """The solutions that were asked for already: the others are found by Prolog of this process."""
    items = []
    while isinstance(solutions, Cons):
        items.append(solutions.car)
        solutions = solutions.cdr
        if isinstance(solutions, LazyTail) and solutions.generator is None:
            solutions = solutions.value
    return list_from(items) if items else solutions


def _has(thing: object, slot: str) -> bool:
    try:
        object.__getattribute__(thing, slot)
    except AttributeError:
        return False
    return True


def _fill(designator: Designator, state: dict[str, object]) -> None:
    for name, value in state.items():
        setattr(designator, name, value)


Designator._lazy = "solutions"  # type: ignore[attr-defined]
"""The slot with the lazy list of the solutions."""
Designator._found = Designator.data  # type: ignore[attr-defined]
"""The slot with the value of an effective designator. Kinds of designators may name another slot."""


class DesignatorIdMixin:
    """Designators with an ``object-id``. Equated ones have the same."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::DESIGNATOR-ID-MIXIN"


class EquateNotificationMixin:
    """Designators that call callbacks when they are equated."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::EQUATE-NOTIFICATION-MIXIN"


class ObjectDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """An object in the world. Perception sets its ``data``."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::OBJECT-DESIGNATOR"


class ActionDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """An action. Prolog resolves it to a plan function and its arguments."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::ACTION-DESIGNATOR"


class MotionDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """A motion. Prolog resolves it to a command for a process module."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::MOTION-DESIGNATOR"


class LocationDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """A place. Generators and validators resolve it."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::LOCATION-DESIGNATOR"
    _lazy = "data"
    _found = Designator.current_solution  # its data is the list of the solutions that are left


class HumanDesignator(Designator, DesignatorIdMixin, EquateNotificationMixin):
    """A human. Perception sets its ``data``."""

    __slots__ = ()
    lisp_name = "CRAM-DESIGNATORS::HUMAN-DESIGNATOR"


class ObjectDesignatorData:
    """The knowledge of perception about an object, for the ``data`` of an object designator. Unset slots are unbound."""

    lisp_name = "CRAM-DESIGNATORS::OBJECT-DESIGNATOR-DATA"
    initargs = {"POSE": "pose", "COLOR": "color", "OBJECT-IDENTIFIER": "object_identifier"}

    def __init__(self, pose=UNBOUND, color=UNBOUND, object_identifier=None):
        self.pose, self.color = pose, color
        self.object_identifier = object_identifier or Symbol(f"OBJECT-{next(_object_ids)}")


def register_designator_class(type_, cls):
    """Let `make_designator` accept the keyword ``type_``. A later registration replaces an earlier one. Returns ``type_``.

    ``cls`` may be a symbol if it names a class by the time the first designator of this type is made.
    """
    _classes[type_] = cls
    _makers.clear()
    _types.clear()
    for known, registered in _classes.items():
        _types.setdefault(registered, known)
    return type_


for _name, _class in (
    ("OBJECT", ObjectDesignator),
    ("ACTION", ActionDesignator),
    ("MOTION", MotionDesignator),
    ("LOCATION", LocationDesignator),
    ("HUMAN", HumanDesignator),
):
    register_designator_class(keyword(_name), _class)

STANDARD = frozenset(_types)
"""The classes that come with CRAM."""


def type_keyword(designator):
    """The keyword for the exact class of ``designator``, or ``None`` if that is not registered."""
    return _types.get(designator.__class__)


def new(cls: Any, description: Any) -> Any:
    """A designator of the class ``cls``, made as ``make-instance`` makes it."""
    if cls in STANDARD and not PORTS.classes.customized(cls):
        return _made(cls, description)
    return _maker(cls)(description)


def _maker(cls: Any) -> Any:
    """The function of a description that makes a designator of the class ``cls`` as ``make-instance`` makes it.

    It is `_made`, if users have not customized how its objects are made.
    """
    if cls in STANDARD and not PORTS.classes.customized(cls):
        return functools.partial(_made, cls)
    return functools.partial(make_instance, cls, DESCRIPTION)


make_designator: MakeDesignator = generic(
    "DESIG::MAKE-DESIGNATOR",
    "(class description &optional parent)",
    documentation="""
A new designator of the class that the keyword ``class`` stands for. It is equated to ``parent`` if there is one.""",
)


@make_designator.call_directly
@make_designator.method(None, None)
def _make_designator(class_=UNSUPPLIED, description=UNSUPPLIED, parent=None, *more):
    if description is UNSUPPLIED or more:
        return make_designator.refuse(class_, description, parent, *more) if more else make_designator.refuse(class_)
    maker = _makers.get(class_)
    if maker is None:
        maker = _maker(_class_of_type(class_))
        if class_ in _classes:
            _makers[class_] = maker
    designator = maker(description)
    if parent is not None:
        equate(parent, designator)
    return designator


def _class_of_type(type_):
    """The class that the keyword ``type_`` stands for; a class stands for itself."""
    cls = _classes.get(type_)
    if cls is None:
        return type_ if isinstance(type_, type) else _undefined_type(type_)
    if cls.__class__ is Symbol:
        cls = find_class_or_error(cls)
        register_designator_class(type_, cls)
    return cls


@when_methods_change
def _methods_changed(generic_function):
    _makers.clear()


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


def make_all_designator(class_: Keyword, description: Cons | None = None) -> Designator:
    """A new designator with the quantifier ``:all``, as the macro ``all`` makes it. An unknown class is an error (designators.md 3.2)."""
    designator = make_designator(class_, description)
    designator.quantifier = ALL
    return designator


def get_all_designators() -> Cons | None:
    """All living designators, the oldest first."""
    return list_from(living())


def living() -> list[Designator]:
    """All living designators, the oldest first, as a Python list."""
    return [designator for reference in list(_live.value) if isinstance(designator := reference(), Designator)]


def keep_living(kept: Iterable[Designator]) -> None:
    """Let `get_all_designators` tell of no designator that exists now, save those in ``kept``."""
    numbers = {id(designator) for designator in kept}
    _live.value[:] = [reference for reference in _live.value if id(reference()) in numbers]


# ------------------------------------------------------------------------------------------------------- derived designators


def merge_desig_descriptions(designator, new_description):
    """``new_description``, with the old pairs for missing keys in front of it, reversed, one per key (designators.md 3.3)."""
    merged, keys = new_description, [pair.car for pair in pairs(new_description)]
    for pair in pairs_of(designator):
        if not any(key is pair.car for key in keys):
            merged = Cons(pair, merged)
            keys.append(pair.car)
    return merged


def copy_designator(old_designator, *, new_description=None):
    """A new designator of the same type with the merged description. It is not equated to the old one."""
    return make_designator(type_keyword(old_designator), merge_desig_descriptions(old_designator, new_description))


def extend_designator_properties(designator, property_extension):
    """A new designator of the same class, with ``property_extension`` at the end of the description. It is not equated to the old one."""
    return new(designator.__class__, list_from(list(pairs_of(designator)), property_extension))


def rename_designator_property_key(designator: Designator, old_property: object, new_property: object) -> Designator:
    """A new designator of the same class, in which the first property ``old_property`` is called ``new_property`` and stands at the end.

    It is not equated to the old one. Without such a property the new one is there all the same, with nothing behind its key, as in CRAM.
    """
    old = next((pair for pair in pairs_of(designator) if pair.car is old_property), None)
    rest = [pair for pair in pairs_of(designator) if pair is not old]
    made: Designator = new(designator.__class__, list_from([*rest, Cons(new_property, old.cdr if old is not None else None)]))
    return made


def update_designator_properties(new_properties, old_properties):
    """``old_properties`` with each new property in front, and without the old ones of its key."""
    result = list(pairs(old_properties))
    for pair in pairs(new_properties):
        result = [pair, *(old for old in result if old.car is not pair.car)]
    return list_from(result)


def make_effective_designator(parent, *, new_properties=None, data_object=None, timestamp=None):
    """A new designator of the class of ``parent`` that is effective and stands for ``data_object``. It is not equated to ``parent``.

    timestamp: seconds; the default is the present time.
    """
    if not isinstance(parent, Designator):
        return type_error(parent, "DESIGNATOR")
    designator = new(parent.__class__, new_properties if new_properties is not None else parent.description)
    designator.data = data_object
    designator.effective = True
    designator.timestamp = current_timestamp() if timestamp is None else timestamp
    return designator


# ---------------------------------------------------------------------------------------------------------------- properties


def check_key(key):
    """Warn if a property name is an ordinary symbol: keys are keywords."""
    if isinstance(key, Keyword) or not isinstance(key, Symbol) or key.package is None or key.package is DESIG_PROPS:
        return
    warn(
        SimpleWarning(
            "Designator property ~s has not been declared properly. This may cause problems. To fix it, use the macro "
            "DEF-DESIG-PACKAGE and declare the symbol as a designator property.",
            key,
        )
    )


def pairs(description):
    """Iterate over the entries of a description, which must be lists. Other entries are a type-error, as in the original."""
    if description is not None and not isinstance(description, Cons):
        type_error(description, "LIST")
    for entry in description or ():
        yield entry if isinstance(entry, Cons) else type_error(entry, "LIST")


def pairs_of(designator):
    """Iterate over the entries of the description of ``designator``."""
    if not isinstance(designator, Designator):
        no_applicable_method("CRAM-DESIGNATORS:DESCRIPTION", 1, designator)
    return pairs(designator.description)


def value_of(pair):
    """The second element of a property, or nil."""
    rest = pair.cdr
    if isinstance(rest, Cons):
        value = rest.car
        return None if value is False or value is NOTHING else value
    return None if rest is None else type_error(rest, "LIST")


def desig_prop_value(desig: Designator | None, prop_name: Symbol) -> Any:
    """The value of the first pair with the key ``prop_name``, a keyword. It is nil if there is none, or if ``desig`` is nil.

    A symbol that is not a keyword is a warning. Source: designators.md section 5.
    """
    if prop_name.__class__ is not Keyword:
        check_key(prop_name)
    if desig is not None:
        for pair in pairs_of(desig):
            if pair.car is prop_name:
                return value_of(pair)
    return None


def desig_prop_values(designator: Designator, property_name: Symbol) -> Cons | None:
    """The values of all pairs with the key ``property_name``, in order, as a Lisp list. Source: designators.md section 5."""
    check_key(property_name)
    values: Cons | None = list_from([value_of(pair) for pair in pairs_of(designator) if pair.car is property_name])
    return values
