"""Images in the REPL buffer: the turtle's paper and the robot's world, after a form that has moved something there.

SLIME's contribution ``slime-media`` shows them where Emacs has a display. An Emacs that has not loaded it gets none, and one without a
display should not load it. Emacs takes the first kind of image that it knows.
"""

from __future__ import annotations

import base64
import io
import os
import tempfile

from cramhy_runtime.extras import install_command
from cramhy_runtime.turtlesim import stills
from cramhy_runtime.turtlesim.node import simulators

from .wire import Name

WIDTH, HEIGHT = 480, 360  # pixels of the robot's world
MISSING = "; Images need Pillow: {}\n"


class Images:
    """Looks what a form of the REPL buffer moves, and sends images of it to ``connection``."""

    def __init__(self, connection):
        self.connection = connection
        self._papers = {}  # simulator → what was on its paper, and where its turtles were
        self._changes = 0  # of the robot's world that is shown
        self._said = False

    def begin(self):
        """A form begins: what has moved before it is not its doing."""
        self._papers = _papers()
        if not self._changes:
            from cramhy_runtime.robot_world import shown

            shown.unwatch(self._note)
            shown.watch(self._note)
        self._changes = 0

    def _note(self, world):
        from cramhy_runtime.robot_world import shown

        if world is shown.current():
            self._changes += 1

    def show(self):
        """Send an image of each paper that has changed since `begin`, and of the robot's world if that has."""
        try:
            for simulator, seen in _papers().items():
                if self._papers.get(simulator) != seen:
                    self._send(stills.picture(simulator), f"turtlesim: {', '.join(simulator.turtles) or 'no turtle'}")
            if self._changes:
                self._show_world()
        except ImportError:
            self._without_pillow()

    def _show_world(self):
        from cramhy_runtime.robot_world import shown
        from cramhy_runtime.robot_world.pictures import stills as world_stills

        world = shown.current()
        if world is not None:
            self._send(world_stills.picture(world, None, WIDTH, HEIGHT), "the robot's world")

    def _send(self, image, words):
        data = io.BytesIO()
        stills.save_image(image, data, "PNG")
        self._send_data("png", data.getvalue(), words)

    def _send_data(self, kind, data, words):
        encoded = base64.b64encode(data).decode("ascii")
        self.connection.send(Name(":write-image"), [[Name(":type"), Name(kind), Name(":data"), encoded]], words)
        self.connection.send(Name(":write-string"), "\n", Name(":repl-result"))

    def _without_pillow(self):
        """Without Pillow the paper is sent as vectors; that there is no image of the robot's world is said once."""
        for simulator, seen in _papers().items():
            if self._papers.get(simulator) != seen:
                with tempfile.TemporaryDirectory() as folder:
                    path = os.path.join(folder, "paper.svg")
                    stills.still_svg(simulator, path)
                    with open(path, "rb") as file:
                        self._send_data("svg", file.read(), "turtlesim")
        if self._changes and not self._said:
            self._said = True
            self.connection.write(MISSING.format(install_command("pictures")))


def _papers():
    """{simulator: what its window shows, to be compared}"""
    return {
        simulator: (
            simulator.canvas.clears,
            simulator.canvas.background,
            [(name, turtle.x, turtle.y, turtle.heading) for name, turtle in simulator.turtles.items()],
        )
        for simulator in simulators()
    }


def wanted(connection):
    """From now on ``connection`` gets images."""
    connection.images = connection.images or Images(connection)
