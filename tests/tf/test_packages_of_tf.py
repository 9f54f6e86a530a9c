"""CL-TRANSFORMS-STAMPED, CL-TF and CL-TF2: their names, arguments and classes, and that nobody pays for them who does not ask."""

import subprocess
import sys

import pytest

from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.languages.commonlisp.printer.print_controls import PRINT_GENSYM
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

STAMPED = {
    "make-pose-stamped": "(frame-id stamp translation rotation)",
    "make-point-stamped": "(frame-id stamp 3d-vector)",
    "make-vector-stamped": "(frame-id stamp 3d-vector)",
    "make-transform-stamped": "(frame-id child-frame-id stamp translation rotation)",
    "copy-pose-stamped": "(pose &key origin orientation stamp)",
    "pose->pose-stamped": "(frame-id stamp pose)",
    "pose-stamped->pose": "(pose-stamped)",
    "point->point-stamped": "(frame-id stamp point)",
    "vector->vector-stamped": "(frame-id stamp vector)",
    "transform->transform-stamped": "(frame-id child-frame-id stamp transform)",
    "transform-stamped->pose-stamped": "(transform)",
    "ensure-pose-stamped": "(obj &optional frame-id stamp)",
    "unslash-frame": "(frame)",
    "resolve-frame": "(prefix frame-name)",
    "make-stamped-transform": "(frame-id child-frame-id stamp translation rotation)",
    "transform->stamped-transform": "(frame-id child-frame-id stamp transform)",
    "stamped-transform->pose-stamped": "(transform)",
    "to-msg": "(obj)",
    "from-msg": "(msg)",
    "make-header-msg": "(stamp frame-id)",
    "make-point-msg": "(3d-vector)",
    "make-pose-stamped-msg": "(pose frame-id stamp)",
    "pose-stamped->point-stamped-msg": "(pose)",
    "restamp-msg": "(msg stamp)",
    "error-description": "(obj)",
    "frame-id": "(obj)",
    "stamp": "(obj)",
    "child-frame-id": "(obj)",
    "lookup-transform": "(transformer target-frame source-frame &key time (timeout 0.0d0) target-time fixed-frame)",
    "transform-pose-stamped": "(transformer &key target-frame pose (timeout 0.0d0) use-current-ros-time)",
    "transform-point-stamped": "(transformer &key target-frame point (timeout 0.0d0) use-current-ros-time)",
}
STAMPED_OTHERS = """stamped transform-stamped pose-stamped point-stamped vector-stamped stamped-transform transform-stamped-error
    connectivity-error lookup-error extrapolation-error invalid-argument-error timeout-error frame source-frame target-frame"""
TF = {
    "set-transform": "(tf transform &key suppress-callbacks)",
    "can-transform": "(tf &key target-frame source-frame time)",
    "wait-for-transform": "(tf &key target-frame source-frame time timeout)",
    "lookup-cached-transform": "(tf &key target-frame source-frame time)",
    "execute-changed-callbacks": "(tf)",
    "transform-pose": "(tf &key target-frame pose)",
    "transform-point": "(tf &key target-frame point)",
    "make-transform-broadcaster": "(&key topic)",
    "send-transform": "(broadcaster tr)",
    "send-transforms": "(broadcaster &rest transforms)",
    "send-static-transforms-blocking": "(broadcaster interval &rest transforms)",
    "send-static-transforms": "(broadcaster interval new-thread &rest transforms)",
    "transform->tf-msg": "(transform)",
    "transforms->tf-msg": "(transforms)",
    "tf-msg->transforms": "(msg)",
    "restamp-tf-msg": "(msg stamp)",
    "topic": "(broadcaster)",
}
TF_OTHERS = "transformer transform-listener make-transformer with-tf-broadcasting"
TF2 = {"make-transform-broadcaster": "(&key topic static)", "send-transform": "(broadcaster &rest transforms)"}
TF2_OTHERS = "buffer-client transform-broadcaster"


@pytest.mark.parametrize(
    "name, functions, others, reexported",
    [
        ("CL-TRANSFORMS-STAMPED", STAMPED, STAMPED_OTHERS, ["CL-TRANSFORMS"]),
        ("CL-TF", TF, TF_OTHERS, ["CL-TRANSFORMS-STAMPED"]),
        ("CL-TF2", TF2, TF2_OTHERS, ["CL-TRANSFORMS-STAMPED"]),
    ],
)
def test_the_names_of_each_package(session, name, functions, others, reexported):
    package = find_package(name)
    passed_on = {found for other in reexported for found in find_package(other).external}
    assert set(package.external) == passed_on | {found.upper() for found in functions} | set(others.upper().split())
    for found, parameters in functions.items():
        with binding(PRINT_GENSYM, None):
            shown = prin1_to_string(lambda_list_of(package.external[found.upper()].function))
        assert " ".join(shown.lower().split()) == parameters, found


def test_nicknames():
    """In a process of its own, for a program may take the name TF for a package of its own."""
    code = """if True:
        from cramhy_runtime.session import boot
        boot()
        from cramhy_runtime.lisp_core.packages import find_package
        assert find_package("TF") is find_package("CL-TF") and find_package("TF-TYPES") is find_package("CL-TRANSFORMS-STAMPED")"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_older_functions_are_of_cl_tf_alone(lisp):
    assert (
        lisp(
            "(list (eq 'cl-tf:transform-pose 'cl-transforms:transform-pose) (eq 'cl-tf2:transform-pose 'cl-transforms:transform-pose)"
            " (eq 'cl-tf:make-pose 'cl-transforms:make-pose))"
        )
        == "(NIL T T)"
    )


def test_kinds_of_conditions(lisp):
    for name in "connectivity-error lookup-error extrapolation-error invalid-argument-error timeout-error".split():
        assert (
            lisp(
                f'(handler-case (error \'{name} :description "two~%lines")'
                " (transform-stamped-error (problem) (list (error-description problem) (princ-to-string problem)"
                " (typep problem 'error))))"
            )
            == '("two~%lines" "two\nlines" T)'
        )
    assert lisp('(princ-to-string (make-condition \'timeout-error :description "a frame ~q"))') == '"a frame ~q"'


def test_what_is_stamped_is_plain_too(lisp):
    lisp('(defvar *pose* (make-pose-stamped "map" 1.0 (vec 1 2 3) (make-quaternion 0 0 0 2)))')
    assert lisp("(list (typep *pose* 'pose) (typep *pose* 'stamped) (q-norm (orientation *pose*)))") == "(T T 1.0d0)"
    assert lisp("(numbers (translation (pose->transform *pose*)))") == "(1.0d0 2.0d0 3.0d0)"
    assert lisp('(v+ (make-point-stamped "map" 1.0 #(1 2 3)) (vec 1 1 1))') == "#<3D-VECTOR (2.0d0 3.0d0 4.0d0)>"
    assert lisp("(let ((copy (copy-pose-stamped *pose* :stamp 2.0))) (list (frame-id copy) (stamp copy) (x (origin copy))))") == (
        '("map" 2.0 1.0d0)'
    )
    assert lisp("(let ((plain (pose-stamped->pose *pose*))) (list (type-of plain) (typep plain 'stamped)))") == "(POSE NIL)"
    assert lisp('(type-of (pose->pose-stamped "map" 0.0 (make-identity-pose)))') == "POSE-STAMPED"
    assert lisp('(make-instance \'pose-stamped :frame-id "map" :stamp 1 :origin (vec 1 2 3))') == (
        '#<POSE-STAMPED \n   FRAME-ID: "map", STAMP: 1\n   #<3D-VECTOR (1.0d0 2.0d0 3.0d0)>\n   #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>>'
    )


def test_old_names_are_warned_of(lisp):
    for old, new, call in (
        ("MAKE-STAMPED-TRANSFORM", "MAKE-TRANSFORM-STAMPED", '(make-stamped-transform "a" "b" 0.0 (vec 1 2 3) (still))'),
        (
            "TRANSFORM->STAMPED-TRANSFORM",
            "TRANSFORM->TRANSFORM-STAMPED",
            '(transform->stamped-transform "a" "b" 0.0 (make-identity-transform))',
        ),
        ("STAMPED-TRANSFORM->POSE-STAMPED", "TRANSFORM-STAMPED->POSE-STAMPED", '(stamped-transform->pose-stamped (at "a" "b" 0.0 1))'),
    ):
        assert lisp.warnings(call) == f"WARNING:\n   {old} is deprecated. Use {new} instead.\n"
    assert lisp('(typep (at "a" "b" 0.0 1) \'stamped-transform)') == "T"
    assert lisp.error("(make-transformer)").startswith("The function CL-TF:MAKE-TRANSFORMER is undefined.")


def test_methods_for_what_a_program_has(lisp):
    lisp("""(defclass cup () ())
            (defmethod to-msg ((cup cup)) (to-msg (vec 7 0 0)))
            (defmethod ensure-pose-stamped ((cup cup) &optional frame-id stamp)
              (make-pose-stamped (or frame-id "table") (or stamp 0.0) (vec 1 2 3) (still)))""")
    assert lisp("(list (x (from-msg (to-msg (make-instance 'cup)))) (x (from-msg (to-msg (vec 1 2 3)))))") == "(7.0d0 1.0d0)"
    assert lisp("(frame-id (ensure-pose-stamped (make-instance 'cup)))") == '"table"'


@pytest.mark.soak
def test_the_packages_are_made_when_somebody_names_them():
    text = (
        "import sys; from cramhy_runtime.session import boot; boot(); assert 'cramhy_runtime.tf' not in sys.modules;"
        "from cramhy_runtime.lisp_core.packages import find_package; assert find_package('TF').name == 'CL-TF';"
        "assert find_package('CL-TF2') and 'cramhy_runtime.tf' in sys.modules"
    )
    assert subprocess.run([sys.executable, "-c", text], capture_output=True, text=True).stderr == ""


def test_a_program_may_call_its_own_package_tf():
    text = (
        "from cramhy_runtime.session import boot; boot();"
        "from cramhy_runtime.repl.session import Session; session = Session(time='virtual', turtlesim=False);"
        "session.evaluate_text('(defpackage :tf (:use :cl)) (in-package :tf) (defun send-transform () 1) (cl-tf:make-identity-pose)');"
        "from cramhy_runtime.lisp_core.packages import find_package; assert find_package('TF') is not find_package('CL-TF')"
    )
    assert subprocess.run([sys.executable, "-c", text], capture_output=True, text=True).stderr == ""
