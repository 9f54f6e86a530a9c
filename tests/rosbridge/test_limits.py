"""What a client with a token can make grow has an end, with a clear text; a program of this process is not limited."""

from __future__ import annotations

import json

import pytest

from bridge_clients import Talk
from cramhy_runtime import kernel
from cramhy_runtime.rosbridge.guard import Limits
from cramhy_runtime.rosbridge.hub import Hub
from cramhy_runtime.rosbridge.parsing import Fragments, Malformed
from cramhy_runtime.rosbridge.rosapi import RosApi


@pytest.fixture
def client(graph):
    """A function that makes a client of a hub with these limits, and with rosapi."""
    made = []

    def make(**limits):
        if not made:
            made.append(Hub(graph, limits=Limits(**limits)))
            RosApi(graph, made[0].limits)
        return Talk(made[0])

    return make


def set_param(talk, name, value):
    answer = talk.call("/rosapi/set_param", name=name, value=json.dumps(value))
    return answer["values"] if not answer["result"] else None


def test_parameters_have_a_number(client, graph):
    talk, other = client(parameters=3), client()
    assert set_param(talk, "/a", 1) is None
    assert set_param(other, "/b", {"c": 1, "d": {"e": 2}}) is None
    assert set_param(talk, "/f", 1) == "Clients have set 3 parameters; 3 are allowed. Delete some."
    assert not graph.parameters.has("/f")
    assert set_param(talk, "/a", 2) is None  # it takes the place of another value
    assert set_param(talk, "/b", 7) is None and set_param(talk, "/g", 1) is None
    assert set_param(talk, "/h", 1) == "Clients have set 3 parameters; 3 are allowed. Delete some."
    assert talk.call("/rosapi/delete_param", name="/a")["result"]
    assert set_param(talk, "/h", {}) is None


def test_parameters_have_a_size_and_a_length_of_name(client):
    talk = client(parameter=50, parameter_bytes=70, name=20)
    assert set_param(talk, "/a", "x" * 50) == "The value of /a has 52 bytes; 50 are allowed."
    assert set_param(talk, "/a", "x" * 40) is None
    assert set_param(talk, "/b", "x" * 40) == "The parameters that clients have set take 42 bytes; 70 are allowed. Delete some."
    assert set_param(talk, "/a", "x" * 45) is None
    assert set_param(talk, "/" + "a" * 20, 1) == "The name of the parameter has 21 characters; 20 are allowed."


def test_programs_of_this_process_set_as_many_parameters_as_they_like(client, graph):
    talk = client(parameters=1)
    for number in range(10):
        graph.parameters.set(f"/own/p{number}", number)
    assert set_param(talk, "/a", 1) is None
    from cramhy_runtime.ros import services

    service = graph.services["/rosapi/set_param"]
    assert services.exchange(service, service.type.request("/b", "1")).failure is None
    assert graph.parameters.get("/b") == 1


def test_turtles_of_clients_have_a_number(client, graph):
    talk, other = client(turtles=2, name=30), client()
    assert talk.call("/spawn", name="a")["result"] and other.call("/spawn", name="b")["result"]
    for each in (talk, other):
        answer = each.call("/spawn", name="c")
        assert (answer["result"], answer["values"]) == (False, "Clients have spawned 2 turtles; more are not allowed. Kill some.")
    from cramhy_runtime.turtlesim.node import running_simulator

    running_simulator().spawn("mine", 1.0, 1.0, 0.0)
    assert talk.call("/kill", name="a")["result"] and talk.call("/spawn", name="c")["result"]
    assert talk.call("/reset")["result"]
    assert talk.call("/spawn", name="x" * 31)["values"] == "The name of the turtle has 31 characters; 30 are allowed."
    assert talk.call("/spawn", name="d")["result"]


def test_latched_messages_of_a_client_have_a_size(client, graph):
    talk = client(latched=100)
    for topic in ("/a", "/b"):
        assert talk.say(op="advertise", topic=topic, type="std_msgs/String", latch=True) == []
        assert talk.say(op="publish", topic=topic, msg={"data": "x" * 50}) == []
    assert talk.say(op="publish", topic="/a", msg={"data": "x" * 40}) == []  # it takes the other's place
    (told,) = talk.say(op="publish", topic="/b", msg={"data": "x" * 61})
    assert told["msg"] == ("The latched messages that you publish take 40 bytes, and this one 61; 100 are allowed. Unadvertise some.")
    assert talk.say(op="unadvertise", topic="/a") == [] and talk.say(op="publish", topic="/b", msg={"data": "x" * 61}) == []


def test_programs_of_a_client_have_a_number(client, graph):
    from cramhy_runtime.ros_tools.hosting import Host

    Host()
    talk, other = client(programs=2), client()

    def start(each, name):
        return each.call(
            "/cramhy/start_program",
            package="turtlesim",
            executable="mimic",
            arguments=[f"__name:={name}", "input:=turtle1", "output:=nobody"],
        )

    assert start(talk, "a")["result"] and start(talk, "b")["result"]
    assert start(talk, "c")["values"] == "You have started 2 programs that still run; more are not allowed. End some."
    assert start(other, "c")["result"]
    assert talk.call("/cramhy/end_node", node="/a")["result"] and start(talk, "d")["result"]


def test_fragments_without_text_count_too():
    fragments = Fragments(Limits(reassembled=100_000))
    with pytest.raises(Malformed) as caught:
        for identity in range(1000):
            for number in range(999):
                fragments.add({"op": "fragment", "id": identity, "data": "", "num": number, "total": 1000})
    assert identity < 3 and "fragments wait for others; all were forgotten." in str(caught.value)


@pytest.mark.parametrize(
    "ros_type, message",
    [
        ("std_msgs/String", {"data": "x" * 1000}),
        ("std_msgs/UInt8MultiArray", {"data": [0] * 125}),
        ("turtlesim/Pose", None),
        ("sensor_msgs/JointState", {"name": ["x" * 100] * 9, "position": [0.0] * 9}),
    ],
)
def test_large_messages_that_wait_are_as_limited_as_many(client, ros_type, message):
    """Of small messages the number counts; of large ones their size, before the server's thread has looked at them, and after that."""
    talk, other = client(heavy=20_000, messages=1000), client()
    talk.say(op="advertise", topic="/large", type=ros_type)
    assert other.say(op="subscribe", topic="/large", type=ros_type) == []
    for _ in range(100):
        talk.session.receive({"op": "publish", "topic": "/large", "msg": message or {}})
    if message is None:
        assert other.outbox.reason is None and len(other.heard()) == 100 and other.outbox.weight == 0
    else:
        assert other.outbox.reason in (
            "More than 0 MB of messages wait for you. Subscribe with throttle_rate or queue_length.",
            "Messages of /large come faster than they can be sent. Subscribe with throttle_rate or queue_length.",
        )


def test_a_queue_of_large_messages_keeps_the_newest(client):
    talk, other = client(heavy=10_500), client()
    talk.say(op="advertise", topic="/large", type="std_msgs/String")
    other.say(op="subscribe", topic="/large", type="std_msgs/String", queue_length=1000)
    for number in range(50):
        talk.session.receive({"op": "publish", "topic": "/large", "msg": {"data": f"{number:1000}"}})
    assert [int(each["msg"]["data"]) for each in other.heard()] == list(range(40, 50))
    assert other.outbox.reason is None and other.outbox.weight == 0


def test_the_thread_that_is_late_keeps_no_more_than_is_allowed(graph):
    handed = []
    hub = Hub(graph, handed.append, Limits(heavy=10_500))
    talk = Talk(hub)
    talk.session.receive({"op": "subscribe", "topic": "/large", "type": "std_msgs/String", "queue_length": 1000})
    node = graph.node("plan")
    from cramhy_runtime.ros.messages import message_class_exact

    publication = node.advertise("/large", message_class_exact("std_msgs/String"))
    for number in range(50):
        publication.send(publication.type(f"{number:1000}"))
    (channel,) = hub.sides[False].channels.values()
    assert len(channel.backlog) == 10
    while handed:
        handed.pop(0)()
    assert [int(each["msg"]["data"]) for each in talk.heard()] == list(range(40, 50))
    kernel.sleep(0)


def test_a_line_of_the_log_has_a_length(client, graph):
    from cramhy_runtime.turtlesim.node import running_simulator

    talk = client()
    assert not talk.call("/kill", name="x" * 100_000)["result"]
    line = running_simulator().lines[-1]
    assert line.endswith("Tried to kill turtle [" + "x" * 1978 + "...") and len(graph.log[-1][2]) == 2003


def test_what_programs_of_clients_set_has_an_end_though_they_have_ended(client, graph):
    from cramhy_runtime.ros_tools.hosting import Host

    Host()
    talk = client(parameters=4)

    def start(name, *arguments):
        answer = talk.call(
            "/cramhy/start_program",
            package="turtlesim",
            executable="mimic",
            arguments=[f"__name:={name}", "input:=turtle1", "output:=nobody", *arguments],
        )
        if answer["result"]:
            talk.call("/cramhy/end_node", node=f"/{name}")
        return answer["values"]

    for name, arguments in (("a", ["_x:=1", "_y:=2"]), ("a", ["_x:=5"]), ("b", ["_x:=1", "_y:=2"])):
        assert start(name, *arguments)["node"] == f"/{name}"
    assert start("c") == "Programs of clients have set 4 parameters; they may not set more."
    assert start("a", "_x:=" + "5" * 10_000).startswith("The arguments of the program have 100")
