"""The recorded answers of the original that this version must give."""

from __future__ import annotations

import pytest

from . import score as scores
from .score import ROOT, score

MUST_PASS = [
    "01_ros_and_turtle",
    "02_messages",
    "03_ros_errors",
    "03b_no_node",
    "05_motion_designators",
    "10_prolog",
    "11_printing",
    "13_plan_language",
]


@pytest.mark.soak
@pytest.mark.parametrize("name", MUST_PASS)
def test_every_answer_is_that_of_the_original(shared, name):
    output = score([shared / "golden" / f"{name}.jsonl"], show=5)
    passed, _, total = output.strip().splitlines()[-1].removeprefix("passed ").partition(" of ")
    assert passed == total, output


@pytest.mark.soak
def test_the_page_shows_the_score(shared):
    page = (ROOT / "docs" / "explanation" / "how-near.md").read_text()
    for line in score(sorted((shared / "golden").glob("*.jsonl"))).splitlines():
        assert line in page


def test_without_the_recorded_answers_make_golden_says_so(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(scores, "SHARED", tmp_path)
    assert scores.main([]) == 1
    said = capsys.readouterr()
    assert said.out == "" and said.err == scores.MISSING + "\n"
    assert "the recorded answers of the original are not here" in said.err
