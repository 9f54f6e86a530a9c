"""From nodes to Hy: code that is made of core Hy forms with names that mean one thing.

Every node is generated for a *destination*: its value is wanted as an expression, or assigned to a name, or returned, or only
its effect is wanted. Lisp is made of expressions and Python partly of statements, so an expression may need statements before
it; where an argument does, the arguments before it are first saved in variables, because Lisp evaluates from left to right.

Exits are in ``generate_exits.py``, function definitions in ``generate_functions.py``.
"""

from __future__ import annotations

from ..data import Symbol, UndefinedFunction
from ..packages import COMMON_LISP, is_symbol, sym
from . import core, nodes
from .constants import Constants, float_model
from .core import List, expression, word
from .destinations import EFFECT, NONE, TRUE, VALUE, VALUES, Destination
from .generate_exits import ExitGenerator
from .generate_functions import FunctionGenerator


ARITHMETIC = {sym(name): f"L{function}" for name, function in (
    ("+", "add2"), ("-", "sub2"), ("*", "mul2"), ("/", "div2"), ("<", "lt2"), (">", "gt2"), ("<=", "le2"), (">=", "ge2"), ("=", "num_eq2"))}


OPERATORS = {sym(name): name for name in "+-*"}
COMPARISONS = {sym(name): name for name in ("<", ">", "<=", ">=")} | {sym("="): "="}
STEPS = {sym("1+"): sym("+"), sym("1-"): sym("-")}


class Generator(ExitGenerator, FunctionGenerator):
    """Generates one Python function at a time; `toplevel` is the entry."""

    def __init__(self, constants=None):
        self.constants = constants or Constants()
        self.out = []
        self.effects = 0
        self.frames = []
        self.scope = None
        self.destinations = {}
        self.jump_codes = {}
        self.before = []  # statements that must stand before the definition of the function being generated

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
        return getattr(self, node.__class__.__name__)(node, destination)

    def value(self, node):
        return self.gen(node, VALUE)

    def finish(self, model, node, destination, pure=False):
        """Deliver an expression to its destination."""
        kind = destination.kind
        if not destination.multiple and not node.single and kind != "effect":
            model = self.call("one", model)
        if kind == "value":
            return model
        if kind == "return":
            self.emit(word("return"), model)
        elif kind == "assign":
            self.assign(destination.name, model)
        elif not pure:
            self.out.append(model)
            self.effects += 1
        return None

    def by_statements(self, node, destination, produce):
        """Generate through ``produce(destination)``, which delivers by statements; for a value use a variable."""
        if destination.kind != "value":
            produce(destination)
            return None
        name = self.temporary()
        produce(Destination("assign", name, destination.multiple))
        return word(name)

    def stable(self, model, node):
        """Whether ``model`` means the same after later statements."""
        if isinstance(node, nodes.Constant | nodes.FunctionReference):
            return True
        if isinstance(node, nodes.LocalVariable):
            return not node.variable.assigned
        return isinstance(node, nodes.Lambda) and isinstance(model, core.Symbol)

    def arguments(self, arguments, destination=VALUE):
        """The expressions of ``arguments``, evaluated from left to right."""
        done = []
        for node in arguments:
            before = self.effects
            statements, model = self.captured(lambda node=node: self.gen(node, destination))
            if statements and self.effects != before:
                for index, (earlier, earlier_node) in enumerate(done):
                    if not self.stable(earlier, earlier_node):
                        name = self.temporary()
                        self.assign(name, earlier)
                        done[index] = word(name), nodes.Constant(None)
            self.out.extend(statements)
            done.append((model, node))
        return [model for model, _ in done]

    # -------------------------------------------------------------------------------------------------------- values, names

    def Constant(self, node, destination):
        return self.finish(self.literal(node.value), node, destination, pure=True)

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

    def LocalVariable(self, node, destination):
        return self.finish(self.reference(node.variable), node, destination, pure=True)

    def GlobalVariable(self, node, destination):
        constant = self.constant(node.symbol)
        place = expression(word("."), constant, word("value"))
        unbound = expression(word("is"), place, word("Lunbound"))
        model = expression(word("if"), unbound, self.positioned(self.call("value", constant), node), place)
        return self.finish(model, node, destination)

    def SetLocal(self, node, destination):
        variable = node.variable
        if not variable.boxed:
            self.gen(node.value, Destination("assign", variable.name))
        else:
            self.emit(word("setv"), self.reference(variable), self.value(node.value))
        return self.finish(self.reference(variable), node, destination, pure=True)

    def SetGlobal(self, node, destination):
        value = self.value(node.value)
        place = expression(word("."), self.constant(node.symbol), word("value"))
        self.emit(word("setv"), place, value)
        return self.finish(place, node, destination, pure=True)

    def FunctionReference(self, node, destination):
        if node.setf:
            model = self.call("setf_function", self.constant(node.symbol))
        elif self.standard(node.symbol):
            model = word(self.constants.name("function", node.symbol))
        else:
            model = self.call("fdefinition", self.constant(node.symbol))
        return self.finish(model, node, destination, pure=True)

    # --------------------------------------------------------------------------------------------------------------- calls

    @staticmethod
    def standard(symbol):
        """Whether ``symbol`` names a function of Common Lisp, which nobody may redefine."""
        return isinstance(symbol, Symbol) and symbol.package is COMMON_LISP and not isinstance(symbol.function, UndefinedFunction)

    def Call(self, node, destination):
        symbol = node.symbol
        arguments = self.arguments(node.arguments)
        if symbol in STEPS and len(arguments) == 1:
            symbol, arguments = STEPS[symbol], [*arguments, 1]
        if len(arguments) == 2 and symbol in ARITHMETIC:
            model = self.positioned(expression(word(ARITHMETIC[symbol]), *arguments), node)
            if symbol in OPERATORS:
                quick = self.on_integers(arguments)
                if quick is not None:
                    model = expression(word("if"), quick, expression(word(OPERATORS[symbol]), *arguments), model)
        elif symbol is NOT and len(arguments) == 1:
            model = self.call("not", *arguments)
        elif self.standard(symbol):
            model = expression(word(self.constants.name("function", symbol)), *arguments)
        elif is_symbol(symbol) and not isinstance(symbol, Symbol):
            model = self.call("undefined", self.constant(symbol), *arguments)
        else:
            model = expression(expression(word("."), self.constant(symbol), word("function")), *arguments)
        return self.finish(self.positioned(model, node), node, destination)

    @staticmethod
    def on_integers(arguments):
        """A Python test that all ``arguments`` are integers, worth making when each is a name or a number; else ``None``.

        Loops count with integers, and Python's own operator is three times as fast as a call of the generic one.
        """
        names = [each for each in arguments if isinstance(each, core.Symbol)]
        if not names or any(not isinstance(each, (core.Symbol, int)) for each in arguments):
            return None
        tests = [expression(word("is"), expression(word("."), name, word("__class__")), word("Lint"))
                 for name in dict.fromkeys(names)]
        return tests[0] if len(tests) == 1 else expression(word("and"), *tests)

    def CallLocal(self, node, destination):
        arguments = self.arguments(node.arguments)
        return self.finish(self.positioned(expression(self.reference(node.variable), *arguments), node), node, destination)

    def CallValue(self, node, destination):
        function, *arguments = self.arguments([node.function, *node.arguments])
        if not isinstance(node.function, nodes.Lambda):
            function = self.call("callable", function)
        return self.finish(self.positioned(expression(function, *arguments), node), node, destination)

    def CallSetf(self, node, destination):
        arguments = self.arguments(node.arguments)
        model = expression(self.call("setf_function", self.constant(node.symbol)), *arguments)
        return self.finish(self.positioned(model, node), node, destination)

    def CallSpread(self, node, destination):
        arguments = self.arguments([node.function])
        spread = self.arguments(node.arguments, VALUES)
        unpacked = [expression(word("unpack-iterable"), self.call("all_values", item)) for item in spread]
        return self.finish(expression(self.call("callable", arguments[0]), *unpacked), node, destination)

    def Support(self, node, destination):
        arguments = self.arguments(node.arguments, VALUES)
        return self.finish(self.positioned(self.call(node.name, *arguments), node), node, destination)

    # ------------------------------------------------------------------------------------------------------------- sequence

    def Progn(self, node, destination):
        for item in node.forms[:-1]:
            self.gen(item, EFFECT)
        return self.gen(node.forms[-1], destination)

    def MultipleValueProg1(self, node, destination):
        if not node.rest:
            return self.gen(node.first, destination)
        name = self.temporary()
        self.gen(node.first, Destination("assign", name, destination.multiple))
        for item in node.rest:
            self.gen(item, EFFECT)
        saved = nodes.Constant(None)
        return self.finish(word(name), saved, destination, pure=True)

    def LoadTimeValue(self, node, destination):
        if not hasattr(node, "name"):
            node.name = self.temporary("Lloaded")
            self.hoisted.append((node.name, node.node))
        return self.finish(word(node.name), node, destination, pure=True)

    # --------------------------------------------------------------------------------------------------------------- choice

    def test(self, node):
        """A Python expression that is true when the value of ``node`` is."""
        if isinstance(node, nodes.Constant):
            return NONE if node.value is None or node.value is False else TRUE
        if isinstance(node, nodes.Call) and node.symbol in NEGATIONS and len(node.arguments) == 1:
            return expression(word("not"), self.test(node.arguments[0]))
        if isinstance(node, nodes.If):
            test = self.test(node.test)
            then_out, then = self.captured(lambda: self.test(node.then))
            else_out, otherwise = self.captured(lambda: self.test(node.otherwise))
            if not then_out and not else_out:
                if otherwise is NONE:
                    return expression(word("and"), test, then)
                return expression(word("if"), test, then, otherwise)
            name = self.temporary()
            self.branch(test, [*then_out, self.setting(name, then)], [*else_out, self.setting(name, otherwise)])
            return word(name)
        if isinstance(node, nodes.Call) and node.symbol in COMPARISONS and len(node.arguments) == 2:
            arguments = self.arguments(node.arguments)
            slow = self.positioned(expression(word(ARITHMETIC[node.symbol]), *arguments), node)
            slow = expression(word("is-not"), slow, NONE)
            quick = self.on_integers(arguments)
            if quick is None:
                return slow
            return expression(word("if"), quick, expression(word(COMPARISONS[node.symbol]), *arguments), slow)
        value = self.value(node)
        if node.boolean:
            return expression(word("is-not"), value, NONE)
        if isinstance(node, nodes.LocalVariable) and not node.variable.boxed:
            return expression(word("and"), expression(word("is-not"), value, NONE),
                              expression(word("is-not"), value, word("False")))
        return self.call("truth", value)

    @staticmethod
    def setting(name, value):
        return expression(word("setv"), word(name), value)

    def branch(self, test, then, otherwise):
        do = word("do")
        if otherwise:
            self.emit(word("if"), test, expression(do, *then), expression(do, *otherwise))
        else:
            self.emit(word("when"), test, *then) if then else self.emit(do, test)

    def If(self, node, destination):
        if isinstance(node.test, nodes.Constant):
            return self.gen(node.then if self.test(node.test) is TRUE else node.otherwise, destination)
        test = self.test(node.test)
        then_out, then = self.captured(lambda: self.gen(node.then, destination))
        else_out, otherwise = self.captured(lambda: self.gen(node.otherwise, destination))
        if destination.kind != "value":
            self.branch(test, then_out, else_out)
            return None
        if not then_out and not else_out:
            return expression(word("if"), test, then, otherwise)
        name = self.temporary()
        self.branch(test, [*then_out, self.setting(name, then)], [*else_out, self.setting(name, otherwise)])
        return word(name)

    # ------------------------------------------------------------------------------------------------------------- binding

    def bind_variable(self, variable, value):
        self.assign(variable.name, self.call("cell", value) if variable.boxed else value)

    def Let(self, node, destination):
        values = self.arguments([value for _, value in node.bindings])
        lexical = [(variable, value) for (variable, _), value in zip(node.bindings, values) if not isinstance(variable, Symbol)]
        dynamic = [(symbol, value) for (symbol, _), value in zip(node.bindings, values) if isinstance(symbol, Symbol)]
        for variable, value in lexical:
            self.bind_variable(variable, value)
        if not dynamic:
            return self.gen(node.body, destination)
        return self.with_specials(node.body, dynamic, destination)

    def with_specials(self, body, dynamic, destination):
        def produce(inner):
            for symbol, value in dynamic:
                self.emit(word("Lbind"), self.constant(symbol), value)
            statements, _ = self.captured(lambda: self.gen(body, inner))
            undo = expression(word("finally"), self.call("unbind", len(dynamic)))
            self.emit(word("try"), *(statements or [NONE]), undo)

        return self.by_statements(body, destination, produce)

    def MultipleValueBind(self, node, destination):
        value = self.gen(node.values, VALUES)
        count = len(node.variables)
        names, dynamic, boxed = [], [], []
        for variable in node.variables:
            name = self.temporary() if isinstance(variable, Symbol) or variable.boxed else variable.name
            names.append(word(name))
            if isinstance(variable, Symbol):
                dynamic.append((variable, word(name)))
            elif variable.boxed:
                boxed.append((variable, word(name)))
        if names:
            self.emit(word("setv"), List(names), self.call("spread", value, count))
        else:
            self.out.append(value)
            self.effects += 1
        for variable, name in boxed:
            self.bind_variable(variable, name)
        if dynamic:
            return self.with_specials(node.body, dynamic, destination)
        return self.gen(node.body, destination)

    def Functions(self, node, destination):
        for variable, _ in node.functions:
            if variable.boxed:
                self.assign(variable.name, self.call("cell", NONE))
        for variable, function in node.functions:
            if variable.boxed:
                self.emit(word("setv"), self.reference(variable), self.function(function))
            else:
                self.function(function, variable.name)
        return self.gen(node.body, destination)

    # ------------------------------------------------------------------------------------------------------------- top level

    def toplevel(self, node, name="toplevel", result="Lresult"):
        """Statements (core forms) that run the top-level function ``node`` and leave its values in ``result``.

        The constants that they need must be made before: see `Constants`.
        """
        self.hoisted = []
        self.out, self.frames, self.scope = [], [], node.scope.parent or node.scope
        self.effects = 0
        self.jump_codes = {}
        function = self.function(node, name)
        statements = self.out
        while self.hoisted:
            loaded, inner = self.hoisted.pop()
            self.out = []
            called = self.function(inner, f"{loaded}_function")
            statements = [*self.out, self.setting(loaded, self.call("one", expression(called))), *statements]
        return [*statements, self.setting(result, expression(function))]


NOT = sym("NOT")
NEGATIONS = {sym("NOT"), sym("NULL")}
