"""An Emacs that speaks to a session in virtual time, without a socket."""

from __future__ import annotations

import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.streams import streams as lisp_streams
from cramhy_runtime.session.session import Session
from cramhy_runtime.swank import package, server, streams

from .client import Emacs


@pytest.fixture
def session():
    """A session in virtual time, without the turtle, as it was before when the test is over."""
    made = Session(time="virtual", turtlesim=False)
    package.stand_in()
    saved = [(variable, variable.value) for variable in (*streams.VARIABLES, lisp_streams.STANDARD_INPUT, lisp_streams.TERMINAL_IO)]
    files = sys.stdin, sys.stdout, sys.stderr
    yield made
    sys.stdin, sys.stdout, sys.stderr = files
    for variable, value in saved:
        variable.value = value
    conditions.install_router(None)
    kernel.stop()


@pytest.fixture
def emacs(session):
    """An `Emacs` that is connected."""
    return Emacs(session)


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A home of its own, without a secret."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    return tmp_path


@pytest.fixture
def serve(session, home):
    """``serve(...)``: a server of the session; ``serve.logged`` has what the user is told."""

    def serve(*arguments, **options):
        found = server.serve(session, serve.logged.append, *arguments, **options)
        opened.append(found)
        return found

    serve.logged, opened = [], []
    yield serve
    for each in opened:
        each.close()
