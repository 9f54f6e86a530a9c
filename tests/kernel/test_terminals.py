"""Keys of a terminal, and what is left of them where the system has no ``termios``."""

from __future__ import annotations

import os
import signal

import pytest

from cramhy_runtime.kernel import terminals

termios = pytest.importorskip("termios")


@pytest.fixture
def typist(monkeypatch):
    """A terminal in the place of standard input; the function types into it, as a person would."""
    pty = pytest.importorskip("pty")
    master, slave = pty.openpty()
    kept = os.dup(0)
    os.dup2(slave, 0)
    yield lambda text: os.write(master, text.encode())
    os.dup2(kept, 0)
    for each in (kept, master, slave):
        os.close(each)


def test_a_key_comes_at_once_and_is_not_shown(typist):
    before = termios.tcgetattr(0)
    with terminals.keys_one_by_one() as read:
        assert read(0) is None
        typist("a\x1b[A")
        assert read(5) == b"a\x1b[A"
        assert not termios.tcgetattr(0)[3] & (termios.ECHO | termios.ICANON)
    assert termios.tcgetattr(0) == before


def test_the_terminal_that_a_shell_had_meanwhile_hands_over_keys_again(typist):
    handler = signal.getsignal(signal.SIGCONT)
    with terminals.keys_one_by_one() as read:
        cooked = termios.tcgetattr(0)
        cooked[3] |= termios.ECHO | termios.ICANON
        termios.tcsetattr(0, termios.TCSANOW, cooked)
        signal.raise_signal(signal.SIGCONT)
        typist("b")
        assert read(5) == b"b"
    assert signal.getsignal(signal.SIGCONT) == handler


@pytest.mark.parametrize("missing", ["termios", "select"])
def test_whole_lines_come_where_the_system_has_no_keys(typist, monkeypatch, missing):
    """Windows and browsers: nobody can tell whether something was typed, so reading waits."""
    if missing == "termios":
        monkeypatch.setattr(terminals, "termios", None)
    else:
        monkeypatch.setattr(terminals, "termios", None)
        monkeypatch.setattr(terminals.select, "select", refuse)
        assert terminals.readable(0, 0) is None
    with terminals.keys_one_by_one() as read:
        typist("ab\n")
        assert read(5) == b"ab\n"


def refuse(*_):
    raise OSError(10038, "An operation was attempted on something that is not a socket")


def test_the_modes_of_a_terminal_stay_where_there_is_no_termios(typist, monkeypatch):
    before = termios.tcgetattr(0)
    monkeypatch.setattr(terminals, "termios", None)
    for block in (
        terminals.ctrl_c_as_a_key(0),
        terminals.ctrl_c_as_a_key(0, True),
        terminals.typed_ahead(0),
        terminals.terminal_of_a_session(),
    ):
        with block:
            assert termios.tcgetattr(0) == before


class Console:
    """What ``msvcrt`` is to a program: keys that were pressed, of which some are two characters."""

    def __init__(self, pressed):
        self.pressed = list(pressed)

    def kbhit(self):
        return bool(self.pressed)

    def getwch(self):
        return self.pressed.pop(0)


@pytest.mark.parametrize(
    ("pressed", "read_as"),
    [("", None), ("q", b"q"), ("\xe0H", b"\x1b[A"), ("\x00P\xe0M\xe0Kq", b"\x1b[B\x1b[C\x1b[Dq"), ("\xe0S", None), ("ü", "ü".encode())],
)
def test_the_console_of_windows_names_arrows_as_terminals_do(typist, monkeypatch, pressed, read_as):
    monkeypatch.setattr(terminals, "msvcrt", Console(pressed))
    with terminals.keys_one_by_one() as read:
        assert read(0) == read_as


def test_ctrl_c_on_the_console_of_windows_ends_the_wait(typist, monkeypatch):
    monkeypatch.setattr(terminals, "msvcrt", Console("a\x03"))
    with terminals.keys_one_by_one() as read, pytest.raises(KeyboardInterrupt):
        read(0)


def test_a_pipe_is_read_as_it_comes(monkeypatch):
    end, other = os.pipe()
    kept = os.dup(0)
    os.dup2(end, 0)
    try:
        with terminals.keys_one_by_one() as read:
            assert read(0) is None
            os.write(other, b"xy")
            assert read(5) == b"xy"
            os.close(other)
            assert read(5) == b""
    finally:
        os.dup2(kept, 0)
        os.close(kept)
        os.close(end)
