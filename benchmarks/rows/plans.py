"""Rows of the plan language: failures, fluents, branches."""

from __future__ import annotations

import time

from . import BOTH, Row, lisp_function, peers

PLANS = """
(defun bench-retried (n)
  (top-level
    (dotimes (i n)
      (let ((tries 0))
        (with-failure-handling ((simple-plan-failure (f) (declare (ignore f)) (retry)))
          (when (cl:= (incf tries) 1) (fail "no")))))))
(defun bench-handled (n)
  (top-level
    (dotimes (i n) (with-failure-handling ((simple-plan-failure (f) (declare (ignore f)) (return))) (fail "no")))))
(defun bench-tried (n) (top-level (dotimes (i n) (try-in-order (fail "no") 1))))
(defun bench-assigned (fluent n) (dotimes (i n) (setf (value fluent) i)))
(defun bench-read (f n)
  (dotimes (i (floor n 10))
    (value f) (value f) (value f) (value f) (value f) (value f) (value f) (value f) (value f) (value f)))
(defun bench-plan-step () 1)
(def-cram-function bench-step () 1)
(defun bench-steps (n) (top-level (dotimes (i n) (bench-step))))
(defun bench-pars (n) (top-level (dotimes (i n) (par 1 2))))
(defun bench-losers (n) (top-level (dotimes (i n) (pursue (sleep 10) 1))))
(defun bench-cleanups (n) (top-level (dotimes (i n) (unwind-protect 1 2))))
(defun bench-sleeps (n) (top-level (par-loop (length '(1 1 1 1 1 1 1 1 1 1)) (dotimes (i (floor n 10)) (sleep length)))))
(defun bench-ping-pong (n)
  (let ((ping (make-fluent)) (pong (make-fluent)))
    (top-level
      (par (dotimes (i n) (setf (value ping) t) (wait-for pong) (setf (value pong) nil))
           (dotimes (i n) (wait-for ping) (setf (value ping) nil) (setf (value pong) t))))))
"""


def plans(name):
    return lisp_function(PLANS, name)


def observed(nets):
    """Work that sets a fluent which so many nets ``(+ f 1)`` observe."""

    def prepare(session):
        from cramhy_runtime import cpl
        from cramhy_runtime.cpl.fluents.operators import fl_plus

        assign = plans("bench-assigned")(session)
        fluent = cpl.make_fluent(value=-1)
        kept = [fl_plus(fluent, 1) for _ in range(nets)]
        return lambda count: assign(fluent, count) if kept else None

    return prepare


def reading(session):
    from cramhy_runtime import cpl

    read, fluent = plans("bench-read")(session), cpl.make_fluent(value=1)
    return lambda count: read(fluent, count)


def failures_and_parked(session):
    """2,000 failures that are handled, then 1,000 tasks that wait at once and are ended."""
    from cramhy_runtime import cpl

    handled = plans("bench-handled")(session)
    never = cpl.make_fluent()

    def parked():
        cpl.pursue(lambda: cpl.par(*[lambda: cpl.wait_for(never)] * 1000), lambda: cpl.sleep(1))

    def work(count):
        for _ in range(count):
            handled(2000)
            cpl.top_level(parked)

    return work


def reactive(session):
    """100 branches that each do a step whenever a fluent is pulsed; a tick is a pulse and all their steps."""
    from cramhy_runtime import cpl

    def work(count):
        pulse, done = cpl.make_fluent(), 0
        spent = 0.0

        def step():
            nonlocal done
            done += 1

        def ticks():
            nonlocal spent
            cpl.sleep(0.1)
            begin = time.process_time()
            for _ in range(count):
                cpl.pulse(pulse)
                cpl.sleep(0.01)
            spent = time.process_time() - begin

        def branch():
            cpl.whenever(cpl.pulsed(pulse), step)

        cpl.top_level(lambda: cpl.pursue(lambda: cpl.par(*[branch] * 100), ticks))
        assert done == 100 * count
        return spent

    return work


def asleep(branches):
    """``count`` branches, so many of them at once, that sleep for a second."""

    def prepare(session):
        from cramhy_runtime import cpl

        def body():
            cpl.par(*[lambda: cpl.sleep(1)] * branches)

        def work(count):
            for _ in range(count // branches):
                cpl.top_level(body)

        return work

    return prepare


ROWS = [
    Row("a failure handled and retried", plans("bench-retried"), 100, 12, cram="14", backends=BOTH),
    Row("try-in-order of two", plans("bench-tried"), 100, 10, cram="12", backends=BOTH),
    Row("a fluent with 10 nets set", observed(10), 300, 6, cram="8.7"),
    Row("a fluent with 100 nets set", observed(100), 40, 60, cram="82"),
    Row("a fluent with 1,000 nets set", observed(1000), 4, 600, cram="797"),
    Row("a fluent's value read", reading, 5000, 0.06, cram="0.06"),
    Row("2,000 failures; 1,000 tasks parked, then ended", failures_and_parked, 1, 25, "ms", others=peers.trio_failures, backends=BOTH),
    Row("100 reactive branches, a tick", reactive, 5, (2.5, 0.25), "ms", others=peers.py_trees_tick, backends=BOTH),
    Row("branches that sleep, 100 at once, each", asleep(100), 1000, backends=BOTH, others=peers.trio_sleepers),
    Row(
        "branches that sleep, 10,000 at once, each",
        asleep(10_000),
        10_000,
        backends=BOTH,
        flat=("branches that sleep, 100 at once, each", 1.4),
        slow=True,
    ),
    Row("par of two", plans("bench-pars"), 50, cram="530", backends=BOTH),
    Row("pursue with a loser asleep", plans("bench-losers"), 20, cram="3,200", backends=BOTH),
    Row("a call of a plan function", plans("bench-steps"), 100, backends=BOTH),
    Row("unwind-protect in a plan", plans("bench-cleanups"), 1000),
    Row("ping-pong by fluents", plans("bench-ping-pong"), 50, cram="374", backends=BOTH),
    Row("a sleep of one of ten tasks", plans("bench-sleeps"), 500, backends=BOTH, others=peers.simpy_sleeps),
]
