"""Designators, names, lists and conditions are copied, pickled, and unpickled in another process."""

import copy
import pickle
import subprocess
import sys

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.designators import Location, Motion, Object, location_generator, motion_grounding, next_solution, properties, reference
from cramhy_runtime.designators.equating import desig_equal
from cramhy_runtime.designators.protocol import equate
from cramhy_runtime.lisp_core.data import UNBOUND, Cons, Symbol, lisp_list, list_from
from cramhy_runtime.prolog import P, V, first, kw, names
from cramhy_runtime.process_modules import perform, process_module, process_modules

COPIES = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    **{f"pickle {n}": lambda x, n=n: pickle.loads(pickle.dumps(x, n)) for n in range(2, 6)},
}


@pytest.fixture(params=COPIES.values(), ids=COPIES)
def copied(request):
    return request.param


class Going(Motion):
    speed: float


class Beside(Location):
    x: float


class DoorStuck(cpl.PlanFailure):
    def __init__(self, door, *, angle):
        super().__init__(f"the {door} is stuck")
        self.door, self.angle = door, angle


def command(motion):
    """A function that a designator names."""
    return motion


def test_a_copy_of_a_designator_is_another_one_with_the_same_properties(copied):
    cup = Object(type=kw.cup, color="red")
    motion = Motion(("goal", 1), ("goal", 2), type=kw.driving, towards=cup, then=[1, [2.5, "a"]], call=command)
    made = copied(motion)
    assert made is not motion and type(made) is type(motion) and made.quantifier is kw.a
    assert [name for name, _ in properties(made)] == ["goal", "goal", "type", "towards", "then", "call"]
    assert made.type is kw.driving and made.then == [1, [2.5, "a"]] and made.towards["color"] == "red" and made.call is command
    assert made.effective is None and not desig_equal(made, motion)


def test_a_resolved_designator_stays_resolved_and_knows_the_solutions_that_were_asked_for(copied):
    motion_grounding(Going)(lambda motion: iter([["go", 1], ["go", 2], ["go", 3]]))
    location_generator(Beside)(lambda place: [place.x + 1, place.x + 2])

    def main():
        motion, place = Going(speed=1.0), Beside(x=3.0)
        assert reference(motion) == ["go", 1] and reference(place) == 4.0
        following = next_solution(place)
        assert reference(copied(motion)) == ["go", 1] and reference(copied(place)) == 4.0 and reference(copied(following)) == 5.0
        if copied in (copy.copy, copy.deepcopy):
            assert reference(next_solution(copied(motion))) == ["go", 2] and reference(next_solution(copied(place))) == 5.0

    cpl.run(main)


def test_a_designator_that_contains_itself_and_a_chain_of_equated_ones_are_pickled():
    first_one, second = Object(type=kw.cup), Object(type=kw.cup, color="red")
    equate(first_one, second)
    second.data = {"where": first_one}
    one, two = pickle.loads(pickle.dumps([first_one, second]))
    assert desig_equal(one, two) and one.successor is two and two.data["where"] is one and one.object_id is two.object_id
    deep = copy.deepcopy(second)
    assert deep.data["where"] is not first_one and deep.data["where"].type is kw.cup


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(
    "name", [kw.cup, P.cup, V.x, V._, V, P, kw, UNBOUND, P.cup.symbol, names("CRAM-PROLOG")], ids=lambda each: type(each).__name__
)
def test_names_are_the_same_after_all_ways_of_copying(name, copied):
    made = copied({"it": name})["it"]
    assert made is name or made == name or repr(made) == repr(name) and made.member == name.member


@pytest.mark.soak(all_but=1)
def test_goals_answers_and_lists_are_equal_after_copying(copied):
    assert repr(copied(P.parent(V.x, "tom") & P.old(V.x))) == repr(P.parent(V.x, "tom") & P.old(V.x))
    answer = copied(first(P.member(V.x, [1, [2, 3]])))
    assert answer.x == 1
    assert list(copied(lisp_list(1, "a", kw.b))) == [1, "a", kw.b]
    dotted = copied(Cons(1, Cons(2, 3)))
    assert (dotted.car, dotted.cdr.car, dotted.cdr.cdr) == (1, 2, 3)
    assert len(copied(list_from(range(50_000)))) == 50_000


def test_a_circular_list_stays_circular_and_an_uninterned_symbol_stays_one_symbol():
    circle = lisp_list(1, 2)
    circle.cdr.cdr = circle
    for made in (copy.deepcopy(circle), pickle.loads(pickle.dumps(circle))):
        assert made.cdr.cdr is made and made.cdr.car == 2
    inside = lisp_list(1, None)
    inside.cdr.car = inside
    assert (made := pickle.loads(pickle.dumps(inside))).cdr.car is made
    symbol = Symbol("FRESH")
    one, two = pickle.loads(pickle.dumps([symbol, symbol]))
    assert one is two and one.name == "FRESH" and one.package is None


def failure_of(plan):
    with pytest.raises(BaseException) as caught:  # noqa: PT011  plan failures are no Exceptions
        cpl.run(plan)
    return caught.value


def break_it():
    @process_module(matches=lambda motion: motion.type is kw.breaking)
    def breaking(motion):
        raise DoorStuck("fridge", angle=30)

    with process_modules(breaking):
        perform(Motion(type=kw.breaking))


FAILURES = {
    "text": lambda: cpl.fail("no ~a %d"),
    "own": lambda: cpl.fail(DoorStuck("door", angle=30)),
    "unresolved": lambda: reference(Motion(type=kw.driving)),
    "no module": lambda: perform(Motion(type=kw.driving)),
    "in a module": break_it,
    "Python's": lambda: 1 / 0,
    "deadlock": lambda: cpl.wait_for(cpl.make_fluent(name="never", value=False)),
    "a live argument": lambda: cpl.fail(cpl.SimplePlanFailure("the lock ~a", [sys.stdout, (item for item in ())])),
}


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("plan", FAILURES.values(), ids=FAILURES)
def test_failures_keep_class_text_slots_and_hint(plan, copied):
    failure = failure_of(plan)
    made = copied(failure)
    assert type(made) is type(failure) and str(made) == str(failure)
    assert getattr(made, "__notes__", []) == getattr(failure, "__notes__", [])
    hint, wanted = getattr(made, "hint", None), getattr(failure, "hint", None)
    assert (hint() if callable(hint) else hint) == (wanted() if callable(wanted) else wanted)
    if isinstance(failure, DoorStuck):
        assert (made.door, made.angle) == (failure.door, failure.angle)


OTHER = """
import pickle, sys
thing = pickle.load(sys.stdin.buffer)
print(thing["motion"].speed, thing["motion"].towards.type, thing["list"], thing["symbol"], thing["variable"], thing["unknown"])
print(type(thing["failure"]).__name__, str(thing["failure"]).split(":")[0], "/", str(thing["lisp"]).strip())
"""


def test_another_process_unpickles_them_without_knowing_our_packages_and_classes(lisp):
    lisp("(defpackage :elsewhere (:use :cl))")
    lisp(
        "(define-condition elsewhere::gone (error) ((place :initarg :place))"
        '  (:report (lambda (c s) (format s "it is ~a" (slot-value c (quote place))))))'
    )
    things = {
        "motion": Motion(type=kw.driving, speed=1.5, towards=Object(type=kw.cup)),
        "list": lisp_list(1, "a", kw.b),
        "symbol": P.cup,
        "variable": V.x,
        "unknown": names("ELSEWHERE").thing.symbol,
        "failure": failure_of(FAILURES["no module"]),
        "lisp": lisp.value("(make-condition 'elsewhere::gone :place :gone)"),
    }
    told = subprocess.run([sys.executable, "-c", OTHER], input=pickle.dumps(things), stdout=subprocess.PIPE, timeout=60, check=True)
    assert told.stdout.decode().splitlines() == [
        "1.5 :CUP (1 'a' :B) cup ?x ELSEWHERE::THING",
        "SimplePlanFailure No matching process module found for #<A MOTION",
        "    (TYPE DRIVING)> / it is GONE",
    ]
