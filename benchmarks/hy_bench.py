"""Plans in plain Hy beside the same plans in Common Lisp: the processor time of each, and the ratio of the two.

    python benchmarks/hy_bench.py [--backend greenlet]

A row is measured in pairs, Lisp and Hy in turn, so a machine that is slower for a while is slower for both. The ratio is the median of the
pairs. The goal is 1.1: what is written in Hy costs what it costs in Lisp. The plans in Hy stand in files, as a user's do.
"""

from __future__ import annotations

import argparse
import gc
import importlib
import statistics
import sys
import tempfile
import time
from pathlib import Path

from measuring import number

from cramhy_runtime.lisp_core.packages import intern
from cramhy_runtime.languages.hy.lisp_data import plan_package
from cramhy_runtime.repl.session import Session

GOAL, PAIRS = 1.1, 15
OURS = "(shadowing-import '(cpl:fail cpl:< cpl:> cpl:not cpl:eq cpl:eql cpl:+ cpl:- cpl:* cpl:/ cpl:= cpl:sleep))"

PLANS = {
    "value": (
        "(defun run (n) (let ((f (make-fluent :value 1))) (dotimes (i n) (value f))))",
        "(defn run [n] (let [f (make-fluent :value 1)] (for [i (range n)] (value f))))",
        20_000,
    ),
    "value of a net": (
        "(defun run (n) (let ((f (make-fluent :value 1))) (dotimes (i n) (value (< f 3)))))",
        "(defn run [n] (let [f (make-fluent :value 1)] (for [i (range n)] (value (< f 3)))))",
        2_000,
    ),
    "designator": (
        "(defun run (n) (dotimes (?s n) (desig-prop-value (a motion (type driving) (speed ?s)) :speed)))",
        "(defn run [n] (for [?s (range n)] (desig-prop-value (a motion (type driving) (speed ?s)) :speed)))",
        2_000,
    ),
    "with-failure-handling, no failure": (
        """(defun run (n)
             (top-level (dotimes (i n) (with-failure-handling ((simple-plan-failure (e) (declare (ignore e)) (return 1))) i))))""",
        "(defn run [n] (top-level (for [i (range n)] (with-failure-handling [[simple-plan-failure [e] (leave 1)]] i))))",
        2_000,
    ),
    "with-failure-handling, a failure": (
        """(defun run (n)
             (top-level
               (dotimes (i n) (with-failure-handling ((simple-plan-failure (e) (declare (ignore e)) (return 1))) (fail "no")))))""",
        """(defn run [n] (top-level (for [i (range n)] (with-failure-handling [[simple-plan-failure [e] (leave 1)]] (fail "no")))))""",
        500,
    ),
    "a class of failures of one's own": (
        """(define-condition stuck (simple-plan-failure) ())
           (defun run (n) (top-level (dotimes (i n) (with-failure-handling ((stuck (e) (declare (ignore e)) (return 1))) i))))""",
        """(import cramhy_runtime.cpl [SimplePlanFailure])
           (defclass Stuck [SimplePlanFailure])
           (defn run [n] (top-level (for [i (range n)] (with-failure-handling [[Stuck [e] (leave 1)]] i))))""",
        2_000,
    ),
    "par": ("(defun run (n) (top-level (dotimes (i n) (par 1 2))))", "(defn run [n] (top-level (for [i (range n)] (par 1 2))))", 300),
    "def-cram-function": (
        "(def-cram-function go-on (x) x) (defun run (n) (top-level (dotimes (i n) (go-on i))))",
        "(def-cram-function go-on [x] x) (defn run [n] (top-level (for [i (range n)] (go-on i))))",
        300,
    ),
    "with-tags": (
        "(defun run (n) (top-level (dotimes (i n) (with-tags (:tag here i)))))",
        "(defn run [n] (top-level (for [i (range n)] (with-tags (:tag here i)))))",
        300,
    ),
    "pm-execute": (
        """(def-process-module base (d) (desig-prop-value d :speed))
           (defun run (n) (top-level (with-process-modules-running (base) (dotimes (?s n) (pm-execute 'base (a motion (speed ?s)))))))""",
        """(def-process-module base [d] (desig-prop-value d :speed))
           (defn run [n]
             (top-level (with-process-modules-running [base] (for [?s (range n)] (pm-execute 'base (a motion (speed ?s)))))))""",
        300,
    ),
}


def measured(work, count):
    """The processor time of ``work(count)`` in microseconds per unit."""
    gc.collect()
    start = time.process_time()
    work(count)
    return (time.process_time() - start) / count * 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--backend", default="threads")
    session = Session(time="virtual", turtlesim=False, backend=parser.parse_args().backend, time_limit=10**9)
    print(f"{'plan':40} {'Lisp':>9} {'Hy':>9} {'ratio':>7}")
    with tempfile.TemporaryDirectory() as folder:
        sys.path.insert(0, folder)
        for number_of_plan, (name, (lisp, hy, count)) in enumerate(PLANS.items()):
            session.package = plan_package(f"PLAN-{number_of_plan}").name
            session.evaluate_text(OURS + lisp)
            module = f"plan_{number_of_plan}_in_hy"
            Path(folder, f"{module}.hy").write_text(f"(require cramhy *)\n{hy}\n")
            in_lisp, in_hy = intern("RUN", session.package.name).function, importlib.import_module(module).run
            pairs = [(measured(in_lisp, count), measured(in_hy, count)) for _ in range(PAIRS)]
            ratio = statistics.median(hy_time / lisp_time for lisp_time, hy_time in pairs)
            best = [number(min(times)) for times in zip(*pairs)]
            print(f"{name:40} {best[0]:>9} {best[1]:>9} {ratio:>7.2f}{'  MISSED' if ratio > GOAL else ''}", flush=True)


if __name__ == "__main__":
    main()
