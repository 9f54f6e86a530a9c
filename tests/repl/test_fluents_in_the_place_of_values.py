"""`<` makes nets and `<=` does not (cpl.md 1.2): what a user is told who takes one for the other, or a net for a value."""

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.tools.advice import explanation
from cramhy_runtime.repl.listener import Listener
from cramhy_runtime.repl.session import Session, condition_of

from .conftest import Script

NOW = "(value fluent) is what the fluent holds now."


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.evaluate_text(
        "(defpackage fluents-for-values (:use :cpl)) (in-package fluents-for-values)"
        "(defparameter *f* (make-fluent :name 'f :value 3)) (defparameter *plain* 3) (defvar *unbound*)"
    )
    yield made
    kernel.stop()


@pytest.fixture
def advice(session):
    """The lines of advice that a user gets for the error of a form."""

    def advice(text):
        with pytest.raises((Condition, Exception)) as problem:
            session.evaluate_text(text, "<repl test>")
        return [line.strip() for line in explanation(condition_of(problem.value)).split("^\n")[1].splitlines()]

    return advice


@pytest.mark.parametrize("name", ["<=", ">=", "/=", "max", "min", "1+", "abs", "sqrt", "length"])
def test_a_function_that_makes_no_nets_names_those_that_do(advice, name):
    assert advice(f"({name} *f*{' 2' if name in ('<=', '>=', '/=', 'max', 'min') else ''})") == [
        f"{name} makes no net of a fluent. In the plan language these functions of Common Lisp do: < > = + - * / eq eql not.",
        f"(fl-funcall #'{name} ...) makes the net; {NOW}",
    ]


def test_what_it_names_makes_nets_and_what_it_tells_to_write_does_too(session):
    for form in [
        "(< *f* 2)",
        "(> 2 *f*)",
        "(= *f* 2)",
        "(+ *f* 2)",
        "(- *f*)",
        "(* *f* 2)",
        "(/ *f* 2)",
        "(eq *f* 2)",
        "(eql *f* 2)",
        "(not *f*)",
    ]:
        assert isinstance(session.evaluate_text(form)[0], cpl.Fluent), form
    (net,) = session.evaluate_text("(fl-funcall #'<= *f* 2)")
    assert isinstance(net, cpl.Fluent) and net.value is None


def test_in_a_function_it_names_the_operator_there(advice):
    assert advice("(defun near (distance)\n  (<= distance 2))\n(near *f*)")[0].startswith("<= makes no net")


def test_the_function_of_common_lisp_has_a_sister_that_makes_nets(advice):
    assert advice("(cl:< *f* 2)") == [f"cl:< makes no net of a fluent, cpl:< does; {NOW}"]


def test_elsewhere_a_fluent_stands_for_its_value(advice):
    assert advice("(dolist (x *f*) x)") == [f"A fluent stands in the place of its value: {NOW}"]


def test_a_type_error_without_a_fluent_gets_no_such_advice(session):
    with pytest.raises(Condition) as problem:
        session.evaluate_text("(<= 'a 2)", "<repl test>")
    assert "net" not in explanation(problem.value)


@pytest.fixture
def said(session, monkeypatch):
    """What the compiler says of a form that is not run."""

    def said(text):
        output = streams.StringOutputStream()
        monkeypatch.setattr(streams.ERROR_OUTPUT, "value", output)
        session.evaluate_text(f"(list (lambda (a b) (list a b)\n  {text}))", "<repl test>")
        return output.take()

    return said


def always_true(test, operator, column):
    return f"""\
; caught STYLE-WARNING:
;   The test {test.upper()} of {operator.upper()} makes a net, and a net is always true.
;   at <repl test>:2:{column}
"""


@pytest.mark.parametrize("operator", ["if", "when", "unless"])
def test_a_net_as_a_test_is_told_to_be_always_true(said, operator):
    assert said(f"({operator} (< *f* 2) a b)").startswith(always_true("(< *f* 2)", operator, 5 + len(operator)))


@pytest.mark.parametrize("test", ["(not *f*)", "(not (< *f* 2))", "(< (+ *f* 1) b)", "(fl-and *f* b)"])
def test_so_is_a_net_of_nets(said, test):
    assert said(f"(if {test} a b)").startswith(always_true(test, "if", 7))


@pytest.mark.parametrize("operator", ["and", "or"])
def test_and_and_or_pass_nets_by(said, operator):
    assert said(f"({operator} (< *f* 2) a)").startswith(always_true("(< *f* 2)", operator, 5 + len(operator)))
    assert said(f"({operator} a (< *f* 2))") == ""  # its value is the net


def test_and_a_test_of_cond(said):
    assert said("(cond ((eq *f* 2) a))").startswith(always_true("(eq *f* 2)", "cond", 10))


@pytest.mark.parametrize(
    "form", ["(if *f* a b)", "(if (< (value *f*) 2) a b)", "(if (< *plain* 2) a b)", "(if (< *unbound* 2) a b)", "(if (< a b) a b)",
             "(let ((*f* 2)) (if (< a *f*) a b))", "(if (cl:< a b) a b)", "(if (< . 3) a b)"]
)  # fmt: skip
def test_what_may_be_a_value_is_left_alone(said, form):
    try:
        assert "always true" not in said(form)
    except Condition as problem:
        assert "dot" in str(problem)


@pytest.mark.parametrize(
    ("form", "rest"),
    [
        ("(wait-for (and (< a 1) (> b 2)))", "AND makes no net: if (< A 1) makes one, WAIT-FOR waits for the last of the nets alone."),
        ("(wait-for (or (not a) b))", "OR makes no net: if (NOT A) makes one, WAIT-FOR waits for the first of the nets alone."),
        ("(whenever ((and (< a 1) b)) a)", "AND makes no net: if (< A 1) makes one, WHENEVER waits for the last of the nets alone."),
    ],
)
def test_a_wait_for_a_combination_of_nets_needs_a_net(said, form, rest):
    hint = "(fl-and ...)" if "(and" in form else "(fl-or ...)"
    text = said(form)
    assert text.startswith(f"; caught STYLE-WARNING:\n;   {rest}\n;   at <repl test>:2:3\n")
    assert text.endswith(f";   {hint} makes a net of nets.\n")


@pytest.mark.parametrize(
    "form", ["(wait-for (fl-and (< a 1) b))", "(wait-for (and a (< b 1)))", "(wait-for (and (< (value a) 1) b))", "(wait-for a)"]
)
def test_a_wait_for_one_of_them_is_left_alone(said, form):
    assert said(form) == ""


def test_the_circumstances_of_an_error_are_none_of_those_of_the_debugger_around_it(session, capsys):
    listener = Listener(session, Script("(car 5)\nq\nq"))
    errors = streams.ERROR_OUTPUT.value
    try:
        with listener.listening():
            listener.respond('(setf (value *f*) 1) (defparameter *n* (< *f* 3)) (setf (value *f*) "fast")')
    finally:
        streams.ERROR_OUTPUT.value = errors
    first, second = capsys.readouterr().out.split("debugger invoked on a ")[1:]
    assert "which keeps its old value, was computed anew" in first
    assert "0] (car 5)" in first and "computed anew" not in second
