"""The record of what a student has typed: the last form, the form that gave a variable its value, and definitions in vain."""

from __future__ import annotations

import pytest

from cramhy_runtime.course.typed_forms import TypedForms, forms
from cramhy_runtime.languages.answered_texts import Answered


def typed(*texts):
    """A record of texts that were answered, but for those with "#<", which led to an error."""
    record = []
    for text in texts:
        record.append(Answered(text, "lisp", None))
        record[-1].end(good="#<" not in text)
    return TypedForms(record)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("1", ["1"]),
        ("(a b) (c)", ["(a b)", "(c)"]),
        ("'(a) ; (c)\n`(b ,d)", ["'(a)", "`(b ,d)"]),
        ('(f ")" #\\( [x]) :k "a b"', ['(f ")" #\\( [x])', ":k", '"a b"']),
        ("#'car", ["#'car"]),
        ("", []),
        ("(open", []),
    ],
)
def test_a_text_is_cut_into_forms(text, found):
    assert forms(text) == found


@pytest.mark.parametrize(
    ("texts", "variable", "found"),
    [
        (["(+ 1 2)", "(* 24 60) (* 3 4)"], None, "(* 3 4)"),
        (["(+ 1 2)", "(car #<)"], None, "(+ 1 2)"),
        ([], None, None),
        (["(defvar *a* (* 4 *s*))"], "*a*", "(* 4 *s*)"),
        (["(defvar *a* 0)", "(setf *A* (* *s* 4))", "*a*", "(+ *a* 1)"], "*a*", "(* *s* 4)"),
        (["(setv side 4 around (* side 4))"], "around", "(* side 4)"),
        (["(setv side 4)"], "around", None),
        (["(setf *b* *a*)"], "*a*", None),
    ],
)
def test_the_form_that_counts_is_found(texts, variable, found):
    assert typed(*texts).form(variable) == found


@pytest.mark.parametrize(
    ("texts", "name"),
    [
        (["(defun f () 1)", "(defun f () #<)"], "f"),
        (["(defun f () 1)", "(defun f () #<)", "(f)"], "f"),
        (["(defun f () 1)", "(defun f () #<)", "(defun f () 2)"], None),
        (["(defun f () #<)"], None),
        (["(defun f () 1)", "(g #<)"], None),
        (["(defn f [] 1)", "(defn [g] f [] #<)"], "f"),
        (["(def-fact-group g () (<- (a)))", "(def-fact-group G () #<)"], "g"),
        (["(defun f () 1)\n(defun g () 2)", "(defun h () 1)\n(defun g () #<)"], "g"),
    ],
)
def test_a_definition_in_vain_is_noticed_while_an_older_one_counts(texts, name):
    assert typed(*texts).refused() == name
