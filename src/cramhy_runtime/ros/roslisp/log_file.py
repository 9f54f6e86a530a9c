"""The log file of the program's node: open from the node's start to its end. Source: roslisp.md 4.6."""

from __future__ import annotations

import os
from pathlib import Path

from cramhy_runtime.kernel.images import Cell
from ... import storage
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from typing import TextIO

    from ..names import Naming


_file: Cell[TextIO | None] = Cell(None, fresh=True)


def place(naming: Naming, now: float) -> Path | None:
    """The path of a node's log file: from ``__log:=``, else below ``$ROS_LOG_DIR``, else ``None``. ``now``: seconds since 1970."""
    if naming.log_file is not None:
        return Path(naming.log_file)
    if os.environ.get("ROS_LOG_DIR"):
        return Path(os.environ["ROS_LOG_DIR"]) / f"{naming.base_name}-{int(now)}.log"
    return None


def start(path: Path) -> None:
    """Write the log to ``path`` from now on; missing folders are made. Raises `OSError` if the file cannot be written."""
    stop()
    path.parent.mkdir(parents=True, exist_ok=True)
    _file.value = open(path, "a", encoding="utf-8", errors="backslashreplace")


def write(line: str) -> str | None:
    """Add ``line`` to the log file, if there is one. If writing fails, the log ends; returns the reason as text, else ``None``."""
    if _file.value is None:
        return None
    try:
        _file.value.write(line)
        _file.value.flush()
    except OSError as problem:
        name = _file.value.name
        stop()
        return f"The log file {name} ends here: {storage.why(problem)} The program goes on."
    return None


def stop() -> None:
    """Close the log file."""
    file, _file.value = _file.value, None
    if file is not None:
        try:
            file.close()
        except OSError:
            pass  # each line was written when it came; what could not be was told then
