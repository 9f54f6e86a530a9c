"""``spawn_brick`` and ``kill_brick``: programs that ask the simulator for one thing, and end.

They wait until the service is there, as the course's do. Their command lines are those of its README. A refusal is the exit status 1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...lisp_core import conditions
from ...lisp_core.condition_types import SimpleError
from ... import kernel
from ...ros import rosout
from ...ros.names import split_arguments
from ...ros.messages import service_type_exact
from ...ros.roscpp import Program
from ...ros.services import Call, start_call
from ...ros.wire import ros_text
from .names import PACKAGE

if TYPE_CHECKING:
    from ...ros.messages import RosMessage
    from ...ros.signatures import Echo, Words

LOOK_AGAIN = 0.1
"""Seconds between two looks for the service."""
_NUMBERS = {"-x": "x", "-y": "y", "-z": "z", "-R": "roll", "-P": "pitch", "-Y": "yaw"}


class Client(Program):
    """A program that calls one service. service: its name; kind: its type."""

    package = PACKAGE
    service = kind = usage = ""

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None) -> None:
        given = [word for word in split_arguments(arguments) if ":=" not in word]
        self.request = service_type_exact(f"{PACKAGE}/{self.kind}").request()
        try:
            self.read(given)
        except (ValueError, IndexError):
            conditions.error(SimpleError("~a", f"Usage: rosrun {PACKAGE} {self.usage}"))
        super().__init__(name, namespace, arguments, echo=echo)
        self._waits = False
        self._timer = kernel.call_every(LOOK_AGAIN, self._ask, kernel.now())
        self.node.on_shutdown.append(self._timer.cancel)

    def read(self, words: list[str]) -> None:
        """Fill the request from the words of the command line. Errors: ValueError and IndexError, for words that are not understood."""
        raise NotImplementedError

    def answered(self, response: RosMessage) -> None:
        """Say what the service answered."""
        raise NotImplementedError

    def _ask(self) -> None:
        service = self.graph.service(self.node.resolve(self.service))
        if service is not None:
            self._timer.cancel()
            start_call(service, self.request, self._end)
        elif not self._waits:
            self._waits = True
            self.log(rosout.INFO, f"waitForService: Service [{self.service}] has not been advertised, waiting...")

    def _end(self, call: Call) -> None:
        if call.lost or call.failure is not None:
            self.log(rosout.ERROR, f"Failed to call the service: {call.failure or 'the simulator has ended.'}")
            self.status = 1
        else:
            self.answered(call.response)
        self.shutdown()


class SpawnBrick(Client):
    """``rosrun lynxmotion_al5d_description spawn_brick -c red -y 0.17``."""

    name = "spawn_lego_brick"
    service, kind = "/lynxmotion_al5d/spawn_brick", "SpawnBrick"
    usage = "spawn_brick -c color [-n name] [-x x] [-y y] [-z z] [-P pitch] [-R roll] [-Y yaw]"

    def read(self, words: list[str]) -> None:
        left = list(words)
        while left:
            option, value = left.pop(0), left.pop(0)
            if option == "-c":
                self.request.color = ros_text(value)
            elif option == "-n":
                self.request.name = ros_text(value)
            else:
                pose, field = self.request.pose, _NUMBERS.get(option, "")
                if not field:
                    raise ValueError(option)
                setattr(pose.position if field in "xyz" else pose.orientation, field, float(value))
        if not self.request.color:
            raise ValueError("no colour")

    def answered(self, response: RosMessage) -> None:
        pose = self.request.pose
        numbers = " ".join(f"{float(number):.2f}" for number in (*pose.position.values(), *pose.orientation.values()))
        self.log(rosout.INFO, f"Spawned brick [{response.name}] of color [{self.request.color}] at position ({numbers})")


class KillBrick(Client):
    """``rosrun lynxmotion_al5d_description kill_brick brick1``."""

    name = "kill_lego_brick"
    service, kind = "/lynxmotion_al5d/kill_brick", "KillBrick"
    usage = "kill_brick name"

    def read(self, words: list[str]) -> None:
        (name,) = words
        self.request.name = ros_text(name)

    def answered(self, response: RosMessage) -> None:
        self.log(rosout.INFO, "Brick deleted successfully")
