"""``rosparam``: the parameters of the graph, and files of them."""

from __future__ import annotations

import sys
from pathlib import Path

from .. import storage
from . import yaml_reading
from .arguments import TOOLS, CommandError, command, global_name, one, option


@command("rosparam", "list", "[namespace]", "lists the parameters")
def list_parameters(terminal, options, given):
    space = global_name(given[0]).rstrip("/") + "/" if given else "/"
    for name in terminal.graph.parameter_names():
        if name.startswith(space):
            terminal.line(name)


def _value(terminal, name, complaint):
    try:
        return terminal.graph.parameter(name)
    except KeyError:
        raise CommandError(complaint.format(name=name)) from None


@command(
    "rosparam",
    "get",
    "[-p] parameter",
    "prints a parameter",
    option("-p", "has no effect: trees are always printed so"),
    option("-v", "has no effect"),
)
def get(terminal, options, given):
    name = global_name(one(TOOLS["rosparam"]["get"], given, "parameter name"))
    value = _value(terminal, name, "ERROR: Parameter [{name}] is not set")
    from .yaml_library import parameter_text

    terminal.write(parameter_text(value))


@command(
    "rosparam",
    "set",
    "[options] parameter value",
    "gives a parameter a value",
    option("-v", "tell what is done"),
    option("-t --textfile", "the value is the text of a file", "FILE"),
)
def set_parameter(terminal, options, given):
    this = TOOLS["rosparam"]["set"]
    if not given:
        raise this.complaint("parameter name must be specified")
    if len(given) + ("textfile" in options) < 2:
        raise this.complaint("you must specify a parameter value")
    if len(given) + ("textfile" in options) > 2:
        raise this.complaint("too many arguments; a value with spaces needs quotes")
    value = _file_text(options["textfile"]) if "textfile" in options else _read(this, given[1])
    _store(terminal, global_name(given[0]), value, "v" in options)


def _read(command, text):
    try:
        return yaml_reading.read(text)
    except yaml_reading.YamlError as problem:
        raise command.complaint(f"Argument error: {problem}") from None


def _store(terminal, name, value, told):
    """Set a parameter; of a mapping each value, so that others below its name stay."""
    if isinstance(value, dict) and value:
        for key, below in value.items():
            _store(terminal, name.rstrip("/") + "/" + key.strip("/"), below, told)
        return
    if value is None:
        raise CommandError(f"ERROR: a parameter cannot be null. To remove it: rosparam delete {name}")
    if told:
        terminal.line(f"set parameter [{name}] to [{value}]")
    terminal.graph.set_parameter(name, value)


@command("rosparam", "delete", "parameter", "removes a parameter", option("-v", "tell what is done"))
def delete(terminal, options, given):
    name = global_name(one(TOOLS["rosparam"]["delete"], given, "parameter name"))
    try:
        terminal.graph.delete_parameter(name)
    except KeyError:
        raise CommandError(f"ERROR: parameter [{name}] is not set") from None
    if options:
        terminal.line(f"deleted parameter [{name}]")


@command("rosparam", "dump", "[file] [namespace]", "writes parameters into a file, or prints them", option("-v", "tell what is done"))
def dump(terminal, options, given):
    if len(given) > 2:
        raise TOOLS["rosparam"]["dump"].complaint("too many arguments")
    space = global_name(given[1]) if len(given) > 1 else "/"
    value = _value(terminal, space, "ERROR: Parameter [{name}] is not set")
    from .yaml_library import parameter_file

    text = parameter_file(value)
    if not given or given[0] == "-":
        return terminal.write(text)
    try:
        storage.write_whole(given[0], text)
    except OSError as problem:
        raise CommandError(f"ERROR: {given[0]} cannot be written: {storage.why(problem)}") from None
    if options:
        terminal.line(f"dumping namespace [{space}] to file [{given[0]}]")


@command("rosparam", "load", "file [namespace]", "reads parameters from a file", option("-v", "tell what is done"))
def load(terminal, options, given):
    this = TOOLS["rosparam"]["load"]
    if not given:
        raise this.complaint("invalid arguments. Please specify a file name")
    if len(given) > 2:
        raise this.complaint("too many arguments")
    text = sys.stdin.read() if given[0] == "-" else _file_text(given[0])
    try:
        tree = yaml_reading.read(text)
    except yaml_reading.YamlError as problem:
        raise CommandError(f"ERROR: {given[0]}, {problem}") from None
    if not isinstance(tree, dict):
        raise CommandError(f"ERROR: {given[0]} holds no parameters: a file of parameters is a mapping, name: value.")
    _store(terminal, global_name(given[1]) if len(given) > 1 else "/", tree, bool(options))


def _file_text(path):
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise CommandError(f"ERROR: file [{path}] does not exist") from None
    except (OSError, UnicodeDecodeError) as problem:
        raise CommandError(f"ERROR: file [{path}] cannot be read: {problem}") from None
