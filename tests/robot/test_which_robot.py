"""Which robot an image has: the one whose description was asked for, else the PR2; a question chooses none."""

from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from cramhy import robot  # noqa: E402  it starts a kernel, which must not be there when nothing can be tested
from cramhy_runtime.robot import libraries  # noqa: E402

pytestmark = pytest.mark.soak

ROOT = Path(__file__).parents[2]
FOUND = (
    f"Descriptions that were found: cram-porter-description ({ROOT}/tutorials/kitchen/cram_porter_description), "
    "cram-pr2-description (part of cramhy)."
)


@pytest.fixture
def image(monkeypatch):
    monkeypatch.chdir(ROOT)
    with Image():
        yield Session(time="virtual", turtlesim=False)
        kernel.stop()


def told(call):
    with pytest.raises(Exception) as caught:  # noqa: PT011  the classes are compared by those who call
        call()
    return type(caught.value), str(caught.value)


NOTHING = (RuntimeError, "There is no robot yet. Begin with robot.world(), which has the PR2, or name another description of a robot.")


def test_the_robot_is_the_one_that_is_asked_for(image):
    for question in (lambda: robot.World().names(), lambda: robot.World().robot, lambda: robot.World().held(), lambda: robot.go((0, 0, 0))):
        assert told(question) == NOTHING
    assert issubclass(robot.failures.ObjectUnfetchable, robot.failures.HighLevelFailure)
    folders = f"{ROOT}, {ROOT}/src, {ROOT}/tutorials"
    kind, text = told(lambda: robot.world("cram_portr_description"))
    assert kind is ValueError and text == (
        f"There is no description of a robot called 'cram_portr_description': no file cram-portr-description.asd is below {folders}. "
        f"Did you mean cram_porter_description?\n{FOUND} ROS_PACKAGE_PATH names further folders in which descriptions are."
    )
    assert "Did you mean cram_porter_description?" in told(lambda: robot.world("porter"))[1]
    assert told(lambda: robot.world(5)) == (
        TypeError,
        'A robot is named by the system that describes it, such as "cram_pr2_description", not 5.',
    )
    assert told(lambda: robot.world("alexandria")) == (
        ValueError,
        f"The system alexandria (part of cramhy) was loaded, and it describes no robot: it has no fact (robot NAME).\n{FOUND}",
    )
    assert libraries.robots() == []
    made = robot.world("cram_porter_description")
    assert libraries.robots() == ["PORTER"] and [str(thing.name) for thing in made.core.machines()][-1].endswith("PORTER")
    for again in ("cram_porter_description", "cram-porter-description", None):
        libraries.load(again)
    assert told(lambda: robot.world("cram_pr2_description")) == (
        ValueError,
        "This image has the robot PORTER already; describe that of cram_pr2_description in an image of its own: with Image(): ...",
    )


def test_a_robot_that_lisp_has_loaded_counts(image):
    image.evaluate_text("(asdf:load-system :cram-pr2-projection)")
    assert told(lambda: robot.world("cram_porter_description"))[0] is ValueError
    libraries.load("cram_pr2_description")
    assert libraries.robots() == ["PR2"] and robot.World().names() == []
    assert type(robot.world(mode="physical").core).__name__ == "PhysicalWorld", "the mode is that of this image"
