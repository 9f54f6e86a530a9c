"""Operators that understand fluents: on plain values they are Common Lisp's, on a fluent they make a net.

An operator looks at its direct arguments only. If none of them is a fluent, it computes at once. Otherwise it returns a net, which
computes the operation again whenever an argument pulses, and keeps the value if all fluent arguments are cacheable. ``fl-and`` and
``fl-or`` read their arguments from left to right and stop early, which matters when reading consumes. Source: cpl.md 2.7 to 2.9, 2.12.

``fl-apply`` keeps the original's results: it does not spread its last argument but hands the function a *list* of values.
Repaired: when it is called with that list alone, it follows the fluents in the list.
"""

from __future__ import annotations

from operator import add, gt, lt, mul, sub
from operator import eq as same_number
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar, overload

from cramhy_runtime.lisp_core.condition_types import CaseFailure
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from, one, truth
from cramhy_runtime.lisp_core.equality import eq, eql
from cramhy_runtime.lisp_core.functions import identity
from cramhy_runtime.lisp_core.packages import keyword
from . import formulas
from .fluents import Fluent, announce, check_fluent, function_of, make_fluent, value
from .nets import CachedNet, Net, is_cacheable
from .pulse_fluents import ALWAYS, NEVER, ONCE, ChangeFluent, PulseFluent
from ..symbols import sym

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from cramhy_runtime.lisp_core.data import Keyword
    from ..signatures import Comparison, Missed

T = TypeVar("T")
A = TypeVar("A")
K = TypeVar("K")
_NUMBERS = frozenset(formulas.NUMBERS)


def net(operator: str, formula: Callable[[], A], arguments: Sequence[object], careful: bool = False) -> Net[A]:
    """The net of ``formula`` over the fluents among ``arguments``. ``careful`` says that ``formula`` calls a function of the user."""
    inputs = tuple(dict.fromkeys([argument for argument in arguments if isinstance(argument, Fluent)]))
    kind = CachedNet if all(map(is_cacheable, inputs)) else Net
    return announce(kind(operator, formula, inputs, careful))


def _lifted(name, operator, quick=None, symbol=None):
    """The fluent-aware form of the Common Lisp function ``name``.

    The commonest case, two ordinary numbers, is done by ``quick`` of Python, whose ``symbol`` formulas contain.
    """
    lisp, is_test = sym(name), symbol in ("<", ">", "==")

    def compute(*arguments):
        return lisp.function(*arguments)

    def lifted(*arguments):
        if quick is not None and len(arguments) == 2:
            first, second = arguments
            if first.__class__ in _NUMBERS and second.__class__ in _NUMBERS:
                return quick(first, second) or None if is_test else quick(first, second)
        for argument in arguments:
            if isinstance(argument, Fluent):
                fast = quick is not None and len(arguments) == 2
                formula = formulas.of_numbers(symbol, compute, arguments) if fast else formulas.of_call(compute, arguments)
                return net(operator, formula, arguments)
        return lisp.function(*arguments)

    lifted.__name__ = operator.lower()
    lifted.__doc__ = f"``cl:{name.lower()}`` that makes a net when an argument is a fluent."
    return lifted


fl_lt = _lifted("<", "FL<", lt, "<")
fl_gt = _lifted(">", "FL>", gt, ">")
fl_equals = _lifted("=", "FL=", same_number, "==")
fl_plus = _lifted("+", "FL+", add, "+")
fl_minus = _lifted("-", "FL-", sub, "-")
fl_times = _lifted("*", "FL*", mul, "*")
fl_divide = _lifted("/", "FL/")
fl_member = _lifted("MEMBER", "FL-MEMBER")


def _lift_test(operator: str, test: Callable[[Any, Any], bool | None]) -> Comparison:
    def lifted(first, second):
        if isinstance(first, Fluent) or isinstance(second, Fluent):
            return net(operator, formulas.of_call(test, (first, second)), (first, second))
        return test(first, second)

    lifted.__name__ = lifted.__qualname__ = operator.lower().replace("-", "_")  # by which an error of its arguments finds it
    return lifted


fl_eq = _lift_test("FL-EQ", eq)
fl_eql = _lift_test("FL-EQL", eql)


@overload
def fl_not(argument: Fluent[object]) -> Fluent[bool | None]: ...
@overload
def fl_not(argument: object) -> object: ...
def fl_not(argument: object) -> object:
    """``(not x)``; for a fluent, a net that is true while the value of the fluent is not."""
    if isinstance(argument, Fluent):
        return net("FL-NOT", formulas.of_not(argument), (argument,))
    return None if truth(argument) else True


@overload
def fl_and(first: Fluent[object], /, *more: object) -> Fluent[object]: ...
@overload
def fl_and(*arguments: object) -> object: ...
def fl_and(*arguments: object) -> object:
    """The last value if all are true, else nil; a net of that if there is a fluent. ``(fl-and)`` is true."""
    return _now_or_net("FL-AND", formulas.of_and(arguments), arguments)


@overload
def fl_or(first: Fluent[object], /, *more: object) -> Fluent[object]: ...
@overload
def fl_or(*arguments: object) -> object: ...
def fl_or(*arguments: object) -> object:
    """The first true value, or nil; a net of that if there is a fluent. The fluents after it are not read, so they are not consumed."""
    return _now_or_net("FL-OR", formulas.of_or(arguments), arguments)


def _now_or_net(operator: str, formula: Callable[[], Any], arguments: tuple[object, ...]) -> Any:
    if any(isinstance(argument, Fluent) for argument in arguments):
        return net(operator, formula, arguments)
    return formula()


@overload
def fl_funcall(function: Callable[..., T], first: Fluent[object], /, *more: object) -> Fluent[T]: ...
@overload
def fl_funcall(function: Callable[..., T], *arguments: object) -> T: ...
def fl_funcall(function: Any, *arguments: Any) -> Any:
    """The result of ``function`` on the values of ``arguments``; a net of it if there is a fluent. Lists are not searched for fluents."""
    function = function_of(function)
    for argument in arguments:
        if isinstance(argument, Fluent):
            return net("FL-FUNCALL", formulas.of_users_call(function, arguments), arguments, careful=True)
    return function(*arguments)


def fl_apply(function: Callable[..., T], argument: object, *more: object) -> Net[T]:
    """A net that calls ``function`` with the values of the leading arguments and, last, a *list* of the values in the last argument.

    A last argument that is not a list is a type error. Source: cpl.md 2.7.
    """
    function = function_of(function)
    *leading, last = argument, *more
    if last is not None and not isinstance(last, (Cons, list, tuple)):
        return type_error(last, "LIST")
    elements = [] if last is None else list(last)

    def formula():
        return one(function(*map(value, leading), list_from(list(map(value, elements)))))

    return net("FL-APPLY", formula, [*leading, *elements], careful=True)


_MISSED = {keyword(mode): mode for mode in (NEVER, ONCE, ALWAYS)}


def fl_pulsed(fluent: Fluent[object], *, handle_missed_pulses: Missed | Keyword | None = None) -> PulseFluent:
    """A new fluent that is true while it has not consumed all pulses of ``fluent``. Reading it consumes.

    handle_missed_pulses: "NEVER" forgets the pulses before now, "ONCE" (the default) counts all missed pulses as one, "ALWAYS" counts
    each; Lisp's keywords of these names do as well, and anything else is an error. An argument that is not a fluent is a type error.
    Source: cpl.md 2.8.
    """
    check_fluent(fluent)
    if handle_missed_pulses is None:
        return announce(PulseFluent(fluent))
    mode = _MISSED.get(handle_missed_pulses) or (handle_missed_pulses if handle_missed_pulses in _MISSED.values() else None)
    if mode is None:
        return error(CaseFailure(handle_missed_pulses, "ECASE", lisp_list(*_MISSED)))
    return announce(PulseFluent(fluent, mode))


pulsed = fl_pulsed


def fl_value_changed(
    fluent: Fluent[T], *, test: Callable[[K, K], object] | None = None, key: Callable[[T], K] | None = None
) -> ChangeFluent:
    """A net that is true once after each change of the value of ``fluent``.

    key: a function that is applied to the value first. test: a function of two values, true if they are the same (``eql``). An argument
    that is not a fluent is a type error. Source: cpl.md 2.9.
    """
    check_fluent(fluent)
    return announce(ChangeFluent(fluent, function_of(eql if test is None else test), function_of(identity if key is None else key)))


_parameters = {}


def define_cpl_parameter(name, initial=None):
    """``(def-cpl-parameter name initial)``: define a place with a hidden fluent, which nets can observe. Returns ``name``."""
    _parameters[name] = make_fluent(name=name, value=initial)
    return name


def cpl_parameter_fluent(name):
    """The fluent behind the parameter ``name``."""
    return _parameters[name]


def parameter_value(name):
    """The value of the parameter ``name``."""
    return _parameters[name].stored


def set_parameter_value(new, name):
    """Assign the parameter ``name``; returns ``new``."""
    return _parameters[name].set(new)
