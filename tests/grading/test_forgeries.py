"""No attack of `forgeries.attacks` wins points, and each is told by what it does. A part of them here, all of them in ``make soak``."""

from __future__ import annotations

import pytest
from systems import linux

from cramhy_runtime.grading import Grader
from cramhy_runtime.grading.exercise import find, own_exercises
from cramhy_runtime.grading.uses import Uses

from .forgeries import CARRIED, attacks

pytestmark = linux

SHORT = {
    "first-drive: kill and spawn",
    "first-drive: an endless number of Lisp",
    "stop-line: a number that is none",
    "maze: teleport",
    "stop-line: forged with the secret",
    "first-drive: carried before it is asked",
    "first-drive: its own INIT-ROS-TURTLE",
    "first-lisp: another reader of the tests",
    "first-lisp: waits for ever",
    "first-lisp: answers with a huge fraction",
    "rooms: another package of the name CRAM-PROLOG",
    "rooms: the answers as facts",
    "dry-pen: never dips",
    "square: shows another pose",
    "square: another background",
    "watchdog: mimics another turtle",
    "watchdog: a file of Hy",
    "watchdog: code that was compiled before",
    "watchdog: a name full of escapes",
}
"""One of each kind, which CI tries."""


def tried(chosen):
    """What went wrong: for each attack that wins, or is not named, its name and the report."""
    exercises = {each.exercise: find(each.exercise) for each in chosen}
    with Grader() as grader:
        reports = grader._all([(exercises[each.exercise], {exercises[each.exercise].submission[0]: each.text}) for each in chosen])
    return {
        each.name: report.text()
        for each, report in zip(chosen, reports, strict=True)
        if report.points > each.most or each.words not in report.text()
    }


@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("/proc/self/mem", ("inside", "/proc/self/mem")),
        ("/proc/1/environ", ("inside", "/proc/1/environ")),
        ("/dev/fd/3", ("inside", "/dev/fd/3")),
        (b"/proc/self/maps", ("inside", "/proc/self/maps")),
        ("x.hy", ("code", "x.hy")),
        ("below/x.py", ("code", "below/x.py")),
        ("kept", ("code", "kept")),
        ("words.txt", None),
        ("a.lisp", None),
        ("b.py", None),
        ("/usr/lib/x.py", None),
        (3, None),
    ],
)
def test_a_program_that_opens_code_or_its_own_process_says_so_before(tmp_path, path, told):
    (tmp_path / "kept").write_bytes(b"# cramhy kept code 3\n")
    (tmp_path / "words.txt").write_text("words")
    found = []
    uses = Uses(lambda kind, what, name: found.append((what, name)), ["a.lisp", "b.py"], tmp_path)
    place = str(tmp_path / path) if isinstance(path, str) and not path.startswith("/") else path
    uses.hear_audit("open", (place, "r", 0))
    assert found == [], "nobody watches yet"
    uses.on = True
    uses.hear_audit("open", (place, "r", 0))
    uses.hear_audit("compile", (place,))
    assert found == ([told] if told else []) and uses.on


def test_the_list_of_attacks_is_whole():
    names = [each.name for each in attacks()]
    assert len(names) == len(set(names)) >= 190 and SHORT <= set(names)
    assert {each.exercise for each in attacks()} == set(own_exercises())
    assert set(own_exercises()) - set(CARRIED) == {"first-lisp", "rooms"}, "a turtle can be carried in all others"


def test_one_attack_of_each_kind_wins_nothing():
    assert tried([each for each in attacks() if each.name in SHORT]) == {}


@pytest.mark.soak
@pytest.mark.timeout(3000)
def test_no_attack_wins_anything():
    assert tried(attacks()) == {}
