"""Why a call has failed, in words for the echo area of Emacs."""

from __future__ import annotations

from cramhy_runtime.lisp_core.printing import attempt_to_print, prin1_to_string
from cramhy_runtime.languages.commonlisp.tools.advice import report_text
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of

from .rpcs import Refused


def aborted(work):
    """What SLIME writes behind "Evaluation aborted on": the condition that opened the debugger in the call ``work``, as it prints."""
    condition = getattr(work, "debugged", None)
    if condition is None:
        return "aborted"
    return attempt_to_print(prin1_to_string, condition)


def reason_of(failure):
    """The text of a failure for the echo area."""
    if isinstance(failure, Refused):
        return str(failure)
    return report_text(condition_of(failure))
