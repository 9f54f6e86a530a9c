"""Random programs have the same answers in the same order here and in SWI-Prolog. Skipped where ``swipl`` is not installed.

With ``CRAMHY_SOAK=1`` there are 5,000 programs instead of 200.
"""

import os
import shutil

import pytest
import swi_text
from prolog_text import RegisteredWarnings, read, show
from random_programs import Program

from cramhy_runtime import image
from cramhy_runtime.lisp.data import Cons, Keyword, Symbol
from cramhy_runtime.prolog import facts, query
from cramhy_runtime.utilities.lazy_lists import elements
from cramhy_runtime.utilities.patterns import ANONYMOUS, var_value, variable, variables_of

LIMIT = 30
"""Answers that are compared."""
WANTED = 5000 if os.environ.get("CRAMHY_SOAK") == "1" else 200


def shown(term, names):
    """``term`` as `swi_text.LIBRARY` shows it."""
    if term is None:
        return "nil"
    if isinstance(term, Cons):
        return f"({shown(term.car, names)} . {shown(term.cdr, names)})"
    if variable(term):
        return "'$named'(" + names.setdefault(term, f"'_{len(names)}'") + ")"
    if isinstance(term, Keyword):
        return f"':{term.name.lower()}'"
    if isinstance(term, Symbol):
        return term.name.lower()
    return f'"{term}"' if isinstance(term, str) else repr(term)


def answers(program, variables):
    """The first answers to the query of ``program``, as lines of text."""
    facts.define_fact_group(read("random-program"), None, program.clauses)
    try:
        found = []
        with RegisteredWarnings():
            for bindings in elements(query.prolog(program.query)):
                names = {}
                found.append("".join(f"({shown(var_value(symbol, bindings), names)} . " for symbol in variables) + "nil" + ")" * len(variables))
                if len(found) == LIMIT:
                    break
        return found
    finally:
        facts.remove_fact_group(read("random-program"))


@pytest.mark.skipif(shutil.which("swipl") is None, reason="swi-prolog is not installed")
def test_random_programs_have_the_answers_of_swi_prolog_in_its_order(tmp_path):
    image.boot()
    programs = []
    for seed in range(WANTED * 5 // 4):
        program = Program(seed)
        programs.append((program, [symbol for symbol in variables_of(program.query) if symbol is not ANONYMOUS]))
    expected = swi_text.run(programs, LIMIT, tmp_path)
    compared = with_answers = 0
    for seed, ((program, variables), wanted) in enumerate(zip(programs, expected)):
        if wanted is None or compared == WANTED:
            continue
        compared += 1
        with_answers += bool(wanted)
        got = answers(program, variables)
        assert got == wanted, "\n".join([f"seed {seed}", *map(show, program.clauses), "?- " + show(program.query)])
    assert compared == WANTED and with_answers > WANTED // 4
