"""Classes whose class a user has defined: the metaobject protocol of classes and slots.

``(defclass counted-class (standard-class) ...)`` makes a metaclass of Python. A class with ``(:metaclass counted-class)`` is an instance
of it, and is made by the functions of the protocol, on which the user may define methods: what slots it has, of which classes their
definitions are, how instances are made and their slots read. Slots of the metaclass itself are kept apart from the attributes of the
class (`MetaobjectSlot`), which its instances would see.

Reading a slot of an instance is Python's access of an attribute, here as everywhere. Only where a method of a user on
``slot-value-using-class`` or its relatives applies, the class has a `UsedSlot` for the slot, which calls them. So no other class is slower.
Source: chapters 5 and 6 of the MOP; texts are SBCL's.
"""

from __future__ import annotations

import weakref

from cramhy_runtime.lisp_core.conditions import SimpleError, error
from cramhy_runtime.lisp_core.data import UNBOUND, Cons, Symbol, boolean, lisp_list, list_from, one, python_list, truth
from cramhy_runtime.lisp_core.dispatch.generic_functions import when_methods_change
from cramhy_runtime.lisp_core.packages import is_symbol, keyword, sym, symbol_name
from cramhy_runtime.lisp_core.python_names import python_name

from . import class_definition, instances, protocol_functions, slots
from .builtin_classes import lisp_mro
from .class_objects import (
    ClassSlot,
    DirectSlot,
    Slot,
    SlotMember,
    StandardClass,
    StandardObject,
    attribute_for,
    combined_slot,
    direct_slots_by_name,
    effective_slots,
    may_be_unbound,
)
from .classes import class_name, class_of, find_class, find_class_or_error, register_class, registered_class
from .instances import Plan

made_classes: weakref.WeakSet = weakref.WeakSet()
"""The classes whose class a user has defined."""


def opened(function):
    """The generic function that ``function`` has become, or the function itself as long as no user has a method on it."""
    opening = getattr(function, "opening", None)
    return function if opening is None or opening.generic is None else opening.generic


def _applicable(function, position, cls):
    """Whether a method that a user has on ``function`` may apply to an object of the class ``cls`` as the argument at ``position``."""
    opening = getattr(function, "opening", None)
    if opening is None or opening.generic is None:
        return False
    mro = lisp_mro(cls)
    return any(not isinstance(each.specializers[position], type) or each.specializers[position] in mro for each in opening.added)


# ------------------------------------------------------------------------------------------------------- making and changing


def validate_superclass(class_, superclass):
    """``sb-mop:validate-superclass``: whether instances of the class of the first may inherit from the second."""
    if superclass is object:
        return True
    first, second = class_of(class_), class_of(superclass)
    return boolean(first is second or not issubclass(first, StandardClass))


def check_superclasses(cls, bases, name):
    """Signal an error if ``validate-superclass`` does not allow one of ``bases`` to be a superclass of ``cls``."""
    for base in bases:
        if vars(base).get("lisp_forward_reference"):
            continue
        if not truth(one(opened(validate_superclass)(cls, base))):
            error(
                SimpleError(
                    "The class ~S cannot be a superclass of ~S, because the class of the first, ~S, is not compatible with that of the "
                    "other, ~S.~%Define a method for ~S on (~S ~S) that returns true, if it is.",
                    base,
                    name,
                    class_of(base),
                    class_of(cls),
                    sym("SB-MOP::VALIDATE-SUPERCLASS"),
                    class_name(class_of(cls)),
                    class_name(class_of(base)),
                )
            )


def ensure_class(name, *initargs):
    """``sb-mop:ensure-class``: define or change the class ``name``."""
    found = find_class(name, None) if is_symbol(name) and name is not None else None
    return opened(ensure_class_using_class)(found, name, *initargs)


def ensure_class_using_class(class_, name, *initargs):
    """``sb-mop:ensure-class-using-class``: ``class_`` is the class that ``name`` names, or nil."""
    given = _by_name(initargs)
    metaclass = find_class_or_error(given.pop("METACLASS", StandardClass if class_ is None else class_of(class_)))
    pairs = [
        (key, value) for key, value in zip(initargs[::2], initargs[1::2]) if symbol_name(key) not in ("METACLASS", "DIRECT-SUPERCLASSES")
    ]
    if "DIRECT-SUPERCLASSES" in given:
        bases = [class_definition.superclass(name, base) for base in python_list(given["DIRECT-SUPERCLASSES"])]
        pairs.insert(0, (keyword("DIRECT-SUPERCLASSES"), list_from(bases)))
    initargs = [part for pair in pairs for part in pair]
    old = registered_class(name)
    if old is not None and vars(old).get("lisp_forward_reference"):
        old.__class__ = metaclass
        protocol_functions.initialize_instance(old, *instances.plan_for(metaclass).with_defaults(tuple(initargs)), keyword("NAME"), name)
        return old
    if old is not None and type(old) is metaclass and class_name(old) is name:
        protocol_functions.reinitialize_instance(old, *initargs)
        return old
    return register_class(name, sym("MAKE-INSTANCE").function(metaclass, keyword("NAME"), name, *initargs))


def _by_name(initargs):
    """The initargs by the names of their keywords; the first one counts."""
    found = {}
    for key, value in zip(initargs[::2], initargs[1::2]):
        found.setdefault(symbol_name(key), value)
    return found


def allocate_class(metaclass):
    """A new class without a name and without slots, of which ``metaclass`` is the class."""
    namespace = {"lisp_symbol": None, "lisp_direct_slots": [], "lisp_fresh": True, "__module__": __name__}
    cls = metaclass.__new__(metaclass, "anonymous", (StandardObject,), namespace)
    made_classes.add(cls)
    return cls


INITARGS = {keyword(name) for name in "NAME DIRECT-SUPERCLASSES DIRECT-SLOTS DIRECT-DEFAULT-INITARGS DOCUMENTATION".split()}
"""The initargs of every class."""


def initialize_class(cls, initargs):
    """What ``shared-initialize`` does for a class: give it the superclasses, slots and default initargs of ``initargs``."""
    given, fresh = _by_name(initargs), "lisp_fresh" in vars(cls)
    if "NAME" in given:
        cls.lisp_symbol = given["NAME"]
        cls.__name__ = cls.__qualname__ = python_name(symbol_name(given["NAME"])) if given["NAME"] is not None else "anonymous"
    name = class_name(cls)
    bases, own = list(cls.__bases__), vars(cls).get("lisp_direct_slots", [])
    if "DIRECT-SUPERCLASSES" in given or fresh:
        bases = [find_class_or_error(base) for base in python_list(given.get("DIRECT-SUPERCLASSES"))]
        bases = [base for base in bases if base is not object]
        if not any(issubclass(base, StandardObject) for base in bases):
            bases.append(StandardObject)
        check_superclasses(cls, bases, name)
    if "DIRECT-SLOTS" in given or fresh:
        own = [_direct_slot(cls, python_list(each)) for each in python_list(given.get("DIRECT-SLOTS"))]
        class_definition.check_slots(name if name is not None else sym("STANDARD-CLASS"), own, "DEFCLASS")
    if "DIRECT-DEFAULT-INITARGS" in given or fresh:
        cls.lisp_default_initargs = [
            (key, function) for key, _, function in map(python_list, python_list(given.get("DIRECT-DEFAULT-INITARGS")))
        ]
    if "DOCUMENTATION" in given or fresh:
        cls.__doc__ = given.get("DOCUMENTATION")
    if fresh:
        del cls.lisp_fresh
        class_definition.begin(cls, bases, own)
    else:
        class_definition.change(cls, bases, own)
    class_definition.define_accessors(cls, own)
    if _is_complete(cls):
        opened(finalize_inheritance)(cls)


def _direct_slot(cls, initargs):
    """The direct slot definition for the slot that a property list describes."""
    made = one(opened(direct_slot_definition_class)(cls, *initargs))
    found = make_slot(made, initargs)
    found.cell = ClassSlot(found.name) if found.allocation == "CLASS" else None
    return found


def make_slot(cls, initargs):
    """An instance of ``cls``, `DirectSlot` or `Slot` or a user's subclass of one."""
    return sym("MAKE-INSTANCE").function(cls, *initargs)


def direct_slot_definition_class(class_, *initargs):
    """``sb-mop:direct-slot-definition-class``: the class of direct slot definitions of ``class_``."""
    return DirectSlot


def effective_slot_definition_class(class_, *initargs):
    """``sb-mop:effective-slot-definition-class``: the class of effective slot definitions of ``class_``."""
    return Slot


# ------------------------------------------------------------------------------------------------------------- finalizing


def finalize_inheritance(class_):
    """``sb-mop:finalize-inheritance``: find the slots of a class, now that all of its superclasses are there."""
    instances.check_finalized(class_)
    effective_slots(class_)


def class_finalized_p(class_):
    """``sb-mop:class-finalized-p``: whether the slots of a class are known; those of others than users' metaclasses always are."""
    return boolean(_is_complete(class_) and ("lisp_made_slots" in vars(class_) or class_ not in made_classes))


def _is_complete(cls):
    """Whether all superclasses of ``cls`` are defined."""
    return not any(vars(base).get("lisp_forward_reference") for base in cls.__mro__)


def compute_class_precedence_list(class_):
    """``sb-mop:compute-class-precedence-list``"""
    return list_from(StandardClass.mro(class_))


def slots_of(cls):
    """The slots of a class that is made by the protocol: a dict from names to `Slot`. They are computed when it or a superclass changes;
    meanwhile the former ones count."""
    made = vars(cls).get("lisp_made_slots", {})
    if "lisp_stale" not in vars(cls):
        return made
    del cls.lisp_stale
    found, taken = {}, None
    for slot in python_list(one(opened(compute_slots)(cls))):
        if slot.attribute is None:  # a method of the user has made it
            slot.attribute, taken = attribute_for(cls, slot.name, taken)
        found[slot.name] = slot
    cls.lisp_made_slots = found
    for slot in found.values():
        _use(cls, slot)
    return found


def compute_slots(class_):
    """``sb-mop:compute-slots``: the effective slot definitions of a class, from those of its superclasses."""
    found, taken = [], None
    for name, direct in direct_slots_by_name(class_).items():
        slot = one(opened(compute_effective_slot_definition)(class_, name, list_from(direct)))
        if slot.attribute is None:
            slot.attribute, taken = attribute_for(class_, name, taken)
        found.append(slot)
    return list_from(found)


def compute_effective_slot_definition(class_, name, direct_slot_definitions):
    """``sb-mop:compute-effective-slot-definition``: one of ``direct_slot_definitions``, the most specific first."""
    direct = python_list(direct_slot_definitions)
    combined = combined_slot(name, direct)
    initargs = [keyword("NAME"), name, keyword("INITARGS"), list_from(combined.initargs), keyword("INITFORM"), combined.initform]
    initargs += [keyword("INITFUNCTION"), combined.initfunction, keyword("TYPE"), combined.type]
    initargs += [keyword("ALLOCATION"), keyword("CLASS" if combined.cell is not None else "INSTANCE")]
    made = one(opened(effective_slot_definition_class)(class_, *initargs))
    slot = combined if made is Slot else make_slot(made, initargs)
    slot.cell, slot.documentation, slot.direct = combined.cell, combined.documentation, direct
    return slot


def compute_default_initargs(class_):
    """``sb-mop:compute-default-initargs``: a list of (initarg, form, function)."""
    return list_from([lisp_list(key, None, thunk) for key, thunk in class_definition.default_initargs(class_).items()])


# ---------------------------------------------------------------------------------------------------------- slots of instances


class UsedSlot(SlotMember):
    """What a class has for a slot of its instances when a user's methods on ``slot-value-using-class`` may apply to it."""

    def __init__(self, slot):
        self.name, self.cell = slot.name, slot.cell

    def _slot(self, instance):
        return effective_slots(type(instance))[self.name]

    def __get__(self, instance, owner):
        if instance is None:
            return self
        return one(opened(slot_value_using_class)(owner, instance, self._slot(instance)))

    def __set__(self, instance, new):
        opened(set_slot_value_using_class)(new, type(instance), instance, self._slot(instance))

    def __delete__(self, instance):
        opened(slot_makunbound_using_class)(type(instance), instance, self._slot(instance))

    def is_bound(self, instance):
        """Whether the slot of ``instance`` has a value."""
        return truth(one(opened(slot_boundp_using_class)(type(instance), instance, self._slot(instance))))


def _use(cls, slot):
    """Give ``cls`` a `UsedSlot` for ``slot`` if a user's method may apply, else the usual member."""
    member, cell = vars(cls).get(slot.attribute), slot.cell
    if any(_applicable(function, position, type(cls)) for function, position in _ACCESS):
        setattr(cls, slot.attribute, UsedSlot(slot))
    elif member.__class__ is UsedSlot:
        delattr(cls, slot.attribute)
        if cell is not None and any(direct.cell is cell for direct in vars(cls)["lisp_direct_slots"]):
            setattr(cls, slot.attribute, cell)


@when_methods_change
def _methods_changed(generic_function):
    name = generic_function.__lisp_name__
    symbol = name.cdr.car if isinstance(name, Cons) else name
    if isinstance(symbol, Symbol) and symbol.name in _NAMES:
        for cls in list(made_classes):
            for slot in vars(cls).get("lisp_made_slots", {}).values():
                _use(cls, slot)


_NAMES = {f"SLOT-{name}-USING-CLASS" for name in ("VALUE", "BOUNDP", "MAKUNBOUND")}


def slot_value_using_class(class_, instance, slot):
    """``sb-mop:slot-value-using-class``"""
    if not isinstance(instance, StandardObject):
        return slots.slot_value(instance, slot.name)
    value = slot.cell.value if slot.cell is not None else instance.__dict__.get(slot.attribute, UNBOUND)
    return slots.missing_value(instance, slot) if value is UNBOUND else value


def set_slot_value_using_class(new, class_, instance, slot):
    """``(setf sb-mop:slot-value-using-class)``"""
    if not isinstance(instance, StandardObject):
        return slots.set_slot_value(new, instance, slot.name)
    if slot.cell is not None:
        slot.cell.value = new
    else:
        instance.__dict__[slot.attribute] = new
    return new


def slot_boundp_using_class(class_, instance, slot):
    """``sb-mop:slot-boundp-using-class``"""
    if not isinstance(instance, StandardObject):
        return slots.slot_boundp(instance, slot.name)
    slots.update_if_obsolete(instance)
    return boolean((instance.__dict__.get(slot.attribute, UNBOUND) if slot.cell is None else slot.cell.value) is not UNBOUND)


def slot_makunbound_using_class(class_, instance, slot):
    """``sb-mop:slot-makunbound-using-class``: returns the instance."""
    if not isinstance(instance, StandardObject):
        return slots.slot_makunbound(instance, slot.name)
    if slot.cell is not None:
        slot.cell.value = UNBOUND
    else:
        if vars(type(instance)).get(slot.attribute).__class__ is not UsedSlot:
            may_be_unbound(type(instance), [slot])
        instance.__dict__.pop(slot.attribute, None)
    return instance


_ACCESS = ((slot_value_using_class, 0), (set_slot_value_using_class, 1), (slot_boundp_using_class, 0), (slot_makunbound_using_class, 0))
"""The functions by which slots of instances are reached, and the positions of their arguments that are the class."""


# -------------------------------------------------------------------------------------------------------------- making instances


class UsersPlan(Plan):
    """How instances of a class are made whose class a user has defined, and how such a class is made."""

    by_protocol = True

    def __init__(self, cls):
        super().__init__(cls)
        if _applicable(compute_default_initargs, 0, type(cls)):
            entries = map(python_list, python_list(one(opened(compute_default_initargs)(cls))))
            self.defaults = {key: function for key, _, function in entries}
        self.allocates = bool(instances.applicable_user_methods(protocol_functions.allocate_instance, type(cls)))
        if issubclass(cls, type) and self.valid is not None:
            self.valid |= INITARGS

    def make(self, initargs):
        """What ``make-instance`` does."""
        initargs = self.with_defaults(initargs)
        self.check(initargs)
        obj = one(protocol_functions.allocate_instance(self.cls, *initargs)) if self.allocates else self.allocate(initargs)
        if self.custom or issubclass(self.cls, type):
            protocol_functions.initialize_instance(obj, *initargs)
        else:
            self.fill(obj, initargs)
        return obj

    def allocate(self, initargs):
        return allocate_class(self.cls) if issubclass(self.cls, type) else super().allocate(initargs)

    def fill(self, obj, initargs, wanted=True):
        given = set()
        for index in range(0, len(initargs), 2):
            for slot in self.targets.get(initargs[index], ()):
                if slot.name not in given:
                    given.add(slot.name)
                    if initargs[index] not in self.parameters:
                        setattr(obj, slot.attribute, initargs[index + 1])
        for slot, initfunction in self.initforms:
            if slot.name not in given and (wanted is True or slot.name in wanted) and not slots.is_bound(obj, slot.attribute):
                setattr(obj, slot.attribute, one(initfunction()))
        if wanted is True and not issubclass(self.cls, type) and not given.issuperset(self.without_initform):
            self.may_lack([slot for name, slot in self.without_initform.items() if name not in given])
        if issubclass(self.cls, type):
            initialize_class(obj, initargs)


def become_metaclass(cls):
    """Let classes of the class ``cls``, a subclass of STANDARD-CLASS, be made by the protocol."""
    cls.lisp_protocol = staticmethod(slots_of)
    cls.mro = _precedence


def _precedence(cls):
    if "lisp_fresh" not in vars(cls) and _applicable(compute_class_precedence_list, 0, type(cls)):
        return python_list(one(opened(compute_class_precedence_list)(cls)))
    return StandardClass.mro(cls)
