"""``cramhy teleop``, ``rosrun turtlesim turtle_teleop_key``: the keys of this terminal drive a turtle of the session.

The node runs in the session, as any other (`ros_tools.hosting`); the terminal hands it what is typed, key by key, without echo. Whatever
ends the program, and when it is stopped and goes on, the terminal is left as it was found. Source: turtlesim.md 10.
"""

from __future__ import annotations

import sys

PACE = 0.1  # s between two looks whether the session is still there


def teleop(words=()):
    """Drive with the arrow keys until ``q``, the end of the input or Ctrl-C; the exit status. words: of the node's command line."""
    from cramhy_runtime.kernel import signals
    from cramhy_runtime.kernel.errors import Terminated
    from cramhy_runtime.kernel.terminals import keys_one_by_one
    from cramhy_runtime.ros_tools import remote_graph
    from cramhy_runtime.ros_tools.graph_access import NoSession, Refused, SessionEnded
    from cramhy_runtime.ros_tools.running import NO_SESSION
    from cramhy_runtime.turtlesim.teleop import BANNER

    try:
        graph = remote_graph.current()
    except NoSession as problem:
        print(f"ERROR: Unable to communicate with master!\n{str(problem) or NO_SESSION}", file=sys.stderr)
        return 1
    node = None
    try:
        node = graph.call(
            "/cramhy/start_program", "", {"package": "turtlesim", "executable": "turtle_teleop_key", "arguments": list(words)}
        )["node"]
        print(BANNER, end="", flush=True)
        with keys_one_by_one() as read:
            while True:
                typed = read(PACE)
                if typed == b"":
                    return 0
                if typed:
                    if not graph.call("/cramhy/feed_program", "", {"node": node, "keys": list(typed)})["alive"]:
                        return 0
                else:
                    graph.receive(graph.now())
    except Refused as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return 2
    except SessionEnded as problem:
        print(f"ERROR: {problem}", file=sys.stderr)
        node = None
        return 1
    except (KeyboardInterrupt, Terminated):
        signals.answered()
        return 0
    finally:
        if node is not None:
            try:
                graph.kill(node)
            except (Refused, SessionEnded):
                pass  # it has ended by itself
        graph.close()
