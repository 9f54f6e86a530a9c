"""The commands that are no session of Lisp's: the simulator alone, the live page, a recording.

``cramhy turtlesim`` is ``rosrun turtlesim turtlesim_node``: the simulator in wall time, with its log on the terminal as in the original
(turtlesim.md 3), for other terminals and a REPL. Each ends with Ctrl-C, without an error.
"""

from __future__ import annotations

import os
import sys
from contextlib import ExitStack

from . import openings


def turtlesim(port=None, view=False):
    """The simulator, until Ctrl-C. port: where it listens. view: with the page."""
    from . import programs

    return programs.run([programs.Program("turtlesim", "turtlesim_node", [])], port=port, view=view)


def view(port=None):
    """The page of the session that runs; without one, of a simulator of its own, until Ctrl-C."""
    from cramhy_runtime.rosbridge import sessions

    try:
        found = sessions.current()
    except sessions.Unsafe as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
    if found is None:
        return turtlesim(port, view=True)
    if not _has_page(found):
        print(f"cramhy: the session of process {found.pid} has no page. Start it with: roslisp_repl --view", file=sys.stderr)
        return 1
    from cramhy_runtime.view.page import show

    print(f"The page: {found.url}")
    show(found.url, found.port, sessions.folder())
    return 0


def _has_page(session):
    """Whether the server of a session gives out a page, and no plain text alone."""
    from http.client import HTTPConnection, HTTPException

    connection = HTTPConnection(session.host, session.port, timeout=5)
    try:
        connection.request("GET", "/")
        return connection.getresponse().getheader("content-type", "").startswith("text/html")
    except (OSError, HTTPException):
        return False
    finally:
        connection.close()


def replay(path, port=None):
    """Show the recording in the file ``path`` in the page, until Ctrl-C."""
    from cramhy_runtime import chronicle, image, kernel

    try:
        openings.require("replay", "cramhy replay")
        kernel.start(clock="wall")
        image.boot()
        with ExitStack() as closings:
            closings.callback(kernel.stop)
            openings.tidy(lambda: os.path.dirname(os.path.realpath(path)))
            try:
                closings.callback(chronicle.replay(path).close)
            except ValueError as problem:
                raise openings.NotPossible(str(problem)) from None
            openings.serve(closings, port, with_page=True)
            while True:
                kernel.park("Ctrl-C, which ends the replay")
    except openings.NotPossible as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
    except (KeyboardInterrupt, kernel.Terminated, kernel.Abandoned):
        return 0
