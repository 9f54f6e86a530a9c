"""The pages of the course, and what is typed on them.

A block of a page that begins with a prompt is a piece of a REPL session; all such blocks of a page are one session, in virtual time.
`play` types their forms into a fresh REPL. A block that begins with ``$`` is a command of the shell and what it prints. ``make docs``
runs this file: it writes the answers into the pages, and the turtle's paper beside them; the tests compare both.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "tutorials"
PAGES = sorted(FOLDER.glob("[0-9]-*.md"))
OTHER_PAGES = [ROOT / "docs" / "projection.md", ROOT / "docs" / "transforms.md", ROOT / "docs" / "turtle.md",
               ROOT / "docs" / "actions.md"]
BLOCK = re.compile(r"^```(?:lisp|sh)\n(.*?)^```$", re.M | re.S)
PROMPT = re.compile(r"^([A-Z-]+> |\d+\] )", re.M)


class Page:
    """A page as text. ``sessions`` are its blocks with prompts, ``commands`` those of the shell, ``code`` all others."""

    def __init__(self, path):
        self.path, self.text = path, path.read_text()
        self.sessions, self.commands, self.code = [], [], []
        for text in BLOCK.findall(self.text):
            self._blocks_like(text).append(text)

    def _blocks_like(self, text):
        return self.commands if text.startswith("$ ") else self.sessions if PROMPT.match(text) else self.code

    @property
    def typed(self):
        """The texts that are typed, in order."""
        return [typed for session in self.sessions for typed, _ in exchanges(session)]

    def with_blocks(self, sessions, commands):
        """The text of the page with other sessions and commands in the places of its own."""
        rest = {id(self.sessions): iter(sessions), id(self.commands): iter(commands), id(self.code): iter(self.code)}
        return BLOCK.sub(lambda block: block[0].replace(block[1], next(rest[id(self._blocks_like(block[1]))])), self.text)


def exchanges(session):
    """(typed, whole text) of every prompt of a session; what is typed ends with the line on which its parentheses are closed."""
    starts = [match.start() for match in PROMPT.finditer(session)] + [len(session)]
    for start, end in zip(starts, starts[1:]):
        text = session[start:end]
        lines = text[PROMPT.match(text).end():].splitlines()
        count = next(count for count in range(1, len(lines) + 1) if balanced("\n".join(lines[:count])) or count == len(lines))
        yield "\n".join(lines[:count]), text


def balanced(form):
    return form.count("(") <= form.count(")")


def environment():
    keep = {key: value for key, value in os.environ.items() if key not in ("ROS_PACKAGE_PATH", "PYTHONDONTWRITEBYTECODE")}
    return {**keep, "PYTHONPATH": os.pathsep.join(str(ROOT / folder) for folder in ("src", "hy_src", "tutorials"))}


def play(page, folder, backend="threads"):
    """Type what stands on ``page`` into a REPL that runs in ``folder``; the sessions as they come out."""
    done = subprocess.run([sys.executable, __file__, "type", str(page.path), backend], cwd=folder, env=environment(),
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and not done.stderr, done.stdout[-3000:] + done.stderr
    played = [text for _, text in exchanges(done.stdout.replace(f"{ROOT}/", ""))]
    sessions = []
    for session in page.sessions:
        count = len(list(exchanges(session)))
        sessions.append("".join(played[:count]))
        played = played[count:]
    return sessions


def run(block, folder):
    """A block with a command of the shell, and with what this prints now."""
    command = block.splitlines()[0]
    words = [sys.executable, "-m", *command.removeprefix("$ ").replace("cramhy ", "cramhy_runtime.cli ", 1).split()]
    done = subprocess.run(words, cwd=folder, env=environment(), capture_output=True, text=True, timeout=120)
    assert not done.stderr, done.stderr
    return f"{command}\n{done.stdout.rstrip()}\n"


def type_into_repl(path, backend):
    """Type a page's forms and print the session, prompts and typed text included."""
    from lectures import Typist

    from cramhy_runtime.repl.console import Console
    from cramhy_runtime.repl.session import Session

    return Console(lambda: Session(time="virtual", backend=backend), Typist(Page(Path(path)).typed)).run()


def rewrite():
    """Write what the REPL answers, and what it draws, into the pages."""
    for path in [*PAGES, *OTHER_PAGES]:
        page = Page(path)
        with tempfile.TemporaryDirectory() as folder:
            path.write_text(page.with_blocks(play(page, folder), [run(block, folder) for block in page.commands]))
            for picture in Path(folder).glob("*.[ps][nv]g"):
                (path.parent / picture.name).write_bytes(picture.read_bytes())


if __name__ == "__main__":
    sys.exit(type_into_repl(*sys.argv[2:]) if sys.argv[1:] else rewrite())
