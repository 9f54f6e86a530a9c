"""Facts that CRAM leaves to applications: no library states them, so that an application may, in a fact group that extends nothing.

CRAM's applications write ``(def-fact-group costmap-metadata () (<- (costmap:costmap-size 12 12)) ...)``. A placeholder ``(fail)`` in a library
would make that an error. The original's libraries have placeholders, too; `DECLARED` are the names of those.
"""

from __future__ import annotations

import re

import pytest
from lisp_text import LispText

from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.languages.commonlisp.systems.systems import find_asd
from cramhy_runtime.prolog.engine import database

pytestmark = pytest.mark.soak

pytest.importorskip("numpy", reason="needs numpy")

SYSTEMS = """cram-location-costmap cram-robot-pose-gaussian-costmap cram-occupancy-grid-costmap cram-btr-visibility-costmap
    cram-btr-spatial-relations-costmap cram-pr2-projection cram-pr2-description cram-robot-interfaces cram-object-interfaces
    cram-plan-occasions-events cram-bullet-reasoning-utilities cram-common-designators cram-mobile-pick-place-plans
    cram-knowrob-pick-place cram-pr2-environment-manipulation""".split()
DECLARED = """object-in-hand object-placed-at object-picked object-put loc looking-at arms-parked action-duration desig-costmap
    object-type-direct-subtype object-rotationally-symmetric orientation-matters object-type-grasp
    robot robot-base-frame robot-odom-frame robot-torso-link-joint robot-description-file arm required-arms available-arms arm-joints
    arm-links arm-base-joints arm-base-links arm-tool-joints hand-links end-effector-link robot-tool-frame gripper-joint gripper-link
    planning-group standard-to-particular-gripper-transform tcp-in-ee-pose gripper-meter-to-joint-multiplier
    robot-arms-parking-joint-states robot-arms-carrying-joint-states end-effector-parking-pose robot-pre-grasp-joint-states
    camera-frame camera-minimal-height camera-maximal-height robot-pan-tilt-links robot-pan-tilt-joints robot-neck-parking-joint-states
    robot-neck-looking-joint-states trajectory-point""".split()
"""Predicates that the original's libraries declare and applications and robots' descriptions extend, by a list of extendable predicates."""
SETTINGS = """(costmap:costmap-size 12 12) (costmap:costmap-origin -6 -6) (costmap:costmap-resolution 0.05) (costmap:costmap-padding 0.3)
    (costmap:costmap-manipulation-padding 0.4) (costmap:costmap-in-reach-distance 0.9) (costmap:costmap-reach-minimal-distance 0.2)
    (costmap:visibility-costmap-size 2) (costmap:orientation-samples 2) (costmap:orientation-sample-step 0.1)"""


@pytest.fixture
def lisp(session):
    for system in SYSTEMS:
        if find_asd(system) is None:
            pytest.skip(f"the system {system} is not there")
        session.evaluate_text(f'(asdf:load-system "{system}")')
    return LispText(session, "(in-package :cl-user)")


def is_placeholder(clause):
    return [goal.car.name for goal in clause.goals or () if isinstance(goal, Cons)] == ["FAIL"]


def test_no_library_has_a_placeholder_for_what_the_original_leaves_to_applications(lisp):
    placeholders = {functor.name.lower() for functor, entry in database.functors.items() if any(map(is_placeholder, entry.clauses))}
    assert placeholders <= set(DECLARED)
    assert "required-arms" in placeholders


def test_an_application_states_the_settings_of_costmaps_and_extends_nothing(lisp):
    facts = re.sub(r"\([^()]*\)", r"(prolog:<- \g<0>)", SETTINGS)
    assert lisp.warnings(f"(prolog:def-fact-group costmap-metadata () {facts})") == ""
    assert lisp("(length (cut:force-ll (prolog:prolog '(costmap:costmap-size ?w ?h))))") == "1"
    assert lisp("(= 12 (getf (costmap:costmap-metadata) :width))") == "T"
