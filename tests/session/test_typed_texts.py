"""Texts typed at the prompt are kept for errors, but not all for ever."""

from __future__ import annotations

import linecache

from cramhy_runtime.session import typed_texts


def kept(prefix):
    return sum(name.startswith(prefix) for name in linecache.cache)


def test_the_newest_texts_are_kept_and_definitions_for_longer(monkeypatch):
    monkeypatch.setattr(typed_texts, "MOST", 20)
    monkeypatch.setattr(typed_texts, "MOST_DEFINITIONS", 50)
    typed_texts.keep("<typed definition>", "(DEFUN f () 1)")
    for number in range(300):
        typed_texts.keep(f"<typed {number}>", f"(f {number})")
    assert kept("<typed ") == 21 and linecache.getline("<typed 299>", 1) == "(f 299)"
    assert linecache.getline("<typed definition>", 1) == "(DEFUN f () 1)" and linecache.getline("<typed 100>", 1) == ""
    for number in range(300):
        typed_texts.keep(f"<typed d{number}>", "(defvar *x*)")
    assert kept("<typed ") == 70


def test_a_name_that_comes_again_is_not_forgotten(monkeypatch):
    monkeypatch.setattr(typed_texts, "MOST", 3)
    for number in range(10):
        typed_texts.keep("<--eval typed>", f"(f {number})")
    assert linecache.getline("<--eval typed>", 1) == "(f 9)"


def test_an_error_in_a_function_whose_text_is_gone_tells_its_place(type_in, monkeypatch):
    monkeypatch.setattr(typed_texts, "MOST_DEFINITIONS", 2)
    shown = type_in("(defun lost (x)\n  (car x))\n" + "(defvar *x* 1)\n" * 5 + "(lost 5)\nabort\n(+ 1 2)")
    assert "  at <repl 1>:2:3\n" in shown and shown.rstrip().endswith("3")
