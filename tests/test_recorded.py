"""The recorded answers of other programs are what these programs answer: a few files are made again where the program is installed."""

from __future__ import annotations

import pytest
import recorded

SAMPLE = [
    "lisp/sbcl/odds.txt",
    "lisp/sbcl/lists.txt",
    "lisp/symbols/structures.txt",
    "lisp/printing/code.jsonl",
    "libraries/alexandria.txt",
]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("recording", [each for each in recorded.RECORDINGS if each.name in SAMPLE], ids=lambda each: each.name)
def test_a_recording_made_again_is_the_same(recording):
    if recording.lacking is not None:
        pytest.skip(f"{recording.lacking} is not installed")
    assert recorded.answers(recording.made()) == recorded.answers(recording.path.read_text())


@pytest.mark.soak
@pytest.mark.parametrize("recording", recorded.RECORDINGS, ids=lambda each: each.name)
def test_each_recording_made_again_is_the_same(recording):
    test_a_recording_made_again_is_the_same(recording)


def test_a_changed_answer_is_seen_and_an_address_is_not():
    assert recorded.answers("(f)\n=> #<A {1001B4E973}>\n") == recorded.answers("; new\n(f)\n=> #<A {10019A0AA3}>\n")
    assert recorded.answers("(f)\n=> 1\n") != recorded.answers("(f)\n=> 2\n")


def test_each_file_of_answers_says_how_it_is_made():
    known = {recording.path for recording in recorded.RECORDINGS}
    folders = [recorded.TESTS / "lisp" / name for name in ("sbcl", "symbols", "printing")]
    files = {path for folder in folders for path in folder.iterdir() if path.suffix in (".txt", ".jsonl")}
    assert {path.name for path in files - known} == {"names.jsonl", "sequences_at_random.txt", "warnings.txt"}, "enter it into recorded.py"
    assert all(recording.path.exists() for recording in recorded.RECORDINGS)
