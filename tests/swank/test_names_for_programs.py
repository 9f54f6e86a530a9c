"""Names of SWANK and SLYNK that programs look for once one of the packages is there, such as libraries of readtables."""

from __future__ import annotations

import pytest

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.swank import package

NOTE = """
(defun cl-user::note-readtable (where)
  (let ((table (find-symbol "*READTABLE-ALIST*" (find-package where))))
    (when (boundp table)
      (let ((entry (cons "NOTES" *readtable*)))
        (setf (symbol-value table) (cons entry (remove "NOTES" (symbol-value table) :key #'car :test #'string=)))
        (mapcar #'car (symbol-value table))))))
"""


@pytest.fixture
def run(session):
    package.define()
    session.package = "CL-USER"
    return lambda text: prin1_to_string(session.evaluate_text(text, "<test>")[0])


@pytest.mark.parametrize("name", ["SWANK", "SLYNK"])
def test_a_program_notes_the_readtable_of_a_package(run, name):
    run(NOTE)
    assert run(f'(note-readtable "{name}")') == '("NOTES")'
    assert run(f'(note-readtable "{name}")') == '("NOTES")'
    assert run(f'(nth-value 1 (find-symbol "*READTABLE-ALIST*" "{name}"))') == ":EXTERNAL"
    run(f"(setf {name}:*readtable-alist* nil)")


@pytest.mark.parametrize("name", ["SWANK", "SLYNK"])
def test_a_program_binds_the_style_of_connections(run, name):
    assert (
        run(f"(list {name}:*communication-style* (let (({name}:*communication-style* nil)) {name}:*communication-style*))")
        == "(:SPAWN NIL)"
    )
