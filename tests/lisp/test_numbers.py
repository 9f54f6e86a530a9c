"""Numbers as Python code and compiled code see them: kinds, contagion, fast operations, random numbers."""

from fractions import Fraction

import pytest

from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import DivisionByZero, FloatingPointOverflow, SimpleTypeError, TypeError_
from cramhy_runtime.languages.commonlisp.numbers import arithmetic, irrational, random_state, rounding
from cramhy_runtime.lisp_core.packages import sym

boot()


@pytest.fixture(autouse=True)
def fresh_seed():
    random_state.seed_random()


@pytest.mark.parametrize("thing", [True, None, False, "1", sym("CAR")])
def test_what_is_a_number_in_python_only_is_none_in_lisp(thing):
    with pytest.raises(TypeError_) as problem:
        arithmetic.add2(1, thing)
    assert problem.value.expected_type is sym("NUMBER")
    assert arithmetic.numberp(thing) is None


def test_a_wrong_operand_is_named_as_sbcl_names_it():
    with pytest.raises(TypeError_) as problem:
        arithmetic.add2(1, "a")
    assert str(problem.value) == 'The value\n  "a"\nis not of type\n  NUMBER'


def test_ratios_become_integers_when_they_can():
    third = arithmetic.div2(1, 3)
    assert third == Fraction(1, 3)
    whole = arithmetic.mul2(third, 3)
    assert whole == 1 and type(whole) is int


@pytest.mark.parametrize("operation", [arithmetic.add2, arithmetic.sub2, arithmetic.mul2, arithmetic.div2])
@pytest.mark.parametrize("other", [2, 2.0, Fraction(1, 2), SingleFloat(2.0)])
def test_a_double_makes_the_result_a_double(operation, other):
    assert type(operation(1.0, other)) is float
    assert type(operation(other, 1.0)) is float


def test_comparisons_answer_true_or_none():
    assert arithmetic.lt2(1, 2) is True
    assert arithmetic.lt2(2, 1) is None
    assert arithmetic.num_eq2(1, 1.0) is True


def test_division_by_zero_tells_operation_and_operands():
    with pytest.raises(DivisionByZero) as problem:
        arithmetic.div2(1, 0)
    assert problem.value.operation is sym("/")
    assert list(problem.value.operands) == [1, 0]


def test_a_product_too_large_for_a_float_overflows_instead_of_going_on_with_infinity():
    with pytest.raises(FloatingPointOverflow):
        arithmetic.mul2(1e300, 1e300)
    with pytest.raises(FloatingPointOverflow):
        arithmetic.mul2(10**400, 1.5)


def test_the_quotient_of_singles_is_rounded_to_a_single_before_it_is_cut():
    assert rounding.floor(SingleFloat(1.0), SingleFloat(0.1))[0] == 10
    assert rounding.floor(1.0, 0.1)[0] == 10


def test_functions_of_singles_give_singles_and_of_doubles_doubles():
    assert type(irrational.sin(1)) is SingleFloat
    assert type(irrational.sqrt(2.0)) is float
    assert type(irrational.atan(1, 1.0)) is float


def test_a_single_that_becomes_a_double_has_the_digits_of_a_single():
    assert irrational.to_double(SingleFloat(0.1)) == 0.10000000149011612


def test_a_fresh_session_throws_the_numbers_that_sbcl_throws():
    throws = [random_state.random(limit) for limit in (255, SingleFloat(1.0), 10, 1.0, 100, 2**40, 7)]
    assert throws[0] == 92 and throws[2] == 9 and throws[4:6] == [5, 969083603898]
    assert throws[1] == pytest.approx(0.2709539, abs=1e-7)
    assert throws[3] == 0.2539739311864577 and type(throws[3]) is float


def test_a_seed_gives_the_throws_that_sbcl_gives_for_it():
    random_state.seed_random(1)
    assert random_state.random(255) == 37
    random_state.RANDOM_STATE.value = random_state.seed_random_state(1)
    assert [random_state.random(6) for _ in range(5)] != [random_state.random(6) for _ in range(5)]


def test_same_seed_same_throws():
    def throws():
        random_state.seed_random(7)
        return [random_state.random(1000) for _ in range(20)] + [random_state.random(2**100) for _ in range(5)]

    assert throws() == throws()


def test_a_copied_state_repeats_what_the_original_throws():
    copy = random_state.make_random_state()
    assert random_state.random(10**6, copy) == random_state.random(10**6)


def test_a_limit_that_is_not_positive_is_refused():
    with pytest.raises(SimpleTypeError) as problem:
        random_state.random(0)
    assert str(problem.value) == "Argument is neither a positive integer nor a positive float:\n  0"
