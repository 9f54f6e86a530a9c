"""Poses in facts are lists of numbers, as in CRAM-TF, and a timeline can be named in (occurs ...) and (holds ...)."""

from __future__ import annotations

import pytest

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")


@pytest.fixture
def answers(values):
    """A function: how the variables ?a and ?b are bound by the answers of a goal."""
    values("(asdf:load-system :cram-bullet-reasoning)")
    values("""
        (defun told (goal)
          (mapcar (lambda (bindings) (list (cut:var-value '?a bindings) (cut:var-value '?b bindings)))
                  (cut:force-ll (prolog:prolog goal))))
        (defun pose () (cl-transforms:make-pose (cl-transforms:make-3d-vector 1 2 3) (cl-transforms:make-identity-rotation)))
        (defparameter *timeline* (btr:timeline-init btr:*current-bullet-world*))
        (btr:timeline-advance *timeline* (btr:make-event btr:*current-bullet-world* '(cup falls) 2.0))
        (btr:timeline-advance *timeline* (btr:make-event btr:*current-bullet-world* '(cup rolls) 1.0))""")
    return values


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    ("goal", "found"),
    [
        ("`(cram-tf:pose ,(pose) ?a ?b)", "(((1.0d0 2.0d0 3.0d0) (0.0d0 0.0d0 0.0d0 1.0d0)))"),
        ("`(cram-tf:pose ,(pose) (?a (0.0d0 0.0d0 0.0d0 ?b)))", "(((1.0d0 2.0d0 3.0d0) 1.0d0))"),
        ("`(cram-tf:pose ,(pose) (?a 2.0d0 ?b) ?)", "((1.0d0 3.0d0))"),
        ("`(cram-tf:pose ,(pose) (?a 5.0d0 ?b) ?)", "NIL"),
        ("'(and (cram-tf:pose ?pose (1 2 3) (0 0 0 1)) (cram-tf:pose ?pose (?a cut:?_ ?b) cut:?_))", "((1.0d0 3.0d0))"),
        (
            '\'(and (cram-tf:pose-stamped ?pose "map" 0.0 (1 2 3) (0 0 0 1)) (cram-tf:pose-stamped ?pose ?a ?b cut:?_ cut:?_))',
            '(("map" 0.0))',
        ),
        ("`(and (cram-tf:position ,(pose) ?a) (cram-tf:orientation ,(pose) ?b))", "(((1.0d0 2.0d0 3.0d0) (0.0d0 0.0d0 0.0d0 1.0d0)))"),
        ("`(coe:occurs ,*timeline* ?a ?b)", "((BTR::START 0.0) ((CUP ROLLS) 1.0) ((CUP FALLS) 2.0))"),
        ("`(coe:occurs ,*timeline* (cup ?a) 2.0)", "((FALLS ?B))"),
        ("`(and (coe:holds ,*timeline* (btr:bullet-world ?w) (coe:at ?b)) (== ?a 1))", "((1 0.0) (1 1.0) (1 2.0))"),
        ("`(and (coe:holds ,*timeline* (btr:bullet-world ?w) (coe:at 1.5)) (== ?a 1))", "((1 ?B))"),
        ("`(and (btr:clear-bullet-world ?w) (lisp-fun btr:objects ?w ?a))", "((NIL ?B))"),
        ("'(btr:valid-grasp ?w milk ?a ?b)", "NIL"),
    ],
)
def test_goals_of_poses_and_times(answers, goal, found):
    goal = goal.replace("(and ", "(prolog:and ").replace("(== ", "(prolog:== ").replace("(lisp-fun ", "(prolog:lisp-fun ")
    printed = answers(f"(told {goal})")
    assert printed.replace("CRAM-BULLET-REASONING::START", "BTR::START").replace("(BTR::START)", "BTR::START") == found


def test_a_timeline_has_its_last_event_at_hand(answers):
    assert answers("""
        (let ((timeline (make-instance 'btr:timeline)))
          (btr:timeline-advance timeline (make-instance 'btr:event :timestamp 3.0))
          (btr:timeline-advance timeline (make-instance 'btr:event :timestamp 1.0))
          (list (mapcar #'btr::timestamp (btr::events timeline))
                (eq (last (btr::events timeline)) (btr::last-event timeline))
                (eq (slot-value timeline 'btr::last-event) (btr::last-event timeline))))""") == ("((1.0 3.0) T T)")


@pytest.mark.soak
def test_a_grasp_of_an_object_is_one_of_its_type_with_an_arm_of_the_robot(answers):
    answers("(asdf:load-system :cram-pr2-description) (asdf:load-system :cram-knowrob-pick-place)")
    answers("""(btr:add-object btr:*current-bullet-world* :mesh :cup '((0 0 1) (0 0 0 1)) :mass 0.2 :mesh :cup)
               nil""")
    assert set(answers("(told '(btr:object-grasp ?w :cup ?a (?b)))").strip("()").replace(") (", ")(").split(")(")) >= {
        ":BACK :RIGHT",
        ":BACK :LEFT",
    }
