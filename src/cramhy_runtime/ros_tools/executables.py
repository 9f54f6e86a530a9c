"""The programs that ``rosrun`` and launch files start: for each package that is part of cramhy, its executables.

A program is a class of the room that it belongs to, a `ros.roscpp.Program`. Its module is imported when the program is started. A program
is found under the names that the package has in ROS, so some have several.
"""

from __future__ import annotations

from importlib import import_module

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from ..turtlesim.executables import PROGRAMS
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from ..ros.roscpp import Program
    from ..ros.signatures import Echo, Words

_FRAMES, _TURTLES, _ROBOTS, _SHAPES = "tf.programs.frames", "tf.programs.turtles", "tf.programs.robots", "actionlib.shape_server"
_ARM, _BRICKS = ("robot_world.al5d.node", "Simulator"), "robot_world.al5d.clients"
EXECUTABLES: dict[str, dict[str, tuple[str, str]]] = {
    "turtlesim": {name: (program.__module__.partition(".")[2], program.__name__) for name, program in PROGRAMS.items()},
    "turtle_actionlib": {"shape_server": (_SHAPES, "ShapeServer"), "shape_client": (_SHAPES, "ShapeClient")},
    "tf": {"static_transform_publisher": (_FRAMES, "StaticTransformPublisher"), "tf_echo": (_FRAMES, "TfEcho")},
    "robot_state_publisher": dict.fromkeys(("robot_state_publisher", "state_publisher"), (_ROBOTS, "RobotStatePublisher")),
    "joint_state_publisher": {"joint_state_publisher": (_ROBOTS, "JointStatePublisher")},
    "tf2_ros": {"static_transform_publisher": (_FRAMES, "Tf2StaticTransformPublisher")},
    "turtle_tf": {
        **dict.fromkeys(("turtle_tf_broadcaster", "turtle_tf_broadcaster.py"), (_TURTLES, "Broadcaster")),
        **dict.fromkeys(("turtle_tf_listener", "turtle_tf_listener.py"), (_TURTLES, "Follower")),
    },
    "lynxmotion_al5d_description": {
        **dict.fromkeys(("simulator", "manager_node"), _ARM),  # the course's manager of bricks is a node beside Gazebo
        "spawn_brick": (_BRICKS, "SpawnBrick"),
        "kill_brick": (_BRICKS, "KillBrick"),
    },
    "turtle_tf2": {
        **dict.fromkeys(("turtle_tf2_broadcaster", "turtle_tf2_broadcaster.py"), (_TURTLES, "Tf2Broadcaster")),
        **dict.fromkeys(("turtle_tf2_listener", "turtle_tf2_listener.py"), (_TURTLES, "Tf2Follower")),
    },
}
"""For each package, its executables: the module below `cramhy_runtime`, and the class in it."""


def executables(package: str) -> list[str]:
    """The names of the executables of a package, sorted; none for a package that is not part of cramhy."""
    return sorted(EXECUTABLES.get(package, ()))


def complaint(package: str, executable: str) -> str | None:
    """A sentence that says which executables there are, or ``None`` if there is this one."""
    if package not in EXECUTABLES:
        return f"cramhy has no executable {package}/{executable}. Packages with executables: {', '.join(sorted(EXECUTABLES))}."
    if executable not in EXECUTABLES[package]:
        return f"cramhy has no executable {package}/{executable}; {package} has {', '.join(executables(package))}."
    return None


def start(package: str, executable: str, arguments: Words = (), echo: Echo = None) -> Program:
    """Start an executable and return its `Program`. One that does not exist is a simple error, as are words that it does not understand.

    arguments: the words of its command line (``__name:=x``, ``__ns:=/y``, ``a:=b``, ``_p:=v``, and its own). echo: see `Program`.
    """
    problem = complaint(package, executable)
    if problem is not None:
        conditions.error(SimpleError("~a", problem))
    module, name = EXECUTABLES[package][executable]
    try:
        program = getattr(import_module(f"cramhy_runtime.{module}"), name)
    except ImportError as missing:  # an extra that is not installed
        return conditions.error(SimpleError("~a", f"{package}/{executable} cannot start. {missing}"))
    return program(arguments=arguments, echo=echo)
