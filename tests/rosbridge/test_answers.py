"""A message that cannot be sent to one client costs that message, and it is told; every call of a service is answered."""

from __future__ import annotations

import json

import pytest

from bridge_clients import Wire
from cramhy_runtime import kernel
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact
from cramhy_runtime.rosbridge.rosapi import RosApi
from cramhy_runtime.ros.wire import NOT_A_NUMBER, POSITIVE_INFINITY


def made(ros_type, **fields):
    """A message with these values, whether they are allowed or not."""
    message = message_class_exact(ros_type)()
    for name, value in fields.items():
        setattr(message, name, value)
    return message


BAD = {  # type, field, value; the compressions in which it cannot be sent, and the end of the text that says so
    "a time out of range": ("std_msgs/Time", "data", 1e300, ["cbor-raw"], "which ROS 1 cannot write as time"),
    "a time before 1970": ("std_msgs/Time", "data", (-1.0), ["cbor-raw"], "which ROS 1 cannot write as time"),
    "a time that is none": ("std_msgs/Time", "data", NOT_A_NUMBER, ["none", "png", "cbor", "cbor-raw"], ""),
    "a time that is infinite": ("std_msgs/Duration", "data", POSITIVE_INFINITY, ["none", "png", "cbor", "cbor-raw"], ""),
    "a lone surrogate": ("std_msgs/String", "data", "a\ud800b", ["cbor"], "surrogates not allowed"),
    "a huge integer": ("std_msgs/Int64", "data", 10**5000, ["none", "png", "cbor-raw"], ""),
    "bytes that are none": ("std_msgs/UInt8MultiArray", "data", [300, -1], ["none", "png", "cbor", "cbor-raw"], ""),
    "no number": ("std_msgs/Float64", "data", "seven", ["none", "png", "cbor", "cbor-raw"], ""),
}


@pytest.mark.soak(all_but=7)
@pytest.mark.parametrize("compression", ["none", "png", "cbor", "cbor-raw"])
@pytest.mark.parametrize("bad", BAD)
def test_a_message_that_cannot_be_encoded_costs_that_message(graph, talk, other, bad, compression, capfd):
    ros_type, field, value, fails_as, text = BAD[bad]
    kind = message_class_exact(ros_type)
    publication = graph.node("plan").advertise("/bad", kind)
    for each in (talk, other):
        assert each.say(op="subscribe", topic="/bad", type=ros_type, compression=compression) == []
    for message in (kind(), made(ros_type, **{field: value}), kind()):
        publication.send(message)
    for each in (talk, other):
        found = each.heard()
        assert len(found) == 3 and each.outbox.reason is None
        told = found[1]
        if compression in fails_as:
            assert (told["op"], told["level"]) == ("status", "error")
            how = "" if compression == "none" else f" as {compression}"
            assert told["msg"].startswith(f"A message of /bad could not be sent to you{how}: ") and text in told["msg"]
        else:
            assert isinstance(told, bytes) or told["op"] in ("publish", "png")
        assert all(isinstance(one, bytes) or one["op"] != "status" for one in (found[0], found[2]))
    assert capfd.readouterr() == ("", "")


def test_who_wants_no_status_gets_none(graph, talk):
    publication = graph.node("plan").advertise("/bad", message_class_exact("std_msgs/Time"))
    talk.say(op="subscribe", topic="/bad")
    talk.say(op="set_level", level="none")
    publication.send(made("std_msgs/Time", data=NOT_A_NUMBER))
    assert talk.heard() == []


def test_with_real_sockets_neither_the_connection_nor_the_output_suffers(serve, outside, capfd):
    server = serve()
    kind = message_class_exact("std_msgs/Time")
    publication = server.graph.node("plan").advertise("/bad", kind)

    def client():
        with Wire(server.address) as raw, Wire(server.address) as plain:
            for wire, compression in ((raw, "cbor-raw"), (plain, "none")):
                wire.send(op="subscribe", topic="/bad", compression=compression)
                assert wire.call("/clear")["result"]
            kernel_side = made("std_msgs/Time", data=1e300)
            server.post(lambda: publication.send(kernel_side))
            server.post(lambda: publication.send(kind()))
            told = raw.until(op="status")
            assert told["msg"] == (
                "A message of /bad could not be sent to you as cbor-raw: std_msgs/Time: the field data holds 1e+300, "
                "which ROS 1 cannot write as time."
            )
            assert isinstance(raw.receive(), bytes)
            assert plain.receive()["op"] == plain.receive()["op"] == "publish"
            assert raw.call("/clear")["result"]

    outside(client)
    assert capfd.readouterr() == ("", "")


# ------------------------------------------------------------------------------------------------------------------ answers


ODD = {
    "a list": [1, 2],
    "an object": {"a": 1},
    "a boolean": True,
    "a long text": "x" * 501,
    "a large number": 2**70,
    "an infinity": 1e999,
    "a lone surrogate": "\ud800",
}
REPEATED = {"a list", "an object", "a boolean", "a large number", "a lone surrogate"}


@pytest.mark.parametrize("odd", ODD)
def test_a_call_with_an_odd_id_is_answered(talk, odd):
    (answer,) = talk.say(op="call_service", service="/nobody", id=ODD[odd])
    assert (answer["op"], answer["service"], answer["result"]) == ("service_response", "/nobody", False)
    assert ("id" in answer) == (odd in REPEATED)
    if odd in REPEATED:
        assert answer["id"] == ODD[odd]
    assert answer["values"] == (
        "Nobody offers the service /nobody." if odd == "a lone surrogate" else 'An "id" is a string of at most 500 characters, or a number.'
    )


@pytest.mark.parametrize(
    "operation",
    [
        {},
        {"service": 7},
        {"service": None},
        {"service": "/a//b"},
        {"service": "/clear", "args": "x"},
        {"service": "/clear", "args": [1]},
        {"service": "/clear", "compression": "zip"},
        {"service": "/clear", "fragment_size": "x"},
        {"service": "\ud800"},
        {"service": "/spawn", "args": 7},
    ],
)
def test_a_call_that_makes_no_sense_is_answered(talk, operation):
    (answer,) = talk.say(op="call_service", id="me", **operation)
    assert (answer["op"], answer["id"], answer["result"]) == ("service_response", "me", False) and answer["values"]


@pytest.mark.parametrize("compression", ["none", "png", "cbor", "cbor-raw"])
@pytest.mark.parametrize("value", ["a\ud800b", 10**5000], ids=["a lone surrogate", "a huge number"])
def test_an_answer_that_cannot_be_encoded_is_a_refusal(graph, talk, value, compression, capfd):
    kind = service_type_exact("std_srvs/Trigger" if isinstance(value, str) else "rosapi/GetROSVersion")
    service = graph.node("plan").serve("/odd", kind, lambda request: kind.response())
    response = kind.response()
    setattr(response, "message" if isinstance(value, str) else "version", value)
    service.submit = lambda call: call.finish(response)
    found = talk.say(op="call_service", service="/odd", id="me", compression=compression)
    answer = found[0]
    if isinstance(value, str) == (compression in ("none", "png")):
        assert len(found) == 1  # JSON has a way to write half a surrogate pair, and CBOR one to write huge numbers
        return
    assert (answer["op"], answer["id"], answer["result"]) == ("service_response", "me", False)
    assert answer["values"].startswith("The answer of the service /odd could not be sent to you: ")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("end", ["node", "service"])
def test_a_call_is_answered_when_the_service_or_its_node_ends(graph, talk, end):
    kind = service_type_exact("std_srvs/Empty")
    node = graph.node("plan", spins=True)
    node.serve("/slow", kind, lambda request: kind.response())
    assert talk.say(op="call_service", service="/slow", id="me") == []
    node.shutdown() if end == "node" else node.withdraw("/slow")
    (answer,) = talk.heard()
    assert (answer["id"], answer["result"], answer["values"]) == (
        "me",
        False,
        "The server of the service /slow went away before it answered.",
    )


def test_a_call_is_answered_when_the_client_that_offers_the_service_goes(talk, other):
    other.say(op="advertise_service", service="/far", type="std_srvs/Empty")
    assert talk.say(op="call_service", service="/far", id="me") == []
    other.session.close()
    (answer,) = talk.heard()
    assert (answer["id"], answer["result"]) == ("me", False)


def test_calls_are_answered_when_the_session_ends(serve, outside, beside):
    server = serve()
    kind = service_type_exact("std_srvs/Empty")
    server.graph.node("plan", spins=True).serve("/slow", kind, lambda request: kind.response())
    heard = []

    def client():
        with Wire(server.address) as wire:
            for number in range(3):
                wire.send(op="call_service", service="/slow", id=number)
            wire.send(op="call_service", service="/rosapi/get_ros_version", id="last")
            heard.append(wire.until(op="service_response", id="last"))
            heard.extend(wire.receive() for _ in range(3))
            heard.append(wire.closed())

    finish = beside(client)
    while not heard:
        kernel.sleep(0.02)
    server.close()
    finish()
    assert [(each["id"], each["result"], each["values"]) for each in heard[1:4]] == [
        (number, False, "The session ended before the service /slow answered.") for number in range(3)
    ]
    assert heard[4] == (1001, "The session has ended.")


@pytest.mark.parametrize(
    "value",
    [10**5000, float("nan"), float("inf"), b"bytes", object(), {"deep": [float("nan")]}],
    ids=["huge", "nan", "infinity", "bytes", "object", "nested"],
)
def test_a_parameter_that_json_does_not_have_is_refused_and_nothing_is_printed(graph, talk, value, capfd):
    RosApi(graph)
    graph.parameters.set("/odd", value)
    answer = talk.call("/rosapi/get_param", name="/odd", default="")
    assert answer["result"] is False and answer["values"].startswith("The parameter /odd cannot be sent as JSON: ")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("text", ["a\ud800b", "日本", "ä", "\0"], ids=ascii)
def test_a_parameter_of_any_text_is_answered(graph, talk, text, capfd):
    RosApi(graph)
    graph.parameters.set("/odd", text)
    answer = talk.call("/rosapi/get_param", name="/odd", default="")
    if answer["result"]:
        assert json.loads(answer["values"]["value"]) == text or "\ud800" in text
    else:
        assert "\ud800" in text
    assert capfd.readouterr() == ("", "")
