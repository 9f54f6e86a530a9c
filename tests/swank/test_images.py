"""Images in the REPL buffer, for an Emacs that has SLIME's contribution slime-media."""

from __future__ import annotations

import base64
import io
import sys

import pytest

from cramhy_runtime.swank.wire import Name
from cramhy_runtime.turtlesim.node import start_with_first_node

from .client import Emacs


@pytest.fixture
def drawing(session):
    """A session with a turtle that can be driven."""
    start_with_first_node()

    emacs = Emacs(session)
    emacs.repl('(roslisp:start-ros-node "artist")')
    emacs.repl('(defparameter *pub* (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist"))')
    return emacs


DRIVE = '(progn (roslisp:publish *pub* (roslisp:make-message "geometry_msgs/Twist" (x linear) 2.0)) (sleep 0.5) 7)'


def images(emacs):
    return [event for event in emacs.events if event[0] == ":write-image"]


def decoded(event):
    from PIL import Image

    [[_, kind, _, data]] = event[1]
    assert kind == "png"
    return Image.open(io.BytesIO(base64.b64decode(data)))


def test_the_paper_comes_after_a_form_that_moved_the_turtle(drawing):
    assert "SWANK-MEDIA" in drawing.call("(swank:swank-require '(swank-media swank-repl))")
    drawing.repl("(+ 1 1)")
    assert not images(drawing)
    start = len(drawing.events)
    drawing.repl(DRIVE)
    [event] = images(drawing)
    assert decoded(event).size == (500, 500) and event[2] == "turtlesim: turtle1"
    told = [each[0] if each[0] == ":write-image" else each[1] for each in drawing.events[start:] if each[0].startswith(":write")]
    assert told == ["7\n", ":write-image", "\n"]  # the value first, and the prompt on a line of its own
    drawing.repl("(+ 1 1)")
    assert len(images(drawing)) == 1


def test_an_emacs_that_does_not_ask_gets_none(drawing):
    assert "SWANK-MEDIA" not in drawing.call("(swank:swank-require '(swank-repl))")
    drawing.repl(DRIVE)
    assert not images(drawing)


def test_without_pillow_the_paper_comes_as_vectors(drawing, monkeypatch):
    drawing.call("(swank:swank-require 'swank-media)")
    monkeypatch.setitem(sys.modules, "PIL", None)
    drawing.repl(DRIVE)
    [[_, [[_, kind, _, data]], _]] = images(drawing)
    assert kind == Name("svg") and base64.b64decode(data).startswith(b"<svg ")
