"""The stream behind pretty printing: it decides, line by line, where to break.

`PrettyStream` keeps what was written in a buffer, with a queue of the operations asked for (newlines, indentations,
starts and ends of blocks), and gives lines away as soon as it can decide about them: a section fits on the line or
does not, or more must be seen first. This is XP, Waters' algorithm of ANSI 22.2, as SBCL 2.2.9 carries it out
(``src/code/pprint.lisp``, public domain), decision for decision, because the recorded answers of the course show its
line breaks. What users of it call is in ``pretty.py``.
"""

from __future__ import annotations

from ..streams.streams import OutputStream
from . import print_controls as controls

DEFAULT_LINE_LENGTH = 80


class _Op:
    """Something queued: ``kind`` says what, ``posn`` where in all the text that was written to the stream."""

    __slots__ = ("kind", "posn", "depth", "section_end", "block_end", "prefix", "suffix", "amount", "style", "increment")

    def __init__(self, kind, posn, depth=0, style=None, amount=0, increment=0, prefix=None, suffix=""):
        self.kind, self.posn, self.depth, self.style = kind, posn, depth, style
        self.amount, self.increment, self.prefix, self.suffix = amount, increment, prefix, suffix
        self.section_end = self.block_end = None


class _Block:
    """A logical block whose start was given away: where it is on the line, and what stands before and after its
    lines.
    """

    __slots__ = ("start_column", "section_column", "per_line_prefix_end", "prefix_length", "suffix_length", "section_start_line")

    def __init__(self, column=0, per_line_prefix_end=0, prefix_length=0, suffix_length=0, line=0):
        self.start_column = self.section_column = column
        self.per_line_prefix_end = per_line_prefix_end
        self.prefix_length, self.suffix_length, self.section_start_line = prefix_length, suffix_length, line


class LineLimit(BaseException):
    """Unwinds to the owner of the pretty stream when ``*print-lines*`` lines are full."""

    def __init__(self, stream):
        self.stream = stream


class PrettyStream(OutputStream):
    """A stream over ``target`` that breaks lines where it must. Positions count all text written, columns those of a
    line.
    """

    lisp_name = "SB-PRETTY::PRETTY-STREAM"
    is_pretty = True

    def __init__(self, target):
        self.target = target
        self.line_length = controls.PRINT_RIGHT_MARGIN.value or target.line_length or DEFAULT_LINE_LENGTH
        self.print_lines = None if controls.PRINT_READABLY.value is not None else controls.PRINT_LINES.value
        self.buffer = ""
        self.offset = 0  # position of the start of the buffer
        self.start_column = target.column
        self.line_number = 0
        self.blocks = [_Block()]
        self.prefix = ""
        self.suffix = ""
        self.queue = []
        self.pending = []
        self.open_blocks = []  # the `pretty.Block` of each logical block whose body is running
        self.tabs = 0

    # text

    @property
    def column(self):
        return self._column(len(self.buffer))

    def write(self, text):
        if "\n" not in text:
            self.buffer += text
            return
        first, *lines = text.split("\n")
        self.buffer += first
        for line in lines:
            self.newline("literal")
            self.buffer += line

    def fresh_line(self):
        # SBCL's pretty streams do not know their column, and so always start a new line.
        self.write("\n")
        return True

    def flush(self):
        self.target.flush()

    # operations

    def newline(self, kind):
        depth = len(self.pending)
        op = _Op("newline", self.offset + len(self.buffer), depth, kind)
        for entry in self.queue:
            if entry.section_end is None and entry.kind in ("newline", "start") and depth <= entry.depth:
                entry.section_end = op
        self.queue.append(op)
        self._decide(kind in ("literal", "mandatory"))

    def indent(self, relative_to, amount):
        self.queue.append(_Op("indent", self.offset + len(self.buffer), style=relative_to, amount=amount))

    def tab(self, kind, column, increment):
        self.tabs += 1
        self.queue.append(_Op("tab", self.offset + len(self.buffer), style=kind, amount=column, increment=increment))

    def start_block(self, prefix="", suffix="", per_line=False):
        if prefix:
            self.write(prefix)
        op = _Op("start", self.offset + len(self.buffer), len(self.pending), prefix=prefix if per_line else None, suffix=suffix)
        self.queue.append(op)
        self.pending.append(op)

    def end_block(self):
        start = self.pending.pop()
        start.block_end = op = _Op("end", self.offset + len(self.buffer))
        self.queue.append(op)
        if start.suffix:
            self.write(start.suffix)

    def finish(self):
        """Give away all that is left."""
        self._decide(False)
        self._expand_tabs(None)
        self.target.write(self.buffer)
        self.buffer = ""

    # decisions

    def _decide(self, force):
        queue = self.queue
        while queue:
            op = queue[0]
            kind = op.kind
            if kind == "newline":
                style = op.style
                if style == "miser":
                    breaks = self._misering()
                elif style == "fill":
                    breaks = self._misering() or self.line_number > self.blocks[-1].section_start_line
                    if not breaks:
                        fits = self._fits(op.section_end, force)
                        if fits is None:
                            return
                        breaks = not fits
                else:
                    breaks = True
                if breaks:
                    self._output_line(op)
            elif kind == "start":
                fits = self._fits(op.section_end, force)
                if fits is None:
                    return
                if fits:  # the whole block fits: nothing in it needs a decision
                    self._expand_tabs(op.block_end)
                    del queue[: queue.index(op.block_end) + 1]
                    continue
                self._really_start_block(op)
            elif kind == "indent":
                if not self._misering():
                    start = self.blocks[-1].start_column if op.style == "block" else self._column(op.posn - self.offset)
                    self._set_indentation(start + op.amount)
            elif kind == "end":
                self._really_end_block()
            else:
                self._expand_tabs(op)
            del queue[0]

    def _misering(self):
        width = controls.PRINT_MISER_WIDTH.value
        return width is not None and self.line_length - self.blocks[-1].start_column <= width

    def _fits(self, until, force):
        """Whether the text up to the operation ``until`` fits on the line; ``None`` when more must be seen to know."""
        available = self.line_length
        if self.print_lines is not None and self.print_lines == self.line_number:
            available -= 3 + self.blocks[-1].suffix_length  # room for " .." and what closes the blocks
        if until is not None:
            return self._column(until.posn - self.offset) <= available
        if force or self._column(len(self.buffer)) > available:
            return False
        return None

    def _output_line(self, until):
        literal = until.style == "literal"
        consumed = until.posn - self.offset
        text = self.buffer[:consumed]
        self.target.write(text if literal else text.rstrip(" "))
        block = self.blocks[-1]
        self.line_number += 1
        if self.print_lines is not None and self.line_number >= self.print_lines:
            self.target.write(" ..")
            if block.suffix_length:
                self.target.write(self.suffix[len(self.suffix) - block.suffix_length :])
            raise LineLimit(self)
        self.target.write("\n")
        self.start_column = 0
        length = block.per_line_prefix_end if literal else block.prefix_length
        self.buffer = self.prefix[:length].ljust(length) + self.buffer[consumed:]
        self.offset += consumed - length
        if not literal:
            block.section_column = length
            block.section_start_line = self.line_number

    def _really_start_block(self, op):
        outer = self.blocks[-1]
        column = self._column(op.posn - self.offset)
        block = _Block(column, outer.per_line_prefix_end, outer.prefix_length, outer.suffix_length, self.line_number)
        self.blocks.append(block)
        self._set_indentation(column)
        if op.prefix is not None:
            block.per_line_prefix_end = column
            start = column - len(op.prefix)
            self.prefix = self.prefix[:start].ljust(start) + op.prefix + self.prefix[column:]
        if op.suffix:
            self.suffix = op.suffix + self.suffix[len(self.suffix) - block.suffix_length :]
            block.suffix_length += len(op.suffix)

    def _really_end_block(self):
        old = self.blocks.pop().prefix_length
        new = self.blocks[-1].prefix_length
        if new > old:
            self.prefix = self.prefix[:old].ljust(new) + self.prefix[new:]

    def _set_indentation(self, column):
        block = self.blocks[-1]
        current = block.prefix_length
        column = max(block.per_line_prefix_end, column)
        if column > current:
            self.prefix = self.prefix[:current].ljust(column) + self.prefix[column:]
        block.prefix_length = column

    # columns and tabs

    def _column(self, index):
        """The column of the character ``index`` of the buffer."""
        column = self.start_column
        if not self.tabs:
            return column + index
        section = self.blocks[-1].section_column
        end = self.offset + index
        for op in self.queue:
            if op.posn >= end:
                break
            if op.kind == "tab":
                column += _tab_size(op, section, column + op.posn - self.offset)
            elif op.kind in ("newline", "start"):
                section = column + op.posn - self.offset
        return column + index

    def _expand_tabs(self, through):
        """Turn the tabs up to the operation ``through`` into spaces; it and those before it then leave the queue."""
        if not self.tabs:
            return
        column, section = self.start_column, self.blocks[-1].section_column
        pieces, taken, added = [], 0, 0
        for op in self.queue:
            index = op.posn - self.offset
            if op.kind == "tab":
                self.tabs -= 1
                size = _tab_size(op, section, column + index)
                if size:
                    pieces += [self.buffer[taken:index], " " * size]
                    taken = index
                    column, added = column + size, added + size
            elif op.kind in ("newline", "start"):
                section = column + index
            if op is through:
                break
        if added:
            pieces.append(self.buffer[taken:])
            self.buffer = "".join(pieces)
            self.offset -= added


def _tab_size(op, section_start, column):
    """The number of spaces that the tab ``op`` makes at ``column``."""
    kind, wanted, increment = op.style, op.amount, op.increment
    position = column - section_start if kind.startswith("section") else column
    if kind.endswith("relative"):
        excess = (position + wanted) % increment if increment > 1 else 0
        return wanted + (increment - excess if excess else 0)
    if position < wanted:
        return wanted - position
    return increment - (position - wanted) % increment if increment else 0
