"""What the user is told and asked beside the values of forms: warnings that nobody muffled, and forms for restarts."""

from __future__ import annotations

import textwrap

from cramhy_runtime.lisp_core.condition_types import StyleWarning
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.lisp_core.printing import princ_to_string, with_numbers_as_spoken
from ..evaluation.evaluator import evaluate
from ..format.format import format_
from ..reader.reader import read_from_stream
from ..streams.streams import ERROR_OUTPUT, QUERY_IO, output_stream


def warning_line(condition):
    """Print ``condition`` to ``*error-output*`` as ``warn`` does: ``WARNING: `` and its report on a line of its own.

    Below that stand its ``where`` and its ``hint``, if somebody noted what more there is to say.
    """
    badness = "STYLE-WARNING" if isinstance(condition, StyleWarning) else "WARNING"
    stream = output_stream(ERROR_OUTPUT.value)
    if stream.filled_to is None:
        with_numbers_as_spoken(format_, ERROR_OUTPUT.value, "~&~@<~A: ~3i~:_~A~:>~%", badness, condition)
    else:  # as SBCL prints an error in a warning, it stands far to the right
        stream.fresh_line()
        words = " ".join(f"{badness}: {princ_to_string(condition)}".split())
        stream.write("\n".join(textwrap.wrap(words, stream.filled_to, subsequent_indent="   ", break_on_hyphens=False)) + "\n")
    for line in filter(None, (getattr(condition, "where", None), getattr(condition, "hint", None))):
        stream.write("".join(f"  {part}\n" for part in line.splitlines()))
    stream.flush()


def ask_for_form(prompt):
    """Print ``prompt`` to ``*query-io*``, read a form from there and return the value of it."""
    stream = QUERY_IO.value
    stream.fresh_line()
    stream.write(prompt)
    stream.flush()
    return one(evaluate(read_from_stream(stream)))
