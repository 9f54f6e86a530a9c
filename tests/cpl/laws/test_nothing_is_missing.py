"""Every trap of cpl.md section 17 has a test or a sentence (docs/explanation/traps.md); the invariants are held by tests/test_invariants.py."""

import re
from pathlib import Path


TESTS = Path(__file__).parents[2]
TRAPS = TESTS.parent / "docs" / "explanation" / "traps.md"
REFERENCE = TESTS.parent / "docs" / "reference" / "cpl.md"


def section(title):
    text = REFERENCE.read_text()
    return re.search(rf"^## {title}.*?(?=^## )", text, re.M | re.S).group()


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
