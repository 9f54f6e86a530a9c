"""Each page of the documentation shows what happens, and each of its blocks of code is run or checked by a test."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from systems import ONE_BACKEND

sys.path.insert(0, str(Path(__file__).parents[1]))

from . import command_line
from .pages import COURSE, DOCS, ELSEWHERE, KITCHEN, PAGES, ROOT, Block, Page, balanced, exchanges, play

PACKAGES = [COURSE / "cram_my_beginner_tutorial", COURSE / "turtlesim_in_hy", COURSE / "kitchen"]


def without_seconds(text):
    """``text`` without the wall time that a report of tests tells."""
    return re.sub(r"\bin \d+\.\d\ds\b", "in 0.00s", text)


def without_marks(text):
    """``text`` without the lines of a traceback that mark a place: those are other ones in other versions of Python."""
    return re.sub(r"^ +[\^~]+\n", "", text, flags=re.M)


SHORT = [path for path in KITCHEN if path.name in ("arms-and-grasps.md", "carrying-a-bottle.md", "recovering.md")]
"""What of the kitchen is played in ordinary tests, too: the first page, and those that are quick."""


def rounded(text):
    """``text`` with its floats, of Lisp and of Hy, in millimetres: the digits behind are those of MuJoCo's version and of the processor."""
    number = r"-?\d+(?:\.\d+(?:[de]-?\d+)?|e-?\d+)"
    return re.sub(number, lambda found: f"{float(found[0].replace('d', 'e')):.3f}".replace("-0.000", "0.000"), text)


STALE = "the page shows other answers than come now; if these are right, `make docs` writes them into the page"
PICTURES_FROM_ELSEWHERE = {"bricks.png", "page.png", "architecture.svg", "spiral.replay.svg", "emacs.png"}
PICTURES_FROM_ELSEWHERE |= {f"notebook-{name}.png" for name in ("live", "values", "fluents", "failure")}  # `notebook_pictures.py`


@pytest.fixture(scope="module", params=ONE_BACKEND)
def plays(request, tmp_path_factory):
    """What has happened on all pages, on either back end: (texts of the blocks, folder) by the path of the page."""
    if request.param == "greenlet":
        pytest.importorskip("greenlet")
    return play(PAGES, tmp_path_factory.mktemp(request.param), request.param)


def pixels(path):
    image = pytest.importorskip("PIL.Image")
    return image.open(path).tobytes()


def name_of(path):
    return path.relative_to(DOCS).as_posix()


def shows(path, plays):
    """The page at ``path`` shows what has happened: its texts, and its pictures."""
    texts, _ = plays[path]
    page = Page(path)
    for text, block in zip(texts, page.blocks, strict=True):
        compared = rounded if path in KITCHEN else str
        came, stands = (compared(without_marks(without_seconds(each))) for each in (text, block.text))
        assert came == stands, STALE
    for name in set(page.pictures) - PICTURES_FROM_ELSEWHERE:
        (drawn,) = [folder / name for other, (_, folder) in plays.items() if other.parent == path.parent and (folder / name).exists()][:1]
        stored = path.parent / name
        if name.endswith(".svg"):
            assert drawn.read_text() == stored.read_text(), f"another picture than {name}; `make docs` stores this one"
        else:
            assert pixels(drawn) == pixels(stored), f"another picture than {name}; `make docs` stores this one"


@pytest.mark.parametrize(
    ("text", "same"),
    [("0.6699999999999999d0", "0.6700112d0"), ("0.6699999999999999", "0.6700112"), ("-8.25d-5", "2.29d-17"), ("1e-05", "0.0")],
)
def test_digits_below_a_millimetre_are_not_compared(text, same):
    assert rounded(f"({text} 7)") == rounded(f"({same} 7)") != rounded("(0.671 7)")


@pytest.mark.soak(only=("actions.md", "command-line.md"))
@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_what_happens_is_what_the_page_shows(path, plays):
    shows(path, plays)


@pytest.mark.parametrize("path", [pytest.param(path, marks=[] if path in SHORT else pytest.mark.soak) for path in KITCHEN], ids=name_of)
def test_what_happens_in_the_kitchen_is_what_the_page_shows(path, tmp_path):
    pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    plays = play([path], tmp_path)
    shows(path, plays)
    if path.name == "table-for-two.md":
        _, folder = plays[path]
        assert pixels(folder / "table.png") == pixels(folder / "table-in-hy.png"), "Lisp and Hy set the same table"


@pytest.mark.soak(all_but=14)
@pytest.mark.parametrize("path", PAGES + KITCHEN, ids=name_of)
def test_code_that_a_page_quotes_stands_in_the_course(path):
    files = [file for folder in PACKAGES for kind in ("*.hy", "*.lisp") for file in sorted(folder.rglob(kind))]
    source = "".join(file.read_text() for file in [*files, COURSE / "spiral.lisp"])
    for code in Page(path).texts("quotation"):
        if balanced(code):  # the piece of a form may end in the middle of a line
            code = code.rstrip().rstrip(")]")
        assert code.rstrip("\n") in source, code


@pytest.mark.parametrize("name", ELSEWHERE)
def test_a_page_whose_blocks_need_more_has_a_test_of_its_own(name):
    test = (ROOT / ELSEWHERE[name]).read_text()
    assert Page(DOCS / name).blocks or name == "common-lisp.md"
    assert name in test or "page" in test


def test_every_kind_of_block_is_on_some_page():
    kinds = {block.kind for path in PAGES for block in Page(path).blocks}
    assert kinds == {"session", "hy session", "file", "command", "python", "text", "quotation", "shell", "start"}


def test_a_block_of_another_language_is_refused():
    with pytest.raises(AssertionError, match="nobody runs blocks of perl"):
        Block("perl", None, "print 1;\n").kind


def test_a_form_ends_where_its_parentheses_are_closed():
    session = "TUT> (list 1\n       2)\n(1 2)\nTUT> 3\n3\n0] 0\n"
    assert [typed for typed, _ in exchanges(session)] == ["(list 1\n       2)", "3", "0"]
    assert "".join(text for _, text in exchanges(session)) == session


def test_the_picture_of_readme_is_drawn_by_the_plan_beside_it(tmp_path):
    """The seven lines of README and of the site's first page stand in ``tutorials/spiral.lisp``, which draws their picture."""
    spiral = COURSE / "spiral.lisp"
    for page in (ROOT / "README.md", DOCS / "index.md"):
        (plan,) = re.findall(r"```lisp\n(.*?)```", page.read_text(), re.S)
        assert plan in spiral.read_text() and plan.count("\n") == 7
        assert "spiral.replay.svg)" in page.read_text()
    words = [sys.executable, "-m", "cramhy_runtime.cli", "run", str(spiral), "--seed", "3", "--picture", "spiral.replay.svg"]
    subprocess.run(words, cwd=tmp_path, check=True, capture_output=True, timeout=60)
    assert (tmp_path / "spiral.replay.svg").read_text() == (DOCS / "tutorials" / "spiral.replay.svg").read_text()


def test_readme_is_short():
    assert len((ROOT / "README.md").read_text().splitlines()) <= 120


def test_the_python_of_readme_runs():
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.S)
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


@pytest.mark.soak
def test_the_tests_of_the_page_about_pytest_pass(tmp_path):
    for block in Page(DOCS / "how-to" / "pytest.md").blocks:
        if block.kind == "file":
            (tmp_path / block.title).write_text(block.text)
    words = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin"]
    done = subprocess.run(
        words, cwd=tmp_path, capture_output=True, text=True, env={**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}, timeout=120
    )
    assert done.returncode == 0 and re.search(r"\b3 passed", done.stdout), done.stdout + done.stderr


def test_the_page_of_the_command_line_is_what_the_parser_says():
    assert command_line.PAGE.read_text(encoding="utf-8") == command_line.text(), "make docs writes it anew"
    assert all(f"\n## cramhy {name}\n" in command_line.text() for name, _, _ in command_line.commands())
