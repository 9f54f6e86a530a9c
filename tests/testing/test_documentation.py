"""The example of docs/testing.md runs as it stands there, and finds what the page says."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from cramhy_runtime import testing

PAGE = (Path(__file__).parents[2] / "docs" / "testing.md").read_text()


@pytest.mark.soak
def test_the_example_runs_and_shows_what_the_page_shows(tmp_path):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.S)
    (shown,) = re.findall(r"```\n(The plan depends.*?)```", PAGE, re.S)
    (tmp_path / "test_fetching.py").write_text(example)
    command = [sys.executable, "-m", "pytest", "-s", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env={**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"})
    assert done.returncode == 0 and "9 passed" in done.stdout, done.stdout + done.stderr
    assert shown in done.stdout
    assert re.search(r"-> 1 TOP-LEVEL/PAR-CHILD-#\d/2 \(goes on", done.stdout), done.stdout


def test_the_page_names_everything_that_there_is():
    for name in testing.__all__:
        assert re.search(rf"\b{name}\b", PAGE) or name in ("Exploration", "Outcome", "Schedule", "leftovers"), name
