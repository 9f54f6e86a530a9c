"""Fluents in Python's notation: operators make nets, identity stays, and the truth of a fluent is not to be had by accident."""

from __future__ import annotations

import operator

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.cpl.fluents.nets import CachedNet


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(
    "function", [operator.lt, operator.le, operator.gt, operator.ge, operator.add, operator.sub, operator.mul, operator.truediv]
)
@pytest.mark.parametrize(("first", "second"), [(1, 2), (2, 2), (3.0, 2)])
def test_an_operator_makes_a_net_of_either_side(function, first, second):
    expected = function(first, second)
    one, other = cpl.make_fluent(value=first), cpl.make_fluent(value=second)
    for net in (function(one, second), function(first, other), function(one, other)):
        assert isinstance(net, CachedNet) and net.value == expected and type(net.value) is type(expected)
    nets = [function(one, second), function(one, other)]
    one.value = first + 10
    assert [net.value for net in nets] == [function(first + 10, second)] * 2


def test_values_may_be_of_any_kind_that_python_can_compare():
    name = cpl.make_fluent(value="b")
    assert (name > "a").value is True and (name + "c").value == "bc" and ("a" + name).value == "ab"


def test_and_or_not_are_those_of_the_plan_language():
    f, g = cpl.make_fluent(value=None), cpl.make_fluent(value=0)
    both, either, neither = f & g, f | g, ~f
    assert (both.value, either.value, neither.value) == (None, 0, True)
    assert (True & f).value is None and (None | g).value == 0
    f.value = 3
    assert (both.value, either.value, neither.value) == (0, 3, None)
    assert abs(cpl.make_fluent(value=-2)).value == 2


def test_a_fluent_is_itself_and_has_a_hash():
    f, g = cpl.make_fluent(value=1), cpl.make_fluent(value=1)
    assert f == f and f != g and len({f, g, f}) == 2 and f in [f] and [g].count(f) == 0


@pytest.mark.parametrize("ask", [bool, lambda f: 1 if f else 2, lambda f: f and 1, lambda f: not f, lambda f: 0 < f < 3])
def test_whether_a_fluent_is_true_cannot_be_asked(ask):
    with pytest.raises(TypeError) as caught:
        ask(cpl.make_fluent(name="distance", value=1))
    text = str(caught.value)
    assert text.startswith("The fluent ") and text.endswith(
        " was asked whether it is true, by if, while, and, or, not, or a comparison like 1 < f < 3. That would be the fluent itself, "
        "which is always there. Write f.value for its value now, cpl.wait_for(f) to wait, f & g, f | g, ~f to combine fluents."
    )


def test_one_waits_for_a_net_as_for_any_fluent():
    distance, bumper = cpl.make_fluent(name="distance", value=3.0), cpl.make_fluent(name="bumper", value=False)

    def approach():
        while distance.value > 0:
            cpl.sleep(1)
            distance.value -= 1

    def main():
        with cpl.par() as branches:
            branches.start(approach)
            cpl.wait_for((distance < 1.5) | bumper)
            return cpl.now(), distance.value

    assert cpl.run(main) == (2, 1.0)
