"""Random values of Python for the fields of all our message types, for Hypothesis."""

import math

from hypothesis import strategies as some

from cramhy_runtime.ros import definition_files, messages
from cramhy_runtime.ros.definition_text import INTEGERS

FOLDERS = sorted(folder.name for folder in definition_files.OURS.iterdir())


def types():
    """The classes of all messages that come with cramhy."""
    return [cls for package in FOLDERS for cls in (messages.load_package(package) or ([],))[0]]


def one_nan(value):
    """``value``; all that are not a number are one object, which is equal to itself in lists and messages."""
    return math.nan if value != value else value


def values(field, finite=False):
    """Values for ``field``. finite: no infinities and no not-a-number, which JSON does not have."""
    if field.base in INTEGERS:
        bits, signed = INTEGERS[field.base]
        one = some.integers(-(1 << bits - 1), (1 << bits - 1) - 1) if signed else some.integers(0, (1 << bits) - 1)
        if field.base in ("uint8", "char") and field.is_array and not field.length:
            return some.binary(max_size=5) | some.lists(one, max_size=3)
    elif field.base in ("time", "duration"):
        one = some.integers(0, 2**31 - 1)
    elif field.primitive:
        one = {
            "bool": some.booleans(),
            "string": some.text(some.characters(exclude_categories=["Cs"]), max_size=6),
            "float32": some.floats(width=32, allow_nan=not finite, allow_infinity=not finite).map(one_nan),
            "float64": some.floats(allow_nan=not finite, allow_infinity=not finite).map(one_nan),
        }[field.base]
    else:
        one = some.deferred(lambda: made(messages.message_class_exact(field.base), finite))
    return some.lists(one, min_size=field.length, max_size=field.length or 2) if field.is_array else one


def made(cls, finite=False):
    """Messages of the class ``cls``."""
    return some.builds(cls, **{field.attribute: values(field, finite) for field in cls.fields})


def any_message(finite=False):
    """Messages of all types."""
    return some.sampled_from(types()).flatmap(lambda cls: made(cls, finite))
