"""Designators and process modules: how long they take, beside CRAM on SBCL and the goals.

    python benchmarks/acting_bench.py

Microseconds, best and median round (``measuring.py``). What stands under CRAM was recorded on another day. Prolog by itself is in
``prolog_bench.py``, tasks and fluents are in ``cpl_bench.py``. Designators are resolved by the rules of the tutorial package: eight
clauses ground its motions, five its actions. The location has one generator with one candidate, which CRAM's own validators judge.
"""

from __future__ import annotations

from contextlib import contextmanager

from measuring import Table, repeat

from cramhy_runtime import cpl, kernel
from cramhy_runtime.session import boot
from cramhy_runtime import designators as desig
from cramhy_runtime import process_modules as pm
from cramhy_runtime.designators.locations import generators, register_location_generator, validators
from cramhy_runtime.designators.protocol import reference
from cramhy_runtime.lisp_core.data import lisp_list, one
from cramhy_runtime.lisp_core.packages import intern, keyword, sym
from cramhy_runtime.languages.commonlisp.reader.reader_functions import read_from_string
from cramhy_runtime.languages.commonlisp.systems.systems import load_system
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.prolog.engine.fact_groups import define_fact_group

boot()


def define_navigation():
    """A process module that does nothing, and the facts by which motions of type driving are resolved and go to it; its name."""
    navigation = intern("BENCH-NAVIGATION", "CRAM-USER")
    d, speed = intern("?D", "CRAM-USER"), intern("?SPEED", "CRAM-USER")
    prop, driving = sym("DESIG::DESIG-PROP"), lisp_list(keyword("TYPE"), keyword("BENCH-DRIVING"))
    grounding, matching, available = map(sym, ("DESIG::MOTION-GROUNDING", "CPM::MATCHING-PROCESS-MODULE", "CPM::AVAILABLE-PROCESS-MODULE"))
    define_fact_group(
        intern("BENCH", "CRAM-USER"),
        lisp_list(grounding, matching, available),
        lisp_list(
            lisp_list(
                lisp_list(grounding, d, lisp_list(intern("DRIVE", "CRAM-USER"), speed)),
                lisp_list(prop, d, driving),
                lisp_list(prop, d, lisp_list(keyword("SPEED"), speed)),
            ),
            lisp_list(lisp_list(matching, d, navigation), lisp_list(prop, d, driving)),
            lisp_list(lisp_list(available, navigation)),
        ),
    )
    pm.define_process_module(navigation, lambda designator: None)
    return navigation


def description(text):
    """The description that is written in ``text``."""
    return one(read_from_string(text))


def fresh(kind, text):
    """A function that makes a designator with the description in ``text``, and one that resolves such a new one."""
    type_, pairs = keyword(kind), description(text)

    def make():
        return desig.make_designator(type_, pairs)

    return make, lambda: reference(make())


def designators(table):
    """The rows of designators."""
    driving, drive = fresh("MOTION", "((:type :driving) (:speed 5) (:angle 2))")
    _, move = fresh("MOTION", "((:type :moving) (:goal (9 1 0)))")
    _, set_pen = fresh("MOTION", "((:type :setting-pen) (:r 1) (:g 2) (:b 3) (:width 4) (:off 1))")
    _, fly = fresh("MOTION", "((:type :driving))")
    _, draw = fresh("ACTION", "((:type :drawing) (:shape :house))")
    _, find = fresh("LOCATION", "((:name :here))")

    def refused():
        try:
            fly()
        except desig.DesignatorError:
            pass

    motion = driving()
    reference(motion)

    def cached(count):
        for _ in range(count):
            reference(motion)

    candidate = intern("BENCH-CANDIDATE", "CRAM-USER")
    candidate.function = lambda designator: lisp_list(candidate)
    table.row("making a designator", repeat(driving), 200, goal=5, cram="0.38")
    table.row("printing a designator", repeat(lambda: prin1_to_string(motion)), 40, goal=10, cram="1.7")
    table.row("reference of a fresh motion: driving", repeat(drive), 40, goal=15, cram="193")
    table.row("moving", repeat(move), 40, goal=15, cram="169")
    table.row("setting-pen, five properties", repeat(set_pen), 40, goal=30, cram="750")
    table.row("one that cannot be resolved, with its error", repeat(refused), 40, goal=20, cram="190")
    table.row("reference of a fresh action", repeat(draw), 40, goal=12, cram="139")
    with without_the_generators_of_the_tutorial():
        register_location_generator(1, candidate)
        table.row("reference of a fresh location", repeat(find), 40, goal=20, cram="6.4")
    table.row("cached reference", cached, 2000, goal=0.2, cram="0.06")


@contextmanager
def without_the_generators_of_the_tutorial():
    """Generators and validators as they are in CRAM itself."""
    kept = generators.entries, validators.entries
    for registry in (generators, validators):
        registry.entries = [entry for entry in registry.entries if entry[1].package.name == "CRAM-DESIGNATORS"]
    try:
        yield
    finally:
        generators.entries, validators.entries = kept


def reasoning_and_acting(table, navigation):
    designators(table)
    motion = desig.make_designator(keyword("MOTION"), description("((:type :bench-driving) (:speed 5))"))

    def acting():
        table.row("matching process modules", repeat(lambda: pm.matching_process_module_names(motion)), 50, goal=10, cram="94")
        table.row("pm-execute, round trip", repeat(lambda: pm.pm_execute(navigation, motion)), 20, goal=(100, 30), cram="5900")
        table.row("perform of a motion", repeat(lambda: pm.perform(motion)), 10, goal=150, cram="7400")

    pm.with_process_modules_running([navigation], lambda: cpl.top_level(acting))
    table.end()


def main():
    kernel.start(clock="virtual")
    load_system("cram-my-beginner-tutorial")
    kernel.stop()
    navigation = define_navigation()
    for backend in ("threads", "greenlet"):
        try:
            kernel.start(clock="virtual", backend=backend)
        except ImportError as missing:
            print(missing)
            continue
        reasoning_and_acting(Table("Reasoning and acting", backend), navigation)
        kernel.stop()


if __name__ == "__main__":
    main()
