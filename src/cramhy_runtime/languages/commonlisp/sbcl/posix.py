"""SB-POSIX: the environment, and the calls of the system that programs make by it. Source: SBCL's manual, chapter 17."""

from __future__ import annotations

import os
import stat

from cramhy_runtime.lisp_core.conditions import Error, error
from cramhy_runtime.lisp_core.data import list_from, truth
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from ..evaluation.universal_time import UNIVERSAL_EPOCH, get_universal_time

if TYPE_CHECKING:
    from collections.abc import Callable


class SyscallError(Error):
    """A call of the system failed: ``name`` says which, ``errno`` why."""

    lisp_name = "SB-POSIX::SYSCALL-ERROR"
    initargs = {"ERRNO": "errno", "NAME": "name"}
    errno: Any = None
    name: Any = None

    def report(self) -> str:
        """SBCL's text."""
        return f"Error in SB-POSIX:{self.name.upper()}: {os.strerror(self.errno)} ({self.errno})"


def _call(name: str, function: Callable[..., Any], *arguments: Any) -> Any:
    try:
        return function(*arguments)
    except OSError as problem:
        return error(SyscallError(name=name, errno=problem.errno))


def syscall_errno(condition: Any) -> object:
    """``sb-posix:syscall-errno``: why a call failed, a number."""
    return condition.errno


def getenv(name: Any) -> str | None:
    """``sb-posix:getenv``: a variable of the environment, or nil."""
    return os.environ.get(str(name))


def setenv(name: Any, value: Any, overwrite: object = 1) -> int:
    """``sb-posix:setenv``: set a variable of the environment; one that is set already only if ``overwrite`` is neither 0 nor nil."""
    if str(name) not in os.environ or (truth(overwrite) and overwrite != 0):
        try:
            os.environ[str(name)] = str(value)
        except (ValueError, OSError):
            error(SyscallError(name="setenv", errno=22))
    return 0


def unsetenv(name: Any) -> int:
    """``sb-posix:unsetenv``: remove a variable from the environment."""
    os.environ.pop(str(name), None)
    return 0


def putenv(text: Any) -> int:
    """``sb-posix:putenv``: set a variable by ``"NAME=VALUE"``."""
    name, _, value = str(text).partition("=")
    return setenv(name, value)


def environ() -> object:
    """``sb-ext:posix-environ``: a list of ``"NAME=VALUE"``."""
    return list_from([f"{name}={value}" for name, value in os.environ.items()])


def time() -> int:
    """``sb-posix:time``: seconds since 1970, by the kernel's clock."""
    return get_universal_time() - UNIVERSAL_EPOCH


def getpid() -> int:
    """``sb-posix:getpid``"""
    return os.getpid()


def getppid() -> int:
    """``sb-posix:getppid``"""
    return os.getppid()


def _of_user(name: str) -> Callable[[], int]:
    """A function of the system that tells who runs the process; 0 where the system has none."""

    def ask() -> int:
        return int(getattr(os, name, lambda: 0)())

    return ask


getuid, geteuid, getgid, getegid = map(_of_user, ("getuid", "geteuid", "getgid", "getegid"))


def getcwd() -> str:
    """``sb-posix:getcwd``"""
    return os.getcwd()


def chdir(folder: Any) -> int:
    """``sb-posix:chdir``"""
    _call("chdir", os.chdir, os.fspath(folder))
    return 0


def mkdir(folder: Any, mode: int = 0o777) -> int:
    """``sb-posix:mkdir``"""
    _call("mkdir", os.mkdir, os.fspath(folder), mode)
    return 0


def rmdir(folder: Any) -> int:
    """``sb-posix:rmdir``"""
    _call("rmdir", os.rmdir, os.fspath(folder))
    return 0


def unlink(file: Any) -> int:
    """``sb-posix:unlink``"""
    _call("unlink", os.unlink, os.fspath(file))
    return 0


def rename(old: Any, new: Any) -> int:
    """``sb-posix:rename``"""
    _call("rename", os.replace, os.fspath(old), os.fspath(new))
    return 0


def chmod(file: Any, mode: int) -> int:
    """``sb-posix:chmod``"""
    _call("chmod", os.chmod, os.fspath(file), mode)
    return 0


def access(file: Any, mode: int) -> int:
    """``sb-posix:access``: 0 if the file may be used so, else a syscall-error."""
    if not os.access(os.fspath(file), mode):
        error(SyscallError(name="access", errno=13 if os.path.exists(os.fspath(file)) else 2))
    return 0


def readlink(file: Any) -> Any:
    """``sb-posix:readlink``"""
    return _call("readlink", os.readlink, os.fspath(file))


def stat_(file: Any) -> Any:
    """``sb-posix:stat``: what the system tells of a file, or of what a link leads to."""
    return _call("stat", os.stat, os.fspath(file))


def lstat(file: Any) -> Any:
    """``sb-posix:lstat``: as `stat_`, of the link itself."""
    return _call("lstat", os.lstat, os.fspath(file))


def _part(name: str) -> Callable[[Any], int]:
    """A function: that part of what `stat_` tells, a whole number."""
    return lambda told: int(getattr(told, f"st_{name}"))


OF_FILES = {
    "stat": stat_,
    **{f"stat-{name}": _part(name) for name in "mode ino dev nlink uid gid size atime mtime ctime".split()},
    **{
        f"s-is{kind}": lambda mode, ask=getattr(stat, f"S_IS{kind.upper()}"): True if ask(mode) else None
        for kind in "reg dir chr blk fifo lnk sock".split()
    },
}
"""Functions whose names Python does not take, or that are made of one another."""
CONSTANTS = {"R-OK": os.R_OK, "W-OK": os.W_OK, "X-OK": os.X_OK, "F-OK": os.F_OK, "ENOENT": 2, "EACCES": 13, "EEXIST": 17, "EINVAL": 22}
NAMES = """getenv setenv unsetenv putenv time getpid getppid getuid geteuid getgid getegid getcwd chdir mkdir rmdir unlink rename chmod
access readlink lstat syscall-errno"""
