"""The PR2 in the kitchen: CRAM's plans for going, looking, picking up and placing, on the robot of the current world."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

SYSTEMS = """
(dolist (system '(:cram-mobile-pick-place-plans :cram-pr2-description :cram-knowrob-pick-place :cram-pr2-projection
                  :cram-bullet-reasoning-utilities))
  (asdf:load-system system))
(defun at (frame x y z &optional (qz 0) (qw 1))
  (cl-transforms-stamped:make-pose-stamped
    frame 0.0 (cl-transforms:make-3d-vector x y z) (cl-transforms:make-quaternion 0 0 qz qw)))
(defun place-of (name) (let ((p (cl-transforms:origin (btr:pose (btr:object btr:*current-bullet-world* name)))))
  (list (cl-transforms:x p) (cl-transforms:y p) (cl-transforms:z p))))
(defun near (place x y z) (every (lambda (a b) (< (abs (- a b)) 0.005)) place (list x y z)))
(defun held () (mapcar #'first (btr:attached-objects (btr:get-robot-object))))
(defun go-to (x y qz qw) (let ((?pose (at "map" x y 0 qz qw)))
  (exe:perform (desig:an action (type going) (target (desig:a location (pose ?pose)))))))
(defun look-at-counter () (let ((?pose (at "base_footprint" 0.65335 0.076 0.758)))
  (exe:perform (desig:an action (type looking) (target (desig:a location (pose ?pose)))))))
(defun see-bottle () (exe:perform (desig:an action (type detecting) (object (desig:an object (type bottle))))))
(defun begin () (cpl:par (exe:perform (desig:a motion (type moving-torso) (joint-angle 0.3))) (pp-plans:park-arms)))
(defun at-counter () (begin) (go-to -1.447 -0.15 -0.70710678 0.70710678) (look-at-counter))
(defun pick-up (?bottle &optional (?arm :right))
  (exe:perform (desig:an action (type picking-up) (arm ?arm) (grasp left-side) (object ?bottle)))
  (pp-plans:park-arms :arm ?arm))
(defun put-down (?bottle x y z) (let ((?target (at "map" x y z)))
  (exe:perform (desig:an action (type placing) (arm right) (object ?bottle) (target (desig:a location (pose ?target)))))))
"""
FRESH = """
(cram-occasions-events:clear-belief)
(btr-utils:spawn-object 'bottle-1 :bottle :pose '((-2 -0.9 0.86) (0 0 0 1)) :color '(1 0 0))
(btr:simulate btr:*current-bullet-world* 100)
"""


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.evaluate_text(SYSTEMS)
    yield made
    kernel.stop()


@pytest.fixture
def ask(session):
    session.evaluate_text(FRESH)

    def asked(form):
        caught = f'(handler-case {form} (serious-condition (problem) (format nil "~a: ~a" (type-of problem) problem)))'
        return prin1_to_string(session.evaluate_text(caught)[0]).strip('"')

    return asked


def simulated(*forms):
    return f"(pr2-proj:with-simulated-robot {' '.join(forms)})"


def test_the_world_begins_with_kitchen_robot_and_what_was_spawned(ask):
    assert ask("(mapcar #'btr:name (btr:objects btr:*current-bullet-world*))") == "(:FLOOR :KITCHEN CRAM-PR2-DESCRIPTION:PR2 BOTTLE-1)"
    assert ask("(near (place-of 'bottle-1) -2.0 -0.9 0.823)") == "T"
    assert ask('(btr:joint-state (btr:get-robot-object) "torso_lift_joint")') == "0.15000000596046448d0"


def test_a_bottle_goes_from_the_table_to_the_island(ask):
    assert (
        ask(simulated("(at-counter)", "(let ((bottle (see-bottle))) (defparameter *bottle* bottle) (pick-up bottle))", "(held)"))
        == "(BOTTLE-1)"
    )
    assert ask(simulated("(go-to -0.15 2.0 1 0)", "(put-down *bottle* -0.8 2 0.9)", "(held)")) == "NIL"
    assert ask("(near (place-of 'bottle-1) -0.8 2.0 0.959)") == "T"


def test_what_is_seen_is_told_with_name_type_and_pose(ask):
    assert ask(
        simulated("(at-counter)", "(let ((b (see-bottle))) (list (desig:desig-prop-value b :name) (desig:desig-prop-value b :type)))")
    ) == ("(BOTTLE-1 :BOTTLE)")
    frame = "(cl-transforms-stamped:frame-id (first (cdr (first (desig:desig-prop-value (see-bottle) :pose)))))"
    assert ask(simulated("(at-counter)", frame)) == "base_footprint"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("forms", "failure"),
    [
        (["(begin)", "(go-to -0.8 2.0 0 1)"], "NAVIGATION-POSE-UNREACHABLE"),
        (["(begin)", "(go-to 0 1 0 1)", "(see-bottle)"], "PERCEPTION-OBJECT-NOT-FOUND: Could not find object"),
        (
            ["(exe:perform (desig:a motion (type moving-torso) (joint-angle 0.5)))"],
            "TORSO-GOAL-NOT-REACHED: Torso goal 0.5 was out of joint limits",
        ),
        (
            [
                "(begin)",
                '(let ((?pose (at "base_footprint" 0.1 0 0))) (exe:perform (desig:an action (type looking) (target (desig:a location (pose ?pose))))))',
            ],
            "PTU-GOAL-NOT-REACHED: Look action wanted to twist the neck",
        ),
        (["(exe:perform (desig:a motion (type gripping) (gripper right)))"], "GRIPPER-CLOSED-COMPLETELY: There was no object to grip"),
        (["(at-counter)", "(let ((b (see-bottle))) (begin) (go-to 0 1 0 1) (pick-up b))"], "GRIPPER-CLOSED-COMPLETELY"),
        (
            [
                '(let ((?pose (at "base_footprint" 3 0 1))) (exe:perform (desig:a motion (type moving-tcp) (left-target (desig:a location (pose ?pose))))))'
            ],
            "MANIPULATION-POSE-UNREACHABLE: ",
        ),
    ],
)
def test_what_cannot_be_done_is_a_failure_of_its_class(ask, forms, failure):
    assert ask(simulated(*forms)).startswith(failure)


def test_a_base_that_is_refused_stands_where_it_stood(ask):
    form = simulated(
        "(begin)", "(go-to 0 1 0 1)", "(handler-case (go-to -0.8 2.0 0 1) (common-fail:navigation-pose-unreachable () :refused))"
    )
    assert ask(form) == ":REFUSED"
    assert ask("(near (place-of 'cram-pr2-description:pr2) 0.0 1.0 0.0)") == "T"


def test_outside_of_the_simulation_no_module_takes_motions(ask):
    assert "No matching process module found" in ask("(cpl:top-level (exe:perform (desig:a motion (type moving-torso) (joint-angle 0.2))))")


def test_a_recovery_with_another_place_succeeds(ask):
    plan = """
    (let ((places (list '(0 1 0 1) '(-1.447 -0.15 -0.70710678 0.70710678))))
      (begin)
      (cpl:with-retry-counters ((tries 2))
        (cpl:with-failure-handling
            ((common-fail:perception-object-not-found (f) (declare (ignore f)) (cpl:do-retry tries (cpl:retry))))
          (apply #'go-to (pop places))
          (look-at-counter)
          (desig:desig-prop-value (see-bottle) :name))))
    """
    assert ask(simulated(plan)) == "BOTTLE-1"


@pytest.mark.soak
def test_the_same_plan_gives_the_same_world_to_the_bit(ask, session):
    places = []
    for _ in range(2):
        session.evaluate_text(FRESH)
        ask(
            simulated(
                "(at-counter)",
                "(pick-up (see-bottle))",
                "(btr:detach-all-objects (btr:get-robot-object))",
                "(btr:simulate btr:*current-bullet-world* 10)",
            )
        )
        places.append(ask("(place-of 'bottle-1)"))
    assert places[0] == places[1]
