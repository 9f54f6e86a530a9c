"""docs/hy.md: its blocks run one after the other and print what stands there, and the two columns of its table have the same values."""

from __future__ import annotations

import contextlib
import io
import re
import types
from pathlib import Path

import hy
import pytest

from cramhy_runtime.languages.hy.malformed import ProgramForm
from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.repl.session import Session

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "hy.md").read_text()
BLOCKS = re.findall(r"^```(hy|lisp|text)\n(.*?)^```$", PAGE, re.M | re.S)
ROWS = re.findall(r"^\| `([^`]*)` \| `([^`]*)` \|", PAGE.partition("## Names and packages")[0], re.M)


@pytest.fixture
def session():
    """A session in virtual time, in the package that the table's names are in."""
    yield (made := Session(time="virtual"))
    made.leave() if hasattr(made, "leave") else kernel.stop()


def module():
    return types.ModuleType("page_in_hy")


def in_hy(text, where):
    """The value of the last form of ``text``; each is compiled as in a file."""
    value = None
    for form in hy.read_many(text):
        value = hy.eval(ProgramForm(form), module=where)
    return value


@pytest.mark.soak
def test_the_blocks_print_what_stands_there(session):
    where, out, compared = module(), io.StringIO(), 0
    for kind, text in BLOCKS:
        if kind == "text":
            assert out.getvalue() == text
            out, compared = io.StringIO(), compared + 1
            continue
        with contextlib.redirect_stdout(out):
            if kind == "hy":
                in_hy(text, where)
            else:
                print(*session.evaluate_text(text))
    assert compared >= 6


def plain(value):
    """A value as both languages have it: lists are lists, symbols are names."""
    if isinstance(value, (Cons, list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, Symbol):
        return value.name
    if callable(value) or type(value).__name__ in ("Fluent", "ValueFluent"):
        return "an object"
    return value


def test_both_columns_of_the_table_have_the_same_values(session):
    where = module()
    in_hy("(require cramhy *)", where)
    session.evaluate_text("(defpackage :page-in-lisp (:use :cpl :desig :roslisp :cl-transforms)) (in-package :page-in-lisp)")
    assert len(ROWS) > 25
    for lisp, there in ROWS:
        in_lisp = plain(session.evaluate_text(lisp)[0])
        value = plain(in_hy(there.replace("\\|", "|"), where))
        if lisp.startswith(("(def", "(setf")):
            continue  # Hy's definitions have no value
        assert value == in_lisp, f"{lisp} is {in_lisp}, and {there} is {value}"


def test_the_readme_leads_to_the_page():
    assert "docs/hy.md" in (ROOT / "README.md").read_text()
    for target in re.findall(r"\]\(([^)#]+)\)", PAGE):
        assert (ROOT / "docs" / target).exists(), target
