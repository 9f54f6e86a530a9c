"""Variables and names of Python that differ by case only are two; keywords and names of Lisp packages with capitals are refused."""

import copy
import pickle

import pytest

from cramhy_runtime.lisp_core.packages import ensure_package
from cramhy_runtime.prolog import P, UnknownPredicate, V, fact_group, facts_asserted, facts_watched, findall, first, holds, kw, names
from cramhy_runtime.prolog import test as prolog_test


@pytest.mark.parametrize("name", ["a", "A", "max_speed", "MAX_SPEED", "maxSpeed", "MaxSpeed", "x1", "X1", "_hidden", "größe"])
def test_a_variable_has_the_name_that_is_written(name):
    variable = getattr(V, name)
    assert variable.name == name and variable is getattr(V, name) and repr(variable) == "?" + name.replace("_", "-")
    assert pickle.loads(pickle.dumps(variable)) is variable and copy.deepcopy(variable) is variable
    answer = first(P["=="](variable, 1))
    assert dict(answer) == {name: 1} and getattr(answer, name) == answer[name] == answer[variable] == 1


def test_variables_that_differ_by_case_are_two():
    assert findall((V.A, V.a), P.member(V.A, [1, 2]), P.member(V.a, [2, 3])) == [(1, 2), (1, 3), (2, 2), (2, 3)]
    with fact_group("cases") as cases:
        cases.rule(P.pair(V.Xy, V.xY), P.member(V.Xy, [1]), P.member(V.xY, [2]))
    assert findall((V.p, V.q), P.pair(V.p, V.q)) == [(1, 2)]
    heard = []
    with facts_watched(lambda operation, **values: heard.append(values), P.on(V.A, V.a)), facts_asserted(P.on(1, 2)):
        pass
    assert heard == [{"A": 1, "a": 2}] * 2


@pytest.mark.parametrize(("one", "other"), [("likes", "Likes"), ("LIKES", "likes"), ("isNear", "isnear"), ("isNear", "IsNear")])
def test_names_that_differ_by_case_are_two(one, other):
    one, other = getattr(P, one), getattr(P, other)
    with fact_group("tastes") as tastes:
        tastes.fact(other("bob", "milk"), one("ann", "tea"))
    assert findall(V.x, one(V.x, V._)) == ["ann"] and findall(V.x, other(V.x, V._)) == ["bob"]
    assert one != other and not holds(P["=="](one, other)) and repr(one) != repr(other) == other.python_name


def test_predicates_of_python_that_differ_by_case_are_two():
    @prolog_test
    def isClose(n):  # noqa: N802
        return n < 3

    @prolog_test
    def isclose(n):
        return n > 3

    assert holds(isClose(1)) and holds(P.isClose(1)) and not holds(isClose(5)) and holds(isclose(5)) and not holds(P.isclose(1))


def test_an_unknown_name_with_capitals_is_told_what_is_meant():
    with pytest.raises(UnknownPredicate) as told:
        holds(P.Member(1, [1]))
    assert str(told.value) == "Nobody has defined the predicate Member of the goal (Member 1 (1)). Did you mean member?"


@pytest.mark.parametrize("name", ["Cup", "CUP", "maxSpeed"])
def test_a_keyword_with_capitals_is_refused(name):
    with pytest.raises(AttributeError) as told:
        getattr(kw, name)
    assert str(told.value) == (
        f"kw.{name} has capitals. Keywords of Lisp do not differ by case, so that all of Python's are written in small letters: "
        f"kw.{name.lower()}."
    )


def test_the_item_of_a_keyword_is_lisps_spelling():
    assert kw["PICK-UP"] is kw["pick-up"] is kw.pick_up
    with pytest.raises(KeyError, match="has capitals"):
        kw["Pick-Up"]


def test_a_name_of_a_lisp_package_with_capitals_is_refused():
    package = ensure_package("CASES-OF-LISP")
    assert names("cases-of-lisp").drive.symbol is package.intern("DRIVE") and names("CASES-OF-LISP")["Drive"].symbol is package.intern(
        "DRIVE"
    )
    with pytest.raises(AttributeError) as told:
        names("CASES-OF-LISP").Drive  # noqa: B018
    assert str(told.value) == (
        "The name 'Drive' has capitals, and those of the Lisp package CASES-OF-LISP are in small letters in Python: "
        "names('CASES-OF-LISP').drive."
    )
    package.intern("Fly")  # one that was written in bars
    assert names("CASES-OF-LISP").Fly.symbol.name == "Fly"
