"""What a URDF file tells of one joint, as Lisp reads it: `CRAM-ROBOT-INTERFACES` asks it for limits, axes and origins.

Nothing here needs MuJoCo. A file is read once; what is read is not changed, so it may be shared.
"""

from __future__ import annotations

import functools
from math import isfinite
from pathlib import Path

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.lisp_core.packages import near_names

from . import description_files
from .descriptions import Description, DescriptionError

DATA = Path(__file__).parent / "data"


@functools.lru_cache(maxsize=8)
def description(source: str) -> Description:
    """The description in a URDF text or file. A name in no folder is that of a file of ours. Errors: `DescriptionError`, OSError."""
    if source.lstrip().startswith("<"):
        return description_files.read_text(source, "robot_description")
    path = Path(source)
    return description_files.read_file(path if path.is_file() else DATA / source)


def joint_figures(source: str, name: str) -> Cons:
    """Type, lower and upper limit (nil where there is none), axis, position, rotation (x y z w), parent and child link of a joint.

    source: the text or the file. Errors: a Lisp error that tells which joints there are, or what is wrong with the file.
    """
    try:
        robot = description(str(source))
    except (DescriptionError, OSError) as problem:
        return error("The robot's description cannot be read: ~A", str(problem))
    joint = robot.joints.get(str(name))
    if joint is None:
        near = near_names(str(name), robot.joints)
        return error("The robot ~A has no joint ~S.~@[ Did you mean ~A?~]", robot.name, name, " or ".join(near) or None)
    w, x, y, z = joint.frame.rotation
    limits = (float(limit) if isfinite(limit) and joint.moves else None for limit in (joint.lower, joint.upper))
    places = (list_from(map(float, numbers)) for numbers in (joint.axis, joint.frame.position, (x, y, z, w)))
    return list_from([joint.kind, *limits, *places, joint.parent, joint.child])
