"""Exercises as folders: what cramhy has, and what is wrong with one in words."""

from __future__ import annotations

import pytest

from cramhy_runtime.grading import jobs
from cramhy_runtime.grading.exercise import Exercise, find, own_exercises
from cramhy_runtime.grading.expressions import computed
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


def test_each_of_ours_says_what_a_solution_may_use():
    allowed = {name: find(name).allow for name in own_exercises()}
    assert {name: allow for name, allow in allowed.items() if allow} == dict.fromkeys(["dashes", "house", "storm"], ("set_pen",))
    assert all("allow = [" in (folder / "exercise.toml").read_text() for folder in own_exercises().values())


@pytest.mark.parametrize(
    "formula", ["1e308 * 10", "hypot(1.7e308, 1.7e308)", "1e308 * 10 - 1e308 * 10", ["1"], None, "(" * 500 + "1" + ")" * 500]
)
def test_a_formula_gives_a_finite_number_or_is_told(formula):
    with pytest.raises(ExerciseError):
        computed(formula, {})


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
        ("points = 2", "points = nan", "points of check of the exercise is nan. Write a number that is finite."),
        ("points = 2", "points = 2\nwithin = inf", "within of check of the exercise is inf"),
        ("points = 2", "points = 2\nvary.x = { from = 1, to = -inf }", "to of x of vary of check of the exercise is -inf"),
        ('title = "Good"', 'title = "Good"\nallow = ["fly"]', "allow of the exercise has fly, which means nothing. There are set_pen, "),
        ('title = "Good"', 'title = "Good"\nallow = "kill"', "and not a list of texts, such as"),
        ("points = 2", 'points = 2\nallow = ["python", "walk"]', 'allow of check 1, "One" has walk'),
        ("points = 2", "points = 2\nhidden = 1", 'hidden of check 1, "One" is 1, and neither true nor false'),
        ("points = 2", "points = 2\nhidden = true\nshow_answers = true", "is hidden, and shall show its answers"),
        ("points = 2", "points = 2\nneeds = [1]", "needs 1, which is not the number of a check above it"),
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
