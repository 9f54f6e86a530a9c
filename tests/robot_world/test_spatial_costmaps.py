"""Costmaps about the current world: on, in, beside, near and far from things, free floor, and from where a thing is seen."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

WORLD = """
(dolist (system '(:cram-btr-visibility-costmap :cram-btr-spatial-relations-costmap :cram-pr2-description :cram-knowrob-pick-place
                  :cram-robot-pose-gaussian-costmap :cram-bullet-reasoning-utilities))
  (asdf:load-system system))
(prolog:def-fact-group costmap-metadata (costmap:costmap-size costmap:costmap-origin costmap:costmap-resolution costmap:costmap-padding
    costmap:costmap-manipulation-padding costmap:costmap-in-reach-distance costmap:costmap-reach-minimal-distance
    costmap:visibility-costmap-size costmap:orientation-samples costmap:orientation-sample-step)
  (prolog:<- (costmap:costmap-size 12 12)) (prolog:<- (costmap:costmap-origin -6 -6)) (prolog:<- (costmap:costmap-resolution 0.05))
  (prolog:<- (costmap:costmap-padding 0.2)) (prolog:<- (costmap:costmap-manipulation-padding 0.2))
  (prolog:<- (costmap:costmap-in-reach-distance 0.9)) (prolog:<- (costmap:costmap-reach-minimal-distance 0.2))
  (prolog:<- (costmap:visibility-costmap-size 2)) (prolog:<- (costmap:orientation-samples 2))
  (prolog:<- (costmap:orientation-sample-step 0.1)))
(cram-tf::set-frames)
(cram-occasions-events:clear-belief)
(btr-utils:spawn-object 'plate-1 :plate :pose '((-0.8 1.5 0.9) (0 0 0 1)))
(btr-utils:spawn-object 'bottle-1 :bottle :pose '((1.5 0.9 1.0) (0 0 0 1)))
(btr:simulate btr:*current-bullet-world* 10)
(defun thing (type &rest more) (desig:make-designator :object (list* (list :type type) more)))
(defun island () (thing :counter-top '(:urdf-name :kitchen-island-surface) '(:part-of :kitchen)))
(defun sink () (thing :counter-top '(:urdf-name :sink-area-surface) '(:part-of :kitchen)))
(defun plate () (thing :plate '(:name plate-1)))
(defun place (&rest properties) (desig:make-designator :location properties))
(defun samples (place n) (loop repeat n for p = (desig:reference place) collect (cl-transforms:origin p)
                               do (setf place (or (desig:next-solution place) place))))
(defun all-p (test place n) (every test (samples place n)))
(defun x (p) (cl-transforms:x p)) (defun y (p) (cl-transforms:y p)) (defun z (p) (cl-transforms:z p))
(defun plate-place () (cl-transforms:origin (btr:pose (btr:object btr:*current-bullet-world* 'plate-1))))
(defun from-plate (p) (sqrt (+ (expt (- (x p) (x (plate-place))) 2) (expt (- (y p) (y (plate-place))) 2))))
"""


@pytest.fixture(scope="module")
def ask():
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text(WORLD)

    def asked(form):
        try:
            return prin1_to_string(session.evaluate_text(form)[-1])
        except Condition as problem:
            return problem.report()

    yield asked
    kernel.stop()


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    ("place", "test"),
    [
        ("(place (list :on (island)))", "(< 0.84 (z p) 0.87)"),
        ("(place (list :on (island)))", "(and (< -1.5 (x p) -0.2) (< 0 (y p) 3))"),
        ("(place (list :on (sink)) '(:side :front))", "(and (> (x p) 1.33) (< -0.22 (y p) 1.27))"),  # not at its edge: a thing would fall
        ("(place (list :on (island)) (list :for (thing :bottle)))", "(< 0.93 (z p) 0.97)"),
        ("(place (list :on (sink)) '(:side :left))", "(> (y p) (y (cl-transforms:origin (btr:link-pose (btr:get-environment-object) \"sink_area_surface\"))))"),
        ("(place (list :on (sink)) '(:side :front))", "(< (x p) (x (cl-transforms:origin (btr:link-pose (btr:get-environment-object) \"sink_area_surface\"))))"),
        ("(place (list :near (plate)) (list :for (thing :cup)))", "(< 0.1 (from-plate p) 0.6)"),
        ("(place (list :far-from (plate)) (list :for (thing :cup)))", "(< 0.5 (from-plate p) 2.0)"),
        ("(place (list :left-of (plate)) (list :for (thing :fork)))", "(< 0.0 (from-plate p) 2)"),
    ],
)  # fmt: skip
def test_places_are_where_the_relation_says(ask, place, test):
    assert ask(f"(all-p (lambda (p) {test}) {place} 8)") == "T"


def test_the_four_sides_of_a_thing_lie_crosswise(ask):
    """For somebody at the nearest edge, left and right, and behind and in front, lie opposite each other."""
    value = "(cramhy-mean '{})"
    ask(
        "(defun cramhy-mean (relation) (let ((cost (btr-spatial-cm::make-relation-cost (btr-spatial-cm::thing-of (plate)) relation)))"
        " (loop for (dx dy) in '((0.2 0) (-0.2 0) (0 0.2) (0 -0.2))"
        " collect (round (funcall cost (+ (x (plate-place)) dx) (+ (y (plate-place)) dy))))))"
    )
    answers = [ask(value.format(f":{relation}")) for relation in ("left-of", "right-of", "in-front-of", "behind")]
    assert sorted(answers) == ["(0 0 0 1)", "(0 0 1 0)", "(0 1 0 0)", "(1 0 0 0)"]


def test_a_robot_stands_on_free_floor(ask):
    place = '(place \'(:reachable-for cram-pr2-description:pr2) (list :object (plate)) (list :pose (cl-transforms-stamped:make-pose-stamped "map" 0.0 (plate-place) (cl-transforms:make-identity-rotation))))'
    ask(f"(defparameter *stand* {place})")
    assert (
        ask(
            "(let ((cost (btr-spatial-cm::make-free-space-cost 0.2))) (list (funcall cost -0.8 1.5) (funcall cost 0.2 1.5)"
            " (all-p (lambda (p) (and (= 0 (z p)) (= 1 (funcall cost (x p) (y p))))) *stand* 5)))"
        )
        == "(0.0d0 1.0d0 T)"
    )


def test_a_place_to_see_from_has_nothing_before_the_thing(ask):
    assert (
        ask(
            "(let ((cost (btr-vis-cm:make-object-visibility-costmap (btr:object btr:*current-bullet-world* 'plate-1) 'cram-pr2-description:pr2 2)))"
            " (list (> (funcall cost 0.2 1.5) 0.5) (funcall cost 4.0 1.5)"
            "  (progn (btr:add-object btr:*current-bullet-world* :box 'screen '((-0.4 1.5 1.2) (0 0 0 1)) :size '(0.02 2 3) :mass 0)"
            "         (prog1 (funcall cost 0.2 1.5) (btr:remove-object btr:*current-bullet-world* 'screen)))))"
        )
        == "(T 0.0d0 0.0d0)"
    )


def test_slots_of_a_table_lie_in_two_rows(ask):
    assert (
        ask(
            "(let* ((places (first (btr-spatial-cm::slots (btr-spatial-cm::thing-of (island)) (thing :plate) 4)))"
            "  (cost (btr-spatial-cm::make-slots-cost (btr-spatial-cm::thing-of (island)) (thing :plate) 4)))"
            " (list (length (remove-duplicates (mapcar #'first places) :test #'=)) (length (remove-duplicates (mapcar #'second places) :test #'=))"
            "  (loop for (x y) in places always (= 1 (funcall cost x y)))))"
        )
        == "(2 2 T)"
    )


def test_an_unknown_link_is_told(ask):
    assert "has no link no-such_link" not in ask("1")
    assert ask("(btr-spatial-cm::thing-of (thing :table '(:urdf-name :no-such-link)))").startswith("The furniture has no link no_such_link")


def test_a_place_where_another_item_stands_is_refused(ask):
    place = "(place (list :on (island)) (list :for (thing :bottle '(:name bottle-1))))"
    pose = '(cl-transforms-stamped:make-pose-stamped "map" 0.0 (cl-transforms:make-3d-vector {} 1.5 0.9) (cl-transforms:make-identity-rotation))'
    assert ask(f"(btr-spatial-cm::collision-pose-validator {place} {pose.format(-0.8)})") == ":REJECT"
    assert ask(f"(btr-spatial-cm::collision-pose-validator {place} {pose.format(3.0)})") == ":ACCEPT"
