"""Where a robot stands to reach or see something: the Gaussian costmaps and those of the map. Source: mobile-manipulation.md section 9."""

from __future__ import annotations

import pytest
from lisp_text import LispText

from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.languages.commonlisp.systems.systems import find_asd

pytest.importorskip("numpy", reason="needs numpy")
MISSING = [name for name in ("cram-robot-interfaces", "cram-tf") if find_asd(name) is None]
pytestmark = pytest.mark.skipif(bool(MISSING), reason=f"the systems {', '.join(MISSING)} are not there")

PRELUDE = """
(asdf:load-system "cram-robot-pose-gaussian-costmap")
(asdf:load-system "cram-occupancy-grid-costmap")
(defpackage #:pose-tests (:use #:cl #:costmap #:desig #:prolog) (:import-from #:cl-transforms #:make-3d-vector #:x #:y #:z #:origin))
(in-package #:pose-tests)
(setf cram-tf:*fixed-frame* "map")
(def-fact-group costmap-metadata (costmap-size costmap-origin costmap-resolution costmap-padding costmap-in-reach-distance
                                  costmap-reach-minimal-distance visibility-costmap-size orientation-samples orientation-sample-step)
  (<- (costmap-size 6 6)) (<- (costmap-origin -3 -3)) (<- (costmap-resolution 0.1)) (<- (costmap-padding 0.2))
  (<- (costmap-in-reach-distance 0.6)) (<- (costmap-reach-minimal-distance 0.2)) (<- (visibility-costmap-size 2))
  (<- (orientation-samples 2)) (<- (orientation-sample-step 0.1)))
(def-fact-group a-robot (cram-robot-interfaces:robot cram-robot-interfaces:arm)
  (<- (cram-robot-interfaces:robot pr2)) (<- (cram-robot-interfaces:arm pr2 :left)))
(defun at (x y z &optional (angle 0.0))
  (cl-transforms-stamped:make-pose-stamped "map" 0.0 (make-3d-vector x y z)
    (cl-transforms:axis-angle->quaternion (make-3d-vector 0 0 1) angle)))
(defun place (&rest properties) (make-designator :location properties))
(defun to-reach () (place '(:reachable-for pr2) (list :pose (at 1 1 0.8))))
(defun to-see () (place '(:visible-for pr2) (list :pose (at 1 1 0.8))))
(defun distances (place count)
  (sort (loop repeat count
              for pose = (reference place)
              collect (cl-transforms:v-dist (origin pose) (make-3d-vector 1 1 (z (origin pose))))
              do (setf place (next-solution place)))
        #'<))
(defun scores (place)
  (sort (mapcar (lambda (generator) (costmap-generator-name->score (generator-name generator)))
                (cost-functions (costmap::designator-costmap place)))
        #'>))
"""


@pytest.fixture
def lisp(session):
    return LispText(session, "(in-package #:pose-tests)" if find_package("POSE-TESTS") else PRELUDE)


def test_a_place_to_reach_from_is_in_a_ring_and_on_the_floor(lisp):
    assert lisp("(let ((d (distances (to-reach) 30))) (list (<= 0.19 (first d)) (<= (first (last d)) 0.61)))") == "(T T)"
    assert lisp("(z (origin (reference (to-reach))))") == "0.0d0"


def test_a_place_to_see_from_is_in_a_disc_and_looks_there(lisp):
    assert lisp("(<= (first (last (distances (to-see) 30))) 2.01)") == "T"
    assert lisp("(gaussian-costmap::visible-location-validator (to-see) (reference (to-see)))") == ":ACCEPT"


def test_the_functions_have_their_scores(lisp):
    lisp("(defun scores-alone (place) (setf (cpl:value cram-occupancy-grid-costmap::*map*) nil) (scores place))")
    assert lisp("(list (scores-alone (to-reach)) (scores-alone (to-see)) (scores-alone (place (list :reachable-from (at 0 0 0)))))") == (
        "((7 6 5) (7 5) (5 4))"
    )


def test_each_of_several_targets_has_its_ring(lisp):
    both = "(place '(:reachable-for pr2) (list :pose (at 1 1 0.8)) (list :pose (at 1.2 1 0.8)))"
    assert lisp(f"(scores {both})") in ("(7 7 6 6 5)", "(7 6 5)")  # the first pose only, where designator-reach-pose has one solution


VERDICTS = {
    "robot-location-on-floor (to-reach) (at 0 0 0.04)": ":ACCEPT",
    "robot-location-on-floor (to-reach) (at 0 0 0.06)": ":REJECT",
    "robot-location-on-floor (to-see) (at 0 0 0.06)": ":REJECT",
    "robot-location-on-floor (place '(:other t)) (at 0 0 0.06)": ":UNKNOWN",
    "robot-location-on-floor (to-see) 3": ":UNKNOWN",
    "reachable-location-validator (to-reach) (at 0.5 1 0)": ":ACCEPT",
    "reachable-location-validator (to-reach) (at 0.5 1 0 0.09)": ":ACCEPT",
    "reachable-location-validator (to-reach) (at 0.5 1 0 0.11)": ":REJECT",
    "reachable-location-validator (to-reach) (at 0.3 1 0)": ":REJECT",
    "reachable-location-validator (to-reach) (at 0.9 1 0)": ":REJECT",
    "reachable-location-validator (to-see) (at 0.9 1 0)": ":UNKNOWN",
    "visible-location-validator (to-see) (at -0.9 1 0)": ":ACCEPT",
    "visible-location-validator (to-see) (at -1.1 1 0)": ":REJECT",
    "visible-location-validator (to-see) (at -0.9 1 0 3.0)": ":REJECT",
    "visible-location-validator (to-reach) (at -0.9 1 0)": ":UNKNOWN",
}


@pytest.mark.parametrize("call", VERDICTS)
def test_verdicts(lisp, call):
    assert lisp(f"(gaussian-costmap::{call})") == VERDICTS[call]


def test_without_a_map_the_costmap_has_no_functions_and_with_one_the_floor_must_be_free(lisp):
    lisp("(setf (cpl:value cram-occupancy-grid-costmap::*map*) nil)")
    assert lisp("(length (cost-functions (costmap::designator-costmap (to-reach))))") == "3"
    lisp(
        """(setf (cpl:value cram-occupancy-grid-costmap::*map*)
              (roslisp:make-message "nav_msgs/OccupancyGrid" (width info) 60 (height info) 60 (resolution info) 0.1
                (x position origin info) -3.0 (y position origin info) -3.0
                data (let ((data (make-array 3600 :initial-element 0)))
                       (dotimes (row 60 data) (loop for column from 40 below 60 do (setf (aref data (+ (* 60 row) column)) 100))))))"""
    )
    assert lisp("(subseq (scores (to-reach)) 0 2)") == "(15 15)"
    # What lies beyond x = 1 is occupied, and 0.2 m before it is padding.
    assert lisp(
        "(loop with place = (to-reach) repeat 30 maximize (x (origin (reference place))) do (setf place (next-solution place)))"
    ) in ("0.7000000551342964d0",)
    lisp("(setf (cpl:value cram-occupancy-grid-costmap::*map*) nil)")


def test_without_a_setting_the_rules_give_no_costmap(lisp):
    lisp("(setf (cpl:value cram-occupancy-grid-costmap::*map*) nil)")
    lisp("(def-fact-group costmap-metadata (costmap-size costmap-origin costmap-resolution)"
         " (<- (costmap-size 6 6)) (<- (costmap-origin -3 -3)) (<- (costmap-resolution 0.1)))")  # fmt: skip
    assert lisp("(cost-functions (costmap::designator-costmap (to-reach)))") == "NIL"
    assert lisp("(gaussian-costmap::reachable-location-validator (to-reach) (at 0.5 1 0))") == ":UNKNOWN"
