"""Messages in list form, read from a stream."""

from __future__ import annotations

from cramhy_runtime.ros.message_building import list_to_ros_message
from ...reader.reader_functions import read


def read_ros_message(stream):
    """Read one list in list form from ``stream`` and make the message."""
    return list_to_ros_message(read(stream))
