"""A session with a server in a process of its own, for tests that kill, stop and shut in such processes. It says where it listens, as JSON
in one line, and goes on until the end of its input."""

import json
import os
import sys

from cramhy_runtime import kernel, rosbridge
from cramhy_runtime.session import boot
from cramhy_runtime.rosbridge.guard import Limits
from cramhy_runtime.rosbridge.server import ServerError


def main(limits="{}", pages="{}", time="wall"):
    kernel.start(clock=time)
    boot()
    from cramhy_runtime.ros_tools.hosting import Host
    from cramhy_runtime.turtlesim.node import start_turtlesim

    start_turtlesim()
    try:
        server = rosbridge.start(pages=json.loads(pages), limits=Limits(**json.loads(limits)), port=int(os.environ.get("TEST_PORT", "0")))
    except ServerError as problem:
        print(json.dumps({"problem": str(problem)}), flush=True)
        return
    Host()
    print(
        json.dumps({"port": server.port, "token": server.token, "address": server.address, "file": str(server.file), "pid": os.getpid()}),
        flush=True,
    )
    kernel.run_blocking(sys.stdin.read)
    kernel.stop()


main(*sys.argv[1:])
