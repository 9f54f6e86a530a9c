"""The commands that are no session of Lisp's: the simulator alone, the live page, a recording.

``cramhy turtlesim`` is ``rosrun turtlesim turtlesim_node``: the simulator with its log on the terminal as in the original (turtlesim.md 3),
for other terminals and a REPL; in wall time unless something else is said. Each ends with Ctrl-C, without an error.
"""

from __future__ import annotations

import os
import sys
from contextlib import ExitStack

from . import servers


def turtlesim(port=None, view=False, time=None):
    """The simulator, until Ctrl-C. port: where it listens. view: with the page. time: what ``--time`` says, or ``None``."""
    from . import programs

    return programs.run([programs.Program("turtlesim", "turtlesim_node", [])], port=port, view=view, time=time)


def view(port=None, time=None):
    """The page of the session that runs; without one, of a simulator of its own, until Ctrl-C. time: as for `turtlesim`."""
    from cramhy_runtime.rosbridge import sessions

    try:
        found = sessions.current()
    except sessions.Unsafe as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
    if found is None:
        return turtlesim(port, view=True, time=time)
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
    from cramhy_runtime import chronicle, kernel
    from cramhy_runtime.session import boot

    try:
        servers.require("replay", "cramhy replay")
        kernel.start(clock="wall")
        boot()
        with ExitStack() as closings:
            closings.callback(kernel.stop)
            servers.tidy(lambda: os.path.dirname(os.path.realpath(path)))
            try:
                closings.callback(chronicle.replay(path).close)
            except ValueError as problem:
                raise servers.NotPossible(str(problem)) from None
            servers.serve(closings, port, with_page=True)
            while True:
                kernel.park("Ctrl-C, which ends the replay")
    except servers.NotPossible as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
    except (KeyboardInterrupt, kernel.Terminated, kernel.Abandoned):
        return 0
