"""A static host on loopback, which shows a site on the machine that made it. Any other static host does as well.

It serves the files of one folder, which are public anyway, and nothing else. So it asks for no token.
"""

from __future__ import annotations

import functools
import http.server
import os
from pathlib import Path

from .site import SiteError

TYPES = {".mjs": "text/javascript", ".js": "text/javascript", ".wasm": "application/wasm", ".json": "application/json"}
"""A browser runs scripts of these types only, and a system's own list may say something else."""


class Handler(http.server.SimpleHTTPRequestHandler):
    """Serves a folder, and prints nothing."""

    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, **TYPES}

    def log_message(self, *_):
        pass

    def list_directory(self, path):
        self.send_error(404)


def open_host(folder: str | os.PathLike[str], port: int | None = None) -> http.server.ThreadingHTTPServer:
    """A host of the site in ``folder``; its ``serve_forever`` serves it.

    port: where it listens on loopback, ``None`` for a free one. Errors: `SiteError` if there is no site, or if the port is taken.
    """
    folder = Path(folder)
    if not (folder / "worker.mjs").is_file():
        raise SiteError(f"There is no site of cramhy in {folder}. Write one with: cramhy browser --out {folder}")
    try:
        return http.server.ThreadingHTTPServer(("127.0.0.1", port or 0), functools.partial(Handler, directory=str(folder)))
    except OSError as problem:
        raise SiteError(f"Port {port} cannot be used: {problem.strerror}. Name another one, or none.") from problem


def address(host: http.server.ThreadingHTTPServer) -> str:
    """Where a browser finds it."""
    return f"http://127.0.0.1:{host.server_port}/"
