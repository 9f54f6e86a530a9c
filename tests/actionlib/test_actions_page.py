"""docs/actions.md: what stands there is what the REPL answers (`make docs`)."""

import pytest
from tutorials.pages import OTHER_PAGES, Page, play

PAGE = Page(next(path for path in OTHER_PAGES if path.name == "actions.md"))


@pytest.mark.parametrize("backend", ["threads", "greenlet"])
def test_the_page_shows_what_the_repl_answers(tmp_path, backend):
    assert play(PAGE, tmp_path, backend) == PAGE.sessions
