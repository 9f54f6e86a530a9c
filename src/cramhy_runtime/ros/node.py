"""The node of the Lisp program: starting it, shutting it down, asking for it.

`start_ros_node` prints the six lines of the original. In virtual time the 1.09 s that the original takes pass on the clock, so
that stamps look as on the slides; nobody waits for them. In wall time the node is up at once. Source: roslisp.md 2.
"""

from __future__ import annotations

import os
from pathlib import Path

from .. import kernel
from ..lisp import conditions
from ..lisp.condition_types import SimpleError
from ..lisp.data import LispString, python_list
from ..lisp.dynamic import special
from ..lisp.packages import sym
from ..lisp.printer.printer import princ_to_string
from . import graph, logging, messages, names, parameters
from .errors import ros_error

STARTUP_SECONDS = 1.094
"""What starting a node took when the golden transcript was recorded."""
ROSOUT_DELAY = 0.05
"""Seconds until the log collector has connected to a new node: its first log calls reach nobody."""
DEFAULT_MASTER = "http://127.0.0.1:11311"

NODE_NAME = special("ROSLISP::*ROS-NODE-NAME*")
MASTER_URI = special("ROSLISP::*MASTER-URI*")
DEFAULT_MASTER_URI = special("ROSLISP::*DEFAULT-MASTER-URI*")

_log_file = None


class Uri:
    """The address of a master (``make-uri``)."""

    lisp_name = "ROSLISP::URI"
    __slots__ = ("address", "port")

    def __init__(self, address, port):
        self.address, self.port = address, port


def make_uri(address, port):
    """An address as `start_ros_node` takes it."""
    return Uri(address, port)


def master_uri():
    """The `Uri` in use, or ``None`` before the first node."""
    return MASTER_URI.value


def node_status():
    """``:running`` or ``:shutdown``."""
    return sym(":SHUTDOWN") if graph.active().lisp_node is None else sym(":RUNNING")


def require_node():
    """The node of the Lisp program. Without one: the continuable error that offers to start a dummy."""
    here = graph.active().lisp_node
    while here is None:
        problem = SimpleError("Node status is SHUTDOWN")
        problem.hint = 'No ROS node runs here. (start-ros-node "name") starts one.'
        conditions.cerror("Start a dummy node", problem)
        start_ros_node("dummy")
        here = graph.active().lisp_node
    return here


def fully_qualified_name(name):
    """The global name that ``name`` means to the node; works without a node too."""
    here = graph.active().lisp_node
    if not isinstance(name, (str, LispString)):
        return conditions.type_error(name, "STRING", "\nwhen binding ROSLISP::NAME")
    if here is not None:
        return here.resolve(str(name))
    return names.qualify(str(name), names.as_namespace(os.environ.get("ROS_NAMESPACE")), NODE_NAME.value)


def start_ros_node(name, *, master_uri=None, anonymous=None, cmd_line_args=None, **others):
    """Start the node ``name``. Returns the number of ``/rosout`` subscribers, usually 0.

    anonymous: append microseconds and seconds. cmd_line_args: a list of strings, or one string. master_uri: a string or a
    `Uri`. Others are ignored, but for two that are errors since long.
    """
    for gone in ("xml-rpc-port", "pub-server-port"):
        if gone.replace("-", "_") in others:
            return conditions.error(SimpleError("~a", f"start-ros-node no longer accepts the {gone} argument"))
    if not isinstance(name, (str, LispString)):
        return conditions.type_error(name, "STRING", "\nwhen binding ROSLISP::NAME")
    here = graph.active()
    if here.lisp_node is not None:
        conditions.warn(
            "Before starting node, node-status equalled RUNNING instead of :shutdown.  Shutting the previous node invocation down now."
        )
        shutdown_ros_node()
    naming = _naming(here, str(name), anonymous, cmd_line_args)
    address = _master_address(master_uri)
    for prepare in here.before_first_node:
        prepare()
    here.before_first_node.clear()
    MASTER_URI.value = address
    NODE_NAME.value = naming.node_name
    _open_log_file(naming)
    node = here.add_node(naming)
    parameters.upload(node)
    logging.read_levels(node)
    _announce(node, address)
    if kernel.active().clock.virtual:
        kernel.sleep(STARTUP_SECONDS)
    here.lisp_node = node
    _connect_services(node)
    return _top("Node startup complete")


def _naming(here, name, anonymous, arguments):
    if anonymous is not None and anonymous is not False:
        now = here.now()
        name = f"{name}_{int(now % 1 * 1e6)}_{int(now)}"
    if not names.is_base_name(name):
        conditions.warn("~a", f"{name} is not a legal ROS base name. This may cause problems with other ROS tools")
    naming = names.Naming(name, os.environ.get("ROS_NAMESPACE") or "/")
    if arguments is not None and not isinstance(arguments, (str, LispString)):
        arguments = python_list(arguments)
    naming.apply_arguments(
        names.split_arguments(str(arguments) if isinstance(arguments, LispString) else arguments),
        names.read_private_value,
    )
    return naming


def _master_address(given):
    if isinstance(given, Uri):
        return Uri(_dotted(given.address), given.port)
    if given is None:
        given = DEFAULT_MASTER_URI.value
        if given is None:
            given = os.environ.get("ROS_MASTER_URI") or DEFAULT_MASTER
    if not isinstance(given, (str, LispString)) or not str(given):
        return conditions.error(
            SimpleError(
                "Master uri needs to be supplied either as an argument to start-ros-node, or through the environment "
                "variable ROS_MASTER_URI, or by setting the lisp variable *default-master-uri*"
            )
        )
    text = str(given)
    scheme, separator, rest = text.rstrip("/").partition("://")
    host, colon, port = rest.partition(":")
    if scheme != "http" or not separator or not host or not port.isdigit():
        return conditions.error(SimpleError("~a", f"Malformed URI {text}"))
    return Uri(_dotted(host), int(port))


def _dotted(host):
    return "127.0.0.1" if host == "localhost" else host


def _announce(node, address):
    naming = node.naming
    _top(f"Node name is {naming.node_name}")
    _top(f"Namespace is {naming.namespace}")
    pairs = " ".join(f"({name} . {raw})" for name, _, raw in naming.private_parameters)
    _top(f"Params are {f'({pairs})' if pairs else 'NIL'}")
    _top("Remappings are:" + "".join(f"\n  {left} = {right}" for left, right in naming.remappings.items()))
    _top(f"master URI is {address.address}:{address.port}")


def _top(text):
    return logging.log_text(logging.INFO, ("ROSLISP", "TOP"), text)


def _connect_services(node):
    from . import services

    logging.join_rosout(node, ROSOUT_DELAY)
    tree = node.graph.parameters
    if tree.has("/use_sim_time") and tree.get("/use_sim_time") in (True, 1, "true", "T"):
        node.simulated_time = 0.0

        def tick(message):
            node.simulated_time = message.clock

        node.subscribe("/clock", messages.message_class_exact("rosgraph_msgs/Clock"), tick, queue=5)
    empty = messages.service_type_exact("std_srvs/Empty")

    def reset_levels(_):
        logging.read_levels(node)
        return empty.response()

    services_name = node.resolve("~reset_debug_levels")
    node.services[services_name] = node.graph.services[services_name] = services.Service(node, services_name, empty, reset_levels)


def shutdown_ros_node():
    """Shut the node down: its topics, services and tasks end. NIL when none is running."""
    here = graph.active().lisp_node
    if here is None:
        return None
    here.shutdown()
    result = _top("Shutdown complete")
    _close_log_file()
    return result


def with_ros_node(name, body, *, spin=None, **options):
    """Run ``body`` with a node, and shut it down on every way out. With ``spin`` wait for ever after the body."""

    def shut_down(condition=None):
        text = "About to shutdown" if condition is None else f"About to shutdown due to condition {condition}"
        return _top(text)

    def run():
        try:
            start_ros_node(name, **options)
            result = body()
            while spin is not None and spin is not False:
                kernel.park("nothing: the node spins until somebody ends it", kernel.now() + 100)
            return result
        finally:
            with kernel.shield():
                shutdown_ros_node()

    return conditions.restart_case([(sym("ROSLISP::SHUTDOWN-ROS-NODE"), shut_down, "Shut the node down.")], run)


def standalone_exec_debug_hook(condition, hook=None):
    """Debugger hook of executables: ends the node when one is running."""
    if graph.active().lisp_node is not None:
        conditions.invoke_restart(sym("ROSLISP::SHUTDOWN-ROS-NODE"), condition)


def print_status():
    """Print the node's name, state, master, and what it publishes and subscribes to."""
    here = graph.active().lisp_node
    stream = sym("*STANDARD-OUTPUT*").value
    stream.fresh_line()
    stream.write(f"Node {NODE_NAME.value or 'NIL'} is {node_status().name}, master {princ_to_string(MASTER_URI.value)}\n")
    for title, table in (
        ("Publications", here.publications if here else {}),
        ("Subscriptions", here.subscriptions if here else {}),
    ):
        stream.write(f"{title}:\n" + "".join(f"  {name} [{entry.type.ros_type}]\n" for name, entry in table.items()))


# ---------------------------------------------------------------------------------------------------------------- log file


def _open_log_file(naming):
    """Open the file of ``__log:=`` or below ``$ROS_LOG_DIR``; without either no file is written."""
    global _log_file
    _close_log_file()
    path = naming.log_file
    if path is None and os.environ.get("ROS_LOG_DIR"):
        path = Path(os.environ["ROS_LOG_DIR"]) / f"{naming.base_name}-{int(graph.active().now())}.log"
    if path is None:
        return
    try:
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        _log_file = open(path, "a", encoding="utf-8")
    except OSError as problem:
        ros_error("Could not open the log file ~a: ~a. Choose another one with __log:=FILE.", str(path), problem.strerror)


def write_log_file(line):
    if _log_file is not None:
        _log_file.write(line)
        _log_file.flush()


def _close_log_file():
    global _log_file
    if _log_file is not None:
        _log_file.close()
        _log_file = None
