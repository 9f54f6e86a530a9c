"""Exercises, and grading what students hand in: ``cramhy grade``, ``cramhy similar``.

    from cramhy_runtime.grading import grade

    report = grade("square", "submissions/ann/square.lisp")
    print(report.points, report.most)

An exercise is a folder (`exercise`). A submission runs in a process of its own (`processes`, `watcher`, `fork_server`), in a `sandbox`,
where it is asked things and where its turtle drives (`performing`, `recording`). What it answers and what its turtle was told go to the
grader, which draws the run again (`replay`) and compares (`judging`). So the expected answers are never where the submission is, and what
it prints is not looked at.

Where the parts are: ``exercise``, ``expressions``, ``paths``, ``troubles`` (what an exercise says) · ``jobs``, ``processes``, ``watcher``,
``messages``, ``fork_server``, ``sandbox`` (the process of a submission), ``here`` (without one), ``in_session`` (in the session that is
there), ``noticing`` (what a plan does there on its way) · ``performing``, ``recording``, ``uses``, ``tests_inside`` (what happens in it) ·
``schema``, ``told`` (what it says) · ``allowances``, ``replay``, ``drawings``, ``judging``, ``forms`` (the verdict) · ``sentences``,
``harmless`` (its words) · ``grader``, ``report``, ``formats`` (points and words) · ``similar`` (submissions that are alike) · ``problems``
(errors of exercises).
"""

from .grader import Grader, grade
from .problems import ExerciseError
from .report import CheckResult, Report

__all__ = ["CheckResult", "ExerciseError", "grade", "Grader", "Report"]
