"""A message that asks for an extra names a command that works: for the index, a clone, an address, with the pip of this Python."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

from cramhy_runtime import extras

ROOT = Path(__file__).parents[1]


@pytest.fixture
def installed(monkeypatch):
    """A function that says what pip noted of cramhy's origin: a dictionary, ``None`` for an index, or a text that is not JSON."""

    class Distribution:
        def __init__(self, noted):
            self.noted = noted

        def read_text(self, name):
            assert name == "direct_url.json"
            return self.noted if self.noted is None or isinstance(self.noted, str) else json.dumps(self.noted)

    def installed(noted):
        monkeypatch.setattr(metadata, "distribution", lambda name: Distribution(noted))

    monkeypatch.setattr(extras, "_pip", lambda: "pip")
    return installed


@pytest.mark.parametrize(
    ("noted", "extra", "command"),
    [
        (None, "web", "pip install 'cramhy[web]'"),
        (None, "web,record", "pip install 'cramhy[web,record]'"),
        ("{no JSON", "web", "pip install 'cramhy[web]'"),
        ({"url": "file:///opt/cramhy", "dir_info": {"editable": True}}, "web", "pip install -e '/opt/cramhy[web]'"),
        ({"url": "file:///opt/my%20clone%27s", "dir_info": {"editable": True}}, "ros", """pip install -e '/opt/my clone'"'"'s[ros]'"""),
        ({"url": "file:///opt/cramhy", "dir_info": {}}, "web", "pip install '/opt/cramhy[web]'"),
        ({"url": "file:///opt/cramhy.whl", "archive_info": {}}, "web", "pip install 'cramhy[web] @ file:///opt/cramhy.whl'"),
        (
            {"url": "https://example.org/c.git", "vcs_info": {"vcs": "git", "commit_id": "0"}},
            "web",
            "pip install 'cramhy[web] @ git+https://example.org/c.git'",
        ),
    ],
)
@pytest.mark.skipif(os.name == "nt", reason="these paths and quotes are those of a POSIX shell")
def test_the_command_names_where_cramhy_came_from(installed, noted, extra, command):
    installed(noted)
    assert extras.install_command(extra) == command


def test_code_out_of_a_clone_that_pip_has_not_seen_is_installed_from_it(monkeypatch):
    def missing(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "distribution", missing)
    monkeypatch.setattr(extras, "_pip", lambda: "pip")
    assert extras.install_command("web") == f"pip install -e {extras._quoted(f'{ROOT}[web]')}"


@pytest.mark.parametrize(("on_path", "command"), [("here", "pip"), ("elsewhere", "{python} -m pip"), ("nowhere", "{python} -m pip")])
def test_the_pip_is_that_of_this_python(tmp_path, monkeypatch, on_path, command):
    for folder in ("here", "elsewhere"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "pip").write_text("#!/bin/sh\n")
        (tmp_path / folder / "pip").chmod(0o755)
    python = tmp_path / "here" / "python"
    monkeypatch.setattr(sys, "executable", str(python))
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.setenv("PATH", str(tmp_path / on_path))
    if os.name == "nt":
        pytest.skip("a program of Windows has another name")
    assert extras._pip() == command.format(python=python)


def test_without_a_virtual_environment_the_user_knows_which_pip(monkeypatch):
    monkeypatch.setattr(sys, "prefix", sys.base_prefix)
    monkeypatch.setenv("PATH", "")
    assert extras._pip() == "pip"


def test_the_command_of_this_installation_runs():
    """Not installing anything: pip itself is asked whether it understands the words."""
    pytest.importorskip("pip")
    words = [sys.executable, "-m", "pip", "install", "--dry-run", "--no-deps", "--no-build-isolation", "--no-index", "--quiet"]
    pytest.importorskip("hatchling")
    done = subprocess.run([*words, *extras._requirement("web")], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
