"""The Lisp package CL-TRANSFORMS, and how its objects print. Source: cl-transforms.md sections 1.4 and 9."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import lisp_list, truth
from ...packages.face_definition import define_face
from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from cramhy_runtime.lisp_core.packages import sym
from ...printer.print_controls import PRINT_ESCAPE
from ...printer.printer import write
from cramhy_runtime.lisp_core.printing import define_printer
from cramhy_runtime.lisp_core.printing import prin1_to_string
from ...types.types import define_type

from cramhy_runtime.transforms import matrices, poses, quaternions, vectors


def _define_type(name, *specifier):
    define_type(sym(f"CL-TRANSFORMS::{name}"), lambda form, environment: lisp_list(*specifier))


def head(obj, stream):
    """Write ``#<`` and the name of the object's class, with its package where the current one does not see it."""
    stream.write("#<")
    write(class_name(type(obj)), stream, escape=truth(PRINT_ESCAPE.value))


def numbers(components, kind, stream):
    """Write components in parentheses."""
    stream.write("(" + " ".join(prin1_to_string(kind(component)) for component in components) + ")")


def _print_vector(obj, stream):
    head(obj, stream)
    stream.write(" ")
    numbers(obj.components, float, stream)
    stream.write(">")


def _print_quaternion(obj, stream):
    head(obj, stream)
    stream.write(" ")
    numbers(obj.components, obj.kind, stream)
    stream.write(">")


def parts_printer(*parts):
    """A printer for an object with parts: each on a line of its own, three spaces from the margin wherever the object stands.

    The parts are printed as PRINC does, so without packages.
    """

    def print_parts(obj, stream):
        head(obj, stream)
        stream.write(" ")
        for attribute, label in parts:
            stream.write("\n   " + label)
            write(getattr(obj, attribute), stream, escape=False)
        stream.write(">")

    return print_parts


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    CL_TRANSFORMS = define_face(
        "CL-TRANSFORMS",
        use=("COMMON-LISP",),
        functions={
            vectors: "make-3d-vector make-identity-vector copy-3d-vector x y z v-inv dot-product cross-product v-norm v-dist "
            "normalize-vector interpolate-vector",
            "v+": vectors.v_plus,
            "v-": vectors.v_minus,
            "v*": vectors.v_star,
            "v*-pairwise": vectors.v_star_pairwise,
            "v/-pairwise": vectors.v_slash_pairwise,
            quaternions: "make-quaternion make-identity-rotation copy-quaternion w q-inv q-dot q-scale squared-norm q-norm normalize "
            "is-normalized axis-angle->quaternion quaternion->axis-angle euler->quaternion quaternion->euler get-yaw yaw "
            "rotate angle-between-quaternions normalize-angle slerp",
            "q=": quaternions.q_eq,
            "q*": quaternions.q_star,
            "q+": quaternions.q_plus,
            "q-": quaternions.q_minus,
            poses: "make-transform make-identity-transform copy-transform transform-inv transform-diff transform-point transform "
            "make-pose make-identity-pose make-2d-pose copy-pose reference-transform pose->transform transform->pose "
            "transform-pose translation rotation origin orientation make-twist make-identity-twist copy-twist make-wrench "
            "make-identity-wrench copy-wrench",
            "transform*": poses.transform_star,
            matrices: "quaternion->matrix matrix->quaternion transform->matrix pose->matrix matrix->transform invert-rot-matrix "
            "transpose-rot-matrix transpose-2d-matrix column-vectors->quaternion",
        },
        export="3d-vector quaternion pose twist wrench point gen-quaternion quaternion-coefficient",
        internal="norm",
    )
    for _name in "X Y Z W TRANSLATION ROTATION ORIGIN ORIENTATION".split():
        open_to_methods(CL_TRANSFORMS.intern(_name).function, f"CL-TRANSFORMS::{_name}", "(obj)", None)
    open_to_methods(poses.reference_transform, "CL-TRANSFORMS::REFERENCE-TRANSFORM", "(pose)", None)
    open_to_methods(poses.transform, "CL-TRANSFORMS::TRANSFORM", "(tr x)", None, None)
    _define_type("POINT", sym("OR"), sym("CL-TRANSFORMS::3D-VECTOR"), lisp_list(sym("VECTOR"), sym("*"), 3))
    _define_type("GEN-QUATERNION", sym("OR"), sym("CL-TRANSFORMS::QUATERNION"), lisp_list(sym("VECTOR"), sym("*"), 4), sym("REAL"))
    _define_type("QUATERNION-COEFFICIENT", sym("OR"), sym("FLOAT"))
    define_printer(vectors.Vector3, _print_vector)
    define_printer(quaternions.Quaternion, _print_quaternion)
    define_printer(poses.Transform, parts_printer(("translation", ""), ("rotation", "")))
    define_printer(poses.Pose, parts_printer(("origin", ""), ("orientation", "")))
    for _class in (poses.Twist, poses.Wrench):
        define_printer(_class, parts_printer(("translation", "TRANSLATION "), ("rotation", "ROTATION ")))
