"""What the guide says of slips of writing: single quotes, commas, an equals sign, ``true`` in Hy, a quote or brackets left out.

Some of these forms fail with a message that does not name the slip, and some give a wrong answer without a message: Hy takes ``1,57`` for
157. The sentence says what stands wrong and how it is written. It has the words of the student, and is not the answer of a task.
"""

from __future__ import annotations

import re

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

_APART = re.compile(r'"(?:[^"\\]|\\.)*"?|;[^\n]*', re.S)
"""Strings and comments, in which nothing is a slip."""
_SINGLE = re.compile(r"(?<![^\s(\[])'([^'()\[\]\"\n]*[^'()\[\]\"\s])'(?=[\s)\]]|$)")
_CURVED = re.compile('[\u201c\u201d\u201e\u00ab\u00bb]([^\u201c\u201d\u201e\u00ab\u00bb"\n]*)[\u201c\u201d\u201e\u00ab\u00bb]')
_DECIMAL = re.compile(r"(?<![\w.,'])(-?\d+),(\d+)(?![\w.,])")
_THOUSANDS = re.compile(r"-?[1-9]\d{0,2},\d{3}")
_ELEMENT = re.compile(r"(?<=[\s(])([A-Za-z][\w.-]*)\[(-?\d+)\](?=[\s)])")
_GROUP = re.compile(r"[(\[][^()\[\]]*[^\s()\[\],],(?=[\s)\]])[^()\[\]]*[)\]]|[(\[][^()\[\]]*\s,\s[^()\[\]]*[)\]]")
_COMMA = re.compile(r"[^\s()\[\],],(?=[\s)\]])")
_EQUALS = re.compile(r"\((?P<head>setv|setf|setq|defvar|defparameter)\s+(?P<name>[^\s()\[\]]+)\s+=\s+(?P<value>[^\s()\[\]]*)")
_EQUALS_IN_LET = re.compile(r"\(let\s+(?P<begin>[\[(]+)\s*(?P<name>[^\s()\[\]=]+)\s+=\s+(?P<value>[^\s()\[\]]*)")
_AS = re.compile(r"\(import\s[^()]*?(?P<module>[^\s()\[\]]+)\s+as\s+(?P<name>[^\s()\[\]]+)")
_NOT_QUOTED = re.compile(r"\((?:[\w-]+:)?prolog\s+\((?P<predicate>[^\s()\[\]]+)")
_NO_BRACKETS = re.compile(r"\((?:[\w-]+:)?def-fact-group\s+(?P<name>[^\s()\[\]]+)\s+\(\s*<-")
_CONDITION = re.compile(r"\(\?[^\s()]+\s+([<>]=?|=)\s")
_NO_ARROW = re.compile(r"\((?:[\w-]+:)?def-fact-group\s+[^\s()\[\]]+\s+(?:\[[^\]]*\]|\([^()]*\)|nil)\s*\((?!\s*(?:[\w-]+:)?<-)", re.I)
_NO_LIST = re.compile(r"\((?:[\w-]+:)?<-\s+([^\s()\[\]]+)")
_HANDLES = re.compile(r"\(with-failure-handling\b")
_LEAVES = re.compile(r"\((?:return|return-from|leave|retry|do-retry)\b")
VALUES = {"true": "True", "false": "False", "nil": "None", "null": "None", "none": "None", "TRUE": "True", "FALSE": "False", "NIL": "None"}
"""What other languages call true, false and nothing, and how Hy writes it."""


def of_form(text: str, language: str) -> str | None:
    """What to say of a form, whether it has failed or not; ``None`` if nothing in it is a slip."""
    code = _code(text)
    if found := _CURVED.search(code):
        return f'; A text stands in straight double quotes: "{found[1]}"'
    if found := _SINGLE.search(code):
        return f'; A text stands in double quotes: "{found[1]}"'
    if found := _CONDITION.search(code):
        return f"; In a condition the comparison comes first, too, as in ({found[1]} ?number 7)"
    if found := _EQUALS.search(code):
        return f"; {found['head']} takes no =: ({found['head']} {found['name']} {found['value'] or '...'})"
    if found := _EQUALS_IN_LET.search(code):
        close = {"[": "]", "(": ")"}
        ends = "".join(close[each] for each in reversed(found["begin"]))
        return f"; let takes no =: (let {found['begin']}{found['name']} {found['value'] or '...'}{ends} ...)"
    return _of_hy(code, text) if language == "hy" else None


def _code(text):
    """``text`` with nothing in its strings, and without comments; what is left keeps its place."""
    return _APART.sub(lambda found: f'"{"_" * (len(found[0]) - 2)}"' if found[0][0] == '"' else " " * len(found[0]), text)


def _of_hy(code, text):
    if found := _AS.search(code):
        return f"; A colon stands before as: {found['module']} :as {found['name']}"
    if (found := _DECIMAL.search(code)) and not _THOUSANDS.fullmatch(found[0]):
        return f"; A number has a point: {found[1]}.{found[2]}. Hy leaves the comma in {found[0]} out."
    if found := _ELEMENT.search(code):
        return f"; {found[0]} is written (get {found[1]} {found[2]}) in Hy."
    if found := _GROUP.search(code):
        group = "".join(" " if sign == "," else old for sign, old in zip(found[0], text[found.start() :]))
        return f"; Between values stand spaces, and no commas: {group[0]}{' '.join(group[1:-1].split())}{group[-1]}"
    if _COMMA.search(code):
        return "; Between values stand spaces, and no commas."
    if _EMPTY_LOOP.search(code):
        return "; This loop repeats nothing: its last parenthesis stands before the forms that it should do."
    return None


_WRITTEN = {
    "for": "(for [i (range 4)] ...): a name and the values for it stand in brackets, and the forms that are repeated behind them",
    "defn": "(defn name [arguments] ...): the names of the arguments stand in brackets, which are [] if there are none",
    "setv": "(setv name value)",
    "let": "(let [name value] ...)",
    "while": "(while condition ...)",
    "if": "(if condition this that)",
}
"""How the forms of Hy are written that beginners write otherwise."""
_MALFORMED = re.compile(r"parse error for pattern macro '(\w+)'")
_NOT_ITERABLE = re.compile(r"'(?:int|float)' object is not iterable")
_NOT_CALLABLE = re.compile(r"'\w+' object is not callable")
_NOT_A_POINT = re.compile(
    r"is not of type\s+CL-TRANSFORMS:(?:POINT|3D-VECTOR)\b|no applicable method for the generic function\s+#<\S+ CL-TRANSFORMS:[XYZ]\b"
)
_NAMES_IN_PARENTHESES = re.compile(r"\(for\s+\[\s*\(([^()]*)\)")
_CALL_OF_NUMBER = re.compile(r"\((-?\d[\d.]*)\s")
_PART_OF_FLUENT = re.compile(r"'\w*Fluent' object has no attribute '(\w+)'")
_NOT_A_FLUENT = re.compile(r"'(?:bool|int|float|NoneType)' object has no attribute 'value'")
_CALL_OF_NAME = re.compile(r"\(([^\s()\[\]\d][^\s()\[\]]*)\)")
_LOOPS = re.compile(r"\(for\s+\[")
_EMPTY_LOOP = re.compile(r"\(for\s+\[\s*[^\s()\[\]]+\s+(?:[^\s()\[\]]+|\([^()]*\))\s*\]\s*\)")


def of_error(told: str, text: str, language: str) -> str | None:
    """What to say of an error with the text ``told``, for the form ``text``: it is written otherwise, or has no point; else ``None``."""
    if _NOT_A_POINT.search(told):
        return "; A point is made by make-3d-vector, of x, y and z: (make-3d-vector 5 5 0)"
    if language != "hy":
        return None
    found = _MALFORMED.search(told)
    if found and found[1] in _WRITTEN:
        return f"; {found[1]} is written {_WRITTEN[found[1]]}."
    if (found := _NOT_CALLABLE.search(told)) and (call := _CALL_OF_NAME.search(_code(text))):
        return f"; ({call[1]}) calls {call[1]}, which is not a function. Its value is {call[1]}, without parentheses."
    if _NOT_CALLABLE.search(told) and (call := _CALL_OF_NUMBER.search(_code(text))):
        return f"; ({call[1]} ...) is a call of {call[1]}, and a number is not a function. Numbers side by side stand without parentheses."
    if found := _PART_OF_FLUENT.search(told):
        return f"; A fluent has no {found[1].replace('_', '-')}, but its value has. fl-funcall makes a fluent of a part of the value."
    if _NOT_A_FLUENT.search(told):
        return "; A value that was computed once does not change any more: it is not a fluent. fl-funcall makes one."
    if found := _NAMES_IN_PARENTHESES.search(_code(text)):
        return f"; Names for the parts of a value stand in brackets: (for [[{found[1]}] ...] ...)"
    if _NOT_ITERABLE.search(told) and _LOOPS.search(_code(text)):
        return "; A loop goes through values, and a number is one: (range 4) stands for four of them, as in (for [i (range 4)] ...)."
    return None


_TAKE_TEXTS = ("print", "princ", "prin1", "fail")


def of_text(name: str, text: str, forms: Iterable[str]) -> str | None:
    """What to say of ``name``, which means nothing in the form ``text``, if one of ``forms`` has a text in its place; else ``None``."""
    found = re.search(rf"\(([^\s()]+)\s+({re.escape(name).replace('_', '[-_]').replace(chr(92) + '-', '[-_]')})[\s)]", text, re.I)
    alone = found is not None and any(re.search(rf'\({re.escape(found[1])} "[^"]*"\)', form) for form in forms)
    if found and (found[1] in _TAKE_TEXTS or any(f'({found[1]} "' in form for form in forms)):
        return f'; A text stands in double quotes: ({found[1]} "{found[2]}"{"" if found[1] in _TAKE_TEXTS or alone else " ..."})'
    return None


def of_name(name: str, language: str, text: str = "") -> str | None:
    """What to say of a name of Hy without a value: a minus before another one, or what other languages call true, false or nothing.

    text: the form in which it stands.
    """
    if language != "hy":
        return None
    if re.match(r"-[a-zA-Z]", name):
        whole = re.search(rf"(?<![\w)]){re.escape(name)}[\w.-]*", text)
        return f"; The minus is a function, with parentheses around the call: (- {whole[0][1:] if whole else name[1:]})"
    return f"; Hy writes {VALUES[name]}." if name in VALUES else None


def of_failed_form(text: str, language: str, earlier: Iterable[str] = ()) -> str | None:
    """What to say of a form that has failed: a quote or brackets left out, or a handler without its end; else ``None``.

    earlier: what was typed on the page before, in which a function may stand that the form calls.
    """
    code = _code(text)
    if found := _NOT_QUOTED.search(code):
        return f"; A question to Prolog is not a call. A quote stands before it: (prolog '({found['predicate']} ...))"
    if found := _NO_BRACKETS.search(code):
        empty = "[]" if language == "hy" else "()"
        return (
            f"; Behind the name of the group stands a list of the predicates that the group extends, and {empty} if it extends none: "
            f"(def-fact-group {found['name']} {empty} ...)"
        )
    if _NO_ARROW.search(code):
        return "; Each fact and each rule of a group stands in a form of its own that begins with <-, as in (<- (fact ...))"
    if found := _NO_LIST.search(code):
        return f"; A fact has parentheses of its own, behind the <-: (<- ({found[1]} ...))"
    for each in (code, *(other for other in map(str, earlier) if _calls(code, other))):
        if _HANDLES.search(each) and not _LEAVES.search(_code(each)):
            leave = "(leave ...)" if language == "hy" else "(return ...)"
            return f"; A handler that comes to its end passes the failure on. {leave} in it ends the block, and (retry) begins it anew."
    return None


def _calls(code, other):
    name = re.match(r"\s*\((?:defun|defn|def-cram-function)\s+([^\s()\[\]]+)", other)
    return name is not None and re.search(rf"\({re.escape(name[1])}[\s)]", code, re.I) is not None


__all__ = ["VALUES", "of_error", "of_failed_form", "of_form", "of_name", "of_text"]
