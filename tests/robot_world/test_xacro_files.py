"""Xacro files are expanded wherever a robot is described: in Python, in Lisp, and as a parameter of a launch file."""

import sys

import pytest

pytest.importorskip("xacro", reason="needs xacro")

from cramhy_runtime.cli import launch
from cramhy_runtime.extras import install_command
from cramhy_runtime.robot_world import description_files, xacro_files
from cramhy_runtime.robot_world.descriptions import DescriptionError

ARM = """<?xml version="1.0"?>
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="$(find my_arm)/urdf/finger.xacro"/>
  <xacro:arg name="length" default="0.3"/>
  <xacro:property name="l" value="$(arg length)"/>
  <link name="base"><collision><geometry><box size="${l} ${2*l} ${l/3}"/></geometry></collision></link>
  <xacro:finger name="left" y="${l/2}"/>
  <xacro:finger name="right" y="${-l/2}"/>
</robot>
"""
FINGER = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="finger" params="name y">
    <link name="${name}_finger"/>
    <joint name="${name}_joint" type="prismatic">
      <parent link="base"/><child link="${name}_finger"/><origin xyz="0 ${y} 0"/><axis xyz="0 1 0"/>
      <limit lower="0" upper="0.05" effort="10" velocity="0.1"/>
    </joint>
  </xacro:macro>
</robot>
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """The folder ``urdf`` of a package with a robot of two files."""
    folder = tmp_path / "src" / "arm_of_mine" / "urdf"
    folder.mkdir(parents=True)
    (folder.parent / "package.xml").write_text("<package><name>my_arm</name></package>")
    (folder / "arm.urdf.xacro").write_text(ARM)
    (folder / "finger.xacro").write_text(FINGER)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "src"))
    return folder


def test_macros_properties_and_other_files_of_packages_are_expanded(package):
    robot = description_files.read_file(package / "arm.urdf.xacro")
    assert robot.name == "arm" and list(robot.links) == ["base", "left_finger", "right_finger"]
    assert robot.links["base"].shapes[0].size == pytest.approx((0.3, 0.6, 0.1))
    assert [robot.joints[f"{side}_joint"].frame.position[1] for side in ("left", "right")] == pytest.approx([0.15, -0.15])


def test_arguments_of_the_file_are_given_by_name(package):
    assert 'size="0.9 1.8 0.3"' in xacro_files.expanded(package / "arm.urdf.xacro", {"length": "0.9"}).replace("0.3000000000000000", "0.3")
    assert "ament_index_python" not in sys.modules


def test_lisp_reads_them(package):
    from cramhy_runtime import kernel
    from cramhy_runtime.repl.session import Session
    from lisp_text import LispText

    session = Session(time="virtual", turtlesim=False)
    lisp = LispText(session, '(asdf:load-system "cl-urdf") (defpackage :xacro-test (:use :cl)) (in-package :xacro-test)')
    try:
        text = f'(let ((robot (cl-urdf:parse-urdf #p"{package / "arm.urdf.xacro"}"))) (list (cl-urdf:name robot) (hash-table-count (cl-urdf:links robot))))'
        assert repr(lisp.values(text)) == "[('arm' 3)]"
    finally:
        kernel.stop()


@pytest.mark.parametrize(
    "command", ["$(find xacro)/xacro.py --inorder '$(find my_arm)/urdf/arm.urdf.xacro'", "xacro $(find my_arm)/urdf/arm.urdf.xacro"]
)
@pytest.mark.parametrize("arguments", ["", " length:=0.6"])
def test_a_launch_file_sets_a_parameter_to_what_xacro_makes(package, tmp_path, command, arguments):
    file = tmp_path / "upload.launch"
    file.write_text(f'<launch><param name="robot_description" command="{command}{arguments}"/></launch>')
    text = launch.load([str(file)], {}).parameters["/robot_description"]
    size = description_files.read_text(text).links["base"].shapes[0].size[0]
    assert size == pytest.approx(0.6 if arguments else 0.3)


def test_a_launch_file_sets_a_parameter_to_what_cat_prints(package, tmp_path):
    file = tmp_path / "upload.launch"
    file.write_text('<launch><param name="text" command="cat $(find my_arm)/package.xml"/></launch>')
    assert launch.load([str(file)], {}).parameters == {"/text": "<package><name>my_arm</name></package>"}


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<xacro:nothing/>", "xacro cannot expand it: unknown macro name: xacro:nothing."),
        ('<link name="${unknown}"/>', "xacro cannot expand it: name 'unknown' is not defined"),
        ('<xacro:include filename="nowhere.xacro"/>', "xacro cannot expand it: [Errno 2] No such file or directory"),
        (
            '<xacro:include filename="$(find nowhere)/x.xacro"/>',
            "xacro cannot expand it: the ROS package nowhere is not found; ROS_PACKAGE_PATH names the folders in which packages are",
        ),
        ("<link", "xacro cannot expand it: "),
        ('<link name="${1/0}"/>', "xacro cannot expand it: division by zero"),
        ('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>', "xacro cannot expand it: "),
    ],
)
def test_a_file_that_cannot_be_expanded_says_why(tmp_path, text, reason):
    path = tmp_path / "wrong.xacro"
    path.write_text(f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{text}</robot>')
    with pytest.raises(DescriptionError) as caught:
        description_files.read_file(path)
    assert caught.value.reason.startswith(reason) and caught.value.file == str(path)


def test_an_error_in_a_file_that_is_included_names_that_file_and_the_macro(package):
    (package / "finger.xacro").write_text(FINGER.replace('xyz="0 ${y} 0"', 'xyz="0 ${z} 0"'))
    with pytest.raises(DescriptionError) as caught:
        description_files.read_file(package / "arm.urdf.xacro")
    assert caught.value.reason.startswith("xacro cannot expand it: name 'z' is not defined")
    assert caught.value.reason.endswith("The macro finger was being expanded.")


def test_without_the_package_xacro_the_error_names_the_extra(package, monkeypatch):
    monkeypatch.setitem(sys.modules, "xacro", None)
    with pytest.raises(DescriptionError) as caught:
        description_files.read_file(package / "arm.urdf.xacro")
    assert caught.value.reason == f"expanding it takes the Python package xacro. Type: {install_command('robot')}"


def test_a_file_that_is_not_there_is_the_usual_error(tmp_path):
    with pytest.raises(FileNotFoundError):
        description_files.read_file(tmp_path / "none.xacro")
