"""Every operator of the plan language and of its neighbours, once: `declaration` says what a row of these tables means."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.kernel.typing_names import Any

from .acting import DESIGNATORS, EPISODES, PROCESS_MODULES, PROJECTION
from .declaration import BRANCHES, IN_PLACE, Operator, Table
from .plan_language import PLAN_LANGUAGE
from .reasoning import PROLOG, UTILITIES
from .ros import ACTIONLIB, FRAMES, ROSLISP

TABLES = (PLAN_LANGUAGE, PROLOG, UTILITIES, DESIGNATORS, PROCESS_MODULES, PROJECTION, EPISODES, ROSLISP, ACTIONLIB, FRAMES)

OPERATORS = {(operator.package, operator.name): operator for table in TABLES for operator in table.values()}
"""(name of the home package, name) → operator."""


def operator_of(symbol: Any) -> Operator | None:
    """The operator that ``symbol`` names, or ``None``; ``None`` also for NIL, T and symbols of no package."""
    if not isinstance(symbol, Symbol) or symbol.package is None:
        return None
    return OPERATORS.get((symbol.package.name, symbol.name))


__all__ = [
    "ACTIONLIB",
    "BRANCHES",
    "DESIGNATORS",
    "EPISODES",
    "FRAMES",
    "IN_PLACE",
    "OPERATORS",
    "Operator",
    "PLAN_LANGUAGE",
    "PROCESS_MODULES",
    "PROJECTION",
    "PROLOG",
    "ROSLISP",
    "TABLES",
    "Table",
    "UTILITIES",
    "operator_of",
]
