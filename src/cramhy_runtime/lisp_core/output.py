"""What the runtime tells besides the values of forms: traces, logs and answers, on the streams of whoever is installed (``ports.py``)."""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import Any

from . import plain_answers  # noqa: F401  so that there are streams in any case
from .ports import PORTS


def trace_output() -> Any:
    """The stream ``*trace-output*``: ``write(text)``, ``fresh_line()``, ``flush()``."""
    return PORTS.output.stream("trace-output")


def output_stream(designator: Any) -> Any:
    """The stream that ``designator`` stands for; ``None`` is ``*trace-output*``."""
    return PORTS.output.designated(designator) if designator is not None else trace_output()


def designated_stream(designator: Any) -> Any:
    """The output stream that ``designator`` stands for, as every function of Lisp takes it: ``None`` is ``*standard-output*``."""
    return PORTS.output.designated(designator)


def standard_output() -> Any:
    """The stream ``*standard-output*``."""
    return PORTS.output.stream("standard-output")


def error_output() -> Any:
    """The stream ``*error-output*``."""
    return PORTS.output.stream("error-output")
