"""``cramhy grade`` and ``cramhy similar``: points for submissions, and pairs of submissions that are alike."""

from __future__ import annotations

import sys
from pathlib import Path

from cramhy_runtime import storage


def grade(options):
    """Grade a submission as the options say. Returns the exit status: 0 if all checks passed, 1 if not, 2 if it could not be graded."""
    from cramhy_runtime.grading import formats
    from cramhy_runtime.grading.grader import grade as graded
    from cramhy_runtime.grading.problems import ExerciseError
    from cramhy_runtime.grading.sandbox import bubblewrap

    try:
        report = graded(options.exercise, options.submission, options.seeds, options.sandbox, options.as_root)
    except ExerciseError as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
    wanted = [(options.json, lambda: report.json().encode()), (options.junit, report.junit)]
    if not all([_write(path, made()) for path, made in wanted if path is not None]):
        return 2
    sys.stdout.write(formats.FORMATS[options.format](report))
    if report.held and "bubblewrap" not in report.held and options.sandbox is None:
        print(f"cramhy: the submission ran behind cramhy's own locks. {bubblewrap.why_not()}", file=sys.stderr)
    missing = formats.missing_locks(report)
    if missing:
        print(f"cramhy: this system has no lock for {', '.join(missing)}. docs/how-to/grading.md says what that means.", file=sys.stderr)
    return 0 if report.passed else 1


def similar(options):
    """List similar pairs as the options say. Returns the exit status: 0: there are none, 1: there are some, 2: wrong options."""
    from cramhy_runtime.grading.problems import ExerciseError
    from cramhy_runtime.grading.similar import pairs

    try:
        found = pairs.similar_pairs(options.folder, options.given, options.least / 100)
    except ExerciseError as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
    if options.json is not None and not _write(options.json, pairs.as_json(found).encode()):
        return 2
    sys.stdout.write(pairs.as_text(found))
    return 1 if found else 0


def _write(path, data):
    """Write ``data`` into a file; whether that was possible, which is told."""
    try:
        storage.write_whole(Path(path).absolute(), data)
    except OSError as problem:
        print(f"cramhy: Cannot write {path}: {problem.strerror}.", file=sys.stderr)
        return False
    return True
