"""The commands of README and of the pages beside it are commands that there are: programs, targets of make, and options that are known.

They are not all carried out here. What stands in a block of the shell, in a table or between backquotes is taken apart as a shell does it,
and given to the parser that would read it.
"""

from __future__ import annotations

import re
import shlex
import tomllib
from pathlib import Path

import pytest

from cramhy_runtime.cli import options, shims
from cramhy_runtime.ros_tools import executables
from cramhy_runtime.ros_tools.arguments import CommandError

ROOT = Path(__file__).parents[1]
PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "tutorials").glob("*.md"))]
PAGES = [page for page in PAGES if page.parent.name != "reference" and page.name != "ARCHITECTURE.md"]  # these do not speak to users
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
EXTRAS = set(PROJECT["optional-dependencies"])
PROGRAMS = {*PROJECT["scripts"], "hy", "python", "pip"}
"""What stands in ``.venv/bin`` after ``make tutorial``."""
FUNCTIONS = {"cramhy", "roslisp_repl", "roscd", *shims.TOOLS}
"""What ``eval "$(.venv/bin/cramhy ros-shims)"`` defines."""
STARTS = ("make", "cramhy", "roslisp_repl", "eval", "pip", "python3", "hy", "python", ".venv/bin/", "mine/bin/", *sorted(FUNCTIONS))
ACTIVATED = "source .venv/bin/activate"
"""Below this line of a page, programs of ``.venv/bin`` need no folder."""


def commands_of(page):
    """The commands of a page, each as (number of its line, text)."""
    language, activated = None, False
    for number, line in enumerate(page.read_text().splitlines(), 1):
        activated = activated or line == ACTIVATED
        if line.startswith("```"):
            language = line[3:].strip() if language is None else None
        elif language in ("", "sh", "console"):
            text = line.removeprefix("$ ")
            if is_command(text):
                yield number, found(text, activated)
        elif language is None:
            for text in re.findall(r"(?<!`)`([^`]+)`(?!`)", line):
                if is_command(text) and " " in text:
                    yield number, found(text, activated)


def found(text, activated):
    """A command with the folder of its program, if the page has put that on the path."""
    return f".venv/bin/{text}" if activated and text.split()[0] in PROGRAMS - FUNCTIONS else text


def is_command(text):
    first = re.split(r"[\s(]", text, maxsplit=1)[0]
    return first in STARTS or first.startswith((".venv/bin/", "mine/bin/"))


FILES_OF_PAGES = {title for page in PAGES for title in re.findall(r'^```\w+ title="(.*?)"', page.read_text(), re.M)}
"""Files that the reader makes."""

COMMANDS = [pytest.param(text, id=f"{page.relative_to(ROOT)}:{number}") for page in PAGES for number, text in commands_of(page)]


def words_of(text):
    """The words of a command line, without its comment; lines that a page breaks off with … are what comes before it."""
    return shlex.split(text.replace("…", "").replace(r"\|", "|"), comments=True)


@pytest.mark.soak(all_but=10)
@pytest.mark.parametrize("text", COMMANDS)
def test_a_command_is_one_that_there_is(text):
    nested = re.fullmatch(r'eval "\$\((.*)\)"', text.strip())
    if nested:
        text = nested.group(1)
        assert text.startswith(".venv/bin/"), "nothing of cramhy's is on the PATH before this"
    for part in re.split(r" \| (?=source$|\w+$)", text):
        if part != "source":
            check(words_of(part))


def check(words):
    """Fail unless a shell in the clone's folder, with the functions, can run these words."""
    program, *rest = words
    folder, _, name = program.rpartition("/")
    assert folder in ("", ".venv/bin", "mine/bin")
    if folder:
        assert name in PROGRAMS
    else:
        assert name in {"make", "python3", *FUNCTIONS}, f"{name} is not on the PATH: it is .venv/bin/{name}"
    if name == "make":
        check_make(rest)
    elif name == "cramhy":
        check_cramhy(rest)
    elif name == "roslisp_repl":
        check_cramhy(["repl", *rest])
    elif name == "pip":
        check_pip(rest)
    elif name in ("python", "hy") and rest and not rest[0].startswith("-") and rest[0] != "FILE.hy":
        assert (ROOT / rest[0]).is_file() or rest[0] in FILES_OF_PAGES
    elif name in FUNCTIONS:
        check_ros(name, rest)


def check_make(targets):
    known = re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.M)
    targets = [target for target in targets if not re.fullmatch(r"[A-Z]+=\S+", target)]
    assert targets and set(targets) <= set(known)


def check_cramhy(words):
    if words[:1] == ["ros"]:
        return check_ros(words[1], words[2:])
    if not words or words in (["COMMAND"], ["COMMAND", "--help"], ["--version"]):
        return None
    known = next(action.choices for action in options.parser()._actions if action.dest == "command")
    assert words[0] in known
    if not set(words) & {"[...]", "..."}:
        placed = [word.replace("HOST", "robot").replace("PORT", "9090").replace("SECONDS", "5") for word in words]
        placed = [("5" if word == "N" else word.split("|")[0]) for word in placed]
        if words in (["run"], ["test"], ["replay"], ["repl", "--ros"], ["grade"], ["similar"]):  # only named
            return None
        options.parser().parse_args(placed)
    return None


def check_pip(words):
    """cramhy is installed from the clone or from a wheel, with extras that it has: ``'.[web]'``, ``-e '.[web]'``."""
    assert words[0] == "install"
    found = re.fullmatch(r"(?:\.|FILE\.whl)\[([\w,]+)\]", words[2 if words[1] == "-e" else 1])
    assert found, "cramhy is installed from a folder or a file"
    assert set(found[1].split(",")) <= EXTRAS


def check_ros(name, words):
    from cramhy_runtime.ros_tools import running
    from cramhy_runtime.ros_tools.arguments import found

    if name == "COMMAND":
        return
    assert name in {*shims.TOOLS, "roscd"}
    if name in running.TOOLS and words:
        for home in running._HOMES[name]:
            __import__(f"cramhy_runtime.ros_tools.{home}")
        found([name, *words])
    if name == "rosrun" and not words[0].startswith("my_"):  # the reader's own package
        assert executables.complaint(words[0], words[1]) is None


def test_the_pages_have_commands_of_every_kind():
    kinds = {words_of(param.values[0])[0] for param in COMMANDS if not param.values[0].startswith("eval")}
    assert {"make", "cramhy", "roslisp_repl", "rosrun", "rostopic", "rosservice", "roslaunch", "mine/bin/pip", ".venv/bin/hy"} <= kinds


@pytest.mark.parametrize(
    "text",
    [
        "cramhy run --nothing FILE",
        "cramhy nothing",
        "cramhy repl --nothing",
        "make nothing",
        "pip install 'cramhy[web]'",
        ".venv/bin/pip install 'cramhy[web]'",
        "hy x.hy",
        ".venv/bin/pip install -e '.[nothing]'",
        "rosrun turtlesim nothing",
        "rostopic nothing",
        ".venv/bin/nothing",
        'eval "$(cramhy ros-shims)"',
    ],
)
def test_what_is_wrong_is_found(text):
    with pytest.raises((AssertionError, SystemExit, CommandError)):
        test_a_command_is_one_that_there_is(text)


def test_options_that_are_named_are_known():
    """``--word`` between backquotes, without a command before it: of cramhy, or of its pytest plugin."""
    parser = options.parser()
    commands = next(action.choices for action in parser._actions if action.dest == "command")
    known = {string for command in commands.values() for action in command._actions for string in action.option_strings}
    quoted = [text for page in PAGES for text in re.findall(r"`(--[^`]+)`", page.read_text())]
    named = {option for text in quoted for option in re.findall(r"--[a-z-]+", text)}
    assert {"--time", "--serve", "--ros"} <= named
    assert named - known == {"--lisp-limit", "--cramhy-time"}
