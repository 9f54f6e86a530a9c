"""Every call that touches the disk fails once, in every place, for every kind of file that cramhy writes.

Afterwards the old file is there or the new one is, whole; nothing else is; no number of a file is lost; and the error names the file, the
reason and what to try.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
from pathlib import Path

import pytest

from cramhy_runtime import chronicle, kernel, storage
from cramhy_runtime.chronicle.recordings import RecordingError
from cramhy_runtime.cli import shims, workspace
from cramhy_runtime.lisp_core.conditions import Condition, FileError
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.files.files import lisp_path
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import DEFAULTS, namestring
from cramhy_runtime.languages.commonlisp.systems import loader
from cramhy_runtime.storage.kept_files import kept_path
from cramhy_runtime.repl.session import Session
from cramhy_runtime.ros_tools import local_graph, running
from cramhy_runtime.storage import leftovers
from cramhy_runtime.turtlesim import pictures
from cramhy_runtime.view import page

from .faults import each_failure

REASON = r"(No space left on device|Disk quota exceeded|Input/output error)\. (Make|Remove|The device)"
OLD = b"what was complete before\n"


@pytest.fixture
def session():
    made = Session(time="virtual", seed=1)
    made.package = "CRAM-USER"
    made.evaluate_text('(roslisp:start-ros-node "n") (turtlesim:record) (turtlesim:press :up) (sleep 1)')
    made.evaluate_text("(turtlesim:press :left) (sleep 1)")
    made.evaluate_text("(def-top-level-cram-function fetch () (sleep 1)) (cet:enable-fluent-tracing) (fetch)")
    yield made
    made.evaluate_text("(cet:disable-fluent-tracing)")
    kernel.stop()


@pytest.fixture(autouse=True)
def tidied(monkeypatch):
    monkeypatch.setattr(leftovers, "_tidied", set())


def numbers():
    """The numbers of open files of this process."""
    return len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc/self/fd") else 0


class Refused(Exception):
    """What a program said before it ended."""


def rosparam(session, path):
    said = []
    if running.run(["rosparam", "dump", str(path)], running.Terminal(said.append, said.append, local_graph.HereGraph)):
        raise Refused("".join(said))


def evaluated(text):
    return lambda session, path: session.evaluate_text(text.replace("PATH", str(path)).replace("FOLDER", str(path.parent)))


def opened(how, direction="output"):
    return evaluated(f'(with-open-file (s "PATH" :direction :{direction} :if-exists :{how}) (dotimes (i 3000) (format s "line ~d~%" i)))')


def compiled(session, path):
    source = path.parent / "source.lisp"
    try:
        session.evaluate_text(f'(compile-file "{source}" :output-file "{path}" :verbose nil)')
    finally:
        shutil.rmtree(path.parent / "__pycache__", ignore_errors=True)


def whole(session, path):
    storage.write_whole(path, b"x" * 30_000)


def piecemeal(session, path):
    with storage.writing(path) as file:
        for _ in range(30):
            file.write(b"x" * 1000)


WRITERS = {
    "whole": (whole, "x"),
    "in pieces": (piecemeal, "x"),
    **{ending: (lambda session, path: pictures.save(path), f"x.{ending}") for ending in ("png", "svg", "gif", "replay.svg")},
    "save-picture": (evaluated('(turtlesim:save-picture "PATH")'), "x.png"),
    "rosparam": (rosparam, "x.yaml"),
    "supersede": (opened("supersede"), "x"),
    "io": (opened("supersede", "io"), "x"),
    "delete": (opened("rename-and-delete"), "x"),
    "rename": (opened("rename"), "x"),
    "episode": (evaluated('(cet:save-last-episode-knowledge "PATH" :if-exists :supersede)'), "x.ek"),
    "compile-file": (compiled, "x.fasl"),
}


def text_of(problem):
    return problem.report() if isinstance(problem, Condition) else str(problem)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("kind", WRITERS)
@pytest.mark.parametrize("before", [OLD, None], ids=["replaced", "new"])
def test_the_old_file_is_there_or_the_new_one(session, tmp_path, monkeypatch, kind, before):
    write, name = WRITERS[kind]
    place, folder = tmp_path / name, tmp_path
    (folder / "source.lisp").write_text("(defun answer () 42)")
    write(session, place)
    complete = place.read_bytes()
    assert complete
    beside = {"source.lisp"}
    calls = []
    for disk in each_failure(folder, monkeypatch):
        place.unlink(missing_ok=True)
        (folder / "x.bak").unlink(missing_ok=True)
        if before is not None:
            place.write_bytes(before)
            place.chmod(0o640)
        held, problem = numbers(), None
        try:
            with disk, binding(DEFAULTS, lisp_path(folder)):
                write(session, place)
        except (OSError, Condition, Refused) as caught:
            problem = caught
        calls += disk.called[disk.fails - 1 : disk.fails]
        assert numbers() == held, disk.called
        there = {path.name for path in folder.iterdir()} - beside
        if problem is None:
            assert place.read_bytes() == complete, disk.called  # also where a second way was gone, as without hard links
            assert there == {name} | ({"x.bak"} if kind == "rename" and before is not None else set())
        else:
            assert disk.fired
            assert (place.read_bytes() if place.exists() else None) == before, disk.called
            assert there == ({name} if before is not None else set()), disk.called
            assert "cramhy-part" not in text_of(problem)
            assert str(place) in f"{text_of(problem)} {getattr(problem, 'filename', '')}", text_of(problem)
            if isinstance(problem, Condition):
                assert isinstance(problem, FileError) and namestring(problem.pathname) == str(place)
            if not isinstance(problem, OSError):
                assert re.search(REASON, text_of(problem)), text_of(problem)
        if before is not None and place.exists() and hasattr(os, "fchmod"):
            assert place.stat().st_mode & 0o777 == 0o640
    assert {"open", "write", "close"} <= set(calls) and ("replace" in calls) >= (before is not None), calls


def test_with_rename_the_older_backup_stays_when_the_new_file_fails(session, tmp_path, monkeypatch):
    place, backup = tmp_path / "x", tmp_path / "x.bak"
    for disk in each_failure(tmp_path, monkeypatch):
        place.write_bytes(OLD)
        backup.write_bytes(b"oldest")
        try:
            with disk:
                opened("rename")(session, place)
        except Condition:
            assert (place.read_bytes(), backup.read_bytes()) == (OLD, b"oldest"), disk.called
        else:
            assert place.stat().st_size > 20_000 and backup.read_bytes() == OLD
        assert {path.name for path in tmp_path.iterdir()} == {"x", "x.bak"}, disk.called


def test_kept_code_that_cannot_be_written_is_no_loss_and_no_rubbish(session, tmp_path, monkeypatch):
    source = tmp_path / "x.lisp"
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    for disk in each_failure(tmp_path, monkeypatch):
        source.write_text(f"(defparameter cl-user::*loaded* {disk.fails})")
        shutil.rmtree(tmp_path / "__pycache__", ignore_errors=True)
        with disk:
            loader.load_file(source)
        assert session.evaluate_text("cl-user::*loaded*") == [disk.fails]
        there = {path.name for path in tmp_path.rglob("*") if path.is_file()}
        assert there <= {"x.lisp", kept_path(source).name}, there
        loader.load_file(source)
        assert session.evaluate_text("cl-user::*loaded*") == [disk.fails]


@pytest.mark.soak
def test_shims_are_all_installed_or_none(session, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(shutil, "which", lambda tool: None)
    target = tmp_path / "bin" / "ros"
    for disk in each_failure(tmp_path, monkeypatch, limit=500):
        shutil.rmtree(tmp_path / "bin", ignore_errors=True)
        with disk:
            status = shims.run(str(target))
        told = capsys.readouterr()
        if status:
            assert not (tmp_path / "bin").exists()
            assert told.err.startswith(f"cramhy: the programs cannot be written into {target}: {tmp_path}") and re.search(REASON, told.err)
        else:
            assert {path.name for path in target.iterdir()} == {"cramhy", "roslisp_repl", *shims.TOOLS}
            assert all(os.access(path, os.X_OK) for path in target.iterdir())


def test_a_package_is_made_whole_or_not_at_all(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for disk in each_failure(tmp_path, monkeypatch):
        shutil.rmtree(tmp_path / "cup", ignore_errors=True)
        with disk:
            status = shims.tool("catkin_create_pkg", ["cup", "roslisp"])
        told = capsys.readouterr()
        if status:
            assert not (tmp_path / "cup").exists(), disk.called
            assert told.err.startswith(f"catkin_create_pkg: {tmp_path}/cup") and re.search(REASON, told.err)
        else:
            assert {path.name for path in (tmp_path / "cup").iterdir()} == {"package.xml", "CMakeLists.txt", "src", "include"}


def test_a_list_for_cmake_that_is_there_stays(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cup").mkdir()
    (tmp_path / "cup" / "CMakeLists.txt").write_text("mine")
    assert workspace.catkin_create_pkg(["cup"]) == 1
    assert (tmp_path / "cup" / "CMakeLists.txt").read_text() == "mine" and len(os.listdir(tmp_path / "cup")) == 1
    assert capsys.readouterr().err == f"catkin_create_pkg: {tmp_path / 'cup'} has a CMakeLists.txt already.\n"


def test_a_page_that_cannot_be_written_is_not_shown(tmp_path, monkeypatch):
    shown = []
    monkeypatch.setattr(page, "has_screen", lambda: True)
    monkeypatch.setattr(page, "browse", shown.append)
    for disk in each_failure(tmp_path, monkeypatch):
        page.way(7, tmp_path).unlink(missing_ok=True)
        shown.clear()
        with disk:
            there = page.show("http://127.0.0.1:7/#x", 7, tmp_path)
        assert there == bool(shown) == page.way(7, tmp_path).exists()
        assert len(list(tmp_path.iterdir())) == len(shown)


@pytest.mark.soak
@pytest.mark.parametrize("before", [True, False], ids=["replaced", "new"])
def test_a_recording_costs_its_rest_and_never_an_older_one(session, tmp_path, monkeypatch, capsys, before):
    pytest.importorskip("mcap")
    place, older = tmp_path / "x.mcap", tmp_path.parent / "older.mcap"
    monkeypatch.setattr("cramhy_runtime.chronicle.recorder.FLUSH", 3 * 10**8)
    with chronicle.record(older):
        session.evaluate_text("(turtlesim:press :up) (sleep 1)")
    for disk in each_failure(tmp_path, monkeypatch):
        for path in tmp_path.iterdir():
            path.unlink()
        if before:
            shutil.copy(older, place)
        made, held = None, numbers()
        try:
            with disk:
                made = chronicle.record(place)
        except RecordingError as problem:
            assert str(problem).startswith(f"The recording {place} cannot be written: ") and re.search(REASON, str(problem))
            assert place.exists() == before
        else:
            with disk:
                session.evaluate_text("(turtlesim:press :up) (sleep 2)")
                made.close()
        told = " ".join(capsys.readouterr().err.split())
        assert told.count("ends here: ") == (made is not None and made.problem is not None), (told, disk.called)
        assert numbers() == held
        rest = {path.name for path in tmp_path.iterdir()} - {"x.mcap"}
        if made is None:
            assert not rest
        elif made.problem:
            assert rest == ({"x.recovered.mcap"} if before else set()), disk.called
            assert not before or str(tmp_path / "x.recovered.mcap") in told
            assert chronicle.read(tmp_path / "x.recovered.mcap" if before else place).about
        else:
            assert not rest and chronicle.read(place).cut == "" and place.read_bytes() != older.read_bytes()
        if before and (made is None or made.problem):
            assert place.read_bytes() == older.read_bytes()


def test_a_log_of_a_node_ends_and_its_program_goes_on(session, tmp_path, monkeypatch, capsys):
    if not Path("/dev/full").exists():
        pytest.skip("there is no device that is always full")
    from cramhy_runtime.ros.roslisp import log_file

    log_file.start(Path("/dev/full"))
    session.evaluate_text('(roslisp:ros-info (test) "one") (roslisp:ros-info (test) "two")')
    told = " ".join(capsys.readouterr().err.split())
    assert (
        told.count(
            "The log file /dev/full ends here: No space left on device. Make room on that disk, or choose another place. The "
            "program goes on."
        )
        == 1
    )
