"""The pages of the course: what they show is what the REPL answers, and what they quote stands in the package."""

from __future__ import annotations

import re

import pytest

from .course import BACKENDS
from .pages import FOLDER, PAGES, Page, balanced, exchanges, play, run

PACKAGE = FOLDER / "cram_my_beginner_tutorial"
STALE = "the page shows other answers than the REPL gives now; if these are right, `make docs` writes them into the page"


@pytest.fixture(params=PAGES, ids=lambda path: path.stem)
def page(request):
    return Page(request.param)


def pixels(path):
    image = pytest.importorskip("PIL.Image")
    return image.open(path).tobytes()


@pytest.mark.parametrize("backend", BACKENDS)
def test_the_repl_answers_what_the_page_shows_and_draws_its_pictures(page, backend, tmp_path):
    assert play(page, tmp_path, backend) == page.sessions, STALE
    shown = re.findall(r"^!\[.*\]\((.*)\)$", page.text, re.M)
    assert shown == [path.name for path in sorted(tmp_path.glob("*.png"))]
    for name in shown:
        assert pixels(tmp_path / name) == pixels(FOLDER / name), f"another picture than {name}; `make docs` stores this one"


def test_commands_print_what_the_page_shows(page, tmp_path):
    assert [run(block, tmp_path) for block in page.commands] == page.commands, STALE


def test_code_on_the_page_stands_in_the_package(page):
    source = "".join(path.read_text() for path in sorted(PACKAGE.rglob("*.hy")))
    for code in page.code:
        if balanced(code):  # the piece of a form may end in the middle of a line
            code = code.rstrip().rstrip(")")
        assert code.rstrip("\n") in source, code


def test_the_readme_leads_to_every_page_and_file():
    readme = (FOLDER / "README.md").read_text()
    for path in [*PAGES, *sorted((PACKAGE / "src").glob("*.hy"))]:
        assert path.name in readme, path.name


def test_pages_lead_to_files_that_exist(page):
    for target in re.findall(r"\]\(([^)#]+)\)", page.text):
        assert (FOLDER / target).exists(), target


def test_a_form_ends_where_its_parentheses_are_closed():
    session = "TUT> (list 1\n       2)\n(1 2)\nTUT> 3\n3\n0] 0\n"
    assert [typed for typed, _ in exchanges(session)] == ["(list 1\n       2)", "3", "0"]
    assert "".join(text for _, text in exchanges(session)) == session
