"""The words of a ROS command: which commands a tool has, their options, and what they say when the words make no sense.

A command is a function of the `Terminal` it writes to, its options and its remaining words, registered with `command`. The texts of
usage, help and errors are laid out as the ROS tools lay out theirs, and exit statuses are theirs: 2 for words that make no sense,
64 for a command that does not exist (roslisp.md 14.2).
"""

from __future__ import annotations

import re
from typing import NamedTuple

from cramhy_runtime.lisp_core.packages import near_names

TOOLS: dict[str, dict[str, Command]] = {}
"""The commands of each tool by name."""
ABOUT = {
    "rosmsg": "shows the definitions of messages",
    "rosnode": "shows the nodes of the graph, and ends them",
    "rosparam": "gets and sets parameters",
    "rosservice": "shows services and calls them",
    "rossrv": "shows the definitions of services",
    "rostopic": "shows topics, listens to them and publishes",
}
_NUMBER = re.compile(r"-(\d|\.\d|\.inf)")


class CommandError(Exception):
    """A command that cannot be done: the text it prints, and its exit status."""

    def __init__(self, text, status=1):
        super().__init__(text)
        self.text, self.status = text, status


class Command(NamedTuple):
    """One command of a tool. ``options``: every option by each of its names, with its attributes."""

    tool: str
    name: str
    usage: str
    about: str
    options: dict
    function: object

    def complaint(self, problem):
        """The `CommandError` for words that make no sense."""
        return CommandError(f"Usage: {self.tool} {self.name} {self.usage}\n\n{self.tool}: error: {problem}", 2)


class Option(NamedTuple):
    """An option: its name in the program, the word for its value (empty for none), what makes the value of a word, and its help."""

    name: str
    value: str
    convert: object
    about: str


def option(names, about, value="", convert=str):
    """An option of a command: ``names`` as they are typed, ``"-n --count"``; the last one names it in the program."""
    names = names.split()
    made = Option(names[-1].lstrip("-").replace("-", "_"), value, convert, about)
    return dict.fromkeys(names, made)


def meant(name, names):
    """A line that asks whether the one of ``names`` was meant that looks like ``name``; empty when none does."""
    near = near_names(name, names, 1)
    return f"Did you mean {near[0]}?\n" if near else ""


def command(tool, name, usage, about, *options):
    """Register the decorated function ``(terminal, options, words)`` as the command ``name`` of ``tool``."""
    table = {word: made for each in options for word, made in each.items()}

    def register(function):
        TOOLS.setdefault(tool, {})[name] = Command(tool, name, usage, about, table, function)
        return function

    return register


def found(words):
    """The `Command` that ``words`` name, or a `CommandError` with the list of what there is."""
    tool, *rest = words
    commands = TOOLS[tool]
    if not rest or rest[0] in ("-h", "--help", "help"):
        raise CommandError(_help(tool), 64 if not rest else 0)
    if rest[0] not in commands:
        raise CommandError(f"{tool}: there is no command {rest[0]}.\n\n{_help(tool)}", 64)
    return commands[rest[0]]


def _help(tool):
    lines = "\n".join(f"\t{tool} {command.name}\t{command.about}" for _, command in sorted(TOOLS[tool].items()))
    return f"{tool} {ABOUT[tool]}.\n\nCommands:\n{lines}\n\nType {tool} <command> -h for the options of a command."


def parsed(command, words):
    """The options of ``words`` as a dict by name, and the other words. After ``--`` nothing is an option; nor is a number."""
    options, rest = {}, []
    words = list(words)
    while words:
        word = words.pop(0)
        if word == "--":
            return options, rest + words
        name, equals, value = word.partition("=") if word.startswith("--") else (word, "", "")
        if name in ("-h", "--help") and name not in command.options:
            raise CommandError(_command_help(command), 0)
        if name in command.options:
            made = command.options[name]
            options[made.name] = _value(command, made, name, equals, value, words)
        elif word.startswith("-") and len(word) > 1 and not _NUMBER.match(word):
            raise command.complaint(f"no such option: {name}")
        else:
            rest.append(word)
    return options, rest


def _value(command, made, name, equals, value, words):
    if not made.value:
        if equals:
            raise command.complaint(f"{name} option does not take a value")
        return True
    if not equals:
        if not words:
            raise command.complaint(f"{name} option requires 1 argument")
        value = words.pop(0)
    try:
        return made.convert(value)
    except ValueError:
        kind = {int: "integer", float: "floating-point"}.get(made.convert, made.convert.__name__)
        raise command.complaint(f"option {name}: invalid {kind} value: {value!r}") from None


def _command_help(command):
    lines = [f"Usage: {command.tool} {command.name} {command.usage}", "", f"{command.about}", "", "Options:"]
    rows = {made: [name for name, each in command.options.items() if each is made] for made in command.options.values()}
    for made, names in rows.items():
        lines.append(f"  {', '.join(names)}{' ' + made.value if made.value else ''}\n                        {made.about}")
    return "\n".join([*lines, "  -h, --help\n                        show this and do nothing else"])


def one(command, words, what, more=False):
    """The single word that a command takes; ``what`` says what it is. ``more``: others may follow."""
    if not words:
        raise command.complaint(f"{what} must be specified")
    if len(words) > 1 and not more:
        raise command.complaint("you may only specify one " + what)
    return words[0]


def global_name(name):
    """``name`` as a global name: the tools live in the namespace ``/``."""
    return "/" + name.strip("/") if name.strip("/") else "/"
