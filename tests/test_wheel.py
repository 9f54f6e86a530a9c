"""The wheel: what ``pip`` gets when it builds cramhy carries the licence, the course, the macros and the page."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from email.parser import Parser
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel that hatchling builds of this tree, opened."""
    pytest.importorskip("hatchling", reason="the wheel is built with it: pip install hatchling")
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run([sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)], cwd=ROOT, check=True,
                   capture_output=True)
    (path,) = folder.glob("*.whl")
    with zipfile.ZipFile(path) as opened:
        yield opened


def file_called(wheel, ending):
    """The text of the one file of the wheel whose name ends so."""
    (name,) = [name for name in wheel.namelist() if name.endswith(ending)]
    return wheel.read(name).decode()


def test_the_wheel_carries_the_licence(wheel):
    assert file_called(wheel, ".dist-info/licenses/LICENSE") == (ROOT / "LICENSE").read_text()
    metadata = Parser().parsestr(file_called(wheel, ".dist-info/METADATA"))
    assert (metadata["License-Expression"], metadata.get_all("License-File")) == ("BSD-3-Clause", ["LICENSE"])


def test_the_licence_names_its_holders():
    text = (ROOT / "LICENSE").read_text()
    assert text.startswith("BSD 3-Clause License\n\nCopyright (c) 2026, cramhy contributors\n")
    assert all(f"\n{number}. " in text for number in (1, 2, 3))


def test_the_manifest_of_the_course_names_the_same_licence():
    assert "<license>BSD-3-Clause</license>" in (ROOT / "tutorials/cram_my_beginner_tutorial/package.xml").read_text()


@pytest.mark.parametrize("folder", ["src/cramhy_runtime", "hy_src/cramhy", "tutorials"])
def test_the_wheel_has_every_file_of_the_tree(wheel, folder):
    tracked = subprocess.run(["git", "ls-files", folder], cwd=ROOT, capture_output=True, text=True)
    if tracked.returncode or not tracked.stdout:
        pytest.skip("this tree is no clone of git's, so what belongs to it is not known")
    home = "cramhy_runtime/tutorials" if folder == "tutorials" else folder.partition("/")[2]
    assert {home + name.removeprefix(folder) for name in tracked.stdout.splitlines()} <= set(wheel.namelist())
