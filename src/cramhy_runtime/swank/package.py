"""The packages SWANK-LOADER and SWANK (for SLY: SLYNK-LOADER and SLYNK), as Emacs expects them of a Lisp that it has started.

``M-x slime`` starts a Lisp and types one form into it: load swank-loader.lisp, call ``swank-loader:init``, call ``swank:start-server`` with
the name of a file for the port. The file swank-loader.lisp is a program for other Lisps. Its place is taken by these packages.
"""

from __future__ import annotations

import os
import sys

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.packages import keyword, on_demand, registered
from cramhy_runtime.languages.commonlisp.packages.face_definition import define_face
from cramhy_runtime.languages.commonlisp.files.files import path_of
from cramhy_runtime.session import session

from . import server, slime_version
from .calls.evaluating import presented


def log(text):
    """Tell the user of the session a line."""
    if sys.stderr is not None:
        print(f"; Emacs: {text}", file=sys.stderr, flush=True)


def init(*options, **more):
    """``swank-loader:init``: everything is there already."""


def start_server(port_file, *options, port=None, dont_close=None, style=None, coding_system=None, **more):
    """``swank:start-server``: listen on a free port of loopback, and write the port into ``port_file``. Returns the port."""
    return _serve(port, os.fspath(path_of(port_file)))


def create_server(*options, port=4005, dont_close=None, style=None, interface=None, **more):
    """``swank:create-server``: listen on ``port`` of loopback, which is 4005 as in SLIME. Returns the port."""
    return _serve(port, None)


def _serve(port, port_file):
    current = session.current()
    if current is None:
        return error("There is no session that a server could belong to. Start cramhy repl, and call this there.")
    try:
        return server.serve(current, log, port, port_file).port
    except server.ServerError as problem:
        return error("~a", str(problem))


def stop_server(port=None):
    """``swank:stop-server``: end the server that listens on ``port``, or all; T if there was one."""
    found = [each for each in server.running() if port is None or each.port == port]
    for each in found:
        each.close()
    return True if found else None


def define():
    """Make the packages, once in each image."""
    for prefix in ("SWANK", "SLYNK"):
        for name in (prefix, f"{prefix}-LOADER"):
            on_demand.pop(name, None)  # they are being made now
    if registered("SWANK-LOADER") is not None:
        return
    for prefix in ("SWANK", "SLYNK"):
        define_face(f"{prefix}-LOADER", functions={"init": init})
        define_face(
            prefix,
            functions={
                "start-server": start_server,
                "create-server": create_server,
                "stop-server": stop_server,
                "lookup-presented-object-or-lose": presented,
                "lookup-presented-object": presented,
            },
            variables={"*readtable-alist*": None, "*communication-style*": keyword("SPAWN")},
        )


def stand_in(loader=None):
    """Do what loading the file ``loader``, SLIME's or SLY's swank-loader.lisp, is for. ``None``: what naming a package is for."""
    if loader is not None:
        slime_version.started_from(loader)
    define()
