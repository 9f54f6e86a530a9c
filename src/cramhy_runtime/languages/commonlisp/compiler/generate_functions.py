"""Functions: from a `Lambda` node to ``defn`` or ``fn``, with its parameters and what they need done on entry.

``&optional`` parameters have Python defaults; ``&rest`` and ``&key`` take Python's rest arguments apart, and Python callers may
use keywords. A variable that must be caught anew in each turn of a loop comes as a default argument.
"""

from __future__ import annotations

from cramhy_runtime.ground.data import Cons, Symbol
from cramhy_runtime.ground.dynamic import special
from cramhy_runtime.ground.keyword_calls import GIVEN, name_of_key
from cramhy_runtime.ground.python_names import python_name
from cramhy_runtime.ground.packages import symbol_name
from . import nodes
from .core import List, Tuple, expression, word
from .arithmetic.operations import AND, FLOAT_CLASS, INT_CLASS, IS, SINGLE_CLASS, class_of, fixnum_test
from .kinds import DOUBLE, INT, SINGLE
from .arithmetic.versions import assumed, bounded, guesses
from .destinations import NONE, RETURN, RETURN_TUPLE, TRUE, Destination
from .several_values import gives_several

DEBUGGED = special(Symbol("*DEBUGGED*"), False)
"""Whether functions are compiled so that a debugger can leave their calls. It costs a block around the body."""


class FunctionGenerator:
    """The part of the `Generator` that defines functions."""

    def Lambda(self, node, destination):
        return self.finish(self.function(node), node, destination, pure=True)

    def function(self, node, name=None):
        """Emit the definition of a function and return the expression for it."""
        given = name
        if name is None:
            base = node.name.cdr.car if isinstance(node.name, Cons) else node.name
            name = self.scope.unique(python_name(symbol_name(base)) if base is not None else "Lfunction")
        if not (node.everywhere and gives_several(node)) or DEBUGGED.value:
            return self.definition(node, name, given, RETURN)
        other = self.scope.unique("Lother")
        self.assign(other, self.definition(node, name, given, RETURN_TUPLE))
        self.definition(node, name, given, RETURN)
        self.out.append(self.call("beside", word(name), word(other)))
        return word(name)

    def definition(self, node, name, given, returning):
        """Emit a function under the Python ``name`` and return the expression for it. given: the name that was asked for."""
        saved = self.out, self.frames, self.scope
        self.out, self.frames, self.scope = [], [], node.scope
        outer_before, self.before = self.before, []
        parameters = self.parameters(node)
        outer_classes, self.class_names = self.class_names, {}
        if returning is RETURN:
            self.version(node)
        for variable in node.parameters.required:
            if variable.operand_uses > 1 and not (variable.writes or variable.captured or variable.proven):
                noted = self.temporary("Lk")
                self.assign(noted, class_of(word(variable.name)))
                self.class_names[variable.name] = word(noted)
        before, self.before = self.before, outer_before
        self.gen(node.body, returning)
        self.class_names = outer_classes
        statements = self.out
        scope = node.scope
        self.out, self.frames, self.scope = saved
        self.out.extend(before)
        header = []
        names = [word(variable.name) for variable in scope.nonlocals if not variable.boxed]
        if names:
            header.append(expression(word("nonlocal"), *names))
        if scope.exits_set:
            header.append(self.setting("Lexit", 0))
        simple = not header and len(statements) == 1 and given is None and node.name is None and statements[0][0] == word("return")
        if simple:
            return self.positioned(expression(word("fn"), List(parameters), statements[0][1]), node)
        if DEBUGGED.value and (given is not None or node.name is not None):
            statements = [self.leavable(statements)]
        definition = expression(word("defn"), word(name), List(parameters), *header, *statements)
        self.out.append(self.positioned(definition, node))
        return word(name)

    def version(self, node):
        """Emit the body for arguments of the usual classes, behind a test of them, if that pays (``arithmetic/versions.py``)."""
        found = guesses(node)
        if not found:
            return
        tests = []
        for variable, kind in found.items():
            name = word(variable.name)
            tests.append(expression(IS, class_of(name), {INT: INT_CLASS, SINGLE: SINGLE_CLASS, DOUBLE: FLOAT_CLASS}[kind]))
            if kind == INT and bounded(node, variable):
                tests.append(fixnum_test(name))

        def body():
            for variable in found:
                if variable.raw:
                    self.assign(variable.name, self.call("float", word(variable.name)))
            self.gen(node.body, RETURN)

        with assumed(node, found):
            statements, _ = self.captured(body)
        self.emit(word("when"), tests[0] if len(tests) == 1 else expression(AND, *tests), *statements)

    def leavable(self, statements):
        """``statements``, the body of a function, so that a debugger can end the call or begin it anew (`frame_exits`)."""
        caught = self.temporary("Lexit")
        leave = expression(
            word("when"),
            expression(word("Lends_here"), word(caught)),
            expression(word("return"), expression(word("."), word(caught), word("value"))),
        )
        handler = expression(word("except"), List([word(caught), word("LFrameExit")]), leave)
        return expression(word("while"), TRUE, expression(word("try"), *statements, handler))

    def parameters(self, node):
        """The Python parameters of ``node``; what they need done on entry is emitted."""
        spec = node.parameters
        parameters = [word(variable.name) for variable in spec.required]
        for variable, default, supplied in spec.optional:
            plain = default is None and supplied is None
            parameters.append(List([word(variable.name), NONE if plain else word("Lunsupplied")]))
        frozen = [variable for variable in node.scope.frozen if variable.fresh]
        pythonic = spec.has_keys and spec.rest is None and not frozen and all(name_of_key(key) == var.name for var, *_, key in spec.keys)
        if spec.rest is not None or spec.has_keys:
            rest = spec.rest.name if spec.rest is not None else self.temporary(GIVEN if pythonic else "Lkeys")
            parameters.append(expression(word("unpack-iterable"), word(rest)))
        if pythonic:
            parameters += [
                List([word(variable.name), NONE if default is None and supplied is None else word("Lunsupplied")])
                for variable, default, supplied, _ in spec.keys
            ]
        if frozen and not (spec.rest is not None or spec.has_keys):
            parameters.append(word("*"))
        parameters += [List([word(variable.name), word(variable.name)]) for variable in frozen]
        if spec.has_keys:
            keywords, parser = self.temporary("Lpython"), self.temporary("Lparse")
            parameters.append(expression(word("unpack-mapping"), word(keywords)))
        for variable, default, supplied in spec.optional:
            self.default(variable, default, supplied)
        if spec.has_keys:
            table = [(key, default is None and supplied is None) for _, default, supplied, key in spec.keys]
            known = [Tuple([word(variable.name) for variable, *_ in spec.keys])] if pythonic else []
            values = expression(word(parser), word(rest), word(keywords), *known)
            self.before.append(
                self.setting(parser, self.call("key_parser", self.constant_keys(table), TRUE if spec.allow_other_keys else NONE))
            )
            sort = lambda: self.keys_in_order(spec.keys, table, word(rest), word(keywords), values, pythonic)  # noqa: E731
            if pythonic:
                statements, _ = self.captured(sort)
                self.emit(word("when"), expression(word("or"), word(rest), word(keywords)), *statements)
            else:
                sort()
        if spec.rest is not None:
            self.assign(spec.rest.name, self.call("list_from", word(spec.rest.name)))
        for variable, default, supplied, _ in spec.keys:
            self.default(variable, default, supplied)
        return parameters

    def keys_in_order(self, keys, table, rest, python, values, known):
        """Give the parameters ``keys`` their values: those in the order of the lambda list, as mostly written, are taken one by one.

        Where arguments are left over then, all are sorted by the parser: ``values``. known: parameters have a value already.
        """
        if not keys:
            self.out.append(values)
            return
        taken, last = word(self.temporary("Ltaken")), word(self.temporary("Llast"))
        self.emit(word("setv"), last, expression(word("-"), self.call("len", rest), 1))
        self.emit(word("setv"), taken, 0)
        for (variable, *_), (key, plain) in zip(keys, table, strict=True):
            found = expression(
                word("and"),
                expression(word("<"), taken, last),
                expression(word("is"), expression(word("get"), rest, taken), self.constant(key)),
            )
            take = [
                self.setting(variable.name, expression(word("get"), rest, expression(word("+"), taken, 1))),
                self.setting(taken, expression(word("+"), taken, 2)),
            ]
            self.branch(found, take, [] if known else [self.setting(variable.name, NONE if plain else word("Lunsupplied"))])
        left = expression(word("or"), expression(word("<="), taken, last), python)
        self.emit(word("when"), left, expression(word("setv"), List([word(variable.name) for variable, *_ in keys]), values))

    def constant_keys(self, table):
        return Tuple([Tuple([self.constant(key), NONE if plain else word("Lunsupplied")]) for key, plain in table])

    def default(self, variable, default, supplied):
        missing = expression(word("is"), word(variable.name), word("Lunsupplied"))
        if supplied is not None:
            self.assign(supplied.name, expression(word("if"), missing, NONE, TRUE))
        elif default is None:
            return
        value = default if default is not None else nodes.Constant(None)
        statements, _ = self.captured(lambda: self.gen(value, Destination("assign", variable.name)))
        self.emit(word("when"), missing, *statements)
