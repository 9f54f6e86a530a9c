"""Collections of Python in goals and facts are lists, or are refused: none is silently without a solution."""

import array
import collections
import itertools

import numpy as np
import pytest

from cramhy_runtime.prolog import P, V, fact_group, findall, first, function, holds, predicate
from cramhy_runtime.prolog import test as prolog_test

PLACES = {"cup": 1, "plate": 2}


@pytest.mark.parametrize(
    ("given", "elements"),
    [
        (range(3), [0, 1, 2]),
        ({3, 1, 2}, [1, 2, 3]),
        (frozenset({"b", "a"}), ["a", "b"]),
        (PLACES.keys(), ["cup", "plate"]),
        (PLACES.values(), [1, 2]),
        (PLACES.items(), [["cup", 1], ["plate", 2]]),
        (collections.deque([1, 2]), [1, 2]),
        (np.array([1, 2, 3]), [1, 2, 3]),
        (np.array([[1, 2], [3, 4]]), [[1, 2], [3, 4]]),
        (array.array("d", [0.5]), [0.5]),
        ([range(2), {5}], [[0, 1], [5]]),
    ],
)
def test_a_collection_in_a_goal_and_in_a_fact_is_a_list(given, elements):
    assert findall(V.x, P.member(V.x, given)) == elements
    with fact_group("collections of a test") as facts:
        facts.fact(P.collected_here("it", given))
    assert holds(P.collected_here("it", elements)) and first(P.collected_here("it", [V.head, *V.tail])).head == elements[0]


def test_equal_sets_are_the_same_list():
    assert holds(P["=="]({1, 9, 17}, {17, 9, 1})) and holds(P["=="]({1, "a"}, {"a", 1}))


@pytest.mark.parametrize("iterator", [(n for n in range(3)), map(str, [1]), zip([1], [2]), itertools.count(), iter([1])])
def test_an_iterator_in_a_goal_is_refused(iterator):
    with pytest.raises(TypeError) as told:
        P.member(V.x, iterator)
    kind = "a generator" if "generator" in repr(iterator) else "an iterator"
    assert str(told.value) == (
        f"A goal has {kind} for an argument: {iterator!r}. It can be read once only, and a goal may be asked again. "
        "Write list(...) around it."
    )


def test_a_dict_as_a_list_is_refused():
    with pytest.raises(TypeError) as told:
        P.member(V.x, {"cup": 1})
    assert str(told.value) == (
        "The goal member is about lists, and a dict is none: {'cup': 1}. "
        "Write list(d) for its keys, list(d.values()) for its values, or list(d.items())."
    )


def test_functions_of_python_get_the_objects_that_are_written_and_give_collections_as_lists():
    @prolog_test
    def has_kind_here(thing, name):
        return type(thing).__name__ == name

    @function
    def doubled_here(numbers):
        return numbers * 2

    @predicate
    def ways_here(_):
        yield range(2)
        yield np.array([5, 6])

    assert holds(has_kind_here({1}, "set")) and holds(has_kind_here(range(2), "range"))
    assert findall(V.x, doubled_here(np.array([1, 2]), V.x)) == [[2, 4]]
    assert findall(V.x, P.lisp_fun(sorted, {2, 1}, V.x)) == [[1, 2]]
    assert findall(V.x, ways_here("left", V.r), P.member(V.x, V.r)) == [0, 1, 5, 6]
