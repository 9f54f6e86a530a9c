"""From forms to nodes: macros expanded, names resolved, scopes known.

`Analyzer.form` takes a form and an `Env` and gives a node. The special operators are in ``special_forms.py``; here are names,
calls and functions. A name that is bound nowhere is taken for a special variable, as SBCL does after its warning: whether it
has a value shows at run time, with the error that the user knows.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import CompileError, SimpleProgramError, error
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, UndefinedFunction, lisp_list, one
from .compilation_unit import expanding
from .failing_macros import expanded_or_failing, is_of_user, reached_at_once
from ..syntax.lambda_lists import parse, variables_of
from ..syntax.macros import ensure_loaded, macroexpand_1
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.lisp_core.dispatch.methods import Shape
from cramhy_runtime.storage.dependency_tracing import run
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from ..reader.form_places import FormPlaces
from . import nodes
from .declared_types import declared_types
from .environment import Env, FunctionScope, LocalFunction, SpecialVariable, SymbolMacro, Variable, function_key
from .kinds import kind_of_type
from .net_tests import WAITING, look_at_wait
from .nodes import (
    Call,
    CallLocal,
    CallValue,
    Checked,
    Constant,
    FunctionReference,
    GlobalVariable,
    Lambda,
    Let,
    LocalVariable,
    Parameters,
    Progn,
    SetGlobal,
    SetLocal,
)
from .open_coding import call_of_next, open_coded
from .passes import WRITTEN_OUT
from .style_checks import CRAMHY, Scrutiny, note_declarations, tuple_of

SPECIAL_FORMS: dict = {}
"""Symbol → method (analyzer, form, env) → node; filled by ``special_forms.py``."""

DECLARE = sym("DECLARE")
LAMBDA = sym("LAMBDA")
SETF = sym("SETF")


class Analyzer(Scrutiny):
    """Turns the forms of one text into nodes. ``positions`` are its `FormPlaces`; ``at_once``: the code runs as soon as it is made.

    macro_expander: makes the function of a local macro; evaluation, which stands above, gives it.
    """

    def __init__(self, filename="<form>", positions=None, at_once=False, macro_expander=None):
        ensure_loaded()
        self.macro_expander = macro_expander
        self.filename = filename
        self.positions = positions if positions is not None else FormPlaces()
        self.at_once = at_once
        self.reached = []  # forms that are evaluated as soon as the top-level form is
        self.circle_check = None  # what looks for circles in expansions, where one was in a call of a user's macro
        self._at = None
        self.begin_scrutiny()

    # ------------------------------------------------------------------------------------------------------------ errors

    def fail(self, control, *arguments):
        """A compile error at the form that is being analysed."""
        return error(CompileError(control, *arguments, position=self.place()))

    def place(self):
        return (self.filename, *self._at[:2]) if self._at else None

    # ------------------------------------------------------------------------------------------------------------- forms

    def form(self, form, env):
        """The node of ``form``."""
        if isinstance(form, Cons):
            key = id(form)
            position = self.positions.get(key)
            if position is None:
                return self._compound(form, env)
            outer, self._at = self._at, position
            around, self.source = self.source, self.positions.source(key, form)
            try:
                node = self._compound(form, env)
                if node.position is None:
                    node.position = position
                return node
            except CompileError as problem:
                if problem.position is None:
                    problem.position = self.place()
                raise
            finally:
                self._at, self.source = outer, around
        if isinstance(form, Symbol) and not isinstance(form, Keyword):
            return self._variable(form, env)
        if form.__class__ is bool:
            return Constant(True if form else None)
        return Constant(form)

    def _variable(self, symbol, env):
        found = env.variable(symbol)
        if isinstance(found, Variable):
            self.read_variable(found)
            return LocalVariable(found.used_from(env.scope))
        if isinstance(found, SymbolMacro):
            return self.form(found.expansion, env)
        if found is None and symbol.compiler_data is not None and "symbol-macro" in symbol.compiler_data:
            return self.form(symbol.compiler_data["symbol-macro"], env)
        if found is None:
            self.free_variable(symbol, env)
        node = GlobalVariable(symbol)
        node.position = self.symbol_position(symbol) or self._at
        return node

    def _compound(self, form, env):
        head = form.car
        if isinstance(head, Symbol) or (head is None or head is True) and env.function(head) is not None:
            local = env.function(head)
            if local is None:
                special = SPECIAL_FORMS.get(head)
                if special is not None:
                    return special(self, form, env)
            if head is DECLARE:
                return self.fail(
                    "~S stands where a form must stand: declarations belong at the beginning of a body, before all forms.", form
                )
            if isinstance(local, LocalFunction):
                self.local_call(head, local.shape, tuple_of(form), env)
                if local.next is not None:
                    return call_of_next(self, local.next, form, env)
                return CallLocal(local.variable.used_from(env.scope), self.arguments(form, env))
            if local is not None or head.__class__ is not Symbol or head.macro is not None:  # most calls are of functions
                expansion, expanded = self.expand(form, env)
                if expanded:
                    return self.form(expansion, env)
            if head in WRITTEN_OUT and head not in self.notinline:
                loop = open_coded(form, env.function)
                if loop is not None:
                    self.positions.inherit(loop, form)
                    return self.form(loop, env)
            shorter = self.compiler_macro_expansion(form, env)
            return self._call(form, env) if shorter is form else self.form(shorter, env)
        if isinstance(head, Cons) and head.car is LAMBDA:
            self.lambda_call(head, tuple_of(form), env)
            return CallValue(self.function(head, env), self.arguments(form, env))
        told = "~S cannot be called: the head of a form must be a symbol or a lambda expression."
        return error(CompileError(told, head, position=self.place(), called=form))

    def expand(self, form, env):
        """(expansion, whether expanded); the expansion inherits the place of ``form``."""
        with expanding(self.unit, form, self.place()):
            if self.unit is None or not is_of_user(form.car, env):
                expansion, expanded = macroexpand_1(form, env)
            elif env.scope.parent is None and reached_at_once(self.reached, form, SPECIAL_FORMS):
                expansion, expanded = macroexpand_1(form, env)
                self.reached.append(expansion)
            else:
                expansion, expanded = expanded_or_failing(self.unit, lambda: macroexpand_1(form, env), form)
        if expanded:
            if self.circle_check is not None:
                self.circle_check(expansion)
            self.positions.inherit(expansion, form)
        return expansion, expanded

    def compiler_macro_expansion(self, form, env):
        """What the compiler macro of the function that ``form`` calls makes of it; ``form`` itself when it declines (ANSI 3.2.2.1)."""
        data = form.car.compiler_data
        if data is None or "compiler-macro" not in data or form.car in self.notinline or "notinline" in data:
            return form
        with expanding(self.unit, form, self.place()):
            expansion = one(run(data["compiler-macro"], form, env))
        if expansion is not form:
            self.positions.inherit(expansion, form)
        return expansion

    def arguments(self, form, env):
        nodes, cell = [], form.cdr
        while isinstance(cell, Cons):
            nodes.append(self.form(cell.car, env))
            cell = cell.cdr
        if cell is not None:
            return self.fail("The form ~S ends in a dot.", form)
        return nodes

    def _call(self, form, env):
        if form.car in WAITING:
            look_at_wait(self, form, env)
        if form.car.package is CRAMHY:
            self.mention_definition(form)
        else:
            self.mention(form.car, env, form, tuple_of(form))
        node = Call(form.car, self.arguments(form, env))
        node.position = self._at
        traits = BUILTIN_TRAITS.get(form.car)
        if traits:
            node.single = "single" in traits
            node.boolean = "boolean" in traits
        return node

    def body(self, forms, env):
        """The node of a progn of ``forms`` (an iterable of forms)."""
        forms = list(forms or ())
        if len(forms) == 1:
            return self.form(forms[0], env)
        if not forms:
            return Constant(None)
        return progn([self.form(form, env) for form in forms])

    # ------------------------------------------------------------------------------------------------------ declarations

    def declarations(self, forms, env, documentation=False):
        """(declaration specifiers, documentation or None, remaining forms) at the head of a body."""
        specifiers, text = [], None
        forms = list(forms or ())
        while forms:
            head = forms[0]
            if isinstance(head, Cons) and head.car is DECLARE:
                specifiers.extend(head.cdr or ())
                forms.pop(0)
            elif documentation and isinstance(head, str) and len(forms) > 1 and text is None:
                text = forms.pop(0)
            else:
                break
        return specifiers, text, forms

    @staticmethod
    def specials(specifiers):
        """The symbols that ``specifiers`` declare special."""
        special = sym("SPECIAL")
        return {name for item in specifiers if isinstance(item, Cons) and item.car is special for name in item.cdr or ()}

    def binds_special(self, symbol, specials):
        if not isinstance(symbol, Symbol) or isinstance(symbol, Keyword):
            return self.fail("~S cannot be bound: a variable must be a symbol that is not a constant.", symbol)
        if symbol.constant:
            return self.fail("The constant ~S cannot be bound.", symbol)
        return symbol.special or symbol in specials

    def bind(self, symbol, env, specials, types=None):
        """Bind ``symbol`` in ``env``: the new `Variable`, or the symbol itself when it is special."""
        if self.binds_special(symbol, specials):
            env.variables[symbol] = SpecialVariable(symbol)
            return symbol
        variable = env.variables[symbol] = Variable(symbol, env.scope)
        if types:
            variable.type = types.get(symbol)
        return variable

    @staticmethod
    def checked(symbol, node, types, given=True):
        """The value ``node`` for ``symbol``, with the check of the type that is declared for it."""
        kind = types.get(symbol) if types else None
        return node if kind is None or not given else Checked(node, kind, symbol)

    # --------------------------------------------------------------------------------------------------------- functions

    def function(self, form, env, name=None):
        """The `Lambda` of a lambda expression ``(lambda list . body)``."""
        if not isinstance(form.cdr, Cons):
            return self.fail("A lambda expression needs a lambda list: ~S", form)
        return self.lambda_(form.cdr.car, form.cdr.cdr, env, name)

    def lambda_(self, lambda_list, body, env, name=None, block=None, local=False):
        """A function with ``lambda_list`` and the forms ``body``; ``block`` names an implicit block around them, ``name`` is that
        of a global function unless it is ``local``.
        """
        with expanding(self.unit, lambda_list, self.place()):
            parsed = parse(lambda_list)
        if name is not None and not local and env.function(function_key(name)) is None:
            self.defines(name, Shape(lambda_list))
        scope = FunctionScope(env.scope)
        inner = Env(env, scope)
        specifiers, documentation, forms = self.declarations(body, env, documentation=True)
        specials = self.specials(specifiers)
        if parsed.has_defaults() and any(symbol.special or symbol in specials for symbol in variables_of(lambda_list)):
            parsed = parsed.in_order()  # a default form sees the special parameters before it
        own = []
        types = declared_types(specifiers)
        checks = []
        parameters = Parameters(has_keys=parsed.has_keys, allow_other_keys=parsed.allow_other_keys)
        dynamic = []

        def parameter(symbol):
            if not isinstance(symbol, Symbol) or isinstance(symbol, Keyword):
                return self.fail("~S cannot be a parameter of a function.", symbol)
            if symbol in inner.variables:
                return self.fail("The variable ~S occurs more than once in the lambda list.", symbol)
            special = self.binds_special(symbol, specials)
            # a special parameter is bound when all parameters have their values
            variable = inner.variables[symbol] = Variable(symbol, scope)
            if symbol in types:
                variable.type = types[symbol]
                checks.append(Checked(LocalVariable(variable), types[symbol], symbol, entry=True))
            if special:
                dynamic.append((symbol, variable))
            else:
                own.append(variable)
            return variable

        parameters.required = [parameter(symbol) for symbol in parsed.required]
        for symbol, default, supplied in parsed.optional:
            node = self.form(default, inner) if default is not None else None
            variable = parameter(symbol)
            parameters.optional.append((variable, node, parameter(supplied) if supplied is not None else None))
        if parsed.rest is not None:
            parameters.rest = parameter(parsed.rest)
        for key, symbol, default, supplied in parsed.keys:
            node = self.form(default, inner) if default is not None else None
            variable = parameter(symbol)
            parameters.keys.append((variable, node, parameter(supplied) if supplied is not None else None, key))
        bindings = [(symbol, LocalVariable(variable)) for symbol, variable in dynamic]
        for symbol in [*(symbol for symbol, _ in dynamic), *(() if parsed.aux else specials)]:  # the LET* of &AUX declares them again
            inner.variables[symbol] = SpecialVariable(symbol)
        around = self.muffled, self.notinline
        note_declarations(self, specifiers, [*own, *(symbol for symbol, _ in parsed.aux)], inner)
        if parsed.aux:
            aux = lisp_list(*(lisp_list(symbol, form) for symbol, form in parsed.aux))
            declared = [Cons(DECLARE, lisp_list(*specifiers))] if specifiers else []
            if block is not None:
                forms = [Cons(sym("BLOCK"), Cons(block, lisp_list(*forms)))]
            body_node = SPECIAL_FORMS[sym("LET*")](self, lisp_list(sym("LET*"), aux, *declared, *forms), inner)
        else:
            body_node = self._blocked(block, forms, inner)
        self.unused(own)
        self.muffled, self.notinline = around
        if bindings:
            body_node = Let(bindings, body_node)
        if checks:
            body_node = progn([*checks, body_node])
            if not (parsed.optional or parsed.has_keys):  # else a default may use them before they are checked
                for check in checks:
                    check.value.variable.proven = kind_of_type(check.type)
        node = Lambda(name, parameters, body_node, scope, documentation)
        node.everywhere = isinstance(name, Symbol) and not local
        return node

    def _blocked(self, block, forms, env):
        if block is None:
            return self.body(forms, env)
        return SPECIAL_FORMS[sym("BLOCK")](self, Cons(sym("BLOCK"), Cons(block, lisp_list(*forms))), env)

    def function_name(self, name, env):
        """The node of ``#'name``."""
        if isinstance(name, Cons) and name.car is LAMBDA:
            return self.function(name, env)
        if isinstance(name, Cons) and name.car is SETF:
            local = env.function(("setf", name.cdr.car))
            if isinstance(local, LocalFunction):
                return LocalVariable(local.variable.used_from(env.scope))
            self.mention(("setf", name.cdr.car), env)
            return FunctionReference(name.cdr.car, setf=True)
        if not is_symbol(name):
            return self.fail("~S is not a name of a function.", name)
        local = env.function(name)
        if isinstance(local, LocalFunction):
            return LocalVariable(local.variable.used_from(env.scope))
        if local is not None or (
            isinstance(name, Symbol) and (name.macro is not None or name in SPECIAL_FORMS) and isinstance(name.function, UndefinedFunction)
        ):
            return self.fail("~S names a macro, not a function, so #' cannot refer to it.", name)
        if isinstance(name, Symbol):
            self.mention(name, env)
        return FunctionReference(name)

    def set_variable(self, symbol, node, env):
        """The node that assigns ``node`` to the variable ``symbol``; symbol macros are the caller's."""
        if not isinstance(symbol, Symbol) or symbol.constant:
            return self.fail("~S cannot be assigned.", symbol)
        found = env.variable(symbol)
        if isinstance(found, Variable):
            self.set_ignored(found)
            if found.type is not None:
                node = Checked(node, found.type)
            return SetLocal(found.used_from(env.scope, assign=True), node)
        if found is None:
            self.free_variable(symbol, env, assigned=True)
        kind = (symbol.compiler_data or {}).get("type")
        return SetGlobal(symbol, node if kind is None else Checked(node, kind))

    def toplevel(self, form, names=None):
        """The node of a top-level form as the body of a function without parameters."""
        ensure_loaded()
        self.reached = [form]
        scope = FunctionScope(names=names)
        env = Env(None, scope)
        return Lambda(None, Parameters(), self.form(form, env), scope)


BUILTIN_TRAITS: dict = {}
"""Symbol → set of "single", "boolean": what is known about the results of standard functions."""


def note_traits(names, *traits):
    for name in names.upper().split():
        BUILTIN_TRAITS.setdefault(sym(name), set()).update(traits)


note_traits(
    "eq eql equal equalp null not consp listp atom symbolp stringp numberp integerp floatp characterp functionp vectorp "
    "keywordp zerop plusp minusp evenp oddp endp string= = /= < > <= >= char= boundp fboundp typep",
    "single",
    "boolean",
)
note_traits(
    "car cdr cons list list* append nconc length reverse nreverse nth nthcdr first second third rest last 1+ 1- + - * / min max "
    "mod rem abs symbol-name make-symbol symbol-value symbol-function string intern-keyword elt aref svref char mapcar mapc "
    "mapcan member assoc find position count remove delete sort concatenate format princ prin1 print terpri write-string "
    "gensym error make-hash-table vector copy-list cadr cddr caar cdar caddr string-upcase string-downcase coerce reduce "
    "cramhy::car-of-cons cramhy::cdr-of-cons cramhy::collect cramhy::loop-vector cramhy::slot-spec cramhy::structure-slot "
    "cramhy::check-shape cramhy::key-table cramhy::key-value cramhy::key-given-p "
    "rplaca rplacd list-length subseq type-of class-of identity random sqrt sin cos atan expt exp log tan asin acos "
    "float gcd lcm isqrt logand logior logxor ash array-dimension make-array",
    "single",
)


def progn(forms):
    """A progn of nodes; only the last may return several values."""
    node = Progn(forms)
    node.single = forms[-1].single
    node.boolean = forms[-1].boolean
    return node


__all__ = ["Analyzer", "Env", "SPECIAL_FORMS", "note_traits", "progn", "nodes", "python_name", "SimpleProgramError"]
