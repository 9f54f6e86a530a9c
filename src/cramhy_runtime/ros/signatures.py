"""Types of the arguments in this room. Only type checkers read this module: no code imports it when a program runs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Protocol, TextIO

from cramhy_runtime.lisp_core.data import LispString, Symbol
from .graph import Node
from .messages import RosMessage, ServiceType
from .services import Call
from .topics import Publication

Text = str | LispString
MessageType = type[RosMessage]
TypeName = str | Symbol | MessageType
"""The name of a message type: ``"turtlesim/Pose"``, the symbol of its class, or the class itself."""
ServiceName = str | Symbol | ServiceType
FieldPath = tuple[str, ...]
"""The names of a field and the fields around it, from the inside out: ``("X", "LINEAR")``."""
FieldSpecs = Sequence[tuple[FieldPath, object]]

Parameter = str | int | float | bool | list["Parameter"] | dict[str, "Parameter"]
"""A value of the parameter server."""
ParameterValue = str | int | float | bool | Sequence["ParameterValue"] | Mapping[str, "ParameterValue"]
"""A value for setting a parameter."""

Callback = Callable[..., object]
"""The callback of a subscription: a function that takes the message."""
Handler = Callable[..., RosMessage]
"""The handler of a service: a function that takes the request and returns the response."""
Answers = Callable[[RosMessage], RosMessage | dict[str, object]]
"""The handler of a service that a Python program offers: it returns the response, or the fields of that."""
Observer = Callable[[str, str, bool], object]
"""A function told of changes: the kind of thing, its name, and whether it is there now."""

Words = str | Iterable[str]
"""A command line: its words, or one string."""
Echo = bool | TextIO | Callable[[str], object] | None
"""Where to print a log: True for stderr, a stream, or a function of each line."""


class Connection(Protocol):
    """The receiving end of a topic: `NativeSubscription`, and that of a Lisp program."""

    node: Node
    name: str
    type: MessageType
    closed: bool

    def receive(self, message: Any) -> None: ...
    def spoiled(self, publication: Publication, message: RosMessage) -> None: ...
    def close(self) -> None: ...


class Answerable(Protocol):
    """An object that accepts the calls of a service."""

    name: str

    def submit(self, call: Call) -> None: ...
