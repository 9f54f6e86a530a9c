"""A submission runs: it is loaded, the plan is called, questions are answered, and all that is told as it comes.

This happens in the process of the submission, which is in a sandbox, or in an image of this process where the system has no processes (a
browser). Nothing here knows what is right: answers and commands are reported, and ``judging.py`` compares them elsewhere. Only the verdicts
of tests of lisp-unit, FiveAM and pytest come from here, since such tests call the submission's functions.

A job is a dictionary of plain data, made by ``jobs.py``. ``tell(kind, **facts)`` sends one report.
"""

from __future__ import annotations

import sys
from contextlib import nullcontext
from pathlib import Path

from . import tests_inside
from .recording import Recording
from .uses import Uses, listen_to_audit, words_in

MOST_VALUES = 20
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


def perform(job, folder, tell, apart=True):
    """Do what ``job`` says. folder: where its files are, as text. tell: see above. The last report is "done", unless something was lost.

    apart: whether this process is the submission's own, and ends with it.
    """
    from cramhy_runtime.session.session import Session
    from cramhy_runtime.testing.watched import WatchedKernel

    made = Session(
        time="virtual", seed=None if job["seed"] == 1 else job["seed"], time_limit=job["turtle_time"], kind=WatchedKernel, cleanup_limit=2.0
    )
    recording = Recording(tuple(job["start"]), job["troubles"], job["seed"])
    recording.watch()
    uses = Uses(tell, job["files"], folder)
    if apart:
        sys.dont_write_bytecode = True  # code that is kept beside a submission would be code that it could write
        listen_to_audit(uses)
    carry_out(job, Path(folder), tell, made, recording, uses)


def carry_out(job, folder, tell, made, recording, uses=None):
    """As `perform`, in the session ``made``, of which ``load``, ``evaluate_text`` and ``package`` are used. folder: a path.

    uses: notices what the submission does beside commands, a `Uses`; ``None``: nobody does.
    """
    try:
        _prepare(job, made)
        if uses is not None:
            uses.keep_functions(_called(job, made))
        with uses.watching() if uses is not None else nullcontext():
            _steps(job, folder, tell, made, recording, uses)
    except _Ended:
        pass
    if uses is not None:
        uses.look_at_functions()
        if recording.simulator is not None:
            uses.look_at_simulator(recording.simulator)
    if recording.simulator is not None:
        recording.tell(tell)
    tell("done")


def _prepare(job, made):
    """Load what the exercise builds upon."""
    for system in job["systems"]:
        made.load(system)
    if job["package"]:
        made.package = job["package"].upper()
    for form in job["prelude"]:
        made.evaluate_text(form)


def _reading():
    """Makes contexts in which forms of the exercise are read as now, before the submission can have changed how Lisp reads."""
    from cramhy_runtime.lisp_core.dynamic import binding
    from cramhy_runtime.languages.commonlisp.reader.readtables import READTABLE
    from cramhy_runtime.languages.commonlisp.reader.tokens import READ_BASE

    table = READTABLE.value.copy()
    return lambda: binding(READTABLE, table.copy(), READ_BASE, 10)


def _called(job, made):
    """What the forms of the exercise name, as of `words_in`: these functions are not the submission's to change.

    In the forms that are evaluated for the verdict, those of the exercise's own package are what the student writes, unless the prelude
    defines them.
    """
    package, own, found = made.package.name, (job["package"] or "").upper(), {}
    texts = [(text, package) for text in (*job["asks"], *([job["do"]] if job["do"] is not None else []))]
    if job["tests"] and job["tests"]["name"].endswith(".lisp"):
        texts.append((job["tests"]["text"], "COMMON-LISP-USER"))  # its own package is not there yet, and uses Common Lisp, too
    for text, home in texts:
        for place, symbol in words_in(text, home).items():
            if symbol.package is not None and own not in symbol.package.names:
                found[place] = symbol
    for text in (*job["prelude"], *job["before"]):
        found |= words_in(text, package)
    return found


def _steps(job, folder, tell, made, recording, uses):
    from cramhy_runtime import kernel

    exercise = _reading() if uses is not None else nullcontext
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
    if uses is not None:
        uses.look_at_functions()
    for form in job["before"]:
        tell("stage", doing="before", what=form[:MOST_TEXT])
        with uses.paused() if uses is not None else nullcontext(), exercise():
            _attempt(tell, lambda form=form: made.evaluate_text(form))
    if uses is not None:
        uses.keep_functions(_called(job, made))
        if recording.simulator is not None:
            uses.keep_simulator(recording.simulator)
    if job["do"] is not None:
        tell("stage", doing="do", what=job["do"][:MOST_TEXT])
        kernel.sleep(SETTLING)
        faults = _plan_faults(job["faults"])
        recording.plan_begins()
        begun = kernel.now()
        if faults:  # of which an ordinary kernel knows nothing
            kernel.active().faults.extend(faults)
        try:
            with exercise():
                values = _attempt(tell, lambda: made.evaluate_text(job["do"]), go_on=True)
        finally:
            if faults:
                kernel.active().faults.clear()
        took = kernel.now() - begun
        recording.plan_ends()
        tell("took", seconds=round(took, 4))
        kernel.sleep(job["after"])
        if values is not None:
            tell("value", values=[printed(value) for value in values[:MOST_VALUES]])
        tell("faults", happened=[fault.happened is not None for fault in faults])
    for form in job["asks"]:
        tell("stage", doing="ask", what=form[:MOST_TEXT])
        with exercise():
            values = _attempt(tell, lambda form=form: made.evaluate_text(form), go_on=True)
        if values is not None:
            tell("answer", values=[printed(value) for value in values[:MOST_VALUES]])
    if job["tests"]:
        tell("stage", doing="tests", what=job["tests"]["name"])
        try:
            with exercise() if not job["tests"]["name"].endswith(".py") else nullcontext():  # pytest brings a kernel of its own
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
    from cramhy_runtime.lisp_core.conditions import Condition

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
    from cramhy_runtime.lisp_core.classes import class_name
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
    from cramhy_runtime.lisp_core.printing import prin1_to_string

    return prin1_to_string(value)[:MOST_TEXT]
