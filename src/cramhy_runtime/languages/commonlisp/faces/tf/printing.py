"""How poses, transforms, points and vectors in a frame print (cl-transforms.md 9)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.printing import define_printer, prin1_to_string, princ_to_string, write
from cramhy_runtime.tf.stamped import PointStamped, PoseStamped, TransformStamped, VectorStamped
from cramhy_runtime.transforms.poses import Pose
from ..transforms.package import head


def _print_in_frame(obj, stream):
    head(obj, stream)
    child = f', CHILD-FRAME-ID: "{princ_to_string(obj.child_frame_id)}"' if isinstance(obj, TransformStamped) else ""
    stream.write(f' \n   FRAME-ID: "{princ_to_string(obj.frame_id)}"{child}, STAMP: {prin1_to_string(obj.stamp)}')
    for part in (obj.origin, obj.orientation) if isinstance(obj, Pose) else (obj.translation, obj.rotation):
        stream.write("\n   ")
        write(part, stream)
    stream.write(">")


def _print_vector_in_frame(obj, stream):
    head(obj, stream)
    stream.write(f' \n   FRAME-ID: "{princ_to_string(obj.frame_id)}" STAMP: {prin1_to_string(obj.stamp)}\n   V: ')
    stream.write("(" + " ".join(prin1_to_string(obj.component(index)) for index in range(3)) + ")>")


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    for _class in (PoseStamped, TransformStamped):
        define_printer(_class, _print_in_frame)
    for _class in (PointStamped, VectorStamped):
        define_printer(_class, _print_vector_in_frame)
