"""``robot_state_publisher`` and ``joint_state_publisher``: a description and joint states become frames."""

from math import pi

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.ros.roscpp import Program
from cramhy_runtime.ros_tools.executables import start
from cramhy_runtime.session import boot
from cramhy_runtime.tf.buffer import Unavailable
from cramhy_runtime.tf.programs.frames import Listener
from cramhy_runtime.transforms.quaternions import general
from cramhy_runtime.transforms.vectors import point

boot()

CRANE = """<robot name="crane">
  <link name="ground"/><link name="post"/><link name="boom"/><link name="trolley"/><link name="hook"/><link name="lamp"/><link name="left"/>
  <link name="right"/>
  <joint name="stand" type="fixed"><parent link="ground"/><child link="post"/><origin xyz="0 0 2"/></joint>
  <joint name="swing" type="continuous"><parent link="post"/><child link="boom"/><axis xyz="0 0 1"/></joint>
  <joint name="run" type="prismatic"><parent link="boom"/><child link="trolley"/><origin xyz="0.5 0 0"/><axis xyz="2 0 0"/>
    <limit lower="1" upper="4" velocity="1" effort="1"/></joint>
  <joint name="lift" type="prismatic"><parent link="trolley"/><child link="hook"/><origin rpy="0 1.5707963267948966 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="2" velocity="1" effort="1"/></joint>
  <joint name="bracket" type="fixed"><parent link="boom"/><child link="lamp"/><origin xyz="0 0 -0.1" rpy="3.141592653589793 0 0"/></joint>
  <joint name="claw" type="revolute"><parent link="hook"/><child link="left"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/><mimic joint="grip" multiplier="0.5" offset="0.1"/></joint>
  <joint name="other_claw" type="revolute"><parent link="hook"/><child link="right"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/><mimic joint="claw" multiplier="-1"/></joint>
</robot>"""


class Hears(Program):
    """A node that knows where frames are."""

    name = "hears"

    def __init__(self):
        super().__init__()
        self.listener = Listener(self)

    def __call__(self, target, source):
        """Position and rotation (x y z w), or None."""
        found = self.listener.lookup(target, source)
        if isinstance(found, Unavailable):
            return None
        return [round(number, 6) + 0.0 for number in (*point(found.translation), *general(found.rotation))]


class Joints:
    """Publishes joint states."""

    def __init__(self, topic="/joint_states"):
        self.type = message_class_exact("sensor_msgs/JointState")
        self.publication = graph.active().node("hand").advertise(topic, self.type)

    def __call__(self, stamp=None, wait=0.1, **positions):
        message = self.type(name=list(positions), position=list(map(float, positions.values())))
        message.header.stamp = graph.active().now() if stamp is None else stamp
        self.publication.publish(message)
        kernel.sleep(wait)


@pytest.fixture
def where():
    kernel.start(clock="virtual")
    graph.active().parameters.set("/robot_description", CRANE)
    yield Hears()
    kernel.stop()


def run(package="robot_state_publisher", *arguments, executable=None):
    return start(package, executable or package, list(arguments))


HALF = 2**0.5 / 2


@pytest.mark.parametrize(
    ("positions", "source", "place"),
    [
        ({}, "post", [0, 0, 2, 0, 0, 0, 1]),
        ({"swing": pi / 2}, "boom", [0, 0, 2, 0, 0, HALF, HALF]),
        ({"swing": 0, "run": 1.5}, "trolley", [2, 0, 2, 0, 0, 0, 1]),
        ({"swing": pi / 2, "run": 1.5}, "trolley", [0, 2, 2, 0, 0, HALF, HALF]),
        ({"swing": 0, "run": 1, "lift": 1.25}, "hook", [1.5, 0, 0.75, 0, HALF, 0, HALF]),
        ({"swing": pi}, "lamp", [0, 0, 1.9, 0, 1, 0, 0]),
    ],
    ids=["fixed", "turned", "moved", "turned and moved", "along its own axis", "fixed on a joint"],
)
def test_a_link_is_where_its_joints_take_it(where, positions, source, place):
    run()
    joints = Joints()
    kernel.sleep(0.1)
    joints(**positions)
    found = where("ground", source)
    assert found == pytest.approx(place, abs=1e-5) or found == pytest.approx([*place[:3], *(-part for part in place[3:])], abs=1e-5)


def test_a_joint_that_follows_another_is_where_that_one_takes_it(where):
    run()
    joints = Joints()
    joints(grip=0.4)
    assert where("hook", "left")[5] == pytest.approx(0.1494, abs=1e-4)  # the sine of half of 0.4 / 2 + 0.1
    assert where("hook", "right")[5] == pytest.approx(-0.1494, abs=1e-4)


def test_nothing_is_said_of_joints_that_nobody_told(where):
    run()
    Joints()(run=2)
    assert where("boom", "trolley") and where("post", "boom") is None


def test_the_newest_states_count(where):
    run()
    joints = Joints()
    joints(run=2)
    joints(run=3)
    assert where("boom", "trolley")[0] == 3.5


def test_no_more_frames_are_sent_than_the_frequency_says(where):
    program = run("robot_state_publisher", "_publish_frequency:=4")
    sent = []
    graph.active().node("counter").subscribe("/tf", message_class_exact("tf2_msgs/TFMessage"), sent.append)
    joints = Joints()
    for _ in range(20):
        joints(run=2)
    assert program.alive and len(sent) == pytest.approx(8, abs=1)


def test_a_message_of_names_without_positions_is_told(where):
    program = run()
    publication = Joints()
    message = publication.type(name=["run", "lift"], position=[1.0])
    publication.publication.publish(message)
    kernel.sleep(0.1)
    assert program.lines[-1].endswith("ignored an invalid JointState message, which has 2 names and 1 positions.")
    publication(run=2)
    assert where("boom", "trolley")


def test_positions_that_are_not_finite_are_left_out(where):
    run()
    Joints()(run=float("nan"), lift=1)
    assert where("boom", "trolley") is None and where("trolley", "hook")


def test_a_prefix_and_another_description(where):
    graph.active().parameters.set("/other", '<robot name="r"><link name="a"/><link name="b"/>'
                                  '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>')  # fmt: skip
    run("robot_state_publisher", "robot_description:=other", "_tf_prefix:=me")
    kernel.sleep(0.1)
    assert where("me/a", "me/b") == [0, 0, 0, 0, 0, 0, 1]


def test_fixed_frames_may_be_sent_again_and_again(where):
    run("robot_state_publisher", "_use_tf_static:=false", "_publish_frequency:=10")
    sent = []
    graph.active().node("counter").subscribe("/tf", message_class_exact("tf2_msgs/TFMessage"), sent.append)
    kernel.sleep(0.55)
    assert where("ground", "post") and len(sent) == 5


def test_the_older_name_of_the_program_and_one_of_a_launch_file(where):
    run("robot_state_publisher", "__name:=table_tf", executable="state_publisher")
    kernel.sleep(0.1)
    assert where("ground", "post") and "/table_tf" in graph.active().nodes


# ------------------------------------------------------------------------------------------------------- joint_state_publisher


@pytest.fixture
def heard(where):
    states = []
    graph.active().node("ear").subscribe("/joint_states", message_class_exact("sensor_msgs/JointState"), states.append)
    return states


def places(message):
    return {str(name): float(place) for name, place in zip(message.name, message.position, strict=True)}


def test_joints_are_at_zero_or_in_the_middle_of_their_limits(heard):
    run("joint_state_publisher")
    kernel.sleep(0.35)
    assert len(heard) == 3
    assert places(heard[-1]) == {"swing": 0, "run": 2.5, "lift": 0}  # nobody tells of "grip", which the claws follow


def test_zeros_and_the_rate_are_parameters(heard):
    graph.active().parameters.set("/joint_state_publisher/zeros", {"swing": 1.0, "lift": 2, "run": "far"})
    run("joint_state_publisher", "_rate:=2")
    kernel.sleep(1.6)
    assert len(heard) == 3 and places(heard[-1]) == {"swing": 1, "run": 2.5, "lift": 2}


def test_other_topics_tell_of_joints(heard):
    graph.active().parameters.set("/joint_state_publisher/source_list", ["/crane_states"])
    run("joint_state_publisher")
    Joints("/crane_states")(lift=1.5, unknown=3, wait=0.3)
    assert places(heard[-1]) == {"swing": 0, "run": 2.5, "lift": 1.5}


def test_both_together_make_all_frames(where):
    run("joint_state_publisher")
    run()
    kernel.sleep(0.3)
    assert where("ground", "hook") == pytest.approx([3, 0, 2, 0, HALF, 0, HALF], abs=1e-5)


@pytest.mark.parametrize(("parameter", "value"), [("zeros", [1, 2]), ("source_list", "/crane_states")])
def test_parameters_of_another_kind_do_not_count(heard, parameter, value):
    graph.active().parameters.set(f"/joint_state_publisher/{parameter}", value)
    program = run("joint_state_publisher")
    kernel.sleep(0.2)
    assert "so it does not count" in program.lines[-1] and places(heard[-1])["run"] == 2.5


@pytest.mark.parametrize("rate", ["0", "-1", "1e9"])
def test_a_rate_that_cannot_be_is_told(where, rate):
    program = run("joint_state_publisher", f"_rate:={rate}")
    assert "it must be more than 0, and at most 1000. It counts as 10." in program.lines[-1]


@pytest.mark.parametrize("package", ["robot_state_publisher", "joint_state_publisher"])
@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (None, "There is no parameter /robot_description, which has to hold the text of a URDF file."),
        ("a robot", "The robot cannot be read: /robot_description"),
        ('<robot name="r"><link name="a"/><link name="b"/></robot>', "in <robot>: it has 2 roots (a, b)"),
        (5, "The robot cannot be read: /robot_description"),
    ],
    ids=["none", "no XML", "two roots", "a number"],
)
def test_without_a_description_the_program_ends_and_says_why(where, package, text, problem):
    parameters = graph.active().parameters
    parameters.delete("/robot_description")
    if text is not None:
        parameters.set("/robot_description", text)
    with pytest.raises(SimpleError) as caught:
        run(package)
    assert problem in caught.value.report() and f"/{package}" not in graph.active().nodes
