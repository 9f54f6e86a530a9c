"""The predicates about designators, and CRAM's own generators and validators of locations, which are there from the start."""

from __future__ import annotations

from cramhy_runtime.prolog.builtins.rete import object_id
from . import locations
from . import plain_printing as _printing  # noqa: F401  a language may print them better
from . import predicates as _predicates  # noqa: F401  Prolog knows them from here on
from .classes import Designator
from .symbols import sym

object_id.method(Designator)(lambda designator: designator.object_id)
locations.register_defaults()
for _name, _function in (
    ("LOCATION-PROLOG-GENERATOR", locations.location_prolog_generator),
    ("FILTER-SOLUTION", locations.filter_solution),
    ("LOCATION-PROLOG-VALIDATOR", locations.location_prolog_validator),
):
    sym(f"DESIG::{_name}").function = _function  # generators and validators are called by their names
