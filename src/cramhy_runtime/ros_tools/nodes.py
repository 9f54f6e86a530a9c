"""``rosnode``: which nodes there are, what they publish, hear and serve, whether they answer; and to end one."""

from __future__ import annotations

from .graph_access import Refused
from .arguments import TOOLS, CommandError, command, global_name, one, option

TIMEOUT = 3.0


@command("rosnode", "list", "[-u] [namespace]", "lists the nodes", option("-u", "their addresses"), option("-a", "names and addresses"))
def list_nodes(terminal, options, given):
    space = global_name(given[0]).rstrip("/") + "/" if given else "/"
    for name in terminal.graph.nodes():
        if name.startswith(space):
            address = f"http://{terminal.graph.uri(name)}/" if options else ""
            terminal.line(f"{address} \t{name}" if "a" in options else address or name)


@command("rosnode", "info", "node1 [node2...]", "prints what a node publishes, hears and serves")
def info(terminal, options, given):
    if not given:
        raise TOOLS["rosnode"]["info"].complaint("You must specify at least one node name")
    status = 0
    for name in map(global_name, given):
        facts = terminal.graph.node(name)
        terminal.line("-" * 80)
        terminal.line(f"Node [{name}]")
        if facts is None:
            terminal.write("Publications: None\n\nSubscriptions: None\n\nServices: None\n\n")
            terminal.complain(f"cannot contact [{name}]: unknown node\n")
            status = 1
        else:
            _describe(terminal, name, facts)
    return status


def _describe(terminal, name, facts):
    graph = terminal.graph
    types = graph.topics()

    def section(title, lines):
        return f"{title}: \n" + "".join(f" * {line}\n" for line in lines) if lines else f"{title}: None\n"

    terminal.line(section("Publications", [f"{topic} [{types.get(topic, 'unknown type')}]" for topic in facts.publishing]))
    terminal.line(section("Subscriptions", [f"{topic} [{types.get(topic, 'unknown type')}]" for topic in facts.subscribing]))
    terminal.line(section("Services", facts.services))
    terminal.line(f"\ncontacting node http://{graph.uri(name)}/ ...\nPid: {graph.process(name)}")
    connections = [(topic, other, "outbound") for topic in facts.publishing for other in graph.subscribers(topic)]
    connections += [(topic, other, "inbound") for topic in facts.subscribing for other in graph.publishers(topic)]
    if connections:
        terminal.line("Connections:")
    for topic, other, direction in connections:
        transport = "INTRAPROCESS" if graph.process(other) == graph.process(name) else "ROSBRIDGE"
        terminal.line(f" * topic: {topic}\n    * to: {other}\n    * direction: {direction}\n    * transport: {transport}")
    terminal.line()


@command(
    "rosnode",
    "ping",
    "[-c COUNT] [-a] node",
    "asks a node for an answer, each second",
    option("-c", "so often", "COUNT", int),
    option("-a --all", "all nodes, once"),
)
def ping(terminal, options, given):
    if "all" in options:
        return _ping_all(terminal)
    name = global_name(one(TOOLS["rosnode"]["ping"], given, "node name"))
    terminal.line(f"rosnode: node is [{name}]")
    if name not in terminal.graph.nodes():
        raise CommandError(f"cannot ping [{name}]: unknown node")
    terminal.line(f"pinging {name} with a timeout of {TIMEOUT}s")
    times = []
    try:
        while True:
            times.append(_reply(terminal, name))
            if len(times) >= options.get("c", len(times) + 1):
                break
            terminal.graph.sleep(1.0)
    finally:
        if times:
            terminal.line(f"ping average: {sum(times) / len(times) * 1e3:f}ms")


def _reply(terminal, name):
    seconds = terminal.graph.ping(name)
    terminal.line(f"xmlrpc reply from http://{terminal.graph.uri(name)}/\ttime={seconds * 1e3:f}ms")
    return seconds


def _ping_all(terminal):
    names = terminal.graph.nodes()
    terminal.line("Will ping the following nodes: ")
    for name in names:
        terminal.line(f" * {name}")
    for name in names:
        terminal.line(f"pinging {name} with a timeout of {TIMEOUT}s")
        _reply(terminal, name)


@command("rosnode", "kill", "[-a] node1 [node2...]", "ends nodes", option("-a --all", "all nodes"))
def kill(terminal, options, given):
    graph = terminal.graph
    there = graph.nodes()
    names = there if "all" in options else [global_name(name) for name in given]
    if not names:
        raise TOOLS["rosnode"]["kill"].complaint("You must specify at least one node name")
    unknown = [name for name in names if name not in there]
    if unknown:
        raise CommandError("\n * ".join(["ERROR: Unknown node(s):", *unknown]))
    for name in names:
        terminal.line(f"killing {name}")
        try:
            graph.kill(name)
        except Refused as problem:
            raise CommandError(f"ERROR: {name} cannot be killed: {problem}") from None
    terminal.line("killed")


@command("rosnode", "machine", "[machine]", "lists the machines with nodes, or the nodes of one")
def machine(terminal, options, given):
    graph = terminal.graph
    hosts = {name: graph.uri(name).partition(":")[0] for name in graph.nodes()}
    for line in sorted(set(hosts.values())) if not given else [name for name, host in hosts.items() if host == given[0]]:
        terminal.line(line)


@command("rosnode", "cleanup", "", "forgets nodes that do not answer: there are none, for nodes leave when they end")
def cleanup(terminal, options, given):
    _ping_all(terminal)
