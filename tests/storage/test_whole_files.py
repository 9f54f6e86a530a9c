"""Writing a whole file is like opening it and writing to it: links, permissions, owners, devices; the errors too."""

from __future__ import annotations

import errno
import os
import stat
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
from systems import posix

from cramhy_runtime import storage

root = pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can give files away, or be somebody else")


@pytest.fixture
def umask():
    """Sets the umask for a test."""
    before = os.umask(0o022)
    yield os.umask
    os.umask(before)


def test_a_text_is_utf_8_and_bytes_are_bytes(tmp_path):
    storage.write_whole(tmp_path / "x", "Jürgen\n")
    assert (tmp_path / "x").read_bytes() == b"J\xc3\xbcrgen\n"
    storage.write_whole(str(tmp_path / "x"), b"\xff")
    assert (tmp_path / "x").read_bytes() == b"\xff" and os.listdir(tmp_path) == ["x"]


@posix
def test_a_reader_sees_the_old_file_until_the_new_one_is_complete(tmp_path):
    (tmp_path / "x").write_text("old")
    with open(tmp_path / "x") as early:
        with storage.writing(tmp_path / "x") as file:
            file.write(b"new" * 10_000)
            file.flush()
            assert (tmp_path / "x").read_text() == "old"
        assert (tmp_path / "x").read_bytes() == b"new" * 10_000
        assert early.read() == "old"  # and to the end, if it began before


@pytest.mark.parametrize("jump", [ValueError("mine"), KeyboardInterrupt(), GeneratorExit()], ids=lambda jump: type(jump).__name__)
def test_a_jump_out_of_the_body_leaves_the_old_file(tmp_path, jump):
    (tmp_path / "x").write_text("old")
    with pytest.raises(type(jump)), storage.writing(tmp_path / "x") as file:
        file.write(b"new")
        raise jump
    assert os.listdir(tmp_path) == ["x"] and (tmp_path / "x").read_text() == "old"


@posix
@pytest.mark.parametrize("mask, mode", [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664), (0, 0o666)])
def test_a_new_file_has_the_usual_permissions(tmp_path, umask, mask, mode):
    umask(mask)
    storage.write_whole(tmp_path / "x", "x")
    open(tmp_path / "y", "w").close()
    assert (tmp_path / "x").stat().st_mode == (tmp_path / "y").stat().st_mode and (tmp_path / "x").stat().st_mode & 0o777 == mode


@posix
@pytest.mark.parametrize("mode", [0o600, 0o640, 0o755, 0o666])
def test_a_file_that_is_replaced_keeps_its_permissions(tmp_path, umask, mode):
    (tmp_path / "x").write_text("old")
    (tmp_path / "x").chmod(mode)
    with storage.writing(tmp_path / "x") as file:
        (part,) = (path for path in tmp_path.iterdir() if path.name != "x")
        assert part.stat().st_mode & 0o777 & ~mode == 0  # a secret is one while it is written, too
        file.write(b"new")
    assert (tmp_path / "x").stat().st_mode & 0o777 == mode


@pytest.mark.parametrize("there", ["a file", pytest.param("a link", marks=posix), pytest.param("a link to nothing", marks=posix)])
def test_a_new_file_does_not_replace_what_is_there(tmp_path, there):
    (tmp_path / "other").write_text("old")
    if there == "a file":
        (tmp_path / "x").write_text("old")
    else:
        (tmp_path / "x").symlink_to(tmp_path / ("other" if there == "a link" else "nothing"))
    with pytest.raises(FileExistsError) as told:
        storage.write_new(tmp_path / "x", b"new", 0o600)
    assert told.value.filename == str(tmp_path / "x")
    assert sorted(os.listdir(tmp_path)) == ["other", "x"] and (tmp_path / "other").read_text() == "old"


def test_of_those_that_make_a_new_file_at_once_one_succeeds_and_no_reader_sees_half_of_it(tmp_path):
    def write(number):
        try:
            storage.write_new(tmp_path / "x", b"%d" % number * 100_000, 0o600)
        except FileExistsError:
            number = None
        return number, len((tmp_path / "x").read_bytes())

    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(write, range(8)))
    assert [number for number, _ in found].count(None) == 7 and {size for _, size in found} == {100_000}
    assert os.listdir(tmp_path) == ["x"]


@root
def test_a_file_that_is_replaced_keeps_its_owner(tmp_path):
    (tmp_path / "x").write_text("old")
    os.chown(tmp_path / "x", 12345, 23456)
    storage.write_whole(tmp_path / "x", "new")
    status = (tmp_path / "x").stat()
    assert (status.st_uid, status.st_gid, (tmp_path / "x").read_text()) == (12345, 23456, "new")


@posix
def test_a_link_is_followed(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "x").write_text("old")
    (tmp_path / "link").symlink_to("there/x")
    (tmp_path / "chain").symlink_to("link")
    storage.write_whole(tmp_path / "chain", "new")
    assert (tmp_path / "chain").is_symlink() and (tmp_path / "link").is_symlink() and (tmp_path / "there" / "x").read_text() == "new"
    assert os.listdir(tmp_path / "there") == ["x"]


@posix
def test_a_link_to_nothing_makes_what_it_names(tmp_path):
    (tmp_path / "link").symlink_to("x")
    storage.write_whole(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink() and (tmp_path / "x").read_text() == "new"


@pytest.mark.parametrize(
    "name, number, said",
    [
        ("no/x", errno.ENOENT, "No such file or directory. Make its folder first, or choose another one."),
        ("folder", errno.EISDIR, "Is a directory. Choose the name of a file."),
        ("x/", errno.EISDIR, "Is a directory. Choose the name of a file."),
        ("file/x", errno.ENOTDIR, "Not a directory. Choose a name in a folder."),
        ("ring", errno.ELOOP, "Too many levels of symbolic links. Remove the link, or choose another name."),
        ("n" * 300, errno.ENAMETOOLONG, "File name too long. Choose a shorter name."),
        ("", errno.ENOENT, "No such file or directory. Make its folder first, or choose another one."),
    ],
)
@posix
def test_errors_name_the_file_as_the_user_does_and_what_to_try(tmp_path, monkeypatch, name, number, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("")
    (tmp_path / "ring").symlink_to("ring")
    before = sorted(os.listdir(tmp_path))
    with pytest.raises(OSError) as caught:
        storage.write_whole(name, "new")
    assert (caught.value.errno, caught.value.filename, storage.why(caught.value)) == (number, name, said)
    assert sorted(os.listdir(tmp_path)) == before


@posix
@pytest.mark.parametrize("name", ["n" * 255, "ü" * 127, os.fsdecode(b"\xff" * 200), "a b\nc", ".x", "-x", "x.cramhy-part"])
def test_every_name_that_a_file_may_have(tmp_path, name):
    for text in ("old", "new"):
        storage.write_whole(tmp_path / name, text)
        assert (tmp_path / name).read_text() == text
    assert os.listdir(tmp_path) == [name]


@posix
def test_a_pipe_is_written_to(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    got = []
    reader = threading.Thread(target=lambda: got.append((tmp_path / "pipe").read_text()))
    reader.start()
    storage.write_whole(tmp_path / "pipe", "new")
    reader.join(30)
    assert got == ["new"] and stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")
def test_a_device_is_written_to(tmp_path):
    with pytest.raises(OSError) as caught:
        storage.write_whole("/dev/full", "new")
    assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, "/dev/full")
    (tmp_path / "full").symlink_to("/dev/full")
    with pytest.raises(OSError):
        storage.write_whole(tmp_path / "full", "new")
    storage.write_whole(os.devnull, "new")
    assert stat.S_ISCHR(os.stat("/dev/full").st_mode) and stat.S_ISCHR(os.stat(os.devnull).st_mode)


@pytest.mark.skipif(not os.path.exists("/dev/stdout"), reason="needs /dev/stdout")
def test_standard_output_is_written_to_also_when_it_is_a_file(tmp_path):
    program = "from cramhy_runtime import storage; storage.write_whole('/dev/stdout', 'new')"
    with open(tmp_path / "x", "w+") as file:
        subprocess.run([sys.executable, "-c", program], stdout=file, check=True)
        file.seek(0)
        assert file.read() == "new"
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True).stdout == "new"


AS_NOBODY = """
import os, sys
from cramhy_runtime import storage
os.setgid(65534); os.setuid(65534)
for path in sys.argv[1:]:
    try:
        storage.write_whole(path, "new")
    except OSError as problem:
        print(f"{problem.filename}: {storage.why(problem)}")
"""


@root
def test_what_may_not_be_written_stays_as_it_is(tmp_path):
    for folder in (tmp_path, *list(tmp_path.parents)[:3]):
        folder.chmod(0o755)
    mine = tmp_path / "nobodys"
    mine.mkdir()
    os.chown(mine, 65534, 65534)
    (mine / "read-only").write_text("old")
    (mine / "read-only").chmod(0o444)
    (tmp_path / "roots").write_text("old")
    done = subprocess.run(
        [sys.executable, "-c", AS_NOBODY, mine / "read-only", tmp_path / "roots", tmp_path / "new", mine / "good"],
        capture_output=True,
        text=True,
        cwd="/",
    )
    why = "Permission denied. Choose a file and a folder that you may write to."
    refused = (mine / "read-only", tmp_path / "roots", tmp_path / "new")
    assert done.stdout.splitlines() == [f"{path}: {why}" for path in refused], done.stderr
    assert (mine / "read-only").read_text() == (tmp_path / "roots").read_text() == "old" and (mine / "good").read_text() == "new"
    assert sorted(os.listdir(mine)) == ["good", "read-only"] and sorted(os.listdir(tmp_path)) == ["nobodys", "roots"]


def test_two_write_the_same_file_and_one_of_them_wins(tmp_path):
    with storage.writing(tmp_path / "x") as one, storage.writing(tmp_path / "x") as other:
        one.write(b"one" * 9000)
        other.write(b"other" * 9000)
    assert (tmp_path / "x").read_bytes() in (b"one" * 9000, b"other" * 9000) and os.listdir(tmp_path) == ["x"]


@pytest.mark.parametrize(
    ("number", "said"),
    [
        (32, "in use. Close the program that has it open, or choose another name."),
        (123, 'in use. Choose a name without < > : " | ? and *.'),
        (5, "in use. Choose a file and a folder that you may write to."),
    ],
)
def test_what_windows_says_by_numbers_of_its_own(number, said):
    problem = OSError(errno.EACCES, "in use")
    problem.winerror = number
    assert storage.why(problem) == said
