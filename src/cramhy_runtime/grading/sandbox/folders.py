"""Landlock: which files a process may read and write, as rules of Linux that it makes for itself. Source: landlock(7).

It may read what Python and cramhy need: the system's programs and libraries, the installation, the modules' folders. It may write in one
folder. Homes, other submissions and the exercise's own folder are out of reach, unless they lie in one of those.
"""

from __future__ import annotations

import ctypes
import os
import sys

_CREATE, _ADD, _RESTRICT = 444, 445, 446  # the same numbers on all processors
_VERSION = 1
_PATH_BENEATH = 1
_EXECUTE, _WRITE, _READ, _READ_FOLDER = 1, 2, 4, 8
_ALL_OF_VERSION = {1: (1 << 13) - 1, 2: (1 << 14) - 1, 3: (1 << 15) - 1, 5: (1 << 16) - 1}
_MADE_OF_NOTHING = ("/usr", "/lib", "/lib64", "/bin", "/etc", "/opt", "/nix", "/dev/null", "/dev/zero", "/dev/urandom", "/dev/random")
_BIND_AND_CONNECT = 3
_SIGNALS_AND_SOCKETS = 3
_NO_NEW_PRIVILEGES = 38


class _Rules(ctypes.Structure):
    _fields_ = [("files", ctypes.c_uint64), ("network", ctypes.c_uint64), ("scoped", ctypes.c_uint64)]


class _Beneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = [("allowed", ctypes.c_uint64), ("folder", ctypes.c_int32)]


def close(scratch):
    """Let the calling process write below ``scratch`` only, and read there and where its modules are; whether the system does that."""
    if sys.platform != "linux":
        return False
    try:
        system = ctypes.CDLL(None, use_errno=True)
    except OSError:
        return False
    version = system.syscall(_CREATE, None, ctypes.c_size_t(0), ctypes.c_uint32(_VERSION))
    if version < 1:
        return False
    handled = _ALL_OF_VERSION[max(known for known in _ALL_OF_VERSION if known <= version)]
    rules = _Rules(handled, _BIND_AND_CONNECT if version >= 4 else 0, _SIGNALS_AND_SOCKETS if version >= 6 else 0)
    size = 24 if version >= 6 else 16 if version >= 4 else 8
    made = system.syscall(_CREATE, ctypes.byref(rules), ctypes.c_size_t(size), ctypes.c_uint32(0))
    if made < 0:
        return False
    for path in readable():
        _allow(system, made, path, (_EXECUTE | _READ | _READ_FOLDER) & handled)
    _allow(system, made, "/dev/null", _WRITE | _READ)
    _allow(system, made, scratch, handled & ~_EXECUTE)
    system.prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    done = system.syscall(_RESTRICT, made, ctypes.c_uint32(0)) == 0
    os.close(made)
    return done


def readable():
    """The paths that a process of Python with cramhy reads."""
    packages = [path for path in sys.path if path]
    ours = [os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))]
    language = sys.modules.get("cramhy")
    ours += [os.path.dirname(folder) for folder in getattr(language, "__path__", ())]
    wanted = [*_MADE_OF_NOTHING, f"/proc/{os.getpid()}", sys.prefix, sys.base_prefix, *packages, *ours, *_tutorials()]
    return [path for path in dict.fromkeys(wanted) if os.path.exists(path)]


def _tutorials():
    from cramhy_runtime.ros.search_folders import search_folders

    return [os.path.join(path, name) for path in search_folders() if os.path.basename(path) == "tutorials" for name in _packages(path)]


def _packages(folder):
    """The folders in the tutorials' one, without the exercises: their tests are nobody's business."""
    return [name for name in os.listdir(folder) if name != "exercises"]


def _allow(system, rules, path, allowed):
    try:
        place = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    try:
        if not os.path.isdir(path):
            allowed &= _EXECUTE | _WRITE | _READ
        system.syscall(_ADD, rules, _PATH_BENEATH, ctypes.byref(_Beneath(allowed, place)), ctypes.c_uint32(0))
    finally:
        os.close(place)
