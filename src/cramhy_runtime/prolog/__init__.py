"""CRAM's Prolog: terms, unification, clauses compiled to Python, built-in predicates, fact groups and rete. It uses the lazy lists
and patterns of the room ``utilities``. Source: reference page ``prolog.md``. Python code can use it without any Lisp:

    from cramhy_runtime.prolog import P, V, fact_group, solve

    with fact_group("family") as family:
        family.fact(P.parent("tom", "bob"), P.parent("bob", "ann"))
        family.rule(P.grandparent(V.x, V.z), P.parent(V.x, V.y), P.parent(V.y, V.z))

    for answer in solve(P.grandparent(V.who, "ann")):
        print(answer.who)

The page docs/reasoning-in-python.md teaches it. ``python/terms.py`` has the notation of terms, ``python/rules.py`` facts, rules and
queries, ``python/predicates.py`` predicates written in Python, and ``python/asserted_facts.py`` facts that come and go. Other rooms ask
queries with `cramhy_runtime.prolog.query` and define predicates with
`cramhy_runtime.prolog.builtins.native_predicates`.
"""

from .python.asserted_facts import facts_asserted, facts_watched
from .python.predicates import Predicate, UnboundVariable, function, predicate, test
from .python.rules import Answer, FactGroup, UnknownPredicate, explain, fact_group, findall, first, holds, remove_fact_group, solve, trace
from .python.terms import Goal, Name, Names, P, Tail, V, Variable, kw, names

__all__ = [
    "Answer", "explain", "fact_group", "FactGroup", "facts_asserted", "facts_watched", "findall", "first", "function", "Goal", "holds",
    "kw", "Name", "names", "Names", "P", "predicate", "Predicate", "remove_fact_group", "solve", "Tail", "test", "trace", "UnboundVariable",
    "UnknownPredicate", "V", "Variable",
]  # fmt: skip
