"""Functions that make objects, written for one structure type, or for one class and its initargs: they know the slots.

A general constructor sorts the keywords of each call and walks over the slots. The functions here are Python text in which each slot
is an assignment (`utilities.generated_functions`).
"""

from __future__ import annotations

from functools import cache
from itertools import count

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.data import FLOATS, UNSUPPLIED, Character, Keyword, one, python_list
from cramhy_runtime.lisp_core.dispatch.keyword_checks import ALLOW_OTHER_KEYS
from cramhy_runtime.lisp_core.keyword_calls import GIVEN, name_of_key
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.utilities.generated_functions import generated_function

_CONSTANTS = frozenset({int, *FLOATS, bool, type(None), str, Keyword, Character})
"""Classes of forms that are their own value."""


def keyword_constructor(structure):
    """The constructor of a `Structure` with a keyword for each slot, for Lisp and for Python."""

    def construct(*initargs, **keywords):
        return structure.construct(*initargs, **keywords)

    names = [name_of_key(slot.keyword) for slot in structure.slots]
    if structure.cls is not None and None not in names and len({*names}) == len(names):
        construct.python_keys = frozenset(names)
        construct.written = cache(lambda: _written_constructor(structure, names))
    return construct


def _written_constructor(structure, names):
    """The same as a function that has the slots' ``names`` as keywords; written only if somebody calls it with them."""
    scope = {"Lnew": object.__new__, "Lclass": structure.cls, "Lone": one, "Lunsupplied": UNSUPPLIED}
    scope |= {"Lconstruct": structure.construct, "Lwrong_type": structure.wrong_type}  # names that no slot has
    parameters, sorting, filling = [f"*{GIVEN}"], [], []
    for number, (name, (_, key, initform, is_right, slot)) in enumerate(zip(names, structure.recipe, strict=True)):
        scope |= {f"Lkey{number}": key, f"Linitform{number}": initform, f"Lis_right{number}": is_right, f"Lslot{number}": slot}
        sorting.append(f"    if {name} is not Lunsupplied: {GIVEN} += (Lkey{number}, {name})")
        parameters.append(f"{name}={'None' if initform is is_right is None else 'Lunsupplied'}")
        if initform is not None or is_right is not None:
            filling.append(f"if {name} is Lunsupplied: {name} = {'None' if initform is None else f'Lone(Linitform{number}())'}")
        if is_right is not None:
            filling.append(f"if not Lis_right{number}({name}): Lwrong_type(Lslot{number}, {name})")
        filling.append(f"Lobject.{slot.attribute} = {name}")
    body = [f"if {GIVEN} or Lothers:", *sorting, f"    return Lconstruct(*{GIVEN}, **Lothers)", "Lobject = Lnew(Lclass)", *filling]
    body.append("return Lobject")
    return generated_function(f"constructor of {structure.name.name}", "construct", [*parameters, "**Lothers"], body, scope)


WORTH_WRITING = 20
"""After so many calls a function of its own is written for a structure: most structures of a program have few instances."""


def maker_of_values(structure, order, empty):
    """The function that makes an instance of a `Structure` from a Lisp list of values, for a constructor by position.

    order: for each slot the position of its value in the list, or ``None``: then the slot has its default. empty: the names of slots
    that were left out, and so may have a value of another type.
    """
    calls, written = count(1), None

    def make(values):
        nonlocal written
        if written is not None:
            return written(values)
        if structure.cls is not None and next(calls) == WORTH_WRITING:
            written = _written_maker(structure, order, empty)
        values = python_list(values)
        found = [values[index] if index is not None else slot.default() for slot, index in zip(structure.slots, order, strict=True)]
        return structure.make(found, empty)

    return make


def _written_maker(structure, order, empty):
    scope = {"new": object.__new__, "cls": structure.cls, "one": one, "wrong_type": structure.wrong_type}
    lines, checks, filling = [], [], []
    for number in range(max((index + 1 for index in order if index is not None), default=0)):
        lines.append(f"value{number} = values.car; values = values.cdr")
    for number, (index, slot) in enumerate(zip(order, structure.slots, strict=True)):
        value = f"default{number}" if index is None else f"value{index}"
        if index is None:
            scope[f"initform{number}"] = slot.initform
            lines.append(f"{value} = {'None' if slot.initform is None else f'one(initform{number}())'}")
        if slot.predicate is not None and symbol_name(slot.name) not in empty:
            scope |= {f"is_right{number}": slot.predicate, f"slot{number}": slot}
            checks.append(f"if not is_right{number}({value}): wrong_type(slot{number}, {value})")
        filling.append(f"made.{slot.attribute} = {value}")
    body = [*lines, *checks, "made = new(cls)", *filling, "return made"]
    return generated_function(f"constructor of {structure.name.name}", "make", ["values"], body, scope)


def instance_constructor(plan, keys):
    """The function that takes the values of the initargs ``keys`` and makes an instance by the `Plan` of its class; ``None`` if there is
    more to do, or something wrong."""
    known = {*keys, *plan.defaults}
    if plan.valid is not None and not plan.valid.issuperset(known) or ALLOW_OTHER_KEYS in known or len({*keys}) < len(keys):
        return None
    if plan.afters is None or plan.python_init not in (None, Condition.__init__) or plan.parameters:
        return None
    scope = {"new": plan.cls.__new__, "cls": plan.cls, "one": one}
    parameters = [f"value{number}" for number in range(len(keys))]
    lines, initargs, given = [], list(zip(keys, parameters, strict=True)), set()
    for number, (key, thunk) in enumerate(plan.defaults.items()):
        if key not in keys:
            scope[f"default{number}"] = thunk
            lines.append(f"value_of_default{number} = one(default{number}())")
            initargs.append((key, f"value_of_default{number}"))
    lines.append("made = new(cls)")
    if plan.python_init is not None:
        lines.append("made.args = ()")
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
            constant = slot.initform.__class__ in _CONSTANTS
            scope[f"initform{number}"] = (None if slot.initform is False else slot.initform) if constant else initfunction
            lines.append(f"made.{slot.attribute} = " + (f"initform{number}" if constant else f"one(initform{number}())"))
    plan.may_lack([slot for name, slot in plan.without_initform.items() if name not in given])
    given = "".join(f", key{number}, {value}" for number, (_, value) in enumerate(initargs))
    scope |= {f"key{number}": key for number, (key, _) in enumerate(initargs)}
    for number, method in enumerate(plan.afters):
        scope[f"after{number}"] = method
        lines.append(f"after{number}(made{given})")
    name = symbol_name(plan.cls.lisp_symbol) if hasattr(plan.cls, "lisp_symbol") else plan.cls.__name__
    return generated_function(f"constructor of {name}", "make", parameters, [*lines, "return made"], scope)
