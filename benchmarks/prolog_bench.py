"""Reasoning figures, beside those of the peers: every row about Prolog of the reference page peers.md.

    PYTHONPATH=src:hy_src python benchmarks/prolog_bench.py

Best and median round, see ``measuring.py``; most rows are numbers a second, so more is better, and the ratio is the goal over the best.
Processor time counts, as in the live figures of SWI-Prolog, and the garbage collector is set as in a session.
What stands under CRAM and the first figure under SWI were recorded on another day; the second one under SWI is this machine's, measured
now, if SWI-Prolog is installed. Queries are asked as users ask them: ``(prolog '(...))`` with the goal as data, and all its answers.
"""

from __future__ import annotations

import gc
import statistics
import time

from measuring import Table, repeat, rounds
from prolog_programs import GOALS, LISTS, ZEBRA, edges, poses, swi_figures

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import make_package, sym
from cramhy_runtime.languages.commonlisp.reader.reader import read_from_string
from cramhy_runtime.repl.session import quiet_collector

boot()

from cramhy_runtime.prolog.engine import database  # noqa: E402
from cramhy_runtime.prolog.engine import fact_groups as facts  # noqa: E402
from cramhy_runtime.prolog import query  # noqa: E402
from cramhy_runtime.prolog.terms.terms import Var  # noqa: E402
from cramhy_runtime.utilities import patterns  # noqa: E402
from cramhy_runtime.utilities.lazy_lists import force_ll  # noqa: E402

HERE = make_package("PROLOG-BENCH", use=["COMMON-LISP", "CRAM-PROLOG"])


def read(text):
    """The Lisp data that ``text`` is."""
    with binding(sym("*PACKAGE*"), HERE):
        form = read_from_string(text)
    return form[0] if isinstance(form, tuple) else form


def define(name, clauses):
    facts.define_fact_group(read(name), None, [read(clause) for clause in clauses])


def first(name):
    """The work that asks for the first answer to a goal."""
    goal = read(GOALS[name][0])
    return lambda: query.prolog(goal)


def answers(name):
    """The work that asks for all answers to a goal, as binding lists."""
    goal = read(GOALS[name][0])
    return lambda: force_ll(query.prolog(goal))


def collected(name):
    """The work that collects the answers to a goal by ``findall``."""
    goal, template = GOALS[name]
    whole = read(f"(findall {template} {goal} ?l)")
    return lambda: force_ll(query.prolog(whole).car.car.cdr)


class PrologTable(Table):
    """A table whose last column is SWI-Prolog: the recorded figure, and the live one."""

    def __init__(self, title):
        super().__init__(title, kernel.active().backend.name, last="SWI-Prolog recorded, here")
        self.swi = swi_figures(read)

    def rate(self, title, name, work, count, goal, cram, swi, units=1):
        """Measure ``work`` in units a second."""
        times = [microseconds / units for microseconds in rounds(repeat(work), count, time.process_time)]
        live = self.swi.get(name)
        self.line(
            title,
            1e6 / min(times),
            1e6 / statistics.median(times),
            goal,
            cram,
            f"{swi}, {f'{live * units:,.0f}' if live else '-'}",
            more_is_better=True,
        )


def inferences(length):
    """What naive reverse of a list takes."""
    return (length + 1) * (length + 2) // 2


def measured(table, title, work, count, goal, cram="-"):
    """A row in microseconds."""
    times = rounds(repeat(work), count, time.process_time)
    table.line(title, min(times), statistics.median(times), goal, cram)


def with_compound_arguments(table):
    for count in (100, 10_000):
        define(f"poses-{count}", poses(f"seen-{count}", count))
        for title, pose in (("all of it known", "p77 (at 77 0)"), ("half of it known", "p77 ?where")):
            goal = read(f"(seen-{count} (pose {pose}) ?n)")
            measured(table, f"a pose among {count:,}, {title}, us", lambda goal=goal: query.prolog(goal), 50, 40)


def with_many_facts(table):
    """What the first query costs, which makes tables of the facts."""
    many, symbols = read("many"), [read(f"s{i}") for i in range(1000)]
    facts.define_fact_group(read("many-facts"), None, [list_from([list_from([many, i, symbols[i % 1000]])]) for i in range(100_000)])
    for title, text, wanted in (
        ("the first query after 100,000 facts, ms", "(many ?x ?y)", 100),
        ("the same, two arguments known, ms", "(many 5 s5)", 200),
    ):
        goal, times = read(text), []
        for _ in range(5):
            database.changed(many)  # the tables are made anew
            gc.collect()
            start = time.process_time()
            assert query.prolog(goal) is not None
            times.append((time.process_time() - start) * 1e3)
        table.line(title, min(times), statistics.median(times), wanted)
    facts.remove_fact_group(read("many-facts"))


def with_patterns(table):
    for title, pattern, thing in (
        ("six elements, three variables", "(a ?x b ?y c ?z)", "(a 1 b 2 c 3)"),
        (
            "six pairs, no variables",
            "((a . 1) (b . 2) (c . 3) (d . 4) (e . 5) (f . 6))",
            "((a . 1) (b . 2) (c . 3) (d . 4) (e . 5) (f . 6))",
        ),
        ("six pairs, six variables", "((a . ?a) (b . ?b) (c . ?c) (d . ?d) (e . ?e) (f . ?f))", "((a) (b) (c) (d) (e) (f))"),
    ):
        constant, data = read(pattern), read(thing)
        measured(table, f"a pattern matched, {title}, us", lambda p=constant, d=data: patterns.pat_match(p, d), 500, 1, "0.35")


def main():
    kernel.start(clock="virtual")
    quiet_collector()
    define("lists", LISTS)
    define("zebra-puzzle", ZEBRA)
    define("edges", edges())
    table = PrologTable("Reasoning, a second")
    table.rate("naive reverse of 30, inferences", "nrev 30", first("nrev 30"), 2, 1e6, "4,064", "42 M", inferences(30))
    table.rate("naive reverse of 300, inferences", "nrev 300", first("nrev 300"), 1, 1e6, "-", "42 M", inferences(300))
    table.rate("append 20+1, inferences", "append", first("append"), 40, 1e6, "116,000", "37 M", 21)
    table.rate("append 10,000+1, inferences", "append 10000", first("append 10000"), 1, 1.2e6, "-", "37 M", 10_001)
    table.rate("findall over member of 1000", "member 1000", collected("member 1000"), 1, 800, "0.85", "8,350")
    table.rate("findall over own member of 100", "own member 100", collected("own member 100"), 10, 10e3, "177", "63 k")
    table.rate("findall over own member of 1000", "own member 1000", collected("own member 1000"), 1, 1e3, "1.1", "6.7 k")
    table.rate("200 facts, all", "all edges", answers("all edges"), 5, 6e3, "3,000", "34 k")
    table.rate("200 facts, the first", "first edge", first("first edge"), 100, 80e3, "5,000", "-")
    table.rate("200 facts, the first argument known", "edges of", answers("edges of"), 100, 80e3, "14,000", "513 k")
    join, cycle = answers("join"), answers("cycle")
    table.rate(f"three-way join, {len(join()):,} answers", "join", join, 1, 100, "10.8", "766")
    table.rate(f"three-way join with a cycle, {len(cycle())} answers", "cycle", cycle, 1, 150, "12.2", "4,975")
    table.rate("zebra puzzle with named variables", "zebra", first("zebra"), 1, 30, "0.97", "723")
    define(
        "motion",
        [
            """((motion-like ?d (drive ?m)) (property ?d (type drive)) (property ?d (speed ?s)) (property ?d (angle ?a))
                          (lisp-fun make-motion ?s ?a ?m))"""
        ],
    )
    define("desig", ["((property d1 (type drive)))", "((property d1 (speed 5)))", "((property d1 (angle 2)))"])
    read("make-motion").function = lambda speed, angle: (speed, angle)
    motion, designator = read("motion-like"), read("d1")
    times = rounds(repeat(lambda: next(query.ask(motion, designator, Var()))), 50, time.process_time)
    table.line("a grounding clause of 3 properties, us", min(times), statistics.median(times), 15, "193")
    with_compound_arguments(table)
    with_many_facts(table)
    with_patterns(table)
    table.end()


if __name__ == "__main__":
    main()
