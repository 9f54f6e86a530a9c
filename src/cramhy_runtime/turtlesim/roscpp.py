"""What the executables of the package have in common: a roscpp node with a command line, loggers, and a log on its terminal.

A program starts in the active graph as ``rosrun`` would start it in a process of its own: ``__name:=sim``, ``__ns:=/left``,
``turtle1/cmd_vel:=turtle2/cmd_vel`` and ``_background_r:=150`` on its command line mean what they mean in ROS. What the original
prints in its terminal is kept in `Program.lines`, and printed where ``echo`` says. Source: turtlesim.md 1, 3; wiki.ros.org/Remapping
Arguments.
"""

from __future__ import annotations

import sys

from cramhy_runtime.ground import conditions
from cramhy_runtime.ground.condition_types import SimpleError
from ..ros import graph, names, rosout
from ..ros.loggers import Loggers
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .signatures import Echo, Words


LABELS = {rosout.DEBUG: "DEBUG", rosout.INFO: " INFO", rosout.WARN: " WARN", rosout.ERROR: "ERROR"}
MOST_LINES = 1_000
MOST_TEXT = 2000  # characters of a line: it may hold a name that a client of another process has made up
_FIRST = ("__ns", "__name")


class Program:
    """A running executable. ``node`` is its node, ``lines`` its log (the last 5,000 to 10,000 lines), ``alive`` until it ends.

    name, namespace: of the node, when ``arguments`` do not say otherwise. arguments: the words of a command line, or one string.
    spins: see `graph.Node`. echo: ``True`` prints the log to stderr, a stream there, a function gets each line without its end.
    A node of the same name is shut down first, as ROS does. A name that is none is a simple error.
    """

    name = ""
    package = "turtlesim"
    of_client = False
    """Whether a client of another process has started it."""

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
        return self.node.alive

    def shutdown(self) -> None:
        """Leave the graph."""
        self.node.shutdown()

    def number(self, parameter: str, default: float) -> float:
        """The value of a parameter as roscpp's ``param`` reads a number; ``default`` when it is not set or something else."""
        try:
            value = self.graph.parameters.get(self.node.resolve(parameter))
        except KeyError:
            return default
        return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else default

    def log(self, level: int, text: str) -> None:
        """A log line as roscpp prints it, and a message on ``/rosout``; nothing when the node's logger is less talkative."""
        if not self.loggers.enabled(level):
            return
        if len(text) > MOST_TEXT:
            text = text[:MOST_TEXT] + "..."
        line = f"[{LABELS[level]}] [{self.graph.now():.6f}000]: {text}"  # nanoseconds, as far as a double tells them
        if len(self.lines) >= MOST_LINES:
            del self.lines[: MOST_LINES // 2]
        self.lines.append(line)
        rosout.report(self.node, level, text)
        if callable(self.echo):
            self.echo(line)
        elif self.echo is not None:
            print(line, file=sys.stderr if self.echo is True else self.echo)


def naming_of(name: str, namespace: str = "/", arguments: Words = ()) -> names.Naming:
    """The `Naming` of a program that starts with the words ``arguments``; name, namespace: when these do not say otherwise."""
    naming = names.Naming(name, namespace)
    words = names.split_arguments(arguments)
    words.sort(key=_rank)
    naming.apply_arguments(words, names.plain_value)
    return naming


def _rank(word: str) -> int:
    """To roscpp name space and name count before all other words of a command line."""
    left = word.partition(":=")[0]
    return _FIRST.index(left) if left in _FIRST else len(_FIRST)
