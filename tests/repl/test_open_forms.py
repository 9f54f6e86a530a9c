"""What is open at the end of the lines that have been typed, and that no line is read twice for it."""

from __future__ import annotations

import pytest
from hypothesis import example, given, strategies

from cramhy_runtime.lisp_core.data import Character
from cramhy_runtime.languages.commonlisp.reader.reader import incomplete, set_macro_character
from cramhy_runtime.languages.commonlisp.reader.readtables import READTABLE, STANDARD
from cramhy_runtime.repl import listener
from cramhy_runtime.repl.open_forms import OpenForms, of_lisp


def after(*lines, hy=False):
    opened = OpenForms(hy)
    for line in lines:
        opened.read(f"{line}\n")
    return opened


@pytest.mark.parametrize(
    "lines, prompt",
    [
        (["(par"], "par 1> "),
        (["(top-level", "  (par (drive 1)"], "par 2> "),
        (["(let ((x 1)"], "( 2> "),
        (["((lambda (x)"], "lambda 2> "),
        (["("], "( 1> "),
        (['(format t "hello'], '" 1> '),
        (["(list #| a (comment"], "#| 1> "),
        (["#| #| |#"], "#| 0> "),
        (["(list |a symbol"], "| 1> "),
        (["(list '(a b"], "a 2> "),
        (["(cpl-impl::with-failure-handling ((f () (retry)"], "f 3> "),
        (["(with-a-very-long-name-of-an-operator x"], "with-a-very-long-n.. 1> "),
        (["'"], "... "),
    ],
)
def test_the_prompt_names_what_is_open_and_how_many_lists_are(lines, prompt):
    assert after(*lines).prompt() == prompt


@pytest.mark.parametrize(
    "lines, prompt",
    [
        (["(defn drive [x"], "[ 2> "),
        (["(par {:a 1"], "{ 2> "),
        (["(par", "  (drive"], "drive 2> "),
        (['(print f"a {b}'], '" 1> '),
        (["(print #[end[ ) ]]"], "#[[ 1> "),
    ],
)
def test_the_prompt_names_what_is_open_in_hy(lines, prompt):
    assert after(*lines, hy=True).prompt() == prompt


@pytest.mark.parametrize(
    "text",
    [
        '(a "(" b)',
        r'(a "\"(" b)',
        r"(list #\( #\" #\; #\|)",
        "(a ; (\n)",
        "(a #|(|# b)",
        "(a |(| b)",
        r"(a \( b)",
        "(a#|(|)",
        r"(|\|(|)",
        "a) b",
        ")",
    ],
)
def test_what_only_looks_like_an_opening_parenthesis_opens_nothing(text):
    assert not after(*text.split("\n")).something


@pytest.mark.parametrize("text", ['(a "(" b)', '(a r"\\"" b)', "(a #[[(]] b)", "(a #[x[ ]] ]x] b)", "(a ; (\n)", "[1 {2 3}]", '(a b-"(")'])
def test_what_only_looks_like_an_opening_bracket_of_hy_opens_nothing(text):
    assert not after(*text.split("\n"), hy=True).something


def test_a_bracket_that_closes_another_kind_is_a_matter_for_the_reader():
    assert after("(defn f [x)", hy=True).wrong
    assert not after("(defn f [x)", hy=True).something


PIECES = [
    "(",
    ")",
    " ",
    "\n",
    "a",
    "foo",
    '"',
    "|",
    "#|",
    "|#",
    ";",
    "\\",
    "#\\",
    "#\\(",
    "'",
    "`",
    ",",
    "#'",
    "#(",
    "1.5",
    ":k",
    "#",
    "x#",
]


@given(strategies.lists(strategies.sampled_from(PIECES), max_size=14).map("".join))
@example('(a "b\\')
@example("a#|(|#")
@example("#1\\(")
@example("#\\#|")
def test_what_is_open_by_this_account_is_open_for_the_reader_too(text):
    """Or the reader finds it malformed before it gets so far. Otherwise a prompt would wait for a parenthesis that nobody owes it."""
    if after(*text.split("\n")).something and not text.endswith("\\"):
        closed = text + "\n" + closing(after(*text.split("\n")))
        assert incomplete(text) or not incomplete(closed)
        assert not after(*closed.split("\n")).something


def closing(opened):
    ends = {'"': '"', "|": "|", "#|": " |#" * max(1, opened._depth), None: ""}
    return ends[opened.within] + ")" * len(opened.lists)


def test_where_a_program_has_changed_the_syntax_the_reader_alone_decides():
    table = READTABLE.value
    READTABLE.value = STANDARD.copy()
    try:
        assert of_lisp() is not None
        set_macro_character(Character("["), lambda stream, char: None)
        assert of_lisp() is None
    finally:
        READTABLE.value = table


def test_a_form_of_many_lines_is_read_in_proportion_to_its_length(type_in, monkeypatch):
    """The reader is asked once whether the form is complete, and each line is looked at once."""
    asked, looked_at = [], []
    monkeypatch.setattr("cramhy_runtime.languages.commonlisp.reader.reader.incomplete", lambda text: asked.append(text) or incomplete(text))

    class Counted(OpenForms):
        def read(self, line):
            looked_at.append(line)
            super().read(line)

    monkeypatch.setattr(listener, "of_lisp", Counted)
    lines = ["(length '(", *['  (a "b (" c) ; d' for _ in range(2000)], "))"]
    assert type_in("\n".join(lines)).endswith("2000\n")
    assert [text.count("\n") for text in asked] == [len(lines) - 1]
    assert len(looked_at) == len(lines)


def test_a_pipe_gets_no_prompt_for_a_line_that_goes_on(type_in):
    assert type_in("(list 1\n2)") == "CPL-USER> (list 1\n2)\n(1 2)\n"


def test_hys_loop_gets_a_form_of_many_lines_as_one_text(monkeypatch):
    """Else it would read the text anew at each line."""
    import sys

    import hy

    from cramhy_runtime import kernel
    from cramhy_runtime.repl import hy_prompt
    from cramhy_runtime.repl.session import Session

    from .conftest import Script

    prompts = []

    class Typed(Script):
        def line(self, prompt):
            prompts.append(prompt)
            return self.lines.pop(0) if self.lines else None

    monkeypatch.setattr(sys, "ps1", "=> ", raising=False)
    monkeypatch.setattr(sys, "ps2", "... ", raising=False)
    repl = hy.REPL()
    try:
        hy_prompt.attend(repl, Session(time="virtual", turtlesim=False))
        repl.lisp.input = Typed('(list [1 "a (\n)" #[[ ( ]]\n2])\n(+ 1 1)\n(defn f [x)\n(+ 2\n')
        assert repl.raw_input("=> ") == '(list [1 "a (\n)" #[[ ( ]]\n2])'
        assert prompts == ["=> ", "... ", "... "]  # it is not a terminal
        assert repl.raw_input("=> ") == "(+ 1 1)"
        assert repl.raw_input("=> ") == "(defn f [x)"  # wrong, as Hy will say
    finally:
        kernel.stop()
