"""Nothing in the repository points outside of it: each cited page is there, and has the section that is cited."""

from __future__ import annotations

import functools
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDERS = [ROOT / name for name in ("src", "hy_src", "tests", "benchmarks", "tutorials", "docs")]
PAGES = {path.name: path for folder in ("", "tutorials", "docs", "docs/reference") for path in (ROOT / folder).glob("*.md")}
PAGES |= {
    path.name: path
    for folder in ("tutorials", "tutorials/kitchen", "how-to", "explanation")
    for path in (ROOT / "docs" / folder).glob("*.md")
}


@functools.cache
def sections(page):
    """The numbers of the sections of a page, like "6" and "6.3"."""
    return set(re.findall(r"^#+ (\d+(?:\.\d+)*)", page.read_text(), re.M))


def texts():
    """(path below the root, text) of each file that a person wrote."""
    for folder in FOLDERS:
        for path in sorted(folder.rglob("*")):
            if path.suffix in (".py", ".hy", ".lisp", ".md", ".js", ".html", ".css") and path != Path(__file__):
                yield path.relative_to(ROOT), path.read_text(encoding="utf-8")


@pytest.mark.soak
def test_each_cited_page_is_here():
    cited = {(str(path), name) for path, text in texts() for name in re.findall(r"(?<![\w./-])([a-z][a-z-]+\.md)\b", text)}
    assert len(cited) > 200
    assert not sorted((path, name) for path, name in cited if name not in PAGES)


@pytest.mark.soak
def test_each_cited_section_is_in_its_page():
    citations = [
        (str(path), name, number)
        for path, text in texts()
        for name, number in re.findall(r"\b([a-z][a-z-]+\.md),? (?:sections? )?(\d+(?:\.\d+)*)", text)
    ]
    assert len(citations) > 200
    missing = [(path, name, number) for path, name, number in citations if number not in sections(PAGES[name])]
    assert not missing


def test_no_comment_names_a_folder_beside_the_repository():
    beside = [str(path) for path, text in texts() if "../shared" in text and path.parts[0] != "tests"]
    assert not beside
