"""The server with real sockets: it answers at the prompt, in wall and in virtual time, on both back ends, and ends with the kernel."""

from __future__ import annotations

import urllib.request
from time import sleep

import pytest

from bridge_clients import Wire
from cramhy_runtime import kernel, rosbridge
from cramhy_runtime.extras import install_command
from cramhy_runtime.ros import graph


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("time", ["virtual", "wall"])
def test_a_client_is_answered_while_the_prompt_waits(serve, outside, time, backend):
    server = serve(time, backend)

    def client():
        with Wire(server.address) as wire:
            assert wire.call("/spawn", x=1.0, y=2.0, name="anna")["values"] == {"name": "anna"}
            wire.send(op="subscribe", topic="/anna/pose")
            assert wire.call("/anna/teleport_absolute", x=3.0, y=4.0)["result"]
            while time == "wall" and wire.until(op="publish")["msg"]["x"] != 3.0:
                pass

    outside(client)


def test_plan_time_passes_at_the_prompt_only_as_far_as_an_answer_needs(serve, outside, backend):
    server = serve(backend=backend)

    def client():
        with Wire(server.address) as wire:
            for _ in range(5):
                wire.call("/rosapi/topics")
            wire.call("/clear")

    outside(client)
    assert 0 < kernel.now() <= 0.032


def test_an_answer_that_never_comes_does_not_drive_the_clock_for_ever(serve, outside, backend):
    from cramhy_runtime.ros.messages import service_type_exact
    from cramhy_runtime.ros.services import Service

    class Silent(Service):
        def submit(self, call):
            self.pending.add(call)

    server = serve(backend=backend)
    here = server.graph.node("silent")
    here.add_service(Silent(here, "/silence", service_type_exact("std_srvs/Empty"), None))

    def client():
        with Wire(server.address) as wire:
            wire.send(op="call_service", service="/silence")
            while kernel.active().clock.wanted or not kernel.active().now():
                wire.call("/rosapi/get_time")

    outside(client)
    assert 600 <= kernel.now() < 601


def test_no_plan_time_passes_while_a_client_owes_the_plan_an_answer(serve, outside, beside, backend):
    from cramhy_runtime.ros import services
    from cramhy_runtime.ros.messages import service_type_exact

    server = serve(backend=backend)
    kind = service_type_exact("roscpp_tutorials/TwoInts")

    def client():
        with Wire(server.address) as wire:
            wire.send(op="advertise_service", service="/sum", type="roscpp_tutorials/TwoInts")
            request = wire.until(op="call_service")
            assert wire.call("/rosapi/service_type", service="/sum")["values"] == {"type": "roscpp_tutorials/TwoInts"}
            wire.send(op="service_response", id=request["id"], service="/sum", values={"sum": 3}, result=True)
            wire.call("/rosapi/topics")

    answered = beside(client)
    while "/sum" not in server.graph.services:
        kernel.sleep(0.01)
    began = kernel.now()
    call = services.exchange(server.graph.services["/sum"], kind.request(a=1, b=2))
    assert (call.failure, call.lost) == (None, False)
    assert call.response.sum == 3
    assert kernel.now() == began
    answered()


def test_the_server_ends_with_the_kernel(serve, outside, backend):
    server = serve(backend=backend)
    assert server.file.exists()
    wires = []

    def client():
        wires.append(Wire(server.address))
        wires[0].call("/rosapi/topics")

    outside(client)
    kernel.stop()
    assert wires[0].closed() == (1001, "The session has ended.")
    assert not server.file.exists()
    assert not server.company.alive and server.company.failure is None


@pytest.mark.soak
def test_every_client_hears_why_the_session_ends_however_busy_the_server_is(serve, outside, backend):
    """uvicorn closes whom it still finds with a mere number; so it is told only when all have had their reason."""
    server = serve(backend=backend)
    wires = []

    def clients():
        for _ in range(20):
            wires.append(Wire(server.address))
            wires[-1].call("/rosapi/topics")
        wires.append(Wire(server.address.rpartition("/")[0]))  # it has not shown its token

    outside(clients)
    server.company.call(lambda: sleep(0.3))  # so uvicorn, which looks around every 0.1 s, does so at once afterwards
    kernel.stop()
    assert {wire.closed() for wire in wires} == {(1001, "The session has ended.")}


def test_who_is_let_in_while_the_session_ends_hears_why(serve, outside):
    server = serve()
    outside(lambda: Wire(server.address).call("/rosapi/topics"))  # so it runs
    server.closed = True
    assert outside(lambda: Wire(server.address).closed()) == (1001, "The session has ended.")
    server.closed = False


def test_closing_twice_does_nothing(serve):
    server = serve()
    server.close()
    server.close()
    assert rosbridge.start().port != 0


def test_a_session_that_ends_at_once_takes_its_server_along(serve):
    server = serve()
    kernel.stop()
    assert server.closed and not server.company.alive and not server.file.exists()


def test_cleanup_is_still_heard_by_clients(serve, outside):
    server = serve()
    wire = outside(lambda: Wire(server.address))
    outside(lambda: wire.send(op="subscribe", topic="/farewell", type="std_msgs/String"))
    outside(lambda: wire.call("/rosapi/topics"))

    def plan():
        from cramhy_runtime.ros.messages import message_class_exact

        string = message_class_exact("std_msgs/String")
        talk = graph.active().node("plan").advertise("/farewell", string)
        try:
            kernel.park("the end")
        finally:
            kernel.sleep(0.01)
            talk.send(string("stop"))

    kernel.spawn(plan)
    kernel.yield_()
    kernel.stop()
    assert wire.until(op="publish")["msg"] == {"data": "stop"}
    assert wire.closed() == (1001, "The session has ended.")


def test_one_server_per_session(serve):
    from cramhy_runtime.rosbridge.server import ServerError

    server = serve()
    with pytest.raises(ServerError) as caught:
        rosbridge.start()
    assert str(caught.value) == f"This session has a server already, on port {server.port}. Close it first, or use it."


def test_a_port_that_is_taken_is_told(serve):
    from cramhy_runtime.rosbridge.server import ServerError

    server = serve()
    port = server.port
    import socket

    server.close()
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", port))
        taken.listen()
        with pytest.raises(ServerError) as caught:
            rosbridge.start(port=port)
    assert str(caught.value) == (
        f"The server cannot listen on port {port} of 127.0.0.1: Address already in use. Choose another port, or none for a free one."
    )


def test_it_listens_on_loopback_only(serve):
    server = serve()
    assert server.socket.getsockname()[0] == "127.0.0.1"


# --------------------------------------------------------------------------------------------------------------------- pages


def test_pages_have_their_headers(serve, outside):
    server = serve(pages={"/": ("<p>turtle</p>", "text/html"), "/view.js": (b"1;", "text/javascript", {"Cache-Control": "max-age=5"})})

    def fetch(path):
        with urllib.request.urlopen(f"http://127.0.0.1:{server.port}{path}", timeout=20) as answer:
            return answer.read(), dict(answer.headers)

    body, headers = outside(fetch, "/")
    assert body == b"<p>turtle</p>"
    assert {name.lower(): value for name, value in headers.items() if name.lower() != "connection"} == {
        "content-type": "text/html; charset=utf-8",
        "content-length": "13",
        "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; "
        "connect-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
        "x-content-type-options": "nosniff",
        "x-frame-options": "DENY",
        "referrer-policy": "no-referrer",
        "cross-origin-opener-policy": "same-origin",
        "cross-origin-resource-policy": "same-origin",
        "cache-control": "no-store",
    }
    body, headers = outside(fetch, "/view.js")
    assert headers["cache-control"] == "max-age=5"


def test_what_is_not_installed_is_named(monkeypatch):
    from importlib import metadata

    from cramhy_runtime.rosbridge.server import ServerError

    def version(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "version", version)
    with pytest.raises(ServerError) as caught:
        rosbridge.start()
    assert str(caught.value) == f"The server needs uvicorn, websockets, which are not installed. Type: {install_command('web')}"
