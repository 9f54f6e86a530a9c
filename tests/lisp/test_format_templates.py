"""Constant controls of ``format``: the code that is written for them prints what the walk over the directives prints."""

import random

import pytest

from lisp_text import LispText

CONTROLS = [
    "~a",
    "~10a|",
    "~10@a|",
    "~8s|",
    "~d of ~d",
    "~5d|~5,'0d|~:d|~@d",
    "~3,'*d~:d",
    "~f",
    "~,2f",
    "~8,3f|",
    "~@f ~,1f",
    "~c~c",
    "~[zero~;one~;two~] ~[a~;b~:;many~]",
    "~:[no~;yes~]",
    "~{~a~^, ~}",
    "~{~a=~d~^; ~}|",
    "~{<~5d>~}",
    "~{~a ~}~%",
    "~&a line~%~a~%",
    "100% ~a",
    "no argument",
    "~d~% ~s ~a",
]
ARGUMENTS = ["5", "-7", "123456789", "0", "1.5", "-0.005", "2.5d0", "1e10", '"text"', ":key", "'sym", r"#\x", "nil", "t", "(list 1 2 3)"]
ARGUMENTS += ["(list 'a 1)", "(list 1)", '(list 1 "b" :c 4)', "'(1 (2) . 3)", "1/3", "(make-array 2 :initial-element 0)", "#c(1 2)"]


@pytest.fixture
def lisp(session):
    yield LispText(session, "(defpackage :format-templates (:use :cl)) (in-package :format-templates)")
    session.package = "COMMON-LISP-USER"


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("control", CONTROLS)
def test_the_code_prints_what_the_walk_prints(lisp, control):
    chosen, count = random.Random(control), sum(control.count(f"{tilde}{end}") for tilde in "~" for end in "~%&")
    count = 2 if control.count("~") - count > 1 else 1
    calls = [[chosen.choice(ARGUMENTS) for _ in range(count + 1)][: chosen.choice([count, count, count, count + 1])] for _ in range(6)]
    for arguments in calls:
        given = " ".join(arguments)
        text = f'"{control}"'
        shown = [
            f"(handler-case {form} (error (e) (type-of e)))"
            for form in (
                f"(format nil {text} {given})",
                f"(with-output-to-string (s) (format s {text} {given}))",
                f"(with-output-to-string (*standard-output*) (format t {text} {given}))",
                f"(let ((control (copy-seq {text}))) (format nil control {given}))",
                f"(with-output-to-string (s) (funcall (formatter {text}) s {given}))",
            )
        ]
        answers = lisp.values(f"(values {' '.join(shown)})")
        assert len({str(answer) for answer in answers}) == 1, (given, answers)


def test_lines_begin_where_they_should(lisp):
    assert (
        lisp.value('(with-output-to-string (s) (write-string "ab" s) (format s "~&c~a" 1) (format s "~%") (format s "~&d"))') == "ab\nc1\nd"
    )
    assert lisp(
        '(let ((s (make-string-output-stream))) (format s "ab~a" 1) (fresh-line s) (fresh-line s) (get-output-stream-string s))'
    ) == ('"ab1\n"')
    assert lisp.value('(let ((s (make-array 0 :element-type \'character :fill-pointer 0))) (format s "~a-~,1f" 1 2.0) s)') is not None
    assert lisp('(let ((s (make-array 0 :element-type \'character :fill-pointer 0))) (format s "~a-~,1f" 1 2.0) s)') == '"1-2.0"'


def test_variables_of_the_printer_are_looked_at(lisp):
    assert lisp('(let ((*print-base* 2)) (format nil "~a ~d ~{~a~}" 5 5 (list 5 6)))') == '"101 5 101110"'
    assert lisp("(let ((*print-case* :downcase)) (format nil \"~a ~s ~{~a~}\" 'foo :bar (list 'baz)))") == '"foo :bar baz"'


def test_digits_behind_the_point_are_those_of_the_long_way():
    from cramhy_runtime.languages.commonlisp.printer import float_printing
    from cramhy_runtime.lisp_core.floats import SingleFloat

    chosen, quick = random.Random(7), 0
    for _ in range(1500):
        number = chosen.choice([float, SingleFloat])(round(chosen.uniform(0, 10 ** chosen.randint(-4, 6)), chosen.randint(0, 8)))
        count = chosen.randint(1, 6)
        text = float_printing._rounded(number, count)
        if text is not None:
            quick += 1
            figures, e = float_printing.digits(number, -count)
            expected = (figures[:e] + "0" * (e - len(figures)) if e > 0 else "") + "."
            behind = figures[e:] if e > 0 else "0" * -e + figures
            assert text == expected + behind[:count].ljust(count, "0"), (number, count)
    assert quick > 500
