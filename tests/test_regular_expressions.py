"""Regular expressions of the product take no time that grows faster than the square of a text, whoever wrote the text."""

import ast
import re
from pathlib import Path
from re import _constants, _parser

import pytest
from source_trees import nodes_of, tree_of

from cramhy_runtime.languages.commonlisp.pathnames.pathname_objects import CHARACTER_SET, MULTI_CHAR, SINGLE_CHAR, Pattern

SOURCES = [path for folder in ("src", "hy_src") for path in sorted((Path(__file__).parents[1] / folder).rglob("*.py"))]
FUNCTIONS = {"compile", "match", "search", "fullmatch", "split", "sub", "subn", "findall", "finditer"}
REPEATS = (_constants.MAX_REPEAT, _constants.MIN_REPEAT)


def patterns(path):
    """(line, text, flags) of each regular expression that a file writes out."""
    source = path.read_text(encoding="utf-8")
    for node in nodes_of(tree_of(path)) if re.search(r"\bre\.|late_pattern", source) else ():
        if not (isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant)):
            continue
        function, text = node.func, node.args[0].value
        of_re = isinstance(function, ast.Attribute) and getattr(function.value, "id", "") == "re" and function.attr in FUNCTIONS
        if (of_re or getattr(function, "id", "") == "late_pattern") and isinstance(text, (str, bytes)):
            flags = ast.unparse(node)
            yield node.lineno, text, sum(flag for name, flag in FLAGS.items() if re.search(rf"re\.{name}\b", flags))


FLAGS = {"S": re.S, "DOTALL": re.S, "X": re.X, "VERBOSE": re.X, "M": re.M, "MULTILINE": re.M}


def inside(item):
    """The sequences in an item of a parsed expression."""
    kind, value = item
    if kind in REPEATS:
        return [value[2]]
    if kind is _constants.SUBPATTERN:
        return [value[3]]
    if kind is _constants.BRANCH:
        return value[1]
    return [value[1]] if kind in (_constants.ASSERT, _constants.ASSERT_NOT) else []


def takes_anything(sequence, dotall):
    """Whether a repeat of any character stands in it, which can take what its neighbours take, too."""
    for kind, value in sequence:
        if kind in REPEATS and value[1] > 1 and list(value[2])[0][0] is _constants.ANY and len(value[2]) == 1 and dotall:
            return True
        if any(takes_anything(each, dotall) for each in inside((kind, value))):
            return True
    return False


def slow(sequence, flags):
    """Why an expression is slow, or ``""``."""
    items = list(sequence)
    for number, (kind, value) in enumerate(items):
        if kind in REPEATS and value[1] > 1 and takes_anything(value[2], flags & re.S):
            return "a repeated group has a repeat of any character in it"
        begins_line = number and items[number - 1] == (_constants.AT, _constants.AT_BEGINNING) and flags & re.M
        if begins_line and kind in REPEATS and re.compile(r"\s").fullmatch("\n") and "CATEGORY_SPACE" in str(list(value[2])):
            return "at each line all blank lines that follow are passed over"
        for each in inside((kind, value)):
            if why := slow(each, flags):
                return why
    return ""


def test_no_pattern_can_take_a_text_in_many_ways():
    found = {}
    for path in SOURCES:
        for line, text, flags in patterns(path):
            parsed = _parser.parse(text, flags)
            if why := slow(parsed, parsed.state.flags):
                found[f"{path.name}:{line}"] = why
    assert found == {}


@pytest.mark.parametrize(
    ("text", "flags"),
    [
        (r"\A\s*(?:<\?.*?\?>\s*|<!--.*?-->\s*)*<mujoco[\s>/]", re.S),  # what read descriptions of robots
        (r"(a.*)*b", re.S),
        (r"(?:x(?:.+?y)?)+z", re.S),
        (r"^\s*\(in-package", re.M),
    ],
)
def test_the_kinds_of_slow_patterns_are_found(text, flags):
    assert slow(_parser.parse(text, flags), flags)


@pytest.mark.parametrize(
    ("pieces", "text", "found"),
    [
        ([MULTI_CHAR, "a", MULTI_CHAR], "banana", ["banan", ""]),
        (["b", SINGLE_CHAR, MULTI_CHAR], "banana", ["a", "nana"]),
        ([(CHARACTER_SET, "a-c"), "x"], "bx", ["b"]),
        ([(CHARACTER_SET, "a-c"), "x"], "dx", None),
        ([], "", []),
        ([MULTI_CHAR, "a"] * 12 + ["b"], "a" * 250, None),  # took longer than anybody waits
    ],
)
def test_wild_pathnames_are_matched_in_one_way(pieces, text, found):
    assert Pattern(pieces).match(text) == found
