"""docs/projection.md: what it shows is what the REPL answers (`make docs` writes the answers of now), and all names are on it."""

import pytest
from tutorials.pages import OTHER_PAGES, Page, play

from .test_inventory import EXPORTS

PAGE = Page(OTHER_PAGES[0])


@pytest.mark.parametrize("backend", ["threads", "greenlet"])
def test_the_page_shows_what_the_repl_answers(tmp_path, backend):
    assert play(PAGE, tmp_path, backend) == PAGE.sessions


@pytest.mark.parametrize("package", EXPORTS)
def test_every_macro_and_variable_is_told_of(package):
    told = {name for name in EXPORTS[package].get("macro", "").split() + EXPORTS[package].get("variable", "").split()
            if name.lower() in PAGE.text}
    untold = {*EXPORTS[package].get("macro", "").split(), *EXPORTS[package].get("variable", "").split()} - told
    assert untold <= {"with-episode-knowledge", "*episode-knowledge*", "*last-episode-knowledge*"}
