"""What code walkers see of the operators that only our compiler knows.

``handler-bind``, ``handler-case`` and ``defun`` expand into operators of the package CRAMHY that the compiler compiles itself. A program
that expands forms until it finds a special operator or a function, as ITERATE does, takes them for macros: the expansions here say the
same by functions and lambda expressions. The compiler never asks for them.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from

from ..syntax.body_parts import body_parts
from ..syntax.lambda_lists import gensym, support
from cramhy_runtime.lisp_core.packages import sym
from .setf_places import macro

FUNCTION, LAMBDA, LIST, QUOTE = sym("FUNCTION"), sym("LAMBDA"), sym("LIST"), sym("QUOTE")


def _function(variables, *body):
    return lisp_list(FUNCTION, Cons(LAMBDA, Cons(variables, list_from(body))))


@macro("CRAMHY::NAMED-LAMBDA")
def _named_lambda(form, environment):
    """``(named-lambda name lambda-list . body)``: a function with a block of its name."""
    name, variables, *body = list(form.cdr)
    documentation, declarations, forms = body_parts(body)
    block = name.cdr.car if isinstance(name, Cons) else name
    text = [] if documentation is None else [documentation]
    return _function(variables, *text, *declarations, Cons(sym("BLOCK"), Cons(block, list_from(forms))))


@macro("CRAMHY::HANDLING")
def _handling(form, environment):
    """``(handling ((type function)...) . body)``"""
    bindings, *body = list(form.cdr)
    handlers = [lisp_list(LIST, lisp_list(QUOTE, binding.car), binding.cdr.car) for binding in bindings or ()]
    return lisp_list(support("HANDLER-BIND"), lisp_list(LIST, *handlers), _function(None, *body))


@macro("CRAMHY::CATCHING")
def _catching(form, environment):
    """``(catching types form (variables . body)...)``"""
    types, guarded, *clauses = list(form.cdr)
    handlers = []
    for type_, clause in zip(types, clauses, strict=True):
        ignored = gensym("CONDITION")
        variables = clause.car if clause.car is not None else lisp_list(ignored)
        unused = [lisp_list(sym("DECLARE"), lisp_list(sym("IGNORE"), ignored))] if clause.car is None else []
        handlers.append(lisp_list(LIST, lisp_list(QUOTE, type_), _function(variables, *unused, *(clause.cdr or ()))))
    return lisp_list(support("HANDLER-CASE"), lisp_list(LIST, *handlers), _function(None, guarded), None)
