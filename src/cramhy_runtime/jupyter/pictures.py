"""What has moved since a cell began: the turtle's paper as SVG, the robot's world as PNG.

A picture is made only if something is different, so cells that compute show none.
"""

from __future__ import annotations

import io

from cramhy_runtime.turtlesim import stills
from cramhy_runtime.turtlesim.node import simulators

MOST_SVG = 1 << 20
"""Characters of an SVG; a paper with more lines becomes a PNG."""
WIDTH, HEIGHT = 640, 480  # of a picture of the robot's world


class Watcher:
    """Looks whether the turtles or the robot's world have changed. To be asked in a task of the session."""

    def __init__(self):
        self._turtles = self._seen_turtles()
        self._changes, self._watched = 0, False
        self._shown = 0

    def _seen_turtles(self):
        return [
            (
                id(simulator),
                simulator.canvas.clears,
                simulator.canvas.background,
                [(name, turtle.x, turtle.y, turtle.heading) for name, turtle in simulator.turtles.items()],
            )
            for simulator in simulators()
        ]

    def begin(self):
        """A cell begins: what has changed before it is not its own."""
        self._turtles = self._seen_turtles()
        self._shown = self._changes
        self._watch_worlds()

    def _watch_worlds(self):
        if not self._watched:
            from cramhy_runtime.robot_world import shown

            self._watched = True
            shown.watch(self._changed)

    def _changed(self, world):
        from cramhy_runtime.robot_world import shown

        if world is shown.current():
            self._changes += 1

    def papers(self):
        """(name of its place, mime bundle) of each turtle's paper that has changed since `begin`."""
        return [
            (f"paper-{number}", paper(simulator))
            for number, (simulator, now) in enumerate(zip(simulators(), self._seen_turtles()))
            if now not in self._turtles
        ]

    def pictures(self):
        """(name of its place, mime bundle) of all that has changed since `begin`. From now on, that counts as seen."""
        found = self.papers()
        if self._changes != self._shown:
            from cramhy_runtime.robot_world import shown

            world = shown.current()
            if world is not None:
                found.append(("world", of_world(world)))
        self._turtles, self._shown = self._seen_turtles(), self._changes
        return found


def paper(simulator):
    """The mime bundle of a simulator's window: SVG, or PNG where that has very many lines."""
    words = f"turtlesim: {', '.join(simulator.turtles) or 'no turtle'}"
    if len(drawn := stills.svg(simulator)) <= MOST_SVG:
        return {"image/svg+xml": drawn, "text/plain": words}
    return {"image/png": _png(stills.picture(simulator)), "text/plain": words}


def of_world(world):
    """The mime bundle of the robot's world, drawn as ``btr:save-picture`` draws it."""
    from cramhy_runtime.robot_world.pictures import stills as world_stills

    return {"image/png": _png(world_stills.picture(world, None, WIDTH, HEIGHT)), "text/plain": "the robot's world"}


def _png(image):
    import base64

    data = io.BytesIO()
    image.save(data, "PNG")
    return base64.b64encode(data.getvalue()).decode("ascii")
