"""Which files a submission may read and write: the paths, and Landlock's rules for them where bubblewrap is not used. Source: landlock(7).

It may read what Python and cramhy need: shared libraries, the interpreter's own modules, the installed packages, cramhy, the course. It may
write in one folder. Homes, ``/etc``, other submissions and the exercises are out of reach, also those exercises that lie beside cramhy in
an installed package.
"""

from __future__ import annotations

import ctypes
import importlib.util
import os
import sys
import sysconfig
from collections.abc import Iterable

from . import linux

_CREATE, _ADD, _RESTRICT = 444, 445, 446  # the same numbers on all processors
_VERSION = 1
_PATH_BENEATH = 1
_EXECUTE, _WRITE, _READ, _READ_FOLDER = 1, 2, 4, 8
_ALL_OF_VERSION = {1: (1 << 13) - 1, 2: (1 << 14) - 1, 3: (1 << 15) - 1, 5: (1 << 16) - 1}
_LIBRARIES = ("/lib", "/lib32", "/lib64", "/usr/lib", "/usr/lib32", "/usr/lib64", "/usr/local/lib", "/usr/local/lib64")
_OTHERS = ("/nix/store", "/gnu/store", "/usr/share/zoneinfo")
_BIND_AND_CONNECT = 3
_SIGNALS_AND_SOCKETS = 3
DEVICES = ("/dev/null", "/dev/zero", "/dev/urandom", "/dev/random")
_PACKAGE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


class _Rules(ctypes.Structure):
    _fields_ = [("files", ctypes.c_uint64), ("network", ctypes.c_uint64), ("scoped", ctypes.c_uint64)]


class _Beneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = [("allowed", ctypes.c_uint64), ("folder", ctypes.c_int32)]


def close(scratch: str, hidden: list[str]) -> bool:
    """Let the calling process write below ``scratch`` only, and read there and where its modules are; whether the system does that.

    hidden: folders that it must not read, wherever they are.
    """
    if sys.platform != "linux":
        return False
    try:
        system = linux.library()
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
    secret = [os.path.realpath(path) for path in [*exercises(), *hidden]]
    for path in readable():
        _allow(system, made, path, _READ_FOLDER)
        for part in _without(path, secret):
            _allow(system, made, part, _EXECUTE | _READ | _READ_FOLDER)
    for path in DEVICES:
        _allow(system, made, path, _READ)
    _allow(system, made, "/dev/null", _WRITE | _READ)
    _allow(system, made, scratch, handled & ~_EXECUTE)
    linux.prctl(linux.NO_NEW_PRIVILEGES, 1)
    done = system.syscall(_RESTRICT, made, ctypes.c_uint32(0)) == 0
    os.close(made)
    return done


def packages() -> list[str]:
    """The folders of cramhy's own two packages."""
    language = importlib.util.find_spec("cramhy")
    found = language.submodule_search_locations if language is not None else None
    return list(dict.fromkeys([_PACKAGE, *(found or ())]))


def readable() -> list[str]:
    """The paths that a process of Python with cramhy reads; none of them is below another one."""
    prefixes = [os.path.join(prefix, name) for prefix in (sys.prefix, sys.base_prefix) for name in ("lib", "lib64")]
    modules = [sysconfig.get_path("stdlib"), sysconfig.get_path("platstdlib"), *(path for path in sys.path if path)]
    wanted = [*_LIBRARIES, *_OTHERS, *prefixes, *modules, *packages(), *_course()]
    return topmost(os.path.normpath(path) for path in wanted if os.path.exists(path))


def topmost(paths: Iterable[str]) -> list[str]:
    """The paths, each once, without those that are below another one."""
    found = list(dict.fromkeys(paths))
    return [path for path in found if not any(path != other and is_below(path, other) for other in found)]


def is_below(path: str, folder: str) -> bool:
    """Whether ``path`` is ``folder``, or in it at any depth, by their texts."""
    return path == folder or path.startswith(f"{folder.rstrip(os.sep)}{os.sep}")


def _tutorials() -> list[str]:
    """Where cramhy's tutorials may be: in its package, and beside it in a checkout."""
    checkout = os.path.dirname(os.path.dirname(_PACKAGE))
    return [os.path.join(place, "tutorials") for place in (_PACKAGE, checkout)]


def exercises() -> list[str]:
    """The folders of the exercises that come with cramhy, whose tests and answers no submission may see."""
    return [path for place in _tutorials() if os.path.isdir(path := os.path.join(place, "exercises"))]


def _course() -> list[str]:
    found = [(place, name) for place in _tutorials() if os.path.isdir(place) for name in os.listdir(place)]
    return [os.path.join(place, name) for place, name in found if name != "exercises"]


def _without(path: str, secret: list[str]) -> list[str]:
    """The paths at or below ``path`` that together are all of it but the secret ones."""
    real = os.path.realpath(path)
    if any(is_below(real, each) for each in secret):
        return []
    if not any(is_below(each, real) for each in secret):
        return [path]
    return [part for name in sorted(os.listdir(path)) for part in _without(os.path.join(path, name), secret)]


def _allow(system, rules, path, allowed):
    try:
        place = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    try:
        if not os.path.isdir(path):
            allowed &= _EXECUTE | _WRITE | _READ
        if allowed:
            system.syscall(_ADD, rules, _PATH_BENEATH, ctypes.byref(_Beneath(allowed, place)), ctypes.c_uint32(0))
    finally:
        os.close(place)
