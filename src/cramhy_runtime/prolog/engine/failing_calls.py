"""The report of an error in a Lisp function that a goal called. It adds the rule, its place and the reason to the original's text.

Most such errors come from a variable that has no value yet: then the function gets its symbol (prolog.md section 8, rule 2).
"""

from __future__ import annotations

from itertools import zip_longest

from cramhy_runtime.lisp_core.data import Cons, list_from, python_list
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.printing import attempt_to_print, princ_to_string
from cramhy_runtime.lisp_core.source_places import describe
from cramhy_runtime.utilities.patterns import variable

from cramhy_runtime.kernel.typing_names import Any, TYPE_CHECKING
from .source_positions import Place
from .goal_text import show
from ..symbols import sym
from ..terms.terms import Var

if TYPE_CHECKING:
    from collections.abc import Iterable

_CALLS = {"function": sym("CRAM-PROLOG::LISP-FUN"), "predicate": sym("CRAM-PROLOG::LISP-PRED")}


_MOST_CAUSES = 4


def note_place(warning: Any, m: Any, kind: str, function: Any, arguments: Any, problem: Any, inside: Any = None) -> None:
    """Note on ``warning`` which rule called ``function``, which of the ``arguments`` are unset, and a hint about the ``problem``.

    ``kind`` is ``function`` or ``predicate``, ``m`` the proof, which notes the cause, too. ``inside`` is the place of the error, if known.
    """
    terms = [_term(argument) for argument in arguments]
    rest = list_from([*terms, Var()]) if kind == "function" else list_from(terms)
    place = Place(m, Cons(_CALLS[kind], Cons(function, rest)))
    first = 2
    if place.written is None and kind == "predicate":  # a comparison is a goal of its own
        place, first = Place(m, Cons(function, rest)), 1
    names = python_list(place.written)[first : first + len(terms)]
    unset = [show(name if variable(name) else term) for term, name in zip_longest(terms, names) if term.__class__ is Var]
    unset = list(dict.fromkeys(unset))
    without_value = f"{' and '.join(unset)} {'has' if len(unset) == 1 else 'have'} no value." if unset else None
    advice = PORTS.output.hint(problem)
    warning.where = place.where
    warning.hint = "\n".join(filter(None, [place.rule("It is called by"), without_value, advice])) or None
    _note_cause(m, kind, function, problem, inside, place, filter(None, [without_value, advice]))


def _note_cause(m: Any, kind: str, function: Any, problem: Any, inside: Any, place: Place, hints: Iterable[str]) -> None:
    """Keep a text about the error for the explanation of why the proof failed. Of many errors the first few are kept."""
    causes = m.warned_of().causes
    if len(causes) < _MOST_CAUSES:
        rule = place.rule("which is called by")
        called = f", {rule[:-1]}{f' {place.where}' if place.where else ''}," if rule else ""
        text = " ".join(attempt_to_print(princ_to_string, problem).split())
        at = describe(inside)
        lines = [f"The Lisp {kind} {attempt_to_print(show, function)}{called} signalled an error:", f"  {text}", at and f"  at {at}"]
        causes["\n".join([line for line in lines if line] + [f"  {line}" for hint in hints for line in hint.splitlines()])] = True


def _term(argument):
    """The term of which ``argument`` of a Lisp function was made: a symbol that is a variable stands for one without a value."""
    if not variable(argument):
        return argument
    term = Var()
    term.name = argument
    return term
