"""Functions: from a `Lambda` node to ``defn`` or ``fn``, with its parameters and what they need done on entry.

``&optional`` parameters have Python defaults; ``&rest`` and ``&key`` take Python's rest arguments apart, and Python callers may
use keywords. A variable that must be caught anew in each turn of a loop comes as a default argument.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.keyword_calls import GIVEN, name_of_key
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.lisp_core.python_names import python_name

from .. import nodes
from ..frame_exits import DEBUGGED
from ..core import NONE, TRUE, List, Tuple, expression, word
from ..destinations import RETURN, Destination
from ..facts import study
from ..passes import ENTRIES, FUNCTIONS
from .output import Generator, generates


@generates(nodes.Lambda)
def _lambda(generator, node, destination):
    return generator.finish(function_of(generator, node), node, destination, pure=True)


def function_of(generator, node, name=None):
    """Emit the definition of a function and return the expression for it."""
    given = name
    if name is None:
        base = node.name.cdr.car if isinstance(node.name, Cons) else node.name
        name = generator.scope.unique(python_name(symbol_name(base)) if base is not None else "Lfunction")
    if not DEBUGGED.value:
        for opening in FUNCTIONS:
            found = opening(generator, node, name, given)
            if found is not None:
                return found
    return definition(generator, node, name, given, RETURN)


def definition(generator, node, name, given, returning):
    """Emit a function under the Python ``name`` and return the expression for it. given: the name that was asked for."""
    saved = generator.out, generator.frames, generator.scope
    generator.out, generator.frames, generator.scope = [], [], node.scope
    outer_before, generator.before = generator.before, []
    parameters = python_parameters(generator, node)
    for opening in ENTRIES:
        opening(generator, node, returning)
    before, generator.before = generator.before, outer_before
    generator.gen(node.body, returning)
    statements = generator.out
    scope = node.scope
    generator.out, generator.frames, generator.scope = saved
    generator.out.extend(before)
    header = []
    names = [word(variable.name) for variable in scope.nonlocals if not variable.boxed]
    if names:
        header.append(expression(word("nonlocal"), *names))
    if scope.exits_set:
        header.append(generator.setting("Lexit", 0))
    simple = not header and len(statements) == 1 and given is None and node.name is None and statements[0][0] == word("return")
    if simple:
        return generator.positioned(expression(word("fn"), List(parameters), statements[0][1]), node)
    if DEBUGGED.value and (given is not None or node.name is not None):
        statements = [leavable(generator, statements)]
    definition = expression(word("defn"), word(name), List(parameters), *header, *statements)
    generator.out.append(generator.positioned(definition, node))
    return word(name)


def leavable(generator, statements):
    """``statements``, the body of a function, so that a debugger can end the call or begin it anew (`frame_exits`)."""
    caught = generator.temporary("Lexit")
    leave = expression(
        word("when"),
        expression(word("Lends_here"), word(caught)),
        expression(word("return"), expression(word("."), word(caught), word("value"))),
    )
    handler = expression(word("except"), List([word(caught), word("LFrameExit")]), leave)
    return expression(word("while"), TRUE, expression(word("try"), *statements, handler))


def python_parameters(generator, node):
    """The Python parameters of ``node``; what they need done on entry is emitted."""
    spec = node.parameters
    parameters = [word(variable.name) for variable in spec.required]
    for variable, default, supplied in spec.optional:
        plain = default is None and supplied is None
        parameters.append(List([word(variable.name), NONE if plain else word("Lunsupplied")]))
    frozen = [variable for variable in node.scope.frozen if variable.fresh]
    pythonic = spec.has_keys and spec.rest is None and not frozen and all(name_of_key(key) == var.name for var, *_, key in spec.keys)
    if spec.rest is not None or spec.has_keys:
        rest = spec.rest.name if spec.rest is not None else generator.temporary(GIVEN if pythonic else "Lkeys")
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
        keywords, parser = generator.temporary("Lpython"), generator.temporary("Lparse")
        parameters.append(expression(word("unpack-mapping"), word(keywords)))
    for variable, default, supplied in spec.optional:
        default_value(generator, variable, default, supplied)
    if spec.has_keys:
        table = [(key, default is None and supplied is None) for _, default, supplied, key in spec.keys]
        known = [Tuple([word(variable.name) for variable, *_ in spec.keys])] if pythonic else []
        values = expression(word(parser), word(rest), word(keywords), *known)
        generator.before.append(
            generator.setting(
                parser, generator.call("key_parser", constant_keys(generator, table), TRUE if spec.allow_other_keys else NONE)
            )
        )
        sort = lambda: keys_in_order(generator, spec.keys, table, word(rest), word(keywords), values, pythonic)  # noqa: E731
        if pythonic:
            statements, _ = generator.captured(sort)
            generator.emit(word("when"), expression(word("or"), word(rest), word(keywords)), *statements)
        else:
            sort()
    if spec.rest is not None:
        generator.assign(spec.rest.name, generator.call("list_from", word(spec.rest.name)))
    for variable, default, supplied, _ in spec.keys:
        default_value(generator, variable, default, supplied)
    return parameters


def keys_in_order(generator, keys, table, rest, python, values, known):
    """Give the parameters ``keys`` their values: those in the order of the lambda list, as mostly written, are taken one by one.

    Where arguments are left over then, all are sorted by the parser: ``values``. known: parameters have a value already.
    """
    if not keys:
        generator.out.append(values)
        return
    taken, last = word(generator.temporary("Ltaken")), word(generator.temporary("Llast"))
    generator.emit(word("setv"), last, expression(word("-"), generator.call("len", rest), 1))
    generator.emit(word("setv"), taken, 0)
    for (variable, *_), (key, plain) in zip(keys, table, strict=True):
        found = expression(
            word("and"),
            expression(word("<"), taken, last),
            expression(word("is"), expression(word("get"), rest, taken), generator.constant(key)),
        )
        take = [
            generator.setting(variable.name, expression(word("get"), rest, expression(word("+"), taken, 1))),
            generator.setting(taken, expression(word("+"), taken, 2)),
        ]
        generator.branch(found, take, [] if known else [generator.setting(variable.name, NONE if plain else word("Lunsupplied"))])
    left = expression(word("or"), expression(word("<="), taken, last), python)
    generator.emit(word("when"), left, expression(word("setv"), List([word(variable.name) for variable, *_ in keys]), values))


def constant_keys(generator, table):
    return Tuple([Tuple([generator.constant(key), NONE if plain else word("Lunsupplied")]) for key, plain in table])


def default_value(generator, variable, default, supplied):
    missing = expression(word("is"), word(variable.name), word("Lunsupplied"))
    if supplied is not None:
        generator.assign(supplied.name, expression(word("if"), missing, NONE, TRUE))
    elif default is None:
        return
    value = default if default is not None else nodes.Constant(None)
    statements, _ = generator.captured(lambda: generator.gen(value, Destination("assign", variable.name)))
    generator.emit(word("when"), missing, *statements)


def toplevel(constants, node, name="toplevel", result="Lresult"):
    """Statements (core forms) that run the top-level function ``node`` and leave its values in ``result``.

    The objects that they need are entered in ``constants``, `Constants`, and must be made before.
    """
    generator = Generator(constants)
    generator.scope = node.scope.parent or node.scope
    study(node)
    function = function_of(generator, node, name)
    statements = generator.out
    while generator.hoisted:
        loaded, inner = generator.hoisted.pop()
        generator.out = []
        called = function_of(generator, inner, f"{loaded}_function")
        statements = [*generator.out, generator.setting(loaded, generator.call("one", expression(called))), *statements]
    return [*statements, generator.setting(result, expression(function))]
