"""Where the links of a robot are, given the positions of its joints: forward kinematics.

A `Skeleton` belongs to one description and is shared by all robots of the kind: it computes, and keeps no state. Positions of joints are a
numpy array in the order of `Skeleton.joints`, radians or metres. Poses of links are in the frame of the root.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .descriptions import Description
from .mujoco_parts import add_links, body_name, mujoco

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .placements import Placement


class Skeleton:
    """Computes the poses of the links of ``description``.

    joints: names of the joints that move, in the order of their positions. links: the number of each link, in the order of the poses.
    lower, upper: the limits of the joints, infinite where they have none.
    """

    def __init__(self, description: Description) -> None:
        self.description = description
        spec = mujoco.MjSpec()
        add_links(spec.worldbody, description)
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.joints = [self.model.joint(number).name for number in range(self.model.njnt)]
        self.joint_numbers = {name: number for number, name in enumerate(self.joints)}
        self.links = {name: self.model.body(body_name(name)).id for name in description.links}
        moving = [description.joints[name] for name in self.joints]
        self.lower = np.array([joint.lower for joint in moving])
        self.upper = np.array([joint.upper for joint in moving])

    def positions(self, values: Mapping[str, float], start: np.ndarray | None = None) -> np.ndarray:
        """The positions of all joints: those of ``values``, else as in ``start``, else 0. Errors: KeyError, for a joint that does not
        move."""
        positions = np.zeros(len(self.joints)) if start is None else start.copy()
        for name, value in values.items():
            positions[self.joint_numbers[name]] = value
        return positions

    def place(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(positions n x 3, rotations n x 4) of all bodies, by the numbers of `links`. The arrays are used again by the next call."""
        self.data.qpos[:] = positions
        mujoco.mj_kinematics(self.model, self.data)
        return self.data.xpos, self.data.xquat

    def placed(self, root: Placement, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """As `place`, with the root at a place in the world; the arrays are the caller's."""
        base = self.links[self.description.root]
        self.model.body_pos[base], self.model.body_quat[base] = root.position, root.rotation
        places, rotations = (array.copy() for array in self.place(positions))
        self.model.body_pos[base], self.model.body_quat[base] = 0.0, (1.0, 0.0, 0.0, 0.0)
        return places, rotations

    def pose(self, positions: np.ndarray, link: str) -> tuple[np.ndarray, np.ndarray]:
        """(position, rotation) of one link, copied."""
        number = self.links[link]
        places, rotations = self.place(positions)
        return places[number].copy(), rotations[number].copy()
