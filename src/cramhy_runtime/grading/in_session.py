"""A check of what stands in a session that is there already: the student's own, in which the functions were just typed.

Nothing is loaded and nothing is protected. The turtle of the session drives: a check that lets it drive begins with a clean paper and a
fresh turtle, and the student sees what is checked. A check with ``paper`` or ``at`` but without ``do`` looks at the paper and the turtle
as they are.
"""

from __future__ import annotations

import math
import re
import secrets
from contextlib import contextmanager
from pathlib import Path

import hy

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.ros import graph
from cramhy_runtime.session.session import Interruption
from cramhy_runtime.turtlesim.node import running_simulator
from cramhy_runtime.turtlesim.teleop import Teleop

from . import judging, schema
from .exercise import RUN_CRITERIA, Check, Exercise, of_checks
from .jobs import job
from .noticing import KEYS, Noticing
from .performing import carry_out
from .recording import Recording
from .sentences import said
from .told import Told

if TYPE_CHECKING:
    from collections.abc import Callable

_MISSING = re.compile(
    r"(?P<form>[^\n]*) ended with an error:\n\s*"
    r"(?:The (?P<sort>function|variable) (?P<lisp>\S+) is (?:undefined|unbound)|name '(?P<hy>\S+)' is not defined$)"
)
"""The report of a form with a name that may not have a meaning yet."""
_MANGLED = re.compile(r"\bhyx_\w+")
_MISSING_IN_HY = re.compile(r"name '(\w+)' is not defined")
_NOT_YET = re.compile(r"There is no (?:function|variable) (\S+) yet\.")
_SAID = re.compile(rf"^{_NOT_YET.pattern}$|The (?:function|variable) (\S+) is (?:undefined|unbound)|name '([^']+)' is not defined", re.M)
_TYPED = re.compile(r"\(typed(?:\s+([^\s()]+))?\)")
"""In a form of a check: stands for what the student has typed."""
_TOO_LONG = "was not over when the turtle's time was."
_COMMANDS = re.compile(r"The plan sent (\d+ commands?)")
"""One that is sent when the plan ends comes too late to be counted."""
_ERROR = "ended with an error:"
MOST_ANSWERS = 3
"""So many wrong answers of a check are told, and of several errors one: they are mostly the same one."""
_LISP_VALUE = re.compile(r"(should give |and gave )(NIL|T)(?=[.,])")
NO_TURTLE = "There is no turtle yet. Start it as the page says, and check again."


class _Evaluator:
    """Takes the place of a session: its forms are evaluated by a function of a text, which gives values. ``interrupted``: by Ctrl-C."""

    def __init__(self, evaluate, seconds):
        self.evaluate, self.seconds = evaluate, seconds
        self.interrupted = False

    def evaluate_text(self, form):
        if self.interrupted:
            raise Interruption
        try:
            with kernel.time_limited(self.seconds):
                return self.evaluate(form)
        except Interruption:
            self.interrupted = True
            raise


def fresh_seed() -> int:
    """A seed that nobody knows before: with it a check is tried beside those that it has always."""
    return 1000 + secrets.randbelow(1_000_000)


def faults(
    title: str,
    tables: list[dict[str, Any]],
    evaluate: Callable[[str], list[Any]],
    language: str = "lisp",
    typed: Callable[[str | None], str | None] | None = None,
) -> list[str]:
    """What is wrong, as sentences for the student; nothing if all checks pass.

    title: of the exercise. tables: its checks, as below ``[[check]]``; ``say`` takes the place of all that would be told of a check.
    evaluate: gives the values of a text's last form, in the ``language`` of the checks, "lisp" or "hy". typed: gives the form that was
    typed last, or for a name the form that was typed last for the value of that variable; ``None`` if nothing is known. A check that asks
    for what is not known is left out. Raises `ExerciseError`, and `Interruption` after Ctrl-C.
    """
    looks, others = [table for table in tables if _looks(table)], [table for table in tables if not _looks(table)]
    wrong = [sentence for table in looks for sentence in _as_it_is(table)]
    if wrong or not others:
        return wrong
    others = [whole for table in others if (whole := _with_typed(table, typed)) is not None]
    own = KEYS | {"say"}
    exercise = of_checks(title, [_with_a_criterion({key: table[key] for key in table if key not in own}) for table in others])
    for check, table in zip(exercise.checks, others):
        varies = "vary" in table or table.get("start") == "anywhere"
        for seed in [*range(1, check.seeds + 1), *([fresh_seed()] if varies else [])]:
            with Noticing({key: table[key] for key in KEYS & set(table)}, evaluate, language) as noticing:
                if noticing.absent:
                    return [_no_function(noticing.absent[0])]
                wrong = _tried(exercise, check, seed, evaluate, language, len(others) > 1 or varies)
            wrong = wrong or said(noticing.faults(), answers=True)
            if wrong:
                if _is_missing(wrong):
                    return wrong
                return [table["say"]] if "say" in table else [*wrong, *([table["hint"]] if "hint" in table and not _failed(wrong) else [])]
    return []


def _with_typed(table, typed):
    """The table of a check with what was typed in its questions; ``None`` if a question needs something that is not known."""
    known = True

    def text_of(match):
        nonlocal known
        text = typed(match[1]) if typed is not None else None
        known = known and text is not None
        return text or ""

    questions = [[_TYPED.sub(text_of, form), answer] for form, answer in table.get("ask", ())]
    return ({**table, "ask": questions} if questions else table) if known else None


def _with_a_criterion(table):
    """A table that asks of a run only what is noticed has to ask something else of it, too: that it is over in the turtle's time."""
    return table if "do" not in table or RUN_CRITERIA & set(table) else {**table, "teleports": 0}


@contextmanager
def _fast():
    """In the block virtual time passes as fast as the machine computes, though a page has slowed it down or paused it."""
    pace = kernel.pace()
    speed, paused = pace.speed, pace.paused
    if not pace.virtual:
        yield
        return
    pace.set_speed(None)
    pace.resume()
    try:
        yield
    finally:
        pace.set_speed(speed)
        if paused:
            pace.pause()


def _looks(table):
    return not any(kind in table for kind in ("do", "ask", "tests", "source"))


def _tried(exercise: Exercise, check: Check, seed: int, evaluate, language, tell_call):
    work, values = job(exercise, check, seed, {})
    reports = []

    def tell(kind, **facts):
        reports.append(schema.line(work["nonce"], kind, facts))

    made = _Evaluator(evaluate, work["turtle_time"])
    recording = Recording(tuple(work["start"]), work["troubles"], seed)
    if check.kind == "do":
        simulator = running_simulator()
        if simulator is None:
            return [NO_TURTLE]
        simulator.reset()
        recording.watch()
    debugger = conditions.install_debugger(None)  # an error belongs to the verdict
    try:
        with _fast():
            carry_out(work, Path(), tell, made, recording)
    finally:
        conditions.install_debugger(debugger)
        recording.stop()
    if made.interrupted:
        raise Interruption
    told = Told(reports, work["nonce"])
    if told.error and told.doing == "before":
        return [f"{told.what} cannot be used:\n{told.error['text']}"]
    judge = judging.of_answers if check.kind == "ask" else judging.of_run
    wrong = [_plainer(_worded(sentence, language)) for sentence in said(judge(check, work, values, told), answers=True)]
    wrong = [sentence.replace(_TOO_LONG, f"did not come to its end in {work['turtle_time']:.0f} seconds.") for sentence in wrong]
    wrong = [_COMMANDS.sub(r"\1 reached the turtle before the plan was over", sentence) for sentence in wrong]
    if not wrong or check.kind != "do":
        return wrong[: 1 if _ERROR in "".join(wrong[:1]) else MOST_ANSWERS]
    if tell_call and not _is_missing(wrong) and not any(work["do"] in sentence for sentence in wrong):
        wrong.append(f"The check called {work['do']}, {_place(work['start'])}.")
    return [*wrong, *_other_drivers(language)]


def _place(start):
    """Where the turtle was when a check began, in words."""
    x, y, heading = start
    return f"with the turtle at x {x:.1f}, y {y:.1f}, looking to {math.degrees(heading):.0f} degrees"


def _other_drivers(language):
    """What to say of other nodes that may drive the turtle, too, such as the demonstration that draws squares.

    The arrow keys of the session are not meant: ``(turtlesim:press ...)`` of a page leaves their node behind, and it drives only
    when it is told to.
    """
    topic = graph.active().topics.get("/turtle1/cmd_vel")
    for publication in topic.visible_publications if topic is not None else ():
        node = publication.node
        if node is not graph.active().lisp_node and not isinstance(getattr(node, "program", None), Teleop):
            end = f"rosnode kill {node.name}" if language == "lisp" else f"type (in-package :cl-user), and then rosnode kill {node.name}"
            yield f"The node {node.name} may drive the turtle, too. End it: {end}"


def _worded(sentence, language):
    """A sentence with true, false, and a name that is missing, as the ``language`` writes them."""
    if language == "lisp":
        return sentence
    sentence = _MANGLED.sub(lambda found: hy.unmangle(found[0]), sentence)
    if (missing := _MISSING_IN_HY.search(sentence)) is not None and (name := missing[1].replace("_", "-")) in sentence:
        sentence = f"{sentence[: missing.start(1)]}{name}{sentence[missing.end(1) :]}"
    return _LISP_VALUE.sub(lambda match: match[1] + {"NIL": "None", "T": "True"}[match[2]], sentence)


def _plainer(sentence):
    """A sentence for a student who has not defined what is asked for; any other ``sentence`` as it is."""
    match = _MISSING.match(sentence)
    if match is None:
        return sentence
    missing = (match["hy"] or match["lisp"].rpartition(":")[2]).lower().replace("_", "-")
    form = match["form"].lower().replace("_", "-")
    if not re.search(rf"(?<![\w*-]){re.escape(missing)}(?![\w*-])", form):
        return sentence  # the name stands in something that the form calls
    called = match["sort"] == "function" if match["sort"] else re.search(rf"\({re.escape(missing)}[\s)]", form)
    return _no_function(missing) if called else f"There is no variable {missing} yet."


def _no_function(name):
    return f"There is no function {name} yet."


def missing_name(sentences: list[str]) -> str | None:
    """The name without a meaning that is the cause of a verdict, in a form of the check or in what that calls; else ``None``."""
    match = _SAID.search("\n".join(sentences[:1]))
    return next(filter(None, match.groups())).rpartition(":")[2].lower() if match is not None else None


def _is_missing(wrong):
    return bool(wrong) and _NOT_YET.fullmatch(wrong[0]) is not None


def _failed(wrong):
    """Whether a form of the check ended with an error. Then a hint about what the turtle should do is no help."""
    return bool(wrong) and _ERROR in wrong[0]


# ------------------------------------------------------------------------------------------------------------------- as it is


class _Now:
    """The paper and the turtle as they are, for the judges that else look at a `Replay`. What came first nobody knows any more."""

    pen_late = False

    def __init__(self, simulator):
        self.simulator = simulator
        self.begun = self.place()

    def drawing(self):
        """As `Replay.drawing`."""
        return [(tuple(colour), [(x1, y1), (x2, y2)]) for x1, y1, x2, y2, colour, _ in self.simulator.canvas.strokes()]

    def widths(self):
        """As `Replay.widths`."""
        return sorted({width for *_, width in self.simulator.canvas.strokes()})

    def place(self, name="turtle1"):
        """As `Replay.place`."""
        turtle = self.simulator.turtles.get(name)
        return None if turtle is None else tuple(turtle.pose()[:3])


def _as_it_is(table):
    """What is wrong with the paper and the turtle as they are."""
    simulator = running_simulator()
    if simulator is None:
        return [NO_TURTLE]
    return said(judging.of_place(table, {}, _Now(simulator)), answers=True)
