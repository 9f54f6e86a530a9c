"""The history of what was typed: form by form, in a file that sessions share, and that nothing breaks."""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys

import pytest

from cramhy_runtime.repl import history
from cramhy_runtime.repl.history import History, place

from .conftest import environment

DEFUN = '(defun drive ()\n  "Drives."\n  (wait-for x))'


@pytest.fixture
def path(tmp_path):
    return str(tmp_path / "state" / "cramhy" / "lisp-history")


def test_a_form_of_several_lines_is_one_entry_that_the_next_session_has(path):
    first = History(path)
    first.add("(+ 1 1)")
    first.add(DEFUN)
    assert History(path).forms == ["(+ 1 1)", DEFUN]


def test_what_is_typed_twice_in_a_row_is_one_entry(path):
    typed = History(path)
    assert [typed.add("a"), typed.add("a"), typed.add("b"), typed.add("a"), typed.add(" \n")] == [True, False, True, True, False]
    assert typed.forms == History(path).forms == ["a", "b", "a"]


def test_sessions_side_by_side_lose_nothing_of_each_other(path):
    one, other = History(path), History(path)
    for number in range(5):
        one.add(f"(one {number})")
        other.add(f"(other {number})")
    assert History(path).forms == [f"({who} {number})" for number in range(5) for who in ("one", "other")]


def test_processes_that_write_at_once_lose_nothing_even_while_the_file_is_made_shorter(path):
    program = (
        "import sys; from cramhy_runtime.repl import history; history.MOST = 4000\n"
        "typed = history.History(sys.argv[1])\n"
        "for number in range(200): typed.add(f'({sys.argv[2]} {number})')"
    )
    writers = [subprocess.Popen([sys.executable, "-c", program, path, name], env=environment()) for name in "abc"]
    assert [writer.wait(120) for writer in writers] == [0, 0, 0]
    kept = History(path).forms
    for name in "abc":  # the newest of each, without a gap
        numbers = [int(form.strip("()").split()[1]) for form in kept if form.startswith(f"({name} ")]
        assert numbers == list(range(200 - len(numbers), 200)), name
    assert os.path.getsize(path) <= 4100
    assert len(kept) > 50


@pytest.mark.skipif(os.name != "posix", reason="modes are POSIX's")
def test_nobody_else_may_read_it(path):
    History(path).add("(secret)")
    assert stat.S_IMODE(os.stat(path).st_mode) == 0o600
    assert stat.S_IMODE(os.stat(os.path.dirname(path)).st_mode) == 0o700
    os.chmod(path, 0o644)
    History(path).add("(another)")
    assert stat.S_IMODE(os.stat(path).st_mode) == 0o600


def test_the_older_half_is_dropped_when_the_file_has_grown_too_large(path, monkeypatch):
    monkeypatch.setattr(history, "MOST", 1000)
    typed = History(path)
    for number in range(100):
        typed.add(f"(form {number})")
        assert os.path.getsize(path) <= 1000
    kept = History(path).forms
    assert kept == [f"(form {number})" for number in range(100 - len(kept), 100)]
    assert len(kept) >= 30
    assert len(typed.forms) == 100
    if os.name == "posix":
        assert stat.S_IMODE(os.stat(path).st_mode) == 0o600


def test_a_form_as_long_as_a_book_is_not_written(path):
    typed = History(path)
    typed.add("(" + "x" * history.LONGEST + ")")
    typed.add("(short)")
    assert History(path).forms == ["(short)"]
    assert len(typed.forms) == 2


@pytest.mark.parametrize(
    "content, forms",
    [
        (b'"(a)"\n"(b', ["(a)"]),  # cut off
        (b'\x00\xff\xfe\n"(a)"\n', ["(a)"]),
        (b'(a)\n{"a": 1}\n"(b)"\n17\n""\n\n' + b"[" * 100_000 + b"\n", ["(b)"]),
        (b"", []),
        (b"\n\n", []),
        (b"x" * 3_000_000, []),
    ],
)
def test_what_is_broken_is_passed_over_and_what_is_added_behind_it_counts(path, content, forms):
    os.makedirs(os.path.dirname(path))
    with open(path, "wb") as file:
        file.write(content)
    typed = History(path)
    assert typed.forms == forms
    typed.add("(new)")
    assert History(path).forms == [*forms, "(new)"]


def test_all_that_can_be_typed_comes_back(path):
    forms = ['"ä\\n→"', "(a\tb)", "\udcff", "(a\r b\x0b \u2028 c)"]
    for form in forms:
        History(path).add(form)
    assert History(path).forms == forms
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        assert json.loads(file.readline()) == forms[0]


@pytest.mark.parametrize("obstacle", ["a folder", "a file where the folder should be", "a pipe"])
def test_where_there_can_be_no_file_the_session_goes_on(path, obstacle):
    if obstacle == "a folder":
        os.makedirs(path)
    elif obstacle == "a pipe":
        if not hasattr(os, "mkfifo"):
            pytest.skip("this system has no named pipes")
        os.makedirs(os.path.dirname(path))
        os.mkfifo(path)
    else:
        with open(os.path.dirname(os.path.dirname(path)), "w"):
            pass
    typed = History(path)
    assert typed.add("(a)")
    assert typed.forms == ["(a)"]


def test_the_place_is_in_the_folder_for_state(monkeypatch, tmp_path):
    monkeypatch.delenv("CRAMHY_HISTORY", raising=False)
    monkeypatch.setattr(os, "name", "posix")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert place("lisp-history") == str(tmp_path / "cramhy" / "lisp-history")
    monkeypatch.setenv("XDG_STATE_HOME", "relative")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert place("lisp-history") == str(tmp_path / ".local" / "state" / "cramhy" / "lisp-history")
    monkeypatch.setenv("CRAMHY_HISTORY", str(tmp_path / "mine"))
    assert place("hy-history") == str(tmp_path / "mine" / "hy-history")
    monkeypatch.setenv("CRAMHY_HISTORY", "")
    assert place("hy-history") is None
    assert History(None).add("(a)")
