"""The node ``/lynxmotion_al5d``: the arm on its table, with topics and services as the course's simulator has them.

=====================================  ==================================================================================
``joints_positions/command``           heard: five angles in rad, and the distance of the fingers in metres
``joint_states``                       fifty times a second: positions, velocities, efforts of the six
``al5d_external_vision/image_raw``     once a second: the picture of the camera above; also as ``external_vision/image_raw``
``al5d_external_vision/camera_info``   once a second: what that picture measures; also as ``external_vision/camera_info``
``/tf``                                ten times a second: where the links of the arm and the camera are
``<brick>/pose``                       ten times a second: where a brick is
``spawn_brick``, ``kill_brick``        put a brick on the table, take it away
``clear``, ``reset``                   take all bricks away; the same, and send the arm home
``<brick>/teleport_absolute``          put a brick somewhere; ``teleport_relative``: move it by so much
=====================================  ==================================================================================

All names but ``/tf`` begin with that of the node. A command counts at once, and the servos go there as fast as they can. A message without
a subscriber is not made. Source: the README of lynxmotion_al5d_description.
"""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from ...ros import rosout
from ...ros.messages import message_class_exact, service_type_exact
from ...ros.names import check_graph_name
from ...ros.roscpp import Program
from ...ros.services import Refusal
from ...ros.wire import as_float
from .. import shown
from . import model
from .bench import Bench, states
from .bricks import Brick, numbers
from .frames import CAMERA_FRAME, camera_info, frames
from .names import NAME, PACKAGE
from .pictures import Shot, image
from .pulses import Pulse

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...ros.messages import RosMessage
    from ...ros.signatures import Echo, Words


COMMANDS = "A command has 6 finite numbers: Joint1 to Joint5 in rad, and Gripper in m."
MOST_BRICKS = 60
CAMERAS = ("al5d_external_vision", "external_vision")
"""What the camera is called: by the course's programs, and by the README of the simulator."""
STATES, PICTURES, FRAMES = 0.02, 1.0, 0.1
"""Seconds between two messages of the joints, of the camera, and of the frames."""


class Simulator(Program):
    """The simulator of the arm. Arguments: see `Program`. bench: its world. bricks: the bricks by their names."""

    name = NAME
    package = PACKAGE

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None) -> None:
        super().__init__(name, namespace, arguments, echo=echo)
        self.bench, self.bricks, self.counter = Bench(), dict[str, Brick](), 0
        self._shot: tuple[object, Shot] | None = None
        self._offer_topics()
        self._offer_services()
        shown.offer(lambda: self.bench if self.alive else None)
        self.log(rosout.INFO, f"The arm AL5D stands on its table, as {self.node.name}.")

    def _offer_topics(self) -> None:
        node = self.node
        self.header_type, self.states_type = message_class_exact("std_msgs/Header"), message_class_exact("sensor_msgs/JointState")
        node.subscribe("~joints_positions/command", message_class_exact("std_msgs/Float64MultiArray"), self._command)
        self.pulses = [Pulse(node.advertise("~joint_states", self.states_type), STATES, self._states)]
        for camera in CAMERAS:
            publication = node.advertise(f"~{camera}/image_raw", message_class_exact("sensor_msgs/Image"))
            self.pulses.append(Pulse(publication, PICTURES, self._image))
            publication = node.advertise(f"~{camera}/camera_info", message_class_exact("sensor_msgs/CameraInfo"))
            self.pulses.append(Pulse(publication, PICTURES, lambda: camera_info(self._header(CAMERA_FRAME))))
        self.pulses.append(Pulse(node.advertise("/tf", message_class_exact("tf2_msgs/TFMessage")), FRAMES, self._frames))

    def _offer_services(self) -> None:
        spawn, kill = (service_type_exact(f"{PACKAGE}/{kind}") for kind in ("SpawnBrick", "KillBrick"))
        empty = service_type_exact("std_srvs/Empty")

        def spawn_brick(request: RosMessage) -> RosMessage:
            return spawn.response(name=self.spawn(request.color, request.name, numbers(request.pose)))

        def emptied(action: Callable[[], None]) -> Callable[[RosMessage], RosMessage]:
            return lambda _: action() or empty.response()

        self.node.serve("~spawn_brick", spawn, spawn_brick)
        self.node.serve("~kill_brick", kill, lambda request: kill.response(True, self.kill(request.name)))
        self.node.serve("~clear", empty, emptied(self.clear))
        self.node.serve("~reset", empty, emptied(self.reset))

    # ------------------------------------------------------------------------------------------------------------------ topics

    def _command(self, message: RosMessage) -> None:
        wanted = [as_float(number) for number in message.data]
        if len(wanted) != len(model.JOINTS) or not all(map(isfinite, wanted)):
            told = f"{len(wanted)} numbers" if len(wanted) != len(model.JOINTS) else "numbers that are not finite"
            self.log(rosout.ERROR, f"{COMMANDS} This one has {told}. The arm goes on as before.")
            return
        far = self.bench.send(wanted)
        if far:
            limits = ", ".join(f"{name} to {value:.3f}" for name, value in zip(model.JOINTS, self.goal, strict=True) if name in far)
            self.log(rosout.WARN, f"A command is beyond the limits of the arm, which goes as far as it can: {limits}.")

    @property
    def goal(self) -> tuple[float, ...]:
        """Where the servos are sent, in the order of `model.JOINTS`."""
        *arm, finger = map(float, self.bench.servos.goal)
        return (*arm, 2 * finger)

    def _header(self, frame: str = "") -> RosMessage:
        return self.header_type(seq=0, stamp=float(self.graph.now()), frame_id=frame)

    def _states(self) -> RosMessage:
        positions, velocities, efforts = (list(map(float, numbers)) for numbers in states(self.bench))
        return self.states_type(self._header(), list(model.JOINTS), positions, velocities, efforts)

    def _frames(self) -> RosMessage:
        return frames(states(self.bench)[0], float(self.graph.now()))

    def _image(self) -> RosMessage:
        now = self.bench.moment
        if self._shot is None or self._shot[0] is not now:
            self._shot = now, Shot(self.bench)
        return image(self._shot[1], self._header(CAMERA_FRAME))

    # ---------------------------------------------------------------------------------------------------------------- services

    def spawn(self, colour: str, name: str = "", at: tuple[float, ...] = (0.0,) * 6) -> str:
        """Put a brick down; its name. at: x, y, z, roll, pitch, yaw. Without a name it is called ``brick1``, ``brick2``, ...

        Errors: `Refusal`, for a name that is taken or illegal, another colour, and when there are too many.
        """
        if colour not in model.COLOURS:
            self._refuse("spawn", f'Bricks are {", ".join(sorted(model.COLOURS))}, not "{colour}".')
        if name in self.bricks:
            self._refuse("spawn", f"Brick {name} already exists.")
        complaint = name and check_graph_name(name)
        if complaint or name in self.bench.things or "/" in name:
            self._refuse("spawn", f"A brick cannot be called {name}. {complaint or 'Letters, digits and _ make a name.'}")
        if len(self.bricks) >= MOST_BRICKS:
            self._refuse("spawn", f"{MOST_BRICKS} bricks are there already; more are not allowed. Kill some.")
        while not name or name in self.bricks:
            self.counter += 1
            name = f"brick{self.counter}"
        self.bricks[name] = Brick(self, name, colour, at)
        return name

    def kill(self, name: str) -> str:
        """Take a brick away; a sentence that says so. Errors: `Refusal`, when it is not there."""
        if name not in self.bricks:
            self._refuse("kill", f"Brick {name} doesn't exist. On the table: {', '.join(self.bricks) or 'no brick'}.")
        self.bricks.pop(name).leave()
        if name == f"brick{self.counter}":
            self.counter -= 1
        return f"Brick {name} was taken away."

    def clear(self) -> None:
        """Take all bricks away; the next one without a name is called ``brick1``."""
        for brick in self.bricks.values():
            brick.leave()
        self.bricks, self.counter = {}, 0

    def reset(self) -> None:
        """Take all bricks away, and send the arm home."""
        self.clear()
        self.bench.send(model.RESET)

    def _refuse(self, what: str, text: str) -> None:
        self.log(rosout.ERROR, f"{what}_brick: {text}")
        raise Refusal(text)
