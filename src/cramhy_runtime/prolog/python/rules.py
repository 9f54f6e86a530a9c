"""Facts, rules and queries from Python.

    with fact_group("family") as family:
        family.fact(P.parent("tom", "bob"), P.parent("bob", "ann"))
        family.rule(P.ancestor(V.x, V.y), P.parent(V.x, V.y))
        family.rule(P.ancestor(V.x, V.z), P.parent(V.x, V.y), P.ancestor(V.y, V.z))

    for answer in solve(P.ancestor("tom", V.who)):
        print(answer.who)

A group is defined as a whole when its block ends, and not at all if the block fails. It replaces the group of that name, if there is
one. Answers come one after the other, each when it is asked for. Queries need neither a plan nor a kernel, though code that they call
may need one. Source: prolog.md sections 5 and 6.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, Self, overload

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import SimpleError, StyleWarning
from cramhy_runtime.lisp_core.conditions import handler_bind
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.lisp_core.restarts import muffle_warning
from ..builtins import control
from ..explanations import explanations
from ..engine import fact_groups as facts
from .. import query, tracing
from ..builtins import builtins as _builtins, productions as _productions, rete as _rete  # noqa: F401  the built-in predicates are there
from ..engine.database import functors
from ..explanations.explanations import Explanation
from .ground import reasoning
from .terms import USER, Goal, Name, Tail, Variable, goal_form, import_predicates, in_python_names, show, to_lisp, to_python
from cramhy_runtime.utilities.patterns import ANONYMOUS
from ..symbols import sym

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from contextlib import AbstractContextManager

# As far as this room has come, the functors are the predicates that come with it.
import_predicates(*control.CONTROL, *functors, sym("CRAM-PROLOG::EXPLAIN"), ANONYMOUS)


class UnknownPredicate(LookupError):
    """A query uses a predicate that is not defined."""


# ---------------------------------------------------------------------------------------------------------------- fact groups


class FactGroup:
    """The facts and rules of a group while its ``with`` block runs. `fact_group` makes it."""

    def __init__(self, name: str | Name | Symbol, extends: Iterable[Name | Symbol]):
        self.name = _group_name(name)
        self.extends: list[Symbol] = [to_lisp(predicate) for predicate in extends]
        self.clauses: list[Cons] = []

    def fact(self, *heads: Goal) -> None:
        """Add one or more facts, which hold without conditions: ``P.parent("tom", "bob")``. Anything but a goal is a TypeError."""
        for head in heads:
            self.rule(head)

    def rule(self, head: Goal, *goals: Goal) -> None:
        """Add a rule: ``head`` holds if all ``goals`` hold, which are proved from left to right. Its variables belong to this rule only.

        Anything but a goal is a TypeError.
        """
        self.clauses.append(Cons(goal_form(head), list_from([goal_form(goal) for goal in goals])))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, problem: BaseException | None, traceback: object) -> None:
        if problem is None:
            self._define()

    def _define(self) -> None:
        try:
            with reasoning():
                handler_bind(
                    [(StyleWarning, lambda warning: muffle_warning(warning))],
                    lambda: facts.define_fact_group(self.name, self.extends, list_from(self.clauses)),
                )
        except SimpleError as refused:
            refused.add_note(
                "A group adds to predicates of other groups, or of cramhy, only if it says so: "
                f"fact_group({show(self.name)!r}, extends=[P.the_predicate])."
            )
            raise


def fact_group(name: str | Name | Symbol, extends: Iterable[Name | Symbol] = ()) -> FactGroup:
    """``with fact_group("family") as family:`` collects facts and rules, and defines the group when the block ends.

    name: the name of the group; a later group of the same name replaces it. extends: the predicates of other groups to which this one
    adds clauses. If the block fails, or the group cannot be defined, the clauses from before stay in force. Clauses for a predicate of
    another group that ``extends`` does not list are a SimpleError. Source: prolog.md 6.
    """
    return FactGroup(name, extends)


def remove_fact_group(name: str | Name | Symbol) -> None:
    """Remove all clauses of the group ``name``. An unknown name does nothing. A name that is not a string or `Name` is a TypeError."""
    facts.remove_fact_group(_group_name(name))


def _group_name(name: Any) -> Symbol:
    found = USER.intern(name.upper().replace("_", "-")) if isinstance(name, str) else to_lisp(name)
    if not isinstance(found, Symbol):
        raise TypeError(f"{name!r} cannot name a fact group. Give a string, or a name: P.family.")
    return found


# --------------------------------------------------------------------------------------------------------------------- answers


class Answer(Mapping[str, Any]):
    """One answer of a query: the values of its variables, as attributes and as items. Lists are Python lists, nil is ``[]``.

    It has no item for a variable that the answer leaves open.
    """

    __slots__ = ("_values",)

    def __init__(self, values: Mapping[Symbol, object]):
        self._values = {_variable_name(symbol): value for symbol, value in values.items()}
        if not _METHODS.isdisjoint(self._values):
            self.__class__ = _NamedLikeMethods

    def __getattr__(self, name: str) -> Any:
        if name == "_values":  # one that is being unpickled
            raise AttributeError(name)
        if name in self._values:
            return self[name]
        near = near_names(name, self._values)
        hint = f" Did you mean {near[0]!r}?" if near else f" It has: {', '.join(self._values) or 'none'}."
        raise AttributeError(f"This answer has no value for a variable {name!r}.{hint}", name=name, obj=self)

    def __getitem__(self, key: str | Variable) -> Any:
        return to_python(self._values[key.name if isinstance(key, Variable) else key], list)

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __bool__(self) -> bool:
        """An answer is true, even without variables."""
        return True

    def __eq__(self, other: object) -> bool:
        return dict(self._pairs()) == dict(other._pairs() if isinstance(other, Answer) else other) if isinstance(other, Mapping) else False

    __hash__ = None  # type: ignore[assignment]  # as for all mappings

    def __repr__(self) -> str:
        return f"Answer({', '.join(f'{name}={value!r}' for name, value in self._pairs())})"

    def _pairs(self) -> list[tuple[str, Any]]:
        return [(name, self[name]) for name in self._values]

    def in_lisp(self, symbol: Symbol) -> object:
        """The value of the variable ``symbol`` as Lisp data; the symbol itself if the answer leaves it open."""
        return self._values.get(_variable_name(symbol), symbol)


_METHODS = frozenset(("keys", "items", "values", "get", "in_lisp"))


class _NamedLikeMethods(Answer):
    """An answer with a variable that is called like one of its methods: the attribute is the value of the variable."""

    __slots__ = ()

    def __getattribute__(self, name: str) -> Any:
        if name in _METHODS:
            values = object.__getattribute__(self, "_values")
            if name in values:
                return self[name]
        return super().__getattribute__(name)


def _variable_name(symbol: Symbol) -> str:
    return Variable(symbol).name


def solve(*goals: Goal) -> Iterator[Answer]:
    """Iterate over the answers to the question whether all ``goals`` hold together. The next answer is searched for on demand.

    Errors: TypeError for anything but a goal; `UnknownPredicate` if a predicate of the question is not defined; all exceptions of
    predicates written in Python. Source: prolog.md 5.
    """
    return _answers(_question(goals))


def _answers(question: Cons) -> Iterator[Answer]:
    solutions = query.solve(question)
    while True:
        if kernel.active() is None:
            with reasoning():
                found = next(solutions, None)
        else:
            found = next(solutions, None)
        if found is None:
            return
        yield Answer(found)


def first(*goals: Goal) -> Answer | None:
    """The first answer of `solve`, or ``None``. An answer is always true. Errors are as in `solve`."""
    return next(solve(*goals), None)


def holds(*goals: Goal) -> bool:
    """Whether all ``goals`` hold together. Errors are as in `solve`."""
    return first(*goals) is not None


@overload
def findall(template: tuple[object, ...], *goals: Goal) -> list[tuple[Any, ...]]: ...
@overload
def findall(template: list[object], *goals: Goal) -> list[list[Any]]: ...
@overload
def findall(template: object, *goals: Goal) -> list[Any]: ...
def findall(template: object, *goals: Goal) -> list[Any]:
    """The list of ``template`` in each answer, in order, with values in place of its variables. Errors are as in `solve`.

    findall(V.who, P.ancestor("tom", V.who))        findall((V.x, V.y), P.parent(V.x, V.y))

    template: a variable, a goal, or a list, tuple, set, dict or dataclass with variables in it; anything else comes back as it is.
    """
    return [_instance(template, answer) for answer in solve(*goals)]


def _instance(template: Any, answer: Answer) -> Any:
    if isinstance(template, Variable):
        return answer[template] if template.name in answer else template
    if isinstance(template, Goal):
        return Goal(_instance_of_form(template.form, answer))
    cls: Any = template.__class__
    if isinstance(template, dict):
        return cls([(_instance(key, answer), _instance(value, answer)) for key, value in template.items()])
    if isinstance(template, (tuple, list, set, frozenset)):
        parts = [instance for part in template for instance in _instances(part, answer)]
        return cls(*parts) if hasattr(cls, "_fields") else cls(parts)
    if hasattr(cls, "__dataclass_fields__") and not isinstance(template, type):
        made = copy.copy(template)
        for name in [name for name in cls.__dataclass_fields__ if hasattr(template, name)]:
            object.__setattr__(made, name, _instance(getattr(template, name), answer))
        return made
    return template


def _instances(part: Any, answer: Answer) -> list[Any]:
    """The instances of an element of a template: several, if it is the rest of a list."""
    if part.__class__ is not Tail:
        return [_instance(part, answer)]
    rest = _instance(part.rest, answer)
    return rest if isinstance(rest, list) else [Tail(rest)]


def _instance_of_form(form: Any, answer: Answer) -> Any:
    if isinstance(form, Cons):
        return Cons(_instance_of_form(form.car, answer), _instance_of_form(form.cdr, answer))
    if isinstance(form, Symbol) and form.name[:1] == "?":
        return answer.in_lisp(form)
    return form


def explain(question: object) -> Explanation:
    """An explanation of why a goal, or a designator, has a solution or none. The goal is proved again for that.

    ``print(explain(goal))`` shows the text. ``explain(goal).holds`` is the outcome, and ``.reason`` says why the goal at the bottom
    failed. Anything but a goal or a designator is an error.
    """
    with in_python_names():
        told: Explanation = explanations.explain(question.form if isinstance(question, Goal) else question)
    return told


def trace(*predicates: Name | Symbol) -> AbstractContextManager[None]:
    """``with trace(P.parent):`` each call, exit, redo and fail of these goals is a line on the standard output; without predicates, of all.

    predicates: names of predicates, built-in ones as well. Those that are traced already stay so afterwards.
    """
    return tracing.tracing(*[to_lisp(predicate) for predicate in predicates])


setattr(Explanation, "__repr__", Explanation.__str__)


def _question(goals: tuple[Any, ...]) -> Cons:
    forms = [goal_form(goal) for goal in goals]
    if not forms:
        raise TypeError('A query needs a goal: solve(P.parent(V.x, "tom")).')
    for form in forms:
        _check_predicates(form)
    return forms[0] if len(forms) == 1 else Cons(sym("AND"), list_from(forms))


_JUNCTIONS = (sym("AND"), sym("OR"), sym("NOT"))


def _check_predicates(form: Any) -> None:
    # In Lisp a query of an unknown predicate is a warning; for Python, where P.ancestr is a name like any other, that is too little.
    functor = form.car
    if functor in _JUNCTIONS:
        for part in form.cdr or ():
            if isinstance(part, Cons):
                _check_predicates(part)
    elif functor not in control.CONTROL and not is_defined(functor):
        known = {symbol.name.upper(): symbol for symbol in functors if isinstance(symbol, Symbol) and is_defined(symbol)}
        near = near_names(functor.name.upper(), known, 1)
        hint = f" Did you mean {show(known[near[0]])}?" if near else " Define it in a fact group, or by @predicate."
        raise UnknownPredicate(f"Nobody has defined the predicate {show(functor)} of the goal {show(form)}.{hint}")


def is_defined(functor: Any) -> bool:
    """Whether goals of ``functor`` can have solutions: it has facts, rules, or Python code."""
    entry = functors.get(functor)
    return entry is not None and entry.defined
