"""``rostopic list``, ``type``, ``info`` and ``find``: which topics there are, of which type, between which nodes."""

from __future__ import annotations

from .arguments import TOOLS, CommandError, command, global_name, one, option


@command(
    "rostopic",
    "list",
    "[options] [namespace]",
    "lists the topics",
    option("-v --verbose", "types, and numbers of nodes"),
    option("-p", "those that somebody publishes on"),
    option("-s", "those that somebody is subscribed to"),
)
def list_topics(terminal, options, given):
    graph = terminal.graph
    space = global_name(given[0]) if given else "/"
    types = {name: ros_type for name, ros_type in graph.topics().items() if name == space or name.startswith(space.rstrip("/") + "/")}
    if "p" in options and "s" in options:
        raise TOOLS["rostopic"]["list"].complaint("you may only specify one of -p, -s")
    if given and not types:
        raise CommandError(f"ERROR: Unknown topic {space}" if space not in graph.topics() else "")

    def lines(nodes_of, what):
        for name in types:
            count = len(nodes_of(name))
            if count:
                yield f" * {name} [{types[name]}] {count} {what}{'s' if count > 1 else ''}\n" if "verbose" in options else f"{name}\n"

    if "verbose" in options:
        terminal.line()
        if "s" not in options:
            terminal.write("Published topics:\n" + "".join(lines(graph.publishers, "publisher")) + "\n")
        if "p" not in options:
            terminal.write("Subscribed topics:\n" + "".join(lines(graph.subscribers, "subscriber")) + "\n")
    elif "p" in options or "s" in options:
        terminal.write("".join(lines(graph.publishers if "p" in options else graph.subscribers, "")))
    else:
        terminal.write("".join(f"{name}\n" for name in types))


@command("rostopic", "type", "topic-or-field", "prints the type of a topic")
def print_type(terminal, options, given):
    name = global_name(one(TOOLS["rostopic"]["type"], given, "topic name"))
    types = terminal.graph.topics()
    if name not in types:
        raise CommandError(f"unknown topic type [{name}]")
    terminal.line(types[name])


@command("rostopic", "info", "/topic", "prints the type of a topic, and its nodes")
def info(terminal, options, given):
    name = global_name(one(TOOLS["rostopic"]["info"], given, "topic name"))
    graph = terminal.graph
    types = graph.topics()
    if name not in types:
        raise CommandError(f"ERROR: Unknown topic {name}")

    def lines(nodes):
        return "\n" + "".join(f" * {node} (http://{graph.uri(node)}/)\n" for node in nodes) if nodes else "None\n"

    terminal.write(f"Type: {types[name]}\n\nPublishers: {lines(graph.publishers(name))}\nSubscribers: {lines(graph.subscribers(name))}\n\n")


@command("rostopic", "find", "msg-type", "lists the topics of a type")
def find(terminal, options, given):
    wanted = one(TOOLS["rostopic"]["find"], given, "message type")
    for name, ros_type in terminal.graph.topics().items():
        if ros_type == wanted:
            terminal.line(name)
