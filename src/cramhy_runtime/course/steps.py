"""The steps of a page in the terminal. Each fits a terminal of 24 rows of 80 columns, with the prompt below it.

A page has texts, and parts to do something with: code to type, files, tasks. A step has some text and at most one part. Where that is more
than the terminal has rows, it becomes several steps: text between two paragraphs, code between two forms, a file between two definitions.
Where the cuts are does not depend on the terminal that somebody has, so the numbers of the steps are the same for all.
"""

from __future__ import annotations

import re
from dataclasses import replace

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, NamedTuple

from . import shown, slips
from .parts import Code, File, Page, Task, Text, Typed, text_in

if TYPE_CHECKING:
    from collections.abc import Iterator

ROWS, COLUMNS = 24, 80
MOST = ROWS - 6
"""Rows of a step for its text and its part: beside them stand the heading, what to type next, the prompt, and rows between them."""
LONGEST_ANSWER = 12
"""Rows of an answer; a longer one is shown without its middle."""
_STYLE = shown.Style(COLUMNS - 1)
_LOG = re.compile(r"(?:^\[\([A-Z].*\) INFO\].*\n){3,}", re.M)
_SHORT_LOG = "[... some lines of the log]\n"
"""What a step shows in the place of many lines of the log; they come when the form is typed."""
ERROR = ("debugger invoked", "Traceback (most recent", "cramhy: ")
"""In the answer of a form that a page shows to fail."""
_MARKS = re.compile(r"^ +[\^~]{40,}\n", re.M)
"""A line of a traceback that marks a whole long line above it, which a step shows broken."""
_MARKS_OF_LONG = re.compile(rf"^(.{{{COLUMNS - 4},}}\n) *[\^~]+\n", re.M)
"""A line that is broken, and the line of marks below it, which would stand under other words."""
_OF_DEBUGGER = re.compile(r"\d+\] ")
_BLOCKS = re.compile(r"^```.*?^```$|(?:^(?!```)[^\n]+\n?)+", re.M | re.S)
_COMMENT = re.compile(r"^<!--.*?-->\n?", re.M | re.S)
_A_NEW_STEP = 1000
"""What a cut costs, where cuts are chosen. Beside it, rows that stay empty cost their square, so steps become equally long."""


class Piece(NamedTuple):
    """A part of a file: which one it is, of how many, and its text."""

    number: int
    count: int
    text: str


class Step(NamedTuple):
    """What is shown at once: texts (Markdown), and then perhaps a part to do something with. piece: of the file, if that is the part."""

    texts: tuple[str, ...]
    part: Code | File | Task | None
    piece: Piece | None = None


def steps(page: Page, language: str) -> list[Step]:
    """The steps of a page for those who learn in ``language``. Code and files of the other language are left out."""
    found: list[Step] = []
    texts: list[str] = []
    for part in page.parts:
        if isinstance(part, Text):
            texts += _blocks(text_in(part.markdown, language))
        elif isinstance(part, Task) or getattr(part, language):
            found += _fitting(texts, part, language)
            texts = []
    if texts or not found:
        unsolved = len(page.tasks) + 1  # what the last step tells beside
        found += _of_texts(texts, MOST - unsolved)
    return found


def answer_shown(typed: Typed) -> str:
    """The answer of a form as a step shows it: without many lines of the log, and without the middle of a long one."""
    answer = _MARKS_OF_LONG.sub(r"\1", _MARKS.sub("", _LOG.sub(_SHORT_LOG, typed.answer)))
    most = min(LONGEST_ANSWER, MOST - _rows(f"{typed.prompt}{typed.form}"))
    if not answer or _rows(answer) <= most:
        return answer
    lines = answer.splitlines(True)
    first = next((number for number, line in enumerate(lines) if line.startswith(ERROR)), 0)
    begin = [f"[... {first} lines more when you type it]\n"] if first > 2 else lines[:first]
    number = first
    while number < len(lines) - 1 and _rows("".join([*begin, lines[number]])) <= most - 2:
        begin.append(lines[number])
        number += 1
    left = len(lines) - number - 1
    middle = [f"[... {left} lines more when you type it]\n"] if left else []
    return "".join([*begin, *middle, lines[-1]])


def session_shown(part: Code, language: str) -> str:
    """The forms of a step, each with its prompt and its answer."""
    worded = slips.in_words_of_lisp if language == "lisp" else slips.in_words_of_hy
    return "".join(f"{each.prompt}{each.form}\n{worded(answer_shown(each))}" for each in getattr(part, language))


# ------------------------------------------------------------------------------------------------------------------ where cuts are


def _blocks(markdown: str) -> list[str]:
    """Paragraphs and blocks of code, each with what belongs before it: a heading, or a sentence that ends in a colon."""
    found: list[str] = []
    markdown = _COMMENT.sub("", markdown)
    for block in (part for match in _BLOCKS.finditer(markdown) for part in _parts_of_block(match[0].strip("\n"))):
        before = found[-1] if found else ""
        both = f"{before}\n\n{block}"
        if before.rsplit("\n\n", 1)[-1].startswith("#") or (before.endswith(":") and _height(shown.text(both, _STYLE)) <= MOST):
            found[-1] = both
        else:
            found.append(block)
    return found


def _parts_of_block(block: str) -> list[str]:
    """A paragraph, or a block of code in pieces that are not too high."""
    if not block.startswith("```") or block.count("\n") < MOST // 2:
        return [block]
    first, *lines = block.split("\n")
    pieces = _between_definitions("\n".join(lines[:-1]), MOST - 2)
    return [f"{first}\n{piece.rstrip()}\n```" for piece in pieces]


def _between_definitions(text: str, most: int) -> list[str]:
    """A text of code in pieces of at most ``most`` rows, cut at empty lines: between forms, and in a form that is too high by itself."""
    blocks = []
    for block in re.split(r"\n\n+(?=\S)", text.strip("\n")):
        blocks += [block] if _rows(block) <= most else re.split(r"\n\n+", block)
    heights = [_rows(block) + 1 for block in blocks]
    return ["\n\n".join(blocks[start:end]) + "\n" for start, end in _cuts(heights, most + 1)]


def _height(*texts: str) -> int:
    """Rows of what is shown one below the other, with an empty row between."""
    return sum(text.count("\n") + 2 for text in texts) - 1 if texts else 0


def _of_texts(texts: list[str], most: int = MOST) -> list[Step]:
    heights = [_height(shown.text(text, _STYLE)) + 1 for text in texts]
    return [Step(tuple(texts[start:end]), None) for start, end in _cuts(heights, most + 1)]


def _fitting(texts: list[str], part: Code | File | Task, language: str) -> Iterator[Step]:
    """The steps of ``texts`` and the ``part`` below them."""
    if isinstance(part, File):
        yield from _of_file(texts, part, language)
        return
    if isinstance(part, Task) and _height(task_shown(part, language, _STYLE)) > MOST:
        title, *paragraphs = f"**Task: {part.title}**", *_blocks(text_in(part.markdown, language))
        yield from _of_texts([*texts, f"{title}\n\n{paragraphs[0]}", *paragraphs[1:]])
        texts, part = [], replace(part, markdown="")
    units = [part] if isinstance(part, Task) else [replace(part, **{language: group}) for group in _groups(getattr(part, language))]
    heights = [_height(shown.text(text, _STYLE)) + 1 for text in texts]
    for unit in units:
        heights.append(_height(task_shown(unit, language, _STYLE)) + 1 if isinstance(unit, Task) else _rows(session_shown(unit, language)))
    for start, end in _cuts(heights, MOST + isinstance(part, Task)):
        own = units[max(0, start - len(texts)) : max(0, end - len(texts))]
        yield Step(tuple(texts[start:end]), _together(own, language))


def _rows(code: str) -> int:
    return shown.code(code, _STYLE).count("\n") + 1


def _together(units, language):
    if len(units) < 2:
        return units[0] if units else None
    return replace(units[0], **{language: tuple(typed for unit in units for typed in getattr(unit, language))})


def _groups(typed: tuple[Typed, ...]) -> list[tuple[Typed, ...]]:
    """The forms, each with what is typed into the debugger that it opens."""
    found: list[list[Typed]] = []
    for each in typed:
        if found and _OF_DEBUGGER.match(each.prompt):
            found[-1].append(each)
        else:
            found.append([each])
    return [tuple(group) for group in found]


def _of_file(texts, part, language):
    name, text = getattr(part, language)
    parts = _between_definitions(text, MOST - 1)
    pieces = [Piece(number, len(parts), each) for number, each in enumerate(parts, 1)]
    before = [shown.text(each, _STYLE) for each in texts]
    if texts and _height(*before, file_shown(name, pieces[0], _STYLE)) <= MOST:
        yield Step(tuple(texts), part, pieces.pop(0))
    elif texts:
        yield from _of_texts(texts)
    for piece in pieces:
        yield Step((), part, piece)


def _cuts(heights: list[int], most: int) -> list[tuple[int, int]]:
    """Where to cut things of these heights, so that those of a step are together at most ``most`` high: (start, end) of each step.

    There are as few steps as can be, and they are as equally high as can be. A thing that is too high by itself is a step.
    """
    best: list[tuple[float, int]] = [(0, 0)]
    for end in range(1, len(heights) + 1):
        choices, height = [], 0
        for start in range(end - 1, -1, -1):
            height += heights[start]
            if height > most and start < end - 1:
                break
            choices.append((best[start][0] + _A_NEW_STEP + (most - height) ** 2, start))
        best.append(min(choices))
    found, end = [], len(heights)
    while end:
        start = best[end][1]
        found.append((start, end))
        end = start
    return found[::-1]


# -------------------------------------------------------------------------------------------------------------------- how parts look


def file_shown(name: str, piece: Piece, style: shown.Style) -> str:
    """A piece of a file, with its name above."""
    which = f", part {piece.number} of {piece.count}" if piece.count > 1 else ""
    return f"{style.bold(f'The file {name}{which}')}\n{shown.code(piece.text, style)}"


def task_shown(task: Task, language: str, style: shown.Style, solved: bool = False) -> str:
    """A task, and the code to begin with."""
    found = [style.bold(f"Task: {task.title}{' (solved)' if solved else ''}")]
    if task.markdown:
        found.append(shown.text(text_in(task.markdown, language), style))
    if language in task.start:
        begin = "Begin with this (:type types it, and the arrow key up brings it back):"
        found += [begin, shown.code(task.start[language], style)]
    return "\n\n".join(found)


__all__ = ["Piece", "Step", "answer_shown", "file_shown", "session_shown", "steps", "task_shown"]
