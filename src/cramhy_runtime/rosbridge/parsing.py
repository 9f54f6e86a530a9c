"""From what a client sent to an operation: strict JSON, one object a message, no deeper and no larger than allowed.

Python's parser takes more than JSON has: ``NaN`` and its kin, one key twice, numbers of any length. Whoever sends such a thing gets
told. What is told never repeats much of what was sent, since it goes back over the same wire.
"""

from __future__ import annotations

import json
import re

# A string ends at its quote or where the text ends: else each quote of a broken text would be tried anew, to its end.
_DEEPER = re.compile(r'"[^"\\]*(?:\\.[^"\\]*)*(?:"|\\?\Z)|[\[{]|[\]}]', re.S)
PART = 100  # bytes that a fragment takes beside its text
LONGEST_NUMBER = 400  # digits; a double has 309 before its point


class Malformed(ValueError):
    """A message that is no operation. ``id``: of the message, when there is one."""

    id = None


def parse(text, depth=50):
    """The operation in TEXT, a dictionary with "op"; raises `Malformed`. DEPTH: of arrays and objects in each other."""
    if not isinstance(text, str):
        raise Malformed("Binary messages are not understood here: an operation is a text message with a JSON object.")
    check_depth(text, depth)
    try:
        found = json.loads(text, parse_constant=_no_constant, parse_int=_integer, parse_float=_real)
    except RecursionError:
        raise Malformed(f"The message has arrays and objects more than {depth} deep in each other.") from None
    except Malformed:
        raise
    except ValueError as problem:
        raise Malformed(f"The message is not JSON: {getattr(problem, 'msg', problem)} at character {getattr(problem, 'pos', 0)}.") from None
    return operation(found)


def operation(found):
    """FOUND, if it is an operation: a dictionary with a string "op"."""
    if not isinstance(found, dict):
        raise Malformed(f"An operation is a JSON object, but this is {json_type(found)}.")
    op = found.get("op")
    if not isinstance(op, str):
        problem = Malformed(
            'The message has no operation: an object needs "op", a string such as "subscribe" or "publish".'
            if "op" not in found
            else f'"op" must be a string, but it is {json_type(op)}.'
        )
        problem.id = found.get("id")
        raise problem
    return found


def json_type(value):
    """What JSON calls the type of VALUE, with an article."""
    if value is None:
        return "null"
    return {bool: "a boolean", int: "a number", float: "a number", str: "a string", list: "an array", dict: "an object"}[type(value)]


def check_depth(text, limit):
    if text.count("[") + text.count("{") <= limit:
        return
    deep = 0
    for found in _DEEPER.finditer(text):
        sign = text[found.start()]
        if sign in "[{":
            deep += 1
            if deep > limit:
                raise Malformed(f"The message has arrays and objects more than {limit} deep in each other.")
        elif sign in "]}":
            deep -= 1


def _no_constant(name):
    raise Malformed(
        f"The message is not JSON: it has the number {name}, which JSON does not have. Send null for a real that is not a number."
    )


def _integer(text):
    if len(text) > LONGEST_NUMBER:
        raise Malformed(f"The message has a number of {len(text)} digits; {LONGEST_NUMBER} are allowed.")
    return int(text)


def _real(text):
    if len(text) > LONGEST_NUMBER:
        raise Malformed(f"The message has a number of {len(text)} digits; {LONGEST_NUMBER} are allowed.")
    return float(text)


class Fragments:
    """The operations "fragment" of one client, put together again when all parts of one have come, in whatever order."""

    def __init__(self, limits):
        self.limits = limits
        self._waiting = {}
        self._size = 0

    def add(self, found):
        """The whole text when FOUND was the last missing part, else ``None``; raises `Malformed`."""
        identity, data, number, total = (found.get(key) for key in ("id", "data", "num", "total"))
        if identity.__class__ not in (str, int) or len(str(identity)) > self.limits.name:
            raise Malformed(f'A fragment needs an "id", a string of at most {self.limits.name} characters.')
        if data.__class__ is not str:
            raise Malformed(f'The "data" of a fragment is a string, but here it is {json_type(data)}.')
        if total.__class__ is not int or not 0 < total <= self.limits.fragments:
            raise Malformed(f'The "total" of a fragment is a number from 1 to {self.limits.fragments}.')
        if number.__class__ is not int or not 0 <= number < total:
            raise Malformed(f'The "num" of a fragment is a number from 0 to {total - 1}, one less than "total".')
        parts = self._waiting.setdefault(identity, {"total": total})
        if parts["total"] != total:
            self._forget(identity)
            raise Malformed(f"The fragments of one message must agree on their total, but there are {parts['total']} and {total}.")
        self._size += len(data) + PART - (len(parts[number]) + PART if number in parts else 0)
        parts[number] = data
        if self._size > self.limits.reassembled or len(self._waiting) > self.limits.fragments:
            self._waiting.clear()
            self._size = 0
            raise Malformed(f"More than {self.limits.reassembled >> 20} MB of fragments wait for others; all were forgotten.")
        if len(parts) <= total:
            return None
        self._forget(identity)
        return "".join(parts[index] for index in range(total))

    def _forget(self, identity):
        parts = self._waiting.pop(identity)
        self._size -= sum(len(part) + PART for part in parts.values() if part.__class__ is str)
