"""The pages of the documentation, and what happens when somebody does what stands on them.

A block of code says by its first line, its language or its title what it is:

* a block of ``lisp`` that begins with a prompt, or of ``hy`` that begins with ``=> ``, is a piece of a session. All pieces of one
  language on a page are one session in virtual time;
* a block with a title, as in ``lisp title="spiral.lisp"``, is a file; but with the title "Begin with" it is the code that a task of the
  course begins with, which ``tests/course`` tries;
* a block of ``python`` is a piece of one program, and a block of ``text`` below it is what this piece prints;
* a block of ``sh`` that begins with ``$`` is a command and what it prints;
* a block of ``lisp`` or ``hy`` without a prompt quotes the course's package;
* any other block has lines for a shell, which ``tests/test_readme_commands.py`` checks without running them.

`play` does all of it and gives the blocks as they come out. One process plays many pages, each in an `Image` of its own. ``make docs``
runs this file: it writes the answers into the pages, and the pictures beside them. The tests compare both.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from cramhy_runtime.cli import shims
from cramhy_runtime.course.reading import START

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
COURSE = ROOT / "tutorials"
FENCE = re.compile(r"^```(\w*)(?: title=\"(.*?)\")?\n(.*?)^```$", re.M | re.S)
PROMPT = re.compile(r"^(?:[A-Z-]+> |\d+\] |=> )", re.M)

ELSEWHERE = {
    "common-lisp.md": "tests/lisp/test_standard_page.py",
    "hy.md": "tests/cpl/test_hy_page.py",
    "images.md": "tests/session/test_page_of_images.py",
    "operators.md": "tests/operators/test_operators_page.py",
    "plans-in-python.md": "tests/cpl/test_plans_in_python.py",
    "prolog.md": "tests/prolog/test_prolog_page.py",
    "python.md": "tests/lisp/test_python_from_lisp.py",
    "reasoning-in-python.md": "tests/process_modules/test_reasoning_in_python.py",
    "ros-bridge.md": "tests/rosbridge/test_bridge_page.py",
    "testing.md": "tests/testing/test_documentation.py",
    "watching.md": "tests/chronicle/test_watching_page.py",
}
"""Pages whose blocks need more than a session, and the test that runs them."""

EXTENSIONS = (".png", ".svg", ".gif")


@dataclass
class Block:
    """A block of code: its language, its title or ``None``, and its text."""

    language: str
    title: str | None
    text: str

    @property
    def kind(self):
        """What the block is: session, hy session, file, command, python, text, quotation, shell, or the beginning of a task's solution."""
        if self.title == START:
            return "start"
        if self.title:
            return "file"
        if self.language in ("sh", "console") and self.text.startswith("$ "):
            return "command"
        if self.language == "lisp":
            return "session" if PROMPT.match(self.text) else "quotation"
        if self.language == "hy":
            return "hy session" if self.text.startswith("=> ") else "quotation"
        if self.language in ("python", "text"):
            return self.language
        assert self.language in ("", "sh", "console"), f"nobody runs blocks of {self.language}"
        return "shell"


class Page:
    """A page as text, with its ``blocks``."""

    def __init__(self, path):
        self.path, self.text = Path(path), Path(path).read_text(encoding="utf-8")

    @cached_property
    def blocks(self):
        return [Block(language, title or None, text) for language, title, text in FENCE.findall(self.text)]

    def texts(self, kind):
        """The texts of the blocks of a kind."""
        return [block.text for block in self.blocks if block.kind == kind]

    @property
    def pictures(self):
        """The names of the pictures beside the page that it shows."""
        return [name for name in re.findall(r"!\[[^\]]*\]\(([^)/]+)\)", self.text) if name.endswith(EXTENSIONS)]

    def with_texts(self, texts):
        """The text of the page with these texts in the places of those of its blocks."""
        fresh = iter(texts)

        def replaced(match):
            start, end = match.start(3) - match.start(), match.end(3) - match.start()
            return match[0][:start] + next(fresh) + match[0][end:]

        return FENCE.sub(replaced, self.text)


LECTURES = ["lecture-34.md", "simple-plans.md", "motion-designators.md", "lecture-38.md"]
"""Pages on which one package grows, in their order."""

KITCHEN = [*sorted((DOCS / "tutorials" / "kitchen").glob("*.md")), DOCS / "how-to" / "add-a-robot.md", DOCS / "tutorials" / "bricks.md"]
"""Pages with the robot in the kitchen, or with the arm, which `play` runs, too. They need the extra ``robot``, and take longer."""
PAGES = [
    path
    for path in sorted(DOCS.rglob("*.md"), key=lambda path: (LECTURES.index(path.name) if path.name in LECTURES else -1, path))
    if path.name not in ELSEWHERE and path not in KITCHEN and path.parent.name != "reference"
]
"""The pages whose blocks `play` runs."""


def exchanges(session):
    """(typed, whole text) of every prompt of a session; what is typed ends with the line on which its parentheses are closed."""
    starts = [match.start() for match in PROMPT.finditer(session)] + [len(session)]
    for start, end in zip(starts, starts[1:]):
        text = session[start:end]
        lines = text[PROMPT.match(text).end() :].splitlines()
        count = next(count for count in range(1, len(lines) + 1) if balanced("\n".join(lines[:count])) or count == len(lines))
        yield "\n".join(lines[:count]), text


def balanced(form):
    return form.count("(") <= form.count(")")


# ------------------------------------------------------------------------------------------------------------- in the process that plays


def actor():
    """The class of a typist who takes its lines from an iterator. Its folder does not stay on the path: Python would take systems in it
    for packages."""
    sys.path.insert(0, str(COURSE))
    try:
        from lectures import Typist
    finally:
        sys.path.remove(str(COURSE))

    class Actor(Typist):
        def __init__(self, lines):
            super().__init__([])
            self.coming = lines

        def line(self, prompt):
            self.lines = [line] if (line := next(self.coming, None)) is not None else []
            return super().line(prompt)

    return Actor


def write(block):
    """Make the file that a block is."""
    path = Path(block.title)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(block.text, encoding="utf-8")


def acted(blocks, texts):
    """Make the files and run the commands of a page in their order, and give the lines of its Lisp session on the way."""
    for number, block in enumerate(blocks):
        if block.kind == "file":
            write(block)
        elif block.kind == "command":
            texts[number] = run(block.text)
        elif block.kind == "session":
            for typed, _ in exchanges(block.text):
                yield from typed.splitlines()


def typed_into_lisp(blocks, texts, backend):
    """Enter into ``texts`` what a page's Lisp session answers and its commands print."""
    from cramhy_runtime.repl.console import Console
    from cramhy_runtime.repl.session import Session

    lines = acted(blocks, texts)
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(out):
        Console(lambda: Session(time="virtual", backend=backend), actor()(lines)).run()
    played = [text for _, text in exchanges(out.getvalue())]
    for number, block in enumerate(blocks):
        if block.kind == "session":
            count = len(list(exchanges(block.text)))
            texts[number] = "".join(played[:count])
            played = played[count:]


def typed_into_hy(blocks, texts, backend):
    """Enter into ``texts`` what the prompt of ``cramhy repl --hy`` answers."""
    import hy
    from hy.errors import filtered_hy_exceptions
    from hy.repl import extend_linecache

    from cramhy_runtime import kernel
    from cramhy_runtime.repl import hy_prompt
    from cramhy_runtime.repl.session import Session

    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(out), contextlib.ExitStack() as around:
        repl = hy.REPL()
        around.enter_context(filtered_hy_exceptions())
        around.enter_context(extend_linecache(repl.cmdline_cache))
        hy_prompt.attend(repl, Session(time="virtual", backend=backend))
        around.callback(kernel.stop)
        repl.runsource("(require cramhy *)")
        for number, block in enumerate(blocks):
            if block.kind == "file":
                write(block)
            elif block.kind == "hy session":
                texts[number] = ""
                for typed, text in exchanges(block.text):
                    out.truncate(out.seek(0))
                    assert not repl.runsource(typed), f"not complete: {typed}"
                    texts[number] += f"=> {text[3 : 3 + len(typed)]}\n{out.getvalue()}"


def printed_by_python(blocks, texts):
    """Enter into ``texts``, for each block of text below a block of Python, what that prints."""
    space, printed = {"__name__": "page"}, ""
    for number, block in enumerate(blocks):
        if block.kind == "python":
            with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()):
                exec(compile(block.text, "page", "exec"), space)
            printed += out.getvalue()
        elif block.kind == "text":
            texts[number], printed = printed, ""
    assert not printed, "a page shows what its Python prints"


def run(block):
    """A block with a command of the shell, and with what this prints now."""
    command = block.splitlines()[0]
    words = shlex.split(command.removeprefix("$ "))
    if words[0] == "cramhy":
        words[0] = "cramhy_runtime.cli"
    elif words[0] in shims.TOOLS:
        words[:0] = ["cramhy_runtime.cli", "ros"]
    done = subprocess.run([sys.executable, "-m", *words], env=environment(), capture_output=True, text=True, timeout=120)
    return "\n".join(text for text in (command, done.stdout.strip("\n"), done.stderr.strip("\n")) if text) + "\n"


@contextlib.contextmanager
def on_the_path(place):
    """Python finds modules of the folder ``place``, and forgets them afterwards: they belong to the image of one page."""
    sys.path.insert(0, str(place))
    try:
        yield
    finally:
        sys.path.remove(str(place))
        for name, module in list(sys.modules.items()):
            places = [getattr(module, "__file__", None), *getattr(module, "__path__", [])]
            if any(str(each).startswith(f"{place}{os.sep}") for each in places):
                del sys.modules[name]


def played(page, backend):
    """The texts of all blocks of ``page``, done in the current folder."""
    from cramhy_runtime.session import Image

    blocks = page.blocks
    texts = [block.text for block in blocks]
    for name in ("turtlesim_in_hy", "kitchen/kitchen_in_hy"):
        if Path(name).name.replace("_", "-") in page.text:
            shutil.copytree(COURSE / name, Path(name).name, ignore=shutil.ignore_patterns("__pycache__"))
    kinds = {block.kind for block in blocks}
    if "session" in kinds:
        with Image():
            typed_into_lisp(blocks, texts, backend)
    else:
        list(acted(blocks, texts))
    with on_the_path(Path.cwd()):
        if "hy session" in kinds:
            with Image():
                typed_into_hy(blocks, texts, backend)
        if "python" in kinds:
            with Image():
                printed_by_python(blocks, texts)
    return texts


def play_here(paths, backend, folder):
    """Play pages in folders below ``folder``, and print the texts of their blocks as JSON."""
    texts = {}
    for path in paths:
        with contextlib.chdir(place_of(path, folder)):
            here = f"{folder}/" if Path(path).name in LECTURES else f"{Path.cwd()}/"
            texts[path] = [text.replace(f"{ROOT}/", "").replace(here, "") for text in played(Page(path), backend)]
    json.dump(texts, sys.stdout)


# --------------------------------------------------------------------------------------------------------------- in the process of the tests


def place_of(path, folder):
    """The folder in which a page is played: the pages of the lectures go on in the same one."""
    path = Path(path)
    place = Path(folder) / ("workspace/ros/src" if path.name in LECTURES else "-".join(path.relative_to(DOCS).with_suffix("").parts))
    place.mkdir(parents=True, exist_ok=True)
    return place


def environment():
    keep = {key: value for key, value in os.environ.items() if key not in ("ROS_PACKAGE_PATH", "PYTHONDONTWRITEBYTECODE")}
    return {**keep, "PYTHONPATH": os.pathsep.join(str(ROOT / folder) for folder in ("src", "hy_src"))}


def play(paths, folder, backend="threads", timeout=300):
    """Do what stands on pages: for each of ``paths`` the texts of its blocks as they come out, and the folder with its files."""
    paths = [str(path) for path in paths]
    done = subprocess.run(
        [sys.executable, __file__, "play", backend, str(folder), *paths],
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=timeout,
    )
    assert done.returncode == 0 and not done.stderr, done.stdout[-3000:] + done.stderr
    return {Path(path): (texts, place_of(path, folder)) for path, texts in json.loads(done.stdout).items()}


def rewrite(paths):
    """Write what happens, and what the turtle draws, into the pages."""
    with tempfile.TemporaryDirectory() as folder:
        for path, (texts, place) in play(paths, folder, timeout=900).items():
            page = Page(path)
            path.write_text(page.with_texts(texts), encoding="utf-8")
            for name in page.pictures:
                if (place / name).exists():
                    (path.parent / name).write_bytes((place / name).read_bytes())


if __name__ == "__main__":
    if sys.argv[1:2] == ["play"]:
        play_here(sys.argv[4:], sys.argv[2], sys.argv[3])
    else:
        rewrite([Path(word).resolve() for word in sys.argv[1:]] or PAGES + KITCHEN)
