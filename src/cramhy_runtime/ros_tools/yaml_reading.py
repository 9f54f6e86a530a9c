"""The YAML that one types after ``rosservice call`` and ``rostopic pub``, and that lies in files of parameters.

Flow style, ``{linear: {x: 1.0}}`` and ``[1, 2]``, and block style, as completion in a shell leaves it, with nested mappings, lists and
literal texts. Words mean what YAML 1.1 lets them mean, so ``yes`` is true and ``010`` is eight, as for the ROS tools. Anchors, tags and
several documents in one text are no part of it, and are refused with their line.
"""

from __future__ import annotations

import re


class YamlError(ValueError):
    """Text that is no value. The text says where, and why."""


_SPACE = re.compile(r"\s*")
_KEY = re.compile(r"""("(?:[^"\\]|\\.)*"|'(?:[^']|'')*'|[^\s\[\]{}"',#&*!|>%@`-][^#]*?|-[^\s#][^#]*?)\s*:(?:\s+|$)""")
_PLAIN = re.compile(r"[^\[\]{},\s](?:[^\[\]{},:\s]|:(?![\s,\]}]|$)|[ \t]+(?![#\s]))*")
_DOUBLE = re.compile(r'"((?:[^"\\]|\\.)*)"', re.S)
_SINGLE = re.compile(r"'((?:[^']|'')*)'", re.S)
_ESCAPE = re.compile(r"\\(x[0-9a-fA-F]{2}|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|\s*\n\s*|.)", re.S)
_ESCAPES = {"0": "\0", "a": "\a", "b": "\b", "t": "\t", "n": "\n", "v": "\v", "f": "\f", "r": "\r", "e": "\x1b", "_": "\xa0"}
_INTEGER = re.compile(r"[-+]?(?:0b[01_]+|0x[0-9a-f_]+|\d[\d_]*)$", re.I)
_FLOAT = re.compile(r"[-+]?(?:\d[\d_]*\.[\d_]*|\._*\d[\d_]*|\d[\d_]*)(?:e[-+]?\d+)?$", re.I)
_WORDS = {
    **dict.fromkeys(("true", "yes", "on"), True),
    **dict.fromkeys(("false", "no", "off"), False),
    **dict.fromkeys(("null", "~", ""), None),
}
_SPECIAL = {".nan": float("nan"), ".inf": float("inf"), "+.inf": float("inf"), "-.inf": float("-inf")}
_REFUSED = {"&": "an anchor", "*": "an alias", "!": "a tag", "%": "a directive", "@": "@", "`": "`"}


def read(text):
    """The value of ``text``: None, a truth value, number, text, list or dict. Raises `YamlError`."""
    try:
        return _Block(text).value()
    except RecursionError:
        raise YamlError("the value is nested too deeply") from None


def scalar(text):
    """The value of one plain word."""
    lower = text.lower()
    if lower in _WORDS:
        return _WORDS[lower]
    if lower in _SPECIAL:
        return _SPECIAL[lower]
    if _INTEGER.match(text):
        digits = lower.replace("_", "")
        sign = -1 if digits[0] == "-" else 1
        digits = digits.lstrip("+-")
        base = {"0x": 16, "0b": 2}.get(digits[:2]) or (8 if len(digits) > 1 and digits[0] == "0" and digits.isdigit() else 10)
        try:
            return sign * int(digits[2:] if digits[:2] in ("0x", "0b") else digits, base)
        except ValueError:  # 089, a list of digits that is no octal number, is a float; a number of a million digits is none
            pass
    return float(text.replace("_", "")) if _FLOAT.match(text) else text


class _Flow:
    """A value in flow style, read from ``text``; ``line`` is where it begins."""

    def __init__(self, text, line):
        self.text, self.line, self.at = text, line, 0

    def fail(self, problem):
        before = self.text[: self.at]
        raise YamlError(f"line {self.line + before.count(chr(10))}, column {self.at - (before.rfind(chr(10)) + 1) + 1}: {problem}")

    def skip(self):
        while True:
            self.at = _SPACE.match(self.text, self.at).end()
            if self.text[self.at : self.at + 1] != "#":
                return self.text[self.at : self.at + 1]
            end = self.text.find("\n", self.at)
            self.at = len(self.text) if end < 0 else end

    def whole(self):
        value = self.value()
        if self.skip():
            self.fail(f"something follows the value: {self.text[self.at : self.at + 20]}")
        return value

    def value(self, inside=""):
        mark = self.skip()
        if mark == "[":
            return self.sequence()
        if mark == "{":
            return self.mapping()
        if mark in ('"', "'"):
            return self.quoted(mark)
        if mark in _REFUSED:
            self.fail(f"{_REFUSED[mark]} cannot be used here")
        if not mark or mark in ",]}":
            if not inside:
                return None
            return None if mark in (",", inside) else self.fail(f"a value or {inside} is missing")
        pattern = _PLAIN if inside else re.compile(r"(?:(?!\s#).)+", re.S)
        found = pattern.match(self.text, self.at)
        if not found:
            self.fail(f"{mark} where a value should be")
        self.at = found.end()
        return scalar(" ".join(found.group().split()))

    def quoted(self, mark):
        found = (_DOUBLE if mark == '"' else _SINGLE).match(self.text, self.at)
        if not found:
            self.fail(f"the {mark} is never closed")
        self.at = found.end()
        body = re.sub(r"[ \t]*\n[ \t]*(\n[ \t]*)*", lambda gap: "\n" * (gap.group().count("\n") - 1) or " ", found.group(1))
        return _ESCAPE.sub(_unescape, body) if mark == '"' else body.replace("''", "'")

    def sequence(self):
        start, items = self.at, []
        self.at += 1
        while True:
            mark = self.skip()
            if mark == "]":
                self.at += 1
                return items
            if not mark:
                self.at = start
                self.fail("the [ is never closed")
            items.append(self.value("]"))
            self.separator("]")

    def mapping(self):
        start, items = self.at, {}
        self.at += 1
        while True:
            mark = self.skip()
            if mark == "}":
                self.at += 1
                return items
            if not mark:
                self.at = start
                self.fail("the { is never closed")
            key = self.value("}")
            if self.skip() == ":":
                self.at += 1
                items[_key(key)] = self.value("}")
            else:
                self.fail("a mapping is written {key: value}, with a space after the colon")
            self.separator("}")

    def separator(self, end):
        mark = self.skip()
        if mark == ",":
            self.at += 1
        elif mark and mark != end:
            self.fail(f"a comma or {end} is missing before {self.text[self.at : self.at + 20]}")


class _Block:
    """A text in block style: its lines as (indentation, content, number), comments and empty lines left out."""

    def __init__(self, text):
        self.raw = text.expandtabs().splitlines()
        self.lines = []
        for number, line in enumerate(self.raw, 1):
            bare = line.strip()
            if bare and not bare.startswith("#"):
                self.lines.append((len(line) - len(line.lstrip()), bare, number))
        if self.lines and self.lines[0][1] == "---":
            del self.lines[0]
        while self.lines and self.lines[-1][1] == "...":
            del self.lines[-1]
        self.at = 0

    def fail(self, problem, number=None):
        raise YamlError(f"line {number or self.lines[min(self.at, len(self.lines) - 1)][2]}: {problem}")

    def value(self):
        if not self.lines:
            return None
        found = self.node(-1)
        if self.at < len(self.lines):
            self.fail(f"{self.lines[self.at][1][:30]!r} fits to nothing above it; is its indentation right?")
        return found

    def node(self, outer):
        """The value of the lines that are indented more than ``outer``."""
        indent, content, number = self.lines[self.at]
        if content == "-" or content.startswith("- "):
            return self.sequence(indent)
        if _KEY.match(content):
            return self.mapping(indent)
        return self.inline(content, number, outer)

    def sequence(self, indent):
        items = []
        while self.at < len(self.lines):
            here, content, number = self.lines[self.at]
            if here != indent or not (content == "-" or content.startswith("- ")):
                if here > indent:
                    self.fail(f"{content[:30]!r} is indented more than the items of its list")
                break
            inner = content[1:].lstrip()
            if inner and not inner.startswith("#"):
                self.lines[self.at] = (here + len(content) - len(inner), inner, number)
                items.append(self.node(here))
            else:
                self.at += 1
                items.append(self.node(here) if self.deeper(here) else None)
        return items

    def mapping(self, indent):
        items = {}
        while self.at < len(self.lines):
            here, content, number = self.lines[self.at]
            found = _KEY.match(content)
            if here != indent or not found:
                if here > indent or here == indent and not (content == "-" or content.startswith("- ")):
                    self.fail(f"a mapping is written key: value, with the keys below each other, but here is {content[:30]!r}")
                break
            key = _Flow(found.group(1), number).whole()
            rest = content[found.end() :]
            if rest and not rest.startswith("#"):
                items[_key(key)] = self.inline(rest, number, indent)
            else:
                self.at += 1
                below = self.deeper(indent) or self.deeper(indent - 1) and self.lines[self.at][1].startswith("-")
                items[_key(key)] = self.node(indent - 1) if below else None
        return items

    def deeper(self, indent):
        return self.at < len(self.lines) and self.lines[self.at][0] > indent

    def inline(self, content, number, outer):
        """A value that begins on this line, and may go on over the lines that are indented more than ``outer``."""
        self.at += 1
        if content[0] in "|>":
            return self.literal(content, number, outer)
        while self.deeper(outer) and (content[0] in "[{\"'" or not _KEY.match(self.lines[self.at][1])):
            content += "\n" * (self.lines[self.at][2] - number - content.count("\n")) + self.lines[self.at][1]
            self.at += 1
        return _Flow(content, number).whole()

    def literal(self, content, number, outer):
        style, keep = content[0], content[1:2]
        if not re.fullmatch(r"[|>][-+]?(\s+#.*)?", content):
            self.fail(f"{content!r} is not understood; a text over several lines begins with | or >", number)
        end = number
        while end < len(self.raw) and (not self.raw[end].strip() or len(self.raw[end]) - len(self.raw[end].lstrip()) > outer):
            end += 1
        body = self.raw[number:end]
        while self.at < len(self.lines) and self.lines[self.at][2] <= end:
            self.at += 1
        margin = min((len(line) - len(line.lstrip()) for line in body if line.strip()), default=0)
        text = "\n".join(line[margin:] for line in body)
        if style == ">":
            text = re.sub(r"(?<=\S)\n(?=\S)", " ", text)
        bare = text.rstrip("\n")
        return bare if keep == "-" or not bare else text + "\n" if keep == "+" else bare + "\n"


def _key(key):
    return key if isinstance(key, str) else "null" if key is None else str(key).lower() if isinstance(key, bool) else str(key)


def _unescape(found):
    code = found.group(1)
    if code[0] in "xuU" and len(code) > 1:
        number = int(code[1:], 16)
        return chr(number) if number < 0x110000 else "\ufffd"
    return _ESCAPES.get(code, "" if code.isspace() and "\n" in code else code)
