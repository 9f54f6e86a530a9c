"""Why a file cannot be written, in the system's words, and what to try."""

from __future__ import annotations

import errno
import os

_REMEDIES = {
    "ENOSPC": "Make room on that disk, or choose another place.",
    "EDQUOT": "Remove files of yours there, or choose another place.",
    "EFBIG": "Allow larger files (ulimit -f), or choose another place.",
    "EIO": "The device fails. Choose another place, and look at the system's log.",
    "EROFS": "Choose a place that may be written to.",
    "EACCES": "Choose a file and a folder that you may write to.",
    "EPERM": "Choose a file and a folder that you may write to.",
    "EEXIST": "Choose another name.",
    "ENOENT": "Make its folder first, or choose another one.",
    "ENOTDIR": "Choose a name in a folder.",
    "EISDIR": "Choose the name of a file.",
    "ENAMETOOLONG": "Choose a shorter name.",
    "ELOOP": "Remove the link, or choose another name.",
    "EMFILE": "Close files that are not needed, or allow more (ulimit -n).",
    "ENFILE": "Close files that are not needed.",
    "EBUSY": "Wait until it is done, or choose another name.",
}
_ON_WINDOWS = {
    32: "Close the program that has it open, or choose another name.",  # ERROR_SHARING_VIOLATION
    123: 'Choose a name without < > : " | ? and *.',  # ERROR_INVALID_NAME
}
_BY_NUMBER = {getattr(errno, name): text for name, text in _REMEDIES.items() if hasattr(errno, name)}


def why(problem):
    """One or two sentences for the `OSError` ``problem``: what the system said, and what to try if that is known."""
    said = problem.strerror or (os.strerror(problem.errno) if problem.errno else str(problem))
    remedy = _ON_WINDOWS.get(getattr(problem, "winerror", None)) or _BY_NUMBER.get(problem.errno)
    return f"{said}. {remedy}" if remedy else f"{said}."
