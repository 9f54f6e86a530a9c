"""What is told reaches a client outside of the process, as a page is one, while the prompt waits and while a plan runs."""

from __future__ import annotations

import json

import pytest

from cramhy_runtime import chronicle, kernel


class Client:
    """A WebSocket that speaks rosbridge; its methods run in `kernel.run_blocking`."""

    def __init__(self, address):
        from websockets.sync.client import connect

        self.socket = connect(address, compression=None, max_size=None).__enter__()

    def send(self, **operation):
        self.socket.send(json.dumps(operation))

    def until(self, wanted):
        while True:
            found = json.loads(self.socket.recv(timeout=30))
            if wanted(found):
                return found

    def call(self, service, **arguments):
        self.send(op="call_service", service=service, args=arguments, id="1")
        return self.until(lambda found: found["op"] == "service_response")


@pytest.fixture
def client(session, tmp_path, monkeypatch):
    pytest.importorskip("websockets")
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    from cramhy_runtime import rosbridge

    server = rosbridge.start()
    chronicle.start()
    made = kernel.run_blocking(Client, server.address)
    yield made
    kernel.run_blocking(made.socket.close)
    server.close()


def outside(function, *arguments, **keywords):
    return kernel.run_blocking(lambda: function(*arguments, **keywords))


def test_a_client_sees_a_plan_from_its_beginning_to_its_end(session, client):
    outside(client.send, op="subscribe", topic="/cramhy/tasks", type="cramhy_msgs/TaskTree")
    state = outside(client.call, "/cramhy/get_state")
    assert state["result"] and state["values"]["tasks"]["tasks"] == []
    session.evaluate_text("(top-level (par (sleep 1) (sleep 2)))")
    known = {}

    def all_dead(found):
        if found["op"] == "publish":
            known.update({task["id"]: task["state"] for task in found["msg"]["tasks"]})
        return len(known) == 3 and set(known.values()) == {"SUCCEEDED"}

    outside(client.until, all_dead)


def test_a_client_sets_the_pace_and_asks_for_the_past(session, client):
    session.evaluate_text("(top-level (par (sleep 1) (sleep 2)))")
    answer = outside(client.call, "/cramhy/set_pace", paused=False, speed=50.0)
    assert answer["values"]["pace"] == {**answer["values"]["pace"], "speed": 50.0, "paused": False, "virtual": True, "busy": False}
    refused = outside(client.call, "/cramhy/set_pace", paused=False, speed=-3.0)
    assert refused["result"] is False and "A speed is a number" in str(refused["values"])
    outside(client.call, "/cramhy/get_state")
    past = outside(client.call, "/cramhy/get_history", chapter=0)
    assert past["result"] and past["values"]["chapter"] >= 1
    kernel.pace().set_speed(None)
