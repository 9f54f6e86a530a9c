"""Operations of rosbridge v2, one client's and several clients', done on a graph in virtual time, without sockets."""

from __future__ import annotations

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact


def errors(found):
    return [each["msg"] for each in found if each["op"] == "status"]


def messages(found, topic):
    return [each["msg"] for each in found if each["op"] == "publish" and each["topic"] == topic]


# ------------------------------------------------------------------------------------------------------------------- topics


def test_a_client_drives_the_turtle_and_hears_where_it_is(talk):
    assert talk.say(op="advertise", topic="/turtle1/cmd_vel", type="geometry_msgs/Twist") == []
    talk.say(op="subscribe", topic="/turtle1/pose")
    kernel.sleep(0.1)
    found = talk.say(op="publish", topic="/turtle1/cmd_vel", msg={"linear": {"x": 1.0}})
    kernel.sleep(0.5)
    poses = messages(found + talk.heard(), "/turtle1/pose")
    assert poses[0]["x"] == pytest.approx(5.5444, abs=1e-3)
    assert poses[-1]["x"] > poses[0]["x"] + 0.3


def test_the_type_of_a_topic_that_is_there_is_known(talk):
    assert talk.say(op="publish", topic="/turtle1/cmd_vel", msg={"angular": {"z": 1}}) == []
    assert talk.say(op="subscribe", topic="turtle1/pose", type="turtlesim/msg/Pose") == []


def test_the_type_of_a_topic_that_is_not_there_must_be_given(talk):
    for operation in ("subscribe", "publish"):
        assert talk.say(op=operation, topic="/x", id="here") == [
            {
                "op": "status",
                "level": "error",
                "id": "here",
                "msg": "Nobody publishes on /x or listens to it yet, so its type is not known. Give the type, too.",
            }
        ]
    assert errors(talk.say(op="advertise", topic="/x")) == ['To advertise /x takes its type, such as "type": "geometry_msgs/Twist".']


def test_another_type_than_the_topic_has_is_refused(talk):
    text = "The topic /turtle1/pose has messages of the type turtlesim/Pose, not std_msgs/String."
    assert errors(talk.say(op="subscribe", topic="/turtle1/pose", type="std_msgs/String")) == [text]
    assert errors(talk.say(op="advertise", topic="/turtle1/pose", type="std_msgs/String")) == [text]


def test_an_unknown_type_is_refused(talk):
    assert errors(talk.say(op="advertise", topic="/x", type="no_such_msgs/Thing")) == [
        "There is no type 'no_such_msgs/Thing'. A type is written \"package/Name\"; its package must be on ROS_PACKAGE_PATH."
    ]


def test_clients_talk_to_each_other(talk, other):
    talk.say(op="advertise", topic="/chatter", type="std_msgs/String")
    other.say(op="subscribe", topic="/chatter")
    talk.say(op="publish", topic="/chatter", msg={"data": "grüß dich"})
    assert messages(other.heard(), "/chatter") == [{"data": "grüß dich"}]


def test_a_latched_message_reaches_whoever_comes_late(talk, other, hub):
    talk.say(op="advertise", topic="/map_name", type="std_msgs/String", latch=True)
    talk.say(op="publish", topic="/map_name", msg={"data": "hall"})
    assert messages(other.say(op="subscribe", topic="/map_name"), "/map_name") == [{"data": "hall"}]
    assert messages(talk.say(op="subscribe", topic="/map_name"), "/map_name") == [{"data": "hall"}]


def test_each_message_arrives_once_however_many_ids_subscribe(talk, other):
    talk.say(op="subscribe", topic="/turtle1/pose", id="a")
    talk.say(op="subscribe", topic="/turtle1/pose", id="b")
    other.say(op="subscribe", topic="/turtle1/pose")
    kernel.sleep(0.1)
    seen = messages(talk.heard(), "/turtle1/pose")
    assert len(seen) >= 4
    assert seen == messages(other.heard(), "/turtle1/pose")
    talk.say(op="unsubscribe", topic="/turtle1/pose", id="a")
    kernel.sleep(0.05)
    assert messages(talk.heard(), "/turtle1/pose")
    talk.say(op="unsubscribe", topic="/turtle1/pose", id="b")
    kernel.sleep(0.05)
    assert talk.heard() == []


def test_unsubscribing_without_an_id_ends_all(talk):
    for name in "ab":
        talk.say(op="subscribe", topic="/turtle1/pose", id=name)
    talk.say(op="unsubscribe", topic="/turtle1/pose")
    talk.heard()
    kernel.sleep(0.05)
    assert talk.heard() == []


def test_a_message_that_does_not_fit_its_type_is_told_with_the_field(talk):
    assert errors(talk.say(op="publish", topic="/turtle1/cmd_vel", msg={"linear": {"x": "fast"}})) == [
        "geometry_msgs/Twist message requires a float64 for field linear.x, but got a text, 'fast'."
    ]


def test_a_throttled_topic_comes_slower_and_brings_the_newest_in_the_end(talk):
    talk.say(op="subscribe", topic="/turtle1/pose", throttle_rate=100)
    talk.say(op="publish", topic="/turtle1/cmd_vel", msg={"linear": {"x": 1.0}})
    seen = []
    for _ in range(100):
        kernel.sleep(0.016)
        talk.now += 0.016
        seen += messages(talk.heard(), "/turtle1/pose")
    assert 15 <= len(seen) <= 17
    talk.now += 1
    seen += messages(talk.heard(), "/turtle1/pose")
    from cramhy_runtime.turtlesim.node import running_simulator

    assert seen[-1]["x"] == pytest.approx(running_simulator().turtles["turtle1"].pose()[0], abs=1e-6)


def test_a_queue_keeps_the_newest(talk):
    talk.say(op="subscribe", topic="/turtle1/pose", queue_length=3)
    talk.say(op="publish", topic="/turtle1/cmd_vel", msg={"linear": {"x": 1.0}})
    kernel.sleep(1.0)
    seen = messages(talk.heard(), "/turtle1/pose")
    assert len(seen) == 3
    assert seen[0]["x"] < seen[2]["x"]


def test_without_conditions_every_message_arrives_in_order(talk):
    talk.say(op="advertise", topic="/count", type="std_msgs/Int32")
    talk.say(op="subscribe", topic="/count")
    for number in range(500):
        kernel.post(lambda number=number: talk.session.receive({"op": "publish", "topic": "/count", "msg": {"data": number}}))
    kernel.yield_()
    assert [message["data"] for message in messages(talk.heard(), "/count")] == list(range(500))


def test_who_does_not_read_is_given_up_with_the_reason(graph):
    from cramhy_runtime.rosbridge.guard import Limits
    from cramhy_runtime.rosbridge.hub import Hub

    from bridge_clients import Talk

    talk = Talk(Hub(graph, limits=Limits(messages=50)))
    talk.say(op="subscribe", topic="/turtle1/pose")
    kernel.sleep(0.7)
    assert talk.outbox.reason is None
    kernel.sleep(0.3)
    assert talk.outbox.reason == "More than 50 messages of /turtle1/pose wait for you. Subscribe with throttle_rate or queue_length."


def test_a_node_is_on_the_graph_only_while_clients_need_it(graph, talk):
    assert "/rosbridge_websocket" not in graph.nodes
    talk.say(op="subscribe", topic="/turtle1/pose")
    assert "/rosbridge_websocket" in graph.visible_nodes()
    talk.session.close()
    assert "/rosbridge_websocket" not in graph.nodes


def test_an_observer_leaves_no_trace(graph, hub):
    from bridge_clients import Talk

    before = list(graph.visible_nodes()), list(graph.visible_topics()), list(graph.visible_services())
    observer = Talk(hub, hidden=True)
    observer.say(op="subscribe", topic="/turtle1/pose")
    observer.say(op="advertise", topic="/mine", type="std_msgs/String")
    observer.say(op="advertise_service", service="/mine", type="std_srvs/Empty")
    assert (list(graph.visible_nodes()), list(graph.visible_topics()), list(graph.visible_services())) == before
    kernel.sleep(0.05)
    assert messages(observer.heard(), "/turtle1/pose")


def test_what_a_client_had_goes_with_it(graph, talk):
    talk.say(op="advertise", topic="/x", type="std_msgs/String")
    talk.say(op="subscribe", topic="/y", type="std_msgs/String")
    talk.say(op="advertise_service", service="/z", type="std_srvs/Empty")
    assert {"/x", "/y"} <= set(graph.visible_topics()) and "/z" in graph.visible_services()
    talk.session.close()
    assert not {"/x", "/y"} & set(graph.visible_topics()) and "/z" not in graph.visible_services()


# ----------------------------------------------------------------------------------------------------------------- services


def test_a_service_of_the_simulator_answers_in_its_next_tick(talk):
    assert talk.call("/spawn", x=2, y=3, theta=0.5, name="anna") == {
        "op": "service_response",
        "id": "call",
        "service": "/spawn",
        "values": {"name": "anna"},
        "result": True,
    }


def test_arguments_may_be_a_list(talk):
    talk.say(op="call_service", service="/turtle1/teleport_absolute", args=[1, 2, 0], id=7)
    kernel.sleep(0.05)
    assert talk.heard() == [{"op": "service_response", "id": 7, "service": "/turtle1/teleport_absolute", "values": {}, "result": True}]


def test_a_refused_call_brings_the_reason(talk):
    answer = talk.call("/kill", name="nobody")
    assert (answer["result"], answer["values"]) == (False, "The service /kill refused, without a reason.")
    assert talk.call("/nowhere")["values"] == "Nobody offers the service /nowhere."
    assert talk.call("/spawn", x="left")["values"] == (
        "turtlesim/SpawnRequest message requires a float32 for field x, but got a text, 'left'."
    )


def test_a_server_that_goes_away_answers_nobody(talk, graph):
    talk.say(op="call_service", service="/spawn", args={"x": 1}, id="a")
    graph.nodes["/turtlesim"].shutdown()
    assert talk.heard()[0]["values"] == "The server of the service /spawn went away before it answered."


def test_a_client_offers_a_service_that_another_calls(talk, other):
    talk.say(op="advertise_service", service="/sum", type="roscpp_tutorials/TwoInts")
    assert other.say(op="call_service", service="/sum", args={"a": 2, "b": 3}, id="q") == []
    (request,) = talk.heard()
    assert (request["op"], request["service"], request["args"]) == ("call_service", "/sum", {"a": 2, "b": 3})
    talk.say(op="service_response", id=request["id"], service="/sum", values={"sum": 5}, result=True)
    assert other.heard() == [{"op": "service_response", "id": "q", "service": "/sum", "values": {"sum": 5}, "result": True}]


def test_a_plan_calls_a_client_and_no_plan_time_passes_meanwhile(talk):
    from cramhy_runtime.ros import graph, services

    kind = service_type_exact("roscpp_tutorials/TwoInts")
    talk.say(op="advertise_service", service="/sum", type="roscpp_tutorials/TwoInts")
    answers = []
    task = kernel.spawn(lambda: answers.append(services.exchange(graph.active().services["/sum"], kind.request(a=20, b=22)).response.sum))
    kernel.settle()
    (request,) = talk.heard()
    began = kernel.now()
    kernel.post(lambda: talk.session.receive({"op": "service_response", "id": request["id"], "values": {"sum": 42}}))
    task.join()
    assert answers == [42]
    assert kernel.now() == began


@pytest.mark.parametrize(
    ("answer", "failure"),
    [
        ({"result": False, "values": "not today"}, "not today"),
        ({"result": False}, ""),
        (
            {"values": {"sum": "many"}},
            "the answer of the client that offers /sum is wrong: roscpp_tutorials/TwoIntsResponse message requires a "
            "int64 for field sum, but got a text, 'many'.",
        ),
        (
            {"values": {"product": 1}},
            "the answer of the client that offers /sum is wrong: Message type roscpp_tutorials/TwoIntsResponse does "
            "not have a field product. The fields of roscpp_tutorials/TwoIntsResponse are sum.",
        ),
    ],
)
def test_a_client_that_fails_to_answer_fails_the_call(talk, answer, failure):
    from cramhy_runtime.ros import graph, services

    talk.say(op="advertise_service", service="/sum", type="roscpp_tutorials/TwoInts")
    calls = []
    services.start_call(graph.active().services["/sum"], service_type_exact("roscpp_tutorials/TwoInts").request(), calls.append)
    (request,) = talk.heard()
    talk.say(op="service_response", id=request["id"], **answer)
    assert calls[0].failure == failure


def test_a_client_that_never_answers_is_not_waited_for(talk):
    from cramhy_runtime.ros import graph, services

    talk.say(op="advertise_service", service="/sum", type="roscpp_tutorials/TwoInts")
    calls = []
    services.start_call(graph.active().services["/sum"], service_type_exact("roscpp_tutorials/TwoInts").request(), calls.append)
    (request,) = talk.heard()
    ((seconds, too_late),) = talk.reminders
    assert seconds == 60
    too_late()
    assert calls[0].failure == "the client that offers /sum did not answer within 60 s"
    assert errors(talk.say(op="service_response", id=request["id"], values={"sum": 1})) == [
        "Nobody waits for this answer: its id is none that you were called with, or it came too late."
    ]


def test_the_clock_goes_on_when_the_client_that_owes_an_answer_is_gone(talk):
    from cramhy_runtime.ros import graph, services

    talk.say(op="advertise_service", service="/sum", type="roscpp_tutorials/TwoInts")
    calls = []
    services.start_call(graph.active().services["/sum"], service_type_exact("roscpp_tutorials/TwoInts").request(), calls.append)
    talk.session.close()
    assert calls[0].lost
    kernel.sleep(1.0)


def test_nobody_takes_a_service_from_another_node(talk, other):
    assert errors(talk.say(op="advertise_service", service="/clear", type="std_srvs/Empty")) == [
        "The service /clear is offered already, by /turtlesim."
    ]
    other.say(op="advertise_service", service="/mine", type="std_srvs/Empty")
    assert errors(talk.say(op="advertise_service", service="/mine", type="std_srvs/Empty")) == [
        "The service /mine is offered already, by /rosbridge_websocket."
    ]
    assert other.say(op="advertise_service", service="/mine", type="std_srvs/SetBool") == []  # its own it may offer anew


# ------------------------------------------------------------------------------------------------------- status and encodings


def test_levels_of_status(talk):
    assert talk.say(op="unsubscribe", topic="/turtle1/pose") == []
    talk.say(op="set_level", level="warning")
    assert errors(talk.say(op="unsubscribe", topic="/turtle1/pose")) == ["You do not subscribe to /turtle1/pose."]
    assert errors(talk.say(op="unadvertise", topic="/a")) == ["You do not advertise /a."]
    assert errors(talk.say(op="unadvertise_service", service="/a")) == ["You do not offer the service /a."]
    talk.say(op="set_level", level="none")
    assert talk.say(op="levitate") == []
    assert talk.say(op="set_level", level="loud") == []
    talk.say(op="set_level", level="error")
    assert errors(talk.say(op="set_level", level="loud")) == ["There is no level 'loud'. There are info, warning, error, none."]


def test_fragments(talk):
    talk.say(op="subscribe", topic="/turtle1/pose", fragment_size=120, queue_length=1)
    kernel.sleep(0.05)
    parts = talk.heard()
    assert all(part["op"] == "fragment" and len(part["data"]) <= 120 for part in parts)
    assert len(parts) > 1
    assert [part["num"] for part in parts] == list(range(parts[0]["total"]))
    import json

    assert json.loads("".join(part["data"] for part in parts))["topic"] == "/turtle1/pose"


def test_a_fragment_holds_100_characters_at_least(talk):
    talk.say(op="subscribe", topic="/turtle1/pose", fragment_size=1, queue_length=1)
    kernel.sleep(0.05)
    parts = [part for part in talk.heard() if part["id"] == "fragment:1"]
    assert [len(part["data"]) for part in parts[:-1]] == [100] * (len(parts) - 1) and len(parts) > 1


def test_png(talk):
    import base64
    import io
    import json

    from PIL import Image

    talk.say(op="subscribe", topic="/turtle1/pose", compression="png", queue_length=1)
    kernel.sleep(0.05)
    (found,) = talk.heard()
    assert found["op"] == "png"
    picture = Image.open(io.BytesIO(base64.b64decode(found["data"])))
    assert json.loads(picture.tobytes().decode())["topic"] == "/turtle1/pose"


def test_cbor(talk):
    cbor2 = pytest.importorskip("cbor2")
    talk.say(op="subscribe", topic="/turtle1/pose", compression="cbor", queue_length=1)
    kernel.sleep(0.05)
    (found,) = talk.heard()
    assert cbor2.loads(found)["msg"]["x"] == pytest.approx(5.5444, abs=1e-3)


def test_the_bytes_of_ros_1_in_cbor(talk):
    import struct

    cbor2 = pytest.importorskip("cbor2")
    talk.say(op="subscribe", topic="/turtle1/pose", compression="cbor-raw", queue_length=1)
    kernel.sleep(0.05)
    (found,) = talk.heard()
    message = cbor2.loads(found)["msg"]
    assert struct.unpack("<5f", message["bytes"])[0] == pytest.approx(5.5444, abs=1e-3)
    assert message["secs"] == 1292688669


def test_the_bytes_of_ros_1_of_all_kinds_of_fields(graph):
    from cramhy_runtime.ros import wire
    from cramhy_runtime.ros.serialization import serialize

    log = wire.transmit(message_class_exact("rosgraph_msgs/Log")(name="ab", level=2, msg="ö", topics=["/x"], line=7))
    assert serialize(log) == (
        b"\x00\x00\x00\x00"
        + b"\x00" * 8
        + b"\x00\x00\x00\x00"
        + b"\x02"
        + b"\x02\x00\x00\x00ab"
        + b"\x02\x00\x00\x00\xc3\xb6"
        + b"\x00\x00\x00\x00"
        + b"\x00\x00\x00\x00"
        + b"\x07\x00\x00\x00"
        + b"\x01\x00\x00\x00"
        + b"\x02\x00\x00\x00/x"
    )
