"""What was typed at prompts before, form by form, in a file that all sessions of a user share.

A form is one entry, however many lines it has. The file has one entry a line, as a JSON string, the oldest first. A session adds its
entries at the end, under a lock, and never writes what it has read. So sessions that run side by side lose nothing of each other. When the
file has grown too large, its older half is dropped. A line that is not such a string (the machine stopped in the middle of it, an editor
has changed it) is passed over, and the rest counts. Nobody but the user may read the file.

A history is a convenience: where the file cannot be written or read, the session goes on with the forms in memory.

Source of the place: XDG Base Directory Specification.
"""

from __future__ import annotations

import json
import os
import stat

from cramhy_runtime.storage import owners
from cramhy_runtime.storage.partial_names import BINARY, lock, same_file
from cramhy_runtime.storage.atomic_write import write_whole

MOST = 1_000_000
"""Bytes of the file, at which its older half is dropped."""
LONGEST = 50_000
"""Bytes of an entry. A longer one is kept in memory only."""
_PATIENTLY = getattr(os, "O_NONBLOCK", 0) | BINARY  # a pipe of that name is not waited for
_OURS = 0o600


def place(name: str) -> str | None:
    """The path of the file for the prompt ``name``; ``None`` if there shall be none.

    It is ``cramhy/NAME`` in the folder for state: ``$XDG_STATE_HOME``, else ``~/.local/state``; on Windows ``%LOCALAPPDATA%``. The variable
    CRAMHY_HISTORY names another folder; if it is empty there is no file.
    """
    folder = os.environ.get("CRAMHY_HISTORY")
    if folder is None:
        base = os.environ.get("LOCALAPPDATA" if os.name == "nt" else "XDG_STATE_HOME", "")
        base = base if os.path.isabs(base) else os.path.join(os.path.expanduser("~"), ".local", "state")
        folder = os.path.join(base, "cramhy")
    return os.path.join(folder, name) if os.path.isabs(folder) else None


class History:
    """The entries of the file ``path`` (``None``: no file) and of this session: ``forms``, the oldest first."""

    def __init__(self, path: str | None):
        self.path = path
        self.forms: list[str] = []
        if path is not None:
            try:
                self.forms = _read(path)
            except OSError:
                pass  # there is none yet

    def add(self, form: str) -> bool:
        """Add ``form`` unless it is what was typed last; whether it was added."""
        form = form.strip("\n")
        if not form.strip() or self.forms[-1:] == [form]:
            return False
        self.forms.append(form)
        line = _line(form)
        if self.path is not None and len(line) <= LONGEST:
            try:
                _append(self.path, line)
            except OSError:
                pass  # no room, or not allowed
        return True


def _line(form):
    return json.dumps(form, ensure_ascii=False).encode("utf-8", "surrogatepass") + b"\n"


def _read(path):
    handle = os.open(path, os.O_RDONLY | _PATIENTLY)
    with open(handle, "rb") as file:
        if not _is_history(handle):
            return []
        file.seek(max(0, os.fstat(handle).st_size - 2 * MOST))
        lines = file.read(2 * MOST).split(b"\n")
    return [form for form in map(_form, lines) if form is not None]


def _form(line):
    """The entry of a line; ``None`` for a line that is none."""
    try:
        found = json.loads(line.decode("utf-8", "surrogatepass"))
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, str) and found.strip() else None


def _is_history(handle):
    status = os.fstat(handle)
    return stat.S_ISREG(status.st_mode) and owners.mine(status)


def _append(path, line):
    """Write ``line`` behind the last one, in a piece."""
    folder = os.path.dirname(path)
    if not _our_folder(folder):
        return
    while True:
        handle = os.open(path, os.O_RDWR | os.O_APPEND | os.O_CREAT | _PATIENTLY, _OURS)
        try:
            if not _is_history(handle):
                return
            lock(handle)
            if not same_file(handle, os.path.realpath(path)):
                continue  # another session has made it shorter meanwhile
            status = os.fstat(handle)
            if owners.open_to_others(status):
                os.chmod(path, _OURS)
            if status.st_size:
                os.lseek(handle, -1, os.SEEK_END)
                if os.read(handle, 1) != b"\n":
                    line = b"\n" + line  # the last line was cut off
            os.write(handle, line)
            if status.st_size + len(line) > MOST:
                _shorten(path)
            return
        finally:
            os.close(handle)


def _our_folder(folder):
    """Make the folder if it is not there. Whether the file belongs there: not in the home of another user, as after ``sudo``."""
    above = folder
    while not os.path.exists(above) and os.path.dirname(above) != above:
        above = os.path.dirname(above)
    if not owners.mine(os.stat(above)):
        return False
    os.makedirs(folder, mode=0o700, exist_ok=True)
    return True


def _shorten(path):
    """Keep the newer entries that fill half of what is allowed."""
    kept, size = [], 0
    for form in reversed(_read(path)):
        line = _line(form)
        size += len(line)
        if size > MOST // 2:
            break
        kept.append(line)
    write_whole(path, b"".join(reversed(kept)), mode=_OURS, durable=False)


__all__ = ["History", "place"]
