"""The names of CRAM-PHYSICS-UTILS, CRAM-BULLET-REASONING, CRAM-PR2-PROJECTION and CFFI-ROS-UTILS: all that the original exports, and what they do."""

from __future__ import annotations

import pytest
from lisp_text import LispText

from cramhy_runtime.lisp_core.packages import find_package

pytestmark = pytest.mark.soak

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

PRELUDE = """
(dolist (system '(:cram-bullet-reasoning :cram-physics-utils :cram-pr2-projection :cffi-ros-utils)) (asdf:load-system system))
(defpackage :physics-tests (:use :cl :physics-utils))
(in-package :physics-tests)
(defun p (x y z) (cl-transforms:make-3d-vector x y z))
(defun parts (v) (list (cl-transforms:x v) (cl-transforms:y v) (cl-transforms:z v)))
(defparameter *corners* (list (p 0 0 0) (p 1 0 0) (p 0 2 0) (p 0 0 3)))
(defun face-of (&rest numbers) (make-face :points (mapcar (lambda (n) (nth n *corners*)) numbers)))
(defun model () (make-3d-model :vertices *corners* :faces (list (face-of 0 2 1) (face-of 0 1 3) (face-of 0 3 2) (face-of 1 2 3))))
(defun size (model) (parts (calculate-aabb (3d-model-vertices model))))
(defun a-world () (let ((w (make-instance 'btr:bt-reasoning-world))) (btr:add-object w :box 'block '((0 0 1) (0 0 0 1)) :size '(0.2 0.4 0.6)) w))
(defun near (numbers) (mapcar (lambda (n) (/ (round n 0.001) 1000)) numbers))
"""
NAMES = {
    "cram-physics-utils": """face make-face face-points face-normals make-3d-model 3d-model 3d-model-vertices 3d-model-faces load-3d-model parse-uri
        calculate-aabb scale-3d-model resize-3d-model shape-msg->points shape-msg->mesh points->point-cloud calculate-mass event-queue post-event
        get-next-event wait-for-queue-empty fix-normals transform-3d-model object-shape-data-mixin object-mesh-data-mixin
        object-point-data-mixin shape-type dimensions vertices faces points get-shape-message""",
    "cram-pr2-projection": """with-simulated-robot with-projected-robot action-duration projection-timestamp-function execute-as-action
        *debug-short-sleep-duration* *debug-long-sleep-duration*""",
    "cffi-ros-utils": "ros-library-paths ros-include-paths ros-grovel-file define-foreign-ros-library",
    "cram-bullet-reasoning": """merge-bounding-boxes camera width height fov-y z-near z-far gl-execute-with-camera camera-transform
        look-at-object-rotation with-rendering-to-framebuffer render-to-framebuffer get-rendering-context read-pixelbuffer read-depthbuffer
        to-png-image generic-cup mesh world make-object box static-plane sphere cylinder cone point-cloud cutlery fork knife mug plate mondamin
        pot bowl sugar-box apple orange cereal spatula pancake pancake-maker invalidate-object bt-reasoning-world-state semantic-map-object
        object-visibility semantic-map-part semantic-map-part-type semantic-map-part-pose object-visibility-percentage
        object-visibility-occluding-objects flat-color-object-proxy object-pose-different ik-solution-not-in-collision grasp side ?w
        init-ros-object-database ros-household-object make-joint-state-message open-object close-object
        set-articulated-object-joint-position copied-world obj-pose-on obj-poses-on drawable-list drawable-list-drawables make-drawable-list
        event holds-in-world""",
}


@pytest.fixture
def lisp(session):
    return LispText(session, "(in-package :physics-tests)" if find_package("PHYSICS-TESTS") else PRELUDE)


@pytest.mark.parametrize("package", NAMES)
def test_all_names_of_the_original_are_exported(lisp, package):
    wanted = " ".join(f'"{name.upper()}"' for name in NAMES[package].split())
    form = f"(remove-if (lambda (name) (eq :external (nth-value 1 (find-symbol name :{package})))) '({wanted}))"
    assert lisp(form) == "NIL"


@pytest.mark.parametrize(
    ("form", "value"),
    [
        ("(list (length (3d-model-vertices (model))) (length (3d-model-faces (model))))", "(4 4)"),
        ("(parts (first (face-normals (aref (3d-model-faces (model)) 0))))", "(0.0d0 0.0d0 -1.0d0)"),
        ("(parts (nth-value 1 (calculate-aabb *corners*)))", "(0.5d0 1.0d0 1.5d0)"),
        ("(list (size (scale-3d-model (model) 2)) (size (scale-3d-model (model) (p 1 1/2 2))))", "((2.0d0 4.0d0 6.0d0) (1.0d0 1.0d0 6.0d0))"),
        ("(size (resize-3d-model (model) (p 1 1 1)))", "(1.0d0 1.0d0 1.0d0)"),
        ("(parts (aref (3d-model-vertices (transform-3d-model (model) (cl-transforms:make-transform (p 1 1 1) (cl-transforms:make-identity-rotation)))) 0))",
         "(1.0d0 1.0d0 1.0d0)"),
        ("(parts (first (face-normals (aref (fix-normals (list (face-of 0 1 2))) 0))))", "(0.0d0 0.0d0 1.0d0)"),
        ("(list (calculate-mass :box :size-x 1 :size-y 2 :size-z 3) (calculate-mass :box :density 2 :size-x 1 :size-y 1 :size-z 1)"
         " (round (calculate-mass :sphere :radius 1)) (round (calculate-mass :cylinder :radius 1 :height 2)) (calculate-mass :mesh :points *corners*))",
         "(6000 2 4189 6283 6000.0d0)"),
        ("(let ((q (make-instance 'event-queue))) (post-event q '(one 1)) (post-event q '(two)) (list (get-next-event q) (get-next-event q)"
         " (get-next-event q 0.1) (wait-for-queue-empty q)))", "((ONE 1) (TWO) NIL NIL)"),
        ("(let ((q (make-instance 'event-queue))) (post-event q '(one)) (wait-for-queue-empty q 0.1))", "NIL"),
        ("(let* ((w (a-world)) (box (btr:aabb (btr:object w 'block)))) (near (parts (btr:bounding-box-dimensions (btr:merge-bounding-boxes box"
         " (cl-bullet:make-bounding-box :center (p 1 0 0) :dimensions (p 1 1 1)))))))", "(8/5 1 9/5)"),
        ("(let ((w (a-world))) (near (parts (cl-transforms:origin (btr:obj-pose-on '((1 1 1) (0 0 0 1)) (btr:object w 'block))))))", "(1 1 13/10)"),
        ("(let* ((w (a-world)) (btr:*current-bullet-world* w)) (near (parts (cl-transforms:origin (cut:lazy-car (btr:obj-poses-on 'block (list (p 0 0 0))))))))",
         "(0 0 3/10)"),
        ("(let ((w (a-world))) (eq w (btr:world (btr:object w 'block))))", "T"),
        ("(let* ((w (a-world)) (copy (cdr (assoc '?c (cut:lazy-car (prolog:prolog `(btr:copied-world ,w ?c))))))) (setf (btr:pose (btr:object copy 'block))"
         " (btr:ensure-pose '((1 0 1) (0 0 0 1)))) (list (and (prolog:prolog `(btr:object-pose-different ,w ,copy block)) t)"
         " (prolog:prolog `(btr:object-pose-different ,w ,w block))))", "(T NIL)"),
        ("(let ((c (make-instance 'btr:camera :width 100))) (list (btr:width c) (btr:height c) (btr:fov-y c) (parts (cl-transforms:translation (btr:camera-transform c)))))",
         "(100 200 50 (0.0d0 0.0d0 0.0d0))"),
        ("(near (parts (cl-transforms:rotate (btr:look-at-object-rotation (btr:ensure-pose '(0 0 0)) (btr:ensure-pose '(5 0 0))) (p 0 0 1))))", "(1 0 0)"),
        ("(btr:event (btr:make-event (a-world) '(opened door) 3))", "(OPENED DOOR)"),
        ("(roslisp:with-fields (name position) (btr:make-joint-state-message '((\"a\" 1.5) (\"b\" 2.0))) (list name position))",
         '(#("a" "b") #(1.5 2.0))'),
        ("(list pr2-proj:*debug-short-sleep-duration* (pr2-proj:action-duration (desig:a motion (type going)) :default 2) (pr2-proj:projection-timestamp-function))",
         "(0.0 2 0)"),
        ("(cffi-ros-utils:ros-library-paths \"no_such_package\")", "NIL"),
    ],
)  # fmt: skip
def test_what_the_names_do(lisp, form, value):
    assert lisp(form) == value


@pytest.mark.parametrize(
    ("form", "said"),
    [
        ("(btr:read-pixelbuffer (make-instance 'btr:camera))", "READ-PIXELBUFFER draws with OpenGL, which cramhy does not."),
        ("(btr:with-rendering-to-framebuffer (1 2) 3)", "GET-RENDERING-CONTEXT draws with OpenGL, which cramhy does not."),
        ("(btr:init-ros-object-database)", "asks the database of household objects, which cramhy does not have."),
        ('(btr:semantic-map-part-pose nil "x")', "asks a semantic map of KnowRob, which cramhy does not have."),
        ("(btr:make-object (a-world) 'thing)", "THING cannot be made of bodies of Bullet's, which cramhy does not have."),
    ],
)
def test_what_is_not_here_is_named(lisp, form, said):
    assert said in lisp.error(form)


@pytest.mark.parametrize("name", "joint-states joint-names link-names links urdf world name pose rigid-bodies item-types".split())
def test_a_function_of_objects_refuses_nil(lisp, name):
    said = lisp.error(f"(btr:{name} nil)")
    assert "no applicable method" in said.lower() and name.upper() in said


def test_no_function_that_is_called_with_nil_ends_in_an_error_of_python(lisp):
    assert (
        lisp("""(let (wrong)
      (do-external-symbols (name :btr wrong)
        (when (and (fboundp name) (not (macro-function name)) (eq (symbol-package name) (find-package :btr)))
          (loop for count from 1 to 3
                do (handler-case (progn (apply name (make-list count)) (return))
                     (program-error () nil)
                     (error (problem)
                       (when (search "NoneType" (princ-to-string problem)) (push name wrong))
                       (return)))))))""")
        == "NIL"
    )
    said = " ".join(lisp.error("(btr:attached-objects nil)").split())
    assert said.startswith("There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION CRAM-BULLET-REASONING:ATT")


def test_an_item_with_the_flag_of_static_objects_does_not_fall(lisp):
    text = """(let* ((world (a-world)) (body (first (btr:rigid-bodies (btr:object world 'block)))) said)
      (flet ((note () (btr:simulate world 10)
                      (push (list (cl-bullet:collision-flags body) (first (last (near (parts (cl-transforms:origin (btr:pose body))))))) said)))
        (setf (cl-bullet:collision-flags body) :cf-static-object)
        (note)
        (setf (cl-bullet:collision-flags body) nil)
        (note)
        (reverse said)))"""
    assert lisp(text) == "(((:CF-STATIC-OBJECT) 1) (NIL 3/10))"
