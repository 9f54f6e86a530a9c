"""``call-next-method`` and ``next-method-p`` where they are called: no closure is made for them.

A method that uses them has them as local functions, so that it can give them away, too. Where its parameters are all required, the
definitions of these functions say which variable holds the function of the next method, and which the arguments. Then a call of
``call-next-method`` is a call of that function.
"""

from __future__ import annotations

from cramhy_runtime.ground.data import Cons
from cramhy_runtime.ground.packages import sym
from .nodes import CallLocal, LocalVariable, Support

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


__all__ = ["call_of_next", "next_method"]
