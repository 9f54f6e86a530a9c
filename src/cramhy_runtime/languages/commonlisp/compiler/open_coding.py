"""Functions that are written in place: mapping over lists, and the next method of a method.

``(mapcar (lambda (x) ...) list)`` means a loop whose body is that of the function, and becomes one. So the variables around stay
variables of one Python function, and ``return-from`` and ``go`` out of the function written in place are jumps. Functions of
several lists end with the shortest. What has another shape (a lambda list with keywords, a function that is computed) is called.

A method that uses ``call-next-method`` and ``next-method-p`` has them as local functions, so that it can give them away, too. Where its
parameters are all required, the definitions of these functions say which variable holds the function of the next method, and which the
arguments. Then a call of ``call-next-method`` is a call of that function, and no closure is made.
"""

from __future__ import annotations

from cramhy_runtime.ground.data import Cons, Symbol, lisp_list, list_from
from ..syntax.lambda_lists import gensym
from ..loop.loop_support import CAR_OF_CONS, CDR_OF_CONS, COLLECT, COLLECT_NCONC, END_OF_LIST
from cramhy_runtime.ground.packages import sym
from .nodes import CallLocal, LocalVariable, Support

MAPCAR, MAPC, MAPCAN = map(sym, "MAPCAR MAPC MAPCAN".split())
LET, LET_STAR, TAGBODY, IF, GO, SETQ, PROGN, ATOM, CONS, FUNCTION, LAMBDA = map(
    sym, "LET LET* TAGBODY IF GO SETQ PROGN ATOM CONS FUNCTION LAMBDA".split()
)
MAPPING = {MAPCAR: COLLECT, MAPC: None, MAPCAN: COLLECT_NCONC}


def open_coded(form):
    """The loop that a call of a mapping function means, or ``None`` to call it."""
    parts, cell = [], form.cdr
    while isinstance(cell, Cons):
        parts.append(cell.car)
        cell = cell.cdr
    if cell is not None or len(parts) < 2:
        return None
    function, *lists = parts
    if isinstance(function, Cons) and function.car is FUNCTION and isinstance(function.cdr, Cons):
        function = function.cdr.car
    if not (isinstance(function, Cons) and function.car is LAMBDA and isinstance(function.cdr, Cons)):
        return None
    variables = _variables(function.cdr.car)
    if variables is None or len(variables) != len(lists):
        return None
    return _loop(form.car, variables, function.cdr.cdr, lists)


def _variables(lambda_list):
    variables, cell = [], lambda_list
    while isinstance(cell, Cons):
        if not isinstance(cell.car, Symbol) or cell.car.name.startswith("&"):
            return None
        variables.append(cell.car)
        cell = cell.cdr
    return variables if cell is None and len(set(variables)) == len(variables) else None


def _loop(name, variables, body, lists):
    collect = MAPPING[name]
    rests = [gensym("REST") for _ in lists]
    first, header, tail, again, end = (gensym(text) for text in ("FIRST", "HEADER", "TAIL", "NEXT", "END"))
    bindings = [lisp_list(rest, each) for rest, each in zip(rests, lists, strict=True)]
    leave = lisp_list(GO, end)
    tests = [lisp_list(IF, lisp_list(ATOM, rest), lisp_list(PROGN, lisp_list(END_OF_LIST, rest), leave), None) for rest in rests]
    elements = list_from([lisp_list(variable, lisp_list(CAR_OF_CONS, rest)) for variable, rest in zip(variables, rests, strict=True)])
    value = Cons(LET, Cons(elements, body))
    steps = [lisp_list(SETQ, rest, lisp_list(CDR_OF_CONS, rest)) for rest in rests]
    if collect is None:
        bindings.append(lisp_list(first, rests[0]))
        result = first
    else:
        bindings += [lisp_list(header, lisp_list(CONS, None, None)), lisp_list(tail, header)]
        value = lisp_list(SETQ, tail, lisp_list(collect, tail, value))
        result = lisp_list(CDR_OF_CONS, header)
    loop = Cons(TAGBODY, list_from([again, *tests, value, *steps, lisp_list(GO, again), end]))
    return lisp_list(LET_STAR, list_from(bindings), loop, result)


# -------------------------------------------------------------------------------------------------------- next methods

CALL, EXISTS = sym("CALL-NEXT-METHOD"), sym("NEXT-METHOD-P")
NEXT_VALUES, NEXT_METHOD_EXISTS = sym("CRAMHY::NEXT-VALUES"), sym("CRAMHY::NEXT-METHOD-EXISTS")


def next_method(name, body):
    """What the local function ``name`` with the forms ``body`` means: its name, the variable of the next method, and those of the
    arguments; ``None`` if it is none of the two functions."""
    form = body.car if isinstance(body, Cons) else None
    if not isinstance(form, Cons):
        return None
    if name is CALL and form.car is NEXT_VALUES:
        _, following, _, *given = form
        return name, following, given
    if name is EXISTS and form.car is NEXT_METHOD_EXISTS:
        return name, form.cdr.car, None
    return None


def call_of_next(analyzer, meaning, form, env):
    """The node of the call ``form`` of one of the two."""
    name, following, given = meaning
    function = env.variable(following).used_from(env.scope)
    if name is EXISTS:
        return Support("next_method_exists", [LocalVariable(function)])
    if given is None or form.cdr is not None:
        arguments = analyzer.arguments(form, env)
    else:
        arguments = [analyzer.form(variable, env) for variable in given]
    return CallLocal(function, arguments)
