"""The pretty printer: logical blocks, conditional newlines, indentation, tabs.

Printing a form that may not fit on the line is done by saying where lines may be broken, and under which conditions, and
letting the stream decide when it knows enough. `PrettyStream` keeps what was written in a buffer, with a queue of the
operations asked for (newlines, indentations, starts and ends of blocks), and gives lines away as they are decided. This is
XP, Waters' algorithm of ANSI 22.2, as SBCL 2.2.9 carries it out (``src/code/pprint.lisp``, public domain), decision for
decision, because the recorded answers of the course show its line breaks.

How a class of the runtime prints itself:

    def print_vector(vector, stream):                        # #<3D-VECTOR (1.0d0 2.0d0 3.0d0)>
        print_unreadable(vector, stream, body=lambda: write(vector.as_list(), stream), type_=True)

    def print_message(message, stream):                      # [VECTOR3
        with logical_block(stream, "[", "]") as out:         #    X:
            out.write(message.type_name)                     #      1.0]
            for name, value in message.fields():
                pprint_indent("block", 2, out)
                pprint_newline("mandatory", out)
                out.write(name + ":")
                pprint_indent("block", 4, out)
                pprint_newline("mandatory", out)
                output_object(value, out)

    define_printer(Message, print_message)

Kinds of newlines are given by name: "linear" breaks when the section does not fit, "fill" when the next section does not,
"miser" when room is short, "mandatory" always. Outside of a pretty-printing stream these calls do nothing, as in Lisp.
"""

from __future__ import annotations

from . import print_controls as controls
from .data import Cons
from .packages import symbol_name
from .print_controls import CIRCULARITY, PRINT_CIRCLE, PRINT_PRETTY, PRINT_READABLY, bound, check_circularity, deeper, too_deep
from .streams import BroadcastStream, OutputStream, output_stream

DEFAULT_LINE_LENGTH = 80
NO_OBJECT = object()


class _Op:
    """Something queued: ``kind`` says what, ``posn`` where in all the text that was written to the stream."""

    __slots__ = ("kind", "posn", "depth", "section_end", "block_end", "prefix", "suffix", "amount", "style", "increment")

    def __init__(self, kind, posn, depth=0, style=None, amount=0, increment=0, prefix=None, suffix=""):
        self.kind, self.posn, self.depth, self.style = kind, posn, depth, style
        self.amount, self.increment, self.prefix, self.suffix = amount, increment, prefix, suffix
        self.section_end = self.block_end = None


class _Block:
    """A logical block whose start was given away: where it is on the line, and what stands before and after its lines."""

    __slots__ = ("start_column", "section_column", "per_line_prefix_end", "prefix_length", "suffix_length",
                 "section_start_line")

    def __init__(self, column=0, per_line_prefix_end=0, prefix_length=0, suffix_length=0, line=0):
        self.start_column = self.section_column = column
        self.per_line_prefix_end = per_line_prefix_end
        self.prefix_length, self.suffix_length, self.section_start_line = prefix_length, suffix_length, line


class LineLimit(BaseException):
    """Unwinds to the owner of the pretty stream when ``*print-lines*`` lines are full."""

    def __init__(self, stream):
        self.stream = stream


class BlockExit(BaseException):
    """Unwinds to the end of a logical block: its list is exhausted, or was cut short."""

    def __init__(self, block):
        self.block = block


class PrettyStream(OutputStream):
    """A stream over ``target`` that breaks lines where it must. Positions count all text written, columns those of a line."""

    lisp_name = "SB-PRETTY::PRETTY-STREAM"
    is_pretty = True

    def __init__(self, target):
        self.target = target
        self.line_length = controls.PRINT_RIGHT_MARGIN.value or target.line_length or DEFAULT_LINE_LENGTH
        self.print_lines = None if PRINT_READABLY.value is not None else controls.PRINT_LINES.value
        self.buffer = ""
        self.offset = 0  # position of the start of the buffer
        self.start_column = target.column
        self.line_number = 0
        self.blocks = [_Block()]
        self.prefix = ""
        self.suffix = ""
        self.queue = []
        self.pending = []
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
                    del queue[:queue.index(op.block_end) + 1]
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
                self.target.write(self.suffix[len(self.suffix) - block.suffix_length:])
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
            self.suffix = op.suffix + self.suffix[len(self.suffix) - block.suffix_length:]
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


# ---------------------------------------------------------------------------------------------------------- logical blocks


def on_pretty_stream(stream, function, *arguments):
    """Call ``function(pretty_stream, *arguments)`` with ``stream``, or a pretty stream over it if it is an ordinary one."""
    if stream.is_pretty:
        function(stream, *arguments)
        return
    pretty = PrettyStream(stream)
    try:
        function(pretty, *arguments)
        pretty.finish()
    except LineLimit as limit:
        if limit.stream is not pretty:
            raise


class Block:
    """The inside of a logical block: hands out the elements of its list. What `call_logical_block` gives to its body.

    ``pop`` and ``exit_if_exhausted`` are ``pprint-pop`` and ``pprint-exit-if-list-exhausted``.
    """

    __slots__ = ("stream", "remaining", "count", "whole")

    def __init__(self, stream, obj):
        self.stream = stream
        self.whole = obj is NO_OBJECT
        self.remaining = None if self.whole else obj
        self.count = 0

    @property
    def exhausted(self):
        return self.remaining is None

    def exit_if_exhausted(self):
        """Leave the block when the list is at its end."""
        if self.remaining is None:
            raise BlockExit(self)

    def check(self):
        """Leave the block when the rest is no list, or cut off by ``*print-length*``, or was met before; that is printed."""
        remaining, stream = self.remaining, self.stream
        if not self.whole and remaining is not None and (not isinstance(remaining, Cons) or _is_backquoted(remaining)):
            self._leave(". ")
        if controls.PRINT_LENGTH.value is not None and self.count >= controls.length_limit():
            stream.write("...")
            raise BlockExit(self)
        if remaining is not None and self.count and PRINT_CIRCLE.value is not None and check_circularity(remaining, in_block=True):
            self._leave(". ")
        self.count += 1

    def _leave(self, text):
        from .printer import output_object

        self.stream.write(text)
        output_object(self.remaining, self.stream)
        raise BlockExit(self)

    def pop(self):
        """The next element; ``None`` when there is none."""
        self.check()
        cell = self.remaining
        if cell is None:
            return None
        self.remaining = cell.cdr
        return cell.car


def _is_backquoted(obj):
    from .pprint_dispatch import is_backquoted

    return is_backquoted(obj)


def call_logical_block(stream, obj, body, prefix="", suffix="", per_line=False):
    """Call ``body(pretty_stream, block)`` inside a logical block around the list ``obj`` (`NO_OBJECT` for none).

    An ``obj`` that is no list is just printed. With ``per_line`` the prefix starts every line. This is what the macro
    ``pprint-logical-block`` becomes.
    """
    on_pretty_stream(output_stream(stream), _call_block, obj, body, prefix, suffix, per_line)


def _call_block(stream, obj, body, prefix, suffix, per_line):
    if obj is not NO_OBJECT and obj is not None and (not isinstance(obj, Cons) or _is_backquoted(obj)):
        from .printer import output_object

        output_object(obj, stream)
        return
    if PRINT_CIRCLE.value is None or obj is NO_OBJECT or obj is None:
        _run_block(stream, obj, body, prefix, suffix, per_line)
    elif CIRCULARITY.value is not None:
        mark = check_circularity(obj, controls.ASSIGN, in_block=True)
        if mark is None or controls.print_mark(mark, stream):
            _run_block(stream, obj, body, prefix, suffix, per_line)
    else:
        from .printer import output_object

        state = controls.Circularity()
        with bound(CIRCULARITY, state):
            output_object(obj, BroadcastStream())
            state.counter = 0
            mark = check_circularity(obj, controls.ASSIGN, in_block=True)
            if mark is not None:
                controls.print_mark(mark, stream)
            _run_block(stream, obj, body, prefix, suffix, per_line)


def _run_block(stream, obj, body, prefix, suffix, per_line):
    if too_deep(stream):
        return
    with deeper():
        stream.start_block(prefix or "", suffix or "", per_line)
        block = Block(stream, obj)
        try:
            body(stream, block)
        except BlockExit as exit_:
            if exit_.block is not block:
                raise
        stream.end_block()


class logical_block:  # noqa: N801  a context manager, used like a function
    """``with logical_block(stream, prefix, suffix) as out:`` prints the body's output to ``out`` as one logical block.

    Too deep for ``*print-level*``, the body's output is dropped and ``#`` stands for it.
    """

    def __init__(self, stream, prefix="", suffix="", per_line=False):
        self.stream, self.prefix, self.suffix, self.per_line = output_stream(stream), prefix, suffix, per_line

    def __enter__(self):
        stream = self.stream
        self.own = None if stream.is_pretty else PrettyStream(stream)
        self.out = self.own or stream
        self.dropped = too_deep(self.out)
        self.level = deeper()
        self.level.__enter__()
        if self.dropped:
            return BroadcastStream()
        self.out.start_block(self.prefix, self.suffix, self.per_line)
        return self.out

    def __exit__(self, kind, exception, traceback):
        self.level.__exit__(kind, exception, traceback)
        if exception is None:
            try:
                if not self.dropped:
                    self.out.end_block()
                if self.own is not None:
                    self.own.finish()
            except LineLimit as limit:
                if limit.stream is not self.own:
                    raise
            return None
        return isinstance(exception, LineLimit) and exception.stream is self.own


pprint_logical_block = logical_block


# ------------------------------------------------------------------------------------------------------- what users call


def _pretty(stream):
    stream = output_stream(stream)
    return stream if stream.is_pretty and PRINT_PRETTY.value is not None else None


def _kind(designator):
    return designator if designator.__class__ is str else symbol_name(designator).lower()


def _checked(designator, *allowed):
    kind = _kind(designator)
    if kind not in allowed:
        from .conditions import type_error

        return type_error(designator, "(MEMBER " + " ".join(":" + name.upper() for name in allowed) + ")")
    return kind


def pprint_newline(kind, stream=None):
    """``pprint-newline``: a conditional newline of ``kind`` linear, fill, miser or mandatory (keyword or string)."""
    kind = _checked(kind, "linear", "fill", "miser", "mandatory")
    stream = _pretty(stream)
    if stream is not None:
        stream.newline(kind)


def pprint_indent(relative_to, n, stream=None):
    """``pprint-indent``: lines of this block start ``n`` columns right of its start ("block") or of here ("current")."""
    relative_to = _checked(relative_to, "block", "current")
    stream = _pretty(stream)
    if stream is not None:
        stream.indent(relative_to, int(n))


def pprint_tab(kind, column, increment, stream=None):
    """``pprint-tab``: go to ``column``, or on by multiples of ``increment``; kinds line, section, and both with -relative."""
    kind = _checked(kind, "line", "section", "line-relative", "section-relative")
    stream = _pretty(stream)
    if stream is not None:
        stream.tab(kind, column, increment)


def _pprint_elements(stream, lst, colon, between):
    from .printer import output_object

    def body(out, block):
        block.exit_if_exhausted()
        while True:
            output_object(block.pop(), out)
            block.exit_if_exhausted()
            out.write(" ")
            between(out)

    parentheses = ("(", ")") if colon is not None and colon is not False else ("", "")
    call_logical_block(stream, lst, body, *parentheses)


def pprint_fill(stream, lst, colon=True, at=None):
    """``pprint-fill``: the elements of ``lst``, as many on each line as fit; in parentheses unless ``colon`` is nil."""
    _pprint_elements(stream, lst, colon, _fill)


def pprint_linear(stream, lst, colon=True, at=None):
    """``pprint-linear``: the elements of ``lst`` on one line, or each on its own."""
    _pprint_elements(stream, lst, colon, _linear)


def pprint_tabular(stream, lst, colon=True, at=None, tabsize=None):
    """``pprint-tabular``: the elements of ``lst`` in columns ``tabsize`` (16) wide."""

    def between(out):
        pprint_tab("section-relative", 0, 16 if tabsize is None else tabsize, out)
        pprint_newline("fill", out)

    _pprint_elements(stream, lst, colon, between)


def _fill(out):
    if PRINT_PRETTY.value is not None:
        out.newline("fill")


def _linear(out):
    if PRINT_PRETTY.value is not None:
        out.newline("linear")


LISP_NAMES = "pprint-newline pprint-indent pprint-tab pprint-fill pprint-linear pprint-tabular"
