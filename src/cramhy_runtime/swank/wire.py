"""The wire between Emacs and Lisp: frames with S-expressions in them.

A frame is the length of its text in bytes, six hexadecimal digits, and then the text in UTF-8. The text is one S-expression as Emacs
prints it. What comes from outside is data for this reader: it interns no symbol, evaluates nothing, and nests only so deep.
"""

from __future__ import annotations

import re

LENGTH = 6  # hexadecimal digits before a frame
DEEPEST = 200  # lists in lists; Emacs sends fewer than ten


class FrameError(ValueError):
    """Bytes that are no frame. Where the next frame begins is unknown, so the connection has to end."""


class TextError(ValueError):
    """The text of a frame is no S-expression. The next frame may be one."""


class Name(str):
    """A symbol as it is written: ``swank:connection-info``, ``:ok``. Other strings are strings of Lisp."""

    __slots__ = ()

    def __repr__(self):
        return f"Name({str(self)})"


def frame(text):
    """The bytes of the frame of ``text``. What UTF-8 cannot write, a half of a pair of surrogates, becomes a question mark."""
    data = text.encode("utf-8", "replace")
    if len(data) > 0xFFFFFF:
        raise FrameError(f"A message of {len(data)} bytes does not fit into a frame, which has room for 16 MB.")
    return b"%06x" % len(data) + data


def length_of(digits):
    """How many bytes follow the six ``digits``, bytes, of a frame. `FrameError` if they are no number."""
    if not re.fullmatch(rb"[0-9a-fA-F]{6}", digits):
        raise FrameError(f"A frame begins with its length in six hexadecimal digits, and {digits!r} came.")
    return int(digits, 16)


def text_of(data):
    """The text of a frame. `TextError` if it is no UTF-8."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as problem:
        raise TextError(f"The message is no UTF-8 (byte {problem.start} of {len(data)}).") from None


# ---------------------------------------------------------------------------------------------------------------- reading

_TOKEN = re.compile(r"""\s*(?:(?P<mark>[()'`]|,@?|\#')|"(?P<string>(?:[^"\\]|\\.)*)"|(?P<atom>(?:\\.|[^\s()"'`,;])+))""", re.S)
_NUMBER = re.compile(r"[+-]?\d+\.?$")
_FLOAT = re.compile(r"[+-]?(\d*\.\d+|\d+(\.\d*)?)([eE][+-]?\d+)?$")
_QUOTES = {"'": "quote", "`": "quote", "#'": "function", ",": "unquote", ",@": "unquote"}


def read(text):
    """The S-expression ``text``: lists become Python lists, ``nil`` None, ``t`` True, symbols `Name`. `TextError` if it is none.

    The last element of a list with a dot stands behind the `Name` ``.``.
    """
    position, stack, done = 0, [], []

    def close(value):
        # the value is complete: the quotes before it take it
        while stack and isinstance(stack[-1], _Quote):
            value = [Name(stack.pop().name), value]
        (stack[-1] if stack else done).append(value)

    while True:
        token = _TOKEN.match(text, position)
        if token is None:
            if text[position:].strip():
                raise TextError(f"The message cannot be read at its character {position + 1}.")
            break
        if done and not stack:
            raise TextError(f"Behind the message stands more, from its character {token.start() + 1} on.")
        position = token.end()
        mark = token["mark"]
        if mark == "(":
            if len(stack) >= DEEPEST:
                raise TextError(f"The message has more than {DEEPEST} lists in one another.")
            stack.append([])
        elif mark == ")":
            if not stack or isinstance(stack[-1], _Quote):
                raise TextError(f"A parenthesis closes nothing at character {position} of the message.")
            finished = stack.pop()
            close(finished or None)
        elif mark is not None:
            if len(stack) >= DEEPEST:
                raise TextError(f"The message has more than {DEEPEST} lists in one another.")
            stack.append(_Quote(_QUOTES[mark]))
        elif token["string"] is not None:
            close(re.sub(r"\\(.)", r"\1", token["string"], flags=re.S))
        else:
            close(_atom(token["atom"]))
    if stack or not done:
        raise TextError("The message ends inside of a list." if stack else "The message is empty.")
    return done[0]


class _Quote(list):
    def __init__(self, name):
        super().__init__()
        self.name = name


def _atom(text):
    if text in ("nil", "NIL"):
        return None
    if text in ("t", "T"):
        return True
    if _NUMBER.match(text):
        if len(text) > 4000:
            raise TextError("The message has a number of more than 4000 digits.")
        return int(text.rstrip("."))
    if _FLOAT.match(text):
        return float(text)
    return Name(re.sub(r"\\(.)", r"\1", text))


# ---------------------------------------------------------------------------------------------------------------- writing


def write(value):
    """``value`` as an S-expression that Emacs reads: None and False are ``nil``, True is ``t``, lists and tuples are lists."""
    if value is None or value is False:
        return "nil"
    if value is True:
        return "t"
    if isinstance(value, Name):
        return value
    if isinstance(value, str):
        return '"' + str(value).replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, (list, tuple)):
        return f"({' '.join([write(item) for item in value])})" if value else "nil"
    if isinstance(value, (int, float)):
        return str(value)
    raise TypeError(f"Emacs has nothing like {value!r}.")
