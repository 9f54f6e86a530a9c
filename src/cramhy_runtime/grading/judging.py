"""What came of a run, compared with what an exercise asks for; in the grader's process, and in words for the student.

Each function gives a `Fault` for each thing that is wrong, and nothing if all is right. Each comparison says what is right, so that
not-a-number, which is neither smaller nor larger than anything, is wrong.
"""

from __future__ import annotations

import math
import re

from . import allowances, drawings, paths
from .expressions import computed, filled
from .schema import not_finite
from .replay import Replay, WrongReport
from .sentences import Fault, fault
from cramhy_runtime.turtlesim.world import TICK

TOLERANCE = 0.25
"""Metres that a line may be off, if the exercise says nothing else: the course's turtle reaches a goal to a tenth of a metre."""
SLACK = 0.15
"""Metres of a drawing that may be missing or too much."""
NEAR = 0.2
NUMBER = re.compile(r"[-+]?(?:\d+/\d+|(?:\d+\.\d*|\.\d+|\d+)(?:[dfes][-+]?\d+)?)(?![\w.])", re.I)


def of_run(check, job, values, told, allow=None):
    """What is wrong with a run of ``do``. told: what its process told (`Told`). allow: what it may use, a set; ``None``: everything."""
    table, form = check.table, job["do"]
    wrong = list(_outcome(table, form, values, told))
    if not told.run:
        return wrong or [fault(NO_RUN, NO_RUN)]
    wrong += [fault(sentence, sentence) for sentence in _not_finite(told)]
    if allow is not None:
        wrong += _only_allowed(allow, told)
    if told.run["ticks"] > job["turtle_time"] * MOST_TICKS_A_SECOND + 1000:
        return [*wrong, fault(NO_SIMULATOR, NO_SIMULATOR)]
    if wrong and (told.error or _not_finite(told) or (allow is not None and allowances.faults(allow, told))):
        return wrong  # the drawing of such a plan says little more
    try:
        replay = Replay(tuple(job["start"]), told.heard, told.run["ticks"], told.run["begin"], job["troubles"], job["seed"])
    except (WrongReport, TypeError, ArithmeticError, ValueError):
        return [*wrong, fault(NO_SIMULATOR, NO_SIMULATOR)]
    table = {"teleports": 0, **table}  # who is carried has not driven
    for judge in _JUDGES:
        wrong += judge(table, values, replay, told)
    return wrong


NO_RUN = "The turtle's simulator never started."
NO_SIMULATOR = "The report of the run is not one that a simulator makes."
MOST_TICKS_A_SECOND = 65
FASTEST = 1e6
"""A command with a larger number in it is a mistake. The numbers are m/s and rad/s, or metres."""


def _only_allowed(allow, told):
    return [fault(sentence, sentence) for sentence in allowances.faults(allow, told)]


def _not_finite(told):
    """A sentence if a turtle was told a number that is none: nothing that it did then was driving."""
    for entry in told.heard:
        found = not_finite(entry)
        if found is not None:
            what = f"{entry[2]} a velocity" if entry[1] == "command" else f"the service {entry[1]} a number"
            return [
                f"The program tells {what} that is {found}. Such a number comes from a division such as 0/0 or 1/0 of floats, or from one "
                "that has grown too large. Print the numbers before they are sent, and look at what is divided."
            ]
        large = next((number for number in entry[3:] if abs(number) > FASTEST), None)
        if large is not None:
            return [f"The program tells {entry[2] or 'the simulator'} a number that is far too large: {large:g}."]
    return []


def _outcome(table, form, values, told):
    """Whether the form gave a value, or failed as it should."""
    wanted = table.get("fails")
    if told.error:
        types = told.error["types"]
        if "TIME-LIMIT" in types:
            yield fault("The plan was not over when the turtle's time was.", f"{form} was not over when the turtle's time was.")
        elif wanted is None:
            yield fault("The plan ended with an error.", f"{form} ended with an error:\n{told.error['text']}")
        elif wanted.upper() not in types:
            failed = f"failed with {types[0] if types else 'something else'}"
            yield Fault(
                "The plan failed in another way than it should.",
                f"{form} {failed}, which is not the failure that it should end with.",
                f"{form} should fail with {wanted}, and {failed}.",
            )
    elif wanted is not None:
        yield Fault(
            "The plan should fail, and did not.",
            f"{form} should fail, and did not.",
            f"{form} should fail with {wanted}, and did not fail.",
        )
    elif told.value is None:
        yield fault("The plan gave no value.", f"{form} gave no value.")
    elif "value" in table:
        yield from _compared(form, table["value"], values, told.value["values"], table.get("within", 1e-6))


def of_place(table, values, now):
    """What is wrong with the paper and the place of the turtle as they are. now: has ``begun``, ``drawing`` and ``place`` as a `Replay`."""
    return [sentence for judge in (_paper, _at) for sentence in judge(table, values, now, None)]


def of_answers(check, job, values, told, allow=None):
    """What is wrong with the answers to questions. allow: as of `of_run`."""
    wrong = _only_allowed(allow, told) if allow is not None else []
    for place, (form, (_, expected)) in enumerate(zip(job["asks"], check.table["ask"])):
        if place >= len(told.answers):
            wrong.append(fault("A question was not answered.", f"{form} was not answered."))
            break
        kind, facts = told.answers[place]
        failing = expected.startswith("fails ")
        wanted = expected.removeprefix("fails ")
        if kind == "error" and "TIME-LIMIT" in facts["types"]:
            wrong.append(endless(form))
            break  # there is no time for the others
        if kind == "error" and not failing:
            wrong.append(fault("A question ended with an error.", f"{form} ended with an error:\n{facts['text']}"))
        elif kind == "error" and wanted.upper() not in facts["types"]:
            failed = f"failed with {facts['types'][0] if facts['types'] else 'something else'}"
            wrong.append(
                Fault(
                    "A question failed in another way than it should.",
                    f"{form} {failed}, which is not the failure that it should end with.",
                    f"{form} should fail with {wanted}, and {failed}.",
                )
            )
        elif kind != "error" and failing:
            gave = f"gave {_shown(facts['values'])}"
            wrong.append(
                Fault("A question should fail.", f"{form} should fail, and {gave}.", f"{form} should fail with {wanted}, and {gave}.")
            )
        elif kind != "error":
            wrong += _compared(form, expected, values, facts["values"], check.table.get("within", 1e-6))
    return wrong


def endless(form):
    """What to say of a question that does not end within the turtle's time."""
    return fault("A question never ended.", f"{form} never ended, and was stopped. Is there a loop or a recursion in it that does not end?")


def of_tests(check, told, allow=None):
    """What is wrong according to tests. allow: as of `of_run`."""
    wrong = _only_allowed(allow, told) if allow is not None else []
    if told.tampered:
        return [*wrong, fault(told.tampered["text"], told.tampered["text"])]
    if told.error:
        return [*wrong, fault("The tests ended with an error.", f"The tests ended with an error:\n{told.error['text']}")]
    if told.tests is None:
        return [*wrong, fault("The tests did not end.", "The tests did not end.")]
    results = told.tests["results"]
    if not results:
        return [*wrong, fault("No test was run.", "No test was run.")]
    missing = {name.upper() for name in check.table.get("only", ())} - {result["name"].upper() for result in results}
    wrong += [fault("A test is missing.", f"There is no test {name}.") for name in sorted(missing)]
    for result in results:
        if not result["passed"]:
            named = f"The test {result['name'].lower()} failed"
            wrong.append(Fault("A test failed.", f"{named}.", f"{named}:\n{result['text']}".rstrip(":\n")))
    return wrong


# ------------------------------------------------------------------------------------------------------------------ values


def _compared(form, expected, values, given, within):
    wanted = filled(expected, values)
    if not same(wanted, given[0] if given else "NIL", within):
        yield Fault(
            "An answer is wrong.",
            f"{form} gave {_shown(given)}, which is not right.",
            f"{form} should give {wanted}, and gave {_shown(given)}.",
        )


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
        yield fault(EMPTY, EMPTY)
        return
    slack = paper.get("slack", SLACK)
    tolerance = paper.get("tolerance", TOLERANCE)
    found = drawings.difference(target, drawn, tolerance)
    wrong = not (found.missing <= slack and found.much <= slack)
    if wrong and _same_lines(target, drawn, tolerance, slack):
        metres = found.missing or found.much
        other = f"The lines of the drawing are right, but {metres:.1f} m of them have another colour than they should"
        yield Fault("A part of the drawing has another colour.", f"{other}.", f"{other}, near {_point(found.missing_at or found.much_at)}.")
        return
    if not found.missing <= slack:
        missing = f"{found.missing:.1f} m of the drawing are missing"
        yield Fault("A part of the drawing is missing.", f"{missing}.", f"{missing}, the first near {_point(found.missing_at)}.")
    if not found.much <= slack:
        much = f"{found.much:.1f} m of the drawing should not be there, the first near {_point(found.much_at)}."
        yield fault("There is too much in the drawing.", much)
    if not wrong:
        yield from _pen_and_order(paper, target, drawn, replay, values)


def _same_lines(target, drawn, tolerance, slack):
    """Whether two drawings are equal but for their colours."""
    found = drawings.difference(*([(None, line) for _, line in drawing] for drawing in (target, drawn)), tolerance)
    return found.missing <= slack and found.much <= slack


def _pen_and_order(paper, target, drawn, replay, values):
    """What is wrong with a drawing that has the right lines: the width of the pen, and how they were drawn."""
    if "width" in paper:
        wanted, widths = computed(paper["width"], values), replay.widths()
        if widths != [wanted]:
            lines = f"The lines are {' and '.join(map(str, widths))} pixels wide"
            yield Fault(
                "The lines have another width than they should.", f"{lines}, which is not right.", f"{lines}. They should be {wanted}."
            )
    if paper.get("pen_first") and replay.pen_late:
        yield fault(PEN_LATE, PEN_LATE)
    if not paper.get("ordered"):
        return
    drew, asked = drawings.length(drawn), drawings.length(target)
    if drew > asked * (1 + LONGER) + paper.get("slack", SLACK):
        twice = f"The lines of the drawing are right, but {drew - asked:.1f} m of them were drawn more than once."
        yield fault("A part of the drawing was drawn more than once.", twice)
    elif not drawings.in_order(target, drawn, paper.get("tolerance", TOLERANCE) + paper.get("slack", SLACK)):
        yield fault(OTHER_ORDER, OTHER_ORDER)


LONGER = 0.03
"""The share by which a drawing may be longer than the asked one: turtles overshoot."""
OTHER_ORDER = "The lines of the drawing are right, but the order matters: the turtle drew them in another one, or the other way round."
PEN_LATE = (
    "The order matters here: the turtle was driven first, and its pen was set afterwards. So it begins its line with the pen that it had."
)
EMPTY = "The paper is empty: the turtle has drawn nothing."


def _point(place):
    return f"x {place[0]:.1f}, y {place[1]:.1f}"


def _at(table, values, replay, told):
    if "at" not in table:
        return
    goal = table["at"]
    place = replay.place(goal.get("turtle", "turtle1"))
    if place is None:
        missing = f"There is no {goal.get('turtle', 'turtle1')} at the end."
        yield fault(missing, missing)
        return
    x, y = (float(computed(goal[name], values)) if name in goal else place[index] for index, name in enumerate("xy"))
    near = goal.get("within", NEAR)
    if not math.dist((x, y), place[:2]) <= near:
        ends = f"The turtle ends at {_point(place)}"
        yield Fault(
            "The turtle ends at another place.",
            f"{ends}, which is {math.dist((x, y), place[:2]):.1f} m from where it should be.",
            f"{ends}. It should end at {_point((x, y))}, to {near} m.",
        )
    if "heading" in goal:
        wanted = math.radians(computed(goal["heading"], values))
        off = abs(math.remainder(place[2] - wanted, math.tau)) if math.isfinite(place[2]) else math.inf
        if not off <= math.radians(goal.get("degrees", 10)):
            looks = f"The turtle looks to {math.degrees(place[2]):.0f} degrees at the end"
            yield Fault(
                "The turtle looks elsewhere at the end.",
                f"{looks}, which is not right. (0 is to the right, 90 is up.)",
                f"{looks}. It should look to {math.degrees(wanted):.0f}. (0 is to the right, 90 is up.)",
            )


def _visits(table, values, replay, told):
    if "visits" not in table:
        return
    way, place = replay.way.get("turtle1", []), 0
    for number, goal in enumerate(table["visits"], 1):
        x, y = (float(computed(part, values)) for part in goal[:2])
        near = computed(goal[2], values) if len(goal) > 2 else NEAR
        while place < len(way) and not math.dist((x, y), way[place][:2]) <= near:
            place += 1
        if place == len(way):
            yield Fault(
                "The turtle did not come to all places in their order.",
                f"The turtle did not come to place {number} in its turn.",
                f"The turtle did not come to place {number}, {_point((x, y))}, in its turn.",
            )
            return


def _seconds(table, values, replay, told):
    """The plan's time: its clock says it, and the simulator's ticks must agree."""
    if "seconds" not in table:
        return
    took = told.took["seconds"] if told.took else math.nan
    ticked = (told.run["end"] - told.run["begin"]) * TICK
    if not abs(took - ticked) <= CLOCKS_APART:
        yield fault(NO_SIMULATOR, NO_SIMULATOR)
        return
    low, high = _range(table["seconds"], values)
    if not low <= took <= high:
        yield _off(f"The plan took {took:.1f} s of the turtle's time", took, low, high, " s", "It should take")


def _still(table, values, replay, told):
    """Whether the turtle stands when the plan is over. One that nobody stops obeys its last speed for a second."""
    if not table.get("still"):
        return
    metres, radians = replay.moved_since(told.run["end"])
    if not (metres <= ROLLS and radians <= math.radians(TURNS_ON)):
        yield fault(MOVES_ON, MOVES_ON)


MOVES_ON = "When the plan is over, the turtle still moves."
ROLLS = 0.06
TURNS_ON = 4
"""Metres and degrees for which a stopped turtle may go on: a command takes effect with the next tick."""
CLOCKS_APART = 0.1
"""Seconds between what the plan's clock and the simulator's ticks say."""


def _counted(name, count, words, wanted):
    """A judge of a number. count: gives it for a `Replay`. words: a sentence with {} for the number, and
    {s} behind what is counted. wanted: how the sentence begins that says what it should be."""

    def judge(table, values, replay, told):
        if name in table:
            found = count(replay)
            low, high = _range(table[name], values)
            if not low <= found <= high:
                shown = f"{found:.1f}" if isinstance(found, float) else found
                yield _off(words.format(shown, s="" if found == 1 else "s"), found, low, high, "", wanted)

    return judge


def _services(table, values, replay, told):
    for name, wanted in table.get("services", {}).items():
        found, (low, high) = replay.services.get(name, 0), _range(wanted, values)
        if not low <= found <= high:
            yield _off(f"The service {name} was called {found} time{'' if found == 1 else 's'}", found, low, high, "", "It should be")


def _off(words, found, low, high, unit, wanted):
    """The `Fault` of a number outside of its range."""
    side = "too much" if found > high else "too little"
    return Fault(f"A number is {side}.", f"{words}, which is {side}.", f"{words}. {wanted} {_between(low, high)}{unit}.")


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
    _still,
    _counted("turned", Replay.turned, "To the left the turtle turned by {} degrees in all", "It should be"),
    _counted("distance", Replay.distance, "The turtle went {} m", "In metres it should go"),
    _counted("commands", lambda replay: replay.commands, "The plan sent {} command{s}", "It should send"),
    _counted("walls", lambda replay: replay.walls, "The turtle was at a wall in {} tick{s}", "It should be"),
    _counted(
        "teleports",
        lambda replay: sum(replay.services.get(name, 0) for name in allowances.CARRYING),
        "The turtle was carried {} time{s}, by teleport or reset",
        "It should be",
    ),
    _counted("turtles", lambda replay: len(replay.turtles), "The number of turtles at the end is {}", "It should be"),
)
