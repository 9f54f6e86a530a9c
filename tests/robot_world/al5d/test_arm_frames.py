"""Where the links of the arm and its camera are, as frames of tf, and what the camera's picture measures."""

from math import pi

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.ros.roscpp import Program
from cramhy_runtime.robot_world.al5d import model
from cramhy_runtime.tf.programs.frames import Listener
from cramhy_runtime.transforms.quaternions import rotate
from cramhy_runtime.transforms.vectors import make_3d_vector, point


@pytest.fixture
def where(table):
    program = Program("hears")
    listener = Listener(program)
    return lambda target, source: listener.lookup(target, source)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "command",
    [(0, pi / 2, -pi / 2, 0, 0, 0.03), (0.5, 1.2, -1.0, 0.3, -0.4, 0.01), (-1.5, 2.0, -2.5, -1.0, 1.0, 0.02), (3, 0.3, -0.2, 1.2, 3, 0)],
)
def test_each_link_is_where_the_world_has_it(table, where, command):
    table.send(*command, wait=4.0)
    world = table.simulator.bench
    for link in model.described().links:
        if link != "world":
            there, found = world.link(model.NAME, link), where("world", link)
            assert point(found.translation) == pytest.approx(tuple(map(float, there.position)), abs=2e-4), link


def test_frames_come_ten_times_a_second_while_somebody_listens(table, where):
    heard = []
    graph.active().node("counter").subscribe("/tf", message_class_exact("tf2_msgs/TFMessage"), heard.append)
    kernel.sleep(1.05)
    assert len(heard) == 10 and len(heard[-1].transforms) == len(model.described().joints) + 1


def test_the_camera_looks_down_on_the_middle_of_the_workspace(table, where):
    kernel.sleep(0.2)
    found = where("world", "camera_link")
    assert point(found.translation) == pytest.approx((0, 0.17, 0.25))
    assert point(rotate(found.rotation, make_3d_vector(0, 0, 1))) == pytest.approx((0, 0, -1))
    assert point(rotate(found.rotation, make_3d_vector(1, 0, 0))) == pytest.approx((1, 0, 0))


def test_a_brick_is_in_the_picture_where_the_camera_info_says(table):
    infos = table.listen("al5d_external_vision/camera_info", "sensor_msgs/CameraInfo")
    others = table.listen("external_vision/camera_info", "sensor_msgs/CameraInfo")
    pictures = table.listen("al5d_external_vision/image_raw", "sensor_msgs/Image")
    table.send(2.5, 1.57, -1.57, 0, 0, 0, wait=3.0)
    table.spawn(0.05, 0.2, colour="red")
    kernel.sleep(2.0)
    info, picture = infos[-1], pictures[-1]
    assert (info.width, info.height, info.distortion_model, info.header.frame_id) == (640, 480, "plumb_bob", picture.header.frame_id)
    assert len(infos) == len(others) and info.header.stamp == picture.header.stamp
    (fx, _, cx), (_, fy, cy) = info.K[:3], info.K[3:6]
    depth = 0.25 - model.BRICK[2]
    column, row = round(cx + fx * 0.05 / depth), round(cy - fy * 0.03 / depth)
    red, green, blue = picture.data[3 * (640 * row + column) : 3 * (640 * row + column) + 3]
    assert red > max(green, blue) + 40
    assert list(info.P) == [fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0]


def test_the_publisher_of_the_course_s_launch_file_works_beside_it(table, where):
    from cramhy_runtime.ros_tools.executables import start

    text = '<robot name="r"><link name="a"/><link name="b"/><joint name="Joint1" type="continuous"><parent link="a"/><child link="b"/>' \
           '<axis xyz="0 0 1"/></joint></robot>'  # fmt: skip
    graph.active().parameters.set("/robot_description", text)
    start("robot_state_publisher", "robot_state_publisher", ["/joint_states:=/lynxmotion_al5d/joint_states"])
    table.send(0.5, pi / 2, -pi / 2, 0, 0, 0.03)
    assert point(rotate(where("a", "b").rotation, make_3d_vector(1, 0, 0)))[1] == pytest.approx(0.479, abs=0.01)
