"""A robot with one arm, described in less than 200 lines: the plans of the PR2 run on it as they are."""

from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

from test_pick_and_place import FRESH, SYSTEMS, simulated

pytestmark = pytest.mark.soak

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

PORTER = Path(__file__).parents[2] / "tutorials" / "kitchen" / "cram_porter_description"


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.evaluate_text("(asdf:load-system :cram-porter-description)")
    made.evaluate_text(SYSTEMS.replace(" :cram-pr2-description", ""))
    yield made
    kernel.stop()


@pytest.fixture
def ask(session):
    session.evaluate_text(FRESH)

    def asked(form):
        caught = f'(handler-case {form} (serious-condition (problem) (format nil "~a: ~a" (type-of problem) problem)))'
        return prin1_to_string(session.evaluate_text(caught)[0]).strip('"')

    return asked


def test_its_description_is_short():
    assert sum(len(path.read_text().splitlines()) for path in PORTER.iterdir() if path.is_file()) < 200


def test_it_is_the_only_robot(ask):
    assert (
        ask("(mapcar #'btr:name (btr:objects btr:*current-bullet-world*))") == "(:FLOOR :KITCHEN CRAM-PORTER-DESCRIPTION:PORTER BOTTLE-1)"
    )
    assert ask("(length (cut:force-ll (prolog:prolog '(cram-robot-interfaces:robot ?robot))))") == "1"


def test_it_carries_a_bottle_from_the_counter_to_the_island(ask):
    assert ask(simulated("(at-counter)", "(pick-up (see-bottle))", "(held)")) == "(BOTTLE-1)"
    assert (
        ask(simulated("(go-to -0.15 2.0 1 0)", "(put-down (first (btr-belief::designators-named 'bottle-1)) -0.8 2 0.9)", "(held)"))
        == "NIL"
    )
    assert ask("(near (place-of 'bottle-1) -0.8 2.0 0.959)") == "T"
    assert ask("(btr-utils:park-robot)") == "NIL"
    assert ask('(btr:joint-state (btr:get-robot-object) "lift")').startswith("0.168")


@pytest.mark.parametrize(
    ("forms", "failure"),
    [
        (["(begin)", "(go-to -0.8 2.0 0 1)"], "NAVIGATION-POSE-UNREACHABLE"),
        (["(exe:perform (desig:a motion (type moving-torso) (joint-angle 0.5)))"], "TORSO-GOAL-NOT-REACHED"),
        (["(at-counter)", "(pick-up (see-bottle) :left)"], "MANIPULATION-POSE-UNREACHABLE: The robot has no left arm"),
        (["(exe:perform (desig:a motion (type gripping) (gripper left)))"], "GRIPPER-GOAL-NOT-REACHED: The robot has no left arm"),
        (["(exe:perform (desig:a motion (type gripping) (gripper right)))"], "GRIPPER-CLOSED-COMPLETELY"),
    ],
)
def test_its_failures_are_those_of_the_plans(ask, forms, failure):
    assert ask(simulated(*forms)).startswith(failure)
