"""Launch files: what they ask for, and what is said of those that cannot be used."""

from __future__ import annotations

import pytest

from cramhy_runtime.cli import launch
from cramhy_runtime.cli.programs import summary

EVERYTHING = """
<launch>
  <arg name="first" default="left"/>
  <arg name="red" default="10"/>
  <arg name="square"/>
  <arg name="unused" value="$(arg first)_x"/>
  <param name="count" value="3"/>
  <param name="text" type="str" value="3"/>
  <param name="/flag" value="true"/>
  <rosparam>
    limits: {speed: 2.0}
    names: [a, b]
  </rosparam>
  <group ns="$(arg first)">
    <remap from="turtle1/cmd_vel" to="cmd"/>
    <node pkg="turtlesim" type="turtlesim_node" name="sim" output="screen">
      <param name="background_r" value="$(arg red)"/>
      <remap from="a" to="b"/>
    </node>
    <node pkg="turtlesim" type="draw_square" name="square" ns="inner" args="_x:='1 2' y:=z" if="$(arg square)"/>
  </group>
  <node pkg="turtlesim" type="mimic" name="mimic" unless="$(arg square)"/>
  <include file="$(dirname)/inner.launch" ns="inside"><arg name="who" value="$(optenv NOBODY_SETS_THIS me you)"/></include>
</launch>
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "all.launch").write_text(EVERYTHING)
    (tmp_path / "inner.launch").write_text('<launch><arg name="who"/><param name="who" value="$(arg who)"/></launch>')
    return tmp_path


def test_everything_that_a_launch_file_may_say(folder):
    launched = launch.load([str(folder / "all.launch")], {"square": "1", "red": "20", "nobody": "x"})
    assert [(program.label, program.executable, program.arguments) for program in launched.programs] == [
        ("left/sim", "turtlesim_node", ["__ns:=/left/", "__name:=sim", "turtle1/cmd_vel:=cmd", "a:=b"]),
        ("left/inner/square", "draw_square", ["__ns:=/left/inner/", "__name:=square", "turtle1/cmd_vel:=cmd", "_x:=1 2", "y:=z"]),
    ]
    assert launched.parameters == {
        "/count": 3,
        "/text": "3",
        "/flag": True,
        "/limits/speed": 2.0,
        "/names": ["a", "b"],
        "/left/sim/background_r": 20,
        "/inside/who": "me you",
    }
    assert launched.arguments_unused == ["nobody"]


def test_the_summary(folder):
    launched = launch.load([str(folder / "all.launch")], {"square": "false"})
    assert (
        summary(launched.parameters, [(program.label, f" ({program.executable})") for program in launched.programs])
        == """SUMMARY
========

PARAMETERS
 * /count: 3
 * /flag: True
 * /inside/who: me you
 * /left/sim/background_r: 10
 * /limits/speed: 2.0
 * /names: ['a', 'b']
 * /text: 3

NODES
  /left/
    sim (turtlesim_node)
  /
    mimic (mimic)
"""
    )


def test_the_launch_file_of_turtlesim():
    assert [program.label for program in launch.load(["turtlesim", "multisim.launch"], {}).programs] == ["turtlesim1/sim", "turtlesim2/sim"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<launch>", "Invalid roslaunch XML syntax: no element found: line 1, column 8 in {path}"),
        ("<robot/>", "Invalid roslaunch XML syntax: no root <launch> tag in {path}"),
        (
            '<launch><nod name="x"/></launch>',
            "while processing {path}:\nInvalid <nod> tag: there is no tag <nod>; there are <group>, <node>, <param>, <rosparam>, <remap>, <arg>, "
            '<include>.\n\nThe tag is <nod name="x">',
        ),
        (
            '<launch><node pkg="turtlesim" name="x"/></launch>',
            'while processing {path}:\nInvalid <node> tag: the attribute type is missing.\n\nThe tag is <node pkg="turtlesim" name="x">',
        ),
        (
            '<launch><param name="a" value="$(arg b)"/></launch>',
            'while processing {path}:\nInvalid <param> tag: there is no <arg name="b"> above it with a value; give one: b:=VALUE.\n\n'
            'The tag is <param name="a" value="$(arg b)">',
        ),
        (
            '<launch><param name="a" valu="1"/></launch>',
            'while processing {path}:\nInvalid <param> tag: it has no attribute valu.\n\nThe tag is <param name="a" valu="1">',
        ),
        (
            '<launch><param name="a" value="x" type="int"/></launch>',
            'while processing {path}:\nInvalid <param> tag: "x" is not of the type int.\n\nThe tag is <param name="a" value="x" type="int">',
        ),
        (
            '<launch><group if="maybe"/></launch>',
            'while processing {path}:\nInvalid <group> tag: if is true, false, 1 or 0, not "maybe".\n\nThe tag is <group if="maybe">',
        ),
        (
            '<launch><include file="/no/such.launch"/></launch>',
            'while processing {path}:\nInvalid <include> tag: there is no file /no/such.launch.\n\nThe tag is <include file="/no/such.launch">',
        ),
        (
            "<launch><rosparam>a: [1</rosparam></launch>",
            "while processing {path}:\nInvalid <rosparam> tag: its parameters: line 1, column 4: the [ is never closed.\n\nThe tag is <rosparam>",
        ),
        (
            '<launch><node pkg="turtlesim" type="mimic" name="a/b"/></launch>',
            'while processing {path}:\nInvalid <node> tag: the name of a node holds no slash; give the namespace by ns="a".\n\n'
            'The tag is <node pkg="turtlesim" type="mimic" name="a/b">',
        ),
        (
            '<launch><param name="a" command="rm x"/></launch>',
            "while processing {path}:\nInvalid <param> tag: cramhy runs no commands for parameters but xacro FILE and cat FILE; give value or "
            'textfile.\n\nThe tag is <param name="a" command="rm x">',
        ),
        (
            '<launch><node pkg="turtlesim" type="mimic" name="a" args="\'b"/></launch>',
            "while processing {path}:\nInvalid <node> tag: the words of args: No closing quotation.\n\n"
            'The tag is <node pkg="turtlesim" type="mimic" name="a" args="\'b">',
        ),
        ('<launch><include file="$(dirname)/x.launch"/></launch>', "while processing {path}:\n20 launch files include each other."),
    ],
)
def test_a_launch_file_that_cannot_be_used(tmp_path, text, message):
    path = tmp_path / "x.launch"
    path.write_text(text)
    with pytest.raises(launch.LaunchError) as caught:
        launch.load([str(path)], {})
    assert str(caught.value) == message.format(path=path)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["turtlesim", "nope.launch"],
            "[nope.launch] is neither a launch file in package [turtlesim] nor is [turtlesim] a launch file name\n"
            "turtlesim has the launch file multisim.launch.",
        ),
        (
            ["nope", "x.launch"],
            "[x.launch] is neither a launch file in package [nope] nor is [nope] a launch file name\n"
            "There is no package nope. rospack list names those that there are.",
        ),
        (
            ["turtelsim", "x.launch"],
            "[x.launch] is neither a launch file in package [turtelsim] nor is [turtelsim] a launch file name\n"
            "There is no package turtelsim. Did you mean turtlesim?",
        ),
        (
            ["std_srvs", "x.launch"],
            "[x.launch] is neither a launch file in package [std_srvs] nor is [std_srvs] a launch file name\nstd_srvs has no launch files.",
        ),
        (
            ["turtlesim", "/no/x.launch"],
            "[/no/x.launch] is neither a launch file in package [turtlesim] nor is [turtlesim] a launch file name\n"
            "turtlesim has the launch file multisim.launch.",
        ),
        (
            ["turtlesim", "../*[.l"],
            "[../*[.l] is neither a launch file in package [turtlesim] nor is [turtlesim] a launch file name\n"
            "turtlesim has the launch file multisim.launch.",
        ),
        (["nope.launch"], "[nope.launch] is not a launch file name"),
    ],
)
def test_a_launch_file_that_is_not_there(words, message):
    with pytest.raises(launch.LaunchError) as caught:
        launch.load(words, {})
    assert str(caught.value) == message
