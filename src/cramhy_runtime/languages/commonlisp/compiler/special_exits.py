"""The special operators that meet exits: ``unwind-protect``, ``catch``, ``handler-case`` and ``handler-bind``. See ``special_forms.py``."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import sym
from ..syntax.lambda_lists import gensym
from .analyze import LAMBDA
from .environment import Variable
from .nodes import Catching, Handling, Lambda, MultipleValueProg1, Support, UnwindProtect
from .special_forms import FUNCALL, bound, items_of, parts_of, special


@special("UNWIND-PROTECT")
def _unwind_protect(analyzer, form, env):
    protected, *cleanup = parts_of(analyzer, form, 1)
    body = analyzer.form(protected, env)
    if not cleanup:
        return body
    return bound(body, UnwindProtect(body, analyzer.body(cleanup, env)))


def _thunk(analyzer, forms, env):
    return analyzer.lambda_(None, list_from(forms), env)


@special("CATCH")
def _catch(analyzer, form, env):
    tag, *forms = parts_of(analyzer, form, 1)
    return Support("catch", [analyzer.form(tag, env), _thunk(analyzer, forms, env)], single=False)


@special("THROW")
def _throw(analyzer, form, env):
    tag, value = parts_of(analyzer, form, 2, 2)
    return Support("throw", [analyzer.form(tag, env), MultipleValueProg1(analyzer.form(value, env), [])])


@special("PROGV")
def _progv(analyzer, form, env):
    symbols, values, *forms = parts_of(analyzer, form, 2)
    return Support("progv", [analyzer.form(symbols, env), analyzer.form(values, env), _thunk(analyzer, forms, env)], single=False)


@special("CRAMHY::CATCHING")
def _catching(analyzer, form, env):
    """``(catching types form (variables . body)...)``: what most ``handler-case`` forms are."""
    types, guarded, *clauses = parts_of(analyzer, form, 2)
    node = _guarded(analyzer, guarded, env)
    inner = env.child()
    symbol = gensym("CONDITION")
    condition = inner.variables[symbol] = Variable(symbol, env.scope)
    bodies = []
    for clause in clauses:
        bindings = lisp_list(lisp_list(clause.car.car, symbol)) if clause.car is not None else None
        bodies.append(analyzer.form(Cons(sym("LET"), Cons(bindings, clause.cdr)), inner))
    catching = Catching(types, node, condition, bodies)
    catching.single = node.single and all(body.single for body in bodies)
    return catching


def _guarded(analyzer, form, env):
    """The node of ``form``, which will stand in a ``try``."""
    if env.scope.loop_depth + env.scope.catching_depth > 3:  # Python nests no more than 20 statements, but functions at will
        form = lisp_list(FUNCALL, lisp_list(LAMBDA, None, form))
    env.scope.catching_depth += 1
    try:
        return analyzer.form(form, env)
    finally:
        env.scope.catching_depth -= 1


@special("CRAMHY::HANDLING")
def _handling(analyzer, form, env):
    """``(handling ((type function)...) . body)``: what ``handler-bind`` is."""
    bindings, *body = parts_of(analyzer, form, 1)
    types = [binding.car for binding in items_of(analyzer, form, bindings)]
    functions = [Support("handler", [analyzer.form(binding.cdr.car, env)]) for binding in items_of(analyzer, form, bindings)]
    functions = [each.arguments[0] if isinstance(each.arguments[0], Lambda) else each for each in functions]
    body = _guarded(analyzer, Cons(sym("LOCALLY"), list_from(body)), env)
    return bound(body, Handling(types, functions, body))
