"""Method combination: how the applicable methods of a call become one function.

A `Combination` is built once per combination of argument classes; what it returns is cached by the generic function. The
standard combination runs :around, :before, primary and :after methods; short forms (``progn``, ``+``, ``list`` ...) apply an
operator to the results of all primary methods; a language may add forms of its own (`register_combination`). CRAM's ``hooks``
(cpl.md section 11) takes every method, whatever its qualifiers, and gives the list of the results; without methods it gives ``nil``.
Source: ANSI 7.6.6; texts are SBCL's.
"""

from __future__ import annotations

from functools import partial

from ..condition_types import shown
from ..conditions import SimpleError, error, restart_case, type_error, warn
from ..data import Symbol, lisp_list, list_from, one, truth
from ..packages import keyword, sym, symbol_name
from ..ports import PORTS
from .generic_errors import no_next_method_error, no_primary_method_error
from .methods import class_by_value, class_for_dispatch, is_told_by_value, may_be_told_by_value

DIRECTLY, CHANGED = keyword("DIRECTLY"), keyword("CHANGED")
"""What ``uses_next`` of a method is that takes the function of the next method itself, and gives it all arguments. With CHANGED it takes
two functions: one for its own arguments, and one for others, which looks whether the next methods take them."""
SAME = keyword("SAME")
"""What ``uses_next`` of a method is whose `NextMethod` is called without arguments only."""
AROUND, BEFORE, AFTER = keyword("AROUND"), keyword("BEFORE"), keyword("AFTER")


STRICTLY, STRICT = keyword("STRICTLY"), keyword("STRICT")
"""The same as CHANGED, and as ``True``, for a method at safety 3: for other arguments the same methods must apply."""


class SameNextMethod:
    """What a method gets as ``next``: calling it is ``call-next-method``; ``exists`` is ``next-method-p``."""

    __slots__ = ("following", "arguments", "keywords")

    def __init__(self, following, arguments, keywords):
        self.following, self.arguments, self.keywords = following, arguments, keywords

    def __call__(self):
        return self.following(*self.arguments, **self.keywords)

    @property
    def exists(self):
        return None if isinstance(self.following, _NoNext) else True


class NextMethod(SameNextMethod):
    """The same for a method that may give the next one other arguments; ``changed`` takes these."""

    __slots__ = ("changed",)

    def __init__(self, following, changed, arguments, keywords):
        self.following, self.changed, self.arguments, self.keywords = following, changed, arguments, keywords

    def __call__(self, *arguments):
        if arguments:
            return self.changed(*arguments)
        return self.following(*self.arguments, **self.keywords)


class _NoNext:
    """Stands behind the last method."""

    exists = None

    def __init__(self, generic_function, method):
        self.generic_function, self.method = generic_function, method

    def __call__(self, *arguments, **keywords):
        return PORTS.definitions.no_next_method(self.generic_function, self.method, arguments, no_next_method_error)


class _Changed:
    """The function of a method for other arguments than those for which it was chosen. It signals a type-error for one that is not of the
    method's class (ANSI 7.6.6.2); so do the next methods, which are not all asked before, as on SBCL."""

    __slots__ = ("method", "count", "following", "known")

    def __init__(self, method, following):
        self.method, self.count, self.following, self.known = method, len(method.specializers), following, {}

    def __call__(self, *arguments, **keywords):
        kinds = tuple(map(type, arguments[: self.count]))
        function = self.known.get(kinds)
        if function is None:
            classes = tuple(
                class_by_value(argument) if is_told_by_value(specializer) else class_for_dispatch(argument)
                for argument, specializer in zip(arguments, self.method.specializers)
            )
            self._check(arguments, classes)
            function = _step(self.method, classes, self.following, self.following)
            if bool not in kinds and not (any(map(may_be_told_by_value, kinds)) and any(map(is_told_by_value, self.method.specializers))):
                self.known[kinds] = function
        return function(*arguments, **keywords)

    def _check(self, arguments, classes):
        for argument, cls, specializer, name in zip(arguments, classes, self.method.specializers, self.method.shape.names):
            if isinstance(specializer, type) and specializer not in PORTS.classes.precedence(cls):
                type_error(argument, PORTS.classes.name(specializer), f"\nwhen binding {shown(name)}")


class Linked:
    """What runs methods one after another: ``function``, and ``changed`` for other arguments than the methods were chosen for."""

    __slots__ = ("function", "changed")

    def __init__(self, function, changed):
        self.function, self.changed = function, changed


def link(generic_function, methods, classes, last=None):
    """The `Linked` that runs the first of ``methods`` with the others as its next methods, and behind them ``last``, another one."""
    following, changed = (None, None) if last is None else (last.function, last.changed)
    for method in reversed(methods):
        if following is None:
            following = changed = _NoNext(generic_function, method)
        following, changed = _step(method, classes, following, changed), _Changed(method, changed)
    return Linked(following, changed)


def _step(method, classes, following, changed):
    function = method.callable_for(classes)
    if not method.uses_next:
        return function
    if method.uses_next is DIRECTLY:
        return partial(function, following)
    if method.uses_next is CHANGED:
        return partial(function, following, changed)
    if method.uses_next is STRICTLY:
        return lambda *given: function(following, _same_methods(method, given, changed), *given)
    if method.uses_next is STRICT:
        return lambda *given, **keywords: function(
            NextMethod(following, _same_methods(method, given, changed), given, keywords), *given, **keywords
        )
    if method.uses_next is SAME:
        return lambda *arguments, **keywords: function(SameNextMethod(following, arguments, keywords), *arguments, **keywords)
    return lambda *arguments, **keywords: function(NextMethod(following, changed, arguments, keywords), *arguments, **keywords)


def _same_methods(method, given, changed):
    """``changed``, behind a test that the methods for its arguments are those for ``given`` (ANSI CALL-NEXT-METHOD)."""

    def call(*arguments, **keywords):
        function = method.generic_function
        if function.applicable_methods(arguments) != function.applicable_methods(given):
            text = (
                "The methods of ~S that apply to ~S, the arguments of CALL-NEXT-METHOD, are not those for ~S, the arguments of the method."
            )
            return error(SimpleError(text, function, list_from(arguments), list_from(given)))
        return changed(*arguments, **keywords)

    return call


class Combination:
    """The standard method combination, and the interface of all others."""

    lisp_name = "METHOD-COMBINATION"
    accepts_none = False
    documentation = None

    def __init__(self, name):
        self.name = name

    def check(self, generic_function, method):
        """Warn when ``method`` has qualifiers that this combination does not know."""
        if not self.knows(method.qualifiers):
            warn(
                "Invalid qualifiers for ~A method combination in method~%  ~S:~%~S.",
                symbol_name(self.name),
                method,
                list_from(method.qualifiers),
            )

    def knows(self, qualifiers):
        return qualifiers in ((), (AROUND,), (BEFORE,), (AFTER,))

    def effective(self, generic_function, methods, classes):
        """The callable for ``methods``, the applicable methods in order, called with arguments of ``classes``."""
        groups = {(): [], (AROUND,): [], (BEFORE,): [], (AFTER,): []}
        for method in methods:
            if method.qualifiers not in groups:
                return invalid(
                    generic_function,
                    method,
                    "has an invalid qualifier.~%Standard method combination requires all "
                    "methods to have one of the single qualifiers :AROUND, :BEFORE and :AFTER or to have no "
                    "qualifier at all.",
                )
            groups[method.qualifiers].append(method)
        if not groups[()]:
            return lambda *arguments, **keywords: retrying(generic_function, arguments, no_primary_method_error)
        main = link(generic_function, groups[()], classes)
        befores = [link(generic_function, [method], classes) for method in groups[(BEFORE,)]]
        afters = [link(generic_function, [method], classes) for method in reversed(groups[(AFTER,)])]
        if befores or afters:
            main = Linked(
                _with_auxiliaries(main.function, [each.function for each in befores], [each.function for each in afters]),
                _with_auxiliaries(main.changed, [each.changed for each in befores], [each.changed for each in afters]),
            )
        return link(generic_function, groups[(AROUND,)], classes, main).function


def _with_auxiliaries(main, befores, afters):
    """The function that calls ``befores``, ``main`` and ``afters`` with its arguments, and gives the value of ``main``."""

    def run(*arguments, **keywords):
        for function in befores:
            function(*arguments, **keywords)
        result = main(*arguments, **keywords)
        for function in afters:
            function(*arguments, **keywords)
        return result

    return run


def retrying(generic_function, arguments, signal):
    return restart_case(
        [(sym("RETRY"), lambda: generic_function(*arguments), "Retry calling the generic function.")],
        lambda: signal(generic_function, arguments),
    )


def invalid(generic_function, method, why):
    def signal(*arguments, **keywords):
        return error(SimpleError(f"invalid method error for ~S method:~%The method ~S on ~S {why}", method, method, generic_function))

    return signal


STANDARD = Combination(sym("STANDARD"))


class ShortCombination(Combination):
    """An operator over the results of all primary methods, which carry the operator's name as their qualifier.

    fold: a Python function of the list of thunks, one per method.
    """

    def __init__(self, name, fold, identity_with_one_argument=False):
        super().__init__(name)
        self.fold, self.identity = fold, identity_with_one_argument

    def knows(self, qualifiers):
        return qualifiers in ((self.name,), (AROUND,))

    def effective(self, generic_function, methods, classes):
        name = symbol_name(self.name)
        for method in methods:
            if not self.knows(method.qualifiers):
                has = "has no qualifiers" if not method.qualifiers else "has an illegal qualifier"
                return invalid(
                    generic_function,
                    method,
                    f"{has}.~%The method combination type {name} was defined with the short "
                    f"form of DEFINE-METHOD-COMBINATION and so requires all methods have either the single qualifier "
                    f"{name} or the single qualifier :AROUND.",
                )
        primaries = [method for method in methods if method.qualifiers == (self.name,)]
        options = generic_function.combination_options
        if options and symbol_name(options[0]) == "MOST-SPECIFIC-LAST":
            primaries.reverse()
        if not primaries:
            return lambda *arguments, **keywords: retrying(generic_function, arguments, no_primary_method_error)
        functions = [link(generic_function, [method], classes) for method in primaries]
        if len(functions) == 1 and self.identity:
            main = functions[0]
        else:
            main = Linked(
                _folded(self.fold, [each.function for each in functions]), _folded(self.fold, [each.changed for each in functions])
            )
        return link(generic_function, [method for method in methods if method.qualifiers == (AROUND,)], classes, main).function


def _folded(fold, functions):
    """The function that gives ``fold`` the calls of ``functions`` with its arguments, as thunks."""
    return lambda *arguments, **keywords: fold([_thunk(function, arguments, keywords) for function in functions])


def _thunk(function, arguments, keywords):
    return lambda: function(*arguments, **keywords)


def _progn(thunks):
    result = None
    for thunk in thunks:
        result = thunk()
    return result


def _and(thunks):
    result = True
    for thunk in thunks[:-1]:
        result = one(thunk())
        if not truth(result):
            return None
    return thunks[-1]()


def _or(thunks):
    for thunk in thunks[:-1]:
        result = one(thunk())
        if truth(result):
            return result
    return thunks[-1]()


SPECIAL_FOLDS = {"PROGN": _progn, "AND": _and, "OR": _or}


def fold_of(operator):
    """The fold for ``operator``, a symbol: special for ``progn``, ``and`` and ``or``, else a call of its function."""
    name = symbol_name(operator)
    if name in SPECIAL_FOLDS:
        return SPECIAL_FOLDS[name]
    return lambda thunks: operator.function(*[one(thunk()) for thunk in thunks])


class HookCombination(Combination):
    """CRAM's ``hooks``: all methods, most specific first, whatever their one qualifier; the list of their results."""

    accepts_none = True
    requirement = (
        "has no qualifier.~%The method combination type HOOKS requires that each method has exactly one qualifier, which may be any symbol."
    )

    def knows(self, qualifiers):
        return len(qualifiers) == 1

    def ordered(self, methods):
        """The methods in the order in which they are called; ``methods``: the most specific first."""
        return methods

    def effective(self, generic_function, methods, classes):
        for method in methods:
            if not self.knows(method.qualifiers):
                return invalid(generic_function, method, self.requirement)
        functions = [link(generic_function, [method], classes).function for method in self.ordered(methods)]
        run = _folded(self._fold(generic_function.combination_options), functions)
        return run if functions else lambda *arguments, **keywords: None

    def _fold(self, options):
        for key, value in zip(options[::2], options[1::2]):
            if symbol_name(key) == "HOOK-COMBINATION" and symbol_name(value) != "LIST":
                return fold_of(value)
        return lambda thunks: lisp_list(*[one(thunk()) for thunk in thunks])


def _number(method):
    """The number of a method whose qualifiers are a name and a number, ``:heuristics 20``; ``None`` for others."""
    qualifiers = method.qualifiers
    return qualifiers[1] if len(qualifiers) == 2 and qualifiers[1].__class__ is int and qualifiers[1] >= 0 else None


class OrderedHookCombination(HookCombination):
    """CRAM's ``ordered-hooks``: as ``hooks``, but those with a number behind their name are called first, the lowest number first."""

    requirement = "has no qualifier.~%The method combination type ORDERED-HOOKS requires a name, and perhaps a number behind it."

    def knows(self, qualifiers):
        return 1 <= len(qualifiers) <= 2

    def ordered(self, methods):
        numbered = [method for method in methods if _number(method) is not None]
        return sorted(numbered, key=_number) + [method for method in methods if _number(method) is None]


class FirstInOrderCombination(Combination):
    """CRAM's ``first-in-order-and-around``: of the methods with a name and a number, the one with the lowest number is called.

    Of equal numbers the most specific method counts. Methods that are qualified with ``:around`` are called around it.
    """

    def knows(self, qualifiers):
        return qualifiers == (AROUND,) or len(qualifiers) == 2

    def effective(self, generic_function, methods, classes):
        for method in methods:
            if method.qualifiers != (AROUND,) and _number(method) is None:
                return invalid(
                    generic_function,
                    method,
                    "has an invalid qualifier.~%The method combination type FIRST-IN-ORDER-AND-AROUND requires :AROUND, or a name and a "
                    "number, such as :HEURISTICS 20.",
                )
        numbered = [method for method in methods if method.qualifiers != (AROUND,)]
        if not numbered:
            return lambda *arguments, **keywords: retrying(generic_function, arguments, no_primary_method_error)
        main = link(generic_function, [min(numbered, key=_number)], classes)
        return link(generic_function, [method for method in methods if method.qualifiers == (AROUND,)], classes, main).function


# ---------------------------------------------------------------------------------------------------------------- definitions

_combinations: dict = {}
_by_name = {"HOOKS": HookCombination, "ORDERED-HOOKS": OrderedHookCombination, "FIRST-IN-ORDER-AND-AROUND": FirstInOrderCombination}


def register_combination(combination):
    """Let its name name ``combination``."""
    _combinations[combination.name] = combination


def _define_standard_ones():
    for name in "PROGN AND OR + APPEND NCONC LIST MAX MIN".split():
        symbol = sym(name)
        _combinations[symbol] = ShortCombination(symbol, fold_of(symbol), identity_with_one_argument=name != "LIST")
    _combinations[STANDARD.name] = STANDARD


_define_standard_ones()


def known_combination(name):
    """The method combination that the symbol ``name`` names, or ``None``. Those of CRAM are known by their names in every package."""
    found = _combinations.get(name)
    if found is None and isinstance(name, Symbol) and name.name in _by_name:
        found = _combinations[name] = _by_name[name.name](name)
    return found


def find_combination(name):
    """The method combination that the symbol ``name`` names; an error that names the known ones when there is none."""
    found = known_combination(name)
    if found is None:
        return error(
            SimpleError(
                "There is no method combination named ~S. The standard ones are ~{~A~^, ~}; others are defined "
                "with DEFINE-METHOD-COMBINATION.",
                name,
                list_from(sorted(map(symbol_name, _combinations))),
            )
        )
    return found


def define_short_combination(name, *, operator=None, identity_with_one_argument=None, documentation=None):
    """``define-method-combination``, short form; returns the name. operator: a symbol, ``name`` by default."""
    combination = ShortCombination(name, fold_of(operator if operator is not None else name), truth(identity_with_one_argument))
    combination.documentation = documentation
    _combinations[name] = combination
    return name
