"""The rest of CRAM-UTILITIES: dispatch on strings and lists, values kept for files (cpl.md 13.3)."""

import pytest

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string


@pytest.fixture
def value(session):
    session.package = "CL-USER"
    return lambda text: prin1_to_string(session.evaluate_text(text, "<test>")[0])


@pytest.mark.parametrize(
    "form, result",
    [
        ('(cut:string-case "Left" ("right" 1) (("up" "LEFT") 2) (t 3))', "2"),
        ('(cut:string-case "x" ("right" 1) (t 3))', "3"),
        ('(cut:string-case "x" ("right" 1))', "NIL"),
        ("(cut:destructure-case '(:move 1 2) ((:turn a) a) ((:move x y) (list y x)))", "(2 1)"),
        ("(cut:destructure-case '(:go) ((:turn a) a) (t :else))", ":ELSE"),
        ("(let ((l (list 1 2 3 4))) (list (cut:pop-if! #'evenp l) l))", "((1 3 4) (1 3 4))"),
        ("(funcall (cut:flip #'-) 1 5)", "4"),
        ('(cut:execute-string "(defparameter *executed* 5) (incf *executed*)") *executed*', "6"),
    ],
)
def test_values(value, form, result):
    assert value(form) == result


def test_a_value_is_computed_again_only_when_its_file_changes(value, tmp_path):
    path = tmp_path / "data"
    path.write_text("1")
    form = (
        f'(let ((n 0)) (list (cut:with-file-cache x "{path}" (incf n) x) (cut:with-file-cache x "{path}" (incf n) (+ x 10))'
        f' (cut:cached-file-value "{path}")))'
    )
    assert value(form) == "(1 11 1)"
    path.write_text("longer")
    again = f'(cut:cached-file-value "{path}")'
    assert value(f"(list {again} (setf {again} :new) {again})") == "(NIL :NEW :NEW)"


@pytest.mark.parametrize(
    "form, text",
    [
        ("(cut:destructure-case '(:go) ((:turn a) a))", "destructure-case failed: (:GO)"),
        ('(cut:cached-file-value "/no/such/file")', "The file /no/such/file cannot be looked at"),
    ],
)
def test_what_is_wrong(value, form, text):
    with pytest.raises(Condition) as caught:
        value(form)
    assert caught.value.report().startswith(text)
