"""A robot that picks and places, for plain Hy and for Python: CRAM's plans on a world of three dimensions, as functions.

    from cramhy import robot

    kitchen = robot.world()
    kitchen.spawn("bottle", (1.4, 0.6, 0.96))


    @robot.run
    def bottle():
        robot.go(robot.at(0.75, 0.6))
        robot.look((1.4, 0.6, 0.96))
        found = robot.detect("bottle")
        robot.pick_up(found, arm="left")
        robot.go(robot.at(-0.15, 2.0, yaw=180))
        robot.place(found, robot.at(-0.8, 2.0, 0.96, yaw=180))
        return found

Below it all are the libraries of CRAM in Lisp: each function performs the action designator of its name, so rules, process modules and
plans of Lisp count here, too, and failures are those of CRAM (`failures`). A function that is called outside of a plan of the robot is a
plan of its own. The room needs the extra ``robot``.

=================  =====================================================================================================
``libraries``      loads what the functions stand on, and finds functions and classes of Lisp
``failures``       the classes of failures, by the names of Python
``poses``          ``at(x, y, z, yaw=90)``
``worlds``         ``world()``, and what can be asked of it and changed in it
``designators``    the actions as classes: ``PickingUp(object=found, arm=kw.left)``
``outcomes``       whether a thing stands at its target, is in a hand, and arms are parked
``acting``         ``run``, ``go``, ``look``, ``detect``, ``pick_up``, ``place``, ``park``, ``lift``
``transporting``   ``transport``, with the places and the grasps that it tries
=================  =====================================================================================================
"""

from .acting import detect, go, lift, look, park, pick_up, place, run
from .designators import Detecting, Going, Looking, MovingTorso, PickingUp, Placing
from .failures import failures
from .poses import at
from .transporting import deliver, fetch, standing_places, transport, ways_to_hold
from .worlds import World, world

__all__ = [
    "at", "deliver", "detect", "Detecting", "failures", "fetch", "go", "Going", "lift", "look", "Looking", "MovingTorso", "park", "pick_up",
    "PickingUp", "place", "Placing", "run", "standing_places", "transport", "ways_to_hold", "world", "World",
]  # fmt: skip
