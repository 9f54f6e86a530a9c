"""Functions that make objects, written for one structure type: they know its slots.

A general constructor sorts the keywords of each call and walks over the slots. The functions here are Python text in which each slot
is a parameter and an assignment (`utilities.generated_functions`).
"""

from __future__ import annotations

from cramhy_runtime.ground.data import UNSUPPLIED, one
from cramhy_runtime.ground.keyword_calls import GIVEN, name_of_key
from cramhy_runtime.utilities.generated_functions import generated_function


def keyword_constructor(structure):
    """The constructor of a `Structure` with a keyword for each slot, for Lisp and for Python."""
    names = [name_of_key(slot.keyword) for slot in structure.slots]
    if structure.cls is None or None in names or len({*names}) < len(names):

        def construct(*initargs, **keywords):
            return structure.construct(*initargs, **keywords)

        return construct
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
