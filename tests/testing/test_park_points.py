"""Park points are named by the functions that wait: each of these must be where the table says."""

from __future__ import annotations

import importlib
import inspect

import pytest

from cramhy_runtime.testing import park_points


@pytest.mark.parametrize("entry", [*park_points.NAMES, park_points.ORDER])
def test_the_function_of_a_park_point_is_there(entry):
    path, name = entry.split(":")
    found = importlib.import_module(f"cramhy_runtime.{path.removesuffix('.py').replace('/', '.')}")
    for part in name.split("."):
        found = getattr(found, part)
    assert park_points._of(inspect.unwrap(found).__code__) == entry
