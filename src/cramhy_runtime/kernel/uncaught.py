"""Uncaught exceptions: the only owner of ``sys.excepthook``, which Python calls when an exception ends the main program.

A kernel installs it if the hook is still Python's own. A floor above may report the exceptions that it knows in its own words
(`told_by`); others go to the hook that was there before. With such a floor, a program ends after Ctrl-C without a message, with the
status 130, as a command does. Any other Python program ends as usual: with a traceback, by the signal.
"""

from __future__ import annotations

import signal
import sys

from .errors import Abandoned, Terminated

INTERRUPTED = 128 + signal.SIGINT

_before = []  # the hook that stood here before ours
_tellers = []  # functions of an exception: whether they have told of it
_interrupts = []  # those that ended the main program, where nobody tells of exceptions


def install(instead_of=()):
    """Install the hook, if the present one is Python's own or one of ``instead_of``. Other hooks are left alone."""
    if sys.excepthook is sys.__excepthook__ or sys.excepthook in instead_of:
        _before[:] = [sys.excepthook]
        sys.excepthook = _uncaught


def told_by(teller, instead_of=()):
    """Let ``teller(exception)`` report uncaught exceptions to the user. It returns whether it has done so.

    instead_of: hooks besides Python's own that are replaced, such as that of a program that runs other programs.
    """
    if teller not in _tellers:
        _tellers.append(teller)
    install(instead_of)


def _uncaught(kind, exception, traceback):
    """The hook: an exception ends the main program, or a prompt shows one."""
    at_a_prompt = hasattr(sys, "ps1") or sys.flags.interactive
    if issubclass(kind, (KeyboardInterrupt, Abandoned)) and not issubclass(kind, Terminated) and not at_a_prompt:
        if _tellers:
            raise SystemExit(INTERRUPTED)  # the way in which a hook gives Python the exit status
        _interrupts.append(exception)
    elif any(teller(exception) for teller in _tellers):
        return
    _before[0](kind, exception, traceback)


def ended_by_interrupt():
    """Whether Ctrl-C ended the main program in Python's way, so that the process must end by the signal."""
    return bool(_interrupts)


__all__ = ["INTERRUPTED", "ended_by_interrupt", "install", "told_by"]
