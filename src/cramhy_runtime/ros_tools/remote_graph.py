"""The session of another terminal, through its rosbridge server: how the tools reach it without any Lisp in their own process.

The session is found by its file in the user's runtime folder (`rosbridge.sessions`). The tools connect as observers, so that
``rostopic list`` does not show itself; what they ask, they ask of rosapi. Types that no folder of this machine defines are asked for,
too. A message that comes while an answer is waited for is kept for its listener.
"""

from __future__ import annotations

import json
import sys
import time
from collections import deque
from contextlib import contextmanager
from urllib.parse import urlencode

from cramhy_runtime.extras import install_command
from cramhy_runtime.rosbridge.no_answers import SESSION_ENDS, taken_apart
from .graph_access import Graph, Listener, NodeFacts, NoSession, Refused, SessionEnded, reached

PATIENCE = 5.0  # s until a session that listens must have let us in
FAREWELL = 1.0  # s that it gets to say good-bye
QUEUE = 10_000  # messages that wait for us at most: a plan in virtual time publishes faster than a terminal prints


def current():
    """The `ThereGraph` of the newest session of this user, or `NoSession`. Where several run, stderr says which one it is."""
    while True:
        living = _living()
        if not living:
            raise NoSession
        found = living[0]
        try:
            graph = ThereGraph(found.host, found.port, found.token, found.pid)
        except NoSession:
            if found in _living():
                raise
            continue  # it died while we connected; a process that was killed still accepts for a moment
        processes = {session.pid for session in living}
        if len(processes) > 1:
            print(f"; {len(processes)} sessions run here; this is the newest, process {found.pid}.", file=sys.stderr, flush=True)
        return graph


def _living():
    from cramhy_runtime.rosbridge import sessions

    try:
        return sessions.living()
    except sessions.Unsafe as problem:
        raise NoSession(str(problem)) from None


class ThereGraph(Graph):
    """The graph of a session. host, port, token: where it listens and what it wants to see. pid: its process."""

    def __init__(self, host, port, token, pid=0):
        try:
            from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus
            from websockets.sync.client import connect
        except ImportError:
            raise NoSession(
                "A session serves here, but reaching it takes the Python package websockets. Type: " + install_command("web")
            ) from None
        self.closed_by_other = ConnectionClosed
        self.address, self.pid = f"{host}:{port}", pid
        try:
            # the token is in the address, so that the handshake ends with a yes or a no: after a first message one only finds out later
            shown = urlencode({"token": token, "hidden": 1})
            self.socket = connect(
                f"ws://{self.address}/?{shown}", compression=None, max_size=None, open_timeout=PATIENCE, close_timeout=FAREWELL, proxy=None
            ).__enter__()  # left in `close`
            self._send(op="set_level", level="error")
        except InvalidStatus as problem:
            raise self._not_let_in(problem.response.body.decode("utf-8", "replace").strip() or problem) from None
        except (OSError, TimeoutError, InvalidHandshake, ConnectionClosed, SessionEnded) as problem:
            raise self._not_let_in(problem) from None
        self.listeners = {}
        self.answers = {}
        self.asked = 0
        reached.append(self)

    def _not_let_in(self, reason):
        return NoSession(f"The session at {self.address} does not let us in: {reason}")

    # ------------------------------------------------------------------------------------------------------ to and fro

    def _send(self, **operation):
        try:
            self.socket.send(_json(operation))
        except self.closed_by_other as problem:
            raise self._ended(problem) from None

    def _ended(self, problem):
        reason = problem.rcvd.reason if problem.rcvd else ""
        return SessionEnded(reason or "The session has ended.")

    def receive(self, until=None):
        """Take what comes next, if anything does before ``until``."""
        try:
            text = self.socket.recv(None if until is None else max(0.0, until - self.now()))
        except TimeoutError:
            return
        except self.closed_by_other as problem:
            raise self._ended(problem) from None
        found = json.loads(text)
        op = found.get("op")
        if op == "publish":
            listener = self.listeners.get(found["topic"])
            if listener is not None:
                listener.waiting.append((self.now(), found["msg"]))
        elif op == "service_response":
            self.answers[found.get("id")] = found
        elif op == "status" and found.get("level") == "error":
            raise Refused(found.get("msg", ""))

    def call(self, name, ros_type, request):
        self.asked += 1
        identity = f"call-{self.asked}"
        self._send(op="call_service", id=identity, service=name, args=request)
        while identity not in self.answers:
            self.receive()
        answer = self.answers.pop(identity)
        if answer["result"]:
            return answer["values"]
        text = answer["values"] if isinstance(answer["values"], str) else ""
        if text == SESSION_ENDS.format(name):
            raise SessionEnded(text)
        raise Refused(*taken_apart(text, name))

    def _ask(self, service, /, **arguments):
        return self.call(f"/rosapi/{service}", "", arguments)

    @contextmanager
    def listen(self, topic, ros_type):
        listener = self.listeners[topic] = ThereListener(self)
        self._send(op="subscribe", topic=topic, type=ros_type, queue_length=QUEUE)
        try:
            yield listener
        finally:
            del self.listeners[topic]

    @contextmanager
    def talk(self, topic, ros_type, latch):
        self._send(op="advertise", topic=topic, type=ros_type, latch=latch)
        self._ask("topic_type", topic=topic)  # a refusal of the topic comes before this answer
        yield lambda data: self._send(op="publish", topic=topic, msg=data)

    def now(self):
        return time.time_ns() / 1e9

    def sleep(self, seconds):
        end = self.now() + seconds
        while self.now() < end:
            self.receive(end)

    def close(self):
        reached.remove(self)
        self.socket.close()

    # -------------------------------------------------------------------------------------------------------- questions

    def nodes(self):
        return sorted(self._ask("nodes")["nodes"])

    def node(self, name):
        if name not in self.nodes():
            return None
        found = self._ask("node_details", node=name)
        return NodeFacts(sorted(found["publishing"]), sorted(found["subscribing"]), sorted(found["services"]))

    def uri(self, node):
        return self.address

    def process(self, node):
        try:
            return self.call("/cramhy/node_process", "cramhy_msgs/NodeProcess", {"node": node})["pid"]
        except Refused:  # a session without our tools, as rosbridge.start makes one
            return self.pid

    def ping(self, node):
        began = time.perf_counter()
        self._ask("node_details", node=node)
        return time.perf_counter() - began

    def kill(self, node):
        self.call("/cramhy/end_node", "cramhy_msgs/EndNode", {"node": node})

    def topics(self):
        found = self._ask("topics")
        return dict(sorted(zip(found["topics"], found["types"])))

    def publishers(self, topic):
        return self._ask("publishers", topic=topic)["publishers"]

    def subscribers(self, topic):
        return self._ask("subscribers", topic=topic)["subscribers"]

    def services(self):
        return sorted(self._ask("services")["services"])

    def service(self, name):
        ros_type = self._ask("service_type", service=name)["type"]
        return (self._ask("service_node", service=name)["node"], ros_type) if ros_type else None

    def parameter_names(self):
        return sorted(self._ask("get_param_names")["names"])

    def parameter(self, name):
        text = self._ask("get_param", name=name, default=json.dumps(""))["value"]
        if text in ('""', "") and not (name == "/" or self._ask("has_param", name=name)["exists"]):
            raise KeyError(name)
        return json.loads(text)

    def set_parameter(self, name, value):
        self._ask("set_param", name=name, value=json.dumps(value))

    def delete_parameter(self, name):
        if not self._ask("has_param", name=name)["exists"]:
            raise KeyError(name)
        self._ask("delete_param", name=name)

    def message_elsewhere(self, ros_type):
        return self._definition("message_details", ros_type, ros_type)

    def service_elsewhere(self, ros_type):
        parts = [self._definition(f"service_{part.lower()}_details", ros_type, ros_type + part) for part in ("Request", "Response")]
        return tuple(parts) if all(parts) else None

    def _definition(self, service, asked, wanted):
        try:
            found = self._ask(service, type=asked)["typedefs"]
        except Refused:
            return None
        return next((_definition(each) for each in found if each["type"] == wanted), None)


_INFINITE = "\0infinite"  # no name or text of a message holds this


def _json(data):
    """``data`` as JSON, which has neither infinities nor what is no number: rosbridge reads too large a real, and null."""
    try:
        return json.dumps(data, allow_nan=False)
    except ValueError:
        text = json.dumps(_finite(data))
        return text.replace(json.dumps("-" + _INFINITE), "-1e999").replace(json.dumps(_INFINITE), "1e999")


def _finite(data):
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_finite(value) for value in data]
    if isinstance(data, float) and data - data != 0.0:
        return None if data != data else _INFINITE if data > 0 else "-" + _INFINITE
    return data


def _definition(typedef):
    """The `Definition` that a ``rosapi/TypeDef`` describes."""
    from cramhy_runtime.ros.definition_text import Definition, Field

    made = Definition()
    made.fields = [
        Field(name, base, None if length < 0 else length)
        for name, base, length in zip(typedef["fieldnames"], typedef["fieldtypes"], typedef["fieldarraylen"])
    ]
    return made


class ThereListener(Listener):
    """A subscription through the server."""

    def __init__(self, reached):
        self.reached = reached
        self.waiting = deque()

    def take(self, until=None):
        while not self.waiting:
            if until is not None and self.reached.now() >= until:
                return None
            self.reached.receive(until)
        return self.waiting.popleft()
