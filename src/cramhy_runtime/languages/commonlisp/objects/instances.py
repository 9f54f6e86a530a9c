"""Making, initializing and changing instances.

``make-instance`` works from a plan per class: which initarg sets which attributes, which slots have initforms, which initargs
are valid. Where users defined methods for INITIALIZE-INSTANCE or SHARED-INITIALIZE that apply to the class, the protocol of
ANSI 7.1 runs as generic functions; else the plan is carried out directly, with the same result. A runtime class (plain Python)
with an ``__init__`` gets the initargs that are parameters of it as Python keywords. Texts are SBCL's.
"""

from __future__ import annotations

from . import protocol_functions
import copy
from types import FunctionType
from fractions import Fraction

from cramhy_runtime.lisp_core.condition_types import Condition, ProgramError, shown
from cramhy_runtime.lisp_core.conditions import SimpleError, error, program_error, type_error
from cramhy_runtime.lisp_core.data import FLOATS, UNBOUND, Character, Cons, Keyword, LispString, Symbol, list_from, one, python_list
from cramhy_runtime.lisp_core.packages import is_symbol, keyword, symbol_name
from .builtin_classes import BuiltInClass, lisp_mro
from .class_definition import default_initargs
from .class_objects import SlotDefinition, StandardClass, StandardObject, effective_slots, find_slot, may_be_unbound
from .constructors import instance_constructor
from cramhy_runtime.lisp_core.classes import when_classes_change
from .classes import StructureClass, SystemClass, class_name, class_of, find_class_or_error, metaclass_of, qualified
from cramhy_runtime.lisp_core.dispatch.generic_functions import no_method_for, when_methods_change
from cramhy_runtime.lisp_core.dispatch.method_combination import AFTER, STANDARD
from cramhy_runtime.kernel.images import part
from cramhy_runtime.lisp_core.dispatch.keyword_checks import ALLOW_OTHER_KEYS, other_keys_allowed


class InitargError(ProgramError):
    """An initialization argument that no slot and no method takes."""

    lisp_name = "SB-PCL::INITARG-ERROR"
    initargs = {"CLASS": "class_", "INITARGS": "invalid"}

    def __init__(self, class_=None, invalid=(), **slots):
        super().__init__(**slots)
        self.class_, self.invalid = class_, invalid

    def report(self):
        names = ", ".join(shown(name) for name in self.invalid)
        plural = "s" if len(self.invalid) > 1 else ""
        return (
            f"Invalid initialization argument{plural}:\n  {names}\nin call for class {shown(self.class_)}.\nSee also:\n"
            f"  The ANSI Standard, Section 7.1.2"
        )


_plans: dict = {}


_constructors: dict = {}
"""(class, initargs) → how often instances were made so, or the function that was written for it, or ``None``."""
_OFTEN = 3


@when_classes_change
def _forget_plans():
    _plans.clear()
    _constructors.clear()
    for function in _watchers:
        function()


@when_methods_change
def _methods_changed(generic_function):
    name = generic_function.__lisp_name__
    if is_symbol(name) and symbol_name(name) in _PROTOCOL:
        _forget_plans()


class _Callers:
    """Stands among those who are told that a function of the protocol changes, as by ``trace``."""

    @staticmethod
    def refresh():
        _forget_plans()


@part
class _OfImage:
    """Methods of users are those of the current image."""

    @staticmethod
    def take():
        return None

    @staticmethod
    def put(state):
        _forget_plans()

    @staticmethod
    def copy(state):
        return None


_watchers: list = []


def when_plans_change(function):
    """Call ``function()`` whenever classes, methods or a trace change how instances are made."""
    _watchers.append(function)
    return function


_PROTOCOL = ("INITIALIZE-INSTANCE", "SHARED-INITIALIZE", "ALLOCATE-INSTANCE", "REINITIALIZE-INSTANCE")


class Plan:
    """How instances of one class are made."""

    by_protocol = False

    def __init__(self, cls):
        self.cls = cls
        check_finalized(cls)
        slots = effective_slots(cls).values()
        self.targets: dict = {}  # initarg -> slots that it sets
        for slot in slots:
            for key in slot.initargs:
                self.targets.setdefault(key, []).append(slot)
        own = [slot for slot in slots if slot.cell is None]
        self.initforms = [(slot, slot.initfunction) for slot in own if slot.initfunction is not None]
        self.without_initform = {slot.name: slot for slot in own if slot.initfunction is None}
        self.shared = [slot for slot in slots if slot.cell is not None and slot.initfunction is not None]
        self.defaults = default_initargs(cls)
        self.python_init, self.parameters = _python_init(cls, slots)
        methods = [
            method
            for function in (protocol_functions.initialize_instance, protocol_functions.shared_initialize)
            for method in applicable_user_methods(function, cls)
        ]
        self.custom = bool(methods) and not issubclass(cls, Condition)
        self.afters = _afters(cls, methods) if self.custom else []
        if self.python_init is not None or self.afters is None:  # code of others sees the instance before its slots are filled
            self.may_lack()
        self.valid = None
        if not issubclass(cls, Condition) and not any(method.shape.allow_other_keys for method in methods):
            self.valid = {*self.targets, *self.parameters, ALLOW_OTHER_KEYS, *(key for method in methods for key in method.shape.keys)}
        self.version = vars(cls).get("lisp_version", 0)

    def may_lack(self, slots=None):
        """To be called before anybody sees an instance without values of ``slots``, by default all."""
        if issubclass(self.cls, StandardObject):
            may_be_unbound(self.cls, slots)

    def check(self, initargs):
        if len(initargs) % 2:
            program_error("odd number of &KEY arguments")
        if self.valid is None:
            return
        wrong = [key for key in initargs[::2] if key not in self.valid]
        if wrong and not other_keys_allowed(initargs):
            error(InitargError(self.cls, list(reversed(dict.fromkeys(wrong)))))

    def allocate(self, initargs):
        """A new object, for which Python's ``__init__`` has run, if the class has one."""
        obj = self.cls.__new__(self.cls)
        if self.python_init is not None:
            given = {}
            for index in range(0, len(initargs), 2):
                parameter = self.parameters.get(initargs[index])
                if parameter is not None:
                    given.setdefault(parameter, initargs[index + 1])
            try:
                self.python_init(obj, **given)
            except TypeError as problem:
                if "required" not in str(problem):
                    raise
                missing = [shown(key) for key, name in self.parameters.items() if name not in given and repr(name) in str(problem)]
                error(SimpleError("~S needs the initialization argument~P ~A.", class_name(self.cls), len(missing), ", ".join(missing)))
        if self.version:
            obj.__dict__["lisp_version"] = self.version
        return obj

    def with_defaults(self, initargs):
        if self.defaults:
            given = set(initargs[::2])
            for key, thunk in self.defaults.items():
                if key not in given:
                    initargs = (*initargs, key, one(thunk()))
        return initargs

    def fill(self, obj, initargs, wanted=True):
        """Set the slots: from ``initargs``, else from the initforms of unbound slots in ``wanted`` (names, or True for all)."""
        given = set()
        for index in range(0, len(initargs), 2):
            for slot in self.targets.get(initargs[index], ()):
                if slot.name not in given:
                    given.add(slot.name)
                    if slot.cell is not None:
                        slot.cell.value = initargs[index + 1]
                    elif initargs[index] not in self.parameters:
                        setattr(obj, slot.attribute, initargs[index + 1])
        for slot, initfunction in self.initforms:
            if slot.name not in given and (wanted is True or slot.name in wanted) and slot.attribute not in obj.__dict__:
                setattr(obj, slot.attribute, one(initfunction()))
        if wanted is True and not given.issuperset(self.without_initform):
            self.may_lack([slot for name, slot in self.without_initform.items() if name not in given])


def _afters(cls, methods):
    """The functions of the :after methods of ``initialize-instance``, in their order, if there are no other ``methods``; or ``None``."""
    functions = protocol_functions.initialize_instance, protocol_functions.shared_initialize
    if any(function.watcher is not None or function.combination is not STANDARD for function in functions):
        return None
    mro = lisp_mro(cls)
    for method in methods:
        if method.generic_function is not functions[0] or method.qualifiers != (AFTER,) or method.uses_next or method.per_class:
            return None
    methods.sort(key=lambda method: -mro.index(method.specializers[0]))
    return [method.function for method in methods]


def constructor_for(cls, keys):
    """The function that makes an instance of ``cls`` from the values of the initargs ``keys``; ``None`` if the protocol must do that."""
    found = _constructors.get((cls, keys), 0)
    if found.__class__ is int:
        if len(_constructors) > 5000:
            _constructors.clear()
        plan = _plans.get(cls) or _plan_or_error(cls)
        found = _constructors[cls, keys] = None if plan.by_protocol else instance_constructor(plan, keys)
        _hear_of_traces()
    return found


def _hear_of_traces():
    for function in (protocol_functions.initialize_instance, protocol_functions.shared_initialize):
        function.__lisp_name__.calls.kept("constructors", lambda: _Callers)


def check_finalized(cls):
    """Signal an error if a superclass of ``cls`` is not defined yet."""
    if vars(cls).get("lisp_forward_reference"):
        error(_undefined_class(SimpleError("FINALIZE-INHERITANCE was called on a forward referenced class:~%~S", cls), cls))
    for base in cls.__mro__:
        if vars(base).get("lisp_forward_reference"):
            problem = SimpleError(
                "While computing the class precedence list of the class named ~A.~%The class named ~A is a forward "
                "referenced class.~%The class named ~A is a direct superclass of the class named ~A.",
                qualified(class_name(cls)),
                qualified(class_name(base)),
                qualified(class_name(base)),
                qualified(class_name(_child(cls, base))),
            )
            error(_undefined_class(problem, base))


def _undefined_class(problem, cls):
    """``problem``, told with the names that are like that of ``cls``."""
    problem.name, problem.undefined = class_name(cls), "type"
    return problem


def _child(cls, base):
    """The class among ``cls`` and its superclasses that names ``base`` as its superclass."""
    return next(each for each in cls.__mro__ if base in each.__bases__)


def _python_init(cls, slots):
    """(the ``lisp_init`` or ``__init__`` of the runtime class behind ``cls``, or None; its parameters by initarg)"""
    for base in cls.__mro__:
        if base in (object, type, BaseException, Exception, StandardObject):
            continue
        init = getattr(base, "lisp_init", None) or vars(base).get("__init__")
        if init is None or "lisp_direct_slots" in vars(base):
            continue
        import inspect  # 5 ms, and most programs make no instance of a Python class

        names = [
            name
            for name, parameter in list(inspect.signature(init).parameters.items())[1:]
            if parameter.kind in (parameter.POSITIONAL_OR_KEYWORD, parameter.KEYWORD_ONLY)
        ]
        parameters = {}
        for slot in slots:
            if slot.attribute in names:
                parameters.update((key, slot.attribute) for key in slot.initargs)
        for name in names:
            if name not in parameters.values():
                parameters[keyword(name.rstrip("_").replace("_", "-").upper())] = name
        return init, parameters
    return None, {}


def applicable_user_methods(generic_function, *argument_classes):
    """The methods of users that could apply to instances of ``argument_classes`` as first arguments."""
    mros = [lisp_mro(cls) for cls in argument_classes]
    return [
        method
        for method in generic_function.methods
        if all(specializer in mro for specializer, mro in zip(method.specializers, mros))
        and not getattr(method.function, "lisp_default", False)
    ]


def plan_for(cls):
    plan = _plans.get(cls)
    if plan is None:
        kind = Plan
        if issubclass(cls, type) or "lisp_direct_slots" in vars(type(cls)):
            from .metaclasses import UsersPlan as kind
        plan = _plans[cls] = kind(cls)
    return plan


# -------------------------------------------------------------------------------------------------------------- make-instance


def make_instance(class_, *initargs, **keywords):
    """``cl:make-instance`` for a class or its name. Python callers may give initargs as keywords: ``make_instance(cls, x=1)``."""
    cls = class_ if isinstance(class_, type) else find_class_or_error(class_)
    if keywords:
        initargs = _with_keywords(initargs, keywords)
    key = (cls, initargs[::2])
    try:
        written = _constructors.get(key, 0)
    except TypeError:  # something that is no keyword and has no hash
        written = None
    if written.__class__ is FunctionType and not len(initargs) & 1:
        return written(*initargs[1::2])
    plan = _plans.get(cls) or _plan_or_error(cls)
    if plan.by_protocol:
        return plan.make(initargs)
    if written.__class__ is int and not isinstance(cls, StructureClass):
        _constructors[key] = written + 1
        if written > _OFTEN:
            constructor_for(*key)
    if isinstance(cls, StructureClass):
        return cls.lisp_structure.construct(*initargs)
    initargs = plan.with_defaults(initargs)
    plan.check(initargs)
    obj = plan.allocate(initargs)
    if plan.custom:
        protocol_functions.initialize_instance(obj, *initargs)
    else:
        plan.fill(obj, initargs)
    return obj


def _with_keywords(initargs, keywords):
    return (*initargs, *(part for name, value in keywords.items() for part in (keyword(name.rstrip("_").replace("_", "-").upper()), value)))


def initialize_from_python(instance, initargs, keywords):
    """Set the slots of an instance of a Python subclass, whose ``__init__`` is running, from initargs and initforms."""
    plan = plan_for(type(instance))
    initargs = plan.with_defaults(_with_keywords(initargs, keywords))
    plan.check(initargs)
    if plan.custom:
        protocol_functions.initialize_instance(instance, *initargs)
    else:
        plan.fill(instance, initargs)


def _is_closed(cls):
    """Whether ``cls`` is a class of classes of which nobody may make any."""
    return issubclass(cls, type) and not issubclass(cls, StandardClass)


def _plan_or_error(cls):
    abstract = isinstance(cls, StructureClass) and not hasattr(cls, "lisp_structure")
    if isinstance(cls, BuiltInClass) or cls is object or _is_closed(cls) or metaclass_of(cls) is SystemClass or abstract:
        return error(SimpleError("Cannot allocate an instance of ~S.", cls))
    return plan_for(cls)


_NO_INSTANCES = frozenset({int, *FLOATS, complex, bool, str, list, type(None), Fraction, Symbol, Keyword, Cons, Character, LispString})
"""Classes of objects that have no slots, so that the functions here have no method for them."""


def default_initialize_instance(instance, *initargs):
    if instance.__class__ in _NO_INSTANCES:
        return no_method_for("INITIALIZE-INSTANCE", instance, *initargs)
    protocol_functions.shared_initialize(instance, True, *initargs)
    return instance


def default_shared_initialize(instance, slot_names, *initargs):
    if instance.__class__ in _NO_INSTANCES:
        return no_method_for("SHARED-INITIALIZE", instance, slot_names, *initargs)
    if slot_names is not None and slot_names is not True and not isinstance(slot_names, Cons):
        type_error(slot_names, "LIST")
    wanted = True if slot_names is True else set(python_list(slot_names))
    plan = plan_for(type(instance))
    parameters = plan.parameters
    for key in initargs[::2]:
        if not is_symbol(key):
            program_error("malformed initialization arguments: ~S is not a symbol.", key)
    plan.fill(instance, initargs, wanted)
    if wanted and plan.shared:
        for slot in plan.shared:
            if slot.cell.value is UNBOUND and (wanted is True or slot.name in wanted):
                slot.cell.value = one(slot.initfunction())
    if not parameters or isinstance(instance, SlotDefinition):
        return instance
    for index in range(0, len(initargs), 2):  # after the Python __init__, reinitialization sets its attributes too
        if initargs[index] in parameters:
            setattr(instance, parameters[initargs[index]], initargs[index + 1])
    return instance


def default_reinitialize_instance(instance, *initargs):
    if instance.__class__ in _NO_INSTANCES:
        return no_method_for("REINITIALIZE-INSTANCE", instance, *initargs)
    _check_initargs(type(instance), applicable_user_methods(protocol_functions.reinitialize_instance, type(instance)), initargs)
    protocol_functions.shared_initialize(instance, None, *initargs)
    return instance


def _check_initargs(cls, methods, initargs):
    """Signal an error for initargs that neither a slot of ``cls`` nor one of the ``methods`` takes."""
    plan = plan_for(cls)
    if len(initargs) % 2:
        program_error("odd number of &KEY arguments")
    if plan.valid is None or any(method.shape.allow_other_keys for method in methods):
        return
    keys = {key for method in methods for key in method.shape.keys}
    wrong = [key for key in initargs[::2] if key not in plan.valid and key not in keys]
    if wrong and not other_keys_allowed(initargs):
        error(InitargError(cls, list(reversed(wrong))))


def default_allocate_instance(cls, *initargs):
    if not isinstance(cls, type):
        return no_method_for("ALLOCATE-INSTANCE", cls, *initargs)
    plan = _plan_or_error(cls)
    plan.may_lack()
    return plan.allocate(initargs)


# --------------------------------------------------------------------------------------------------------------- change-class


def _has_slots(cls):
    """Whether instances of ``cls`` have slots that ``change-class`` can carry over; those of built-in classes have none."""
    return cls not in _NO_INSTANCES and (isinstance(cls, StandardClass) or hasattr(cls, "initargs") or hasattr(cls, "lisp_slots"))


def default_change_class(instance, new_class, *initargs):
    """Make ``instance`` an instance of ``new_class``, keeping the slots that both have (ANSI 7.2)."""
    cls = find_class_or_error(new_class)
    if not _has_slots(type(instance)) or not _has_slots(cls):
        return no_method_for("CHANGE-CLASS", instance, cls, *initargs)
    old = type(instance)
    if initargs:
        changing = applicable_user_methods(protocol_functions.update_instance_for_different_class, old, cls)
        _check_initargs(cls, changing, initargs)
    previous = copy.copy(instance)
    values = {
        slot.name: vars(instance).get(slot.attribute, UNBOUND) if slot.cell is None else slot.cell.value
        for slot in effective_slots(old).values()
    }
    for slot in effective_slots(old).values():
        vars(instance).pop(slot.attribute, None)
    try:
        instance.__class__ = cls
    except TypeError:
        vars(instance).update(vars(previous))
        return error(SimpleError("An instance of ~S cannot become one of ~S: Python stores them differently.", class_of(previous), cls))
    vars(instance).pop("lisp_version", None)
    version = vars(cls).get("lisp_version", 0)
    if version:
        vars(instance)["lisp_version"] = version
    for name, value in values.items():
        slot = find_slot(cls, name)
        if slot is not None and slot.cell is None and value is not UNBOUND:
            setattr(instance, slot.attribute, value)
    if issubclass(cls, StandardObject):
        may_be_unbound(cls, [slot for slot in effective_slots(cls).values() if slot.attribute not in vars(instance)])
    protocol_functions.update_instance_for_different_class(previous, instance, *initargs)
    return instance


def default_update_for_different_class(previous, current, *initargs):
    before = effective_slots(type(previous))
    added = [name for name in effective_slots(type(current)) if name not in before]
    protocol_functions.shared_initialize(current, list_from(added), *initargs)


def default_update_for_redefined_class(instance, added_slots, discarded_slots, property_list, *initargs):
    protocol_functions.shared_initialize(instance, added_slots, *initargs)
