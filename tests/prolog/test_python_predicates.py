"""Predicates written in Python: decorators, what their functions get and give, and what their exceptions say."""

from __future__ import annotations

import sys

import pytest
from prolog_text import ask
from test_python_rules import text_of

from cramhy_runtime import cpl
from cramhy_runtime.prolog import P, UnboundVariable, V, fact_group, findall, first, function, holds, kw, names, predicate, solve
from cramhy_runtime.prolog import test as check
from cramhy_runtime.prolog.python.terms import import_predicates

EDGES = {"kitchen": [("hall", 3.0), ("balcony", 1.5)], "hall": [("door", 2.0)]}


@predicate
def way(room):
    yield from EDGES.get(room, ())


@function
def hours(metres: float):
    return metres / 1800


@check
def near(metres):
    return metres < 2.5


def line(made):
    return made.function.__code__.co_firstlineno


def test_a_predicate_yields_solutions_a_function_returns_one_and_a_test_is_true_or_false():
    assert findall((V.to, V.m), way("kitchen", V.to, V.m)) == [("hall", 3.0), ("balcony", 1.5)]
    assert findall(V.to, way("kitchen", V.to, V.m), near(V.m)) == ["balcony"]
    assert first(hours(900, V.h)).h == 0.5
    assert holds(near(1)) and not holds(near(3)) and holds(~near(3))
    assert near.function(1) is True


def test_what_is_known_is_compared():
    assert findall(V.m, way("kitchen", "balcony", V.m)) == [1.5]
    assert holds(hours(1800, 1.0)) and not holds(hours(1800, 2.0))


def test_without_arguments_for_the_outcome_each_solution_counts():
    assert len(list(solve(way("kitchen")))) == 2


def test_rules_of_lisp_and_of_python_use_it():
    with fact_group("ways") as group:
        group.rule(P.reachable(V.a, V.b), way(V.a, V.b, V._))
        group.rule(P.reachable(V.a, V.c), way(V.a, V.b, V._), P.reachable(V.b, V.c))
    assert findall(V.x, P.reachable("kitchen", V.x)) == ["hall", "balcony", "door"]
    assert ask('(and (python-user:way "kitchen" ?to ?m) (python-user:near ?m))') == '(((?TO . "balcony") (?M . 1.5d0)))'


def test_a_solution_is_asked_for_when_it_is_wanted_and_the_generator_is_closed_when_it_is_not():
    heard = []

    @predicate
    def count():
        try:
            n = 0
            while True:
                heard.append(n)
                yield n
                n += 1
        finally:
            heard.append("closed")

    assert first(count(V.n), V.n >= 2).n == 2
    assert heard == [0, 1, 2, "closed"]
    assert findall(V.n, P.once(count(V.n))) == [0]


def test_what_nil_is_for_a_function_is_said_by_its_annotation():
    got = []

    @check
    def takes(plain, items: list, flag: bool, name: str | None, other: list[int]):
        got.append([plain, items, flag, name, other])
        return True

    assert holds(takes([], [], [], [], [])) and holds(takes(None, None, None, None, None)) and holds(takes(*[False] * 5))
    assert got == [[[], [], False, None, []], [None] * 5, [False] * 5]


@pytest.mark.skipif(sys.version_info < (3, 14), reason="Python computes annotations when it defines the function")
def test_an_annotation_may_name_what_is_defined_later():
    names = {"got": [], "__name__": __name__}
    program = "def knows(plain: Later, items: list[Later], flag: bool, name: Later | None):\n    return got.extend([plain, items, flag, name]) is None"
    exec(compile(program, "later.py", "exec", dont_inherit=True), names)
    assert holds(check(names["knows"])(None, None, None, None)) and names["got"] == [[], [], False, None]


def test_lists_are_python_lists_and_may_have_open_places():
    got = []

    @check
    def look(items):
        return got.append(items) is None

    assert holds(look([1, ["a", kw.b], V.open, *V.rest]))
    assert got[0][:2] == [1, ["a", kw.b]] and got[0][2] is V.open


def test_solutions_may_have_variables_of_their_own():
    @predicate
    def pairs():
        yield [V.x, V.x]

    assert first(pairs([1, V.other])).other == 1


def test_a_list_is_as_good_as_a_generator_and_none_is_no_solution():
    @predicate
    def places(room):
        return ["table", "shelf"] if room == "kitchen" else None

    assert findall(V.p, places("kitchen", V.p)) == ["table", "shelf"]
    assert not holds(places("hall", V.p))


def test_its_name_may_be_another_one():
    tell = names("PROLOG-TESTS-HERE").tell_length

    @function(name=tell)
    def anything(text):
        return len(text)

    assert anything == tell and ask('(tell-length "four" ?n)') == "(((?N . 4)))"
    assert first(function(name=P.double)(lambda x: 2 * x)(4, V.y)).y == 8


def test_methods_and_variable_numbers_of_arguments():
    class World:
        def __init__(self, *things):
            self.things = things

        def on_table(self):
            yield from self.things

    on_table = predicate(name=P.on_table)(World("cup", "plate").on_table)
    assert findall(V.x, on_table(V.x)) == ["cup", "plate"]
    total = function(name=P.total)(lambda *numbers: sum(numbers))
    assert first(total(1, 2, 3, V.sum)).sum == 6 and first(total(V.sum)).sum == 0


def test_a_definition_again_replaces_the_old_one():
    for value in (41, 42):

        @function
        def answer(value=value):
            return value

    assert findall(V.x, answer(V.x)) == [42]


def test_facts_are_added_by_a_group_that_extends_it():
    with fact_group("new way", extends=[way]) as group:
        group.fact(way("door", "street", 1.0))
    assert findall(V.x, way("door", V.x, V._)) == ["street"]


def test_it_may_wait_in_a_plan():
    @predicate
    def seen():
        cpl.sleep(1)
        yield "cup"
        cpl.sleep(2)
        yield "plate"

    def plan():
        return [(answer.x, cpl.now()) for answer in solve(seen(V.x))]

    for backend in ("threads", "greenlet"):
        assert cpl.run(plan, clock="virtual", backend=backend) == [("cup", 1.0), ("plate", 3.0)]


# ---------------------------------------------------------------------------------------------------------------------- errors


def test_an_argument_without_a_value():
    with pytest.raises(UnboundVariable) as problem:
        holds(hours(V.m, V.h))
    assert text_of(problem) == (
        "The argument metres has no value in the goal (hours ?m ?h). "
        f"The @function hours ({__file__}:{line(hours)}) needs it: "
        "put a goal that gives the variable a value in front."
    )


def test_a_wrong_number_of_arguments():
    for goal, text in [
        (near(1, 2), f"The goal (near 1 2) has 2 arguments; the @test near ({__file__}:{line(near)}) has metres."),
        (hours(1), f"The goal (hours 1) has 1 argument; the @function hours ({__file__}:{line(hours)}) has metres, its result."),
        (hours(), f"The goal (hours) has 0 arguments; the @function hours ({__file__}:{line(hours)}) has metres, its result."),
        (way(), f"The goal (way) has 0 arguments; the @predicate way ({__file__}:{line(way)}) has room, what it yields."),
    ]:
        with pytest.raises(TypeError) as problem:
            holds(goal)
        assert text_of(problem) == text


def test_what_the_function_raises_comes_out_with_the_goal_and_the_place():
    with pytest.raises(TypeError) as problem:
        holds(P.member(V.x, [1, "two"]) & ~near(V.x) | near("two"))
    assert text_of(problem) == (
        "'<' not supported between instances of 'str' and 'float'\n"
        f'This happened in the goal (near "two"), which is solved by the @test near ({__file__}:{line(near)}).'
    )
    assert "metres < 2.5" in str(problem.traceback[-1].statement)


def test_plan_failures_go_through():
    class DoorStuck(cpl.PlanFailure):
        pass

    @check
    def opens(door):
        raise DoorStuck(door)

    with pytest.raises(DoorStuck):
        cpl.run(lambda: holds(opens("front")))


def test_solutions_of_the_wrong_kind():
    @predicate
    def one_by_mistake():
        return "kitchen"

    @predicate
    def too_few():
        yield "kitchen"

    for goal, made, text in [
        (
            one_by_mistake(V.x),
            one_by_mistake,
            "A predicate yields its solutions, or returns a list of them, not 'kitchen'. Use @function for one value.\n"
            "This happened in the goal (one-by-mistake ?x), which is solved by the @predicate one_by_mistake ({}:{}).",
        ),
        (
            too_few(V.x, V.y),
            too_few,
            "A solution is 'kitchen', but the goal has 2 arguments for it. Give a tuple of 2.\n"
            "This happened in the goal (too-few ?x ?y), which is solved by the @predicate too_few ({}:{}).",
        ),
    ]:
        with pytest.raises(TypeError) as problem:
            holds(goal)
        assert text_of(problem) == text.format(__file__, line(made))


def test_names_that_cannot_be():
    with pytest.raises(TypeError) as problem:
        check(lambda x: True)
    assert str(problem.value).startswith("@test needs a name for <function ") and str(problem.value).endswith("test(name=P.a_name)(...).")
    with pytest.raises(TypeError) as problem:

        @predicate
        def findall(x):
            yield x

    assert text_of(problem) == ("findall is a name of cramhy's package CRAM-PROLOG. Choose another one: predicate(name=P.a_name).")


def test_two_modules_that_give_a_predicate_one_name_are_told():
    def clash():
        return True

    check(name=P.clash)(clash)
    check(name=P.clash)(clash)  # the same module: a cell that is run again
    clash.__module__ = "another"
    with pytest.warns(RuntimeWarning) as warned:
        check(name=P.clash)(clash)
    assert str(warned[0].message) == (
        f"The test clash of the module another replaces that of {__name__}: names are global in Prolog. "
        "Give one of them another: name=P.another_name."
    )
    assert (warned[0].filename, warned[0].lineno) == (__file__, clash.__code__.co_firstlineno)


def test_a_name_that_was_used_before_its_predicate_was_imported_is_told():
    P.early_bird  # noqa: B018
    with pytest.warns(UserWarning, match="^P.early_bird was used before the module that has the predicate :early-bird") as warned:
        import_predicates(kw.early_bird)
    assert warned and repr(P.early_bird) == "early-bird"


def test_a_default_of_a_predicate_is_refused_where_it_is_defined_for_a_goal_could_mean_two_things():
    def way(room, steps=1):
        yield f"{room}-{steps}"

    with pytest.raises(TypeError) as refused:
        predicate(way)
    assert str(refused.value) == (
        f"The @predicate way ({__file__}:{way.__code__.co_firstlineno}) has a default for steps. The arguments of a goal are those of all "
        "parameters, and then the solution, so nobody could tell whether an argument is steps or the solution. Leave the default out, and "
        "give the value in the goal."
    )

    @function
    def longer(metres, factor=2):
        return metres * factor

    assert first(longer(3, V.m)).m == 6 and first(longer(3, 5, V.m)).m == 15


def test_predicates_are_methods_and_two_classes_may_have_the_same_name():
    class Robot:
        def __init__(self, reach):
            self.reach = reach

        @predicate
        def can_reach(self):
            yield self.reach

        @function
        def half(self, metres):
            return metres / 2 + self.reach

        @check
        def near(self, metres):
            return metres < self.reach

    class Arm(Robot):
        @predicate
        def can_reach(self):
            yield "arm"
            yield self.reach

    robot, arm = Robot(3), Arm(1)
    assert findall(V.r, robot.can_reach(V.r)) == [3] and findall(V.r, arm.can_reach(V.r)) == ["arm", 1]
    assert first(arm.half(4, V.h)).h == 3 and holds(robot.near(2)) and not holds(arm.near(2))
    assert findall(V.r, Robot.can_reach(arm, V.r)) == [1]
    with fact_group("robots") as robots:
        robots.fact(P.robot(robot), P.robot(arm))
        robots.rule(P.reaches(V.r, V.far), P.robot(V.r), Robot.can_reach(V.r, V.far))
    assert findall((V.r, V.far), P.reaches(V.r, V.far)) == [(robot, 3), (arm, 1)]
