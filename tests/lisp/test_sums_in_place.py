"""``incf`` and ``decf`` of local variables: the compiler puts the delta into the sum where the order of evaluation cannot be seen."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

# what SBCL answers
ORDER = [
    ("(let ((x 0)) (flet ((f () (setf x 10) 1)) (incf x (f)) x))", "11"),
    ("(let ((x 0)) (incf x (progn (setq x 10) 1)) x)", "11"),
    ("(let ((x 0)) (setf (symbol-function 'change) (lambda () (setq x 10) 1)) (incf x (change)) x)", "11"),
    ("(let ((x 10)) (decf x (let ((y 2)) (incf y (abs -3)) y)) x)", "5"),
    ("(let ((x 10)) (decf x (progn (dotimes (i 3) (decf x)) 1)) x)", "6"),
    ("(let ((x 1)) (incf x (if (> x 2) 3 (return-from out (list :out x)))) x)", "(:OUT 1)"),
    ("(let ((x 3)) (incf x (values 1 2)) x)", "4"),
    ("(let ((x 3)) (list (incf x (length '(1 2))) x))", "(5 5)"),
    ("(let ((x 3)) (dotimes (i 3) (incf x (* i (abs -2)))) x)", "9"),
    ("(let ((x 1.5)) (incf x (expt 2 3)) x)", "9.5"),
    ("(let ((x 3)) (incf x (incf x (abs 1))) x)", "8"),
    ("(let ((x 3)) (handler-case (incf x (string :a)) (type-error () (list :refused x))))", "(:REFUSED 3)"),
]


@pytest.fixture(scope="module")
def session():
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


@pytest.mark.parametrize("form, answer", ORDER)
def test_the_delta_is_evaluated_before_the_place_is_read(session, form, answer):
    *_, found = session.evaluate_text(f"(defun in-place () (block out {form})) (in-place)")
    assert prin1_to_string(found) == answer


TEXTS = [
    ('(format nil "~a 100%s % ~s~%~d" "50%s" :kitchen x)', "50%s 100%s % :KITCHEN\n4", "50%s 100%s % :kitchen\n4"),
    ('(format nil "~s" :abc)', ":ABC", ":abc"),
    ('(format nil "~a~s" "a%b" :|foo bar|)', "a%b:|foo bar|", "a%b:|foo bar|"),
    ('(format nil "~a" "abc")', "abc", "abc"),
    ('(format nil "~s ~s" :kitchen x)', ":KITCHEN 4", ":kitchen 4"),
]


@pytest.mark.parametrize("form, upper, lower", TEXTS)
def test_known_arguments_of_format_stand_in_the_text(session, form, upper, lower):
    """Also when the program changes the case of names, and the result is a string into which it may store."""
    *_, found = session.evaluate_text(
        f"""(defun told (x) x {form})
        (list (told 4) (let ((*print-case* :downcase)) (told 4)) (let ((s (told 4))) (setf (char s 0) #\\x) (subseq s 0 1)))"""
    )
    assert list(found) == [upper, lower, "x"]


def test_known_names_are_printed_for_the_readtable_of_now(session):
    *_, found = session.evaluate_text(
        """(defun told (x) (list (format nil "~s" :abc) (format nil "~s" x)))
        (let ((*readtable* (copy-readtable nil))) (setf (readtable-case *readtable*) :downcase) (told :abc))"""
    )
    assert list(found) == [":|ABC|", ":|ABC|"]


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("operator", ["+", "*", "-", "max", "min", "logior", "=", "append"])
def test_a_form_of_a_thousand_variables_is_compiled(session, operator):
    """The time for this grows with the terms; where it grew with their third power this took minutes."""
    names = " ".join(f"v{index}" for index in range(1024))
    ones = "nil " * 1024 if operator == "append" else "1 " * 1024
    wanted = {"+": "1024", "-": "-1022", "=": "T", "append": "NIL"}.get(operator, "1")
    *_, found = session.evaluate_text(f"(flet ((f ({names}) ({operator} {names}))) (f {ones}))")
    assert prin1_to_string(found) == wanted
