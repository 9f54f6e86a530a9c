"""``docs/common-lisp.md`` is what the code makes, and a symbol that is not there says why when it is used."""

import re

import pytest

from cramhy_runtime.lisp import coverage, standard_names
from cramhy_runtime.lisp.conditions import CompileError

import standard_page


@pytest.fixture(scope="module")
def page():
    return standard_page.text()


def test_the_page_is_what_the_code_makes(page):
    assert standard_page.PAGE.read_text(encoding="utf-8") == page, "make docs writes it anew"


def test_every_symbol_is_there_or_has_a_reason(page):
    names = re.findall(r"^\| `(.*?)` \| (.+) \|$", page, re.M)
    assert len(names) == 978 and len({name for name, _ in names}) == 978
    assert not [name for name, what in names if what == "?"]
    absent = {name for name, _, kinds in coverage.table() if not kinds}
    assert absent == set(standard_names.ABSENT), "a reason for what is there, or none for what is not"
    assert len(names) - len(absent) >= 965


@pytest.mark.parametrize(("form", "text"), [
    ("(call-next-method)", "CALL-NEXT-METHOD has a meaning only in the body of a method."),
    ("(list (pprint-pop))", "PPRINT-POP has a meaning only in the body of PPRINT-LOGICAL-BLOCK."),
    ("(loop-finish-is-mine otherwise)", "OTHERWISE has a meaning only as the key of the last clause of CASE and its relatives."),
    ("(list #'declare)", "DECLARE has a meaning only at the head of a body, before its forms."),
])
def test_a_name_used_where_it_means_nothing(session, form, text):
    with pytest.raises(CompileError) as caught:
        session.evaluate_text(f"(defun try ()\n  {form})", "<repl 1>")
    assert str(caught.value) == text
    assert caught.value.position[1] == 2


@pytest.mark.parametrize("name", sorted(standard_names.ABSENT))
def test_a_symbol_that_is_not_there_fails_when_it_is_compiled_with_the_reason(session, name):
    reason = standard_names.ABSENT[name]
    with pytest.raises(CompileError) as caught:
        session.evaluate_text(f"(defun try ()\n  (list 1\n    cl:{name.lower()}))" if name.startswith("*") else
                              f"(defun try ()\n  (list 1\n    (cl:{name.lower()} 2)))", "<repl 1>")
    assert str(caught.value) == f"{name if name.startswith('*') else name} of Common Lisp is not part of cramhy. {reason}"
    assert caught.value.position[:2] == ("<repl 1>", 3)
