"""Blocks within branches within blocks, drawn at random: nothing outlives its block, and cleanup that began for an end comes to its end."""

from __future__ import annotations

import random

import pytest

from cramhy_runtime import cpl, kernel


class Bad(cpl.PlanFailure):
    """A failure that was drawn."""


class Program:
    """A plan drawn from ``seed``, what happened in it, and what must not."""

    def __init__(self, seed):
        self.lots = random.Random(seed)
        self.events = []
        self.begun = self.completed = 0

    def body(self, depth):
        """A function that does something, drawn beforehand, so that the schedule has no part in it."""
        lots = self.lots
        kinds = ["sleep", "sleep", "fail", "error"] + [
            "par",
            "pursue",
            "try_all",
            "timeout",
            "move on",
            "functions",
            "task",
            "attempts",
            "undisturbed",
        ] * (3 if depth else 0)
        kind, seconds, cleanup = lots.choice(kinds), lots.randint(0, 6) / 2, lots.randint(0, 3) / 4
        parts = [self.body(depth - 1) for _ in range(lots.randint(1, 3))] if depth else []
        own = self.body(depth - 1) if depth and lots.random() < 0.5 else None

        def run():
            try:
                self.run(kind, seconds, parts, own)
            except kernel.Cancelled:
                self.begun += 1
                cpl.sleep(cleanup)
                self.completed += 1
                raise
            finally:
                self.begun += 1
                with cpl.cleanup():
                    cpl.sleep(cleanup)
                    self.completed += 1
                self.events.append((kind, cpl.now()))

        return run

    def run(self, kind, seconds, parts, own):
        if kind == "sleep":
            cpl.sleep(seconds)
        elif kind in ("fail", "error"):
            cpl.sleep(seconds)
            raise Bad(str(seconds)) if kind == "fail" else LookupError(str(seconds))
        elif kind in ("par", "pursue", "try_all"):
            try:
                with getattr(cpl, kind)() as block:
                    for part in parts:
                        block.start(part)
                    if own is not None:
                        own()
            finally:
                assert all(task.dead for task in block.tasks)
        elif kind == "timeout":
            with cpl.timeout(seconds):
                parts[0]()
        elif kind == "move on":
            with cpl.move_on_after(seconds):
                parts[0]()
        elif kind == "functions":
            cpl.par(*parts[:2])
        elif kind == "task":
            cpl.with_task(parts[0])
        elif kind == "attempts":
            for attempt in cpl.attempts(2, on=(Bad, LookupError)):
                with attempt:
                    parts[0]()
        elif kind == "undisturbed":
            with cpl.without_scheduling():
                cpl.sleep(seconds)
            parts[0]()


def outcome(number, backend, order):
    program = Program(number)
    main = program.body(4)
    with kernel.aside():
        own = kernel.start(backend=backend, seed=order, time_limit=10_000)
        try:
            with cpl.plan() as root:
                main()
            ending = "done"
        except (cpl.PlanFailure, LookupError) as problem:
            ending = f"{type(problem).__name__} {problem}"
        kernel.yield_()
        me = kernel.current()
        assert own.tasks == [me] and root.dead and not root.children
        assert not me.cancelled_delivered and not getattr(me.local, "blocks", ()) and me.owner is None and me.shielded == 0
    assert program.begun == program.completed
    return ending, program.events


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("first", range(0, 120, 20))
def test_programs_of_blocks_keep_the_laws_on_both_back_ends_in_every_order(first):
    for number in range(first, first + 20):
        assert outcome(number, "threads", None) == outcome(number, "greenlet", None)
        outcome(number, "greenlet", number)
        outcome(number, "greenlet", number + 1)
