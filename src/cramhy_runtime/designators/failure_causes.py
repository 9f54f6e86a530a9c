"""Why a designator could not be resolved, if a Lisp function is to blame: it signalled an error, and the goal that called it failed.

The error became a warning, as in the original, which may be far up on the screen, or muffled. So the explanation of the designator
begins with it. Source: prolog.md section 8.
"""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

from .classes import attached

if TYPE_CHECKING:
    from .classes import Designator

_CAUSES = "_causes_of_failure"


def note_causes(designator: Designator, causes: dict[str, bool]) -> None:
    """Remember the keys of ``causes``, texts about Lisp functions that signalled while ``designator`` was resolved."""
    attached(designator)[_CAUSES] = causes


def because(designator: Designator, explanation: str) -> str:
    """``explanation`` of why ``designator`` is not resolved, after what is known of its causes."""
    return "\n".join([*attached(designator).get(_CAUSES, ()), explanation])
