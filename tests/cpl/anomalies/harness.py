"""The anomaly loop: each plan, each task of it, each park point, each action, until the plan ends by itself.

`check_run` runs a plan with one fault and says what is wrong: a cleanup form that ran twice, too early or never, a task that lives, an
observer, timer or thread that is left, a result that nobody allows. `faults_of` goes through all faults of a plan.
"""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from fnmatch import fnmatchcase
from itertools import count

from cramhy_runtime.testing import faults, runs
from cramhy_runtime.testing.plans import plan_of, with_lisp

from . import acting_plans, guards

TIME_LIMIT = 100.0
_functions = {}


def forget():
    """Forget the compiled plans: the next one finds another image, without what these defined."""
    _functions.clear()


def function_of(plan):
    """The compiled plan."""
    if not _functions:
        with_lisp(guards.define)
        plan_of(guards.MACROS)
        plan_of(acting_plans.HELPERS)
    if plan.name not in _functions:
        with redirect_stderr(io.StringIO()):
            _functions[plan.name] = plan_of(plan.text)
    return _functions[plan.name]


def check_run(plan, *, fault=None, faults=(), **options):
    """(outcome, list of what is wrong) of one run. With several FAULTS every outcome is allowed but a deadlock."""
    function = function_of(plan)
    with redirect_stderr(io.StringIO()) as said, redirect_stdout(said):
        run = guards.begin()
        outcome = runs.observe(function, faults=[fault] if fault is not None else faults, time_limit=TIME_LIMIT, **options)
    wrong = run.finish() + outcome.left
    shown = str(outcome)
    if faults:
        right = "Deadlock*" in plan.evaporated or not shown.startswith(("Deadlock", "TimeLimit"))
    else:
        right = allowed(plan, shown, fault)
    return outcome, wrong if right else [*wrong, f"the outcome is {shown}"]


def allowed(plan, shown, fault):
    """Whether a plan may end so after FAULT."""
    if shown == plan.value or shown in plan.free:
        return True
    if fault is None or fault.happened is None:
        return False
    if fault.action == "suspend-and-resume":
        others = plan.suspended
    elif fault.action == "evaporate":
        others = (*plan.evaporated, *(("no values",) if fault.happened.task.endswith("TOP-LEVEL") else ()))
    else:
        others = (*plan.failed, "*Injected*")
    return any(fnmatchcase(shown, other) for other in others)


def faults_of(plan, backend, actions=faults.ACTIONS, entering=(False, True), every=1):
    """All runs of a plan with one fault: (fault, outcome, what is wrong). EVERY: take only every so manyeth point of a task."""
    outcome, wrong = check_run(plan, backend=backend)
    yield None, outcome, wrong
    labels = list(dict.fromkeys(point.task for point in outcome.points))
    for label in labels:
        for action in actions:
            for early in entering:
                for nth in count(1, every):
                    fault = faults.at(label, nth=nth, action=action, entering=early)
                    outcome, wrong = check_run(plan, fault=fault, backend=backend)
                    if fault.happened is None:
                        break
                    yield fault, outcome, wrong
