"""Hash tables: tests, order, walking, weak keys."""

import gc

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sbcl_answers import answer, recorded

from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import equality
from cramhy_runtime.lisp_core import hash_tables as h
from cramhy_runtime.lisp_core.data import Character, Cons, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import keyword, sym


@pytest.fixture(autouse=True)
def a_kernel():
    kernel.start(clock="virtual")


def table(test="EQL", **options):
    return h.make_hash_table(test=sym(test), **options)


@pytest.mark.parametrize("form, expected", recorded("hash_tables.txt"))
def test_hash_tables_answer_as_in_sbcl(form, expected):
    assert answer(form) == expected


def test_gethash_tells_a_stored_nil_from_a_missing_entry():
    t = table()
    h.SETTERS["GETHASH"](None, 1, t)
    assert h.gethash(1, t, 5) == (None, True)
    assert h.gethash(2, t, 5) == (5, None)


def test_an_eql_table_tells_numbers_apart_by_their_type():
    t = table()
    for key in (1, SingleFloat(1.0), 1.0, True, 0.0, -0.0):
        t[key] = repr(key)
    assert len(t) == 6
    assert t[1] == "1" and t[True] == "True" and t[1.0] == "1.0"


def test_an_equal_table_finds_lists_and_strings_by_their_contents():
    t = table("EQUAL")
    t[lisp_list(1, "two", Cons(3, 4))] = "found"
    assert t[lisp_list(1, "two", Cons(3, 4))] == "found"
    assert lisp_list(1, "TWO", Cons(3, 4)) not in t


def test_an_equalp_table_ignores_case_and_the_types_of_numbers():
    t = table("EQUALP")
    t["Abc"] = 1
    t[lisp_list(1, [2.0])] = 2
    assert t["aBC"] == 1
    assert t[[Character("a"), Character("B"), Character("c")]] == 1
    assert t[lisp_list(1.0, [2])] == 2


def test_an_eq_table_tells_equal_lists_apart():
    t, one, two = table("EQ"), lisp_list(1), lisp_list(1)
    t[one] = "one"
    assert t[one] == "one" and two not in t


def test_entries_keep_their_order_and_their_first_key():
    t = table("EQUALP")
    for key in ("b", "a", "B"):
        t[key] = key
    assert list(t.keys()) == ["b", "a"]
    assert list(t.values()) == ["B", "a"]


def test_the_current_entry_may_be_removed_while_walking_and_others_are_then_left_out():
    t = table()
    for key in range(4):
        t[key] = key
    seen = []

    def visit(key, value):
        seen.append(key)
        h.remhash(key, t)
        h.remhash(2, t)

    assert h.maphash(visit, t) is None
    assert seen == [0, 1, 3]
    assert h.hash_table_count(t) == 0


def test_weak_keys_do_not_keep_a_symbol_alive():
    t = table(weakness=keyword("KEY"))
    kept, dropped = Symbol("KEPT"), Symbol("DROPPED")
    t[kept], t[dropped], t["a string"] = 1, 2, 3
    del dropped
    gc.collect()
    assert list(t.keys()) == [kept, "a string"]
    assert h.hash_table_weakness(t) is keyword("KEY")


def test_the_test_may_be_given_as_a_function():
    assert h.hash_table_test(h.make_hash_table(test=equality.equal)) is sym("EQUAL")


@given(st.lists(st.tuples(st.integers(0, 9), st.integers(), st.booleans())))
def test_a_table_behaves_like_a_dictionary(steps):
    t, model = table("EQUAL"), {}
    for key, value, removes in steps:
        if removes:
            assert (h.remhash(list_from([key]), t) is True) == (model.pop(key, None) is not None)
        else:
            h.set_gethash(value, list_from([key]), t)
            model[key] = value
    assert [(key.car, value) for key, value in t.items()] == list(model.items())
