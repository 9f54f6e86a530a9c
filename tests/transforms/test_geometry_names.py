"""CL-TRANSFORMS, name by name: what each is and with which arguments (cl-transforms.md sections 1.1, 2 to 4 and 9)."""

import pytest

from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.languages.commonlisp.objects.classes import find_class
from cramhy_runtime.languages.commonlisp.printer.print_controls import PRINT_GENSYM
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.lisp_core.packages import ensure_package

FUNCTIONS = {
    "(x y z)": "make-3d-vector",
    "nil": "make-identity-vector make-identity-transform make-identity-pose make-identity-twist make-identity-wrench",
    "(v &key x y z)": "copy-3d-vector",
    "(&rest vecs)": "v+ v-",
    "(v scalar)": "v*",
    "(v-1 v-2)": "v*-pairwise v/-pairwise dot-product cross-product v-dist",
    "(v)": "v-inv v-norm normalize-vector",
    "(v-0 v-1 ratio)": "interpolate-vector",
    "(x y z w)": "make-quaternion",
    "(&optional type-template)": "make-identity-rotation",
    "(q &key x y z w)": "copy-quaternion",
    "(q1 q2)": "q= q-dot angle-between-quaternions",
    "(&rest args)": "q* q+",
    "(q)": "q-inv squared-norm q-norm normalize is-normalized quaternion->axis-angle get-yaw quaternion->matrix",
    "(q1 &rest args)": "q-",
    "(q scalar)": "q-scale",
    "(axis angle)": "axis-angle->quaternion",
    "(&key (ax 0.0) (ay 0.0) (az 0.0))": "euler->quaternion",
    "(q &key just-values)": "quaternion->euler",
    "(angle)": "yaw normalize-angle",
    "(q v &key (normalize :check))": "rotate",
    "(q1 q2 ratio)": "slerp",
    "(translation rotation &key (validate-args :warn))": "make-transform",
    "(transform &key translation rotation)": "copy-transform",
    "(trans)": "transform-inv",
    "(&rest transforms)": "transform*",
    "(transform-to transform-from)": "transform-diff",
    "(trans p)": "transform-point",
    "(tr x)": "transform",
    "(origin orientation)": "make-pose",
    "(x y theta)": "make-2d-pose",
    "(pose &key origin orientation)": "copy-pose",
    "(pose)": "reference-transform pose->transform pose->matrix",
    "(transform)": "transform->pose transform->matrix",
    "(tr p)": "transform-pose",
    "(obj)": "x y z w translation rotation origin orientation",
    "(translation rotation)": "make-twist make-wrench",
    "(twist &key translation rotation)": "copy-twist",
    "(wrench &key translation rotation)": "copy-wrench",
    "(matrix)": "matrix->quaternion matrix->transform invert-rot-matrix transpose-rot-matrix transpose-2d-matrix",
    "(x y z) ": "column-vectors->quaternion",
}
CLASSES = "3d-vector quaternion transform pose twist wrench"
TYPES = "point gen-quaternion quaternion-coefficient"

CL_TRANSFORMS = ensure_package("CL-TRANSFORMS")


@pytest.mark.soak(all_but=17)
@pytest.mark.parametrize("lambda_list, names", FUNCTIONS.items())
def test_the_arguments_of_each_function(lambda_list, names):
    for name in names.upper().split():
        symbol, status = CL_TRANSFORMS.lookup(name)
        assert status == "external", name
        with binding(PRINT_GENSYM, None):
            assert prin1_to_string(lambda_list_of(symbol.function)) == lambda_list.strip().upper(), name


def test_every_export_is_a_function_a_class_or_a_type():
    functions = {name for names in FUNCTIONS.values() for name in names.upper().split()}
    assert set(CL_TRANSFORMS.external) == functions | set(f"{CLASSES} {TYPES}".upper().split())


@pytest.mark.parametrize("name", CLASSES.upper().split())
def test_the_classes(name):
    assert find_class(CL_TRANSFORMS.external[name]).__name__


def test_types_of_arguments(lisp):
    kinds = "'(point gen-quaternion quaternion-coefficient)"
    for thing, answer in (
        ("*x*", "(T NIL NIL)"),
        ("#(1 2 3)", "(T NIL NIL)"),
        ("'(1 2 3)", "(NIL NIL NIL)"),
        ("#(1 2)", "(NIL NIL NIL)"),
        ("(yaw 1.0)", "(NIL T NIL)"),
        ("#(1 2 3 4)", "(NIL T NIL)"),
        ("2", "(NIL T NIL)"),
        ("2.0", "(NIL T T)"),
        ("2d0", "(NIL T T)"),
    ):
        assert lisp(f"(mapcar (lambda (kind) (typep {thing} kind)) {kinds})") == answer, thing


def test_readers_of_other_things(lisp):
    assert lisp("(list (x #(1 2 3)) (z #(1 2 3)) (w #(1 2 3 4)) (x 3) (y 3.0) (z 1/2) (w 3))") == "(1 3 4 0.0 0.0 0.0 3)"
    text = (
        "There is no applicable method for the generic function\n  #<STANDARD-GENERIC-FUNCTION CL-TRANSFORMS:{}>\nwhen called with "
        "arguments\n  ({}).\nSee also:\nThe ANSI Standard, Section 7.6.6"
    )
    assert lisp.error("(x nil)") == text.format("X", "NIL")
    assert lisp.error("(v-dist *x* nil)") == text.format("X", "NIL")
    assert lisp.error("(w *x*)") == text.format("W", "#<3D-VECTOR (1.0d0 0.0d0 0.0d0)>")
    assert lisp.error("(w #(1 2 3))").startswith("Invalid index 3 for (SIMPLE-VECTOR 3)")
    assert lisp.error("(origin *x*)") == text.format("ORIGIN", "#<3D-VECTOR (1.0d0 0.0d0 0.0d0)>")


def test_generic_functions_take_methods(lisp):
    lisp("""(defmethod transform ((tr transform) (x string)) (concatenate 'string "moved " x))
            (defmethod reference-transform ((x string)) (make-identity-transform))
            (defclass place () ((east :initarg :east)))
            (defmethod x ((place place)) (slot-value place 'east))""")
    assert lisp('(list (transform *a* "cup") (x (make-instance \'place :east 7)) (x *x*) (eq (reference-transform *a*) *a*))') == (
        '("moved cup" 7 1.0d0 T)'
    )
    assert lisp('(near (transform (reference-transform "here") #(1 2 3)) \'(1 2 3))') == "T"
    assert lisp("(eq 'nobody (handler-case (transform *a* *a*) (error () 'nobody)))") == "T"


def test_what_a_transform_is_applied_to(lisp):
    assert (
        lisp(
            "(list (near (transform *a* *x*) '(1 3 3)) (near (transform *a* #(1 0 0)) '(1 3 3))"
            " (near (origin (transform *a* (make-pose *x* (yaw 0.0)))) '(1 3 3)))"
        )
        == "(T T T)"
    )
    assert lisp("(near (transform *a* (make-array 3 :initial-contents '(1 0 0) :adjustable t :fill-pointer t)) '(1 3 3))") == "T"
    assert lisp.error("(transform *a* #(1 2))") == (
        "The assertion (= 3 (LENGTH CL-TRANSFORMS::P)) failed with (LENGTH CL-TRANSFORMS::P) = 2."
    )


def test_angles_that_are_no_numbers(lisp):
    assert lisp.error('(normalize-angle "a")', "type-error") == 'The value\n  "a"\nis not of type\n  REAL'
    for text in (
        "(normalize-angle sb-ext:double-float-positive-infinity)",
        "(yaw sb-ext:double-float-negative-infinity)",
        "(euler->quaternion :az sb-ext:double-float-positive-infinity)",
        "(q-inv (make-quaternion 0 0 0 0))",
    ):
        assert lisp.error(text) == "arithmetic error FLOATING-POINT-INVALID-OPERATION signalled", text


def test_an_angle_of_many_turns_is_normalised_at_once(lisp):
    # In the original 2 pi vanishes in such a number, and the loop has no end.
    assert lisp("(<= (- pi) (normalize-angle 1d30) pi)") == "T"
    assert lisp("(< (abs (- (normalize-angle (+ 1 (* 2000000 pi))) 1)) 1d-6)") == "T"
    assert lisp("(normalize-angle -1d300)").endswith("d0")


def test_numbers_that_are_no_doubles(lisp):
    assert lisp("(make-3d-vector 1.5 2/3 3d0)") == "#<3D-VECTOR (1.5d0 0.6666666666666666d0 3.0d0)>"
    assert lisp("(make-3d-vector 0.1 0 0)") == "#<3D-VECTOR (0.10000000149011612d0 0.0d0 0.0d0)>"
    assert lisp.error("(make-3d-vector #c(1 2) 0 0)", "type-error") == "The value\n  #C(1 2)\nis not of type\n  REAL"
    assert lisp.error("(make-3d-vector (expt 10 400) 0 0)", "arithmetic-error")
    assert lisp("(list (squared-norm 2) (q-norm #(1 2 2 4)) (q-dot #(1 2 3 4) #(1 2 3 4)) (q-dot (make-quaternion 0 0 0 2) 3))") == (
        "(4.0 5.0 30 6.0d0)"
    )


def test_a_matrix_that_is_too_small(lisp):
    assert lisp.error("(matrix->quaternion #2A((1 0) (0 1)))") == (
        "The assertion (EQUAL (ARRAY-DIMENSIONS CL-TRANSFORMS::MATRIX) '(3 3)) failed: the matrix is 2 by 2."
    )
    assert lisp.error("(matrix->quaternion 3)", "type-error") == (
        "The value\n  3\nis not of type\n  (ARRAY * (* *))\nwhen binding CL-TRANSFORMS::MATRIX"
    )
    assert lisp("(transpose-2d-matrix #2A((1 2 3) (4 5 6)))") == "#2A((1 4) (2 5) (3 6))"


def test_vectors_have_no_setters(lisp):
    assert lisp.error("(setf (x *x*) 4)", "undefined-function").startswith("The function (COMMON-LISP:SETF CL-TRANSFORMS:X) is undefined.")
    assert lisp.error("(setf (origin (make-identity-pose)) *x*)", "undefined-function")


def test_arguments_in_the_wrong_order(lisp):
    for text in ("(make-pose (yaw 1.0) *x*)", "(make-transform (yaw 1.0) *x*)"):
        assert lisp.error(text, "type-error") == (
            "The value\n  #<3D-VECTOR (1.0d0 0.0d0 0.0d0)>\nis not of type\n  CL-TRANSFORMS:GEN-QUATERNION\nwhen binding CL-TRANSFORMS::Q"
        )
        assert lisp.condition(text).hint == "The place comes first, then the rotation."


def test_a_class_of_ones_own_prints_its_name(lisp):
    lisp("(defclass named-pose (pose) ((name :initarg :name)))")
    assert lisp('(make-instance \'named-pose :name "home" :orientation (make-quaternion 0 0 2 0))') == (
        "#<NAMED-POSE \n   #<3D-VECTOR (0.0d0 0.0d0 0.0d0)>\n   #<QUATERNION (0.0d0 0.0d0 1.0d0 0.0d0)>>"
    )
    assert lisp('(type-of (transform-pose *a* (make-instance \'named-pose :name "home")))') == "POSE"
