"""A program that speaks to its clients as rosbridge_suite 0.11.17 for ROS 1 does, with a turtle behind it: what tests join as a robot.

It is started as ``python ros1_peer.py [--rospy]``. Without an option it has a small graph of its own, with `Turtle` and the services
``/rosapi/...``; with ``--rospy`` the graph is that of a real roscore (`ros1_rospy.py`). What it has of the original's manners:

* No client is sent ``status``: what is wrong with an operation is written to the robot's own log, which the client never sees.
* Operations of a client wait in a queue for a thread; when the client closes, those that wait are thrown away.
* A client's services stay when the client has gone. Their callers wait for ever, or until the service is withdrawn, which aborts them.
* ``values`` of a ``service_response`` must be an object, else the response is not heard; ``result`` is not looked at.

It reads commands from its standard input, a line of JSON ``[name, argument...]`` each, and writes one line of JSON as the answer to each:

``ops``: the operations that came, as [seconds, operation]; ``wrong``: the own log
``late S``: answers of ``/rosapi`` take S seconds; ``mute SERVICE``: its type is not told; ``define TOPIC TYPE``
``cut``: every connection is reset; ``clients``: how many there are
``call NAME ARGUMENTS``: a node of the robot calls a service; ``calls``: what became of these; ``services``; ``pose``
"""

from __future__ import annotations

import contextlib
import json
import math
import queue
import socket
import struct
import sys
import threading
import time
from functools import partial

EMPTY = "std_srvs/Empty"


class Turtle:
    """turtlesim's turtle: it obeys a velocity for one second."""

    def __init__(self):
        self.x = self.y = 5.544445
        self.theta = self.linear = self.angular = 0.0
        self.last = 0.0
        self.trail = []

    def command(self, twist):
        self.linear, self.angular, self.last = twist["linear"]["x"], twist["angular"]["z"], time.monotonic()
        self.trail.append((time.monotonic(), self.linear, self.angular))

    def step(self, seconds):
        if time.monotonic() - self.last > 1:
            self.linear = self.angular = 0.0
        self.theta = math.remainder(self.theta + self.angular * seconds, 2 * math.pi)
        self.x = min(max(self.x + math.cos(self.theta) * self.linear * seconds, 0), 11.088889)
        self.y = min(max(self.y + math.sin(self.theta) * self.linear * seconds, 0), 11.088889)

    def pose(self):
        return {"x": self.x, "y": self.y, "theta": self.theta, "linear_velocity": self.linear, "angular_velocity": self.angular}

    def teleport_absolute(self, x, y, theta):
        self.x, self.y, self.theta = x, y, theta
        return {}

    def teleport_relative(self, linear, angular):
        self.theta += angular
        self.x += linear * math.cos(self.theta)
        self.y += linear * math.sin(self.theta)
        return {}


class OwnGraph:
    """Topics, services and parameters without any ROS."""

    def __init__(self):
        self.lock = threading.RLock()
        self.types = {"/turtle1/cmd_vel": "geometry_msgs/Twist", "/turtle1/pose": "turtlesim/Pose", "/rosout": "rosgraph_msgs/Log"}
        self.listeners = {}
        self.services = {}
        self.parameters = {"/turtlesim/background_b": 255}
        self.late, self.mute = 0.0, None
        self.turtle = turtle = Turtle()
        self.listen("/turtle1/cmd_vel", None, turtle.command)
        for name, kind, handler in (
            ("/turtle1/teleport_absolute", "turtlesim/TeleportAbsolute", turtle.teleport_absolute),
            ("/turtle1/teleport_relative", "turtlesim/TeleportRelative", turtle.teleport_relative),
            ("/turtle1/set_pen", "turtlesim/SetPen", lambda **_: {}), ("/clear", EMPTY, dict), ("/reset", EMPTY, dict),
            ("/spawn", "turtlesim/Spawn", lambda name="", **_: {"name": name or "turtle2"}), ("/slow", EMPTY, partial(time.sleep, 3600)),
            ("/rosapi/topics", "rosapi/Topics", lambda: {"topics": list(self.types), "types": list(self.types.values())}),
            ("/rosapi/topic_type", "rosapi/TopicType", lambda topic: {"type": self.types.get(topic, "")}),
            ("/rosapi/services", "rosapi/Services", lambda: {"services": list(self.services)}),
            ("/rosapi/service_type", "rosapi/ServiceType", lambda service: {"type": self.services.get(service, ("",))[0]}),
            ("/rosapi/nodes", "rosapi/Nodes", lambda: {"nodes": ["/turtlesim", "/rosapi", "/rosbridge_websocket"]}),
            ("/rosapi/get_time", "rosapi/GetTime", lambda: {"time": {"secs": int(time.time()), "nsecs": 0}}),
            ("/rosapi/get_param", "rosapi/GetParam",
             lambda name, default="": {"value": json.dumps(self.parameters[name]) if name in self.parameters else default}),
            ("/rosapi/has_param", "rosapi/HasParam", lambda name: {"exists": name in self.parameters}),
            ("/rosapi/set_param", "rosapi/SetParam", lambda name, value: self.parameters.update({name: json.loads(value)}) or {}),
            ("/rosapi/delete_param", "rosapi/DeleteParam", lambda name: self.parameters.pop(name) and {}),
            ("/rosapi/get_param_names", "rosapi/GetParamNames", lambda: {"names": list(self.parameters)}),
        ):  # fmt: skip
            self.services[name] = kind, lambda arguments, handler=handler: handler(**arguments) or {}
        threading.Thread(target=self._live, daemon=True).start()

    def _live(self):
        while True:
            time.sleep(0.016)
            self.turtle.step(0.016)
            self.say("/turtle1/pose", self.turtle.pose())

    def pose(self):
        return self.turtle.pose()

    def say(self, topic, message):
        for listener in list(self.listeners.get(topic, ())):
            listener(message)

    def check(self, topic, kind):
        there = self.types.setdefault(topic, kind)
        if there != kind:
            raise TypeError(f"Tried to register topic {topic} with type {kind} but it is already established with type {there}")

    def advertise(self, client, topic, kind):
        self.check(topic, kind)

    def publish(self, client, topic, message):
        if topic not in self.types:
            raise KeyError(f"Cannot infer topic type for topic {topic} as it is not yet advertised")
        self.say(topic, message)

    def unadvertise(self, client, topic):
        pass

    def listen(self, topic, kind, listener):
        """Hear a topic; a function that ends it."""
        with self.lock:
            if kind:
                self.check(topic, kind)
            self.listeners.setdefault(topic, []).append(listener)
        return lambda: self.listeners[topic].remove(listener)

    def call(self, name, arguments):
        if name.startswith("/rosapi/"):
            time.sleep(3600 if arguments.get("service") == self.mute and self.mute else self.late)
        if name not in self.services:
            raise LookupError(f"Service {name} does not exist")
        return self.services[name][1](arguments)

    def offer(self, name, kind, handler):
        self.services[name] = kind, handler
        return lambda: self.services.pop(name, None)

    def response(self, kind, values):
        return values


class ServedByClient:
    """A service of a client: AdvertisedServiceHandler of the original."""

    def __init__(self, robot, client, name, kind):
        self.client, self.name, self.kind = client, name, kind
        self.responses, self.ended, self.count = {}, False, 0
        self.withdraw = robot.graph.offer(name, kind, self.handle)

    def handle(self, arguments):
        self.count += 1
        identity = f"service_request:{self.name}:{self.count}"
        with contextlib.suppress(Exception):
            self.client.send({"op": "call_service", "id": identity, "service": self.name, "args": arguments})
        while identity not in self.responses:
            if self.ended:
                return None
            time.sleep(0.005)
        return self.responses.pop(identity)


class Client:
    """One connection, with its queue."""

    def __init__(self, robot, wire):
        self.robot, self.wire, self.graph = robot, wire, robot.graph
        self.queue, self.gone = queue.SimpleQueue(), False
        self.heard = {}
        threading.Thread(target=self._work, daemon=True).start()

    def send(self, message):
        self.wire.send(json.dumps(message))

    def _work(self):
        while not self.gone:
            text = self.queue.get()
            if text is None or self.gone:
                return
            message = json.loads(text)
            self.robot.ops.append((time.monotonic(), message))
            try:
                getattr(self, "do_" + message["op"])(message)
            except Exception as problem:  # the original logs it, and tells the client nothing
                self.robot.wrong.append(f"[{message['op']}] {type(problem).__name__}: {problem}")

    def close(self):
        self.gone = True
        self.queue.put(None)
        for stop in self.heard.values():
            stop()

    def do_advertise(self, message):
        self.graph.advertise(self, message["topic"], message["type"])

    def do_unadvertise(self, message):
        self.graph.unadvertise(self, message["topic"])

    def do_publish(self, message):
        self.graph.publish(self, message["topic"], message["msg"])

    def do_subscribe(self, message):
        topic = message["topic"]

        def hear(values):
            with contextlib.suppress(Exception):
                self.send({"op": "publish", "topic": topic, "msg": values})

        self.heard[topic] = self.graph.listen(topic, message["type"], hear)

    def do_unsubscribe(self, message):
        self.heard.pop(message["topic"])()

    def do_call_service(self, message):
        def answer():
            reply = {"op": "service_response", "service": message["service"]}
            if "id" in message:
                reply["id"] = message["id"]
            try:
                reply |= {"values": self.graph.call(message["service"], message.get("args") or {}), "result": True}
            except Exception as problem:
                reply |= {"values": str(problem), "result": False}
            with contextlib.suppress(Exception):
                self.send(reply)

        threading.Thread(target=answer, daemon=True).start()

    def do_advertise_service(self, message):
        name = message["service"]
        if name in self.robot.served:  # the list is one for all clients, as in the original
            self.robot.served.pop(name).withdraw()
        self.robot.served[name] = ServedByClient(self.robot, self, name, message["type"])

    def do_unadvertise_service(self, message):
        service = self.robot.served.pop(message["service"])
        service.ended = True
        time.sleep(0.2)  # graceful_shutdown
        service.withdraw()

    def do_service_response(self, message):
        if not isinstance(message["values"], dict):
            raise TypeError("Expected field values to be of type dict")
        service = self.robot.served[message["service"]]
        service.responses[message["id"]] = self.graph.response(service.kind, message["values"])


class Robot:
    """The server."""

    def __init__(self, graph, port=0):
        from websockets.sync.server import serve

        self.graph, self.ops, self.wrong, self.served, self.clients, self.calls = graph, [], [], {}, set(), []
        self.server = serve(
            self._serve, "127.0.0.1", port, compression=None, max_size=None, server_header="AutobahnPython/0.17.1", close_timeout=1
        )
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.address = f"ws://127.0.0.1:{self.server.socket.getsockname()[1]}"

    def _serve(self, wire):
        from websockets.exceptions import ConnectionClosed

        client = Client(self, wire)
        self.clients.add(client)
        try:
            for text in wire:
                client.queue.put(text)
        except ConnectionClosed:
            pass
        finally:
            self.clients.discard(client)
            client.close()

    # ------------------------------------------------------------------------------------------------------------- commands

    def command_ops(self):
        return self.ops

    def command_wrong(self):
        return self.wrong

    def command_late(self, seconds):
        self.graph.late = seconds

    def command_cut(self):
        for client in list(self.clients):
            client.wire.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            with contextlib.suppress(OSError):
                client.wire.socket.shutdown(socket.SHUT_RDWR)

    def command_define(self, topic, kind):
        self.graph.types[topic] = kind

    def command_mute(self, service):
        self.graph.mute = service

    def command_pose(self):
        return self.graph.pose()

    def command_clients(self):
        return len(self.clients)

    def command_services(self):
        return self.graph.call("/rosapi/services", {})["services"]

    def command_call(self, name, arguments):
        place = len(self.calls)
        self.calls.append(None)

        def call():
            try:
                self.calls[place] = [True, self.graph.call(name, arguments) if name in self.command_services() else "gone"]
                if self.calls[place][1] in (None, {}) and isinstance(self.graph, OwnGraph) and self.calls[place][1] is None:
                    self.calls[place] = [False, "service handler returned None"]
            except Exception as problem:
                self.calls[place] = [False, str(problem)]

        threading.Thread(target=call, daemon=True).start()
        return place

    def command_calls(self):
        return self.calls


def main(arguments):
    if "--libraries" in arguments:
        sys.path += arguments[arguments.index("--libraries") + 1].split(":")
    if "--rospy" in arguments:
        from ros1_rospy import RospyGraph

        graph = RospyGraph()
    else:
        graph = OwnGraph()
    robot = Robot(graph, int(arguments[arguments.index("--port") + 1]) if "--port" in arguments else 0)
    print(json.dumps(robot.address), flush=True)
    for line in sys.stdin:
        name, *words = json.loads(line)
        print(json.dumps(getattr(robot, f"command_{name}")(*words)), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
