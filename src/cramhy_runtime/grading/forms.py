"""The forms of a text, taken apart without reading it as a program: nothing is interned, nothing runs, and a broken text gives what it has.

Common Lisp and Hy share the syntax that matters here: parentheses, strings, comments, quotes. A form is a string (a word, as it is written,
in small letters), a `Text`, or a `Group` of forms. Python is taken apart by Python, into groups with the name of the construct in front.
"""

from __future__ import annotations

import ast
import re
import warnings

_TOKEN = re.compile(
    r"""(?P<blank>\s+|;[^\n]*|\#\|(?:(?!\|\#).)*(?:\|\#|$))
    |(?P<text>"(?:\\.|[^"\\])*(?:"|$))
    |(?P<character>\#\\(?:[\w-]+|.))
    |(?P<open>\#?[(\[{])
    |(?P<close>[)\]}])
    |(?P<prefix>\#'|'|`|,@|,|~@|~|\#[+-]|\#\^|\#_|\#\*)
    |(?P<word>(?:\|[^|]*\||\\.|[^\s()\[\]{}"';`,])+)""",
    re.X | re.S,
)
MOST_NESTED = 100
"""Groups in groups; what lies deeper belongs to the one above. Nobody writes more, and a stack is not endless."""


class Text(str):
    """A string of the program."""


class Group(list):
    """Forms in parentheses. ``line``: where they begin."""

    def __init__(self, forms=(), line=0):
        super().__init__(forms)
        self.line = line


def forms_of(text, name):
    """The top-level forms of a text, a `Group`. name: of its file; ``.py`` is Python."""
    if name.endswith(".py"):
        return _forms_of_python(text)
    top = Group(line=1)
    open_groups = [top]
    line = 1
    for match in _TOKEN.finditer(text):
        kind, token = match.lastgroup, match[0]
        if kind == "open" and len(open_groups) < MOST_NESTED:
            group = Group(line=line)
            open_groups[-1].append(group)
            open_groups.append(group)
        elif kind == "close" and len(open_groups) > 1:
            open_groups.pop()
        elif kind == "text":
            open_groups[-1].append(Text(token[1:-1]))
        elif kind in ("word", "character"):
            open_groups[-1].append(token.lower())
        line += token.count("\n")
    return top


def _forms_of_python(text):
    """As `forms_of`, for Python. A text that Python cannot take apart, for whatever reason, gives the words of each line."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about the text of a stranger, such as a wrong escape
            tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):  # nested too deeply, null bytes, half surrogates, integers without end
        return Group(
            [Group(re.findall(r"\w+|[^\w\s]", line), number) for number, line in enumerate(text.splitlines(), 1) if line.strip()], 1
        )
    return Group([_of_node(node, 1) for node in tree.body], 1)


def _of_node(node, depth):
    if isinstance(node, ast.Constant):
        return Text(node.value) if isinstance(node.value, str) else _constant(node.value)
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.arg):
        return node.arg
    group = Group([type(node).__name__.lower()], getattr(node, "lineno", 0))
    if depth >= MOST_NESTED:
        group += [inner.id for inner in ast.walk(node) if isinstance(inner, ast.Name)]
        return group
    for _, value in ast.iter_fields(node):
        for part in value if isinstance(value, list) else [value]:
            if isinstance(part, ast.AST) and not isinstance(part, ast.expr_context):
                group.append(_of_node(part, depth + 1))
            elif isinstance(part, str):
                group.append(part)
    return group


def _constant(value):
    try:
        return repr(value)
    except ValueError:  # an integer, written in another base, with more digits than Python writes
        return "0"


def words_of(form):
    """All words in a form, as often as they are there."""
    if isinstance(form, Group):
        for part in form:
            yield from words_of(part)
    elif not isinstance(form, Text):
        yield form.rpartition(":")[2]


def source_faults(source, submitted):
    """What is wrong with the text of a submission, as sentences.

    source: a table with ``uses`` and ``avoids``, lists of names. submitted: the texts of the files by name.
    """
    words = {word for name, text in submitted.items() for word in words_of(forms_of(text, name))}
    wrong = [f"The program does not use {name}." for name in source.get("uses", ()) if name.lower() not in words]
    return wrong + [f"The program uses {name}, which it should do without." for name in source.get("avoids", ()) if name.lower() in words]
