"""UIOP: each form of ``uiop.txt`` has the values that SBCL's UIOP gives, and what that file cannot hold. ``make recorded`` asks it again."""

from pathlib import Path

import pytest
from systems import posix

from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.python.python_calls import watch

LINES = [line for line in (Path(__file__).parent / "uiop.txt").read_text().splitlines() if not line.startswith("; ")]


@pytest.mark.soak(all_but=23)
@posix
@pytest.mark.parametrize(("form", "answer"), list(zip(LINES[::2], LINES[1::2], strict=True)))
def test_a_form_has_the_values_of_sbcl(values, form, answer):
    try:
        told = f"=> {values(form, ' ; ')}"
    except Condition as problem:
        told = f"!! {class_name(type(problem)).name} {problem}"
    assert " ".join(told.split()) == answer.strip()


@posix
def test_a_program_that_fails_says_which_and_how(values):
    with pytest.raises(Condition) as caught:
        values("""(uiop:run-program '("sh" "-c" "exit 3"))""")
    assert caught.value.report().endswith('with command ("sh" "-c" "exit 3") exited with error code 3')
    assert values("""(handler-bind ((uiop:subprocess-error #'continue)) (uiop:run-program "exit 3"))""") == "NIL NIL 3"


def test_a_program_that_is_not_there_is_named(values):
    with pytest.raises(Condition) as caught:
        values("""(uiop:run-program '("/no/such/program"))""")
    assert caught.value.report() == """Couldn't execute "/no/such/program": No such file or directory"""


@posix
def test_others_go_on_while_a_task_waits_for_a_program(values):
    assert (
        values("""(let ((log nil))
      (cpl:top-level (cpl:par (progn (uiop:run-program '("sh" "-c" "read x < /dev/null; exit 0")) (push :program log))
               (push :other log)))
      log)""")
        == "(:PROGRAM :OTHER)"
    )


def test_a_grader_is_told_of_programs(values, monkeypatch):
    names = []
    monkeypatch.setattr(watch, "function", names.append)
    values("""(ignore-errors (uiop:run-program '("/no/such/program")))""")
    assert names == ["subprocess"]


def test_a_package_whose_used_packages_are_in_conflict(values):
    values("(uiop:define-package :uiop-first (:use :cl) (:export #:shared))")
    values("(uiop:define-package :uiop-second (:use :cl) (:export #:shared #:own))")
    try:
        values("(uiop:define-package :uiop-both (:mix :uiop-first :uiop-second :cl) (:export #:shared))")
        values("(uiop:define-package :uiop-both (:mix :uiop-first :uiop-second :cl) (:export #:shared))")  # a second time says nothing
        assert values("(list (symbol-package 'uiop-both:shared) 'uiop-both::own)") == '(#<PACKAGE "UIOP-FIRST"> UIOP-SECOND:OWN)'
    finally:
        values("(mapc #'uiop:delete-package* '(:uiop-both :uiop-second :uiop-first))")


def test_a_file_that_a_task_writes_is_whole_or_not_there(values, tmp_path):
    values(f"""(ignore-errors (uiop:with-staging-pathname (p "{tmp_path}/kept.txt")
      (uiop:with-output-file (s p :if-exists :supersede) (write-string "half" s)) (error "no")))""")
    assert list(tmp_path.iterdir()) == []
