"""The long form of ``define-method-combination``: method groups, and a form that says how their methods are run (ANSI 7.6.6.4)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Symbol, lisp_list, list_from, one, python_list, truth
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_primary_method_error
from cramhy_runtime.lisp_core.dispatch.method_combination import Combination, invalid, register_combination, retrying
from cramhy_runtime.lisp_core.packages import printed, symbol_name
from .effective_forms import function_of_form


class LongCombination(Combination):
    """The long form: ``groups`` sort the methods, ``expand`` computes the form that runs them; see `define_long_combination`."""

    def __init__(self, name, groups, traits, expand, lambda_list):
        super().__init__(name)
        self.groups, self.traits, self.expand, self.lambda_list = groups, traits, expand, lambda_list

    def knows(self, qualifiers):
        return any(group.takes(qualifiers) for group in self.groups)

    def effective(self, generic_function, methods, classes):
        lists = [[] for _ in self.groups]
        for method in methods:
            for group, members in zip(self.groups, lists):
                if group.takes(method.qualifiers):
                    members.append(method)
                    break
            else:
                return invalid(
                    generic_function, method, f"has qualifiers that the method combination type {printed(self.name)} does not know."
                )
        options = lisp_list(*generic_function.combination_options)
        for members, traits in zip(lists, python_list(one(self.traits(options)))):
            if traits.car is not None and symbol_name(traits.car) == "MOST-SPECIFIC-LAST":
                members.reverse()
            if truth(traits.cdr) and not members:
                return lambda *arguments, **keywords: retrying(generic_function, arguments, no_primary_method_error)
        form = one(self.expand(generic_function, options, *[list_from(members) for members in lists]))
        return function_of_form(form, generic_function, classes, self.lambda_list)


class MethodGroup:
    """A method group of the long form: ``takes(qualifiers)`` says which methods belong to it."""

    def __init__(self, patterns):
        self.patterns = patterns

    def takes(self, qualifiers):
        return any(self._fits(pattern, qualifiers) for pattern in self.patterns)

    def _fits(self, pattern, qualifiers):
        if isinstance(pattern, Symbol) and pattern.name == "*":
            return True
        if isinstance(pattern, Symbol):
            return truth(one(pattern.function(list_from(qualifiers))))
        rest = list(qualifiers)
        while isinstance(pattern, Cons):
            if not rest or not (pattern.car is rest[0] or _is_star(pattern.car)):
                return False
            pattern, rest = pattern.cdr, rest[1:]
        return not rest if pattern is None else _is_star(pattern)


def _is_star(pattern):
    return isinstance(pattern, Symbol) and pattern.name == "*"


def define_long_combination(name, patterns, traits, expand, *, lambda_list=None, documentation=None):
    """``define-method-combination``, long form; returns the name.

    patterns: for each method group a list of qualifier patterns (lists, ``*``) or predicates (symbols). traits: a function of the
    list of combination options that gives (order . required) for each group. expand: a function of the generic function, the list
    of options, and one list of methods per group; it returns the effective form, with ``call-method`` and ``make-method``.
    lambda_list: that of the option ``:arguments``.
    """
    combination = LongCombination(name, [MethodGroup(python_list(each)) for each in python_list(patterns)], traits, expand, lambda_list)
    combination.documentation = documentation
    register_combination(combination)
    return name
