"""docs/turtle.md: what it shows is what the REPL and Python answer, and its pictures are those that they draw (`make docs`)."""

import re
import subprocess
import sys

import pytest
from tutorials.pages import OTHER_PAGES, Page, environment, play

PAGE = Page(next(path for path in OTHER_PAGES if path.name == "turtle.md"))


@pytest.mark.parametrize("backend", ["threads", "greenlet"])
def test_the_page_shows_what_the_repl_answers_and_draws(tmp_path, backend):
    assert play(PAGE, tmp_path, backend) == PAGE.sessions
    for name in ("keys.svg", "square.replay.svg"):
        assert (tmp_path / name).read_text() == (PAGE.path.parent / name).read_text()
        assert f"]({name})" in PAGE.text


def test_the_example_in_python_prints_what_the_page_shows(tmp_path):
    program, shown = (re.search(rf"```{kind}\n(.*?)```", PAGE.text, re.S)[1] for kind in ("python", "text"))
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.stderr) == (shown, "")
    assert (tmp_path / "half.svg").exists()
