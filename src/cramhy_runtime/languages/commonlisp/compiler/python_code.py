"""From core Hy forms to Python's syntax tree.

Hy's compiler knows all of Hy, and finds out for each form which part of it is a statement. The generator delivers statements and
expressions apart already, so here one look at the head of a form is enough, and a form that is a statement in Python is one here.
The trees mean what Hy's mean (tests compare), without the variables that Hy needs because its statements have values.
"""

from __future__ import annotations

import ast
import sys
import warnings

from .core import Expression, Keyword, List, Symbol, Tuple

_LOAD, _STORE = ast.Load(), ast.Store()
_JUMPS = (ast.Return, ast.Break, ast.Continue, ast.Raise)
_COMPARISONS = {
    "is": ast.Is(),
    "is-not": ast.IsNot(),
    "=": ast.Eq(),
    "!=": ast.NotEq(),
    "<": ast.Lt(),
    "<=": ast.LtE(),
    ">": ast.Gt(),
    ">=": ast.GtE(),
    "in": ast.In(),
    "not-in": ast.NotIn(),
}
_OPERATORS = {"+": ast.Add(), "-": ast.Sub(), "*": ast.Mult(), "/": ast.Div(), "//": ast.FloorDiv(), "%": ast.Mod()}
_CONSTANTS = {"None": None, "True": True, "False": False}
_WARNS_OF_EXITS = sys.version_info >= (3, 14)
"""Whether Python warns of a ``return``, ``break`` or ``continue`` in ``finally`` (PEP 765). A cleanup form of Lisp may leave."""


def compiled(tree, filename):
    """The code object of an ``ast.Module``, without Python's warning of exits from cleanup."""
    if not _WARNS_OF_EXITS or not _leaves_cleanup(tree):
        return compile(tree, filename, "exec")
    with warnings.catch_warnings():
        allow_exits_from_cleanup()
        return compile(tree, filename, "exec")


def allow_exits_from_cleanup():
    """From now on Python does not warn of them: for Hy, which compiles a file when it has read all of it."""
    if _WARNS_OF_EXITS:
        warnings.filterwarnings("ignore", r"'(return|break|continue)' in a 'finally' block", SyntaxWarning)


def _leaves_cleanup(tree):
    cleanups = (part for node in ast.walk(tree) if isinstance(node, ast.Try) for part in node.finalbody)
    return any(isinstance(node, _JUMPS) for part in cleanups for node in ast.walk(part))


def module(forms):
    """The ``ast.Module`` that runs the statements ``forms``."""
    return ast.Module(body=block(forms, (1, 0, 1, 1)) if forms else [], type_ignores=[])


def block(forms, place):
    """The Python statements of ``forms``, up to the first that leaves; `place` is that of the form around them."""
    out = []
    for form in forms:
        statement(form, place, out)
        if out and isinstance(out[-1], _JUMPS):
            break
    return out or [_at(ast.Pass(), place)]


def _at(node, place):
    node.lineno, node.col_offset, node.end_lineno, node.end_col_offset = place
    return node


def _inner(form, place):
    """The place of ``form`` itself, and that of its parts that have none: only where it begins.

    Python takes the place of a call from its function part, which stands nowhere in the user's text.
    """
    position = form.position
    if position is None:
        return place, place
    return position, (position[0], position[1], position[0], position[1] + 1)


def statement(form, place, out):
    """Append the Python statements of ``form`` to ``out``."""
    if form.__class__ is Expression and form[0].__class__ is Symbol:
        handler = _STATEMENTS.get(form[0])
        if handler is not None:
            own, place = _inner(form, place)
            handler(form, own, place, out)
            return
    if form.__class__ is not Expression:
        return  # a name or a constant has no effect
    node = value(form, place)
    out.append(_at(ast.Expr(node), place))


def _setv(form, own, place, out):
    target, source = form[1], form[2]
    out.append(_at(ast.Assign([_target(target, place)], value(source, place)), own))


def _target(form, place):
    kind = form.__class__
    if kind is Symbol:
        return _at(ast.Name(form.text, _STORE), place)
    if kind is List:
        return _at(ast.Tuple([_target(item, place) for item in form], _STORE), place)
    if form[0] == "get":
        return _at(ast.Subscript(value(form[1], place), value(form[2], place), _STORE), place)
    return _at(ast.Attribute(value(form[1], place), form[2].text, _STORE), place)


def _if(form, own, place, out):
    test = value(form[1], place)
    then = block([form[2]], place)
    otherwise = block([form[3]], place) if len(form) > 3 else []
    if len(otherwise) == 1 and isinstance(otherwise[0], ast.Pass):
        otherwise = []
    out.append(_at(ast.If(test, then, otherwise), own))


def _when(form, own, place, out):
    out.append(_at(ast.If(value(form[1], place), block(form[2:], place), []), own))


def _do(form, own, place, out):
    for item in form[1:]:
        statement(item, place, out)


def _parts(forms):
    """(body, else part) of a loop."""
    if forms and forms[-1].__class__ is Expression and forms[-1][0] == "else":
        return forms[:-1], forms[-1][1:]
    return forms, []


def _while(form, own, place, out):
    body, otherwise = _parts(form[2:])
    out.append(_at(ast.While(value(form[1], place), block(body, place), block(otherwise, place) if otherwise else []), own))


def _for(form, own, place, out):
    target, source = form[1]
    body, otherwise = _parts(form[2:])
    out.append(
        _at(ast.For(_target(target, place), value(source, place), block(body, place), block(otherwise, place) if otherwise else []), own)
    )


def _try(form, own, place, out):
    body, handlers, final = [], [], []
    for item in form[1:]:
        head = item[0] if item.__class__ is Expression else None
        if head == "except":
            name, kind = item[1] if len(item[1]) == 2 else (None, item[1][0])
            handlers.append(_at(ast.ExceptHandler(value(kind, place), None if name is None else name.text, block(item[2:], place)), own))
        elif head == "finally":
            final = block(item[1:], place)
        else:
            body.append(item)
    out.append(_at(ast.Try(block(body, place), handlers, [], final), own))


def _with(form, own, place, out):
    name, context = form[1]
    item = ast.withitem(value(context, place), None if name == "_" else _target(name, place))
    out.append(_at(ast.With([item], block(form[2:], place)), own))


def _return(form, own, place, out):
    out.append(_at(ast.Return(value(form[1], place)), own))


def _raise(form, own, place, out):
    out.append(_at(ast.Raise(value(form[1], place) if len(form) > 1 else None, None), own))


def _defn(form, own, place, out):
    node = ast.FunctionDef(form[1].text, _parameters(form[2], place), block(form[3:], place), [], None, None)
    if "type_params" in node._fields:
        node.type_params = []
    out.append(_at(node, own))


def _parameters(forms, place):
    positional, keyword_only, defaults, key_defaults, rest, mapping = [], [], [], [], None, None
    after = False
    for form in forms:
        kind = form.__class__
        if kind is Symbol:
            if form == "*":
                after = True
            else:
                (keyword_only if after else positional).append(_argument(form, place))
        elif kind is List:
            name, default = form
            if after:
                keyword_only.append(_argument(name, place))
                key_defaults.append(value(default, place))
            else:
                positional.append(_argument(name, place))
                defaults.append(value(default, place))
        elif form[0] == "unpack-iterable":
            rest, after = _argument(form[1], place), True
        else:
            mapping = _argument(form[1], place)
    return ast.arguments(
        posonlyargs=[], args=positional, vararg=rest, kwonlyargs=keyword_only, kw_defaults=key_defaults, kwarg=mapping, defaults=defaults
    )


def _argument(name, place):
    return _at(ast.arg(name.text, None), place)


_STATEMENTS = {
    "setv": _setv,
    "if": _if,
    "when": _when,
    "do": _do,
    "while": _while,
    "for": _for,
    "try": _try,
    "with": _with,
    "return": _return,
    "raise": _raise,
    "defn": _defn,
    "break": lambda form, own, place, out: out.append(_at(ast.Break(), own)),
    "continue": lambda form, own, place, out: out.append(_at(ast.Continue(), own)),
    "nonlocal": lambda form, own, place, out: out.append(_at(ast.Nonlocal([name.text for name in form[1:]]), own)),
}


# ---------------------------------------------------------------------------------------------------------------- expressions


def value(form, place):
    """The Python expression of ``form``."""
    kind = form.__class__
    if kind is Symbol:
        if form in _CONSTANTS:
            return _at(ast.Constant(_CONSTANTS[form]), place)
        node = ast.Name(form.text, _LOAD)  # most expressions are names, so here stands what `_at` does
        node.lineno, node.col_offset, node.end_lineno, node.end_col_offset = place
        return node
    if kind is Expression:
        own, place = _inner(form, place)
        head = form[0]
        if head.__class__ is Symbol:
            handler = _EXPRESSIONS.get(head)
            if handler is not None:
                return handler(form, own, place)
        return _call(form, own, place)
    if kind is List or kind is Tuple:
        return _at((ast.List if kind is List else ast.Tuple)([value(item, place) for item in form], _LOAD), place)
    return _at(ast.Constant(form), place)


def _call(form, own, place):
    arguments, keywords, name = [], [], None
    for item in form[1:]:
        if name is not None:
            keywords.append(_at(ast.keyword(name, value(item, place)), place))
            name = None
        elif item.__class__ is Keyword:
            name = str(item)
        elif item.__class__ is Expression and item[0] == "unpack-iterable":
            arguments.append(_at(ast.Starred(value(item[1], place), _LOAD), place))
        elif item.__class__ is Expression and item[0] == "unpack-mapping":
            keywords.append(_at(ast.keyword(None, value(item[1], place)), place))
        else:
            arguments.append(value(item, place))
    return _at(ast.Call(value(form[0], place), arguments, keywords), own)


def _attribute(form, own, place):
    return _at(ast.Attribute(value(form[1], place), form[2].text, _LOAD), own)


def _choice(form, own, place):
    return _at(ast.IfExp(value(form[1], place), value(form[2], place), value(form[3], place)), own)


def _comparison(form, own, place):
    operator = _COMPARISONS[form[0]]
    first, *others = [value(item, place) for item in form[1:]]
    return _at(ast.Compare(first, [operator] * len(others), others), own)


def _operation(form, own, place):
    if len(form) == 2:
        return _at(ast.UnaryOp(ast.USub(), value(form[1], place)), own)
    return _at(ast.BinOp(value(form[1], place), _OPERATORS[form[0]], value(form[2], place)), own)


def _boolean(operator):
    def make(form, own, place):
        return _at(ast.BoolOp(operator, [value(item, place) for item in form[1:]]), own)

    return make


def _not(form, own, place):
    operand = value(form[1], place)
    if isinstance(operand, ast.Compare) and len(operand.ops) == 1 and operand.ops[0] in _OPPOSITES:
        operand.ops = [_OPPOSITES[operand.ops[0]]]
        return operand
    return _at(ast.UnaryOp(ast.Not(), operand), own)


_OPPOSITES = {_COMPARISONS["is"]: _COMPARISONS["is-not"], _COMPARISONS["is-not"]: _COMPARISONS["is"]}


def _setx(form, own, place):
    return _at(ast.NamedExpr(_at(ast.Name(form[1].text, _STORE), place), value(form[2], place)), own)


def _get(form, own, place):
    return _at(ast.Subscript(value(form[1], place), value(form[2], place), _LOAD), own)


def _fn(form, own, place):
    return _at(ast.Lambda(_parameters(form[1], place), value(form[2], place)), own)


_EXPRESSIONS = {
    ".": _attribute,
    "if": _choice,
    "and": _boolean(ast.And()),
    "or": _boolean(ast.Or()),
    "not": _not,
    "setx": _setx,
    "get": _get,
    "fn": _fn,
    **dict.fromkeys(_COMPARISONS, _comparison),
    **dict.fromkeys(_OPERATORS, _operation),
}
