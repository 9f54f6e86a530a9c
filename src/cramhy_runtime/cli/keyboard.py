"""``cramhy teleop``, ``rosrun turtlesim turtle_teleop_key``: the keys of this terminal drive a turtle of the session.

The node runs in the session, as any other (`ros_tools.hosting`); the terminal hands it what is typed, key by key, without echo. Whatever
ends the program, and when it is stopped and goes on, the terminal is left as it was found. Source: turtlesim.md 10.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import contextmanager

from cramhy_runtime.lisp.streams.console_ready import readable

PACE = 0.1  # s between two looks whether the session is still there


def teleop(words=()):
    """Drive with the arrow keys until ``q``, the end of the input or Ctrl-C; the exit status. words: of the node's command line."""
    from cramhy_runtime.kernel import signals
    from cramhy_runtime.kernel.errors import Terminated
    from cramhy_runtime.ros_tools import there
    from cramhy_runtime.ros_tools.reach import NoSession, Refused, SessionEnded
    from cramhy_runtime.ros_tools.running import NO_SESSION
    from cramhy_runtime.turtlesim.teleop import BANNER

    try:
        graph = there.current()
    except NoSession as problem:
        print(f"ERROR: Unable to communicate with master!\n{str(problem) or NO_SESSION}", file=sys.stderr)
        return 1
    node = None
    try:
        node = graph.call("/cramhy/start_program", "", {
            "package": "turtlesim", "executable": "turtle_teleop_key", "arguments": list(words)})["node"]
        print(BANNER, end="", flush=True)
        with keys_one_by_one():
            while True:
                ready = readable(0, PACE) in (True, None)  # None: the system cannot tell, and reading waits
                typed = os.read(0, 1024) if ready else b""
                if ready and not typed:
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


@contextmanager
def keys_one_by_one():
    """Within it the terminal hands over each key at once, and shows none; where standard input is no terminal, or the system has
    no ``termios``, nothing changes."""
    try:
        import termios
    except ImportError:  # not on this system, whose terminal hands over whole lines
        termios = None
    if termios is None or not os.isatty(0):
        yield
        return

    before = termios.tcgetattr(0)

    def begin(*_):
        changed = termios.tcgetattr(0)
        changed[3] &= ~(termios.ICANON | termios.ECHO)
        termios.tcsetattr(0, termios.TCSADRAIN, changed)

    saved = signal.signal(signal.SIGCONT, begin)  # the shell had the terminal meanwhile
    begin()
    try:
        yield
    finally:
        signal.signal(signal.SIGCONT, saved)
        try:
            termios.tcsetattr(0, termios.TCSADRAIN, before)
        except termios.error:
            pass  # the terminal has gone
