"""A plan package of twenty-six files, written for any Common Lisp, prints the same in cramhy as in SBCL, byte for byte.

``systems/kitchen-courier`` is a robot that tidies a kitchen: CLOS, conditions and restarts, macros that write macros, LOOP, FORMAT,
hash tables, packages whose conflicts are resolved by shadowing, tests in lisp-unit. ``transcript.txt`` beside it is what SBCL printed.
"""

import os
import shutil
import subprocess
from pathlib import Path

import pytest


SYSTEMS = Path(__file__).parent / "systems"
RECORDED = SYSTEMS / "kitchen-courier" / "transcript.txt"


def test_the_transcript_is_that_of_sbcl(session, monkeypatch):
    monkeypatch.setattr("cramhy_runtime.ros.search_folders.extra_folders", [str(SYSTEMS / "kitchen-courier")])
    session.package = "CL-USER"
    session.evaluate_text('(asdf:load-system "kitchen-courier/tests")')
    [text] = session.evaluate_text("""(with-output-to-string (*standard-output*)
                                        (funcall (intern "MAIN" "COURIER-PLANS"))
                                        (asdf:test-system "kitchen-courier/tests"))""")
    assert str(text).splitlines() == RECORDED.read_text().splitlines()
    assert str(text) == RECORDED.read_text()


@pytest.mark.soak
@pytest.mark.skipif(shutil.which("sbcl") is None, reason="SBCL is not installed")
def test_the_recorded_transcript_is_what_sbcl_prints(tmp_path):
    translations = f'(:output-translations (t "{tmp_path}/") :ignore-inherited-configuration)'
    run = subprocess.run(
        ["sbcl", "--script", str(SYSTEMS / "transcript.lisp")],
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, "ASDF_OUTPUT_TRANSLATIONS": translations},
    )
    assert run.stdout == RECORDED.read_text()


def test_a_macro_with_a_body_is_indented_like_one(session):
    session.package = "CL-USER"
    session.evaluate_text("(defmacro with-grip ((&rest clauses) &body body) `(progn ,clauses ,@body))")
    [text] = session.evaluate_text("""(let ((*print-right-margin* 30))
                                        (format nil "~S" '(with-grip (left right) (pick-up cup) (put-down cup))))""")
    assert str(text) == "(WITH-GRIP (LEFT RIGHT)\n  (PICK-UP CUP)\n  (PUT-DOWN CUP))"


def test_the_report_of_a_condition_breaks_where_the_line_ends(session):
    session.package = "CL-USER"
    session.evaluate_text('(define-condition long (error) () (:report (lambda (c s) c (format s "~S" \'(0 1 2 3 4 5 6 7 8)))))')
    [text] = session.evaluate_text('(let ((*print-right-margin* 30)) (format nil "12345678901234 ~A" (make-condition \'long)))')
    assert str(text) == "12345678901234 (0 1 2 3 4 5 6\n                7 8)"
