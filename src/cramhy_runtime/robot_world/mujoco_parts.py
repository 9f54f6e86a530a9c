"""MuJoCo, and how a description becomes bodies of it.

The engine comes with the extra ``robot``. This module is the only one that imports it, so that all others may be imported without.
"""

from __future__ import annotations

import numpy as np

from cramhy_runtime.extras import install_command

from .descriptions import Description, Frame, Joint, Shape
from .mesh_files import Mesh
from .meshes import mesh_of

try:
    import mujoco
except ImportError as _problem:  # pragma: no cover  the tests of missing extras hide it
    raise ImportError(f"Robot worlds need MuJoCo, which is not installed: {install_command('robot')}") from _problem

__all__ = ["add_links", "add_shape", "body_name", "mujoco"]

_GEOMS = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
    "mesh": mujoco.mjtGeom.mjGEOM_MESH,
    "plane": mujoco.mjtGeom.mjGEOM_PLANE,
}
_JOINTS = {"prismatic": mujoco.mjtJoint.mjJNT_SLIDE, "revolute": mujoco.mjtJoint.mjJNT_HINGE, "continuous": mujoco.mjtJoint.mjJNT_HINGE}


def add_shape(body: mujoco.MjsBody, shape: Shape, spec: mujoco.MjSpec | None = None, **options: object) -> mujoco.MjsGeom:
    """Add a geom for ``shape`` to a body; ``options`` are attributes of the geom. A mesh needs the ``spec`` that the body is part of.

    Errors: `MeshError`.
    """
    if shape.kind == "mesh":
        options["meshname"] = _mesh_name(spec, mesh_of(shape))
    size = np.zeros(3)
    size[: len(shape.size)] = shape.size
    if shape.kind == "box":
        size /= 2  # MuJoCo counts from the middle
    elif shape.kind == "cylinder":
        size[1] /= 2
    elif shape.kind == "mesh":
        size[:] = 0
    elif shape.kind == "plane":
        size[2] = 1  # of the pattern that is drawn
    return body.add_geom(type=_GEOMS[shape.kind], size=size, pos=shape.frame.position, quat=shape.frame.rotation, **options)


def _mesh_name(spec: mujoco.MjSpec, mesh: Mesh) -> str:
    """The name of a mesh in the spec, which gets it once."""
    name = f"mesh {id(mesh)}"
    if spec.mesh(name) is None:
        added = spec.add_mesh(name=name, uservert=mesh.points.ravel(), inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX)
        if len(mesh.triangles):
            added.userface = mesh.triangles.ravel()
    return name


def body_name(link: str) -> str:
    """What the body of a link is called: not as the link, which may be called world, as MuJoCo calls its own."""
    return f"link {link}"


def add_links(body: mujoco.MjsBody, description: Description) -> None:
    """Add the links of ``description`` below ``body``, without shapes: what is needed to compute where they are."""
    made = {description.root: _weigh(body.add_body(name=body_name(description.root)))}
    for name in list(description.order)[1:]:
        joint = description.joint_above[name]
        made[name] = _add_link(made[joint.parent], joint)


def _add_link(parent: mujoco.MjsBody, joint: Joint) -> mujoco.MjsBody:
    frame: Frame = joint.frame
    body = _weigh(parent.add_body(name=body_name(joint.child), pos=frame.position, quat=frame.rotation))
    if joint.moves:
        body.add_joint(name=joint.name, type=_JOINTS[joint.kind], axis=joint.axis)
    return body


def _weigh(body: mujoco.MjsBody) -> mujoco.MjsBody:
    # A body that moves must weigh something; nothing here computes with it.
    body.mass, body.inertia, body.explicitinertial = 1.0, [1.0, 1.0, 1.0], True
    return body
