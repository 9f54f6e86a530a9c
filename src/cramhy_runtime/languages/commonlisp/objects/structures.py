"""Structures: what ``defstruct`` makes.

A structure type is a Python class with ``__slots__``, so Python reads ``motion.speed`` and a wrong attribute is an error. An
accessor is the slot's own descriptor, which checks the type of its argument in C; only when it refuses is Lisp's type-error made.
With ``:type list`` or ``:type vector`` there is no class: instances are lists or vectors. A structure that is defined again
with the same slots keeps its class, so that reloading a file does not invalidate the objects at hand; with other slots it gets
a new one, and old objects stay what they were. Source: ANSI 8.1 (DEFSTRUCT); texts are SBCL's.
"""

from __future__ import annotations

from ..collections.arrays import aref, set_aref
from ..collections.element_types import initial_element, upgraded_element_type
from ..collections.strings import string
from ..collections.sequence_types import elements, typed_vector
from . import protocol_functions
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.conditions import SimpleError, error, program_error, type_error
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons, Symbol, UndefinedFunction, lisp_list, list_from, one, python_list
from ..syntax.function_shapes import shape_of
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.lisp_core.packages import Package, intern, is_symbol, keyword, redefined, sym, symbol_name
from ..packages.package_errors import check_symbol
from ..syntax.declaration_names import check_type_name
from cramhy_runtime.lisp_core.printing import CURRENT_LEVEL, LEVELS_COUNT
from .builtin_classes import set_structure_object
from .constructors import keyword_constructor, maker_of_values
from .classes import StructureClass, register_class, registered_class
from cramhy_runtime.lisp_core.dispatch.generic_functions import add_method
from cramhy_runtime.lisp_core.dispatch.methods import Shape

LISP_NAMES = "copy-structure"

PACKAGE = sym("*PACKAGE*")
ALLOW_OTHER_KEYS = keyword("ALLOW-OTHER-KEYS")


OR, QUOTE, SETF = sym("OR"), sym("QUOTE"), sym("SETF")


class StructureObject(metaclass=StructureClass):
    """STRUCTURE-OBJECT: the root of all structure types."""

    __slots__ = ("__weakref__",)
    lisp_name = "STRUCTURE-OBJECT"

    def __repr__(self):
        return f"#S({type(self).__name__} " + " ".join(f":{name.name} {value!r}" for name, value in slots_of(self)) + ")"


set_structure_object(StructureObject)


class StructureSlot:
    """A slot of a structure type: its name, initform (a thunk or ``None``), type specifier, and whether it can be set."""

    cell = None
    said_writable = False

    def __init__(self, name, initform=None, type_=True, read_only=False):
        self.name, self.initform, self.type, self.read_only = name, initform, type_, read_only
        self.keyword = keyword(symbol_name(name))
        self.attribute = None
        self.predicate = None

    def copy(self):
        other = StructureSlot(self.name, self.initform, self.type, self.read_only)
        other.attribute = self.attribute
        return other

    def default(self):
        """The value of the initform, nil without one."""
        return one(self.initform()) if self.initform is not None else None


def _predicate(specifier):
    """The test of a slot's type; a type that is defined only later is asked for when a value needs it."""
    if isinstance(specifier, Cons) and specifier.car is OR:
        parts = [_predicate(part) for part in python_list(specifier.cdr)]
        if not all(map(PORTS.types.known, python_list(specifier.cdr))):
            return lambda value: any(part(value) for part in parts)
    return PORTS.types.declared(specifier) if PORTS.types.known(specifier) else lambda value: PORTS.types.declared(specifier)(value)


def structure_slot(name, *, initform=None, type=True, read_only=None, writable=None):
    """The description of a slot for `define_structure`: a Symbol, a thunk or nil, a type specifier, t or nil.

    writable: whether the definition said ``:read-only nil``, which an included slot that is read-only does not allow.
    """
    slot = StructureSlot(name, initform, type, read_only is not None)
    slot.said_writable = writable is not None
    return slot


def _representation(kind):
    """(``LIST`` or ``VECTOR`` or ``None``, upgraded element type) for the value of the option ``:type``."""
    if kind is None:
        return None, True
    name, *rest = python_list(kind) if isinstance(kind, Cons) else [kind]
    if name is sym("VECTOR") and isinstance(kind, Cons) and len(rest) < 2:
        return "VECTOR", upgraded_element_type(rest[0]) if rest else True
    if name is sym("VECTOR") and len(rest) > 1:
        program_error("(VECTOR ELEMENT-TYPE) is the :TYPE of a structure, and ~S has more in it.", kind)
    if name not in (sym("LIST"), sym("VECTOR")) or rest:
        error(SimpleError("~S is a bad :TYPE for DEFSTRUCT.", kind))
    return symbol_name(name), True


class Structure:
    """A structure type: what ``defstruct`` said. ``cls`` is its class; ``None`` with ``:type``, then ``representation`` counts."""

    def __init__(self, name, slots, include, type_, named, offset):
        self.name, self.slots, self.include = name, slots, include
        if type_ is None and offset:
            program_error(":OFFSET can't be specified unless :TYPE is specified.")
        self.representation, self.element_type = _representation(type_)
        self.named, self.offset = named, offset
        if include is not None and (include.representation, include.element_type) != (self.representation, self.element_type):
            error(SimpleError(":TYPE option mismatch between structures ~S and ~S", name, include.name))
        if named and self.element_type is not True:
            error(SimpleError(":NAMED option is incompatible with element type ~S", self.element_type))
        self.cls = None
        self.fields = self.recipe = ()

    def slot(self, name):
        """The slot named by the symbol ``name`` or by an equally named one; ``None`` when there is none."""
        for slot in self.slots:
            if slot.name is name or (is_symbol(name) and symbol_name(slot.name) == symbol_name(name)):
                return slot
        return None

    def prepare(self):
        """Compute what `construct` needs for each slot: how to set it, its keyword, initform and type test."""
        for slot in self.slots:
            slot.predicate = None if slot.type is True else _predicate(slot.type)
        if self.cls is not None:
            self.fields = tuple((getattr(self.cls, slot.attribute).__set__, slot) for slot in self.slots)
            self.recipe = tuple((set_slot, slot.keyword, slot.initform, slot.predicate, slot) for set_slot, slot in self.fields)

    def construct(self, *initargs, **keywords):
        """The keyword constructor. Python callers may use keywords."""
        if len(initargs) % 2:
            return program_error("odd number of &KEY arguments")
        given = dict(zip(initargs[-2::-2], initargs[::-2]))  # from the last to the first: of equal keywords the first one counts
        for name, value in keywords.items():
            slot = next((slot for slot in self.slots if slot.attribute == name), None)
            given[slot.keyword if slot else keyword(name.upper())] = value
        if self.cls is None:
            values = [given.pop(slot.keyword) if slot.keyword in given else slot.default() for slot in self.slots]
            self._check_rest(given)
            return self.make(values)
        obj = object.__new__(self.cls)
        for set_slot, key, initform, predicate, slot in self.recipe:
            if key in given:
                value = given.pop(key)
            else:
                value = one(initform()) if initform is not None else None
            if predicate is not None and not predicate(value):
                self.wrong_type(slot, value)
            set_slot(obj, value)
        if given:
            self._check_rest(given)
        return obj

    def _check_rest(self, given):
        if given.pop(ALLOW_OTHER_KEYS, None) is None and given:
            program_error("Unknown &KEY argument: ~S", next(iter(given)))

    def make(self, values, empty=()):
        """An instance with these slot values; those of the names ``empty`` are unchecked, as they were left out."""
        for slot, value in zip(self.slots, values):
            if slot.predicate is not None and not slot.predicate(value) and symbol_name(slot.name) not in empty:
                self.wrong_type(slot, value)
        if self.cls is not None:
            obj = object.__new__(self.cls)
            for (set_slot, _), value in zip(self.fields, values):
                set_slot(obj, value)
            return obj
        items = self._layout(values)
        return list_from(items) if self.representation == "LIST" else self.vector(items)

    def vector(self, items):
        """A vector of ``items`` that can be changed, of the element type of ``:type (vector element-type)``."""
        return typed_vector(items, self.element_type)

    def wrong_type(self, slot, value):
        return type_error(value, slot.type, f"\nwhen setting slot {symbol_name(slot.name)} of structure {symbol_name(self.name)}")

    def _layout(self, values):
        items, rest = [], list(values)
        for structure in self.chain():
            own = len(structure.slots) - (len(structure.include.slots) if structure.include else 0)
            items += [self._filler()] * structure.offset + ([structure.name] if structure.named else [])
            items += rest[:own]
            rest = rest[own:]
        return items

    def _filler(self):
        return None if self.representation == "LIST" else initial_element(self.element_type)

    def chain(self):
        """The structure types from the most general one to this one."""
        return [*self.include.chain(), self] if self.include else [self]

    def position(self, slot):
        """The index of ``slot`` in an instance that is a list or vector."""
        index = counted = 0
        for structure in self.chain():
            index += structure.offset + (1 if structure.named else 0)
            while counted < len(structure.slots):
                if self.slots[counted].name is slot.name:
                    return index
                counted += 1
                index += 1
        return index

    def name_position(self):
        """The index of the name in an instance that is a list or vector with ``:named``."""
        before = len(self.include._layout([None] * len(self.include.slots))) if self.include else 0
        return before + self.offset


_typed_structures: dict = {}


def structure_named(name):
    """The `Structure` that the symbol ``name`` names, or ``None``."""
    return getattr(registered_class(name), "lisp_structure", None) or _typed_structures.get(name)


def find_structure(name):
    """The `Structure` that the symbol ``name`` names; an error when there is none."""
    found = structure_named(name)
    return found if found is not None else error(SimpleError("~S is not the name of a structure type defined with DEFSTRUCT.", name))


def slots_of(obj):
    """The slots of a structure: a list of (Symbol, value)."""
    return [(slot.name, getattr(obj, slot.attribute, None)) for slot in type(obj).lisp_structure.slots]


def define_structure(
    name,
    slots=None,
    *,
    conc_name=UNSUPPLIED,
    constructors=UNSUPPLIED,
    copier=UNSUPPLIED,
    predicate=UNSUPPLIED,
    include=None,
    include_slots=None,
    type=None,
    named=None,
    initial_offset=0,
    print_function=None,
    print_object=None,
    documentation=None,
):
    """``defstruct``: define the structure type ``name`` with its functions; returns ``name``.

    name: a Symbol. slots: a list of `structure_slot` results. Options not given take the defaults of ANSI.
    conc_name: a string designator, or nil for no prefix.
    constructors: a list whose entries are symbols (keyword constructors) or lists (name variables function) for BOA
    constructors, see `boa_lambda_list`; nil: none.
    copier, predicate: symbols; nil: none. include: the name of the included type; include_slots: `structure_slot` results that
    replace slots of it. type: ``list`` or ``vector`` or ``(vector ...)``. named: t for ``:named``. initial_offset: a number.
    print_function: a function of object, stream and depth. print_object: a function of object and stream.
    """
    check_symbol(name, "defining ~S as a structure", name)
    check_type_name(name)
    parent = find_structure(include) if include is not None else None
    own = python_list(slots)
    if predicate is not UNSUPPLIED and predicate is not None and type is not None and named is None:
        error(SimpleError(":PREDICATE cannot be used with :TYPE unless :NAMED is also specified."))
    structure = Structure(name, _all_slots(name, parent, own, python_list(include_slots)), parent, type, named is not None, initial_offset)
    package = PACKAGE.value if isinstance(PACKAGE.value, Package) else name.package
    prefix = f"{name.name}-" if conc_name is UNSUPPLIED else "" if conc_name is None else str(string(conc_name))
    accessors = [(slot, slot.name if conc_name is None else intern(prefix + symbol_name(slot.name), package)) for slot in structure.slots]
    constructors = [intern(f"MAKE-{name.name}", package)] if constructors is UNSUPPLIED else python_list(constructors)
    copier = intern(f"COPY-{name.name}", package) if copier is UNSUPPLIED else copier
    predicate = intern(f"{name.name}-P", package) if predicate is UNSUPPLIED else predicate
    names = [("an accessor", symbol) for _, symbol in accessors] + [("a copier", copier), ("a predicate", predicate)]
    names += [("a constructor", entry if is_symbol(entry) else python_list(entry)[0]) for entry in constructors]
    for what, symbol in names:
        if symbol is not None:
            check_symbol(symbol, f"defining ~S as {what} for ~S structure", symbol, name)
    if structure.representation is None:
        _make_class(structure, parent, documentation)
    else:
        _typed_structures[name] = structure
    structure.prepare()
    for slot, symbol in accessors:
        _define_accessor(structure, slot, symbol, parent)
    for constructor in constructors:
        _define_constructor(structure, constructor)
    if copier is not None:
        _define_copier(structure, copier)
    if predicate is not None and (structure.representation is None or structure.named):
        _define_predicate(structure, predicate)
    _define_printing(structure, print_function, print_object)
    return name


def _all_slots(name, parent, own, overrides):
    slots = [slot.copy() for slot in parent.slots] if parent else []
    for number, override in enumerate(overrides):
        if override.keyword in {other.keyword for other in overrides[:number]}:
            program_error("duplicate slot name ~S", override.name)
        inherited = next((slot for slot in slots if slot.keyword is override.keyword), None)
        if inherited is None:
            program_error("slot name ~S not present in included structure ~S", override.name, parent.name)
        if inherited.read_only and override.said_writable:
            text = "The slot ~A is :READ-ONLY in superclass, and so must be :READ-ONLY in subclass."
            error(SimpleError(text, symbol_name(override.name)))
        inherited.initform = override.initform
        inherited.read_only = inherited.read_only or override.read_only
        if override.type is not True:
            inherited.type = override.type
    taken = {slot.attribute for slot in slots}
    for slot in own:
        if any(other.keyword is slot.keyword for other in slots):
            program_error("duplicate slot name ~S", slot.name)
        slot.attribute = python_name(symbol_name(slot.name))
        while slot.attribute in taken or hasattr(StructureObject, slot.attribute) or slot.attribute == "lisp_structure":
            slot.attribute += "_"
        taken.add(slot.attribute)
        slots.append(slot)
    return slots


def _make_class(structure, parent, documentation):
    base = parent.cls if parent else StructureObject
    old = registered_class(structure.name)
    known = getattr(old, "lisp_structure", None)
    if (
        known is not None
        and old.__bases__ == (base,)
        and [slot.attribute for slot in known.slots] == [slot.attribute for slot in structure.slots]
    ):
        cls = old
    else:
        inherited = len(parent.slots) if parent else 0
        package = structure.name.package
        cls = StructureClass(
            python_name(structure.name.name),
            (base,),
            {
                "__slots__": tuple(slot.attribute for slot in structure.slots[inherited:]),
                "__module__": python_name(package.name) if package else "lisp",
                "lisp_symbol": structure.name,
            },
        )
        register_class(structure.name, cls)
    cls.__doc__ = documentation
    structure.cls = cls
    cls.lisp_structure = structure


def _function(symbol, function):
    redefined(symbol)
    function.__lisp_name__ = symbol
    function.__name__ = function.__qualname__ = python_name(symbol.name)
    symbol.function, symbol.macro = function, None
    symbol.function_changed()


def _define_accessor(structure, slot, symbol, parent):
    if parent is not None and _serves_both(structure, slot, symbol):
        return  # the included type's accessor of the same name serves both (ANSI DEFSTRUCT, :include)
    if structure.cls is not None:
        reader, writer = _class_accessors(structure, slot)
    else:
        reader, writer = _sequence_accessors(structure, slot)
    _function(symbol, reader)
    writer.__lisp_name__ = lisp_list(SETF, symbol)
    symbol.setf_function = None if slot.read_only else writer
    symbol.function_changed()


def _serves_both(structure, slot, symbol):
    """Whether the function of ``symbol`` is the accessor of ``slot`` that an included type has."""
    if structure.cls is None:
        return slot.keyword in {other.keyword for other in structure.include.slots} and not isinstance(symbol.function, UndefinedFunction)
    cls = getattr(symbol.function, "slot_of", None)
    return cls in structure.cls.__mro__[1:] and symbol.function.attribute == slot.attribute


def _class_accessors(structure, slot):
    member, cls = getattr(structure.cls, slot.attribute), structure.cls
    get, put, predicate, name = member.__get__, member.__set__, slot.predicate, structure.name
    if member.__objclass__ is not cls:  # the slot's own descriptor takes instances of the included type, too

        def get(object):
            return member.__get__(object) if isinstance(object, cls) else type_error(object, name)

        def put(object, new):
            return member.__set__(object, new) if isinstance(object, cls) else type_error(object, name)

    def accessor(object):
        try:
            return get(object)
        except (TypeError, AttributeError):
            return type_error(object, name)

    def setter(new, object):
        if predicate is not None and not predicate(new):
            structure.wrong_type(slot, new)
        try:
            put(object, new)
        except (TypeError, AttributeError):
            return type_error(object, name)
        return new

    accessor.slot_of, accessor.attribute = structure.cls, slot.attribute
    if predicate is None:
        setter.slot_of, setter.attribute = structure.cls, slot.attribute
    return accessor, setter


def _sequence_accessors(structure, slot):
    index = structure.position(slot)
    kind = sym("LIST") if structure.representation == "LIST" else sym("VECTOR")

    def cell_of(obj):
        cell = obj
        for _ in range(index):
            cell = cell.cdr if isinstance(cell, Cons) else None
        return cell if isinstance(cell, Cons) else None

    def list_accessor(object):
        if object is not None and not isinstance(object, Cons):
            return type_error(object, kind)
        cell = cell_of(object)
        return cell.car if cell is not None else None

    def list_setter(new, object):
        cell = cell_of(object)
        if cell is None:
            return type_error(object, kind)
        cell.car = new
        return new

    def vector_accessor(object):
        if structure.element_type is True and object.__class__ is not list:
            return type_error(object, sym("SIMPLE-VECTOR"))
        try:
            return object[index] if object.__class__ is list else aref(object, index)
        except (TypeError, IndexError):
            return type_error(object, kind)

    def vector_setter(new, object):
        if structure.element_type is True and object.__class__ is not list:
            return type_error(object, sym("SIMPLE-VECTOR"))
        if object.__class__ is not list:
            return set_aref(new, object, index)
        try:
            object[index] = new
        except (TypeError, IndexError):
            return type_error(object, kind)
        return new

    return (list_accessor, list_setter) if structure.representation == "LIST" else (vector_accessor, vector_setter)


def _define_constructor(structure, constructor):
    if constructor is None:
        return
    if not isinstance(constructor, (Cons, list, tuple)):
        construct = keyword_constructor(structure)
        construct.shape = Shape()
        construct.shape.has_keys, construct.shape.keys = True, [keyword(symbol_name(slot.name)) for slot in structure.slots]
        _function(constructor, construct)
        return
    symbol, variables, function, empty = python_list(constructor)
    empty = {symbol_name(variable) for variable in python_list(empty)}
    indexes = {symbol_name(variable): index for index, variable in enumerate(python_list(variables))}
    order = [indexes.get(symbol_name(slot.name)) for slot in structure.slots]

    make = maker_of_values(structure, order, empty)

    def construct(*arguments, **keywords):
        return make(one(function(*arguments, **keywords)))

    construct.shape = shape_of(function)
    _function(symbol, construct)


def boa_lambda_list(lambda_list, initforms, included=None):
    """(lambda list, variables, empty) for a BOA constructor: optional and keyword parameters without default get that of their slot.

    initforms: those of the slots that the form itself gives, by name. included: the name of the included type, which is asked for the
    defaults of the slots that it has. empty: the ``&aux`` variables without a form, whose slots are left without a value.

    The macro then passes ``(list name (quote variables) (lambda lambda-list (list . variables)) (quote empty))`` to `define_structure`
    (ANSI 3.4.6).
    """
    result, variables, empty, state = [], [], [], "required"
    for item in python_list(lambda_list):
        name = item.name if isinstance(item, Symbol) else ""
        if name.startswith("&") and name in ("&OPTIONAL", "&REST", "&KEY", "&AUX", "&ALLOW-OTHER-KEYS"):
            state = name
            result.append(item)
            continue
        parts = python_list(item) if isinstance(item, Cons) else [item]
        variable = parts[0].cdr.car if isinstance(parts[0], Cons) else parts[0]
        if state in ("&OPTIONAL", "&KEY") and len(parts) == 1:
            own = variable in initforms or included is None
            parts.append(
                initforms.get(variable)
                if own
                else lisp_list(sym("CRAMHY::SLOT-DEFAULT"), *(lisp_list(QUOTE, part) for part in (included, variable)))
            )
        elif state == "&AUX" and len(parts) == 1:
            empty.append(variable)
        variables.append(variable)
        if len(parts) == 3:
            variables.append(parts[2])
        result.append(list_from(parts) if len(parts) > 1 else item)
    return list_from(result), list_from(variables), list_from(empty)


def slot_default(structure, name):
    """The value of the initform of the slot ``name`` of a structure type, as compiled BOA constructors ask for it; nil without one."""
    slot = find_structure(structure).slot(name)
    return None if slot is None else slot.default()


def _define_copier(structure, symbol):
    def copier(object):
        if structure.cls is None:
            return list_from(python_list(object)) if structure.representation == "LIST" else structure.vector(elements(object))
        if not isinstance(object, structure.cls):
            return type_error(object, structure.name)
        return copy_structure(object)

    _function(symbol, copier)


def copy_structure(structure):
    """``cl:copy-structure``"""
    if not isinstance(structure, StructureObject):
        return type_error(structure, sym("STRUCTURE-OBJECT"), "\nwhen binding STRUCTURE")
    description = type(structure).lisp_structure
    new = object.__new__(type(structure))
    for (set_slot, _), (_, value) in zip(description.fields, slots_of(structure)):
        set_slot(new, value)
    return new


def _define_predicate(structure, symbol):
    if structure.cls is not None:
        cls = structure.cls
        _function(symbol, lambda object: True if isinstance(object, cls) else None)
        return
    index, name = structure.name_position(), structure.name

    def predicate(object):
        items = object if isinstance(object, list) else list(object) if isinstance(object, Cons) else []
        return True if len(items) > index and items[index] is name else None

    _function(symbol, predicate)


def _define_printing(structure, print_function, print_object_function):
    if structure.cls is None or (print_function is None and print_object_function is None):
        return

    if print_function is not None:
        LEVELS_COUNT.value = True

    def print_it(object, stream):
        if print_function is not None:
            return _callable(print_function)(object, stream, CURRENT_LEVEL.value)
        return _callable(print_object_function)(object, stream)

    add_method(protocol_functions.print_object, (), [structure.cls, True], print_it, uses_next=False)


def _callable(designator):
    return designator.function if isinstance(designator, Symbol) else designator
