"""The node ``/turtlesim``: topics, services and parameters around the turtles' world.

It spins once per tick of 16 ms: first the commands and requests that arrived, then one update of every turtle in the order of
their names. So a response comes before the update of its tick, and of several commands within a tick the last one counts.
The first tick only looks at the time. What nobody subscribes to is not computed. The log, which the original prints in a
terminal of its own, is in `Turtlesim.lines` and on ``/rosout``. Source: turtlesim.md 3, 4, 8.
"""

from __future__ import annotations

import math
import sys

from .. import kernel
from ..lisp.data import DoubleFloat
from ..ros import graph, logging, wire
from ..ros.messages import message_class_exact, service_type_exact
from ..ros.names import check_graph_name
from ..ros.services import Refusal
from . import canvas
from .canvas import METRE, Canvas
from .world import CENTRE, TICK, Turtle

BACKGROUND = (("background_r", 69), ("background_g", 86), ("background_b", 255))
LABELS = {logging.INFO: " INFO", logging.WARN: " WARN", logging.ERROR: "ERROR"}
MOST_LINES = 10_000
_double = DoubleFloat


class Inhabitant:
    """A turtle with its topics and services."""

    def __init__(self, simulator, turtle):
        node, name = simulator.node, turtle.name
        self.turtle = turtle
        self.pose = node.advertise(f"{name}/pose", simulator.pose_type)
        self.colour = node.advertise(f"{name}/color_sensor", simulator.colour_type)
        self.commands = node.subscribe(f"{name}/cmd_vel", message_class_exact("geometry_msgs/Twist"), self._command, queue=1)
        self.services = [
            node.serve(f"{name}/{service}", service_type_exact(f"turtlesim/{kind}"), handler)
            for service, kind, handler in (
                ("set_pen", "SetPen", self._set_pen),
                ("teleport_absolute", "TeleportAbsolute", self._teleport_absolute),
                ("teleport_relative", "TeleportRelative", self._teleport_relative),
            )
        ]
        self.simulator = simulator

    def leave(self):
        node = self.simulator.node
        for publication in (self.pose, self.colour):
            node.unadvertise(publication.name)
        node.unsubscribe(self.commands.name)
        for service in self.services:
            node.withdraw(service.name)

    def _command(self, twist):
        linear = twist.linear
        self.turtle.command(wire.as_float(linear.x), wire.as_float(linear.y), wire.as_float(twist.angular.z), kernel.now())

    def _set_pen(self, request):
        self.turtle.set_pen(request.r, request.g, request.b, request.width, request.off)
        return self.services[0].type.response()

    def _teleport_absolute(self, request):
        self.turtle.teleport_absolute(*(wire.as_float(value) for value in request.values()))
        return self.services[1].type.response()

    def _teleport_relative(self, request):
        self.turtle.teleport_relative(*(wire.as_float(value) for value in request.values()))
        return self.services[2].type.response()

    def publish(self):
        """The pose and the colour of this tick, for those who listen."""
        simulator = self.simulator
        if self.pose.connections:
            x, y, heading, speed, turn = self.turtle.pose()
            total = x + y + heading + speed + turn
            if total - total == 0.0:  # all are finite
                message = simulator.pose_type(_double(x), _double(y), _double(heading), _double(speed), _double(turn))
            else:
                message = simulator.pose_type(*(wire.lisp_float(value) for value in (x, y, heading, speed, turn)))
            self.pose.send(message)
        if self.colour.connections:
            self.colour.send(simulator.colour_type(*self.turtle.colour()))


class Turtlesim:
    """The simulator. ``node`` is its ROS node, ``turtles`` the turtles by name, ``canvas`` the paper, ``lines`` its log."""

    def __init__(self, name="turtlesim", namespace="/", echo=None):
        self.graph = graph.active()
        self.node = self.graph.node(name, namespace, spins=True)
        self.node.simulator = self
        self.echo = echo
        self.lines = []
        self.pose_type, self.colour_type = message_class_exact("turtlesim/Pose"), message_class_exact("turtlesim/Color")
        self.canvas = Canvas()
        self.inhabitants = {}
        self.counter = self.spawned = 0
        self.started = False
        logging.join_rosout(self.node)
        for parameter, value in BACKGROUND:
            full = self.node.resolve("~" + parameter)
            if not self.graph.parameters.has(full):
                self.graph.parameters.set(full, value)
        self._clear()
        self._offer_services()
        self.log(logging.INFO, f"Starting turtlesim with node name {self.node.name}")
        self.spawn("", CENTRE, CENTRE, 0.0)
        self.timer = kernel.call_every(TICK, self.tick)
        self.node.on_shutdown.append(self.timer.cancel)

    @property
    def turtles(self):
        return {name: inhabitant.turtle for name, inhabitant in self.inhabitants.items()}

    def tick(self):
        """What happens every 16 ms."""
        node = self.node
        if node.inbox:
            node.spin_once()
        if not self.started:
            self.started = True
            return
        now = kernel.now()
        for inhabitant in self.inhabitants.values():
            turtle = inhabitant.turtle
            if not turtle.at_rest:
                turtle.update(now)
            if inhabitant.pose.connections or inhabitant.colour.connections:
                inhabitant.publish()
            if turtle._segment is not None:
                turtle.draw()
        node.tick_done()

    def spawn(self, name, x, y, heading):
        """A new turtle at world coordinates; an empty name stands for the next free ``turtleN``. Returns the name."""
        if not name:
            while True:
                self.counter += 1
                name = f"turtle{self.counter}"
                if name not in self.inhabitants:
                    break
        elif name in self.inhabitants:
            self.log(logging.ERROR, f"A turtled named [{name}] already exists")
            raise Refusal("")
        complaint = check_graph_name(name)
        if complaint:
            self.log(logging.ERROR, f"Exception thrown while processing service call: {complaint}")
            raise Refusal(complaint)
        turtle = Turtle(name, self.spawned, x, y, heading, self.canvas, lambda text: self.log(logging.WARN, text))
        self.spawned += 1
        self.inhabitants[name] = Inhabitant(self, turtle)
        self.inhabitants = dict(sorted(self.inhabitants.items()))  # updates go in the order of names
        self.log(logging.INFO, f"Spawning turtle [{name}] at x=[{x:f}], y=[{y:f}], theta=[{heading:f}]")
        return name

    def kill(self, name):
        """Remove a turtle; its trail stays."""
        if name not in self.inhabitants:
            self.log(logging.ERROR, f"Tried to kill turtle [{name}], which does not exist")
            raise Refusal("")
        self.inhabitants.pop(name).leave()

    def clear(self):
        """Fill the paper with the background, as the parameters are now."""
        self.log(logging.INFO, "Clearing turtlesim.")
        self._clear()

    def reset(self):
        """One turtle in the centre, clean paper."""
        self.log(logging.INFO, "Resetting turtlesim.")
        for inhabitant in self.inhabitants.values():
            inhabitant.leave()
        self.inhabitants = {}
        self.counter = self.spawned = 0
        self.spawn("", CENTRE, CENTRE, 0.0)
        self._clear()

    def picture(self):
        """A Pillow image of the window."""
        return canvas.picture(self.canvas, self._sprites())

    def save_png(self, path):
        """Write the window as a PNG file."""
        canvas.save_png(path, self.canvas, self._sprites())

    def _sprites(self):
        return [
            (turtle.x * METRE, turtle.y * METRE, turtle.heading, turtle.number)
            for turtle in self.turtles.values()
            if math.isfinite(turtle.x) and math.isfinite(turtle.y) and math.isfinite(turtle.heading)
        ]

    def shutdown(self):
        """Close the simulator."""
        self.node.shutdown()

    def log(self, level, text):
        """A log line as roscpp prints it, and a message on ``/rosout``."""
        stamp = self.graph.now()
        line = f"[{LABELS[level]}] [{int(stamp)}.{int(stamp % 1 * 1e9):09d}]: {text}"
        if len(self.lines) >= MOST_LINES:
            del self.lines[: MOST_LINES // 2]
        self.lines.append(line)
        logging.rosout(self.node, level, text)
        if self.echo is not None:
            print(line, file=sys.stderr if self.echo is True else self.echo)

    def _clear(self):
        colour = []
        for parameter, default in BACKGROUND:
            try:
                colour.append(int(self.graph.parameters.get(self.node.resolve("~" + parameter))) & 255)
            except (KeyError, TypeError, ValueError):
                colour.append(default)
        self.canvas.clear(tuple(colour))

    def _offer_services(self):
        empty = service_type_exact("std_srvs/Empty")
        spawn, kill = service_type_exact("turtlesim/Spawn"), service_type_exact("turtlesim/Kill")
        loggers, set_level = service_type_exact("roscpp/GetLoggers"), service_type_exact("roscpp/SetLoggerLevel")
        logger = message_class_exact("roscpp/Logger")

        def do(action, kind):
            def handler(_):
                action()
                return kind.response()

            return handler

        def spawn_turtle(request):
            return spawn.response(name=self.spawn(request.name, *(wire.as_float(value) for value in (request.x, request.y, request.theta))))

        def kill_turtle(request):
            self.kill(request.name)
            return kill.response()

        self.node.serve("clear", empty, do(self.clear, empty))
        self.node.serve("reset", empty, do(self.reset, empty))
        self.node.serve("spawn", spawn, spawn_turtle)
        self.node.serve("kill", kill, kill_turtle)
        self.node.serve("~get_loggers", loggers, lambda _: loggers.response(loggers=[logger(name="ros.turtlesim", level="info")]))
        self.node.serve("~set_logger_level", set_level, lambda _: set_level.response())


def start_turtlesim(name="turtlesim", namespace="/", echo=None):
    """Start the simulator in the active kernel. ``echo``: True prints its log to stderr, a stream there."""
    return Turtlesim(name, namespace, echo)


def running_simulator(name="/turtlesim"):
    """The simulator whose node has that name in the active graph, or ``None``."""
    return getattr(graph.active().nodes.get(name), "simulator", None)


def start_with_first_node(echo=None):
    """Have the simulator start with the first ``start-ros-node``, as if ``turtlesim_node`` had been running before."""

    def start():
        if running_simulator() is None:
            start_turtlesim(echo=echo)

    graph.active().before_first_node.append(start)
