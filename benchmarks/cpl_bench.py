"""Tasks, fluents, designators and process modules: how long they take, beside the figures of CRAM on SBCL and the goals.

Run: ``python benchmarks/cpl_bench.py``. Medians of five rounds, in microseconds. The figures in the columns CRAM and goal are those of
the table of peers; they were measured on another day, so each run also times a loop of plain Python calls and a hand-over of the
baton between two kernel tasks, which is the floor for everything here.
"""

from __future__ import annotations

import statistics
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "src"))

from cramhy_runtime import cpl, image, kernel  # noqa: E402
from cramhy_runtime import designators as desig  # noqa: E402
from cramhy_runtime import process_modules as pm  # noqa: E402
from cramhy_runtime.cpl import fluent_operators  # noqa: E402
from cramhy_runtime.lisp.data import lisp_list  # noqa: E402
from cramhy_runtime.lisp.packages import intern, keyword, sym  # noqa: E402
from cramhy_runtime.lisp.printer.printer import prin1_to_string  # noqa: E402
from cramhy_runtime.prolog.facts import define_fact_group  # noqa: E402

image.boot()


def microseconds(work, count):
    """The median time per unit of ``work(count)``."""
    rounds = []
    for _ in range(5):
        start = time.perf_counter()
        work(count)
        rounds.append((time.perf_counter() - start) / count)
    return statistics.median(rounds) * 1e6


def repeat(call):
    def work(count):
        for _ in range(count):
            call()

    return work


def in_plan(work):
    return lambda count: cpl.top_level(lambda: work(count))


def row(name, work, count, cram="-", goal="-"):
    print(f"{name:46} {microseconds(work, count):9.2f}   {cram:>10} {goal:>16}")


def hand_over(count):
    """Two kernel tasks that yield to each other: ``count`` hand-overs of the baton."""
    def yielding():
        for _ in range(count // 2):
            kernel.yield_()

    for task in [kernel.spawn(yielding) for _ in range(2)]:
        task.join()


def ping_pong(count):
    ping, pong = cpl.make_fluent(), cpl.make_fluent()

    def first():
        for _ in range(count):
            ping.set(True)
            cpl.wait_for(pong)
            pong.set(None)

    def second():
        for _ in range(count):
            cpl.wait_for(ping)
            ping.set(None)
            pong.set(True)

    cpl.top_level(lambda: cpl.par(first, second))


def virtual_sleeps(count):
    def sleeping():
        for _ in range(count // 10):
            cpl.sleep(1)

    cpl.top_level(lambda: cpl.par(*[sleeping] * 10))


def setting(nets):
    def work(count):
        fluent = cpl.make_fluent(value=-1)
        kept = [cpl.fl_funcall(lambda x: x, fluent) for _ in range(nets)]
        for value in range(count):
            fluent.set(value)
        return kept

    return work


def setting_unchanged(count):
    fluent = cpl.make_fluent(value=-1)
    kept = [fluent_operators.fl_lt(fluent, 10**9) for _ in range(10)]
    for value in range(count):
        fluent.set(value)
    return kept


def tasks_and_fluents():
    empty, winner = lambda: None, lambda: 1
    row("(top-level)", repeat(lambda: cpl.top_level(empty)), 2000, "96", "30 / 10")
    row("par of 2 trivial branches", in_plan(repeat(lambda: cpl.par(empty, empty))), 2000, "530", "100 / 25")
    for count, cram in ((10, "102"), (100, "81"), (1000, "102")):
        row(f"par of {count}, per branch", lambda n: cpl.top_level(lambda: cpl.par(*[empty] * n)), count, cram, "30 / 10")
    row("pursue, loser in (sleep 10)", in_plan(repeat(lambda: cpl.pursue(lambda: cpl.sleep(10), winner))), 1000, "3200", "150")
    never = cpl.make_fluent()
    row("pursue, loser in a wait that never ends", in_plan(repeat(lambda: cpl.pursue(lambda: cpl.wait_for(never), winner))),
        1000, "1700", "150")
    row("pursue, loser in a busy loop", in_plan(repeat(lambda: cpl.pursue(busy, winner))), 100, "never", "5000")
    row("fluent ping-pong, round trip", ping_pong, 2000, "374", "40 / 8")
    for nets, cram, goal in ((0, "0.63", "0.6"), (1, "1.5", "2"), (10, "8.5", "12"), (100, "54", "100")):
        row(f"(setf value), {nets} nets", setting(nets), 200_000 // (nets + 10), cram, goal)
    row("(setf value), 10 nets that do not change", setting_unchanged, 20_000, "1.7", "4")
    fluent = cpl.make_fluent(value=1)
    row("(value f)", repeat(lambda: cpl.value(fluent)), 100_000, "0.06", "0.1")
    row("virtual sleep of one among ten branches", virtual_sleeps, 5000, "-", "100 / 20")


def busy():
    while True:
        kernel.checkpoint()


def reasoning_and_acting():
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
    description = lisp_list(driving, lisp_list(keyword("SPEED"), 5))
    incomplete = lisp_list(driving)

    def fresh(pairs=description):
        return desig.make_designator(keyword("MOTION"), pairs)

    def refused():
        try:
            desig.reference(fresh(incomplete))
        except desig.DesignatorError:
            pass

    motion = fresh()
    desig.reference(motion)
    row("making a designator", repeat(fresh), 5000, "0.38", "5")
    row("printing a designator", repeat(lambda: prin1_to_string(motion)), 2000, "1.7", "10")
    row("reference of a fresh motion", repeat(lambda: desig.reference(fresh())), 2000, "193", "15")
    row("the same when it cannot be resolved", repeat(refused), 2000, "190", "20")
    row("cached reference", repeat(lambda: desig.reference(motion)), 20_000, "0.06", "0.2")

    def acting():
        row("matching process modules", repeat(lambda: pm.matching_process_module_names(motion)), 1000, "94", "10")
        row("pm-execute, round trip", repeat(lambda: pm.pm_execute(navigation, motion)), 500, "5900", "100 / 30")
        row("perform of a motion", repeat(lambda: pm.perform(motion)), 300, "7400", "150")

    pm.with_process_modules_running([navigation], lambda: cpl.top_level(acting))


def main():
    for backend in ("threads", "greenlet"):
        try:
            kernel.start(clock="virtual", backend=backend)
        except ImportError as missing:
            print(missing)
            continue
        print(f"\n{'back end ' + backend + ', microseconds':46} {'cramhy':>9}   {'CRAM':>10} {'goal (thr / grn)':>16}")
        row("reference: a call of a Python function", repeat(lambda: None), 100_000)
        row("reference: a hand-over between kernel tasks", hand_over, 4000)
        tasks_and_fluents()
        reasoning_and_acting()
        kernel.stop()


if __name__ == "__main__":
    main()
