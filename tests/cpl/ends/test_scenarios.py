"""A request to end comes again until its block is left, cleanup is run whole, and no block is left in a wrong order unnoticed."""

from __future__ import annotations

import importlib

import hy  # noqa: F401  teaches Python to import the plans in Hy
import pytest
from systems import BACKENDS

from cramhy_runtime import cpl, kernel
from cramhy_runtime.kernel.clocks import make_clock

from . import closed_scenarios  # noqa: F401  they join SCENARIOS
from .scenarios import SCENARIOS

IN_PYTHON = list(SCENARIOS)
HY = importlib.import_module(".scenarios_in_hy", __package__)
IN_HY = [name for name in SCENARIOS if hasattr(HY, name)]


@pytest.fixture(autouse=True)
def fresh_kernel(request):
    """No kernel is active: each plan brings its own."""
    kernel.stop()
    yield
    assert kernel.active() is None


def noted(plan, backend, time_limit):
    """What ``plan`` notes, and the first words of the error that ends it, each with the time."""
    entries: list[str] = []
    clock = make_clock("virtual")

    def main():
        plan(lambda what: entries.append(f"{what} {cpl.now():g}"))
        return "the end"

    try:
        if cpl.run(main, clock=clock, backend=backend, time_limit=time_limit or 1000) != "the end":
            entries.append(f"ended without a word {clock.now():g}")
    except BaseException as problem:
        entries.append(f"{problem} {clock.now():g}")
    return entries


def agree(seen, expected):
    """Whether the same was noted; of a text of an error the beginning counts, and the time."""
    return len(seen) == len(expected) and all(
        one.startswith(other.rpartition(" ")[0]) and one.rpartition(" ")[2] == other.rpartition(" ")[2]
        for one, other in zip(seen, expected, strict=True)
    )


@pytest.mark.soak(all_but=16)
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("name", IN_PYTHON)
def test_a_plan_in_python(name, backend):
    plan, expected, time_limit = SCENARIOS[name]
    seen = noted(plan, backend, time_limit)
    assert agree(seen, expected), seen


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("name", IN_HY)
def test_the_same_plan_in_hy(name, backend):
    _, expected, time_limit = SCENARIOS[name]
    seen = noted(getattr(HY, name), backend, time_limit)
    assert agree(seen, expected), seen
