"""How the benchmarks of plans measure, and how their tables look.

The machines that these run on are seldom quiet. So each row is measured again and again for most of a second, in rounds of about a
millisecond, which other programs seldom cut in two, and two figures are printed: the best round, which is what the code needs,
and the median, which is what the machine gave it meanwhile. A goal counts as reached when the best round reaches it; where only
the median misses it, the row says so.
"""

from __future__ import annotations

import statistics
import time

SECONDS = 0.8  # that a row is measured, at most
ROUNDS = 5, 1000  # at least and at most


def rounds(work, count, clock=time.perf_counter):
    """The times, in microseconds per unit, that ``work(count)`` took in each round. The first round only warms up.

    With ``clock=time.process_time`` the processor's: for work of one thread whose rounds are so long that others cut them in pieces.
    """
    work(count)
    times, end = [], time.perf_counter() + SECONDS
    while len(times) < ROUNDS[0] or (time.perf_counter() < end and len(times) < ROUNDS[1]):
        start = clock()
        work(count)
        times.append((clock() - start) / count * 1e6)
    return times


def microseconds(work, count):
    """The time of a unit in the best round."""
    return min(rounds(work, count))


def repeat(call):
    """The work that calls ``call`` so many times."""

    def work(count):
        for _ in range(count):
            call()

    return work


def number(figure):
    """``figure`` with three digits that count."""
    if figure is None:
        return "-"
    return f"{figure:,.0f}" if figure >= 100 else f"{figure:.1f}" if figure >= 10 else f"{figure:.2f}"


class Table:
    """Prints a line per row: our figures, the goal, the ratio of the best to the goal, and what others need.

    ``backend`` is the one that runs; a goal may be a pair, for threads and for greenlets. ``last``: whom the last column is about.
    """

    def __init__(self, title, backend, last="Python"):
        self.backend = backend
        self.missed = []
        print(f"\n{title + ', back end ' + backend:48} {'best':>9} {'median':>9} {'goal':>9} {'ratio':>6} {'CRAM':>12}   {last}")

    def row(self, name, work, count, goal=None, cram="-", python=""):
        """Measure ``work(count)``, in microseconds per unit, and print its line."""
        times = rounds(work, count)
        self.line(name, min(times), statistics.median(times), goal, cram, python)

    def line(self, name, best, median, goal=None, cram="-", python="", more_is_better=False):
        """Print the line of figures that were measured elsewhere."""
        if isinstance(goal, tuple):
            goal = goal[self.backend == "greenlet"]
        ratio, remark = "", ""
        if goal is not None:

            def quotient(figure):
                return goal / figure if more_is_better else figure / goal

            ratio = f"{quotient(best):.2f}"
            if quotient(best) > 1:
                remark = "  MISSED"
                self.missed.append(name)
            elif quotient(median) > 1:
                remark = "  missed in the median"
        print(f"{name:48} {number(best):>9} {number(median):>9} {number(goal):>9} {ratio:>6} {cram:>12}   {python}{remark}", flush=True)

    def end(self):
        print(f"Goals missed: {', '.join(self.missed)}." if self.missed else "All goals reached.")
