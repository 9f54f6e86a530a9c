"""A session for tests of the page, without plans: it speaks as much of the rosbridge protocol as the page does, and says what it is told.

It gives out the files of the page with the headers of the real server, notes what the page sends, and keeps the state that
``/cramhy/get_state`` tells by applying what is published, so that a page that comes later sees the same.
"""

from __future__ import annotations

import copy
import json
import math
import threading
from http import HTTPStatus

from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Response
from websockets.sync.server import serve

from cramhy_runtime.view import page

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; connect-src 'self'; "
    "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
TOPICS = {
    "world": "/cramhy/world",
    "tasks": "/cramhy/tasks",
    "fluents": "/cramhy/fluents",
    "modules": "/cramhy/process_modules",
    "robots": "/cramhy/robot_world",
    "pace": "/cramhy/pace",
}
PEN = (179, 184, 255)
MIDDLE = 5.544444561004639
PATIENCE = 60


def turtle(name="turtle1", x=MIDDLE, y=MIDDLE, theta=0.0, pen=PEN, width=3, picture=0, speed=0.0, turn=0.0):
    """A cramhy_msgs/Turtle; pen: its colour, or None when it is up."""
    r, g, b = pen or PEN
    return {
        "name": name,
        "x": x,
        "y": y,
        "theta": theta,
        "linear_velocity": speed,
        "angular_velocity": turn,
        "pen": pen is not None,
        "r": r,
        "g": g,
        "b": b,
        "width": width,
        "picture": picture,
    }


def stroke(x1, y1, x2, y2, colour=PEN, width=3):
    """A cramhy_msgs/Stroke."""
    return dict(zip(("x1", "y1", "x2", "y2", "r", "g", "b", "width"), (x1, y1, x2, y2, *colour, width)))


def task(id_, name, parent="", state="RUNNING", waits_for="", place="", began=0.0, ended=None, result="", operator=""):
    """A cramhy_msgs/Task; a time that is None is NaN, which is null in JSON."""
    return {
        "id": id_,
        "parent": parent,
        "name": name,
        "operator": operator,
        "state": state,
        "waits_for": waits_for,
        "place": place,
        "began": began,
        "ended": ended,
        "result": result,
    }


def fluent(id_, name, value, number=None):
    """A cramhy_msgs/Fluent."""
    return {"id": id_, "name": name, "value": value, "number": number}


class FakeSession:
    """A server of the page on a port of loopback. ``heard`` is all that the page sent, ``services`` are functions by name."""

    def __init__(self, token="a-token"):
        self.token = token
        self.stamp = 0.0
        self.state = {
            "world": {
                "stamp": 0.0,
                "complete": True,
                "clears": 1,
                "r": 69,
                "g": 86,
                "b": 255,
                "simulator": "/turtlesim",
                "turtles": [turtle()],
                "strokes": [],
            },
            "tasks": {"stamp": 0.0, "complete": True, "tasks": [], "removed": []},
            "fluents": {"stamp": 0.0, "complete": True, "fluents": [], "removed": []},
            "modules": {"stamp": 0.0, "modules": []},
            "robots": {"stamp": 0.0, "complete": True, "things": [], "removed": [], "steps": [], "marks": []},
            "pace": {
                "stamp": 0.0,
                "virtual": True,
                "paused": False,
                "speed": 1.0,
                "busy": False,
                "recording": "",
                "begin": 0.0,
                "end": 0.0,
            },
        }
        self.chapters = {}
        self.heard = []
        self.services = {
            "/cramhy/get_state": lambda request: self.state,
            "/cramhy/get_history": self._history,
            "/cramhy/set_pace": self._set_pace,
            "/cramhy/step": self._step,
        }
        self._news = threading.Condition()
        self._connections = {}
        self._files = page.files()
        self.port = 0
        self.open()

    # ------------------------------------------------------------------------------------------------------------ the server

    def open(self):
        """Listen, on the port of before if there was one."""
        self._server = serve(self._serve, "127.0.0.1", self.port, process_request=self._get, compression=None)
        self.port = self._server.socket.getsockname()[1]
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    def close(self):
        """Hang up on everybody, and listen no more."""
        self._server.shutdown()
        for connection in list(self._connections):
            connection.close(1001)

    @property
    def address(self):
        return f"http://127.0.0.1:{self.port}/#{self.token}"

    def _get(self, connection, request):
        if request.headers.get("Upgrade"):
            return None
        found = self._files.get(request.path)
        status = HTTPStatus.OK if found else HTTPStatus.NOT_FOUND
        body, kind = found or (b"", "text/plain")
        headers = Headers(
            {
                "Content-Type": kind,
                "Content-Length": str(len(body)),
                "Content-Security-Policy": POLICY,
                "Connection": "close",
                "X-Content-Type-Options": "nosniff",
            }
        )
        return Response(status.value, status.phrase, headers, body)

    def _serve(self, connection):
        try:
            first = json.loads(connection.recv(timeout=PATIENCE))
            if first != {"op": "auth", "token": self.token, "hidden": True}:
                connection.close(1008, "this token is not the session's")
                return
            self._connections[connection] = set()
            for text in connection:
                self._hear(connection, json.loads(text))
        except (ConnectionClosed, TimeoutError):
            pass
        finally:
            self._connections.pop(connection, None)

    def _hear(self, connection, message):
        if message["op"] == "subscribe":
            self._connections[connection].add(message["topic"])
        elif message["op"] == "call_service":
            self._answer(connection, message)
        elif message["op"] == "ping":
            self._send(connection, {"op": "pong"})
            return
        with self._news:
            self.heard.append(message)
            self._news.notify_all()

    def _answer(self, connection, message):
        try:
            values, result = self.services.get(message["service"], lambda request: {})(message["args"]), True
        except ValueError as problem:
            values, result = str(problem), False
        self._send(
            connection, {"op": "service_response", "id": message["id"], "service": message["service"], "values": values, "result": result}
        )

    def _send(self, connection, message):
        try:
            connection.send(json.dumps(message, allow_nan=False))
        except ConnectionClosed:
            pass

    # -------------------------------------------------------------------------------------------------------- what is told

    def publish(self, topic, message):
        """Send a message to who subscribed."""
        for connection, topics in list(self._connections.items()):
            if topic in topics:
                self._send(connection, {"op": "publish", "topic": topic, "msg": message})

    def world(self, turtles=None, strokes=(), passed=0.016, cleared=None):
        """A tick; cleared: a colour that the paper was filled with."""
        world = self.state["world"]
        self.stamp += passed
        if cleared:
            world["clears"] += 1
            world.update(zip("rgb", cleared), strokes=[])
        world.update(stamp=self.stamp, turtles=turtles or world["turtles"], strokes=world["strokes"] + list(strokes))
        self.publish(TOPICS["world"], {**world, "complete": False, "strokes": list(strokes)})

    def tasks(self, *tasks, removed=()):
        """Tasks that are new or have changed."""
        self._changed("tasks", tasks, removed)

    def fluents(self, *fluents, removed=()):
        """Fluents that are new or have changed."""
        self._changed("fluents", fluents, removed)

    def _changed(self, kind, changed, removed):
        state = self.state[kind]
        known = {one["id"]: one for one in (*state[kind], *changed)}
        for id_ in removed:
            known.pop(id_, None)
        state.update({"stamp": self.stamp, kind: list(known.values())})
        self.publish(TOPICS[kind], {"stamp": self.stamp, "complete": False, kind: list(changed), "removed": list(removed)})

    def modules(self, *modules):
        """All process modules, as (name, state, executes, [queue])."""
        names = ("name", "state", "executes", "queue")
        self.state["modules"] = {"stamp": self.stamp, "modules": [dict(zip(names, module)) for module in modules]}
        self.publish(TOPICS["modules"], self.state["modules"])

    def robots(self, things=(), steps=(), removed=(), marks=()):
        """What has happened in the robot's world; steps: pairs of seconds and a list of WorldStates."""
        told = self.state["robots"]
        gone = {*removed, *(one["name"] for one in things)}
        states = {state["name"]: state for step in told["steps"] for state in step["states"]}
        states |= {state["name"]: state for _, moved in steps for state in moved}
        told["things"] = [one for one in told["things"] if one["name"] not in gone] + list(things)
        told["steps"] = [{"seconds": 0.0, "states": [state for name, state in states.items() if name not in removed]}]
        told["marks"] = list(marks) or told["marks"]
        news = [{"seconds": seconds, "states": list(moved)} for seconds, moved in steps]
        self.publish(
            TOPICS["robots"],
            {"stamp": self.stamp, "complete": False, "things": list(things), "removed": list(removed), "steps": news, "marks": list(marks)},
        )

    def pace(self, **changes):
        """Another pace."""
        self.state["pace"] = {**self.state["pace"], "stamp": self.stamp, **changes}
        self.publish(TOPICS["pace"], self.state["pace"])

    def say(self, text, level=2, name="/turtlesim"):
        """A line on /rosout."""
        self.publish(
            "/rosout",
            {
                "header": {"seq": 0, "stamp": {"secs": 1, "nsecs": 0}, "frame_id": ""},
                "level": level,
                "name": name,
                "msg": text,
                "file": "",
                "function": "",
                "line": 0,
                "topics": [],
            },
        )

    def drive(self, ticks, speed=2.0, turn=0.0, name="turtle1"):
        """Let a turtle drive and draw for so many ticks."""
        for _ in range(ticks):
            turtles = copy.deepcopy(self.state["world"]["turtles"])
            strokes = []
            for one in turtles:
                if one["name"] == name:
                    old = one["x"], one["y"]
                    one["theta"] += turn * 0.016
                    one["x"] += speed * 0.016 * math.cos(one["theta"])
                    one["y"] += speed * 0.016 * math.sin(one["theta"])
                    one.update(linear_velocity=speed, angular_velocity=turn)
                    if one["pen"]:
                        strokes.append(stroke(*old, one["x"], one["y"], (one["r"], one["g"], one["b"]), one["width"]))
            self.world(turtles, strokes)

    # ------------------------------------------------------------------------------------------------------ what is asked

    def _history(self, request):
        if not self.chapters:
            raise ValueError("There is no chapter 0: nothing has been published yet.")
        return self.chapters[request["chapter"] or max(self.chapters)]

    def _set_pace(self, request):
        self.pace(paused=request["paused"], speed=request["speed"])
        return {"pace": self.state["pace"]}

    def _step(self, request):
        self.stamp += request["seconds"]
        self.pace(paused=True)
        return {"pace": self.state["pace"]}

    def chapter(self, number, oldest, newest, begin, end, state, **later):
        """Have /cramhy/get_history tell a chapter."""
        self.chapters[number] = {
            "chapter": number,
            "oldest": oldest,
            "newest": newest,
            "begin": begin,
            "end": end,
            **{kind: copy.deepcopy(state[kind]) for kind in ("world", "tasks", "fluents", "modules", "robots")},
            **{f"later_{kind}": later.get(kind, []) for kind in ("world", "tasks", "fluents", "modules", "robots")},
        }

    # --------------------------------------------------------------------------------------------------------- what came

    def wait(self, wanted, patience=PATIENCE):
        """The first message that was heard for which ``wanted(message)`` is true; waits for it."""
        with self._news:
            self._news.wait_for(lambda: any(map(wanted, self.heard)), patience)
            found = [message for message in self.heard if wanted(message)]
        assert found, f"The page has not sent it. It sent {self.heard[-20:]}"
        return found[0]

    def wait_for_call(self, service, patience=PATIENCE):
        """The arguments of the first call of a service."""
        return self.wait(lambda message: message["op"] == "call_service" and message["service"] == service, patience)["args"]
