"""What a plan considers in the world of its robot, for whoever looks on: costmaps, grasps that are tried, where things were seen.

While nobody looks on, a remark costs one question and nothing is kept. This module is loaded without MuJoCo, as ``shown`` is.

=================  =====================================================================================================
``costmap``        the `LocationCostmap` that places are drawn from now
``grasp``          (machine, goal in the frame of its base, whether it was reached): a tool was to go there
``seen``           (name of the thing, a `Placement` in the world, or ``None`` when it is in a hand): where it is believed to be
=================  =====================================================================================================
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cramhy_runtime.kernel.images import per_image

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

    from .costmaps.costmap import LocationCostmap
    from .placements import Placement
    from .things import Machine

_listeners: list[Callable[[str, object], None]] = per_image([])


def listen(listener: Callable[[str, object], None]) -> None:
    """Call ``listener(kind, value)`` for each remark from now on."""
    _listeners.append(listener)


def unlisten(listener: Callable[[str, object], None]) -> None:
    """Call it no more."""
    if listener in _listeners:
        _listeners.remove(listener)


def heard() -> bool:
    """Whether anybody looks on."""
    return bool(_listeners)


def costmap(value: LocationCostmap) -> None:
    """Places are drawn from this costmap now."""
    _tell("costmap", value)


def grasp(machine: Machine, goal: Placement, reached: bool) -> None:
    """A tool of a machine was to go to a pose in the frame of its base."""
    _tell("grasp", (machine, goal, reached))


def seen(name: Hashable, place: Placement | None) -> None:
    """A thing is believed to be there; ``None``: it goes with the hand that holds it."""
    _tell("seen", (name, place))


def _tell(kind: str, value: object) -> None:
    for listener in tuple(_listeners):
        listener(kind, value)
