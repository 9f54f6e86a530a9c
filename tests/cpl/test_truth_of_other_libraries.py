"""What asks "true?" on behalf of a plan: the truth values of numpy and of its like count as Python's, and numbers are true as in Lisp."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cramhy_runtime import cpl
from cramhy_runtime.lisp_core.data import plain_truth, truth
from cramhy_runtime.session.session import Session

np = pytest.importorskip("numpy")
NO = [None, False, np.bool_(False), np.array(False), np.array([False])]
YES = [True, 0, 0.0, "", [], (), np.bool_(True), np.int64(0), np.float64(0), np.float32(1), np.array(True), np.array([True]), np.str_("")]


class Tensor:
    """An array as torch, jax and pandas have them: a class of another library with a truth of its own."""

    dtype, shape = "bool", ()

    def __init__(self, answer):
        self.answer = answer

    def __bool__(self):
        return self.answer


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("value", [*NO, Tensor(False)], ids=lambda each: type(each).__name__)
def test_what_is_not_true(value):
    assert not truth(value)


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("value", [*YES, Tensor(True)], ids=lambda each: type(each).__name__)
def test_what_is_true(value):
    assert truth(value)


def test_an_array_of_several_raises_as_numpy_does():
    with pytest.raises(ValueError, match="truth value of an array with more than one element is ambiguous"):
        truth(np.array([True, False]))


@given(st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(), st.lists(st.integers())))
def test_values_of_python_are_true_unless_none_or_false(value):
    assert truth(value) == (value is not None and value is not False)
    assert plain_truth(value) is value


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("make", [lambda f: f < 1.0, lambda f: ~(f >= 1.0), lambda f: (f < 1.0) & True, lambda f: False | (f < 1.0),
                                  lambda f: cpl.fl_funcall(lambda d: d < 1.0, f), lambda f: cpl.fl_and(f < 1.0, f > -1.0)])  # fmt: skip
def test_a_wait_goes_on_while_numpy_says_no(make, backend):
    distance = cpl.make_fluent(value=np.float64(2.0))

    def drive():
        for metres in (1.5, 1.0, 0.5):
            cpl.sleep(1)
            distance.value = np.float64(metres)

    def plan():
        with cpl.par() as branches:
            branches.start(drive)
            assert cpl.wait_for(make(distance)) is True
            return cpl.now()

    assert cpl.run(plan, clock="virtual", backend=backend) == 3


@pytest.mark.parametrize("no", NO[:3], ids=repr)
def test_a_fluent_whose_value_says_no_does_not_end_a_wait(no):
    door = cpl.make_fluent(value=no)
    assert cpl.run(lambda: cpl.wait_for(door, timeout=2), clock="virtual") is None
    door.value = True
    door.value = no
    assert cpl.run(lambda: cpl.wait_for(door, timeout=2), clock="virtual") is None


def test_a_fluent_keeps_truth_values_of_numpy_as_those_of_python():
    door = cpl.make_fluent(value=np.bool_(False))
    assert door.value is False
    door.value = np.bool_(True)
    assert door.value is True and door.pulses == 1
    door.value = np.True_
    assert door.pulses == 1


def test_a_policy_is_not_met_by_a_no_of_numpy():
    battery = cpl.make_fluent(value=np.float64(80))
    low = cpl.make_policy("low", [], check=lambda store: battery.value < 10)
    with cpl.plan(), cpl.policy(low):
        cpl.sleep(1)


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(
    "form",
    ["(if (numpy:less 3 2) 1 2)", "(cond ((numpy:any (numpy:zeros 3)) 1) (t 2))", "(if (py:call \"numpy.bool_\" 0) 1 2)",
     "(let ((a (numpy:array (vector 1 0) :dtype \"bool\"))) (if (py:item a 1) 1 2))", "(if (not (numpy:less 3 2)) 2 1)",
     "(length (remove-if (lambda (x) (numpy:less x 2)) '(1 2 3)))"],
)  # fmt: skip
def test_lisp_takes_what_python_gives_for_what_it_is(form):
    session = Session(time="virtual")
    session.evaluate_text("(py:import numpy)")
    assert session.evaluate_text(form)[-1] == 2


COLLECTIONS = [[1], {1: 2}, {1}, bytearray(b"a"), np.array([1])]


@pytest.mark.parametrize("collection", COLLECTIONS, ids=lambda each: type(each).__name__)
def test_a_collection_of_python_that_is_stored_once_more_pulses(collection):
    things = cpl.make_fluent(value=collection)
    things.value = things.value
    assert things.pulses == 1


def test_a_vector_of_lisp_that_is_stored_once_more_does_not_pulse():
    session = Session(time="virtual")
    session.evaluate_text("(in-package :cpl) (defvar *v* (vector 1 2)) (defvar *f* (make-fluent :name 'f :value *v*))")
    session.evaluate_text("(setf (value *f*) *v*)")
    assert session.evaluate_text("*f*")[-1].pulses == 0
