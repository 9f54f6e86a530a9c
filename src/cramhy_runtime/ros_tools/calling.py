"""``rosservice``: which services there are, of which types, who offers them; and to call one."""

from __future__ import annotations

from . import definitions, filling, message_text
from .graph_access import Refused
from .arguments import TOOLS, CommandError, command, global_name, meant, one, option


def _service(terminal, command, given, text, status=1):
    """(name, node, type) of the service that is given; ``text`` is the complaint when there is none."""
    name = global_name(one(TOOLS["rosservice"][command], given, "service name", more=command == "call"))
    facts = terminal.graph.service(name)
    if facts is None:
        near = meant(name, terminal.graph.services()).rstrip()
        raise CommandError(text.format(name=name) + (near and "\n" + near), status)
    return name, *facts


def _definition(ros_type):
    found = definitions.service_definition(ros_type)
    if found is None:
        raise CommandError(f"ERROR: Unable to load type [{ros_type}].\nHave you typed 'make' in [{ros_type.partition('/')[0]}]?", 2)
    return found


def _arguments(ros_type):
    return " ".join(field.name for field in _definition(ros_type)[0].fields)


@command("rosservice", "list", "[-n] [namespace]", "lists the services", option("-n --nodes", "with their nodes"))
def list_services(terminal, options, given):
    space = global_name(given[0]).rstrip("/") if given else ""
    for name in terminal.graph.services():
        if name == space or name.startswith(space + "/"):
            terminal.line(f"{name} {terminal.graph.service(name)[0]}" if options else name)


@command("rosservice", "info", "/service", "prints node, address, type and arguments of a service")
def info(terminal, options, given):
    name, node, ros_type = _service(terminal, "info", given, "ERROR: unknown service")
    terminal.line(f"Node: {node}\nURI: rosrpc://{terminal.graph.uri(node)}\nType: {ros_type}\nArgs: {_arguments(ros_type)}")


@command("rosservice", "type", "/service", "prints the type of a service")
def print_type(terminal, options, given):
    terminal.line(_service(terminal, "type", given, "Unknown service [{name}]")[2])


@command("rosservice", "args", "/service", "prints the names of a service's arguments")
def args(terminal, options, given):
    terminal.line(_arguments(_service(terminal, "args", given, "ERROR: Service [{name}] is not available.")[2]))


@command("rosservice", "find", "srv-type", "lists the services of a type")
def find(terminal, options, given):
    wanted = one(TOOLS["rosservice"]["find"], given, "service type")
    for name in terminal.graph.services():
        if terminal.graph.service(name)[1] == wanted:
            terminal.line(name)


@command("rosservice", "node", "/service", "prints the node that offers a service")
def node(terminal, options, given):
    terminal.line(_service(terminal, "node", given, "ERROR: unknown service")[1])


@command("rosservice", "uri", "/service", "prints the address of a service")
def uri(terminal, options, given):
    terminal.line(f"rosrpc://{terminal.graph.uri(_service(terminal, 'uri', given, 'ERROR: unknown service')[1])}")


@command("rosservice", "call", "/service [args...]", "calls a service", option("-v", "has no effect"))
def call(terminal, options, given):
    name, _, ros_type = _service(terminal, "call", given, "ERROR: Service [{name}] is not available.", 2)
    parts = _definition(ros_type)
    arguments = filling.values(TOOLS["rosservice"]["call"], given[1:])
    request = filling.request_data(parts, arguments)
    try:
        response = terminal.graph.call(name, ros_type, request)
    except Refused as refusal:
        if refusal.lost:
            raise CommandError(
                "ERROR: transport error completing service call: unable to receive data from sender, check sender's logs for details", 2
            ) from None
        raise CommandError(f"ERROR: service [{name}] responded with an error: {str(refusal).encode()!r}", 2) from None
    terminal.write("\n".join(message_text.message_lines(response, parts[1])) + "\n")
