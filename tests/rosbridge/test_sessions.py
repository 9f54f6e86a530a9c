"""How sessions are announced and found, with real processes: a file goes only when its process is surely dead, a session that lives is
announced again, and what a killed one left behind is cleaned up by the next program that looks."""

from __future__ import annotations

import json
import os
import shutil
import signal
import stat
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.rosbridge import processes, sessions
from cramhy_runtime.ros import graph
from processes_of_sessions import SessionProcess, wait_until

LINUX = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="the system says too little of its processes")
UNSHARE = ["unshare", "--pid", "--fork", "--mount-proc", "--kill-child"]
LOOK = "from cramhy_runtime.rosbridge import sessions; print([found.port for found in sessions.living()])"


def folder_of(tmp_path):
    return tmp_path / f"cramhy-{os.getuid()}"


def look(folder, before=(), **environment):
    """What another program finds: the ports of sessions; and what it says on stderr."""
    done = subprocess.run(
        [*before, sys.executable, "-c", LOOK],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "XDG_RUNTIME_DIR": str(folder), **environment},
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout), done.stderr


@pytest.fixture
def start(tmp_path):
    """Starts sessions in processes of their own."""
    made = []

    def begin(folder=tmp_path, **keywords):
        made.append(SessionProcess(folder, **keywords))
        return made[-1]

    yield begin
    for one in made:
        one.end()


@pytest.fixture
def announced(tmp_path):
    """Writes files of sessions that this test makes up, in the folder of this user."""
    folder_of(tmp_path).mkdir(mode=0o700)

    def write(name, text):
        path = folder_of(tmp_path) / name
        path.write_text(text if isinstance(text, str) else json.dumps(text))
        path.chmod(0o600)
        return path

    return write


def made_up(**values):
    """What stands in the file of a session of this very process, with other values."""
    me = processes.own()
    return {
        "host": "127.0.0.1",
        "port": 1,
        "token": "t",
        "pid": me.pid,
        "address": "ws://127.0.0.1:1/t",
        "url": "http://127.0.0.1:1/#t",
        "started": 1,
        "process": me.began,
        "machine": me.machine,
        "boot": me.boot,
        "namespace": me.namespace,
        **values,
    }


# ------------------------------------------------------------------------------------------------------------- the folder


@pytest.mark.soak
def test_the_session_is_found_by_its_file(serve, outside, tmp_path):
    server = serve()
    found = outside(sessions.current)
    assert (found.port, found.token, found.pid, found.address, found.url) == (
        server.port,
        server.token,
        os.getpid(),
        server.address,
        server.url,
    )
    folder = folder_of(tmp_path)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert [stat.S_IMODE(path.stat().st_mode) for path in folder.iterdir()] == [0o600]
    kernel.stop()
    assert sessions.current() is None and list(folder.iterdir()) == []


def test_a_folder_that_others_can_enter_is_not_trusted(tmp_path):
    folder = folder_of(tmp_path)
    folder.mkdir()
    folder.chmod(0o755)
    with pytest.raises(sessions.Unsafe) as caught:
        sessions.current()
    assert str(caught.value) == (
        f"{folder} is not a folder that belongs to this user alone, so no session is announced or looked for "
        f"there. Remove it, or type: chmod 700 {folder}"
    )


@pytest.mark.soak
def test_where_no_session_can_be_announced_nothing_is_looked_for_and_no_server_stays(serve, tmp_path, monkeypatch):
    from cramhy_runtime.rosbridge.server import ServerError, running

    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "file"))
    assert sessions.current() is None
    with pytest.raises(ServerError) as caught:
        serve()
    assert str(caught.value) == (
        f"The server cannot be announced to the other programs of this user. {tmp_path / 'file' / f'cramhy-{os.getuid()}'}, where "
        "sessions are announced, cannot be made: Not a directory. Set XDG_RUNTIME_DIR to a folder of your own."
    )
    assert running() is None and "/rosapi" not in graph.active().nodes


@pytest.mark.soak
def test_a_file_that_others_can_read_is_not_trusted(serve):
    server = serve()
    server.file.chmod(0o644)
    with pytest.raises(sessions.Unsafe) as caught:
        sessions.living()
    assert str(caught.value) == f"{server.file} can be read or written by others than this user, so it is not trusted. Remove it."


@pytest.mark.soak
def test_a_relative_folder_is_ignored_and_that_is_said_once(tmp_path, start):
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    session = start("run", TMPDIR=str(temporary))
    assert session.file.parent == folder_of(temporary) and not Path("run").exists()
    ports, errors = look("run", TMPDIR=str(temporary))
    line = f"; XDG_RUNTIME_DIR is run, a relative path, and is ignored. Sessions are announced below {temporary}.\n"
    assert (ports, errors) == ([session.port], line)
    assert session.end() == line


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 8 KiB; its path and a function that makes it read-only."""
    place = tmp_path / "disk"
    place.mkdir()
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8k,mode=700", "tmpfs", str(place)], capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"no file system can be mounted here: {done.stderr}")
    yield place, lambda: subprocess.run(["mount", "-o", "remount,ro", str(place)], check=True)
    subprocess.run(["umount", "-l", str(place)], check=True)


@pytest.mark.soak
def test_a_full_folder_is_told_in_one_line_and_nothing_is_left(small_disk, start):
    place, _ = small_disk
    folder = folder_of(place)
    folder.mkdir(mode=0o700)
    (place / "fill").write_bytes(b"x" * 8192)
    session = start(place)
    assert session.problem == (
        f"The server cannot be announced to the other programs of this user. A file cannot be written in {folder}, where sessions are "
        "announced: No space left on device. Make room there, or set XDG_RUNTIME_DIR to a folder of your own."
    )
    assert list(folder.iterdir()) == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("there", [True, False], ids=["a folder", "no folder"])
def test_a_folder_that_cannot_be_written_is_told_in_one_line(small_disk, start, there):
    place, make_read_only = small_disk
    if there:
        folder_of(place).mkdir(mode=0o700)
    make_read_only()
    says = (
        f"A file cannot be written in {folder_of(place)}, where sessions are announced: Read-only file system. Make room there, or set"
        if there
        else f"{folder_of(place)}, where sessions are announced, cannot be made: Read-only file system. Set"
    )
    assert start(place).problem == (
        f"The server cannot be announced to the other programs of this user. {says} XDG_RUNTIME_DIR to a folder of your own."
    )


@pytest.mark.soak
def test_a_session_whose_folder_fills_up_goes_on_and_says_once_that_it_cannot_be_found(small_disk, start):
    place, _ = small_disk
    session = start(place)
    session.file.unlink()
    (place / "fill").write_bytes(b"x" * 8192) if not session.file.exists() else None
    from bridge_clients import Wire

    with Wire(session.address) as wire:
        assert wire.call("/clear")["result"]
    if not session.file.exists():  # it may have been quicker than the disk was full
        (place / "fill").unlink()
        wait_until(session.file.exists, "it is announced again when there is room")


# ------------------------------------------------------------------------------------------------------- surely dead or not


@pytest.mark.soak
@LINUX
def test_what_a_killed_session_left_behind_goes_when_another_program_looks(start, tmp_path):
    session, other = start(), start()
    page = session.file.parent / f"page-{session.port}.html"
    page.touch()
    session.kill()  # and nobody has asked how it ended
    assert session.file.exists()
    assert look(tmp_path)[0] == [other.port]
    assert not session.file.exists() and not page.exists() and other.file.exists()


@pytest.mark.soak
@LINUX
def test_what_a_killed_session_left_behind_goes_when_the_next_one_starts(start, tmp_path):
    session = start()
    session.kill()
    me = processes.own()
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    unfinished = [
        session.file.parent / f".session-{session.pid}-{me.began}-{me.place}-abc",
        session.file.parent / f".session-{dead.pid}-1-{me.place}-abc",
    ]
    mine = session.file.parent / f".session-{me.pid}-{me.began}-{me.place}-abc"
    elsewhere = session.file.parent / f".session-{dead.pid}-1-0123456789ab-abc"
    old = session.file.parent / ".session-abcdef"
    for path in (*unfinished, mine, elsewhere, old):
        path.touch(mode=0o600)
    os.utime(old, (1, 1))
    following = start()
    assert set(session.file.parent.iterdir()) == {following.file, mine, elsewhere}


@pytest.mark.soak
@LINUX
def test_a_session_that_is_stopped_keeps_its_file_and_is_found_however_many_look(start, tmp_path):
    session = start()
    session.signal(signal.SIGSTOP)
    for _ in range(3):
        assert look(tmp_path)[0] == [session.port]
    assert session.file.exists()
    session.signal(signal.SIGCONT)
    session.end()
    assert list(session.file.parent.iterdir()) == []


@pytest.fixture
def namespace():
    """The words that start a command in a PID namespace of its own."""
    if shutil.which("unshare") is None or subprocess.run([*UNSHARE, "true"], capture_output=True).returncode:
        pytest.skip("no PID namespace can be made here")
    return UNSHARE


@pytest.mark.soak
@LINUX
def test_a_program_in_another_pid_namespace_leaves_the_file_of_a_living_session(start, tmp_path, namespace):
    session = start()
    assert look(tmp_path, namespace)[0] == [session.port]
    assert session.file.exists()


@pytest.mark.soak
@LINUX
def test_a_session_in_another_pid_namespace_is_found_and_keeps_its_file(start, tmp_path, namespace):
    inside = start(before=namespace)
    assert inside.pid < 100
    outside = start()
    assert look(tmp_path)[0] == [outside.port, inside.port]
    assert look(tmp_path, namespace)[0] == [outside.port, inside.port]
    assert inside.file.exists() and outside.file.exists()
    inside.end()
    assert list(outside.file.parent.iterdir()) == [outside.file]


@pytest.mark.soak
@LINUX
def test_sessions_with_one_number_in_two_namespaces_do_not_take_each_others_file(start, tmp_path, namespace):
    one, other = start(before=namespace), start(before=namespace)
    assert one.pid == other.pid and one.file != other.file
    one.end()
    assert look(tmp_path)[0] == [other.port]


@pytest.mark.soak
@LINUX
def test_a_session_that_was_killed_in_another_namespace_is_not_shown_but_its_file_stays(start, tmp_path, namespace):
    session = start(before=namespace)
    session.kill()
    wait_until(lambda: look(tmp_path)[0] == [], "nobody listens")
    assert session.file.exists()  # nobody can know here whether it is dead


ALIVE = {
    "another machine": {"machine": "elsewhere", "pid": 2**22 + 1},
    "another namespace": {"namespace": "pid:[1]", "pid": 2**22 + 1},
    "no machine": {"machine": "", "pid": 2**22 + 1},
    "no boot": {"boot": "", "pid": 2**22 + 1},
    "no namespace": {"namespace": "", "pid": 2**22 + 1},
    "no start": {"process": "", "pid": 2**22 + 1},
    "this process": {},
    "a field of a later version": {"colour": "red", "pid": os.getpid()},
}
DEAD = {
    "no process of that number": {"pid": 2**22 + 1},
    "a number that is none": {"pid": 10**30},
    "the number has another process": {"process": "1"},
    "before the machine was started": {"boot": "another"},
    "before the machine was started, in a container": {"boot": "another", "namespace": "pid:[1]"},
}


@LINUX
@pytest.mark.parametrize("values", ALIVE.values(), ids=ALIVE)
def test_what_may_be_alive_keeps_its_file_though_nobody_answers(announced, values):
    path = announced("session-1-1.json", made_up(**values))
    assert sessions.living() == [] and path.exists()


@LINUX
@pytest.mark.parametrize("values", DEAD.values(), ids=DEAD)
def test_what_is_surely_dead_goes(announced, values):
    path = announced("session-1-1.json", made_up(**values))
    assert sessions.living() == [] and not path.exists()


@pytest.mark.soak
def test_where_the_system_does_not_tell_every_process_counts_as_alive(announced, monkeypatch):
    monkeypatch.setattr(processes, "own", lambda: processes.Identity(os.getpid(), "machine"))
    path = announced("session-1-1.json", made_up(pid=2**22 + 1, machine="machine", boot="", namespace="", process=""))
    assert sessions.living() == [] and path.exists()


@pytest.mark.parametrize(
    "text",
    ["", "{", "[]", "7", "null", "{}", '{"pid": 1}', json.dumps(made_up(pid="1")), "\0", "[" * 50_000, json.dumps(made_up(port=True))],
)
def test_a_file_in_which_no_session_stands_goes(announced, text):
    path = announced("session-1-1.json", text)
    assert sessions.living() == [] and not path.exists()


@pytest.mark.soak
def test_what_is_no_file_is_left_alone(announced, tmp_path):
    folder = folder_of(tmp_path)
    (folder / "session-1-1.json").symlink_to("/etc/passwd")
    (folder / "session-2-2.json").mkdir()
    kept = announced("something-else.json", "{")
    with pytest.raises(sessions.Unsafe):
        sessions.living()
    sessions.announce(1, "t").close()  # who wants to start a session is not kept from it
    (folder / "session-2-2.json").rmdir()
    os.mkfifo(folder / "session-3-3.json", 0o600)  # opening it would wait for a writer
    with pytest.raises(sessions.Unsafe):
        sessions.living()
    (folder / "session-3-3.json").unlink()
    assert sessions.living() == []
    assert (folder / "session-1-1.json").is_symlink() and kept.exists()


@pytest.mark.soak
def test_the_newest_of_several_is_current(serve, outside, announced):
    server = serve()
    values = json.loads(server.file.read_text())
    announced("session-9-9.json", {**values, "started": values["started"] + 1, "token": "newer"})
    assert [found.token for found in outside(sessions.living)] == ["newer", server.token]
    assert outside(sessions.current).token == "newer"


# ------------------------------------------------------------------------------------------------- announced again, and gone


@pytest.mark.soak
@pytest.mark.parametrize("clock", ["wall", "virtual"])
@pytest.mark.parametrize("gone", ["the file", "the folder", "the file, for another", "the file, for a folder's link"])
def test_a_living_session_is_announced_again(start, tmp_path, gone, clock):
    session = start(time=clock)
    text = session.file.read_text()
    if gone == "the folder":
        shutil.rmtree(session.file.parent)
    else:
        session.file.unlink()
    if gone == "the file, for another":
        other = session.file.parent / "other"
        other.write_text("{")
        other.chmod(0o600)
        os.replace(other, session.file)
    elif gone == "the file, for a folder's link":
        session.file.symlink_to(tmp_path)
    wait_until(lambda: session.file.is_file() and session.file.read_text() == text, "it is announced again")
    assert stat.S_IMODE(session.file.stat().st_mode) == 0o600 and stat.S_IMODE(session.file.parent.stat().st_mode) == 0o700
    assert look(tmp_path)[0] == [session.port]
    assert session.end() == ""
    assert list(session.file.parent.iterdir()) == []


@pytest.mark.soak
def test_a_session_is_announced_again_while_a_plan_computes(serve):
    server = serve()
    kernel.spawn(lambda: kernel.sleep(1e9), name="somebody to hand the baton to")
    server.file.unlink()

    def announced():
        for _ in range(200):
            kernel.checkpoint()
        return server.file.exists()

    wait_until(announced, "it is announced again")


@pytest.mark.soak
def test_it_is_announced_again_where_it_was(serve, tmp_path, monkeypatch):
    server = serve()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "elsewhere"))
    server.file.unlink()
    wait_until(server.file.exists, "it is announced again")
    assert not (tmp_path / "elsewhere").exists()


@pytest.mark.soak
def test_a_session_that_ends_removes_its_own_file_and_no_other(serve, announced):
    server = serve()
    other = announced("session-1-1.json", made_up(machine="elsewhere"))
    path = server.file
    announced(path.name, "of another")
    server.announcement.closed = True  # it would take its place back
    kernel.stop()
    assert path.read_text() == "of another" and other.exists()


@pytest.mark.soak
def test_a_session_that_cannot_be_announced_again_says_so_once(serve, tmp_path, capfd):
    server = serve()
    folder = folder_of(tmp_path)
    shutil.rmtree(folder)
    folder.touch()
    line = (
        f"; Other programs cannot find this session any more. {folder}, where sessions are announced, cannot be made: File exists. "
        "Set XDG_RUNTIME_DIR to a folder of your own.\n"
    )
    told = []

    def said():
        kernel.sleep(0)
        kernel.run_blocking(lambda: None)
        told.append(capfd.readouterr().err)
        return "".join(told)

    wait_until(said, "it says so")
    for _ in range(3):
        server.company.call(server._renew, server.company.loop, True)
    folder.unlink()
    wait_until(server.file.exists, "it is announced again")
    assert said() == line


def test_two_identities_are_one_place_only_if_all_is_known_and_the_same():
    me = processes.Identity(1, "machine", "boot", "pid:[1]", "5")
    assert me.place and me.place == replace(me, pid=2, began="6").place
    assert len({me.place, replace(me, machine="other").place, replace(me, boot="other").place, replace(me, namespace="other").place}) == 4
    assert replace(me, boot="").place == replace(me, machine="").place == ""
