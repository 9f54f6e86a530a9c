"""The parts of the page that need no browser, under Node: history, playback, lines, the task tree's outline, the connection."""

from __future__ import annotations

import shutil
import subprocess
from importlib import resources
from pathlib import Path

import pytest

NODE = shutil.which("node")


@pytest.mark.soak
@pytest.mark.skipif(NODE is None, reason="no node is on the PATH to run the page's unit tests")
def test_the_modules_of_the_page_pass_their_unit_tests(tmp_path):
    version = subprocess.run([NODE, "--version"], capture_output=True, text=True).stdout
    if int(version.lstrip("v").partition(".")[0]) < 20:
        pytest.skip(f"node {version.strip()} has no mock timers; 20 or later has")
    shutil.copytree(resources.files("cramhy_runtime.view").joinpath("static"), tmp_path, dirs_exist_ok=True)
    (tmp_path / "package.json").write_text('{"type": "module"}')
    tests = [Path(shutil.copy(file, tmp_path)) for file in sorted(Path(__file__).parent.glob("*.test.mjs"))]
    done = subprocess.run([NODE, "--test", *tests], capture_output=True, text=True, cwd=tmp_path, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
