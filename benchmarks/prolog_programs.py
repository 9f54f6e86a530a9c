"""The programs that the Prolog figures are of, in Lisp text, and the same programs for SWI-Prolog, run there live.

Each program is text of clauses ``((head) goal...)``. For SWI-Prolog they are written in its syntax: a goal ``(f a ?x)`` is ``f(a, X)``, and
lists are lists. It runs each goal so often that it takes a tenth of a second at least.
"""

from __future__ import annotations

import random
import shutil
import subprocess
import tempfile
from pathlib import Path

LISTS = [
    "((app () ?l ?l))",
    "((app (?h . ?t) ?l (?h . ?r)) (app ?t ?l ?r))",
    "((nrev () ()))",
    "((nrev (?h . ?t) ?r) (nrev ?t ?rt) (app ?rt (?h) ?r))",
    "((mem ?x (?x . ?_)))",
    "((mem ?x (?_ . ?t)) (mem ?x ?t))",
]

ZEBRA = [
    "((right-of ?y ?x (?x ?y . ?_)))",
    "((right-of ?y ?x (?_ . ?t)) (right-of ?y ?x ?t))",
    "((next-to ?x ?y ?l) (right-of ?x ?y ?l))",
    "((next-to ?x ?y ?l) (right-of ?y ?x ?l))",
    """((zebra ?houses ?owner)
             (== ?houses ((house ?n1 ?p1 ?c1 ?d1 ?s1) (house ?n2 ?p2 ?c2 ?d2 ?s2) (house ?n3 ?p3 ?c3 ?d3 ?s3)
                          (house ?n4 ?p4 ?c4 ?d4 ?s4) (house ?n5 ?p5 ?c5 ?d5 ?s5)))
             (== ?n1 norwegian) (== ?d3 milk)
             (mem (house english ?a1 red ?a2 ?a3) ?houses) (mem (house spanish dog ?b1 ?b2 ?b3) ?houses)
             (mem (house ?e1 ?e2 green coffee ?e3) ?houses) (mem (house ukrainian ?f1 ?f2 tea ?f3) ?houses)
             (right-of (house ?g1 ?g2 green ?g3 ?g4) (house ?h1 ?h2 ivory ?h3 ?h4) ?houses)
             (mem (house ?i1 snails ?i2 ?i3 winston) ?houses) (mem (house ?j1 ?j2 yellow ?j3 kools) ?houses)
             (next-to (house ?k1 ?k2 ?k3 ?k4 chesterfield) (house ?l1 fox ?l2 ?l3 ?l4) ?houses)
             (next-to (house ?m1 ?m2 ?m3 ?m4 kools) (house ?o1 horse ?o2 ?o3 ?o4) ?houses)
             (mem (house ?q1 ?q2 ?q3 juice luckystrike) ?houses) (mem (house japanese ?r1 ?r2 ?r3 parliaments) ?houses)
             (next-to (house norwegian ?t1 ?t2 ?t3 ?t4) (house ?u1 ?u2 blue ?u3 ?u4) ?houses)
             (mem (house ?owner zebra ?w1 ?w2 ?w3) ?houses))""",
]


def edges():
    """200 facts ``edge`` over 39 nodes, drawn by chance, with as many answers to the joins as the peers had (5,063 and 144)."""
    chance, found = random.Random(1737), set()
    while len(found) < 200:
        a, b = chance.randrange(39), chance.randrange(39)
        if a != b:
            found.add((a, b))
    return [f"((edge n{a} n{b}))" for a, b in sorted(found)]


def poses(name, count):
    """The text of ``count`` facts with a pose as the first argument."""
    return [f"(({name} (pose p{i} (at {i} {i % 7})) {i}))" for i in range(count)]


def numbers(count):
    """The text of a list of ``count`` numbers."""
    return f"({' '.join(map(str, range(count)))})"


JOIN = "(and (edge ?x ?y) (edge ?y ?z) (edge ?z ?w))"
CYCLE = "(and (edge ?x ?y) (edge ?y ?z) (edge ?z ?x))"
GOALS = {  # name → the goal, and what stands for its solutions when all are wanted
    "nrev 30": (f"(nrev {numbers(30)} ?r)", None),
    "nrev 300": (f"(nrev {numbers(300)} ?r)", None),
    "append": (f"(app {numbers(20)} (1) ?c)", None),
    "append 10000": (f"(app {numbers(10_000)} (1) ?c)", None),
    "member 1000": (f"(member ?x {numbers(1000)})", "?x"),
    "own member 100": (f"(mem ?x {numbers(100)})", "?x"),
    "own member 1000": (f"(mem ?x {numbers(1000)})", "?x"),
    "all edges": ("(edge ?x ?y)", "(?x ?y)"),
    "first edge": ("(edge ?x ?y)", None),
    "edges of": ("(edge n3 ?y)", "?y"),
    "join": (JOIN, "(?x ?y ?z ?w)"),
    "cycle": (CYCLE, "(?x ?y ?z)"),
    "zebra": ("(zebra ?houses ?owner)", None),
}

_RATE = """
rate(Name, Goal) :- rate(Name, Goal, 1).
rate(Name, Goal, N) :- statistics(cputime, T0), ( between(1, N, _), once(Goal), fail ; true ), statistics(cputime, T1), T is T1 - T0,
    ( T < 0.1 -> M is N * 4, rate(Name, Goal, M) ; R is N / T, format("~w|~w~n", [Name, R]) ).
"""


def swi_figures(read):
    """Goal name → how often a second SWI-Prolog proves it here; empty where it is not installed. ``read`` makes data of text."""
    program = shutil.which("swipl")
    if program is None:
        return {}
    clauses = [_clause(read(text)) for text in [*LISTS, *ZEBRA, *edges()]]
    rates = [
        f"rate('{name}', {_goal(read(goal)) if wanted is None else f'findall({_term(read(wanted))}, {_goal(read(goal))}, _)'})"
        for name, (goal, wanted) in GOALS.items()
    ]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "peers.pl"
        path.write_text("\n".join([*sorted(clauses, key=_functor), _RATE, f"main :- {', '.join(rates)}.", ""]))
        done = subprocess.run([program, "-q", "-g", "main", "-t", "halt", str(path)], capture_output=True, text=True, timeout=120)
    return {name: float(rate) for name, _, rate in (line.partition("|") for line in done.stdout.splitlines()) if rate}


def _functor(clause):
    return clause.partition("(")[0]


def _clause(data):
    head, *goals = data
    return f"{_goal(head)}{' :- ' + ', '.join(map(_goal, goals)) if goals else ''}."


def _goal(data):
    functor, *arguments = data
    name = functor.name.lower()
    if name == "and":
        return f"({', '.join(map(_goal, arguments))})"
    if name == "==":
        return " = ".join(map(_term, arguments))
    return f"{name.replace('-', '_')}({', '.join(map(_term, arguments))})"


def _term(data):
    if data is None:
        return "[]"
    if isinstance(data, int):
        return str(data)
    if hasattr(data, "name"):
        name = data.name.lower().replace("-", "_")
        return ("_" if name == "?_" else "V" + name[1:]) if name.startswith("?") else name
    items, cell = [], data
    while hasattr(cell, "cdr"):
        items.append(_term(cell.car))
        cell = cell.cdr
    return f"[{', '.join(items)}{'' if cell is None else '|' + _term(cell)}]"
