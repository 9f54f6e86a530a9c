"""Start, shut down and find the node of the Lisp program.

`start_ros_node` prints the six lines of the original. In virtual time, the clock advances by the 1.09 s that the original takes,
so stamps look as on the slides. In wall time, the node starts at once. Source: roslisp.md 2.
"""

from __future__ import annotations

import os

from ... import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.data import Cons, LispString, Symbol, python_list, truth
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.hash_tables import HashTable
from cramhy_runtime.lisp_core.output import standard_output
from cramhy_runtime.lisp_core.floats import literal_float
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import princ_to_string
from cramhy_runtime.utilities.wait_queue import need
from .. import graph, messages, names, rosout
from . import log_file, logging, master
from .errors import ros_error
from .master import MASTER_URI
from .parameter_values import encode
from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

    from cramhy_runtime.lisp_core.data import Keyword
    from ..signatures import Text

T = TypeVar("T")
STARTUP_SECONDS = 1.094
"""Seconds that starting a node took in the golden transcript."""
SHUTDOWN_SECONDS = 3.5
"""Seconds to wait at most for the cleanup of callbacks: shutting a node down takes as long in the original."""
ROSOUT_DELAY = 0.05
"""Seconds until the log collector has connected to a new node. Before that, log calls reach no subscriber."""

NODE_NAME = special("ROSLISP::*ROS-NODE-NAME*")
NODE_STATUS: Symbol = special("ROSLISP::*NODE-STATUS*", sym(":SHUTDOWN"))
NAMESPACE: Symbol = special("ROSLISP::*NAMESPACE*", "/")
REMAPPED_NAMES: Symbol = special("ROSLISP::*REMAPPED-NAMES*")
LOG_LOCATION: Symbol = special("ROSLISP::*ROS-LOG-LOCATION*")
"""Internal variables of roslisp, which programs look at all the same."""
RUNNING_FROM_COMMAND_LINE = special("ROSLISP::*RUNNING-FROM-COMMAND-LINE*")


def node_status() -> Keyword:
    """The status of the node: ``:running`` or ``:shutdown``."""
    return sym(":SHUTDOWN") if graph.active().lisp_node is None else sym(":RUNNING")


def require_node() -> graph.Node:
    """The node of the Lisp program. Without one, it is an error with a restart that starts a dummy node."""
    here = graph.active().lisp_node
    while here is None:
        problem = SimpleError("Node status is SHUTDOWN")
        problem.hint = 'No ROS node runs here. (start-ros-node "name") starts one.'
        conditions.cerror("Start a dummy node", problem)
        start_ros_node("dummy")
        here = graph.active().lisp_node
    return here


def fully_qualified_name(name: Text) -> str:
    """The global name of ``name`` for the node. It works without a node too. Source: roslisp.md 3."""
    here = graph.active().lisp_node
    if not isinstance(name, (str, LispString)):
        return conditions.type_error(name, "STRING", "\nwhen binding ROSLISP::NAME")
    if here is not None:
        return here.resolve(str(name))
    return names.qualify(str(name), names.as_namespace(os.environ.get("ROS_NAMESPACE")), NODE_NAME.value)


command_line: Cell[tuple[str, ...]] = Cell(())
"""The words behind the name of the program, where it was started by ``rosrun``: ``:cmd-line-args`` of nodes that say nothing else."""


def start_ros_node(
    name: Text, *, master_uri: Text | master.Uri | None = None, anonymous: bool | None = None, cmd_line_args: Any = None, **others: object
) -> int | None:
    """Start the node ``name``. A running node is shut down first. Returns the number of ``/rosout`` subscribers, usually 0.

    ``anonymous``: append microseconds and seconds to the name. ``cmd_line_args``: a list of strings, or one string.
    ``master_uri``: a string or a `Uri`. Other arguments are ignored, except two old ones, which are errors. A master that cannot be
    reached is an error. Source: roslisp.md 2.
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
    address = master.chosen_uri(master_uri)
    for prepare in here.before_first_node:
        prepare()
    here.before_first_node.clear()
    MASTER_URI.value = address
    NODE_NAME.value, NAMESPACE.value = naming.node_name, naming.namespace
    REMAPPED_NAMES.value = table = HashTable("EQUAL")
    for left, right in naming.remappings.items():
        table.put(left, right)
    _contact_master(naming, address)
    _open_log_file(naming)
    node = here.add_node(naming)
    try:
        _upload_parameters(node)
        logging.read_levels(node)
        _announce(node, address)
        if kernel.active().clock.virtual:
            kernel.sleep(STARTUP_SECONDS)
        here.lisp_node = node
        NODE_STATUS.value = node_status()
        _connect_services(node)
        node.on_shutdown.append(_ended)  # also when somebody else ends it, as rosnode kill does
        return _top("Node startup complete")
    except BaseException:  # an interrupt, or the end of the task: half a node helps nobody
        node.shutdown()
        log_file.stop()
        raise


def _contact_master(naming: names.Naming, address: master.Uri) -> None:
    problem = master.connection_problem(address)
    if problem is None:
        return
    hint = "The master is in this process, and a node finds it when :master-uri is left out."
    for name, _, _ in reversed(naming.private_parameters):  # they are the first thing that it would be told
        ros_error("Could not contact master at ~a when setting param ~a", address, naming.resolve(name), hint=hint)
    ros_error("Could not contact master at ~a when getting param list: ~a", address, problem, hint=hint)


def _naming(here: graph.Graph, name: str, anonymous: object, arguments: Any) -> names.Naming:
    if anonymous is not None and anonymous is not False:
        now = here.now()
        name = f"{name}_{int(now % 1 * 1e6)}_{int(now)}"
    if not names.is_base_name(name):
        conditions.warn("~a", f"{name} is not a legal ROS base name. This may cause problems with other ROS tools")
    naming = names.Naming(name, os.environ.get("ROS_NAMESPACE") or "/")
    if arguments is None:
        arguments = list(command_line.value) or None
    if arguments is not None and not isinstance(arguments, (str, LispString)):
        arguments = python_list(need(arguments, (Cons, list, tuple), "LIST"))
    naming.apply_arguments(
        names.split_arguments(str(arguments) if isinstance(arguments, LispString) else arguments), names.read_private_value
    )
    return naming


def _announce(node: graph.Node, address: master.Uri) -> None:
    naming = node.naming
    _top(f"Node name is {naming.node_name}")
    _top(f"Namespace is {naming.namespace}")
    pairs = " ".join(f"({name} . {raw})" for name, _, raw in naming.private_parameters)
    _top(f"Params are {f'({pairs})' if pairs else 'NIL'}")
    _top("Remappings are:" + "".join(f"\n  {left} = {right}" for left, right in naming.remappings.items()))
    _top(f"master URI is {address.address}:{address.port}")


def _top(text: str) -> int | None:
    return logging.log_text(logging.INFO, ("ROSLISP", "TOP"), text)


def _connect_services(node: graph.Node) -> None:
    rosout.join(node, ROSOUT_DELAY)
    tree = node.graph.parameters
    if tree.has("/use_sim_time") and tree.get("/use_sim_time") in (True, 1, "true", "T"):
        node.simulated_time = literal_float(0.0)

        def tick(message):
            node.simulated_time = message.clock

        node.subscribe("/clock", messages.message_class_exact("rosgraph_msgs/Clock"), tick, queue=5)
    empty = messages.service_type_exact("std_srvs/Empty")

    def reset_levels(_):
        logging.read_levels(node)
        return empty.response()

    node.serve("~reset_debug_levels", empty, reset_levels)


def _upload_parameters(node: graph.Node) -> None:
    """Set the private parameters of the node's command line."""
    for name, value, _ in reversed(node.naming.private_parameters):
        node.graph.parameters.set(names.qualify(name, node.naming.namespace, node.name), encode(value))


def _open_log_file(naming: names.Naming) -> None:
    path = log_file.place(naming, graph.active().now())
    LOG_LOCATION.value = None if path is None else str(path)
    if path is None:
        return
    try:
        log_file.start(path)
    except OSError as problem:
        ros_error("Could not open the log file ~a: ~a. Choose another one with __log:=FILE.", str(path), problem.strerror)


def shutdown_ros_node() -> None:
    """Shut the node down, with its topics, services and tasks. If none runs, do nothing. An executable ends with its node.

    Returns nil. Source: roslisp.md 2.
    """
    here = graph.active().lisp_node
    if here is None:
        return None
    tasks = [task for entry in (*_entries(here.subscriptions), getattr(here, "event_loop", None)) if (task := getattr(entry, "task", None))]
    here.shutdown()
    limit = kernel.now() + SHUTDOWN_SECONDS
    for task in tasks:
        if task is not kernel.current():
            task.join(f"{task.name} to end with the node", limit, claim=False)
    if truth(RUNNING_FROM_COMMAND_LINE.value):
        raise SystemExit(0)


def _entries(table: dict[str, list[Any]]) -> list[Any]:
    return [entry for entries in table.values() for entry in entries]


def _ended() -> None:
    NODE_STATUS.value = sym(":SHUTDOWN")
    _top("Shutdown complete")
    log_file.stop()


def with_ros_node(name: Text, body: Callable[[], T], *, spin: bool | None = None, **options: Any) -> T:
    """Run ``body`` with the node ``name``, and shut the node down however ``body`` ends. Returns the values of ``body``.

    ``spin``: if true, wait for ever after the body. ``options``: as for `start_ros_node`. Source: roslisp.md 2.
    """

    def shut_down(condition=None):
        text = "About to shutdown" if condition is None else f"About to shutdown due to condition {condition}"
        return _top(text)

    def run():
        start_ros_node(name, **options)
        result = body()
        while truth(spin):
            kernel.park("nothing: the node spins until it is shut down", kernel.now() + 100)
        return result

    try:
        return conditions.restart_case([(sym("ROSLISP::SHUTDOWN-ROS-NODE"), shut_down, "Shut the node down.")], run)
    finally:
        with kernel.shield():
            shutdown_ros_node()


def standalone_exec_debug_hook(condition: BaseException, hook: object = None) -> None:
    """The debugger hook of executables: shuts the node down if one runs."""
    if graph.active().lisp_node is not None:
        conditions.invoke_restart(sym("ROSLISP::SHUTDOWN-ROS-NODE"), condition)


def print_status() -> None:
    """Print the node's name, state, master, publications and subscriptions."""
    here = graph.active().lisp_node
    stream = standard_output()
    stream.fresh_line()
    stream.write(f"Node {NODE_NAME.value or 'NIL'} is {node_status().name}, master {princ_to_string(MASTER_URI.value)}\n")
    for title, table in (
        ("Publications", {name: entry.type.ros_type for name, entry in here.publications.items()} if here else {}),
        ("Subscriptions", {name: entries[0].type.ros_type for name, entries in here.subscriptions.items()} if here else {}),
    ):
        stream.write(f"{title}:\n" + "".join(f"  {name} [{kind}]\n" for name, kind in table.items()))
