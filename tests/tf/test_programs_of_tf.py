"""The programs of tf, tf2_ros, turtle_tf and turtle_tf2: frames of turtles, a follower, static transforms, and ``tf_echo``."""

import math
import re

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.ros_tools.executables import start
from cramhy_runtime.session import boot
from cramhy_runtime.tf.buffer import Unavailable
from cramhy_runtime.tf.programs.frames import Listener
from cramhy_runtime.tf.stamped import TransformStamped
from cramhy_runtime.ros.roscpp import Program
from cramhy_runtime.transforms.quaternions import general, get_yaw
from cramhy_runtime.transforms.vectors import point
from cramhy_runtime.turtlesim.node import start_turtlesim

boot()


class Hears(Program):
    """A node that knows where frames are."""

    name = "hears"

    def __init__(self):
        super().__init__()
        self.listener = Listener(self)

    def __call__(self, target, source):
        found = self.listener.lookup(target, source)
        return None if isinstance(found, Unavailable) else found


@pytest.fixture
def simulator():
    kernel.start(clock="virtual")
    yield start_turtlesim()
    kernel.stop()


@pytest.fixture
def where(simulator):
    return Hears()


def drive(forward, turn):
    twist = message_class_exact("geometry_msgs/Twist")()
    twist.linear.x, twist.angular.z = forward, turn
    graph.active().node("hand").advertise("/turtle1/cmd_vel", twist.__class__).publish(twist)


def pose(simulator, turtle):
    return simulator.turtles[turtle].pose()[:3]


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    ("package", "executable", "words"),
    [
        ("turtle_tf", "turtle_tf_broadcaster.py", "_turtle:=turtle1"),
        ("turtle_tf", "turtle_tf_broadcaster", "turtle1"),
        ("turtle_tf", "turtle_tf_broadcaster", "/turtle1 __name:=other"),
        ("turtle_tf2", "turtle_tf2_broadcaster.py", "_turtle:=/turtle1"),
        ("turtle_tf2", "turtle_tf2_broadcaster", "turtle1"),
    ],
)
def test_the_frame_of_a_turtle_is_where_it_is(simulator, where, package, executable, words):
    start(package, executable, words)
    kernel.sleep(0.1)
    drive(1.0, 0.7)
    kernel.sleep(1.5)
    found = where("world", "turtle1")
    x, y, heading = pose(simulator, "turtle1")
    assert (*point(found.translation)[:2], get_yaw(found.rotation)) == pytest.approx((x, y, heading), abs=1e-6)
    assert (found.frame_id, found.child_frame_id) == ("world", "turtle1")
    assert found.stamp == pytest.approx(graph.active().now(), abs=0.02)


@pytest.mark.parametrize("executable", ["turtle_tf_broadcaster", "turtle_tf_broadcaster.py"])
def test_a_broadcaster_that_knows_no_turtle_says_how_to_name_one(simulator, executable):
    with pytest.raises(SimpleError) as error:
        start("turtle_tf", executable)
    assert error.value.report() == (
        "/turtle_tf_broadcaster does not know of which turtle it shall tell: the parameter /turtle_tf_broadcaster/turtle is not set."
    )
    assert error.value.hint == (
        'Say it: rosrun turtle_tf turtle_tf_broadcaster.py _turtle:=turtle1, or in the <node> of a launch file <param name="turtle" value="turtle1"/>.'
    )
    assert "/turtle_tf_broadcaster" not in graph.active().nodes


@pytest.mark.soak
@pytest.mark.parametrize("two", ["", "2"])
def test_the_second_turtle_follows_the_first_one(simulator, two):
    package = f"turtle_tf{two}"
    for turtle in ("turtle1", "turtle2"):
        start(package, f"{package}_broadcaster.py", f"__name:={turtle}_broadcaster _turtle:={turtle}")
    follower = start(package, f"{package}_listener.py")
    kernel.sleep(20)
    assert math.dist(pose(simulator, "turtle1")[:2], pose(simulator, "turtle2")[:2]) < 0.05
    drive(3.0, 2.0)
    kernel.sleep(1)
    assert math.dist(pose(simulator, "turtle1")[:2], pose(simulator, "turtle2")[:2]) > 0.3
    kernel.sleep(20)
    assert math.dist(pose(simulator, "turtle1")[:2], pose(simulator, "turtle2")[:2]) < 0.05
    assert follower.lines == []


def test_the_follower_waits_for_a_simulator():
    kernel.start(clock="virtual")
    try:
        follower = start("turtle_tf", "turtle_tf_listener")
        kernel.sleep(5)
        simulator = start_turtlesim()
        kernel.sleep(1)
        assert simulator.turtles["turtle2"].pose()[:3] == (4.0, 2.0, 0.0)
        assert follower.alive
    finally:
        kernel.stop()


def test_a_follower_that_is_there_already_is_driven(simulator):
    simulator.spawn("turtle2", 1.0, 1.0, 0.0)
    for turtle in ("turtle1", "turtle2"):
        start("turtle_tf", "turtle_tf_broadcaster", f"{turtle} __name:={turtle}")
    follower = start("turtle_tf", "turtle_tf_listener.py")
    kernel.sleep(20)
    assert math.dist(pose(simulator, "turtle1")[:2], pose(simulator, "turtle2")[:2]) < 0.05
    assert [line.split("]: ", 1)[1] for line in follower.lines] == [
        "turtle2 was not spawned. If there is a turtle of that name already, it is driven."
    ]


def test_the_turtle_that_follows_has_the_name_of_a_parameter(simulator):
    graph.active().parameters.set("/turtle", "chaser")
    start("turtle_tf2", "turtle_tf2_listener.py")
    kernel.sleep(1)
    assert "chaser" in simulator.turtles


def test_when_the_first_turtle_is_gone_the_second_one_drives_to_where_it_was(simulator):
    for turtle in ("turtle1", "turtle2"):
        start("turtle_tf", "turtle_tf_broadcaster", f"{turtle} __name:={turtle}")
    start("turtle_tf", "turtle_tf_listener.py")
    kernel.sleep(0.5)
    place = pose(simulator, "turtle1")
    simulator.kill("turtle1")
    kernel.sleep(20)
    assert math.dist(place[:2], pose(simulator, "turtle2")[:2]) < 0.05


# ------------------------------------------------------------------------------------------------------ static transforms


@pytest.mark.parametrize(
    ("package", "words", "rotation"),
    [
        ("tf", "1 2 0.5 1.5707963267948966 0 0 map /camera 100", (0, 0, math.sqrt(0.5), math.sqrt(0.5))),
        ("tf", "1 2 0.5 0 0 2 0 map camera 25", (0, 0, 1, 0)),
        ("tf2_ros", "1 2 0.5 0 1.5707963267948966 0 map camera", (0, math.sqrt(0.5), 0, math.sqrt(0.5))),
        ("tf2_ros", "1 2 0.5 0.5 0.5 0.5 0.5 map camera", (0.5, 0.5, 0.5, 0.5)),
    ],
)
def test_a_static_transform_is_known(simulator, where, package, words, rotation):
    start(package, "static_transform_publisher", words)
    kernel.sleep(1)
    found = where("map", "camera")
    assert point(found.translation) == (1.0, 2.0, 0.5)
    assert general(found.rotation) == pytest.approx(rotation)


def test_a_static_transform_of_tf2_is_known_to_those_who_come_later_and_that_of_tf_is_sent_again(simulator):
    start("tf2_ros", "static_transform_publisher", "0 0 1 0 0 0 a b")
    start("tf", "static_transform_publisher", "0 0 1 0 0 0 c d 500")
    kernel.sleep(3)
    late = Hears()
    assert late("a", "b") is not None and late("c", "d") is None
    kernel.sleep(0.6)
    found = late("c", "d")
    assert found is not None and graph.active().now() < found.stamp <= graph.active().now() + 0.5


def test_several_run_since_each_has_a_name_of_its_own_and_a_name_can_be_given(simulator):
    names = {start("tf", "static_transform_publisher", f"0 0 0 0 0 0 map f{number} 100").node.name for number in range(3)}
    assert len(names) == 3 and all(re.fullmatch(r"/static_transform_publisher_\d{19}", name) for name in names)
    assert start("tf", "static_transform_publisher", "0 0 0 0 0 0 map g 100 __name:=mine").node.name == "/mine"


USAGE = (
    "Usage: static_transform_publisher x y z yaw pitch roll frame_id child_frame_id period_in_ms\n"
    "or:    static_transform_publisher x y z qx qy qz qw frame_id child_frame_id period_in_ms"
)
USAGE_2 = USAGE.replace(" period_in_ms", "")
ECHO_USAGE = (
    "Usage: tf_echo source_frame target_frame [echo_rate]\n"
    "It prints the pose of target_frame in source_frame, once a second without a rate."
)


@pytest.mark.parametrize(
    ("package", "executable", "words", "complaint"),
    [
        ("tf", "static_transform_publisher", "", f"static_transform_publisher takes 9 or 10 words, and got none.\n{USAGE}"),
        ("tf", "static_transform_publisher", "1 2 map", f"static_transform_publisher takes 9 or 10 words, and got 3 (1 2 map).\n{USAGE}"),
        (
            "tf2_ros",
            "static_transform_publisher",
            "0 0 0 0 0 0 0 a b 100",
            f"static_transform_publisher takes 8 or 9 words, and got 10 (0 0 0 0 0 0 0 a b 100).\n{USAGE_2}",
        ),
        ("tf", "static_transform_publisher", "0 0 up 0 0 0 a b 100", f'"up" is not a number.\n{USAGE}'),
        ("tf", "static_transform_publisher", "0 0 nan 0 0 0 a b 100", f'"nan" is not a number.\n{USAGE}'),
        ("tf", "static_transform_publisher", "0 0 0 0 0 0 a b fast", f'"fast" is not a number.\n{USAGE}'),
        ("tf", "static_transform_publisher", "0 0 0 0 0 0 a /a 100", f"A frame has no place in itself: both frames are a.\n{USAGE}"),
        (
            "tf",
            "static_transform_publisher",
            "0 0 0 0 0 0 a b 0",
            f"The period is 0 ms; it must be more than 0, and at most 1000000000.\n{USAGE}",
        ),
        ("tf", "static_transform_publisher", "0 0 0 0 0 0 0 a b 10", f"A quaternion of four zeros is not a rotation.\n{USAGE}"),
        ("tf", "tf_echo", "a", f"tf_echo takes the names of two frames and a rate, and got 1 (a).\n{ECHO_USAGE}"),
        ("tf", "tf_echo", "a b 0", f"The rate is 0; it must be more than 0, and at most 1000.\n{ECHO_USAGE}"),
        ("tf", "tf_echo", "a b _rate:=-1", f"The rate is -1; it must be more than 0, and at most 1000.\n{ECHO_USAGE}"),
        ("tf", "tf_echo", "a b often", f'"often" is not a number.\n{ECHO_USAGE}'),
    ],
)
def test_words_that_make_no_sense_are_told_with_the_usage_and_leave_no_node(simulator, package, executable, words, complaint):
    before = set(graph.active().nodes)
    with pytest.raises(SimpleError) as error:
        start(package, executable, words)
    assert error.value.report() == complaint
    assert set(graph.active().nodes) - before <= {"/rosout"}


# ----------------------------------------------------------------------------------------------------------------- tf_echo


def test_tf_echo_prints_the_transform_once_a_second(simulator):
    start("tf", "static_transform_publisher", "1 -2 0.5 1.5 0.25 -0.5 map camera 100")
    echo = start("tf", "tf_echo", "map camera")
    kernel.sleep(2.5)
    first = "\n".join(echo.lines[:5])
    assert re.sub(r"\d{10}\.\d{3}", "TIME", first) == (
        "At time TIME\n"
        "- Translation: [1.000, -2.000, 0.500]\n"
        "- Rotation: in Quaternion [-0.262, -0.079, 0.678, 0.682]\n"
        "            in RPY (radian) [-0.500, 0.250, 1.500]\n"
        "            in RPY (degree) [-28.648, 14.324, 85.944]"
    )
    assert sum(line.startswith("At time") for line in echo.lines) == 3


def test_tf_echo_at_a_rate(simulator):
    start("tf2_ros", "static_transform_publisher", "0 0 0 0 0 0 map camera")
    echo = start("tf", "tf_echo", "map camera 10")
    slow = start("tf", "tf_echo", "map camera _rate:=0.5")
    kernel.sleep(2.05)
    assert [sum(line.startswith("At time") for line in each.lines) for each in (echo, slow)] == [20, 1]


def test_tf_echo_waits_a_second_and_then_tells_what_is_not_known_until_it_is(simulator):
    start("tf2_ros", "static_transform_publisher", "0 0 0 0 0 0 map table")
    echo = start("tf", "tf_echo", "map cup")
    kernel.sleep(0.9)
    assert echo.lines == []
    kernel.sleep(0.3)
    assert [re.sub(r"\d{10}\.\d{9}", "TIME", line) for line in echo.lines] == [
        "Failure at TIME",
        "Exception thrown:The frame cup is not in the graph. Known frames: map, table.",
        "The current list of frames is:",
        "Frame table exists with parent map.",
    ]
    start("tf2_ros", "static_transform_publisher", "0 0 0 0 0 0 table cup")
    kernel.sleep(1)
    assert "- Translation: [0.000, 0.000, 0.000]" in echo.lines


def test_a_broken_transform_spoils_no_other_one(simulator, where):
    message = message_class_exact("tf2_msgs/TFMessage")
    part = message_class_exact("geometry_msgs/TransformStamped")
    broken, whole = part(child_frame_id="x"), part(child_frame_id="y")
    whole.header.frame_id, whole.header.stamp, whole.transform.rotation.w = "map", 5.0, 1.0
    graph.active().node("sends").advertise("/tf", message).publish(message(transforms=[broken, whole]))
    assert isinstance(where("map", "y"), TransformStamped)
    assert len(where.lines) == 1 and "Ignoring a transform on /tf: " in where.lines[0]
