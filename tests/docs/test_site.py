"""The site: it builds without a warning, and no link or anchor of any page is dead, on the site and on GitHub."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib

import pytest

from .pages import DOCS, ROOT

pytestmark = pytest.mark.soak

PAGES = [*sorted(ROOT.glob("*.md")), *sorted(DOCS.rglob("*.md")), ROOT / "tutorials" / "README.md"]
LINK = re.compile(r"\]\((?![a-z]+:)([^)\s#]*)(?:#([^)\s]+))?\)")
CODE = re.compile(r"^```.*?^```$", re.M | re.S)


def slug(heading):
    """The anchor that GitHub and the site give a heading."""
    words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", words.lower()).strip().replace(" ", "-")


def anchors(page):
    return {slug(heading) for heading in re.findall(r"^#+ (.*)$", CODE.sub("", page.read_text(encoding="utf-8")), re.M)}


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_no_link_is_dead(page):
    for target, anchor in LINK.findall(CODE.sub("", page.read_text(encoding="utf-8"))):
        there = (page.parent / target).resolve() if target else page
        assert there.exists() and ROOT in (there, *there.parents), f"{page.name}: there is no {target}"
        if anchor and there.suffix == ".md":
            assert anchor in anchors(there), f"{page.name}: {there.name} has no heading for #{anchor}"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the site, built with warnings as errors."""
    pytest.importorskip("material", reason="it builds the site: pip install mkdocs-material")
    folder = tmp_path_factory.mktemp("site")
    words = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, env={**os.environ, "NO_MKDOCS_2_WARNING": "1"}, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def test_the_site_has_every_page(site):
    built = {path.relative_to(site).with_suffix("").as_posix() for path in site.rglob("*.html")}
    ours = {path.relative_to(DOCS).with_suffix("").as_posix().replace("README", "index") for path in DOCS.rglob("*.md")}
    assert ours | {"ARCHITECTURE", "SECURITY", "CONTRIBUTING", "CHANGELOG", "tutorials/the-package"} <= built


def test_examples_in_several_languages_are_tabs(site):
    page = (site / "tutorials" / "first-plan.html").read_text(encoding="utf-8")
    written = (DOCS / "tutorials" / "first-plan.md").read_text(encoding="utf-8")
    for_one = len(
        re.findall(r"^<!-- (?:lisp|hy) -->\n+(?:```.*?^```\n|.+?\n)\n(?!<!-- (?:lisp|hy) -->)", written, re.M | re.S)
    )  # ends of boxes
    assert page.count('class="tabbed-set') == written.count("<!-- tabs -->") + for_one
    assert "<!-- lisp -->" not in page and "<!-- hy -->" not in page
    assert re.findall(r'<div class="tabbed-labels"><label[^>]*>(\w+)</label><label[^>]*>(\w+)</label>', page)[0] == ("Lisp", "Hy")


def test_the_first_use_of_a_word_leads_to_the_glossary(site):
    page = (site / "explanation" / "time.html").read_text(encoding="utf-8")
    assert page.count('href="../glossary.html#deadlock"') == 1
    assert "<h1" not in page.partition("glossary.html")[0][-20:]


def test_the_site_loads_nothing_from_elsewhere(site):
    for path in site.rglob("*.html"):
        loaded = re.findall(r'<(?:script|link|img)[^>]*(?:src|href)="(https?://[^"]+)"', path.read_text(encoding="utf-8"))
        assert not loaded, (path, loaded)


def test_the_tools_of_the_site_are_an_extra():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    assert any(name.startswith("mkdocs-material") for name in extras["docs"]) and "docs" in extras["dev"][0]


@pytest.mark.parametrize(
    ("heading", "expected"),
    [
        ("Why there is no answer: `explain`", "why-there-is-no-answer-explain"),
        ("The way of a `cmd_vel`", "the-way-of-a-cmd_vel"),
        ("6.3 Waiting", "63-waiting"),
    ],
)
def test_headings_have_the_anchors_of_github(heading, expected):
    assert slug(heading) == expected


def test_hints_are_closed_and_formatted_and_checks_are_not_shown(site):
    page = (site / "tutorials" / "first-forms.html").read_text(encoding="utf-8")
    assert re.search(r"<details>\s*<summary>Hint 1</summary>\s*<p>The function that multiplies is <code>\*</code>", page)
    assert "86400</" not in page.partition("the seconds of a day")[2].partition("<h2")[0]
    assert "details markdown" not in (site / "how-to" / "learn.html").read_text(encoding="utf-8"), "what a block shows stays as it is"
