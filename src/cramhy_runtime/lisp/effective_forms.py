"""The form that a long-form method combination computes, as a function.

``(call-method m (next ...))`` and ``(make-method form)`` are only known inside such a form. It is small: calls of methods under
``progn``, ``and``, ``multiple-value-prog1``, ``unwind-protect``, ``let`` and function calls; so it is turned directly into Python
closures over the arguments, macros being expanded on the way. Source: ANSI CALL-METHOD, DEFINE-METHOD-COMBINATION.
"""

from __future__ import annotations

from .conditions import SimpleError, error
from .data import Cons, Keyword, Symbol, all_values, lisp_list, one, python_list, truth, values
from .method_combination import AROUND, SPECIAL_FOLDS, link
from .packages import sym, symbol_name


def function_of_form(form, generic_function, classes):
    """The function of the generic function's arguments that does what ``form`` says."""
    run = _Translation(generic_function, classes).translate(form)
    return lambda *arguments, **keywords: run((arguments, keywords, {}))


class _MadeMethod:
    """What ``(make-method form)`` stands for in a list of next methods."""

    uses_next, per_class, qualifiers = False, False, (AROUND,)

    def __init__(self, function):
        self.function = function

    def callable_for(self, classes):
        return self.function


class _Translation:
    """Translates forms to functions of a state (arguments, Python keywords, local variables)."""

    def __init__(self, generic_function, classes):
        self.generic_function, self.classes = generic_function, classes

    def translate(self, form):
        if not isinstance(form, Cons):
            return self._atom(form)
        if not isinstance(form.car, Symbol):
            return error(SimpleError("~S cannot stand in the form of a method combination.", form))
        special = getattr(self, "form_" + symbol_name(form.car).lower().replace("-", "_").replace("*", "_star"), None)
        if special is not None:
            return special(*python_list(form.cdr))
        from .macros import macroexpand_1

        expansion, expanded = macroexpand_1(form)
        if expanded:
            return self.translate(expansion)
        arguments = [self.translate(argument) for argument in python_list(form.cdr)]
        return lambda state: form.car.function(*[one(argument(state)) for argument in arguments])

    def _atom(self, form):
        if isinstance(form, Symbol) and not isinstance(form, Keyword):
            return lambda state: state[2][form] if form in state[2] else form.value
        return lambda state: form

    def _sequence(self, forms):
        steps = [self.translate(form) for form in forms]

        def run(state):
            result = None
            for step in steps:
                result = step(state)
            return result

        return run

    def _method(self, form):
        if isinstance(form, Cons) and symbol_name(form.car) == "MAKE-METHOD":
            return _MadeMethod(function_of_form(form.cdr.car, self.generic_function, self.classes))
        return form

    def form_call_method(self, method, following=None, *_):
        methods = [self._method(item) for item in (method, *python_list(following))]
        function = link(self.generic_function, methods, self.classes)
        return lambda state: function(*state[0], **state[1])

    def form_quote(self, value):
        return lambda state: value

    def form_function(self, name):
        return lambda state: name.function

    def form_funcall(self, function, *arguments):
        steps = [self.translate(form) for form in (function, *arguments)]

        def run(state):
            called, *given = [one(step(state)) for step in steps]
            return (called.function if isinstance(called, Symbol) else called)(*given)

        return run

    def form_progn(self, *forms):
        return self._sequence(forms)

    form_locally = form_progn

    def _fold(self, name, forms):
        steps = [self.translate(form) for form in forms]
        fold = SPECIAL_FOLDS[name]
        if not steps:
            return lambda state: True if name == "AND" else None
        return lambda state: fold([lambda step=step: step(state) for step in steps])

    def form_and(self, *forms):
        return self._fold("AND", forms)

    def form_or(self, *forms):
        return self._fold("OR", forms)

    def form_if(self, test, then, otherwise=None):
        test, then, otherwise = self.translate(test), self.translate(then), self.translate(otherwise)
        return lambda state: then(state) if truth(one(test(state))) else otherwise(state)

    def form_multiple_value_prog1(self, first, *forms):
        first, rest = self.translate(first), self._sequence(forms)

        def run(state):
            result = first(state)
            rest(state)
            return result

        return run

    def form_prog1(self, first, *forms):
        run = self.form_multiple_value_prog1(first, *forms)
        return lambda state: one(run(state))

    def form_unwind_protect(self, protected, *cleanup):
        protected, cleanup = self.translate(protected), self._sequence(cleanup)

        def run(state):
            try:
                return protected(state)
            finally:
                cleanup(state)

        return run

    def form_let(self, bindings, *body):
        pairs = [python_list(binding) if isinstance(binding, Cons) else [binding, None] for binding in python_list(bindings)]
        steps = [(variable, self.translate(form)) for variable, form in pairs]
        body = self._sequence(body)

        def run(state):
            arguments, keywords, variables = state
            new = {variable: one(step(state)) for variable, step in steps}
            return body((arguments, keywords, {**variables, **new}))

        return run

    def form_let_star(self, bindings, *body):
        form = lisp_list(sym("PROGN"), *body)
        for binding in reversed(python_list(bindings)):
            form = lisp_list(sym("LET"), lisp_list(binding), form)
        return self.translate(form)

    def form_values(self, *forms):
        steps = [self.translate(form) for form in forms]
        return lambda state: values(*[one(step(state)) for step in steps])

    def form_multiple_value_list(self, form):
        step = self.translate(form)
        return lambda state: lisp_list(*all_values(step(state)))
