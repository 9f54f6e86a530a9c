"""What a process of a submission is told to do for a check and a seed: plain data, and nothing that says what is right."""

from __future__ import annotations

import random
import secrets

from .exercise import Check, Exercise
from .expressions import computed, drawn, filled
from cramhy_runtime.kernel.typing_names import Any

AFTER = 1.1
"""Seconds of the plan's clock after a plan: a turtle that is not stopped goes on for one second."""
WALL = 60.0
"""Seconds of the wall clock that a run gets beside its processor time: a busy machine must not cost points."""
ANYWHERE = ((3.0, 8.0), (3.0, 8.0), (-3.0, 3.0))


def job(exercise: Exercise, check: Check, seed: int, submitted: dict[str, str]) -> tuple[dict[str, Any], dict[str, Any]]:
    """The job, and the values of the seed. submitted: the texts of the files that were handed in, by name."""
    table = check.table
    values = drawn(table.get("vary", {}), seed)
    start = table.get("start", [5.544444561, 5.544444561, 0])
    if start == "anywhere":
        begin = [
            round(low + random.Random(f"start {index} {seed}").random() * (high - low), 3) for index, (low, high) in enumerate(ANYWHERE)
        ]
    else:
        begin = [float(computed(part, values)) for part in start]
    made = {
        "nonce": secrets.token_hex(16),
        "canary": "c" + secrets.token_hex(8),
        "seed": seed,
        "systems": exercise.systems,
        "package": exercise.package,
        "files": submitted,
        "load": [name for name in exercise.submission if name.endswith((".lisp", ".hy", ".py"))],
        "prelude": exercise.prelude,
        "before": [filled(form, values) for form in table.get("before", exercise.before)],
        "do": filled(table["do"], values) if "do" in table else None,
        "after": table.get("after", AFTER),
        "asks": [filled(form, values) for form, _ in table.get("ask", ())],
        "tests": {"name": table["tests"], "text": exercise.files[table["tests"]], "only": table.get("only")} if "tests" in table else None,
        "start": begin,
        "troubles": [numbers(trouble, values) for trouble in table.get("troubles", ())],
        "faults": [numbers(fault, values, keep=("task", "park", "action")) for fault in table.get("faults", ())],
        "seconds": max(int(exercise.limits["time"] + 0.999), 1),
        "megabytes": int(exercise.limits["memory"]),
        "turtle_time": float(exercise.limits["turtle_time"]),
        "output": int(exercise.limits["output"] * 1000),
        "wall": WALL + 4 * exercise.limits["time"],
        "hidden": [str(exercise.folder.resolve())] if exercise.folder.parts else [],
    }
    return made, values


def numbers(table, values, keep=("kind", "turtle")):
    """A table of the exercise with its formulas computed."""
    return {name: value if name in keep or isinstance(value, bool) else computed(value, values) for name, value in table.items()}
