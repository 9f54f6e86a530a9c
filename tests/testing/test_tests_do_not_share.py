"""What a test defines is gone in the next one, under pytest as users run it."""

from __future__ import annotations

import subprocess
import sys

import pytest

TESTS = """
from cramhy_runtime.designators import DesignatorError, Motion, motion_grounding, reference
from cramhy_runtime.prolog import P, V, fact_group, findall, kw


def test_one():
    with fact_group("kitchen") as kitchen:
        kitchen.fact(P.stands("cup", "table"))

    class Driving(Motion):
        speed: float

    @motion_grounding(Driving)
    def command(motion):
        return ["drive", motion.speed]

    assert reference(Driving(speed=1.0)) == ["drive", 1.0]
    assert findall(V.x, P.stands(V.x, "table")) == ["cup"]


def test_two():
    with fact_group("second") as second:
        second.fact(P.stands("plate", "table"))
    assert findall(V.x, P.stands(V.x, "table")) == ["plate"]
    with pytest.raises(DesignatorError):
        reference(Motion(type=kw.driving, speed=2.0))


def test_three():
    import rules_of_ours


def test_four():
    import rules_of_ours

    assert findall(V.x, P.hangs(V.x, "wall")) == ["pan"]
"""
RULES = """
from cramhy_runtime.prolog import P, fact_group

with fact_group("wall") as wall:
    wall.fact(P.hangs("pan", "wall"))
"""


@pytest.mark.soak
def test_facts_of_a_test_go_with_it_and_those_of_a_module_stay(tmp_path):
    (tmp_path / "test_facts.py").write_text(TESTS)
    (tmp_path / "rules_of_ours.py").write_text(RULES)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "test_facts.py"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert "4 passed" in done.stdout, done.stdout
