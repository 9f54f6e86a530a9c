"""Folders that the user may not look at lie on the way of every search: for systems, packages, and definitions of messages.

A real process without the rights of root meets real links into such a folder; then every call of the system fails once, with each error.
"""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from systems import IS_POSIX

from cramhy_runtime.cli import workspace
from cramhy_runtime.ros import search_folders
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.ros import definition_files

NOBODY = 65534


def without_the_rights_of_root():
    """The words before a command that take root's right to enter every folder; none for other users."""
    if os.getuid():
        return []
    if shutil.which("setpriv") is None:
        pytest.skip("root enters every folder, and setpriv, which takes that right, is not installed")
    return ["setpriv", "--bounding-set", "-dac_override,-dac_read_search", "--"]


@pytest.fixture
def workspace_with_links(tmp_path):
    """A workspace with a package and a system, between links into a folder of somebody else."""
    if not IS_POSIX:
        pytest.skip("folders are closed by the modes of POSIX")
    closed = tmp_path / "closed"
    for name in ("msg", "a_package/msg"):
        (closed / name).mkdir(parents=True)
    for name in ("a.asd", "package.xml", "msg/A.msg"):
        (closed / name).write_text("")
    place = tmp_path / "ws"
    (place / "mine" / "msg").mkdir(parents=True)
    (place / "mine" / "msg" / "Mine.msg").write_text("int32 x\n")
    (place / "mine" / "package.xml").write_text("<package><name>mine</name></package>")
    (place / "mine" / "mine.asd").write_text('(defsystem "mine")')
    for link, target in (("a_link", "a_package"), ("a.asd", "a.asd"), ("package.xml", "package.xml"), ("z_link", "msg")):
        (place / "mine" / "below").mkdir(exist_ok=True)
        (place / "mine" / "below" / link).symlink_to(closed / target)
        if link not in ("package.xml",):
            (place / link).symlink_to(closed / target)
    (place / "circle").symlink_to(place / "circle")
    (place / "stranger" / "msg").mkdir(parents=True)
    (place / "stranger" / "package.xml").symlink_to(closed / "package.xml")
    if os.getuid():
        closed.chmod(0)
    else:
        closed.chmod(0o700)
        os.chown(closed, NOBODY, NOBODY)
    yield place
    closed.chmod(0o700)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("form, answer", [
    ('(roslisp:start-ros-node "x")', "Node startup complete"),
    ('(make-instance (quote mine-msg:mine) :x 7)', "MINE"),
    ('(asdf:load-system "mine")', "T"),
    ('(asdf:load-system "nowhere")', "nowhere"),
    ('(ros-load:load-system "mine" "mine")', "T"),
    ('(roslisp:make-msg "nowhere_msgs/A")', "nowhere_msgs"),
    ('(directory "*/")', "stranger"),
    ('(directory "**/*.asd")', "mine.asd"),
])  # fmt: skip
def test_a_session_among_closed_folders_starts_and_finds_what_is_open(workspace_with_links, form, answer):
    done = subprocess.run(
        [*without_the_rights_of_root(), sys.executable, "-m", "cramhy_runtime.cli", "repl"],
        input=form,
        text=True,
        capture_output=True,
        cwd=workspace_with_links,
        timeout=120,
        env={**os.environ, "ROS_PACKAGE_PATH": str(workspace_with_links)},
    )
    shown = done.stdout + done.stderr
    assert answer in shown
    assert "ermission" not in shown and "Errno" not in shown and "Traceback" not in shown
    assert done.returncode == 0


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "words, shown",
    [("rospack list", "mine "), ("rosmsg packages", "mine"), ("rosmsg show mine/Mine", "int32 x"), ("rospack find mine", "/mine")],
)
def test_a_tool_among_closed_folders_shows_what_is_open(workspace_with_links, words, shown):
    done = subprocess.run(
        [*without_the_rights_of_root(), sys.executable, "-m", "cramhy_runtime.cli", "ros", *words.split()],
        text=True,
        capture_output=True,
        cwd=workspace_with_links,
        timeout=120,
    )
    assert shown in done.stdout, done
    assert done.stderr == "" and done.returncode == 0


def test_a_definition_that_may_not_be_read_is_named(workspace_with_links):
    closed = workspace_with_links / "mine" / "msg" / "Other.msg"
    closed.symlink_to(workspace_with_links.parent / "closed" / "msg" / "A.msg")
    done = subprocess.run(
        [*without_the_rights_of_root(), sys.executable, "-m", "cramhy_runtime.cli", "repl"],
        text=True,
        input='(roslisp:make-msg "mine/Mine")',
        capture_output=True,
        cwd=workspace_with_links,
        timeout=120,
    )
    assert f"{closed} cannot be read: Permission denied." in done.stdout + done.stderr
    assert "Make it readable for this user, or remove it." in done.stdout + done.stderr


# ---------------------------------------------------------------------------------------------------------- fault injection

ERRORS = [errno.EACCES, errno.EPERM, errno.ELOOP, errno.EIO, errno.ESTALE, errno.ENOTCONN, errno.ENAMETOOLONG]
SEARCHES = [
    search_folders.search_folders,
    definition_files.known_packages,
    lambda: definition_files.package_folder("nowhere"),
    lambda: systems.find_asd("nowhere"),
    lambda: systems.find_package_folder("nowhere"),
    systems.known_systems,
    workspace.packages,
]


@pytest.mark.soak
@pytest.mark.parametrize("search", SEARCHES)
@pytest.mark.parametrize("number", ERRORS)
def test_whichever_look_at_a_file_fails_the_search_goes_on(tmp_path, monkeypatch, search, number):
    for name in ("a/msg", "b/src/c/msg", "d"):
        (tmp_path / name).mkdir(parents=True)
    for name in ("a/package.xml", "d/d.asd", "b/src/c/package.xml"):
        (tmp_path / name).write_text("<name>a</name>")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    looks = Looks(monkeypatch, number, str(tmp_path))
    looks.fail_at = None
    search()
    assert looks.count
    for at in range(looks.count):
        looks.count, looks.fail_at = 0, at
        search()  # it raises nothing


class Listing(list):
    """What `os.scandir` gives: `pathlib` enters it as a context."""

    def __enter__(self):
        return iter(self)

    def __exit__(self, *_):
        pass


class Looks:
    """Counts the looks at files below a folder, and lets the one with the number ``fail_at`` fail with an error of the system."""

    def __init__(self, monkeypatch, number, below):
        self.count, self.fail_at, self.number, self.below = 0, None, number, below
        stat, scandir = os.stat, os.scandir

        def look(path):
            if os.fspath(path).startswith(self.below):
                self.count += 1
                if self.count - 1 == self.fail_at:
                    raise OSError(self.number, os.strerror(self.number), os.fspath(path))

        class Entry:
            def __init__(self, entry):
                self.entry, self.name, self.path = entry, entry.name, entry.path

            def __fspath__(self):
                return self.path

            def is_dir(self):
                look(self.path)
                return self.entry.is_dir()

            def is_file(self):
                look(self.path)
                return self.entry.is_file()

            def is_symlink(self):
                look(self.path)
                return self.entry.is_symlink()

        def listed(path="."):
            if not os.fspath(path).startswith(self.below):
                return scandir(path)
            look(path)
            return Listing(Entry(entry) for entry in scandir(path))

        def looked(path, **keywords):
            if isinstance(path, (str, Path)):
                look(path)
            return stat(path, **keywords)

        monkeypatch.setattr(os, "stat", looked)
        monkeypatch.setattr(search_folders.os, "scandir", listed)
