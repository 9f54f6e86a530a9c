"""Programs that run in a session, with their terminals elsewhere: ``rosrun turtlesim draw_square`` from a second terminal.

All nodes of a session live in its process. So ``rosrun`` asks the session to start the program there, prints the lines of its log, which
come on ``/cramhy/program_log``, and ends it with Ctrl-C. A terminal that is killed cannot ask for that: what a client has started ends
with its connection at the latest. The session's page opens when another terminal asks for it. A `Host` offers all that to clients of the
session's server, on a hidden node; it starts nodes of packages that are part of cramhy, and evaluates nothing.
"""

from __future__ import annotations

import os
import sys

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Error
from ..robot_world.al5d.names import NAME, PACKAGE
from ..ros import graph
from ..ros.messages import message_class_exact, service_type_exact
from ..ros.services import OfCaller, Refusal, Service
from ..ros.wire import ros_text
from ..turtlesim import window
from ..turtlesim.node import Turtlesim, start_waiting
from ..ros.roscpp import naming_of
from .executables import complaint
from .executables import start as start_executable

LOG = "/cramhy/program_log"
SERVICES = {
    "start_program": "StartProgram", "feed_program": "FeedProgram", "end_node": "EndNode", "node_process": "NodeProcess",
    "open_page": "OpenPage",
}  # fmt: skip
MOST_ARGUMENTS = 10_000
"""Characters in the arguments of a program that a client starts."""
SHARED = {("turtlesim", "turtlesim_node"): Turtlesim.name, **{(PACKAGE, simulator): NAME for simulator in ("simulator", "manager_node")}}
"""What runs once, and its name: whoever starts it a second time under its name looks on, as at a window."""


class Host:
    """Offers to start, feed and end programs in the active graph."""

    def __init__(self):
        self.graph = graph.active()
        self.node = self.graph.node("cramhy_programs", hidden=True)
        self.line_type = message_class_exact("cramhy_msgs/ProgramLine")
        self.log = self.node.advertise(LOG, self.line_type)
        self._told = set()
        self._parameters = 0  # that programs of clients have added
        for name, kind in SERVICES.items():
            service_type = service_type_exact(f"cramhy_msgs/{kind}")
            handler = self._handler(getattr(self, name), service_type.response)
            made = OfCaller if name == "start_program" else Service
            self.node.add_service(made(self.node, f"/cramhy/{name}", service_type, handler))

    def close(self):
        """Offer nothing more."""
        self.node.shutdown()

    @staticmethod
    def _handler(function, response):
        return lambda request, *caller: response(*function(*request.values(), *caller))

    def start_program(self, package, executable, arguments, caller=None):
        """(name of the node, whether it was there before, its log so far). The program ends with the caller, see `services.start_call`."""
        problem = complaint(package, executable)
        if problem is not None:
            raise Refusal(problem)

        def fail(condition):
            hint = getattr(condition, "hint", None)
            raise Refusal(condition.report() + (f" {hint() if callable(hint) else hint}" if hint else ""))

        def in_ros(function, *words):
            return conditions.handler_case([(Error, fail)], lambda: function(*words))

        there = in_ros(self._simulator_that_is_meant, package, executable, arguments) if (package, executable) in SHARED else None
        if there is not None:
            self.tell(there)
            return there.node.name, True, list(there.lines)
        if caller is not None:
            self._check(arguments, caller)
        before = len(self.graph.parameters.names())
        program = in_ros(start_executable, package, executable, arguments)
        self.tell(program)
        if caller is not None:
            program.of_client = True
            self._parameters += max(0, len(self.graph.parameters.names()) - before)
            caller.at_end.add(program.shutdown)
            program.node.on_shutdown.append(lambda: caller.at_end.discard(program.shutdown))
        return program.node.name, False, list(program.lines)

    def _simulator_that_is_meant(self, package, executable, arguments):
        """The simulator of the session whose name this one would take with these arguments, ``/turtlesim`` for one; else ``None``.

        A plan may be driving the session's own turtle. So whoever starts another one under its name looks on, and ends nothing by Ctrl-C.
        """
        own = SHARED[package, executable]
        naming = naming_of(own, arguments=arguments)
        if naming.node_name != f"/{own}":
            return None
        if own == Turtlesim.name and naming.node_name not in self.graph.nodes:
            start_waiting()
        there = getattr(self.graph.nodes.get(naming.node_name), "program", None)
        if there is None or not (naming.remappings or naming.private_parameters):
            return there
        if not there.of_client:
            raise Refusal(
                f"/{own} is the session's own, and would end if another one took its name. Give yours another name: __name:=other. "
                f"To look on at the session's, leave out the words after {executable}."
            )
        return None

    def _check(self, arguments, caller):
        """Refuse a client that asks for too much: what its programs set stays among the parameters when they end."""
        limits = caller.limits
        if len(caller.at_end) >= limits.programs:
            raise Refusal(f"You have started {len(caller.at_end)} programs that still run; more are not allowed. End some.")
        if sum(map(len, arguments)) > MOST_ARGUMENTS:
            raise Refusal(f"The arguments of the program have {sum(map(len, arguments))} characters; {MOST_ARGUMENTS} are allowed.")
        if self._parameters >= limits.parameters:
            raise Refusal(f"Programs of clients have set {self._parameters} parameters; they may not set more.")

    def tell(self, program):
        """Send the lines of the program's log to the terminals from now on."""
        if program in self._told:
            return
        self._told.add(program)
        before = program.echo
        name = program.node.name

        def echo(line):
            self.log.send(self.line_type(name, ros_text(line), None, 0))
            if callable(before):
                before(line)
            elif before is not None:
                print(line, file=sys.stderr if before is True else before)

        def ended():
            self._told.discard(program)
            if self.node.alive:
                self.log.send(self.line_type(name, "", True, program.status))

        program.echo = echo
        program.node.on_shutdown.append(ended)

    def feed_program(self, name, keys):
        """Hand keys to a program; whether it still runs."""
        program = getattr(self.graph.nodes.get(name), "program", None)
        if program is None:
            return (None,)
        if not hasattr(program, "feed"):
            raise Refusal(f"The program {name} reads no keys.")
        return (True if program.feed(bytes(keys)) else None,)

    def _node(self, name):
        node = self.graph.nodes.get(name)
        if node is None or node.hidden:
            raise Refusal(f"There is no node {name}.")
        return node

    def end_node(self, name):
        """End a node."""
        self._node(name).shutdown()
        return ()

    def node_process(self, name):
        """(number of the process whose node it is)."""
        return (self._node(name).process or os.getpid(),)

    def open_page(self, asked, shows):
        """(address of the session's page, its port, whether a browser was opened for it before); the page opens if it is not open yet."""
        try:
            page = window.page(show=False, asked=asked is True)
        except window.NoPage as problem:
            raise Refusal(str(problem)) from None
        seen = page.seen
        page.seen = seen or shows is True
        return page.url, page.port, seen or None
