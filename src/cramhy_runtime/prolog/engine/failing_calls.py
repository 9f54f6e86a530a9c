"""The report of an error in a Lisp function that a goal called. It adds the rule, its place and the reason to the original's text.

Most such errors come from a variable that has no value yet: then the function gets its symbol (prolog.md section 8, rule 2).
"""

from __future__ import annotations

from itertools import zip_longest

from cramhy_runtime.ground.data import Cons, list_from, python_list
from cramhy_runtime.ground.ports import PORTS
from cramhy_runtime.utilities.patterns import variable

from .source_positions import Place
from .goal_text import show
from ..symbols import sym
from ..terms.terms import Var

_CALLS = {"function": sym("CRAM-PROLOG::LISP-FUN"), "predicate": sym("CRAM-PROLOG::LISP-PRED")}


def note_place(warning, m, kind, function, arguments, problem):
    """Note on ``warning`` which rule called ``function``, which of the ``arguments`` are unset, and a hint about the ``problem``.

    ``kind`` is ``function`` or ``predicate``, ``m`` the proof.
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
    warning.where = place.where
    warning.hint = (
        "\n".join(
            filter(
                None,
                [
                    place.rule("It is called by"),
                    f"{' and '.join(unset)} {'has' if len(unset) == 1 else 'have'} no value." if unset else None,
                    PORTS.output.hint(problem),
                ],
            )
        )
        or None
    )


def _term(argument):
    """The term of which ``argument`` of a Lisp function was made: a symbol that is a variable stands for one without a value."""
    if not variable(argument):
        return argument
    term = Var()
    term.name = argument
    return term
