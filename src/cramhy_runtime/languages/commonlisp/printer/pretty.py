"""The pretty printer: logical blocks, conditional newlines, indentation, tabs.

Printing a form that may not fit on the line is done by saying where lines may be broken, and under which conditions,
and letting the stream decide when it knows enough (``pretty_stream.py``). Source: ANSI 22.2; details as in SBCL
2.2.9.

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

Kinds of newlines are given by name: "linear" breaks when the section does not fit, "fill" when the next section does
not, "miser" when room is short, "mandatory" always. Outside of a pretty-printing stream these calls do nothing, as in
Lisp.
"""

from __future__ import annotations

from numbers import Real

from .components import COMPONENTS
from cramhy_runtime.kernel.active import checkpoint
from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from ..streams.streams import BroadcastStream, output_stream
from . import print_controls as controls
from .pretty_stream import LineLimit, PrettyStream
from .print_controls import CIRCULARITY, PRINT_CIRCLE, PRINT_PRETTY, bound, check_circularity, deeper, too_deep

NO_OBJECT = object()


class BlockExit(BaseException):
    """Unwinds to the end of a logical block: its list is exhausted, or was cut short."""

    def __init__(self, block):
        self.block = block


# ------------------------------------------------------------------------------------------------------- logical blocks


def on_pretty_stream(stream, function, *arguments):
    """Call ``function(pretty_stream, *arguments)`` with ``stream``, or a pretty stream over it if it is an ordinary
    one.
    """
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
        """Leave the block when the rest is no list, or cut off by ``*print-length*``, or was met before; that is
        printed.
        """
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
        self.stream.write(text)
        COMPONENTS.output_object(self.remaining, self.stream)
        raise BlockExit(self)

    def pop(self):
        """The next element; ``None`` when there is none."""
        checkpoint()
        self.check()
        cell = self.remaining
        if cell is None:
            return None
        self.remaining = cell.cdr
        return cell.car


def _is_backquoted(obj):
    """Whether ``obj`` is a backquoted form: ``(quasiquote x)``, which prints as ```x``."""
    if not isinstance(obj, Cons):
        return False
    head, rest = obj.car, obj.cdr
    return isinstance(head, Symbol) and head.name == "QUASIQUOTE" and isinstance(rest, Cons) and rest.cdr is None


def is_pair(lst):
    """Whether the list ``lst`` has two elements."""
    return isinstance(lst.cdr, Cons) and lst.cdr.cdr is None


def call_logical_block(stream, obj, body, prefix="", suffix="", per_line=False):
    """Call ``body(pretty_stream, block)`` inside a logical block around the list ``obj`` (`NO_OBJECT` for none).

    An ``obj`` that is no list is just printed. With ``per_line`` the prefix starts every line. This is what the macro
    ``pprint-logical-block`` becomes.
    """
    on_pretty_stream(output_stream(stream), _call_block, obj, body, prefix, suffix, per_line)


def _call_block(stream, obj, body, prefix, suffix, per_line):
    if obj is not NO_OBJECT and obj is not None and (not isinstance(obj, Cons) or _is_backquoted(obj)):
        COMPONENTS.output_object(obj, stream)
        return
    if PRINT_CIRCLE.value is None or obj is NO_OBJECT or obj is None:
        _run_block(stream, obj, body, prefix, suffix, per_line)
    elif CIRCULARITY.value is not None:
        mark = check_circularity(obj, controls.ASSIGN, in_block=True)
        if mark is None or controls.print_mark(mark, stream):
            _run_block(stream, obj, body, prefix, suffix, per_line)
    else:
        state = controls.Circularity()
        with bound(CIRCULARITY, state):
            COMPONENTS.output_object(obj, BroadcastStream())
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
        stream.open_blocks.append(block)
        try:
            body(stream, block)
        except BlockExit as exit_:
            if exit_.block is not block:
                raise
        finally:
            stream.open_blocks.pop()
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


# ------------------------------------------------------------------------------------------------------ what users call


def _pretty(stream):
    stream = output_stream(stream)
    return stream if stream.is_pretty and PRINT_PRETTY.value is not None else None


def _kind(designator):
    if designator.__class__ is str:
        return designator
    return symbol_name(designator).lower() if is_symbol(designator) else None


def _checked(designator, *allowed):
    kind = _kind(designator)
    if kind not in allowed:
        return type_error(designator, "(MEMBER " + " ".join(":" + name.upper() for name in allowed) + ")")
    return kind


def pprint_newline(kind, stream=None):
    """``pprint-newline``: a conditional newline of ``kind`` linear, fill, miser or mandatory (keyword or string)."""
    kind = _checked(kind, "linear", "miser", "fill", "mandatory")
    stream = _pretty(stream)
    if stream is not None:
        stream.newline(kind)


def newline_if_pretty(out, kind):
    """A conditional newline in the pretty stream ``out``, if that is what printing is now."""
    if PRINT_PRETTY.value is not None:
        out.newline(kind)


def pprint_indent(relative_to, n, stream=None):
    """``pprint-indent``: lines of the block start ``n`` columns right of its start ("block") or of here ("current")."""
    relative_to = _checked(relative_to, "block", "current")
    if not isinstance(n, Real) or n is True:
        return type_error(n, "REAL")
    stream = _pretty(stream)
    if stream is not None:
        stream.indent(relative_to, int(n))


def pprint_tab(kind, column, increment, stream=None):
    """``pprint-tab``: go to ``column``, or on by multiples of ``increment``; kinds line, section, and both with
    -relative.
    """
    kind = _checked(kind, "line", "section", "line-relative", "section-relative")
    for number in (column, increment):
        if number.__class__ is not int or number < 0:
            return type_error(number, "UNSIGNED-BYTE")
    stream = _pretty(stream)
    if stream is not None:
        stream.tab(kind, column, increment)


def _pprint_elements(stream, lst, colon, between):
    def body(out, block):
        block.exit_if_exhausted()
        while True:
            COMPONENTS.output_object(block.pop(), out)
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
