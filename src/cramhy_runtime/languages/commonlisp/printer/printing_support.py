"""What the macros of printing become: ``pprint-logical-block``, ``print-unreadable-object`` and their relatives.

The macros (``hy_src/cramhy/cl.hy``) only put the forms of their bodies into functions; the work is done here.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import LispString
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, sym
from ..streams.streams import STANDARD_OUTPUT, TERMINAL_IO, StringOutputStream, output_stream
from . import print_controls, printer
from .float_printing import READ_DEFAULT_FLOAT_FORMAT
from .pprint_dispatch import INITIAL, PRINT_PPRINT_DISPATCH
from .pretty import call_logical_block


def pprint_logical_block(function, stream, items, *, prefix=None, per_line_prefix=None, suffix=""):
    """Call ``function(stream)`` inside a logical block around the list ``items``; an ``items`` that is no list is printed.

    ``stream`` nil or t stands for ``*standard-output*`` or ``*terminal-io*``, which are bound to the block's stream.
    """
    if suffix is None:
        type_error(suffix, "STRING")
    for text in (prefix, per_line_prefix, suffix):
        if text is not None and not isinstance(text, (str, LispString)):
            type_error(text, "(OR STRING NULL)")
    if prefix is not None and per_line_prefix is not None:
        error("cannot specify values for both PREFIX and PER-LINE-PREFIX.")
    variable = STANDARD_OUTPUT if stream is None else TERMINAL_IO if stream is True else None

    def body(out, block):
        if variable is None:
            function(out)
        else:
            with print_controls.bound(variable, out):
                function(out)

    text = per_line_prefix if per_line_prefix is not None else prefix
    call_logical_block(stream, items, body, str(text or ""), str(suffix or ""), per_line_prefix is not None)


def _innermost(stream):
    return output_stream(stream).open_blocks[-1]


def pprint_pop(stream):
    """``pprint-pop``: the next element of the list of the innermost block on ``stream``; may leave the block."""
    return _innermost(stream).pop()


def pprint_list_exhausted(stream):
    """Whether the list of the innermost block on ``stream`` has no more elements."""
    return True if _innermost(stream).exhausted else None


def print_unreadable_object(obj, stream, body=None, *, type=None, identity=None):
    """``print-unreadable-object``: ``#<TYPE body {address}>``; the body prints to the stream that it was given."""
    printer.print_unreadable(obj, output_stream(stream), None, type is not None, identity is not None, body)


def make_fill_pointer_output_stream(string):
    """A stream that appends to ``string``, which has a fill pointer."""
    if not isinstance(string, LispString) or string.fill_pointer is None:
        from cramhy_runtime.lisp_core.conditions import type_error

        return type_error(string, "(AND STRING (SATISFIES ARRAY-HAS-FILL-POINTER-P))")
    return StringOutputStream(string)


def stream_position(stream):
    """The index of the next character of a string input stream."""
    return stream.position()


_OFF = """
*PRINT-CIRCLE* *PRINT-LENGTH* *PRINT-LEVEL* *PRINT-LINES* *PRINT-MISER-WIDTH* *PRINT-PRETTY* *PRINT-RADIX* *PRINT-RIGHT-MARGIN*
*READ-SUPPRESS*
"""


def with_standard_io_syntax(thunk):
    """``with-standard-io-syntax``: the values of ``thunk``, with the variables of reader and printer as ANSI sets them."""
    from ..reader.readtables import READTABLE, STANDARD

    controls = print_controls
    standard = {
        controls.PACKAGE: COMMON_LISP_USER,
        controls.PRINT_BASE: 10,
        controls.PRINT_CASE: controls.UPCASE,
        PRINT_PPRINT_DISPATCH: INITIAL,
        READ_DEFAULT_FLOAT_FORMAT: sym("SINGLE-FLOAT"),
        READTABLE: STANDARD,
        sym("*READ-BASE*"): 10,
    }
    for name in "*PRINT-ARRAY* *PRINT-ESCAPE* *PRINT-GENSYM* *PRINT-READABLY* *READ-EVAL*".split():
        standard[sym(name)] = True
    for name in _OFF.split():
        standard[sym(name)] = None
    with controls.bound(*(part for pair in standard.items() for part in pair)):
        return thunk()


def with_readable_input(thunk):
    """The value of ``thunk``, the debugger's dialogue: whatever the program has bound, a form can be typed and its value is shown.

    SBCL's debugger binds all variables of the reader and the printer to their standard values but for ``*package*`` and ``*print-pretty*``.
    Here the user's limits of printing stay.
    """
    from ..reader.readtables import READTABLE, STANDARD, SUPPRESS

    controls = print_controls
    with controls.bound(
        SUPPRESS, None, sym("*READ-BASE*"), 10, sym("*READ-EVAL*"), True, READTABLE, STANDARD, controls.PRINT_READABLY, None
    ):
        return thunk()
