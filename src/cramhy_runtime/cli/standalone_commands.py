"""The commands that are no session of Lisp's: the simulator alone, the live page, a recording.

``cramhy turtlesim`` is ``rosrun turtlesim turtlesim_node``: the simulator with its log on the terminal as in the original (turtlesim.md 3),
for other terminals and a REPL; in wall time unless something else is said. Each ends with Ctrl-C, without an error.
"""

from __future__ import annotations

import os
import sys
from contextlib import ExitStack

from . import servers


def turtlesim(port=None, view=None, time=None):
    """The simulator, until Ctrl-C. port: where it listens. view, time: as for `programs.run`."""
    from . import programs

    return programs.run([programs.Program("turtlesim", "turtlesim_node", [])], port=port, view=view, time=time)


def view(port=None, time=None):
    """Open the page of the session that runs; without one, of a simulator of its own, until Ctrl-C. time: as for `turtlesim`."""
    from cramhy_runtime.rosbridge.no_answers import NOBODY
    from cramhy_runtime.ros_tools import remote_graph
    from cramhy_runtime.ros_tools.graph_access import OPEN_PAGE, NoSession, Refused, SessionEnded

    from . import live_page

    try:
        servers.require("view", "The page")
        graph = remote_graph.current()
    except NoSession as problem:
        if str(problem):
            return _complain(problem)
        print(f"; No session listens here, so this is a simulator of its own. {WHERE_ONE_LISTENS}", file=sys.stderr, flush=True)
        return turtlesim(port, view=True, time=time)
    except servers.NotPossible as problem:
        return _complain(problem)
    try:
        print(f"The page: {live_page.show_session(graph)}")
    except Refused as problem:
        if str(problem) == NOBODY.format(OPEN_PAGE):
            return _complain(
                f"The session of process {graph.pid} offers no page. Its program opens one by: "
                "from cramhy_runtime import view; view.start()"
            )
        return _complain(f"The session of process {graph.pid} does not open its page: {problem}")
    except SessionEnded as problem:
        return _complain(problem)
    finally:
        graph.close()
    return 0


WHERE_ONE_LISTENS = "To see the turtle of a prompt, type (turtlesim:view) there, or start it with roslisp_repl --serve."


def _complain(problem):
    print(f"cramhy: {problem}", file=sys.stderr)
    return 2


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
