"""What an operator's call stands for, in Hy: the expansion that its declaration gives for Lisp, written with Hy's bodies.

The operator's expander makes a Lisp form of the call's parts, which `call_parts` finds. It consists of a few of Lisp's own operators,
``lambda``, ``let``, ``flet``, ``quote`` and the like, and of calls of functions; `Translation` says each in Hy. So a lambda is a ``fn``
with the user's parameters, what is quoted is a constant, and the user's code stands in the middle as it was written, with its lines.

A ``block`` named nil, which ``return`` leaves in Lisp, is left by ``(leave value)``: Hy's ``return`` belongs to the function around it.
`operator_bodies` says what the bodies assign, and where ``return`` may stand.
"""

from __future__ import annotations

import builtins
import functools

import hy
from hy import models

from cramhy_runtime.lisp_core.classes import find_class
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.packages import common, is_symbol, sym
from ..commonlisp.syntax.macros import ensure_loaded, macroexpand_1
from .call_parts import Code, without_code
from .lisp_data import call_of, constant_form, function_form, is_simple
from .module_names import binds, if_global
from .operator_bodies import CLAUSE, hidden

LEAVE, RETURN = models.Symbol("leave"), models.Symbol("return")

DEFINITIONS = ("DEF", "DECLARE-GOAL", "MAKE-POLICY", "FLET*", "REGISTER-", "REPLACEABLE-FUNCTION", "WITH-PRODUCTION-HANDLERS")
"""How the names of the operators begin whose bodies are functions of the user's: he gives them a name, or parameters."""

VARIABLES = ("DEFINE-HOOK", "DEFINE-POLICY", "DEFINE-TASK-VARIABLE", "DEFINE-SPECIAL-PROJECTION-VARIABLE")
"""The operators whose first part names a variable: in Hy it has what the definition gives. A special one is read by ``name.value``."""


def expression(*parts):
    return models.Expression([models.as_model(part) for part in parts])


def word(name):
    return models.Symbol(name)


class Translation:
    """The expansion of one call of an operator, a `Call`, for the compiler of Hy."""

    def __init__(self, compiler, call, operator):
        self.compiler = compiler
        self.call = call
        self.operator = operator
        self.is_definition = operator.name.startswith(DEFINITIONS)
        self.fresh = {}  # a symbol that the expander made → a Hy symbol
        self.local_functions = frozenset()  # the names of the flets around
        self.depth = 0  # how many functions of the expansion are around
        self.depths = {}  # variable of a let of the expansion → the depth of the let
        self.reached = set()  # those of them that an inner function assigns

    # ------------------------------------------------------------------------------------------------------------- into Hy

    def hy(self, form):
        """The Hy model of a Lisp form of the expansion."""
        if isinstance(form, Code):
            return form.model
        if isinstance(form, Cons):
            return self.compound(form)
        if isinstance(form, Keyword):
            return constant_form(form)
        if isinstance(form, Symbol):
            return self.variable(form)
        if form is None or form is True or is_simple(form):
            return models.as_model(form)
        if isinstance(form, models.Object):
            return form
        return constant_form(form)

    def variable(self, symbol):
        if symbol in self.call.names:
            return self.call.names[symbol]
        made = self.fresh.get(symbol)
        if made is None:
            name = symbol.name.lower()
            made = self.fresh[symbol] = hy.gensym(name) if symbol.package is None else word(name)
        return made

    def compound(self, form):
        written = self.call.written_as(form)
        if written is not None:
            return written
        head = form.car
        if isinstance(head, Cons):  # ((lambda ...) ...)
            return expression(self.hy(head), *map(self.hy, form.cdr or ()))
        if isinstance(head, Code):
            return expression(head.model, *map(self.hy, form.cdr or ()))
        method = _forms().get(head) if is_symbol(head) else None
        if method is not None:
            return method(self, *(form.cdr or ()))
        if head in self.call.names and head.macro is None and isinstance(head.function, UndefinedFunction):  # a function of Hy
            return expression(self.call.names[head], *map(self.hy, form.cdr or ()))
        expanded, more = macroexpand_1(form)
        if more:
            return self.hy(expanded)
        return expression(self.function(head), *map(self.hy, form.cdr or ()))

    def function(self, symbol):
        if symbol in self.local_functions:
            return self.variable(symbol)
        return function_form(symbol.package.name, symbol.name)

    def body(self, forms):
        made = [self.hy(form) for form in forms if not _is_declaration(form)]
        return made or [word("None")]

    def parameters(self, lambda_list):
        """The Hy parameters of a lambda list: as they were written, or with Hy's signs for Lisp's."""
        written = self.call.written_as(lambda_list)
        if written is not None:
            return models.List(written)
        made, sign, optional = [], None, False
        for item in lambda_list or ():
            if isinstance(item, Symbol) and item.name.startswith("&"):
                sign, optional = {"&REST": "#*", "&BODY": "#*"}.get(item.name), item.name in ("&OPTIONAL", "&KEY")
                if item.name == "&KEY":
                    made.append(word("*"))
                continue
            if isinstance(item, Code):
                made.append(item.model)
                continue
            name = self.variable(item.car if isinstance(item, Cons) else item)
            default = self.hy(item.cdr.car) if isinstance(item, Cons) and item.cdr is not None else word("None")
            if sign:
                made.append(expression(word("unpack-iterable"), name))
            else:
                made.append(models.List([name, default]) if optional else name)
        return models.List(made)

    # ------------------------------------------------------------------------------------------- Lisp's own operators in Hy

    def lambda_(self, parameters, *forms):
        return self.function_of(parameters, forms, None if self.is_definition else self.body_name(parameters))

    def body_name(self, parameters):
        """What `operator_bodies` calls the function with these parameters: by the operator, or a clause."""
        name = self.operator.name.lower()
        if name == "with-failure-handling" and not (parameters is not None and parameters.cdr is None and _is_fresh(parameters.car)):
            return CLAUSE
        return name

    def function_of(self, parameters, forms, body_of=None):
        """The ``fn`` of a lambda. body_of: the operator whose body it is, if it is one."""
        rest = _rest_parameter(parameters)
        self.depth += 1
        body = self.body(forms)
        self.depth -= 1
        written = self.call.written_as(parameters) is not None
        if rest is not None and not written:  # Lisp has the rest as a list of its own
            name = self.variable(rest)
            body = [expression(word("setv"), name, expression(call_of("lisp-list"), expression(word("unpack-iterable"), name))), *body]
        made = expression(word("fn"), self.parameters(parameters), *body)
        if body_of is not None:
            made = hidden(made, body_of)
        if written and any(map(_takes_keywords, made[1])):
            return expression(call_of("lispify"), made)  # the caller passes keywords as objects
        return made

    def progn(self, *forms):
        made = self.body(forms)
        return made[0] if len(made) == 1 else expression(word("do"), *made)

    def quote(self, data):
        if isinstance(data, Symbol) and data in self.call.functions:
            return expression(call_of("publish"), constant_form(data), self.call.names[data])
        if isinstance(data, Cons) and data.car is sym("OR") and any(part in self.call.types for part in data.cdr or ()):
            return expression(call_of("lisp-list"), constant_form(data.car), *map(self.quote, data.cdr))
        if isinstance(data, Symbol) and data in self.call.types and data in self.call.names:
            return self.failure_type(data, self.call.names[data])
        return constant_form(without_code(data, self.call.package))

    def failure_type(self, symbol, name):
        """The type of a handler: the class of Hy that ``name`` means if there is one, else the Lisp type of the symbol."""
        lisp, found = constant_form(symbol), hy.mangle(name)
        asked = expression(call_of("failure-type"), lisp, expression(word("fn"), models.List(), name))
        there = if_global(self.compiler, found)
        if there is None:
            return asked
        of_hy = expression(word("or"), expression(call_of("failure-class"), name), lisp)
        if hasattr(builtins, found):
            return of_hy
        return expression(word("if"), there, of_hy, lisp if common(symbol) and find_class(symbol) is not None else asked)

    def let(self, bindings, *forms):
        pairs = []
        for binding in bindings or ():
            name, *value = binding if isinstance(binding, Cons) else (binding,)
            pairs += [name.model if isinstance(name, Code) else self.variable(name), self.hy(value[0] if value else None)]
            if isinstance(name, Symbol):
                self.depths[name] = self.depth
        body = self.body(forms)
        if not self.reached.isdisjoint(name.car if isinstance(name, Cons) else name for name in bindings or ()):
            # Hy's nonlocal does not reach a let of a module; so the variables are those of a function
            return expression(expression(word("fn"), models.List(), expression(word("setv"), *pairs), *body))
        return expression(word("let"), models.List(pairs), *body)

    def block(self, name, *forms):
        if name is not None and name.package is None:  # the expander's own
            leave = self.variable(name)
        elif name is None and any(_mentions(form, self, word) for form in forms for word in (LEAVE, RETURN)):
            leave = LEAVE
        else:
            return self.progn(*forms)
        # no try in place: Hy runs its statements before the arguments that stand before it
        around = expression(word("fn"), models.List([leave]), *self.body(forms))
        return expression(call_of("block"), hidden(around, "block" if self.is_definition else self.operator.name.lower()))

    def return_from(self, name, value=None):
        return expression(self.variable(name), self.hy(value))

    def with_tags(self, *forms):
        macro = models.Expression(map(models.Symbol, (".", "hy", "R", "cramhy/bodies", "with-tags")))
        return expression(macro, *self.body(forms))

    def if_(self, test, then, otherwise=None):
        return expression(word("if"), self.hy(test), self.hy(then), self.hy(otherwise))

    def and_(self, *forms):
        return expression(word("and"), *map(self.hy, forms))

    def or_(self, *forms):
        return expression(word("or"), *map(self.hy, forms))

    def flet(self, functions, *forms):
        before = self.local_functions
        pairs = []
        for name, parameters, *body in functions or ():
            pairs += [self.variable(name), self.function_of(parameters, body)]
            binds(self.compiler, hy.mangle(pairs[-2]))
            if name.package is not None:  # the user may write cut:cont for cont
                for prefix in map(str.lower, name.package.names):
                    alias = word(f"{prefix}:{name.name.lower()}")
                    pairs += [alias, self.variable(name)] if any(_mentions(form, self, alias) for form in forms) else []
        self.local_functions = before | {function.car for function in functions or ()}
        try:
            return expression(word("let"), models.List(pairs), *self.body(forms))
        finally:
            self.local_functions = before

    def list_(self, *forms):
        made = None
        for form in reversed(forms):
            item = self.hy(form)
            if isinstance(form, Symbol) and form.name.startswith("?"):  # a variable in a designator
                item = expression(call_of("as-lisp"), item)
            made = expression(call_of("Cons"), item, made)
        return models.as_model(made)

    def funcall(self, function, *arguments):
        return expression(self.hy(function), *map(self.hy, arguments))

    def apply(self, function, *arguments):
        *first, last = arguments
        return expression(
            self.hy(function),
            *map(self.hy, first),
            expression(word("unpack-iterable"), expression(word("or"), self.hy(last), models.List())),
        )

    def function_(self, name):
        return self.lambda_(*name.cdr) if isinstance(name, Cons) else self.function(name)

    def unwind_protect(self, form, *cleanup):
        return expression(word("try"), self.hy(form), expression(word("finally"), *self.body(cleanup)))

    def setf(self, place, value):
        made = hy.gensym("value")
        target = place.model if isinstance(place, Code) else self.hy(place)
        outer = []
        if isinstance(place, Symbol) and self.depths.get(place, self.depth) < self.depth:
            self.reached.add(place)
            outer = [expression(word("nonlocal"), target)]
        return expression(word("do"), *outer, expression(word("setv"), made, self.hy(value)), expression(word("setv"), target, made), made)

    def defun(self, name, parameters, *forms):
        definition = expression(word("defn"), self.variable(name), *self.function_of(parameters, forms)[1:])
        return expression(word("do"), definition, expression(call_of("publish"), constant_form(name), self.variable(name)))

    def use_package(self, name):
        return expression(call_of("use-package"), self.hy(name), models.String(self.call.package.name))

    def prog1(self, first, *forms):
        made = hy.gensym("first")
        return expression(word("do"), expression(word("setv"), made, self.hy(first)), *self.body(forms), made)

    def nothing(self, *forms):
        return word("None")


_FORMS = {
    "LAMBDA": Translation.lambda_,
    "CRAMHY::NAMED-LAMBDA": lambda self, name, parameters, *forms: self.lambda_(parameters, *forms),
    "PROGN": Translation.progn,
    "QUOTE": Translation.quote,
    "LET": Translation.let,
    "LET*": Translation.let,
    "BLOCK": Translation.block,
    "RETURN-FROM": Translation.return_from,
    "CPL-IMPL::WITH-TAGS": Translation.with_tags,
    "IF": Translation.if_,
    "AND": Translation.and_,
    "OR": Translation.or_,
    "FLET": Translation.flet,
    "LIST": Translation.list_,
    "FUNCALL": Translation.funcall,
    "APPLY": Translation.apply,
    "FUNCTION": Translation.function_,
    "UNWIND-PROTECT": Translation.unwind_protect,
    "SETF": Translation.setf,
    "SETQ": Translation.setf,
    "DEFUN": Translation.defun,
    "PROG1": Translation.prog1,
    "EVAL-WHEN": lambda self, situations, *forms: self.progn(*forms),
    "DECLAIM": Translation.nothing,
    "USE-PACKAGE": Translation.use_package,
    "VALUES": lambda self, *forms: self.progn(*forms),
}
"""Lisp's operator → what it is in Hy."""


@functools.cache
def _forms():
    return {sym(name): method for name, method in _FORMS.items()}


def _takes_keywords(parameter):
    return parameter == word("*") or isinstance(parameter, models.Expression) and parameter[:1] == (word("unpack-mapping"),)


def _is_declaration(form):
    return isinstance(form, Cons) and form.car is sym("DECLARE")


def _is_fresh(parameter):
    return isinstance(parameter, Symbol) and parameter.package is None


def _rest_parameter(lambda_list):
    items = list(lambda_list or ())
    for item, after in zip(items, items[1:]):
        if isinstance(item, Symbol) and item.name in ("&REST", "&BODY"):
            return after
    return None


def _mentions(form, translation, name):
    """Whether the user's code in a form of the expansion has the Hy symbol ``name``."""
    if isinstance(form, Cons):
        written = translation.call.written_as(form)
        if written is not None and _model_mentions(written, name):
            return True
        while isinstance(form, Cons):
            if _mentions(form.car, translation, name):
                return True
            form = form.cdr
        return False
    return isinstance(form, Code) and _model_mentions(form.model, name)


def _model_mentions(model, name):
    if isinstance(model, models.Sequence):
        return any(_model_mentions(part, name) for part in model)
    return model == name


def expand(compiler, operator, arguments, call, form):
    """The Hy model that a call of ``operator`` stands for, of which `lisp_call` has made ``call`` and the Lisp ``form``."""
    if operator.name == "PAR" and not arguments:  # nothing is done at once; Lisp's PAR has an error that Python's `par` has not
        return word("None")
    ensure_loaded()
    expansion, _ = macroexpand_1(form)
    made = Translation(compiler, call, operator).hy(expansion)
    if operator.name in VARIABLES and arguments and isinstance(arguments[0], models.Symbol):
        return expression(word("do"), expression(word("setv"), arguments[0], made), arguments[0])
    return made
