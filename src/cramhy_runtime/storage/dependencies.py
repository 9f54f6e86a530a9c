"""What compiled code depends on beside the text that it was made from: a record of questions about the world, each with its answer.

A record is a dictionary ``{(kind, key): answer}``, which `marshal` can write. A `Kind` says how a question of that kind is answered now,
and whether an answer still holds. Those of files, folders and the environment are here; a room above adds its own to `KINDS`, such as the
values of Lisp's variables. `holds` tells whether code with such a record may be used.

Files are told by their content. What the file system says of a file is looked at first: size, time of the last change, and number. As in
git, that is not enough where the file had changed just before somebody looked: two changes within one tick of the clock have the same time.
Such a file is read again.
"""

from __future__ import annotations

import os
import stat
import time

TYPE_CHECKING = False
if TYPE_CHECKING:  # as type checkers see it; `typing` itself takes 2 ms to import
    from collections.abc import Callable
    from typing import Any

    Facts = dict[tuple[str, Any], Any]
else:
    Facts = dict

RACY = 2_000_000_000
"""Nanoseconds: the coarsest clock that file systems have for the last change of a file (FAT)."""
_CHANGING = ("/proc/", "/sys/", "/dev/")


class Unanswerable(Exception):
    """The question has no answer that could be compared later. The text says why: "FILE is no file", "the value is too large"."""


class Kind:
    """A kind of question.

    now: the answer, by the key. told: what is asked for, in words. holds: whether an answer is still right, by key and answer; where there
    is none, it is compared with the one of now.
    """

    __slots__ = ("now", "told", "holds")

    def __init__(self, now: Callable[[Any], Any], told: Callable[[Any], str], holds: Callable[[Any, Any], bool] | None = None):
        self.now, self.told, self.holds = now, told, holds


def holds(facts: Facts) -> bool:
    """Whether all answers in ``facts`` are as they were."""
    return broken(facts) is None


def broken(facts: Facts) -> tuple[str, Any] | None:
    """The first question in ``facts`` that has another answer now; ``None`` if there is none."""
    for question, answer in facts.items():
        kind = KINDS.get(question[0])
        if kind is None:
            return question
        try:
            if not (kind.holds(question[1], answer) if kind.holds is not None else kind.now(question[1]) == answer):
                return question
        except Exception:  # `Unanswerable`, or an object of the user's
            return question
    return None


def told(question: tuple[str, Any]) -> str:
    """What the question asks for, in words: "the file d.txt"."""
    kind, key = question
    return KINDS[kind].told(key) if kind in KINDS else kind


# ------------------------------------------------------------------------------------------------------------------- files


def _file(path: str) -> Any:
    """("missing",), ("folder",), or ("file", size, time of the last change, number, checksum, when that was looked at)."""
    if path.startswith(_CHANGING):
        raise Unanswerable(f"{path} is not a file that keeps what is in it")
    from .digests import sha256

    looked_at = time.time_ns()
    try:
        status = os.stat(path)
        if stat.S_ISDIR(status.st_mode):
            return ("folder",)
        if not stat.S_ISREG(status.st_mode):
            raise Unanswerable(f"{path} is not a file that keeps what is in it")
        with open(path, "rb") as file:
            checksum = sha256(file.read()).hexdigest()
    except (FileNotFoundError, NotADirectoryError):
        return ("missing",)
    except (OSError, ValueError) as problem:
        raise Unanswerable(f"{path} cannot be read: {problem}") from None
    return "file", status.st_size, status.st_mtime_ns, status.st_ino, checksum, looked_at


def _file_holds(path: str, answer: Any) -> bool:
    if answer[0] != "file":
        return _file(path) == answer
    _, size, changed, number, checksum, looked_at = answer
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return False
    if status.st_size != size:
        return False
    if (status.st_mtime_ns, status.st_ino) == (changed, number) and abs(looked_at - changed) > RACY:
        return True
    now = _file(path)
    return now[0] == "file" and now[4] == checksum


def file_state(path: str | os.PathLike[str]) -> Any:
    """What tells later whether a file has changed; ``None`` if there is none. Only a file that has just changed is read for that."""
    looked_at = time.time_ns()
    try:
        status = os.stat(path)
    except OSError:
        return None
    young = stat.S_ISREG(status.st_mode) and abs(looked_at - status.st_mtime_ns) <= RACY
    return status.st_size, status.st_mtime_ns, status.st_ino, _file(os.fspath(path)) if young else None


def unchanged(path: str | os.PathLike[str], state: Any) -> bool:
    """Whether the file is as it was when `file_state` gave ``state``."""
    if state is None:
        return False
    try:
        status = os.stat(path)
    except OSError:
        return False
    if (status.st_size, status.st_mtime_ns, status.st_ino) != state[:3]:
        return False
    return state[3] is None or _file_holds(os.fspath(path), state[3])


def _status(path: str) -> Any:
    """What the file system says of ``path``: whether it is there, what it is, and for a file its size and the time of its last change."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return "link" if os.path.islink(path) else "missing"
    if stat.S_ISREG(status.st_mode):
        return "file", status.st_size, status.st_mtime_ns
    return stat.S_IFMT(status.st_mode)


def _existence(path: str) -> Any:
    answer = _status(path)
    return answer[0] if isinstance(answer, tuple) else answer


def _folder(path: str) -> Any:
    """The names in a folder."""
    try:
        return sorted(name for name in os.listdir(path) if name != "__pycache__")
    except (OSError, ValueError):
        return "missing"


def _environment(name: str | None) -> Any:
    return sorted(os.environ.items()) if name is None else os.environ.get(name)


def _module(name: str) -> str | None:
    """The file in which Python finds the module of that name: another one may stand before it now."""
    from importlib.machinery import PathFinder

    spec = PathFinder.find_spec(name)
    return spec.origin if spec is not None else None


KINDS: dict[str, Kind] = {
    "file": Kind(_file, lambda path: f"the file {path}", _file_holds),
    "existence": Kind(_existence, lambda path: f"whether {path} is there"),
    "status": Kind(_status, lambda path: f"the size or the age of {path}"),
    "folder": Kind(_folder, lambda path: f"the names in the folder {path}"),
    "environment": Kind(_environment, lambda name: f"the variable {name} of the environment" if name else "the environment"),
    "module": Kind(_module, lambda name: f"where the module {name} is"),
    "working folder": Kind(lambda _: os.getcwd(), lambda _: "the working folder"),
}

__all__ = ["KINDS", "Facts", "Kind", "Unanswerable", "broken", "file_state", "holds", "told", "unchanged"]
