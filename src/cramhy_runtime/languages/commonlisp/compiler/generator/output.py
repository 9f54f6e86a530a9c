"""The generator's core: statements that have been made, names, destinations, and the driver that goes from node to node.

Every node is generated for a *destination*: its value is wanted as an expression, or assigned to a name, or returned, or only
its effect is wanted. Lisp is made of expressions and Python partly of statements, so an expression may need statements before
it; where an argument does, the arguments before it are first saved in variables, because Lisp evaluates from left to right.

What is made of a kind of node is a function in one of the files beside this one, entered with `generates`; what its value is as a
Python test, one entered with `makes_test`. They are plain: shorter code is what the openings offer (``passes.py``).
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.packages import COMMON_LISP

from .. import core, nodes
from ..constants import Constants, float_model
from ..core import NONE, TRUE, expression, word
from ..destinations import FIRST_OF_VALUES, VALUE, Destination
from ..kinds import SINGLE, kind_of
from ..passes import ONE_VALUE

GENERATORS: dict = {}
"""Class of a node → function (generator, node, destination): an expression for a value destination, else ``None``."""
TESTS: dict = {}
"""Class of a node → function (generator, node): a Python expression that is true when the value of the node is."""

SINGLE_VALUE = nodes.Constant(None)
"""Stands for a node that gives one value."""


def generates(kind):
    """Decorator: enter a function as the one that generates nodes of ``kind``."""

    def entering(function):
        GENERATORS[kind] = function
        return function

    return entering


def makes_test(kind):
    """Decorator: enter a function as the one that makes tests of nodes of ``kind``."""

    def entering(function):
        TESTS[kind] = function
        return function

    return entering


class Generator:
    """Generates one Python function at a time."""

    def __init__(self, constants=None):
        self.constants = constants or Constants()
        self.out = []
        self.effects = 0
        self.frames = []
        self.scope = None
        self.destinations = {}
        self.jump_codes = {}
        self.cases = []  # the ``handler-case`` forms around in which a function of `JUMPS` is called, see `catching_statements`
        self.before = []  # statements that must stand before the definition of the function being generated
        self.hoisted = []  # (name, node) of the values that are computed when the code is loaded

    # ------------------------------------------------------------------------------------------------------------- output

    def emit(self, *items, pure=False):
        self.out.append(expression(*items))
        if not pure:
            self.effects += 1

    def call(self, name, *arguments):
        """A call of a support function: ``call("one", x)`` is ``(Lone x)``."""
        return expression(word("L" + name), *arguments)

    def assign(self, name, value):
        self.emit(word("setv"), word(name), value)

    def captured(self, produce):
        """(statements, result) of ``produce``, its statements kept apart."""
        outer, self.out = self.out, []
        try:
            result = produce()
            return self.out, result
        finally:
            self.out = outer

    def temporary(self, base="Lt"):
        return self.scope.unique(base)

    def constant(self, obj):
        return word(self.constants.name("object", obj))

    def positioned(self, model, node):
        position = node.position
        if position is not None and model.__class__ is core.Expression:
            model.position = position
        return model

    # ------------------------------------------------------------------------------------------------------------- driver

    def gen(self, node, destination):
        """Generate ``node``; for a value destination return the expression, else ``None``."""
        return GENERATORS[node.__class__](self, node, destination)

    def value(self, node):
        return self.gen(node, VALUE)

    def finish(self, model, node, destination, pure=False, raw=False):
        """Deliver an expression to its destination. ``raw``: singles among its values are Python's floats."""
        kind = destination.kind
        if not destination.multiple and not node.single and kind != "effect":
            model = self.first_value(model)
        if raw is not destination.raw and kind != "effect":
            model = self.wrapped(model, kind_of(node)) if raw else self.unwrapped(model, kind_of(node))
        if kind == "value":
            return model
        if kind == "return":
            self.emit(word("return"), model if destination.through is None else destination.through(self, model))
        elif kind == "assign":
            self.assign(destination.name, model)
        elif not pure:
            self.out.append(model)
            self.effects += 1
        return None

    def first_value(self, model):
        """The first of the values of ``model``; nearly always it is the only one."""
        value = word("Lv")
        several = expression(
            word("is-not"), expression(word("."), expression(word("setx"), value, model), word("__class__")), word("LMultipleValues")
        )
        return expression(word("if"), several, value, self.call("one", value))

    def wrapped(self, model, kind):
        """``model``, a raw value of ``kind``, as Lisp sees it."""
        if model.__class__ is float:
            return self.constant(SingleFloat(model))
        return self.call("new_single" if kind == SINGLE else "wrapped", model)

    def unwrapped(self, model, kind):
        """``model``, a value of ``kind`` as Lisp sees it, raw. 0 stands for a kind that is not known."""
        if kind and not kind & SINGLE:
            return model
        return self.call("float" if kind == SINGLE else "unwrapped", model)

    def by_statements(self, node, destination, produce):
        """Generate through ``produce(destination)``, which delivers by statements; for a value use a variable."""
        if destination.kind != "value":
            produce(destination)
            return None
        name = self.temporary()
        produce(Destination("assign", name, destination.multiple, destination.raw))
        return word(name)

    def stable(self, model, node):
        """Whether ``model`` means the same after later statements."""
        if isinstance(node, nodes.Constant | nodes.FunctionReference):
            return True
        if isinstance(node, nodes.LocalVariable):
            return not node.variable.assigned
        return isinstance(node, nodes.Lambda) and isinstance(model, core.Symbol)

    def arguments(self, arguments, destination=VALUE):
        """The expressions of ``arguments``, evaluated from left to right. ``destination``: that of all, or a list with that of each."""
        done = []
        for index, node in enumerate(arguments):
            before = self.effects
            where = destination[index] if destination.__class__ is list else destination
            statements, model = self.captured(lambda node=node, where=where: self.gen(node, where))
            if statements and self.effects != before:
                for index, (earlier, earlier_node) in enumerate(done):
                    if not self.stable(earlier, earlier_node):
                        name = self.temporary()
                        self.assign(name, earlier)
                        done[index] = word(name), nodes.Constant(None)
            self.out.extend(statements)
            done.append((model, node))
        return [model for model, _ in done]

    def stable_names(self, models):
        """``models``, evaluated and named as far as that is needed to use them twice."""
        done = []
        for model in models:
            if model.__class__ in (core.Expression, core.List, core.Tuple):
                name = self.temporary()
                self.assign(name, model)
                model = word(name)
            done.append(model)
        return done

    def literal(self, value):
        if value is None or value is False:
            return NONE
        if value is True:
            return TRUE
        kind = type(value)
        if kind is str:
            return value
        if kind is int and abs(value) < 1 << 64:
            return value
        if kind is float:
            return float_model(value)
        return self.constant(value)

    def reference(self, variable):
        name = word(variable.name)
        return expression(word("."), name, word("v")) if variable.boxed else name

    @staticmethod
    def standard(symbol, package=COMMON_LISP):
        """Whether ``symbol`` names a function of Common Lisp, or of the other ``package``, which nobody may redefine."""
        return isinstance(symbol, Symbol) and symbol.package is package and not isinstance(symbol.function, UndefinedFunction)

    @staticmethod
    def truth_value(test):
        """t or nil for a Python test."""
        return expression(word("if"), test, TRUE, NONE)

    def test(self, node):
        """A Python expression that is true when the value of ``node`` is."""
        return TESTS.get(node.__class__, test_of_value)(self, node)

    @staticmethod
    def setting(name, value):
        return expression(word("setv"), word(name), value)

    def branch(self, test, then, otherwise):
        do = word("do")
        if otherwise and not then:
            self.emit(word("when"), expression(word("not"), test), *otherwise)
        elif otherwise:
            self.emit(word("if"), test, expression(do, *then), expression(do, *otherwise))
        else:
            self.emit(word("when"), test, *then) if then else self.emit(do, test)


def test_of_value(generator, node):
    """The test of a node whose value is looked at when it has been computed."""
    if node.boolean:
        return expression(word("is-not"), generator.value(node), NONE)
    model = generator.gen(node, FIRST_OF_VALUES)
    if model.__class__ is not core.Expression:
        return generator.call("truth", model if node.single else generator.call("one", model))
    value = word("Lv")
    true = [expression(word("is-not"), expression(word("setx"), value, model), NONE), expression(word("is-not"), value, word("False"))]
    if not node.single and not (node.__class__ is nodes.Call and node.symbol in ONE_VALUE):
        single = expression(word("is-not"), expression(word("."), value, word("__class__")), word("LMultipleValues"))
        true.append(expression(word("or"), single, generator.call("truth", generator.call("one", value))))
    return expression(word("and"), *true)
