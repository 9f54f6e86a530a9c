"""The camera's pictures as messages, which are drawn when somebody looks at them.

To draw a picture takes a quarter of a second, and most programs that listen to a camera keep the last picture and look at few. So a message
holds a copy of the world as it was, which costs next to nothing, and draws it when its field ``data`` is read for the first time.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from ...ros.messages import message_class_exact
from ..pictures.drawing import draw
from . import model

if TYPE_CHECKING:
    from ...ros.messages import RosMessage
    from ..world import World


class Shot:
    """What the camera saw at a moment. Its pixels are drawn once, however many messages have them."""

    def __init__(self, world: World) -> None:
        self._world: World | None = world.copy()
        self._pixels = b""

    def pixels(self) -> bytes:
        """Red, green and blue of each pixel, row by row from the top left."""
        if self._world is not None:
            colours = draw(self._world, model.camera(), model.WIDTH, model.HEIGHT).colours
            self._pixels, self._world = np.round(colours * 255).astype(np.uint8).tobytes(), None
        return self._pixels


@functools.cache
def _undrawn() -> type[RosMessage]:
    """The class of ``sensor_msgs/Image`` messages whose field ``data`` is not there before somebody reads it."""
    image = message_class_exact("sensor_msgs/Image")

    class Image(image):
        __slots__ = ("shot",)

        def __getattr__(self, name: str) -> Any:
            if name != "data":
                raise AttributeError(name)
            self.data = list(self.shot.pixels())
            return self.data

    return Image


def image(shot: Shot, header: RosMessage) -> RosMessage:
    """The message with the picture of a shot."""
    message = _undrawn()(header=header, height=model.HEIGHT, width=model.WIDTH, encoding="rgb8", is_bigendian=0, step=3 * model.WIDTH)
    del message.data
    message.shot = shot
    return message
