"""Types that ROS no longer has are explained wherever somebody names them."""

import pytest

from cramhy_runtime.cli import shims
from cramhy_runtime.lisp_core.condition_types import Error
from cramhy_runtime.ros import messages

VELOCITY = (
    "turtlesim/Velocity was replaced by geometry_msgs/Twist: linear is its linear.x, angular its angular.z. "
    "The turtle takes it on the topic turtle1/cmd_vel, which was turtle1/command_velocity."
)


@pytest.mark.parametrize("name", ["turtlesim/Velocity", "TurtleSim/velocity"])
def test_a_message_of_the_former_type_names_its_successor(name):
    with pytest.raises(Error) as error:
        messages.message_class(name)
    assert error.value.report() == f"Can't find class for {name}" and error.value.hint == VELOCITY


def test_a_topic_of_the_former_type_names_its_successor():
    with pytest.raises(Error) as error:
        messages.topic_class("turtlesim/Velocity")
    assert error.value.report() == "No datatype turtlesim/Velocity known" and error.value.hint == VELOCITY


@pytest.mark.parametrize("name", ["Velocity", "<Velocity>"])
def test_reading_the_symbol_of_the_former_class_names_its_successor(name):
    from cramhy_runtime.languages.commonlisp.reader.reader_functions import read_from_string
    from cramhy_runtime.session import boot

    boot()
    with pytest.raises(Error) as error:
        read_from_string(f"(turtlesim-msg:{name})")
    assert error.value.hint == f"TURTLESIM-MSG exports no symbol {name.upper()}. {VELOCITY}"


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (
            "rostopic pub /turtle1/command_velocity turtlesim/Velocity 1 0",
            f"ERROR: invalid message type: turtlesim/Velocity.\n{VELOCITY}\n",
        ),
        (
            "rosmsg show turtlesim/Velocity",
            "Unable to load msg [turtlesim/Velocity]: Cannot locate message [Velocity] in package [turtlesim]; it has turtlesim/Color, "
            f"turtlesim/Pose. {VELOCITY}\n",
        ),
    ],
)
def test_the_commands_name_its_successor(capsys, words, complaint):
    name, *arguments = words.split()
    assert shims.tool(name, arguments) in (1, 2)
    said = capsys.readouterr()
    assert said.out + said.err == complaint


def test_a_service_of_that_name_and_other_types_say_nothing_of_it():
    for ask, name in ((messages.message_class, "turtlesim/Speed"), (messages.service_type, "turtlesim/Velocity")):
        with pytest.raises(Error) as error:
            ask(name)
        assert "Twist" not in str(error.value.hint)
