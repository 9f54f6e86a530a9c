"""``roslaunch``, and launch files: which programs and parameters a file describes.

Tags: ``launch``, ``group``, ``node``, ``param``, ``rosparam``, ``remap``, ``arg``, ``include``, with ``if``, ``unless``, ``ns`` and the
substitutions ``$(arg x)``, ``$(find package)``, ``$(env X)``, ``$(optenv X default)``, ``$(dirname)``, ``$(anon x)``. An unknown tag or a
missing attribute is an error that names the file and the tag. Source: roslisp.md 14.2, wiki.ros.org/roslaunch/XML.
"""

from __future__ import annotations

import os
import re
import shlex
import sys
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.ros import definition_files
from cramhy_runtime.ros.names import plain_value
from cramhy_runtime.ros_tools import executables, yaml_reading

from .programs import Program, rosrun, run, summary
from .workspace import folder_of, packages

USAGE = """Usage: roslaunch [options] [package] <filename> [arg_name:=value...]
       roslaunch [options] <filename> [<filename>...] [arg_name:=value...]"""
DEEPEST = 20  # launch files that include each other
_IGNORED = {"env", "machine", "test"}
_ATTRIBUTES = {
    "launch": set(), "group": {"ns", "clear_params"}, "arg": {"name", "value", "default", "doc"}, "remap": {"from", "to"},
    "node": {"pkg", "type", "name", "args", "output", "respawn", "respawn_delay", "required", "ns", "machine", "clear_params", "cwd",
             "launch-prefix"},
    "param": {"name", "value", "type", "textfile", "binfile", "command"}, "rosparam": {"command", "file", "param", "ns", "subst_value"},
    "include": {"file", "ns", "pass_all_args", "clear_params"},
}  # fmt: skip


class LaunchError(Exception):
    """A launch file that cannot be used; the text says where and why."""


class Launched(NamedTuple):
    """What launch files ask for: programs in order, parameters by global name, names of arguments that nobody took."""

    programs: list
    parameters: dict
    arguments_unused: list


class Scope(NamedTuple):
    """Where a tag stands: the file, the namespace with slashes at both ends, arguments, and remappings in force."""

    file: Path
    namespace: str
    arguments: dict
    remappings: list
    depth: int = 0


def load(words, values):
    """The `Launched` of ``[package, file]`` or of a list of files. values: arguments by name, from ``name:=value``."""
    launched = Launched([], {}, [])
    used = set()
    for path in _files(words):
        _load_file(launched, Scope(path, "/", {}, []), values, used)
    launched.arguments_unused.extend(name for name in values if name not in used and not name.startswith("_"))
    return launched


def _files(words):
    if len(words) == 2 and not Path(words[0]).is_file():
        package, name = words
        folder = _folder_with(package, name)
        wanted = Path(name).parts
        below = (path for path in sorted(folder.rglob("*")) if wanted and path.parts[-len(wanted) :] == wanted) if folder else ()
        found = [path for path in (folder / name, *below) if path.is_file()] if folder else []
        if not found:
            raise LaunchError(
                f"[{name}] is neither a launch file in package [{package}] nor is [{package}] a launch file name\n"
                + (_launch_files_of(package, folder) if folder else _package_meant(package))
            )
        return found[:1]
    missing = [word for word in words if not Path(word).is_file()]
    if missing:
        raise LaunchError(f"[{missing[0]}] is not a launch file name")
    return [Path(word).absolute() for word in words]


def _folder_with(package, name):
    """The folder of a package in which a launch file is looked for: cramhy's own, if it has that file, since its programs are ours."""
    ours = definition_files.own_folder(package)
    if ours is None or not (ours / "launch" / name).is_file():
        return folder_of(package)
    if folder_of(package) != ours:
        print(f"; {name} of cramhy is launched, since cramhy has its own programs for {package}.", file=sys.stderr)
    return ours


def _launch_files_of(package, folder):
    names = sorted({path.name for path in folder.rglob("*.launch")})
    return f"{package} has the launch file{'s' if names[1:] else ''} {', '.join(names)}." if names else f"{package} has no launch files."


def _package_meant(package):
    near = near_names(package, packages(), 1)
    return f"There is no package {package}." + (f" Did you mean {near[0]}?" if near else " rospack list names those that there are.")


def _load_file(launched, scope, values, used):
    if scope.depth > DEEPEST:
        raise LaunchError(f"while processing {scope.file}:\n{DEEPEST} launch files include each other.")
    try:
        root = ElementTree.fromstring(scope.file.read_text(encoding="utf-8-sig"))
    except ElementTree.ParseError as problem:
        raise LaunchError(f"Invalid roslaunch XML syntax: {problem} in {scope.file}") from None
    except (OSError, UnicodeDecodeError) as problem:
        raise LaunchError(f"{scope.file} cannot be read: {problem}") from None
    if root.tag != "launch":
        raise LaunchError(f"Invalid roslaunch XML syntax: no root <launch> tag in {scope.file}")
    _children(launched, root, scope, values, used)


def _children(launched, parent, scope, values, used):
    """Carry out the tags below ``parent``; a remapping holds for what follows it."""
    scope = scope._replace(remappings=list(scope.remappings))
    for tag in parent:
        if not isinstance(tag.tag, str) or tag.tag in _IGNORED:
            continue
        if tag.tag not in _DO or tag.tag == "launch":
            raise _wrong(scope, tag, f"there is no tag <{tag.tag}>; there are {', '.join(f'<{name}>' for name in _DO)}")
        unknown = sorted(set(tag.attrib) - _ATTRIBUTES[tag.tag] - {"if", "unless"})
        if unknown:
            raise _wrong(scope, tag, f"it has no attribute {unknown[0]}")
        if _wanted(tag, scope):
            _DO[tag.tag](launched, tag, scope, values, used)


def _wrong(scope, tag, problem):
    shown = " ".join([tag.tag, *(f'{name}="{value}"' for name, value in tag.attrib.items())])
    return LaunchError(f"while processing {scope.file}:\nInvalid <{tag.tag}> tag: {problem}.\n\nThe tag is <{shown}>")


def _wanted(tag, scope):
    for attribute, good in (("if", True), ("unless", False)):
        if attribute in tag.attrib:
            value = _text(tag, attribute, scope).strip().lower()
            if value not in ("true", "1", "false", "0"):
                raise _wrong(scope, tag, f'{attribute} is true, false, 1 or 0, not "{value}"')
            if (value in ("true", "1")) is not good:
                return False
    return True


def _text(tag, attribute, scope, default=None):
    """The value of an attribute with its substitutions; one without ``default`` must be there."""
    value = tag.attrib.get(attribute)
    if value is None:
        if default is None:
            raise _wrong(scope, tag, f"the attribute {attribute} is missing")
        return default
    return re.sub(r"\$\(([^()]*)\)", lambda found: _substitution(found.group(1).split(), tag, scope), value)


def _substitution(words, tag, scope):
    command, *rest = words or [""]
    if command == "arg" and len(rest) == 1:
        if rest[0] in scope.arguments:
            return scope.arguments[rest[0]]
        raise _wrong(scope, tag, f'there is no <arg name="{rest[0]}"> above it with a value; give one: {rest[0]}:=VALUE')
    if command == "find" and len(rest) == 1:
        folder = "xacro" if rest[0] == "xacro" else folder_of(rest[0])  # the package is one of Python's; see `_output`
        if folder is None:
            raise _wrong(scope, tag, f"there is no package {rest[0]}")
        return str(folder)
    if command == "env" and len(rest) == 1:
        if rest[0] not in os.environ:
            raise _wrong(scope, tag, f"there is no environment variable {rest[0]}")
        return os.environ[rest[0]]
    if command == "optenv" and rest:
        return os.environ.get(rest[0], " ".join(rest[1:]))
    if command == "dirname" and not rest:
        return str(scope.file.parent)
    if command == "anon" and len(rest) == 1:
        return f"{rest[0]}_{os.getpid()}"
    raise _wrong(scope, tag, f"$({' '.join(words)}) is not understood; there are arg, find, env, optenv, dirname and anon")


def _join(namespace, name):
    return name if name.startswith("/") else namespace + name


def _group(launched, tag, scope, values, used):
    namespace = _join(scope.namespace, _text(tag, "ns", scope, "")).rstrip("/") + "/"
    _children(launched, tag, scope._replace(namespace=namespace), values, used)


def _arg(launched, tag, scope, values, used):
    name = _text(tag, "name", scope)
    used.add(name)
    if "value" in tag.attrib:
        scope.arguments[name] = _text(tag, "value", scope)
    elif name in values:
        scope.arguments[name] = values[name]
    elif "default" in tag.attrib:
        scope.arguments[name] = _text(tag, "default", scope)


def _remap(launched, tag, scope, values, used):
    scope.remappings.append(f"{_text(tag, 'from', scope)}:={_text(tag, 'to', scope)}")


def _include(launched, tag, scope, values, used):
    inner = dict(values) if _text(tag, "pass_all_args", scope, "false").lower() in ("true", "1") else {}
    for each in tag:
        if each.tag != "arg":
            raise _wrong(scope, tag, f"only <arg> may stand in it, not <{each.tag}>")
        if _wanted(each, scope):
            inner[_text(each, "name", scope)] = _text(each, "value", scope)
    path = Path(_text(tag, "file", scope))
    if not path.is_file():
        raise _wrong(scope, tag, f"there is no file {path}")
    namespace = _join(scope.namespace, _text(tag, "ns", scope, "")).rstrip("/") + "/"
    _load_file(launched, Scope(path, namespace, {}, list(scope.remappings), scope.depth + 1), inner, used)


def _node(launched, tag, scope, values, used):
    name, package, executable = (_text(tag, attribute, scope) for attribute in ("name", "pkg", "type"))
    if "/" in name:
        raise _wrong(scope, tag, f'the name of a node holds no slash; give the namespace by ns="{name.rpartition("/")[0]}"')
    namespace = _join(scope.namespace, _text(tag, "ns", scope, "")).rstrip("/") + "/"
    inner = scope._replace(namespace=f"{namespace}{name}/", remappings=list(scope.remappings))
    for each in tag:
        if isinstance(each.tag, str) and each.tag not in ("remap", "param", "rosparam", "env"):
            raise _wrong(scope, each, "it has no place in a <node>")
        if isinstance(each.tag, str) and each.tag != "env" and _wanted(each, scope):
            _DO[each.tag](launched, each, inner, values, used)
    try:
        given = shlex.split(_text(tag, "args", scope, ""))
    except ValueError as problem:
        raise _wrong(scope, tag, f"the words of args: {problem}") from None
    # the namespace comes first: roslisp makes the name anew, of the one that the program gives, when it reads it
    words = [f"__ns:={namespace}", f"__name:={name}", *inner.remappings, *given]
    launched.programs.append(Program(package, executable, words, f"{namespace}{name}".lstrip("/")))


_TYPES = {
    "str": str,
    "string": str,
    "int": lambda text: int(text, 0),
    "double": float,
    "float": float,
    "bool": lambda text: {"true": True, "1": True, "false": False, "0": False}[text.lower()],
    "yaml": yaml_reading.read,
}


def _param(launched, tag, scope, values, used):
    name, kind = _join(scope.namespace, _text(tag, "name", scope).lstrip("~")), _text(tag, "type", scope, "auto")
    if "textfile" in tag.attrib:
        try:
            launched.parameters[name] = Path(_text(tag, "textfile", scope)).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as problem:
            raise _wrong(scope, tag, f"the file cannot be read: {problem}") from None
        return
    if "command" in tag.attrib:
        launched.parameters[name] = _output(tag, scope)
        return
    if "binfile" in tag.attrib:
        raise _wrong(scope, tag, "cramhy reads no binary files for parameters; give value or textfile")
    text = _text(tag, "value", scope)
    if kind != "auto" and kind not in _TYPES:
        raise _wrong(scope, tag, f'there is no type "{kind}"; there are {", ".join(_TYPES)} and auto')
    try:
        launched.parameters[name] = plain_value(text) if kind == "auto" else _TYPES[kind](text)
    except (ValueError, KeyError):
        raise _wrong(scope, tag, f'"{text}" is not of the type {kind}') from None


def _output(tag, scope):
    """What a command for a parameter would print: xacro expands a file, and cat reads it. Others are not run."""
    from cramhy_runtime.robot_world import xacro_files
    from cramhy_runtime.robot_world.descriptions import DescriptionError

    try:
        command, *words = shlex.split(_text(tag, "command", scope))
    except ValueError as problem:
        raise _wrong(scope, tag, f"the words of command: {problem}") from None
    tool = Path(command).name.removesuffix(".py")
    files = [word for word in words if ":=" not in word and not word.startswith("-")]
    if tool not in ("xacro", "cat") or len(files) != 1:
        raise _wrong(scope, tag, "cramhy runs no commands for parameters but xacro FILE and cat FILE; give value or textfile")
    try:
        if tool == "cat":
            return Path(files[0]).read_text(encoding="utf-8")
        return xacro_files.expanded(files[0], dict(word.split(":=", 1) for word in words if ":=" in word))
    except (OSError, UnicodeDecodeError, DescriptionError) as problem:
        raise _wrong(scope, tag, f"the file cannot be read: {problem}") from None


def _rosparam(launched, tag, scope, values, used):
    command = _text(tag, "command", scope, "load")
    space = _join(scope.namespace, _text(tag, "ns", scope, ""))
    if command == "delete":
        launched.parameters.pop(_join(space.rstrip("/") + "/", _text(tag, "param", scope)), None)
        return
    if command != "load":
        raise _wrong(scope, tag, f'the command "{command}" is none of load and delete')
    try:
        text = Path(_text(tag, "file", scope)).read_text(encoding="utf-8-sig") if "file" in tag.attrib else tag.text or ""
        value = yaml_reading.read(_undented(text))
    except (OSError, UnicodeDecodeError) as problem:
        raise _wrong(scope, tag, f"the file cannot be read: {problem}") from None
    except yaml_reading.YamlError as problem:
        raise _wrong(scope, tag, f"its parameters: {problem}") from None
    name = _text(tag, "param", scope, "")
    if not name and not isinstance(value, dict):
        raise _wrong(scope, tag, "its parameters are not a mapping, name: value, and there is no attribute param")
    _spread(launched.parameters, _join(space.rstrip("/") + "/", name) if name else space.rstrip("/"), value)


def _undented(text):
    from textwrap import dedent

    return dedent(text.strip("\n"))


def _spread(parameters, name, value):
    if isinstance(value, dict):
        for key, below in value.items():
            _spread(parameters, f"{name}/{key}", below)
    else:
        parameters[name] = value


_DO = {"group": _group, "node": _node, "param": _param, "rosparam": _rosparam, "remap": _remap, "arg": _arg, "include": _include}


def roslaunch(arguments):
    """``roslaunch PACKAGE FILE.launch [arg:=value]`` or ``roslaunch FILE.launch``; also an executable, as the slides have it."""
    if arguments[:1] in (["-h"], ["--help"]):
        print(USAGE)
        return 0
    words = [word for word in arguments if ":=" not in word and not word.startswith("-")]
    values = dict(word.split(":=", 1) for word in arguments if ":=" in word)
    if not words:
        print(USAGE + "\n\nroslaunch: error: you must specify at least one input file", file=sys.stderr)
        return 2
    if len(words) == 2 and executables.complaint(*words) is None:
        return rosrun(words + [word for word in arguments if ":=" in word])
    try:
        launched = load(words, values)
    except LaunchError as problem:
        print(f"RLException: {problem}", file=sys.stderr)
        return 1
    print(summary(launched.parameters, [(program.label, f" ({program.package}/{program.executable})") for program in launched.programs]))
    for name in launched.arguments_unused:
        print(f'WARNING: there is no <arg name="{name}"> in the launch file', file=sys.stderr)
    return run(launched.programs, launched.parameters)
