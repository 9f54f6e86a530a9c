"""What nobody caught: the one owner of ``sys.excepthook``, which Python calls when an exception ends the main program.

A kernel installs it, where the hook is still Python's own. A floor above may tell of the exceptions that it knows (`told_by`), in its
own words; whatever it does not know goes to the hook that stood here before. A program that such a floor tells of ends after Ctrl-C
without a word, with the status 130, as a command does. Any other Python program ends as Python ends it: with a traceback, by the signal.
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
    """Be called from now on, if the hook is Python's own or one of ``instead_of``. Somebody else's is left alone."""
    if sys.excepthook is sys.__excepthook__ or sys.excepthook in instead_of:
        _before[:] = [sys.excepthook]
        sys.excepthook = _uncaught


def told_by(teller, instead_of=()):
    """Let ``teller(exception)`` tell the user of what nobody caught. It returns whether it has done so.

    instead_of: hooks besides Python's own that give way to ours, as that of a program which runs other programs.
    """
    if teller not in _tellers:
        _tellers.append(teller)
    install(instead_of)


def _uncaught(kind, exception, traceback):
    """The main program ends by an exception; or a prompt shows one."""
    at_a_prompt = hasattr(sys, "ps1") or sys.flags.interactive
    if issubclass(kind, (KeyboardInterrupt, Abandoned)) and not issubclass(kind, Terminated) and not at_a_prompt:
        if _tellers:
            raise SystemExit(INTERRUPTED)  # the way in which a hook gives Python the exit status
        _interrupts.append(exception)
    elif any(teller(exception) for teller in _tellers):
        return
    _before[0](kind, exception, traceback)


def ended_by_interrupt():
    """Whether Ctrl-C ended the main program in Python's way, so that the process is to end by the signal."""
    return bool(_interrupts)


__all__ = ["INTERRUPTED", "ended_by_interrupt", "install", "told_by"]
