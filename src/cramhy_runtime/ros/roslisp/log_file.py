"""The log file of the program's node: open from the node's start to its end. Source: roslisp.md 4.6."""

from __future__ import annotations

import os
from pathlib import Path

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
    _file = open(path, "a", encoding="utf-8")


def write(line):
    """Add a line, if there is a log file."""
    if _file is not None:
        _file.write(line)
        _file.flush()


def stop():
    """Close it."""
    global _file
    if _file is not None:
        _file.close()
        _file = None
