"""docs/transforms.md: what it shows is what the REPL and Python answer (`make docs` writes the answers of now)."""

import re
import subprocess
import sys

import pytest
from tutorials.pages import OTHER_PAGES, Page, environment, play

PAGE = Page(OTHER_PAGES[1])


@pytest.mark.parametrize("backend", ["threads", "greenlet"])
def test_the_page_shows_what_the_repl_answers(tmp_path, backend):
    assert play(PAGE, tmp_path, backend) == PAGE.sessions


def test_the_example_in_python_prints_what_the_page_shows(tmp_path):
    program, shown = (re.search(rf"```{kind}\n(.*?)```", PAGE.text, re.S)[1] for kind in ("python", "text"))
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.stderr) == (shown, "")
