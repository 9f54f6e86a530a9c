"""A brick with its topic and its services: where it is, and how a program puts it elsewhere."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from ...ros.messages import message_class_exact, service_type_exact
from ...ros.services import Refusal
from ...ros.wire import as_float
from ..descriptions import turned
from ..placements import Placement, placement
from ..urdf import angles
from . import model
from .names import PACKAGE
from .pulses import Pulse

if TYPE_CHECKING:
    from ...ros.messages import RosMessage
    from .node import Simulator


PERIOD = 0.1
"""Seconds between two messages of where a brick is."""


def numbers(pose: RosMessage) -> tuple[float, ...]:
    """x, y, z, roll, pitch and yaw of a pose of the package. Errors: `Refusal`, when one of them is not finite."""
    x, y, z = pose.position.values()
    found = tuple(map(as_float, (x, y, z, *pose.orientation.values())))
    if not all(map(isfinite, found)):
        raise Refusal(f"A pose is six finite numbers; these are {', '.join(f'{number:g}' for number in found)}.")
    return found


def placed(at: tuple[float, ...]) -> Placement:
    """The placement of x, y, z, roll, pitch and yaw, in metres and radians; the turns are about the fixed axes x, y and z."""
    return placement(at[:3], turned(*at[3:]))


class Brick:
    """The brick ``name`` of a simulator. colour: of `model.COLOURS`."""

    def __init__(self, simulator: Simulator, name: str, colour: str, at: tuple[float, ...]) -> None:
        self.simulator, self.name, self.colour = simulator, name, colour
        shapes, colour = model.brick_shapes(), model.COLOURS[colour]
        simulator.bench.add_item(name, shapes, placed(at), mass=model.BRICK_MASS, colour=colour, types=("brick",))  # it falls until it lies
        node = simulator.node
        self.pose_type = message_class_exact(f"{PACKAGE}/Pose")
        self.pulse = Pulse(node.advertise(f"~{name}/pose", self.pose_type), PERIOD, self.pose)
        kinds = {"teleport_absolute": ("TeleportAbsolute", self._put), "teleport_relative": ("TeleportRelative", self._move)}
        self.services = [
            node.serve(f"~{name}/{service}", service_type_exact(f"{PACKAGE}/{kind}"), handler) for service, (kind, handler) in kinds.items()
        ]

    def where(self) -> tuple[float, ...]:
        """x, y, z, roll, pitch and yaw."""
        at = self.simulator.bench.item(self.name).placement
        return (*map(float, at.position), *angles(tuple(map(float, at.rotation))))

    def pose(self) -> RosMessage:
        """Where it is, as a message."""
        x, y, z, roll, pitch, yaw = map(float, self.where())
        message = self.pose_type()
        message.position.x, message.position.y, message.position.z = x, y, z
        message.orientation.roll, message.orientation.pitch, message.orientation.yaw = roll, pitch, yaw
        return message

    def _put(self, request: RosMessage) -> RosMessage:
        self.simulator.bench.put(self.name, placed(numbers(request.pose)))
        return self.services[0].type.response()

    def _move(self, request: RosMessage) -> RosMessage:
        at = tuple(now + more for now, more in zip(self.where(), numbers(request.pose), strict=True))
        self.simulator.bench.put(self.name, placed(at))
        return self.services[1].type.response()

    def leave(self) -> None:
        """Take it off the table, and end its topic and its services."""
        node = self.simulator.node
        self.pulse.end()
        node.unadvertise(self.pulse.publication.name)
        for service in self.services:
            node.withdraw(service.name)
        self.simulator.bench.remove(self.name)
