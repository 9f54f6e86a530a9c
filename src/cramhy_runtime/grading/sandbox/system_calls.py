"""Seccomp: a filter of the calls that a process makes to Linux, which it makes for itself. Source: seccomp(2), bpf.

A call on the list fails with "operation not permitted", so that a submission gets an error and the student a message. Threads can be
started, processes cannot. Signals can be sent to the process itself only. It cannot take back that it ends with its parent.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform
import sys

from . import linux
from .call_numbers import ARCHITECTURES, CALLS, CLONE, CLONE3, KILL, PRCTL, PRLIMIT, TGKILL

_LOAD, _EQUAL, _AT_LEAST, _AND, _RETURN = 0x20, 0x15, 0x35, 0x54, 0x06
_ALLOW, _ERROR = 0x7FFF0000, 0x00050000
_NUMBER, _ARCHITECTURE, _FIRST, _SECOND = 0, 4, 16, 24  # where the data of a call are; arguments have 64 bits, the lower half first
_CLONE_THREAD = 0x10000
_X32 = 0x40000000
_SET_SECCOMP, _FILTER = 22, 2


class _Step(ctypes.Structure):
    _fields_ = [("code", ctypes.c_ushort), ("yes", ctypes.c_ubyte), ("no", ctypes.c_ubyte), ("value", ctypes.c_uint32)]


class _Program(ctypes.Structure):
    _fields_ = [("length", ctypes.c_ushort), ("steps", ctypes.POINTER(_Step))]


def close():
    """Filter the calls of the calling process and of its threads from now on; whether the system does that."""
    machine = platform.machine()
    if sys.platform != "linux" or sys.byteorder != "little" or machine not in ARCHITECTURES or sys.maxsize < 2**32:
        return False
    steps = _filter(list(ARCHITECTURES).index(machine), ARCHITECTURES[machine], os.getpid())
    program = _Program(len(steps), (_Step * len(steps))(*(_Step(*step) for step in steps)))
    try:
        linux.prctl(linux.NO_NEW_PRIVILEGES, 1)
        linux.call("prctl", _SET_SECCOMP, _FILTER, ctypes.byref(program), 0, 0)
    except OSError:
        return False
    return True


def _filter(column, architecture, own):
    """The steps of the filter as (code, steps to skip if so, steps to skip if not, value)."""
    refused, unknown = (_RETURN, 0, 0, _ERROR | errno.EPERM), (_RETURN, 0, 0, _ERROR | errno.ENOSYS)
    allowed, number = (_RETURN, 0, 0, _ALLOW), (_LOAD, 0, 0, _NUMBER)
    steps = [(_LOAD, 0, 0, _ARCHITECTURE), (_EQUAL, 1, 0, architecture), refused, number, (_AT_LEAST, 0, 1, _X32), refused]
    for place in sorted(numbers[column] for numbers in CALLS.values() if numbers[column] is not None):
        steps += [(_EQUAL, 0, 1, place), refused]
    steps += [(_EQUAL, 0, 1, CLONE3[column]), unknown]  # its flags are out of a filter's sight; libraries take clone then
    steps += [(_EQUAL, 0, 4, CLONE[column]), (_LOAD, 0, 0, _FIRST), (_AND, 0, 0, _CLONE_THREAD), (_EQUAL, 0, 1, 0), refused, number]
    for place in (KILL[column], TGKILL[column]):
        steps += [(_EQUAL, 0, 3, place), (_LOAD, 0, 0, _FIRST), (_EQUAL, 1, 0, own), refused, number]
    steps += [(_EQUAL, 0, 3, PRLIMIT[column]), (_LOAD, 0, 0, _FIRST), (_EQUAL, 1, 0, 0), refused]
    steps += [(_EQUAL, 0, 3, PRCTL[column]), (_LOAD, 0, 0, _FIRST), (_EQUAL, 0, 1, linux.PARENT_DEATH_SIGNAL), refused]
    return [*steps, allowed]
