"""Conditions and exceptions that Python code raises meet handlers as those that were signalled do: once, and only from outside."""

from __future__ import annotations

import pytest

from cramhy_runtime.lisp_core.conditions import Error, SeriousCondition, handler_bind, signal_condition


class Stuck(SeriousCondition):
    """A condition of Python code."""


def raising(problem):
    def body(*_):
        raise problem

    return body


@pytest.mark.parametrize("problem", [Stuck(), ValueError("x")])
def test_handlers_hear_of_what_python_code_just_raises_inner_ones_first(session, problem):
    heard = []
    with pytest.raises(type(problem)):
        handler_bind(
            [(SeriousCondition, lambda condition: heard.append("outer"))],
            lambda: handler_bind([(SeriousCondition, lambda condition: heard.append("inner"))], raising(problem)),
        )
    assert heard == ["inner", "outer"]


@pytest.mark.parametrize("problem", [Stuck(), ValueError("x")])
def test_what_a_handler_raises_is_heard_outside_of_its_form_only(session, problem):
    heard = []

    def note(where):
        return lambda condition: heard.append((where, str(condition)))

    def body():
        handler_bind([(SeriousCondition, note("inside"))], lambda: signal_condition(Error()))

    with pytest.raises(type(problem)):
        handler_bind(
            [(SeriousCondition, note("outside"))],
            lambda: handler_bind([(SeriousCondition, raising(problem)), (SeriousCondition, note("beside"))], body),
        )
    assert [where for where, _ in heard] == ["inside", "outside"]
    assert heard[0][1] == str(Error()) and heard[1][1] == str(problem)


def test_a_condition_that_was_signalled_is_not_offered_again_when_it_is_raised(session):
    heard, problem = [], Stuck()

    def body():
        signal_condition(problem)
        raise problem

    with pytest.raises(Stuck):
        handler_bind([(Stuck, heard.append)], body)
    assert heard == [problem]
