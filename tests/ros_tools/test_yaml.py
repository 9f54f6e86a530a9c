"""Values as one types them after a command, and as they are printed."""

from __future__ import annotations

import math

import pytest

from cramhy_runtime.ros_tools.yaml_library import parameter_file, parameter_text
from cramhy_runtime.ros_tools.yaml_reading import YamlError, read

BLOCK = """
linear:
  x: 2.0   # forward
  y: 0.0
angular: {x: 0, y: 0,
          z: 1.8}
names:
- a
- 'it''s'
-
  - 1
  - [2,
     3]
- key: v
  other: "a\\tb\\u00e4"
text: |
  one # no comment
    two

folded: >-
  three
  four
empty:
"a b": word with  spaces: no
"""


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("1.5", 1.5),
        ("1e3", 1000.0),
        ("-.5", -0.5),
        ("+7", 7),
        ("0x1F", 31),
        ("010", 8),
        ("0b11", 3),
        ("1_000", 1000),
        ("._5", 0.5),
        ("._", "._"),
        ("-._", "-._"),
        ("089", 89.0),
        ("true", True),
        ("Yes", True),
        ("off", False),
        ("~", None),
        ("", None),
        ("  # nothing", None),
        ('""', ""),
        ("turtle1", "turtle1"),
        ("'5'", "5"),
        ('"a\\nb"', "a\nb"),
        ("[1, 2.0]", [1, 2.0]),
        ("[]", []),
        ("[1, 2,]", [1, 2]),
        ("{}", {}),
        ("{x: 1, y: {z: a}}", {"x": 1, "y": {"z": "a"}}),
        ("{x: , y: 2}", {"x": None, "y": 2}),
        ("x: 1\ny: 2", {"x": 1, "y": 2}),
        ("-3", -3),
        ("/a/b", "/a/b"),
        ("http://host:11311/", "http://host:11311/"),
        ("a: 12:30", {"a": "12:30"}),
        ("-inf", "-inf"),
        ("-.inf", -math.inf),
        ("{1: 2, true: x}", {"1": 2, "true": "x"}),
        ("--- 1".replace(" ", "\n"), 1),
        ("two words", "two words"),
        ("- 1\n- - 2\n  - 3\n", [1, [2, 3]]),
        ("a:\n- 1\nb: 2", {"a": [1], "b": 2}),
        ("a #b", "a"),
        ("a#b", "a#b"),
        ("[a#b, c d]", ["a#b", "c d"]),
    ],
)
def test_text_that_is_a_value(text, value):
    assert read(text) == value


def test_a_number_that_is_none():
    assert math.isnan(read(".nan"))


def test_block_style():
    assert read(BLOCK.replace("  spaces: no", "  spaces")) == {
        "linear": {"x": 2.0, "y": 0.0},
        "angular": {"x": 0, "y": 0, "z": 1.8},
        "names": ["a", "it's", [1, [2, 3]], {"key": "v", "other": "a\tbä"}],
        "text": "one # no comment\n  two\n",
        "folded": "three four",
        "empty": None,
        "a b": "word with  spaces",
    }


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[1, 2", "line 1, column 1: the [ is never closed"),
        ("{a: 1", "line 1, column 1: the { is never closed"),
        ("{a 1}", "line 1, column 5: a mapping is written {key: value}, with a space after the colon"),
        ("{a:1}", "line 1, column 5: a mapping is written {key: value}, with a space after the colon"),
        ("[1 2] 3", "line 1, column 7: something follows the value: 3"),
        ('"abc', 'line 1, column 1: the " is never closed'),
        ("[{a: 1]]", "line 1, column 7: a comma or } is missing before ]]"),
        ("a: 1\n   b: 2", "line 2: a mapping is written key: value, with the keys below each other, but here is 'b: 2'"),
        ("a: 1\nb", "line 2: a mapping is written key: value, with the keys below each other, but here is 'b'"),
        ("a:\n    b: 1\n  c: 2", "line 3: a mapping is written key: value, with the keys below each other, but here is 'c: 2'"),
        ("&x 1", "line 1, column 1: an anchor cannot be used here"),
        ("{a: *x}", "line 1, column 5: an alias cannot be used here"),
        ("!!python/object:os.system 1", "line 1, column 1: a tag cannot be used here"),
        ("[" * 100_000, "the value is nested too deeply"),
        ("a: |x\n  b", "line 1: '|x' is not understood; a text over several lines begins with | or >"),
    ],
)
def test_text_that_is_no_value(text, message):
    with pytest.raises(YamlError) as caught:
        read(text)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (69, "69\n"),
        (True, "true\n"),
        (1.0, "1.0\n"),
        (1e-5, "1.0e-05\n"),
        (math.inf, ".inf\n"),
        ("hello", "hello\n"),
        ("69", "'69'\n"),
        ("", "''\n"),
        ("yes", "'yes'\n"),
        ("a: b", "'a: b'\n"),
        ("it's", "it's\n"),
        ("- x", "'- x'\n"),
        ("noetic\n", "'noetic\n\n  '\n"),
        ("tab\t", '"tab\\t"\n'),
        ([], "[]\n"),
        ({}, "{}\n"),
        ([1, [2, {"a": 3, "b": []}]], "- 1\n- - 2\n  - a: 3\n    b: []\n\n"),
        ({"b": {"c": [1, 2]}, "a": None}, "a: null\nb:\n  c:\n  - 1\n  - 2\n\n"),
    ],
)
def test_a_parameter_as_it_is_printed(value, text):
    assert parameter_text(value) == text


@pytest.mark.parametrize(
    "value",
    [
        {
            "a": {"b": [1, -2.5, "x", True, None, [[]], {"k": "v"}]},
            "text": "two\nlines\n",
            "odd": ["- a", "#", "'", '"', "a # b", "1e3", " x ", "ä€"],
            "n": {"": 1},
        }
    ],
)
def test_what_is_written_to_a_file_is_read_again(value):
    assert read(parameter_file(value)) == value
