"""The Tab key at a prompt of Hy: names of Hy, of our packages and of Lisp, and keywords of the call at hand."""

from __future__ import annotations

import types

import hy
import pytest
from hy.completer import Completer

from cramhy_runtime.repl.hy_tab import HyTab

from .conftest import REQUIRE, Door

IN_HY = {
    "an operator": ("(with-failure-h\t", "with-failure-handling"),
    "an operator with its package": ("(cpl:par-l\t [n [1]] n)", "cpl:par-loop"),
    "a package": ("(actionlib-l\t", "actionlib-lisp:"),
    "a macro of Hy's": ("(lfo\t n [1] n)", "lfor"),
    "a function of ours": ("(make-fl\t)", "make-fluent"),
    "a variable of the user's": ("door-st\t", "door-state"),
    "an attribute": ("sys.byteo\t", "sys.byteorder"),
    "a keyword of a function of ours": ("(make-fluent :na\t 'door)", ":name"),
    "a keyword of an operator, in a list that is no call": ("(with-task-suspended [t :rea\t 1])", ":reason"),
    "a keyword of a function of the user's": ("(turn 1 :ang\t 2)", ":angle"),
    "a process module behind a quote": ("(lisp-name 'pen-wh\t)", "pen-wheels"),
    "a word of a designator": ("(a motion (rolling-sp\t 3))", "rolling-speed"),
}
IN_LISP = {
    "an operator with its package": ("(cpl:par-l\t (n '(1)) n)", "cpl:par-loop"),
    "a function": ("(list-all-pac\t)", "list-all-packages"),
    "a function behind #'": ("(list #'list-all-pac\t)", "list-all-packages"),
    "a symbol behind a quote": ("(list 'list-all-pac\t)", "list-all-packages"),
    "a symbol of the user's": ("*door-st\t", "*door-state*"),
    "a keyword of a function": ("(make-hash-table :te\t 'equal)", ":test"),
    "a keyword of a function of ours": ("(cpl:make-fluent :na\t 'door)", ":name"),
    "a keyword of a function of the user's": ("(turn 1 :ang\t 2)", ":angle"),
    "a keyword of an operator, in a list that is no call": ("(cpl:with-task-suspended (t :rea\t 1))", ":reason"),
}
BEGIN_HY = [
    REQUIRE,
    "(import sys)",
    "(setv door-state 5)",
    "(defn turn [speed * [angle 0]] [speed angle])",
    "(def-process-module pen-wheels [motion] (reference motion))",
    "(setv rolling (a motion (rolling-speed 1)))",
]
BEGIN_LISP = ["(in-package :cl-user)", "(defvar *door-state* 5)", "(defun turn (speed &key (angle 0)) (list speed angle))"]


@pytest.fixture(scope="module")
def lines():
    """What stands in the line when Tab was pressed in all texts, typed one after the other at one prompt. Ctrl-C forgets each."""
    from .conftest import HY

    if not HY.exists():
        pytest.skip("hy is not installed beside Python")
    found = {}
    with Door(program=[str(HY)]) as repl:
        repl.expect("=> $")
        for beginning, typed, prompt in ((BEGIN_HY, IN_HY, "=> "), (BEGIN_LISP, IN_LISP, "CL-USER> ")):
            for text in beginning:
                repl.ask(text)
            for name, (text, _) in typed.items():
                repl.press(text + "\x03")
                found[prompt, name] = repl.expect(rf"\^C\n{prompt}$").partition("^C")[0]
        assert repl.ask("(list :still :there)") == "(:STILL :THERE)\nCL-USER> "
    return found


@pytest.mark.parametrize(
    "prompt, name", [*(("=> ", name) for name in IN_HY), *(("CL-USER> ", name) for name in IN_LISP)], ids=lambda each: each.strip()
)
def test_tab_completes(lines, prompt, name):
    typed, whole = (IN_HY if prompt == "=> " else IN_LISP)[name]
    rest = typed.partition("\t")[2]
    assert f"{whole}{rest}" in lines[prompt, name]


@pytest.mark.soak
def test_a_second_tab_lists_what_there_is(hy_terminal):
    with hy_terminal() as repl:
        repl.expect("=> $")
        repl.ask(REQUIRE)
        repl.press("(top-level (cpl:pa\t\t\t")  # up to where several go on, a bell, the list
        listed = repl.expect(r"\n=> \(top-level \(cpl:par$").split()
        assert {"cpl:par", "cpl:par-loop", "cpl:partial-order"} <= set(listed) and not any("::" in name for name in listed)
        repl.type(" 1 2))")
        assert repl.expect("\n=> $").endswith("\n1\n=> ")


@pytest.mark.soak
def test_in_a_form_of_several_lines_the_call_is_the_one_of_the_lines_before(hy_terminal):
    with hy_terminal() as repl:
        repl.expect("=> $")
        repl.ask(REQUIRE)
        assert repl.ask("(make-fluent") == "... "
        repl.press("  :na\t 'door)\n")
        assert repl.expect("\n=> $").endswith("#<FLUENT DOOR [NIL]>\n=> ")
        repl.ask("(in-package :cl-user)")
        assert repl.ask("(cpl:make-fluent") == "... "
        repl.press("  :na\t 'gate)\n")
        assert repl.expect("\nCL-USER> $").endswith("#<FLUENT GATE [NIL]>\nCL-USER> ")


# ----------------------------------------------------------------------------------------------------- without a terminal


@pytest.fixture
def tab(session, monkeypatch):
    """``tab(text)``: what the last word of ``text`` may become in Hy."""
    module = types.ModuleType("a_door")
    hy.eval(hy.read("(require cramhy *)"), module=module)
    completer = HyTab(types.SimpleNamespace(module=module, buffer=[]), lambda: False)
    return lambda text: completer.candidates(text, text[max(map(text.rfind, " \t\n()[]{}`~'")) + 1 :])


def test_a_string_and_a_word_that_nobody_knows_offer_nothing(tab):
    assert tab('(print "make-fl') == []
    assert tab('(print "a;b" make-fl') == ["make-fluent"]
    assert tab("(nobody-knows") == tab("(nowhere:x") == tab("(print (nobody :na") == tab(":na") == []


def test_the_innermost_call_that_is_known_says_which_keywords_there_are(tab):
    assert tab("(make-fluent :value (nobody :na") == [":name"]
    assert tab("(make-fluent :value (len :na") == []
    assert tab("(make-fluent :name 'a) :na") == []


def test_all_candidates_are_made_once_for_a_key(tab, monkeypatch):
    """Hy's completer made thousands of names anew for each candidate: one key took half a minute."""
    asked = []
    names = Completer.global_matches
    monkeypatch.setattr(Completer, "global_matches", lambda self, word: asked.append(word) or names(self, word))
    assert len(tab("(c")) > 50 and asked == ["c"]
