"""A system that the user loads by file, or has in his central registry, is taken instead of the one that cramhy contains, and a line says so."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.systems import systems


@pytest.fixture
def lisp(session, tmp_path, monkeypatch):
    """Evaluates a text; ``lisp.said()`` is what was told on ``*error-output*`` since. What is chosen is forgotten afterwards."""
    session.package = "CL-USER"
    output = streams.StringOutputStream()
    monkeypatch.setattr(streams.ERROR_OUTPUT, "value", output)

    def evaluate(text):
        return session.evaluate_text(text)

    evaluate.said = output.take
    before = set(systems.preferred)
    yield evaluate
    session.evaluate_text("(setf asdf:*central-registry* nil)")
    for name in ("split-sequence", "cram-language", "my-own"):
        systems.forget_system(name)
        systems.chosen.pop(name, None)
    systems.preferred.clear()
    systems.preferred.update(before)


def write(folder, name, text):
    (folder / f"{name}.asd").write_text(f'(defsystem "{name}" :components ((:file "own")))')
    (folder / "own.lisp").write_text(text)
    return folder / f"{name}.asd"


NAMES = ["split-sequence", "cram-language"]  # a library that is loaded on demand, and a room that is there from the beginning


@pytest.mark.parametrize("name", NAMES)
def test_a_system_that_is_loaded_by_file(lisp, tmp_path, name):
    path = write(tmp_path, name, "(defvar cl-user::*own-one* 0) (incf cl-user::*own-one*)")
    lisp(f'(makunbound (quote cl-user::*own-one*)) (asdf:load-asd "{path}")')
    assert lisp.said() == f"; The system {name} is that of {path}, not the one that cramhy contains.\n"
    assert lisp(f'(asdf:load-system "{name}") cl-user::*own-one*') == [1]
    lisp(f'(asdf:load-asd "{path}")')
    assert "The system" not in lisp.said()  # it is told once


@pytest.mark.parametrize("name", NAMES)
def test_a_system_in_the_central_registry(lisp, tmp_path, name):
    path = write(tmp_path, name, "(defvar cl-user::*own-two* 0) (incf cl-user::*own-two*)")
    lisp(f'(makunbound (quote cl-user::*own-two*)) (push #p"{tmp_path}/" asdf:*central-registry*)')
    assert lisp(f'(asdf:load-system "{name}") cl-user::*own-two*') == [1]
    assert lisp.said().count(f"; The system {name} is that of {path}, not the one that cramhy contains.\n") == 1


@pytest.mark.soak
def test_a_library_of_all_lisps_on_the_package_path(tmp_path):
    path = write(tmp_path, "split-sequence", "(defvar cl-user::*own-four* 4)")
    text = '(asdf:load-system "split-sequence") cl-user::*own-four* (asdf:load-system "alexandria")'
    command = [sys.executable, "-m", "cramhy_runtime.cli", "repl"]
    environment = {**os.environ, "ROS_PACKAGE_PATH": str(tmp_path)}
    said = subprocess.run(command, input=text, env=environment, cwd=tmp_path, capture_output=True, text=True)
    told = said.stdout + said.stderr
    assert told.count("; The system ") == 1 and f"; The system split-sequence is that of {path}, not the one" in told and "\n4\n" in told, (
        told
    )


def test_of_a_system_that_cramhy_does_not_contain_nothing_is_told(lisp, tmp_path):
    path = write(tmp_path, "my-own", "(defvar cl-user::*own-three* 3)")
    assert lisp(f'(asdf:load-asd "{path}") (asdf:load-system "my-own") cl-user::*own-three*') == [3] and lisp.said() == ""
