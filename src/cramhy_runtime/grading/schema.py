"""What a process of a submission tells the grader: one schema, and every number, list and text in it has its bounds.

A message is a line: the job's secret, and JSON. The process is not trusted, so nothing looks at a message before `read` has found it good.
`Malformed` says what is wrong with one; it costs the submission that sent it, and nobody else.

The facts of each kind stand in `SCHEMA`. A number is finite but where a turtle was told it: a division such as 0/0 is a mistake of honest
students, too, and they are told so.
"""

from __future__ import annotations

import json
import math

MOST_TEXT = 4000
"""Characters of a text. Values and errors are cut off at half of that where they come from."""
MOST_LINE = 400_000
"""Characters of a message. No honest one is longer: commands come in parts (`PART`)."""
MOST_MESSAGES = 5000
PART = 500
"""So many commands are in one message at most."""
MOST_HEARD = 100_000
MOST_TICKS = 300_000
"""More than an hour of the turtle, the longest that an exercise may ask for."""
LARGEST = 1e15
_COUNTS = {"command": 3, "set_pen": 5, "teleport_absolute": 3, "teleport_relative": 2, "spawn": 3, "kill": 0, "clear": 0, "reset": 0}
"""What reaches a simulator, with how many numbers."""


class Malformed(ValueError):
    """A message that no process of ours sends. Its text says what is wrong, for the student."""


def line(nonce, kind, facts):
    """A message as text. nonce: the job's secret. kind, facts: see `SCHEMA`."""
    return f"{nonce} {json.dumps({'kind': kind, **facts})}"


def read(text):
    """(kind, facts) of the JSON of a message. Raises `Malformed`."""
    if len(text) > MOST_LINE:
        raise Malformed(f"a message is longer than {MOST_LINE} characters")
    try:
        facts = json.loads(text)
    except (ValueError, RecursionError, MemoryError):
        raise Malformed("a message is not JSON")
    kind = facts.pop("kind", None) if isinstance(facts, dict) else None
    wanted = SCHEMA.get(kind) if isinstance(kind, str) else None
    if wanted is None:
        raise Malformed("a message has no kind")
    if set(facts) != set(wanted):
        raise Malformed(f"a message of the kind {kind} has other entries than {', '.join(wanted) or 'none'}")
    for name, good in wanted.items():
        if not good(facts[name]):
            raise Malformed(f"in a message of the kind {kind} the entry {name} is wrong")
    return kind, facts


def is_text(value):
    """Whether it is a text that is short enough."""
    return isinstance(value, str) and len(value) <= MOST_TEXT


def is_whole(most):
    """A test whether a value is a whole number from 0 to ``most``."""
    return lambda value: isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= most


def is_finite(value):
    """Whether it is a number that is neither endless nor not-a-number, and not huge."""
    return is_number(value) and -LARGEST <= value <= LARGEST


def is_number(value):
    """Whether it is a number that a float can be, or not-a-number, or endless."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return isinstance(value, float) or -LARGEST <= value <= LARGEST


def is_list(most, good):
    """A test whether a value is a list of at most ``most`` elements, all of which are ``good``."""
    return lambda value: isinstance(value, list) and len(value) <= most and all(map(good, value))


def _is_heard(entry):
    """Whether ``entry`` is [tick, kind, turtle, numbers...], something that reached a simulator."""
    if not isinstance(entry, list) or len(entry) < 3 or not isinstance(entry[1], str) or entry[1] not in _COUNTS:
        return False
    tick, kind, turtle, *numbers = entry
    if not is_whole(MOST_TICKS)(tick) or not (isinstance(turtle, str) and len(turtle) <= 200) or len(numbers) != _COUNTS[kind]:
        return False
    if kind == "set_pen":
        return all(map(is_whole(255), numbers))
    return all(map(is_number, numbers))


def not_finite(entry):
    """The first number of an entry of ``heard`` that is not finite, as text; ``None`` if all are."""
    for number in entry[3:]:
        if not math.isfinite(number):
            return "not a number (NaN)" if number != number else "endless"
    return None


def _is_result(value):
    return (
        isinstance(value, dict)
        and set(value) == {"name", "passed", "text"}
        and is_text(value["name"])
        and isinstance(value["passed"], bool)
        and is_text(value["text"])
    )


_texts = is_list(64, is_text)
SCHEMA = {
    "held": {"locks": is_list(32, is_text)},
    "stage": {"doing": lambda value: value in STAGES, "what": lambda value: isinstance(value, str) and len(value) <= 20_000},
    "error": {"types": is_list(40, is_text), "text": is_text},
    "value": {"values": _texts},
    "answer": {"values": _texts},
    "took": {"seconds": lambda value: is_finite(value) and value >= 0},
    "faults": {"happened": is_list(100, lambda value: isinstance(value, bool))},
    "heard": {"entries": is_list(PART, _is_heard)},
    "run": {"ticks": is_whole(MOST_TICKS), "begin": is_whole(MOST_TICKS), "end": is_whole(MOST_TICKS)},
    "used": {"what": lambda value: value in USES, "name": is_text},
    "tests": {"results": is_list(500, _is_result)},
    "tampered": {"text": is_text},
    "done": {},
}
"""The kinds of messages, and a test of each entry. ``stage``: what is done now. ``value``, ``took``: of ``do``. ``heard``: what reached the
simulator. ``run``: ticks of the simulator, when the plan began and when it ended. ``used``: see `USES`."""
STAGES = ("load", "before", "do", "ask", "tests")
USES = ("python", "code", "inside", "node", "simulator", "parameter", "publication", "service", "function")
"""What a submission can do to the world beside commands and services of a turtle (`allowances`)."""
