"""``robot_state_publisher`` and ``joint_state_publisher``: where the links of a robot are, as frames of tf.

Both read the parameter ``robot_description``, a text of URDF. The first hears ``joint_states`` and publishes the frame of each link in
that of the link before it: those of joints that move on ``/tf``, the others once on ``/tf_static``. The second publishes joint states of
its own, for a description that nobody drives: all joints are where ``~zeros`` says or at 0, as far as their limits allow, or where the
topics in ``~source_list`` say. Joints that follow others are where these take them. Source: wiki.ros.org/robot_state_publisher and
wiki.ros.org/joint_state_publisher.
"""

from __future__ import annotations

from math import isfinite

from ... import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from ...robot_world import urdf_parts
from ...robot_world.description_files import read_text
from ...robot_world.descriptions import Description, DescriptionError, Joint
from ...ros import rosout
from ...ros.messages import message_class
from ...ros.roscpp import Program
from ...ros.wire import as_float
from ...transforms.poses import Transform
from ...transforms.quaternions import Quaternion
from ...transforms.vectors import make_3d_vector
from .frames import Sender
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...ros.messages import RosMessage
    from ...ros.signatures import Echo, Words

T = TypeVar("T")
PARAMETER = "robot_description"
MOST_RATE = 1000.0


class Robot:
    """The robot in the parameter ``robot_description`` of a program. description: its links and joints."""

    def __init__(self, program: Program):
        parameter = program.node.resolve(PARAMETER)
        try:
            text = str(program.graph.parameters.get(parameter))
            self.description: Description = read_text(text, parameter)
            mimics = urdf_parts.read_text(text, parameter).mimics
        except KeyError:
            self._refuse(program, f"There is no parameter {parameter}, which has to hold the text of a URDF file.")
        except (DescriptionError, ImportError) as problem:  # MJCF takes MuJoCo, which is an extra
            self._refuse(program, f"The robot cannot be read: {problem}")
        self.followers = {name: (other, times, plus) for name, other, times, plus in mimics}
        self.moving = [joint for joint in self.description.joints.values() if joint.moves]
        self.fixed = [joint for joint in self.description.joints.values() if not joint.moves]

    @staticmethod
    def _refuse(program: Program, text: str) -> None:
        program.shutdown()
        conditions.error(
            SimpleError("~a", f"{program.name}: {text}"),
            hint=f'Set it in a launch file: <param name="{PARAMETER}" textfile="robot.urdf"/>, or with command="xacro FILE". '
            f'Or at the prompt: (set-param "{PARAMETER}" text).',
        )

    def position(self, joint: Joint, known: Mapping[str, float]) -> float | None:
        """Where a joint is, as ``known`` says of it or of the one that it follows; ``None`` where it says nothing."""
        if joint.name in known:
            return known[joint.name]
        name, times, plus = joint.name, 1.0, 0.0
        for _ in self.followers:  # a follower may follow another one
            if name not in self.followers:
                return None
            name, factor, offset = self.followers[name]
            times, plus = times * factor, plus + times * offset
            if name in known:
                return known[name] * times + plus
        return None


def transform_of(joint: Joint, position: float = 0.0) -> Transform:
    """The pose of the child's frame in the parent's when the joint is at ``position``, in rad or m."""
    frame = joint.placed(position)
    w, x, y, z = frame.rotation
    return Transform(make_3d_vector(*frame.position), Quaternion(x, y, z, w))


def _rate(program: Program, parameter: str, default: float) -> float:
    rate = program.number(parameter, default)
    if 0 < rate <= MOST_RATE:
        return rate
    program.log(rosout.WARN, f"{parameter} is {rate:g} Hz; it must be more than 0, and at most {MOST_RATE:g}. It counts as {default:g}.")
    return default


class RobotStatePublisher(Program):
    """``rosrun robot_state_publisher robot_state_publisher``. Arguments: see `Program`.

    Parameters: ``~publish_frequency`` (50 Hz at most), ``tf_prefix``, ``~use_tf_static`` (true; else fixed frames are sent at that rate).
    """

    name = "robot_state_publisher"
    package = "robot_state_publisher"

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, echo=echo)
        self.robot = Robot(self)
        self.period = 1 / _rate(self, "~publish_frequency", 50.0)
        self.prefix = self._prefix()
        self.newest = -self.period
        self.sender, static = Sender(self.node), self._use_tf_static()
        self.fixed_sender = Sender(self.node, static=True) if static else self.sender
        if static:
            self._send_fixed()
        else:
            self.node.on_shutdown.append(kernel.call_every(self.period, self._send_fixed).cancel)
        self.node.subscribe("joint_states", message_class("sensor_msgs/JointState"), self._hear)

    def _use_tf_static(self) -> bool:
        parameter = self.node.resolve("~use_tf_static")
        return not self.graph.parameters.has(parameter) or self.graph.parameters.get(parameter) not in (False, None)

    def _prefix(self) -> str:
        for parameter in ("~tf_prefix", "tf_prefix"):
            if self.graph.parameters.has(self.node.resolve(parameter)):
                return str(self.graph.parameters.get(self.node.resolve(parameter))).strip("/")
        return ""

    def frame(self, link: str) -> str:
        """What the frame of a link is called."""
        return f"{self.prefix}/{link}" if self.prefix else link

    def _send_fixed(self) -> None:
        now = self.graph.now()
        self.fixed_sender.send_all(
            [(self.frame(joint.parent), self.frame(joint.child), now, transform_of(joint)) for joint in self.robot.fixed]
        )

    def _hear(self, message: RosMessage) -> None:
        names, positions = [str(name) for name in message.name], [as_float(number) for number in message.position]
        if len(names) != len(positions):
            told = f"{len(names)} names and {len(positions)} positions"
            self.log(rosout.ERROR, f"Robot state publisher ignored an invalid JointState message, which has {told}.")
            return
        stamp = as_float(message.header.stamp)
        if stamp < self.newest:  # the time was set back
            self.newest = stamp - self.period
        if stamp < self.newest + self.period - 1e-9:
            return
        self.newest, known = stamp, {name: place for name, place in zip(names, positions, strict=True) if isfinite(place)}
        places = [(joint, self.robot.position(joint, known)) for joint in self.robot.moving]
        self.sender.send_all(
            [
                (self.frame(joint.parent), self.frame(joint.child), stamp, transform_of(joint, place))
                for joint, place in places
                if place is not None
            ]
        )


class JointStatePublisher(Program):
    """``rosrun joint_state_publisher joint_state_publisher``. Arguments: see `Program`.

    Parameters: ``~rate`` (10 Hz), ``~zeros`` (positions by the names of joints), ``~source_list`` (topics with joint states).
    """

    name = "joint_state_publisher"
    package = "joint_state_publisher"

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, echo=echo)
        self.robot = Robot(self)
        self.header, self.type = message_class("std_msgs/Header"), message_class("sensor_msgs/JointState")
        zeros = self._parameter("~zeros", dict, "names of joints with numbers")
        self.places = {joint.name: self._zero(joint, zeros) for joint in self.robot.moving if joint.name not in self.robot.followers}
        for topic in self._parameter("~source_list", list, "a list of topics"):
            self.node.subscribe(str(topic), self.type, self._hear)
        self.publication = self.node.advertise("joint_states", self.type)
        self.node.on_shutdown.append(kernel.call_every(1 / _rate(self, "~rate", 10.0), self._send).cancel)

    def _parameter(self, name: str, kind: type[T], told: str) -> T:
        """The value of a parameter, or an empty one of this ``kind`` if it is not set, or is not ``told``, of which the log tells."""
        parameter = self.node.resolve(name)
        value = self.graph.parameters.get(parameter) if self.graph.parameters.has(parameter) else kind()
        if isinstance(value, kind):
            return value
        self.log(rosout.WARN, f"The parameter {parameter} is not {told}, so it does not count.")
        return kind()

    def _zero(self, joint: Joint, zeros: Mapping[str, object]) -> float:
        wanted = zeros.get(joint.name)
        if isinstance(wanted, (int, float)) and not isinstance(wanted, bool) and isfinite(wanted):
            return float(wanted)
        if joint.lower <= 0 <= joint.upper:
            return 0.0
        return (joint.lower + joint.upper) / 2

    def _hear(self, message: RosMessage) -> None:
        for name, place in zip(map(str, message.name), map(as_float, message.position)):
            if name in self.places and isfinite(place):
                self.places[name] = place

    def _send(self) -> None:
        joints = [(joint.name, self.robot.position(joint, self.places)) for joint in self.robot.moving]
        known = [(name, place) for name, place in joints if place is not None]
        header = self.header(seq=0, stamp=float(self.graph.now()), frame_id="")
        self.publication.publish(self.type(header, [name for name, _ in known], [place for _, place in known], [], []))
