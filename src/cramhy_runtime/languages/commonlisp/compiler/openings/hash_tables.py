"""Hash tables: an entry under a key of a plain class is one of Python's dictionary.

Rows of ``make bench`` without it, as times of the row with it: a hash table filled and
read 7.6.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import sym

from .. import nodes
from ..arithmetic.elements import GET, as_argument, as_arguments
from ..arithmetic.operations import operands_of, settle
from ..core import TRUE, Tuple, expression, word
from ..destinations import FIRST_OF_VALUES
from ..generator.output import SINGLE_VALUE
from ..passes import ONE_VALUE, VALUES, enter, opens, opens_call, opens_setter
from ..words import AND, DOT, IF, IS, class_of

GETHASH = sym("GETHASH")
IN, SETV = map(word, "in setv".split())


@opens_call("hash-tables", GETHASH)
def entry_read(generator, node, destination):
    """``(gethash key table default)``, the first of its values."""
    if len(node.arguments) not in (2, 3) or destination.multiple and destination is not FIRST_OF_VALUES:
        return None
    operands = operands_of(generator, node.arguments)
    settle(generator, operands)
    plain, entries = entry_test(generator, operands)
    usual = as_arguments(generator, operands)
    quick = expression(expression(DOT, entries, GET), operands[0].later, *usual[2:])
    model = expression(IF, plain, quick, generator.positioned(generator.call("gethash", *usual), node))
    return (generator.finish(model, SINGLE_VALUE, destination),)


@opens("hash-tables", VALUES)
def _both_values(generator, names, node):
    if len(names) != 2 or node.__class__ is not nodes.Call or node.symbol is not GETHASH or len(node.arguments) not in (2, 3):
        return None
    return entry_and_presence(generator, node, node.arguments)


@opens_setter("hash-tables", GETHASH)
def _set_entry(generator, node, destination):
    if len(node.arguments) != 3:
        return None
    return (generator.by_statements(node, destination, lambda inner: entry_written(generator, node, inner)),)


@enter("hash-tables")
def _gives_one():
    ONE_VALUE.add(GETHASH)


def entry_test(generator, operands):
    """(a test whether the dictionary behind a table has the value under the key itself, that dictionary). ``operands`` are the key, the
    table, and perhaps a default."""
    key, table, *_ = operands
    known = expression(IS, class_of(table.later), word("Lhash_table"))
    plain = expression(IN, class_of(key.later), expression(DOT, table.later, word("plain")))
    return expression(AND, known, plain), expression(DOT, table.later, word("entries"))


def entry_and_presence(generator, node, arguments):
    """Both values of ``(gethash key table default)``, as a tuple."""
    operands = operands_of(generator, arguments)
    settle(generator, operands)
    plain, entries = entry_test(generator, operands)
    key = operands[0].later
    slow = generator.positioned(generator.call("gethash_values", *as_arguments(generator, operands)), node)
    return expression(IF, expression(AND, plain, expression(IN, key, entries)), Tuple([expression(GET, entries, key), TRUE]), slow)


def entry_written(generator, node, destination):
    """``(setf (gethash key table) new)``"""
    new, *others = operands = operands_of(generator, node.arguments)
    settle(generator, operands)
    (value,) = generator.stable_names([as_argument(generator, new)])
    plain, entries = entry_test(generator, others)
    setter = word(generator.constants.name("setf_function", GETHASH))
    slow = generator.positioned(expression(setter, value, *as_arguments(generator, others)), node)
    generator.branch(plain, [expression(SETV, expression(GET, entries, others[0].later), value)], [slow])
    generator.effects += 1
    generator.finish(value, SINGLE_VALUE, destination, pure=True)
