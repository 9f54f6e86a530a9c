"""A file that is being written and has not got its name yet.

A `Part` stands beside its place, ``.NAME.RANDOM.cramhy-part``. `Part.finish` checks that everything has reached the disk and gives it the
name; `Part.discard` removes it. The random half of the name is made by the system's source of secrets, and the file must not have been
there before, so nobody can plant a file or a link in its way.

`growing` is for a file that is written for hours, such as a recording. It has its name from the first moment on if nothing has that
name. Otherwise it is a part that the next start recovers, ``.NAME.RANDOM.cramhy-recording``.

Each holds a lock of the operating system on its file, by which others see that the process lives (see `leftovers`). On Windows a file
that is open cannot be removed, which is as good.
"""

from __future__ import annotations

import errno
import os
import stat
from io import BufferedRandom, BufferedWriter, FileIO

from . import backups
from .partial_names import BINARY, PART, RECORDING, fcntl, forget, free_name, is_being_written, lock, part_name, same_file

_DIRECT = ("/dev/", "/proc/")


class Part:
    """A file that will be at ``path``. ``file``: to write to, binary, buffered, and to be read again by `seek`.

    mode: the permissions of the file, of which the user's umask takes some away; without it those of the file that is replaced, or the
    usual ones. ending: which kind of part it is. claim: to take the name ``path`` at once, if it is free. follow: whether a link is
    followed, and a device written to; else what has the name is replaced, whatever it is. Errors: `OSError` with ``path`` as its
    ``filename``, then and in `finish`.
    """

    def __init__(self, path, mode=None, ending=PART, claim=False, follow=True):
        self.path = os.fspath(path)
        self.name = self._lock = self.file = None
        try:
            self.place, status = _place(self.path) if follow else (self.path, None)
            if status is not None and (not stat.S_ISREG(status.st_mode) or self.place.startswith(_DIRECT)):
                self._open_directly()
            else:
                self._open(status, mode, ending, claim)
        except OSError as problem:
            raise self._named(problem) from None

    def _open_directly(self):
        self.file = BufferedWriter(FileIO(self.path, "wb"))

    def _open(self, status, mode, ending, claim):
        if status is not None and not os.access(self.place, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        kept = status is not None and mode is None
        usual = 0o666 if mode is None else mode
        while self.file is None:
            self.name = self.place if claim and status is None else part_name(self.place, ending)
            handle = os.open(self.name, os.O_RDWR | os.O_CREAT | os.O_EXCL | BINARY, 0o600 if kept else usual)
            try:
                if lock(handle) and not same_file(handle, self.name):
                    os.close(handle)  # somebody tidied up between the two lines above
                    continue
                if kept:
                    _take_over(handle, status)
                self.file = BufferedRandom(FileIO(handle, "r+b", closefd=True))
                self._lock = os.dup(handle) if fcntl else None
            except BaseException:
                self._drop(handle)
                raise

    def _drop(self, handle):
        try:
            self.file.close() if self.file is not None else os.close(handle)
        except OSError:
            pass  # the problem that led here is the one to be told
        self.discard()

    def _named(self, problem):
        problem.filename, problem.filename2 = self.path, None
        return problem

    def finish(self, durable=True, backup=None, lost=True, replace=True):
        """Check that everything is on the disk, and give the file its name.

        durable: to wait for the disk, not only for the system. backup: a name for the older file, beside it; else that file goes. lost:
        whether to discard what was written if that fails; else it is the caller's to `discard` or `keep`. replace: whether a file that
        has the name is replaced; else that is a `FileExistsError`.
        """
        try:
            self.file.flush()
            if durable:
                synchronize(self.file.fileno())
            self.file.close()  # a network file system may say only now that the disk is full
            if self.name not in (None, self.place):
                if not replace:
                    os.link(self.name, self.place)  # unlike a rename, it needs a free name
                    forget(self.name)
                elif backup is None:
                    os.replace(self.name, self.place)
                else:
                    backups.replace(self.name, self.place, backup)
        except BaseException as problem:
            if lost:
                self.discard()
            if isinstance(problem, OSError):
                raise self._named(problem) from None
            raise
        self.name = None
        self._unlock()

    def discard(self):
        """Remove what was written. Nothing happens after `finish`."""
        name, self.name = self.name, None
        try:
            mine = name is not None and (self.file is None or self.file.closed or same_file(self.file.fileno(), name))
        except OSError:
            mine = True
        self._close()
        if mine:
            forget(name)
        self._unlock()

    def keep(self):
        """Leave what was written, also if it is not complete, and close the file. Returns the name that it has now.

        That is the file's own name if it had it from the beginning, else one beside the older file of that name.
        """
        self._close()
        name, self.name = self.name, None
        if name not in (None, self.place):
            kept = free_name(self.place)
            try:
                os.rename(name, kept)
                name = kept
            except OSError:
                pass  # then it keeps the name that it has
        self._unlock()
        return name or self.path

    def _close(self):
        raw = getattr(self.file, "raw", None)
        if raw is None or self.file.closed:
            return
        try:
            self.file.close()
        except (OSError, ValueError):
            try:
                raw.close()  # the buffer could not be written, and is not wanted any more
            except OSError:
                pass

    def _unlock(self):
        handle, self._lock = self._lock, None
        if handle is not None:
            try:
                os.close(handle)
            except OSError:
                pass  # nothing was written by this number


def growing(path):
    """A `Part` for a file that is written for a long time; the older file of that name stays until it is finished.

    Errors: `OSError`; with the number EBUSY when a living process, this one included, writes a file of that name in this way.
    """
    while True:
        try:
            place, status = _place(os.fspath(path))
            if status is not None and stat.S_ISREG(status.st_mode) and is_being_written(place):
                raise OSError(errno.EBUSY, "Another recording is being written there", os.fspath(path))
            return Part(path, ending=RECORDING, claim=True)
        except FileExistsError:
            continue  # another process has taken the name since


def synchronize(handle):
    """``fsync``, where the file system has it."""
    try:
        os.fsync(handle)
    except OSError as problem:
        if problem.errno not in (errno.EINVAL, errno.ENOTSUP):
            raise


def _place(path):
    """(the file itself behind all links, its status or ``None``)."""
    if not path:
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))
    if path.startswith(_DIRECT):
        return path, os.stat(path)
    try:
        status = os.stat(path)
    except FileNotFoundError:
        status = None
    if status is not None and stat.S_ISDIR(status.st_mode) or path.endswith(("/", os.sep)):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    return os.path.realpath(path), status


def _take_over(handle, status):
    """Give a file the permissions and, where that is allowed, the owner of the one that it replaces."""
    if not hasattr(os, "fchmod"):
        return
    mine = os.fstat(handle)
    for owner, group in ((status.st_uid, -1), (-1, status.st_gid)):
        if owner not in (-1, mine.st_uid) or group not in (-1, mine.st_gid):
            try:
                os.fchown(handle, owner, group)
            except OSError:
                pass  # only root may give files away
    os.fchmod(handle, stat.S_IMODE(status.st_mode) & 0o777)
