"""The page of a session that runs already: it opens at any time, without a restart.

Three ask for it. The user does, by ``(turtlesim:view)``. Another terminal does, by ``cramhy view`` or ``rosrun turtlesim
turtlesim_node``, if the session listens (``--serve``). And on a desktop the page opens by itself when the turtle appears, as the
original's window does. Where there is no screen, nothing is said, since prompts answer as the slides show; `help` tells how to open it.
`offer` lets a session do the first two, `open_with_turtle` the last. `show_session` is for the other terminal.

A simulator that ``rosrun`` has started goes over to the prompt's session when one starts. The browsers that show it go with it (`follow`).
"""

from __future__ import annotations

import os
import sys

from cramhy_runtime.turtlesim import window

ASK = "(turtlesim:view)"
MOVED = "/cramhy/moved"
"""The topic on which pages hear the address of the page that takes their place."""
PATIENCE = 2.0  # s that browsers get to leave for it


def offer():
    """Let the page of the active session, and of those that follow it in this process, be opened at any time."""
    window.offer(opened)


def opened(show, asked):
    """The page of the active session, which opens now if it is not open; see `window.offer`."""
    from cramhy_runtime.view import page

    from . import heap, servers

    try:
        servers.require("view", "The page")
        with servers.server_errors_told():
            heap.keep_small()
            return page.start(open_browser=show, watched=asked)
    except servers.NotPossible as problem:
        raise window.NoPage(str(problem)) from None


def open_with_turtle():
    """Open the page in a browser when the first simulator of the active session starts, if a person sits at a desktop."""
    from cramhy_runtime.turtlesim.node import each_simulator

    if not sys.stdin.isatty():  # nothing of it is loaded where lines come from a pipe
        return
    told = []

    def appears(_):
        if not told:
            told.append(True)
            _open_unasked()

    each_simulator(appears)


def _open_unasked():
    from cramhy_runtime.view import page

    if page.running() is not None:
        return
    if page.opens_by_itself():
        try:
            _tell(f"The page: {opened(show=True, asked=False).url}")
            return
        except window.NoPage:
            pass  # why, it says to those who ask for the page


def show_session(graph, asked=True):
    """Have the session at ``graph``, a `ThereGraph`, open its page, and show it here; its address.

    asked: whether the user has asked for the page. Otherwise a browser opens if a person sits at a desktop, and none was opened for it
    before. Raises `graph_access.Refused`.
    """
    from cramhy_runtime.rosbridge import sessions
    from cramhy_runtime.ros_tools.graph_access import OPEN_PAGE
    from cramhy_runtime.view import page

    shows = page.has_screen() if asked else page.opens_by_itself()
    found = graph.call(OPEN_PAGE, "cramhy_msgs/OpenPage", {"asked": asked, "shows": shows})
    if shows and (asked or not found["seen"]):
        page.show(found["url"], found["port"], sessions.folder())
    return found["url"]


def follow():
    """Lead the browsers that show the page of this process to that of the newest session elsewhere. To be called in a task.

    Where no browser shows it, nothing happens, so that a page opens as it does with a turtle that appears.
    """
    from cramhy_runtime import kernel
    from cramhy_runtime.ros import graph
    from cramhy_runtime.ros.messages import message_class_exact

    here = graph.active()
    if MOVED not in here.topics:
        return
    address = kernel.run_blocking(_address_elsewhere)
    if address is None:
        return
    text = message_class_exact("std_msgs/String")
    told = here.node("cramhy_moved", hidden=True).advertise(MOVED, text)
    told.publish(text(data=address))
    until = kernel.now() + PATIENCE
    while told.connections and kernel.now() < until:
        kernel.sleep(0.02)


def _address_elsewhere():
    """The address of the page of the newest session, which opens there; ``None`` if that offers none."""
    from cramhy_runtime.rosbridge import sessions
    from cramhy_runtime.ros_tools.graph_access import OPEN_PAGE, NoSession, Refused, SessionEnded
    from cramhy_runtime.ros_tools.remote_graph import ThereGraph

    try:
        found = sessions.current()
        if found is None or found.pid == os.getpid():
            return None
        graph = ThereGraph(found.host, found.port, found.token, found.pid)
        try:
            return graph.call(OPEN_PAGE, "cramhy_msgs/OpenPage", {"asked": False, "shows": True})["url"]
        finally:
            graph.close()
    except (sessions.Unsafe, NoSession, Refused, SessionEnded):
        return None


def _tell(text):
    """Print a line, but not into one that is being typed: then another terminal has started the simulator, and tells the address there."""
    from cramhy_runtime import kernel

    if kernel.pace().busy:
        print(f"; {text}", file=sys.stderr, flush=True)
