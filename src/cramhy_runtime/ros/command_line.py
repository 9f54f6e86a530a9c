"""The ROS command-line tools on the graph of this process: ``rostopic``, ``rosservice``, ``rosnode``, ``rosparam``, ``rosmsg``.

`run` takes the words of a command and returns what it prints and its exit status; texts are those of the tools
(ros-command-line.txt, roslisp.md 14.2). Commands that watch a topic (``echo``, ``hz``) end after ``-n`` messages, or after
``seconds`` of the kernel's clock.
"""

from __future__ import annotations

import os

from .. import kernel
from . import definition_text, graph, messages, services, wire, yaml_text
from .messages import RosMessage


class CommandError(Exception):
    """A command that cannot be done: the text it prints, and its exit status."""

    def __init__(self, text, status=1):
        super().__init__(text)
        self.text, self.status = text, status


def run(words, seconds=5.0):
    """Run a command, given as a list of words (``["rosservice", "call", "/clear"]``); returns (text, exit status)."""
    tool, *rest = words
    command = _commands.get((tool, rest[0] if rest else ""))
    if command is None:
        known = " ".join(sorted(second for first, second in _commands if first == tool)) or "none"
        return f"{tool}: unknown command {rest[0] if rest else '(none given)'}. Commands: {known}\n", 64
    try:
        return _ended(command(rest[1:], seconds)), 0
    except CommandError as problem:
        return _ended(problem.text), problem.status
    except yaml_text.YamlError as problem:
        return f"ERROR: {problem}\n", 2


def _ended(text):
    return text if not text or text.endswith("\n") else text + "\n"


def _options(words, *with_value):
    options, rest = {}, []
    words = list(words)
    while words:
        word = words.pop(0)
        if word == "--":
            rest += words
            break
        if word in with_value and words:
            options[word] = words.pop(0)
        elif word == "-1" or (word.startswith("-") and len(word) > 1 and word[1].isalpha()):
            options[word] = True
        else:
            rest.append(word)
    return options, rest


def _argument(words, what, usage):
    if not words:
        raise CommandError(f"Usage: {usage}\n\nerror: {what} must be specified", 2)
    return words[0]


def _global(name):
    return name if name.startswith("/") else "/" + name


# ------------------------------------------------------------------------------------------------------------------- nodes


def rosnode_list(words, seconds):
    return "\n".join(sorted(graph.active().nodes))


def rosnode_info(words, seconds):
    name = _global(_argument(words, "node name", "rosnode info node1"))
    here = graph.active()
    node = here.nodes.get(name)
    if node is None:
        raise CommandError(f"ERROR: Unknown node(s):\n * {name}\n", 1)

    def section(title, lines):
        return f"{title}: " + ("\n" + "\n".join(lines) + "\n" if lines else "None\n")

    published = [f" * {topic} [{entry.type.ros_type}]" for topic, entry in sorted(node.publications.items())]
    subscribed = [f" * {topic} [{entry.type.ros_type}]" for topic, entry in sorted(node.subscriptions.items())]
    connections = [
        line
        for topic, entry in sorted(node.publications.items())
        for subscription in entry.connections
        for line in (
            f" * topic: {topic}",
            f"    * to: {subscription.node.name}",
            "    * direction: outbound",
            "    * transport: INTRAPROCESS",
        )
    ]
    return (
        f"{'-' * 80}\nNode [{name}]\n"
        + section("Publications", published)
        + "\n"
        + section("Subscriptions", subscribed)
        + "\n"
        + section("Services", [f" * {service}" for service in sorted(node.services)])
        + f"\n\ncontacting node http://{node.address}/ ...\n"
        + f"Pid: {os.getpid()}\n"
        + ("Connections:\n" + "\n".join(connections) + "\n" if connections else "")
    )


def rosnode_kill(words, seconds):
    name = _global(_argument(words, "node name", "rosnode kill node1"))
    node = graph.active().nodes.get(name)
    if node is None:
        raise CommandError(f"ERROR: Unknown node(s):\n * {name}\n", 1)
    node.shutdown()
    return f"killing {name}\nkilled"


# ------------------------------------------------------------------------------------------------------------------ topics


def _topic(name):
    topic = graph.active().topics.get(_global(name))
    if topic is None:
        raise CommandError(f"ERROR: Unknown topic {_global(name)}")
    return topic


def rostopic_list(words, seconds):
    options, _ = _options(words)
    topics = graph.active().topics
    if "-v" not in options:
        return "\n".join(sorted(topics))

    def lines(attribute, what):
        for topic in topics.values():
            count = len(getattr(topic, attribute))
            if count:
                yield f" * {topic.name} [{topic.type.ros_type}] {count} {what}{'s' if count > 1 else ''}"

    return (
        "\nPublished topics:\n"
        + "\n".join(lines("publications", "publisher"))
        + "\n\nSubscribed topics:\n"
        + "\n".join(lines("subscriptions", "subscriber"))
        + "\n\n"
    )


def rostopic_info(words, seconds):
    topic = _topic(_argument(words, "topic name", "rostopic info /topic"))

    def lines(entries):
        return "\n" + "\n".join(f" * {entry.node.name} (http://{entry.node.address}/)" for entry in entries) if entries else "None"

    return f"Type: {topic.type.ros_type}\n\nPublishers: {lines(topic.publications)}\n\nSubscribers: {lines(topic.subscriptions)}\n\n"


def rostopic_type(words, seconds):
    name = _global(_argument(words, "topic name", "rostopic type /topic"))
    topic = graph.active().topics.get(name)
    if topic is None:
        raise CommandError(f"unknown topic type [{name}]")
    return topic.type.ros_type


def rostopic_find(words, seconds):
    wanted = _argument(words, "message type", "rostopic find msg-type")
    return "\n".join(topic.name for topic in graph.active().topics.values() if topic.type.ros_type == wanted)


def _watch(words, seconds, usage):
    """(topic name, field path, options, messages with their times) of a command that listens for a while."""
    options, rest = _options(words, "-n", "-w")
    name = _global(_argument(rest, "topic name", usage))
    here, path = graph.active(), []
    while name not in here.topics and "/" in name[1:]:
        name, _, field = name.rpartition("/")
        path.insert(0, field)
    topic = here.topics.get(name)
    if topic is None:
        wanted = _global(rest[0])
        raise CommandError(f"WARNING: topic [{wanted}] does not appear to be published yet")
    count = int(options["-n"]) if "-n" in options else None
    received = []
    task = kernel.current()
    node = here.node(f"rostopic_{os.getpid()}")

    def arrived(message):
        received.append((kernel.now(), message))
        if count is not None and len(received) >= count:
            kernel.unpark(task)

    try:
        node.subscribe(name, topic.type, arrived)
        end = kernel.now() + seconds
        while (count is None or len(received) < count) and kernel.now() < end:
            kernel.park(f"messages on {name}", end)
    finally:
        node.shutdown()
    return name, path, options, received if count is None else received[:count]


def rostopic_echo(words, seconds):
    name, path, options, received = _watch(words, seconds, "rostopic echo [options] /topic")
    parts = []
    for _, message in received:
        for field in path:
            if not isinstance(message, RosMessage) or field not in message.field_names:
                raise CommandError(f"ERROR: there is no field [{'/'.join(path)}] in {name}")
            message = getattr(message, field)
        if "-p" in options and isinstance(message, RosMessage):
            parts.append(",".join(yaml_text.show_value(value) for value in message.values()))
        else:
            shown = "\n".join(yaml_text.show_message(message)) if isinstance(message, RosMessage) else yaml_text.show_value(message)
            parts.append(shown + "\n---")
    return "\n".join(parts)


def rostopic_hz(words, seconds):
    name, _, options, received = _watch(words, seconds, "rostopic hz /topic")
    if len(received) < 2:
        return f"subscribed to [{name}]\nno new messages"
    window = int(options.get("-w", 50000))
    times = [time for time, _ in received][-window:]
    steps = [later - earlier for earlier, later in zip(times, times[1:])]
    mean = sum(steps) / len(steps)
    deviation = (sum((step - mean) ** 2 for step in steps) / len(steps)) ** 0.5
    return (
        f"subscribed to [{name}]\naverage rate: {1 / mean:.3f}\n\tmin: {min(steps):.3f}s max: {max(steps):.3f}s std dev: {deviation:.5f}s "
        f"window: {len(times)}"
    )


def rostopic_pub(words, seconds):
    options, rest = _options(words, "-r")
    if len(rest) < 2:
        raise CommandError("Usage: rostopic pub /topic type [args...]\n\nrostopic pub: error: topic type must be specified", 2)
    name, type_name, *arguments = rest
    cls = messages.message_class_exact(type_name)
    if cls is None:
        raise CommandError(
            f"ERROR: invalid message type: {type_name}.\nIf this is a valid message type, perhaps you need to type 'rosmake "
            f"{type_name.partition('/')[0]}'"
        )
    try:
        message = wire.transmit(_fill(cls, [yaml_text.read(argument) for argument in arguments]))
    except _BadArguments as problem:
        raise CommandError(f"ERROR: {problem}\n\nArgs are: [{' '.join(_leaf_names(cls))}]") from None
    node = graph.active().node(f"rostopic_{os.getpid()}")
    try:
        publication = node.advertise(_global(name), cls, latch="-r" not in options)
        end = kernel.now() + (3.0 if "-1" in options else seconds)
        while True:
            publication.send(wire.fresh(message))
            if "-r" not in options:
                kernel.park("the end of rostopic pub", end)
                break
            if kernel.now() >= end:
                break
            kernel.sleep(1.0 / float(options["-r"]))
    finally:
        node.shutdown()
    if "-r" in options:
        return ""
    return (
        "publishing and latching message for 3.0 seconds"
        if "-1" in options
        else "publishing and latching message. Press ctrl-C to terminate"
    )


# ---------------------------------------------------------------------------------------------------------------- services


class _BadArguments(Exception):
    """Arguments that do not fit the fields of a message; the text says how."""


class _BadValue(_BadArguments):
    """A value that its field cannot hold."""


def _fill(cls, arguments):
    """A message from YAML values: one mapping, or one value per field."""
    message = cls()
    if len(arguments) == 1 and isinstance(arguments[0], dict):
        for key, value in arguments[0].items():
            field = next((field for field in cls.fields if field.name == key), None)
            if field is None:
                raise _BadArguments(f"No field name [{key}]")
            setattr(message, field.attribute, _value_for(field, value))
        return message
    if arguments and len(arguments) != len(cls.fields):
        raise _BadArguments("Not enough arguments" if len(arguments) < len(cls.fields) else "Too many arguments")
    for field, value in zip(cls.fields, arguments):
        setattr(message, field.attribute, _value_for(field, value))
    return message


def _value_for(field, value):
    if field.is_array:
        if not isinstance(value, list):
            raise _BadArguments(f"Field [{field.name}] must be a list or tuple, not {type(value).__name__}")
        element = definition_text.Field(field.name, field.base)
        return [_value_for(element, part) for part in value]
    if not field.primitive:
        cls = messages.message_class_exact(field.base)
        return _fill(cls, value if isinstance(value, list) else [value])
    if field.base == "string" and value is not None and not isinstance(value, str):
        return str(value)
    if field.base in definition_text.INTEGERS:
        bits, signed = definition_text.INTEGERS[field.base]
        if isinstance(value, float) or not isinstance(value, int):
            raise _BadValue(f"field {field.name} must be {'' if signed else 'unsigned '}integer type")
        low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
        if value < 0 and not signed:
            raise _BadValue(f"field {field.name} must be unsigned integer type")
        if not low <= value <= high:
            raise _BadValue(f"field {field.name} exceeds specified width [{field.base}]")
        return int(value)
    if field.base in ("float32", "float64", "time", "duration") and not isinstance(value, (int, float)):
        raise _BadValue(f"field {field.name} must be float type")
    return value


def _leaf_names(cls, prefix=""):
    for field in cls.fields:
        part = None if field.primitive or field.is_array else messages.message_class_exact(field.base)
        if part is not None:
            yield from _leaf_names(part, f"{prefix}{field.name}.")
        else:
            yield prefix + field.name


def _service(name, text="ERROR: unknown service", status=1):
    service = graph.active().services.get(_global(name))
    if service is None:
        raise CommandError(text, status)
    return service


def rosservice_list(words, seconds):
    options, _ = _options(words)
    table = graph.active().services
    return "\n".join(f"{name} {table[name].node.name}" if "-n" in options else name for name in sorted(table))


def _arguments_of(service):
    return " ".join(field.name for field in service.type.request.fields)


def rosservice_info(words, seconds):
    service = _service(_argument(words, "service name", "rosservice info /service"))
    return f"Node: {service.node.name}\nURI: rosrpc://{service.node.address}\nType: {service.type.name}\nArgs: {_arguments_of(service)}"


def rosservice_type(words, seconds):
    name = _argument(words, "service name", "rosservice type /service")
    return _service(name, f"Unknown service [{_global(name)}]").type.name


def rosservice_args(words, seconds):
    name = _argument(words, "service name", "rosservice args /service")
    return _arguments_of(_service(name, f"ERROR: Service [{_global(name)}] is not available."))


def rosservice_find(words, seconds):
    wanted = _argument(words, "service type", "rosservice find srv-type")
    return "\n".join(sorted(name for name, service in graph.active().services.items() if service.type.name == wanted))


def rosservice_node(words, seconds):
    return _service(_argument(words, "service name", "rosservice node /service")).node.name


def rosservice_uri(words, seconds):
    return f"rosrpc://{_service(_argument(words, 'service name', 'rosservice uri /service')).node.address}"


def rosservice_call(words, seconds):
    name = _argument(words, "service name", "rosservice call /service [args...]")
    service = _service(name, f"ERROR: Service [{_global(name)}] is not available.", 2)
    arguments = [yaml_text.read(word) for word in words[1:] if word != "--"]
    fields = service.type.request.fields
    given = not (len(arguments) == 1 and isinstance(arguments[0], dict))
    if given and len(arguments) != len(fields):
        kind = "Not enough" if len(arguments) < len(fields) else "Too many"
        shown = "\n".join(f" * {argument!r} (type {type(argument).__name__})" for argument in arguments)
        expected = [field.name for field in fields]
        raise CommandError(
            f"ERROR: Incompatible arguments to call service:\n{kind} arguments:\n * Given: {arguments}\n * Expected: {expected}\n"
            f"Provided arguments are:\n{shown}\n\nService arguments are: [{' '.join(expected)}]",
            2,
        )
    try:
        request = _fill(service.type.request, arguments)
    except _BadValue as problem:
        raise CommandError(
            f"ERROR: Unable to send request. One of the fields has an incorrect type:\n  {problem}\n\nsrv file:\n"
            f"{_service_text(service.type)}",
            2,
        ) from None
    except _BadArguments as problem:
        raise CommandError(
            f"ERROR: Incompatible arguments to call service:\n{problem}\nProvided arguments are:\n * {arguments[0]!r} (type dict)\n\n"
            f"Service arguments are: [{_arguments_of(service)}]",
            2,
        ) from None
    answer = services.exchange(service, request)
    if answer.lost:
        raise CommandError(
            "ERROR: transport error completing service call: unable to receive data from sender, check sender's logs for details",
            2,
        )
    if answer.failure is not None:
        raise CommandError(f"ERROR: service [{_global(name)}] responded with an error: b'{answer.failure}'", 2)
    return "\n".join(yaml_text.show_message(answer.response)) or "\n"


# -------------------------------------------------------------------------------------------------------------- parameters


def rosparam_list(words, seconds):
    return "\n".join(graph.active().parameters.names())


def rosparam_get(words, seconds):
    name = _global(_argument(words, "parameter", "rosparam get /parameter"))
    try:
        value = graph.active().parameters.get(name)
    except KeyError:
        raise CommandError(f"ERROR: Parameter [{name}] is not set") from None
    return yaml_text.show_parameter(value) + ("\n" if isinstance(value, dict) else "") + "\n"


def rosparam_set(words, seconds):
    if len(words) < 2:
        raise CommandError("Usage: rosparam set [options] parameter value", 2)
    try:
        graph.active().parameters.set(_global(words[0]), yaml_text.read(words[1]))
    except TypeError as problem:  # the root takes dictionaries only
        raise CommandError(f"ERROR: {problem}") from None
    return ""


def rosparam_delete(words, seconds):
    name = _global(_argument(words, "parameter", "rosparam delete /parameter"))
    try:
        graph.active().parameters.delete(name)
    except KeyError:
        raise CommandError(f"ERROR: parameter [{name}] is not set") from None
    return ""


# ------------------------------------------------------------------------------------------------------------- definitions


def _message_lines(cls, indent=""):
    for line in cls.definition.lines:
        yield indent + line
        field = next((field for field in cls.fields if repr(field) == line), None)
        if field is not None and not field.primitive:
            yield from _message_lines(messages.message_class_exact(field.base), indent + "  ")


def _service_text(kind):
    return "".join(line + "\n" for line in [*_message_lines(kind.request), "---", *_message_lines(kind.response)])


def rosmsg_show(words, seconds):
    cls = messages.message_class_exact(_argument(words, "message type", "rosmsg show <message type>"))
    if cls is None:
        raise CommandError("")
    return "".join(line + "\n" for line in _message_lines(cls)) + "\n"


def rossrv_show(words, seconds):
    kind = messages.service_type_exact(_argument(words, "service type", "rossrv show <service type>"))
    if kind is None:
        raise CommandError("")
    return _service_text(kind) + "\n"


_commands = {
    tuple(name.split("_", 1)): function
    for name, function in list(globals().items())
    if name.startswith(("rosnode_", "rostopic_", "rosservice_", "rosparam_", "rosmsg_", "rossrv_"))
}
