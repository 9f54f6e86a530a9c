"""``(format nil "..." ...)`` with a simple control: Python's own formatting makes the text.

Rows of ``make bench`` without it, as times of the row with it: format in a loop 4.5.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Keyword
from cramhy_runtime.lisp_core.packages import sym

from ...format.format_templates import SMALL, Piece, template, with_known
from ...printer.print_controls import PRINT_BASE, PRINT_CASE, UPCASE
from ...printer.print_names import symbol_text
from ...reader.readtables import READTABLE
from .. import core, nodes
from ..core import NONE, TRUE, expression, word
from ..kinds import INT, kind_of
from ..passes import opens_call

FORMAT = sym("FORMAT")


@opens_call("format", FORMAT, effect=True)
def _format(generator, node, destination):
    model = formatted(generator, node, node.arguments)
    return None if model is None else (generator.finish(model, node, destination),)


def formatted(generator, node, arguments):
    """``(format stream "..." ...)`` with a simple control: Python's formatting, if all arguments are atoms; else ``None``."""
    if len(arguments) < 2 or arguments[1].__class__ is not nodes.Constant or arguments[1].value.__class__ is not str:
        return None
    control, to_string = arguments[1].value, arguments[0].__class__ is nodes.Constant and arguments[0].value is None
    found = template(control)
    if found is None or len(found[1]) != len(arguments) - 2:
        return None
    target, *names = generator.stable_names(generator.arguments([arguments[0], *arguments[2:]]))
    tests, parts, known = [], [], []
    for kind, name, argument in zip(found[1], names, arguments[2:], strict=True):
        if kind == "A" and name.__class__ is str:
            known.append(name)
            continue
        if kind == "S" and argument.__class__ is nodes.Constant and argument.value.__class__ is Keyword:
            known.append(symbol_text(argument.value))
            tests.append(customary_printing(generator))
            continue
        known.append(None)
        if kind == "D":  # an integer, so small that Python surely prints it
            tests.append(small_integer(generator, name, argument))
            parts.append(name)
            continue
        part = word(generator.temporary())
        if kind.__class__ is Piece:
            text = expression(expression(word("."), generator.constant(kind), word("text_of")), name)
        else:
            text = generator.call("text" + kind, name)
        if kind == "A":
            is_text = expression(word("is"), expression(word("."), name, word("__class__")), word("Lstr"))
            text = expression(word("if"), is_text, name, text)
        tests.append(expression(word("is-not"), expression(word("setx"), part, text), NONE))
        parts.append(part)
    text = with_known(found[0], known)
    filled = expression(word("%"), text, core.Tuple(parts)) if parts else text % ()
    if to_string:
        filled = expression(word("Lfresh"), filled)
    else:
        filled = generator.positioned(generator.call("write_text", target, filled, TRUE if found[2] else NONE), node)
    if not tests:
        return filled
    general = expression(word(generator.constants.name("function", node.symbol)), target, control, *names)
    simple = tests[0] if len(tests) == 1 else expression(word("and"), *tests)
    return expression(word("if"), simple, filled, generator.positioned(general, node))


def small_integer(generator, name, argument):
    """The test that the value of ``argument``, which ``name`` has, is an integer that Python prints at once."""
    small = expression(word("<"), -SMALL, name, SMALL)
    if kind_of(argument) == INT:
        return small
    is_integer = expression(word("is"), expression(word("."), name, word("__class__")), word("Lint"))
    return expression(word("and"), is_integer, small)


def customary_printing(generator):
    """The test that keywords are printed in upper case and numbers in decimal, as they are unless a program says otherwise."""
    case, base, readtable = [expression(word("."), generator.constant(each), word("value")) for each in (PRINT_CASE, PRINT_BASE, READTABLE)]
    upper = generator.constant(UPCASE)
    tests = expression(word("is"), case, upper), expression(word("is"), expression(word("."), readtable, word("case")), upper)
    return expression(word("and"), *tests, expression(word("="), base, 10))
