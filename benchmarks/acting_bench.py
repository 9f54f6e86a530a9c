"""Designators and process modules: how long they take, beside CRAM on SBCL and the goals.

    python benchmarks/acting_bench.py

Microseconds, best and median round (``measuring.py``). What stands under CRAM was recorded on another day. Prolog by itself is in
``prolog_bench.py``, tasks and fluents are in ``cpl_bench.py``.
"""

from __future__ import annotations

from measuring import Table, repeat

from cramhy_runtime import cpl, image, kernel
from cramhy_runtime import designators as desig
from cramhy_runtime import process_modules as pm
from cramhy_runtime.designators.protocol import reference
from cramhy_runtime.lisp.data import lisp_list
from cramhy_runtime.lisp.packages import intern, keyword, sym
from cramhy_runtime.lisp.printer.printer import prin1_to_string
from cramhy_runtime.prolog.facts import define_fact_group

image.boot()


def define_navigation():
    """A process module that does nothing, and the facts by which motions of type driving are resolved and go to it; its name."""
    navigation = intern("BENCH-NAVIGATION", "CRAM-USER")
    d, speed = intern("?D", "CRAM-USER"), intern("?SPEED", "CRAM-USER")
    prop, driving = sym("DESIG::DESIG-PROP"), lisp_list(keyword("TYPE"), keyword("DRIVING"))
    grounding, matching, available = map(sym, ("DESIG::MOTION-GROUNDING", "CPM::MATCHING-PROCESS-MODULE",
                                               "CPM::AVAILABLE-PROCESS-MODULE"))
    define_fact_group(intern("BENCH", "CRAM-USER"), lisp_list(grounding, matching, available), lisp_list(
        lisp_list(lisp_list(grounding, d, lisp_list(intern("DRIVE", "CRAM-USER"), speed)), lisp_list(prop, d, driving),
                  lisp_list(prop, d, lisp_list(keyword("SPEED"), speed))),
        lisp_list(lisp_list(matching, d, navigation), lisp_list(prop, d, driving)),
        lisp_list(lisp_list(available, navigation))))
    pm.define_process_module(navigation, lambda designator: None)
    return navigation


def reasoning_and_acting(table, navigation):
    driving = lisp_list(keyword("TYPE"), keyword("DRIVING"))
    description = lisp_list(driving, lisp_list(keyword("SPEED"), 5))
    incomplete = lisp_list(driving)

    def fresh(pairs=description):
        return desig.make_designator(keyword("MOTION"), pairs)

    def refused():
        try:
            reference(fresh(incomplete))
        except desig.DesignatorError:
            pass

    motion = fresh()
    reference(motion)
    table.row("making a designator", repeat(fresh), 200, goal=5, cram="0.38")
    table.row("printing a designator", repeat(lambda: prin1_to_string(motion)), 40, goal=10, cram="1.7")
    table.row("reference of a fresh motion", repeat(lambda: reference(fresh())), 40, goal=15, cram="193")
    table.row("the same when it cannot be resolved", repeat(refused), 40, goal=20, cram="190")
    table.row("cached reference", repeat(lambda: reference(motion)), 2000, goal=0.2, cram="0.06")

    def acting():
        table.row("matching process modules", repeat(lambda: pm.matching_process_module_names(motion)), 50, goal=10, cram="94")
        table.row("pm-execute, round trip", repeat(lambda: pm.pm_execute(navigation, motion)), 20, goal=(100, 30), cram="5900")
        table.row("perform of a motion", repeat(lambda: pm.perform(motion)), 10, goal=150, cram="7400")

    pm.with_process_modules_running([navigation], lambda: cpl.top_level(acting))
    table.end()


def main():
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
