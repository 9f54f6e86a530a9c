"""A submission runs: it is loaded, the plan is called, questions are answered, and all that is told as it comes.

This happens in the process of the submission, which is in a sandbox, or in an image of this process where the system has no processes (a
browser). Nothing here knows what is right: answers and commands are reported, and ``judging.py`` compares them elsewhere. Only the verdicts
of tests of lisp-unit, FiveAM and pytest come from here, since such tests call the submission's functions.

A job is a dictionary of plain data, made by ``jobs.py``. ``tell(kind, **facts)`` sends one report.
"""

from __future__ import annotations

import sys
from pathlib import Path

from . import tests_inside
from .recording import Recording

MOST_TEXT = 2000
"""So many characters of a value or an error are reported."""
SETTLING = 0.1
"""Seconds of the plan's clock after the beginning, in which the turtle tells its first pose."""


class _Ended(Exception):
    """A step failed, and the failure has been told; what comes after it makes no sense."""


def lay_out(job, folder):
    """Write the files of a job into ``folder``."""
    for name, text in job["files"].items():
        place = Path(folder, name)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8", newline="")


def perform(job, folder, tell):
    """Do what ``job`` says. folder: where its files are, as text. tell: see above. The last report is "done", unless something was lost."""
    from cramhy_runtime.session.session import Session
    from cramhy_runtime.testing.watched import WatchedKernel

    made = Session(
        time="virtual", seed=None if job["seed"] == 1 else job["seed"], time_limit=job["turtle_time"], kind=WatchedKernel, cleanup_limit=2.0
    )
    recording = Recording(tuple(job["start"]), job["troubles"], job["seed"])
    recording.watch()
    carry_out(job, Path(folder), tell, made, recording)


def carry_out(job, folder, tell, made, recording):
    """As `perform`, in the session ``made``, of which ``load``, ``evaluate_text`` and ``package`` are used. folder: a path."""
    try:
        _steps(job, folder, tell, made, recording)
    except _Ended:
        pass
    if recording.simulator is not None:
        begin = recording.troubles.begin
        tell("run", heard=recording.heard, ticks=recording.ticks, begin=recording.ticks if begin is None else begin)
    tell("done")


def _steps(job, folder, tell, made, recording):
    from cramhy_runtime import kernel

    for system in job["systems"]:
        made.load(system)
    if job["package"]:
        made.package = job["package"].upper()
    for form in job["prelude"]:
        made.evaluate_text(form)
    guard = tests_inside.Guard() if job["tests"] else None
    for name in job["load"]:
        tell("stage", doing="load", what=name)
        if name.endswith(".py"):
            if str(folder) not in sys.path:
                sys.path.insert(0, str(folder))
            if not job["tests"]:
                _attempt(tell, lambda name=name: __import__(Path(name).stem))
        else:
            _attempt(tell, lambda name=name: made.load(str(folder / name)))
    for form in job["before"]:
        tell("stage", doing="before", what=form)
        _attempt(tell, lambda form=form: made.evaluate_text(form))
    if job["do"] is not None:
        tell("stage", doing="do", what=job["do"])
        kernel.sleep(SETTLING)
        faults = _plan_faults(job["faults"])
        recording.begin()
        begun = kernel.now()
        if faults:  # of which an ordinary kernel knows nothing
            kernel.active().faults.extend(faults)
        try:
            values = _attempt(tell, lambda: made.evaluate_text(job["do"]), go_on=True)
        finally:
            if faults:
                kernel.active().faults.clear()
        took = kernel.now() - begun
        kernel.sleep(job["after"])
        if values is not None:
            tell("value", values=[printed(value) for value in values], seconds=round(took, 4))
        tell("faults", happened=[fault.happened is not None for fault in faults])
    for form in job["asks"]:
        tell("stage", doing="ask", what=form)
        values = _attempt(tell, lambda form=form: made.evaluate_text(form), go_on=True)
        if values is not None:
            tell("answer", values=[printed(value) for value in values])
    if job["tests"]:
        tell("stage", doing="tests", what=job["tests"]["name"])
        try:
            results = tests_inside.run(job["tests"], folder, job["canary"], guard)
        except tests_inside.Tampered as problem:
            tell("tampered", text=str(problem))
        except SystemExit:
            tell("error", types=["SYSTEM-EXIT"], text="The program ended the session with (quit) or (exit).")
        except Exception as problem:
            tell("error", **_described(problem))
        else:
            tell("tests", results=results)


def _attempt(tell, work, go_on=False):
    """The values of ``work()``. An error is told, and ends the run unless ``go_on``, which then gives ``None``."""
    from cramhy_runtime.ground.conditions import Condition

    try:
        return work()
    except SystemExit:
        tell("error", types=["SYSTEM-EXIT"], text="The program ended the session with (quit) or (exit).")
    except (Exception, Condition) as problem:
        tell("error", **_described(problem))
        if go_on:
            return None
    raise _Ended


def _described(problem):
    """The names of the types of an error, the most special first, and its text as a student gets it."""
    from cramhy_runtime.ground.classes import class_name
    from cramhy_runtime.kernel import TimeLimit
    from cramhy_runtime.languages.commonlisp.tools.advice import explanation
    from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of

    if isinstance(problem, TimeLimit):
        return {"types": ["TIME-LIMIT"], "text": ""}
    condition = condition_of(problem)
    names = []
    kinds = type(condition).__mro__
    for kind in kinds:
        try:
            name = str(getattr(class_name(kind), "name", kind.__name__)).upper()
        except Exception:  # a class of Python alone
            name = kind.__name__.upper()
        names.append(name)
    for place, (name, above) in enumerate(zip(names, names[1:])):
        if name == above:  # a class of the student's in Python or Hy, which has no name in Lisp but that of its parent
            names[place] = kinds[place].__name__.upper()
    return {"types": names[:30], "text": explanation(condition)[:MOST_TEXT]}


def _plan_faults(tables):
    from cramhy_runtime.testing import faults

    return [faults.at(**table) for table in tables]


def printed(value):
    """A value as Lisp prints it, cut off."""
    from cramhy_runtime.ground.printing import prin1_to_string

    return prin1_to_string(value)[:MOST_TEXT]
