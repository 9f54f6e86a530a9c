"""This checkout beside another commit of it, in lock step: ``python benchmarks/compare.py COMMIT [--only PART] [--short] [--fail RATIO]``

Both run the rows of this checkout's benchmarks, each in workers of its own, one round in turn. So whatever else the machine does meets
both. The table has the medians of the processor time, how often the other's time this checkout needs (the median of the rounds' ratios)
and the spread of these ratios. A row is marked when it is slower by more than 5 %.

Exit status: 1 if a row is slower by more than ``--fail``, after it was measured a second time with three times the rounds. 0 otherwise.
COMMIT may be ``release``: the last tag ``v*``, or, where there is none yet, the commit before this one.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager

from measuring import number
from rows import SCALES, rows
from workers import HERE, SECONDS, Failed, Worker, spread

ROOT = HERE.parent
SHORT = (
    "a failure handled and retried", "a fluent with 10 nets set", "par of two", "pursue with a loser asleep", "ping-pong by fluents",
    "a call of a plan function", "cut:pat-match of six pairs", "findall over own member of 100", "naive reverse of 30",
    "a motion designator made and resolved", "fib", "double-float arithmetic in a loop", "format in a loop", "push and nreverse",
    "a hash table filled and read", "a call of a generic function", "make-instance", "calls with &key", "handler-case",
    "400 lines of plans read and compiled", "a tick of the turtle",
)  # fmt: skip


def git(*words):
    return subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True, check=True).stdout.strip()


def commit(name):
    """The commit that ``name`` is, as git or the word ``release`` names it."""
    if name == "release":
        tags = git("tag", "--list", "v*", "--sort=-v:refname", "--merged", "HEAD").split()
        name = tags[0] if tags else "HEAD~1"
    return git("rev-parse", "--verify", f"{name}^{{commit}}")


@contextmanager
def checkout(name):
    """The folder of a checkout of the commit ``name``, for as long as it is needed."""
    with tempfile.TemporaryDirectory() as folder:
        git("worktree", "add", "--detach", "--force", f"{folder}/there", commit(name))
        try:
            yield f"{folder}/there"
        finally:
            git("worktree", "remove", "--force", f"{folder}/there")


def pairs(here, there, row, seconds):
    """The figures (ours, theirs) of each round. Who begins changes from round to round."""
    for worker in (here, there):
        worker.measure(row.name)
    figures, end = [], time.perf_counter() + seconds
    while len(figures) < 5 or (time.perf_counter() < end and len(figures) < 400):
        if len(figures) % 2:
            ours, theirs = here.measure(row.name), there.measure(row.name)
        else:
            theirs, ours = there.measure(row.name), here.measure(row.name)
        figures.append(tuple(figure[0] if row.unit == "times" else figure for figure in (ours, theirs)))
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("commit", help="what git calls it, or release")
    parser.add_argument("--only", default="", help="part of the names of the rows to measure")
    parser.add_argument("--short", action="store_true", help="a row or two of each kind")
    parser.add_argument("--seconds", type=float, default=2 * SECONDS, help="that a row is measured, at least five rounds [%(default)s]")
    parser.add_argument("--fail", type=float, help="exit with 1 when a row needs this many times the other's time")
    options = parser.parse_args()
    wanted = [row for row in rows() if options.only in row.name and (not options.short or row.name in SHORT)]
    slower = []
    with checkout(options.commit) as folder:
        teams = {}

        def line(row, backend, seconds):
            """Measure, print, and return the ratio."""
            if backend not in teams:
                teams[backend] = Worker(backend), Worker(backend, folder)
            figures = pairs(*teams[backend], row, seconds)
            scale = SCALES.get(row.unit, 1e3)
            ours, theirs = (statistics.median(column) * scale for column in zip(*figures, strict=True))
            ratios = [one / other for one, other in figures]
            ratio = statistics.median(ratios)
            unit = row.unit if row.unit in SCALES else "ms"
            remark = "  slower" if ratio > 1.05 else ""
            print(
                f"{row.name + ' (' + backend[0] + ')':56} {unit:>3} {number(ours):>9} {number(theirs):>9} {ratio:>7.2f} "
                f"{spread(ratios):>6.0%}{remark}",
                flush=True,
            )
            return ratio

        print(f"{'row':56} {'':>3} {'here':>9} {'there':>9} {'ratio':>7} spread")
        for row in wanted:
            for backend in row.backends:
                try:
                    ratio = line(row, backend, options.seconds)
                    if options.fail and ratio > options.fail:
                        ratio = line(row, backend, 3 * options.seconds)
                except Failed as why:
                    print(f"{row.name + ' (' + backend[0] + ')':56} not in both: {why}")
                    for worker in teams.pop(backend, ()):  # perhaps one of them ended
                        worker.close()
                    continue
                if options.fail and ratio > options.fail:
                    slower.append(row.name)
        for team in teams.values():
            for worker in team:
                worker.close()
    if slower:
        sys.exit(f"slower by more than {options.fail - 1:.0%}: {', '.join(slower)}")


if __name__ == "__main__":
    main()
