"""Elements of arrays: ``aref``, ``svref``, ``elt``, ``length`` and their ``setf``.

A simple vector is a Python list or a `TypedVector`, and an element of it is one subscript behind the tests of the class and the bounds.
Of a simple array with two axes the element is found by its row and its column. Other arrays, and all errors, are the functions' business.
"""

from __future__ import annotations

from cramhy_runtime.ground.packages import sym
from .. import nodes
from ..core import TRUE, Symbol, expression, word
from .operations import AND, DOT, IF, INT_CLASS, IS, OR, ArithmeticGenerator
from ..kinds import INT, exactly, never_negative

AREF, SVREF, ELT, LENGTH = map(sym, "AREF SVREF ELT LENGTH".split())
ELEMENTS = {AREF, SVREF, ELT}
LESS, GET, VECTOR, TYPED_VECTOR, MATRIX = map(word, "< get Lvector Ltyped_vector Larray".split())
ROWS, COLUMNS, STORAGE = map(word, "rows columns storage".split())


class ArrayGenerator(ArithmeticGenerator):
    """The part of the `Generator` that reads and writes elements of arrays."""

    def element(self, node, symbol, arguments):
        """The expression of an element, or of a length; ``None`` for other calls."""
        if symbol is LENGTH and len(arguments) == 1:
            (vector,) = self.operands(arguments)
            slow = self.positioned(expression(word(self.constants.name("function", symbol)), self.call("one", vector.later)), node)
            return expression(IF, expression(IS, self.class_of(vector.first), VECTOR), self.call("len", vector.later), slow)
        if symbol not in ELEMENTS or len(arguments) != 2 and (len(arguments) != 3 or symbol is not AREF):
            return None
        operands = self.operands(arguments)
        self.settle(operands)
        tests, place = self.place(operands)
        function = word(self.constants.name("function", symbol))
        slow = self.positioned(expression(function, *(self.argument(operand) for operand in operands)), node)
        if tests is None:
            return slow
        if symbol is not SVREF and len(operands) == 2:
            typed = expression(IS, self.class_of(operands[0].later), TYPED_VECTOR)
            tests[0] = expression(OR, tests[0], typed)
        return expression(IF, expression(AND, *tests), place, slow)

    def argument(self, operand):
        """An operand as an argument of a function, which takes no several values."""
        model = self.generic(operand)
        return self.call("one", model) if operand.node.__class__ is not nodes.LocalVariable and not operand.node.single else model

    def place(self, operands):
        """(tests, Python's place) of the element of a vector or matrix that ``operands`` mean; (``None``, ``None``) if they cannot."""
        array, *subscripts = operands
        if (
            array.later.__class__ is not Symbol
            or array.later in ("None", "True")
            or any(not each.kind & INT or each.raw for each in subscripts)
        ):
            return None, None
        matrix = len(subscripts) == 2
        tests = [expression(IS, self.class_of(array.later), MATRIX if matrix else VECTOR)]
        ends = [expression(DOT, array.later, ROWS), expression(DOT, array.later, COLUMNS)]
        if not matrix:
            ends = [self.call("len", array.later)]
        for subscript, end in zip(subscripts, ends):
            if not exactly(subscript.kind, INT):
                tests.append(expression(IS, self.class_of(subscript.later), INT_CLASS))
            below = [] if never_negative(subscript.node) else [-1]
            tests.append(expression(LESS, *below, subscript.later, end))
        if not matrix:
            return tests, expression(GET, array.later, subscripts[0].later)
        row, column = (each.later for each in subscripts)
        index = expression(word("+"), expression(word("*"), row, ends[1]), column)
        return tests, expression(GET, expression(DOT, array.later, STORAGE), index)

    def store(self, node):
        """Emit the store of an element, if ``node`` is one of a simple kind; the stored value, or ``None``."""
        symbol, arguments = node.symbol, node.arguments
        if symbol not in ELEMENTS or len(arguments) != 3 and (len(arguments) != 4 or symbol is not AREF):
            return None
        new, *others = operands = self.operands(arguments)
        self.settle(operands)
        tests, place = self.place(others)
        if tests is None:
            tests, place = [TRUE], None
        elif len(others) == 3:
            tests.insert(1, expression(IS, expression(DOT, others[0].later, word("element_type")), TRUE))
        value = self.generic(new)
        if value.__class__ is not Symbol and value.__class__ not in (int, float):
            name = word(self.temporary())
            self.emit(word("setv"), name, value)
            value = name
        setter = word(self.constants.name("setf_function", symbol))
        slow = self.positioned(expression(setter, value, *(self.argument(operand) for operand in others)), node)
        if place is None:
            self.out.append(slow)
        else:
            self.emit(word("if"), expression(AND, *tests), expression(word("setv"), place, value), slow)
        self.effects += 1
        return value
