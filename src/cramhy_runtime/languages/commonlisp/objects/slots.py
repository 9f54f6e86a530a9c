"""``slot-value`` and its relatives.

A slot is a Python attribute; which one, is asked per class (see ``class_objects.py``) and remembered in a table, so
``slot-value`` costs two dictionary look-ups and a ``getattr``. Whatever is unusual (unbound, missing, a class that was defined
again after the instance was made) is found when the attribute is missing. The four accidents are generic functions that users
may define methods for: SLOT-UNBOUND, SLOT-MISSING, UPDATE-INSTANCE-FOR-REDEFINED-CLASS. Source: ANSI 7.5; texts are SBCL's.
"""

from __future__ import annotations

from . import protocol_functions
from operator import attrgetter

from cramhy_runtime.lisp_core.condition_types import MissingSlot
from cramhy_runtime.lisp_core.condition_types import shown
from cramhy_runtime.lisp_core.conditions import Condition, SimpleError, UnboundSlot, ask_value, error, restart_case, type_error
from cramhy_runtime.lisp_core.known_calls import Classes
from cramhy_runtime.lisp_core.data import UNBOUND, Symbol, boolean, list_from, one, truth
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from cramhy_runtime.lisp_core.python_names import python_name
from .class_objects import InstanceSlot, SlotMember, StandardObject, effective_slots, find_slot, may_be_unbound
from cramhy_runtime.lisp_core.classes import when_classes_change
from .classes import class_of

LISP_NAMES = "slot-value slot-boundp slot-makunbound slot-exists-p"

_attributes: dict = {}
"""For each class a dict from slot name to attribute; class slots have attributes too."""


_named: dict = {}
"""The `NamedSlot` of each name that compiled code quotes."""


@when_classes_change
def _forget():
    _attributes.clear()
    for named in _named.values():
        named.replace(())


class NamedSlot(Classes):
    """The classes from whose instances compiled code takes the slot ``name`` itself: it is the attribute ``attribute`` of them.

    A class comes in when `read` or `write` was called for an instance of it.
    """

    __slots__ = ("name", "attribute")

    def __init__(self, name):
        super().__init__()
        self.name, self.attribute, self.last = name, python_name(name.name), None

    def read(self, instance):
        """``(slot-value instance name)``"""
        value = slot_value(instance, self.name)
        self._note(instance.__class__)
        return value

    def write(self, new, instance):
        """``(setf (slot-value instance name) new)``"""
        set_slot_value(new, instance, self.name)
        self._note(instance.__class__)
        return new

    def _note(self, cls):
        if issubclass(cls, StandardObject) and _attributes.get(cls, {}).get(self.name) == self.attribute:
            self.add(cls)
            self.last = cls


def named_slot(name):
    """The `NamedSlot` of the symbol ``name``."""
    found = _named.get(name)
    if found is None:
        found = _named[name] = NamedSlot(name)
    return found


def _attribute(obj, name):
    """The attribute for the slot ``name`` of ``obj``, or ``None`` when there is no such slot."""
    table = _attributes.get(obj.__class__)
    if table is None:
        table = _attributes[obj.__class__] = {}
    found = table.get(name) if isinstance(name, Symbol) else None
    if found is None:
        if not is_symbol(name):
            return type_error(name, sym("SYMBOL"), "\nwhen binding SB-PCL::SLOT-NAME")
        slot = slot_of(obj, name)
        if slot is None:
            return None
        found = table[name] = slot.attribute
    return found


def slot_of(obj, name):
    """The `Slot` of ``obj`` named ``name``, or ``None``."""
    cls = obj.__class__
    structure = getattr(cls, "lisp_structure", None)
    if structure is not None and not isinstance(obj, type):
        return structure.slot(name)
    return find_slot(cls, name)


def slot_value(object, slot_name):
    """``cl:slot-value``"""
    try:
        value = getattr(object, _attributes[object.__class__][slot_name])
    except (KeyError, AttributeError, TypeError):
        return _slot_value(object, slot_name)
    return value if value is not UNBOUND else _slot_value(object, slot_name)


def _slot_value(obj, name):
    attribute = _attribute(obj, name)
    if attribute is None:
        return missing_slot(obj, name, "SLOT-VALUE", "read the slot's value (slot-value)")
    try:
        value = getattr(obj, attribute)  # STANDARD-OBJECT signals the unbound slot itself
    except AttributeError:
        value = UNBOUND
    return protocol_functions.slot_unbound(class_of(obj), obj, name) if value is UNBOUND else value


def set_slot_value(new, object, slot_name):
    """``(setf slot-value)``"""
    try:
        setattr(object, _attributes[object.__class__][slot_name], new)
    except (KeyError, TypeError, AttributeError):
        attribute = _attribute(object, slot_name)
        if attribute is None:
            missing_slot(object, slot_name, "SETF", f"set the slot's value to {shown(new)} (SETF of SLOT-VALUE)", new)
        else:
            by_lisp = getattr(getattr(object.__class__, attribute, None), "set_by_lisp", None)  # of what Python cannot assign
            if by_lisp is None:
                setattr(object, attribute, new)
            else:
                by_lisp(object, new)
    return new


SETTERS = {"SLOT-VALUE": set_slot_value}


def slot_boundp(object, slot_name):
    """``cl:slot-boundp``"""
    attribute = _attribute(object, slot_name)
    if attribute is None:
        return boolean(truth(one(missing_slot(object, slot_name, "SLOT-BOUNDP", "test to see whether slot is bound (SLOT-BOUNDP)"))))
    return boolean(is_bound(object, attribute))


def is_bound(obj, attribute):
    """Whether ``attribute``, which stands for a slot of ``obj``, has a value."""
    update_if_obsolete(obj)
    own = getattr(obj, "__dict__", None)
    if own is not None and attribute in own and not isinstance(getattr(type(obj), attribute, None), SlotMember):
        return own[attribute] is not UNBOUND
    for cls in type(obj).__mro__:
        if attribute in vars(cls):
            member = vars(cls)[attribute]
            if isinstance(member, InstanceSlot):
                return False
            if hasattr(member, "is_bound"):
                return member.is_bound(obj)
            if hasattr(member, "value") and hasattr(member, "__set__"):
                return member.value is not UNBOUND
            try:
                return getattr(obj, attribute) is not UNBOUND
            except AttributeError:
                return False
    return False


def slot_makunbound(object, slot_name):
    """``cl:slot-makunbound``: returns the object."""
    attribute = _attribute(object, slot_name)
    if attribute is None:
        missing_slot(object, slot_name, "SLOT-MAKUNBOUND", "make the slot unbound (SLOT-MAKUNBOUND)")
    else:
        if isinstance(object, StandardObject):
            may_be_unbound(type(object), [slot_of(object, slot_name)])
        try:
            delattr(object, attribute)
        except AttributeError:
            if getattr(type(object), attribute, UNBOUND) is not UNBOUND:
                setattr(object, attribute, UNBOUND)
    return object


def slot_exists_p(object, slot_name):
    """``cl:slot-exists-p``"""
    return boolean(_attribute(object, slot_name) is not None)


def missing_slot(obj, name, operation, what, new=UNBOUND):
    """Call SLOT-MISSING, or, when users defined no method for it, signal the error. ``what`` ends "When attempting to"."""
    if protocol_functions.slot_missing.user_methods:
        arguments = (class_of(obj), obj, name, sym(operation), *(() if new is UNBOUND else (new,)))
        return protocol_functions.slot_missing(*arguments)
    return error(MissingSlot(name, obj, what))


def unbound_slot_error(cls, obj, name):
    """The default of SLOT-UNBOUND: signal unbound-slot with restarts USE-VALUE and STORE-VALUE, whose value is returned."""
    if isinstance(obj, Condition):
        return error(SimpleError("Unbound condition slot: ~S", name))

    def store(value):
        return set_slot_value(value, obj, name)

    return restart_case(
        [
            (sym("USE-VALUE"), lambda value: value, "Return a value as the slot-value.", ask_value),
            (sym("STORE-VALUE"), store, "Store and return a value as the slot-value.", ask_value),
        ],
        lambda: error(UnboundSlot(name, obj)),
    )


# ------------------------------------------------------------------------------------------------ instances of changed classes


def missing_value(obj, slot):
    """The value of an attribute that Python did not find in ``obj``: after an update of the instance, or unbound."""
    if update_if_obsolete(obj):
        value = getattr(obj, "__dict__", {}).get(slot.attribute, UNBOUND)
        if value is not UNBOUND:
            return value
    return protocol_functions.slot_unbound(class_of(obj), obj, slot.name)


def update_if_obsolete(obj):
    """Bring ``obj`` up to date when its class was defined again since; whether there was something to do."""
    cls = type(obj)
    version = vars(cls).get("lisp_version", 0)
    if not version or isinstance(obj, type):
        return False
    own = obj.__dict__
    seen = own.get("lisp_version", 0)
    if seen == version:
        return False
    own["lisp_version"] = version
    before = vars(cls)["lisp_history"][seen]
    now = effective_slots(cls)
    added = [name for name in now if name not in before and now[name].cell is None]
    discarded, plist = [], []
    for name, attribute in before.items():
        if name not in now:
            discarded.append(name)
            if attribute in own:
                plist += [name, own.pop(attribute)]
    protocol_functions.update_instance_for_redefined_class(obj, list_from(added), list_from(discarded), list_from(plist))
    return True


# ------------------------------------------------------------------------------------------------------------ accessor methods


def reader_for(name):
    """The function of the reader method for the slot ``name``, made for each class of argument: see `generic.add_method`."""

    def for_classes(classes):
        slot = find_slot(classes[0], name)
        if slot.cell is not None:
            return lambda obj: slot.cell.__get__(obj, type(obj))
        return attrgetter(slot.attribute)

    for_classes.attribute_in = _attribute_of_instances(name)
    return for_classes


def _attribute_of_instances(name):
    def attribute_in(cls):
        """The attribute of the slot in instances of ``cls``; ``None`` if it has one value for all."""
        slot = find_slot(cls, name) if isinstance(cls, type) else None
        return slot.attribute if slot is not None and slot.cell is None else None

    return attribute_in


def writer_for(name):
    """The same for the writer method: its function takes the new value and the object."""

    def for_classes(classes):
        slot = find_slot(classes[1], name)
        cell, attribute = slot.cell, slot.attribute

        def write(new, obj):
            setattr(obj, attribute, new)
            return new

        def write_shared(new, obj):
            cell.value = new
            return new

        write.writes_attribute = attribute
        return write if cell is None else write_shared

    for_classes.attribute_in = _attribute_of_instances(name)
    return for_classes
