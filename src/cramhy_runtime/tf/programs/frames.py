"""``static_transform_publisher`` and ``tf_echo``: where a frame is, published and printed.

tf's ``static_transform_publisher`` sends its transform again and again, with stamps as far ahead as its period is long; that of tf2_ros
sends it once, on the latched topic ``/tf_static``. ``tf_echo`` waits for the transform for a second and then prints it at a rate, or why
it is not known. Words that such a program does not understand are a simple error with its usage. Source: wiki.ros.org/tf (Command-line
Tools), wiki.ros.org/tf2_ros.
"""

from __future__ import annotations

import math

from ... import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Error, SimpleError
from ...ros import rosout
from ...ros.messages import message_class
from ...ros.roscpp import Program, anonymous, plain_words
from ...transforms.poses import Transform
from ...transforms.quaternions import Quaternion, euler_to_quaternion, general, make_quaternion, quaternion_to_euler
from ...transforms.vectors import make_3d_vector, point
from ..buffer import FrameBuffer, Unavailable
from ..frames import unslash_frame
from ..stamped import TransformStamped
from ..stamped_messages import from_msg, to_msg
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...ros.graph import Node
    from ...ros.messages import RosMessage
    from ...ros.signatures import Echo, Words

MOST_MILLISECONDS = 1e9
MOST_RATE = 1000.0


class Sender:
    """Publishes transforms for ``node`` on ``/tf``; static: once and for all, on ``/tf_static``."""

    def __init__(self, node: Node, static: bool = False):
        self.message = message_class("tf2_msgs/TFMessage")
        self.publication = node.advertise("/tf_static" if static else "/tf", self.message, latch=static)

    def send(self, parent: str, child: str, stamp: float, transform: Transform) -> None:
        """Publish that ``transform`` is the pose of the frame ``child`` in ``parent`` at the time ``stamp`` (s)."""
        self.send_all([(parent, child, stamp, transform)])

    def send_all(self, transforms: Iterable[tuple[str, str, float, Transform]]) -> None:
        """Publish several transforms, with the arguments of `send`, in one message."""
        stamped = [TransformStamped(parent, child, stamp, each.translation, each.rotation) for parent, child, stamp, each in transforms]
        self.publication.publish(self.message(transforms=[to_msg(each) for each in stamped]))


class Listener:
    """What a node has heard of frames. ``buffer``: the `FrameBuffer`. What is broken in a message is logged, and the rest is kept."""

    def __init__(self, program: Program):
        self.program, self.buffer = program, FrameBuffer()
        message = message_class("tf2_msgs/TFMessage")
        program.node.subscribe("/tf", message, lambda heard: self._hear(heard, None))
        program.node.subscribe("/tf_static", message, lambda heard: self._hear(heard, 0.0))

    def _hear(self, message: RosMessage, stamp: float | None) -> None:
        for part in message.transforms:
            conditions.handler_case([(Error, self._refuse)], lambda part=part: self._take(part, stamp))

    def _take(self, part: RosMessage, stamp: float | None) -> None:
        transform = from_msg(part)
        if stamp is not None:
            transform = TransformStamped(transform.frame_id, transform.child_frame_id, stamp, transform.translation, transform.rotation)
        try:
            self.buffer.store(transform)
        except ValueError as problem:
            self.program.log(rosout.WARN, f"Ignoring a transform on /tf: {problem}")

    def _refuse(self, problem: Error) -> None:
        self.program.log(rosout.WARN, f"Ignoring a transform on /tf: {problem.report()}")

    def lookup(self, target: str, source: str) -> TransformStamped | Unavailable:
        """The newest transform that takes coordinates in ``source`` into those in ``target``, or why it is not known."""
        try:
            return self.buffer.lookup(unslash_frame(target), unslash_frame(source))
        except Unavailable as problem:
            return problem


def _number(word: str, usage: str) -> float:
    try:
        number = float(word)
    except ValueError:
        number = math.nan
    return number if math.isfinite(number) else _wrong(f'"{word}" is not a number.', usage)


def _wrong(problem: str, usage: str) -> float:
    return conditions.error(SimpleError("~a", f"{problem}\n{usage}"))


class StaticTransformPublisher(Program):
    """``rosrun tf static_transform_publisher``: where ``child`` is in ``parent``, sent every ``period`` seconds. Arguments: see `Program`.

    The words of the command line: x y z (m), then yaw pitch roll (rad) or the quaternion qx qy qz qw, the names of both frames, and the
    period in milliseconds.
    """

    name = "static_transform_publisher"
    package = "tf"
    static = False
    usage = (
        "Usage: static_transform_publisher x y z yaw pitch roll frame_id child_frame_id period_in_ms\n"
        "or:    static_transform_publisher x y z qx qy qz qw frame_id child_frame_id period_in_ms"
    )

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        numbers, self.parent, self.child, self.period = self.understood(plain_words(arguments))
        super().__init__(name or anonymous(self.name), namespace, arguments, echo=echo)
        self.transform = Transform(make_3d_vector(*numbers[:3]), self._rotation(*numbers[3:]))
        self.sender = Sender(self.node, self.static)
        self.send()
        if not self.static:
            self.node.on_shutdown.append(kernel.call_every(self.period, self.send).cancel)

    def understood(self, words: list[str]) -> tuple[list[float], str, str, float]:
        """(numbers, parent, child, period in seconds) of the words of the command line. What is wrong with them is a simple error."""
        extra = 0 if self.static else 1
        if len(words) - extra not in (8, 9):
            _wrong(f"static_transform_publisher takes {8 + extra} or {9 + extra} words, and got {counted(words)}.", self.usage)
        ends = len(words) - extra - 2
        numbers = [_number(word, self.usage) for word in words[:ends]]
        parent, child = words[ends : ends + 2]
        if unslash_frame(parent) == unslash_frame(child):
            _wrong(f"A frame has no place in itself: both frames are {parent}.", self.usage)
        period = 0.0 if self.static else _number(words[-1], self.usage)
        if not self.static and not 0 < period <= MOST_MILLISECONDS:
            _wrong(f"The period is {words[-1]} ms; it must be more than 0, and at most {MOST_MILLISECONDS:.0f}.", self.usage)
        if len(numbers) == 7 and not any(numbers[3:]):
            _wrong("A quaternion of four zeros is not a rotation.", self.usage)
        return numbers, parent, child, period / 1000.0

    @staticmethod
    def _rotation(*numbers: float) -> Quaternion:
        if len(numbers) == 3:
            yaw, pitch, roll = map(float, numbers)
            return euler_to_quaternion(ax=roll, ay=pitch, az=yaw)
        length = math.hypot(*numbers)
        return make_quaternion(*(number / length for number in numbers))

    def send(self) -> None:
        """Send the transform once. The timer calls it."""
        self.sender.send(self.parent, self.child, self.graph.now() + self.period, self.transform)


class Tf2StaticTransformPublisher(StaticTransformPublisher):
    """``rosrun tf2_ros static_transform_publisher``: as that of tf, but without a period, sent once on the latched ``/tf_static``."""

    package = "tf2_ros"
    static = True
    usage = (
        "Usage: static_transform_publisher x y z yaw pitch roll frame_id child_frame_id\n"
        "or:    static_transform_publisher x y z qx qy qz qw frame_id child_frame_id"
    )


class TfEcho(Program):
    """``rosrun tf tf_echo SOURCE_FRAME TARGET_FRAME [RATE]``: prints where the second frame is in the first one. Arguments: see `Program`.

    rate: how often in a second, 1.0 unless the third word or the parameter ``~rate`` says otherwise.
    """

    name = "tf_echo"
    package = "tf"
    patience = 1.0
    """Seconds in which nothing is said of a transform that is not known."""
    usage = (
        "Usage: tf_echo source_frame target_frame [echo_rate]\n"
        "It prints the pose of target_frame in source_frame, once a second without a rate."
    )

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        words = plain_words(arguments)
        if len(words) not in (2, 3):
            _wrong(f"tf_echo takes the names of two frames and a rate, and got {counted(words)}.", self.usage)
        self.source, self.target = words[:2]
        rate = self._checked(_number(words[2], self.usage)) if words[2:] else None
        super().__init__(name or anonymous(self.name), namespace, arguments, echo=echo)
        try:
            self.period = 1.0 / (rate or self._checked(self.number("~rate", 1.0)))
        except SimpleError:
            self.shutdown()
            raise
        self.listener = Listener(self)
        self.first = kernel.now() + self.patience
        self.timer = kernel.call_every(min(self.period, 0.1), self._look)
        self.node.on_shutdown.append(lambda: self.timer.cancel())

    def _checked(self, rate: float) -> float:
        return (
            rate
            if 0 < rate <= MOST_RATE
            else _wrong(f"The rate is {rate:g}; it must be more than 0, and at most {MOST_RATE:g}.", self.usage)
        )

    def _look(self) -> None:
        """Begin when the transform is known, or when one has waited for it long enough."""
        if isinstance(self.listener.lookup(self.source, self.target), TransformStamped) or kernel.now() >= self.first:
            self.timer.cancel()
            self.timer = kernel.call_every(self.period, self.tell)
            self.tell()

    def tell(self) -> None:
        """Print the transform, or why it is not known."""
        found = self.listener.lookup(self.source, self.target)
        if isinstance(found, Unavailable):
            known = "".join(f"\nFrame {link.child} exists with parent {link.parent}." for link in self.listener.buffer.links.values())
            why = f"{found.text.rstrip('.')}. {found.hint}".replace("\n", " ")
            self.say(f"Failure at {self.graph.now():.6f}000\nException thrown:{why}\nThe current list of frames is:{known}")
            return
        angles = list(map(float, quaternion_to_euler(found.rotation, just_values=True)))
        self.say(
            f"At time {found.stamp:.3f}\n"
            f"- Translation: {_listed(point(found.translation))}\n"
            f"- Rotation: in Quaternion {_listed(general(found.rotation))}\n"
            f"            in RPY (radian) {_listed(angles)}\n"
            f"            in RPY (degree) {_listed(map(math.degrees, angles))}"
        )


def _listed(numbers: Iterable[float]) -> str:
    return f"[{', '.join(f'{number:.3f}' for number in numbers)}]"


def counted(words: list[str]) -> str:
    """How many words there are, and which: ``2 (map camera)``."""
    return f"{len(words)} ({' '.join(words)})" if words else "none"
