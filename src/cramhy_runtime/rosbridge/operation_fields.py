"""Reading the fields of an operation, which a client may have given any value of JSON."""

from __future__ import annotations

from .hub import Refused
from .parsing import json_type

LARGEST = 2**31


def shown(value):
    """VALUE in a status message: short, whatever it is."""
    if value.__class__ is str:
        return repr(value if len(value) <= 60 else value[:60] + "…")
    return json_type(value) if value.__class__ not in (int, float) else repr(value)[:60]


def boolean(operation, key):
    """A truth value that may be missing."""
    value = operation.get(key)
    if value is not None and value.__class__ is not bool:
        raise Refused(f'"{key}" must be true or false, but it is {json_type(value)}.')
    return bool(value)


def integer(operation, key, least=0):
    """A whole number that may be missing: then ``None``."""
    value = operation.get(key)
    if value is None:
        return None
    if value.__class__ is float and value.is_integer():
        value = int(value)
    if value.__class__ is not int or not least <= value < LARGEST:
        raise Refused(f'"{key}" must be a whole number from {least} on, but it is {shown(value)}.')
    return value
