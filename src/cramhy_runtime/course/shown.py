"""Markdown of the course's pages as text for a terminal: paragraphs are filled, and marks become bold or go.

Only what the pages use is understood: headings, paragraphs, lists, tables, blocks of code, pictures, links, emphasis and code in a line.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
import textwrap

from cramhy_runtime.kernel.terminals import draws

WIDEST = 96
"""Columns of the widest text; longer lines are hard to read."""
_BLOCK = re.compile(r"^```[^\n]*\n(.*?)^```$", re.M | re.S)
_ITEM = re.compile(r"([*-]|\d+\.) +")
_PICTURE = re.compile(r"!\[([^\]]*)\]\([^)]*\)")
_LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
_STRONG, _EMPHASIS = re.compile(r"\*\*([^*]+)\*\*"), re.compile(r"(?<![\w*`])\*([^*\s][^*]*)\*(?![\w*])")
_CODE = re.compile(r"`([^`]+)`")
BOLD, CODE, PLAIN = "\x1b[1m", "\x1b[36m", "\x1b[0m"


class Style:
    """How text is shown. width: columns. colours: whether the terminal understands them."""

    def __init__(self, width: int = WIDEST, colours: bool = False):
        self.width, self.colours = width, colours

    @classmethod
    def of_terminal(cls) -> Style:
        """What standard output is. The variable NO_COLOR turns colours off (https://no-color.org)."""
        columns = shutil.get_terminal_size((WIDEST, 24)).columns
        return cls(max(30, min(columns - 1, WIDEST)), draws(sys.stdout) and not os.environ.get("NO_COLOR"))

    def bold(self, text: str) -> str:
        return f"{BOLD}{text}{PLAIN}" if self.colours else text

    def code(self, text: str) -> str:
        return f"{CODE}{text}{PLAIN}" if self.colours else text


def text(markdown: str, style: Style) -> str:
    """Markdown as text. Lines have at most ``style.width`` columns, but for code and tables."""
    markdown = re.sub(r"<!--.*?-->\n?", "", markdown, flags=re.S)
    found, end = [], 0
    for match in _BLOCK.finditer(markdown):
        found += _paragraphs(markdown[end : match.start()], style)
        found.append(code(match[1], style))
        end = match.end()
    return "\n\n".join([*found, *_paragraphs(markdown[end:], style)])


_CALL = re.compile(r"\([^()\s]{1,30}(?: [^()\s]{1,20}){1,3}\)")
"""A short call in a sentence."""


def filled(line: str, style: Style) -> str:
    """A line of ours, filled to the width. A remark stays one: its further lines begin with a semicolon, too. Code stays as it is."""
    if len(line) <= style.width or line.startswith(" "):
        return line
    lead = "; " if line.startswith("; ") else ""
    kept = _CALL.sub(lambda call: call[0].replace(" ", _KEPT), line)
    return textwrap.fill(kept, style.width, subsequent_indent=lead, break_long_words=False, break_on_hyphens=False).replace(_KEPT, " ")


_MARKS_BELOW = re.compile(r"( *)([\^~]+)\s*")


def fitted(told: str, style: Style) -> str:
    """The text of an error in lines that fit the width. Of a long line with a mark below it the piece around the mark is shown."""
    found, lines = [], told.split("\n")
    for place, line in enumerate(lines):
        marks = _MARKS_BELOW.fullmatch(lines[place + 1]) if place + 1 < len(lines) else None
        if _MARKS_BELOW.fullmatch(line) and place and len(lines[place - 1]) > style.width and line.strip():
            continue  # it was shown with its line
        if len(line) <= style.width:
            found.append(line)
        elif marks is not None:
            found += _around(line, len(marks[1]), len(marks[2]), style.width)
        else:
            indent = " " * (len(line) - len(line.lstrip()))
            found.append(textwrap.fill(line, style.width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False))
    return "\n".join(found)


def _around(line, column, count, width):
    """The piece of a line around what is marked in it, and the marks."""
    indent = len(line) - len(line.lstrip())
    inside, room = line[indent:].rstrip(), width - indent - 8
    start = max(0, min(column - indent - room // 3, len(inside) - room))
    piece = inside[start : start + room]
    before, behind = ("... " if start else ""), (" ..." if start + room < len(inside) else "")
    shift = column - indent - start + len(before)
    return [
        f"{' ' * indent}{before}{piece}{behind}",
        f"{' ' * (indent + shift)}{'^' * max(1, min(count, len(piece) - (column - indent - start)))}",
    ]


def code(block: str, style: Style) -> str:
    """A block of code, indented. A line that is too long goes on below, further in."""
    found, inside = [], False
    for line in block.rstrip("\n").split("\n"):
        found += _broken(line, style.width - 4, inside)
        inside = _ends_in_a_text(line, inside)
    return "\n".join(f"    {style.code(part)}" if part else "" for part in found)


_COMMENT = re.compile(r'((?:[^";\\]|\\.|"(?:[^"\\]|\\.)*"?)*)(;*)(.*)')
"""A line of code: what stands before a comment, its semicolons, its text."""


_OF_TEXT = re.compile(r'(?:[^"\\]|\\.)*("?)')
"""What is left of a text that began on a line before, and its end."""


def _ends_in_a_text(line, inside):
    """Whether a text in double quotes is open at the end of ``line``. inside: whether one is at its beginning."""
    if inside:
        rest = _OF_TEXT.match(line)
        if not rest[1]:
            return True
        line = line[rest.end() :]
    code = _COMMENT.fullmatch(line)[1]
    return re.sub(r'#\\.|"(?:[^"\\]|\\.)*"|\\.', "", code).count('"') % 2 == 1


def _broken(line, width, inside=False):
    """A line of code in pieces of at most ``width`` columns. They end between words, so a longer word stays whole.

    A comment goes on as a comment, so that what is typed as it stands is the same code. inside: whether the line begins in a text that
    began on a line before.
    """
    if len(line) <= width:
        return [line]
    text = _OF_TEXT.match(line)[0] if inside else ""
    before, mark, comment = _COMMENT.fullmatch(line[len(text) :]).groups()
    before = text + before
    if mark:
        indent = " " * (len(before) - len(before.lstrip()))
        pieces, begin = ([], before + mark) if len(before) < width * 2 // 3 else (_broken(before.rstrip(), width, inside), indent + mark)
        lead = f"{begin} " if comment.startswith(" ") else begin
        further = f"{indent}{mark} "
        return pieces + textwrap.wrap(
            comment.strip(), width, initial_indent=lead, subsequent_indent=further, break_long_words=False, break_on_hyphens=False
        )
    longest = max(map(len, line.split()))
    further = " " * max(0, min(len(line) - len(line.lstrip()) + 4, width // 2, width - longest))
    return textwrap.wrap(line, width, subsequent_indent=further, break_long_words=False, break_on_hyphens=False)


def _paragraphs(markdown, style):
    for paragraph in re.split(r"\n\s*\n", markdown.strip("\n")):
        if paragraph.strip():
            yield _paragraph(paragraph.strip("\n"), style)


def _paragraph(paragraph, style):
    if paragraph.startswith("#"):
        return style.bold(_filled(paragraph.lstrip("# "), Style(style.width)))
    if paragraph.startswith("|"):
        return _table(paragraph, style)
    if _ITEM.match(paragraph):
        items = re.split(r"\n(?=(?:[*-]|\d+\.) )", paragraph)
        return "\n".join(_item(item, style) for item in items)
    picture = _PICTURE.fullmatch(paragraph)
    if picture:
        return _filled(f"(The picture shows: {picture[1]})", style)
    return _filled(paragraph, style)


def _item(item, style):
    mark = _ITEM.match(item)
    lead = f"  {'*' if mark[1] in '*-' else mark[1]} "
    return _filled(item[mark.end() :], style, lead, " " * len(lead))


def _table(paragraph, style):
    rows = [[_marks(cell.strip(), Style()) for cell in row.strip("|").split("|")] for row in paragraph.split("\n")]
    rows = [row for row in rows if not all(re.fullmatch(r":?-+:?", cell) for cell in row)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lead = sum(width + 2 for width in widths[:-1]) + 2  # columns before the last one, which is filled to the width
    last = max(style.width - lead, style.width // 3)
    lines = []
    for row in rows:
        first, *others = textwrap.wrap(row[-1], last, break_long_words=False, break_on_hyphens=False) or [""]
        cells = [*(cell.ljust(width) for cell, width in zip(row, widths[:-1])), first]
        lines += ["  " + "  ".join(cells).rstrip(), *(" " * lead + other for other in others)]
    return "\n".join(lines)


def _marks(line, style):
    """A line without the marks of Markdown. What was code, or strong, has the colours of the style."""
    line = _LINK.sub(r"\1", _PICTURE.sub(r"(The picture shows: \1)", line))
    pieces = re.split(r"(`[^`]+`)", line)  # stars in code are no marks
    for place, piece in enumerate(pieces):
        if place % 2:
            pieces[place] = style.code(piece[1:-1])
        else:
            pieces[place] = _EMPHASIS.sub(r"\1", _STRONG.sub(lambda match: style.bold(match[1]), piece))
    return "".join(pieces)


def _filled(paragraph, style, first="", rest=""):
    """A paragraph filled to the width. Code in it is not broken."""
    most = style.width // 2
    unbroken = _CODE.sub(lambda code: code[0].replace(" ", _KEPT) if len(code[1]) <= most else code[0], " ".join(paragraph.split()))
    plain = _marks(unbroken, Style())
    lines = textwrap.wrap(plain, style.width, initial_indent=first, subsequent_indent=rest, break_long_words=False, break_on_hyphens=False)
    lines = [line.replace(_KEPT, " ") for line in lines]
    if not style.colours:
        return "\n".join(lines)
    return _coloured("\n".join(lines), paragraph, style)


_KEPT = "\0"
"""Stands for a space at which no line ends: in code that has not more than half a line."""


def _coloured(filled, paragraph, style):
    """``filled`` with colours at the pieces that are code in ``paragraph``; line ends may have come into them."""
    start = 0
    for word in _CODE.findall(" ".join(paragraph.split())):
        match = re.compile(r"\s+".join(map(re.escape, word.split()))).search(filled, start)
        if match:
            shown = "\n".join(re.sub(r"^( *)(.*)$", lambda line: line[1] + style.code(line[2]), line) for line in match[0].split("\n"))
            filled = filled[: match.start()] + shown + filled[match.end() :]
            start = match.start() + len(shown)
    return filled
