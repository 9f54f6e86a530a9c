"""The YAML that one types after ``rosservice call`` and ``rostopic pub``, and that lies in files of parameters.

PyYAML reads it (`yaml_library`); a number or a word alone needs no library. Words mean what YAML 1.1 lets them mean, so ``yes`` is true and
``010`` is eight, as for the ROS tools.
"""

from __future__ import annotations

import re


class YamlError(ValueError):
    """The text is not a value. The message says where, and why."""


_WORD = re.compile(r"[\w/.+][\w/.+-]*|-[\w/.][\w/.+-]*|", re.A)
_INTEGER = re.compile(r"[-+]?(?:0b[01_]+|0x[0-9a-f_]+|\d[\d_]*)$", re.I)
_FLOAT = re.compile(r"[-+]?(?:\d[\d_]*\.[\d_]*|\._*\d[\d_]*|\d[\d_]*)(?:e[-+]?\d+)?$", re.I)
_WORDS = {
    **dict.fromkeys(("true", "yes", "on"), True),
    **dict.fromkeys(("false", "no", "off"), False),
    **dict.fromkeys(("null", "~", ""), None),
}
_SPECIAL = {".nan": float("nan"), ".inf": float("inf"), "+.inf": float("inf"), "-.inf": float("-inf")}


def read(text):
    """The value of ``text``: None, a truth value, number, text, list or dict. Raises `YamlError`."""
    if _WORD.fullmatch(text) and text != "...":
        return scalar(text)
    from . import yaml_library  # which takes 25 ms to load

    return yaml_library.read(text)


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
