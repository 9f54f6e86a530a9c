"""eq, eql, equal and equalp, and the hash keys that go with them."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sbcl_answers import answer, recorded

from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import equality
from cramhy_runtime.lisp_core.hash_tables import HashTable, sxhash
from cramhy_runtime.lisp_core.arrays import LispArray, Vector, bit_vector
from cramhy_runtime.lisp_core.data import Character, Cons, FreshString, LispString, list_from
from cramhy_runtime.lisp_core.equality import eq, eql, equal, equalp
from cramhy_runtime.lisp_core.packages import sym


def changed_string(text):
    """A string that was made with other characters, and has those of ``text`` now."""
    string = FreshString("b" * len(text))
    string.writable()[:] = text
    return string


atoms = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-2, 2),
    st.sampled_from([0.0, -0.0, 1.0, 2.0, float("nan"), SingleFloat(0.0), SingleFloat(1.0)]),
    st.sampled_from([Fraction(1, 2), sym("CAR"), Character("a"), Character("A"), 1j, 0.5]),
    st.text("aA", max_size=2),
    st.text("aA", max_size=2).map(LispString),
    st.text("aA", max_size=2).map(FreshString),
    st.text("aA", max_size=2).map(changed_string),
    st.lists(st.integers(0, 1), max_size=2).map(bit_vector),
)
things = st.recursive(
    atoms,
    lambda inner: st.one_of(
        st.builds(Cons, inner, inner),
        st.lists(inner, max_size=2),
        st.lists(inner, max_size=2).map(list_from),
        st.lists(inner, max_size=2).map(Vector),
        st.lists(inner, min_size=2, max_size=2).map(lambda items: LispArray((1, 2), items)),
    ),
    max_leaves=5,
)


@pytest.fixture(autouse=True)
def a_kernel():
    kernel.start(clock="virtual")


@pytest.mark.parametrize("form, expected", recorded("equality.txt"))
def test_equality_answers_as_in_sbcl(form, expected):
    assert answer(form) == expected


def test_t_is_not_one_and_one_is_not_one_point_zero():
    assert eql(True, 1) is None and eql(1, 1.0) is None and eql(SingleFloat(1.0), 1.0) is None
    assert equal(True, 1) is None and equalp(True, 1) is None


def test_python_false_is_nil():
    assert eq(False, None) is True and equal(None, False) is True and eql(False, 0) is None


def test_equal_numbers_are_eq_however_large():
    assert eq(10**30, 10**30) is True


def test_a_string_that_can_be_changed_equals_a_constant_one():
    assert equal(LispString("abc"), "abc") is True
    assert eql(LispString("abc"), LispString("abc")) is None


def test_equalp_compares_tables_by_their_entries():
    one, two = HashTable("EQUAL"), HashTable("EQUAL")
    one["a"], two["a"] = "X", "x"
    assert equalp(one, two) is True
    two["b"] = 1
    assert equalp(one, two) is None


@pytest.mark.soak
def test_long_lists_are_compared_without_recursion():
    assert equal(list_from(range(100_000)), list_from(range(100_000))) is True
    assert equality.equal_key(list_from(range(100_000))) == equality.equal_key(list_from(range(100_000)))


def test_sxhash_is_the_same_in_every_run():
    assert sxhash("turtle") == sxhash(LispString("turtle")) == 1981650988


@given(things, things)
def test_a_hash_key_is_the_same_exactly_for_equal_objects(x, y):
    for test, key in ((eql, equality.eql_key), (equal, equality.equal_key), (equalp, equality.equalp_key)):
        if x == x and y == y:
            assert (key(x) == key(y)) == (test(x, y) is True)


@given(things, things)
def test_each_equality_implies_the_next(x, y):
    for narrow, wide in ((eql, equal), (equal, equalp)):
        if narrow(x, y):
            assert wide(x, y)
    if equal(x, y):
        assert sxhash(x) == sxhash(y)


@given(things)
def test_everything_equals_itself(x):
    assert eql(x, x) and equal(x, x) and equalp(x, x)
