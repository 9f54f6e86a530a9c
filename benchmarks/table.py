"""One table of what counts: plans, Prolog, compiled Lisp, the turtle, and whole processes, beside their goals and beside others.

    python benchmarks/table.py [--only PART] [--quick]

Figures are processor time, medians of many rounds; "spread" is the distance between the quarters of the rounds, as a part of the
median. Rows that differ by back end stand there twice, with (t) for threads and (g) for greenlets. A row that misses its goal is marked.
Rows in "times" tell how often the time of Python written by hand a Lisp program needs; both run in turn.
The goals are for a machine on which a call of an empty Python function takes 0.05 us. Where it takes longer, they are scaled.
CRAM's figures were recorded (SBCL 2.2.9); those of trio, SimPy, py_trees and SWI-Prolog are measured in this run where they are installed.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time

from measuring import number
from rows import SCALES, peers, processes, rows, tabs
from workers import LEAST, MOST, SECONDS, Failed, Worker, spread


def measured(worker, row, seconds=SECONDS):
    """The figures of the rounds, in the row's unit."""
    worker.measure(row.name)
    figures, end = [], time.perf_counter() + seconds
    least = 3 if row.slow else LEAST
    while len(figures) < least or (time.perf_counter() < end and len(figures) < MOST):
        figure = worker.measure(row.name)
        figures.append(figure[0] / figure[1] if row.unit == "times" else figure * SCALES[row.unit])
    return figures


class Table:
    """Prints the rows and remembers which missed their goals."""

    def __init__(self):
        self.missed, self.medians = [], {}
        self.scale = max(1.0, peers.empty_call() / 0.05)
        print(f"A call of an empty Python function takes {self.scale * 0.05:.3f} us or less here: goals are times {self.scale:.2f}.\n")
        print(f"{'row':52} {'unit':>5} {'median':>9} {'spread':>7} {'goal':>8} {'CRAM':>7}   others")

    def line(self, row, mark, figures):
        median = statistics.median(figures)
        self.medians[row.name, mark] = median
        goal = row.goal[mark == " (g)"] if isinstance(row.goal, tuple) else row.goal
        if goal is not None and row.unit in SCALES:
            goal *= self.scale
        if row.flat:
            goal = self.medians.get((row.flat[0], mark), math.nan) * row.flat[1]
        others = row.others() if row.others and mark != " (t)" else ""
        self.print(row.name + mark, row.unit, median, spread(figures), goal, row.cram, others)

    def print(self, name, unit, median, part, goal, cram="-", others=""):
        remark = ""
        if goal is not None and median > goal:
            self.missed.append(name)
            remark = "MISSED  "
        print(f"{name:52} {unit:>5} {number(median):>9} {part:>6.0%} {number(goal):>8} {cram:>7}   {remark}{others}".rstrip(), flush=True)

    def end(self):
        print(f"\nGoals missed: {', '.join(self.missed)}." if self.missed else "\nAll goals reached.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="part of the names of the rows to measure")
    parser.add_argument("--quick", action="store_true", help="a few rounds each, and no whole processes")
    options = parser.parse_args()
    wanted = [row for row in rows() if options.only in row.name]
    workers, table, quotients = {}, Table(), []
    for row in wanted:
        for backend in row.backends:
            try:
                if backend not in workers:
                    workers[backend] = Worker(backend)
                figures = measured(workers[backend], row, 0.2 if options.quick else SECONDS)
            except Failed as why:
                print(f"{row.name:52} failed: {why}")
                table.missed.append(row.name)
                continue
            table.line(row, f" ({backend[0]})" if len(row.backends) > 1 else "", figures)
            if row.unit == "times":
                quotients.append(statistics.median(figures))
    if len(quotients) > 10:
        mean = statistics.geometric_mean(quotients)
        table.print(f"compiled Lisp: geometric mean of {len(quotients)} programs", "times", mean, 0.0, 2.5)
    for worker in workers.values():
        worker.close()
    if not options.quick:
        for row, figures in (*processes.measured(options.only), *tabs.measured(options.only)):
            if isinstance(figures, str):
                print(f"{row.name:52} not measured: {figures}")
            else:
                table.line(row, "", figures)
    table.end()


if __name__ == "__main__":
    main()
