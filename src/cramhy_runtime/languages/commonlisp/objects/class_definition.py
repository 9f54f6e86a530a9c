"""``defclass`` and ``define-condition`` at run time.

The macros pass what they have taken apart, with initforms and default initargs as thunks; here the Python class is made, or
changed when the name has one already. Readers, writers and accessors become methods of generic functions whose effective
function is a bare attribute access. Source: ANSI 7.1, 7.5 and 9.1; texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.conditions import SimpleError, error
from cramhy_runtime.lisp_core.data import UNBOUND, Symbol, list_from, one, python_list
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.lisp_core.packages import is_symbol, keyword, sym, symbol_name
from ..streams.streams import StringOutputStream
from ..packages.package_errors import check_symbol
from ..syntax.declaration_names import check_type_name
from .class_objects import (
    ClassSlot,
    InstanceSlot,
    MetaobjectSlot,
    hide_class_slots,
    DirectSlot,
    StandardClass,
    StandardObject,
    effective_slots,
    may_be_unbound,
    missing_attribute,
    tell_of_change,
    touch_classes,
)
from .classes import (
    BuiltInClass,
    FuncallableStandardClass,
    StructureClass,
    class_name,
    find_class_or_error,
    invalid_class_definition,
    qualified,
    register_class,
    registered_class,
    symbol_class,
)
from cramhy_runtime.lisp_core.dispatch.generic_functions import FunctionObject, add_method, ensure_generic_function, remove_method
from cramhy_runtime.lisp_core.dispatch.methods import ReaderMethod, WriterMethod
from .slots import reader_for, writer_for


def slot_spec(
    name,
    *,
    initargs=None,
    initform=None,
    initform_source=None,
    readers=None,
    writers=None,
    accessors=None,
    allocation=None,
    type=True,
    documentation=None,
    others=None,
):
    """The description of one slot for `define_class` and `define_condition`.

    name: a Symbol. initargs: a Lisp list of symbols. initform: a thunk, or nil when there is no initform; initform_source: the
    form. readers, accessors: lists of symbols. writers: a list of function names, symbols or ``(setf symbol)``. allocation:
    ``:instance`` or ``:class``. type: a type specifier. documentation: a string. others: a property list of further options, for the
    metaclass.
    """
    readers, writers = python_list(readers), python_list(writers)
    for accessor in python_list(accessors):
        readers.append(accessor)
        writers.append(list_from([sym("SETF"), accessor]))
    shared = allocation is not None and symbol_name(allocation) == "CLASS"
    slot = DirectSlot(
        name,
        tuple(python_list(initargs)),
        initform,
        initform_source,
        "CLASS" if shared else "INSTANCE",
        type,
        documentation,
        tuple(readers),
        tuple(writers),
    )
    if others is not None:
        slot.others = tuple(python_list(others))
    return slot


def define_class(name, superclasses=None, slots=None, *, default_initargs=None, metaclass=None, documentation=None, others=None):
    """``defclass``: define or redefine the class ``name``; returns the class.

    name: a Symbol. superclasses: a list (Lisp or Python) of symbols or classes; one that is not defined yet becomes a forward
    reference. slots: a list of `slot_spec` results. default_initargs: a list of (initarg, thunk, form) lists. metaclass: a
    symbol; a class of a user's metaclass is made by `metaclasses.ensure_class`. documentation: a string. others: a property list of
    further options, for the metaclass.
    """
    slots = python_list(slots)
    check_symbol(name, "defining ~S as a class", name)
    check_type_name(name)
    check_slots(name, slots, "DEFCLASS")
    initargs = [python_list(entry)[0] for entry in python_list(default_initargs)]
    for initarg in initargs:
        if initargs.count(initarg) > 1:
            invalid_class_definition("Duplicate initialization argument name ~S in :DEFAULT-INITARGS of DEFCLASS ~S.", initarg, name)
    superclasses = python_list(superclasses)
    found = find_class_or_error(metaclass) if metaclass is not None else StandardClass
    if "lisp_direct_slots" in vars(found):
        return _defined_by_protocol(name, superclasses, slots, default_initargs, found, documentation, others)
    _refuse_others(slots, others)
    if name in superclasses or registered_class(name) in superclasses:
        error(SimpleError("Class named ~A specified as its own superclass.", qualified(name)))
    bases = [superclass(name, base) for base in superclasses]
    _check_superclasses(name, bases)
    bases = [base for base in bases if base is not object]
    if found is FuncallableStandardClass:
        bases = _function_bases(bases)
    if not any(issubclass(base, StandardObject) for base in bases):
        bases.append(StandardObject)
    if any("lisp_direct_slots" in vars(type(base)) for base in bases):
        from .metaclasses import check_superclasses

        check_superclasses(StandardObject, bases, name)
    cls = _make_or_change(name, bases, slots)
    cls.lisp_default_initargs = [tuple(python_list(entry))[:2] for entry in python_list(default_initargs)]
    cls.__doc__ = documentation
    if found is not StandardClass:
        cls.lisp_metaclass = found
    define_accessors(cls, slots)
    return cls


def _defined_by_protocol(name, superclasses, slots, default_initargs, metaclass, documentation, others):
    """The class that the metaobject protocol makes of the parts of a ``defclass`` form."""
    from .metaclasses import ensure_class

    given = {"DIRECT-SUPERCLASSES": list_from(superclasses), "DIRECT-SLOTS": list_from([_plist_of_slot(slot) for slot in slots])}
    defaults = [python_list(entry) for entry in python_list(default_initargs)]
    if documentation is not None:
        given["DOCUMENTATION"] = documentation
    given["DIRECT-DEFAULT-INITARGS"] = list_from([list_from([key, form, thunk]) for key, thunk, form in defaults])
    given["METACLASS"] = metaclass
    initargs = [part for key, value in given.items() for part in (keyword(key), value)]
    return ensure_class(name, *initargs, *python_list(others))


def _plist_of_slot(slot):
    given = {"NAME": slot.name, "INITARGS": list_from(slot.initargs), "READERS": list_from(slot.readers)}
    given["WRITERS"] = list_from(slot.writers)
    if slot.initfunction is not None:
        given |= {"INITFORM": slot.initform, "INITFUNCTION": slot.initfunction}
    if slot.allocation == "CLASS":
        given["ALLOCATION"] = keyword("CLASS")
    if slot.type is not True:
        given["TYPE"] = slot.type
    if slot.documentation is not None:
        given["DOCUMENTATION"] = slot.documentation
    return list_from([*(part for key, value in given.items() for part in (keyword(key), value)), *slot.others])


def _function_bases(bases):
    """The superclasses of a class of functions: it inherits from FUNCALLABLE-STANDARD-OBJECT, and from generic functions as users have
    them."""
    from .metafunctions import FuncallableObject, function_base

    bases = [function_base(base) for base in bases]
    return bases if any(issubclass(base, (FuncallableObject, FunctionObject)) for base in bases) else [*bases, FuncallableObject]


def _refuse_others(slots, others):
    """Signal an error for options of a class or of slots that only a metaclass of a user could know."""
    for slot in slots:
        if slot.others:
            invalid_class_definition(
                "There is no slot option ~S, which slot ~S has. The options are ~{:~A~^, ~}.",
                slot.others[0],
                slot.name,
                list_from(sorted("INITARG INITFORM READER WRITER ACCESSOR ALLOCATION TYPE DOCUMENTATION".split())),
            )
    if others is not None:
        invalid_class_definition("there is no option ~S.", others.car)


def check_slots(name, slots, operator):
    names = [slot.name for slot in slots]
    for slot in slots:
        if not is_symbol(slot.name) or slot.name in (None, True) or slot.name.constant:
            invalid_class_definition("~S is not a slot name, in ~A ~S.", slot.name, operator, name)
        if wrong := [initarg for initarg in slot.initargs if not is_symbol(initarg)]:
            invalid_class_definition("~S is not an initarg, in the slot ~S of ~A ~S.", wrong[0], slot.name, operator, name)
        if names.count(slot.name) > 1:
            invalid_class_definition("Multiple slots named ~S in ~A ~S.", slot.name, operator, name)
    if not isinstance(name, Symbol):
        invalid_class_definition("The name of the class in ~A must be a symbol, not ~S.", operator, name)


def superclass(name, base):
    cls = base if isinstance(base, type) else symbol_class(base)
    if cls is None:
        cls = StandardClass(
            python_name(base.name),
            (StandardObject,),
            {"lisp_symbol": base, "lisp_direct_slots": [], "lisp_forward_reference": True, "__module__": __name__},
        )
        return register_class(base, cls)
    if isinstance(cls, (BuiltInClass, StructureClass)):
        return error(
            SimpleError(
                "The class ~A was specified as a superclass of the class ~A, but it is a ~A: only classes of defclass can be superclasses.",
                qualified(class_name(cls)),
                qualified(name),
                "structure class" if isinstance(cls, StructureClass) else "built-in class",
            )
        )
    return cls


def _check_superclasses(name, bases):
    """Signal an error if the class ``name`` would be its own superclass by a round of others."""
    old = registered_class(name)
    if old is not None and any(issubclass(base, old) for base in bases):
        error(SimpleError("Specified class ~S as a superclass of itself.", old))


def _make_or_change(name, bases, slots):
    for slot in slots:
        if slot.allocation == "CLASS":
            slot.cell = ClassSlot(slot.name)
    old = registered_class(name)
    if (
        old is None
        or class_name(old) is not name
        or "lisp_direct_slots" not in vars(old)
        or issubclass(old, Condition) != issubclass(bases[0], Condition)
    ):
        return register_class(name, _new_class(name, bases, slots))
    return _change(name, old, bases, slots)


def _new_class(name, bases, slots):
    metaclass = _metaclass(bases)
    namespace = {"lisp_symbol": name, "lisp_direct_slots": slots, "__module__": _module_name(name)}
    if metaclass is None:
        cls = StandardClass(python_name(name.name), (StandardObject,), namespace)
        cls.__bases__ = tuple(bases)
    else:
        cls = metaclass(python_name(name.name), tuple(bases), namespace)
    _install_class_slots(cls, slots)
    return cls


def _metaclass(bases):
    """`StandardClass`, combined with whatever metaclass the Python superclasses have; ``None`` if a superclass is of a user's metaclass,
    which its subclasses in Python would have, too."""
    if any("lisp_direct_slots" in vars(type(base)) for base in bases):
        return None
    others = {type(base) for base in bases if not issubclass(StandardClass, type(base))}
    if not others or others == {StandardClass}:
        return StandardClass
    if len(others) == 1 and issubclass(next(iter(others)), StandardClass):
        return next(iter(others))
    return type("StandardClass", (StandardClass, *others), {})


def _module_name(symbol):
    return python_name(symbol.package.name) if symbol.package else "lisp"


def begin(cls, bases, slots):
    """Give a class that was just made its superclasses and slots."""
    if tuple(bases) != cls.__bases__:
        cls.__bases__ = tuple(bases)
    cls.lisp_direct_slots = slots
    cls.lisp_stale = True
    touch_classes()
    _install_class_slots(cls, slots)


def change(cls, bases, slots):
    """The same for a class that exists; its instances are updated when they are next looked at."""
    _change(class_name(cls), cls, bases, slots)


def _change(name, cls, bases, slots):
    """Give the existing class new superclasses and slots; its instances are updated when they are next looked at."""
    changed = [sub for sub in _with_subclasses(cls) if "lisp_direct_slots" in vars(sub)]
    before = {sub: {slot.name: slot.attribute for slot in effective_slots(sub).values()} for sub in changed}
    held = {sub: _in_instances(sub) for sub in changed}
    lacking = {sub for sub in changed if any(isinstance(value, InstanceSlot) for base in sub.__mro__ for value in vars(base).values())}
    if tuple(bases) != cls.__bases__:
        try:
            cls.__bases__ = tuple(bases)
        except TypeError:  # Python cannot lay the instances out anew: old ones keep the old class
            new = _new_class(name, bases, slots)
            return register_class(name, new)
    old_cells = {slot.name: slot.cell for slot in cls.lisp_direct_slots if slot.cell is not None}
    for slot in slots:
        if slot.cell is not None and slot.name in old_cells:
            slot.cell.value = old_cells[slot.name].value
    for sub in changed:
        kinds = (ClassSlot, InstanceSlot) if sub is cls else InstanceSlot
        for attribute in [name for name, value in vars(sub).items() if isinstance(value, kinds) or hasattr(value, "is_bound")]:
            delattr(sub, attribute)
    _remove_accessors(cls)
    cls.lisp_direct_slots = slots
    if "lisp_forward_reference" in vars(cls):
        del cls.lisp_forward_reference
    for sub in changed:
        if "lisp_made_slots" in vars(sub):
            sub.lisp_stale = True
    touch_classes()
    for sub in changed:
        sub.lisp_attributes = before[sub]
        if {slot.name: slot.attribute for slot in effective_slots(sub).values()} != before[sub]:
            sub.lisp_version = vars(sub).get("lisp_version", 0) + 1
            sub.lisp_history = [*vars(sub).get("lisp_history", ()), before[sub]]
        if sub in lacking or not _in_instances(sub) <= held[sub]:
            may_be_unbound(sub)
    _install_class_slots(cls, slots)
    for sub in changed:
        hide_class_slots(sub)
    tell_of_change(cls)
    return cls


def _in_instances(cls):
    """The attributes that instances of ``cls`` have for slots."""
    return {slot.attribute for slot in effective_slots(cls).values() if slot.cell is None}


def _with_subclasses(cls):
    result = [cls]
    for sub in result:
        result.extend(other for other in type.__subclasses__(sub) if other not in result)
    return result


def _install_class_slots(cls, slots):
    if issubclass(cls, type):
        for slot in effective_slots(cls).values():
            setattr(cls, slot.attribute, MetaobjectSlot(slot))
        from .metaclasses import become_metaclass

        become_metaclass(cls)
        return
    for slot in slots:
        if slot.cell is not None:
            setattr(cls, effective_slots(cls)[slot.name].attribute, slot.cell)
            initfunction = effective_slots(cls)[slot.name].initfunction  # perhaps that of a superclass
            if initfunction is not None and slot.cell.value is UNBOUND:
                slot.cell.value = one(initfunction())


# ----------------------------------------------------------------------------------------------------------------- accessors


def define_accessors(cls, slots):
    cls.lisp_accessors = []
    for slot in slots:
        for reader in slot.readers:
            gf = ensure_generic_function(reader, list_from([sym("OBJECT")]))
            method = add_method(gf, (), [cls], reader_for(slot.name), uses_next=False, per_class=True)
            method.__class__, method.slot_definition = ReaderMethod, slot
            cls.lisp_accessors.append((gf, method))
        for writer in slot.writers:
            gf = ensure_generic_function(writer, list_from([sym("NEW-VALUE"), sym("OBJECT")]))
            method = add_method(gf, (), [True, cls], writer_for(slot.name), uses_next=False, per_class=True)
            method.__class__, method.slot_definition = WriterMethod, slot
            cls.lisp_accessors.append((gf, method))


def _remove_accessors(cls):
    for gf, method in vars(cls).get("lisp_accessors", ()):
        remove_method(gf, method)


# ---------------------------------------------------------------------------------------------------------------- conditions


def define_condition(name, parents=None, slots=None, *, report=None, default_initargs=None, documentation=None):
    """``define-condition``: define or redefine the condition class ``name``; returns ``name``.

    parents: a list of symbols or classes, CONDITION by default. slots: a list of `slot_spec` results. report: a string, a
    function of condition and stream, or nil to inherit the text. default_initargs, documentation: as for `define_class`.
    """
    slots = python_list(slots)
    check_symbol(name, "defining ~S as a condition", name)
    check_type_name(name)
    check_slots(name, slots, "DEFINE-CONDITION")
    bases = [find_class_or_error(parent) for parent in python_list(parents)] or [Condition]
    for base in bases:
        if not issubclass(base, Condition):
            error(SimpleError("~S is not a condition class and cannot be a parent of the condition ~S.", class_name(base), name))
    bases = [base for base in bases if not any(other is not base and issubclass(other, base) for other in bases)]
    cls = _make_or_change(name, bases, slots)
    cls.lisp_default_initargs = [tuple(python_list(entry))[:2] for entry in python_list(default_initargs)]
    cls.__doc__ = documentation
    if report is not None:
        cls.report = _report_method(report)
    elif "report" in vars(cls):
        del cls.report
    if "__getattr__" not in vars(cls):
        cls.__getattr__ = missing_attribute
    define_accessors(cls, slots)
    return name


def _report_method(report):
    if isinstance(report, str) or report.__class__.__name__ == "LispString":
        return lambda self: str(report)

    def write(self, stream):
        function = report.function if isinstance(report, Symbol) else report
        function(self, stream)

    def text(self):
        stream = StringOutputStream()
        write(self, stream)
        return stream.text()

    text.write = write
    return text


def default_initargs(cls):
    """The default initargs of ``cls``: a dict from keyword to thunk, superclasses included."""
    result = {}
    for base in cls.__mro__:
        for key, thunk in vars(base).get("lisp_default_initargs", ()):
            result.setdefault(key, thunk)
    return result
