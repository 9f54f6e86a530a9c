"""A ROS command from its words to its exit status, and the terminal that it writes to.

What a command prints goes out line by line as it comes; what it complains of goes to the other stream, so that a pipe stays clean.
Ctrl-C is the ordinary end of a command that goes on for ever. Modules are imported when a command of theirs is named.
"""

from __future__ import annotations

import importlib
from queue import Empty, SimpleQueue

from . import arguments as words
from .graph_access import NoSession, Refused, SessionEnded
from .arguments import CommandError

_HOMES = {
    "rosmsg": {"types": ()}, "rossrv": {"types": ()}, "rosnode": {"nodes": ()}, "rosparam": {"parameters": ()},
    "rosservice": {"calling": ()},
    "rostopic": {"topics": ("list", "type", "info", "find"), "topic_echo": ("echo", "hz", "bw"), "publishing": ("pub",)},
}  # fmt: skip
"""The modules of each tool, with the commands in each where there are several."""
TOOLS = tuple(_HOMES)
NO_SESSION = 'No session serves here. Start one with: roslisp_repl --serve (after eval "$(cramhy ros-shims)" plain roslisp_repl does it).'


LOOK_AGAIN = 0.5  # s between two looks for a session to join again


class Terminal:
    """Where a command writes, and the graph that it works on.

    write, complain: functions of a text. reach: a function that gives the `Graph` when it is needed, or raises `NoSession`.
    """

    def __init__(self, write, complain, reach):
        self.write, self.complain = write, complain
        self._reach = reach
        self._graph = None

    def line(self, text=""):
        """Write a line."""
        self.write(text + "\n")

    @property
    def graph(self):
        if self._graph is None:
            self._graph = self._reach()
        return self._graph

    def rejoin(self, problem):
        """The session has gone, or the connection to it (``problem``): wait until one is announced, and go on with its graph."""
        self._graph.close()
        self._graph = None
        self.complain(f"; {problem} Waiting for a session to join; Ctrl-C ends.\n")
        told = ""
        while self._graph is None:
            try:
                self._graph = self._reach()
            except NoSession as why:
                if str(why) not in ("", told):
                    told = str(why)
                    self.complain(f"; {told}\n")
                pause(LOOK_AGAIN)
        self.complain(f"; Joined the session of process {self._graph.pid}.\n")

    def close(self):
        """Let go of the graph."""
        if self._graph is not None:
            self._graph.close()


def pause(seconds):
    """Wait, in a process that has no kernel."""
    try:
        SimpleQueue().get(timeout=seconds)
    except Empty:
        pass


def run(command_words, terminal):
    """Carry out a command, given as a list of words (``["rosservice", "call", "/clear"]``); the exit status."""
    homes = _HOMES[command_words[0]]
    for home in [home for home, names in homes.items() if command_words[1:2] and command_words[1] in names] or homes:
        importlib.import_module(f".{home}", __package__)
    try:
        command = words.found(command_words)
        return command.function(terminal, *words.parsed(command, command_words[2:])) or 0
    except CommandError as problem:
        (terminal.complain if problem.status else terminal.write)(problem.text and problem.text + "\n")
        return problem.status
    except NoSession as problem:
        terminal.complain(f"ERROR: Unable to communicate with master!\n{str(problem) or NO_SESSION}\n")
        return 1
    except (Refused, SessionEnded) as problem:
        terminal.complain(f"ERROR: {problem}\n")
        return 1
    except KeyboardInterrupt:
        return 0
    finally:
        terminal.close()
