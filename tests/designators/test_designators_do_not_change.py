"""The properties of a designator do not change in Python: an assignment says what to write instead. Slots of CRAM can be set."""

import copy
import gc
import pickle
import sys

import pytest

from cramhy_runtime.designators import Action, Human, Location, Motion, Object, replace
from cramhy_runtime.designators.classes import ActionDesignator, living, make_designator
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.prolog import kw


class Driving(Motion):
    speed: float
    angle: float = 0.0


MADE = {
    "motion": lambda: Motion(type=kw.driving, speed=1.0),
    "driving": lambda: Driving(speed=1.0),
    "action": lambda: Action(type=kw.driving, speed=1.0),
    "location": lambda: Location(speed=1.0),
    "object": lambda: Object(type=kw.cup, speed=1.0),
    "human": lambda: Human(speed=1.0),
    "from Lisp": lambda: make_designator(keyword("MOTION"), Motion(speed=1.0).description),
    "made by its class": lambda: ActionDesignator(Motion(speed=1.0).description),
    "copied": lambda: copy.copy(Motion(speed=1.0)),
    "pickled": lambda: pickle.loads(pickle.dumps(Motion(speed=1.0))),
}


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("kind", MADE)
@pytest.mark.parametrize("name", ["speed", "angle", "colour"])
def test_an_assignment_says_what_to_write(kind, name):
    made = MADE[kind]()
    which = type(made).__name__.removesuffix("Designator").lower()
    with pytest.raises(AttributeError) as problem:
        setattr(made, name, 2)
    assert str(problem.value) == (
        f"The properties of a designator do not change: {name} cannot be set. Make another one, which has the new value: "
        f"replace({which}, {name}=2), from cramhy_runtime.designators."
    )
    assert made.speed == 1.0 and replace(made, **{name: 2})[name] == 2


def test_items_and_augmented_assignments_are_refused_too():
    motion = Driving(speed=1.0)
    with pytest.raises(TypeError, match=r"replace\(motion, speed=2\)"):
        motion["speed"] = 2
    with pytest.raises(TypeError, match=r"replace\(motion, python_style=2\)"):
        motion[kw.python_style] = 2
    with pytest.raises(AttributeError, match=r"replace\(motion, speed=2.0\)"):
        motion.speed += 1
    with pytest.raises(AttributeError):
        del motion.speed
    with pytest.raises(TypeError, match=r"replace\(motion, speed=None\)"):
        del motion["speed"]
    assert motion.speed == 1.0


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("kind", MADE)
def test_the_slots_of_cram_can_be_set(kind):
    made = MADE[kind]()
    made.data, made.effective, made.timestamp = {"pose": 1}, True, 2.0
    made.quantifier = kw.all
    made.object_id = kw.cup
    assert (made.data, made.effective, made.timestamp, made.object_id) == ({"pose": 1}, True, 2.0, kw.cup)


def test_classes_of_users_have_attributes_of_their_own():
    class Tool(ActionDesignator):
        pass

    tool = Tool(Motion(speed=1.0).description)
    tool.sharp = True
    with pytest.raises(AttributeError, match="speed cannot be set"):
        tool.speed = 2
    assert tool.sharp and tool.speed == 1.0


def test_designators_are_known_as_long_as_they_live_in_the_order_of_their_making():
    gc.collect()
    before = len(living())
    kept = [Motion(number=number) for number in range(30)]
    for _ in range(5000):
        Motion(number=0)
    found = living()
    assert found[-30:] == kept and len(found) <= before + 30
    assert sys.getsizeof(found) < 100_000
