"""An operator that is written wrongly in Hy is an error of syntax, which says how it is written in Hy, and where it stands."""

import hy
import pytest
from harness import new_session, surroundings
from plain_hy import hy_module

from cramhy_runtime.languages.hy.plan_macros import hy_shape
from cramhy_runtime.languages.operators import OPERATORS
from cramhy_runtime.languages.operators.grammar import Many, Maybe, Text

BY_NAME = {operator.name.lower(): operator for operator in OPERATORS.values()}


@pytest.fixture(scope="module")
def module():
    with surroundings():
        yield hy_module(new_session("threads"), "")


def part(item):
    """The least that fits an item of a grammar."""
    if isinstance(item, list):
        return "[" + " ".join(map(part, required(item))) + "]"
    return '"text"' if isinstance(item, Text) else str(item)


def required(pattern):
    return [item for item in pattern if not isinstance(item, (Many, Maybe))]


def too_few(operator):
    """The call with one part too few in all the ways that it may be written."""
    shortest = min((required(pattern) for pattern in operator.patterns), key=len)
    return " ".join(["(" + written(operator), *map(part, shortest[:-1])]) + ")" if shortest else None


def without_a_list(operator):
    """The call with a name where a list must be, in all the ways that it may be written."""
    first, *others = map(required, operator.patterns)
    for place, item in enumerate(first):
        if isinstance(item, list) and all(isinstance(other[place], list) for other in others if place < len(other)):
            if not others or all(place < len(other) for other in others):
                parts = [*map(part, first[:place]), "name", *map(part, first[place + 1 :])]
                return " ".join(["(" + written(operator), *parts]) + ")"
    return None


def written(operator):
    return operator.name.lower()


FREE = [name for name, operator in BY_NAME.items() if too_few(operator) is None]


def test_only_these_can_be_written_without_any_part():
    assert (
        sorted(FREE)
        == """abort-current assert-no-nlx assert-no-returning define-log-tags delay load-if-necessary load-message-types
        load-service-types log-event logging-enabled-p par preempt-current publish-feedback pursue retry-after-suspension seq
        set-debug-levels succeed-current top-level trace-prolog try-all try-in-order untrace-prolog with-last-episode-knowledge
        with-scheduling with-tags without-scheduling""".split()
    )


def refused(module, operator, call):
    with pytest.raises(hy.errors.HySyntaxError) as problem:
        for form in hy.read_many(f"1\n  {call}", filename="<wrong>"):
            hy.eval(form, module=module)
    assert problem.value.msg.endswith(f"\nIt is written {hy_shape(operator)}.")
    assert problem.value.msg.startswith(f"The form {call} is malformed: ")
    assert (problem.value.lineno, problem.value.offset) == (2, 3)


@pytest.mark.soak(all_but=20)
@pytest.mark.parametrize("name", [name for name in BY_NAME if name not in FREE])
def test_one_part_too_few(module, name):
    refused(module, BY_NAME[name], too_few(BY_NAME[name]))


@pytest.mark.soak(all_but=22)
@pytest.mark.parametrize("name", [name for name, operator in BY_NAME.items() if without_a_list(operator)])
def test_a_name_where_a_list_must_be(module, name):
    refused(module, BY_NAME[name], without_a_list(BY_NAME[name]))
