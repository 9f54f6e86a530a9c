"""Operators: arithmetic, comparison, and the small functions on lists that become Python expressions.

Where the kinds of the operands are known (``facts.py``) a Python operator stands alone. Where they are not, the operator stands
behind a test of their classes, and the generic function of ``numbers/arithmetic.py`` behind it in turn: ratios, doubles, errors and
several values are its business. Numbers stay what they are in Lisp: ``t`` is none although Python's ``True`` is, a quotient of
integers is a ratio, and a product of floats that became infinite is an error, unless it is only a term of a sum.
"""

from __future__ import annotations

import sys

from cramhy_runtime.ground.packages import sym
from . import nodes
from .core import NONE, TRUE, Expression, Symbol, expression, word
from .declared_types import FIXNUM, GREATEST_FIXNUM, LEAST_FIXNUM, is_fixnum, kind_of_type
from .destinations import FIRST_OF_VALUES
from .facts import DIVIDE, MINUS, PLUS, TIMES, kind_of

ARITHMETIC = {
    sym(name): word(f"L{function}")
    for name, function in (
        ("+", "add2"),
        ("-", "sub2"),
        ("*", "mul2"),
        ("/", "div2"),
        ("<", "lt2"),
        (">", "gt2"),
        ("<=", "le2"),
        (">=", "ge2"),
        ("=", "num_eq2"),
    )
}
OPERATORS = {PLUS: word("+"), MINUS: word("-"), TIMES: word("*")}
COMPARISONS = {sym(name): word(name) for name in ("<", ">", "<=", ">=", "=")}
STEPS = {sym("1+"): PLUS, sym("1-"): MINUS}
SIGNS = {sym("ZEROP"): COMPARISONS[sym("=")], sym("PLUSP"): COMPARISONS[sym(">")], sym("MINUSP"): COMPARISONS[sym("<")]}
PARITY = {sym("EVENP"): 0, sym("ODDP"): 1}
REMAINDERS = {sym("MOD")}
SAME = {sym("EQ"), sym("EQL")}
NOT = sym("NOT")
NEGATIONS = {NOT, sym("NULL")}
CAR, CDR, FIRST, REST, CONS, LIST = map(sym, "CAR CDR FIRST REST CONS LIST".split())
PARTS = {CAR: "car", FIRST: "car", CDR: "cdr", REST: "cdr"}
KNOWN_PARTS = {sym("CRAMHY::CAR-OF-CONS"): "car", sym("CRAMHY::CDR-OF-CONS"): "cdr"}
CONSP, ATOM, ENDP = map(sym, "CONSP ATOM ENDP".split())

LARGEST = sys.float_info.max
INT, FLOAT, CLASS, CLASSES, RESULT = word("Lint"), word("Lfloat"), word("__class__"), word("Lc"), word("Lr")
IS, IS_NOT, AND, OR, IF, DOT, SETX = map(word, "is is-not and or if . setx".split())


def class_of(model):
    return expression(DOT, model, CLASS)


def nameable(model):
    """Whether ``model`` may be evaluated twice: a name or a number."""
    return model.__class__ in (Symbol, int, float)


def unproven(kinds):
    """``kinds``; to be a number of any kind helps only where sums are made."""
    return [None if kind == "number" else kind for kind in kinds]


def known_kind(variable):
    return variable.proven or variable.kind


def all_of(classes, wanted):
    """A test that all ``classes`` are ``wanted``."""
    tests = [expression(IS, each, wanted) for each in classes]
    return tests[0] if len(tests) == 1 else expression(AND, *tests)


class OperatorGenerator:
    """The part of the `Generator` that makes expressions of calls of standard functions."""

    def class_of(self, model):
        """The class of the value of ``model``; that of a parameter that is often an operand was noted on entry."""
        noted = self.class_names.get(model) if model.__class__ is Symbol else None
        return class_of(model) if noted is None else noted

    def noted_class(self, model):
        """(first use, later use) of the class of the value of ``model``."""
        known = self.class_of(model)
        return (known, known) if known.__class__ is Symbol else (expression(SETX, CLASSES, known), CLASSES)

    def operands(self, arguments):
        """(first uses, later uses) of the values of ``arguments``: an expression that is not simple is named by its first use.

        Several values are left in: the generic functions take the first.
        """
        models = self.arguments(arguments, FIRST_OF_VALUES)
        first, later = [], []
        for index, (model, node) in enumerate(zip(models, arguments)):
            simple = nameable(model)
            if simple and node.__class__ is nodes.LocalVariable and node.variable.captured and node.variable.assigned:
                simple = all(map(nameable, models[index + 1 :]))  # else a later operand may change it
            if simple:
                first.append(model)
                later.append(model)
            else:
                name = word(self.temporary())
                first.append(expression(SETX, name, model))
                later.append(name)
        return first, later

    def Checked(self, node, destination):
        """A value of a declared type: one comparison of classes, and of size for a fixnum, where that proves it."""
        kind = kind_of_type(node.type)
        known = kind is not None and not node.entry and kind_of(node.value) == kind
        if known and (node.type is not FIXNUM or node.value.__class__ is nodes.Constant and is_fixnum(node.value.value)):
            return self.gen(node.value, destination)
        (first,), (later,) = self.operands([node.value])
        place = [self.constant(node.place)] if node.place is not None else []
        if kind is None:
            return self.finish(self.positioned(self.call("checked", first, self.literal(node.type), *place), node), node, destination)
        slow = self.positioned(self.call("checked", later, self.literal(node.type), *place), node)
        test = expression(IS, self.class_of(first), INT if kind == "int" else FLOAT)
        if node.type is FIXNUM:
            test = expression(AND, test, expression(word("<="), LEAST_FIXNUM, later, GREATEST_FIXNUM))
        if destination.kind == "effect":
            self.emit(word("when"), expression(word("not"), test), slow)
            self.effects += 1
            return None
        return self.finish(expression(IF, test, later, slow), node, destination)

    def arithmetic(self, node, symbol, arguments):
        """The expression of a sum, difference, product or quotient of two operands."""
        fused = self.fused(node, symbol, arguments)
        if fused is not None:
            return fused
        kinds = [kind_of(argument) for argument in arguments]
        first, later = self.operands(arguments)
        if symbol is not DIVIDE and symbol is not TIMES and "number" in kinds and {*kinds} <= {None, "number"}:
            return self.sum_of_numbers(node, symbol, kinds, first, later)
        kinds = unproven(kinds)
        slow = self.positioned(expression(ARITHMETIC[symbol], *later), node)
        if symbol is DIVIDE:
            return self.quotient(kinds, first, later, slow)
        operator = OPERATORS[symbol]
        if kinds[0] == kinds[1] == "int" or (symbol is not TIMES and kinds[0] == kinds[1] == "float"):
            return expression(operator, *first)
        if not {*kinds} <= {None, "int", "float"}:
            return self.positioned(expression(ARITHMETIC[symbol], *first), node)
        kinds = self.tested(kinds, first)
        quick = expression(operator, *later)
        numbers = [model.__class__ for model in later]
        if "float" in kinds:
            if all(kind == "float" or number is int for kind, number in zip(kinds, numbers)):
                return quick if symbol is not TIMES else self.finite(TRUE, quick, slow)
            guard = self.guard(first, later, kinds, FLOAT)
            if guard is None:
                return slow
            return expression(IF, guard, quick, slow) if symbol is not TIMES else self.finite(guard, quick, slow)
        if "int" in kinds and int not in numbers:
            return expression(IF, self.guard(first, later, kinds, INT), quick, slow)
        shared = self.shared_class(first, later)
        if symbol is not TIMES:
            return expression(IF, self.both(shared), quick, slow)
        one, other = shared
        again = one if other is None and one.__class__ is Symbol else CLASSES
        either = expression(
            IF, expression(IS, one if other is None else CLASSES, INT), quick, self.finite(expression(IS, again, FLOAT), quick, slow)
        )
        return either if other is None else expression(IF, expression(IS, one, other), either, slow)

    def sum_of_numbers(self, node, symbol, kinds, first, later):
        """A sum or difference of which one operand surely is a number: with an integer or a float it needs no other test.

        (A ratio plus an integer is never whole, and contagion to a float or a double is Python's too.)
        """
        if kinds[0] == "number" and nameable(first[0]):
            tested, operands = first[1], later
        elif kinds[1] == "number":
            tested, operands = first[0], [later[0], first[1]]
        else:
            return self.positioned(expression(ARITHMETIC[symbol], *first), node)
        noted, again = self.noted_class(tested)
        test = expression(OR, expression(IS, noted, INT), expression(IS, again, FLOAT))
        return expression(
            IF, test, expression(OPERATORS[symbol], *operands), self.positioned(expression(ARITHMETIC[symbol], *operands), node)
        )

    @staticmethod
    def finite(guard, product, slow):
        """``product`` if ``guard`` holds and it is finite, else what the generic function says to it."""
        inside = expression(word("<="), -LARGEST, expression(SETX, RESULT, product), LARGEST)
        return expression(IF, inside if guard is TRUE else expression(AND, guard, inside), RESULT, slow)

    @staticmethod
    def tested(kinds, first):
        """The kinds that need no test; an operand that is yet to be evaluated takes part in the test, which evaluates it."""
        return [kind if nameable(model) else None for kind, model in zip(kinds, first)]

    def guard(self, first, later, kinds, wanted):
        """A test that the operands of unknown kind are of the class ``wanted``; ``None`` when another one cannot be.

        Both operands are evaluated in it, whatever the class of the first.
        """
        tests = []
        for use, name, kind in zip(first, later, kinds):
            if kind is None:
                tests.append(self.class_of(use))
            elif (kind == "int") is not (wanted is INT) and name.__class__ is not int:
                return None
        return expression(IS, *tests, wanted)

    def shared_class(self, first, later):
        """(the first operand's class, noted in ``Lc`` when all operands have been evaluated; the other's class or ``None``)."""
        names = [index for index, model in enumerate(later) if model.__class__ is Symbol]
        one = first[names[0]]
        if len(names) == 1 or later[names[0]] is later[names[1]]:
            return self.noted_class(one)[0], None
        other = first[names[1]]
        if other.__class__ is Symbol:
            return expression(SETX, CLASSES, self.class_of(one)), self.class_of(other)
        return self.class_of(one), expression(SETX, CLASSES, self.class_of(other))

    @staticmethod
    def both(shared):
        """A test that all operands are integers or all are floats."""
        one, other = shared
        if other is None:
            again = one if one.__class__ is Symbol else CLASSES
            return expression(OR, expression(IS, one, INT), expression(IS, again, FLOAT))
        return expression(AND, expression(IS, one, other), expression(OR, expression(IS, CLASSES, INT), expression(IS, CLASSES, FLOAT)))

    def quotient(self, kinds, first, later, slow):
        if all(model.__class__ in (int, float) for model in later) or "boolean" in kinds:
            return expression(slow[0], *first)
        if kinds == ["int", "int"]:
            return expression(slow[0], *first)
        floats = [kind for kind, model in zip(kinds, later) if kind == "float" or model.__class__ is int]
        divisor = later[1]
        known = divisor.__class__ in (int, float)
        if known and not divisor:
            return expression(slow[0], *first)
        if len(floats) == 2:
            return (
                expression(word("/"), *first)
                if known
                else expression(IF, first[1], expression(word("/"), *later), slow)
                if nameable(first[0])
                else expression(slow[0], *first)
            )
        kinds = self.tested(kinds, first)
        guard = self.guard(first, later, kinds, FLOAT)
        if guard is None or "int" in kinds and int not in [model.__class__ for model in later]:
            return expression(slow[0], *first)
        if not known:
            guard = expression(AND, guard, divisor)
        return expression(IF, guard, expression(word("/"), *later), slow)

    def fused(self, node, symbol, arguments):
        """The expression of several operations on variables and numbers behind one test of all variables, or ``None``."""
        if symbol is DIVIDE:
            return None
        leaves, operations = {}, []

        def tree(item):
            kind = item.__class__
            if kind is nodes.LocalVariable and not item.variable.boxed:
                leaves[item.variable] = word(item.variable.name)
                return leaves[item.variable]
            if kind is nodes.Constant and item.value.__class__ is int:
                return item.value
            if kind is nodes.Call:
                operator, operands = STEPS.get(item.symbol, item.symbol), item.arguments
                if operator is not item.symbol and len(operands) == 1:
                    operands = [*operands, nodes.Constant(1)]
                if operator in OPERATORS and len(operands) == 2 and len(operations) < 8:
                    operations.append((operator, item))
                    parts = [tree(operand) for operand in operands]
                    if None not in parts:
                        return (operator, item, parts)
            return None

        operations.append((symbol, node))
        parts = [tree(argument) for argument in arguments]
        if None in parts or len(operations) < 2 or not leaves or len(leaves) > 4:
            return None
        numbers = [self.class_of(name) for variable, name in leaves.items() if known_kind(variable) == "number"]
        kinds = {*unproven(map(known_kind, leaves))}
        if kinds == {"int"} or not kinds <= {None, "int", "float"} or kinds >= {"int", "float"}:
            return None  # each operation is bare by itself, or none is

        def quick(operator, parts):
            return expression(OPERATORS[operator], *(part if part.__class__ is not tuple else quick(part[0], part[2]) for part in parts))

        def slow(operator, item, parts):
            return self.positioned(
                expression(ARITHMETIC[operator], *(part if part.__class__ is not tuple else slow(*part) for part in parts)), item
            )

        bare, generic = quick(symbol, parts), slow(symbol, node, parts)
        product = symbol is TIMES
        unknown = [self.class_of(name) for variable, name in leaves.items() if known_kind(variable) in (None, "number")]
        if kinds == {"float"}:
            return self.finite(TRUE, bare, generic) if product else bare
        if kinds >= {"int"}:
            return expression(IF, all_of(unknown, INT), bare, generic)
        if kinds >= {"float"}:
            guard = all_of(unknown, FLOAT)
            return self.finite(guard, bare, generic) if product else expression(IF, guard, bare, generic)
        if any(operator is TIMES for operator, _ in operations):  # of floats, most likely
            ints = expression(IF, all_of(unknown, INT), bare, generic)
            certain = [each for each in unknown if each not in numbers]
            floats = all_of(certain or unknown, FLOAT)  # what is a number becomes a float with them
            return self.finite(floats, bare, ints) if product else expression(IF, floats, bare, ints)
        noted = expression(SETX, CLASSES, unknown[0])
        alike = expression(IS, noted, *unknown[1:]) if unknown[1:] else None
        either = expression(OR, expression(IS, noted if alike is None else CLASSES, INT), expression(IS, CLASSES, FLOAT))
        return expression(IF, either if alike is None else expression(AND, alike, either), bare, generic)

    # --------------------------------------------------------------------------------------------------------------- tests

    def comparison(self, node, symbol, arguments):
        """The Python test of a comparison of two operands."""
        kinds = unproven([kind_of(argument) for argument in arguments])
        first, later = self.operands(arguments)
        operator = COMPARISONS[symbol]
        if all(kind in ("int", "float") for kind in kinds):
            return expression(operator, *first)
        if not {*kinds} <= {None, "int", "float"}:
            return expression(IS_NOT, self.positioned(expression(ARITHMETIC[symbol], *first), node), NONE)
        slow = expression(IS_NOT, self.positioned(expression(ARITHMETIC[symbol], *later), node), NONE)
        kinds = self.tested(kinds, first)
        if None in kinds and {*kinds} != {None}:  # one of them is a number
            index = kinds.index(None)
            noted, again = self.noted_class(first[index])
            wanted = (INT, FLOAT) if kinds[1 - index] == "int" else (FLOAT, INT)
            test = expression(OR, expression(IS, noted, wanted[0]), expression(IS, again, wanted[1]))
        else:
            test = self.both(self.shared_class(first, later))
        return expression(IF, test, expression(operator, *later), slow)

    def small_test(self, node, symbol, arguments):
        """The Python test of a call of a predicate that has one, or ``None``."""
        if len(arguments) == 1:
            if symbol in SIGNS or symbol in PARITY:
                kind = kind_of(arguments[0])
                first, later = self.operands(arguments)
                if symbol in SIGNS:
                    quick = expression(SIGNS[symbol], later[0], 0)
                    known = expression(SIGNS[symbol], first[0], 0)
                else:
                    quick = expression(word("="), expression(word("%"), later[0], 2), PARITY[symbol])
                    known = expression(word("="), expression(word("%"), first[0], 2), PARITY[symbol])
                if kind == "int" or (kind == "float" and symbol in SIGNS):
                    return known
                slow = expression(
                    IS_NOT,
                    self.positioned(expression(word(self.constants.name("function", symbol)), self.call("one", later[0])), node),
                    NONE,
                )
                if later[0].__class__ is not Symbol:
                    return None
                noted, again = self.noted_class(first[0])
                test = (
                    expression(OR, expression(IS, noted, INT), expression(IS, again, FLOAT))
                    if symbol in SIGNS
                    else expression(IS, self.class_of(first[0]), INT)
                )
                return expression(IF, test, quick, slow)
            if symbol is CONSP:
                return expression(IS, self.class_of(self.value(arguments[0])), word("LCons"))
            if symbol is ATOM:
                return expression(IS_NOT, self.class_of(self.value(arguments[0])), word("LCons"))
            if symbol is ENDP:
                model, name = self.named(arguments[0])
                slow = expression(IS_NOT, self.positioned(expression(word(self.constants.name("function", symbol)), name), node), NONE)
                no_cons = expression(IS_NOT, class_of(model), word("LCons"))
                return expression(AND, no_cons, expression(OR, expression(IS, name, NONE), slow))
        elif symbol in SAME and len(arguments) == 2:
            return self.sameness(arguments)
        return None

    def sameness(self, arguments):
        """``eq`` and ``eql`` with a quoted symbol, a character, or an integer; else ``None``."""
        for index in (1, 0):
            constant = arguments[index]
            if constant.__class__ is not nodes.Constant:
                continue
            value = constant.value
            if value is None or value is False:
                return expression(word("not"), self.test(arguments[1 - index]))
            if value.__class__ is int:
                first, later = self.named(arguments[1 - index])
                if kind_of(arguments[1 - index]) == "int":
                    return expression(word("="), first, value)
                return expression(AND, expression(IS, self.class_of(first), INT), expression(word("="), later, value))
            if value is True or value.__class__.__name__ in ("Symbol", "Keyword", "Character"):
                return expression(IS, self.value(arguments[1 - index]), self.literal(value))
        return None

    # --------------------------------------------------------------------------------------------------------------- lists

    def named(self, argument):
        """(first use, later use) of the first value of ``argument``."""
        model = self.value(argument)
        if model.__class__ is Symbol:
            return model, model
        name = word(self.temporary())
        return expression(SETX, name, model), name

    def small_function(self, node, symbol, arguments):
        """The expression of a call of a standard function that has a short one, or ``None``."""
        count = len(arguments)
        if count == 1:
            if symbol in PARTS:
                model, name = self.named(arguments[0])
                slow = self.positioned(expression(word(self.constants.name("function", symbol)), name), node)
                return expression(IF, expression(IS, self.class_of(model), word("LCons")), expression(DOT, name, word(PARTS[symbol])), slow)
            if symbol in KNOWN_PARTS:
                return expression(DOT, self.value(arguments[0]), word(KNOWN_PARTS[symbol]))
        if symbol is CONS and count == 2:
            return expression(word("LCons"), *self.arguments(arguments))
        if symbol is LIST and 0 < count < 5:
            model = NONE
            for item in reversed(self.arguments(arguments)):
                model = expression(word("LCons"), item, model)
            return model
        if symbol in REMAINDERS and count == 2:
            kinds = [kind_of(argument) for argument in arguments]
            divisor = arguments[1]
            if divisor.__class__ is nodes.Constant and divisor.value.__class__ is int and divisor.value and kinds[0] in (None, "int"):
                first, later = self.operands(arguments)
                if kinds[0] == "int":
                    return expression(word("%"), *first)
                if later[0].__class__ is Symbol:
                    slow = expression(word(self.constants.name("function", symbol)), self.call("one", later[0]), later[1])
                    return expression(
                        IF, expression(IS, self.class_of(first[0]), INT), expression(word("%"), *later), self.positioned(slow, node)
                    )
        return None


__all__ = ["ARITHMETIC", "COMPARISONS", "Expression", "OperatorGenerator"]
