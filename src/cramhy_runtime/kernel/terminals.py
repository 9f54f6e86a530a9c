"""Terminals and pipes: which keys send signals, whether a key comes at once, and whether a read would wait.

POSIX has `termios` for this, and `select` on any file. Windows has neither: it selects among sockets only, and `msvcrt` asks its console.
A browser has none of them. So each function says what it does where the system does not help; then the terminal stays as it is, and
whether a read would wait is unknown beforehand.
"""

import os
import select
import signal
from contextlib import contextmanager, nullcontext

from . import signals
from .typing_names import Any

try:
    import termios
except ImportError:  # not a POSIX system
    termios = None
try:
    import msvcrt
except ImportError:  # not Windows
    msvcrt = None

INTERRUPT = "\x03"
_ARROWS = {"H": b"\x1b[A", "P": b"\x1b[B", "M": b"\x1b[C", "K": b"\x1b[D"}
"""The codes that terminals send for the arrow keys. Windows names these keys by a letter after one of these:"""
_SPECIAL = ("\x00", "\xe0")
PACE = 0.02  # s between two looks at the keys of Windows' console, which nothing but a look can wait for


# --------------------------------------------------------------------------------------------------------------------- waiting


def readable(file, seconds):
    """Whether a read from the file, or file descriptor, would return at once. Waits for that at most ``seconds``.

    It is ``None`` if the system cannot tell: for a file without a descriptor, or if only sockets can be waited for.
    """
    try:
        return bool(select.select([file], [], [], seconds)[0])
    except (OSError, ValueError, AttributeError):
        return None


def is_terminal(fd):
    """Whether the file descriptor FD is a terminal."""
    try:
        return os.isatty(fd)
    except OSError:
        return False


_CANNOT_DRAW = ("", "dumb", "unknown", "emacs")


def draws(file: Any) -> bool:
    """Whether the text file is a terminal on which something can be drawn and erased, by what the variable TERM says of it.

    Emacs' buffers and other "dumb" ones only take lines. Windows' console draws, and has no TERM.
    """
    try:
        on_terminal = file is not None and file.isatty()
    except ValueError:  # it is closed
        return False
    return on_terminal and os.environ.get("TERM", "" if os.name == "posix" else "windows") not in _CANNOT_DRAW


# ----------------------------------------------------------------------------------------------------------------------- modes


def ctrl_c_as_a_key(fd, end_of_line=False):
    """Let Ctrl-C on the terminal FD be a character during the block, which sends no signal. With END_OF_LINE, it ends a line."""
    if termios is None:
        return nullcontext()
    keys = {termios.VINTR: os.fpathconf(fd, "PC_VDISABLE").to_bytes(1, "little")}
    return _modes(fd, keys={**keys, termios.VEOL: INTERRUPT.encode()} if end_of_line else keys)


def typed_ahead(fd):
    """Let a read during the block get everything typed on the terminal FD so far, also an unfinished line."""
    return nullcontext() if termios is None else _modes(fd, off=termios.ICANON | termios.ECHO)


@contextmanager
def _modes(fd, on=0, off=0, keys=None):
    """Give the terminal FD other local modes (ON, OFF: bits of termios) and special KEYS during the block, and then restore them."""
    try:
        before = termios.tcgetattr(fd)
        changed = [*before[:6], list(before[6])]
        changed[3] = before[3] & ~off | on
        for key, value in (keys or {}).items():
            changed[6][key] = value
    except termios.error:  # the terminal was closed
        yield
        return
    try:
        _set_modes(fd, changed)  # in here, since a signal may raise behind it
        yield
    finally:
        _set_modes(fd, before)


def _set_modes(fd, modes):
    try:
        termios.tcsetattr(fd, termios.TCSANOW, modes)
    except termios.error:
        pass  # the terminal was closed


@contextmanager
def terminal_of_a_session():
    """During the block, keys that send signals do not throw away input typed ahead. Afterwards, however the process ends, the terminal
    is restored."""
    if termios is None or not is_terminal(0):
        yield
        return
    before = termios.tcgetattr(0)
    signals.restore_terminal.append(lambda: _set_modes(0, before))
    with _modes(0, on=termios.NOFLSH):
        try:
            yield
        finally:
            signals.restore_terminal.pop()


# ------------------------------------------------------------------------------------------------------------- key after key


@contextmanager
def keys_one_by_one():
    """``with keys_one_by_one() as read:`` gives each key of standard input at once, and shows none.

    ``read(seconds)`` returns the bytes that were typed within so many seconds, ``b""`` at the end of input, and ``None`` if nothing was
    typed. The terminal is restored, also when the program is stopped and goes on. Input from another source than a terminal is read as
    it comes. If the system cannot tell whether a key was typed, ``read`` waits for one.
    """
    if msvcrt is not None and is_terminal(0):
        yield _read_windows_console
    elif termios is None or not is_terminal(0):
        yield _read_input
    else:
        with _modes(0, off=termios.ICANON | termios.ECHO):
            typing = termios.tcgetattr(0)
            before = signal.signal(signal.SIGCONT, lambda *_: _set_modes(0, typing))  # the shell had the terminal meanwhile
            try:
                yield _read_input
            finally:
                signal.signal(signal.SIGCONT, before)


def _read_input(seconds):
    return None if readable(0, seconds) is False else os.read(0, 1024)


def _read_windows_console(seconds):
    import time

    until = time.monotonic() + seconds
    while not msvcrt.kbhit():
        if time.monotonic() >= until:
            return None
        time.sleep(PACE)
    typed = b""
    while msvcrt.kbhit():
        key = msvcrt.getwch()
        typed += _ARROWS.get(msvcrt.getwch(), b"") if key in _SPECIAL else key.encode()
    if INTERRUPT.encode() in typed:  # `getwch` makes a character of Ctrl-C
        raise KeyboardInterrupt
    return typed or None
