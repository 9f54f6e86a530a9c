"""A run of the course's package: forms typed in TUT, in virtual time, and a witness of everything that the turtle does.

The same forms are typed into the package that is written in plain Hy, as `in_hy` says them there, while `course` makes a `CourseInHy`.
"""

from __future__ import annotations

import functools
import math
import os
import random
import re
import sys
import types
from contextlib import contextmanager, nullcontext
from pathlib import Path

import hy
from systems import SOAK

from cramhy_runtime import kernel, testing
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.languages.commonlisp.numbers.random_state import seed_random
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.session import Image
from cramhy_runtime.testing.leftovers import leftovers
from cramhy_runtime.testing.plans import plan_of, with_lisp
from cramhy_runtime.turtlesim.node import running_simulator, start_with_first_node

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "tutorials"
SEEDS = range(200 if SOAK else 10)
BACKENDS = ("threads", "greenlet")
TICK = 0.016
STEP = 1.5 * TICK  # metres that a moving turtle goes in a tick: so much nearer than the threshold may it stop


def backend_of(seed):
    """Both back ends get half of the seeds each."""
    return BACKENDS[seed % 2]


def seeded(seed):
    """A course in the order and with the random numbers of ``seed``, on the back end that is its turn."""
    return course(backend_of(seed), seed)


@contextmanager
def course(backend="threads", seed=None):
    """A `Course` after ``(init)``."""
    KIND.load()
    with testing.virtual_time(backend, seed) as clock:
        clock.watch_fluents()
        seed_random(seed)
        start_with_first_node()
        random.seed(seed)
        yield KIND(clock)


class Course:
    """``commands`` are (time, speed, turn) as the turtle heard them, ``poses`` (x, y) of every tick, ``strokes`` what was drawn."""

    def __init__(self, clock):
        self.clock = clock
        self.poses, self.commands, self.strokes = [], [], []
        self("(init)")
        self.simulator = running_simulator()
        witness = graph.active().node("witness")
        witness.subscribe("/turtle1/pose", message_class_exact("turtlesim/Pose"), self._see)
        witness.subscribe("/turtle1/cmd_vel", message_class_exact("geometry_msgs/Twist"), self._hear)
        self.simulator.observe(self._drawn)

    @staticmethod
    def load():
        """Load the package."""
        with_lisp(lambda: systems.load_system("cram-my-beginner-tutorial"))

    def __call__(self, form):
        """The first value of a form, read in TUT."""
        return one(plan_of(f"(in-package :tut) {form}")())

    def teleport(self, x, y, theta):
        """Put the turtle down somewhere, without a trace."""
        turtle = self.turtle
        turtle.pen_on = False
        turtle.teleport_absolute(x, y, theta)
        kernel.sleep(3 * TICK)
        turtle.pen_on = True

    @property
    def turtle(self):
        return self.simulator.turtles["turtle1"]

    @property
    def place(self):
        """Where the turtle is, in metres."""
        return self.turtle.pose()[:2]

    @property
    def pen(self):
        """(on, colour, width)"""
        return self.turtle.pen_on, self.turtle.pen_colour, self.turtle.pen_width

    def _see(self, pose):
        self.poses.append((float(pose.x), float(pose.y)))

    def _hear(self, twist):
        self.commands.append((kernel.now(), float(twist.linear.x), float(twist.angular.z)))

    def _drawn(self, simulator, lines):
        """The lines of a tick; a stroke is what one pen draws without being lifted: (colour, width, [point ...])."""
        for x0, y0, x1, y1, colour, width in lines:
            if self.strokes:
                last_colour, last_width, points = self.strokes[-1]
                if (last_colour, last_width) == (colour, width) and math.dist(points[-1], (x0, y0)) < 1e-6:
                    points.append((x1, y1))
                    continue
            self.strokes.append((colour, width, [(x0, y0), (x1, y1)]))

    # ------------------------------------------------------------------------------------------------------ what must hold

    def stands_still(self):
        """No command comes after the stop, and the turtle does not move any more."""
        kernel.sleep(3 * TICK)
        before, heard = self.place, len(self.commands)
        kernel.sleep(2)
        return self.commands[-1][1:] == (0, 0) and len(self.commands) == heard and self.place == before

    def left(self):
        """What the plans have left behind: tasks, timers, nets of the pose, process modules that run."""
        kernel.sleep(3 * TICK)  # until the node is connected
        self.simulator.timer.cancel()
        self.clock.settle()
        pose = self("*turtle-pose*")
        modules = [name for name in ("turtlesim-navigation", "turtlesim-pen-control") if self(f"(get-running-process-module '{name})")]
        return leftovers(self.clock) + list(pose.living_nets()) + list(pose.waiters) + modules


# --------------------------------------------------------------------------------------------------------------- in plain Hy

MODULES = (
    "control_turtlesim simple_plans location_designators action_designators process_modules selecting_process_modules high_level_plans"
)
IN_HY = [
    (r"\*(turtle-pose)\*", r"\1"),
    (r"setf \*(min-bound)\*", r"setv location-designators.\1"),
    (r"\(list ([^()]*)\)|'\(([^()]*)\)", r"[\1\2]"),
    (r"-running \(([^()]*)\)", r"-running [\1]"),
    (r"\(let \(\((\S+) (.*?)\)\)\n", r"(let [\1 \2]\n"),
    (r" nil\)", " None)"),
    (r"(goto-location|get-shape-vertices) :([a-z]+)(?: :([a-z]+))?", r'\1 "\2" "\3"'),
    (r' ""', ""),
]
"""What is written in another way than in Common Lisp, and how."""


def in_hy(form):
    """A form of Common Lisp as one writes it in plain Hy."""
    for lisp, there in IN_HY:
        form = re.sub(lisp, there, form)
    return form


def prompt_in_hy():
    """A module beside those of the package in plain Hy, which has all their names."""
    module = types.ModuleType("turtlesim_in_hy.prompt")
    imports = "".join(f"(import turtlesim-in-hy.{name} *)" for name in MODULES.split())
    for form in hy.read_many(f"(require cramhy *) (import turtlesim-in-hy [location-designators]) {imports}"):
        hy.eval(form, module=module)
    return module


@functools.cache
def in_hy_alone():
    """(an image that has the package in plain Hy and not the one in Common Lisp, since both say what a motion is; its prompt)"""
    sys.path.insert(0, str(FOLDER))
    with (image := Image()).entered():
        return image, prompt_in_hy()


class CourseInHy(Course):
    """The course in plain Hy."""

    @staticmethod
    def load():
        """The image of `in_hy_alone` has it."""

    def __call__(self, form):
        value = None
        for each in hy.read_many(in_hy(form)):
            value = hy.eval(each, module=in_hy_alone()[1])
        return one(value)


KIND = Course


def image_of(kind):
    """A block in which the image is that of ``kind``, of a `Course`."""
    return in_hy_alone()[0].entered() if kind is CourseInHy else nullcontext()


def missed(corners, points, near):
    """The first of ``corners`` that the ``points`` do not come as near to, one corner after the other; ``None`` if there is none."""
    on_the_way = iter(points)
    for corner in corners:
        if not any(math.dist(corner, point) < near for point in on_the_way):
            return corner
    return None


def environment():
    """The variables of a process that knows this tree and the course in it, and nothing of ROS."""
    keep = {key: value for key, value in os.environ.items() if key not in ("ROS_PACKAGE_PATH", "PYTHONDONTWRITEBYTECODE")}
    return {**keep, "PYTHONPATH": os.pathsep.join(str(ROOT / folder) for folder in ("src", "hy_src", "tutorials"))}
