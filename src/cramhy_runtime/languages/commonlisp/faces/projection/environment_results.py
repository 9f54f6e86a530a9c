"""The structure that ``with-projection-environment`` returns."""

from __future__ import annotations

from cramhy_runtime.projection.environments import RESULT
from cramhy_runtime.projection.symbols import PROJ
from ...objects.structures import define_structure, structure_slot
from ...printer.print_controls import PACKAGE


def define_result():
    """Define the structure that `with_projection_environment` returns; its functions are not exported, as in the original."""
    outer, PACKAGE.value = PACKAGE.value, PROJ
    try:
        define_structure(RESULT, [structure_slot(PROJ.intern(slot)) for slot in ("NAME", "RESULT", "ENVIRONMENT")])
    finally:
        PACKAGE.value = outer
