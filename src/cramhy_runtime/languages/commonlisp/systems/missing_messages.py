"""What a system wants of a ROS package of messages that is not there, as its source files tell: for the error that says so.

The system ``nope_msgs-msg`` stands for the messages of the ROS package ``nope_msgs``. Its types are named in strings
(``"nope_msgs/Grip"``), their Lisp names with the package ``nope_msgs-msg`` or ``nope_msgs-srv`` before them.
"""

from __future__ import annotations

import re

from cramhy_runtime.ros import definition_files
from .system_definitions import systems

_MOST = 6
"""How many names of a kind are told."""


def advice(name, files):
    """The hint for the missing system ``name``, ``nope_msgs-msg`` or ``nope_msgs-srv``; ``None`` if it is not called so.

    files: the source files of the system that asked for it.
    """
    package, _, kind = name.rpartition("-")
    if kind not in ("msg", "srv") or not package:
        return None
    told = [definition_files.why_missing(package, kind=kind)]
    wanted, names = _wanted(package, files)
    if wanted:
        told.append(f"Wanted of it: {_listed(wanted)}.")
    if names:
        told.append(f"Lisp names of it: {_listed(names)}.")
    return "\n".join(told)


def wanted_by(required_by, files_of):
    """The source files of the system called ``required_by``, which ``files_of`` lists; none if there is no such system."""
    system = systems.get(required_by)
    return [component.pathname for component in files_of(system)] if system is not None else []


def _wanted(package, files):
    """The definition files of ``package``, and its Lisp names, that ``files`` name, each with the first place."""
    types = re.compile(rf'"{re.escape(package)}/([A-Za-z]\w*)"')
    symbols = re.compile(rf"(?<![\w:*-]){re.escape(package)}-(?:msg|srv)::?([^\s()'`\",;:]+)", re.IGNORECASE)
    wanted, names = {}, {}
    for path in files:
        try:
            lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
        except OSError:
            continue
        for number, line in enumerate(lines, 1):
            for match in types.finditer(line):
                wanted.setdefault(definition_files.file_of_type(match[1]), f"{path.name}:{number}")
            for match in symbols.finditer(line):
                names.setdefault(match[1].lower(), f"{path.name}:{number}")
    return wanted, names


def _listed(found):
    shown = [f"{what} ({where})" for what, where in list(found.items())[:_MOST]]
    more = len(found) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")
