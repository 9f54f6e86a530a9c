"""What clients are told about the graph: only what users are shown, and an empty answer for what is not there."""

from __future__ import annotations

import pytest

from bridge_clients import Talk
from cramhy_runtime.ros import messages, type_texts
from cramhy_runtime.rosbridge.rosapi import SERVICES, RosApi


@pytest.fixture
def api(graph, hub):
    """Calls a service of rosapi: the values of its answer, or its text when it refuses."""
    RosApi(graph)
    talk = Talk(hub)
    return lambda service, /, **arguments: talk.call(f"/rosapi/{service}", **arguments)["values"]


def test_the_definitions_are_those_of_ros_noetic():
    """The sums that clients of ROS 1 know these types by."""
    sums = {
        "Topics": "d966d98fc333fa1f3135af765eac1ba8",
        "GetParam": "e36fd90759dbac1c5159140a7fa8c644",
        "SetParam": "bc6ccc4a57f61779c8eaae61e9f422e0",
        "GetTime": "556a4fb76023a469987922359d08a844",
        "ServiceType": "0e24a2dcdf70e483afc092a35a1f15f7",
        "Nodes": "3d07bfda1268b4f76b16b7ba8a82665d",
        "TopicType": "0d30b3f53a0fd5036523a7141e524ddf",
        "HasParam": "ed3df286bd6dff9b961770f577454ea9",
        "DeleteParam": "c1f3d28f1b044c871e6eff2e9fc3c667",
        "Services": "e44a7e7bcb900acadbcc28b132378f0c",
    }
    assert {name: type_texts.md5_of(messages.service_type_exact(f"rosapi/{name}")) for name in sums} == sums


def test_nobody_sees_rosapi_itself(api):
    assert api("nodes") == {"nodes": ["/rosout", "/turtlesim"]}
    assert not any("rosapi" in name for name in api("services")["services"])
    assert api("service_node", service="/rosapi/topics") == {"node": "/rosapi"}


def test_topics(api):
    found = api("topics")
    assert dict(zip(found["topics"], found["types"])) == {
        "/rosout": "rosgraph_msgs/Log",
        "/rosout_agg": "rosgraph_msgs/Log",
        "/turtle1/cmd_vel": "geometry_msgs/Twist",
        "/turtle1/color_sensor": "turtlesim/Color",
        "/turtle1/pose": "turtlesim/Pose",
    }
    assert api("topics_for_type", type="turtlesim/Pose") == {"topics": ["/turtle1/pose"]}
    assert api("topic_type", topic="turtle1/pose") == {"type": "turtlesim/Pose"}
    assert api("topic_type", topic="/nowhere") == {"type": ""}
    assert api("publishers", topic="/turtle1/pose") == {"publishers": ["/turtlesim"]}
    assert api("subscribers", topic="/turtle1/cmd_vel") == {"subscribers": ["/turtlesim"]}
    assert api("subscribers", topic="/nowhere") == {"subscribers": []}


def test_raw_types_hold_the_parts(api):
    found = api("topics_and_raw_types")
    text = dict(zip(found["topics"], found["typedefs_full_text"]))["/turtle1/cmd_vel"]
    assert text.count("MSG: geometry_msgs/Vector3") == 1


def test_services(api):
    assert api("services_for_type", type="turtlesim/Spawn") == {"services": ["/spawn"]}
    assert api("service_type", service="/spawn") == {"type": "turtlesim/Spawn"}
    assert api("service_node", service="/spawn") == {"node": "/turtlesim"}
    assert api("service_host", service="/spawn") == {"host": "127.0.0.1"}
    assert api("service_providers", service="turtlesim/Spawn") == {"providers": ["/turtlesim"]}
    assert api("service_type", service="/nowhere") == {"type": ""}
    assert api("node_details", node="/turtlesim")["publishing"] == ["/rosout", "/turtle1/color_sensor", "/turtle1/pose"]
    assert api("node_details", node="/nobody") == {"subscribing": [], "publishing": [], "services": []}


def test_details_of_types(api):
    (twist, vector) = api("message_details", type="geometry_msgs/Twist")["typedefs"]
    assert twist == {
        "type": "geometry_msgs/Twist",
        "fieldnames": ["linear", "angular"],
        "fieldtypes": ["geometry_msgs/Vector3"] * 2,
        "fieldarraylen": [-1, -1],
        "examples": ["{}", "{}"],
        "constnames": [],
        "constvalues": [],
    }
    assert vector["examples"] == ["0.0"] * 3
    (log, _) = api("message_details", type="rosgraph_msgs/Log")["typedefs"]
    assert dict(zip(log["fieldnames"], log["fieldarraylen"]))["topics"] == 0
    assert dict(zip(log["constnames"], log["constvalues"]))["WARN"] == "4"
    (request,) = api("service_request_details", type="turtlesim/Spawn")["typedefs"]
    assert request["fieldnames"] == ["x", "y", "theta", "name"]
    assert api("service_response_details", type="turtlesim/Nothing") == (
        "There is no type 'turtlesim/Nothing'. A type is written \"package/Name\"; its package must be on ROS_PACKAGE_PATH."
    )


def test_parameters_are_json_texts(api, graph):
    assert api("get_param", name="/turtlesim/background_b") == {"value": "255"}
    assert api("get_param", name="/nothing", default='{"a": 1}') == {"value": '{"a": 1}'}
    assert api("set_param", name="/limits", value='{"speed": 1.5, "names": ["ä"]}') == {}
    assert graph.parameters.get("/limits/names") == ["ä"]
    assert api("get_param", name="limits") == {"value": '{"speed": 1.5, "names": ["ä"]}'}
    assert api("set_param", name="/text", value="no JSON") == {}
    assert api("get_param", name="/text") == {"value": '"no JSON"'}
    assert api("has_param", name="/limits/speed") == {"exists": True}
    assert api("search_param", name="limits") == {"global_name": "/limits"}
    assert api("delete_param", name="/limits") == {}
    assert api("has_param", name="/limits/speed") == {"exists": False}
    assert api("delete_param", name="/limits") == "The parameter /limits is not set."
    assert "/text" in api("get_param_names")["names"]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("null", "A parameter has no value null. To remove one, call /rosapi/delete_param."),
        ('{"a": [1, null]}', "A parameter has no value null. To remove one, call /rosapi/delete_param."),
        ("[" * 60 + "]" * 60, "The value of a parameter has lists and dictionaries more than 50 deep in each other."),
    ],
)
def test_what_no_parameter_can_be_is_refused(api, value, text):
    assert api("set_param", name="/x", value=value) == text


def test_the_root_of_all_parameters_cannot_be_changed(api, graph):
    for name in ("", "/", "//"):
        assert api("delete_param", name=name) == "A parameter needs a name; all of them at once cannot be changed."
        assert api("set_param", name=name, value="{}") == "A parameter needs a name; all of them at once cannot be changed."
    assert graph.parameters.has("/turtlesim/background_b")


def test_action_servers(api, graph):
    node = graph.node("server")
    for part in ("goal", "cancel", "status", "feedback", "result"):
        node.advertise(f"/draw/{part}", messages.message_class_exact("std_msgs/Empty"))
    node.advertise("/other/goal", messages.message_class_exact("std_msgs/Empty"))
    assert api("action_servers") == {"action_servers": ["/draw"]}


def test_time_and_version(api):
    assert api("get_time")["time"]["secs"] == 1292688669
    assert api("get_ros_version") == {"version": 1, "distro": "noetic"}


def test_every_service_of_rosapi_has_its_definition():
    for name, kind in SERVICES.items():
        assert messages.service_type_exact(f"rosapi/{kind}") is not None, name
