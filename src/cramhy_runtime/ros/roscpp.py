"""The common part of all programs that ``rosrun`` starts: a roscpp node with a command line, loggers, and a log on its terminal.

A program starts in the active graph as ``rosrun`` would start it in its own process. On its command line, ``__name:=sim``,
``__ns:=/left``, ``turtle1/cmd_vel:=turtle2/cmd_vel`` and ``_background_r:=150`` mean the same as in ROS. `Program.lines` keeps the
lines that the original prints in its terminal; ``echo`` says where to print them. Source: turtlesim.md 1, 3; wiki.ros.org/Remapping
Arguments.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from . import graph, names, rosout
from .loggers import Loggers
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .signatures import Echo, Words


LABELS = {rosout.DEBUG: "DEBUG", rosout.INFO: " INFO", rosout.WARN: " WARN", rosout.ERROR: "ERROR"}
MOST_LINES = 1_000
MOST_TEXT = 2000  # characters of a line: it may hold a name that a client of another process has made up
_FIRST = ("__ns", "__name")


class Program:
    """A running executable. ``node``: its node. ``lines``: the last lines of its log, at most `MOST_LINES`.

    ``name``, ``namespace``: of the node, unless ``arguments`` say otherwise. ``arguments``: the words of a command line, or one string.
    ``spins``: see `graph.Node`. ``echo``: ``True`` prints the log to stderr; a stream, to the stream; a function gets each line
    without its end. As in ROS, a node of the same name is shut down first. An illegal name is a simple error.
    """

    name = ""
    package = ""
    of_client = False
    """Whether a client of another process has started it."""
    status = 0
    """The exit status with which it ends: not 0 if it could not do its work."""

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), spins: bool = False, echo: Echo = None):
        self.graph = graph.active()
        naming = naming_of(name or self.name, namespace, arguments)
        complaint = names.check_graph_name(naming.node_name)
        if complaint:
            conditions.error(SimpleError("~a", f"A node cannot be called {naming.node_name}. {complaint}"))
        self.node = self.graph.add_node(naming, spins)
        self.node.program = self
        self.echo = echo
        self.lines: list[str] = []
        for parameter, value, _ in reversed(naming.private_parameters):
            self.graph.parameters.set(self.node.resolve(parameter), value)
        rosout.join(self.node)
        self.loggers = Loggers(self.node, self.package)

    @property
    def alive(self) -> bool:
        """Whether the program still runs."""
        return self.node.alive

    def shutdown(self) -> None:
        """End the program: its node leaves the graph."""
        self.node.shutdown()

    def number(self, parameter: str, default: float) -> float:
        """The value of a numeric parameter, as from roscpp's ``param``; ``default`` if it is not set or not a number."""
        try:
            value = self.graph.parameters.get(self.node.resolve(parameter))
        except KeyError:
            return default
        return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else default

    def log(self, level: int, text: str) -> None:
        """Print a log line in roscpp's form and publish it on ``/rosout``, if the node's logger allows ``level``."""
        if not self.loggers.enabled(level):
            return
        if len(text) > MOST_TEXT:
            text = text[:MOST_TEXT] + "..."
        rosout.report(self.node, level, text)
        self._print(f"[{LABELS[level]}] [{self.graph.now():.6f}000]: {text}")  # nanoseconds, as far as a double tells them

    def say(self, text: str) -> None:
        """Print the lines of ``text`` on the program's terminal as they are. They are not part of ``/rosout``."""
        for line in text.splitlines():
            self._print(line[:MOST_TEXT])

    def _print(self, line: str) -> None:
        if len(self.lines) >= MOST_LINES:
            del self.lines[: MOST_LINES // 2]
        self.lines.append(line)
        if callable(self.echo):
            self.echo(line)
        elif self.echo is not None and self.echo is not False:
            print(line, file=sys.stderr if self.echo is True else self.echo)


def plain_words(arguments: Words) -> list[str]:
    """The words of a command line that are for the program: all but ``a:=b``."""
    return [word for word in names.split_arguments(arguments) if ":=" not in word]


def anonymous(name: str) -> str:
    """A name for a node, of which several may run, that no node of the active graph has: ``tf_echo_1413285840000000000``."""
    here = graph.active()
    moment = int(here.now() * 1e9)
    while any(other.rpartition("/")[2] == f"{name}_{moment}" for other in here.nodes):
        moment += 1
    return f"{name}_{moment}"


def naming_of(name: str, namespace: str = "/", arguments: Words = ()) -> names.Naming:
    """The `Naming` of a program that starts with the words ``arguments``; name, namespace: when these do not say otherwise."""
    naming = names.Naming(name, namespace)
    words = names.split_arguments(arguments)
    words.sort(key=_rank)
    naming.apply_arguments(words, names.plain_value)
    return naming


def _rank(word: str) -> int:
    """The rank of a word on the command line: roscpp reads namespace and name before all others."""
    left = word.partition(":=")[0]
    return _FIRST.index(left) if left in _FIRST else len(_FIRST)
