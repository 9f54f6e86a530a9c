"""From an operation to what goes over the wire: JSON, CBOR, PNG, or the bytes of ROS 1 in CBOR; and fragments of what is long.

A message on a topic that many clients listen to is a `Parcel`: it is turned into JSON once, by whoever sends it first, and the others
send the same text. That happens in the server's thread. Messages on the graph are never changed once they are sent, so it may read them.
"""

from __future__ import annotations

import base64
import io
import json
import math

from ..ros.message_json import to_json

COMPRESSIONS = ("none", "png", "cbor", "cbor-raw")
TYPED_ARRAYS = {
    "uint8": 64,
    "char": 64,
    "byte": 72,
    "int8": 72,
    "uint16": 69,
    "uint32": 70,
    "uint64": 71,
    "int16": 77,
    "int32": 78,
    "int64": 79,
    "float32": 85,
    "float64": 86,
}
"""The tags of RFC 8746 for arrays of numbers, little-endian."""


def text_of(operation):
    """The JSON of an operation. What is no finite number is null, as in rosbridge."""
    return json.dumps(operation, separators=(",", ":"), allow_nan=False)


def png_of(text):
    """The operation "png" that holds TEXT: its bytes as the pixels of a picture, in base64."""
    from PIL import Image

    data = text.encode()
    width = max(1, math.isqrt(len(data) // 3))
    height = math.ceil(len(data) / 3 / width)
    picture = Image.frombytes("RGB", (width, height), data.ljust(width * height * 3, b"\n"))
    file = io.BytesIO()
    picture.save(file, "PNG")
    return text_of({"op": "png", "data": base64.b64encode(file.getvalue()).decode("ascii")})


def fragments_of(text, size, identity):
    """TEXT as operations "fragment" with SIZE characters each; TEXT alone when it is no longer than that."""
    if size is None or len(text) <= size:
        return [text]
    total = -(-len(text) // size)
    return [
        text_of({"op": "fragment", "id": identity, "data": text[number * size : (number + 1) * size], "num": number, "total": total})
        for number in range(total)
    ]


def cbor_of(operation):
    """The bytes of an operation in CBOR; raises ImportError when the package is not installed."""
    import cbor2

    return cbor2.dumps(operation)


def encoded(operation, compression):
    """The text or the bytes of an operation, for the compression "none", "png" or "cbor"."""
    if compression == "cbor":
        return cbor_of(operation)
    return png_of(text_of(operation)) if compression == "png" else text_of(operation)


_varying: dict[type, tuple] = {}


def weight(message):
    """About how many bytes the texts and arrays of MESSAGE take; 0 when its type has none."""
    fields = _varying.get(message.__class__)
    if fields is None:
        fields = _varying[message.__class__] = tuple(
            field for field in message.fields if field.is_array or field.base == "string" or not field.primitive
        )
    total = 0
    for field in fields:
        value = getattr(message, field.attribute)
        if field.is_array and hasattr(value, "__len__"):
            total += 8 * len(value)
            if field.base == "string" or not field.primitive:
                total += sum(map(_weight, value))
        else:
            total += _weight(value)
    return total


def _weight(value):
    if value.__class__ is str:
        return len(value)
    return weight(value) if hasattr(value, "fields") else 0


class Parcel:
    """A message of a topic on its way to clients; each form of it is made once."""

    __slots__ = ("topic", "message", "stamp", "weight", "_forms")

    def __init__(self, topic, message, stamp=0.0):
        self.topic, self.message, self.stamp, self.weight = topic, message, stamp, weight(message)
        self._forms = {}

    def form(self, compression):
        """Text or bytes, for the compression "none", "png", "cbor" or "cbor-raw"."""
        found = self._forms.get(compression)
        if found is None:
            found = self._forms[compression] = getattr(self, "_" + compression.replace("-", "_"))()
        return found

    def _none(self):
        return text_of({"op": "publish", "topic": self.topic, "msg": to_json(self.message)})

    def _png(self):
        return png_of(self.form("none"))

    def _cbor(self):
        from ..ros.message_cbor import to_cbor_data

        return cbor_of({"op": "publish", "topic": self.topic, "msg": to_cbor_data(self.message)})

    def _cbor_raw(self):
        from ..ros.serialization import serialize

        nanoseconds = round(self.stamp * 1e9)
        message = {"secs": nanoseconds // 10**9, "nsecs": nanoseconds % 10**9, "bytes": serialize(self.message)}
        return cbor_of({"op": "publish", "topic": self.topic, "msg": message})
