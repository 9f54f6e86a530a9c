"""Clauses that accumulate: collect, append, nconc, count, sum, maximize, minimize.

Without ``into`` the result of the loop is accumulated; all such clauses of one loop share one accumulator and must be of one
kind. A list is built behind a header cell; a variable named by ``into`` always shows the list collected so far.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, lisp_list
from ..syntax.lambda_lists import gensym
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from .loop_support import CDR_OF_CONS, COLLECT, COLLECT_APPEND, COLLECT_NCONC
from .loop_tokens import zero

SETQ, CONS, CDR, PLUS, GREATER, LESS = map(sym, "SETQ CONS CDR + > <".split())
IF, LET = sym("IF"), sym("LET")

WITH_INTO = "INTO gives what is collected a variable, which FINALLY can return."

KINDS = {
    **dict.fromkeys(("COLLECT", "COLLECTING", "APPEND", "APPENDING", "NCONC", "NCONCING"), "LIST"),
    **dict.fromkeys(("SUM", "SUMMING", "COUNT", "COUNTING"), "SUM"),
    **dict.fromkeys(("MAXIMIZE", "MAXIMIZING", "MINIMIZE", "MINIMIZING"), "MAXIMIZE"),
}
_LIST_STEPS = {"COLLECT": COLLECT, "APPEND": COLLECT_APPEND, "NCONC": COLLECT_NCONC}


class Accumulator:
    """One value being accumulated: its kind and its variables."""

    def __init__(self, kind, variable):
        self.kind = kind
        self.variable = variable
        self.tail = self.started = None


def clause(loop, keyword):
    """Read an accumulation clause after its keyword."""
    tokens = loop.tokens
    value = loop.value_form()
    into = None
    if tokens and tokens.next_is("INTO"):
        tokens.take()
        into = tokens.take()
        if not is_symbol(into):
            tokens.fail("The value accumulation recipient name, ~S, is not a symbol.", into)
    declared = None
    if tokens.next_is("OF-TYPE") or (KINDS[keyword] != "LIST" and tokens and not isinstance(tokens.peek(), Cons)):
        declared = tokens.type_specifier()
    accumulator = _accumulator(loop, keyword, into, declared)
    verb = keyword[:-3] if keyword.endswith("ING") else keyword
    verb = {"SUMM": "SUM", "MAXIMIZ": "MAXIMIZE", "MINIMIZ": "MINIMIZE"}.get(verb, verb)
    variable = accumulator.variable
    if accumulator.kind == "LIST":
        step = lisp_list(SETQ, accumulator.tail, lisp_list(_LIST_STEPS[verb], accumulator.tail, value))
        loop.emit(step if into is None else lisp_list(*step, variable, lisp_list(CDR, accumulator.header)))
    elif verb == "SUM":
        loop.emit(lisp_list(SETQ, variable, lisp_list(PLUS, variable, value)))
    elif verb == "COUNT":
        loop.emit(lisp_list(IF, value, lisp_list(SETQ, variable, lisp_list(PLUS, variable, 1)), None))
    else:
        loop.emit(_extreme(accumulator, GREATER if verb == "MAXIMIZE" else LESS, value))


def _accumulator(loop, keyword, into, declared):
    kind = KINDS[keyword]
    if into is None and loop.aggregates:
        loop.tokens.fail("This anonymous collection LOOP clause is not permitted with aggregate booleans.", hint=WITH_INTO)
    found = loop.accumulators.get(into)
    if found is not None:
        if found.kind != kind:
            loop.tokens.fail(
                "incompatible kinds of LOOP value accumulation specified for collecting~%~A: ~A and ~A",
                "as the value of the LOOP" if into is None else f"in {into.name}",
                found.kind,
                keyword,
                hint="Give each its own variable with INTO.",
            )
        return found
    if into is not None and into in loop.variables:
        loop.tokens.fail("Duplicated variable ~S in INTO clause", into)
    found = loop.accumulators[into] = Accumulator(kind, gensym("RESULT") if into is None else into)
    if kind == "LIST":
        found.header = loop.temporary("HEADER", lisp_list(CONS, None, None))
        found.tail = loop.temporary("TAIL", found.header)
        if into is not None:
            loop.bind([(into, None)])
    else:
        loop.bind([(found.variable, zero(declared) if declared is not None and zero(declared) is not None else 0)])
        if kind == "MAXIMIZE":
            found.started = loop.temporary("STARTED")
    return found


def _extreme(accumulator, comparison, value):
    new, variable = gensym("NEW"), accumulator.variable
    return lisp_list(
        LET,
        lisp_list(lisp_list(new, value)),
        lisp_list(
            IF,
            lisp_list(IF, accumulator.started, lisp_list(comparison, new, variable), True),
            lisp_list(SETQ, variable, new, accumulator.started, True),
            None,
        ),
    )


def result(loop):
    """The form for the value of the loop."""
    accumulator = loop.accumulators.get(None)
    if accumulator is None:
        return loop.default_result
    return lisp_list(CDR_OF_CONS, accumulator.header) if accumulator.kind == "LIST" else accumulator.variable
