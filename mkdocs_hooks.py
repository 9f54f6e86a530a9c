"""What the site does with pages that are written for GitHub, too: pages beside ``docs``, tabs, links to the glossary.

* The pages of the root, and the one of ``tutorials``, become pages of the site. Links to other files of the repository lead to the
  repository if its address is known (CRAMHY_REPOSITORY), and else are plain words.
* Blocks of code below the comment ``<!-- tabs -->`` become tabs, one for each language. Where the languages are the same, the first
  block is for Lisp and the second one for Hy.
* Paragraphs and blocks below ``<!-- lisp -->`` and ``<!-- hy -->`` become tabs, too; so each says for whom it is.
* Hints, which GitHub shows as ``<details>``, are Markdown inside.
* The first use of a word of the glossary on a page becomes a link to its entry.
"""

from __future__ import annotations

import os
import posixpath
import re
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).parent
PAGES = {name: name for name in ("ARCHITECTURE.md", "SECURITY.md", "CONTRIBUTING.md", "CHANGELOG.md")}
PAGES["tutorials/README.md"] = "tutorials/the-package.md"
"""Pages that are not in ``docs``, by their path in the repository: their path on the site."""

FENCE = re.compile(r"^```(\w*)[^\n]*\n.*?^```$", re.M | re.S)
TABS = re.compile(r"^<!-- tabs -->\n\n((?:```\w*[^\n]*\n(?:.*\n)*?```\n\n?){2,})", re.M)
MARKED = re.compile(r"(?:^<!-- (?:lisp|hy) -->\n+(?:```[^\n]*\n.*?^```$|[^\n]+(?:\n[^\n]+)*)(?:\n\s*\n|\n?\Z))+", re.M | re.S)
ONE_MARKED = re.compile(r"^<!-- (lisp|hy) -->\n+(```[^\n]*\n.*?^```$|[^\n]+(?:\n[^\n]+)*)", re.M | re.S)
LABELS = {"lisp": "Lisp", "hy": "Hy", "python": "Python"}
LINK = re.compile(r"(!?)\[((?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*)\]\((?![a-z]+:|#)([^)\s#]+)(#[^)\s]*)?\)")
APART = re.compile(r"(^```.*?^```$|^#.*?$|^\|.*?$|^!!!.*?$|`[^`\n]*`|!?\[[^\]]*\]\([^)]*\)|<!--.*?-->)", re.M | re.S)
"""Parts of a page in which no word becomes a link."""
ENTRIES = re.findall(r"^### (.*)$", (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8"), re.M)
SKIPPED = {"Form", "Package", "System", "Ground", "Plan", "Task", "Location", "Action", "Motion", "Perform", "Service", "Session", "Park"}
"""Entries whose word is also an everyday word: only pages that mean the entry link to it themselves."""


def on_files(files, config):
    for source in PAGES:
        files.append(File.generated(config, PAGES[source], content=(ROOT / source).read_text(encoding="utf-8")))
    return files


def on_page_markdown(markdown, page, config, files):
    place = page.file.src_uri
    source = next((source for source, there in PAGES.items() if there == place), f"docs/{place}")
    text = with_links(markdown, source, place, {file.src_uri for file in files})
    if not place.startswith("reference/") and place not in ("glossary.md", "CHANGELOG.md"):
        text = with_glossary(text, posixpath.relpath("glossary.md", posixpath.dirname(place) or "."))
    return with_tabs(with_marked(with_hints(text)))


def with_marked(text):
    """A page's text in which what is for one language is in a tab: neighbours of both languages are one box."""

    def tabs(match):
        pieces: dict[str, list[str]] = {}
        for language, piece in ONE_MARKED.findall(match[0]):
            pieces.setdefault(language, []).append(re.sub(r"^(?=.)", "    ", piece, flags=re.M))
        return _box((LABELS[language], "\n\n".join(each)) for language, each in pieces.items())

    return MARKED.sub(tabs, text)


def with_hints(text):
    """A page's text in which Markdown within ``<details>`` counts, but not where a block of code shows one."""
    parts = re.split(r"(^(`{3,}).*?^\2$)", text, flags=re.M | re.S)
    return "".join(
        part if place % 3 == 1 else part.replace("<details><summary>", '<details markdown="1"><summary>')
        for place, part in enumerate(parts)
        if place % 3 != 2
    )


def with_links(text, source, place, there):
    """A page's text with links as the site has them. ``source``, ``place``: its paths in the repository and on the site."""
    folder = posixpath.dirname(source)

    def link(match):
        picture, words, target, anchor = match.groups()
        words = LINK.sub(link, words)
        path = posixpath.normpath(posixpath.join(folder, target))
        wanted = PAGES.get(path, path.removeprefix("docs/") if path.startswith("docs/") else None)
        if wanted in there:
            return f"{picture}[{words}]({posixpath.relpath(wanted, posixpath.dirname(place) or '.')}{anchor or ''})"
        assert (ROOT / path).exists(), f"{source}: a link to {target}, which is not there"
        repository = os.environ.get("CRAMHY_REPOSITORY", "").rstrip("/")
        return f"[{words}]({repository}/blob/main/{path}{anchor or ''})" if repository else words

    parts = re.split(r"(^```.*?^```$)", text, flags=re.M | re.S)
    return "".join(part if part.startswith("```") else LINK.sub(link, part) for part in parts)


def with_tabs(text):
    def tabs(match):
        blocks = [block for block in FENCE.finditer(match[1])]
        languages = [block[1] for block in blocks]
        labels = [LABELS.get(language, language) for language in languages]
        if len(set(languages)) == 1:
            labels = ["Lisp", "Hy"]
        shown = []
        for label, block in zip(labels, blocks, strict=True):
            indented = re.sub(r"^(?=.)", "    ", block[0], flags=re.M)
            shown.append((label, indented))
        return _box(shown)

    return TABS.sub(tabs, text)


def _box(tabs):
    """The Markdown of a box of (label, indented text); the exclamation mark keeps it apart from a box right before it."""
    return "".join(f'==={"" if number else "!"} "{label}"\n\n{text}\n\n' for number, (label, text) in enumerate(tabs))


def with_glossary(text, glossary):
    """A page's text with a link to the glossary at the first use of each of its words."""
    parts = APART.split(text)
    for entry in ENTRIES:
        if entry in SKIPPED or f"{glossary}#{anchor_of(entry)}" in text:
            continue
        word = re.compile(rf"\b({re.escape(entry)}(?:e?s|d|ed)?)\b", re.I)
        for number in range(0, len(parts), 2):
            found = word.search(parts[number])
            if found:
                link = f"[{found[1]}]({glossary}#{anchor_of(entry)})"
                parts[number : number + 1] = [parts[number][: found.start()], link, parts[number][found.end() :]]
                break
    return "".join(parts)


def anchor_of(entry):
    return entry.lower().replace(" ", "-")
