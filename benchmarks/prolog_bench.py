"""Reasoning figures, beside those of the peers (reference page peers.md: CRAM on SBCL, SWI-Prolog 9, and our goal).

Run: ``PYTHONPATH=src python benchmarks/prolog_bench.py``. Each figure is the best of five runs on this machine; the peers'
were measured on another one, so compare the ratios.
"""

from __future__ import annotations

import time

from cramhy_runtime import kernel
from cramhy_runtime.lisp import cl_names
from cramhy_runtime.lisp.data import list_from
from cramhy_runtime.lisp.packages import COMMON_LISP, make_package

for _name in cl_names.NAMES.split():
    if _name not in ("nil", "t"):
        COMMON_LISP.export(COMMON_LISP.intern(_name.upper()))

import cramhy_runtime.prolog.package  # noqa: E402, F401
from cramhy_runtime.prolog import facts, query  # noqa: E402
from cramhy_runtime.utilities.lazy_lists import force_ll  # noqa: E402
from cramhy_runtime.prolog.terms import Var  # noqa: E402

HERE = make_package("PROLOG-BENCH", use=["COMMON-LISP", "CRAM-PROLOG"])


def read(text):
    """Symbols, integers and lists: enough for the programs of this file."""
    tokens = text.replace("(", " ( ").replace(")", " ) ").split()

    def form(position):
        token = tokens[position]
        if token != "(":
            return (int(token) if token.lstrip("-").isdigit() else HERE.intern(token.upper())), position + 1
        items, tail, position = [], None, position + 1
        while tokens[position] != ")":
            if tokens[position] == ".":
                tail, position = form(position + 1)
            else:
                item, position = form(position)
                items.append(item)
        return list_from(items, tail), position + 1

    return form(0)[0]


def define(name, *clauses):
    facts.define_fact_group(read(name), None, [read(clause) for clause in clauses])


LISTS = ("((app () ?l ?l))", "((app (?h . ?t) ?l (?h . ?r)) (app ?t ?l ?r))", "((nrev () ()))",
         "((nrev (?h . ?t) ?r) (nrev ?t ?rt) (app ?rt (?h) ?r))", "((mem ?x (?x . ?_)))", "((mem ?x (?_ . ?t)) (mem ?x ?t))")

ZEBRA = ("((right-of ?y ?x (?x ?y . ?_)))", "((right-of ?y ?x (?_ . ?t)) (right-of ?y ?x ?t))",
         "((next-to ?x ?y ?l) (right-of ?x ?y ?l))", "((next-to ?x ?y ?l) (right-of ?y ?x ?l))",
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
             (mem (house ?owner zebra ?w1 ?w2 ?w3) ?houses))""")


def best(work, count):
    """Seconds per call of ``work``, the best of five runs of ``count`` calls."""
    times = []
    for _ in range(5):
        start = time.perf_counter()
        for _ in range(count):
            work()
        times.append((time.perf_counter() - start) / count)
    return min(times)


def row(name, value, cram, swi, goal):
    print(f"| {name} | {value} | {cram} | {swi} | {goal} |")


def human(number):
    return f"{number / 1e6:.2f} M" if number >= 1e6 else f"{number / 1e3:.0f} k" if number >= 1e4 else f"{number:,.3g}"


def main():
    kernel.start(clock="virtual")
    define("lists", *LISTS)
    define("zebra-puzzle", *ZEBRA)
    edges = [(i % 50, (i * 7 + 3 + i // 50 * 11) % 50) for i in range(200)]
    define("edges", *(f"((edge n{a} n{b}))" for a, b in edges))
    print("| work | cramhy | CRAM on SBCL | SWI-Prolog | goal |\n|---|---|---|---|---|")
    nrev, app, thirty, twenty = read("nrev"), read("app"), list_from(range(30)), list_from(range(20))
    for length, items in ((30, thirty), (300, list_from(range(300)))):
        inferences = (length + 1) * (length + 2) / 2
        rate = inferences / best(lambda: next(query.ask(nrev, items, Var())), 10)
        row(f"naive reverse of {length}, LIPS", human(rate), "4,064" if length == 30 else "-", "42 M", "1 M, flat")
    one, goal = list_from([1]), list_from([app, twenty, list_from([1]), read("?c")])
    row("append 20+1, LIPS", human(21 / best(lambda: query.prolog(goal), 200)), "116 k", "37 M", "1 M")
    row("append 20+1 asked from Python, LIPS", human(21 / best(lambda: next(query.ask(app, twenty, one, Var())), 200)), "-", "-", "-")

    def findall(functor, size):
        inner = list_from([read(functor), read("?x"), list_from(range(size))])
        whole = list_from([read("findall"), read("?x"), inner, read("?l")])
        return 1 / best(lambda: force_ll(query.prolog(whole).car.car.cdr), 5)

    row("findall over member of 1000, a second", human(findall("member", 1000)), "0.85", "8,350", "800")
    row("findall over own member of 100 / 1000", f"{human(findall('mem', 100))} / {human(findall('mem', 1000))}", "177 / 1.1",
        "63 k / 6.7 k", "10 k / 1 k")
    every, bound = read("(edge ?x ?y)"), read("(edge n3 ?y)")
    figures = (best(lambda: force_ll(query.prolog(every)), 20), best(lambda: query.prolog(every), 200),
               best(lambda: force_ll(query.prolog(bound)), 200))
    row("200 facts: all / first / bound first argument", " / ".join(human(1 / figure) for figure in figures), "3.0 k / 5.0 k / 14 k",
        "34 k / - / 513 k", "6 k / 80 k / 80 k")
    join = read("(and (edge ?x ?y) (edge ?y ?z) (edge ?z ?w))")
    answers = sum(1 for _ in query.solve(join))
    row(f"three-way join, {answers} answers, a second", human(1 / best(lambda: force_ll(query.prolog(join)), 2)), "10.8 (5,062)",
        "766", "100")
    cycle = read("(and (edge ?x ?y) (edge ?y ?z) (edge ?z ?x))")
    answers = sum(1 for _ in query.solve(cycle))
    row(f"three-way join with a cycle, {answers} answers", human(1 / best(lambda: force_ll(query.prolog(cycle)), 2)), "12.2 (144)",
        "4,975", "150")
    zebra = read("(zebra ?h ?o)")
    owner = query.first(zebra, read("?o"))
    row(f"zebra puzzle ({owner.name.lower()}), a second", human(1 / best(lambda: query.prolog(zebra), 1)), "0.97", "723", "30")

    define("motion", """((motion-like ?d (drive ?m)) (property ?d (type drive)) (property ?d (speed ?s)) (property ?d (angle ?a))
                         (lisp-fun make-motion ?s ?a ?m))""")
    read("make-motion").function = lambda speed, angle: (speed, angle)
    define("desig", "((property d1 (type drive)))", "((property d1 (speed 5)))", "((property d1 (angle 2)))")
    motion = read("motion-like")
    seconds = best(lambda: next(query.ask(motion, read("d1"), Var())), 100)
    row("a grounding clause with three properties and a lisp-fun", f"{seconds * 1e6:.1f} us", "193 us (driving)", "-", "15 us")


if __name__ == "__main__":
    main()
