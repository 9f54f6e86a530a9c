"""What a killed process leaves is found by the next start: removed, or recovered if it can be read. What lives is left alone."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

from cramhy_runtime import storage
from cramhy_runtime.storage import leftovers

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="signals and locks of POSIX")

WRITES = """
import sys
from cramhy_runtime import storage
part = storage.{how}
part.file.write(b"half of it" * 5000)
part.file.flush()
print("ready", flush=True)
sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def untidied(monkeypatch):
    monkeypatch.setattr(leftovers, "_tidied", set())


@contextmanager
def writer(how, before=()):
    """A process in the middle of writing, which may be killed."""
    process = subprocess.Popen([*before, sys.executable, "-c", WRITES.format(how=how)], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    try:
        assert process.stdout.readline() == b"ready\n"
        yield process
    finally:
        process.kill()
        process.communicate()


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_what_a_killed_process_left_goes_with_the_next_file_in_that_folder(tmp_path):
    (tmp_path / "x").write_text("old")
    with writer(f"Part({str(tmp_path / 'x')!r})") as process:
        assert len(names(tmp_path)) == 2
        process.send_signal(signal.SIGKILL)
    assert len(names(tmp_path)) == 2 and (tmp_path / "x").read_text() == "old"
    storage.write_whole(tmp_path / "y", "other")
    assert names(tmp_path) == ["x", "y"] and (tmp_path / "x").read_text() == "old"


def test_what_a_living_process_writes_stays(tmp_path):
    with writer(f"Part({str(tmp_path / 'x')!r})"):
        there = names(tmp_path)
        assert storage.tidy(tmp_path) == [] and names(tmp_path) == there != []
    assert storage.tidy(tmp_path) == [] and names(tmp_path) == []


@pytest.mark.skipif(os.geteuid() != 0 if hasattr(os, "geteuid") else True, reason="only root makes another PID namespace")
def test_what_a_process_of_another_container_writes_stays(tmp_path):
    apart = ("unshare", "--pid", "--fork", "--kill-child")
    if subprocess.run([*apart, "true"], capture_output=True).returncode:
        pytest.skip("this machine allows no namespaces")
    with writer(f"Part({str(tmp_path / 'x')!r})", apart):
        there = names(tmp_path)
        assert storage.tidy(tmp_path) == [] and names(tmp_path) == there != []


def test_what_this_process_writes_stays(tmp_path):
    with storage.writing(tmp_path / "x") as file:
        file.write(b"new")
        assert storage.tidy(tmp_path) == []
    assert names(tmp_path) == ["x"]


def test_a_recording_beside_an_older_one_is_recovered_under_a_name_of_its_own(tmp_path):
    (tmp_path / "x.mcap").write_text("older")
    for count in (1, 2):
        with writer(f"growing({str(tmp_path / 'x.mcap')!r})"):
            assert storage.tidy(tmp_path) == []
        storage.write_whole(tmp_path / "y", "this does not touch it, as nobody would hear of it")
        name = "x.recovered.mcap" if count == 1 else "x.recovered-2.mcap"
        assert storage.tidy(tmp_path) == [str(tmp_path / name)]
        assert (tmp_path / name).read_bytes() == b"half of it" * 5000
    assert (tmp_path / "x.mcap").read_text() == "older"
    assert names(tmp_path) == ["x.mcap", "x.recovered-2.mcap", "x.recovered.mcap", "y"]


def test_a_recording_without_an_older_one_has_its_name_already(tmp_path):
    with writer(f"growing({str(tmp_path / 'x.mcap')!r})"):
        assert names(tmp_path) == ["x.mcap"]
        with pytest.raises(OSError) as caught:
            storage.growing(tmp_path / "x.mcap")
        assert storage.why(caught.value) == "Another recording is being written there. Wait until it is done, or choose another name."
    assert storage.tidy(tmp_path) == [] and (tmp_path / "x.mcap").stat().st_size == 50_000


@pytest.mark.parametrize(
    "name",
    [
        "x.cramhy-part",
        ".x.cramhy-part",
        ".x.0123.cramhy-part",
        ".x.0123456789abcdeg.cramhy-part",
        ".x.0123456789abcdef.cramhy-party",
        ".0123456789abcdef.cramhy-part",
    ],
)
def test_files_of_other_names_stay(tmp_path, name):
    (tmp_path / name).write_text("mine")
    assert storage.tidy(tmp_path) == [] and names(tmp_path) == [name]


PLANTED = ".x.0123456789abcdef.cramhy-part"


@pytest.mark.parametrize(
    "plant",
    [lambda path, other: path.symlink_to(other), lambda path, other: os.mkfifo(path), lambda path, other: path.mkdir()],
    ids=["link", "pipe", "folder"],
)
def test_what_somebody_planted_leads_nowhere(tmp_path, plant):
    (tmp_path / "other").write_text("mine")
    plant(tmp_path / PLANTED, tmp_path / "other")
    assert storage.tidy(tmp_path) == []
    assert (tmp_path / "other").read_text() == "mine" and os.path.lexists(tmp_path / PLANTED)


@pytest.mark.skipif(os.geteuid() != 0 if hasattr(os, "geteuid") else True, reason="only root can give files away")
def test_the_leftovers_of_other_users_are_theirs(tmp_path):
    (tmp_path / PLANTED).write_text("")
    os.chown(tmp_path / PLANTED, 12345, -1)
    assert storage.tidy(tmp_path) == [] and names(tmp_path) == [PLANTED]


def test_a_folder_that_is_not_there_holds_nothing(tmp_path):
    assert storage.tidy(tmp_path / "no") == storage.tidy(Path("/proc/1/nothing")) == []


PROGRAM = """
(with-open-file (s "x" :direction :output :if-exists :supersede)
  (format s "new~%") (finish-output s) (format t "READY~%") (finish-output) (read-line))
"""


@pytest.mark.soak
def test_a_lisp_program_that_is_killed_leaves_the_old_file_and_the_next_start_tidies_up(tmp_path):
    (tmp_path / "x").write_text("old")
    (tmp_path / "p.lisp").write_text(PROGRAM)
    (tmp_path / "q.lisp").write_text("(print :done)")
    command = [sys.executable, "-m", "cramhy_runtime.cli", "run", "--no-turtlesim"]
    process = subprocess.Popen([*command, "p.lisp"], cwd=tmp_path, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    while "READY" not in process.stdout.readline():
        assert process.poll() is None
    process.kill()
    process.communicate()
    left = [path for path in tmp_path.iterdir() if path.name.endswith(".cramhy-part")]
    assert len(left) == 1 and left[0].read_text() == "new\n" and (tmp_path / "x").read_text() == "old"
    done = subprocess.run([*command, "q.lisp"], cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "") and "DONE" in done.stdout
    assert not left[0].exists() and (tmp_path / "x").read_text() == "old"


RECORDS = '(roslisp:start-ros-node "n") (turtlesim:press :up) (sleep 20) (format t "READY~%") (finish-output) (read-line)'


@pytest.mark.soak
def test_a_killed_recording_is_recovered_and_told_of_by_the_next_start(tmp_path):
    pytest.importorskip("mcap")
    from cramhy_runtime import chronicle

    (tmp_path / "q.lisp").write_text('(roslisp:start-ros-node "n") (turtlesim:press :up) (sleep 1)')
    (tmp_path / "p.lisp").write_text(RECORDS)
    command = [sys.executable, "-m", "cramhy_runtime.cli", "run", "--time", "virtual"]
    first = subprocess.run([*command, "q.lisp", "--record", "x.mcap"], cwd=tmp_path, capture_output=True, text=True)
    assert (first.returncode, first.stderr) == (0, "")
    older = (tmp_path / "x.mcap").read_bytes()
    process = subprocess.Popen(
        [*command, "p.lisp", "--record", "x.mcap"],
        cwd=tmp_path,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    while "READY" not in process.stdout.readline():
        assert process.poll() is None
    process.kill()
    process.communicate()
    assert (tmp_path / "x.mcap").read_bytes() == older
    again = subprocess.run([*command, "q.lisp"], cwd=tmp_path, capture_output=True, text=True)
    kept = tmp_path / "x.recovered.mcap"
    assert again.stderr == f"; A recording was cut off when its process was killed. It is now {kept}\n"
    found = chronicle.read(kept)
    assert found.cut and found.end > 15 and chronicle.read(tmp_path / "x.mcap").cut == ""
    assert not [path.name for path in tmp_path.iterdir() if path.name.startswith(".")]
