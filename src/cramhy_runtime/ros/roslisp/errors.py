"""The conditions of roslisp, and how it reports its own errors.

Programs rely on two habits of roslisp. Most errors are logged at level ERROR on the root topic, and then signalled with the same
text (`ros_error`). ``ros-rpc-error``, the master's error, is not a subclass of ``error``, so a handler for errors does not see
it (roslisp.md 7.1 and trap 6).
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Condition, Error, SimpleError
from cramhy_runtime.lisp_core.printing import format_to_string
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.lisp_core.printing import princ_to_string
from ..names import allowed_name, check_graph_name
from . import logging
from .master import master_uri
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from .master import Uri


class RosRpcError(Condition):
    """The master refused a call. ``call``: the text of the call. ``code``, ``message``, ``result``: the master's answer."""

    lisp_name = "ROSLISP::ROS-RPC-ERROR"

    def __init__(self, call: str = "", uri: Uri | None = None, code: int = -1, message: str = "", result: object = "", **slots: object):
        super().__init__(**slots)
        self.call, self.uri, self.code, self.message, self.result = call, uri, code, message, result
        if message == "no provider":
            self.hint = (
                "No node offers this service. rosservice list, typed at the prompt, shows those that there are; "
                "(wait-for-service name) waits for one."
            )

    def report(self) -> str:
        return (
            f"ros-rpc call ({self.call}) to {princ_to_string(self.uri)} failed with code {self.code}, "
            f"message {self.message}, values {self.result}"
        )


class ServiceError(SimpleError):
    """A service callback signals this to refuse a request with its own text."""

    lisp_name = "ROSLISP::SERVICE-ERROR"


class ServiceCallError(Error):
    """A call of a persistent service failed. ``message`` says why."""

    lisp_name = "ROSLISP::SERVICE-CALL-ERROR"
    initargs = {"MESSAGE": "message"}
    message = ""

    def report(self) -> str:
        return f"service-call-error: {self.message}"


def ros_error(control: str, *arguments: object, hint: str | Callable[[], str] | None = None) -> NoReturn:
    """Log the format ``control`` with ``arguments`` at level ERROR on the root topic, then signal it as a simple error.

    ``hint``: what to try, or a function that returns it. Users see it below the error; it is not part of the error's text.
    """
    logging.log_text(logging.ERROR, None, format_to_string(control, *arguments))
    conditions.error(SimpleError(control, *arguments), hint=hint)


def legal(name: str, kind: str) -> str:
    """``name`` if ROS's rules allow it for a topic, service or parameter (``kind``), else it is an error with roscpp's text.

    The name is as the program gave it, since the node's own name, which goes before private ones, is another matter. An empty name is an
    error of its own, where it is resolved. Source: turtlesim.md 6, wiki.ros.org/Names.
    """
    complaint = check_graph_name(name)
    if complaint is not None:
        ros_error(
            "~a", complaint, hint=f'"{name}" cannot be the name of a {kind}, since ROS does not allow it. Try "{allowed_name(name)}".'
        )
    return name


def close_names(name: str, names: Iterable[str], otherwise: str) -> str:
    """The hint for an unknown ``name``: similar names from ``names``, or the sentence ``otherwise``."""
    close = near_names(name, names)
    return f"Did you mean {' or '.join(close)}?" if close else otherwise


def rpc_error(call: str, code: int, message: str, result: object = "", hint: str | None = None) -> None:
    """Signal that the master refused ``call``, as a ``ros-rpc-error`` with the restart ``Ignore and continue``.

    ``code``, ``message``, ``result``: the master's answer. ``hint``: what to try, instead of the usual hint.
    """
    problem = RosRpcError(call, master_uri(), code, message, result)
    if hint is not None:
        problem.hint = hint
    return conditions.cerror("Ignore and continue", problem)
