"""Exercises as folders: what cramhy has, and what is wrong with one in words."""

from __future__ import annotations

import pytest

from cramhy_runtime.grading import jobs
from cramhy_runtime.grading.exercise import Exercise, find, own_exercises
from cramhy_runtime.grading.problems import ExerciseError

from .submissions import SOLUTIONS

GOOD = """
title = "Good"
submission = ["a.lisp"]
[[check]]
title = "One"
points = 2
ask = [["(+ 1 2)", "3"]]
"""


@pytest.mark.parametrize("name", own_exercises())
def test_an_exercise_of_ours_is_whole(name):
    folder = own_exercises()[name]
    exercise = find(name)
    assert exercise.points > 0 and exercise.title
    text = (folder / "README.md").read_text()
    assert text.startswith(f"# {exercise.title}\n") and f"cramhy grade {name} {exercise.submission[0]}" in text
    assert sorted(path.name for path in (folder / "start").iterdir()) == sorted(exercise.submission)
    assert sorted(path.name for path in (SOLUTIONS / name).iterdir()) == sorted(exercise.submission)
    assert not list(folder.rglob("*solution*")), "solutions are kept apart"
    for check in exercise.checks:
        if check.kind != "source":
            for seed in range(1, 6):
                jobs.job(exercise, check, seed, {})


def read(folder, text):
    (folder / "exercise.toml").write_text(text)
    return Exercise.read(folder)


def test_a_good_one_is_read(tmp_path):
    exercise = read(tmp_path, GOOD)
    assert exercise.points == 2 and exercise.checks[0].kind == "ask" and exercise.limits["time"] == 5


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('title = "Good"', "title = ", "is not TOML"),
        ('submission = ["a.lisp"]', "", "does not say what is handed in"),
        ('["a.lisp"]', '["../a.lisp"]', "outside of its folder"),
        ('["a.lisp"]', '"a.lisp"', "and not a list of texts"),
        ("points = 2", "points = -1", 'points of check 1, "One" are -1'),
        ("points = 2", "seeds = 0", "not a number from 1 to 100"),
        ("points = 2", "colour = 2", "check 1 has colour, which means nothing there"),
        ('title = "One"', "", "check 1 has no title"),
        ('ask = [["(+ 1 2)", "3"]]', "", "has nothing to do"),
        ('ask = [["(+ 1 2)", "3"]]', 'ask = ["3"]', "a question that is not"),
        ('ask = [["(+ 1 2)", "3"]]', 'do = "(go)"', "asks nothing of the run"),
        ('ask = [["(+ 1 2)", "3"]]', 'do = "(go)"\npaper = { path = "forward 1" }', "has path, which means nothing"),
        ('ask = [["(+ 1 2)", "3"]]', 'do = "(go)"\nwalls = 0\ntroubles = [{ kind = "rain" }]', "no trouble 'rain'"),
        ('ask = [["(+ 1 2)", "3"]]', 'tests = "nothing.lisp"', "nothing.lisp of check 1"),
        ("points = 2", "points = 2\nwalls = 3", "has no do, but asks for walls"),
        ("[[check]]", "[limits]\ntime = 1000\n[[check]]", "must be above 0 and at most 300"),
        ("[[check]]", "[[cheque]]", "which means nothing there"),
    ],
)
def test_what_is_wrong_with_one_is_told_with_its_place(tmp_path, old, new, words):
    assert old in GOOD
    with pytest.raises(ExerciseError) as problem:
        read(tmp_path, GOOD.replace(old, new))
    assert words in str(problem.value) and str(tmp_path / "exercise.toml") in str(problem.value)


def test_a_folder_without_one_is_told(tmp_path):
    with pytest.raises(ExerciseError, match="is not an exercise"):
        Exercise.read(tmp_path)
