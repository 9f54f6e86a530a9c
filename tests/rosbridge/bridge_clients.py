"""Clients of rosbridge for tests: one without any socket, and one with a WebSocket."""

from __future__ import annotations

import json

from cramhy_runtime import kernel


class Talk:
    """One client's session, without any socket; what came out is parsed JSON."""

    def __init__(self, hub, hidden=False):
        from cramhy_runtime.rosbridge.outbox import Outbox
        from cramhy_runtime.rosbridge.protocol import Session

        self.now = 0.0
        self.reminders = []
        self.outbox = Outbox(hub.limits)
        self.session = Session(hub, self.outbox, lambda seconds, function: self.reminders.append((seconds, function)), hidden)

    def say(self, **operation):
        """Have the session do an operation, in the scheduler as the server has it; what came out."""
        kernel.post(lambda: self.session.receive(operation))
        kernel.yield_()
        return self.heard()

    def heard(self):
        """What came out since the last time, as parsed JSON."""
        found = []
        while True:
            frames, _ = self.outbox.next(self.now)
            if not frames:
                return found
            found += [frame if isinstance(frame, bytes) else json.loads(frame) for frame in frames]

    def call(self, service, /, **arguments):
        """The answer of a service, which may take some ticks of the simulator."""
        found = self.say(op="call_service", service=service, args=arguments, id="call")
        for _ in range(100):
            answers = [each for each in found if each["op"] == "service_response" and each.get("id") == "call"]
            if answers:
                return answers[0]
            kernel.sleep(0.016)
            found += self.heard()
        raise AssertionError(f"no answer from {service}")


class Wire:
    """A WebSocket of the library websockets, for functions that run in `kernel.run_blocking`."""

    def __init__(self, address, **options):
        from websockets.sync.client import connect

        options.setdefault("max_size", None)
        self.socket = connect(address, compression=None, **options).__enter__()
        self.number = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, **operation):
        self.socket.send(json.dumps(operation))

    def receive(self, timeout=20):
        found = self.socket.recv(timeout=timeout)
        return found if isinstance(found, bytes) else json.loads(found)

    def until(self, timeout=20, **wanted):
        """The next operation with these values."""
        while True:
            found = self.receive(timeout)
            if isinstance(found, dict) and all(found.get(key) == value for key, value in wanted.items()):
                return found

    def call(self, service, timeout=20, /, **arguments):
        self.number += 1
        identity = f"call:{self.number}"
        self.send(op="call_service", service=service, args=arguments, id=identity)
        return self.until(timeout, op="service_response", id=identity)

    def closed(self, timeout=20):
        """(code, reason) with which the server closes, reading away what comes before."""
        from websockets.exceptions import ConnectionClosed

        try:
            while True:
                self.socket.recv(timeout=timeout)
        except ConnectionClosed as closed:
            return (closed.rcvd.code, closed.rcvd.reason) if closed.rcvd else (None, None)
