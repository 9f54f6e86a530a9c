"""Predicates written in Python: decorators that make a goal of a function.

    @predicate                          # solutions one after the other, each when it is asked for
    def neighbour(room: str):
        yield "kitchen", 3.0
        yield "hall", 5.5

    @function                           # one solution: what it returns
    def hours(metres: float): return metres / 1800

    @test                               # it holds or not, by Python's truth
    def near(metres: float): return metres < 4

``neighbour("office", V.room, V.metres) & near(V.metres) & hours(V.metres, V.h)`` is a goal. The parameters of the function are
arguments that must have a value when the goal is reached. The arguments after them are unified with the result: one argument with the
value, several with the parts of a tuple. The functor is the name of the function in the package PYTHON-USER, or the one in ``name=``, so
rules of Lisp can use it. The function itself is ``neighbour.function``.

An exception of the function leaves the query, with a note that names the goal; a goal fails only because there is no solution. A group
that ``extends`` such a predicate can add facts to it. Source: prolog.md 5 and 11.
"""

from __future__ import annotations

import functools

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, Generic, NoReturn, TypeVar, overload, subscripted

from cramhy_runtime.kernel.unstarted import plain_function, ran
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from
from ..builtins import native_predicates as natives
from .spelling import exact_lisp_name, lisp_name
from .terms import P, Name, claim, python_arguments, python_predicates, show, to_lisp, what_nil_means
from cramhy_runtime.utilities.patterns import NOTHING

from ..symbols import sym
from ..terms.terms import Var, deref, import_term, resolve

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from ..engine.machine import Machine

F = TypeVar("F", bound="Callable[..., object]", default="Callable[..., Any]")
T = TypeVar("T")
LISP_FUN, LISP_PRED = sym("CRAM-PROLOG::LISP-FUN"), sym("CRAM-PROLOG::LISP-PRED")


class UnboundVariable(ValueError):
    """A predicate written in Python was called with an unset variable for an argument whose value it needs."""


class Predicate(Name, Generic[F]):
    """A predicate written in Python. A call of it makes a goal. ``function`` is the Python function."""

    __slots__ = ("function", "kind", "least", "most", "nothing", "parameters")
    __class_getitem__ = subscripted

    def __init__(self, symbol: Symbol, function: F, kind: str):
        super().__init__(symbol)
        self.function, self.kind = function, kind
        self.nothing: list[object] = what_nil_means(function, list)
        self.parameters: tuple[str, ...] = ()
        self.least: int = 0
        self.most: int | None = None
        code = getattr(function, "__code__", None)
        if code is not None:  # of a function of C we know nothing: it gets all arguments
            bound = 1 if hasattr(function, "__self__") else 0
            self.nothing = self.nothing[bound:]
            self.parameters = code.co_varnames[bound : code.co_argcount]
            self.most = None if code.co_flags & 0x04 else len(self.parameters)
            self.least = len(self.parameters) - len(getattr(function, "__defaults__", None) or ())

    def __get__(self, instance: object, owner: type | None = None) -> Any:
        """As functions in a class: ``robot.can_reach(V.x)`` is the goal whose first argument is ``robot``."""
        return self if instance is None else functools.partial(self, instance)

    @property
    def where(self) -> str:
        """The name and place of the function, for messages."""
        code = getattr(self.function, "__code__", None)
        place = f" ({code.co_filename}:{code.co_firstlineno})" if code is not None else ""
        return f"the @{self.kind} {getattr(self.function, '__name__', self.python_name)}{place}"

    # ------------------------------------------------------------------------------------------------------------- its goals

    def split(self, m: Machine, terms: tuple[object, ...]) -> tuple[list[object], tuple[object, ...]]:
        """(The arguments for the function, the terms to unify with its solutions).

        An argument without a value is an `UnboundVariable`, and a wrong number of arguments a TypeError.
        """
        if self.kind == "test":
            count = len(terms)
        elif self.kind == "function":
            count = len(terms) - 1
        else:
            count = min(len(terms), len(self.parameters))
        if count < self.least or (self.most is not None and count > self.most):
            self.refuse_count(m, terms)
        inputs = []
        for index, term in enumerate(terms[:count]):
            value = deref(term)
            if value.__class__ is Var:
                name = self.parameters[index] if index < len(self.parameters) else f"number {index + 1}"
                raise UnboundVariable(f"The argument {name} has no value in the goal {self.goal_text(m, terms)}. {self.needs_a_value()}")
            inputs.append(resolve(value, m.names))
        return python_arguments(inputs, self.nothing, list), terms[count:]

    def needs_a_value(self) -> str:
        """The advice for an `UnboundVariable`."""
        where = self.where
        return f"{where[0].upper()}{where[1:]} needs it: put a goal that gives the variable a value in front."

    def refuse_count(self, m: Machine, terms: tuple[object, ...]) -> NoReturn:
        """Raise the TypeError for a wrong number of arguments."""
        given = f"The goal {self.goal_text(m, terms)} has {len(terms)} argument{'' if len(terms) == 1 else 's'}"
        expected = [*self.parameters, *({"test": [], "function": ["its result"]}.get(self.kind, ["what it yields"]))]
        raise TypeError(f"{given}; {self.where} has {', '.join(expected) or 'none'}.")

    def goal_text(self, m: Machine, terms: tuple[object, ...]) -> str:
        """The goal as messages show it, with the values of variables."""
        if self.symbol in (LISP_FUN, LISP_PRED):
            terms = (Symbol(exact_lisp_name(getattr(self.function, "__name__", str(self.function)))), *terms)
        return show(Cons(self.symbol, list_from([resolve(term, m.names) for term in terms])))

    def called(self, m: Machine, terms: tuple[object, ...], step: Callable[[], T]) -> T:
        """The result of ``step()``. Its exceptions get a note that names the goal."""
        try:
            return step()
        except UnboundVariable:
            raise
        except Exception as problem:
            note = f"This happened in the goal {self.goal_text(m, terms)}, which is solved by {self.where}."
            if note not in getattr(problem, "__notes__", ()):
                problem.add_note(note)
            raise

    def unify(self, m: Machine, outputs: tuple[object, ...], value: object) -> bool:
        """Unify the output terms with the result ``value`` of the function. Returns whether that is possible."""
        if len(outputs) == 1:
            return bool(m.unify(outputs[0], import_term(to_lisp(value, True, NOTHING), {})))
        if not outputs:
            return True
        if not isinstance(value, (tuple, list)) or len(value) != len(outputs):
            raise TypeError(f"A solution is {value!r}, but the goal has {len(outputs)} arguments for it. Give a tuple of {len(outputs)}.")
        names: dict[Any, Any] = {}
        parts = [import_term(to_lisp(part, True, NOTHING), names) for part in value]
        pairs = [side for both in zip(outputs, parts, strict=True) for side in both]
        return bool(m.unify(*pairs))

    def solutions(self, m: Machine, *terms: object) -> Iterator[None]:
        """The generator for the engine, for a `predicate`: it sets the variables of a solution and yields."""
        inputs, outputs = self.split(m, terms)
        found = self.called(m, terms, lambda: self._iterator(self.function(*inputs)))
        while True:
            value = self.called(m, terms, lambda: next(found, _END))
            if value is _END:
                return
            if self.called(m, terms, lambda: self.unify(m, outputs, value)):
                yield

    def _iterator(self, result: Any) -> Iterator[Any]:
        if result is None:
            return iter(())
        if isinstance(result, (str, bytes, dict)) or not hasattr(result, "__iter__"):
            raise TypeError(f"A predicate yields its solutions, or returns a list of them, not {result!r}. Use @function for one value.")
        return iter(result)

    def value(self, m: Machine, *terms: object) -> bool:
        """The test for the engine, for a `function`."""
        if not terms:
            self.refuse_count(m, terms)
        inputs, outputs = self.split(m, terms)
        return bool(self.called(m, terms, lambda: self.unify(m, outputs, self.function(*inputs))))

    def holds(self, m: Machine, *terms: object) -> bool:
        """The test for the engine, for a `test`."""
        inputs, _ = self.split(m, terms)
        return bool(self.called(m, terms, lambda: bool(ran(self.function(*inputs), "a @test"))))


_END = object()


# ----------------------------------------------------------------------------------------------------------------- decorators


@overload
def predicate(function: F, /) -> Predicate[F]: ...
@overload
def predicate(*, name: Name | Symbol | None = None) -> Callable[[F], Predicate[F]]: ...
def predicate(function: Any = None, /, *, name: Any = None) -> Any:
    """Decorator: make a predicate of a generator of solutions, or of a function that returns a list of them; ``None`` is an empty list.

    name: the name of the predicate, if it is not that of the function. A name of a package of cramhy is a TypeError.
    """
    return _decorated(function, "predicate", name)


@overload
def function(function: F, /) -> Predicate[F]: ...
@overload
def function(*, name: Name | Symbol | None = None) -> Callable[[F], Predicate[F]]: ...
def function(function: Any = None, /, *, name: Any = None) -> Any:
    """Decorator: make a predicate whose last argument is the function's result. ``name`` is as in `predicate`."""
    return _decorated(function, "function", name)


@overload
def test(function: F, /) -> Predicate[F]: ...
@overload
def test(*, name: Name | Symbol | None = None) -> Callable[[F], Predicate[F]]: ...
def test(function: Any = None, /, *, name: Any = None) -> Any:
    """Decorator: make a predicate that holds if the function's result is true in Python. ``name`` is as in `predicate`."""
    return _decorated(function, "test", name)


def _decorated(function: Any, kind: str, name: Any) -> Any:
    def define(function: F) -> Predicate[F]:
        return _define(function, kind, name)

    return define if function is None else define(function)


def _define(function: F, kind: str, name: Any) -> Predicate[F]:
    own = getattr(function, "__name__", "")
    if name is None and not own.isidentifier():
        raise TypeError(f"@{kind} needs a name for {function!r}: write {kind}(name=P.a_name)(...).")
    plain_function(function, f"a @{kind}", yields=kind == "predicate")
    if kind == "predicate" and getattr(function, "__defaults__", None):
        code: Any = getattr(function, "__code__", None)
        optional = code.co_varnames[code.co_argcount - 1]
        raise TypeError(
            f"The @predicate {own} ({code.co_filename}:{code.co_firstlineno}) has a default for {optional}. The arguments of a goal are "
            f"those of all parameters, and then the solution, so nobody could tell whether an argument is {optional} or the solution. "
            "Leave the default out, and give the value in the goal."
        )
    symbol = to_lisp(name) if name is not None else _own_symbol(function, own)
    if symbol.package is not None and symbol.package.built_in:
        raise TypeError(f"{show(symbol)} is a name of cramhy's package {symbol.package.name}. Choose another one: {kind}(name=P.a_name).")
    claim(symbol, function, kind)
    python_predicates.add(symbol)
    made = Predicate(symbol, function, kind)
    group = f"CRAMHY::{symbol.package.name if symbol.package else ''} {symbol.name} IN PYTHON"
    if kind == "predicate":
        natives.predicate(symbol, group)(lambda m, *terms: made.solutions(m, *terms))
    else:
        natives.test(symbol, group)(lambda m, *terms: made.value(m, *terms) if kind == "function" else made.holds(m, *terms))
    return made


def _own_symbol(function: Any, own: str) -> Symbol:
    """The symbol for the name of ``function``. That of a method has the name of its class in front."""
    of_class = getattr(function, "__qualname__", own).rpartition("<locals>.")[2].rpartition(".")[0]
    found: Symbol = P[lisp_name(f"{of_class}.{own}")].symbol if of_class else getattr(P, own).symbol
    return found


def inline(kind: str, function: F) -> Predicate[F]:
    """A predicate for a callable that stands in a goal, as the function of ``lisp-fun`` does."""
    return Predicate(LISP_FUN if kind == "function" else LISP_PRED, function, kind)


natives.test("CRAMHY::PYTHON-FUNCTION")(lambda m, function, *terms: inline("function", deref(function)).value(m, *terms))
natives.test("CRAMHY::PYTHON-TEST")(lambda m, function, *terms: inline("test", deref(function)).holds(m, *terms))
