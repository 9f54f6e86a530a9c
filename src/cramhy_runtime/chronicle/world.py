"""What the turtles do: where they are, what their pens draw, when the paper is cleared. Told by the simulator, tick by tick."""

from __future__ import annotations

from .. import kernel
from ..ros.messages import message_class_exact
from ..turtlesim.node import running_simulator


class World:
    """Watches the simulator, as soon as there is one. `take` gives what is new as a ``cramhy_msgs/World``, or ``None``."""

    def __init__(self, now):
        self.now = now
        self.kernel = kernel.active()
        self.type, self.turtle_type = message_class_exact("cramhy_msgs/World"), message_class_exact("cramhy_msgs/Turtle")
        self.stroke_type = message_class_exact("cramhy_msgs/Stroke")
        self.simulator = None
        self.seen = None  # (papers, turtles) as they were told last
        self.clears = 0  # papers that were told, of this simulator and those before it
        self.paper = None  # (simulator, how often its paper was cleared) of the strokes
        self.strokes = []
        self.ticked = False

    def begin(self):
        """The simulator is looked for in `take`, since it may start later."""

    def end(self):
        if self.simulator is not None:
            self.simulator.unobserve(self._tick)
            self.simulator = None

    def _tick(self, simulator, strokes):
        self.ticked = True
        if simulator.canvas.clears != self.paper[1]:
            self._new_paper()
        self.strokes += strokes

    def _new_paper(self):
        self.clears += 1
        self.paper = (self.simulator, self.simulator.canvas.clears)
        self.strokes = []

    def take(self):
        """The turtles, and what was drawn since the last call, if anything has changed."""
        complete = False
        simulator = self.simulator
        if (simulator is None or not simulator.node.alive) and kernel.active() is self.kernel:
            simulator = running_simulator()
        if simulator is not self.simulator:
            self.end()
            self.simulator = simulator
            if simulator is not None:
                simulator.observe(self._tick)
                self._new_paper()
                self.strokes = list(simulator.canvas.strokes())
            complete = self.ticked = True
        if simulator is None and not complete or not (self.ticked or self.strokes):
            return None
        self.ticked = False
        turtles = (
            []
            if simulator is None
            else [
                (turtle.name, *turtle.pose(), True if turtle.pen_on else None, *turtle.pen_colour, turtle.pen_width, turtle.number & 255)
                for turtle in simulator.turtles.values()
            ]
        )
        if (self.clears, turtles) == self.seen and not self.strokes and not complete:
            return None
        self.seen = self.clears, turtles
        strokes, self.strokes = self.strokes, []
        make_turtle, make_stroke = self.turtle_type, self.stroke_type
        background, name = ((0, 0, 0), "") if simulator is None else (simulator.canvas.background, simulator.node.name)
        return self.type(
            self.now(),
            True if complete else None,
            self.clears,
            *background,
            name,
            [make_turtle(*turtle) for turtle in turtles],
            [make_stroke(x1, y1, x2, y2, *colour, width) for x1, y1, x2, y2, colour, width in strokes],
        )
