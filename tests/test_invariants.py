"""Every invariant that a reference page lists ("Invariants a test could check") has a test.

A test says which ones it holds: ``@pytest.mark.law("prolog", 3, 4)`` for invariants 3 and 4 of ``prolog.md``; without the name of
a page it is ``cpl.md``. The marks are read from the sources of all tests, so that a test that is skipped here counts, too.
"""

import ast
import functools
import re
from pathlib import Path

import pytest
from source_trees import tree_of

TESTS = Path(__file__).parent
REFERENCE = TESTS.parent / "docs" / "reference"

PAGES = {
    "cpl": 121,
    "prolog": 62,
    "designators": 52,
    "process-modules": 40,
    "projection-and-events": 27,
    "cl-transforms": 45,
    "turtlesim": 43,
    "roslisp": 50,
}
"""Page -> how many invariants it lists."""


@functools.cache
def marks():
    """Page -> number of an invariant -> the tests that claim it."""
    found = {}
    for path in sorted(TESTS.rglob("test_*.py")):
        text = path.read_text()
        for node in ast.walk(tree_of(path)) if "mark.law(" in text else ():
            if isinstance(node, ast.FunctionDef):
                for decorator in node.decorator_list:
                    if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "pytest.mark.law":
                        page, numbers = "cpl", [ast.literal_eval(argument) for argument in decorator.args]
                        if isinstance(numbers[0], str):
                            page, *numbers = numbers
                        for number in numbers:
                            found.setdefault(page, {}).setdefault(number, []).append(f"{path.relative_to(TESTS)}::{node.name}")
    return found


def invariants(page):
    """The numbers that the page lists."""
    text = (REFERENCE / f"{page}.md").read_text()
    section = re.search(r"^##? (?:\d+\. )?Invariants.*?(?=^##? |\Z)", text, re.M | re.S).group()
    return {int(number) for number in re.findall(r"^(\d+)\. ", section, re.M)}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("page", PAGES)
def test_every_invariant_has_a_test(page):
    numbers, claimed = invariants(page), marks().get(page, {}).keys()
    assert len(numbers) == PAGES[page]
    assert not numbers - claimed, f"without a test: {sorted(numbers - claimed)}"
    assert not claimed - numbers, f"no such invariant: {sorted(claimed - numbers)}"
