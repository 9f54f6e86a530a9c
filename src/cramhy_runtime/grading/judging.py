"""What came of a run, compared with what an exercise asks for; in the grader's process, and in words for the student.

`sentences` gives one sentence for each thing that is wrong, and nothing if all is right.
"""

from __future__ import annotations

import math
import re

from . import drawings, paths
from .expressions import computed, filled
from .replay import Replay, WrongReport

TOLERANCE = 0.25
"""Metres that a line may be off, if the exercise says nothing else: the course's turtle reaches a goal to a tenth of a metre."""
SLACK = 0.15
"""Metres of a drawing that may be missing or too much."""
NEAR = 0.2
NUMBER = re.compile(r"[-+]?(?:\d+/\d+|(?:\d+\.\d*|\.\d+|\d+)(?:[dfes][-+]?\d+)?)(?![\w.])", re.I)


def of_run(check, job, values, told):
    """What is wrong with a run of ``do``. told: the reports by kind (`Told`)."""
    table, form = check.table, job["do"]
    wrong = list(_outcome(table, form, values, told))
    if not told.run:
        return [*wrong, "The turtle's simulator never started."] if not wrong else wrong
    try:
        replay = Replay(tuple(job["start"]), told.run["heard"], told.run["ticks"], told.run["begin"], job["troubles"], job["seed"])
    except (WrongReport, KeyError, TypeError, OverflowError):
        return [*wrong, "The report of the run is not one that a simulator makes."]
    if told.error and wrong:  # the drawing of a plan that failed says little more
        return wrong
    table = {"teleports": 0, **table}  # who is carried has not driven
    for judge in _JUDGES:
        wrong += judge(table, values, replay, told)
    return wrong


def _outcome(table, form, values, told):
    """Whether the form gave a value, or failed as it should."""
    wanted = table.get("fails")
    if told.error:
        types = told.error["types"]
        if "TIME-LIMIT" in types:
            yield f"{form} was not over when the turtle's time was."
        elif wanted is None:
            yield f"{form} ended with an error:\n{told.error['text']}"
        elif wanted.upper() not in types:
            yield f"{form} should fail with {wanted}, and failed with {types[0] if types else 'something else'}."
    elif wanted is not None:
        yield f"{form} should fail with {wanted}, and did not fail."
    elif told.value is None:
        yield f"{form} gave no value."
    elif "value" in table:
        yield from _compared(form, table["value"], values, told.value["values"], table.get("within", 1e-6))


def of_place(table, values, now):
    """What is wrong with the paper and the place of the turtle as they are. now: has ``begun``, ``drawing`` and ``place`` as a `Replay`."""
    return [sentence for judge in (_paper, _at) for sentence in judge(table, values, now, None)]


def of_answers(check, job, values, told):
    """What is wrong with the answers to questions."""
    wrong = []
    answers = list(told.answers)
    for place, (form, (_, expected)) in enumerate(zip(job["asks"], check.table["ask"])):
        if place >= len(answers):
            wrong.append(f"{form} was not answered.")
            break
        kind, facts = answers[place]
        if kind == "error":
            wanted = expected.removeprefix("fails ") if expected.startswith("fails ") else None
            if wanted is None:
                wrong.append(f"{form} ended with an error:\n{facts['text']}")
            elif wanted.upper() not in facts["types"]:
                wrong.append(f"{form} should fail with {wanted}, and failed with {facts['types'][0]}.")
        elif expected.startswith("fails "):
            wrong.append(f"{form} should fail with {expected.removeprefix('fails ')}, and gave {_shown(facts['values'])}.")
        else:
            wrong += _compared(form, expected, values, facts["values"], check.table.get("within", 1e-6))
    return wrong


def of_tests(check, told):
    """What is wrong according to tests."""
    if told.tampered:
        return [told.tampered["text"]]
    if told.error:
        return [f"The tests ended with an error:\n{told.error['text']}"]
    if told.tests is None:
        return ["The tests did not end."]
    results = told.tests["results"]
    if not results:
        return ["No test was run."]
    missing = {name.upper() for name in check.table.get("only", ())} - {result["name"].upper() for result in results}
    wrong = [f"There is no test {name}." for name in sorted(missing)]
    return wrong + [
        f"The test {result['name'].lower()} failed:\n{result['text']}".rstrip(":\n") for result in results if not result["passed"]
    ]


# ------------------------------------------------------------------------------------------------------------------ values


def _compared(form, expected, values, given, within):
    wanted = filled(expected, values)
    if not same(wanted, given[0] if given else "NIL", within):
        yield f"{form} should give {wanted}, and gave {_shown(given)}."


def _shown(values):
    return ", ".join(values)[:300] if values else "no value"


def same(one, other, within):
    """Whether two printed values are equal: letters without case, numbers within a distance; 1.0d0, 1.0 and 1 are one number."""
    first, second = NUMBER.split(one.strip().upper()), NUMBER.split(other.strip().upper())
    if [" ".join(part.split()) for part in first] != [" ".join(part.split()) for part in second]:
        return False
    return all(
        abs(_number(left) - _number(right)) <= within
        for left, right in zip(NUMBER.findall(one.strip().upper()), NUMBER.findall(other.strip().upper()))
    )


def _number(text):
    """The number that a text means; not-a-number, which is equal to nothing, if no float is that large."""
    try:
        if "/" in text:
            above, below = text.split("/")
            return int(above) / int(below)
        return float(re.sub("[DFS]", "E", text))
    except (ArithmeticError, ValueError):
        return math.nan


# --------------------------------------------------------------------------------------------------------------- the turtle


def _paper(table, values, replay, told):
    if "paper" not in table:
        return
    paper = table["paper"]
    begin = paper.get("from", "start")
    begin = replay.begun if begin == "start" else tuple(float(computed(part, values)) for part in begin)
    if paper.get("upright"):
        begin = (*begin[:2], 0.0)
    target = paths.lines(paper["way"], values, begin)
    drawn = replay.drawing()
    if not drawn:
        yield "The paper is empty: the turtle has drawn nothing."
        return
    slack = paper.get("slack", SLACK)
    found = drawings.difference(target, drawn, paper.get("tolerance", TOLERANCE))
    if found.missing > slack:
        yield f"{found.missing:.1f} m of the drawing are missing, the first near {_point(found.missing_at)}."
    if found.much > slack:
        yield f"{found.much:.1f} m of the drawing should not be there, the first near {_point(found.much_at)}."


def _point(place):
    return f"x {place[0]:.1f}, y {place[1]:.1f}"


def _at(table, values, replay, told):
    if "at" not in table:
        return
    goal = table["at"]
    place = replay.place(goal.get("turtle", "turtle1"))
    if place is None:
        yield f"There is no {goal.get('turtle', 'turtle1')} at the end."
        return
    x, y = (float(computed(goal[name], values)) if name in goal else place[index] for index, name in enumerate("xy"))
    near = goal.get("within", NEAR)
    if math.dist((x, y), place[:2]) > near:
        yield f"The turtle ends at {_point(place)}. It should end at {_point((x, y))}, to {near} m."
    if "heading" in goal:
        wanted = math.radians(computed(goal["heading"], values))
        off = abs(math.remainder(place[2] - wanted, math.tau))
        if off > math.radians(goal.get("degrees", 10)):
            yield (
                f"The turtle looks to {math.degrees(place[2]):.0f} degrees at the end. It should look to {math.degrees(wanted):.0f}. "
                "(0 is to the right, 90 is up.)"
            )


def _visits(table, values, replay, told):
    if "visits" not in table:
        return
    way, place = replay.way.get("turtle1", []), 0
    for number, goal in enumerate(table["visits"], 1):
        x, y = (float(computed(part, values)) for part in goal[:2])
        near = computed(goal[2], values) if len(goal) > 2 else NEAR
        while place < len(way) and math.dist((x, y), way[place][:2]) > near:
            place += 1
        if place == len(way):
            yield f"The turtle did not come to place {number}, {_point((x, y))}, in its turn."
            return


def _seconds(table, values, replay, told):
    if "seconds" not in table or told.value is None:
        return
    took = told.value["seconds"]
    low, high = _range(table["seconds"], values)
    if not low <= took <= high:
        yield f"The plan took {took:.1f} s of the turtle's time. It should take {_between(low, high)} s."


def _counted(name, count, words):
    def judge(table, values, replay, told):
        if name in table:
            found = count(replay)
            low, high = _range(table[name], values)
            if not low <= found <= high:
                shown = f"{found:.1f}" if isinstance(found, float) else found
                yield words.format(shown, _between(low, high))

    return judge


def _services(table, values, replay, told):
    for name, wanted in table.get("services", {}).items():
        found, (low, high) = replay.services.get(name, 0), _range(wanted, values)
        if not low <= found <= high:
            yield f"The service {name} was called {found} times. It should be {_between(low, high)}."


def _range(wanted, values):
    """(least, most): a number is the most, a list has both."""
    if isinstance(wanted, list):
        return computed(wanted[0], values), computed(wanted[1], values)
    return 0, computed(wanted, values)


def _between(low, high):
    return f"at most {high:g}" if not low else f"{low:g}" if low == high else f"{low:g} to {high:g}"


_JUDGES = (
    _paper,
    _at,
    _visits,
    _seconds,
    _services,
    _counted("distance", Replay.distance, "The turtle went {} m. It should go {} m."),
    _counted("commands", lambda replay: replay.commands, "The plan sent {} commands. It should send {}."),
    _counted("walls", lambda replay: replay.walls, "The turtle was at a wall in {} ticks. It should be {}."),
    _counted(
        "teleports",
        lambda replay: sum(replay.services.get(name, 0) for name in ("teleport_absolute", "teleport_relative", "reset")),
        "The turtle was carried {} times, by teleport or reset. It should be {}.",
    ),
    _counted("turtles", lambda replay: len(replay.turtles), "There are {} turtles at the end. It should be {}."),
)
