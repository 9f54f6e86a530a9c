"""Designators in Python's notation: ``Motion(type=kw.driving, speed=1.5)`` is ``(a motion (type driving) (speed 1.5))``.

`Motion`, `Action`, `Location`, `Object` and `Human` make designators. A class derived from one of them declares a type, as a dataclass
does:

    class Driving(Motion):              # the type :driving
        speed: float                    # m/s
        angle: float = 0.0

    motion = Driving(speed=1.5)

The result is a designator like any other. A description of the same type that was written in Lisp is a ``Driving``, too: `isinstance`
looks at the kind, the type, and whether the properties without default are there. So ``match`` works as well.

Attributes (``motion.speed``) or items (``motion["speed"]``) read properties. Properties never change; `replace` makes a new designator.
A key in ``Python_style`` is the keyword ``:python-style``. ``None`` leaves a property out, as ``(when ...)`` does. Values are converted as
in Prolog (``prolog/python/terms.py``): strings are strings, and names, like those of types, are keywords, ``kw.driving``. Pairs in front
give several values for one key, and names that Python does not allow: ``Motion(("goal", 1), ("goal", 2), type=kw.driving)``.
Designators are equal by identity, and their ``repr`` is the text that Lisp prints. Source: designators.md 3 to 5.
"""

from __future__ import annotations

from types import FunctionType
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar, annotations_of_body, dataclass_transform

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.lisp_core.printing import text_for_python
from cramhy_runtime.lisp_core.python_names import lisp_spelling
from cramhy_runtime.prolog.python.ground import reasoning
from cramhy_runtime.prolog.python.spelling import lisp_name, python_name
from cramhy_runtime.prolog.python.terms import kw, nil_as, shortened, show, to_lisp, to_python
from cramhy_runtime.utilities.patterns import NOTHING
from . import defaults as _defaults  # noqa: F401  the predicates and the generators that come along
from .classes import ALL, ActionDesignator, Designator, HumanDesignator, LocationDesignator, MotionDesignator, ObjectDesignator, new

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from .signatures import Key, Pair

D = TypeVar("D", bound=Designator)
TYPE = kw.type
_OWN = frozenset(name for cls in Designator.__mro__ for name in vars(cls) if not name.startswith("_"))
"""The attributes that every designator has beside its properties."""
_SLOTS = frozenset(name for cls in Designator.__mro__ for name in getattr(cls, "__slots__", ()))
_declared: dict[tuple[type, Keyword], list[Kind]] = per_image({})
"""(class of designators, type) → the classes that declare it, the newest first."""


@dataclass_transform(kw_only_default=True)
class Kind(type):
    """The metaclass of `Motion`, `Action` and the others, and of the types derived from them."""

    designators: type
    """The class of the designators of this kind."""
    type_: Keyword | None
    """The value of their property ``:type``; ``None`` for `Motion` and the other kinds themselves."""
    fields: dict[str, Any]
    """The declared properties: Python name → annotation."""
    defaults: dict[str, Any]

    def __new__(mcs, name: str, bases: tuple[type, ...], body: dict[str, Any], of: type | None = None, type: Any = None) -> Kind:  # noqa: A002
        made = super().__new__(mcs, name, bases, body)
        if of is not None:
            made.designators, made.type_, made.fields, made.defaults = of, None, {}, {}
            return made
        parent: Any = bases[0]
        made.designators = parent.designators
        made.type_ = _type_keyword(name, type)
        own = annotations_of_body(body)
        made.fields = {**parent.fields, **{field: annotation for field, annotation in own.items() if "ClassVar" not in str(annotation)}}
        made.defaults = {**parent.defaults, **{field: body[field] for field in own if field in body}}
        for field in own:
            _check_name(field, name)
        one_spelling(made.fields, name)
        for field, value in body.items():
            _check_body(field, value, own, name)
        known = _declared.setdefault((made.designators, made.type_), [])
        known[:] = [made, *(other for other in known if (other.__module__, other.__qualname__) != (made.__module__, made.__qualname__))]
        _define_for_derived(made)
        return made

    def __init__(cls, name: str, bases: tuple[type, ...], body: dict[str, Any], **options: Any):
        super().__init__(name, bases, body)

    if not TYPE_CHECKING:  # which knows the initializers: those below, and those that `dataclass_transform` makes

        def __call__(cls, *pairs, **properties):
            if pairs:
                keys = [pair[0] for pair in pairs if isinstance(pair, (tuple, list)) and pair and isinstance(pair[0], str)]
                one_spelling([*keys, *properties], cls.__name__)
            return new(cls.designators, list_from([*map(_pair, pairs), *cls._entries(properties)]))

    def _entries(cls, properties: dict[str, Any]) -> Iterator[Cons]:
        if cls.type_ is None:
            for name in properties:
                _check_name(name, cls.__name__)
                if not name.islower() or name[-1] == "_":
                    one_spelling(properties, cls.__name__)
            if isinstance(properties.get("type"), str):
                raise TypeError(
                    f"The type of a designator is a keyword: {cls.__name__}(type=kw.{properties['type']}). "
                    "A string is never the same as it."
                )
            given = properties
        else:
            cls._check_given(properties)
            yield lisp_list(TYPE, cls.type_)
            given = {name: properties.get(name, cls.defaults.get(name)) for name in cls.fields}
        for name, value in given.items():
            if value is not None:
                yield lisp_list(kw[lisp_name(name)], to_lisp(value))

    def _check_given(cls, properties: dict[str, Any]) -> None:
        for name in properties:
            if name not in cls.fields:
                near = near_names(name, cls.fields, 1)
                hint = f" Did you mean {near[0]!r}?" if near else f" It has: {', '.join(cls.fields) or 'none'}."
                raise TypeError(f"{cls.__name__} has no property {name!r}.{hint}")
        missing = [name for name in cls.required if name not in properties]
        if missing:
            raise TypeError(f"{cls.__name__} needs the propert{'ies' if len(missing) > 1 else 'y'} {', '.join(map(repr, missing))}.")

    @property
    def required(cls) -> list[str]:
        """The declared properties without default."""
        return [name for name in cls.fields if name not in cls.defaults]

    def __instancecheck__(cls, thing: Any) -> bool:
        if not isinstance(thing, cls.designators):
            return False
        return cls.type_ is None or cls._fits(thing)

    def _fits(cls, designator: Any) -> bool:
        if value_of(designator, TYPE) is cls.type_:
            return all(_entry(designator, lisp_name(name)) is not None for name in cls.required)
        derived: Any = type.__subclasses__(cls)
        return any(other._fits(designator) for other in derived)


_for_derived: dict[Symbol, tuple[Kind, Callable[[list[Kind]], None]]] = per_image({})
"""The name of a definition for a kind → the kind, and the function that defines the same for kinds derived from it."""


def hold_for_derived(name: Symbol, kind: Kind, define: Callable[[list[Kind]], None]) -> None:
    """Call ``define(derived kinds)`` now, and whenever there are others.

    What is defined for the derived kinds itself comes first: these definitions move behind it.
    """
    _for_derived[name] = kind, define
    _define_for_derived(kind)


def forget_for_derived(name: Symbol) -> None:
    """Undo `hold_for_derived`."""
    _for_derived.pop(name, None)


def _define_for_derived(kind: Kind) -> None:
    concerned = [(base, define) for base, define in _for_derived.values() if base in kind.__mro__]
    for base, define in sorted(concerned, key=lambda pair: -len(pair[0].__mro__)):
        if kinds := _derived(base):
            define(kinds)


def _derived(kind: Kind) -> list[Kind]:
    """The kinds derived from ``kind``, one for each type but its own, those derived directly first."""
    found: dict[Any, Any] = {kind.type_: kind}
    waiting: list[Any] = [kind]
    while waiting:
        derived: list[Any] = type.__subclasses__(waiting.pop(0))
        for other in derived:
            found.setdefault(other.type_, other)
            waiting.append(other)
    return list(found.values())[1:]


def _type_keyword(class_name: str, given: Any) -> Keyword:
    if given is None:
        return kw[lisp_spelling(class_name)]
    if isinstance(given, str):
        return kw[lisp_name(given)]
    if isinstance(given, Keyword):
        return given
    raise TypeError(f'The type of {class_name} is to be a keyword or its name, not {given!r}: class {class_name}(Motion, type="driving").')


def _check_name(name: str, of: str) -> None:
    if name in _OWN:
        raise TypeError(
            f"A property of {of} cannot be called {name!r}: designators have an attribute of that name. "
            f'Give it as a pair, {of}(("{name}", value)), and read designator["{name}"].'
        )


def one_spelling(names: Iterable[str], of: str) -> None:
    """Raise a TypeError if two of the ``names`` of properties are one for Lisp: they differ by case, or by an underscore at the end."""
    spelled: dict[str, str] = {}
    for name in names:
        other = spelled.setdefault(lisp_name(name), name)
        if other.replace("-", "_") != name.replace("-", "_"):
            raise TypeError(
                f"The properties {other!r} and {name!r} of {of} are one for Lisp, which sees no case, and no underscore at the end. "
                "Give one of them another name."
            )


def _check_body(field: str, value: Any, annotations: dict[str, Any], of: str) -> None:
    if field.startswith("__") or field in annotations or isinstance(value, type):
        return
    if isinstance(value, (FunctionType, property, classmethod, staticmethod)):
        raise TypeError(
            f"{of}.{field} would be a method, but what {of}(...) makes is a plain designator, which has properties only. "
            f"Write a function: def {field}(designator): ..."
        )
    raise TypeError(f"{of}.{field} has a value, but no type, and would be no property: {field}: {type(value).__name__} = {value!r}.")


def _pair(pair: Any) -> Cons:
    if isinstance(pair, (tuple, list)) and len(pair) == 2 and isinstance(pair[0], (str, Symbol)):
        return lisp_list(_key(pair[0]), to_lisp(pair[1]) if pair[1] is not None else NOTHING)
    raise TypeError(f'{pair!r} is no property. In front of the keyword arguments stand pairs: ("goal", value).')


def _key(key: str | Symbol) -> Symbol:
    if isinstance(key, str):
        return kw[lisp_name(key)]
    return key if isinstance(key, Symbol) else to_lisp(key)


class _Readable:
    """Tells type checkers how to read designators; the code below gives `Designator` these methods. They know declared attributes only."""

    if TYPE_CHECKING:
        type: Keyword

        def __getitem__(self, key: Key) -> Any: ...
        def __contains__(self, key: Key) -> bool: ...


class Motion(MotionDesignator, _Readable, metaclass=Kind, of=MotionDesignator):
    """A motion, which `perform` gives to a process module."""

    def __init__(self, *pairs: Pair, type: Keyword = ..., **properties: object): ...


class Action(ActionDesignator, _Readable, metaclass=Kind, of=ActionDesignator):
    """An action, for which `reference` finds a plan function."""

    def __init__(self, *pairs: Pair, type: Keyword = ..., **properties: object): ...


class Location(LocationDesignator, _Readable, metaclass=Kind, of=LocationDesignator):
    """A place, which generators propose and validators judge."""

    def __init__(self, *pairs: Pair, type: Keyword = ..., **properties: object): ...


class Object(ObjectDesignator, _Readable, metaclass=Kind, of=ObjectDesignator):
    """An object in the world. Perception sets its ``data``."""

    def __init__(self, *pairs: Pair, type: Keyword = ..., **properties: object): ...


class Human(HumanDesignator, _Readable, metaclass=Kind, of=HumanDesignator):
    """A human. Perception sets its ``data``."""

    def __init__(self, *pairs: Pair, type: Keyword = ..., **properties: object): ...


# ------------------------------------------------------------------------------------------------------------------ reading


def properties(designator: Designator) -> list[tuple[str, Any]]:
    """The properties of a designator in order, as pairs of a Python name and a value. A repeated key comes more than once."""
    return [(python_name(entry.car.name), _value(designator, entry)) for entry in _entries_of(designator)]


def property_values(designator: Designator, name: str | Symbol) -> list[Any]:
    """All values of the key ``name`` in order, converted for Python."""
    wanted = _key(name).name
    return [_value(designator, entry) for entry in _entries_of(designator) if entry.car.name.replace("_", "-") == wanted]


def every(designator: D) -> D:
    """A new designator for all things of this description, as Lisp's ``(all objects (type cup))``. Its ``quantifier`` is ``kw.all``."""
    made = replace(designator)
    made.quantifier = ALL
    return made


def replace(designator: D, **changed: object) -> D:
    """A new designator in which these properties have these values; ``None`` removes a property. It is not equated to the old one.

    The order is kept. For a repeated key, the first property is replaced and the others are removed. New properties come at the end.
    """
    one_spelling(changed, "replace")
    description, left = [], {lisp_name(name): value for name, value in changed.items()}
    done: set[str] = set()
    for entry in designator.description or ():
        name = entry.car.name if isinstance(entry, Cons) and isinstance(entry.car, Symbol) else None
        if name in left:
            if left[name] is not None and name not in done:
                description.append(lisp_list(entry.car, to_lisp(left[name])))
            done.add(name)
        else:
            description.append(entry)
    description += [lisp_list(kw[name], to_lisp(value)) for name, value in left.items() if name not in done and value is not None]
    made: D = new(designator.__class__, list_from(description))
    return made


def value_of(designator: Designator, key: Symbol) -> Any:
    """The value of the first property ``key``, as Lisp data, or ``None``."""
    found = _entry(designator, key.name)
    return found.cdr.car if found is not None and found.cdr is not None else None


def _entries_of(designator: Designator) -> Iterator[Cons]:
    for entry in designator.description or ():
        if isinstance(entry, Cons) and isinstance(entry.car, Symbol):
            yield entry


def _entry(designator: Designator, name: str) -> Cons | None:
    for entry in _entries_of(designator):
        if entry.car.name == name:
            return entry
    if "-" in name:  # code in Lisp may have written it with underscores
        return next((entry for entry in _entries_of(designator) if entry.car.name.replace("_", "-") == name), None)
    return None


def _value(designator: Designator, entry: Cons) -> Any:
    value = entry.cdr.car if isinstance(entry.cdr, Cons) else None
    if value is not None:
        return to_python(value)
    name = python_name(entry.car.name)
    kind = declaration(designator, name)
    return to_python(None, nil_as(kind.fields[name], None) if kind is not None else list)


def declaration(designator: Designator, name: str) -> Kind | None:
    """The class that declares the property ``name`` for the type of ``designator``, or ``None``."""
    if _declared:
        for cls in designator.__class__.__mro__:
            for kind in _declared.get((cls, value_of(designator, TYPE)), ()):
                if name in kind.fields:
                    return kind
    return None


def _attribute(self: Designator, name: str) -> Any:
    if not name.startswith("_") and name not in _OWN:  # one of its own is not filled yet: it is being made
        found = _entry(self, lisp_name(name))
        if found is not None:
            return _value(self, found)
        kind = declaration(self, name)
        if kind is not None and name in kind.defaults:
            return to_python(to_lisp(kind.defaults[name]), nil_as(kind.fields[name], None))
    raise AttributeError(_no_property(self, name), name=name, obj=self)


def _no_property(designator: Designator, name: str) -> str:
    known = [python_name(entry.car.name) for entry in _entries_of(designator)]
    near = near_names(name, known, 1)
    hint = f" Did you mean {near[0]!r}?" if near else f" It has: {', '.join(known) or 'none'}."
    return f"This {type_name(designator)} has no property {name!r}.{hint}"


def type_name(designator: Designator) -> str:
    """``"motion"`` for a motion."""
    return designator.__class__.__name__.removesuffix("Designator").lower() or "designator"


def _item(self: Designator, key: str | Symbol) -> Any:
    found = _entry(self, _key(key).name)
    if found is None:
        raise KeyError(_no_property(self, key if isinstance(key, str) else show(key)))
    return _value(self, found)


def _assigned(self: Designator, name: str, value: object) -> None:
    """Set a slot of the designator, not a property, nor an attribute that it does not have."""
    cls = type(self)
    if name in _SLOTS or name[:2] == "__" or hasattr(getattr(cls, name, None), "__set__"):
        object.__setattr__(self, name, value)
    elif cls.__dictoffset__ and _entry(self, lisp_name(name)) is None:
        object.__setattr__(self, name, value)  # a class of Lisp's or of users' has slots of its own
    else:
        raise AttributeError(_unchanged(self, name, value), name=name, obj=self)


def _item_assigned(self: Designator, key: str | Symbol, value: object) -> None:
    raise TypeError(_unchanged(self, key if isinstance(key, str) else python_name(key.name), value))


def _item_deleted(self: Designator, key: str | Symbol) -> None:
    _item_assigned(self, key, None)


def _unchanged(designator: Designator, name: str, value: object) -> str:
    kind = type_name(designator)
    return (
        f"The properties of a designator do not change: {name} cannot be set. Make another one, which has the new value: "
        f"replace({kind}, {name}={shortened(value)}), from cramhy_runtime.designators."
    )


def _contains(self: Designator, key: str | Symbol) -> bool:
    return _entry(self, _key(key).name) is not None


def _representation(self: Designator) -> str:
    with reasoning():
        text: str = text_for_python(self)
    return text


def _names(self: Designator) -> list[str]:
    return sorted({*object.__dir__(self), *(name for name, _ in properties(self))})


for _special, _function in (
    ("__getattr__", _attribute),
    ("__setattr__", _assigned),
    ("__getitem__", _item),
    ("__setitem__", _item_assigned),
    ("__delitem__", _item_deleted),
    ("__contains__", _contains),
    ("__iter__", None),
    ("__repr__", _representation),
    ("__dir__", _names),
):
    setattr(Designator, _special, _function)
