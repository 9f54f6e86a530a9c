"""Disks that are really full: a small tmpfs, a small ext4 in a file, a limit on the size of files. Driven by the command line."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest
from systems import has_module

pytestmark = pytest.mark.soak

RUN = [sys.executable, "-m", "cramhy_runtime.cli", "run", "--time", "virtual"]
DRIVE = '(roslisp:start-ros-node "n") (dotimes (i 20) (turtlesim:press :up) (turtlesim:press :left) (sleep 1))'
FULL = "No space left on device. Make room on that disk, or choose another place."


def mounted(folder, *arguments):
    """Mount something there, or skip the test where that is not allowed."""
    done = subprocess.run(["mount", *arguments, folder], capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"nothing can be mounted here: {done.stderr.strip()}")


@pytest.fixture(params=["tmpfs", "ext4"])
def disk(request, tmp_path):
    """A folder on a disk of its own, of 64 KiB or of 256 KiB, of which 48 KiB or less are free."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        pytest.skip("only root may mount")
    folder = tmp_path / "disk"
    folder.mkdir()
    if request.param == "tmpfs":
        mounted(folder, "-t", "tmpfs", "-o", "size=64k", "tmpfs")
    else:
        if not shutil.which("mkfs.ext4"):
            pytest.skip("there is no mkfs.ext4")
        image = tmp_path / "image"
        image.write_bytes(bytes(256 * 1024))
        subprocess.run(["mkfs.ext4", "-q", "-O", "^has_journal", "-m", "0", image], check=True, capture_output=True)
        mounted(folder, "-o", "loop", image)
    yield folder
    subprocess.run(["umount", "-l", folder], check=True)


def fill(disk, leave):
    """Fill the disk but for ``leave`` bytes."""
    with open(disk / "ballast", "wb", buffering=0) as file:
        try:
            while True:
                file.write(bytes(4096))
        except OSError:
            pass
        file.truncate(max(0, file.tell() - leave))


def cramhy(folder, *words, program=DRIVE, **options):
    (folder.parent / "p.lisp").write_text(program)
    return subprocess.run([*RUN, folder.parent / "p.lisp", *words], capture_output=True, text=True, cwd=folder.parent, **options)


@pytest.mark.parametrize("ending", ["png", "svg", "gif", "replay.svg"])
def test_a_picture_on_a_full_disk(disk, ending):
    place = disk / f"x.{ending}"
    place.write_text("old")
    fill(disk, 0)
    done = cramhy(disk, "--picture", str(place))
    assert done.returncode == 1 and f"The picture {place} cannot be written: {FULL}" in " ".join(done.stderr.split())
    assert place.read_text() == "old" and {path.name for path in disk.iterdir()} - {"lost+found"} == {place.name, "ballast"}


@pytest.mark.parametrize("before", [True, False], ids=["replaced", "new"])
def test_a_recording_on_a_disk_that_becomes_full(disk, before):
    pytest.importorskip("mcap")
    from cramhy_runtime import chronicle

    place = disk / "x.mcap"
    if before:
        done = cramhy(disk, "--record", str(place), program='(roslisp:start-ros-node "n")')
        assert (done.returncode, done.stderr) == (0, "")
    older = place.read_bytes() if before else None
    fill(disk, 16384)
    done = cramhy(disk, "--record", str(place), program=DRIVE.replace("20", "200") + '(print "the plan went on")')
    told = " ".join(done.stderr.split())
    assert done.returncode == 0 and "the plan went on" in done.stdout
    assert told.count(f"The recording {place} ends here: {FULL}") == 1 and told.endswith("The plan goes on.")
    if before:
        assert place.read_bytes() == older and f"What it has is in {disk / 'x.recovered.mcap'}" in told
    found = chronicle.read(disk / "x.recovered.mcap" if before else place)
    assert found.cut and len(list(found.messages())) > 20
    assert not [path for path in disk.iterdir() if path.name.startswith(".")]


def test_lisp_on_a_full_disk(disk):
    (disk / "x").write_text("old")
    (disk / "a.fasl").write_text("old")
    (disk.parent / "a.lisp").write_text("(defun answer () 42)" + "(defun f (x) (* x x))" * 400)
    fill(disk, 0)
    done = cramhy(
        disk,
        program=f"""
(defun try (function)
  (handler-case (funcall function)
    (file-error (e) (format t "~a|~a~%" (file-error-pathname e) (substitute #\\Space #\\Newline (princ-to-string e))))))
(try (lambda () (with-open-file (s "{disk}/x" :direction :output :if-exists :supersede) (dotimes (i 90000) (write-line "new" s)))))
(try (lambda () (with-open-file (s "{disk}/y" :direction :output) (dotimes (i 90000) (write-line "new" s)))))
(try (lambda () (compile-file "a.lisp" :output-file "{disk}/a.fasl" :verbose nil)))
(try (lambda () (load "{disk.parent}/a.lisp")))
(print (answer))
""",
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0].startswith(f"{disk}/x|couldn't write to #<") and lines[0].endswith(FULL)
    assert lines[1].startswith(f"{disk}/y|couldn't write to #<") and lines[1].endswith(FULL)
    assert lines[2] == f"{disk}/a.fasl|Cannot write the compiled file {disk}/a.fasl: {FULL}"
    assert "42" in done.stdout
    assert (disk / "x").read_text() == (disk / "a.fasl").read_text() == "old"
    assert {path.name for path in disk.iterdir()} - {"lost+found"} == {"x", "a.fasl", "ballast"}


def test_kept_code_on_a_full_disk_is_done_without(disk):
    (disk / "s.lisp").write_text("(defun answer () 42)")
    fill(disk, 0)
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    for _ in range(2):
        done = cramhy(disk, program=f'(load "{disk}/s.lisp") (print (answer))', env=environment)
        assert (done.returncode, done.stdout.split(), done.stderr) == (0, ["42"], "")
    assert not [path for path in disk.rglob("*") if path.is_file() and path.name not in ("s.lisp", "ballast")]


@pytest.mark.skipif(not has_module("resource"), reason="this system has no such limits")
def test_a_limit_on_the_size_of_files_is_an_error_and_not_the_end(tmp_path):
    """SIGXFSZ ends a process that does not expect it."""
    (tmp_path / "x.png").write_text("old")
    (tmp_path / "p.lisp").write_text(
        DRIVE
        + """
(handler-case (with-open-file (s "y" :direction :output) (dotimes (i 9000) (write-line "many words" s)))
  (file-error (e) (format t "~a~%" e)))"""
    )
    limit = "import os, resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)); os.execv(sys.executable, sys.argv[1:])"
    done = subprocess.run([sys.executable, "-c", limit, *RUN, "p.lisp", "--picture", "x.png"], capture_output=True, text=True, cwd=tmp_path)
    why = "File too large. Allow larger files (ulimit -f), or choose another place."
    assert why in " ".join(done.stdout.split()) and f"The picture x.png cannot be written: {why}" in " ".join(done.stderr.split())
    kept = {"p.lisp", "x.png", "__pycache__"}
    assert done.returncode == 1 and {"p.lisp", "x.png"} <= set(os.listdir(tmp_path)) <= kept and (tmp_path / "x.png").read_text() == "old"
