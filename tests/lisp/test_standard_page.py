"""``docs/common-lisp.md`` is what the code makes, and a symbol that is not there says why when it is used."""

import re
import subprocess
import sys

import pytest
import standard_page

from cramhy_runtime.languages.commonlisp import standard_names
from cramhy_runtime.lisp_core.conditions import CompileError
from cramhy_runtime.lisp_core.data import UNBOUND, UndefinedFunction
from cramhy_runtime.lisp_core.packages import sym


@pytest.fixture(scope="module")
def page():
    """Made in a process of its own: other tests define things, and so many classes that to look for the names among them takes half a minute."""
    done = subprocess.run([sys.executable, standard_page.__file__, "--print"], capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_page_is_what_the_code_makes(page):
    assert standard_page.PAGE.read_text(encoding="utf-8") == page, "make docs writes it anew"


def test_every_symbol_is_there_or_has_a_reason(page):
    names = re.findall(r"^\| `(.*?)` \| (.+) \|$", page, re.M)
    assert len(names) == 978 and len({name for name, _ in names}) == 978
    assert not [name for name, what in names if what == "?"]
    absent = {name.upper() for name in re.findall(r"^\| `(.*?)` \|", page.partition("\n## Not there\n")[2], re.M)}
    assert absent == set(standard_names.ABSENT), "a reason for what is there, or none for what is not"
    assert len(names) - len(absent) >= 970
    assert not [name for name in standard_names.INSIDE if standard_names.is_there(sym(name))]


@pytest.mark.parametrize(
    ("form", "text"),
    [
        ("(call-next-method)", "CALL-NEXT-METHOD has a meaning only in the body of a method."),
        ("(list (make-method 1))", "MAKE-METHOD has a meaning only in the form of a DEFINE-METHOD-COMBINATION."),
        ("(loop-finish-is-mine otherwise)", "OTHERWISE has a meaning only as the key of the last clause of CASE and its relatives."),
        ("(list #'declare)", "DECLARE has a meaning only at the head of a body, before its forms."),
    ],
)
def test_a_name_used_where_it_means_nothing(session, form, text):
    with pytest.raises(CompileError) as caught:
        session.evaluate_text(f"(defun try ()\n  {form})", "<repl 1>")
    assert str(caught.value) == text
    assert caught.value.position[1] == 2


@pytest.mark.parametrize("use", ["(ed)", "*load-verbose*", "#'ed"])
def test_a_symbol_that_is_not_there_fails_when_it_is_compiled_with_the_reason(session, monkeypatch, use):
    name = use.strip("()#'").upper()
    symbol = sym(name)
    monkeypatch.setitem(standard_names.ABSENT, name, "There is no ~ here.")
    monkeypatch.setattr(symbol, "special", False)
    monkeypatch.setattr(symbol, "value", UNBOUND)
    monkeypatch.setattr(symbol, "function", UndefinedFunction(symbol))
    with pytest.raises(CompileError) as caught:
        session.evaluate_text(f"(defun try ()\n  (list 1\n    {use}))", "<repl 1>")
    assert str(caught.value) == f"{name} of Common Lisp is not part of cramhy. There is no ~ here."
    assert caught.value.position[:2] == ("<repl 1>", 3)
