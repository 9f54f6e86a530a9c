"""The recorded answers of the original that this version must give."""

from __future__ import annotations

import pytest

from .score import score

MUST_PASS = ["01_ros_and_turtle", "02_messages", "03b_no_node", "13_plan_language"]


@pytest.mark.parametrize("name", MUST_PASS)
def test_every_answer_is_that_of_the_original(shared, name):
    output = score([shared / "golden" / f"{name}.jsonl"], show=5)
    passed, _, total = output.strip().splitlines()[-1].removeprefix("passed ").partition(" of ")
    assert passed == total, output
