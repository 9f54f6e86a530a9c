"""Indentation as Emacs indents Lisp. Only the white space at the beginning of lines, and at their ends, is changed."""

from __future__ import annotations

from .texts import Token

_BODY_AT = (
    (0, "progn try finally do locally"),
    (1, "<- with-failure-handling with-retry-counters let let* flet labels macrolet symbol-macrolet lambda when unless dolist dotimes"),
    (1, "case ecase ccase typecase etypecase block catch eval-when prog1 handler-case handler-bind restart-case with-open-file"),
    (1, "return-from while for fn except with defpackage defsystem do-symbols with-output-to-string"),
    (2, "defun defmacro defmethod defgeneric defclass do* multiple-value-bind destructuring-bind with-slots with-accessors"),
    (2, "with-fields deftype defn define-condition"),
)
_BODY = {name: count for count, names in _BODY_AT for name in names.split()}
_ALIGNED = frozenset(("if", "and", "or", "setf", "setq", "setv", "cond", "loop", "import", "require"))
_LOOP_BODIES = frozenset(("do", "doing", "initially", "finally"))
_LOOP_CONDITIONS = frozenset(("when", "if", "unless"))
_LOOP_CLAUSES = (
    _LOOP_BODIES
    | _LOOP_CONDITIONS
    | frozenset(
        """for as with repeat while until always never thereis collect collecting append appending nconc nconcing count counting sum summing
    maximize maximizing minimize minimizing return named""".split()
    )
)
_CLAUSED = frozenset(("handler-case", "restart-case"))
_FIVE = frozenset(("unwind-protect",))
_LOCAL_FUNCTIONS = frozenset(("flet", "labels", "macrolet"))


def indented(text, body_start, first=0, last=None):
    """[(start, end, new)] of the white space that changes in the lines from ``first`` to ``last`` (counted from 0, included).

    body_start: a function of the name of an operator, which gives how many of its arguments stand before its body, or ``None``.
    """
    changes, columns = [], {}  # columns: line → how far its beginning has moved
    inside = _strings(text)
    for line, start in enumerate(text.starts):
        end = text.starts[line + 1] if line + 1 < len(text.starts) else len(text.text)
        content = text.text[start:end].rstrip("\r\n")
        blank = len(content) - len(content.lstrip(" \t"))
        columns[line] = 0
        if last is not None and line > last:
            break
        if start in inside or line < first:
            continue
        stripped = content.rstrip(" \t")
        if start + len(content) not in inside and len(stripped) < len(content):
            changes.append((start + len(stripped), start + len(content), ""))
        if not stripped:
            continue
        if stripped.lstrip().startswith(";;;"):
            continue
        wanted = _column(text, start + blank, line, columns, body_start)
        if wanted is not None and content[:blank] != " " * wanted:
            changes.append((start, start + blank, " " * wanted))
            columns[line] = wanted - blank
    return sorted(changes)


class _Inside:
    """Whether an offset stands in a string or a block comment."""

    def __init__(self, ranges):
        self.ranges = ranges
        self.at = 0

    def __contains__(self, offset):
        while self.at < len(self.ranges) and self.ranges[self.at][1] <= offset:
            self.at += 1
        return self.at < len(self.ranges) and self.ranges[self.at][0] < offset


def _strings(text):
    return _Inside([(t.start, t.end) for t in text.tokens if t.kind == "string" or t.kind == "comment" and t.text.startswith("#|")])


def _column(text, offset, line, columns, body_start):
    around = text.around(offset)
    if not around:
        return 0
    form = around[0]
    outer = around[1] if len(around) > 1 else None
    base, first = _now(text, form.start, columns), form.items[0] if form.items else None
    before = [item for item in form.items if item.start < offset]
    if len(before) > 1 and outer is not None and outer.word(0).lower() == "defpackage":
        aligned = _keyword_before(text, offset, before)
        return _now(text, (aligned or before[1]).start, columns)
    if not before or text.text[form.start] != "(" or not _is_name(first) or _is_data(text, form, around):
        return base + 1 if not before else _now(text, before[0].start, columns)
    name = first.text.lower().rpartition(":")[2]
    arguments = [item for item in before[1:] if not (isinstance(item, Token) and item.kind == "quote")]
    if outer is not None and outer.word(0).lower().rpartition(":")[2] in _CLAUSED and form in outer.items[2:]:
        return base + (2 if arguments else 4)
    if name in _FIVE:
        return base + (5 if not arguments else 2)
    if name == "loop" and arguments:
        return base + 2 if _words_only(text, arguments, line) else _in_loop(text, offset, form, arguments, columns, base)
    if name not in _ALIGNED:
        count = _count(name, first.text, form, outer, body_start)
        if count is not None:
            return base + (2 if len(arguments) >= count else 4)
    aligned = _keyword_before(text, offset, arguments)
    if aligned is not None:
        return _now(text, aligned.start, columns)
    if arguments and text.place(before[1].start)[0] == text.place(form.start)[0]:
        return _now(text, before[1].start, columns)
    return base + 1


def _keyword_before(text, offset, arguments):
    """The first of the keyword arguments right before a line that begins with a keyword, too; ``None`` if there is none."""
    found, rest = None, list(arguments)
    while text.text[offset] == ":" and len(rest) > 1 and isinstance(rest[-2], Token) and rest[-2].text.startswith(":"):
        found = rest[-2]
        rest = rest[:-2]
    return found


def _in_loop(text, offset, form, arguments, columns, base):
    """The column of a line in a ``loop`` with clauses, or of a form in one without."""
    first = arguments[0]
    if not isinstance(first, Token):
        same = text.place(first.start)[0] == text.place(form.start)[0]
        return _now(text, first.start, columns) if same else base + 2
    words = [number for number, item in enumerate(arguments) if isinstance(item, Token) and item.kind == "word"]
    if text.text[offset] in "(\"'`#":  # a form of a body
        last = arguments[words[-1] + 1 :] if words else []
        if last and arguments[words[-1]].text.lower().lstrip(":") in _LOOP_BODIES:
            return _now(text, last[0].start, columns)
        return _now(text, first.start, columns) + 3
    clauses = [item for item in arguments if isinstance(item, Token) and item.text.lower().lstrip(":") in _LOOP_CLAUSES]
    if clauses and clauses[-1].text.lower().lstrip(":") in _LOOP_CONDITIONS:
        return _now(text, clauses[-1].start, columns) + 2
    return _now(text, first.start, columns)


def _words_only(text, arguments, line):
    """Whether all arguments of a ``loop`` before this line are one word on its first line: ``(loop do``."""
    return (
        len(arguments) == 1
        and isinstance(arguments[0], Token)
        or all(isinstance(item, Token) or text.place(item.start)[0] == line - 1 for item in arguments[1:])
        and (isinstance(arguments[0], Token) and arguments[0].text.lower() == "do")
    )


def _is_name(item):
    return isinstance(item, Token) and item.kind == "word" and not item.text.startswith((":", "#"))


def _is_data(text, form, around):
    """Whether a list is data: it is quoted, or a list of bindings or parameters."""
    if form.start and text.text[form.start - 1] in "'":
        return True
    outer = form.parent
    if outer is None or not outer.items:
        return False
    name = outer.word(0).lower().rpartition(":")[2]
    index = next((number for number, item in enumerate(outer.items) if item is form), 0)
    if name in ("let", "let*", "symbol-macrolet", "with-slots", "with-fields", "multiple-value-bind", "destructuring-bind", "lambda"):
        return index == 1
    return name in ("defun", "defmacro", "defmethod", "def-cram-function", "defclass") and index == 2


def _count(name, written, form, outer, body_start):
    holder = outer.parent if outer is not None else None
    if holder is not None and holder.word(0).lower() in _LOCAL_FUNCTIONS and len(holder.items) > 1 and holder.items[1] is outer:
        return 1
    count = _BODY.get(name)
    if count is None:
        count = body_start(written)
    if count is None and name.startswith(("def", "define-")):
        return 1
    return count


def _now(text, offset, columns):
    line, _ = text.place(offset)
    return offset - text.starts[line] + columns.get(line, 0)
