"""Designators from Python: making and reading them, types that a class declares, grounding written in Python."""

from __future__ import annotations

import traceback
from functools import partial
from typing import ClassVar

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime import designators as desig
from cramhy_runtime.designators import python_grounding
from cramhy_runtime.designators import (
    Action,
    DesignatorError,
    Human,
    Location,
    Motion,
    Object,
    action_grounding,
    equate,
    equate_callback,
    every,
    forget,
    location_generator,
    location_validator,
    motion_grounding,
    next_solution,
    properties,
    property_values,
    reference,
    replace,
    solutions,
)
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.prolog import P, V, explain, fact_group, findall, kw

NAME = __name__.replace("_", "-")


class Driving(Motion):
    count: ClassVar[int] = 0
    speed: float
    angle: float = 0.0
    path: list[int] = []
    careful: bool = False
    towards: str | None = None


class DrivingBackwards(Driving):
    bell: str = "beep"


class Fetching(Action):
    object: Object


class On(Location, type="on-top-of"):
    table: str


def text_of(problem):
    return "\n".join([str(problem.value), *getattr(problem.value, "__notes__", ())])


def place(function):
    return f"{__file__}:{function.__code__.co_firstlineno}"


# ------------------------------------------------------------------------------------------------------------ making, reading


def test_a_designator_is_made_and_read_by_its_properties():
    cup = Object(type=kw.cup, color="red")
    motion = Motion(type=kw.driving, speed=1.5, to=[1, (2, 3)], of=cup, pen_on=True, in_=3)
    assert (
        repr(motion)
        == """\
#<A MOTION
    (TYPE DRIVING)
    (SPEED 1.5)
    (TO (1 (2 3)))
    (OF #<A OBJECT
    (TYPE CUP)
    (COLOR "red")>)
    (PEN-ON T)
    (IN 3)>"""
    )
    assert (motion.type, motion.speed, motion.to, motion.of, motion.pen_on, motion["in"]) == (kw.driving, 1.5, [1, [2, 3]], cup, True, 3)
    assert motion["speed"] == motion[kw.speed] == 1.5 and "speed" in motion and "angle" not in motion
    assert {"type", "speed", "pen_on"} <= set(dir(motion))


def test_a_type_may_be_declared_in_a_module_whose_annotations_are_no_texts():
    declared = {"Motion": Motion}
    program = """
class Leaping(Motion):
    height: float
    to: "Later"
    careful: bool = False
"""
    exec(compile(program, "leaping.py", "exec", dont_inherit=True), declared)
    leaping = declared["Leaping"]
    assert (list(leaping.fields), leaping.defaults, leaping.required) == (["height", "to", "careful"], {"careful": False}, ["height", "to"])
    assert properties(leaping(height=1.5, to="there")) == [("type", kw.leaping), ("height", 1.5), ("to", "there"), ("careful", False)]


def test_order_and_repeated_keys_are_kept():
    motion = Motion(("goal", 1), ("goal", [2]), ("nothing", None), (kw.data, 5), type=kw.driving, left_out=None)
    assert properties(motion) == [("goal", 1), ("goal", [2]), ("nothing", None), ("data", 5), ("type", kw.driving)]
    assert motion.goal == 1 and property_values(motion, "goal") == [1, [2]] and property_values(motion, "none") == []
    assert motion.data is None and motion["data"] == 5


def test_they_are_equal_by_identity():
    one, other = Motion(type=kw.driving), Motion(type=kw.driving)
    assert one != other and len({one, other, one}) == 2


@pytest.mark.parametrize(
    "kind, cls",
    [
        (Motion, desig.MotionDesignator),
        (Action, desig.ActionDesignator),
        (Object, desig.ObjectDesignator),
        (Location, desig.LocationDesignator),
        (Human, desig.HumanDesignator),
    ],
)
def test_each_kind_makes_plain_designators(kind, cls):
    made = kind(name="walter")
    assert made.__class__ is cls and isinstance(made, kind) and made.name == "walter"
    assert not any(isinstance(made, other) for other in (Motion, Action, Object, Location, Human) if other is not kind)
    assert repr(kind()) == f"#<A {kind.__name__.upper()}>"


def test_replace_makes_another_one():
    motion = Motion(("goal", 1), ("goal", 2), type=kw.driving, speed=1)
    changed = replace(motion, goal=7, speed=None, more="x")
    assert properties(changed) == [("goal", 7), ("type", kw.driving), ("more", "x")]
    assert motion.speed == 1 and changed.parent is None


# ------------------------------------------------------------------------------------------------------------- declared types


def test_a_class_declares_a_type_with_its_properties():
    motion = Driving(speed=1.5, path=[1, 2])
    assert properties(motion) == [("type", kw.driving), ("speed", 1.5), ("angle", 0.0), ("path", [1, 2]), ("careful", False)]
    assert motion.careful is False and motion.towards is None and "towards" not in motion
    assert On(table="desk").type is kw.on_top_of and DrivingBackwards(speed=1, angle=2).type is kw.driving_backwards


def test_a_description_from_lisp_of_that_type_is_one_too():
    motion = desig.make_designator(
        keyword("MOTION"),
        lisp_list(lisp_list(kw.type, kw.driving), lisp_list(kw.speed, 3), lisp_list(kw.careful, None), lisp_list(kw.path, None)),
    )
    assert isinstance(motion, Driving) and motion.angle == 0.0 and motion.careful is False and motion.path == []
    match motion:
        case DrivingBackwards():
            raise AssertionError
        case Driving(speed=speed, angle=angle):
            assert (speed, angle) == (3, 0.0)


def test_what_is_no_such_designator():
    assert not isinstance(Motion(type=kw.driving), Driving)  # it has no speed
    assert not isinstance(Motion(type=kw.flying, speed=1), Driving)
    assert not isinstance(Action(type=kw.driving, speed=1), Driving)
    assert not isinstance(3, Motion)
    assert isinstance(DrivingBackwards(speed=1), Driving)


# ---------------------------------------------------------------------------------------------------------------- resolution


def test_a_motion_grounding_gives_a_solution_or_several():
    @motion_grounding(Driving)
    def drive(motion):
        return ["drive", motion.speed]

    @motion_grounding(Driving)
    def others(motion):
        if motion.careful:
            yield ["creep", motion.speed]
            yield None
            yield ["crawl", motion.speed]

    assert reference(Driving(speed=1)) == ["drive", 1]
    motion = Driving(speed=2, careful=True)
    assert list(solutions(motion)) == [["drive", 2], ["creep", 2], ["crawl", 2]]
    assert reference(motion) is reference(motion) and motion.effective
    assert next_solution(next_solution(next_solution(Driving(speed=2, careful=True)))) is None
    assert reference(next_solution(Driving(speed=2, careful=True))) == ["creep", 2]


def test_a_grounding_may_give_any_object_and_none_is_not_mine():
    command = object()

    @motion_grounding
    def fly(motion):
        return command if motion.type is kw.flying else None

    assert reference(Motion(type=kw.flying)) is command
    assert list(solutions(Motion(type=kw.swimming))) == []


def test_an_action_grounding_gives_the_plan_function_and_its_arguments():
    def fetch(thing, arm=None): ...

    @action_grounding(Fetching)
    def grounding(action):
        yield fetch, action.object, kw.left
        yield fetch

    cup = Object(type=kw.cup)
    assert list(solutions(Fetching(object=cup))) == [[fetch, cup, kw.left], [fetch]]


def test_it_counts_as_one_of_the_rules():
    with fact_group("in prolog", extends=[P.motion_grounding]) as group:
        group.rule(P.motion_grounding(V.m, ["by-rule", V.speed]), P.desig_prop(V.m, [kw.speed, V.speed]))

    @motion_grounding(Driving)
    def drive(motion):
        return "by function"

    motion = Driving(speed=2)
    assert list(solutions(motion)) == [["by-rule", 2], "by function"]
    assert findall(V.x, P.motion_grounding(motion, V.x)) == [["by-rule", 2], "by function"]
    forget(drive)
    assert list(solutions(Driving(speed=2))) == [["by-rule", 2]]


def test_a_second_definition_of_the_name_replaces_the_first():
    for answer in ("old", "new"):

        @motion_grounding(Driving)
        def drive(motion, answer=answer):
            return answer

    assert list(solutions(Driving(speed=2))) == ["new"]


def test_places_are_proposed_by_generators_and_judged_by_validators():
    asked = []

    @location_generator(On, priority=5)
    def grid(location):
        x = 0
        while True:
            asked.append(x)
            yield (x, location.table)
            x += 1

    @location_generator(priority=6)
    def anywhere(location):
        return ["here"]

    @location_validator(On, priority=5)
    def even(location, candidate):
        return candidate[0] % 2 == 0

    @location_validator
    def not_zero(location, candidate):
        return None if candidate == "here" or candidate[0] else False

    spot = On(table="desk")
    assert reference(spot) == [2, "desk"] and asked == [0, 1, 2]
    found = solutions(spot)
    assert [next(found) for _ in range(3)] == [[2, "desk"], [4, "desk"], [6, "desk"]] and asked[-1] == 6
    assert list(solutions(Location(type=kw.somewhere))) == ["here"]
    forget(grid)
    forget(even)
    assert list(solutions(On(table="desk"))) == ["here"]


def test_maybe_and_truth_of_numpy():
    @location_generator
    def places(location):
        return [1, 2, 3]

    @location_validator
    def unless_somebody_wants_it(location, candidate):
        return kw.maybe_reject

    @location_validator(priority=20)
    def wants(location, candidate):
        return True if candidate == 2 else None

    assert list(solutions(Location())) == [2]
    forget(unless_somebody_wants_it)
    numpy = pytest.importorskip("numpy")

    @location_validator(priority=20)
    def wants(location, candidate):  # noqa: F811
        return numpy.float64(candidate) < 3

    assert list(solutions(Location())) == [1, 2]


def test_equating():
    seen, heard = Object(type=kw.cup, at="table"), Object(type=kw.cup)
    assert equate(heard, seen) is seen and desig.current_desig(heard) is seen
    with pytest.raises(SimpleError, match="^Cannot equate designators that are already equal.$"):
        equate(heard, seen)


def test_none_of_this_needs_a_kernel():
    @motion_grounding(Driving)
    def drive(motion):
        return [1]

    with kernel.aside():
        assert reference(Driving(speed=1)) == [1] and repr(Motion()) == "#<A MOTION>"
        assert list(solutions(Driving(speed=1))) == [[1]]
        with pytest.raises(DesignatorError):
            reference(Motion())
        assert kernel.active() is None


def test_a_grounding_may_wait_in_a_plan():
    @motion_grounding(Driving)
    def drive(motion):
        cpl.sleep(motion.speed)
        return cpl.now()

    assert cpl.run(lambda: (reference(Driving(speed=2)), cpl.now())) == (2.0, 2.0)


# ---------------------------------------------------------------------------------------------------------------------- errors


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(
    "mistake, kind, text",
    [
        (lambda: Driving(speed=1).sped, AttributeError, "This motion has no property 'sped'. Did you mean 'speed'?"),
        (lambda: Motion(type=kw.driving).colour, AttributeError, "This motion has no property 'colour'. It has: type."),
        (lambda: Object()["colour"], KeyError, "\"This object has no property 'colour'. It has: none.\""),
        (lambda: Driving(sped=1), TypeError, "Driving has no property 'sped'. Did you mean 'speed'?"),
        (lambda: Fetching(), TypeError, "Fetching needs the property 'object'."),
        (
            lambda: Motion(type="driving"),
            TypeError,
            "The type of a designator is a keyword: Motion(type=kw.driving). A string is never the same as it.",
        ),
        (
            lambda: Object(data=1),
            TypeError,
            "A property of Object cannot be called 'data': designators have an attribute of that name. "
            'Give it as a pair, Object(("data", value)), and read designator["data"].',
        ),
        (
            lambda: type(Motion)("Bad", (Motion,), {"__annotations__": {"parent": str}}),
            TypeError,
            "A property of Bad cannot be called 'parent': designators have an attribute of that name. "
            'Give it as a pair, Bad(("parent", value)), and read designator["parent"].',
        ),
        (
            lambda: type(Motion)("Bad", (Motion,), {}, type=3),
            TypeError,
            'The type of Bad is to be a keyword or its name, not 3: class Bad(Motion, type="driving").',
        ),
        (
            lambda: type(Motion)("Bad", (Motion,), {"stop": lambda self: 1}),
            TypeError,
            "Bad.stop would be a method, but what Bad(...) makes is a plain designator, which has properties only. "
            "Write a function: def stop(designator): ...",
        ),
        (
            lambda: type(Motion)("Bad", (Motion,), {"angle": 0.0}),
            TypeError,
            "Bad.angle has a value, but no type, and would be no property: angle: float = 0.0.",
        ),
        (lambda: Motion(3), TypeError, '3 is no property. In front of the keyword arguments stand pairs: ("goal", value).'),
        (lambda: reference("driving"), TypeError, "'driving' is no designator. Make one: Motion(type=kw.driving), Driving(speed=1.0)."),
        (lambda: list(Motion()), TypeError, "'MotionDesignator' object is not iterable"),
        (lambda: motion_grounding(Fetching), TypeError, "Fetching does not describe motions, which this decorator is for."),
        (
            lambda: action_grounding(desig.ActionDesignator),
            TypeError,
            "ActionDesignator is the class of all actions. Leave it out, or name a declared type.",
        ),
    ],
)
def test_mistakes_say_what_to_write(mistake, kind, text):
    with pytest.raises(kind) as problem:
        mistake()
    assert text_of(problem) == text


def test_why_a_designator_could_not_be_resolved_stands_below_the_traceback():
    @motion_grounding(Driving)
    def drive(motion):
        if motion.speed < 3:
            yield ["drive", motion.speed]

    with pytest.raises(DesignatorError) as problem:
        reference(Motion(type=kw.driving, sped=1))
    assert (
        "".join(traceback.format_exception_only(problem.value)).partition(": ")[2]
        == f"""\
Cannot resolve motion designator #<A MOTION
    (TYPE DRIVING)
    (SPED 1)>.
Of 2 clauses this one came furthest, clause 1 of {NAME}.test-why-a-designator-could-not-be-resolved-stands-below-the-traceback.drive:
  (motion-grounding ?designator ?solution)
  holds  (desig-prop ?designator (:type :driving))
  FAILS  (once (desig-prop ?designator (:speed ?_)))
           (desig-prop #<a motion (type driving) (sped 1)> (:speed ?_)) fails:
             There is no property :speed, but :sped; is that misspelled?
    -    (python-grounding #<drive ({place(drive)})> ?designator ?solution)
  with ?designator = #<a motion (type driving) (sped 1)>
explain(designator) tries it again and tells all of it.
"""
    )
    told = explain(Driving(speed=5))
    assert not told.holds and told.reason == "drive gave no solution" and "drive gave no solution." in str(told)


def test_what_a_grounding_raises_comes_out_with_the_designator_and_the_place():
    @motion_grounding(Driving)
    def drive(motion):
        return motion.sped

    @action_grounding
    def later(action):
        yield reference, action
        raise ValueError("no idea")

    with pytest.raises(AttributeError) as problem:
        reference(Driving(speed=1))
    assert text_of(problem) == (
        "This motion has no property 'sped'. Did you mean 'speed'?\n"
        f"This happened in the motion grounding drive ({place(drive)}), "
        "for #<A MOTION (TYPE DRIVING) (SPEED 1) (ANGLE 0.0) (PATH NIL) (CAREFUL NIL)>."
    )
    with pytest.raises(ValueError) as problem:
        list(solutions(Action()))
    assert text_of(problem) == f"no idea\nThis happened in the action grounding later ({place(later)}), for #<A ACTION>."


def test_solutions_that_cannot_be():
    @action_grounding
    def said(action):
        return "fetch", action

    @location_generator
    def one(location):
        return "here"

    @location_validator
    def perhaps(location, candidate):
        return "yes"

    with pytest.raises(TypeError) as problem:
        reference(Action())
    assert text_of(problem) == (
        "An action grounding gives a plan function and its arguments, (pick_up, cup), not ('fetch', #<A ACTION>).\n"
        f"This happened in the action grounding said ({place(said)}), for #<A ACTION>."
    )
    with pytest.raises(TypeError) as problem:
        reference(Location())
    assert text_of(problem).startswith(
        "A location generator yields candidates, or returns a list of them, not 'here'.\n"
        f"This happened in the location generator one ({place(one)}), for #<A LOCATION>."
    )
    forget(one)

    @location_generator
    def two(location):
        return ["here"]

    with pytest.raises(TypeError) as problem:
        reference(Location())
    assert text_of(problem).startswith(
        "A validator returns True, False, None or kw.maybe_reject, not 'yes'.\n"
        f"This happened in the location validator perhaps ({place(perhaps)}), for #<A LOCATION>."
    )


def test_an_error_reads_the_same_where_no_kernel_runs():
    kernel.stop()
    with pytest.raises(DesignatorError) as problem:
        reference(Motion(type=kw.flying))
    assert str(problem.value) == "Cannot resolve motion designator #<A MOTION\n    (TYPE FLYING)>."


def test_a_callback_is_told_of_what_is_equated_while_the_block_runs_however_it_ends():
    cup, mug, glass, told = Object(type=kw.cup), Object(type=kw.mug), Object(type=kw.glass), []
    with pytest.raises(ValueError), equate_callback(cup, told.append):
        equate(cup, mug)
        raise ValueError
    equate(mug, glass)
    assert told == [mug]


def test_every_describes_all_things_and_leaves_the_designator_of_one_as_it_is():
    cup = Object(type=kw.cup, color="red")
    cups = every(cup)
    assert (cups.quantifier, cups.color, cup.quantifier) == (kw.all, "red", kw.a)
    assert repr(cups).startswith("#<ALL ")


def test_groundings_hold_for_derived_types_however_they_are_ordered_and_those_of_the_derived_type_come_first():
    class Going(Motion):
        speed: float

    class Running(Going):
        breath: float = 1.0

    motion_grounding(Going)(lambda motion: ["go", motion.speed])
    assert list(solutions(Running(speed=2.0))) == [["go", 2.0]]

    class Racing(Running):
        rival: str | None = None

    motion_grounding(Running)(lambda motion: ["run", motion.breath])
    motion_grounding(lambda motion: ["anything"])
    assert list(solutions(Going(speed=1.0))) == [["go", 1.0], ["anything"]]
    assert sorted(solutions(Racing(speed=3.0))) == [["anything"], ["go", 3.0], ["run", 1.0]]
    assert [each for each in solutions(Racing(speed=3.0)) if each != ["anything"]] == [["run", 1.0], ["go", 3.0]]
    assert [each for each in solutions(Running(speed=3.0)) if each != ["anything"]] == [["run", 1.0], ["go", 3.0]]
    assert not isinstance(Motion(type=kw.racing), Going)
    with pytest.raises(DesignatorError):
        forget_all = [function for function in list(python_grounding._forgetting)]
        for function in forget_all:
            forget(function)
        reference(Racing(speed=3.0))


def test_a_definition_again_replaces_the_one_for_derived_types_too():
    class Going(Motion):
        speed: float

    class Running(Going):
        pass

    for word in ("first", "second"):

        @motion_grounding(Going)
        def go(motion, word=word):
            return [word, motion.speed]

    assert list(solutions(Running(speed=1.0))) == [["second", 1.0]] == list(solutions(Going(speed=1.0)))
    forget(go)
    assert list(solutions(Running(speed=1.0))) == []


def test_two_lambdas_two_partials_and_one_function_for_two_types_are_two_groundings():
    class Going(Motion):
        speed: float

    class Near(Location):
        x: float

    class Far(Location):
        x: float

    made = [
        lambda motion: ["a"],
        lambda motion: ["b"],
        partial(lambda word, motion: [word], "c"),
        partial(lambda word, motion: [word], "d"),
    ]
    for function in made:
        motion_grounding(Going)(function)
    assert list(solutions(Going(speed=1.0))) == [["a"], ["b"], ["c"], ["d"]]
    forget(made[1])
    assert list(solutions(Going(speed=1.0))) == [["a"], ["c"], ["d"]]

    def beside(place):
        return [place.x + 1]

    location_generator(Near)(beside)
    location_generator(Far)(beside)
    for step in (2, 3):
        location_generator(Far)(lambda place, step=step: [place.x + step])
    location_validator(Far)(lambda place, candidate: candidate != 3)
    location_validator(Far)(lambda place, candidate: candidate < 4)
    assert list(solutions(Near(x=1))) == [2] and list(solutions(Far(x=1))) == [2]
    forget(beside)
    assert list(solutions(Near(x=1))) == []
