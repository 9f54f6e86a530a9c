"""``rostopic echo``, ``hz`` and ``bw``: listening to a topic, line by line as messages come, until Ctrl-C or as many as ``-n`` says.

A topic that nobody publishes on yet is waited for, after a warning, as in the original. When the session ends, or the connection to it
breaks, the tool waits for a session and listens there, as the original goes on when its publisher has come back.
"""

from __future__ import annotations

import math
import re
from collections import deque

from . import definitions, message_text
from .graph_access import SessionEnded
from .arguments import TOOLS, CommandError, command, global_name, meant, one, option

_LOOK_AGAIN = 0.2  # s; how often a topic that is not there yet is looked for


def _topic_of(terminal, name):
    """The topic, its type and the fields below it that ``name`` means, as soon as there is such a topic."""
    warned = False
    while True:
        try:
            types = terminal.graph.topics()
        except SessionEnded as problem:
            terminal.rejoin(problem)
            continue
        topic, fields = name, []
        while topic not in types and "/" in topic[1:]:
            topic, _, field = topic.rpartition("/")
            fields.insert(0, field)
        if topic in types:
            definition = definitions.message_definition(types[topic])
            if definition is None:
                raise CommandError(f"ERROR: Cannot load message class for [{types[topic]}]. Are your messages built?")
            return topic, types[topic], definition, fields
        if not warned:
            terminal.complain(f"WARNING: topic [{name}] does not appear to be published yet\n{meant(name, types)}")
            warned = True
        try:
            terminal.graph.sleep(_LOOK_AGAIN)
        except SessionEnded as problem:
            terminal.rejoin(problem)


def _count(text):
    number = int(text)
    if number < 1:
        raise ValueError
    return number


_count.__name__ = "count"


# -------------------------------------------------------------------------------------------------------------------- echo


@command(
    "rostopic",
    "echo",
    "[options] /topic",
    "prints the messages of a topic, or one field of them",
    option("-n", "end after so many messages", "COUNT", _count),
    option("-p", "as a table, columns separated by commas"),
    option("-c --clear", "clear the screen before each message"),
    option("--noarr", "leave out arrays"),
    option("--nostr", "leave out texts"),
)
def echo(terminal, options, given):
    name = global_name(one(TOOLS["rostopic"]["echo"], given, "topic name"))
    topic, ros_type, definition, fields = _topic_of(terminal, name)
    pick = _field_picker(topic, definition, fields)
    show = _table(terminal, options) if "p" in options else _blocks(terminal, options)
    left = options.get("n", math.inf)

    def listen(listener):
        nonlocal left
        while left > 0:
            stamp, data = listener.take()
            show(stamp, *pick(data))
            left -= 1

    _following(terminal, topic, ros_type, listen)


def _following(terminal, topic, ros_type, listen):
    """Call ``listen(listener)`` with a listener of the topic, and again with one of the next session whenever a session has ended."""
    while True:
        try:
            with terminal.graph.listen(topic, ros_type) as listener:
                return listen(listener)
        except SessionEnded as problem:
            terminal.rejoin(problem)


def _field_picker(topic, definition, path):
    """A function that gives (definition, field, value) of what ``path`` names in a message: the message itself has no field."""
    steps = []
    field = None
    for word in path:
        name, index = re.fullmatch(r"([^\[\]]*)(?:\[(\d+)\])?", word).groups() if word.count("[") <= 1 else (word, None)
        field = next((each for each in definition.fields if each.name == name), None) if definition else None
        if field is None or index is not None and not field.is_array:
            raise CommandError(f"ERROR: there is no field [{'/'.join(path)}] in {topic}")
        steps.append((name, None if index is None else int(index)))
        if index is not None:
            field = type(field)(f"{name}[{index}]", field.base)
        definition = None if field.primitive or field.is_array else definitions.message_definition(field.base)

    def pick(data):
        for name, index in steps:
            data = data[name]
            if index is not None:
                if index >= len(data):
                    raise CommandError(f"ERROR: {topic} has only {len(data)} elements in {name}")
                data = data[index]
        return definition, field, data

    return pick


def _blocks(terminal, options):
    def keep(field):
        return not (field.is_array and "noarr" in options or field.base == "string" and "nostr" in options)

    def show(stamp, definition, field, data):
        if field is None:
            lines = message_text.message_lines(data, definition, keep=keep)
        else:
            lines = message_text.field_lines(field, data, keep)
        clear = "\x1b[2J\x1b[;H" if "clear" in options else ""
        terminal.write(clear + "".join(line + "\n" for line in lines) + "---\n")

    return show


def _table(terminal, options):
    headed = []

    def show(stamp, definition, field, data):
        if definition is not None:
            names, values = message_text.csv_names(definition), message_text.csv_values(data, definition)
        else:
            names, values = ["field"], [message_text.inline_text(field, data)]
        if not headed:
            headed.append(True)
            terminal.line(",".join(["%time", *names]))
        terminal.line(",".join([str(round(stamp * 1e9)), *values]))

    return show


# ----------------------------------------------------------------------------------------------------------------- hz, bw


def _each_second(terminal, topic, ros_type, seen, arrived, report):
    """Tell ``arrived(stamp, data)`` of every message, and let ``report()`` print each second. ``seen``: what to forget with a session."""

    def listen(listener):
        terminal.line(f"subscribed to [{topic}]")
        seen.clear()
        due = terminal.graph.now() + 1.0
        while True:
            taken = listener.take(due)
            if taken is not None:
                arrived(*taken)
            else:
                report()
                due += 1.0

    _following(terminal, topic, ros_type, listen)


_WINDOW = option("-w --window", "look at so many messages", "WINDOW", _count)


@command("rostopic", "hz", "[options] /topic", "prints how often messages come", _WINDOW)
def hz(terminal, options, given):
    name = global_name(one(TOOLS["rostopic"]["hz"], given, "topic name"))
    topic, ros_type, _, _ = _topic_of(terminal, name)
    stamps = deque(maxlen=options.get("window", 50000))
    printed = [None]

    def report():
        if len(stamps) < 2 or printed[0] == stamps[-1]:
            return terminal.line("no new messages")
        printed[0] = stamps[-1]
        times = list(stamps)
        steps = [later - earlier for earlier, later in zip(times, times[1:])]
        mean = sum(steps) / len(steps)
        deviation = math.sqrt(sum((step - mean) ** 2 for step in steps) / len(steps))
        rate = f"{1 / mean:.3f}" if mean > 0 else "inf"
        terminal.line(
            f"average rate: {rate}\n\tmin: {min(steps):.3f}s max: {max(steps):.3f}s std dev: {deviation:.5f}s window: {len(times)}"
        )

    _each_second(terminal, topic, ros_type, stamps, lambda stamp, data: stamps.append(stamp), report)


@command("rostopic", "bw", "[options] /topic", "prints how many bytes come", _WINDOW)
def bw(terminal, options, given):
    name = global_name(one(TOOLS["rostopic"]["bw"], given, "topic name"))
    topic, ros_type, definition, _ = _topic_of(terminal, name)
    seen = deque(maxlen=options.get("window", 100))

    def report():
        if not seen:
            return
        seconds = terminal.graph.now() - seen[0][0]
        sizes = [size for _, size in seen]
        rate, unit = sum(sizes) / max(seconds, 1e-9), 1
        name = "B"
        for larger in ("KB", "MB"):
            if rate >= unit * 1000:
                unit, name = unit * 1000, larger
        mean, least, most = sum(sizes) / len(sizes), min(sizes), max(sizes)
        terminal.line(
            f"average: {rate / unit:.2f}{name}/s\n\tmean: {mean / unit:.2f}{name} min: {least / unit:.2f}{name} "
            f"max: {most / unit:.2f}{name} window: {len(sizes)}"
        )

    _each_second(terminal, topic, ros_type, seen, lambda stamp, data: seen.append((stamp, definitions.size(data, definition))), report)
