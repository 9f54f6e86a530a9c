"""The pages keep the house's English: the actor first, short sentences, no figures of speech that a third language stumbles over."""

from __future__ import annotations

import re

import pytest

from .pages import DOCS, ROOT

PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md", "ARCHITECTURE.md", "CHANGELOG.md", "tutorials/README.md")]
PAGES += [path for path in sorted(DOCS.rglob("*.md")) if path.parent.name != "reference"]

FORBIDDEN = {
    r"^\W*(?:What|Who|Whoever|Whatever|Whom)\b(?!.*\?$)(?! if\b)": "the actor comes first: not 'What fails is logged', but 'Failures are logged'",
    r"(?<![Tt]here )\b(?:is|are|was|were) no\b(?! longer\b| more\b|-op|\b primary method\b)": "'is not a', never 'is no'",
    r"\bone's own\b": "'your own' or 'its own'",
    r"\b(?:to be had|cannot be had)\b": "'is there', 'is missing'",
}
LONGEST = 45
"""Words in a sentence. Most have fewer than twenty."""


def sentences(text):
    """The sentences of a page, without code, headings and links; each cell of a table counts as one."""
    text = re.sub(r"^```.*?^```$|^#.*?$|<!--.*?-->", "\n", text, flags=re.M | re.S)
    text = re.sub(r"`[^`]*`", "X", text)
    text = re.sub(r"\]\([^)]*\)", "]", text)
    text = re.sub(r"^\|.*$", lambda row: row[0].replace("|", "\n\n"), text, flags=re.M)
    for part in re.split(r"\n\s*\n|^\s*(?:[*-]|\d+\.) ", text, flags=re.M):
        for sentence in re.split(r"(?<=[.!?:])\s+(?=[A-Z(*X\[\"])", " ".join(part.split())):
            yield sentence.strip()


def faults(text):
    for sentence in sentences(text):
        for pattern, advice in FORBIDDEN.items():
            if re.search(pattern, sentence):
                yield f"{sentence!r}: {advice}"
        if len(sentence.split()) > LONGEST:
            yield f"{sentence!r}: {len(sentence.split())} words"


@pytest.mark.soak(all_but=16)
@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_the_sentences_are_plain(page):
    assert not list(faults(page.read_text(encoding="utf-8")))


@pytest.mark.parametrize(
    "sentence",
    [
        "What fails is logged.",
        "Who leaves it cancels the goal.",
        "It runs. *Whatever* is left is ended.",
        "A failure is no exception.",
        "Messages of one's own.",
        "word " * 60 + "end.",
    ],
)
def test_a_sentence_of_another_kind_is_found(sentence):
    assert list(faults(sentence))


@pytest.mark.parametrize(
    "sentence",
    [
        "Failures are logged.",
        "What fails?",
        "There is no way back.",
        "The task is no longer alive.",
        "`What fails is logged.`",
        "Tell what fails.",
    ],
)
def test_plain_sentences_are_left_alone(sentence):
    assert not list(faults(sentence))
