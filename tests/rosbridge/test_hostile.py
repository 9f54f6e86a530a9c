"""Clients that mean no good, or are broken: each is refused or told, and the session goes on as if nothing had been.

The cases of law 9 and of the issue: DNS rebinding, other pages, tokens, frames, JSON, operations. Floods are in `test_floods`.
"""

from __future__ import annotations

# Tables of what strangers send, a line each:
# fmt: off

import base64
import hashlib
import http.client
import json
import os
import socket
import struct
import subprocess
import sys
import time

import pytest

from bridge_clients import Wire

NO_TOKEN = 'The first message must be {"op": "auth", "token": "..."} with the token of this session.'
PAGES = {"/": ("<p>turtle</p>", "text/html"), "/secret.txt": ("not for all", "text/plain")}


PROGRAM = """
import json, sys
from cramhy_runtime import kernel, rosbridge
from cramhy_runtime.session import boot
from cramhy_runtime.rosbridge.guard import Limits
from cramhy_runtime.turtlesim.node import start_turtlesim

kernel.start(clock="virtual")
boot()
start_turtlesim()
limits = Limits(first_message=1.0, complaints=20, message=100_000, reassembled=300_000)
server = rosbridge.start(pages=json.loads(sys.argv[1]), limits=limits)
print(json.dumps([server.port, server.token, server.address]), flush=True)
kernel.run_blocking(sys.stdin.read)
kernel.stop()
print("ended in order", flush=True)
"""


class Running:
    """A session in a process of its own, with a server, which waits at its prompt in virtual time."""

    def __init__(self, folder):
        self.errors = open(folder / "errors", "w+")
        self.process = subprocess.Popen([sys.executable, "-c", PROGRAM, json.dumps(PAGES)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self.errors, text=True, env={**os.environ, "XDG_RUNTIME_DIR": str(folder)})
        self.port, self.token, self.address = json.loads(self.process.stdout.readline())

    def told(self):
        """What the user was told since the start: nothing, for nothing that a client does is a defect of ours."""
        self.errors.seek(0)
        return self.errors.read()


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    """One session for all cases: it must survive them all, and end in order."""
    session = Running(tmp_path_factory.mktemp("runtime"))
    yield session
    rest, _ = session.process.communicate("", timeout=60)
    assert (rest, session.process.returncode) == ("ended in order\n", 0)
    session.errors.close()


@pytest.fixture
def server(running):
    """The session; afterwards it must answer an honest client as if nothing had been, and have told the user of no defect."""
    yield running
    with Wire(running.address) as wire:
        assert wire.call("/rosapi/topic_type", topic="/turtle1/pose")["values"] == {"type": "turtlesim/Pose"}
        assert wire.call("/clear")["result"]
    assert running.told() == ""


def request(server, method="GET", path="/", **headers):
    """Status and body of a plain request."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
    try:
        connection.putrequest(method, path, skip_host=True)
        for name, value in {"Host": f"127.0.0.1:{server.port}", **headers}.items():
            for each in value if isinstance(value, list) else [value]:
                connection.putheader(name.replace("_", "-"), each)
        connection.endheaders()
        answer = connection.getresponse()
        body = "" if answer.status == 101 else answer.read().decode()
        return answer.status, body, {name.lower(): value for name, value in answer.getheaders()}
    finally:
        connection.close()


def upgrade(server, path=None, **headers):
    """The status line of a request for a WebSocket."""
    return request(server, path=f"/{server.token}" if path is None else path, Upgrade="websocket", Connection="Upgrade",
                   Sec_WebSocket_Key=base64.b64encode(b"0123456789abcdef").decode(), Sec_WebSocket_Version="13", **headers)


def talk(server, function, address=None):
    """What FUNCTION does with a WebSocket."""
    with Wire(server.address if address is None else address) as wire:
        return function(wire)


def stranger(server):
    return f"ws://127.0.0.1:{server.port}/"


# ------------------------------------------------------------------------------------------------------- hosts and origins


HOSTS = ["evil.example", "evil.example:80", "127.0.0.1", "127.0.0.1:1", "localhost:1", "127.0.0.1.evil.example", "[::1]:80", "", "0.0.0.0"]


@pytest.mark.parametrize("host", HOSTS)
def test_a_page_that_had_its_name_point_here_is_refused(server, host):
    text = "This server answers to 127.0.0.1 and localhost only, with its port.\n"
    assert request(server, Host=host)[:2] == (421, text)
    assert upgrade(server, Host=host)[:2] == (421, text)


def test_two_hosts_are_refused(server):
    assert request(server, Host=[f"127.0.0.1:{server.port}", "evil.example"])[0] in (400, 421)


ORIGINS = ["http://evil.example", "https://127.0.0.1", "http://127.0.0.1:1", "null", "file://", "http://localhost",
           "chrome-extension://abc", ""]


@pytest.mark.parametrize("origin", ORIGINS)
def test_pages_of_others_are_refused(server, origin):
    text = "Pages of other servers may not connect. One that you trust can be named with --origin.\n"
    assert request(server, Origin=origin)[:2] == (403, text)
    assert upgrade(server, Origin=origin)[:2] == (403, text)


def test_its_own_page_may_connect(server):
    assert upgrade(server, Origin=f"http://127.0.0.1:{server.port}")[0] == 101
    assert upgrade(server, Origin=f"http://localhost:{server.port}")[0] == 101


def test_other_pages_cannot_load_anything(server):
    assert request(server, Sec_Fetch_Site="cross-site", Sec_Fetch_Mode="no-cors")[0] == 403
    assert request(server, Sec_Fetch_Site="cross-site", Sec_Fetch_Mode="navigate")[0] == 200


def test_no_answer_has_a_header_of_cors(server):
    for answer in (request(server), request(server, Origin="http://evil.example"), request(server, "OPTIONS", Origin="http://evil.example")):
        assert not any(name.startswith("access-control") for name in answer[2])


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "PROPFIND", "X"])
def test_other_methods_are_refused(server, method):
    status, text, headers = request(server, method)
    assert (status, text, headers["allow"]) == (405, "Only GET and HEAD are answered here.\n", "GET, HEAD")


PATHS = ["/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "//secret.txt", "/secret.txt/", "/.env", "/session.json", "/%00",
         "/" + "a" * 3000, "/__proto__", "/constructor", "/proc/self/environ", "\\secret.txt"]


@pytest.mark.parametrize("path", PATHS)
def test_only_the_pages_that_there_are(server, path):
    assert request(server, path=path)[0] in (400, 404)


@pytest.mark.soak
def test_a_head_that_never_ends_is_given_up(server):
    def drip():
        with socket.create_connection(("127.0.0.1", server.port), 20) as slow:
            slow.sendall(b"GET / HTTP/1.1\r\nHost: ")
            slow.settimeout(20)
            try:
                return slow.recv(100)
            except ConnectionResetError:
                return b""

    assert drip() == b""


def test_a_second_head_that_never_ends_is_given_up_likewise(server):
    whole = f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n\r\n".encode()
    with socket.create_connection(("127.0.0.1", server.port), 20) as slow:
        slow.settimeout(20)
        slow.sendall(whole)
        answer = b""
        while not answer.endswith(b"<p>turtle</p>"):
            answer += slow.recv(1000)
        slow.sendall(whole[:20])
        try:
            assert slow.recv(100) == b""
        except ConnectionResetError:
            pass


@pytest.mark.parametrize("data", [b"\x16\x03\x01\x02\x00\x01", b"GET\r\n\r\n", b"\x00" * 1000, b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 5000,
                                  b"GET / HTTP/9.9\r\n\r\n", b"GET / HTTP/1.1\r\nHost: a\r\nContent-Length: -1\r\n\r\n"])
def test_what_is_no_request_is_refused(server, data):
    def send():
        with socket.create_connection(("127.0.0.1", server.port), 20) as raw:
            raw.settimeout(20)
            try:
                raw.sendall(data)
                return raw.recv(1000)
            except (ConnectionResetError, BrokenPipeError):
                return b""

    answer = send()
    assert answer == b"" or answer.startswith(b"HTTP/1.1 4"), answer


# ------------------------------------------------------------------------------------------------------------------ tokens


@pytest.mark.parametrize("path", ["/wrong", "/?token=wrong", "/a/b", "/?token=a&token=b", "/%ff", "/?token=" + "a" * 5000])
def test_a_wrong_token_in_the_address_is_refused(server, path):
    assert upgrade(server, path)[:2] == (403, "This is not the token of this session, or no address of it.\n")


def test_nearly_the_token_is_refused(server):
    for token in (server.token[:-1], server.token + "a", server.token.swapcase(), server.token + "/x"):
        assert upgrade(server, "/" + token)[0] == 403


def test_a_token_in_the_query_is_good(server):
    assert upgrade(server, f"/?token={server.token}")[0] == 101


FIRST = [{"op": "call_service", "service": "/clear"}, {"op": "auth"}, {"op": "auth", "token": "wrong"}, {"op": "auth", "token": None},
         {"op": "auth", "token": ["a"]}, {"op": "auth", "token": {}}, {"op": "auth", "token": 5}, {"op": "auth", "token": True},
         {"op": "auth", "mac": "x"}, [], "auth", 7, None, {"token": "x"}]


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize("message", FIRST, ids=json.dumps)
def test_who_does_not_begin_with_the_token_is_closed(server, message):
    def client(wire):
        wire.socket.send(json.dumps(message))
        return wire.closed()

    assert talk(server, client, stranger(server)) == (1008, NO_TOKEN)


@pytest.mark.parametrize("data", [b"\x00\x01", "{", "\x00", '{"op":"auth","token":"' + "a" * 50_000 + '"}'],
                         ids=["binary", "broken", "null", "long"])
def test_a_first_message_that_is_none_is_closed(server, data):
    def client(wire):
        wire.socket.send(data)
        return wire.closed()

    assert talk(server, client, stranger(server)) == (1008, NO_TOKEN)


@pytest.mark.soak
def test_who_says_nothing_is_closed(server):
    assert talk(server, lambda wire: wire.closed(), stranger(server)) == (
        1013, 'No token came within 1 s. The first message must be {"op": "auth", "token": "..."}.')


def test_the_token_as_the_first_message_is_good(server):
    def client(wire):
        wire.send(op="auth", token=server.token)
        return wire.call("/rosapi/topic_type", topic="/turtle1/pose")["result"]

    assert talk(server, client, stranger(server)) is True


def test_what_comes_behind_a_wrong_token_is_not_done(server):
    def client(wire):
        wire.send(op="auth", token="wrong")
        try:
            for _ in range(50):
                wire.send(op="publish", topic="/stolen", type="std_msgs/String", msg={"data": "x"})
        except Exception:
            pass
        return wire.closed()

    assert talk(server, client, stranger(server))[0] in (1008, None)
    assert "/stolen" not in talk(server, lambda wire: wire.call("/rosapi/topics"))["values"]["topics"]


def rosauth(secret, begin, end, mac=None):
    parts = {"client": "me", "dest": "turtle", "rand": "r4nd", "level": "user"}
    text = f"{secret}{parts['client']}{parts['dest']}{parts['rand']}{begin}{parts['level']}{end}"
    return {"op": "auth", "mac": mac or hashlib.sha512(text.encode()).hexdigest(), "t": begin, "end": end, **parts}


def test_rosbridges_own_first_message_is_good_with_the_token_as_secret(server):
    def client(wire):
        now = int(time.time())
        wire.send(**rosauth(server.token, now, now + 60))
        return wire.call("/rosapi/topic_type", topic="/turtle1/pose")["result"]

    assert talk(server, client, stranger(server)) is True


@pytest.mark.parametrize(("secret", "begin", "end", "mac"), [("wrong", 0, 60, None), (None, -60, 60, None), (None, 60, 120, None),
                                                             (None, 0, -1, None), (None, 0, 60, "a" * 128), (None, 0, 60, 5)])
def test_a_first_message_of_rosbridge_that_is_forged_or_old_is_closed(server, secret, begin, end, mac):
    def client(wire):
        now = int(time.time())
        wire.send(**rosauth(secret or server.token, now + begin, now + end, mac))
        return wire.closed()

    assert talk(server, client, stranger(server)) == (1008, NO_TOKEN)


# -------------------------------------------------------------------------------------------------------------------- frames


def raw_frame(opcode, payload, fin=True, mask=True, length=None):
    """A frame of a WebSocket, as broken as wanted."""
    size = len(payload) if length is None else length
    head = bytes([(0x80 if fin else 0) | opcode])
    if size < 126:
        head += bytes([(0x80 if mask else 0) | size])
    elif size < 65536:
        head += bytes([(0x80 if mask else 0) | 126]) + struct.pack(">H", size)
    else:
        head += bytes([(0x80 if mask else 0) | 127]) + struct.pack(">Q", size)
    return head + (b"\0\0\0\0" if mask else b"") + payload


FRAMES = {
    "not masked": raw_frame(1, b"{}", mask=False),
    "longer than allowed": raw_frame(1, b"{" + b" " * 200_000),
    "says that it is enormous": raw_frame(1, b"{}", length=2**62),
    "parts longer than allowed": raw_frame(1, b" " * 60_000, fin=False) + raw_frame(0, b" " * 60_000),
    "no UTF-8": raw_frame(1, b"\xff\xfe"),
    "unknown kind": raw_frame(3, b"{}"),
    "continues nothing": raw_frame(0, b"{}"),
    "long ping": raw_frame(9, b"a" * 200),
    "ping in parts": raw_frame(9, b"a", fin=False),
    "reserved bits": bytes([0xF1, 0x80]) + b"\0\0\0\0",
    "broken close": raw_frame(8, b"\x00"),
}


@pytest.mark.parametrize("data", FRAMES.values(), ids=FRAMES)
def test_broken_frames_close_the_connection(server, data):
    def client():
        with socket.create_connection(("127.0.0.1", server.port), 20) as raw:
            raw.settimeout(20)
            raw.sendall((f"GET /{server.token} HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                         "Sec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
            assert raw.recv(1000).startswith(b"HTTP/1.1 101")
            found = b""
            try:
                raw.sendall(data)
                while part := raw.recv(1000):
                    found += part
            except (ConnectionResetError, BrokenPipeError):
                pass
            return found

    assert client()[:1] in (b"\x88", b"")


@pytest.mark.parametrize("data", [raw_frame(1, b'{"op": "publ', fin=False), raw_frame(1, b'{"op": "publ', length=5000), b"\x81", b""],
                         ids=["half a message", "half a frame", "half a head", "nothing"])
def test_who_breaks_off_in_the_middle_harms_nobody(server, data):
    def client():
        with socket.create_connection(("127.0.0.1", server.port), 20) as raw:
            raw.sendall((f"GET /{server.token} HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                         "Sec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
            raw.recv(1000)
            raw.sendall(data)
            raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # the system sends a reset

    client()


# ------------------------------------------------------------------------------------------------------------------- messages


DEEP = "[" * 60 + "]" * 60
TEXTS = {
    "{": "The message is not JSON: Expecting property name enclosed in double quotes at character 1.",
    "": "The message is not JSON: Expecting value at character 0.",
    "[]": "An operation is a JSON object, but this is an array.",
    "null": "An operation is a JSON object, but this is null.",
    "7": "An operation is a JSON object, but this is a number.",
    '"op"': "An operation is a JSON object, but this is a string.",
    "{}": 'The message has no operation: an object needs "op", a string such as "subscribe" or "publish".',
    '{"op": 5}': '"op" must be a string, but it is a number.',
    '{"op": {"a": 1}}': '"op" must be a string, but it is an object.',
    '{"op": null}': '"op" must be a string, but it is null.',
    '{"op": "publish", "x": NaN}': "The message is not JSON: it has the number NaN, which JSON does not have. Send null for a real that "
                                   "is not a number.",
    '{"op": "publish", "x": -Infinity}': "The message is not JSON: it has the number -Infinity, which JSON does not have. Send null for a "
                                         "real that is not a number.",
    '{"op": "publish", "x": ' + "9" * 5000 + "}": "The message has a number of 5000 digits; 400 are allowed.",
    '{"op": "publish", "x": 0.' + "9" * 5000 + "}": "The message has a number of 5002 digits; 400 are allowed.",
    '{"op": "publish", "x": ' + DEEP + "}": "The message has arrays and objects more than 50 deep in each other.",
    "[" * 90_000: "The message has arrays and objects more than 50 deep in each other.",
    '{"a":' * 15_000: "The message has arrays and objects more than 50 deep in each other.",
    '{"op": "x", "a": "' + '\\"' * 40_000: "The message is not JSON: Unterminated string starting at at character 17.",
}


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize(("text", "told"), TEXTS.items(), ids=[text[:30] for text in TEXTS])
def test_what_is_no_operation_is_told(server, text, told):
    def client(wire):
        wire.socket.send(text)
        return wire.receive()

    assert talk(server, client) == {"op": "status", "level": "error", "msg": told}


def test_binary_messages_are_told(server):
    def client(wire):
        wire.socket.send(b"\xa1bopgpublish")
        return wire.receive()["msg"]

    assert talk(server, client) == "Binary messages are not understood here: an operation is a text message with a JSON object."


OPERATIONS = [
    ({"op": "__proto__"}, "There is no operation '__proto__'."),
    ({"op": "constructor"}, "There is no operation 'constructor'."),
    ({"op": "__class__", "topic": "__init__"}, "There is no operation '__class__'."),
    ({"op": "close"}, "There is no operation 'close'."),
    ({"op": "receive", "operation": {}}, "There is no operation 'receive'."),
    ({"op": "eval", "form": "(quit)"}, "There is no operation 'eval'."),
    ({"op": "a" * 5000}, "There is no operation '" + "a" * 60 + "…'."),
    ({"op": "send_action_goal", "action": "/x"}, "There is no operation 'send_action_goal'."),
    ({"op": "png", "data": "x"}, "Operations in pictures (png) are not understood here; send JSON."),
    ({"op": "subscribe"}, 'A topic is named by a string, such as "/turtle1/pose".'),
    ({"op": "subscribe", "topic": ["/turtle1/pose"]}, 'A topic is named by a string, such as "/turtle1/pose".'),
    ({"op": "subscribe", "topic": ""}, 'A topic is named by a string, such as "/turtle1/pose".'),
    ({"op": "subscribe", "topic": "/../../etc/passwd", "type": "std_msgs/String"}, "Character [.] at element [1] is not valid"),
    ({"op": "subscribe", "topic": "/a b", "type": "std_msgs/String"}, "Character [ ] at element [2] is not valid"),
    ({"op": "subscribe", "topic": "/" + "a" * 600}, "The name of the topic has 601 characters; 500 are allowed."),
    ({"op": "subscribe", "topic": "//x", "type": "std_msgs/String"}, "//x is not a name of a topic: a part of it is empty."),
    ({"op": "subscribe", "topic": "/x", "type": "../../etc/passwd"}, "There is no type '../../etc/passwd'."),
    ({"op": "subscribe", "topic": "/x", "type": "std_msgs/../../x"}, "There is no type 'std_msgs/../../x'."),
    ({"op": "subscribe", "topic": "/x", "type": {"a": 1}}, "There is no type {'a': 1}."),
    ({"op": "subscribe", "topic": "/turtle1/pose", "throttle_rate": "fast"}, '"throttle_rate" must be a whole number from 0 on, but it is '
                                                                             "'fast'."),
    ({"op": "subscribe", "topic": "/turtle1/pose", "throttle_rate": -1}, '"throttle_rate" must be a whole number from 0 on, but it is -1.'),
    ({"op": "subscribe", "topic": "/turtle1/pose", "queue_length": 1e300}, '"queue_length" must be a whole number from 0 on'),
    ({"op": "subscribe", "topic": "/turtle1/pose", "queue_length": 10**40}, '"queue_length" must be a whole number from 0 on'),
    ({"op": "subscribe", "topic": "/turtle1/pose", "fragment_size": 0}, '"fragment_size" must be a whole number from 1 on, but it is 0.'),
    ({"op": "subscribe", "topic": "/turtle1/pose", "compression": "zip"}, "There is no compression 'zip'."),
    ({"op": "subscribe", "topic": "/turtle1/pose", "compression": ["png"]}, "There is no compression an array."),
    ({"op": "subscribe", "topic": "/turtle1/pose", "id": {"a": 1}}, 'An "id" is a string of at most 500 characters, or a number.'),
    ({"op": "subscribe", "topic": "/turtle1/pose", "id": True}, 'An "id" is a string of at most 500 characters, or a number.'),
    ({"op": "subscribe", "topic": "/turtle1/pose", "id": "x" * 501}, 'An "id" is a string of at most 500 characters, or a number.'),
    ({"op": "subscribe", "topic": "/turtle1/pose", "id": 10**30}, 'An "id" is a string of at most 500 characters, or a number.'),
    ({"op": "advertise", "topic": "/x", "type": 5}, "There is no type 5."),
    ({"op": "advertise", "topic": "/x", "type": "std_msgs/String", "latch": "yes"}, '"latch" must be true or false, but it is a string.'),
    ({"op": "publish", "topic": "/turtle1/cmd_vel", "msg": []}, "geometry_msgs/Twist message requires"),
    ({"op": "publish", "topic": "/turtle1/cmd_vel", "msg": {"linear": {"x": True}}}, "geometry_msgs/Twist message requires a float64"),
    ({"op": "publish", "topic": "/turtle1/cmd_vel", "msg": {"__class__": 1}}, "Message type geometry_msgs/Twist does not have a field"),
    ({"op": "publish", "topic": "/turtle1/cmd_vel", "msg": {"linear": {"x": 10**399}}}, "geometry_msgs/Twist message requires a float64"),
    ({"op": "publish", "topic": "/n", "type": "std_msgs/UInt8", "msg": {"data": 256}}, "std_msgs/UInt8 message requires a uint8"),
    ({"op": "publish", "topic": "/t", "type": "std_msgs/Time", "msg": {"data": {"secs": -1}}}, "std_msgs/Time message requires a time"),
    ({"op": "advertise_service", "service": "/clear", "type": "std_srvs/Empty"}, "The service /clear is offered already, by /turtlesim."),
    ({"op": "advertise_service", "service": "/rosapi/topics", "type": "rosapi/Topics"}, "The service /rosapi/topics is offered already"),
    ({"op": "advertise_service", "service": "/x", "type": "std_msgs/String"}, "There is no type 'std_msgs/String'."),
    ({"op": "advertise_service", "service": "/x"}, "There is no type None."),
    ({"op": "service_response", "service": "/x", "id": "service_request:/x:1", "values": {}}, "Nobody waits for this answer"),
    ({"op": "service_response", "values": {}}, "Nobody waits for this answer"),
    ({"op": "service_response", "id": [1]}, 'An "id" is a string'),
    ({"op": "set_level", "level": 7}, "There is no level 7."),
    ({"op": "set_level"}, "There is no level null."),
    ({"op": "fragment"}, 'A fragment needs an "id", a string of at most 500 characters.'),
    ({"op": "fragment", "id": "a", "data": 5, "num": 0, "total": 1}, 'The "data" of a fragment is a string, but here it is a number.'),
    ({"op": "fragment", "id": "a", "data": "x", "num": 1, "total": 1}, 'The "num" of a fragment is a number from 0 to 0'),
    ({"op": "fragment", "id": "a", "data": "x", "num": 0, "total": 10**9}, 'The "total" of a fragment is a number from 1 to 1000.'),
    ({"op": "fragment", "id": "a", "data": "x", "num": 0, "total": True}, 'The "total" of a fragment is a number from 1 to 1000.'),
    ({"op": "fragment", "id": "a", "data": "{", "num": 0, "total": 1}, "The message is not JSON"),
]


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize(("operation", "told"), OPERATIONS, ids=[json.dumps(each[0])[:60] for each in OPERATIONS])
def test_operations_that_cannot_be_done_are_told(server, operation, told):
    def client(wire):
        wire.send(**operation)
        return wire.receive()

    found = talk(server, client)
    assert (found["op"], found["level"]) == ("status", "error")
    assert found["msg"].startswith(told), found["msg"]
    assert len(found["msg"]) < 1000


CALLS = [
    ({"service": "/nowhere"}, "Nobody offers the service /nowhere."),
    ({}, 'A service is named by a string, such as "/turtle1/pose".'),
    ({"service": 5}, 'A service is named by a string, such as "/turtle1/pose".'),
    ({"service": "/spawn", "args": "x"}, "turtlesim/SpawnRequest message requires"),
    ({"service": "/spawn", "args": [1, 2, 3, 4, 5]}, "turtlesim/SpawnRequest takes 4 arguments (x, y, theta, name), but 5 were given."),
    ({"service": "/spawn", "args": {"x": [1]}}, "turtlesim/SpawnRequest message requires a float32 for field x"),
    ({"service": "/spawn", "args": {"hasOwnProperty": 1}}, "Message type turtlesim/SpawnRequest does not have a field"),
    ({"service": "/spawn", "fragment_size": -5}, '"fragment_size" must be a whole number from 1 on, but it is -5.'),
    ({"service": "/spawn", "compression": "gzip"}, "There is no compression 'gzip'."),
]


@pytest.mark.parametrize(("call", "told"), CALLS, ids=[json.dumps(each[0]) for each in CALLS])
def test_calls_that_cannot_be_made_are_answered(server, call, told):
    def client(wire):
        wire.send(op="call_service", id="q", **call)
        return wire.receive()

    found = talk(server, client)
    assert (found["op"], found["id"], found["result"]) == ("service_response", "q", False)
    assert found["values"].startswith(told), found["values"]


def test_fragments_that_wait_for_ever_are_forgotten(server):
    def client(wire):
        for number in range(10):
            wire.send(op="fragment", id=f"f{number}", data="x" * 90_000, num=0, total=2)
            if number == 3:
                return wire.receive()["msg"]

    assert talk(server, client) == "More than 0 MB of fragments wait for others; all were forgotten."


def test_fragments_in_any_order_make_a_message(server):
    def client(wire):
        text = json.dumps({"op": "call_service", "service": "/rosapi/get_ros_version", "id": "whole"})
        parts = [text[start:start + 20] for start in range(0, len(text), 20)]
        for number in [2, 0, *range(3, len(parts)), 0, 1]:
            wire.send(op="fragment", id="f", data=parts[number], num=number, total=len(parts))
        return wire.receive()

    assert talk(server, client)["id"] == "whole"


def test_fragments_that_disagree_are_told(server):
    def client(wire):
        wire.send(op="fragment", id="f", data="x", num=0, total=3)
        wire.send(op="fragment", id="f", data="x", num=1, total=2)
        return wire.receive()["msg"]

    assert talk(server, client) == "The fragments of one message must agree on their total, but there are 3 and 2."


def test_who_sends_nothing_but_nonsense_is_closed(server):
    def client(wire):
        for _ in range(21):  # one that is sent after the server's good-bye would be an error here
            wire.socket.send("{")
        return wire.closed()

    assert talk(server, client) == (1008, "More than 20 messages in a minute were none that rosbridge knows.")


def test_the_shape_of_an_answer_cannot_be_chosen(server):
    """Names that mean something in JavaScript or Python are names like any other."""
    def client(wire):
        for name in ("/__proto__", "/constructor", "/__class__"):
            wire.send(op="advertise", topic=name, type="std_msgs/String")
            wire.send(op="subscribe", topic=name)
            wire.send(op="publish", topic=name, msg={"data": "</script><script>alert(1)</script>"})
            assert wire.receive() == {"op": "publish", "topic": name, "msg": {"data": "</script><script>alert(1)</script>"}}

    talk(server, client)
