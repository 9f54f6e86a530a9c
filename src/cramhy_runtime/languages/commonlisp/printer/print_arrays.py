"""Arrays as text: ``#(1 2)``, ``#2A((1 2) (3 4))``, ``#*101``.

Vectors are Python lists or the classes of ``lisp_core/arrays.py``. Source: ANSI 22.1.3.7 and 22.1.3.8; layout as in SBCL.
"""

from __future__ import annotations

from .components import COMPONENTS
import math

from cramhy_runtime.lisp_core.arrays import CHARACTER, LispArray, Vector, is_bit_vector
from cramhy_runtime.lisp_core.data import Character, Cons, list_from
from .pretty import NO_OBJECT, call_logical_block, newline_if_pretty
from .print_controls import PRINT_ARRAY, PRINT_READABLY, deeper, length_limit, too_deep


def _elements(array):
    return array.active() if isinstance(array, Vector) else array


def _is_vector(array):
    return isinstance(array, (list, Vector))


def _characters(array):
    """The text of a vector of characters with a fill pointer, else ``None``."""
    if _is_vector(array) and getattr(array, "element_type", None) is CHARACTER:
        return "".join(item.char if isinstance(item, Character) else item for item in _elements(array))
    return None


def _needs_type(array):
    """Whether ``array`` is to be read again, and ``#(...)`` or ``#2A(...)`` would not tell its dimensions or its element type."""
    if PRINT_READABLY.value is None or is_bit_vector(array):
        return False
    empty = isinstance(array, LispArray) and not isinstance(array, Vector) and 0 in array.dimensions[:-1]
    return empty or getattr(array, "element_type", True) is not True


def _with_type(array):
    """(dimensions element-type . contents): what SBCL writes, and reads, behind ``#A``."""
    elements = _elements(array) if _is_vector(array) else array.active()
    dimensions = [len(elements)] if _is_vector(array) else list(array.dimensions)
    return Cons(list_from(dimensions), Cons(getattr(array, "element_type", True), _nested(elements, dimensions, 0)))


def _nested(elements, dimensions, index):
    if not dimensions:
        return elements[index]
    step = math.prod(dimensions[1:])
    return list_from([_nested(elements, dimensions[1:], index + position * step) for position in range(dimensions[0])])


def print_array(array, stream):
    """Print ``array`` on one line, or tersely when ``*print-array*`` is nil."""
    text = _characters(array)
    if text is not None:
        COMPONENTS.write_string_text(text, stream)
        return
    if PRINT_ARRAY.value is None and PRINT_READABLY.value is None:
        COMPONENTS.print_unreadable(array, stream, type_=True, identity=True)
        return
    if _needs_type(array):
        stream.write("#A")
        COMPONENTS.output_object(_with_type(array), stream)
        return
    if is_bit_vector(array):
        stream.write("#*" + "".join(map(str, _elements(array))))
        return
    if _is_vector(array):
        if too_deep(stream):
            return
        limit = length_limit()
        with deeper():
            stream.write("#(")
            for index, item in enumerate(_elements(array)):
                if index:
                    stream.write(" ")
                if index >= limit:
                    stream.write("...")
                    break
                COMPONENTS.output_object(item, stream)
            stream.write(")")
        return
    stream.write(f"#{len(array.dimensions)}A")
    _print_dimension(array.active(), array.dimensions, 0, stream, COMPONENTS.output_object)


def _print_dimension(elements, dimensions, index, stream, output_object):
    if not dimensions:
        output_object(elements[index], stream)
        return
    if too_deep(stream):
        return
    limit, step = length_limit(), math.prod(dimensions[1:])
    with deeper():
        stream.write("(")
        for position in range(dimensions[0]):
            if position:
                stream.write(" ")
            if position >= limit:
                stream.write("...")
                break
            _print_dimension(elements, dimensions[1:], index + position * step, stream, output_object)
        stream.write(")")


def pprint_array(stream, array, *_):
    """Print ``array`` with line breaks where they are needed."""
    if _characters(array) is not None or _needs_type(array) or (PRINT_ARRAY.value is None and PRINT_READABLY.value is None):
        print_array(array, stream)
    elif _is_vector(array):
        call_logical_block(stream, NO_OBJECT, lambda out, block: _fill_elements(out, block, _elements(array)), "#(", ")")
    else:
        stream.write(f"#{len(array.dimensions)}A")
        _pprint_dimension(stream, array.active(), array.dimensions, 0)


def _fill_elements(out, block, elements):
    for index, item in enumerate(elements):
        if index:
            out.write(" ")
            newline_if_pretty(out, "fill")
        block.pop()
        COMPONENTS.output_object(item, out)


def _pprint_dimension(stream, elements, dimensions, index):
    if not dimensions:
        COMPONENTS.output_object(elements[index], stream)
        return
    rest = dimensions[1:]
    step = math.prod(rest)

    def body(out, block):
        for position in range(dimensions[0]):
            if position:
                out.write(" ")
                newline_if_pretty(out, "linear" if rest else "fill")
            block.pop()
            _pprint_dimension(out, elements, rest, index + position * step)

    call_logical_block(stream, NO_OBJECT, body, "(", ")")
