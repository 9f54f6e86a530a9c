"""What has moved since a form or a cell began: turtles and what they drew, and the robot's world. Front ends show pictures of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cramhy_runtime.turtlesim.node import simulators

if TYPE_CHECKING:
    from collections.abc import Hashable

    from cramhy_runtime.robot_world.world import World
    from cramhy_runtime.turtlesim.node import Turtlesim


class Moved:
    """Looks what has moved since the last `begin`. To be asked in a task of the session."""

    def __init__(self) -> None:
        self._papers = _papers()
        self._world_has_changed = False

    def begin(self) -> None:
        """What has moved before now counts no more."""
        from cramhy_runtime.robot_world import shown

        self._papers = _papers()
        self._world_has_changed = False
        shown.unwatch(self._note)
        shown.watch(self._note)  # again each time, since each image has watchers of its own

    def _note(self, world: World) -> None:
        from cramhy_runtime.robot_world import shown

        if world is shown.current():
            self._world_has_changed = True

    def simulators(self) -> dict[int, Turtlesim]:
        """The simulators whose windows have changed, by their numbers among all there are."""
        now = _papers()
        return {number: each for number, each in enumerate(simulators()) if self._papers.get(each) != now[each]}

    def world(self) -> World | None:
        """The robot's world that is shown, if it has changed."""
        from cramhy_runtime.robot_world import shown

        return shown.current() if self._world_has_changed else None


def _papers() -> dict[Hashable, Any]:
    """What each simulator's window shows, to be compared."""
    return {
        simulator: (
            simulator.canvas.clears,
            simulator.canvas.background,
            [(name, turtle.x, turtle.y, turtle.heading) for name, turtle in simulator.turtles.items()],
        )
        for simulator in simulators()
    }
