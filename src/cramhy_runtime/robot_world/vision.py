"""What a camera sees: how much of an item is in its picture, and what stands before it.

The picture is that of the original: 320 times 200 pixels, 50 degrees high, from 0.1 to 10 metres. Rays through its pixels say how many
belong to the item alone, and how many of these it still has among all other things. A camera looks along z, with x to the right and y
down, as ROS's optical frames do.
"""

from __future__ import annotations

from math import radians, tan
from typing import TYPE_CHECKING

import numpy as np

from .mujoco_parts import mujoco

if TYPE_CHECKING:
    from .placements import Placement
    from .scene import Scene
    from .things import Item, Machine

WIDTH, HEIGHT = 320, 200  # pixels
OPENING = radians(50)
NEAR, FAR = 0.1, 10.0  # metres
_UNSEEN = 1  # the group of geoms in which the camera is: of its own case nothing is seen from inside
_SEEN_GROUPS = np.array([1, 0, 0, 0, 0, 0], np.uint8)
_MOST_RAYS = 24  # along each side of the part of the picture in which the item is


def seen(scene: Scene, camera: Placement, item: Item | Machine) -> tuple[float, list[Item | Machine]]:
    """(the part of the item's picture that is seen, 0 to 1; what hides the rest, most first).

    The part is of what the item alone would fill in the picture; it is 0 when that is nothing.
    """
    rays = _rays_at(scene, camera, item)
    if not len(rays):
        return 0.0, []
    own = _distances_alone(scene, camera, rays, item)
    hit = own <= FAR
    if not hit.any():
        return 0.0, []
    rays, own = rays[hit], own[hit]
    geoms, distances = _hits(scene, camera, rays)
    visible = distances >= own - 1e-4
    hidden = [scene._thing_of_geom[geom] for geom in geoms[~visible] if geom > 0]  # noqa: SLF001  the same room
    counts = sorted(set(hidden), key=lambda number: (-hidden.count(number), number))
    return float(visible.mean()), [scene.things[number] for number in counts]


def _rays_at(scene: Scene, camera: Placement, item: Item | Machine) -> np.ndarray:
    """Directions in the world through the pixels of the rectangle in which the item is."""
    lowest, highest = scene.bounds(item)
    corners = np.array([[x, y, z] for x in (lowest[0], highest[0]) for y in (lowest[1], highest[1]) for z in (lowest[2], highest[2])])
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, camera.rotation)
    turn = turn.reshape(3, 3)
    local = (corners - camera.position) @ turn
    if (local[:, 2] < NEAR).all():
        return np.zeros((0, 3))
    high = tan(OPENING / 2)
    wide = high * WIDTH / HEIGHT
    depth = np.maximum(local[:, 2], NEAR)
    left, right = (np.clip(bound(local[:, 0] / depth), -wide, wide) for bound in (np.min, np.max))
    top, bottom = (np.clip(bound(local[:, 1] / depth), -high, high) for bound in (np.min, np.max))
    x, y = _pixels(left, right, wide, WIDTH), _pixels(top, bottom, high, HEIGHT)
    grid = np.stack([*map(np.ravel, np.meshgrid(x, y)), np.ones(len(x) * len(y))], axis=1)
    return (grid / np.linalg.norm(grid, axis=1, keepdims=True)) @ turn.T


def _pixels(low: float, high: float, edge: float, count: int) -> np.ndarray:
    """Middles of pixels between ``low`` and ``high``, of the ``count`` from -edge to edge; not more than are needed."""
    middles = (np.arange(count) + 0.5) / count * 2 * edge - edge
    within = middles[(middles >= low) & (middles <= high)]
    return within if len(within) <= _MOST_RAYS else within[np.linspace(0, len(within) - 1, _MOST_RAYS).astype(int)]


def _hits(scene: Scene, camera: Placement, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(the geom that each ray meets first, or -1; the distance to it)."""
    geoms, distances = np.full(len(rays), -1, np.int32), np.full(len(rays), np.inf)
    found = np.zeros(1, np.int32)
    around = scene.around(camera.position)
    scene.model.geom_group[around] = _UNSEEN
    for number, ray in enumerate(rays):
        distance = mujoco.mj_ray(scene.model, scene.data, camera.position, ray, _SEEN_GROUPS, 1, -1, found)
        if found[0] >= 0:
            geoms[number], distances[number] = found[0], distance
    scene.model.geom_group[around] = 0
    return geoms, distances


def _distances_alone(scene: Scene, camera: Placement, rays: np.ndarray, item: Item | Machine) -> np.ndarray:
    """How far each ray goes until it meets the item, if there were nothing else."""
    nearest = np.full(len(rays), np.inf)
    for part in scene.parts:
        if part.thing is item:
            for geom in part.geoms:
                place, turn = scene.data.geom_xpos[geom], scene.data.geom_xmat[geom]
                size, kind = scene.model.geom_size[geom], scene.model.geom_type[geom]
                if kind == mujoco.mjtGeom.mjGEOM_MESH:
                    met = np.array([mujoco.mj_rayMesh(scene.model, scene.data, geom, camera.position, ray) for ray in rays])
                else:
                    met = np.array([mujoco.mju_rayGeom(place, turn, size, camera.position, ray, kind) for ray in rays])
                nearest = np.where((met >= 0) & (met < nearest), met, nearest)
    return nearest
