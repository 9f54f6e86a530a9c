"""The packages for mobile manipulation: their names, nicknames, the packages that they use, what they export, and how they are loaded.

Source: mobile-manipulation.md, sections 1 to 10.
"""

import subprocess
import sys

import pytest

PACKAGES = {
    "cram-common-failures": (
        "common-fail",
        "cram-language",
        "low-level-failure high-level-failure actionlib-action-timed-out navigation-low-level-failure navigation-failure-location "
        "navigation-pose-unreachable navigation-goal-not-reached perception-low-level-failure perception-object-not-found "
        "object-not-found-object ptu-low-level-failure ptu-goal-unreachable ptu-goal-not-reached manipulation-low-level-failure "
        "manipulation-goal-not-reached manipulation-pose-unreachable gripper-low-level-failure gripper-failure-action "
        "gripper-closed-completely gripper-goal-not-reached torso-low-level-failure torso-goal-unreachable torso-goal-not-reached "
        "navigation-high-level-failure navigation-goal-in-collision navigation-failure-pose-stamped looking-high-level-failure "
        "manipulation-goal-in-collision environment-unreachable environment-manipulation-impossible object-unreachable object-unfetchable "
        "object-undeliverable object-nowhere-to-be-found object-unreachable-object object-unfetchable-object object-undeliverable-object "
        "object-nowhere-to-be-found-object",
    ),
    "cram-designator-specification": ("spec", "common-lisp cram-prolog", "property"),
    "cram-common-designators": (
        "",
        "common-lisp cram-prolog cram-designators cram-designator-specification",
        "move-base move-torso move-head detect inspect move-gripper-joint move-tcp move-joints move-with-constraints",
    ),
    "cram-plan-occasions-events": (
        "cpoe",
        "common-lisp cram-occasions-events cram-prolog",
        "object-perceived-event object-updated-event object-removed-event robot-state-changed object-connection-event object-attached "
        "object-detached object-articulation-event environment-manipulation-event container-opening-event container-closing-event "
        "event-object-designator perception-source event-object-name event-arm opening-distance environment-event-joint-name "
        "environment-event-arm environment-event-object environment-event-distance object-in-hand object-placed-at object-picked object-put "
        "loc looking-at arms-parked event-object link event-link side event-side object object-designator container-handle-grasping-event",
    ),
    "cram-robot-interfaces": (
        "",
        "common-lisp cram-prolog cram-designators",
        "robot robot-base-frame robot-odom-frame robot-torso-link-joint arm required-arms available-arms arm-joints arm-links "
        "arm-base-joints arm-base-links arm-tool-joints hand-links end-effector-link robot-tool-frame gripper-joint gripper-link "
        "robot-arms-parking-joint-states robot-arms-carrying-joint-states end-effector-parking-pose robot-pre-grasp-joint-states "
        "planning-group standard-to-particular-gripper-transform camera-frame camera-minimal-height camera-maximal-height "
        "robot-pan-tilt-links robot-pan-tilt-joints robot-neck-parking-joint-states robot-neck-looking-joint-states trajectory-point "
        "joint-lower-limit joint-upper-limit joint-type joint-axis joint-origin joint-parent-link joint-child-link get-joint-lower-limit "
        "get-joint-upper-limit get-joint-type get-joint-axis get-joint-origin get-joint-parent get-joint-child reachability-designator "
        "visibility-designator designator-reach-pose trajectory-desig? constraints-desig? reachability-designator-p "
        "visibility-designator-p current-robot-symbol current-robot-package current-robot-name symbol-to-prolog-rule compute-iks "
        "robot-description-file tcp-in-ee-pose gripper-meter-to-joint-multiplier",  # the last two of a later CRAM, the file of ours
    ),
    "cram-object-interfaces": (
        "obj-int",
        "common-lisp cram-prolog",
        "get-object-pose get-object-transform object-type-direct-subtype object-type-subtype object-rotationally-symmetric "
        "orientation-matters object-type-grasp get-object-type-gripping-effort get-object-type-gripper-opening "
        "get-object-type-to-gripper-transform get-object-type-to-gripper-pregrasp-transform "
        "get-object-type-to-gripper-2nd-pregrasp-transform get-object-type-to-gripper-lift-transform "
        "get-object-type-to-gripper-2nd-lift-transform def-object-type-to-gripper-transforms get-object-grasping-poses "
        "get-object-type-grasps calculate-object-faces object-type-grasp->robot-grasp robot-grasp->object-type-grasp *back-grasp-rotation* "
        "*front-grasp-rotation* *left-side-grasp-rotation* *right-side-grasp-rotation* *top-across-x-grasp-rotation* "
        "*top-across-y-grasp-rotation*",
    ),
    "cram-tf": (
        "",
        "common-lisp cram-designators cram-utilities cram-prolog cl-transforms-stamped cl-transforms cram-robot-interfaces",
        "*transformer* *tf-default-timeout* *fixed-frame* *odom-frame* *robot-base-frame* *robot-torso-frame* *robot-torso-joint* "
        "*robot-left-tool-frame* *robot-right-tool-frame* *broadcaster* *tf-broadcasting-enabled* *tf-broadcasting-topic* "
        "*tf-broadcasting-interval* pose->flat-list pose->flat-list-w-first pose->list flat-list->pose flat-list-w-first->pose list->pose "
        "poses-equal-p tf-frame-converged ensure-pose-in-frame ensure-point-in-frame frame-to-pose-in-fixed-frame robot-current-pose "
        "translate-pose rotate-pose translate-transform-stamped copy-transform-stamped pose->transform-stamped "
        "pose-stamped->transform-stamped transform-stamped-inv strip-transform-stamped multiply-transform-stampeds apply-transform "
        "make-euclidean-distance-filter make-tf-broadcaster add-transform remove-transform publish-transforms start-publishing-transforms "
        "stop-publishing-transforms visualize-marker pose pose-stamped position orientation poses-equal location-pose",
    ),
    "cram-mobile-pick-place-plans": (
        "pp-plans",
        "common-lisp cram-prolog",
        "move-arms-in-sequence park-arms release grip close-gripper set-gripper-to-position look-at go-to-target pick-up place perceive",
    ),
    "cram-pr2-description": ("", "common-lisp cram-prolog cram-robot-interfaces", "pr2 get-hand-link-names"),
    "cram-knowrob-pick-place": ("kr-pp", "common-lisp cram-object-interfaces cram-prolog", ""),
    "cram-simple-actionlib-client": ("actionlib-client", "common-lisp", "make-simple-action-client call-simple-action-client"),
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", PACKAGES)
def test_a_package_is_there_when_it_is_named(lisp, name):
    nickname, used, exported = PACKAGES[name]
    lisp(f'(find-symbol "T" \'#:{nickname or name})')  # which uses it, and does not only ask whether it is there
    assert lisp(f"(package-name (find-package '#:{nickname or name}))") == f'"{name.upper()}"'
    assert lisp(f"(package-nicknames '#:{name})") == (f'("{nickname.upper()}")' if nickname else "NIL")
    assert set(eval(lisp(f"(format nil \"~{{~S ~}}\" (mapcar #'package-name (package-use-list '#:{name})))")).split()) == {
        f'"{other.upper()}"' for other in used.split()
    }
    there = lisp(f'(let (names) (do-external-symbols (s \'#:{name}) (push (string-downcase s) names)) (format nil "~{{~A ~}}" names))')
    assert sorted(there.strip('"').split()) == sorted(exported.split())


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", PACKAGES)
def test_a_system_is_loaded_as_those_of_a_workspace_are(lisp, name):
    assert lisp(f"(asdf:load-system '#:{name})") == "T"
    assert lisp(f'(ros-load:load-system "{name.replace("-", "_")}" \'#:{name})') == "T"
    assert lisp(f"(stringp (asdf:system-description (asdf:find-system '#:{name})))") == "T"


@pytest.mark.soak
def test_a_system_that_depends_on_them(session, tmp_path):
    (tmp_path / "tea.asd").write_text('(defsystem "tea" :depends-on (cram-mobile-pick-place-plans cram-tf) :components ((:file "tea")))')
    (tmp_path / "tea.lisp").write_text("(defpackage :tea (:use :cl :cram-tf)) (in-package :tea) (defun rest-arms () (pp-plans:park-arms))")
    session.evaluate_text(f'(push #p"{tmp_path.as_posix()}/" asdf:*central-registry*)', "<test>")
    assert session.evaluate_text("(asdf:load-system :tea) (fboundp 'tea::rest-arms)", "<test>")[0]


@pytest.mark.soak
def test_an_image_that_names_none_of_them_has_none():
    program = (
        "from cramhy_runtime.session.boot import boot; boot()\n"
        "from cramhy_runtime.lisp_core.packages import registered\n"
        f"print([name for name in {[name.upper() for name in PACKAGES]!r} if registered(name)])\n"
        "import sys; print([name for name in sys.modules if 'robot_world' in name])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == ["[]", "[]"]
