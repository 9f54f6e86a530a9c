"""What a session opens to the outside when an option asks for it: the server, the page, the recorder, a real ROS, a picture.

Each is a room of its own, whose parts are imported when it is asked for, so that a session that opens nothing pays nothing. What an
option needs and is not installed is named before the session begins, with the extra that brings it. Everything that was opened is
closed when the session has ended, the last first, and after the plan's cleanup, which may still have something to tell (law 2).
"""

from __future__ import annotations

import os
import sys
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from cramhy_runtime import chronicle, rosbridge, storage, view
from cramhy_runtime.extras import install_command

from . import heap, robot_address

NEEDS = {
    "serve": ("web", ("uvicorn", "websockets")),
    "view": ("web", ("uvicorn", "websockets")),
    "replay": ("web,record", ("uvicorn", "websockets", "mcap")),
    "record": ("record", ("mcap",)),
    "ros": ("ros", ("roslibpy",)),
    "lsp": ("lsp", ("pygls",)),
    "jupyter": ("jupyter", ("ipykernel", "jupyter_client")),
    "greenlet": ("fast", ("greenlet",)),
}
"""The extra that an option needs, and its modules that have to be there."""


class NotPossible(Exception):
    """Something that was asked for cannot be had: the text says what, why, and what to do."""


def require(what, asked):
    """Make sure that the modules for ``what`` are installed, which the user asked for with the words ``asked``."""
    extra, modules = NEEDS[what]
    missing = [module for module in modules if find_spec(module) is None]
    if missing:
        verb = "is" if len(missing) == 1 else "are"
        raise NotPossible(
            f"{asked} needs {', '.join(modules)}, and {', '.join(missing)} {verb} not installed. Type: {install_command(extra)}"
        )


def check(options):
    """Complain of what cannot be done before anything begins; see `NotPossible`."""
    for option in ("record", "ros", "picture"):
        if getattr(options, option, None) == "":  # as from a shell's variable that is not set
            raise NotPossible(f"--{option} is given an empty word. Give it what it needs, or leave it out.")
    asked_for = "--ros" if options.ros else robot_address.ADDRESS
    try:
        options.ros = robot_address.chosen(options.ros, options.ros_token)
    except robot_address.Unusable as problem:
        raise NotPossible(str(problem)) from None
    if getattr(options, "picture", None):
        from cramhy_runtime.turtlesim import pictures

        if not pictures.is_picture(options.picture):
            raise NotPossible(
                f"--picture {options.picture}: a picture is written as .png or .svg; .gif and .replay.svg show the whole way."
            )
    for option in ("record", "picture"):
        path = getattr(options, option, None)
        if path and not Path(path).absolute().parent.is_dir():
            raise NotPossible(f"--{option} {path}: there is no folder {Path(path).absolute().parent}.")
    if options.port is not None and not (options.serve or options.view):
        raise NotPossible("--port says where --serve and --view listen; give one of them, too.")
    if getattr(options, "origin", None) and not (options.serve or options.view):
        raise NotPossible("--origin says whose pages may connect to --serve and --view; give one of them, too.")
    for what in ("serve", "view", "record", "ros"):
        if getattr(options, what):
            require(what, asked_for if what == "ros" else f"--{what}")


def open_session(options, closings):
    """Open what ``options`` ask for, in the session that has just begun. ``closings`` is an `contextlib.ExitStack`."""
    if options.record or options.ros or options.view or options.serve:
        heap.keep_small()
    tidy(os.getcwd)
    if getattr(options, "picture", None):
        tidy(lambda: os.path.dirname(os.path.realpath(options.picture)))
    if options.record:
        closings.callback(chronicle.record(options.record, program_of(options)).close)
    if options.ros:
        with server_errors_told():
            closings.callback(rosbridge.attach(options.ros).close)
    if getattr(options, "picture", None):
        from cramhy_runtime.turtlesim import pictures

        if pictures.is_replay(options.picture):  # it shows what happened from the beginning
            pictures.keep_history()
    if options.view or options.serve:
        server, _ = serve(closings, options.port, options.view, options.origin)
        if not options.view:
            print(f"; Clients of rosbridge: {server.address}", file=sys.stderr, flush=True)


def tidy(folder):
    """Remove or recover what killed processes left in the folder that ``folder()`` gives; a line tells of recordings."""
    try:
        recovered = storage.tidy(folder())
    except OSError:
        return  # the working folder is gone
    for path in recovered:
        print(f"; A recording was cut off when its process was killed. It is now {path}", file=sys.stderr, flush=True)


@contextmanager
def server_errors_told():
    """A server that cannot start, or be reached, is something that cannot be had."""
    from cramhy_runtime.rosbridge.server import ServerError

    try:
        yield
    except ServerError as problem:
        raise NotPossible(str(problem)) from None


def program_of(options):
    """The files and systems that the options have loaded, in that order."""
    return [*options.load, *([options.file] if getattr(options, "file", None) else [])]


def serve(closings, port=None, with_page=False, origins=()):
    """Start the server, with the page when ``with_page`` says so, and let other terminals start programs here; the page's address is told.

    origins: pages of other servers that may connect. Returns the server, or the page, and the `Host`; raises `NotPossible`.
    """
    from cramhy_runtime import kernel
    from cramhy_runtime.ros_tools.hosting import Host

    with server_errors_told():
        server = rosbridge.start(port=port, origins=tuple(origins))
        closings.callback(server.close)
        host = Host()
        if with_page:  # it takes the server that there is
            server = view.start()
            closings.callback(server.close)
    if with_page:
        print(f"; The page: {server.url}", file=sys.stderr, flush=True)
        if kernel.pace().virtual:
            print(
                "; Virtual time passes as the wall's does, so that there is something to see; the page can change its speed.",
                file=sys.stderr,
                flush=True,
            )
    return server, host


def save_picture(path):
    """Write what the turtle's window shows now, or how it came about, into the file ``path``; a problem is told, and ends the process."""
    from cramhy_runtime.lisp_core.conditions import Condition
    from cramhy_runtime.repl.console import report
    from cramhy_runtime.repl.session import condition_of
    from cramhy_runtime.turtlesim import pictures

    try:
        pictures.save(path)
    except (Exception, Condition) as problem:
        report(condition_of(problem))
        sys.exit(1)
