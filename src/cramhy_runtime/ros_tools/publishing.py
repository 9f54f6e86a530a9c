"""``rostopic pub``: one message, latched, for three seconds or until Ctrl-C; or the same message again and again."""

from __future__ import annotations

import math
from pathlib import Path

from ..ros.former_types import successor
from . import definitions, filling
from .arguments import TOOLS, CommandError, command, global_name, option

ONCE = 3.0  # s that `-1` stays, so that a subscriber can connect


def _rate(text):
    number = float(text)
    if not 0 < number < math.inf:
        raise ValueError
    return number


_rate.__name__ = "rate"


@command(
    "rostopic",
    "pub",
    "[options] /topic type [args...]",
    "publishes a message",
    option("-1 --once", "end after 3 seconds"),
    option("-r --rate", "so often per second", "HZ", _rate),
    option("-f --file", "the message is in a file of YAML", "FILE"),
    option("-l --latch", "latched, with -r too"),
    option("-s --substitute-keywords", "has no effect: now and auto are always understood"),
    option("-v", "tell what is published"),
)
def pub(terminal, options, given):
    this = TOOLS["rostopic"]["pub"]
    if not given:
        raise this.complaint("topic name must be specified")
    if len(given) < 2:
        raise this.complaint("topic type must be specified")
    topic, ros_type, *arguments = given
    topic = global_name(topic)
    definition = definitions.message_definition(ros_type)
    if definition is None:
        package = ros_type.partition("/")[0]
        advice = successor(ros_type) or f"If this is a valid message type, perhaps you need to type 'rosmake {package}'"
        raise CommandError(f"ERROR: invalid message type: {ros_type}.\n{advice}")
    if "file" in options:
        if arguments:
            raise this.complaint("the message is in the file, so no values may follow the type")
        arguments = [_read_file(this, options["file"])]
    elif not arguments and definition.fields:
        raise this.complaint("Please specify message values")
    data = filling.message_data(this, ros_type, filling.values(this, arguments))
    known = terminal.graph.topics().get(topic)
    if known not in (None, ros_type):
        raise CommandError(f"ERROR: the topic {topic} has the type {known}, so a {ros_type} would reach nobody.")
    _publish(terminal, options, topic, ros_type, data)


def _read_file(command, path):
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as problem:
        raise command.complaint(f"the file {path} cannot be read: {problem}") from None


def _publish(terminal, options, topic, ros_type, data):
    graph = terminal.graph
    repeated = "rate" in options
    with graph.talk(topic, ros_type, not repeated or "latch" in options) as send:
        send(data)
        if "once" in options:
            terminal.line(f"publishing and latching message for {ONCE} seconds")
            graph.sleep(ONCE)
        elif not repeated:
            terminal.line("publishing and latching message. Press ctrl-C to terminate")
            while True:
                graph.sleep(60.0)
        else:
            due = graph.now()
            while True:
                due = max(due + 1.0 / options["rate"], graph.now() - 1.0)  # who is late does not make up for more than a second
                graph.sleep(max(0.0, due - graph.now()))
                send(data)
