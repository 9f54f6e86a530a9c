"""External formats: how characters become the bytes of a file, and what happens when they don't (ANSI 13.1.8, 21.1.1).

Names are SBCL's (``:utf-8 :latin-1 :ascii ...``); any other codec of Python may be named too. ``(:utf-8 :replacement #\\?)`` puts
a character where an error would be.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Character
from cramhy_runtime.lisp_core.printing import prin1_to_string
import codecs

from cramhy_runtime.lisp_core.conditions import StreamError, error, restart_case
from cramhy_runtime.lisp_core.data import Cons, list_from, python_list
from cramhy_runtime.lisp_core.packages import ensure_package, is_symbol, keyword, sym

_NAMES = {
    "DEFAULT": "utf-8",
    "UTF-8": "utf-8",
    "UTF8": "utf-8",
    "LATIN-1": "latin-1",
    "LATIN1": "latin-1",
    "ISO-8859-1": "latin-1",
    "ASCII": "ascii",
    "US-ASCII": "ascii",
    "UTF-16": "utf-16",
    "UTF-16LE": "utf-16-le",
    "UTF-16BE": "utf-16-be",
    "UTF-32": "utf-32",
    "UTF-32LE": "utf-32-le",
    "UTF-32BE": "utf-32-be",
}
_CANONICAL = {"utf-8": "UTF-8", "latin-1": "LATIN-1", "ascii": "ASCII"}


for _name in ("SB-INT", "SB-IMPL"):
    ensure_package(_name)
OUTPUT_NOTHING, OUTPUT_REPLACEMENT = sym("SB-IMPL::OUTPUT-NOTHING"), sym("SB-IMPL::OUTPUT-REPLACEMENT")
ATTEMPT_RESYNC, FORCE_END_OF_FILE = sym("SB-INT::ATTEMPT-RESYNC"), sym("SB-INT::FORCE-END-OF-FILE")
INPUT_REPLACEMENT = sym("SB-IMPL::INPUT-REPLACEMENT")
for _restart in (ATTEMPT_RESYNC, FORCE_END_OF_FILE):
    _restart.package.export(_restart)


class StreamEncodingError(StreamError):
    """A character that the external format has no bytes for."""

    lisp_name = "SB-INT::STREAM-ENCODING-ERROR"

    def __init__(self, stream=None, code=0, **slots):
        super().__init__(stream, **slots)
        self.code = code

    def report(self):
        shown = prin1_to_string(self.stream.external_format())
        return f"{shown} stream encoding error on {prin1_to_string(self.stream)}:\n  the character with code {self.code} cannot be encoded."


class StreamDecodingError(StreamError):
    """Bytes that mean no character in the external format."""

    lisp_name = "SB-INT::STREAM-DECODING-ERROR"

    def __init__(self, stream=None, octets=(), **slots):
        super().__init__(stream, **slots)
        self.octets = octets

    def report(self):
        shown = prin1_to_string(self.stream.external_format())
        octets = " ".join(map(str, self.octets))
        return f"{shown} stream decoding error on {prin1_to_string(self.stream)}:\n  the octet sequence #({octets}) cannot be decoded."


class ExternalFormat:
    """A codec and the character that replaces what it cannot do, if any."""

    def __init__(self, name, codec, replacement=None):
        self.name, self.codec, self.replacement = name, codec, replacement

    def designator(self):
        """The format as Lisp names it."""
        if self.replacement is None:
            return self.name
        return list_from([self.name, keyword("REPLACEMENT"), Character(self.replacement)])

    def encode(self, text, stream):
        """The bytes of ``text``. Errors: `StreamEncodingError`, with restarts that leave the character out or replace it."""
        try:
            return text.encode(self.codec)
        except UnicodeEncodeError as problem:
            head, bad, rest = text[: problem.start], text[problem.start], text[problem.start + 1 :]
            if self.replacement is not None:
                return self.encode(head + self.replacement + rest, stream)
            instead = restart_case(
                [
                    (OUTPUT_NOTHING, lambda: "", "Skip output of this character."),
                    (OUTPUT_REPLACEMENT, lambda text="?": str(getattr(text, "char", text)), "Output replacement string."),
                ],
                lambda: error(StreamEncodingError(stream, ord(bad))),
            )
            return self.encode(head + instead + rest, stream)

    def width(self, text):
        """How many bytes ``text`` takes."""
        return len(text.encode(self.codec, "replace"))


def external_format(designator):
    """The `ExternalFormat` that ``designator`` names: nil and :default are UTF-8. Errors: SIMPLE-ERROR with SBCL's text."""
    replacement, name = None, designator
    if isinstance(designator, Cons):
        name, *options = python_list(designator)
        if len(options) != 2 or options[0] is not keyword("REPLACEMENT"):
            name = keyword("(UNKNOWN OPTIONS)")
        else:
            replacement = getattr(options[1], "char", None) or str(options[1])
    text = "DEFAULT" if name is None else name.name if is_symbol(name) and name is not True else str(name).upper()
    codec = _NAMES.get(text)
    if codec is None:
        try:
            found = codecs.lookup(text)
            codec = found.name if found._is_text_encoding else None
        except LookupError:
            codec = None
    if codec is None:
        return error("Undefined external-format: ~S", designator)
    return ExternalFormat(keyword(_CANONICAL.get(codec, text)), codec, replacement)
