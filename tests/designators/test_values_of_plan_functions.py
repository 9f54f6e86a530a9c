"""What a grounding in Python gives for a plan function of Python reaches it as it is."""

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.designators import Action, action_grounding, forget
from cramhy_runtime.process_modules import perform

got = []


class Tidying(Action):
    room: str


def tidy(*values):
    got[:] = values
    return values[0]


VALUES = [False, True, None, [], (), 0, 0.0, "", {}, [1, 2], [False, [], None], {"a": []}, set()]


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("value", VALUES, ids=repr)
def test_an_argument_arrives_as_it_was_given(session, value):
    def how(action):
        return tidy, value, "after"

    action_grounding(Tidying)(how)
    try:
        answer = cpl.run(lambda: perform(Tidying(room="kitchen")))
    finally:
        forget(how)
    assert got[1] == "after"
    assert repr(got[0]) == repr(value) and repr(answer) == repr(value)


def test_a_fluent_keeps_false_and_none_apart():
    pulses = []
    for value in (False, None, False):
        fluent = cpl.make_fluent()
        cpl.register_update_callback(fluent, "count", lambda new: pulses.append(new))
        fluent.value = value
        assert fluent.value is value and cpl.peek_value(fluent) is value
    assert pulses == []  # they are one value in Lisp
