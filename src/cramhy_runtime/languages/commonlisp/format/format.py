"""``format``: text from a control string and arguments.

`format_` is Lisp's function, `format_to_string` the one for Python callers. A control string is parsed once
(``format_parser.py``), then each use walks over its directives with a `State`: where the output goes and which
argument is next. What each directive does is in ``format_directives.py`` and the modules that it names. Source: ANSI
22.3.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Cons, FreshString, LispString, MultipleValues, list_from, one, python_list
from ..collections.characters import character_name
from ..streams.streams import OutputStream, StringOutputStream, output_stream, standard_output
from .format_parser import Directive, FormatError, parse
from .format_templates import filled, template


class UpAndOut(BaseException):
    """``~^`` (and, with ``colon``, ``~:^``): ends the innermost enclosing construct."""

    def __init__(self, colon=False):
        self.colon = colon


class State:
    """One walk over a control: ``stream``, and the arguments ``args`` of which ``position`` is the next.

    block: the logical block whose list the arguments are. rest: inside ``~:{``, how many sublists follow this one,
    else ``None``. colon_up: whether ``~:^`` is allowed. outer: the state around, for arguments taken by enclosing
    constructs.
    """

    __slots__ = ("stream", "args", "position", "block", "rest", "colon_up")

    def __init__(self, stream, args, position=0, block=None, rest=None, colon_up=False):
        self.stream, self.args, self.position = stream, args, position
        self.block, self.rest, self.colon_up = block, rest, colon_up

    def on(self, stream):
        """A walk over the same arguments with output to ``stream``."""
        return State(stream, self.args, self.position, self.block, self.rest, self.colon_up)

    def next(self, directive, offset=None):
        """The next argument."""
        if self.position >= len(self.args):
            if self.block is not None and not self.block.exhausted:
                self.block.pop()  # a dotted tail: it is printed, and the block is left
            elif self._tail is not None:
                return type_error(self._tail, "LIST")
            return directive.complain("No more arguments", offset)
        if self.block is not None:
            self.block.pop()
        self.position += 1
        return self.args[self.position - 1]

    @property
    def exhausted(self):
        if self.position < len(self.args):
            return False
        return self._tail is None if self.block is None else self.block.exhausted

    @property
    def remaining(self):
        if self._tail is not None:
            return type_error(self._tail, "LIST")
        return len(self.args) - self.position

    @property
    def _tail(self):
        """What a list of arguments ends with that is not a proper one; else ``None``."""
        return self.args.tail if self.args.__class__ is _DottedArguments else None


def run(nodes, state):
    """Carry out a parsed control."""
    for node in nodes:
        if node.__class__ is str:
            state.stream.write(node)
        elif node.handler is None:
            node.complain(f"Unknown format directive (character: {character_name(node.char)})")
        else:
            node.handler(node, state)


def format_on(stream, control, args, state=None):
    """Format to the output stream ``stream``. ``control`` is a string or a function, as ``formatter`` makes them; with
    ``state`` the arguments are taken from there.
    """
    if control.__class__ is not str:
        if callable(control):
            return _call_formatter(stream, control, args, state)
        if not isinstance(control, (str, LispString)):
            return type_error(control, "(OR STRING FUNCTION)")
        control = str(control)
    if state is None:
        state = State(stream, args)
    try:
        run(parse(control), state)
    except UpAndOut as up:
        if up.colon:
            raise
    return state


def _call_formatter(stream, function, args, state):
    left = one(function(stream, *(args if state is None else state.args[state.position :])))
    if state is not None:
        state.position = len(state.args) - len(python_list(left))
    return state


def format_(destination, control, *args):
    """``cl:format``: print to ``destination``; nil gives a string, t is ``*standard-output*``, a string with fill
    pointer grows.

    Arguments are Lisp objects. Errors: `FormatError`, when control and arguments do not fit.
    """
    if destination is None:
        return FreshString(format_to_string(control, *args))
    if destination is True:
        stream = standard_output()
    elif isinstance(destination, OutputStream):
        stream = destination
    elif isinstance(destination, LispString):
        stream = StringOutputStream(destination)
    else:
        stream = output_stream(destination)
    if control.__class__ is str:
        found = template(control)
        if found is not None and not found[2]:
            text = filled(found, args)
            if text is not None:
                stream.write(text)
                return None
    format_on(stream, control, args)
    return None


def write_text(destination, text, fresh):
    """What ``format`` does with the ``text`` that it made for ``destination``; ``fresh``: it begins a line. Its value."""
    if destination is None:
        return FreshString(text)
    if isinstance(destination, OutputStream):
        stream = destination
    elif destination is True:
        stream = standard_output()
    else:
        stream = StringOutputStream(destination) if isinstance(destination, LispString) else output_stream(destination)
    if fresh:
        stream.fresh_line()
    stream.write(text)
    return None


def format_to_string(control, *args):
    """The text that ``format`` makes of ``control`` and ``args``."""
    if control.__class__ is str:
        found = template(control)
        if found is not None:
            text = filled(found, args)
            if text is not None:
                return text
    stream = StringOutputStream()
    format_on(stream, control, args)
    return stream.text()


def formatter(control):
    """What the macro ``formatter`` becomes: a function of a stream and arguments that returns the arguments left
    over.
    """
    if not isinstance(control, str):
        return type_error(control, "STRING")
    parse(control)

    def formatting(stream, *args):
        state = format_on(output_stream(stream), control, args)
        return list_from(args[state.position :])

    return formatting


def list_arguments(directive, arg):
    """The elements of the list ``arg`` as arguments; a type-error when it is no list."""
    if arg is None:
        return ()
    if isinstance(arg, Cons):
        return _elements(directive, arg)
    return type_error(arg, "LIST")


class _DottedArguments(list):
    """Arguments from a list that ends with ``tail`` instead of nil. Asking for one more is a type-error."""

    def __init__(self, items, tail):
        super().__init__(items)
        self.tail = tail


def _elements(directive, cell):
    items, slow = [], cell
    while isinstance(cell, Cons):
        items.append(cell.car)
        cell = cell.cdr
        if len(items) % 2 == 0:
            slow = slow.cdr
            if slow is cell and cell is not None:
                directive.complain("The list of arguments is circular")
    return items if cell is None else _DottedArguments(items, cell)


__all__ = [
    "Directive",
    "FormatError",
    "State",
    "UpAndOut",
    "format_",
    "format_on",
    "format_to_string",
    "formatter",
    "run",
    "MultipleValues",
]
LISP_NAMES = "format formatter"
