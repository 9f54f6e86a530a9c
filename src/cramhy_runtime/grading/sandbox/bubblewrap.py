"""Bubblewrap: the sandbox of Flatpak and of others, where it is installed and works. Source: bwrap(1), namespaces(7), setns(2).

A submission is forked from a process that has the course in its memory, and bwrap can only start programs. So bwrap starts ``cat`` in a
fresh sandbox (`Bubblewrap`), and the forked process joins that sandbox's name spaces (`join`): of users, processes, mounts, network, IPC
and host name. The first process of the sandbox is bwrap's. When it ends, Linux ends all others in there, and the files go with the mounts;
so nothing that a submission does can outlive it. It ends with the process that started it (``--die-with-parent``), and when that one
closes the pipe from which ``cat`` reads.

The root folder cannot be written. The submission's folder is a tmpfs of a fixed size and number of files. bwrap cannot set that number, so
`join` mounts it, and then gives up the rights to mount anything.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import shutil
import signal
import subprocess

from . import folders, linux

FOLDER = "/submission"
"""Where the submission's files are, as it sees them."""
MOST_ON_DISK = 32 * 1024 * 1024
MOST_FILES = 2000
NUMBER = 1000
"""The user's and the group's number in the sandbox, whoever grades."""
WAIT = 20.0
"""Seconds in which bwrap has to be ready; on an idle machine it takes 0.03."""
WHERE = "/usr/bin:/bin:/usr/local/bin:/run/current-system/sw/bin"
_SPACES = linux.NEW_USER | linux.NEW_PID | linux.NEW_MOUNT | linux.NEW_IPC | linux.NEW_UTS | linux.NEW_NET


class Unusable(Exception):
    """Bubblewrap cannot be used here. Its text says why."""


def arguments(keeper: str, hidden: tuple[str, ...] | list[str]) -> list[str]:
    """The options that say what the sandbox has, and its program.

    keeper: the path of the program ``cat``. hidden: folders that a submission must not see, wherever they are.
    """
    words = ["--unshare-all", "--unshare-user", "--die-with-parent", "--new-session", "--cap-drop", "ALL", "--clearenv"]
    words += ["--uid", str(NUMBER), "--gid", str(NUMBER), "--hostname", "sandbox"]
    shown = folders.readable()
    for path in shown:
        if os.path.islink(path):
            words += ["--symlink", os.readlink(path), path]
        else:
            words += ["--ro-bind", path, path]
    for path in folders.topmost(os.path.realpath(each) for each in [*folders.exercises(), *hidden]):
        if os.path.isdir(path) and any(folders.is_below(path, os.path.realpath(each)) for each in shown):
            words += ["--tmpfs", path, "--remount-ro", path]
    for path in folders.DEVICES:
        words += ["--dev-bind", path, path]
    if not any(path == "/tmp" or path.startswith("/tmp/") for path in shown):
        words += ["--symlink", FOLDER, "/tmp"]
    return [*words, "--ro-bind", os.path.realpath(keeper), "/cat", "--dir", FOLDER, "--remount-ro", "/", "/cat"]


class Bubblewrap:
    """A sandbox of bwrap's in which nothing runs yet. hidden: see `arguments`. Raises `Unusable` if there is no bwrap.

    `first` is the number of its first process, for `join`. `end` ends it, with all that is in it.
    """

    def __init__(self, hidden: tuple[str, ...] | list[str] = ()):
        program, keeper = (shutil.which(name, path=WHERE) for name in ("bwrap", "cat"))
        if program is None or keeper is None:
            raise Unusable("bubblewrap is not installed. Debian, Ubuntu, Fedora and Arch have it as the package bubblewrap.")
        self._facts, told = os.pipe()
        try:
            words = [program, "--info-fd", str(told), *arguments(keeper, hidden)]
            self.process = subprocess.Popen(
                words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, pass_fds=[told], env={}, cwd="/"
            )
        finally:
            os.close(told)
        self._first = 0

    def first(self) -> int:
        """The number of its first process. Waits until the sandbox is whole. Raises `Unusable` if bwrap cannot make it."""
        if not self._first:
            assert self.process.stdin is not None and self.process.stdout is not None and self.process.stderr is not None
            with contextlib.suppress(OSError):
                self.process.stdin.write(b".")
                self.process.stdin.flush()
            ready = select.select([self.process.stdout], (), (), WAIT)[0]
            if not ready or self.process.stdout.read(1) != b".":
                self.process.kill()
                said = self.process.stderr.read(2000).decode("utf-8", "replace").strip()
                self.end()
                raise Unusable(f"bubblewrap does not work here: {said or 'it does not answer'}.")
            self._first = json.loads(os.read(self._facts, 4096))["child-pid"]
        return self._first

    def end(self) -> None:
        """End it, with all that is in it. When this returns, there is no process and no file of it."""
        if self._facts >= 0:
            os.close(self._facts)
            self._facts = -1
        if self._first and self.process.poll() is None:
            with contextlib.suppress(OSError):
                os.kill(self._first, signal.SIGKILL)
        else:
            self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            if pipe is not None:
                with contextlib.suppress(OSError):
                    pipe.close()


def join(first: int) -> None:
    """Take the calling process, which has one thread, into the sandbox whose first process is ``first``. Its children are in it wholly."""
    place = os.pidfd_open(first)
    try:
        linux.call("setns", place, _SPACES)
    finally:
        os.close(place)
    linux.mount_tmpfs(FOLDER, f"size={MOST_ON_DISK},nr_inodes={MOST_FILES},mode=0700")
    os.chdir(FOLDER)


def why_not() -> str | None:
    """The reason why bubblewrap cannot be used here, ``None`` if it can: makes a sandbox, and joins it. The process has one thread."""
    try:
        made = Bubblewrap()
    except (Unusable, OSError) as problem:
        return str(problem)
    try:
        return _tried(made.first())
    except (Unusable, OSError) as problem:
        return str(problem)
    finally:
        made.end()


def _tried(first: int) -> str | None:
    """What a process that joins says of it."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        try:
            join(first)
            linux.drop_rights()
        except BaseException as problem:
            os.write(writing, f"bubblewrap works, but its sandbox cannot be joined: {problem}.".encode())
        finally:
            os._exit(0)
    os.close(writing)
    said = os.read(reading, 4096).decode("utf-8", "replace")
    os.close(reading)
    os.waitpid(child, 0)
    return said or None
