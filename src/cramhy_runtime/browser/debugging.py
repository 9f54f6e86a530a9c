"""What the page shows of an error besides its text: the ways to go on, and the calls that led there, with their variables.

All of it is taken at once, on the stack that failed. Nobody may look at the frames of that stack while it is suspended (see the back end).
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.lisp_core.printing import attempt_to_print, report_of
from cramhy_runtime.lisp_core.source_places import describe
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_type
from cramhy_runtime.session.calls_on_stack import calls_on_stack

if TYPE_CHECKING:
    from types import FrameType

MOST_FRAMES, MOST_VARIABLES = 20, 12
LONGEST = 200  # characters of a value


def told(condition: Any, restarts: list[Any], frame: FrameType) -> dict[str, Any]:
    """What the page shows of ``condition``, which was signalled in ``frame`` or below it, and can be left by ``restarts``."""
    return {
        "type": condition_type(condition),
        "restarts": [{"name": symbol_name(restart.name), "report": report_of(restart)} for restart in restarts],
        "frames": [
            {
                "call": call.text,
                "place": describe(call.position),
                "variables": [[name, _shown(value)] for name, value in call.variables[:MOST_VARIABLES]],
            }
            for call in calls_on_stack(frame, condition)[:MOST_FRAMES]
            if call.name != "the form"
        ],
    }


def _shown(value):
    text = attempt_to_print(prin1_to_string, value)
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."
