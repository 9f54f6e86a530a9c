"""Lisp data as JSON, for files of episodes: everything that a fluent or a task may have had as its value.

``nil`` is null, ``t`` true; integers, strings, single-floats and proper lists are JSON's; all else is an object with one telling key:
``{"symbol": name, "in": package}``, ``{"double": 1.5}``, ``{"list": [...], "end": x}``. Symbols without a package and objects with slots
have a number, so that what was one thing is one thing again when it is read.

Reading runs no code. An object is allocated and its slots are set, nothing is initialised; only data has a way to be read: structures,
instances of ``defclass`` and conditions, designators, poses, ROS messages. What else there may be, a fluent, a task, a stream, is
written as the text that it prints, and read as an `Unreadable` that prints it. Functions are written as ``(function name)``, and a lazy
list ends where it was not computed. A type with a backend (``backends.py``) is written and read by that.
"""

from __future__ import annotations

import math
from fractions import Fraction

from cramhy_runtime.lisp_core.hash_tables import HashTable
from cramhy_runtime.lisp_core.arrays import LispArray, TypedVector
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import (
    NO_VALUES,
    UNBOUND,
    WRITABLE_STRINGS,
    Character,
    Cons,
    MultipleValues,
    Symbol,
    lisp_list,
    list_from,
)
from cramhy_runtime.lisp_core.floats import SingleFloat
from ...numbers.irrational import complex_, imagpart, realpart
from ...objects.class_objects import StandardObject, effective_slots, may_be_unbound
from ...objects.classes import find_class
from cramhy_runtime.lisp_core.classes import make_instance
from cramhy_runtime.lisp_core.classes import class_name
from ...objects.structures import StructureObject
from cramhy_runtime.lisp_core.packages import named_package, keyword
from cramhy_runtime.lisp_core.printing import define_printer
from cramhy_runtime.lisp_core.printing import prin1_to_string
from ...printer.standard_printers import function_name
from cramhy_runtime.utilities.lazy_lists import LazyTail
from .backends import backend_of, restored, stored
from cramhy_runtime.episodes.symbols import sym

FUNCTION = sym("FUNCTION")
DEEPEST = 200
"""How deep values may be nested; what is deeper is written as its text."""

GEOMETRY = "CL-TRANSFORMS"
DATA_PACKAGES = {GEOMETRY, "CRAM-DESIGNATORS"}
"""The packages whose classes, of the runtime, are data."""


class Unreadable:
    """What could not be written to a file but as ``text``."""

    def __init__(self, text):
        self.text = text


class BadFile(Exception):
    """What is wrong with the text of a file, in words."""


def is_data(cls):
    """Whether objects of the class are written with their slots."""
    if issubclass(cls, StructureObject | StandardObject):
        return True
    name = vars(cls).get("lisp_name") or ""
    package = name.partition("::")[0]
    if issubclass(cls, Condition):
        return class_name(cls) is not None and find_class(class_name(cls), None) is cls
    return package in DATA_PACKAGES or any(vars(base).get("lisp_name") == "ROSLISP-MSG-PROTOCOL::ROS-MESSAGE" for base in cls.__mro__)


class Writer:
    """Makes JSON of Lisp data. One writer per file: things keep their numbers."""

    def __init__(self):
        self.numbers = {}
        self.kept = []  # so that no other object gets the identity of one that was written

    def write(self, value, depth=0):
        """``value`` as what ``json.dumps`` takes."""
        kind = value.__class__
        if value is None or value is False:
            return None
        if value is True or kind is int:
            return value
        if kind is str or kind in WRITABLE_STRINGS:
            return str(value)
        if isinstance(value, Symbol):
            return self._symbol(value)
        if kind is float:
            return {"double": self._number(value)}
        if kind is SingleFloat:
            return float(value) if math.isfinite(value) else {"single": self._number(value)}
        if depth > DEEPEST:
            return {"text": f"#<nested deeper than {DEEPEST} levels>"}
        if kind is Cons:
            return self._list(value, depth + 1)
        if kind is Fraction:
            return {"ratio": [value.numerator, value.denominator]}
        if isinstance(value, complex):
            return {"complex": [self.write(realpart(value)), self.write(imagpart(value))]}
        if kind is Character:
            return {"character": value.char}
        if isinstance(value, MultipleValues) or value is NO_VALUES:
            return {"values": [self.write(item, depth + 1) for item in value]}
        if kind is tuple:
            return {"tuple": [self.write(item, depth + 1) for item in value]}
        return self._object(value, depth + 1)

    @staticmethod
    def _number(value):
        return value if math.isfinite(value) else str(value)

    def _symbol(self, symbol):
        if symbol.package is not None:
            return {"symbol": symbol.name, "in": symbol.package.name}
        number = self.numbers.get(id(symbol))
        if number is not None:
            return {"same": number}
        return {"new": self._numbered(symbol), "symbol": symbol.name}

    def _numbered(self, thing):
        self.kept.append(thing)
        number = self.numbers[id(thing)] = len(self.numbers)
        return number

    def _list(self, value, depth):
        items, seen, end = [], set(), None
        while value.__class__ is Cons and id(value) not in seen:
            seen.add(id(value))
            items.append(self.write(value.car, depth))
            value = value.cdr
            while isinstance(value, LazyTail):
                value = value.value if value.generator is None else None
        if value.__class__ is Cons:
            end = {"text": "#<the list goes round>"}
        elif value is not None:
            end = self.write(value, depth)
        return items if end is None else {"list": items, "end": end}

    def _object(self, value, depth):
        number = self.numbers.get(id(value))
        if number is not None:
            return {"same": number}
        backend = backend_of(value)
        if backend is not None:
            return {"new": self._numbered(value), "backend": self.write(backend), "stored": stored(backend, value)}
        cls = value.__class__
        if isinstance(value, list | TypedVector | bytes | bytearray) or (isinstance(value, LispArray) and len(value.dimensions) == 1):
            return {"new": self._numbered(value), "vector": [self.write(item, depth) for item in value]}
        if cls is HashTable and value.weakness is None and value.test.__class__ is str:
            number = self._numbered(value)
            return {
                "new": number,
                "table": value.test,
                "entries": [[self.write(key, depth), self.write(item, depth)] for key, item in value.items()],
            }
        if isinstance(value, type) or not is_data(cls):
            name = function_name(value) if callable(value) and not isinstance(value, type) else None
            return {"text": prin1_to_string(value)} if name is None else self.write(lisp_list(FUNCTION, name), depth)
        number = self._numbered(value)
        return {
            "new": number,
            "class": self.write(class_name(cls)),
            "slots": [[self.write(name), self.write(item, depth)] for name, item in _slots(value)],
        }


def _slots(value):
    """(name, value) of the bound slots of an object."""
    structure = getattr(type(value), "lisp_structure", None)
    slots = structure.slots if structure is not None else effective_slots(type(value)).values()
    own = vars(value) if isinstance(value, StandardObject) else None  # to ask it for an unbound slot would be an error
    for slot in slots:
        if getattr(slot, "cell", None) is None:
            item = getattr(value, slot.attribute, UNBOUND) if own is None else own.get(slot.attribute, UNBOUND)
            if item is not UNBOUND:
                yield slot.name, item


class Reader:
    """Makes Lisp data of JSON. One reader per file. Whatever is wrong with the JSON is a `BadFile`."""

    def __init__(self):
        self.things = {}

    def read(self, form):
        """The value that `Writer.write` made ``form`` of."""
        kind = form.__class__
        if form is None or form is True or kind is int or kind is str:
            return form
        if kind is float:
            return SingleFloat(form)
        if kind is list:
            return list_from([self.read(item) for item in form])
        if kind is dict:
            for key, function in _READERS.items():
                if key in form:
                    return function(self, form)
        raise BadFile(f"{str(form)[:60]} stands for no value")

    def _new(self, form, thing):
        if "new" in form:
            self.things[form["new"]] = thing
        return thing

    def _same(self, form):
        if form["same"] not in self.things:
            raise BadFile(f"it refers to a thing, number {form['same']}, that was not there before")
        return self.things[form["same"]]

    def _symbol(self, form):
        name = _text(form["symbol"])
        if "in" not in form:
            return self._new(form, Symbol(name))
        package = named_package(_text(form["in"]))
        if form["in"] == "KEYWORD":
            return keyword(name)
        if package is None:
            raise BadFile(f"it has a symbol {name} of the package {form['in']}, which does not exist here: load the system that defines it")
        found, status = package.lookup(name)
        if status is None:
            if package.locked:
                raise BadFile(f"it has a symbol {name} of the package {package.name}, which has no such symbol")
            return package.intern(name)
        return found

    def _float(self, form):
        return SingleFloat(_number(form["single"]))

    def _double(self, form):
        return _number(form["double"])

    def _list(self, form):
        return list_from([self.read(item) for item in _sequence(form["list"])], self.read(form.get("end")))

    def _ratio(self, form):
        numerator, denominator = _sequence(form["ratio"])
        return Fraction(numerator, denominator)

    def _complex(self, form):
        return complex_(*(self.read(part) for part in _sequence(form["complex"])))

    def _character(self, form):
        return Character(_text(form["character"])[:1] or " ")

    def _values(self, form):
        return MultipleValues(tuple(self.read(item) for item in _sequence(form["values"])))

    def _tuple(self, form):
        return tuple([self.read(item) for item in _sequence(form["tuple"])])

    def _vector(self, form):
        vector = self._new(form, [])
        vector += [self.read(item) for item in _sequence(form["vector"])]
        return vector

    def _table(self, form):
        if form["table"] not in ("EQ", "EQL", "EQUAL", "EQUALP"):
            raise BadFile(f"there are no hash tables of the kind {form['table']}")
        table = self._new(form, HashTable(form["table"]))
        for key, item in _sequence(form["entries"]):
            table.put(self.read(key), self.read(item))
        return table

    def _unreadable(self, form):
        return Unreadable(_text(form["text"]))

    def _backend(self, form):
        return self._new(form, restored(self.read(form["backend"]), _text(form["stored"]), BadFile))

    def _instance(self, form):
        name = self.read(form["class"])
        cls = find_class(name, None) if isinstance(name, Symbol) else None
        if cls is None:
            raise BadFile(
                f"it has an object of the class {prin1_to_string(name)}, which does not exist here: load the system that defines it"
            )
        if not isinstance(cls, type) or not is_data(cls):
            raise BadFile(f"objects of the class {prin1_to_string(name)} cannot be read from files")
        structure = getattr(cls, "lisp_structure", None)
        slots = {slot.name: slot for slot in structure.slots} if structure is not None else effective_slots(cls)
        if name.package.name == GEOMETRY:  # whose slots are parts of what is stored
            return self._new(
                form,
                make_instance(
                    cls, *(part for key, item in _sequence(form["slots"]) for part in (keyword(self.read(key).name), self.read(item)))
                ),
            )
        if issubclass(cls, StandardObject):
            may_be_unbound(cls)
        thing = self._new(form, cls.__new__(cls) if issubclass(cls, BaseException) else object.__new__(cls))
        for key, item in _sequence(form["slots"]):
            slot = slots.get(self.read(key))
            if slot is None:
                raise BadFile(f"the class {prin1_to_string(name)} has no slot {prin1_to_string(self.read(key))} here: it was changed since")
            setattr(thing, slot.attribute, self.read(item))
        return thing


_READERS = {
    "same": Reader._same,
    "symbol": Reader._symbol,
    "double": Reader._double,
    "single": Reader._float,
    "list": Reader._list,
    "ratio": Reader._ratio,
    "complex": Reader._complex,
    "character": Reader._character,
    "values": Reader._values,
    "tuple": Reader._tuple,
    "vector": Reader._vector,
    "table": Reader._table,
    "text": Reader._unreadable,
    "backend": Reader._backend,
    "class": Reader._instance,
}


def _text(thing):
    if not isinstance(thing, str):
        raise BadFile(f"{str(thing)[:60]} stands where a text should be")
    return thing


def _sequence(thing):
    if not isinstance(thing, list):
        raise BadFile(f"{str(thing)[:60]} stands where a list should be")
    return thing


def _number(thing):
    if isinstance(thing, bool) or not isinstance(thing, int | float | str):
        raise BadFile(f"{str(thing)[:60]} stands where a number should be")
    return float(thing)


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_printer(Unreadable, lambda thing, stream: stream.write(thing.text))
