"""Actions from Python: a server that works on goals, and a client that waits for them.

    from cramhy_runtime.actionlib.python import action_client, action_server, call_goal, publish_feedback, succeed_current

    @action_server("count", "actionlib_tutorials/FibonacciAction")
    def count_up(goal):
        publish_feedback(sequence=[goal.order])
        succeed_current(sequence=[goal.order, goal.order])

    client = action_client("count", "actionlib_tutorials/FibonacciAction")
    result, state = call_goal(client, order=3)          # state is kw.succeeded

Both need a node (``cramhy_runtime.ros.python.ros_node``). Messages are objects with attributes; where a goal, a result or a feedback is
sent, its fields are keyword arguments. They are the functions of the package ACTIONLIB. Source: roslisp.md 13.2.
"""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar

from cramhy_runtime.ros.messages import RosMessage
from cramhy_runtime.ros.received import for_python

from . import calls, server
from .client import ActionClient
from .goals import ABORTED, PREEMPTED, SUCCEEDED

if TYPE_CHECKING:
    from collections.abc import Callable

    from cramhy_runtime.lisp_core.data import Keyword

F = TypeVar("F", bound="Callable[..., object]")


def action_server(name: str, action_type: str) -> Callable[[F], F]:
    """Decorator: the function works on one goal of the action ``name`` after the other, in a task of its own, until the node ends.

    action_type: ``"package/NameAction"``. The function gets the goal message, and ends it by `succeed_current`, `abort_current` or
    `preempt_current`. If it raises an exception, or only returns, the goal is aborted, and the log tells why. Errors: a failure if the
    node has a server of that name already, or if there is no such type.
    """

    def serve(function: F) -> F:
        server.start_action_server(name, action_type, lambda goal: function(for_python(goal)), separate_thread=True)
        return function

    return serve


def succeed_current(**result: object) -> NoReturn:
    """The goal is reached; ``result`` are the fields of its result. This leaves the function of the server."""
    _end(SUCCEEDED, result)


def abort_current(**result: object) -> NoReturn:
    """The goal cannot be reached. This leaves the function of the server."""
    _end(ABORTED, result)


def preempt_current(**result: object) -> NoReturn:
    """The goal was given up, because it was cancelled or another one came. This leaves the function of the server."""
    _end(PREEMPTED, result)


def _end(state: int, fields: dict[str, object]) -> NoReturn:
    server.end_current(state, server.current_class("result")(**fields))
    raise AssertionError("the function of the server has been left")


def publish_feedback(**feedback: object) -> int:
    """Tell the client how far the goal is; the number of subscribers that were reached."""
    reached: int = server.publish_feedback(server.current_class("feedback")(**feedback))
    return reached


def cancel_requested() -> bool:
    """Whether somebody wants the goal to be given up that the function of the server works on."""
    return server.cancel_request_received() is True


def action_client(name: str, action_type: str, timeout: float | None = None) -> ActionClient:
    """A client of the action ``name``, when its server has given a sign of life.

    timeout: seconds to wait for that; ``None`` is no limit. Errors: TimeoutError when they are over.
    """
    client = ActionClient(name, action_type)
    if not client.wait_for_server(timeout or 0):
        raise TimeoutError(f"No server of the action {name} gave a sign of life within {timeout:g} s. Does it run, under that name?")
    return client


def make_goal(client: ActionClient, **fields: object) -> RosMessage:
    """A goal message of the action of ``client``."""
    goal: RosMessage = client.action.goal(**fields)
    return goal


def call_goal(
    client: ActionClient,
    goal: RosMessage | None = None,
    *,
    time_limit: float | None = None,
    on_feedback: Callable[[Any], object] | None = None,
    **fields: object,
) -> tuple[Any, Keyword]:
    """Send a goal, a message or its fields, and wait for its end: its result, and its state such as ``kw.succeeded``.

    time_limit: seconds after which the goal is cancelled; the values are then ``None`` and ``kw.timeout``. on_feedback: it is called with
    each feedback. A plan that is ended meanwhile cancels the goal. Errors: a failure if the server falls silent for two seconds.
    """
    if goal is None:
        goal = make_goal(client, **fields)
    elif fields:
        raise TypeError("call_goal was given a goal and fields of one. Give one of them: call_goal(client, order=3).")
    heard = None if on_feedback is None else lambda feedback: on_feedback(for_python(feedback))
    result, state = calls.call_goal(client, goal, timeout=time_limit, feedback_cb=heard)
    return for_python(result) if isinstance(result, RosMessage) else result, state
