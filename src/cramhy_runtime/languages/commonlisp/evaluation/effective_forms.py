"""The form that a long-form method combination computes, as a function.

``(call-method m (next ...))`` and ``(make-method form)`` are only known inside such a form. They are local macros of it: a call of a
method becomes a call of the function that `method_combination.link` makes of it, with the arguments of the generic function.
The rest of the form is whatever Lisp its author wrote, and goes through the compiler. Source: ANSI CALL-METHOD,
DEFINE-METHOD-COMBINATION.
"""

from __future__ import annotations

from ..compiler.environment import Env, LocalMacro
from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from, python_list
from .evaluator import compile_lambda
from ..syntax.lambda_lists import gensym, parse
from cramhy_runtime.lisp_core.packages import sym, symbol_name
from cramhy_runtime.lisp_core.dispatch.method_combination import AROUND, link
from cramhy_runtime.lisp_core.dispatch.methods import Shape

CALL_METHOD, MAKE_METHOD, LAMBDA, QUOTE = sym("CALL-METHOD"), sym("MAKE-METHOD"), sym("LAMBDA"), sym("QUOTE")


def function_of_form(form, generic_function, classes, lambda_list=None, *, made=False):
    """The function of the generic function's arguments that does what ``form`` says.

    lambda_list: that of the option ``:arguments``; its variables stand for the arguments of the call in ``form``. made: whether it is the
    form of a ``make-method``, which a method may have given other arguments.
    """
    state = gensym("STATE")

    def call_method(call, environment):
        method, *following = python_list(call.cdr)
        methods = [
            _method(item, generic_function, classes, lambda_list) for item in (method, *python_list(following[0] if following else None))
        ]
        linked = link(generic_function, methods, classes)
        function = linked.changed if made else linked.function
        return lisp_list(sym("FUNCALL"), lisp_list(QUOTE, lambda given: function(*given[0], **given[1])), state)

    environment = Env()
    environment.functions[CALL_METHOD] = LocalMacro(call_method)
    if lambda_list is not None:
        given = lisp_list(sym("FUNCALL"), lisp_list(QUOTE, lambda given: list_from(given[0])), state)
        form = lisp_list(sym("DESTRUCTURING-BIND"), _lenient(lambda_list), given, form)
    run = compile_lambda(lisp_list(LAMBDA, lisp_list(state), form), environment)
    return lambda *arguments, **keywords: run((arguments, keywords))


def _method(form, generic_function, classes, lambda_list):
    if isinstance(form, Cons) and symbol_name(form.car) == "MAKE-METHOD":
        return _MadeMethod(function_of_form(form.cdr.car, generic_function, classes, lambda_list, made=True))
    return form


def _lenient(lambda_list):
    """``lambda_list`` so that it takes any arguments: those that are missing are nil, others are ignored (ANSI)."""
    parsed = parse(lambda_list)
    parts = [
        sym("&OPTIONAL"),
        *parsed.required,
        *(lisp_list(variable, default, *([supplied] if supplied else [])) for variable, default, supplied in parsed.optional),
    ]
    parts += [sym("&REST"), parsed.rest if parsed.rest is not None else gensym("IGNORED")]
    if parsed.has_keys:
        keys = [
            lisp_list(lisp_list(key, variable), default, *([supplied] if supplied else []))
            for key, variable, default, supplied in parsed.keys
        ]
        parts += [sym("&KEY"), *keys, sym("&ALLOW-OTHER-KEYS")]
    return list_from(parts)


class _MadeMethod:
    """What ``(make-method form)`` stands for in a list of next methods."""

    uses_next, qualifiers, specializers, shape = False, (AROUND,), (), Shape()

    def __init__(self, function):
        self.function = function

    def callable_for(self, classes):
        return self.function
