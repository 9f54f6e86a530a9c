"""The ground of services: a request, a response, and somebody who is told the answer.

A `Service` belongs to a node. That of a spinning node, such as turtlesim, serves a request in its next tick; any other serves it
at once; the services of the Lisp program (``roslisp/services.py``) queue for a task of their own. There are two ways to call:

* `exchange` is for tasks: it parks until there is an answer.
* `start_call` is for code that must not wait: callbacks, timers, and what outside threads `kernel.post` (the bridge to other
  processes calls this way). It returns the `Call` at once, and ``when_done(call)`` is called when the call is over.

Every call ends, exactly once, in one of three ways: with a ``response``, with the ``failure`` text of a server that refused, or
``lost``, because the server went away. What a handler raises besides `Refusal` is told to the caller and reported (law 3).
Source: roslisp.md 7, wiki.ros.org/Services.
"""

from __future__ import annotations

from .. import kernel
from cramhy_runtime.ground import conditions
from cramhy_runtime.ground.condition_types import Error
from . import wire
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from .graph import Node
    from .messages import RosMessage, ServiceType
    from .signatures import Handler


class Refusal(Exception):
    """Raised by a handler in Python: the service answers "not ok" with this text."""


class Service:
    """An offered service: the node, the `ServiceType`, and the handler of requests."""

    lisp_name = "ROSLISP::SERVICE"

    def __init__(self, node: Node, name: str, service_type: ServiceType, handler: Handler):
        self.node, self.name, self.type, self.handler = node, name, service_type, handler
        self.pending: set[Call] = set()
        self.closed = False

    def respond(self, call: Call) -> RosMessage:
        """The response to ``call``; what is raised is the failure."""
        return self.handler(call.request)

    def close(self) -> None:
        """The server goes away: whoever waits for an answer gets none."""
        self.closed = True
        for call in list(self.pending):
            call.finish(lost=True)

    def submit(self, call: Call) -> None:
        """Take ``call``; it is answered now, or later in a spin of the node."""
        if self.closed:
            call.finish(lost=True)
            return
        self.pending.add(call)
        if self.node.spins:
            self.node.inbox.append(call.serve)
        else:
            call.serve()


class OfCaller(Service):
    """A service whose handler gets the ``caller`` of `start_call` as its second argument."""

    def respond(self, call: Call) -> RosMessage:
        return self.handler(call.request, call.caller)


class Call:
    """One request on its way. When ``done``: ``failure`` is the server's text if it refused, ``lost`` that it gave no answer,
    else ``response`` is the answer. ``when_done`` is called with the call. ``caller``: see `start_call`."""

    __slots__ = ("service", "request", "when_done", "caller", "done", "response", "failure", "lost")

    def __init__(self, service: Service, request: RosMessage, when_done: Callable[[Call], object], caller: object = None):
        self.service, self.request, self.when_done, self.caller = service, request, when_done, caller
        self.done = self.lost = False
        self.response: RosMessage | None = None
        self.failure: str | None = None

    def serve(self) -> None:
        """Have the handler answer."""
        if self.done:
            return
        try:
            response = wire.transmit(self.service.respond(self))
        except Refusal as refusal:
            self.finish(failure=str(refusal))
        except Exception as problem:  # the caller shall not wait for ever because a handler is broken
            kernel.unhandled(kernel.current(), problem)
            self.finish(failure=f"error processing request: {problem}")
        else:
            self.finish(response)

    def finish(self, response: RosMessage | None = None, failure: str | None = None, lost: bool = False) -> None:
        """End the call; the first end counts."""
        if not self.done:
            self.service.pending.discard(self)
            self.response, self.failure, self.lost, self.done = response, failure, lost, True
            self.when_done(self)


def exchange(service: Service, request: RosMessage) -> Call:
    """Send ``request`` to the `Service` and park until it is answered; the finished `Call`."""
    task = kernel.current()
    call = Call(service, wire.transmit(request), lambda _: kernel.unpark(task))
    service.submit(call)
    while not call.done:
        kernel.park(f"the answer of service {service.name}")
    return call


def start_call(service: Service, request: RosMessage, when_done: Callable[[Call], object], caller: object = None) -> Call:
    """Send ``request`` to the `Service` and return the `Call`, without waiting. To be called with the baton, in a task or not.

    when_done: a function of the finished call; it is called in whatever task serves the request, or in none, and must not wait.
    It may run before this function returns. caller: a client of another process; it has a set ``at_end`` of functions that are called
    when it has gone, so that a service can end what it began for it, and ``limits``, how much it may ask for (`rosbridge.guard.Limits`). A
    request that cannot be sent (a wrong type in a field) is a failed call.
    """
    call = Call(service, request, when_done, caller)

    def submit() -> None:
        call.request = wire.transmit(request)
        service.submit(call)

    conditions.handler_case([(Error, lambda problem: call.finish(failure=str(problem)))], submit)
    return call
