"""Random programs have the same answers in the same order here and in SWI-Prolog. Skipped where ``swipl`` is not installed.

With ``CRAMHY_SOAK=1`` there are 5,000 programs instead of 100.
"""

import shutil

import pytest
from systems import SOAK
import swi_text
from prolog_text import RegisteredWarnings, read, show
from random_programs import Program

from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from cramhy_runtime.prolog.compiler import variants
from cramhy_runtime.prolog.engine import fact_groups as facts
from cramhy_runtime.prolog import query
from cramhy_runtime.utilities.lazy_lists import LazyTail, elements
from cramhy_runtime.utilities.patterns import ANONYMOUS, var_value, variable, variables_of

LIMIT = 20
"""Answers that are compared."""
WANTED = 5000 if SOAK else 100


def shown(term, names):
    """``term`` as `swi_text.LIBRARY` shows it."""
    if term is None:
        return "nil"
    if isinstance(term, LazyTail):
        return shown(term.force(), names)
    if isinstance(term, Cons):
        return f"({shown(term.car, names)} . {shown(term.cdr, names)})"
    if variable(term):
        return "'$named'(" + names.setdefault(term, f"'_{len(names)}'") + ")"
    if isinstance(term, Keyword):
        return f"':{term.name.lower()}'"
    if isinstance(term, Symbol):
        return term.name.lower()
    return f'"{term}"' if isinstance(term, str) else repr(term)


def answers(goal, variables):
    """The first answers to ``goal``, as lines of text."""
    found = []
    with RegisteredWarnings():
        for bindings in elements(query.prolog(goal)):
            names = {}
            found.append("".join(f"({shown(var_value(symbol, bindings), names)} . " for symbol in variables) + "nil" + ")" * len(variables))
            if len(found) == LIMIT:
                break
    return found


@pytest.mark.skipif(shutil.which("swipl") is None, reason="swi-prolog is not installed")
def test_random_programs_have_the_answers_of_swi_prolog_in_its_order(tmp_path, monkeypatch):
    """In every other program, predicates are written anew at once for calls with known terms, which takes many calls otherwise."""
    boot()
    monkeypatch.setattr(variants, "_LEAST", 1)
    programs = []
    for seed in range(WANTED):
        program = Program(seed)
        queries = [(goal, [symbol for symbol in variables_of(goal) if symbol is not ANONYMOUS]) for goal in program.queries]
        programs.append((program, queries))
    compared = with_answers = 0
    for seed, ((program, queries), expected) in enumerate(zip(programs, swi_text.run(programs, LIMIT, tmp_path))):
        monkeypatch.setattr(variants, "_CALLS", 0 if seed % 2 else 10_000)
        facts.define_fact_group(read("random-program"), None, program.clauses)
        for (goal, variables), wanted in zip(queries, expected):
            if wanted is not None:
                compared += 1
                with_answers += bool(wanted)
                got = answers(goal, variables)
                assert got == wanted, "\n".join([f"seed {seed}", *map(show, program.clauses), "?- " + show(goal)])
        facts.remove_fact_group(read("random-program"))
    assert compared > 3 * WANTED and with_answers > compared * 2 // 5
