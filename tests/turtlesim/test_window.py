"""The Lisp package TURTLESIM: keys and the picture of the window."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.faces.turtlesim import package


def test_pressing_a_key_moves_the_turtle(turtle):
    assert package.press(sym(":UP")) is True
    kernel.sleep(1.5)
    assert turtle.pose[0] == pytest.approx(7.560444, abs=1e-5)
    package.press(sym(":LEFT"))
    kernel.sleep(1.5)
    assert turtle.pose[2] == pytest.approx(2.016, abs=1e-5)


def test_a_key_that_does_not_exist_is_an_error_that_names_the_keys(turtle):
    with pytest.raises(SimpleError) as error:
        package.press(sym(":JUMP"))
    assert error.value.report() == ":JUMP is not a key that moves the turtle. Keys: :up :down :left :right."


@pytest.mark.parametrize(
    "act", [lambda name: package.press(sym(":UP"), name), lambda name: package.mimic("turtle1", name), package.mimic, package.stop]
)
def test_a_name_that_ros_does_not_allow_is_an_error_that_says_why(turtle, act):
    with pytest.raises(SimpleError) as error:
        act("my turtle")
    assert error.value.report() == (
        '"my turtle" is not the name of a turtle or of a node. Character [ ] at element [2] is not valid in Graph Resource Name '
        "[my turtle].  Valid characters are a-z, A-Z, 0-9, / and _."
    )


def test_the_paper_can_be_saved(turtle, tmp_path):
    path = str(tmp_path / "turtle.png")
    assert package.save_picture(path) == path
    assert (tmp_path / "turtle.png").read_bytes().startswith(b"\x89PNG")


def test_without_a_simulator_the_error_says_how_to_get_one():
    kernel.start()
    with pytest.raises(SimpleError) as error:
        package.save_picture("x.png")
    assert "start-ros-node" in error.value.report()
    package.start()
    assert package.running_simulator() is not None
