"""The special operators: what each of them means.

The 25 of ANSI 3.1.2.1.2.1, and a few that CL defines as macros but that every compiler treats itself. Each function takes the
analyzer, the form and the environment, and gives a node.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Symbol, UndefinedFunction, lisp_list, list_from
from ..syntax.lambda_lists import gensym
from cramhy_runtime.lisp_core.dispatch.methods import Shape
from cramhy_runtime.lisp_core.packages import COMMON_LISP, is_symbol, sym, symbol_name, symbol_package
from ..packages.package_errors import locked
from .open_coding import next_method
from .analyze import SETF, SPECIAL_FORMS, progn
from .declared_types import checkable, declared_types
from .environment import EXECUTE, SITUATIONS, Block, LocalFunction, LocalMacro, SpecialVariable, SymbolMacro, Tagbody, Variable
from .net_tests import look_at_tests
from .nodes import (
    BlockNode,
    Call,
    CallSetf,
    CallSpread,
    CallValue,
    Checked,
    Constant,
    Each,
    FunctionReference,
    Functions,
    Go,
    If,
    Let,
    LoadTimeValue,
    LocalVariable,
    MultipleValueBind,
    MultipleValueProg1,
    ReturnFrom,
    Support,
    TagbodyNode,
)

PROGN, FUNCTION, MACROLET = sym("PROGN"), sym("FUNCTION"), sym("MACROLET")
FUNCALL, LAMBDA = sym("FUNCALL"), sym("LAMBDA")


def special(name):
    """Enter the decorated function as the special operator ``name``."""

    def define(function):
        SPECIAL_FORMS[sym(name)] = function
        return function

    return define


def parts_of(analyzer, form, least, most=None):
    """The forms after the operator, checked for number."""
    parts = []
    cell = form.cdr
    while isinstance(cell, Cons):
        parts.append(cell.car)
        cell = cell.cdr
    if cell is not None or len(parts) < least or (most is not None and len(parts) > most):
        wanted = str(least) if least == most else f"at least {least}" if most is None else f"{least} to {most}"
        parts = "part" if wanted.endswith("1") else "parts"
        analyzer.fail("~S takes ~A ~A, but here it is ~S.", form.car, wanted, parts, form)
    return parts


def items_of(analyzer, form, value):
    """The elements of ``value``, a part of ``form`` that must be a list."""
    items, cell = [], value
    while isinstance(cell, Cons):
        items.append(cell.car)
        cell = cell.cdr
    if cell is not None:
        analyzer.fail("~S needs a list where it has ~S.", form.car, value)
    return items


@special("QUOTE")
def _quote(analyzer, form, env):
    value = parts_of(analyzer, form, 1, 1)[0]
    return Constant(value)


@special("FUNCTION")
def _function(analyzer, form, env):
    return analyzer.function_name(parts_of(analyzer, form, 1, 1)[0], env)


@special("LAMBDA")
def _lambda(analyzer, form, env):
    return analyzer.function(form, env)


@special("CRAMHY::NAMED-LAMBDA")
def _named_lambda(analyzer, form, env):
    """``(named-lambda name lambda-list . body)``: a function with a block of its name around the body."""
    name, lambda_list, *body = parts_of(analyzer, form, 2)
    block = name.cdr.car if isinstance(name, Cons) else name
    node = analyzer.lambda_(lambda_list, list_from(body), env, name, block)
    node.position = analyzer._at
    return node


@special("PROGN")
def _progn(analyzer, form, env):
    return analyzer.body(parts_of(analyzer, form, 0), env)


@special("IF")
def _if(analyzer, form, env):
    test, then, *otherwise = parts_of(analyzer, form, 2, 3)
    look_at_tests(analyzer, form.car, (test,), env)
    node = If(analyzer.form(test, env), analyzer.form(then, env), analyzer.form(otherwise[0] if otherwise else None, env))
    node.single = node.then.single and node.otherwise.single
    node.boolean = _true_or_false(node.then) and _true_or_false(node.otherwise)
    return node


def _true_or_false(node):
    return node.boolean or (isinstance(node, Constant) and (node.value is None or node.value is True))


@special("SETQ")
def _setq(analyzer, form, env):
    parts = parts_of(analyzer, form, 0)
    if len(parts) % 2:
        analyzer.fail("SETQ takes pairs of a variable and a value, but here it is ~S.", form)
    assignments = []
    for symbol, value in zip(parts[::2], parts[1::2]):
        expansion = _symbol_macro(symbol, env)
        if expansion is not None:
            assignments.append(analyzer.form(lisp_list(SETF, expansion[0], value), env))
        else:
            assignments.append(analyzer.set_variable(symbol, analyzer.form(value, env), env))
    if not assignments:
        return Constant(None)
    return assignments[0] if len(assignments) == 1 else progn(assignments)


def _symbol_macro(symbol, env):
    local = env.variable(symbol)
    if isinstance(local, SymbolMacro):
        return (local.expansion,)
    if local is None and isinstance(symbol, Symbol) and symbol.compiler_data and "symbol-macro" in symbol.compiler_data:
        return (symbol.compiler_data["symbol-macro"],)
    return None


def _binding(analyzer, item):
    if isinstance(item, Cons):
        parts = list(item)
        if len(parts) > 2:
            analyzer.fail("A binding is a variable or (variable value), not ~S.", item)
        return parts[0], parts[1] if len(parts) == 2 else None
    return item, None


def _distinct(analyzer, symbols, operator):
    seen = set()
    for symbol in symbols:
        if symbol in seen:
            analyzer.fail("The variable ~S occurs more than once in the ~A.", symbol, operator)
        seen.add(symbol)


def bound(body_node, node):
    node.single, node.boolean = body_node.single, body_node.boolean
    return node


def _free_specials(specials, env, bound):
    """Declare specials that the form itself does not bind."""
    for symbol in specials:
        if symbol not in bound:
            env.variables[symbol] = SpecialVariable(symbol)


@special("LET")
def _let(analyzer, form, env):
    parts = parts_of(analyzer, form, 1)
    specifiers, _, forms = analyzer.declarations(parts[1:], env)
    specials, types = analyzer.specials(specifiers), declared_types(specifiers)
    pairs = [_binding(analyzer, item) for item in items_of(analyzer, form, parts[0])]
    _distinct(analyzer, [symbol for symbol, _ in pairs], "LET")
    values = [analyzer.checked(symbol, analyzer.form(value, env), types, value is not None) for symbol, value in pairs]
    inner = env.child()
    bindings = [(analyzer.bind(symbol, inner, specials, types), value) for (symbol, _), value in zip(pairs, values)]
    _free_specials(specials, inner, {symbol for symbol, _ in pairs})
    body = analyzer.scope([variable for variable, _ in bindings], specifiers, forms, inner)
    return bound(body, Let(bindings, body)) if bindings else body


@special("LET*")
def _let_star(analyzer, form, env):
    parts = parts_of(analyzer, form, 1)
    specifiers, _, forms = analyzer.declarations(parts[1:], env)
    specials, types = analyzer.specials(specifiers), declared_types(specifiers)
    bindings, inner = [], env
    for item in items_of(analyzer, form, parts[0]):
        symbol, value = _binding(analyzer, item)
        node = analyzer.checked(symbol, analyzer.form(value, inner), types, value is not None)
        inner = inner.child()
        bindings.append((analyzer.bind(symbol, inner, specials, types), node))
    inner = inner.child()
    _free_specials(specials, inner, {binding[0] if isinstance(binding[0], Symbol) else binding[0].symbol for binding in bindings})
    node = analyzer.scope([variable for variable, _ in bindings], specifiers, forms, inner)
    for binding in reversed(bindings):
        node = bound(node, Let([binding], node))
    return node


@special("LOCALLY")
def _locally(analyzer, form, env):
    specifiers, _, forms = analyzer.declarations(parts_of(analyzer, form, 0), env)
    inner = env.child()
    _free_specials(analyzer.specials(specifiers), inner, ())
    return analyzer.scope((), specifiers, forms, inner)


LOCAL_NAMES = {sym(name) for name in "CALL-NEXT-METHOD NEXT-METHOD-P LOOP-FINISH PPRINT-POP PPRINT-EXIT-IF-LIST-EXHAUSTED".split()}
"""Functions and macros of Common Lisp that exist only locally: macros of the standard define them."""


def _check_lock(analyzer, name, what):
    """A function of Common Lisp must not get another meaning, not even locally (ANSI 11.1.2.1.2); other symbols may, as in SBCL.

    name: a symbol or ``(setf symbol)``.
    """
    symbol = name.cdr.car if isinstance(name, Cons) else name
    if not is_symbol(symbol) or symbol_package(symbol) is not COMMON_LISP or symbol in LOCAL_NAMES or not locked(COMMON_LISP):
        return
    if _names_function(symbol, isinstance(name, Cons)):
        analyzer.fail(
            "Lock on package COMMON-LISP violated when binding ~A as ~A.~%Choose another name, or shadow the symbol: "
            "(:shadow #:~(~A~)) in the definition of your package.",
            symbol_name(symbol),
            what,
            symbol_name(symbol),
        )


def _names_function(symbol, setter):
    """Whether ``symbol``, or ``(setf symbol)`` if ``setter``, names a function, a macro or a special operator."""
    if not isinstance(symbol, Symbol):  # nil and t name no function
        return False
    if setter:
        return symbol.setf_function is not None or "setf-expander" in (symbol.compiler_data or {})
    return symbol.macro is not None or symbol in SPECIAL_FORMS or not isinstance(symbol.function, UndefinedFunction)


def _definitions(analyzer, form):
    parts = parts_of(analyzer, form, 1)
    definitions = []
    for item in items_of(analyzer, form, parts[0]):
        if not isinstance(item, Cons) or not isinstance(item.cdr, Cons):
            analyzer.fail("A local function is (name lambda-list . body), not ~S.", item)
        name = item.car
        if not is_symbol(name) and not (isinstance(name, Cons) and name.car is SETF and isinstance(name.cdr, Cons)):
            analyzer.fail("~S is not a name of a function.", name)
        key = ("setf", name.cdr.car) if isinstance(name, Cons) else name
        symbol = name.cdr.car if isinstance(name, Cons) else name
        _check_lock(analyzer, name, "a local macro" if form.car is MACROLET else "a local function")
        definitions.append((key, symbol, item.cdr.car, item.cdr.cdr))
    return definitions, parts[1:]


def _local_functions(analyzer, form, env, recursive):
    definitions, forms = _definitions(analyzer, form)
    inner = env.child()
    variables = [Variable(symbol, env.scope) for _, symbol, _, _ in definitions]
    for (key, symbol, lambda_list, body), variable in zip(definitions, variables):
        inner.functions[key] = LocalFunction(variable, Shape(lambda_list), next_method(symbol, body))
    if any(inner.functions[key].next for key, *_ in definitions):
        return _with_next_methods(analyzer, definitions, variables, forms, env, inner)
    functions = []
    for (_, symbol, lambda_list, body), variable in zip(definitions, variables):
        if recursive:
            variable.assigned = True  # a closure over it is made before it has its value
        functions.append((variable, analyzer.lambda_(lambda_list, body, inner if recursive else env, symbol, symbol, local=True)))
    specifiers, _, forms = analyzer.declarations(forms, env)
    _free_specials(analyzer.specials(specifiers), inner, ())
    body = analyzer.scope((), specifiers, forms, inner)
    if not recursive:  # nobody can call the others, as `retry` in the body of most with-failure-handling forms
        functions = [(variable, function) for variable, function in functions if variable.used]
    return bound(body, Functions(functions, body)) if functions else body


def _with_next_methods(analyzer, definitions, variables, forms, env, inner):
    """``flet`` as the body of a method has it: its functions are made only if somebody takes them as values."""
    body = analyzer.body(forms, inner)
    functions = [
        (variable, analyzer.lambda_(lambda_list, body_, env, symbol, symbol, local=True))
        for (_, symbol, lambda_list, body_), variable in zip(definitions, variables)
        if variable.used
    ]
    return bound(body, Functions(functions, body)) if functions else body


@special("FLET")
def _flet(analyzer, form, env):
    return _local_functions(analyzer, form, env, recursive=False)


@special("LABELS")
def _labels(analyzer, form, env):
    return _local_functions(analyzer, form, env, recursive=True)


@special("MACROLET")
def _macrolet(analyzer, form, env):
    definitions, forms = _definitions(analyzer, form)
    inner = env.child()
    for _, symbol, lambda_list, body in definitions:
        inner.functions[symbol] = LocalMacro(analyzer.macro_expander(symbol, lambda_list, body, env, analyzer))
    return _locally(analyzer, Cons(sym("LOCALLY"), list_from(forms)), inner)


@special("SYMBOL-MACROLET")
def _symbol_macrolet(analyzer, form, env):
    parts = parts_of(analyzer, form, 1)
    inner = env.child()
    for item in items_of(analyzer, form, parts[0]):
        if not isinstance(item, Cons) or not isinstance(item.cdr, Cons):
            analyzer.fail("A symbol macro is (name expansion), not ~S.", item)
        symbol, expansion = _binding(analyzer, item)
        if not isinstance(symbol, Symbol) or symbol.constant or symbol.special:
            analyzer.fail("~S is a constant or a special variable, so it cannot be a symbol macro.", symbol)
        inner.variables[symbol] = SymbolMacro(expansion)
    for symbol in analyzer.specials(analyzer.declarations(parts[1:], env)[0]):
        if symbol in inner.variables:
            analyzer.fail("The symbol macro ~S cannot be declared SPECIAL.", symbol)
    return _locally(analyzer, Cons(sym("LOCALLY"), list_from(parts[1:])), inner)


@special("BLOCK")
def _block(analyzer, form, env):
    name, *forms = parts_of(analyzer, form, 1)
    if not is_symbol(name):
        analyzer.fail("A block must be named by a symbol, not ~S.", name)
    inner = env.child()
    block = Block(name, env.scope)
    block.variable = Variable(name if isinstance(name, Symbol) else sym("BLOCK"), env.scope, env.scope.unique("Lb"))
    inner.blocks[name] = block
    body = analyzer.body(forms, inner)
    if not block.used:
        return body
    return BlockNode(block, body)


@special("RETURN-FROM")
def _return_from(analyzer, form, env):
    name, *value = parts_of(analyzer, form, 1, 2)
    block = env.block(name)
    if block is None:
        analyzer.fail("return for unknown block: ~S", name)
    node = analyzer.form(value[0] if value else None, env)
    block.used_from(env.scope)
    return ReturnFrom(block, node)


@special("TAGBODY")
def _tagbody(analyzer, form, env):
    parts = parts_of(analyzer, form, 0)
    tagbody = Tagbody(env.scope)
    tagbody.variable = Variable(sym("TAGBODY"), env.scope, env.scope.unique("Lb"))
    inner = env.child()
    segments, index = [[]], 0
    for item in parts:
        if not isinstance(item, Cons):
            index += 1
            if item in inner.tags:
                analyzer.fail("The tag ~S appears more than once in a tagbody.", item)
            inner.tags[item] = (tagbody, index)
            segments.append([])
        else:
            segments[-1].append(item)
    if index:
        env.scope.loop_depth += 1
        env.scope.loops = True
    try:
        analysed = [[analyzer.form(item, inner) for item in segment] for segment in segments]
    finally:
        if index:
            env.scope.loop_depth -= 1
    if not tagbody.used:
        return progn([*(node for segment in analysed for node in segment), Constant(None)])
    return TagbodyNode(tagbody, analysed)


@special("CRAMHY::EACH")
def _each(analyzer, form, env):
    """``(each (variable sequence source context) . body)``: what is written in place of searching functions (``open_coding.py``).

    For a list of variables each item of the source is a tuple of their values.
    """
    (symbols, sequence, source, context), *forms = parts_of(analyzer, form, 1)
    sequence, inner, variables = analyzer.form(sequence, env), env.child(), []
    for symbol in symbols if isinstance(symbols, Cons) else (symbols,):
        variable = inner.variables[symbol] = Variable(symbol, env.scope)
        variables.append(variable)
    env.scope.loop_depth += 1
    try:
        body = analyzer.body(forms, inner)
    finally:
        env.scope.loop_depth -= 1
    return Each(variables, sequence, body, source, context)


@special("GO")
def _go(analyzer, form, env):
    tag = parts_of(analyzer, form, 1, 1)[0]
    found = env.tag(tag)
    if found is None:
        analyzer.fail("attempt to GO to nonexistent tag: ~S", tag)
    tagbody, index = found
    tagbody.used_from(env.scope)
    return Go(tagbody, index)


@special("THE")
def _the(analyzer, form, env):
    kind, value = parts_of(analyzer, form, 2, 2)
    analyzer.mention_type(kind, form)
    node = analyzer.form(value, env)
    return Checked(node, kind) if checkable(kind) else node


@special("EVAL-WHEN")
def _eval_when(analyzer, form, env):
    situations, *forms = parts_of(analyzer, form, 1)
    situations = items_of(analyzer, form, situations)
    for situation in situations:
        if situation not in SITUATIONS:
            analyzer.fail("~S is not a situation of EVAL-WHEN: they are :COMPILE-TOPLEVEL, :LOAD-TOPLEVEL and :EXECUTE.", situation)
    if EXECUTE.isdisjoint(situations):  # the evaluator takes top-level ones apart itself
        return Constant(None)
    return analyzer.body(forms, env)


@special("LOAD-TIME-VALUE")
def _load_time_value(analyzer, form, env):
    value = parts_of(analyzer, form, 1, 2)[0]
    return LoadTimeValue(analyzer.toplevel(value, env.scope.names))


@special("MULTIPLE-VALUE-CALL")
def _multiple_value_call(analyzer, form, env):
    function, *arguments = parts_of(analyzer, form, 1)
    return CallSpread(analyzer.form(function, env), [analyzer.form(argument, env) for argument in arguments])


@special("MULTIPLE-VALUE-PROG1")
def _multiple_value_prog1(analyzer, form, env):
    first, *rest = parts_of(analyzer, form, 1)
    node = MultipleValueProg1(analyzer.form(first, env), [analyzer.form(item, env) for item in rest])
    node.single = node.first.single
    return node


@special("MULTIPLE-VALUE-BIND")
def _multiple_value_bind(analyzer, form, env):
    symbols, values, *body = parts_of(analyzer, form, 2)
    node = analyzer.form(values, env)
    specifiers, _, forms = analyzer.declarations(body, env)
    specials, types = analyzer.specials(specifiers), declared_types(specifiers)
    inner = env.child()
    symbols = items_of(analyzer, form, symbols)
    _distinct(analyzer, symbols, "MULTIPLE-VALUE-BIND")
    variables = [analyzer.bind(symbol, inner, specials, types) for symbol in symbols]
    _free_specials(specials, inner, set(symbols))
    body_node = analyzer.scope(variables, specifiers, forms, inner)
    checks = [
        Checked(LocalVariable(variable), variable.type)
        for variable in variables
        if isinstance(variable, Variable) and variable.type is not None
    ]
    if checks:
        body_node = progn([*checks, body_node])
    return bound(body_node, MultipleValueBind(variables, node, body_node))


@special("MULTIPLE-VALUE-LIST")
def _multiple_value_list(analyzer, form, env):
    value = analyzer.form(parts_of(analyzer, form, 1, 1)[0], env)
    return Support("value_list", [MultipleValueProg1(value, [])])


def _lambda_expression(form):
    """The lambda expression that ``form``, as it is or behind ``#'``, is; else ``None``."""
    if isinstance(form, Cons) and form.car is FUNCTION and isinstance(form.cdr, Cons):
        form = form.cdr.car
    return form if isinstance(form, Cons) and form.car is LAMBDA else None


@special("FUNCALL")
def _funcall(analyzer, form, env):
    function, *arguments = parts_of(analyzer, form, 1)
    if (
        isinstance(function, Cons)
        and function.car is FUNCTION
        and isinstance(function.cdr, Cons)
        and isinstance(function.cdr.car, Symbol)
        and env.function(function.cdr.car) is None
    ):
        direct = Cons(function.cdr.car, form.cdr.cdr)
        shorter = analyzer.compiler_macro_expansion(direct, env)
        if shorter is not direct:
            return analyzer.form(shorter, env)
    nodes = [analyzer.form(argument, env) for argument in arguments]
    node = analyzer.form(function, env)
    if (expression := _lambda_expression(function)) is not None:
        analyzer.lambda_call(expression, tuple(arguments), env)
    if isinstance(node, FunctionReference):
        analyzer.mention(("setf", node.symbol) if node.setf else node.symbol, env, form, tuple(arguments))
        call = (CallSetf if node.setf else Call)(node.symbol, nodes)
        call.position = analyzer._at
        return call
    return CallValue(node, nodes)


@special("AND")
def _and(analyzer, form, env):
    parts = parts_of(analyzer, form, 0)
    if not parts:
        return Constant(True)
    look_at_tests(analyzer, form.car, parts[:-1], env)
    node = analyzer.form(parts[-1], env)
    for part in reversed(parts[:-1]):
        outer = If(analyzer.form(part, env), node, Constant(None))
        outer.single, outer.boolean = node.single, node.boolean
        node = outer
    return node


@special("OR")
def _or(analyzer, form, env):
    parts = parts_of(analyzer, form, 0)
    if not parts:
        return Constant(None)
    look_at_tests(analyzer, form.car, parts[:-1], env)
    node = analyzer.form(parts[-1], env)
    for part in reversed(parts[:-1]):
        value = analyzer.form(part, env)
        if value.boolean:
            outer = If(value, Constant(True), node)
            outer.single, outer.boolean = node.single, node.boolean
        else:
            variable = Variable(gensym("OR"), env.scope)
            outer = Let([(variable, value)], If(LocalVariable(variable), LocalVariable(variable), node))
            outer.body.single = outer.single = node.single
        node = outer
    return node


@special("CRAMHY::SUPPORT")
def _support(analyzer, form, env):
    """``(support "name" argument...)``: a call of a function of ``compiler/support.py``; arguments keep all values."""
    name, *arguments = parts_of(analyzer, form, 1)
    return Support(str(name), [analyzer.form(argument, env) for argument in arguments], single=str(name) in SINGLE_VALUED)


SINGLE_VALUED = {"vector", "keep", "same_kind"}
"""Functions of ``compiler/support.py`` that give one value."""
