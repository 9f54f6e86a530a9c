"""What docs/watching.md shows is what happens: its program, its commands, its examples, its tables."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from cramhy_runtime.chronicle.merge import TOPICS
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact

pytest.importorskip("mcap")

PAGE = (Path(__file__).parents[2] / "docs" / "watching.md").read_text()
BLOCKS = {language: re.findall(rf"```{language}\n(.*?)```", PAGE, re.S) for language in ("lisp", "console", "python", "text")}


def run(folder, *words):
    done = subprocess.run([sys.executable, *words], capture_output=True, text=True, cwd=folder, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("page")
    (made / "errand.lisp").write_text(BLOCKS["lisp"][0])
    command = BLOCKS["console"][0].strip().removeprefix("$ cramhy ").split()
    run(made, "-m", "cramhy_runtime.cli", *command)
    return made


@pytest.mark.parametrize("number", [0, 1])
def test_the_examples_print_what_the_page_shows(folder, number):
    assert run(folder, "-c", BLOCKS["python"][number]) == BLOCKS["text"][number]


def test_the_tables_name_what_there_is():
    named = dict(re.findall(r"^\| `(/cramhy/\w+)` \| `(\w+)`", PAGE, re.M))
    assert set(named) == {*TOPICS.values(), "/cramhy/pace"}
    assert all(message_class_exact(f"cramhy_msgs/{name}") for name in named.values())
    services = re.findall(r"^\| `/cramhy/(\w+)` \| [^`|]", PAGE, re.M)
    assert services == ["get_state", "get_history", "set_pace", "step", "move_thing", "seek"]
    assert all(service_type_exact("cramhy_msgs/" + name.title().replace("_", "")) for name in services)
