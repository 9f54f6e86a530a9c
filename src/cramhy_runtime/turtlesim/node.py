"""The node ``/turtlesim``: topics, services and parameters around the turtles' world.

It spins once per tick of 16 ms: first it handles the commands and requests that have arrived, then it updates every turtle, in
the order of names. So a response comes before the update of its tick, and of several commands within a tick the last one counts.
The first tick only looks at the time. Messages without subscribers are not computed. Source: turtlesim.md 3, 4, 8.
"""

from __future__ import annotations

import math
from weakref import WeakKeyDictionary

from .. import kernel
from cramhy_runtime.lisp_core import conditions
from ..ros import graph, rosout, wire
from ..ros.messages import message_class, service_type
from ..ros.names import check_graph_name
from ..ros.services import OfCaller, Refusal
from .canvas import Canvas
from .history import History
from .dimensions import CENTRE, DRAWINGS, EXTENT
from ..ros.roscpp import Program
from .world import TICK, Turtle
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..ros.messages import RosMessage
    from ..ros.services import Service
    from ..ros.signatures import Echo, Words
    from .signatures import Listener, Observer, Stroke


BACKGROUND = (("background_r", 69), ("background_g", 86), ("background_b", 255))


class Inhabitant:
    """A turtle with its topics and services. ``of_client``: whether a client of another process has spawned it."""

    of_client = False

    def __init__(self, simulator: Turtlesim, turtle: Turtle):
        node, name = simulator.node, turtle.name
        self.turtle = turtle
        self.pose = node.advertise(f"{name}/pose", simulator.pose_type)
        self.colour = node.advertise(f"{name}/color_sensor", simulator.colour_type)
        self.commands = node.subscribe(f"{name}/cmd_vel", message_class("geometry_msgs/Twist"), self._command, queue=1)
        self.services: list[Service] = [
            node.serve(f"{name}/{service}", service_type(f"turtlesim/{kind}"), handler)
            for service, kind, handler in (
                ("set_pen", "SetPen", self._set_pen),
                ("teleport_absolute", "TeleportAbsolute", self._teleport_absolute),
                ("teleport_relative", "TeleportRelative", self._teleport_relative),
            )
        ]
        self.simulator = simulator

    def leave(self) -> None:
        """End the turtle's topics and services."""
        node = self.simulator.node
        for publication in (self.pose, self.colour):
            node.unadvertise(publication.name)
        node.unsubscribe(self.commands)
        for service in self.services:
            node.withdraw(service.name)

    def _command(self, twist: RosMessage) -> None:
        linear = twist.linear
        velocity = wire.as_float(linear.x), wire.as_float(linear.y), wire.as_float(twist.angular.z)
        if self.simulator.listener is not None:
            velocity = self.simulator.listener("command", self.turtle.name, velocity)
            if velocity is None:
                return
        self.turtle.command(*velocity, kernel.now())

    def _set_pen(self, request: RosMessage) -> RosMessage:
        self._tell("set_pen", (request.r, request.g, request.b, request.width, request.off))
        self.turtle.set_pen(request.r, request.g, request.b, request.width, request.off)
        return self.services[0].type.response()

    def _teleport_absolute(self, request: RosMessage) -> RosMessage:
        place = tuple(wire.as_float(value) for value in request.values())
        self._tell("teleport_absolute", place)
        self.turtle.teleport_absolute(*place)
        return self.services[1].type.response()

    def _teleport_relative(self, request: RosMessage) -> RosMessage:
        way = tuple(wire.as_float(value) for value in request.values())
        self._tell("teleport_relative", way)
        self.turtle.teleport_relative(*way)
        return self.services[2].type.response()

    def _tell(self, kind: str, values: tuple[float, ...]) -> None:
        if self.simulator.listener is not None:
            self.simulator.listener(kind, self.turtle.name, values)

    def publish(self) -> None:
        """Publish the pose and the colour of this tick, if there are subscribers."""
        simulator = self.simulator
        if self.pose.connections:
            x, y, heading, speed, turn = self.turtle.pose()
            total = x + y + heading + speed + turn
            if total - total == 0.0:  # all are finite
                message = simulator.pose_type(x, y, heading, speed, turn)
            else:
                message = simulator.pose_type(*(wire.lisp_float(value) for value in (x, y, heading, speed, turn)))
            self.pose.send(message)
        if self.colour.connections:
            self.colour.send(simulator.colour_type(*self.turtle.colour()))


class Turtlesim(Program):
    """The simulator, ``turtlesim_node``. Arguments: see `Program`.

    ``turtles``: the turtles by name. ``canvas``: the paper. ``observers``: functions called at every tick (`observe`).

    ``listener``: ``None``, or a function of what reaches the simulator, called before it counts: ``listener(kind, turtle, values)``. The
    kinds and their values are "command" (forward, sideways, turn), "set_pen" (r, g, b, width, off), "teleport_absolute" (x, y, heading),
    "teleport_relative" (linear, angular), "spawn" (x, y, heading), "kill", "clear" and "reset", with units as in `Turtle`. For a command
    it returns the velocity that counts, or ``None`` if the command is lost. The other results are not used.
    """

    name = "turtlesim"
    package = "turtlesim"

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, spins=True, echo=echo)
        self.pose_type, self.colour_type = message_class("turtlesim/Pose"), message_class("turtlesim/Color")
        self.canvas = Canvas()
        self.inhabitants: dict[str, Inhabitant] = {}
        self.counter = self.spawned = 0
        self.started = False
        self.observers: tuple[Observer, ...] = ()
        self.listener: Listener | None = None
        self.history: History | None = None
        for parameter, value in BACKGROUND:
            full = self.node.resolve("~" + parameter)
            if not self.graph.parameters.has(full):
                self.graph.parameters.set(full, value)
        self._clear()
        self._offer_services()
        self.log(rosout.INFO, f"Starting turtlesim with node name {self.node.name}")
        self.spawn("", CENTRE, CENTRE, 0.0)
        self.timer = kernel.call_every(TICK, self.tick)
        self.node.on_shutdown.append(self.timer.cancel)
        for callback in _expecting.get(self.graph, ()):
            callback(self)

    @property
    def turtles(self) -> dict[str, Turtle]:
        """The turtles by name, sorted."""
        return {name: inhabitant.turtle for name, inhabitant in self.inhabitants.items()}

    def tick(self) -> None:
        """Handle the input and update all turtles. The timer calls it every 16 ms."""
        node = self.node
        if node.inbox:
            node.spin_once()
        if not self.started:
            self.started = True
            return
        now = kernel.now()
        talkative = self.loggers.talkative
        for inhabitant in self.inhabitants.values():
            turtle = inhabitant.turtle
            if not turtle.at_rest:
                turtle.update(now)
            if inhabitant.pose.connections or inhabitant.colour.connections:
                inhabitant.publish()
            if talkative:
                self.log(
                    rosout.DEBUG, f"[{self.node.resolve(turtle.name)}]: pos_x: {turtle.x:f} pos_y: {turtle.y:f} theta: {turtle.heading:f}"
                )
            if turtle.segment is not None:
                turtle.draw()
        if self.observers:
            self._show()
        node.tick_done()

    def observe(self, callback: Observer) -> None:
        """Call ``callback(simulator, strokes)`` at the end of every tick, after all updates. It must not wait.

        ``strokes``: a new list of the lines of this tick, ``(x1, y1, x2, y2, (r, g, b), width)``, in the order of drawing. Coordinates
        are metres of the world (y up), the width is in pixels. If ``simulator.canvas.clears`` has grown since the last call, the paper
        was first filled with ``simulator.canvas.background``, and the list has only the lines since then.

        ``simulator.turtles``: the turtles by name, with `Turtle.pose`, ``pen_on``, ``pen_colour``, ``pen_width`` and ``number`` (of the
        drawing, `drawing.shapes`). ``simulator.canvas.strokes()`` returns the lines from before the first call.

        Without observers, none of this is computed. If a callback raises an error, the error is reported and the callback removed.
        """
        if self.canvas.news is None:
            self.canvas.news = []
        self.observers = (*self.observers, callback)

    def unobserve(self, callback: Observer) -> None:
        """Stop calling ``callback``. If it is not an observer, do nothing."""
        self.observers = tuple(each for each in self.observers if each != callback)
        if not self.observers:
            self.canvas.news = None

    def keep_history(self) -> History:
        """Keep a `History` from now on, for `replay`, and return it. Later calls return the same one."""
        if self.history is None:
            self.history = History(self)
        return self.history

    def _show(self) -> None:
        news = self.canvas.news
        strokes: list[Stroke] = []
        if news:
            strokes = [
                (x1, EXTENT - y1, x2, EXTENT - y2, colour, width)
                for x2, y2, x1, y1, colour, width in news
                if (x1 + y1 + x2 + y2) * 0.0 == 0.0
            ]  # a line to nowhere is no stroke
            news.clear()
        for observer in self.observers:
            try:
                observer(self, list(strokes))
            except Exception as problem:  # the turtles have nothing to do with it, and it would come again 62 times a second
                self.unobserve(observer)
                kernel.unhandled(kernel.current(), problem)

    def spawn(self, name: str, x: float, y: float, heading: float) -> str:
        """Make a turtle at (x, y), in metres of the world (y up), with ``heading`` in radians; returns its name.

        An empty ``name`` means the next free ``turtleN``. A name that is taken or illegal raises `Refusal`. Source: turtlesim.md 8.
        """
        if not name:
            while True:
                self.counter += 1
                name = f"turtle{self.counter}"
                if not self._taken(name):
                    break
        elif self._taken(name):
            self.log(rosout.ERROR, f"A turtled named [{name}] already exists")
            raise Refusal("")
        complaint = check_graph_name(name)
        if complaint:
            self.log(rosout.ERROR, f"Exception thrown while processing service call: {complaint}")
            raise Refusal(complaint)
        self._tell("spawn", name, (x, y, heading))
        turtle = Turtle(name, self.spawned % DRAWINGS, x, y, heading, self.canvas, lambda text: self.log(rosout.WARN, text))
        self.spawned += 1
        self.inhabitants[name] = Inhabitant(self, turtle)
        self.inhabitants = dict(sorted(self.inhabitants.items()))  # updates go in the order of names
        self.log(rosout.INFO, f"Spawning turtle [{name}] at x=[{x:f}], y=[{y:f}], theta=[{heading:f}]")
        return name

    def _taken(self, name: str) -> bool:
        """Whether a turtle has the name, or one with the same meaning (``/turtle1``): the two would share their topics."""
        full = self.node.resolve(name)
        return any(self.node.resolve(other) == full for other in self.inhabitants)

    def _check_number(self, name: str, caller: Any) -> None:
        """Raise `Refusal` if a client of another process spawns too many turtles or too long a name (`ros.services.start_call`)."""
        if caller is None:
            return
        there = sum(inhabitant.of_client for inhabitant in self.inhabitants.values())
        if there >= caller.limits.turtles:
            raise Refusal(f"Clients have spawned {there} turtles; more are not allowed. Kill some.")
        if len(name) > caller.limits.name:
            raise Refusal(f"The name of the turtle has {len(name)} characters; {caller.limits.name} are allowed.")

    def kill(self, name: str) -> None:
        """Remove the turtle ``name``; its trail stays. An unknown name raises `Refusal`."""
        if name not in self.inhabitants:
            self.log(rosout.ERROR, f"Tried to kill turtle [{name}], which does not exist")
            raise Refusal("")
        self._tell("kill", name)
        self.inhabitants[name].leave()
        self.inhabitants = {other: inhabitant for other, inhabitant in self.inhabitants.items() if other != name}

    def clear(self) -> None:
        """Fill the paper with the background colour from the present parameters."""
        self.log(rosout.INFO, "Clearing turtlesim.")
        self._tell("clear", "")
        self._clear()

    def reset(self) -> None:
        """Remove all turtles, make one in the centre, and clear the paper."""
        self.log(rosout.INFO, "Resetting turtlesim.")
        self._tell("reset", "")
        for inhabitant in self.inhabitants.values():
            inhabitant.leave()
        self.inhabitants = {}
        self.counter = 0
        self.spawn("", CENTRE, CENTRE, 0.0)
        self._clear()

    def _tell(self, kind: str, turtle: str, values: tuple[float, ...] = ()) -> None:
        if self.listener is not None:
            self.listener(kind, turtle, values)

    def _clear(self) -> None:
        values = [(self.number("~" + parameter, default), default) for parameter, default in BACKGROUND]
        self.canvas.clear([math.floor((value if math.isfinite(value) else default) + 0.5) & 255 for value, default in values])

    def _offer_services(self) -> None:
        empty = service_type("std_srvs/Empty")
        spawn, kill = service_type("turtlesim/Spawn"), service_type("turtlesim/Kill")

        def do(action, kind):
            def handler(_):
                action()
                return kind.response()

            return handler

        def spawn_turtle(request, caller):
            self._check_number(request.name, caller)
            name = self.spawn(request.name, *(wire.as_float(value) for value in (request.x, request.y, request.theta)))
            self.inhabitants[name].of_client = caller is not None
            return spawn.response(name=name)

        def kill_turtle(request):
            self.kill(request.name)
            return kill.response()

        self.node.serve("clear", empty, do(self.clear, empty))
        self.node.serve("reset", empty, do(self.reset, empty))
        self.node.add_service(OfCaller(self.node, self.node.resolve("spawn"), spawn, spawn_turtle))
        self.node.serve("kill", kill, kill_turtle)


_expecting: WeakKeyDictionary[graph.Graph, list[Callable[[Turtlesim], object]]] = (
    WeakKeyDictionary()
)  # graph -> functions that get every simulator that starts


def simulators() -> list[Turtlesim]:
    """The running simulators of the active graph, in the order of their start."""
    return [node.program for node in graph.active().nodes.values() if isinstance(getattr(node, "program", None), Turtlesim)]


def each_simulator(callback: Callable[[Turtlesim], object]) -> None:
    """Call ``callback(simulator)`` for each simulator of the active graph: at once for running ones, for others when they start."""
    _expecting.setdefault(graph.active(), []).append(callback)
    for simulator in simulators():
        callback(simulator)


def expect_no_more(callback: Callable[[Turtlesim], object]) -> None:
    """Undo `each_simulator` for simulators that start later."""
    expecting = _expecting.get(graph.active(), [])
    if callback in expecting:
        expecting.remove(callback)


def start_turtlesim(name: str | None = None, namespace: str = "/", echo: Echo = None) -> Turtlesim:
    """Start the simulator in the active graph and return it. Arguments: see `Program`."""
    return Turtlesim(name, namespace, echo=echo)


def running_simulator() -> Turtlesim | None:
    """The simulator with the node ``/turtlesim``, else the one that has run longest, or ``None``."""
    running = simulators()
    return next((each for each in running if each.node.name == "/turtlesim"), running[0] if running else None)


def needed_simulator() -> Turtlesim:
    """The `running_simulator`. If there is none, it is a simple error."""
    return running_simulator() or conditions.error(
        'No turtlesim is running in this process. It starts with (start-ros-node "name"), or with (turtlesim:start).'
    )


_starters: WeakKeyDictionary[graph.Graph, Callable[[], object]] = WeakKeyDictionary()  # graph -> what its first node starts


def start_with_first_node(echo: Echo = None) -> None:
    """Let the first ``start-ros-node`` start the simulator, as if ``turtlesim_node`` had been running before.

    ``echo``: see `Program`. If a simulator runs already, none is started.
    """

    def start():
        if running_simulator() is None:
            start_turtlesim(echo=echo)

    _starters[graph.active()] = start
    graph.active().before_first_node.append(start)


def start_waiting() -> None:
    """Start the simulator that waits for the first ``start-ros-node``, if one waits."""
    start = _starters.get(graph.active())
    if start in graph.active().before_first_node:
        start()
