"""The class world: names of classes, ``find-class`` and ``class-of``.

Every Lisp class is a Python class. Those of ``defclass``, ``defstruct`` and ``define-condition`` are registered under their
symbols; the system classes are in ``builtin_classes.py``; classes of the runtime are found by their attribute ``lisp_name``.
A symbol's class is one object from the first definition on, also when it is defined again.

``make_instance`` is in ``instances.py``, ``define_class`` and ``define_condition`` are in ``class_definition.py``.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import part
from cramhy_runtime.lisp_core.condition_types import shown, shown_with
from cramhy_runtime.lisp_core.conditions import CellError, Condition, SimpleProgramError, SimpleTypeError, TypeError_, error, type_error
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.dispatch.generic_functions import FunctionObject, no_method_for
from cramhy_runtime.lisp_core.dispatch.methods import ConditionClass
from cramhy_runtime.lisp_core.packages import common, ensure_package, find_package, is_symbol, our_own, sym
from cramhy_runtime.lisp_core.plain_answers import registered as _classes
from .builtin_classes import CLASSES, STRUCTURES, BuiltInClass, lisp_mro, system_class
from .class_objects import StandardClass, StandardObject, touch_classes

LISP_NAMES = "find-class class-of class-name"


class ClassNotFoundError(CellError):
    """No class has the name that was given."""

    lisp_name = "SB-PCL::CLASS-NOT-FOUND-ERROR"
    initargs = {"NAME": "name"}
    undefined = "type"

    def report(self):
        return f"There is no class named {qualified(self.name)}."


def qualified(symbol):
    """The name of ``symbol`` with its package, always, as SBCL shows it in messages about classes."""
    return shown_with(symbol, "KEYWORD")


def register_class(symbol, cls):
    """Make ``cls`` the class that ``symbol`` names. Other symbols may name it too."""
    if isinstance(symbol, Symbol) and common(symbol) and "lisp_name" not in vars(cls) and cls.__module__ != "builtins":
        _keep_ours(symbol)
    old = _classes.get(symbol)
    _classes[symbol] = cls
    if isinstance(cls, type) and "lisp_symbol" not in vars(cls) and "lisp_name" not in vars(cls) and not cls.__module__ == "builtins":
        cls.lisp_symbol = symbol
    if old is not None and old is not cls:
        touch_classes()
    return cls


def alias_class(symbol, cls):
    """Let ``symbol`` name a class that has another name of its own, or is Python's."""
    _classes[symbol] = cls


def registered_class(symbol):
    """The class registered under ``symbol``, without looking for runtime classes; ``None`` if there is none."""
    return _classes.get(symbol)


def forget_class(symbol):
    """``(setf (find-class symbol) nil)``"""
    _keep_ours(symbol)
    if _classes.pop(symbol, None) is not None:
        touch_classes()


_ours: dict = {}  # symbols of our packages to which a program gave another class -> the one that they name by themselves


def _keep_ours(symbol):
    """A program is about to give ``symbol`` another class. Of a symbol that all images share, the others keep the old one."""
    if isinstance(symbol, Symbol) and symbol not in _ours and not our_own.depth and common(symbol):
        _ours[symbol] = symbol_class(symbol)


@part
class _ClassesOfOurSymbols:
    """Which classes users gave to the symbols that all images share."""

    @staticmethod
    def take():
        return {symbol: _classes.get(symbol) for symbol in _ours}

    @staticmethod
    def put(state):
        changed = False
        for symbol, own in _ours.items():
            cls = state.get(symbol, own)
            changed = changed or _classes.get(symbol) is not cls
            if cls is None:
                _classes.pop(symbol, None)
            else:
                _classes[symbol] = cls
        if changed:
            touch_classes()

    @staticmethod
    def copy(state):
        return dict(state)

    @staticmethod
    def new(state):
        return {}


def defined_class(symbol):
    """The class of that name that a program has defined or asked for, or ``None``. Nothing is looked for."""
    return _classes.get(symbol)


def symbol_class(symbol):
    """The class that ``symbol`` names, or ``None``."""
    found = _classes.get(symbol)
    if found is not None:
        return found
    if symbol is None or symbol is False:
        return None
    found = system_class(symbol)
    if found is None and isinstance(symbol, Symbol):
        found = _runtime_class(symbol)
    if found is not None:
        _classes[symbol] = found
    return found


def _runtime_class(symbol):
    # Rooms need not register their classes: a name that is not known yet is looked for among Python's classes.
    if symbol.package is None:
        return None
    names = {f"{name}::{symbol.name}" for name in symbol.package.names}
    if symbol.package.name == "COMMON-LISP":
        names.add(symbol.name)
    return _search(object, names, set())


def _search(root, names, seen):
    for cls in type.__subclasses__(root):
        if id(cls) in seen:  # a class may compare itself as it likes
            continue
        seen.add(id(cls))
        own = vars(cls).get("lisp_name")
        if own in names:
            return cls
        found = _search(cls, names, seen)
        if found is not None:
            return found
    return None


class IllegalClassName(TypeError_):
    """A class was looked for by what is not a symbol."""

    lisp_name = "SB-PCL::ILLEGAL-CLASS-NAME-ERROR"

    def __init__(self, datum=None, **slots):
        super().__init__(datum, sym("SYMBOL"), **slots)

    def report(self):
        return f"{shown(self.datum)} is not a legal class name."


def find_class(symbol, errorp=True, environment=None):
    """``cl:find-class``: the class that ``symbol`` names; else nil or, with ``errorp``, an error."""
    found = symbol_class(symbol) if is_symbol(symbol) or symbol is False else error(IllegalClassName(symbol))
    if found is None and errorp is not None and errorp is not False:
        return class_not_found(symbol)
    return found


def class_not_found(symbol):
    return error(ClassNotFoundError(symbol))


def find_class_or_error(designator):
    """The class that a symbol names, or the class itself."""
    if isinstance(designator, type):
        return designator
    return find_class(designator)


def set_find_class(new, symbol, errorp=True, environment=None):
    """``(setf find-class)``"""
    if not is_symbol(symbol):
        return error(IllegalClassName(symbol))
    if new is None:
        forget_class(symbol)
    elif not isinstance(new, type):
        return type_error(new, sym("CLASS"))
    else:
        register_class(symbol, new)
    return new


SETTERS = {"FIND-CLASS": set_find_class}
"""Setter functions by the Lisp name of the place: called with the new value and the arguments of the place."""


def class_of(object_):
    """``cl:class-of``: the class of which ``object_`` is an instance."""
    cls = type(object_)
    if cls is bool and object_ is False:
        return CLASSES["NULL"]
    if cls is int:
        return CLASSES["FIXNUM" if -(2**62) <= object_ < 2**62 else "BIGNUM"]
    if isinstance(object_, type):
        return metaclass_of(object_)
    for candidate in lisp_mro(cls):
        if isinstance(candidate, BuiltInClass):
            return CLASSES["FUNCTION"] if candidate is CLASSES["COMPILED-FUNCTION"] else candidate  # the former is a mere type
        if candidate is not object and has_own_name(candidate):
            return CLASSES.get(vars(candidate).get("lisp_name"), candidate)  # a class of the runtime may stand for one of the system's
    return object


def has_own_name(cls):
    """Whether Lisp has a name for the class ``cls`` itself, which a plain class of Python has not."""
    return "lisp_symbol" in vars(cls) or "lisp_name" in vars(cls)


def class_name(cls):
    """``cl:class-name``: the Symbol that names ``cls``; for a Python class without a Lisp name that of its nearest superclass."""
    if cls is object:
        return True
    if cls is type:
        return sym("CLASS")
    if not isinstance(cls, type):
        return no_method_for("CLASS-NAME", cls)
    for base in lisp_mro(cls):
        own = vars(base)
        if "lisp_symbol" in own:
            return own["lisp_symbol"]
        if "lisp_name" in own:
            return named(own["lisp_name"])
        if base is object:
            break
    return True


def named(lisp_name):
    """The symbol for a ``lisp_name`` attribute. SBCL's own packages are made when a class is first named by one of their symbols."""
    package, _, name = lisp_name.rpartition("::")
    if package.startswith("SB-"):
        home = ensure_package(package)
        symbol = home.intern(name)
        if package in _EXPORTING or name in ("CLASS-NOT-FOUND-ERROR", "SYSTEM-CLASS"):
            home.export(symbol)
        return symbol
    if package and find_package(package) is None:
        return _uninterned.setdefault(lisp_name, Symbol(name))
    return sym(lisp_name)


_uninterned: dict = {}
_EXPORTING = ("SB-EXT", "SB-INT", "SB-KERNEL", "SB-SYS", "SB-MOP")  # all class names in these are external symbols


# ------------------------------------------------------------------------------------------------------------ kinds of classes


class StructureClass(type):
    """The metaclass of classes made by ``defstruct``. Python code makes instances with keywords: ``TurtleMotion(speed=5)``."""

    lisp_name = "STRUCTURE-CLASS"
    names = STRUCTURES

    def __call__(cls, *initargs, **keywords):
        return cls.lisp_structure.construct(*initargs, **keywords)


class SystemClass(type):
    """The metaclass that SBCL shows for the system classes users may add to."""

    lisp_name = "SB-PCL::SYSTEM-CLASS"
    names = ("T", "FUNCTION", "SEQUENCE", "STREAM")


class FuncallableStandardClass(type):
    """The metaclass of classes whose instances are generic functions."""

    lisp_name = "SB-MOP::FUNCALLABLE-STANDARD-CLASS"


class ForwardReferencedClass(StandardClass):
    """A class that was named as a superclass and is not defined yet."""

    lisp_name = "SB-MOP::FORWARD-REFERENCED-CLASS"


def metaclass_of(cls):
    """The class of the class ``cls``."""
    if vars(cls).get("lisp_forward_reference"):
        return ForwardReferencedClass
    if isinstance(cls, BuiltInClass) or cls is object:
        name = "T" if cls is object else vars(cls)["lisp_name"]
        return SystemClass if name in SystemClass.names else StructureClass if name in StructureClass.names else BuiltInClass
    if cls is type:
        return StandardClass
    if "lisp_direct_slots" in vars(type(cls)):  # a user's metaclass
        return type(cls)
    if issubclass(cls, Condition):
        return ConditionClass
    if isinstance(cls, StructureClass):
        return StructureClass
    if CLASSES["STREAM"] in lisp_mro(cls) and not issubclass(cls, StandardObject):
        return SystemClass
    if issubclass(cls, FunctionObject):
        return FuncallableStandardClass
    metaclass = vars(cls).get("lisp_metaclass")
    if metaclass is not None:
        return metaclass
    return StandardClass if issubclass(cls, StandardObject) or has_own_name(cls) else type(cls)


def set_class_name(new, cls):
    """``(setf class-name)``"""
    if not isinstance(cls, type):
        return no_method_for("CLASS-NAME", cls)
    if not is_symbol(new):
        return type_error(new, sym("SYMBOL"))
    if isinstance(cls, BuiltInClass):
        return error(
            SimpleTypeError("The name of the built-in class ~S cannot be changed.", cls, datum=cls, expected_type=sym("STANDARD-CLASS"))
        )
    cls.lisp_symbol = new
    return new


SETTERS["CLASS-NAME"] = set_class_name


def invalid_class_definition(text, *arguments):
    return error(SimpleProgramError(text, *arguments))


register_class(sym("CLASS"), type)
