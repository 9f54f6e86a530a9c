"""Lisp classes as Python classes: the metaclass, STANDARD-OBJECT, and which slots a class has.

``defclass`` makes a Python class. Its slots are Python attributes, so Python code reads ``robot.speed``; unbound is the
attribute that is missing. `StandardClass` orders superclasses as CLOS does (ANSI 4.3.5), which now and then is not Python's
order. Classes of the runtime's rooms are plain Python classes that say what Lisp sees of them: ``lisp_name =
"PACKAGE::NAME"`` and ``initargs = {"SLOT-NAME": "attribute"}``; users may inherit from them.

Which attribute holds a slot is asked per class, because two slots of different packages may have one Python name: the second
gets an underscore more. A class that is defined again stays the same object; `touch_classes` makes everybody forget what they
had computed about it.
"""

from __future__ import annotations

from . import protocol_functions
from cramhy_runtime.lisp_core.printing import prin1_to_string

from cramhy_runtime.lisp_core import classes
from cramhy_runtime.lisp_core.conditions import SimpleError, UnboundSlot, error
from cramhy_runtime.lisp_core.data import UNBOUND, Symbol, python_list
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.lisp_core.packages import keyword, printed, sym, symbol_name
from . import builtin_classes


class StandardClass(type):
    """The metaclass of classes made by ``defclass`` and ``define-condition``."""

    lisp_name = "STANDARD-CLASS"

    def mro(cls):
        return precedence_list(cls)

    def __call__(cls, *initargs, **keywords):
        """Python's way of ``make-instance``. A subclass that Python code wrote is made as Python makes it."""
        if "lisp_direct_slots" in vars(cls):
            return classes.make_instance(cls, *initargs, **keywords)
        return super().__call__(*initargs, **keywords)


def precedence_list(cls):
    """The class precedence list of ``cls`` by the rule of ANSI 4.3.5.1; a contradiction is an error that explains it."""
    classes, stack = [], [cls]
    while stack:
        current = stack.pop()
        if current not in classes:
            classes.append(current)
            stack.extend(current.__bases__)
    before = {current: set() for current in classes}  # what must come before each class
    for current in classes:
        previous = current
        for base in current.__bases__:
            before[base].add(previous)
            previous = base
    result = []
    while len(result) < len(classes):
        free = [current for current in classes if current not in result and before[current].issubset(result)]
        if not free:
            return _contradiction(cls, [current for current in classes if current not in result])
        result.append(free[0] if len(free) == 1 else _rightmost_subclass(free, result))
    return result


def _rightmost_subclass(free, result):
    for current in reversed(result):
        for base in current.__bases__:
            if base in free:
                return base
    return free[0]


def _contradiction(cls, rest):
    names = [_name(current) for current in rest]
    return error(
        SimpleError(
            "While computing the class precedence list of the class named ~A.~%It is not possible to compute the class precedence "
            "list because~%there is a circularity in the local precedence relations.~%This arises because of these classes: ~A.~%"
            "A class that is listed as a superclass must not come before its own subclass.",
            _name(cls),
            ", ".join(names),
        )
    )


def _name(cls):
    symbol = vars(cls).get("lisp_symbol")  # the class is not complete, so it cannot be asked
    return printed(symbol) if symbol is not None else vars(cls).get("lisp_name", cls.__name__)


class SlotDefinition:
    """The class of `DirectSlot` and `Slot`."""

    lisp_name = "SB-MOP::SLOT-DEFINITION"
    others: tuple = ()
    """Options that only a metaclass of a user knows, as a property list."""


class DirectSlot(SlotDefinition):
    """A slot as a class definition gives it. ``initfunction`` is a thunk or ``None``; ``cell`` holds the value of a class slot."""

    lisp_name = "SB-MOP::STANDARD-DIRECT-SLOT-DEFINITION"

    def __init__(
        self,
        name,
        initargs=(),
        initfunction=None,
        initform=None,
        allocation="INSTANCE",
        type=True,
        documentation=None,
        readers=(),
        writers=(),
    ):
        self.name, self.initargs, self.initfunction, self.initform = name, initargs, initfunction, initform
        self.allocation, self.type, self.documentation = allocation, type, documentation
        self.readers, self.writers = readers, writers
        self.cell = None

    def lisp_init(
        self,
        name=None,
        initargs=None,
        initfunction=None,
        initform=None,
        allocation=None,
        type=True,
        documentation=None,
        readers=None,
        writers=None,
    ):
        """What ``make-instance`` does, where lists are Lisp's and the allocation is a keyword."""
        shared = allocation is not None and symbol_name(allocation) == "CLASS"
        lists = [tuple(python_list(each)) for each in (initargs, readers, writers)]
        DirectSlot.__init__(
            self, name, lists[0], initfunction, initform, "CLASS" if shared else "INSTANCE", type, documentation, lists[1], lists[2]
        )


class Slot(SlotDefinition):
    """A slot as instances of one class have it: `DirectSlot` definitions of all superclasses combined (ANSI 7.5.3)."""

    lisp_name = "SB-MOP::STANDARD-EFFECTIVE-SLOT-DEFINITION"

    def __init__(self, name, attribute, initargs=(), initfunction=None, initform=None, type=True, owner=None):
        self.name, self.attribute, self.initargs = name, attribute, initargs
        self.initfunction, self.initform, self.type = initfunction, initform, type
        self.cell = self.documentation = None
        self.owner = owner
        self.direct: list = []

    def lisp_init(self, name=None, initargs=None, initfunction=None, initform=None, type=True, allocation=None, documentation=None):
        """What ``make-instance`` does. The attribute is found when a class has the slot."""
        Slot.__init__(self, name, None, tuple(python_list(initargs)), initfunction, initform, type)
        self.documentation = documentation


class SlotMember:
    """The attribute of a class for a slot whose value is not, or not only, in the dictionary of the instance."""


class ClassSlot(SlotMember):
    """The Python attribute for a slot with ``:allocation :class``: one value for all instances."""

    def __init__(self, name):
        self.name, self.value = name, UNBOUND

    def __get__(self, instance, owner):
        if instance is None:
            return self
        if self.value is UNBOUND:
            return protocol_functions.slot_unbound(type(instance), instance, self.name)
        return self.value

    def __set__(self, instance, value):
        self.value = value

    def __delete__(self, instance):
        self.value = UNBOUND


class InstanceSlot:
    """What a class has for a slot that instances may lack: Python looks here when an instance has no value of its own.

    Python reads an attribute in a fifth of the time if its class has nothing of that name. So a class gets this when an instance can be
    seen without a value (`may_be_unbound`), and most classes never do. (With a method ``__getattr__`` Python would look there, too, but
    then every access to any attribute would take three times as long.)
    """

    def __init__(self, attribute):
        self.attribute = attribute

    def __get__(self, instance, owner):
        if instance is None:
            raise AttributeError(self.attribute)  # the class has no value
        return missing_attribute(instance, self.attribute)


VALUES = "lisp_slot_values"
"""The attribute of a class that holds the values of its own slots, those of its metaclass."""


class MetaobjectSlot(SlotMember):
    """The attribute of a metaclass for a slot of its classes. Were it an attribute of the class, instances would have it, too."""

    def __init__(self, slot):
        self.slot = slot

    def __get__(self, cls, owner):
        if cls is None:
            return self
        if self.slot.cell is not None:
            return self.slot.cell.__get__(cls, owner)
        value = vars(cls).get(VALUES, {}).get(self.slot.name, UNBOUND)
        return protocol_functions.slot_unbound(owner, cls, self.slot.name) if value is UNBOUND else value

    def __set__(self, cls, value):
        if self.slot.cell is not None:
            self.slot.cell.value = value
        elif VALUES in vars(cls):
            vars(cls)[VALUES][self.slot.name] = value
        else:
            setattr(cls, VALUES, {self.slot.name: value})

    def __delete__(self, cls):
        self.__set__(cls, UNBOUND)

    def is_bound(self, cls):
        """Whether the slot of ``cls`` has a value."""
        values = vars(cls).get(VALUES, {})
        return (self.slot.cell.value if self.slot.cell is not None else values.get(self.slot.name, UNBOUND)) is not UNBOUND


def missing_attribute(instance, attribute):
    """The value of an attribute that ``instance`` lacks: the slot is unbound, or the class was defined again with more slots."""
    slot = slot_of_attribute(type(instance), attribute)
    if slot is None:
        raise AttributeError(f"{type(instance).__name__!r} object has no attribute {attribute!r}")
    from .slots import missing_value

    return missing_value(instance, slot)


class StandardObject(metaclass=StandardClass):
    """STANDARD-OBJECT: the root of the classes of ``defclass``."""

    lisp_name = "STANDARD-OBJECT"

    def __init__(self, *initargs, **keywords):
        """For subclasses written in Python: ``super().__init__(name="x")`` sets slots as ``make-instance`` does."""
        from .instances import initialize_from_python

        initialize_from_python(self, initargs, keywords)

    def __init_subclass__(cls, **keywords):
        super().__init_subclass__(**keywords)
        if "lisp_direct_slots" not in vars(cls):  # a class that Python code wrote makes instances in its own way
            may_be_unbound(cls)

    def lisp_condition(self, attribute):
        """The condition for Python's complaint that this has no ``attribute``: Python code deleted that of a slot."""
        slot = slot_of_attribute(type(self), attribute)
        if slot is None:
            return None
        may_be_unbound(type(self), [slot])
        return UnboundSlot(slot.name, self)

    def __repr__(self):
        return prin1_to_string(self)


builtin_classes.set_standard_object(StandardObject)


# ------------------------------------------------------------------------------------------------------ slots of a class

_slots: dict = {}


def touch_classes():
    """Forget everything that was computed about classes."""
    _slots.clear()
    builtin_classes.forget()
    classes.touch_classes()


_class_watchers: list = []


def when_class_is_changed(function):
    """Call ``function(class)`` whenever a class was defined again."""
    _class_watchers.append(function)


def tell_of_change(cls):
    """Tell those that want to know that ``cls`` was defined again."""
    for function in _class_watchers:
        function(cls)


def effective_slots(cls):
    """The slots of instances of ``cls``: a dict from slot name (a Symbol) to `Slot`, in order of definition."""
    found = _slots.get(cls)
    if found is None:
        by_protocol = getattr(type(cls), "lisp_protocol", None)
        found = _slots[cls] = _compute_slots(cls) if by_protocol is None else by_protocol(cls)
        if issubclass(cls, StandardObject):
            hide_class_slots(cls)
    return found


def hide_class_slots(cls):
    """Let instances of ``cls`` have their own value of a slot that is shared in a superclass and is not shared in ``cls``."""
    may_be_unbound(cls, [slot for slot in effective_slots(cls).values() if isinstance(_member(cls, slot), ClassSlot)])


def _member(cls, slot):
    return next((vars(base)[slot.attribute] for base in cls.__mro__ if slot.attribute in vars(base)), None)


def may_be_unbound(cls, slots=None):
    """From now on instances of ``cls`` may lack a value of one of ``slots`` (all, if not given), and reading it is an error of Lisp.

    To be called before anybody can see such an instance. It gives ``cls`` an `InstanceSlot` for each slot for which it has none, and
    inherits none.
    """
    for slot in effective_slots(cls).values() if slots is None else slots:
        if slot.cell is None:
            member = _member(cls, slot)
            if member is None or isinstance(member, ClassSlot):
                setattr(cls, slot.attribute, InstanceSlot(slot.attribute))


def slot_of_attribute(cls, attribute):
    for slot in effective_slots(cls).values():
        if slot.attribute == attribute:
            return slot
    return None


def find_slot(cls, name):
    """The `Slot` named by the Symbol ``name``, or ``None``.

    Slots of runtime classes are also found by a symbol of the same name in another package, because a page of the reference
    may not say in which package the original has its symbol.
    """
    slots = effective_slots(cls)
    found = slots.get(name)
    if found is None and isinstance(name, Symbol):
        for slot in slots.values():
            if slot.owner is not None and slot.name.name == name.name:
                return slot
    return found


def direct_slots(cls):
    """The slots that ``cls`` itself defines, a list of `DirectSlot`."""
    own = vars(cls).get("lisp_direct_slots")
    if own is not None:
        return own
    slots = [DirectSlot(_runtime_symbol(cls, name), (keyword(name),)) for name in vars(cls).get("initargs", ())]
    return slots + [DirectSlot(_runtime_symbol(cls, name)) for name in vars(cls).get("lisp_slots", ())]


def _runtime_symbol(cls, name):
    if "::" in name:
        return sym(name)
    package = vars(cls).get("lisp_name", "").rpartition("::")[0]
    return sym(f"{package}::{name}" if package else name)


def _compute_slots(cls):
    slots: dict = {}
    taken = _python_attributes(cls)
    kept = vars(cls).get("lisp_attributes", {})  # the attributes before the class was defined again
    for base in reversed(cls.__mro__):
        if "lisp_direct_slots" not in vars(base):
            for name, attribute in vars(base).get("initargs", {}).items():
                symbol = _runtime_symbol(base, name)
                slots[symbol] = Slot(symbol, attribute, (keyword(name.rpartition("::")[2]),), owner=base)
                taken.add(attribute)
            for name, attribute in vars(base).get("lisp_slots", {}).items():
                symbol = _runtime_symbol(base, name)
                slots[symbol] = Slot(symbol, attribute, owner=base)
                taken.add(attribute)
    for base in reversed(cls.__mro__):
        for direct in vars(base).get("lisp_direct_slots", ()):
            slot = slots.get(direct.name)
            if slot is None:
                attribute = kept.get(direct.name) or _free_attribute(direct.name, taken)
                slot = slots[direct.name] = Slot(direct.name, attribute)
                taken.add(attribute)
            _inherit(slot, direct)
    return slots


def direct_slots_by_name(cls):
    """The direct slots that ``cls`` and its superclasses define, by name: lists, the most specific first, in order of definition."""
    found: dict = {}
    for base in reversed(cls.__mro__):
        for direct in vars(base).get("lisp_direct_slots", ()):
            found.setdefault(direct.name, []).insert(0, direct)
    return found


def combined_slot(name, direct):
    """The `Slot` of the `DirectSlot` definitions ``direct``, the most specific first; it has no attribute yet."""
    slot = Slot(name, None)
    for each in reversed(direct):
        _inherit(slot, each)
    return slot


def attribute_for(cls, name, taken=None):
    """The attribute for the slot ``name`` of instances of ``cls``, and the attributes that are then taken, of which some were."""
    taken = _python_attributes(cls) if taken is None else taken
    inherited = [slots[name].attribute for base in cls.__mro__[1:] if (slots := _slots.get(base)) is not None and name in slots]
    attribute = vars(cls).get("lisp_attributes", {}).get(name) or (inherited or [_free_attribute(name, taken)])[0]
    taken.add(attribute)
    return attribute, taken


def _free_attribute(symbol, taken):
    attribute = python_name(symbol.name)
    while attribute in taken:
        attribute += "_"
    return attribute


def _inherit(slot, direct):
    # Called from the least to the most specific class: the later definition wins, initargs add up.
    slot.direct.insert(0, direct)
    slot.initargs = tuple(dict.fromkeys((*direct.initargs, *slot.initargs)))
    if direct.initfunction is not None:
        slot.initfunction, slot.initform = direct.initfunction, direct.initform
    if direct.type is not True:
        slot.type = direct.type
    slot.cell = direct.cell
    slot.documentation = direct.documentation if direct.documentation is not None else slot.documentation


def _python_attributes(cls):
    """Names that a slot may not take as its attribute: those that Python code of runtime superclasses uses.

    A subclass that somebody wrote in Python knows the slots by their names and takes none away.
    """
    taken = set()
    lisp_defined = tuple(base for base in cls.__mro__ if "lisp_direct_slots" in vars(base))
    for base in cls.__mro__:
        if base is object or lisp_defined and issubclass(base, lisp_defined) and base not in lisp_defined:
            continue
        taken.update(vars(base).get("reserved_attributes", ()))
        for name, value in vars(base).items():
            if isinstance(value, (ClassSlot, InstanceSlot)) or hasattr(value, "is_bound"):
                continue
            taken.add(name)
            code = getattr(value, "__code__", None)
            if code is not None and base is not StandardObject and "lisp_direct_slots" not in vars(base):
                taken.update(code.co_names)
    return taken
