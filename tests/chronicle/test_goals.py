"""The places that running motions name: which designators have some, and how they reach those who look on."""

from __future__ import annotations

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.chronicle.goals import goals

PLACES = {
    "(desig:a motion (type moving) (goal (9 9.5 0)))": ((9.0, 9.5),),
    "(desig:a motion (type moving) (goal (1/2 2.0d0)))": ((0.5, 2.0),),
    "(let ((?v (cl-transforms:make-3d-vector 3 4 0))) (desig:a motion (type moving) (target ?v)))": ((3.0, 4.0),),
    "(let ((?p (cl-transforms:make-2d-pose 5 6 1.0))) (desig:a motion (type going) (pose ?p)))": ((5.0, 6.0),),
    "(desig:a motion (type going) (pose ((1 2 0) (0 0 0 1))))": ((1.0, 2.0),),
    "(desig:a motion (type going) (target (desig:a location (pose (7 8 0)))))": ((7.0, 8.0),),
    "(desig:a motion (type visiting) (location (1 1)) (goal (2 2)) (to (1 1)))": ((1.0, 1.0), (2.0, 2.0)),
    "(desig:a motion (type setting-pen) (r 255) (g 0) (colour (255 0 0)))": (),
    "(desig:a motion (type moving) (goal home))": (),
    "(desig:a motion (type moving) (goal (near the door)))": (),
    "(desig:a motion (type moving) (goal (1)))": (),
    "(desig:a motion (type going) (target (desig:a location (left-of door))))": (),
    "(let ((?c (list 1 2))) (setf (cddr ?c) ?c) (desig:a motion (type moving) (goal ?c)))": ((1.0, 2.0),),
    "(let ((?n (expt 10 400))) (desig:a motion (type moving) (goal (?n 1))))": (),
}


@pytest.mark.parametrize("form", PLACES)
def test_places_are_found_below_the_properties_that_say_where_to(session, form):
    (designator,) = session.evaluate_text(form)
    assert goals(designator) == PLACES[form]


def test_a_location_counts_once_it_is_resolved_and_nobody_resolves_it_for_that(session):
    session.evaluate_text("""(progn (defparameter *asked* 0)
      (defun somewhere (desig) (declare (ignore desig)) (incf *asked*) (list (cl-transforms:make-3d-vector 2 3 0)))
      (desig:register-location-generator 5 somewhere)
      (defparameter *place* (desig:a location (left-of door)))
      (defparameter *motion* (desig:make-designator :motion `((:type :going) (:goal ,*place*)))))""")
    (motion,) = session.evaluate_text("*motion*")
    assert goals(motion) == () and session.evaluate_text("*asked*") == [0]
    session.evaluate_text("(desig:reference *place*)")
    assert goals(motion) == ((2.0, 3.0),)


def test_they_are_told_while_the_module_executes_the_motion(session, looker):
    session.evaluate_text("(cpm:def-process-module mover (motion) (sleep 1))")
    session.evaluate_text("""(top-level (cpm:with-process-modules-running (mover)
      (cpm:pm-execute 'mover (desig:a motion (type moving) (goal (9 8 0))))))""")
    kernel.sleep(1)
    seen = [[(module.state, list(module.goals)) for module in message.modules] for message in looker.told["modules"]]
    assert seen == [[("RUNNING", [9.0, 8.0])], []]
