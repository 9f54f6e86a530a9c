"""`value` and nets read the slots of fluents without a call, but only where ``read`` does nothing else."""

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.cpl.fluents import formulas
from cramhy_runtime.cpl.fluents import operators as op
from cramhy_runtime.cpl.fluents.fluents import ValueFluent


class Doubled(ValueFluent):
    """Its class has a ``read`` of its own."""

    __slots__ = ()

    def read(self):
        return 2 * self.stored

    peek = read


class DoubledBelow(Doubled):
    """It inherits that."""

    __slots__ = ()


class Doubling:
    __slots__ = ()

    def read(self):
        return 2 * self.stored

    peek = read


class DoubledBeside(Doubling, ValueFluent):
    """It has it from a class that is none of fluents."""

    __slots__ = ()


class AsBefore(Doubled):
    """It has got that of value fluents back."""

    __slots__ = ()
    read = peek = ValueFluent.read


class Broken(ValueFluent):
    __slots__ = ()

    def read(self):
        return self.no_such_slot


@pytest.mark.parametrize("kind, factor", [(ValueFluent, 1), (Doubled, 2), (DoubledBelow, 2), (DoubledBeside, 2), (AsBefore, 1)])
def test_the_read_of_a_class_counts_everywhere(kind, factor):
    fluent = kind(value=4)
    plus, call, negated, both = fluent + 1, cpl.fl_funcall(lambda x: x, fluent), cpl.fl_not(fluent), cpl.fl_and(True, fluent)
    lisp = op.fl_plus(fluent, 1)
    assert cpl.value(fluent) == 4 * factor
    assert [net.value for net in (plus, lisp, call, negated, both)] == [4 * factor + 1, 4 * factor + 1, 4 * factor, None, 4 * factor]
    fluent.set(5)
    assert [net.value for net in (plus, lisp, call, both)] == [5 * factor + 1, 5 * factor + 1, 5 * factor, 5 * factor]


def test_an_attribute_that_a_read_misses_does_not_make_the_fluent_its_own_value():
    with pytest.raises(AttributeError, match="no_such_slot"):
        cpl.value(Broken())


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("old, new, pulses", [(1, 1, 0), (1, 1.0, 1), (0.0, -0.0, 1), (False, None, 0), (None, False, 0), (True, 1, 1)])
def test_what_is_the_same_for_eql_is_no_change(old, new, pulses):
    fluent = cpl.make_fluent(value=old)
    net = cpl.fl_or(fluent)
    before = net.pulses
    fluent.set(new)
    assert fluent.pulses == pulses
    assert net.pulses - before == pulses


def test_numbers_of_other_kinds_are_computed_by_lisp(lisp_numbers=(True, "text")):
    fluent = cpl.make_fluent(value=1)
    total, less = op.fl_plus(fluent, 2), op.fl_lt(fluent, 0.5)
    assert (total.value, less.value) == (3, None)
    fluent.set(0.25)
    assert (total.value, less.value) == (2.25, True)
    for wrong in lisp_numbers:
        with pytest.raises(BaseException, match="is not of type"):
            fluent.set(wrong)


def test_nets_of_one_shape_share_their_code():
    here, there = cpl.make_fluent(value=1), cpl.make_fluent(value=2)
    assert op.fl_lt(here, 1).formula.__code__ is op.fl_lt(there, 2.5).formula.__code__
    assert op.fl_lt(here, 1).formula.__code__ is not op.fl_lt(here, there).formula.__code__


def test_makers_of_formulas_are_not_collected_for_ever(monkeypatch):
    monkeypatch.setattr(formulas, "MOST", 5)
    fluent = cpl.make_fluent(value=1)
    nets = [cpl.fl_and(*[fluent] * count) for count in range(1, 30)]
    assert len(formulas._makers) <= 5
    fluent.set(7)
    assert {net.value for net in nets} == {7}
