"""Services and their calls, the common part of all nodes.

A `Service` belongs to a node. A spinning node, such as turtlesim, handles a request in its next tick; any other node handles it at
once. The services of the Lisp program (``roslisp/services.py``) queue for a task of their own. There are two ways to call:

* `exchange` is for tasks: it parks until the answer comes.
* `start_call` is for code that must not wait: callbacks, timers, and functions that outside threads `kernel.post`, as the bridge
  to other processes does. It returns the `Call` at once, and calls ``when_done(call)`` at the end of the call.

Every call ends exactly once, in one of three ways: with a ``response``; with ``failure``, the text of a server that refused; or
``lost``, because the server went away. If a handler raises anything but `Refusal`, the caller gets it as a failure, and it is
reported (law 3). Source: roslisp.md 7, wiki.ros.org/Services.
"""

from __future__ import annotations

from .. import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Error
from . import wire
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from .graph import Node
    from .messages import RosMessage, ServiceType
    from .signatures import Handler


class Refusal(Exception):
    """A handler in Python raises this to refuse a request: the service answers "not ok" with this text."""


class Service:
    """An offered service: its node, its global name, its `ServiceType`, and the handler of requests."""

    lisp_name = "ROSLISP::SERVICE"

    def __init__(self, node: Node, name: str, service_type: ServiceType, handler: Handler):
        self.node, self.name, self.type, self.handler = node, name, service_type, handler
        self.pending: set[Call] = set()
        self.closed = False

    def respond(self, call: Call) -> RosMessage:
        """Run the handler; returns the response to ``call``. An exception is the call's failure."""
        return self.handler(call.request)

    def close(self) -> None:
        """End the service. All waiting calls are lost."""
        self.closed = True
        for call in list(self.pending):
            call.finish(lost=True)

    def submit(self, call: Call) -> None:
        """Accept ``call``, and answer it now or in the node's next spin."""
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
        """Run the handler with request and caller; returns the response to ``call``."""
        return self.handler(call.request, call.caller)


class Call:
    """One call of a service.

    When it is ``done``, ``failure`` is the server's text if it refused, ``lost`` is true if no answer came, else ``response`` is the
    answer. At the end, ``when_done`` is called with the call. ``caller``: see `start_call`.
    """

    __slots__ = ("service", "request", "when_done", "caller", "done", "response", "failure", "lost")

    def __init__(self, service: Service, request: RosMessage, when_done: Callable[[Call], object], caller: object = None):
        self.service, self.request, self.when_done, self.caller = service, request, when_done, caller
        self.done = self.lost = False
        self.response: RosMessage | None = None
        self.failure: str | None = None

    def serve(self) -> None:
        """Run the handler and finish the call."""
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
        """End the call with ``response``, ``failure`` or ``lost``. Only the first end counts."""
        if not self.done:
            self.service.pending.discard(self)
            self.response, self.failure, self.lost, self.done = response, failure, lost, True
            self.when_done(self)


def exchange(service: Service, request: RosMessage) -> Call:
    """Send ``request`` to ``service``, park until the answer comes, and return the finished `Call`."""
    task = kernel.current()
    call = Call(service, wire.transmit(request), lambda _: kernel.unpark(task))
    service.submit(call)
    while not call.done:
        kernel.park(f"the answer of service {service.name}")
    return call


def start_call(service: Service, request: RosMessage, when_done: Callable[[Call], object], caller: object = None) -> Call:
    """Send ``request`` to ``service`` and return the `Call`, without waiting. Call it with the baton, in a task or not.

    ``when_done``: a function of the finished call. It runs in the task that handles the request, or in none, must not wait, and may
    run before this function returns. ``caller``: a client of another process. It has a set ``at_end`` of functions to call when it
    has gone, so that a service can end its work for it, and ``limits`` on its requests (`rosbridge.guard.Limits`). A request that
    cannot be sent, such as one with a wrong type in a field, is a failed call.
    """
    call = Call(service, request, when_done, caller)

    def submit() -> None:
        call.request = wire.transmit(request)
        service.submit(call)

    conditions.handler_case([(Error, lambda problem: call.finish(failure=str(problem)))], submit)
    return call
