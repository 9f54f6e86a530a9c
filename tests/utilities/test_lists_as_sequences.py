"""Lists of Lisp are sequences to Python: iteration computes lazy ones, and Lisp's own comparisons stay what they are."""

import itertools
import json
from collections.abc import Sequence

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import Cons, lisp_list
from cramhy_runtime.lisp_core.equality import eql, equal
from cramhy_runtime.utilities.lazy_lists import force_ll, from_iterator, lazy_mapcar


@pytest.fixture(autouse=True)
def a_kernel():
    with kernel.at_hand():
        yield


def squares(count=3):
    return from_iterator(n * n for n in range(1, count + 1))


def test_all_that_goes_through_a_lazy_list_sees_all_of_it():
    assert list(squares()) == [1, 4, 9]
    assert [*squares()] == [1, 4, 9] and tuple(squares()) == (1, 4, 9)
    assert len(squares()) == 3 and squares()[-1] == 9 and squares()[1] == 4 and squares()[1:] == [4, 9]
    assert sorted(squares(), reverse=True) == [9, 4, 1] and list(reversed(squares())) == [9, 4, 1]
    assert sum(squares()) == 14 and max(squares()) == 9 and any(n == 9 for n in squares()) and 9 in squares() and 5 not in squares()
    one, two, three = squares()
    assert (one, two, three) == (1, 4, 9)
    assert squares().index(9) == 2 and squares().count(9) == 1
    assert json.dumps(squares(), default=list) == "[1, 4, 9]"


def test_each_element_of_a_lazy_list_is_computed_once_and_when_it_is_asked_for():
    asked = []
    numbers = from_iterator(asked.append(n) or n for n in itertools.count())
    assert list(itertools.islice(numbers, 3)) == [0, 1, 2] == numbers[:3]
    assert len(asked) <= 4
    assert 2 in numbers and numbers[3] == 3 and len(asked) <= 5


def test_an_endless_list_and_a_circular_one_have_no_length(monkeypatch):
    monkeypatch.setattr("cramhy_runtime.lisp_core.conses.ENDLESS", 1000)
    with pytest.raises(OverflowError) as told:
        len(from_iterator(itertools.count()))
    assert str(told.value) == (
        "This lazy list has given 1000 elements and goes on, so it has no length. Take as many as you need: itertools.islice(answers, 10)."
    )
    ring = lisp_list(1, 2, 3)
    ring.cdr.cdr.cdr = ring
    with pytest.raises(OverflowError, match="This list is circular, so it has no length."):
        len(ring)


def test_a_long_lazy_list_has_a_length():
    assert len(squares(5000)) == 5000


def test_a_list_that_grows_lazily_is_not_forced_without_a_kernel_at_hand():
    made = lazy_mapcar(lambda n: n + 1, lisp_list(1, 2))
    kernel_less = list(made)
    assert kernel_less == [2, 3] and force_ll(made) is made


def test_a_list_is_equal_to_a_list_or_tuple_of_python_with_equal_elements():
    way = lisp_list(lisp_list(0, "x"), None, 2.0)
    assert way == [[0, "x"], [], 2] and [[0, "x"], None, 2.0] == way and way == ((0, "x"), (), 2)
    assert way != [[0, "x"], []] and way != [[0, "x"], [], 2, 3] and way != "x" and way is not None
    assert way == lisp_list(lisp_list(0, "x"), None, 2.0) and way != lisp_list(1)
    assert squares() == [1, 4, 9] and squares() == squares() and squares() != [1, 4] and squares() != [1, 4, 9, 16]
    assert Cons(1, 2) != [1] and Cons(1, 2) == Cons(1, 2) and Cons(1, 2) != Cons(1, 3) and Cons(1) != Cons(1, 2)
    ring = lisp_list(1)
    ring.cdr = ring
    assert ring == ring and ring != [1, 1]


def test_patterns_of_match_and_isinstance_know_lists():
    assert isinstance(lisp_list(1), Sequence)
    match squares():
        case [first, *rest]:
            assert (first, rest) == (1, [4, 9])
        case _:
            pytest.fail("no sequence")


def test_lisp_compares_lists_as_before_and_a_list_as_a_key_is_itself():
    one, other = lisp_list(1, 2), lisp_list(1, 2)
    assert not eql(one, other) and eql(one, one) and equal(one, other)
    assert {one: "one", other: "other"}[one] == "one" and len({one, other}) == 2
