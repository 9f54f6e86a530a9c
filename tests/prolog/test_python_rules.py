"""Facts, rules and queries from Python: how terms are written and read, groups, and answers."""

from __future__ import annotations

import copy
import dataclasses
import functools
import math
import pickle
from collections import namedtuple

import pytest
from prolog_text import ask, group

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.prolog import P, UnknownPredicate, V, explain, fact_group, findall, first, holds, kw, names, remove_fact_group, solve
from cramhy_runtime.prolog.python.terms import Tail, show, to_lisp, to_python


def text_of(problem):
    """The text of an exception with its notes, as a traceback shows them."""
    return "\n".join([str(problem.value), *getattr(problem.value, "__notes__", ())])


@pytest.fixture
def family():
    with fact_group("family") as group:
        group.fact(P.parent("tom", "bob"), P.parent("bob", "ann"), P.parent("bob", "pat"))
        group.rule(P.ancestor(V.x, V.y), P.parent(V.x, V.y))
        group.rule(P.ancestor(V.x, V.z), P.parent(V.x, V.y), P.ancestor(V.y, V.z))


# ---------------------------------------------------------------------------------------------------------------------- asking


def test_answers_come_in_order_with_the_variables_as_attributes_and_items(family):
    answers = list(solve(P.ancestor("tom", V.who)))
    assert [answer.who for answer in answers] == ["bob", "ann", "pat"]
    assert answers[0] == {"who": "bob"} and answers[0]["who"] == answers[0][V.who] == "bob"
    assert repr(list(solve(P.parent(V.one, V.other)))[1]) == "Answer(one='bob', other='ann')"


def test_an_answer_can_be_copied_and_pickled(family):
    answer = first(P.parent("tom", V.who))
    assert copy.deepcopy(answer) == pickle.loads(pickle.dumps(answer)) == {"who": "bob"}


def test_goals_of_a_query_are_proved_together_and_may_be_joined_by_operators(family):
    sibling = P.parent(V.p, V.a) & P.parent(V.p, V.b) & ~P["=="](V.a, V.b)
    assert findall((V.a, V.b), sibling) == [("ann", "pat"), ("pat", "ann")]
    assert findall(V.x, P.parent("tom", V.x) | P.parent(V.x, "pat")) == ["bob", "bob"]
    assert findall(V.n, P.member(V.n, [1, 2, 3]), V.n >= 2, V.n < 3) == [2]
    assert repr(sibling) == "(and (parent ?p ?a) (parent ?p ?b) (not (== ?a ?b)))"


def test_first_holds_and_findall(family):
    assert first(P.parent("ann", V.who)) is None
    assert first(P.parent("tom", "bob")) == {} and bool(first(P.parent("tom", "bob"))) is True
    assert holds(P.parent("tom", V._)) and not holds(P.parent(V._, "tom"))
    assert findall({"a": V.who}, P.parent("tom", V.who)) == [{"a": "bob"}]
    assert findall([V.who, 1, V.free], P.parent("tom", V.who)) == [["bob", 1, V.free]]


def test_an_answer_is_computed_when_it_is_asked_for():
    asked = []
    answers = solve(P.member(V.x, [1, 2, 3]), P.lisp_pred(lambda x: asked.append(x) is None, V.x))
    assert asked == []
    assert next(answers).x == 1 and asked == [1]
    assert next(answers).x == 2 and asked == [1, 2]


def test_reasoning_needs_no_kernel_and_starts_none_that_stays(family):
    with kernel.aside():
        assert findall(V.x, P.ancestor("tom", V.x)) == ["bob", "ann", "pat"]
        assert first(P.findall(V.x, P.member(V.x, [1, 2, 3]), V.all)).all == [1, 2, 3]
        assert first(P.sort([3, 1, 2], names("CL")["<"], V.sorted)).sorted == [1, 2, 3]
        assert kernel.active() is None


# ----------------------------------------------------------------------------------------------------------------------- terms


@pytest.mark.parametrize("value", [0, 1, 1.0, True, "a", "", 10**30, [1, [2, "b"]], [[]], kw.driving, P.parent.symbol])
def test_a_value_comes_back_as_it_is(value):
    found = first(P["=="](V.x, value)).x
    assert found == value and type(found) is type(value)


def test_numbers_truth_strings_and_names_are_all_different():
    values = [1, 1.0, True, "t", "driving", kw.driving, P.driving, None]
    for i, one in enumerate(values):
        for j, other in enumerate(values):
            assert holds(P["=="](one, other)) is (i == j), (one, other)


def test_tuples_are_lists_and_what_is_derived_from_tuple_is_an_object():
    point = namedtuple("Point", "x y")(1, 2)
    found = first(P["=="](V.x, [(1, 2), point])).x
    assert found == [[1, 2], point] and found[1] is point


def test_objects_are_themselves():
    thing, other = {"a": 1}, {"a": 1}
    assert first(P["=="](V.x, thing)).x is thing
    assert holds(P["=="](thing, thing)) and not holds(P["=="](thing, other))


def test_the_rest_of_a_list_and_of_the_arguments():
    assert first(P["=="]([V.first, *V.rest], [1, 2, 3])) == {"first": 1, "rest": [2, 3]}
    assert first(P["=="]([V.first, *V.rest], [1])) == {"first": 1, "rest": []}
    assert not holds(P["=="]([V.first, *V.rest], []))
    assert first(P["=="](V.x, [1, *V.open])).x == [1, Tail(V.open)]
    with fact_group("any number of arguments") as group:
        group.rule(P.together(*V.all), P.length(V.all, 2))
    assert holds(P.together("a", "b")) and not holds(P.together("a"))


def test_a_function_is_a_symbol_with_it_and_comes_back_as_the_function():
    assert first(P["=="](V.f, len)).f is len and first(P["=="](V.f, text_of)).f is text_of
    assert holds(P["=="](text_of, text_of)) and not holds(P["=="](text_of, show))
    assert to_lisp(functools.partial(pow, 2)).function(5) == 32
    assert to_lisp(len).function(Cons(1, Cons(2))) == 2  # it gets the list of Lisp as one of Python


def test_numbers_of_numpy_are_numbers():
    numpy = pytest.importorskip("numpy")
    assert to_lisp(numpy.float64(0.5)).__class__ is float and to_lisp(numpy.bool_(False)) is False and to_lisp(numpy.int32(3)) == 3
    assert to_lisp(numpy.array([1])).shape == (1,)


def test_the_names_of_variables():
    assert V.who is V.who and V.who is not V.whom and V._ is V._
    assert first(P["=="]([V.x_1, V.pen_on, V.in_, V._, V._], [1, 2, 3, 4, 5])) == {"x_1": 1, "pen_on": 2, "in": 3}


def test_a_name_is_equal_to_its_symbol_and_knows_the_built_in_predicates():
    assert P.parent == P.parent.symbol and P.parent.symbol == P.parent and len({P.parent, P.parent.symbol}) == 1
    assert P.parent != kw.parent and P.parent != "parent"
    assert repr(P.not_.symbol) == "COMMON-LISP::NOT" and repr(P.findall.symbol) == "CRAM-PROLOG::FINDALL"
    assert repr(P["->"].symbol) == "CRAM-PROLOG::->" and repr(P.fetch_cup.symbol) == "PYTHON-USER::FETCH-CUP"
    assert repr(names("cl").list.symbol) == "COMMON-LISP::LIST" and repr([P.a, kw.pen_on]) == "[a, :PEN-ON]"


def test_lists_of_lisp_that_end_in_something():
    assert to_python(Cons(1, Cons(2, 3))) == [1, 2, Tail(3)]
    assert to_lisp(to_python(Cons(1, 2))).cdr == 2


# ------------------------------------------------------------------------------------------------------------ Lisp and Python


def test_rules_of_lisp_are_asked_from_python_and_the_reverse(family):
    group(
        "in-lisp",
        "((uncle ?x ?y) (python-user:parent ?p ?y) (python-user:parent ?g ?p) (python-user:parent ?g ?x) (not (== ?x ?p)))",
        "((likes tom :tea))",
    )
    here = names("PROLOG-TESTS-HERE")
    assert findall((V.who, V.what), here.likes(V.who, V.what)) == [(here.tom, kw.tea)]
    with fact_group("more-family") as more:
        more.rule(P.uncle_of(V.x, V.y), here.uncle(V.x, V.y))
    with fact_group("family") as changed:
        changed.fact(P.parent("tom", "bob"), P.parent("tom", "jim"), P.parent("bob", "ann"))
    assert ask('(python-user:uncle-of ?who "ann")') == '(((?WHO . "jim")))'
    assert ask('(python-user:parent "tom" ?x)') == '(((?X . "bob")) ((?X . "jim")))'


# ---------------------------------------------------------------------------------------------------------------------- groups


def test_a_group_is_replaced_as_a_whole_without_a_word(family, capsys):
    with fact_group("family") as group:
        group.fact(P.parent("eve", "abel"))
    assert findall((V.x, V.y), P.parent(V.x, V.y)) == [("eve", "abel")]
    with pytest.raises(UnknownPredicate):
        holds(P.ancestor("eve", "abel"))
    assert capsys.readouterr() == ("", "")


def test_a_block_that_fails_leaves_the_old_group(family):
    with pytest.raises(ZeroDivisionError), fact_group("family") as group:
        group.fact(P.parent("eve", "abel"))
        group.fact(P.parent("eve", 1 / 0))
    assert holds(P.parent("tom", "bob")) and not holds(P.parent("eve", V._))


def test_a_group_adds_to_another_only_if_it_says_so(family):
    with pytest.raises(SimpleError) as problem, fact_group("more") as group:
        group.fact(P.parent("eve", "abel"))
    assert (
        text_of(problem)
        == """\
Functor PARENT is being redefined in fact-group MORE.
                Other definitions were in fact-groups (FAMILY).
A group adds to predicates of other groups, or of cramhy, only if it says so: fact_group('more', extends=[P.the_predicate])."""
    )
    with fact_group("more", extends=[P.parent]) as group:
        group.fact(P.parent("eve", "abel"))
    assert findall(V.x, P.parent(V.x, V._)) == ["tom", "bob", "bob", "eve"]
    remove_fact_group("family")
    assert findall(V.x, P.parent(V.x, V._)) == ["eve"]


def test_a_definition_that_is_refused_leaves_the_old_group(family):
    with fact_group("others") as group:
        group.fact(P.stranger("eve"))
    with pytest.raises(SimpleError), fact_group("others") as group:
        group.fact(P.stranger("lilith"), P.parent("eve", "abel"))
    assert findall(V.x, P.stranger(V.x)) == ["eve"] and not holds(P.parent("eve", V._))


def test_variables_of_a_rule_are_its_own(family):
    with fact_group("own") as group:
        group.rule(P.child(V.who, V.x), P.parent(V.x, V.who))
    assert findall((V.who, V.x), P.child(V.x, V.who)) == [("tom", "bob"), ("bob", "ann"), ("bob", "pat")]


# ---------------------------------------------------------------------------------------------------------------------- errors


@pytest.mark.parametrize(
    "mistake, kind, text",
    [
        (
            lambda: holds(P.ancestr("tom", V.x)),
            UnknownPredicate,
            'Nobody has defined the predicate ancestr of the goal (ancestr "tom" ?x). Did you mean ancestor?',
        ),
        (
            lambda: holds(P.parent("tom", V.x) & ~P.zzz()),
            UnknownPredicate,
            "Nobody has defined the predicate zzz of the goal (zzz). Define it in a fact group, or by @predicate.",
        ),
        (lambda: holds(P.parent), TypeError, "parent is no goal. Call it with its arguments: parent(...)."),
        (
            lambda: holds(V.x == 3),
            TypeError,
            'False is no goal. (== compares objects, at once; P["=="](a, b) is the goal that makes terms the same.)',
        ),
        (
            lambda: holds("parent(tom, X)"),
            TypeError,
            "'parent(tom, X)' is no goal. A goal is a name with arguments: P.parent(V.x, \"tom\").",
        ),
        (lambda: holds(), TypeError, 'A query needs a goal: solve(P.parent(V.x, "tom")).'),
        (
            lambda: P.parent("tom", V.x) and P.parent(V.x, "ann"),
            TypeError,
            'The goal (parent "tom" ?x) was asked whether it is true, by if, while, and, or, not, or a comparison like 1 < x < 3. Ask holds(goal) '
            "for that; goal & goal, goal | goal, ~goal combine goals.",
        ),
        (
            lambda: 1 < V.x < 3,
            TypeError,
            "The goal (> ?x 1) was asked whether it is true, by if, while, and, or, not, or a comparison like 1 < x < 3. Ask holds(goal) "
            "for that; goal & goal, goal | goal, ~goal combine goals.",
        ),
        (lambda: not V.x, TypeError, "The variable ?x was asked whether it is true. It has a value in an answer only."),
        (
            lambda: P.parent(V.x, "a") | P.parent,
            TypeError,
            'parent cannot be joined to the goal (parent ?x "a"): it is no goal. Call it with its arguments: parent(...).',
        ),
        (lambda: P.parent(*V.x, 1), TypeError, "*?x stands for the rest of a list: [first, *V.rest], P.f(first, *V.rest)."),
        (
            lambda: first(P.parent(V.father, "bob")).fahter,
            AttributeError,
            "This answer has no value for a variable 'fahter'. Did you mean 'father'?",
        ),
        (lambda: first(P.parent(V.father, "bob")).who, AttributeError, "This answer has no value for a variable 'who'. It has: father."),
        (lambda: names("CRAM-PROLG"), LookupError, "There is no Lisp package 'CRAM-PROLG'. Did you mean 'CRAM-PROLOG'?"),
        (lambda: names("xyz"), LookupError, "There is no Lisp package 'XYZ'. Load the system that defines it first: import my_package."),
        (lambda: fact_group(3), TypeError, "3 cannot name a fact group. Give a string, or a name: P.family."),
        (lambda: fact_group("x").fact("tom"), TypeError, "'tom' is no goal. A goal is a name with arguments: P.parent(V.x, \"tom\")."),
    ],
)
def test_mistakes_say_what_to_write(family, mistake, kind, text):
    with pytest.raises(kind) as problem:
        mistake()
    assert text_of(problem) == text


def test_a_callable_where_lisp_fun_has_a_function_is_called_as_python_calls_it():
    assert first(P.lisp_fun(math.hypot, 3, 4, V.d)).d == 5.0
    assert first(P.lisp_fun(sum, [1, 2], V.s)).s == 3
    assert findall(V.s, P.member(V.s, ["12", "a"]), P.lisp_pred(str.isdigit, V.s)) == ["12"]
    with pytest.raises(ValueError) as problem:
        first(P.lisp_fun(int, "x", V.x))
    assert text_of(problem) == (
        "invalid literal for int() with base 10: 'x'\n"
        'This happened in the goal (lisp-fun int "x" ?x), which is solved by the @function int.'
    )


def test_symbols_of_lisp_in_that_place_keep_the_rule_of_lisp(warnings_given):
    assert first(P.lisp_fun(names("CL")["+"], 1, 2, V.s)).s == 3
    assert first(P.lisp_fun(names("CL").car, 3, V.x)) is None
    assert warnings_given[0].startswith("An error occurred while executing the lisp function `CAR': `The value")


def test_a_symbol_that_python_has_met_in_an_answer_is_a_term_again():
    tea = first(P["=="](V.x, P.tea)).x
    assert isinstance(tea, Symbol) and holds(P["=="](tea, P.tea))


def test_explain_tells_why(family):
    told = explain(P.ancestor("ann", V.who))
    assert (told.holds, told.outcome) == (False, "fails") and repr(told) == str(told)
    assert str(told).startswith("""\
(ancestor "ann" ?who) has no solution.
Of 2 clauses this one came furthest, clause 1 of family:
  (ancestor ?x ?y)
  FAILS  (parent ?x ?y)""")
    with kernel.aside():
        assert explain(P.ancestor("tom", V.who)).holds


@pytest.mark.parametrize("text", [lambda v: f"room-{v}", "room-{}".format, format, lambda v: f"{v:>5}"])
def test_a_variable_in_a_text_is_refused_with_what_to_write(text):
    with pytest.raises(TypeError) as caught:
        text(V.n)
    assert str(caught.value) == (
        "The variable ?n stands in a text, by an f-string or by format: f'... {V.n} ...'. It has no value yet, so the text would have its "
        "name. Make the text in a @function, which is called with the value. To show the variable itself, write {V.n!r}."
    )
    assert f"{V.n!r}" == "?n" and str(V.n) == "?n"


@pytest.mark.parametrize("name", ["values", "items", "get", "keys", "of", "name", "count", "in_lisp", "_made", "self", "symbol"])
def test_a_variable_may_have_any_name(name):
    variable = getattr(V, name)
    answer = first(P.member(variable, [["a", 1]]))
    assert answer == {name: ["a", 1]} and answer[name] == ["a", 1] and answer[variable] == ["a", 1] and list(answer) == [name]
    assert getattr(answer, name) == ["a", 1] and f"{answer}" == f"Answer({name}=['a', 1])"
    assert findall(variable, P.member(variable, [1, 2])) == [1, 2]
    assert pickle.loads(pickle.dumps(answer)) == answer


Pair = namedtuple("Pair", "left right")


@dataclasses.dataclass
class Seen:
    what: object
    where: object = None


@pytest.mark.parametrize(
    ("template", "wanted"),
    [
        ({"x": V.x, "y": [V.y]}, {"x": 1, "y": [3]}),
        ({V.x: V.y}, {1: 3}),
        (Pair(V.x, (V.y, "b")), Pair(1, (3, "b"))),
        ({V.x, V.y}, {1, 3}),
        (frozenset([V.x]), frozenset([1])),
        (Seen(V.x, where={"is": V.y}), Seen(1, where={"is": 3})),
        ([V.x, *V.rest], [1, 7, 8]),
        ("text", "text"),
    ],
)
def test_a_template_of_findall_is_any_container(template, wanted):
    goals = P.member(V.x, [1]), P["=="](V.y, 3), P["=="](V.rest, [7, 8])
    assert findall(template, *goals) == [wanted]
    assert type(findall(template, *goals)[0]) is type(wanted)


def test_a_goal_as_a_template_of_findall_is_the_goal_with_values():
    assert repr(findall(P.old(V.x, [V.y, V.z]), P["=="](V.x, 1), P["=="](V.y, "a"))) == '[(old 1 ("a" ?z))]'
