"""Call and offer services from the Lisp program.

The services of the program run one at a time in the task ``ROSLisp event loop``. If no node offers a service, its call signals
``ros-rpc-error``, which is not an ``error``. If the server refuses, it is a simple error with the server's text.
Source: roslisp.md 7.
"""

from __future__ import annotations

from collections import deque

from ... import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.kernel.unstarted import plain_function
from cramhy_runtime.lisp_core.condition_types import Condition, Error, SimpleError, SimpleTypeError, shown
from cramhy_runtime.lisp_core.data import LispString, Symbol
from cramhy_runtime.lisp_core.functions import function_named
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.packages import sym, symbol_name
from cramhy_runtime.lisp_core.printing import princ_to_string
from cramhy_runtime.utilities.wait_queue import need, time_limit
from .. import messages, wire
from ..message_building import get_field, instance
from ..messages import RosMessage
from ..received import for_lisp, for_python, lisp_receiver
from ..services import Service, exchange
from ..strict import check
from . import logging, node
from .errors import ServiceCallError, ServiceError, legal, ros_error, rpc_error
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..graph import Node
    from ..services import Call
    from ..signatures import Handler, MessageType, ServiceName, Text


NAMED_BY_STRINGS = 'A service is named by a string, such as "/clear". Has the variable been set that holds it?'


class LispService(Service):
    """A service of the Lisp program. The task of the node's event loop handles the requests one after the other."""

    def submit(self, call: Call) -> None:
        """Queue ``call`` for the event loop. A call from the event loop itself is answered at once."""
        if self.closed:
            call.finish(lost=True)
            return
        self.pending.add(call)
        loop = event_loop(self.node)
        if loop.task is kernel.current():  # a callback that calls a service of its own node; the original waits for itself
            self.answer(call)
        else:
            loop.queue.append((self, call))
            kernel.unpark(loop.task)

    def answer(self, call: Call) -> None:
        """Run the callback and finish ``call``, even if the callback fails."""

        def refuse(condition):
            call.finish(failure=f"service cannot process request: {condition.report()}")

        def fail(condition):
            logging.log_text(
                logging.ERROR,
                ("ROSLISP", "SERVICE", "TCP"),
                f"Error processing request {princ_to_string(call.request)}:\n {condition.report()}",
            )
            call.finish(failure=f"error processing request: {condition.report()}")

        def run():
            response = self.handler(call.request)
            if not isinstance(response, RosMessage) or response.ros_type != self.type.response.ros_type:
                expected = self.type.response.lisp_name.replace("::", ":")
                return conditions.error(
                    SimpleError(
                        "~a",
                        f"The callback of service {self.name} must return a {expected} (see make-response), "
                        f"but it returned {princ_to_string(response)}.",
                    )
                )
            call.finish(wire.transmit(response))

        try:
            conditions.handler_case([(ServiceError, refuse), (Error, fail)], run)
        except Condition as condition:  # no error, but nobody handled it: the node's other services shall not die of it
            fail(condition)
        finally:
            if not call.done:
                call.finish(lost=True)


class EventLoop:
    """The task that serves the services of the Lisp program."""

    def __init__(self, node: Node):
        self.queue: deque[tuple[LispService, Call]] = deque()
        owner = node.graph.kernel
        self.task: kernel.Task[object] = owner.spawn(self._run, name="ROSLisp event loop", parent=owner.main)
        node.on_shutdown.append(lambda: self.task.cancel("the node was shut down"))

    def _run(self) -> None:
        while True:
            while self.queue:
                service, call = self.queue.popleft()
                service.answer(call)
            kernel.park("a request for a service of the node")


def event_loop(node: Any) -> EventLoop:
    """The event loop of the Lisp program's node. The first service starts it."""
    found = getattr(node, "event_loop", None)
    if found is None:
        found = node.event_loop = EventLoop(node)
    return found


# ------------------------------------------------------------------------------------------------------------------ clients


def call(service: Service, request: RosMessage) -> RosMessage | None:
    """Send ``request`` to ``service``, wait, and return the response. If the call fails, it is the client's error, logged too."""
    if request.ros_type != service.type.request.ros_type:
        return ros_error(
            "service-call to ~a with request ~a failed.",
            service.node.address,
            request,
            hint=f"The service {service.name} is of type {service.type.name}, which has another request.",
        )
    answer = exchange(service, request)
    if answer.lost:
        return ros_error("service-call to ~a with request ~a failed.", service.node.address, request)
    if answer.failure is not None:
        return ros_error(
            "service-call to ~a with request ~a failed with message: ~a",
            service.node.address,
            request,
            answer.failure,
            hint=None if answer.failure else lambda: _reason(service),
        )
    return answer.response


def _reason(service: Service) -> str:
    """The hint for a refusal without a text: the last error that the server logged may explain it."""
    server = service.node
    said = next((text for level, name, text in reversed(server.graph.log) if name == server.name and level >= logging.ERROR), None)
    told = f"The error that it logged last: {said}" if said else "rostopic echo /rosout, typed at the prompt, shows what it logs."
    return f"{server.name} refused to do {service.name}, and gave no reason. {told}"


def lookup(here: Node, name: str) -> Service | None:
    """The offered `Service` with the global name ``name``. If there is none, it is the master's ``ros-rpc-error``.

    If a handler ignores the error, the result is the service if it is offered by then, else ``None``.
    """
    if here.graph.service(name) is None:
        cut_off = here.graph.cut_off
        rpc_error(
            f"lookupService {name}",
            -1,
            f"no provider: {cut_off}" if cut_off else "no provider",
            hint=f'(wait-for-service "{name}") waits until the service is there again.' if cut_off else None,
        )
    return here.graph.services.get(name)


class ServiceClient:
    """The name and type of a service, to call it again and again (from ``make-service-client``)."""

    lisp_name = "ROSLISP::SERVICE-CLIENT"

    def __init__(self, name: str, service_type: messages.ServiceType):
        self.name, self.type = name, service_type


def make_service_client(service_name: Text, service_type: Text) -> ServiceClient:
    """A client for `call_service` and `wait_for_service`. Both arguments are strings, else it is a type error."""
    for name, value in (("SERVICE-NAME", service_name), ("SERVICE-TYPE", service_type)):
        if not isinstance(value, (str, LispString)):
            return conditions.error(
                SimpleTypeError(
                    "~a",
                    f"The value of ROSLISP::{name} is {shown(value)}, which is not of type STRING.",
                    datum=value,
                    expected_type="STRING",
                )
            )
    return ServiceClient(legal(str(service_name), "service"), messages.service_type(service_type))


def call_service(service: ServiceClient | Text, *rest_args: object) -> RosMessage | None:
    """Call a service and wait; returns the response. The arguments are ``name type . request`` or ``client . request``.

    The request is keywords and values, or exactly one request object. If no node offers the service, it is a ``ros-rpc-error``;
    if the call fails, an error. Source: roslisp.md 7.1.
    """
    response = _call_service(service, rest_args)
    return None if response is None else for_lisp(response)


def response_of(service: ServiceClient | Text, *rest_args: object) -> RosMessage | None:
    """`call_service` for any language: the response in the form that the graph has."""
    return _call_service(service, rest_args)


def checked_call_service(service: ServiceClient | Text, *rest_args: object) -> RosMessage | None:
    """`call_service` for Python and Hy. A request that Python would refuse is refused: an integer that is out of range is a ValueError."""
    response = _call_service(service, rest_args, check)
    return None if response is None else for_python(response)


def _call_service(
    service: ServiceClient | Text, rest_args: tuple[Any, ...], check_request: Callable[[RosMessage], None] | None = None
) -> RosMessage | None:
    here = node.require_node()
    if isinstance(service, ServiceClient):
        name, service_type, arguments = service.name, service.type, rest_args
    elif not isinstance(service, (str, LispString)):
        return no_applicable_method("ROSLISP:CALL-SERVICE", 2, service, *rest_args, advice=NAMED_BY_STRINGS)
    elif not rest_args:
        return conditions.error(
            SimpleError(
                "~a",
                "Error while parsing arguments to DESTRUCTURING-BIND:\n  too few elements in\n    ()\n  to satisfy "
                "lambda list\n    (SERVICE-TYPE &REST REQUEST-ARGS):\n  at least 1 expected, but got 0",
            )
        )
    else:
        name, service_type, arguments = legal(str(service), "service"), messages.service_type(rest_args[0]), rest_args[1:]
    request = _request(service_type, arguments)
    if check_request is not None:
        check_request(request)
    found = lookup(here, here.resolve(name))
    return None if found is None else call(found, request)


def _request(service_type: messages.ServiceType, arguments: tuple[Any, ...]) -> RosMessage:
    if len(arguments) == 1 and isinstance(arguments[0], RosMessage):
        return arguments[0]
    return instance(service_type.request, arguments)


def wait_for_service(service: ServiceClient | Text, timeout: float | None = None) -> bool | None:
    """Wait until the service is offered; returns T, or NIL after ``timeout`` seconds. It looks every 0.1 s. Source: roslisp.md 7.1."""
    here = node.require_node()
    if isinstance(service, ServiceClient):
        name = service.name
    elif isinstance(service, (str, LispString)):
        name = legal(str(service), "service")
    else:
        return no_applicable_method("ROSLISP:WAIT-FOR-SERVICE", 2, service, advice=NAMED_BY_STRINGS)
    if not name.startswith(("/", "~")):
        name = here.naming.namespace + name  # what the master makes of it; remappings are not looked at here
    deadline = time_limit(timeout)
    while here.graph.service(name) is None:
        if deadline is not None and kernel.now() >= deadline:
            return None
        pause = 0.1 if deadline is None else min(0.1, deadline - kernel.now())
        kernel.park(f"service {name} to be offered", kernel.now() + pause)
    return True


# ------------------------------------------------------------------------------------------------------------------ servers


def register_service_fn(service_name: Text, function: Handler | Symbol, service_type: ServiceName) -> int:
    """Offer the service ``service_name``: ``function`` takes the request and returns the response. Returns 1.

    If the node offers that service already, it is an error. Source: roslisp.md 7.2.
    """
    return offered(service_name, function, service_type, lisp_receiver)


def offered(
    service_name: Text, function: Handler | Symbol, service_type: ServiceName, receiver: Callable[[MessageType, Handler], Handler]
) -> int:
    """`register_service_fn` for any language: ``receiver(class, function)`` is the function that is called with the graph's requests."""
    here = node.require_node()
    kind = messages.service_type(service_type)
    if not isinstance(service_name, (str, LispString)):
        return conditions.type_error(service_name, "STRING", "\nwhen binding ROSLISP::SERVICE-NAME")
    name = here.resolve(legal(str(service_name), "service"))
    existing = here.services.get(name)
    if existing is not None:
        return ros_error("Cannot create service ~a as it already exists with info ~a", name, existing)
    if isinstance(function, Symbol):
        function = function_named(function)
    if not callable(function):
        return conditions.type_error(function, "FUNCTION", "\nwhen binding FUNCTION")
    plain_function(function, f"what answers the service {name}")
    here.add_service(LispService(here, name, kind, receiver(kind.request, function)))
    event_loop(here)
    return 1


def register_service(service_name: Text, symbol: Symbol) -> int:
    """Offer a service for the macro ``register-service``: ``symbol`` names both its type and the callback. Returns 1."""
    return register_service_fn(service_name, symbol, symbol)


# ------------------------------------------------------------------------------------------------------ persistent services


class PersistentService:
    """A service client with a lasting connection (``make-instance 'persistent-service``)."""

    lisp_name = "ROSLISP::PERSISTENT-SERVICE"
    initargs = {"SERVICE-NAME": "service_name", "SERVICE-TYPE": "service_type"}

    def __init__(self, service_name: Text, service_type: ServiceName):
        if not isinstance(service_name, (str, LispString)):
            conditions.type_error(service_name, "STRING", "\nwhen binding ROSLISP::SERVICE-NAME")
        legal(str(service_name), "service")
        self.service_name, self.service_type = service_name, service_type
        self.type = messages.service_type(service_type)
        self.connection: Service | None = None
        self.connect(node.require_node())

    def connect(self, here: Node) -> None:
        """Look the service up again for the node ``here``; errors as in `lookup`."""
        self.connection = lookup(here, here.resolve(str(self.service_name)))


def call_persistent_service(service: PersistentService, *request: object) -> RosMessage | None:
    """Call through the open connection; returns the response. A failure is a ``service-call-error`` with the restart ``reconnect``.

    ``request``: keywords and values, or exactly one request object.
    """
    here = node.require_node()
    message = _request(_persistent(service).type, request)
    while True:
        connection = service.connection
        if connection is not None and here.graph.services.get(connection.name) is connection:
            answer = exchange(connection, message)
            if not answer.lost and answer.failure is None:
                return None if answer.response is None else for_lisp(answer.response)
            problem = answer.failure or "The server closed the connection."
        else:
            problem = f"The connection is closed: {here.graph.cut_off}." if here.graph.cut_off else "The connection is closed."
        failure = ServiceCallError(message=problem)
        conditions.restart_case(
            [(sym("ROSLISP::RECONNECT"), lambda: service.connect(here), "Try reconnecting and call the service again.")],
            lambda failure=failure: conditions.error(failure),
        )


def close_persistent_service(service: PersistentService) -> None:
    """Close the connection of ``service``."""
    _persistent(service).connection = None


def persistent_service_ok(service: PersistentService) -> bool | None:
    """T while the connection is open and the server offers the service, else nil."""
    connection = _persistent(service).connection
    return True if connection is not None and connection.node.graph.services.get(connection.name) is connection else None


def _persistent(service: object) -> PersistentService:
    return need(service, PersistentService, "ROSLISP:PERSISTENT-SERVICE")


def call_named(service_name: Text, service_symbol: Symbol, return_field: Symbol | None, *request: object) -> Any:
    """Call a service for a function made by ``def-service-call``; returns the response, or its field ``return_field``."""
    response = call_service(service_name, service_symbol, *request)
    if return_field is None:
        return response
    return get_field(response, (symbol_name(return_field),))
