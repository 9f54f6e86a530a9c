"""Lazy lists: when elements are computed, and what the functions give. Source: prolog.md section 4, cpl.md 13.1."""

import pytest
from prolog_text import error_text, read, show

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.utilities import lazy_lists as ll


def counting(calls, last=None):
    """A lazy list 0, 1, 2, ... that notes each computation in ``calls``."""

    def body(cont, next_, finish, i):
        calls.append(i)
        if i == last:
            finish(i)
        cont(i, i + 1)

    return ll.lazy_list([0], body)


def test_the_first_element_is_computed_at_creation_and_each_other_when_it_is_asked_for():
    calls = []
    lazy = counting(calls, last=2)
    assert calls == [0] and ll.lazy_car(lazy) == 0 and calls == [0]
    assert ll.lazy_car(ll.lazy_cdr(lazy)) == 1 and calls == [0, 1]
    assert show(ll.force_ll(lazy)) == "(0 1 2)" and calls == [0, 1, 2]
    assert ll.lazy_list_p(lazy) is None


def test_next_computes_again_and_the_value_of_the_body_is_the_rest():
    def odd(cont, next_, finish, i):
        if i > 5:
            return lisp_list("end")
        if i % 2 == 0:
            next_(i + 1)
        cont(i, i + 1)

    assert show(ll.force_ll(ll.lazy_list([0], odd))) == '(1 3 5 "end")'
    assert ll.lazy_list([0], lambda cont, next_, finish, i: None) is None
    assert ll.lazy_list([0], lambda cont, next_, finish, i: 5) == 5


def test_cont_of_an_outer_list_leaves_the_inner_one():
    def outer(cont, next_, finish, i):
        ll.lazy_list([0], lambda inner_cont, n, f, j: finish("outer"))

    assert show(ll.lazy_list([0], outer)) == '("outer")'


@pytest.mark.parametrize(
    "make, expected",
    [
        (lambda: ll.lazy_mapcar(lambda a, b: a + b, lisp_list(1, 2, 3), lisp_list(10, 20)), "(11 22)"),
        (lambda: ll.lazy_mapcan(lambda x: x, lisp_list(lisp_list(1), None, lisp_list(2, 3))), "(1 2 3)"),
        (lambda: ll.lazy_filter(lambda x: x % 2 or None if x % 2 else None, list_from(range(6))), "(1 3 5)"),
        (lambda: ll.lazy_filter(lambda x: True, None), "NIL"),
        (lambda: ll.lazy_filter(lambda x: MultipleValues((True, x == 2 or None)), list_from(range(6))), "(0 1 2)"),
        (lambda: ll.lazy_append(None, lisp_list(1), None, lisp_list(2, 3), None), "(1 2 3)"),
        (lambda: ll.lazy_append(), "NIL"),
        (lambda: ll.lazy_take(2, list_from(range(5))), "(0 1)"),
        (lambda: ll.lazy_take(0, list_from(range(5))), "NIL"),
        (lambda: ll.lazy_skip(3, list_from(range(5))), "(3 4)"),
        (lambda: ll.lazy_flatten(lisp_list(1, lisp_list(2, lisp_list(3), None), None, 4)), "(1 2 3 4)"),
        (lambda: ll.lazy_rests(lisp_list(1, 2)), "((1 2) (2))"),
    ],
)
def test_functions(make, expected):
    assert show(ll.force_ll(make())) == expected


def test_functions_compute_one_element_at_creation():
    for wrap in (
        lambda lazy: ll.lazy_mapcar(lambda x: x, lazy),
        lambda lazy: ll.lazy_filter(lambda x: True, lazy),
        lambda lazy: ll.lazy_take(3, lazy),
        lambda lazy: ll.lazy_append(lazy, lazy),
        lambda lazy: ll.lazy_mapcan(lambda x: lisp_list(x), lazy),
    ):
        calls = []
        wrap(counting(calls))
        assert calls == [0]


def test_take_of_an_endless_list_computes_no_more_than_it_takes():
    calls = []
    assert show(ll.force_ll(ll.lazy_take(3, counting(calls)))) == "(0 1 2)"
    assert calls == [0, 1, 2]


def test_a_result_that_is_no_list_is_an_error_of_mapcan():
    assert error_text(lambda: ll.force_ll(ll.lazy_mapcan(lambda x: x, lisp_list(lisp_list(1), 5)))).endswith("but result 5 is not a list\n")


def test_elements_by_number_and_folding():
    assert [ll.lazy_elt(lisp_list(1, 2), i) for i in (0, 1, 2)] == [1, 2, None]
    assert ll.lazy_fold(lambda a, b: a + b, lisp_list(1, 2, 3)) == 6
    assert ll.lazy_fold(lambda a, b: a + b, None, initial_value=7) == 7
    assert ll.lazy_car(None) is None and ll.lazy_cdr(None) is None


def test_a_copy_shares_what_is_not_computed_yet():
    calls = []
    lazy = counting(calls, last=3)
    copy = ll.copy_lazy_list(lazy)
    ll.force_ll(copy)
    ll.force_ll(lazy)
    assert calls == [0, 1, 2, 3] and copy is not lazy and show(copy) == show(lazy) == "(0 1 2 3)"


def test_lists_remember_the_environment_they_are_created_in():
    special, values = Symbol("*SPECIAL*"), iter([1, 2, 3])
    special.value, special.special = 0, True
    with binding(special, 9):
        lazy = ll.with_lazy_list_dynamic_environment(
            [(special, lambda: next(values))], lambda: ll.lazy_list([0], lambda cont, next_, finish, i: cont(special.value, i + 1))
        )
    assert [ll.lazy_elt(lazy, i) for i in (0, 1, 2)] == [1, 2, 3]
    assert special.value == 0


def test_a_second_task_waits_for_the_element_that_a_first_one_computes():
    computed = []

    def slowly(cont, next_, finish, i):
        if i:
            kernel.sleep(1)
        computed.append(i)
        cont(i, i + 1)

    lazy, seen = ll.lazy_list([0], slowly), []
    tasks = [kernel.spawn(lambda: seen.append(ll.lazy_elt(lazy, 2)), name="reader") for _ in range(2)]
    for task in tasks:
        task.join("a reader")
    assert seen == [2, 2] and computed == [0, 1, 2]


def test_promises():
    calls = []
    promise = ll.delay(lambda: calls.append(1) or 5)
    assert ll.delay_p(promise) and calls == []
    assert ll.force(promise) == ll.force(promise) == 5 and calls == [1]
    assert ll.force(7) == 7 and ll.delay_p(7) is None


def test_an_uncomputed_tail_prints_as_the_original_shows_it():
    text = show(counting([]))
    assert text.startswith("(0 . #S(CRAM-UTILITIES::LAZY-CONS-ELEM :GENERATOR #<FUNCTION (LAMBDA NIL :IN CRAM-UTILITIES:LAZY-MAPCAR) {")


def test_from_iterator_is_as_lazy_as_a_generator():
    assert ll.from_iterator(iter(())) is None
    assert show(ll.force_ll(ll.from_iterator(range(3)))) == "(0 1 2)"
    assert isinstance(read("(1)"), Cons)
