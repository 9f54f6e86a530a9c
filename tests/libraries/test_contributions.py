"""What is contributed to SBCL: each form of ``contributions.txt`` has the values that SBCL gives. ``make recorded`` asks it again."""

from pathlib import Path

import pytest
from systems import posix

from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.conditions import Condition

LINES = [line for line in (Path(__file__).parent / "contributions.txt").read_text().splitlines() if not line.startswith("; ")]


@pytest.mark.soak
@posix
def test_forms_have_the_values_of_sbcl(values):
    """One after the other, since tests of SB-RT are defined by some and run by others."""
    different = []
    for form, answer in zip(LINES[::2], LINES[1::2], strict=True):
        try:
            told = f"=> {values(form, ' ; ')}"
        except Condition as problem:
            told = f"!! {class_name(type(problem)).name} {problem}"
        if " ".join(told.split()) != " ".join(answer.split()):
            different.append((form, answer, told))
    assert not different, "\n".join(map(repr, different))
