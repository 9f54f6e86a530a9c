"""Fixtures of tests with systems: files in a folder in which systems are found, and forms in."""

from __future__ import annotations

import pytest

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.systems import systems

collect_ignore = ["systems"]  # their own tests run in test_plan_system.py; collected here, they would define theirs for all tests


@pytest.fixture
def write(tmp_path, session, monkeypatch):
    """A function: write a file below the folder in which systems are found."""
    monkeypatch.setattr("cramhy_runtime.ros.search_folders.extra_folders", [str(tmp_path)])
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    session.package = "CL-USER"
    before = dict(systems.systems)
    session.evaluate_text("(defparameter cl-user::*log* nil)", "<test>")

    def writing(name, text):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    yield writing
    for name in set(systems.systems) - set(before):
        systems.forget_system(name)


@pytest.fixture
def run(write, session):
    """A function: the printed value of the last form of a text."""
    return lambda text: prin1_to_string(session.evaluate_text(text, "<test>")[0])
