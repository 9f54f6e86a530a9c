"""The robot's world in Emacs: as an image, and in the inspector."""

from __future__ import annotations

import pytest

from .test_images import decoded, images
from .test_looking import content

pytest.importorskip("mujoco")


@pytest.fixture
def world(emacs):
    """An Emacs whose session has a world with a ball, and gets images."""
    emacs.call("(swank:swank-require '(swank-media))")
    emacs.repl('(asdf:load-system "cram-bullet-reasoning")')
    emacs.repl("(setf btr:*current-bullet-world* (robot-world:make-world))")
    emacs.events.clear()
    emacs.repl("(btr:add-object btr:*current-bullet-world* :sphere 'ball '((0 0 0.1) (0 0 0 1)) :radius 0.1 :mass 0.5)")
    return emacs


def test_a_form_that_moves_something_shows_it(world):
    [event] = images(world)
    assert decoded(event).size == (480, 360) and event[2] == "the robot's world"
    world.repl("(+ 1 2)")
    assert len(images(world)) == 1


def test_a_world_is_inspected(world):
    _, text, actions, parts = content(world.call('(swank:init-inspector "btr:*current-bullet-world*")'))
    assert "The object is a world with 1 thing.\nBALL: #<" in text and list(actions) == ["[simulate 1 s]"]
    _, text, actions, _ = content(world.call(f"(swank:inspect-nth-part {parts[0]})"))
    assert "The object is a thing in a world.\n" in text and "Mass in kg: 0.5d0\n" in text and "Pose:       #<" in text
    _, text, *_ = content(world.call(f"(swank:inspector-call-nth-action {actions['[see what it touches]']})"))
    assert text.startswith('The object is a SYMBOL.\nName:     "NIL"')  # an empty list: the floor is no thing
    world.call("(swank:inspector-pop)")
    _, text, actions, _ = content(world.call("(swank:inspector-reinspect)"))
    assert "The object is a world" in content(world.call(f"(swank:inspector-call-nth-action {actions['[go to its world]']})"))[1]


@pytest.mark.soak
def test_furniture_tells_its_joints(world):
    world.repl(
        "(btr:add-object btr:*current-bullet-world* :urdf :kitchen '((0 0 0) (0 0 0 1)) :urdf (robot-world:description-text :kitchen))"
    )
    _, text, *_ = content(world.call('(swank:init-inspector "(btr:object btr:*current-bullet-world* :kitchen)")'))
    assert "\nName: " in text and "\nJoint " in text
