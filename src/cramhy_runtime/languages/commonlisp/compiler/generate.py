"""From nodes to Hy: code that is made of core Hy forms with names that mean one thing.

Every node is generated for a *destination*: its value is wanted as an expression, or assigned to a name, or returned, or only
its effect is wanted. Lisp is made of expressions and Python partly of statements, so an expression may need statements before
it; where an argument does, the arguments before it are first saved in variables, because Lisp evaluates from left to right.

Exits are in ``generate_exits.py``, function definitions in ``generate_functions.py``, texts in ``generate_texts.py``.
"""

from __future__ import annotations

from cramhy_runtime.ground.data import Symbol, UndefinedFunction
from cramhy_runtime.ground.floats import SingleFloat
from cramhy_runtime.ground.dispatch.reached_slots import written_attribute
from cramhy_runtime.ground.packages import COMMON_LISP, CRAMHY, is_symbol, sym
from . import core, nodes
from .constants import Constants, float_model
from .core import expression, word
from .destinations import EFFECT, FIRST_OF_VALUES, NONE, RAW, RETURN_TUPLE, TRUE, VALUE, VALUES, Destination
from .facts import study, walk
from .generate_calls import GETHASH, SLOT_VALUE, CallGenerator, slot_named_by
from .generate_exits import ERROR, ExitGenerator
from .generate_functions import FunctionGenerator
from .arithmetic.functions import NUMBER_FUNCTIONS
from .generate_operators import ARITHMETIC, COMPARISONS, KNOWN_PARTS, MOST_TERMS, NEGATIONS, OperatorGenerator
from .generate_texts import TextGenerator
from .loop_shapes import CHANGES
from .kinds import BOOLEAN, MAX, MIN, MINUS, OPERATORS, PI, PLUS, STEPS, THING, WHOLE, kind_of


COLLECT, CONS, FORMAT = map(sym, "CRAMHY::COLLECT CONS FORMAT".split())
KNOWN_SETTERS = {sym(name) for name in "GETHASH AREF SVREF ELT NTH GET CHAR".split()}
"""Functions of Common Lisp whose ``setf`` is a function, which nobody may redefine or give methods."""


SINGLE_VALUE = nodes.Constant(None)
"""Stands for a node that gives one value."""


class Generator(CallGenerator, ExitGenerator, FunctionGenerator, OperatorGenerator, TextGenerator):
    """Generates one Python function at a time; `toplevel` is the entry."""

    def __init__(self, constants=None):
        self.constants = constants or Constants()
        self.out = []
        self.effects = 0
        self.frames = []
        self.scope = None
        self.destinations = {}
        self.jump_codes = {}
        self.class_names = {}  # names of parameters → names of variables that hold their classes
        self.cases = []  # the ``handler-case`` forms around in which an error is signalled, see `catching`
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
            self.emit(word("return"), self.tuple_of_values(model) if destination is RETURN_TUPLE else model)
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

    # -------------------------------------------------------------------------------------------------------- values, names

    def Constant(self, node, destination):
        if destination.raw and node.value.__class__ is SingleFloat:
            return self.finish(float_model(float(node.value)), node, destination, pure=True, raw=True)
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
        return self.finish(self.reference(node.variable), node, destination, pure=True, raw=node.variable.raw)

    def GlobalVariable(self, node, destination):
        if node.symbol is PI:
            return self.finish(PI.value, SINGLE_VALUE, destination, pure=True)
        constant, value = self.constant(node.symbol), word("Lv")
        place = expression(word("."), constant, word("value"))
        bound = expression(word("is-not"), expression(word("setx"), value, place), word("Lunbound"))
        model = expression(word("if"), bound, value, self.positioned(self.call("value", constant), node))
        return self.finish(model, node, destination)

    def SetLocal(self, node, destination):
        variable = node.variable
        if destination.kind == "effect" and not variable.boxed:
            grown = word(variable.name)
            if self.grows(node, COLLECT, 0):
                cell = self.new_cell(node.value.arguments[1], NONE)
                self.emit(word("setv"), expression(word("."), grown, word("cdr")), cell)
                self.emit(word("setv"), grown, cell)
                return None
            if self.grows(node, CONS, 1):  # as push writes it
                cell = self.new_cell(node.value.arguments[0], grown)
                self.emit(word("setv"), grown, cell)
                self.emit(word("setv"), cell, NONE)  # or it would keep the list for as long as the function runs
                return None
        if not variable.boxed:
            self.gen(node.value, Destination("assign", variable.name, raw=variable.raw))
        else:
            self.emit(word("setv"), self.reference(variable), self.value(node.value))
        return self.finish(self.reference(variable), node, destination, pure=True, raw=variable.raw)

    @staticmethod
    def grows(node, symbol, position):
        """Whether ``node`` gives a variable the value of a call of ``symbol`` with the variable itself as argument ``position`` of two."""
        value = node.value
        if value.__class__ is not nodes.Call or value.symbol is not symbol or len(value.arguments) != 2:
            return False
        argument = value.arguments[position]
        return argument.__class__ is nodes.LocalVariable and argument.variable is node.variable

    def new_cell(self, item, rest):
        """The name of a new cons of ``item``, a node, and ``rest``. It is made without its constructor, a call of a Python function."""
        cell, item = word(self.temporary("Lnew")), self.value(item)
        self.emit(word("setv"), cell, expression(word("Lnew_object"), word("LCons")))
        self.emit(word("setv"), expression(word("."), cell, word("car")), item)
        self.emit(word("setv"), expression(word("."), cell, word("cdr")), rest)
        return cell

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
    def standard(symbol, package=COMMON_LISP):
        """Whether ``symbol`` names a function of Common Lisp, or of the other ``package``, which nobody may redefine."""
        return isinstance(symbol, Symbol) and symbol.package is package and not isinstance(symbol.function, UndefinedFunction)

    def Call(self, node, destination):
        symbol, arguments = node.symbol, node.arguments
        if symbol in STEPS and len(arguments) == 1:
            symbol, arguments = STEPS[symbol], [*arguments, nodes.Constant(1)]
        standard = self.standard(symbol) and destination.kind != "effect"
        if standard and 2 < len(arguments) <= MOST_TERMS and (symbol in OPERATORS or symbol is MAX or symbol is MIN):
            arguments = self.nested(node)
            if arguments is None:
                return self.gen(self.named_arguments(node), destination)
        if standard and len(arguments) == 2 and symbol in ARITHMETIC:
            if symbol not in COMPARISONS:
                model, raw = self.arithmetic(node, symbol, arguments, destination.raw)
                return self.finish(model, node, destination, raw=raw)
            return self.finish(self.truth_value(self.comparison(node, symbol, arguments)), node, destination)
        if standard and symbol in NUMBER_FUNCTIONS:
            found = self.number_function(node, symbol, arguments, destination.multiple and destination is not FIRST_OF_VALUES)
            if found is not None:
                return self.finish(found[0], SINGLE_VALUE if symbol in WHOLE else node, destination, raw=found[1])
        if symbol in NEGATIONS and len(arguments) == 1:
            return self.finish(self.truth_value(expression(word("not"), self.test(arguments[0]))), node, destination)
        if standard or symbol in KNOWN_PARTS:
            test = self.small_test(node, symbol, arguments)
            if test is not None:
                return self.finish(self.truth_value(test), node, destination)
            model = self.small_function(node, symbol, arguments)
            if model is not None:
                return self.finish(model, node, destination)
        if standard:
            model = self.open_call(node, symbol, arguments, destination)
            if model is not None:
                return self.finish(model, nodes.Constant(None), destination)
        if symbol is ERROR and self.cases and self.cases[-1][-1] is self.scope and arguments and self.standard(symbol):
            return self.error_in_case(node, arguments, destination)
        if symbol in CHANGES and len(arguments) == 2 and self.standard(symbol):
            return self.by_statements(node, destination, lambda inner: self.pushed(node, arguments, inner))
        if symbol is FORMAT:
            model = self.text(node, arguments)
            if model is not None:
                return self.finish(model, node, destination)
        models = self.arguments(arguments)
        model = self.keyword_call(node, symbol, models, arguments)
        if model is not None:
            return self.finish(model, node, destination)
        model = self.slot_read(node, symbol, models)
        if model is not None:
            return self.finish(model, nodes.Constant(None), destination)
        model = self.through_object(node, symbol, models)
        if model is not None:
            return self.finish(model, node, destination)
        if self.standard(symbol) or self.standard(symbol, CRAMHY):
            model = self.standard_function(symbol, models, arguments)
        elif is_symbol(symbol) and not isinstance(symbol, Symbol):
            model = self.call("undefined", self.constant(symbol), *models)
        else:  # named, because Python takes longer to call an attribute of an object with slots
            function = expression(word("setx"), word("Lf"), expression(word("."), self.constant(symbol), word("function")))
            model = expression(function, *models)
        return self.finish(self.positioned(model, node), node, destination)

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

    def through_object(self, node, symbol, models):
        """A call of a generic function that looks at the class of its first argument only: that is looked up right here; or ``None``."""
        if not isinstance(symbol, Symbol) or not models or getattr(symbol.function, "by_first_of", None) != len(models):
            return None
        models = self.stable_names(models)
        table = word(self.constants.name("unary" if len(models) == 1 else "binary", symbol))
        known = expression(expression(word("."), table, word("get")), expression(word("."), models[0], word("__class__")))
        chosen = expression(word("or"), known, expression(word("."), self.constant(symbol), word("function")))
        return self.positioned(expression(chosen, *models), node)

    @staticmethod
    def truth_value(test):
        """t or nil for a Python test."""
        return expression(word("if"), test, TRUE, NONE)

    def CallLocal(self, node, destination):
        arguments = self.arguments(node.arguments)
        return self.finish(self.positioned(expression(self.reference(node.variable), *arguments), node), node, destination)

    def CallValue(self, node, destination):
        function, *arguments = self.arguments([node.function, *node.arguments])
        if not isinstance(node.function, nodes.Lambda):
            if function.__class__ is core.Symbol:
                name = function
            else:
                name = word(self.temporary())
                function = expression(word("setx"), name, function)
            plain = expression(word("is"), expression(word("."), function, word("__class__")), word("LFunction"))
            function = expression(word("if"), plain, name, self.call("callable", name))
        return self.finish(self.positioned(expression(function, *arguments), node), node, destination)

    def CallSetf(self, node, destination):
        stored = self.store(node)
        if stored is not None:
            return self.finish(stored, SINGLE_VALUE, destination, pure=True)
        if node.symbol is GETHASH and len(node.arguments) == 3:
            return self.by_statements(node, destination, lambda inner: self.entry_written(node, inner))
        arguments = self.arguments(node.arguments)
        if (attribute := written_attribute(node.symbol)) is not None and len(arguments) == 2:
            return self.by_statements(node, destination, lambda inner: self.slot_written(node, attribute, arguments, inner))
        if node.symbol is SLOT_VALUE and len(arguments) == 3 and (named := slot_named_by(node.arguments[2])) is not None:
            return self.by_statements(node, destination, lambda inner: self.named_slot_written(node, named, arguments, inner))
        if node.symbol in KNOWN_SETTERS:
            setter = word(self.constants.name("setf_function", node.symbol))
        else:
            setter = self.call("setf_function", self.constant(node.symbol))
        return self.finish(self.positioned(expression(setter, *arguments), node), node, destination)

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
        self.gen(node.first, Destination("assign", name, destination.multiple, destination.raw))
        for item in node.rest:
            self.gen(item, EFFECT)
        saved = nodes.Constant(None)
        return self.finish(word(name), saved, destination, pure=True, raw=destination.raw)

    def LoadTimeValue(self, node, destination):
        if not hasattr(node, "name"):
            node.name = self.constants.own_name("Lloaded")  # a global: functions of other forms have theirs beside it
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
        if isinstance(node, nodes.Let) and not any(isinstance(variable, Symbol) for variable, _ in node.bindings):
            self.bind(node.bindings, node.body)
            return self.test(node.body)
        if isinstance(node, nodes.Call) and self.standard(node.symbol):
            if node.symbol in COMPARISONS and len(node.arguments) == 2:
                return self.comparison(node, node.symbol, node.arguments)
            test = self.small_test(node, node.symbol, node.arguments) or self.open_test(node, node.symbol, node.arguments)
            if test is not None:
                return test
        if node.boolean:
            return expression(word("is-not"), self.value(node), NONE)
        if isinstance(node, nodes.LocalVariable):
            kind, value = node.variable.kind, self.reference(node.variable)
            if kind and not kind & (BOOLEAN | THING):
                return TRUE
            true = expression(word("is-not"), value, NONE)
            return true if not kind & THING else expression(word("and"), true, expression(word("is-not"), value, word("False")))
        model = self.gen(node, FIRST_OF_VALUES)
        if model.__class__ is not core.Expression:
            return self.call("truth", model if node.single else self.call("one", model))
        value = word("Lv")
        true = [expression(word("is-not"), expression(word("setx"), value, model), NONE), expression(word("is-not"), value, word("False"))]
        if not node.single and not (node.__class__ is nodes.Call and node.symbol is GETHASH):
            single = expression(word("is-not"), expression(word("."), value, word("__class__")), word("LMultipleValues"))
            true.append(expression(word("or"), single, self.call("truth", self.call("one", value))))
        return expression(word("and"), *true)

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

    @staticmethod
    def alike(variable, other, forms):
        """Whether ``variable``, bound to the value of ``other`` while ``forms`` run, can do without a Python variable of its own."""
        if variable.writes or variable.captured or other.boxed or variable.owner is not other.owner or variable.raw is not other.raw:
            return False
        if not other.writes:
            return True
        return not other.captured and not any(item.__class__ is nodes.SetLocal and item.variable is other for item in walk(forms))

    def bind_variable(self, variable, value):
        self.assign(variable.name, self.call("cell", value) if variable.boxed else value)

    @staticmethod
    def modification(node):
        """The body of ``(let ((delta value)) (setq place (+ place delta)))``, as ``incf`` makes it, with the value in place of delta.

        ``None`` if the body is another, or if the value may change the place: then the sum must read the place after it.
        """
        (variable, value), body = node.bindings[0], node.body
        if len(node.bindings) > 1 or isinstance(variable, Symbol) or body.__class__ is not nodes.SetLocal:
            return None
        call, place = body.value, body.variable
        if call.__class__ is not nodes.Call or call.symbol not in (PLUS, MINUS) or len(call.arguments) != 2:
            return None
        if [each.variable if each.__class__ is nodes.LocalVariable else None for each in call.arguments] != [place, variable]:
            return None
        if variable.reads != 1 or variable.writes or place.captured:
            return None
        if any(item.__class__ is nodes.SetLocal and item.variable is place for item in walk([value])):
            return None
        sum_ = nodes.Call(call.symbol, [call.arguments[0], value])
        sum_.single, sum_.position = True, call.position
        changed = nodes.SetLocal(place, sum_)
        changed.position = body.position
        return changed

    def Let(self, node, destination):
        if node.bindings and (body := self.modification(node)) is not None:
            return self.gen(body, destination)
        dynamic = self.bind(node.bindings, node.body)
        return self.with_specials(node.body, dynamic, destination) if dynamic else self.gen(node.body, destination)

    def bind(self, pairs, body):
        """Emit the bindings ``pairs`` of the lexical variables of a ``let``; gives those of the specials, symbols with their values."""
        bindings = []
        for variable, value in pairs:
            plain = not isinstance(variable, Symbol) and value.__class__ is nodes.LocalVariable
            if plain and self.alike(variable, value.variable, [body, *(other for _, other in pairs)]):
                variable.name = value.variable.name
            else:
                bindings.append((variable, value))
        wanted = [RAW if getattr(variable, "raw", False) else VALUE for variable, _ in bindings]
        values = self.arguments([value for _, value in bindings], wanted)
        for (variable, _), value in zip(bindings, values):
            if not isinstance(variable, Symbol):
                self.bind_variable(variable, value)
        return [(symbol, value) for (symbol, _), value in zip(bindings, values) if isinstance(symbol, Symbol)]

    def with_specials(self, body, dynamic, destination):
        def produce(inner):
            for symbol, value in dynamic:
                self.emit(word("Lbind"), self.constant(symbol), value)
            statements, _ = self.captured(lambda: self.gen(body, inner))
            undo = expression(word("finally"), self.call("unbind", len(dynamic)))
            self.emit(word("try"), *(statements or [NONE]), undo)

        return self.by_statements(body, destination, produce)

    def MultipleValueBind(self, node, destination):
        names, dynamic, boxed = [], [], []
        for variable in node.variables:
            name = self.temporary() if isinstance(variable, Symbol) or variable.boxed else variable.name
            names.append(word(name))
            if isinstance(variable, Symbol):
                dynamic.append((variable, word(name)))
            elif variable.boxed:
                boxed.append((variable, word(name)))
        if names:
            self.assign_values(names, node.values)
        else:
            self.out.append(self.gen(node.values, VALUES))
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
        study(node)
        function = self.function(node, name)
        statements = self.out
        while self.hoisted:
            loaded, inner = self.hoisted.pop()
            self.out = []
            called = self.function(inner, f"{loaded}_function")
            statements = [*self.out, self.setting(loaded, self.call("one", expression(called))), *statements]
        return [*statements, self.setting(result, expression(function))]
