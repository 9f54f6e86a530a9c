"""``cramhy lsp``: the language server, which an editor starts and talks to at standard input and output."""

from __future__ import annotations

import sys

from . import servers


def run():
    """Serve until the editor ends it. Returns the status of the process."""
    try:
        servers.require("lsp", "cramhy lsp")
    except servers.NotPossible as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
    from cramhy_runtime.lsp import server

    return server.run()
