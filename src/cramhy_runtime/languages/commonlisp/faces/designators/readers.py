"""Reader functions of designators, under the Lisp names of their slots.

They are generic in the original. Here they are plain functions until somebody defines a method on one
(``lisp_core/dispatch/open_functions.py``): a class of one's own with ``:reader cut:timestamp``, say.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import UnboundSlot
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import UNBOUND
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from cramhy_runtime.lisp_core.hash_tables import HashTable, need_table
from cramhy_runtime.designators.classes import Designator, DesignatorError, ObjectDesignatorData, keep_living, living
from cramhy_runtime.designators.symbols import sym


def _reader(name, cls, attribute, documentation):
    """The reader function of the Lisp name ``name`` for the attribute of instances of ``cls``."""
    printed = name if "::" in name else f"CRAM-DESIGNATORS:{name.upper()}"

    def read(thing):
        if not isinstance(thing, cls):
            return no_applicable_method(printed.replace("::", ":"), 1, thing)
        value = getattr(thing, attribute)
        return value if value is not UNBOUND else error(UnboundSlot(sym(f"DESIG::{name.upper()}"), thing))

    read.__name__ = read.__qualname__ = attribute
    read.__doc__ = documentation
    return read


description = _reader("description", Designator, "description", "The whole description, a list of ``(key value)``.")
properties = _reader("properties", Designator, "description", "The whole description, a list of ``(key value)``.")
parent = _reader("parent", Designator, "parent", "The designator before it in its chain; nil for the oldest.")
successor = _reader("successor", Designator, "successor", "The designator after it in its chain; nil for the youngest.")
effective = _reader("effective", Designator, "effective", "True after it was resolved, or made by make-effective-designator.")
quantifier = _reader("quantifier", Designator, "quantifier", "``:a`` or ``:all``.")
timestamp = _reader("CRAM-UTILITIES::TIMESTAMP", Designator, "timestamp", "Seconds at which it was first resolved; nil before.")
object_pose = _reader("object-pose", ObjectDesignatorData, "pose", "The pose that perception found.")
object_color = _reader("object-color", ObjectDesignatorData, "color", "The colour that perception found.")
object_identifier = _reader("object-identifier", ObjectDesignatorData, "object_identifier", "The name that perception gave.")
designator = _reader("designator", DesignatorError, "designator", "The designator of a ``designator-error``.")


def table_of_designators():
    """``desig::*designators*``: a new table with each living designator as a key, which it does not keep alive."""
    table = HashTable("EQ", weakness="KEY")
    for one in living():
        table.put(one, True)
    return table


def forget_designators(table):
    """``(setf desig::*designators* table)``: from now on those count that are keys of ``table``, and those that are made later."""
    if not isinstance(table, HashTable):
        need_table(table)
    keep_living(table.keys())


def open_readers():
    """Let users define methods on the readers, when their symbols have them."""
    for name, function, cls in (
        ("DESCRIPTION", description, Designator),
        ("PROPERTIES", properties, Designator),
        ("PARENT", parent, Designator),
        ("SUCCESSOR", successor, Designator),
        ("EFFECTIVE", effective, Designator),
        ("QUANTIFIER", quantifier, Designator),
        ("OBJECT-POSE", object_pose, ObjectDesignatorData),
        ("OBJECT-COLOR", object_color, ObjectDesignatorData),
        ("OBJECT-IDENTIFIER", object_identifier, ObjectDesignatorData),
        ("DESIGNATOR", designator, DesignatorError),
    ):
        open_to_methods(function, f"DESIG::{name}", f"({cls.__name__.lower()})", cls)
    open_to_methods(timestamp, "CUT::TIMESTAMP", "(designator)", Designator)
