"""Every invariant of cpl.md section 16 has a test, and every trap of section 17 a test or a sentence (docs/traps.md).

A test says which invariants it holds by ``@pytest.mark.law(40, 41)``; the marks are read from the sources of all tests.
"""

import ast
import re
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[2]
TRAPS = TESTS.parent / "docs" / "traps.md"
REFERENCE = TESTS.parents[1] / "shared" / "reference" / "cpl.md"


def marks():
    """Number of an invariant -> the tests that claim it."""
    found = {}
    for path in sorted(TESTS.rglob("test_*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.FunctionDef):
                for decorator in node.decorator_list:
                    if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "pytest.mark.law":
                        for number in decorator.args:
                            found.setdefault(ast.literal_eval(number), []).append(f"{path.relative_to(TESTS.parent)}::{node.name}")
    return found


def section(title):
    if not REFERENCE.exists():
        pytest.skip("the reference pages are not laid beside the project")
    text = REFERENCE.read_text()
    return re.search(rf"^## {title}.*?(?=^## )", text, re.M | re.S).group()


def test_every_invariant_has_a_test():
    numbers = {int(number) for number in re.findall(r"^(\d+)\. ", section(r"16\."), re.M)}
    assert len(numbers) == 121
    claimed = marks()
    assert not numbers - claimed.keys(), f"without a test: {sorted(numbers - claimed.keys())}"
    assert not claimed.keys() - numbers, f"no such invariant: {sorted(claimed.keys() - numbers)}"


def traps():
    return re.findall(r"^(\d+)\. \*\*(.+?)\*\*\s+(.+?)(?=^\d+\. |\Z)", TRAPS.read_text(), re.M | re.S)


def test_every_trap_has_an_answer():
    known = [int(number) for number, _, _ in traps()]
    assert known == [int(number) for number in re.findall(r"^(\d+)\. ", section(r"17\."), re.M)]
    assert not [number for number, _, answer in traps() if "(open)" in answer]


def test_the_tests_that_answer_traps_exist():
    for number, _, answer in traps():
        for path, name in re.findall(r"(tests/[\w/]+\.py)::(\w+)", answer):
            assert re.search(rf"^def {name}\(", (TESTS.parent / path).read_text(), re.M), f"trap {number}: {path}::{name}"
