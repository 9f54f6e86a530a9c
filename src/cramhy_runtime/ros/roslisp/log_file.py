"""The log file of the program's node: open from the node's start to its end. Source: roslisp.md 4.6."""

from __future__ import annotations

import os
from pathlib import Path

from ... import storage

_file = None


def place(naming, now):
    """The path of the log file of a node with that `Naming`, or ``None``: ``__log:=``, or below ``$ROS_LOG_DIR``."""
    if naming.log_file is not None:
        return Path(naming.log_file)
    if os.environ.get("ROS_LOG_DIR"):
        return Path(os.environ["ROS_LOG_DIR"]) / f"{naming.base_name}-{int(now)}.log"
    return None


def start(path):
    """Write to ``path`` from now on; folders are made. `OSError` when it cannot be written."""
    global _file
    stop()
    path.parent.mkdir(parents=True, exist_ok=True)
    _file = open(path, "a", encoding="utf-8", errors="backslashreplace")


def write(line):
    """Add a line, if there is a log file. Returns why that is the end of the log, a text, or ``None`` when all is well."""
    global _file
    if _file is None:
        return None
    try:
        _file.write(line)
        _file.flush()
    except OSError as problem:
        name = _file.name
        stop()
        return f"The log file {name} ends here: {storage.why(problem)} The program goes on."
    return None


def stop():
    """Close it."""
    global _file
    file, _file = _file, None
    if file is not None:
        try:
            file.close()
        except OSError:
            pass  # each line was written when it came; what could not be was told then
