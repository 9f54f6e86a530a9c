"""The page of a session: its files, its server, its address, and the browser that shows it.

The address ends in ``#`` and the token. Browsers send that part to nobody, so it is in no log and in no header; the page takes the token
from there and says it as the first message on its WebSocket. A browser is never started with that address, since every user of the
machine can read the arguments of programs: it is given a file that only this user can read, which leads to the page.

The page opens by itself where the slides open the window of turtlesim, if a person sits there: at a terminal, on a desktop, and not in a
test, in CI, in a notebook or over SSH (`opens_by_itself`). The variable CRAMHY_VIEW switches that off.
"""

from __future__ import annotations

import html
import json
import os
import subprocess
import sys
from importlib import resources
from pathlib import Path

from .. import chronicle, kernel, rosbridge, storage
from ..kernel.images import per_image
from ..turtlesim import window

TYPES = {"html": "text/html", "js": "text/javascript", "css": "text/css", "svg": "image/svg+xml", "json": "application/json"}
VARIABLE = "CRAMHY_VIEW"
OFF = ("no", "off", "false", "0")
"""What the variable says so that no page opens by itself."""
UNATTENDED = ("CI", "PYTEST_CURRENT_TEST", "PYTEST_VERSION", "JPY_PARENT_PID")
"""Variables of surroundings in which nobody looks at a screen: CI, pytest, Jupyter."""


def files():
    """What the server gives out: a dictionary from paths, such as ``"/app.js"``, to pairs of bytes and a media type."""
    from ..turtlesim.drawing import shapes

    found = dict(_within(resources.files(__package__).joinpath("static"), "/"))
    found["/"] = found["/index.html"]
    found["/shapes.json"] = (json.dumps(shapes(), separators=(",", ":")).encode(), TYPES["json"])
    return found


def _within(folder, path):
    for file in folder.iterdir():
        if file.is_dir():
            yield from _within(file, f"{path}{file.name}/")
        else:
            yield path + file.name, (file.read_bytes(), TYPES[file.name.rpartition(".")[2]])


class Page:
    """The page of the active session. ``url``: its address, with the token. ``port``, ``token``: of ``server``, the rosbridge server.

    ``seen``: whether a browser was opened for it. ``watched``: whether virtual time was slowed down for it. ``closed``: whether it has
    ended.
    """

    def __init__(self, server, own):
        self.server, self._own = server, own
        self.url, self.port, self.token = server.url, server.port, server.token
        self.seen = self.watched = self.closed = False
        server.kernel.at_stop(self.close)

    def open(self):
        """Show the page in the user's browser; whether there is one."""
        opened = show(self.url, self.port, self.server.file.parent)
        self.seen = self.seen or opened
        return opened

    def close(self):
        """End the page, and the server if it was started for it. Does nothing a second time."""
        if self.closed:
            return
        self.closed = True
        self.server.kernel.not_at_stop(self.close)
        way(self.port, self.server.file.parent).unlink(missing_ok=True)
        chronicle.stop()
        if not self.server.kernel.stopped and kernel.active() is self.server.kernel and kernel.pace().virtual:
            kernel.pace().set_speed(None)
            kernel.pace().resume()
        if self._own:
            self.server.close()
        else:
            self.server.pages = {}


_pages = per_image({})  # the kernel that is active -> its page


def running():
    """The page of the active session, or ``None``."""
    found = _pages.get(kernel.active())
    return None if found is None or found.closed or found.server.closed else found


def start(session=None, port=None, open_browser=True, watched=True):
    """Show the active session in a page; the `Page`, the same one when it is open already.

    session: the active one, or its kernel. port: where to listen on loopback, ``None`` or 0 for a free one. open_browser: whether to open
    the page in a browser, where a person sits at a screen. watched: whether virtual time passes as the wall's from now on, so that there is
    something to see; the page can let it go as fast as the machine computes. A server that the session has already is used. Errors:
    `rosbridge.server.ServerError` when the server cannot start.
    """
    page = running()
    if page is None or port and port != page.port:
        page = _start(session, port)
    if watched and not page.watched:  # once: a user who lets it go faster on the page may ask for the page again
        page.watched = True
        if kernel.pace().virtual and kernel.pace().speed is None:
            kernel.pace().set_speed(1.0)
    if open_browser and sys.stderr is not None and sys.stderr.isatty():
        page.open()
    return page


def _start(session, port):
    from ..rosbridge import server

    there = server.running()
    found = there if there is not None and not port else rosbridge.start(session, port, files())
    if found is there:
        found.pages = files()
    chronicle.start()
    _pages.clear()  # those of kernels before are closed
    page = _pages[kernel.active()] = Page(found, found is not there)
    _let_others_ask()
    return page


def _let_others_ask():
    """Let other terminals, and ``turtlesim.view()``, ask for the page, also in a program that offers nothing else."""
    from ..ros import graph
    from ..ros_tools.graph_access import OPEN_PAGE
    from ..ros_tools.hosting import Host

    if not window.offered():
        window.offer(lambda show, asked: start(open_browser=show, watched=asked))
    if OPEN_PAGE not in graph.active().services:
        Host()


# ---------------------------------------------------------------------------------------------------------- the browser


def has_screen():
    """Whether a browser would have a window that the user sees: else a browser of the terminal would take that from the prompt."""
    if sys.platform in ("darwin", "win32"):
        return not (os.environ.get("SSH_CONNECTION") or os.environ.get("SSH_TTY"))
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def at_a_terminal():
    """Whether a person types and reads here."""
    return all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stderr))


def opens_by_itself():
    """Whether the page opens in a browser where nobody has asked for it: a person sits at a desktop, and has not switched that off."""
    if os.environ.get(VARIABLE, "").lower() in OFF or any(map(os.environ.get, UNATTENDED)):
        return False
    return at_a_terminal() and has_screen()


def show(url, port, folder):
    """Show the page ``url`` of the session on ``port`` in the user's browser; whether there is one. folder: one of this user's alone."""
    if not has_screen():
        return False
    path = way(port, folder)
    try:
        storage.write_whole(
            path,
            f'<!doctype html><meta charset="utf-8"><title>cramhy</title><meta http-equiv="refresh" content="0; url={html.escape(url)}">\n',
            mode=0o600,
            durable=False,
            follow=False,
        )
        browse(path.as_uri())
    except OSError:
        return False  # the page's address has been told, and can be opened by hand
    return True


_browsers = []  # processes that open browsers; each is kept until it has ended, so that the system forgets it


def browse(address):
    """Open ``address`` in the user's browser (webbrowser of Python's library, which the variable BROWSER tells which one).

    A process of its own does that. Some browsers keep the program that starts them for seconds, and what they print, or a browser of the
    terminal, would disturb the prompt. Raises OSError.
    """
    _browsers[:] = [process for process in _browsers if process.poll() is None]
    _browsers.append(
        subprocess.Popen(
            [sys.executable, "-I", "-m", "webbrowser", address],  # -I: a webbrowser.py of the current folder is another one
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,  # Ctrl-C at the prompt does not end it
        )
    )


def way(port, folder):
    """The file that leads a browser to the page of the session on ``port``."""
    return Path(folder) / f"page-{port}.html"
