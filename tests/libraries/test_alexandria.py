"""Alexandria: each form of ``alexandria.txt`` has the values that the library gives on SBCL. ``record.lisp`` says how that file is made."""

from pathlib import Path

import pytest

from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.conditions import Condition

RECORDED = Path(__file__).parent / "alexandria.txt"


def recorded():
    """(form, what the library answered) of each line."""
    lines = [line for line in RECORDED.read_text().splitlines() if not line.startswith("; ")]
    return list(zip(lines[::2], lines[1::2], strict=True))


@pytest.mark.soak(all_but=10)
@pytest.mark.parametrize(("form", "answer"), recorded())
def test_a_form_has_the_values_of_the_library(values, form, answer):
    try:
        told = f"=> {values(form, ' ; ')}"
    except Condition as problem:
        told = f"!! {class_name(type(problem)).name} {problem}"
    assert " ".join(told.split()) == answer


def test_files(values, tmp_path):
    path = tmp_path / "text"
    values(f'(alexandria:write-string-into-file "one{chr(10)}two" "{path}")')
    assert values(f'(alexandria:read-file-into-string "{path}")') == '"one\ntwo"'


def test_every_name_is_defined(values):
    """Every external symbol is a function, a macro or a type."""
    assert (
        values("""(let (missing)
      (do-external-symbols (symbol :alexandria missing)
        (unless (or (fboundp symbol) (member symbol '(alexandria:array-index alexandria:array-length))
                    (ignore-errors (typep 1 symbol) t))
          (push symbol missing))))""")
        == "NIL"
    )


def test_the_library_is_loaded_when_its_package_is_named(values):
    assert values("(package-name (find-package :alexandria))") == '"ALEXANDRIA"'
    values("(defpackage :plans-with-curry (:use :cl) (:import-from :alexandria #:curry))")
    try:
        assert values("(funcall (plans-with-curry::curry #'+ 1) 2)") == "3"
    finally:
        values("(delete-package :plans-with-curry)")
