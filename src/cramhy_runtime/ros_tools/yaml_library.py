"""PyYAML as the ROS tools use it: plain values read, with errors that say what to write instead, and parameters written.

`yaml_reading.scalar` says what a word means, for reading and for writing. Anchors, tags and several documents in one text are refused with
their line, since with them a text of a few lines could stand for more than fits into memory.
"""

from __future__ import annotations

import math
import re

import yaml

from .yaml_reading import YamlError, scalar

_MAPPING = "a mapping is written key: value, with the keys below each other, but here is {line!r}"
_END = {"[": "]", "{": "}"}
_ADVICE = (  # of PyYAML's problem: a pattern, and what is said; with what stands there
    ("expected ',' or '.', but got '<stream end>'", "the {opened} is never closed"),
    ("found unexpected end of stream", "the {opened} is never closed"),
    ("expected ',' or '(.)'", "a comma or {} is missing before {rest}"),
    ("expected the node content, but found '<stream end>'", "the {opened} is never closed"),
    ("expected the node content", "a value or {end} is missing"),
    ("expected '<document start>'", "something follows the value: {rest}"),
    ("found character '(.)' that cannot start any token", "{} cannot be used here"),
    ("expected chomping or indentation indicators", "{text!r} is not understood; a text over several lines begins with | or >"),
    ("mapping values are not allowed here|could not find expected ':'|expected <block end>", _MAPPING),
)


def read(text):
    """The value of ``text``, as `yaml_reading.read` returns it. Raises `YamlError`."""
    loader = None
    try:
        loader = _Loader(text.expandtabs())
        node = loader.get_single_node()
        return None if node is None else _value(node)
    except yaml.MarkedYAMLError as problem:
        raise _said(problem, loader.opened) from None
    except yaml.YAMLError as problem:
        raise YamlError(" ".join(str(problem).split())) from None
    except RecursionError:
        raise YamlError("the value is nested too deeply") from None
    finally:
        if loader is not None:
            loader.dispose()


class _Loader(yaml.SafeLoader):
    """PyYAML's loader of plain values. opened: where the lists and mappings begin that it is in."""

    def __init__(self, text):
        super().__init__(text)
        self.opened = []

    def compose_node(self, parent, index):
        event = self.peek_event()
        alias = isinstance(event, yaml.AliasEvent)
        if alias or event.anchor is not None or event.tag is not None:
            raise _error(event.start_mark, f"{'an alias' if alias else 'an anchor' if event.anchor else 'a tag'} cannot be used here")
        self.opened.append(event.start_mark)
        node = super().compose_node(parent, index)
        self.opened.pop()
        return node


def _value(node):
    if isinstance(node, yaml.ScalarNode):
        return node.value if node.style else scalar(node.value)
    if isinstance(node, yaml.SequenceNode):
        return [_value(each) for each in node.value]
    for key, value in node.value:
        if node.flow_style and ":" not in key.end_mark.buffer[key.end_mark.pointer : value.start_mark.pointer]:
            raise _error(value.start_mark, "a mapping is written {key: value}, with a space after the colon")
    return {_key(_value(key)): _value(value) for key, value in node.value}


def _key(key):
    return key if isinstance(key, str) else "null" if key is None else str(key).lower() if isinstance(key, bool) else str(key)


def _error(mark, problem, column=True):
    return YamlError(f"line {mark.line + 1}{f', column {mark.column + 1}' if column else ''}: {problem}")


def _said(problem, inside):
    """PyYAML's ``problem`` as a `YamlError`, in words that say what to write. inside: see `_Loader`."""
    here = problem.problem_mark
    if "node content" in problem.problem and not inside:
        return _error(here, f"something follows the value: {_rest(here)}")
    opened = inside[-1] if inside and "node content" in problem.problem else problem.context_mark or here
    for pattern, words in _ADVICE:
        found = re.match(pattern, problem.problem)
        if found:
            mark = opened if "{opened" in words or problem.context == "while scanning a simple key" else here
            line = mark.buffer.splitlines()[mark.line].strip().rstrip("\0")
            said = words.format(
                *found.groups(), line=line, rest=_rest(here), opened=_rest(opened)[:1], text=_rest(opened), end=_END.get(_rest(opened)[:1])
            )
            return _error(mark, said, column="{line" not in words and "{text" not in words)
    return _error(here, " ".join(filter(None, [problem.context, problem.problem])))


def _rest(mark):
    return mark.buffer[mark.pointer : mark.pointer + 20].partition("\n")[0].rstrip("\0")


# -------------------------------------------------------------------------------------------------------------- parameters


def parameter_text(value):
    """A parameter as ``rosparam get`` prints it, with the end of its last line."""
    return parameter_file(value) + ("\n" if isinstance(value, (dict, list)) and value else "")


def parameter_file(value):
    """A tree of parameters as the text of a file, which ``rosparam load`` reads."""
    return yaml.dump(value, Dumper=_Dumper, default_flow_style=False, allow_unicode=True, width=math.inf).removesuffix("...\n")


class _Dumper(yaml.SafeDumper):
    def ignore_aliases(self, data):
        return True


def _text(dumper, text):
    """A text in quotes if it would be read as something else."""
    return dumper.represent_scalar("tag:yaml.org,2002:str", str(text), style=None if scalar(text) == text else "'")


_Dumper.add_representer(str, _text)
_Dumper.add_multi_representer(str, _text)
_Dumper.add_multi_representer(float, lambda dumper, number: dumper.represent_float(float(number)))
_Dumper.add_multi_representer(list, yaml.SafeDumper.represent_list)
