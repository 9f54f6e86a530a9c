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
from cramhy_runtime.session.moved import Moved
from cramhy_runtime.turtlesim import stills

from .wire import Name

WIDTH, HEIGHT = 480, 360  # pixels of the robot's world
MISSING = "; Images need Pillow: {}\n"


class Images(Moved):
    """Looks what a form of the REPL buffer moves, and sends images of it to ``connection``."""

    def __init__(self, connection):
        super().__init__()
        self.connection = connection
        self._said = False

    def show(self):
        """Send an image of each paper that has changed since `begin`, and of the robot's world if that has."""
        papers, world = self.simulators().values(), self.world()
        try:
            for simulator in papers:
                self._send(stills.picture(simulator), stills.title(simulator))
            if world is not None:
                from cramhy_runtime.robot_world.pictures import stills as world_stills

                self._send(world_stills.picture(world, None, WIDTH, HEIGHT), "the robot's world")
        except ImportError:
            self._without_pillow(papers, world)

    def _send(self, image, words):
        data = io.BytesIO()
        stills.save_image(image, data, "PNG")
        self._send_data("png", data.getvalue(), words)

    def _send_data(self, kind, data, words):
        encoded = base64.b64encode(data).decode("ascii")
        self.connection.send(Name(":write-image"), [[Name(":type"), Name(kind), Name(":data"), encoded]], words)
        self.connection.send(Name(":write-string"), "\n", Name(":repl-result"))

    def _without_pillow(self, papers, world):
        """Without Pillow the paper is sent as vectors; that there is no image of the robot's world is said once."""
        for simulator in papers:
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "paper.svg")
                stills.still_svg(simulator, path)
                with open(path, "rb") as file:
                    self._send_data("svg", file.read(), "turtlesim")
        if world is not None and not self._said:
            self._said = True
            self.connection.write(MISSING.format(install_command("pictures")))


def wanted(connection):
    """From now on ``connection`` gets images."""
    connection.images = connection.images or Images(connection)
