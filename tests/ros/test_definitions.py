"""The language of .msg and .srv files."""

import pytest

from cramhy_runtime.ros import definition_text, messages
from cramhy_runtime.ros.definition_text import DefinitionError, parse_message, parse_service


def test_fields_constants_and_comments():
    definition = parse_message("# a comment\nint32 X=3 # three\nstring S=a # b\nfloat64[36] c\nHeader header\nPoint[] ps\n", "my_msgs")
    assert [repr(field) for field in definition.fields] == [
        "float64[36] c",
        "std_msgs/Header header",
        "my_msgs/Point[] ps",
    ]
    assert definition.constants == {"X": 3, "S": "a # b"}


def test_a_service_has_two_halves():
    request, response = parse_service("int64 a\n---\nint64 sum", "p")
    assert [len(request.fields), len(response.fields)] == [1, 1]


@pytest.mark.parametrize(
    "text, problem",
    [
        ("int32", 'here, line 1: "int32" is neither a field (TYPE NAME) nor a constant (TYPE NAME=VALUE).'),
        ("int32[x] a", 'here, line 1: "int32[x]" is not a type. Arrays are written T[] or T[3].'),
        ("int32 A=x", "here, line 1: x is not a int32."),
    ],
)
def test_errors_name_file_and_line(text, problem):
    with pytest.raises(DefinitionError) as error:
        parse_message(text, "p", "here")
    assert str(error.value) == problem


def test_every_definition_of_ours_loads_and_every_type_can_be_made():
    for package in definition_text.known_packages():
        classes, services = messages.load_package(package)
        for cls in [*classes, *(half for service in services for half in (service.request, service.response))]:
            assert len(cls().values()) == len(cls.fields)


def test_a_users_own_package_is_found(tmp_path):
    folder = tmp_path / "own_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Thing.msg").write_text("geometry_msgs/Point where\nstring name\n")
    definition_text.add_package_directory(tmp_path)
    try:
        thing = messages.message_class("own_msgs/Thing")()
        assert (thing.where.x, thing.name) == (0.0, "")
    finally:
        definition_text._directories.remove(tmp_path)
