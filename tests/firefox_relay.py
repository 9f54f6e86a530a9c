"""Firefox as Playwright can drive it: the program that Playwright starts in its place.

Playwright drives a Firefox of Debian's or Mozilla's by WebDriver BiDi. At the start it chooses a colour scheme, by a command that Firefox 153
does not have yet, and gives up when that fails. So this program starts Firefox, which takes all its arguments, and hands the messages on in both
directions; it answers that command itself. `browsers.firefox` makes the program: its first argument is the path of Firefox.
"""

from __future__ import annotations

import asyncio
import json
import re
import sys

import websockets

UNKNOWN = "emulation.setMediaFeaturesOverride"
LISTENS = re.compile(r"WebDriver BiDi listening on (ws://\S+)")


async def hand_on(source, target, answered=None):
    """Hand messages from SOURCE on to TARGET. Those whose command is unknown to Firefox are answered to SOURCE."""
    try:
        async for message in source:
            if answered and UNKNOWN in message and (told := json.loads(message)).get("method") == UNKNOWN:
                await source.send(json.dumps({"type": "success", "id": told["id"], "result": {}}))
            else:
                await target.send(message)
    except websockets.ConnectionClosed:
        pass
    await target.close()


async def main():
    firefox = await asyncio.create_subprocess_exec(*sys.argv[1:], stderr=asyncio.subprocess.PIPE)
    inner = None

    async def serve(client):
        async with websockets.connect(inner + client.request.path, max_size=None) as behind:
            await asyncio.gather(hand_on(client, behind, answered=True), hand_on(behind, client))

    async with websockets.serve(serve, "127.0.0.1", 0, max_size=None) as server:
        port = server.sockets[0].getsockname()[1]
        while line := (await firefox.stderr.readline()).decode(errors="replace"):
            if found := LISTENS.search(line):
                inner, line = found[1], f"WebDriver BiDi listening on ws://127.0.0.1:{port}\n"
            sys.stderr.write(line)
            sys.stderr.flush()
        return await firefox.wait()


if __name__ == "__main__":
    sys.exit(asyncio.run(main()))
