"""Properties whose names are one for Lisp are refused, wherever two of them stand together."""

import pytest

from cramhy_runtime.designators import Action, Motion, replace
from cramhy_runtime.prolog import kw


def declared():
    class Moving(Motion):
        x: float
        X: float


def inherited():
    class Moving(Motion):
        x: float = 0.0

    class MovingFar(Moving):
        X: float = 0.0


@pytest.mark.parametrize(
    ("make", "one", "other", "of"),
    [
        (lambda: Motion(type=kw.driving, x=1, X=2), "x", "X", "Motion"),
        (lambda: Action(maxspeed=1, maxSpeed=2), "maxspeed", "maxSpeed", "Action"),
        (lambda: Motion(grasp=1, grasp_=2), "grasp", "grasp_", "Motion"),
        (lambda: Motion(("x", 1), ("X", 2)), "x", "X", "Motion"),
        (lambda: Motion(("x", 1), X=2), "x", "X", "Motion"),
        (lambda: replace(Motion(y=0), y=1, Y=2), "y", "Y", "replace"),
        (declared, "x", "X", "Moving"),
        (inherited, "x", "X", "MovingFar"),
    ],
    ids=["in a call", "camel case", "underscore", "pairs", "pair and keyword", "replace", "class", "derived class"],
)
def test_two_names_that_are_one_for_lisp_are_refused(make, one, other, of):
    with pytest.raises(TypeError) as told:
        make()
    assert str(told.value) == (
        f"The properties {one!r} and {other!r} of {of} are one for Lisp, which sees no case, and no underscore at the end. "
        "Give one of them another name."
    )


def test_one_name_with_capitals_and_a_name_with_two_values_are_taken():
    motion = Motion(("goal", 1), ("goal", 2), maxSpeed=3)
    assert motion.maxSpeed == 3 and motion["maxSpeed"] == 3 and motion.goal == 1
