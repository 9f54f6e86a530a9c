"""The page of a session: its files, its server, its address, and the browser that shows it.

The address ends in ``#`` and the token. Browsers send that part to nobody, so it is in no log and in no header; the page takes the token
from there and says it as the first message on its WebSocket. A browser is never started with that address, since every user of the
machine can read the arguments of programs: it is given a file that only this user can read, which leads to the page.
"""

from __future__ import annotations

import html
import json
import os
import sys
import webbrowser
from importlib import resources
from pathlib import Path

from .. import chronicle, kernel, rosbridge, storage

TYPES = {"html": "text/html", "js": "text/javascript", "css": "text/css", "svg": "image/svg+xml", "json": "application/json"}


def files():
    """What the server gives out: a dictionary from paths, such as ``"/app.js"``, to pairs of bytes and a media type."""
    from ..turtlesim.drawing import shapes

    found = {
        f"/{file.name}": (file.read_bytes(), TYPES[file.name.rpartition(".")[2]])
        for file in resources.files(__package__).joinpath("static").iterdir()
    }
    found["/"] = found["/index.html"]
    found["/shapes.json"] = (json.dumps(shapes(), separators=(",", ":")).encode(), TYPES["json"])
    return found


class Page:
    """The page of the active session. ``url``: its address, with the token. ``port``, ``token``: of ``server``, the rosbridge server."""

    def __init__(self, server, own):
        self.server, self._own = server, own
        self.url, self.port, self.token = server.url, server.port, server.token

    def open(self):
        """Show the page in the user's browser; whether there is one."""
        return show(self.url, self.port, self.server.file.parent)

    def close(self):
        """End the page, and the server if it was started for it. Does nothing a second time."""
        way(self.port, self.server.file.parent).unlink(missing_ok=True)
        chronicle.stop()
        if not self.server.kernel.stopped and kernel.active() is self.server.kernel and kernel.pace().virtual:
            kernel.pace().set_speed(None)
            kernel.pace().resume()
        if self._own:
            self.server.close()
        else:
            self.server.pages = {}


def start(session=None, port=None, open_browser=True):
    """Show the active session in a page; the `Page`.

    session: the active one, or its kernel. port: where to listen on loopback, ``None`` or 0 for a free one. open_browser: whether to open
    the page in a browser, where a person sits at a screen. A server that the session has already is used for it. Virtual time passes as
    the wall's from now on, so that there is something to see; the page can let it go as fast as the machine computes. Errors:
    `rosbridge.server.ServerError` when the server cannot start.
    """
    from ..rosbridge import server

    running = server.running()
    found = running if running is not None and not port else rosbridge.start(session, port, files())
    if found is running:
        found.pages = files()
    chronicle.start()
    if kernel.pace().virtual and kernel.pace().speed is None:
        kernel.pace().set_speed(1.0)
    page = Page(found, found is not running)
    if open_browser and sys.stderr.isatty():
        page.open()
    return page


def has_screen():
    """Whether a browser would have a window: else a browser of the terminal would take that from the prompt."""
    return sys.platform in ("darwin", "win32") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


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
    except OSError:
        return False  # the page's address has been told, and can be opened by hand
    return webbrowser.open(path.as_uri())


def way(port, folder):
    """The file that leads a browser to the page of the session on ``port``."""
    return Path(folder) / f"page-{port}.html"
