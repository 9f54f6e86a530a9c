"""An exercise: a folder with ``exercise.toml``, a text (``README.md``), starting files and tests.

`Exercise.read` reads it and says in words what is wrong with it, with the place. What the entries mean stands in
``docs/how-to/grading.md``. Nothing here runs anything.
"""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

from . import allowances, paths, troubles
from .problems import ExerciseError

FILE = "exercise.toml"
LIMITS = {"time": 5.0, "memory": 600, "turtle_time": 120.0, "output": 200}
"""Seconds of processor time, megabytes, seconds of the plan's clock, kilobytes: for each run of a check."""
WIDEST = {"time": 300.0, "memory": 8000, "turtle_time": 3600.0, "output": 10_000}
BEFORE_TURTLE = ('(roslisp:start-ros-node "grader")',)
"""What happens before a plan, if the exercise says nothing else."""
RUN_CRITERIA = {
    "paper", "at", "visits", "seconds", "distance", "commands", "walls", "teleports", "turtles", "value", "fails", "services",
    "turned", "still",
}  # fmt: skip
"""What a check may ask of a run of ``do``."""
CHECK_KEYS = RUN_CRITERIA | {
    "title", "points", "seeds", "start", "vary", "before", "do", "after", "troubles", "faults", "ask", "within", "tests", "only", "source",
    "hint", "allow", "hidden", "show_answers", "needs",
}  # fmt: skip
EXERCISE_KEYS = {"title", "submission", "systems", "package", "prelude", "before", "limits", "check", "allow", "show_answers"}
MOST_SEEDS = 100


class Check(NamedTuple):
    """A check: its title, its points, how many seeds it is tried with, and the table of the file.

    hidden: whether a student is told nothing of what it asks. show_answers: whether he is told what was expected. needs: the numbers of
    the checks that must pass, too, counted from 1.
    """

    title: str
    points: float
    seeds: int
    table: dict[str, Any]
    hidden: bool = False
    show_answers: bool = False
    needs: tuple[int, ...] = ()

    @property
    def kind(self) -> str:
        """ "do", "ask", "tests" or "source"."""
        return next(kind for kind in ("do", "ask", "tests", "source") if kind in self.table)


class Exercise(NamedTuple):
    """An exercise. submission: the names of the files to hand in. files: texts of the exercise's own files, by name.

    allow: what a submission may use beside commands for turtle1 (`allowances`).
    """

    folder: Path
    title: str
    submission: list[str]
    systems: list[str]
    package: str | None
    prelude: list[str]
    before: list[str]
    limits: dict[str, float]
    checks: list[Check]
    files: dict[str, str]
    allow: tuple[str, ...] = ()

    @property
    def points(self) -> float:
        """The most points that it gives."""
        return whole(sum(check.points for check in self.checks))

    @classmethod
    def read(cls, folder: str | Path) -> Exercise:
        """The exercise in ``folder``. Raises `ExerciseError`."""
        folder = Path(folder)
        try:
            text = (folder / FILE).read_text(encoding="utf-8")
        except OSError as problem:
            raise ExerciseError(f"{folder} is not an exercise: {folder / FILE} cannot be read ({problem.strerror}).")
        except UnicodeDecodeError:
            raise ExerciseError(f"{folder / FILE} is not UTF-8 text. Save it as UTF-8.")
        try:
            table = tomllib.loads(text)
        except tomllib.TOMLDecodeError as problem:
            raise ExerciseError(f"{folder / FILE} is not TOML: {problem}.")
        try:
            return _exercise(folder, table)
        except ExerciseError as problem:
            raise ExerciseError(f"{folder / FILE}: {problem}")


def of_checks(title: str, tables: list[dict[str, Any]]) -> Exercise:
    """An exercise without a folder, for a session that is there already: nothing is handed in and nothing loaded.

    tables: its checks, as below ``[[check]]``; one without a title has that of the exercise. Raises `ExerciseError`.
    """
    checks = [_check(Path(), {"title": title, **table}, number, {}) for number, table in enumerate(tables, 1)]
    return Exercise(Path(), title, [], [], None, [], [], dict(LIMITS), checks, {})


def whole(number):
    """3 for 3.0, so that points are shown as people write them."""
    return int(number) if float(number).is_integer() else round(number, 2)


def _exercise(folder, table):
    _known(table, EXERCISE_KEYS, "the exercise")
    _finite(table, "the exercise")
    submission = _texts(table, "submission")
    if not submission:
        raise ExerciseError('it does not say what is handed in. Write submission = ["square.lisp"].')
    for name in submission:
        if Path(name).is_absolute() or ".." in Path(name).parts:
            raise ExerciseError(f"the file {name} of a submission is outside of its folder.")
    limits = dict(LIMITS)
    _known(table.get("limits", {}), set(LIMITS), "[limits]")
    for name, value in table.get("limits", {}).items():
        if not isinstance(value, (int, float)) or not 0 < value <= WIDEST[name]:
            raise ExerciseError(f"the limit {name} is {value!r}; it must be above 0 and at most {WIDEST[name]:g}.")
        limits[name] = value
    if not isinstance(table.get("check"), list) or not table["check"]:
        raise ExerciseError("it has no checks. Write one below [[check]].")
    files = {}
    shows = _flag(table, "show_answers", "the exercise")
    checks = [_check(folder, entry, number, files, shows) for number, entry in enumerate(table["check"], 1)]
    before = _texts(table, "before") if "before" in table else list(BEFORE_TURTLE)
    return Exercise(
        folder,
        str(table.get("title", folder.name)),
        submission,
        _texts(table, "systems"),
        table.get("package"),
        _texts(table, "prelude"),
        before,
        limits,
        checks,
        files,
        tuple(allowances.checked(table.get("allow", []), "the exercise")),
    )


def _check(folder, table, number, files, shows=False):
    where = f"check {number}"
    _known(table, CHECK_KEYS, where)
    title = table.get("title")
    if not isinstance(title, str):
        raise ExerciseError(f"{where} has no title.")
    where = f'{where}, "{title}"'
    points = table.get("points", 1)
    if not isinstance(points, (int, float)) or isinstance(points, bool) or not 0 <= points < 10_000:
        raise ExerciseError(f"the points of {where} are {points!r}, and not a number.")
    seeds = table.get("seeds", 1)
    if not isinstance(seeds, int) or not 1 <= seeds <= MOST_SEEDS:
        raise ExerciseError(f"the seeds of {where} are {seeds!r}, and not a number from 1 to {MOST_SEEDS}.")
    kinds = [kind for kind in ("do", "ask", "tests", "source") if kind in table]
    if len(kinds) != 1:
        raise ExerciseError(f"{where} has {' and '.join(kinds) or 'nothing to do'}; it needs one of do, ask, tests and source.")
    criteria = RUN_CRITERIA & set(table)
    if kinds == ["do"] and not criteria:
        raise ExerciseError(f"{where} asks nothing of the run. It may ask for {', '.join(sorted(RUN_CRITERIA))}.")
    if kinds != ["do"] and criteria:
        raise ExerciseError(f"{where} has no do, but asks for {', '.join(sorted(criteria))}.")
    if "paper" in table:
        paper = table["paper"]
        _known(paper, {"way", "from", "upright", "tolerance", "slack", "width", "ordered", "pen_first"}, f"paper of {where}")
        if not isinstance(paper.get("way"), str):
            raise ExerciseError(f"paper of {where} has no way.")
    for trouble in table.get("troubles", ()):
        troubles.checked(trouble)
    if "source" in table:
        _known(table["source"], {"uses", "avoids"}, f"source of {where}")
    if "ask" in table and not all(_is_question(question) for question in table["ask"]):
        raise ExerciseError(f'{where} has a question that is not [form, answer], as in ["(+ 1 2)", "3"].')
    if "tests" in table:
        files[table["tests"]] = _text_of(folder, table["tests"], where)
    allowances.checked(table.get("allow", []), where)
    hidden, shows = _flag(table, "hidden", where), _flag(table, "show_answers", where, shows)
    if hidden and table.get("show_answers"):
        raise ExerciseError(f"{where} is hidden, and shall show its answers. It can do one of both.")
    return Check(title, points, seeds, table, hidden, shows, _needs(table.get("needs", []), number, where))


def _flag(table, name, where, otherwise=False):
    found = table.get(name, otherwise)
    if not isinstance(found, bool):
        raise ExerciseError(f"{name} of {where} is {found!r}, and neither true nor false.")
    return found


def _needs(needs, number, where):
    """The numbers of checks that must pass, too, as a tuple: of those above, so that nothing needs itself."""
    needs = needs if isinstance(needs, list) else [needs]
    for each in needs:
        if not isinstance(each, int) or isinstance(each, bool) or not 1 <= each < number:
            raise ExerciseError(f"{where} needs {each!r}, which is not the number of a check above it. The first check has the number 1.")
    return tuple(needs)


def _finite(value, where):
    """Raise `ExerciseError` if a number is endless or not-a-number: TOML has both, and nothing could be compared with them."""
    if isinstance(value, dict):
        for name, each in value.items():
            _finite(each, f"{name} of {where}")
    elif isinstance(value, list):
        for each in value:
            _finite(each, where)
    elif isinstance(value, float) and not math.isfinite(value):
        raise ExerciseError(f"{where} is {value}. Write a number that is finite.")


def _is_question(question):
    return isinstance(question, list) and len(question) == 2 and all(isinstance(part, str) for part in question)


def _text_of(folder, name, where):
    try:
        return (folder / name).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as problem:
        raise ExerciseError(f"the file {name} of {where} cannot be read: {problem}.")


def _texts(table, name):
    found = table.get(name, [])
    if not isinstance(found, list) or not all(isinstance(each, str) for each in found):
        raise ExerciseError(f"{name} is {found!r}, and not a list of texts.")
    return found


def _known(table, names, where):
    if not isinstance(table, dict):
        raise ExerciseError(f"{where} is not a table.")
    unknown = sorted(set(table) - names)
    if unknown:
        raise ExerciseError(f"{where} has {', '.join(unknown)}, which means nothing there. There are {', '.join(sorted(names))}.")


def find(name: str) -> Exercise:
    """The exercise in the folder ``name``, or the one of that name that comes with cramhy. Raises `ExerciseError`."""
    if (Path(name) / FILE).is_file() or Path(name).is_dir():
        return Exercise.read(name)
    known = own_exercises()
    if name in known:
        return Exercise.read(known[name])
    names = ", ".join(sorted(known))
    raise ExerciseError(f"There is no folder {name}, and no exercise of that name. cramhy has {names}.")


def own_exercises() -> dict[str, Path]:
    """The folders of the exercises that come with cramhy, by name."""
    root = Path(__file__).parents[1]
    for place in (root / "tutorials" / "exercises", root.parents[1] / "tutorials" / "exercises"):
        if place.is_dir():
            return {folder.parent.name: folder.parent for folder in sorted(place.glob(f"*/{FILE}"))}
    return {}


__all__ = ["Check", "Exercise", "find", "own_exercises", "paths", "whole"]
