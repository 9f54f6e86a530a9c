"""What a process of a submission tells is looked at before it is believed: a malformed message costs its sender, and ends nothing."""

from __future__ import annotations

import json
import math
import random

import pytest

from cramhy_runtime.grading import Grader, schema
from cramhy_runtime.grading.exercise import find
from cramhy_runtime.grading.grader import LARGEST
from cramhy_runtime.grading.schema import Malformed, read
from cramhy_runtime.grading.told import Told

GOOD = {
    "held": {"locks": ["time"]},
    "stage": {"doing": "do", "what": "(go)"},
    "error": {"types": ["WALL-AHEAD"], "text": "at a wall"},
    "value": {"values": ["1", "2"]},
    "answer": {"values": []},
    "took": {"seconds": 1.5},
    "faults": {"happened": [True]},
    "heard": {"entries": [[5, "command", "turtle1", 1.0, 0, math.nan], [6, "kill", "turtle1"], [6, "set_pen", "turtle1", 1, 2, 3, 4, 0]]},
    "run": {"ticks": 100, "begin": 3, "end": 50},
    "used": {"what": "node", "name": "/n"},
    "tests": {"results": [{"name": "t", "passed": True, "text": ""}]},
    "tampered": {"text": "changed"},
    "done": {},
}
"""A message of each kind."""


def text(kind, facts):
    return json.dumps({"kind": kind, **facts})


@pytest.mark.parametrize("kind", GOOD)
def test_a_message_of_each_kind_is_read(kind):
    assert set(GOOD) == set(schema.SCHEMA)
    got, facts = read(text(kind, GOOD[kind]))
    assert got == kind and str(facts) == str(GOOD[kind])


ODD = [None, True, 5, -1, 10**12, 10**400, 1.5, math.nan, math.inf, "x", "y" * 30_000, [], [1], [[]], [None] * 100_000, {}, {"a": 1}, [{}]]
"""Values that stand where something else belongs."""


def fits(kind, name, value):
    return schema.SCHEMA[kind][name](value)


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, facts in GOOD.items() for name in facts])
def test_an_odd_value_in_any_place_is_malformed_and_not_an_error(kind, name):
    refused = 0
    for value in ODD:
        line = text(kind, {**GOOD[kind], name: value})
        if len(line) > schema.MOST_LINE or not fits(kind, name, value):
            refused += 1
            with pytest.raises(Malformed):
                read(line)
    assert refused >= len(ODD) - 4


@pytest.mark.parametrize("kind", GOOD)
def test_a_message_has_all_of_its_entries_and_no_others(kind):
    for facts in ({**GOOD[kind], "more": 1}, *({key: GOOD[kind][key] for key in GOOD[kind] if key != name} for name in GOOD[kind])):
        with pytest.raises(Malformed, match="other entries"):
            read(text(kind, facts))


@pytest.mark.parametrize(
    "line",
    ["", "nonsense", "[]", "{}", "5", "null", '"x"', '{"kind": 5}', '{"kind": []}', '{"kind": "fly"}', "[" * 100_000, "9" * 5000,
     '{"kind": "heard", "entries": [' + "[]," * 100_000 + "[]]}"],
)  # fmt: skip
def test_what_is_no_message_is_malformed(line):
    with pytest.raises(Malformed):
        read(line)


@pytest.mark.parametrize(
    "entry",
    [
        [5, "command", "turtle1", 1.0, 0.0],
        [5, "fly", "turtle1", 1.0],
        [5, "command", "turtle1", "far", 0.0, 0.0],
        [5, "command", 1, 0.0, 0.0, 0.0],
        [5, "command", "t" * 1000, 0.0, 0.0, 0.0],
        [5, "command", "turtle1", 10**400, 0.0, 0.0],
        [5, "command", "turtle1", True, 0.0, 0.0],
        [5, "set_pen", "turtle1", 1000, 0, 0, 0, 0],
        [5, "set_pen", "turtle1", 1.0, 0, 0, 0, 0],
        [10**12, "kill", "turtle1"],
        [-1, "kill", "turtle1"],
        ["now", "kill", "turtle1"],
        [True, "kill", "turtle1"],
        [5, [], "turtle1"],
        [],
        5,
    ],
)
def test_an_entry_that_no_simulator_hears_is_malformed(entry):
    with pytest.raises(Malformed, match="heard the entry entries is wrong"):
        read(text("heard", {"entries": [entry]}))


def anything(chance, deep=0):
    """A random value that JSON can hold."""
    kind = chance.randrange(8 if deep < 3 else 5)
    if kind < 5:
        return (None, True, chance.choice([0, -1, 7, 10**30]), chance.choice([0.5, math.nan, -math.inf]), chance.choice(["", "x", "kind"]))[
            kind
        ]
    inner = [anything(chance, deep + 1) for _ in range(chance.randrange(4))]
    return inner if kind < 7 else {chance.choice(["kind", "name", "passed", "text", "x"]): each for each in inner}


@pytest.mark.parametrize("seed", range(5))
def test_no_message_of_any_shape_ends_the_reading(seed):
    chance, malformed = random.Random(seed), 0
    for _ in range(200):
        kind = chance.choice(sorted(GOOD))
        facts = {name: anything(chance) if chance.random() < 0.5 else value for name, value in GOOD[kind].items()}
        malformed += Told([f"x {text(kind, facts)}"], "x").malformed is not None
    assert 20 < malformed < 200


@pytest.mark.parametrize("line", ["", "y nonsense", "junk", 'junkx {"kind": "done"}', ' x {"kind": "done"}'])
def test_a_line_without_the_secret_may_have_destroyed_a_message(line):
    told = Told(['x {"kind": "value", "values": ["2"]}', line, 'x {"kind": "done"}'], "x")
    assert told.malformed == "a line is not from this run" and not told.done


def test_the_first_of_a_kind_counts_and_nothing_after_the_end():
    lines = ['x {"kind": "value", "values": ["2"]}', 'x {"kind": "value", "values": ["3"]}', 'x {"kind": "done"}', "x nonsense"]
    told = Told(lines, "x")
    assert told.value["values"] == ["2"] and told.tests is None and told.done and told.malformed is None


def test_the_number_of_commands_and_their_order_are_bounded():
    part = text("heard", {"entries": [[5, "kill", "turtle1"]] * schema.PART})
    assert "more than 100000 commands" in Told([f"x {part}"] * 300, "x").malformed
    later, earlier = (text("heard", {"entries": [[tick, "kill", "turtle1"]]}) for tick in (9, 5))
    assert "not in the order of time" in Told([f"x {later}", f"x {earlier}"], "x").malformed
    with pytest.raises(Malformed):
        read(text("heard", {"entries": [[5, "kill", "turtle1"]] * (schema.PART + 1)}))


BROKEN = ['{"kind":"error"}', '{"kind":"value"}', '{"kind":"value","values":[1]}', '{"kind":"tests","results":[{}]}',
          '{"kind":"held","locks":5}', '{"kind":"run","ticks":1000000000000,"begin":1,"end":1}', "nonsense"]  # fmt: skip
"""The messages of issue 29 that ended the grading of a class, or took all memory."""


class FromLines:
    """Takes the place of the processes: each job is answered with the next list of messages."""

    def __init__(self, answers):
        self.answers = iter(answers)

    def ask(self, job):
        self.job = job

    def take(self):
        lines = [f"{self.job['nonce']} {line}" for line in next(self.answers)]
        return {"reports": lines, "output": "", "ended": "left", "signal": 0}

    def close(self):
        pass


@pytest.mark.parametrize("exercise", ["first-drive", "first-lisp"])
def test_a_malformed_message_costs_its_sender_only(exercise, monkeypatch):
    found = find(exercise)
    one = found._replace(checks=[check._replace(seeds=1) for check in found.checks])
    grader = Grader(at_once=1)
    good = ['{"kind":"stage","doing":"do","what":"x"}', '{"kind":"done"}']
    everything = [[line, '{"kind":"done"}'] for line in BROKEN for _ in one.checks] + [good] * len(one.checks)
    source = FromLines(everything)
    monkeypatch.setattr(grader, "_fork_server", lambda slot, exercise: source)
    reports = grader._all([(one, {one.submission[0]: "()"})] * (len(BROKEN) + 1))
    for report in reports[:-1]:
        assert report.points == 0 and "The program sends reports of its own, or destroys those of its run: " in report.text()
    assert reports[-1].points == 0 and "reports of its own" not in reports[-1].text()


def test_a_text_that_is_too_large_or_cannot_be_written_is_not_a_text():
    exercise = find("first-drive")
    with Grader(apart=False) as grader:
        for text in ("\ud800", "x" * (LARGEST + 1)):
            assert "is not UTF-8 text, or too large" in grader.grade_texts(exercise, {"first-drive.lisp": text}).text()
