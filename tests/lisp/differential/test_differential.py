"""Random forms of seven chapters of Common Lisp answer as in SBCL 2.2.9, but for what ``docs/differences.md`` names.

``form_grammar.py`` makes the forms, ``two_lisps.py`` asks, ``named_differences.py`` says which differences are named, and ``shrinking.py``
makes what is shown small. ``recorded.jsonl`` holds SBCL's answers to some of the forms, and ``mended.jsonl`` those to forms that once
differed, so these tests run without SBCL. With SBCL, 840 new forms are asked, and with CRAMHY_SOAK=1 (``make soak``) 20,000 more. A series of
forms is fixed by its chapter and its seed, which a failure tells, so ``comparing.py CHAPTER COUNT SEED`` shows it again.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from comparing import Asked, questions, recorded, shown
from form_grammar import NAMES, Grammar
from named_differences import NAMED, named
from shrinking import shrunk

from cramhy_runtime import kernel

COMPARING = "tests/lisp/differential/comparing.py"
PAGE = Path(__file__).parents[3] / "docs" / "differences.md"
needs_sbcl = pytest.mark.skipif(shutil.which("sbcl") is None, reason="sbcl is not installed")
FORMS = 20_000
SEEDS = "first second third fourth".split()


@pytest.fixture(scope="module")
def asked():
    both = Asked()
    yield both
    both.theirs.close()
    kernel.stop()


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("chapter", NAMES)
def test_random_forms_answer_as_was_recorded(asked, chapter):
    check_recorded(asked, [entry for entry in recorded("recorded") if entry[0] == chapter])


@pytest.mark.soak
def test_what_was_mended_stays_so(asked):
    check_recorded(asked, recorded("mended"))


def check_recorded(asked, entries):
    assert entries
    for _, question, theirs in entries:
        ours = asked.answer(asked.ours, question)
        assert ours == theirs or named(question, theirs, ours), shown(question, theirs, ours)


@pytest.mark.soak
@needs_sbcl
@pytest.mark.parametrize("chapter", NAMES)
def test_random_forms_answer_as_in_sbcl(asked, chapter):
    check_live(asked, chapter, 120, "live")


@needs_sbcl
@pytest.mark.soak
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("chapter", NAMES)
def test_many_random_forms_answer_as_in_sbcl(asked, chapter, seed):
    check_live(asked, chapter, -(-FORMS // len(NAMES) // len(SEEDS)), seed)


def check_live(asked, chapter, count, seed):
    differing = [question for question in questions(chapter, count, seed) if asked.difference(question)]
    again = f"{len(differing)} of {count} forms differ; see them with: python {COMPARING} {chapter} {count} {seed}\n"
    assert not differing, again + "\n".join(shown(each, *asked.answers(each)) for each in differing[:5])


def test_each_named_difference_stands_on_its_page():
    page = " ".join(PAGE.read_text(encoding="utf-8").split())
    assert [difference.words for difference in NAMED if difference.words not in page] == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("chapter", NAMES)
def test_the_same_number_makes_the_same_form(chapter):
    grammars = Grammar(chapter), Grammar(chapter)
    assert [grammars[0].question(number, "1") for number in range(5)] == [grammars[1].question(number, "1") for number in range(5)]
    assert grammars[0].question(0, "1") != grammars[0].question(1, "1")


def test_a_grammar_with_an_unknown_name_or_without_an_end_is_refused(monkeypatch, tmp_path):
    monkeypatch.setattr("form_grammar.CHAPTERS", tmp_path)
    (tmp_path / "common.grammar").write_text("small = 1\n")
    (tmp_path / "endless.grammar").write_text("question = ({question})\n")
    with pytest.raises(ValueError, match="never end"):
        Grammar("endless")
    (tmp_path / "broken.grammar").write_text("question = 1\nno alternative\n")
    with pytest.raises(ValueError, match="no alternative"):
        Grammar("broken")


def test_a_text_may_be_likelier_and_may_hold_a_string(monkeypatch, tmp_path):
    monkeypatch.setattr("form_grammar.CHAPTERS", tmp_path)
    (tmp_path / "common.grammar").write_text("")
    (tmp_path / "some.grammar").write_text('question = 5| odd\n| even {"text}\ntext = "a\\b"\n')
    asked = [Grammar("some").question(number, "1") for number in range(20)]
    assert set(asked) == {"odd", r'even "\"a\\b\""'}
    assert asked.count("odd") > 10


def test_a_question_shrinks_to_what_matters():
    assert shrunk("(list (foo 1 (car 'x)) (let ((a 2)) #\\( (bad a)))", lambda text: "bad" in text and text.count("(") <= 9) == "bad"
    assert shrunk('(list 1 (f "a b" (g 2)) 3)', lambda text: text.startswith("(") and "(g" in text) == "(g)"
