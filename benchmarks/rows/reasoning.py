"""Rows of Prolog, patterns, designators."""

from __future__ import annotations

import functools
import itertools
import time

from prolog_programs import GOALS, LISTS, ZEBRA, edges

from . import Row, lisp_function, peers

PATTERN = """
(defparameter *bench-pattern* '((?a . 1) (?b . 2) (?c . 3) (?d . 4) (?e . 5) (?f . 6)))
(defparameter *bench-object* '((a . 1) (b . 2) (c . 3) (d . 4) (e . 5) (f . 6)))
(defun bench-matched (n) (dotimes (i n) (cut:pat-match *bench-pattern* *bench-object*)))
"""


@functools.cache
def package():
    from cramhy_runtime.lisp_core.packages import make_package

    return make_package("PROLOG-ROWS", use=["COMMON-LISP", "CRAM-PROLOG"])


def read(text):
    """The Lisp data that ``text`` is, in a package that uses Prolog's."""
    from cramhy_runtime.lisp_core.dynamic import binding
    from cramhy_runtime.lisp_core.packages import sym
    from cramhy_runtime.languages.commonlisp.reader.reader import read_from_string

    with binding(sym("*PACKAGE*"), package()):
        form = read_from_string(text)
    return form[0] if isinstance(form, tuple) else form


def define(name, clauses):
    from cramhy_runtime.prolog.engine import fact_groups

    fact_groups.define_fact_group(read(name), None, [read(clause) for clause in clauses])


def define_lists():
    define("lists", LISTS)


def first(name, clauses, goal, before=lambda: None):
    """Work that asks for the first answer to ``goal``. ``before`` defines what the clauses call."""

    def prepare(session):
        from cramhy_runtime.prolog import query

        before()
        define(name, clauses)
        asked = read(goal)

        def work(count):
            for _ in range(count):
                query.prolog(asked)

        return work

    return prepare


def collected(name, clauses, goal, template):
    """Work that collects all answers by ``findall``."""

    def prepare(session):
        from cramhy_runtime.prolog import query
        from cramhy_runtime.utilities.lazy_lists import force_ll

        define(name, clauses)
        asked = read(f"(findall {template} {goal} ?l)")

        def work(count):
            for _ in range(count):
                force_ll(query.prolog(asked).car.car.cdr)

        return work

    return prepare


def compound(facts):
    """Work that looks up one of so many facts by an argument that is a list."""

    def prepare(session):
        from cramhy_runtime.prolog import query

        name = f"at-{facts}"
        define(name, [f"(({name} (cell {i} {i + 1}) thing-{i}))" for i in range(facts)])
        asked = [read(f"({name} (cell {i * 7919 % facts} {i * 7919 % facts + 1}) ?what)") for i in range(50)]
        query.prolog(asked[0])

        def work(count):
            for i in range(count):
                query.prolog(asked[i % 50])

        return work

    return prepare


def first_query(arguments):
    """Work that makes 100,000 facts of a predicate that is new, and asks once; only the query counts."""

    def prepare(session):
        from cramhy_runtime.lisp_core.data import lisp_list
        from cramhy_runtime.prolog import query
        from cramhy_runtime.prolog.engine import fact_groups

        pairs = [(read(f"n{i % 1000}"), read(f"m{i // 1000}")) for i in range(0, 100_000, 100)]
        numbers = itertools.count()

        def work(count):
            spent = 0.0
            for _ in range(count):
                name = f"link-{arguments.count('?')}-{next(numbers)}"
                predicate = read(name)
                facts = [lisp_list(lisp_list(predicate, *pairs[i // 100], i)) for i in range(100_000)]
                fact_groups.define_fact_group(read(f"group-{name}"), None, facts)
                asked = read(f"({name} {arguments})")
                begin = time.process_time()
                query.prolog(asked)
                spent += time.process_time() - begin
                fact_groups.remove_fact_group(read(f"group-{name}"))
            return spent

        return work

    return prepare


def resolved(session):
    """Work that makes a motion designator of the tutorial and resolves it."""
    from acting_bench import fresh

    from cramhy_runtime.languages.commonlisp.systems.systems import load_system

    load_system("cram-my-beginner-tutorial")
    _, drive = fresh("MOTION", "((:type :driving) (:speed 5) (:angle 2))")

    def work(count):
        for _ in range(count):
            drive()

    return work


LONG = f"({' '.join(map(str, range(10_000)))})"
ROWS = [
    Row("cut:pat-match of six pairs", lisp_function(PATTERN, "bench-matched"), 500, 1, cram="0.35"),
    Row("a fact by a compound argument, of 1,000", compound(1000), 200),
    Row("a fact by a compound argument, of 20,000", compound(20_000), 200, flat=("a fact by a compound argument, of 1,000", 1.25)),
    Row("first query after 100,000 facts", first_query("n700 ?m ?i"), 1, 100, "ms", slow=True),
    Row("the same, with a pair of bound arguments", first_query("n700 m3 ?i"), 1, 210, "ms", slow=True),
    Row("findall over own member of 100", collected("lists", LISTS, *GOALS["own member 100"]), 20, 83, others=peers.swi("own member 100")),
    Row("append of 10,000 to a list", first("lists", LISTS, f"(app {LONG} (1) ?c)"), 1, 7.7, "ms", others=peers.swi("append 10000")),
    Row("the zebra puzzle", first("zebra-puzzle", ZEBRA, GOALS["zebra"][0], define_lists), 1, 10.9, "ms", others=peers.swi("zebra")),
    Row("naive reverse of 30", first("lists", LISTS, GOALS["nrev 30"][0]), 3, others=peers.swi("nrev 30")),
    Row("three-way join of 200 facts", collected("edges", edges(), *GOALS["join"]), 1, unit="ms", others=peers.swi("join")),
    Row("a fact by its first argument", collected("edges", edges(), *GOALS["edges of"]), 100, others=peers.swi("edges of")),
    Row("a motion designator made and resolved", resolved, 50, cram="193"),
]
