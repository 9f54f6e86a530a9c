"""Joint positions that bring the tip of an arm to a pose: inverse kinematics by damped least squares.

A `Reach` solves for one chain of joints, from one link to another. It begins at several postures, the wanted one first, the others drawn
once with a fixed seed, so that the same question has the same answer each time; from each it walks down the error with steps that keep the
limits. No closed form is needed, so it serves any arm; for the PR2's seven joints it finds nearly all that there is to find.

Source: S. R. Buss, Introduction to Inverse Kinematics with Jacobian Transpose, Pseudoinverse and Damped Least Squares methods (2009).
"""

from __future__ import annotations

from math import inf, pi
from typing import TYPE_CHECKING

import numpy as np

from .descriptions import Description, Joint
from .mujoco_parts import mujoco
from .skeleton import Skeleton

if TYPE_CHECKING:
    from collections.abc import Iterator

PRECISION = 1e-4
"""How far from the goal an answer may be: metres and radians together."""
POSTURES = 12
"""From how many postures a solution is looked for."""
_MOST_STEPS = 40
_LARGEST_STEP = 0.7  # of a joint, radians or metres
_REMEMBERED = 5_000  # questions
_DIFFERENT = 0.05  # of one of the joints
_LOOK_BACK = 5  # steps, in which the squared error of a descent that leads somewhere at least halves


class Reach:
    """Inverse kinematics of the chain from the link ``root`` to the link ``tip``.

    description: the whole robot. joints: the names of the chain's joints, in the order of the answers. Errors: `DescriptionError`, when
    the one link is not below the other.
    """

    def __init__(self, description: Description, root: str, tip: str) -> None:
        chain = description.chain(root, tip)
        links = [description.links[root], *(description.links[joint.child] for joint in chain)]
        self.skeleton = Skeleton(Description(description.name, {link.name: link for link in links}, {joint.name: joint for joint in chain}))
        self.root, self.tip = root, tip
        self.joints = self.skeleton.joints
        self._model, self._data, self._tip = self.skeleton.model, self.skeleton.data, self.skeleton.links[tip]
        self._jacobian, self._error = np.zeros((6, len(self.joints))), np.zeros(6)
        self._inverse, self._turn, self._solution = np.zeros(4), np.zeros(4), np.zeros(6)
        self._postures = self._drawn()
        self._answers: dict[tuple[bytes, bytes], tuple[list[np.ndarray], Iterator[np.ndarray]]] = {}
        self._shoulder, self._length = self._measured(chain)

    def _measured(self, chain: list[Joint]) -> tuple[np.ndarray, float]:
        """Where the first joint that moves is, and how far from there the tip can be at most; infinite when a joint slides."""
        first = next((number for number, joint in enumerate(chain) if joint.moves), len(chain))
        if any(joint.kind == "prismatic" for joint in chain) or first == len(chain):
            return np.zeros(3), inf
        shoulder = self.skeleton.pose(np.zeros(len(self.joints)), chain[first].child)[0]
        return shoulder, sum(float(np.linalg.norm(joint.frame.position)) for joint in chain[first + 1 :])

    def _drawn(self) -> list[np.ndarray]:
        lower, upper = self.skeleton.lower, self.skeleton.upper
        bounded = np.isfinite(lower) & np.isfinite(upper)
        middle = np.where(bounded, (np.where(bounded, lower, 0.0) + np.where(bounded, upper, 0.0)) / 2, 0.0)
        width = np.where(bounded, np.where(bounded, upper, 0.0) - middle, pi)
        draw = np.random.default_rng(20_260_101)
        return [middle, *(middle + width * draw.uniform(-0.8, 0.8, len(middle)) for _ in range(POSTURES - 1))]

    def solve(self, position: np.ndarray, rotation: np.ndarray, first: np.ndarray | None = None) -> np.ndarray | None:
        """Positions of the joints that bring the tip to a pose, or ``None``.

        position: of the tip in the frame of the root, metres. rotation: quaternion (w, x, y, z). first: the posture to begin with, by
        default all joints at 0.
        """
        return next(self.solutions(position, rotation, first), None)

    def solutions(self, position: np.ndarray, rotation: np.ndarray, first: np.ndarray | None = None) -> Iterator[np.ndarray]:
        """As `solve`: the answers that the postures lead to, one after another; the same may come again."""
        if np.linalg.norm(position - self._shoulder) > self._length + PRECISION:
            return
        start = np.zeros(len(self.joints)) if first is None else np.asarray(first, float)
        for posture in (start, *self._postures):
            found = self._descend(position, rotation, np.clip(posture, self.skeleton.lower, self.skeleton.upper))
            if found is not None:
                yield found

    def recall(self, position: np.ndarray, rotation: np.ndarray, number: int = 0) -> np.ndarray | None:
        """The answer of that number, counted from 0, of those that differ; ``None`` when there are not so many.

        Answers are remembered, for a plan asks twice: before it moves, and when it moves.
        """
        question = (position.tobytes(), rotation.tobytes())
        if question not in self._answers:
            if len(self._answers) >= _REMEMBERED:
                self._answers.clear()
            self._answers[question] = [], self.solutions(position, rotation)
        known, more = self._answers[question]
        while len(known) <= number:
            found = next(more, None)
            if found is None:
                return None
            if all(np.abs(found - other).max() > _DIFFERENT for other in known):
                known.append(found)
        return known[number]

    def _descend(self, position: np.ndarray, rotation: np.ndarray, joints: np.ndarray) -> np.ndarray | None:
        model, data, tip, error, jacobian = self._model, self._data, self._tip, self._error, self._jacobian
        lower, upper = self.skeleton.lower, self.skeleton.upper
        kinematics, centres, jacobian_of = mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_jacBody
        places, turns, moves, turning, qpos = data.xpos[tip], data.xquat[tip], jacobian[:3], jacobian[3:], data.qpos
        turn, solution, inverse, columns = error[3:], self._solution, self._inverse, jacobian.T
        before = inf
        for step in range(1, _MOST_STEPS + 1):
            qpos[:] = joints
            kinematics(model, data)
            np.subtract(position, places, error[:3])
            mujoco.mju_negQuat(inverse, turns)
            mujoco.mju_mulQuat(self._turn, rotation, inverse)
            mujoco.mju_quat2Vel(turn, self._turn, 1.0)
            size = float(error @ error)
            if size < PRECISION * PRECISION:
                return joints
            if step % _LOOK_BACK == 0:
                if size > before / 2:
                    return None
                before = size
            centres(model, data)
            jacobian_of(model, data, moves, turning, tip)
            product = jacobian @ columns
            product.flat[::7] += 1e-3 * size + 1e-6
            mujoco.mju_cholFactor(product, 0.0)
            mujoco.mju_cholSolve(solution, product, error)
            change = columns @ solution
            largest = max(float(change.max()), -float(change.min()))
            if largest > _LARGEST_STEP:
                change *= _LARGEST_STEP / largest
            joints = np.minimum(np.maximum(joints + change, lower), upper)
        return None
