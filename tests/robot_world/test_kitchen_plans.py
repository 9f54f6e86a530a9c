"""What readers of CRAM's two kitchen tutorials run: the same systems, calls and figures. Source: bullet-world.md, sections 1, 9 and 10."""

from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

pytestmark = pytest.mark.soak

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

PLANS = Path(__file__).parent / "kitchen_plans.lisp"


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.evaluate_text(f'(load "{PLANS.as_posix()}") (in-package :kitchen-plans) (roslisp-utilities:startup-ros)')
    yield made
    kernel.stop()


@pytest.fixture
def ask(session):
    session.evaluate_text("(in-package :kitchen-plans) (coe:clear-belief)")

    def asked(form):
        caught = f'(handler-case {form} (serious-condition (problem) (format nil "~a: ~a" (type-of problem) problem)))'
        return prin1_to_string(session.evaluate_text(caught)[0]).strip('"')

    return asked


def test_two_bottles_change_places(ask):
    assert "PROJECTION-ENVIRONMENT-RESULT" in ask("(princ-to-string (type-of (switch-two-bottles)))")
    assert ask("(list (place-of 'bottle-1) (place-of 'bottle-2) (held))") == "((-0.8 2.0 0.96) (-2.0 -0.9 0.82) NIL)"


@pytest.mark.parametrize("place", ["((-1.6 -0.9 0.82) (0 0 0 1))", "((-1.35 -0.88 0.82) (0 0 0.7 0.7))", "((-1.9 -0.95 0.82) (0 0 1 0))"])
def test_a_bottle_is_found_by_turning_the_head_and_taken_somehow(ask, place):
    assert ask(f"(move-bottle '{place})") in (":LEFT", ":RIGHT")
    assert ask("(list (place-of 'bottle-1) (held))") == "((-0.8 2.0 0.96) NIL)"


def test_a_bottle_that_is_elsewhere_is_not_found(ask):
    assert ask("(move-bottle '((1.5 0.7 0.96) (0 0 0 1)))").startswith("OBJECT-NOWHERE-TO-BE-FOUND: No such object was found.")


def test_the_base_waits_for_the_arms_that_park_beside_it(ask):
    """As long as the arms are before it, they would hit the table; the base is the first in the form."""
    assert (
        ask('(with-simulated-robot (get-ready *counter*) (btr:joint-state (btr:get-robot-object) "torso_lift_joint"))')
        == "0.30000001192092896d0"
    )


def test_frames_follow_bare_motions(ask):
    form = '(cl-transforms:x (cl-transforms:origin (cram-tf:frame-to-pose-in-fixed-frame "base_footprint")))'
    assert ask(f"(with-simulated-robot (pp-plans:park-arms) (go-to *island*) (/ (round {form} 0.01) 100.0))") == "-0.15"
