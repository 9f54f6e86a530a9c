"""What has moved since a cell began: the turtle's paper as SVG, the robot's world as PNG.

A picture is made only if something is different, so cells that compute show none.
"""

from __future__ import annotations

import io

from cramhy_runtime.session.moved import Moved
from cramhy_runtime.turtlesim import stills

MOST_SVG = 1 << 20
"""Characters of an SVG; a paper with more lines becomes a PNG."""
WIDTH, HEIGHT = 640, 480  # of a picture of the robot's world


class Watcher(Moved):
    """Pictures of what has moved, each with the name of its place on the page."""

    def papers(self):
        """(name of its place, mime bundle) of each turtle's paper that has changed since `begin`."""
        return [(f"paper-{number}", paper(simulator)) for number, simulator in self.simulators().items()]

    def pictures(self):
        """(name of its place, mime bundle) of all that has changed since `begin`. From now on, that counts as seen."""
        found = self.papers()
        world = self.world()
        if world is not None:
            found.append(("world", of_world(world)))
        self.begin()
        return found


def paper(simulator):
    """The mime bundle of a simulator's window: SVG, or PNG where that has very many lines."""
    words = stills.title(simulator)
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
