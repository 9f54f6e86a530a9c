"""``make-instance`` with a quoted class and named initargs: a function for such calls, which knows the slots of the class.

A `Maker` stands in compiled code for all calls with the same class and initargs. Its function is written when it is first called
(`utilities.generated_functions`). It is forgotten when a class or a method of the protocol changes, when ``make-instance`` gets a method
or is traced, and when another image comes. Where the protocol of ANSI 7.1 has more to do than to fill slots, `make_instance` itself is
called.
"""

from __future__ import annotations

from cramhy_runtime.ground.classes import find_class_or_error, when_classes_change
from cramhy_runtime.ground.condition_types import Condition
from cramhy_runtime.ground.data import Character, DoubleFloat, Keyword, one
from cramhy_runtime.ground.dispatch.keyword_checks import ALLOW_OTHER_KEYS
from cramhy_runtime.ground.packages import symbol_name, sym
from cramhy_runtime.kernel.images import part
from cramhy_runtime.utilities.generated_functions import generated_function
from .class_objects import StandardObject
from .instances import plan_for, when_plans_change

MAKE_INSTANCE = sym("MAKE-INSTANCE")
_CONSTANTS = frozenset({int, float, DoubleFloat, bool, type(None), str, Keyword, Character})
"""Classes of forms that are their own value."""


class Maker:
    """Calls of ``make-instance`` for the class ``name`` with the initargs ``keys``: ``make`` takes their values."""

    __slots__ = ("name", "keys", "make")

    def __init__(self, name, keys):
        self.name, self.keys = name, keys
        self.refresh()

    def refresh(self):
        """Forget the function that was written."""
        self.make = self._make

    def _make(self, *values):
        written = self._written()
        if written is None:
            return self._make_any(*values)
        self.make = written
        return written(*values)

    def _make_any(self, *values):
        return MAKE_INSTANCE.function(self.name, *[part for pair in zip(self.keys, values, strict=True) for part in pair])

    def _written(self):
        """The function, or ``None`` if there is more to do than to fill slots."""
        function = MAKE_INSTANCE.function
        if function.methods != function.own_methods or function.watcher is not None or len({*self.keys}) < len(self.keys):
            return None
        cls = find_class_or_error(self.name)
        if not issubclass(cls, StandardObject) or issubclass(cls, Condition):
            return None
        plan = plan_for(cls)
        if plan.custom or plan.python_init is not None or ALLOW_OTHER_KEYS in self.keys:
            return None
        if plan.valid is not None and not plan.valid.issuperset(self.keys):
            return None
        return _function(plan, self.keys)


def _function(plan, keys):
    scope = {"new": plan.cls.__new__, "cls": plan.cls, "one": one}
    parameters = [f"value{number}" for number in range(len(keys))]
    lines, initargs, given = [], list(zip(keys, parameters, strict=True)), set()
    for number, (key, thunk) in enumerate(plan.defaults.items()):
        if key not in keys:
            scope[f"default{number}"] = thunk
            lines.append(f"value_of_default{number} = one(default{number}())")
            initargs.append((key, f"value_of_default{number}"))
    lines.append("made = new(cls)")
    if plan.version:
        lines.append(f"made.lisp_version = {plan.version}")
    for number, (key, value) in enumerate(initargs):
        for slot in plan.targets.get(key, ()):
            if slot.name not in given:
                given.add(slot.name)
                if slot.cell is not None:
                    scope[f"cell{number}"] = slot.cell
                lines.append(f"made.{slot.attribute} = {value}" if slot.cell is None else f"cell{number}.value = {value}")
    for number, (slot, initfunction) in enumerate(plan.initforms):
        if slot.name not in given:
            if slot.initform.__class__ in _CONSTANTS:
                scope[f"initform{number}"] = slot.initform if slot.initform is not False else None
                lines.append(f"made.{slot.attribute} = initform{number}")
            else:
                scope[f"initform{number}"] = initfunction
                lines.append(f"made.{slot.attribute} = one(initform{number}())")
    name = symbol_name(plan.cls.lisp_symbol) if hasattr(plan.cls, "lisp_symbol") else plan.cls.__name__
    return generated_function(f"maker of {name}", "make", parameters, [*lines, "return made"], scope)


def maker(name, *keys):
    """The `Maker` for the class that the symbol ``name`` names and the keywords ``keys``, one for all calls."""
    if MAKE_INSTANCE.keyed is None:
        MAKE_INSTANCE.keyed = {}  # so it hears when the function changes
    found = MAKE_INSTANCE.keyed.get((name, keys))
    if found is None:
        found = MAKE_INSTANCE.keyed[name, keys] = Maker(name, keys)
    return found


@when_classes_change
@when_plans_change
def _forget():
    for each in (MAKE_INSTANCE.keyed or {}).values():
        each.refresh()


@part
class _OfImage:
    """What makers know is about the classes of the current image."""

    @staticmethod
    def take():
        return None

    @staticmethod
    def put(state):
        _forget()

    @staticmethod
    def copy(state):
        return None


__all__ = ["Maker", "maker"]
