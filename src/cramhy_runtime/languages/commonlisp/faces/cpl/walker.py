"""The code walker: a form with all its macros expanded, and every ``(:tag name form...)`` in it found on the way (cpl.md 12).

`Walk` goes through a form as the compiler does, with the same lexical environment, so that it meets what the compiler will
meet: tags that a macro makes are found, tags in quoted data are not, and a local function hides the macro of its name. What it
meets is told to `Walk.tag` and `Walk.call`, which a kind of walk overrides. ``with-tags`` collects its names so (`tag_names`),
``expand-plan`` its tree (``plan_tree.py``).

``:tag`` is looked at before macros and local functions are, so a ``macrolet`` cannot take it away.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import condition_types as types
from ...compiler.environment import Env, FunctionScope, LocalFunction, LocalMacro, SpecialVariable, SymbolMacro
from cramhy_runtime.lisp_core.conditions import error, handler_bind, handler_case, muffle_warning
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, lisp_list, list_from
from ...evaluation.evaluator import macro_expander
from cramhy_runtime.lisp_core.functions import function_of
from ...syntax.macros import expand_fully, macroexpand_1
from cramhy_runtime.lisp_core.packages import COMMON_LISP, find_package
from ...syntax.backquote import Comma
from cramhy_runtime.cpl.symbols import CPL_IMPL, sym

TAG, WITH_TAGS = sym(":TAG"), sym("CPL-IMPL::WITH-TAGS")
LAMBDA, DECLARE, SETF, FUNCTION, QUOTE = (sym(name) for name in ("LAMBDA", "DECLARE", "SETF", "FUNCTION", "QUOTE"))
SPECIAL_FORMS = {}
"""Special operator → method (walk, form, environment) → the form with its parts walked."""


def special(*names):
    """Enter the decorated function as the way through forms of these operators."""

    def define(function):
        for name in names:
            SPECIAL_FORMS[sym(name)] = function
        return function

    return define


class Walk:
    """One walk through a form. Its parts are visited in the order of the text, outer forms before inner ones."""

    def form(self, form, env):
        """The expansion of ``form`` in the environment ``env``."""
        form, _ = expand_fully(form, lambda form: self.step(form, env))
        if not isinstance(form, Cons):
            return form
        head = form.car
        if head is TAG and isinstance(form.cdr, Cons):
            return self.tag(form, form.cdr.car, form.cdr.cdr, env)
        if isinstance(head, Cons) and head.car is LAMBDA:
            return Cons(_function_object(self, head, env), self.forms(form.cdr, env))
        if not isinstance(head, Symbol):
            return self.invalid(form)
        if head in SPECIAL_FORMS and env.function(head) is None:
            return SPECIAL_FORMS[head](self, form, env)
        return self.call(form, env)

    def step(self, form, env):
        """(expansion, whether there is one) of ``form``, which may be anything. What is walked through itself has none."""
        if isinstance(form, Cons):
            head = form.car
            if (
                not isinstance(head, Symbol)
                or head is TAG
                and isinstance(form.cdr, Cons)
                or head in SPECIAL_FORMS
                and env.function(head) is None
            ):
                return form, False
            return self.expand(form, env)
        return macroexpand_1(form, env) if isinstance(form, Symbol) and not isinstance(form, Keyword) else (form, False)

    def forms(self, forms, env):
        """The list of the expansions of a list of forms."""
        walked, cell = [], forms
        while isinstance(cell, Cons):
            walked.append(self.form(cell.car, env))
            cell = cell.cdr
        return list_from(walked, cell)

    def expand(self, form, env):
        """(expansion, whether there is one) of the call ``form``."""
        return macroexpand_1(form, env)

    def local_macro(self, name, lambda_list, body, env):
        """The expander of a definition of ``macrolet``."""
        return macro_expander(name, lambda_list, body, env)

    def tag(self, form, name, body, env):
        """What becomes of the tag ``form`` = ``(:tag name . body)``: it stays, with its body walked."""
        return Cons(TAG, Cons(name, self.forms(body, env)))

    def call(self, form, env):
        """What becomes of the call ``form`` of a function."""
        return Cons(form.car, self.forms(form.cdr, env))

    def invalid(self, form):
        """What becomes of a form whose head is neither a symbol nor a lambda expression."""
        return error("Invalid form ~a.", form)


def walk_with_tag_handler(form, tag_handler, env=None):
    """``form`` with all macros expanded; ``tag_handler(name, list of body forms)`` is called for each tag, outer ones first."""
    handler = function_of(tag_handler)

    class Told(Walk):
        def tag(self, form, name, body, env):
            handler(name, body)
            return super().tag(form, name, body, env)

    return Told().form(form, environment(env))


def environment(env=None):
    """A lexical environment that a walk may go on from: ``env``, or the empty one."""
    return env if env is not None else Env(None, FunctionScope())


def tag_names(forms, env):
    """The names of the tags in ``forms`` (a Python sequence), in textual order; those of an inner ``with-tags`` belong to that.

    The compiler will expand the same forms again, and say with their places what is wrong with them or worth a warning; here a
    form that cannot be expanded is passed over, and warnings are muffled. Most bodies have no tag and no macro that could make one;
    these are not walked through, which would take a quarter of the time that it takes to compile them.
    """
    if not _may_hold_tags(forms, env):
        return []
    collector = _Names()
    handler_bind(
        [(types.Warning_, lambda condition: muffle_warning(condition))], lambda: collector.forms(list_from(forms), environment(env))
    )
    return list(collector.names)


def _may_hold_tags(forms, env):
    """Whether a tag stands in ``forms``, or a macro that is not one of the language's own, which make none."""
    while env is not None:
        if any(isinstance(meaning, LocalMacro) for meaning in env.functions.values()) or any(
            isinstance(meaning, SymbolMacro) for meaning in env.variables.values()
        ):
            return True
        env = env.parent
    waiting, vectors = list(forms), set()
    while waiting:
        item = waiting.pop()
        if isinstance(item, Cons):
            if item.car is not QUOTE:  # quoted data has no tags, and may contain itself
                waiting += (item.car, item.cdr)
        elif isinstance(item, Symbol):
            if (
                item is TAG
                or item in _LOCAL_MACROS
                or item.macro is not None
                and item.package not in _WITHOUT_TAGS
                or item.compiler_data is not None
                and "symbol-macro" in item.compiler_data
            ):
                return True
        elif isinstance(item, Comma):
            waiting.append(item.form)
        elif type(item) is list and id(item) not in vectors:
            vectors.add(id(item))
            waiting += item
    return False


_LOCAL_MACROS = {sym("MACROLET"), sym("SYMBOL-MACROLET")}
_WITHOUT_TAGS = {COMMON_LISP, CPL_IMPL, find_package("CRAMHY")}


class _Names(Walk):
    def __init__(self):
        self.names = {}

    def tag(self, form, name, body, env):
        self.names[name] = True
        return super().tag(form, name, body, env)

    def expand(self, form, env):
        if form.car is WITH_TAGS and env.function(WITH_TAGS) is None:
            return None, True
        return handler_case([(types.Error, lambda condition: (form, False))], lambda: macroexpand_1(form, env))

    def local_macro(self, name, lambda_list, body, env):
        return handler_case([(types.Error, lambda condition: lambda form, env: None)], lambda: macro_expander(name, lambda_list, body, env))

    def invalid(self, form):
        return form


# ------------------------------------------------------------------------------------------------- special forms: plain parts


@special("QUOTE", "GO", "DECLARE")
def _data(walk, form, env):
    return form


@special(
    "PROGN",
    "IF",
    "UNWIND-PROTECT",
    "CATCH",
    "THROW",
    "PROGV",
    "MULTIPLE-VALUE-CALL",
    "MULTIPLE-VALUE-PROG1",
    "MULTIPLE-VALUE-LIST",
    "FUNCALL",
    "AND",
    "OR",
)
def _all_parts(walk, form, env):
    return Cons(form.car, walk.forms(form.cdr, env))


@special("BLOCK", "RETURN-FROM", "THE", "EVAL-WHEN", "CRAMHY::SUPPORT")
def _all_but_the_first(walk, form, env):
    first, rest = _two(form)
    return Cons(form.car, Cons(first, walk.forms(rest, env)))


@special("LOAD-TIME-VALUE")
def _load_time_value(walk, form, env):
    value, rest = _two(form)
    return Cons(form.car, Cons(walk.form(value, environment()), rest))


@special("SETQ")
def _setq(walk, form, env):
    parts = list(_items(form.cdr))
    if any(isinstance(symbol, Symbol) and macroexpand_1(symbol, env)[1] for symbol in parts[::2]):
        pairs = [lisp_list(SETF, symbol, value) for symbol, value in zip(parts[::2], parts[1::2], strict=False)]
        return walk.form(
            Cons(sym("PROGN"), list_from([Cons(SETF, Cons(macroexpand_1(pair.cdr.car, env)[0], pair.cdr.cdr)) for pair in pairs])), env
        )
    return Cons(form.car, list_from([walk.form(part, env) if index % 2 else part for index, part in enumerate(parts)]))


@special("TAGBODY")
def _tagbody(walk, form, env):
    return Cons(form.car, list_from([walk.form(part, env) if isinstance(part, Cons) else part for part in _items(form.cdr)]))


def _items(part):
    """The elements of a part that should be a list; of anything else none, and the compiler will say so."""
    while isinstance(part, Cons):
        yield part.car
        part = part.cdr


def _two(form):
    """(first part, list of the others) of a form; what is missing is nil, and the compiler's affair."""
    return (form.cdr.car, form.cdr.cdr) if isinstance(form.cdr, Cons) else (None, None)


# ------------------------------------------------------------------------------------------------- special forms: with scopes


def _body(walk, forms, env):
    """A body: its declarations stay, its forms are walked."""
    walked, cell = [], forms
    while isinstance(cell, Cons):
        item = cell.car
        walked.append(item if isinstance(item, Cons) and item.car is DECLARE else walk.form(item, env))
        cell = cell.cdr
    return list_from(walked, cell)


def _bind(symbol, env):
    """Let the variable ``symbol`` mean a variable from here on, whatever symbol macro it was outside."""
    if isinstance(symbol, Symbol):
        env.variables[symbol] = SpecialVariable(symbol)


@special("LET", "LET*")
def _let(walk, form, env):
    bindings, body = _two(form)
    inner, walked = env.child(), []
    seen = inner if form.car.name == "LET*" else env
    for item in _items(bindings):
        if isinstance(item, Cons) and isinstance(item.cdr, Cons):
            walked.append(Cons(item.car, Cons(walk.form(item.cdr.car, seen), item.cdr.cdr)))
        else:
            walked.append(item)
        if seen is inner:
            _bind(item.car if isinstance(item, Cons) else item, inner)
    for item in _items(bindings):
        _bind(item.car if isinstance(item, Cons) else item, inner)
    return Cons(form.car, Cons(list_from(walked), _body(walk, body, inner)))


@special("LOCALLY")
def _locally(walk, form, env):
    return Cons(form.car, _body(walk, form.cdr, env))


@special("MULTIPLE-VALUE-BIND")
def _multiple_value_bind(walk, form, env):
    variables, rest = _two(form)
    if not isinstance(rest, Cons):
        return form
    values, inner = walk.form(rest.car, env), env.child()
    for symbol in _items(variables):
        _bind(symbol, inner)
    return Cons(form.car, Cons(variables, Cons(values, _body(walk, rest.cdr, inner))))


@special("SYMBOL-MACROLET")
def _symbol_macrolet(walk, form, env):
    definitions, body = _two(form)
    inner = env.child()
    for item in _items(definitions):
        if isinstance(item, Cons) and isinstance(item.cdr, Cons):
            inner.variables[item.car] = SymbolMacro(item.cdr.car)
    return Cons(form.car, Cons(definitions, _body(walk, body, inner)))


@special("MACROLET")
def _macrolet(walk, form, env):
    definitions, body = _two(form)
    inner = env.child()
    for item in _items(definitions):
        if isinstance(item, Cons) and isinstance(item.cdr, Cons):
            inner.functions[item.car] = LocalMacro(walk.local_macro(item.car, item.cdr.car, item.cdr.cdr, env))
    return Cons(form.car, Cons(definitions, _body(walk, body, inner)))


@special("FLET", "LABELS")
def _local_functions(walk, form, env):
    definitions, body = _two(form)
    inner = env.child()
    for item in _items(definitions):
        if isinstance(item, Cons):
            name = item.car
            inner.functions[("setf", name.cdr.car) if isinstance(name, Cons) and isinstance(name.cdr, Cons) else name] = LocalFunction(None)
    outside = inner if form.car.name == "LABELS" else env
    walked = [Cons(item.car, _lambda_parts(walk, item.cdr, outside)) if isinstance(item, Cons) else item for item in _items(definitions)]
    return Cons(form.car, Cons(list_from(walked), _body(walk, body, inner)))


@special("CRAMHY::CATCHING")
def _catching(walk, form, env):
    kinds, rest = _two(form)
    if not isinstance(rest, Cons):
        return form
    clauses = []
    for variables, *body in rest.cdr:  # only macros of ours write this form
        inner = env.child()
        for symbol in _items(variables):
            _bind(symbol, inner)
        clauses.append(Cons(variables, _body(walk, list_from(body), inner)))
    return Cons(form.car, Cons(kinds, Cons(walk.form(rest.car, env), list_from(clauses))))


@special("CRAMHY::EACH")
def _each(walk, form, env):
    loop, body = _two(form)
    inner, (variables, sequence, *rest) = env.child(), _items(loop)  # only the compiler writes this form
    for symbol in _items(variables) if isinstance(variables, Cons) else (variables,):
        _bind(symbol, inner)
    return Cons(form.car, Cons(lisp_list(variables, walk.form(sequence, env), *rest), _body(walk, body, inner)))


@special("CRAMHY::HANDLING")
def _handling(walk, form, env):
    bindings, body = _two(form)
    walked = [
        lisp_list(binding.car, walk.form(binding.cdr.car, env)) for binding in _items(bindings)
    ]  # only macros of ours write this form
    return Cons(form.car, Cons(list_from(walked), _body(walk, body, env)))


# ------------------------------------------------------------------------------------------------- special forms: functions


@special("FUNCTION")
def _function(walk, form, env):
    what, rest = _two(form)
    if isinstance(what, Cons) and what.car is LAMBDA:
        return Cons(form.car, Cons(_function_object(walk, what, env), rest))
    return form


@special("LAMBDA")
def _lambda(walk, form, env):
    return lisp_list(FUNCTION, _function_object(walk, form, env))


@special("CRAMHY::NAMED-LAMBDA")
def _named_lambda(walk, form, env):
    name, parts = _two(form)
    return Cons(form.car, Cons(name, _lambda_parts(walk, parts, env)))


def _function_object(walk, form, env):
    return Cons(form.car, _lambda_parts(walk, form.cdr, env))


def _lambda_parts(walk, parts, env):
    """``(lambda-list . body)`` with the defaults of the parameters and the body walked."""
    if not isinstance(parts, Cons):
        return parts
    inner, parameters, cell = env.child(), [], parts.car
    while isinstance(cell, Cons):
        item = cell.car
        if isinstance(item, Cons):  # (variable default supplied), ((:key variable) default supplied)
            variable = item.car
            if isinstance(item.cdr, Cons):
                item = Cons(variable, Cons(walk.form(item.cdr.car, inner), item.cdr.cdr))
                for supplied in _items(item.cdr.cdr):
                    _bind(supplied, inner)
            _bind(variable.cdr.car if isinstance(variable, Cons) and isinstance(variable.cdr, Cons) else variable, inner)
        elif not getattr(item, "name", "&").startswith("&"):
            _bind(item, inner)
        parameters.append(item)
        cell = cell.cdr
    return Cons(list_from(parameters, cell), _body(walk, parts.cdr, inner))
