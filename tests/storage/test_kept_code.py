"""Code that is kept is used only if it is ours and undamaged; ``marshal`` sees no byte before that is known."""

from __future__ import annotations

import hashlib
import marshal
import os
import stat
import sys
from pathlib import Path

import pytest
from systems import posix

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages import compiler_stamp
from cramhy_runtime.languages.commonlisp.systems import program_files
from cramhy_runtime.languages.commonlisp.systems import loader
from cramhy_runtime.repl.session import Session
from cramhy_runtime.storage import kept_code, kept_files
from cramhy_runtime.storage.checksummed_code import Unusable, sealed, unsealed
from cramhy_runtime.storage.kept_files import kept_path

root = pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can give files away")
LINE, LABEL = b"# a test\n", "0" * 64


@pytest.fixture
def session(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    tmp_path.chmod(0o755)
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


@pytest.fixture
def read(monkeypatch):
    """The bytes that ``marshal`` was given, but for those of modules of Python, which are no ``bytes``."""
    given, loads = [], marshal.loads
    monkeypatch.setattr(marshal, "loads", lambda data: (given.append(data) if data.__class__ is bytes else None, loads(data))[1])
    return given


@pytest.fixture
def kept(session, tmp_path, read):
    """A file with kept code: (source, kept file)."""
    source = tmp_path / "x.lisp"
    source.write_text("(defparameter cl-user::*loaded* 7)")
    loader.load_file(source)
    read.clear()
    return source, kept_path(source)


def loaded(session):
    return session.evaluate_text("cl-user::*loaded*")


def test_good_code_is_used(session, kept, read):
    loader.load_file(kept[0])
    assert len(read) == 1 and loader.why_not_kept(kept[0]) is None and loaded(session) == [7]


def test_the_fingerprint_of_cramhy_covers_every_folder_of_the_language(monkeypatch):
    seen, scandir = set(), os.scandir
    monkeypatch.setattr(os, "scandir", lambda folder: (seen.add(str(folder)), scandir(folder))[1])
    compiler_stamp.stamp.__wrapped__()
    language = Path(loader.__file__).parents[1]
    assert {str(path.parent) for path in language.rglob("*.py")} <= seen


@pytest.mark.parametrize("place", [0, 5, 25, 60, 100, 150, -1])
def test_a_byte_that_changed_is_seen_before_marshal_sees_it(session, kept, read, place):
    data = bytearray(kept[1].read_bytes())
    data[place] ^= 1
    kept[1].write_bytes(data)
    loader.load_file(kept[0])
    assert not read and loaded(session) == [7]
    assert loader.why_not_kept(kept[0]).kind in ("damaged", "foreign")
    loader.load_file(kept[0])
    assert len(read) == 1  # and it was made anew


@pytest.mark.parametrize("length", [0, 1, 20, 52, 115, 116, 117, 200])
def test_a_file_that_was_cut_off_is_made_anew(session, kept, read, length):
    kept[1].write_bytes(kept[1].read_bytes()[:length])
    loader.load_file(kept[0])
    assert not read and loaded(session) == [7]


def test_code_of_another_text_is_not_read(session, kept, read):
    kept[0].write_text("(defparameter cl-user::*loaded* 8)")
    loader.load_file(kept[0])
    assert not read and loaded(session) == [8]


def test_code_is_used_where_its_source_was_moved_to_and_knows_where_that_is(session, kept, read):
    kept[0].write_text("(defparameter cl-user::*loaded* 7)\n\n(defun cl-user::fails (x)\n  (mapcar (lambda (y) (+ y :a)) x))")
    loader.load_file(kept[0])
    read.clear()
    there = kept[0].parent / "moved"
    kept[0].parent.rename(there.parent.with_name("another"))
    source = there.parent.with_name("another") / "x.lisp"
    for _ in range(2):
        loader.load_file(source)
        assert loader.why_not_kept(source) is None and loaded(session) == [7]
        with pytest.raises(conditions.Condition) as caught:
            session.evaluate_text("(cl-user::fails '(1))")
        assert caught.value.position[:2] == (str(source), 4)
    assert len(read) == 2
    made_in, _ = marshal.loads(unsealed(kept_path(source), kept_code.FIRST_LINE, loader._fingerprint(source, source.read_text())))
    assert made_in == str(source), "so that the next load has nothing to change"


def test_what_the_wheel_brings_is_used_where_the_user_cannot_write(session, kept, read, monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    access = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: access(path, mode) and not (mode == os.W_OK and "cache" not in Path(path).parts))
    assert kept_path(kept[0]).parent == tmp_path / "cache" / "cramhy"
    loader.load_file(kept[0])
    assert len(read) == 1 and loader.why_not_kept(kept[0]) is None and loaded(session) == [7]
    kept[1].write_bytes(kept[1].read_bytes()[:-3])  # the folder cannot be written to, so that stays
    for reads in (1, 2):
        loader.load_file(kept[0])
        assert len(read) == reads and loaded(session) == [7]
    assert kept_path(kept[0]).is_file()


@pytest.mark.parametrize("library", ["alexandria", "cram-location-costmap"])
def test_code_of_a_library_of_ours_is_kept_in_the_users_cache(session, monkeypatch, tmp_path, library):
    """Nobody finds files in a clone of cramhy that its sources do not have."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    source = next((Path(kept_files.__file__).parents[1] / "libraries" / library).rglob("*.lisp"))
    assert kept_path(source).parent == tmp_path / "cache" / "cramhy"
    assert kept_path(source).name.endswith(f"-{source.name}.{sys.implementation.cache_tag}.cramhy")


def test_what_a_wheel_brings_of_ours_is_used_until_the_source_changes(session, read, monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    source = tmp_path / "ours" / "x.lisp"
    source.parent.mkdir(mode=0o755)
    source.write_text("(defparameter cl-user::*loaded* 7)")
    loader.load_file(source)
    monkeypatch.setattr(kept_files._Own, "folders", (f"{source.parent}{os.sep}",))
    loader.load_file(source)
    assert len(read) == 1 and not (tmp_path / "cache").exists()
    source.write_text("(defparameter cl-user::*loaded* 8)")
    loader.load_file(source)
    assert loader.why_not_kept(source).kind == "outdated" and kept_path(source).is_file()
    loader.load_file(source)
    assert len(read) == 2 and loaded(session) == [8]


def test_old_files_leave_the_users_cache_and_others_stay(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    kept_files.drop_old(".cramhy")  # there is no folder
    (tmp_path / "cramhy").mkdir()
    for name, age in (("a.cramhy", 0), ("b.cramhy", kept_files.OLD - 1), ("c.cramhy", kept_files.OLD + 1), ("history", kept_files.OLD + 1)):
        (tmp_path / "cramhy" / name).write_text(name)
        os.utime(tmp_path / "cramhy" / name, (2e9 - age, 2e9 - age))
    kept_files.drop_old(".cramhy")
    assert sorted(os.listdir(tmp_path / "cramhy")) == ["a.cramhy", "b.cramhy", "history"]


@pytest.fixture
def compiling(tmp_path, monkeypatch):
    """A folder that stands for what compiles; `stamp` of it."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    (tmp_path / "compiler").mkdir()
    (tmp_path / "compiler").chmod(0o755)
    (tmp_path / "compiler" / "a.py").write_text("1")
    monkeypatch.setattr(compiler_stamp, "_compiling_folders", lambda: [tmp_path / "compiler"])
    monkeypatch.setattr(compiler_stamp, "__file__", str(tmp_path / "compiler" / "loader.py"))
    return tmp_path / "compiler", compiler_stamp.stamp.__wrapped__


def test_the_fingerprint_covers_all_folders_of_the_compiler():
    """A folder in the compiler's folder, too, in whichever depth."""
    compiler = Path(loader.__file__).parents[1] / "compiler"
    assert {path.parent for path in compiler.rglob("*.py")} <= set(compiler_stamp._compiling_folders())


def test_the_fingerprint_of_cramhy_is_that_of_its_content(compiling, tmp_path, monkeypatch):
    folder, stamp = compiling
    first = stamp()
    os.utime(folder / "a.py", (1e9, 1e9))
    assert stamp() == first
    (folder / "a.py").write_text("2")
    changed = stamp()
    assert changed != first
    (folder / "b.hy").write_text("2")
    assert stamp() not in (first, changed)
    (folder / "b.hy").unlink()
    (folder / "notes.txt").write_text("this compiles nothing")
    assert stamp() == changed
    (tmp_path / "elsewhere").mkdir()
    folder.rename(tmp_path / "elsewhere" / "compiler")
    monkeypatch.setattr(compiler_stamp, "_compiling_folders", lambda: [tmp_path / "elsewhere" / "compiler"])
    assert stamp() == changed


@pytest.mark.parametrize("spoil", [lambda data: data[:40], lambda data: b"", lambda data: b"# something else\n" + data])
def test_a_fingerprint_that_was_kept_and_is_damaged_is_made_anew(compiling, spoil):
    folder, stamp = compiling
    first, place = stamp(), kept_path(folder / "stamp")
    good = place.read_bytes()
    place.write_bytes(spoil(good))
    assert stamp() == first and place.read_bytes() == good


def evil(path):
    """A file of code that would be valid, but for its owner."""
    path.write_bytes(sealed(kept_code.FIRST_LINE, LABEL, marshal.dumps([compile("1/0", "evil", "exec")])))


def owned_by_another(source, kept):
    os.chown(kept, 12345, -1)
    return f"{kept} belongs to another user (number 12345)"


def writable_by_all(source, kept):
    kept.chmod(0o666)
    return f"{kept} can be written to by everybody"


def a_link(source, kept):
    evil(source.parent / "evil")
    kept.unlink()
    kept.symlink_to(source.parent / "evil")
    return f"{kept} cannot be read: Too many levels of symbolic links"


def a_pipe(source, kept):
    kept.unlink()
    os.mkfifo(kept)
    return f"{kept} is not a file"


@root
@pytest.mark.parametrize("spoil", [owned_by_another, writable_by_all, a_link, a_pipe])
def test_a_file_that_others_may_have_written_is_not_read(session, kept, read, capsys, spoil):
    source, path = kept
    why = spoil(source, path)
    session.evaluate_text(f'(load "{source}" :verbose t)')
    assert not read and loaded(session) == [7]
    assert str(loader.why_not_kept(source)) == why
    told = capsys.readouterr().out
    assert f";; compiled again: {why}" in told or loader.why_not_kept(source).kind == "unreadable"
    if (source.parent / "evil").exists():
        assert b"evil" in (source.parent / "evil").read_bytes()  # nothing was written through the link's name


@root
@pytest.mark.parametrize(
    "spoil",
    [lambda folder: os.chown(folder, 12345, -1), lambda folder: folder.chmod(0o777)],
    ids=["of another user", "writable by everybody"],
)
def test_a_folder_that_others_may_write_to_is_not_used(session, kept, read, monkeypatch, tmp_path, spoil):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    source, path = kept
    before = path.read_bytes()
    spoil(path.parent)
    loader.load_file(source)
    assert not read and loaded(session) == [7]
    own = kept_path(source)
    assert own.parent == tmp_path / "cache" / "cramhy" and own.exists() and path.read_bytes() == before
    loader.load_file(source)
    assert len(read) == 1
    spoil(own.parent)
    loader.load_file(source)
    assert len(read) == 1 and loader.why_not_kept(source).kind == "distrusted"


@posix
@pytest.mark.parametrize("mask", [0, 0o002, 0o022, 0o077])
def test_kept_code_is_ours_alone_to_write_whatever_the_umask_is(session, tmp_path, read, mask):
    before = os.umask(mask)
    try:
        source = tmp_path / "x.lisp"
        source.write_text("(defparameter cl-user::*loaded* 7)")
        loader.load_file(source)
    finally:
        os.umask(before)
    path = kept_path(source)
    assert not (path.stat().st_mode | path.parent.stat().st_mode) & (stat.S_IWOTH | stat.S_IWGRP)
    loader.load_file(source)
    assert len(read) == 1


def test_temporary_names_cannot_be_foretold(session, tmp_path, monkeypatch):
    seen, original = [], os.open
    monkeypatch.setattr(
        os,
        "open",
        lambda path, flags, *more, **options: (seen.append((os.fspath(path), flags)), original(path, flags, *more, **options))[1],
    )
    for number in range(3):
        (tmp_path / "x.lisp").write_text(f"(defparameter cl-user::*loaded* {number})")
        loader.load_file(tmp_path / "x.lisp")
    made = [(path, flags) for path, flags in seen if flags & os.O_CREAT and path.startswith(str(tmp_path))]
    assert len({path for path, _ in made}) == 3
    assert all(flags & os.O_EXCL and str(os.getpid()) + "." not in path for path, flags in made)


# ---------------------------------------------------------------------------------------------------------- compiled files


@pytest.fixture
def fasl(session, tmp_path, read):
    (tmp_path / "a.lisp").write_text("(defparameter cl-user::*loaded* 9)")
    session.evaluate_text(f'(compile-file "{tmp_path / "a.lisp"}" :verbose nil)')
    read.clear()
    return tmp_path / "a.fasl"


def refusal(session, path):
    with pytest.raises(conditions.Condition) as caught:
        session.evaluate_text(f'(load "{path}")')
    assert isinstance(caught.value, conditions.FileError)
    return caught.value.report()


def test_a_compiled_file_may_stand_anywhere(session, fasl, tmp_path):
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared").chmod(0o1777)
    (tmp_path / "shared" / "b.fasl").write_bytes(fasl.read_bytes())
    session.evaluate_text(f'(load "{tmp_path / "shared" / "b.fasl"}")')
    assert loaded(session) == [9]


def test_every_damaged_byte_of_a_compiled_file_is_an_error(session, fasl, read):
    whole = fasl.read_bytes()
    for place in [*range(len(program_files.FIRST_WORDS), len(whole), 7), len(whole) - 1]:
        data = bytearray(whole)
        data[place] ^= 0x10
        fasl.write_bytes(data)
        assert refusal(session, fasl).endswith("Compile its source again.")
    for length in range(len(program_files.FIRST_WORDS), len(whole), 11):
        fasl.write_bytes(whole[:length])
        assert refusal(session, fasl).endswith("Compile its source again.")
    assert not read


@root
def test_a_compiled_file_of_another_user_is_refused(session, fasl, read):
    os.chown(fasl, 12345, -1)
    assert refusal(session, fasl) == f"{fasl} belongs to another user (number 12345), so it is not loaded. Compile its source again."
    os.chown(fasl, 0, -1)
    fasl.chmod(0o666)
    assert refusal(session, fasl) == f"{fasl} can be written to by everybody, so it is not loaded. Compile its source again."
    assert not read


def test_a_seal_holds_what_it_says(tmp_path):
    path = tmp_path / "x"
    path.write_bytes(sealed(LINE, LABEL, b"content"))
    assert path.read_bytes() == LINE + hashlib.sha256(LABEL.encode() + b"content").digest() + LABEL.encode() + b"content"
    assert unsealed(path, LINE, LABEL, in_folder=False) == b"content"
    for line, label, kind in ((b"# else\n", LABEL, "foreign"), (LINE, "1" * 64, "outdated")):
        with pytest.raises(Unusable) as caught:
            unsealed(path, line, label, in_folder=False)
        assert caught.value.kind == kind
