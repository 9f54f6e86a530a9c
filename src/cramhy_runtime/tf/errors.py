"""The conditions of tf: why a transform is not to be had. Source: cl-transforms.md 5.2.

All are kinds of ``transform-stamped-error``. The text is in the slot ``description`` and is a format control itself, as in the
original; one that cannot be read as such, because a frame is called ``a~b``, is shown as it stands, where the original fails.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import Condition, Error, formatted
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import UNBOUND


class TransformStampedError(Error):
    """A transform cannot be given."""

    lisp_name = "CL-TRANSFORMS-STAMPED::TRANSFORM-STAMPED-ERROR"
    initargs = {"DESCRIPTION": "error_description"}

    def __init__(self, error_description=UNBOUND, **slots):
        super().__init__(**slots)
        self.error_description = error_description

    def report(self):
        if self.error_description is UNBOUND:
            return "A transform could not be computed."
        try:
            return formatted(str(self.error_description), ())
        except Condition:
            return str(self.error_description)


class ConnectivityError(TransformStampedError):
    """Two frames are in different trees."""

    lisp_name = "CL-TRANSFORMS-STAMPED::CONNECTIVITY-ERROR"


class FrameLookupError(TransformStampedError):
    """A frame is not known."""

    lisp_name = "CL-TRANSFORMS-STAMPED::LOOKUP-ERROR"


class ExtrapolationError(TransformStampedError):
    """Nothing is known about the time that was asked for."""

    lisp_name = "CL-TRANSFORMS-STAMPED::EXTRAPOLATION-ERROR"


class InvalidArgumentError(TransformStampedError):
    """What was given is no transform between two frames."""

    lisp_name = "CL-TRANSFORMS-STAMPED::INVALID-ARGUMENT-ERROR"


class TimeoutError_(TransformStampedError):
    """No transform came in time."""

    lisp_name = "CL-TRANSFORMS-STAMPED::TIMEOUT-ERROR"


def transform_error(kind, text, hint=None):
    """Signal a condition of the class ``kind``."""
    return error(kind(text), hint=hint)
