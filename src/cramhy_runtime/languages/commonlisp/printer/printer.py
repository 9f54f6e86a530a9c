"""The printer: any object as text, under the control variables of Common Lisp.

`output_object` is the way everything goes. Atoms of the common kinds are turned into text at once. Other objects are
first looked up in the pretty printer's dispatch table, if ``*print-pretty*`` is on, and else printed plainly: by the
user's ``print-object`` method (`user_methods`), by the printer that a room of the runtime has registered for the
class (`define_printer`), or as a structure, condition, function, class. What nobody knows is foreign: ``#<PYTHON
repr>``.

Printed forms, addresses included, are SBCL's. An address tells objects apart and means nothing; it is counted up when
an object is first printed, so that the same run prints the same bytes (law 5). Source: ANSI chapter 22.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.kernel.active import checkpoint
from cramhy_runtime.lisp_core.classes import class_name
import weakref
from fractions import Fraction

from cramhy_runtime.lisp_core.arrays import LispArray
from cramhy_runtime.lisp_core.conditions import PrintNotReadable, error
from cramhy_runtime.lisp_core.data import (
    UNSUPPLIED,
    WRITABLE_STRINGS,
    Character,
    Cons,
    FreshString,
    Keyword,
    LispString,
    MultipleValues,
    Symbol,
)
from cramhy_runtime.lisp_core.floats import SingleFloat
from ..streams.streams import BroadcastStream, Stream, StringOutputStream, output_stream
from cramhy_runtime.lisp_core.plain_answers import printers, printers_found
from cramhy_runtime.lisp_core.plain_answers import printer_for as nearest_printer
from cramhy_runtime.lisp_core.printing import SUPPRESS, bounded, define_printer, print_suppressed
from cramhy_runtime.kernel.looking_on import only_looked_at
from cramhy_runtime.kernel.images import Cell
from . import print_controls as controls
from .float_printing import float_text
from .pprint_dispatch import PRINT_PPRINT_DISPATCH
from .components import COMPONENTS
from .flat_lists import flat_text
from .pretty import NO_OBJECT, call_logical_block, on_pretty_stream
from .print_controls import (
    CIRCULARITY,
    PRINT_CIRCLE,
    PRINT_ESCAPE,
    PRINT_PRETTY,
    PRINT_READABLY,
    bound,
    check_circularity,
    deeper,
    length_limit,
    too_deep,
)
from .print_names import character_text, integer_text, ratio_text, string_text, symbol_text


class UserMethods:
    """The methods that users have defined on ``print-object``.

    ``print_object`` is ``None``, or a function of an object and a stream: it calls the user's method, and returns whether there is one.
    """

    __slots__ = ("print_object",)

    def __init__(self):
        self.print_object = None


user_methods = UserMethods()


def print_through(print_object):
    """Ask ``print_object(object, stream)`` from now on to call the user's methods; ``None``: there are none."""
    user_methods.print_object = print_object


_integer = int.__repr__
_SHORT = 10**18
"""Python prints smaller integers without a limit."""


def _integer_atom(number, escape):
    if controls.PRINT_BASE.value == 10 and controls.PRINT_RADIX.value is None:
        try:
            return _integer(number)
        except ValueError:
            pass
    return integer_text(number)


_ATOMS = {
    str: lambda obj, escape: string_text(obj) if escape else obj,
    **dict.fromkeys(WRITABLE_STRINGS, lambda obj, escape: string_text(str(obj)) if escape else str(obj)),
    int: _integer_atom,
    bool: symbol_text,
    type(None): symbol_text,
    Symbol: symbol_text,
    Keyword: symbol_text,
    float: lambda obj, escape: float_text(obj),
    SingleFloat: lambda obj, escape: float_text(obj),
    Fraction: lambda obj, escape: ratio_text(obj),
    Character: lambda obj, escape: character_text(obj.char) if escape else obj.char,
}
"""The text of an atom (object, whether escaped), by class: what needs neither line breaks nor a stream."""


def print_as_symbols(cls):
    """Let instances of ``cls``, a subclass of `Symbol`, be printed as symbols are."""
    _ATOMS[cls] = symbol_text


atom_text = _ATOMS.get
"""The function (object, whether escaped) that gives the text of an atom of a class; ``None`` for other classes."""


def escaping():
    """Whether objects are to be printed so that they can be read back."""
    return PRINT_ESCAPE.value is not None or PRINT_READABLY.value is not None


def output_object(obj, stream):
    """Print ``obj`` to the output stream ``stream`` under the control variables as they are."""
    text_of = _ATOMS.get(obj.__class__)
    if text_of is not None and PRINT_CIRCLE.value is None and not PRINT_PPRINT_DISPATCH.value.entries:
        stream.write(text_of(obj, escaping()))
    elif PRINT_CIRCLE.value is None or controls.identified_by_print(obj):
        _print(obj, stream)
    elif CIRCULARITY.value is not None or text_of is None:
        _print_circular(obj, stream)
    else:
        _print(obj, stream)


def _print_circular(obj, stream):
    mark = check_circularity(obj, controls.ASSIGN)
    if mark is controls.INITIATE:
        state = controls.Circularity()
        with bound(CIRCULARITY, state):
            _print_circular(obj, BroadcastStream())
            state.counter = 0
            _print_circular(obj, stream)
    elif mark is None or controls.print_mark(mark, stream):
        _print(obj, stream)


def _print(obj, stream):
    if SUPPRESS.value is None:
        _print_itself(obj, stream)
    else:
        print_suppressed(obj, stream, _print_itself)


def _print_itself(obj, stream):
    if PRINT_PRETTY.value is not None:
        layout = PRINT_PPRINT_DISPATCH.value.find(obj)
        if layout is not None:
            on_pretty_stream(stream, layout, obj)
            return
    output_ugly(obj, stream)


def output_ugly(obj, stream):
    """Print ``obj`` itself without the pretty printer's table; its components go the usual way."""
    cls = obj.__class__
    if cls is Cons:
        _print_list(obj, stream)
        return
    text_of = _ATOMS.get(cls)
    if text_of is not None:
        stream.write(text_of(obj, escaping()))
        return
    if user_methods.print_object is None or not user_methods.print_object(obj, stream):
        printer_for(cls)(obj, stream)


def standard_print_object(obj, stream):
    """The print function that applies when no user method does: what ``call-next-method`` in the last of them calls."""
    text_of = _ATOMS.get(obj.__class__)
    if obj.__class__ is Cons:
        _print_list(obj, stream)
    elif text_of is not None:
        stream.write(text_of(obj, escaping()))
    else:
        printer_for(obj.__class__)(obj, stream)


def _print_list(lst, stream):
    if too_deep(stream):
        return
    limit, count = length_limit(), 0
    with deeper():
        stream.write("(")
        while True:
            checkpoint()
            if count >= limit:
                stream.write("...")
                break
            output_object(lst.car, stream)
            lst = lst.cdr
            if lst is None:
                break
            if not isinstance(lst, Cons) or (PRINT_CIRCLE.value is not None and check_circularity(lst)):
                stream.write(" . ")
                output_object(lst, stream)
                break
            stream.write(" ")
            count += 1
        stream.write(")")


# ---------------------------------------------------------------------------------------------------- printers by class


def printer_for(cls):
    """The function that prints instances of ``cls``: that of the nearest superclass that has one."""
    found = printers_found.get(cls)
    if found is None:
        if object not in printers:
            from .standard_printers import print_python_object

            define_printer(object, print_python_object)  # and its module defines the printers of all standard classes
        found = nearest_printer(cls)
    return found


# --------------------------------------------------------------------------------------------------- unreadable objects

_addresses: dict = {}
_next_address = Cell(0x1001000040)  # of the image: what else lives in the process changes nothing that a run prints
_TAGS = {"list": 0x7, "function": 0xB, "instance": 0x3}


def address(obj):
    """The address that ``#<... {1001000003}>`` shows for ``obj``: hexadecimal digits, the same as long as ``obj``
    lives.
    """
    key = id(obj)
    known = _addresses.get(key)
    if known is not None:
        return known[0]
    if only_looked_at():
        return "?"
    kind = "list" if isinstance(obj, Cons) else "function" if callable(obj) and not isinstance(obj, type) else "instance"
    text = f"{_next_address.value | _TAGS[kind]:010X}"
    _next_address.value += 0x40
    try:
        keeper = weakref.ref(obj, lambda _: _addresses.pop(key, None))
    except TypeError:
        keeper = obj  # it cannot be watched, so it is kept, and its identity with it
    _addresses[key] = (text, keeper)
    return text


def print_unreadable(obj, stream, text=None, type_=False, identity=False, body=None):
    """``print-unreadable-object``: ``#<TYPE text {address}>``.

    text: what to print inside; or ``body``: a function of no arguments that prints it to ``stream`` (a pretty stream
    then has a logical block open). type_: print the type of ``obj`` first. identity: print its address last.
    """
    if PRINT_READABLY.value is not None:
        return error(PrintNotReadable(object=obj))
    if text is not None:

        def body():
            stream.write(text)

    def description(*_):
        if type_:
            with bound(PRINT_CIRCLE, None, controls.PRINT_LEVEL, None, controls.PRINT_LENGTH, None):
                output_object(type_name(obj), stream)
            stream.write(" ")
        if body is not None:
            body()
        if identity:
            stream.write(f"{' ' if body is not None or not type_ else ''}{{{address(obj)}}}")

    if stream.is_pretty and PRINT_PRETTY.value is not None:
        call_logical_block(stream, NO_OBJECT, description, "#<", ">")
    else:
        stream.write("#<")
        description()
        stream.write(">")
    return None


def class_symbol(cls):
    """The symbol that names the class ``cls``: from the class system, or from its ``lisp_name``."""
    return class_name(cls)


def type_name(obj):
    """What stands for the type of ``obj`` in ``#<...>``: a symbol, or a list for arrays and numbers."""
    if isinstance(obj, (list, str, int, complex, Character, Keyword, LispString, LispArray)):
        return PORTS.types.of(obj)
    return class_symbol(type(obj))


def write_string_text(text, stream):
    stream.write(string_text(text) if escaping() else text)


COMPONENTS.output_object, COMPONENTS.output_ugly = output_object, output_ugly
COMPONENTS.print_unreadable, COMPONENTS.write_string_text = print_unreadable, write_string_text


# ------------------------------------------------------------------------------------------------------ what users call


def write(obj, stream, escape=True):
    """Print ``obj`` to ``stream`` (an output stream or a designator of one), as ``prin1`` or, without ``escape``,
    ``princ``.
    """
    if stream.__class__ is None.__class__ or not isinstance(stream, Stream):
        stream = output_stream(stream)
    text_of = _ATOMS.get(obj.__class__)
    usual = PRINT_CIRCLE.value is None and not PRINT_PPRINT_DISPATCH.value.entries
    if text_of is not None and usual:
        stream.write(text_of(obj, escape))
    elif usual and obj.__class__ is Cons and (text := flat_text(obj, stream, escape, atom_text)) is not None:
        stream.write(text)
    elif escape:
        if PRINT_ESCAPE.value is True:
            output_object(obj, stream)
        else:
            with bound(PRINT_ESCAPE, True):
                output_object(obj, stream)
    elif PRINT_ESCAPE.value is None and PRINT_READABLY.value is None:
        output_object(obj, stream)
    else:
        with bound(PRINT_ESCAPE, None, PRINT_READABLY, None):
            output_object(obj, stream)


def prin1(obj, stream=None):
    """``prin1``: print ``obj`` so that it can be read back. Returns ``obj``."""
    write(obj, stream, True)
    return obj


def princ(obj, stream=None):
    """``princ``: print ``obj`` for people: no quotes, no packages. Returns ``obj``."""
    if stream.__class__ is StringOutputStream and obj.__class__ is int and -_SHORT < obj < _SHORT and controls.PRINT_BASE.value == 10:
        if controls.PRINT_RADIX.value is None and PRINT_CIRCLE.value is None and not PRINT_PPRINT_DISPATCH.value.entries:
            stream.write(_integer(obj))
            return obj
    write(obj, stream, False)
    return obj


def print_(obj, stream=None):
    """``print``: a newline, ``obj`` as by ``prin1``, a space. Returns ``obj``."""
    stream = output_stream(stream)
    stream.write("\n")
    write(obj, stream, True)
    stream.write(" ")
    return obj


def pprint(obj, stream=None):
    """``pprint``: a newline and ``obj``, pretty. Returns no values."""
    stream = output_stream(stream)
    stream.write("\n")
    with bound(PRINT_PRETTY, True, PRINT_ESCAPE, True):
        output_object(obj, stream)
    return MultipleValues()


def prin1_to_string(obj):
    """The text that ``prin1`` prints."""
    return _to_string(obj, True)


def princ_to_string(obj):
    """The text that ``princ`` prints."""
    return _to_string(obj, False)


def lisp_prin1_to_string(object):
    """``prin1-to-string``: the text that ``prin1`` prints, a fresh string."""
    return FreshString(_to_string(object, True))


def lisp_princ_to_string(object):
    """``princ-to-string``: the text that ``princ`` prints, a fresh string."""
    return FreshString(_to_string(object, False))


def _to_string(obj, escape):
    text_of = _ATOMS.get(obj.__class__)
    if text_of is not None and PRINT_CIRCLE.value is None and not PRINT_PPRINT_DISPATCH.value.entries:
        return text_of(obj, escape)
    return bounded(lambda: _written(obj, escape))


def _written(obj, escape):
    stream = StringOutputStream()
    write(obj, stream, escape)
    return stream.text()


_KEYWORDS = {
    "array": controls.PRINT_ARRAY,
    "base": controls.PRINT_BASE,
    "case": controls.PRINT_CASE,
    "circle": PRINT_CIRCLE,
    "escape": PRINT_ESCAPE,
    "gensym": controls.PRINT_GENSYM,
    "length": controls.PRINT_LENGTH,
    "level": controls.PRINT_LEVEL,
    "lines": controls.PRINT_LINES,
    "miser_width": controls.PRINT_MISER_WIDTH,
    "pprint_dispatch": PRINT_PPRINT_DISPATCH,
    "pretty": PRINT_PRETTY,
    "radix": controls.PRINT_RADIX,
    "readably": PRINT_READABLY,
    "right_margin": controls.PRINT_RIGHT_MARGIN,
}


def _bindings(given):
    return [item for name, value in given.items() if value is not UNSUPPLIED for item in (_KEYWORDS[name], value)]


def lisp_write(
    obj,
    *,
    stream=None,
    array=UNSUPPLIED,
    base=UNSUPPLIED,
    case=UNSUPPLIED,
    circle=UNSUPPLIED,
    escape=UNSUPPLIED,
    gensym=UNSUPPLIED,
    length=UNSUPPLIED,
    level=UNSUPPLIED,
    lines=UNSUPPLIED,
    miser_width=UNSUPPLIED,
    pprint_dispatch=UNSUPPLIED,
    pretty=UNSUPPLIED,
    radix=UNSUPPLIED,
    readably=UNSUPPLIED,
    right_margin=UNSUPPLIED,
):
    """``cl:write``: print ``obj`` to ``stream`` with the given control variables bound. Returns ``obj``."""
    given = {name: value for name, value in locals().items() if name in _KEYWORDS}
    with bound(*_bindings(given)):
        output_object(obj, output_stream(stream))
    return obj


def write_to_string(
    obj,
    *,
    array=UNSUPPLIED,
    base=UNSUPPLIED,
    case=UNSUPPLIED,
    circle=UNSUPPLIED,
    escape=UNSUPPLIED,
    gensym=UNSUPPLIED,
    length=UNSUPPLIED,
    level=UNSUPPLIED,
    lines=UNSUPPLIED,
    miser_width=UNSUPPLIED,
    pprint_dispatch=UNSUPPLIED,
    pretty=UNSUPPLIED,
    radix=UNSUPPLIED,
    readably=UNSUPPLIED,
    right_margin=UNSUPPLIED,
):
    """``write-to-string``: the text that ``write`` with the same arguments prints."""
    given = {name: value for name, value in locals().items() if name in _KEYWORDS}
    stream = StringOutputStream()
    with bound(*_bindings(given)):
        output_object(obj, stream)
    return FreshString(stream.text())


LISP_NAMES = "prin1 princ print pprint write-to-string"
LISP_FUNCTIONS = {"write": lisp_write, "prin1-to-string": lisp_prin1_to_string, "princ-to-string": lisp_princ_to_string}
