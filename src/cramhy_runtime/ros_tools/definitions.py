"""The definitions of messages and services as the tools need them: by their type's name, without a session and without Lisp.

They are read from the same files from which a session makes its classes (`ros.definition_files`); what no folder of this machine has is
asked for where a session was reached. What was found is kept; what was not may come to the path later, while the prompt goes on.
"""

from __future__ import annotations

import functools

from ..ros import definition_files, definition_text
from . import graph_access as reach
from .arguments import CommandError


def _kept(find):
    """FIND, a function of texts, called once for each of its results that is not ``None``."""
    found = {}

    @functools.wraps(find)
    def look(*words):
        if words not in found:
            result = find(*words)
            if result is None:
                return None
            found[words] = result
        return found[words]

    return look


@_kept
def _package(name):
    try:
        return definition_files.read(name)
    except definition_text.DefinitionError as problem:
        raise CommandError(f"ERROR: {problem}") from None


def message_definition(ros_type):
    """The `Definition` of ``"turtlesim/Pose"``, or ``None``."""
    return _definition(ros_type, "messages", "message_elsewhere")


def service_definition(ros_type):
    """The two definitions of ``"turtlesim/Spawn"``, of its request and its response, or ``None``."""
    return _definition(ros_type, "services", "service_elsewhere")


@_kept
def _definition(ros_type, table, elsewhere):
    package, _, name = ros_type.partition("/")
    found = getattr(_package(package), table, {}).get(name)
    for graph in () if found else reach.reached:
        found = getattr(graph, elsewhere)(ros_type)
    return found


def packages(kind):
    """The names of all packages that define messages (``"msg"``) or services (``"srv"``)."""
    return [name for name in definition_files.known_packages() if definition_files.has_kind(definition_files.package_folder(name), kind)]


def types(package, kind):
    """The names of all types of a package, sorted: ``["turtlesim/Color", "turtlesim/Pose"]``."""
    folder = definition_files.package_folder(package)
    names = definition_files.message_names(folder) if kind == "msg" else definition_files.definition_files(folder, kind)
    return [f"{package}/{name}" for name in sorted(names)]


def text_of(definition, indent=""):
    """The text of a definition as ``rosmsg show`` prints it, the fields of the parts indented below them."""
    return "".join(f"{indent}{line}\n" for line in _lines(definition))


def _lines(definition):
    fields = {repr(field): field for field in definition.fields}
    for line in definition.lines:
        yield line
        field = fields.get(line)
        below = field and not field.primitive and message_definition(field.base)
        if below:
            yield from ("  " + inner for inner in _lines(below))


def service_text(parts):
    """The text of a service's two definitions as ``rossrv show`` prints it."""
    return f"{text_of(parts[0])}---\n{text_of(parts[1])}"


def md5(ros_type, kind):
    """The MD5 sum by which ROS nodes recognise a message or a service, in hexadecimal."""
    from ..ros import messages, type_texts

    return type_texts.md5_of((messages.message_class_exact if kind == "msg" else messages.service_type_exact)(ros_type))


def leaf_names(definition, prefix=""):
    """The names of the fields that hold values: ``linear.x linear.y …``."""
    for field in definition.fields:
        part = None if field.primitive or field.is_array else message_definition(field.base)
        if part is None:
            yield prefix + field.name
        else:
            yield from leaf_names(part, f"{prefix}{field.name}.")


def size(data, definition):
    """The bytes that a message, given as plain data, takes on a wire of ROS 1."""
    return sum(_field_size(field, data.get(field.name)) for field in definition.fields)


_SIZES = {
    "bool": 1,
    "float32": 4,
    "float64": 8,
    "time": 8,
    "duration": 8,
    **{name: bits // 8 for name, (bits, _) in definition_text.INTEGERS.items()},
}


def _field_size(field, value):
    if not field.is_array:
        return _value_size(field, value)
    count = 0 if field.length else 4
    if isinstance(value, str):  # base64, of bytes
        return count + len(value) * 3 // 4 - value.count("=")
    if field.base in _SIZES:
        return count + len(value or ()) * _SIZES[field.base]
    return count + sum(_value_size(field, each) for each in value or ())


def _value_size(field, value):
    if field.base == "string":
        return 4 + len((value or "").encode())
    return _SIZES.get(field.base) or size(value, message_definition(field.base))
