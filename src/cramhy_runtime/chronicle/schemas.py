"""What messages look like, as JSON schemas: derived from the definitions, and put into recordings so that tools can read them.

The JSON is that of ``ros/message_json.py``: a time is an object with ``secs`` and ``nsecs``, ``uint8[]`` is a text in base64, and a
number that is not finite is null.
"""

from __future__ import annotations

import json

from ..ros.definition_text import INTEGERS
from ..ros.messages import message_class_exact

_MOMENT = {"type": "object", "properties": {"secs": {"type": "integer"}, "nsecs": {"type": "integer"}}}


def schema(cls):
    """The JSON schema of the message class ``cls``, as a dict."""
    made = _object(cls)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": cls.ros_type, **made}


def schema_text(cls):
    """The same as bytes of a file; the same for the same definition."""
    return json.dumps(schema(cls), separators=(",", ":")).encode()


def _object(cls):
    return {"type": "object", "properties": {field.name: _field(field) for field in cls.fields}}


def _field(field):
    if field.is_array and field.base in ("uint8", "char"):
        return {"type": "string", "contentEncoding": "base64"}
    one = _one(field)
    if not field.is_array:
        return one
    return {"type": "array", "items": one, **({"minItems": field.length, "maxItems": field.length} if field.length else {})}


def _one(field):
    if field.base in INTEGERS:
        bits, signed = INTEGERS[field.base]
        least = -(1 << (bits - 1)) if signed else 0
        return {"type": "integer", "minimum": least, "maximum": least + (1 << bits) - 1}
    if field.base in ("float32", "float64"):
        return {"type": "number"}
    if field.base == "bool":
        return {"type": "boolean"}
    if field.base == "string":
        return {"type": "string"}
    if field.base in ("time", "duration"):
        return _MOMENT
    part = message_class_exact(field.base)
    return {"type": "object"} if part is None else _object(part)
