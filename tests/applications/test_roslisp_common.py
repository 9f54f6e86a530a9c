"""The libraries of roslisp_common give what they give on SBCL: those of cramhy in their place, and those of a checkout.

SBCL wrote the answers, with the libraries of a checkout. CRAMHY_APPLICATIONS names a folder with one, ``roslisp_common``; without it only
ours are asked.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image
from typed_lists import run

CHECKOUT = Path(os.environ.get("CRAMHY_APPLICATIONS", "nowhere")) / "roslisp_common"
foreign = pytest.mark.skipif(not CHECKOUT.is_dir(), reason="CRAMHY_APPLICATIONS names no folder with roslisp_common")
TRANSFORMS = ["cl_transforms/src/cl-transforms.asd", "cl_transforms_stamped/cl-transforms-stamped.asd"]
ACTIONS = ["actionlib_lisp/src/new_implementation/actionlib-lisp.asd", "actionlib_lisp/src/original_implementation/actionlib.asd"]
UTILITIES = ["cl_utils/src/utils/cl-utils.asd"]
LIBRARIES = {
    "roslisp_common": TRANSFORMS,  # cl_transforms
    "cl_urdf": [*TRANSFORMS, "cl_urdf/cl-urdf.asd"],  # with the library s-xml; there a number without a point is an integer, here a float
    "roslisp_utilities": [*UTILITIES, "roslisp_utilities/roslisp-utilities.asd"],  # there a node was a function that notes that it runs
    "cl_tf": [*TRANSFORMS, *UTILITIES, "cl_tf/cl-tf.asd"],  # without messages, listener, broadcaster; with stand-ins for roslisp's names
    "cl_transforms_stamped": TRANSFORMS,  # this and the next ones with Debian's roslisp: record.py beside this file
    "cl_tf2": [*TRANSFORMS, *ACTIONS, "cl_tf2/cl-tf2.asd"],
    "actionlib_lisp": ACTIONS,
    "actionlib": ACTIONS,
}
"""The lists of typed forms, each with the files of the systems that it asks."""


@pytest.mark.parametrize("library", LIBRARIES)
def test_ours_gives_what_that_of_roslisp_common_gives_on_sbcl(library):
    with Image():
        assert run(Session(time="virtual", turtlesim=False), library) == []


@foreign
@pytest.mark.parametrize("library", LIBRARIES)
def test_that_of_a_checkout_gives_here_what_it_gives_on_sbcl(monkeypatch, library):
    """It is loaded by file, so that it takes the place of ours."""
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(CHECKOUT))
    with Image():
        session = Session(time="virtual", turtlesim=False)
        for system in LIBRARIES[library]:
            session.evaluate_text(f'(asdf:load-asd "{CHECKOUT / system}")')
        assert run(session, library, original=True) == []


@foreign
def test_cl_utils_of_a_checkout_gives_what_it_gives_on_sbcl(monkeypatch):
    """Its systems cl-utils, extended-reals, data-structures, cl-graph and cl-probability are loaded by name."""
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(CHECKOUT))
    with Image():
        assert run(Session(time="virtual", turtlesim=False), "cl_utils") == []


@foreign
def test_the_suite_of_actionlib_lisp_gives_with_its_own_library_what_it_gives_on_sbcl(monkeypatch, capsys):
    """302 of its 307 assertions hold on both; the other five, in three tests, are wrong about the library that they come with."""
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(CHECKOUT))
    with Image():
        session = Session(time="virtual", turtlesim=False)
        session.evaluate_text(f'(asdf:load-asd "{CHECKOUT / ACTIONS[0]}") (asdf:load-system "actionlib-test")')
        session.evaluate_text("(lisp-unit:print-failures (lisp-unit:run-tests :all :actionlib-test))")
    printed = capsys.readouterr().out
    assert re.findall(r"(\d+) (assertions total|passed|failed|execution errors)", printed)[:4] == [
        ("307", "assertions total"),
        ("302", "passed"),
        ("5", "failed"),
        ("0", "execution errors"),
    ]
    assert sorted(re.findall(r"^([-A-Z]+): \d+ assertions passed, (\d+) failed", printed, re.MULTILINE)) == [
        ("DONE-TRANSITIONS", "1"),
        ("UPDATE-STATUS-AND-RESULT", "1"),
        ("WAITING-FOR-GOAL-ACK-TRANSITIONS", "3"),
    ]
