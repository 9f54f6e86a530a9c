"""The Lisp packages CL-TRANSFORMS-STAMPED, CL-TF and CL-TF2. Source: cl-transforms.md 5 to 8.

They are made when a program first names one of them (``image.define_tf``). CL-TF and CL-TF2 export what CL-TRANSFORMS-STAMPED and
CL-TRANSFORMS do, too, but for the older `transform-pose` and `transform-point` of CL-TF, which are functions of its own.
"""

from __future__ import annotations


from ...packages.face_definition import define_face
from ...syntax.operator_macros import define, export
from ....operators import FRAMES
from . import printing
from ...objects.classes import alias_class
from cramhy_runtime.lisp_core.classes import register_class
from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from cramhy_runtime.lisp_core.packages import find_package, on_demand
from cramhy_runtime.tf import broadcasting, buffer_client, errors, frames, stamped, stamped_messages, transformer

STAMPED_GENERICS = {
    "frame-id": (stamped.frame_id, "(obj)"),
    "stamp": (stamped.stamp, "(obj)"),
    "child-frame-id": (stamped.child_frame_id, "(obj)"),
    "ensure-pose-stamped": (stamped.ensure_pose_stamped, "(obj &optional frame-id stamp)"),
    "to-msg": (stamped_messages.to_msg, "(obj)"),
    "from-msg": (stamped_messages.from_msg, "(msg)"),
    "lookup-transform": (transformer.lookup_transform, "(transformer target-frame source-frame &key time timeout target-time fixed-frame)"),
    "transform-pose-stamped": (transformer.transform_pose_stamped, "(transformer &key target-frame pose timeout use-current-ros-time)"),
    "transform-point-stamped": (transformer.transform_point_stamped, "(transformer &key target-frame point timeout use-current-ros-time)"),
}
CLASSES = (
    stamped.Stamped,
    stamped.TransformStamped,
    stamped.PoseStamped,
    stamped.PointStamped,
    stamped.VectorStamped,
    errors.TransformStampedError,
    errors.ConnectivityError,
    errors.FrameLookupError,
    errors.ExtrapolationError,
    errors.InvalidArgumentError,
    errors.TimeoutError_,
    transformer.Transformer,
    transformer.TransformListener,
    broadcasting.TransformBroadcaster,
    buffer_client.BufferClient,
)


def define_faces(names):
    """Make the packages, whose names and nicknames wait in `on_demand`. A nickname that a program has taken for a package of its own
    stays the program's."""
    free = {name for name in names if on_demand.pop(name, None) is not None}
    types = define_face(
        "CL-TRANSFORMS-STAMPED",
        free & {"TF-TYPES"},
        use=("COMMON-LISP", "CL-TRANSFORMS"),
        reexport=("CL-TRANSFORMS",),
        functions={
            stamped: "make-pose-stamped make-transform-stamped make-point-stamped make-vector-stamped copy-pose-stamped "
            "pose->pose-stamped pose-stamped->pose point->point-stamped vector->vector-stamped "
            "transform->transform-stamped transform-stamped->pose-stamped make-stamped-transform "
            "transform->stamped-transform stamped-transform->pose-stamped error-description",
            frames: "unslash-frame resolve-frame",
            stamped_messages: "make-header-msg make-point-msg make-pose-stamped-msg pose-stamped->point-stamped-msg restamp-msg",
            **{name: function for name, (function, _) in STAMPED_GENERICS.items()},
        },
        export="stamped transform-stamped pose-stamped point-stamped vector-stamped stamped-transform transform-stamped-error "
        "connectivity-error lookup-error extrapolation-error invalid-argument-error timeout-error frame source-frame target-frame",
    )
    for name, (function, parameters) in STAMPED_GENERICS.items():
        required = parameters.partition("&")[0].strip("() ").split()
        open_to_methods(function, f"CL-TRANSFORMS-STAMPED::{name.upper()}", parameters, *[None] * len(required))
    tf = define_face(
        "CL-TF",
        free & {"TF"},
        use=("COMMON-LISP", "CL-TRANSFORMS-STAMPED"),
        shadow="transform-pose transform-point",
        reexport=("CL-TRANSFORMS-STAMPED",),
        functions={
            transformer: "set-transform can-transform wait-for-transform lookup-cached-transform execute-changed-callbacks destroy",
            broadcasting: "make-transform-broadcaster send-transform send-transforms send-static-transforms-blocking "
            "send-static-transforms transform->tf-msg transforms->tf-msg tf-msg->transforms restamp-tf-msg "
            "while-broadcasting",
            "topic": broadcasting.topic,
            "transform-pose": transformer.old_transform_pose,
            "transform-point": transformer.old_transform_point,
        },
        export="transformer transform-listener make-transformer",
        internal="destroy while-broadcasting",  # the macro expands into the latter: a kept file names it, and so makes the package
    )
    define_face(
        "CL-TF2",
        use=("COMMON-LISP", "CL-TRANSFORMS-STAMPED"),
        reexport=("CL-TRANSFORMS-STAMPED",),
        functions={
            "make-transform-broadcaster": broadcasting.make_transform_broadcaster_2,
            "send-transform": broadcasting.send_transform_2,
        },
        export="buffer-client transform-broadcaster",
    )
    for package in (types, tf):
        package.lends_nicknames = True
    for cls in CLASSES:
        home, _, name = cls.lisp_name.partition("::")
        register_class(find_package(home).intern(name), cls)
    alias_class(types.intern("STAMPED-TRANSFORM"), stamped.TransformStamped)
    printing.define()
    export(FRAMES)
    define(FRAMES)
