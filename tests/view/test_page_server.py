"""What the page's server gives out and to whom, and how a browser comes to it."""

from __future__ import annotations

import http.client
import stat
import sys
import threading

import pytest

from cramhy_runtime import kernel, view
from cramhy_runtime.repl.session import Session
from cramhy_runtime.view import page as page_module


@pytest.fixture
def session(tmp_path, monkeypatch):
    """A session in virtual time, whose server announces itself in a folder of its own."""
    pytest.importorskip("uvicorn", reason="pip install 'cramhy[web]'")
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


def get(page, path, **headers):
    """(status, media type, body, headers) of a request, which the kernel must not be needed for."""
    found = []

    def ask():
        connection = http.client.HTTPConnection("127.0.0.1", page.port, timeout=60)
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        found.append((answer.status, answer.getheader("content-type"), answer.read(), answer.headers))
        connection.close()

    thread = threading.Thread(target=ask)
    thread.start()
    kernel.run_blocking(thread.join)
    return found[0]


def test_every_file_of_the_page_is_given_out_with_its_type(session):
    page = view.start()
    status, kind, body, headers = get(page, "/")
    assert (status, kind) == (200, "text/html; charset=utf-8") and b'src="app.js"' in body
    assert headers["content-security-policy"].startswith("default-src 'none'; script-src 'self'")
    assert get(page, "/app.js")[1] == "text/javascript; charset=utf-8"
    assert get(page, "/style.css")[1] == "text/css; charset=utf-8"
    assert get(page, "/icon.svg")[1] == "image/svg+xml"
    assert get(page, "/shapes.json")[2].startswith(b'[{"name":')
    for path in ("/../page.py", "/static/app.js", "/app.js/", "//app.js", "/%2e%2e/page.py", "/secret"):
        assert get(page, path)[0] == 404, path


def test_the_address_has_the_token_in_its_fragment(session):
    page = view.start()
    assert page.url == f"http://127.0.0.1:{page.port}/#{page.token}"
    assert page.token.encode() not in b"".join(body for body, _ in page_module.files().values())


def test_a_page_that_is_closed_leaves_the_session_as_it_was(session):
    page = view.start()
    assert kernel.pace().speed == 1.0
    assert "/cramhy/get_state" in page.server.graph.services
    page.close()
    page.close()
    assert kernel.pace().speed is None
    assert "/cramhy/get_state" not in page.server.graph.services
    again = view.start()
    assert get(again, "/")[0] == 200


def test_a_server_that_is_there_gets_the_page(session):
    from cramhy_runtime import rosbridge

    server = rosbridge.start()
    page = view.start()
    assert page.server is server and get(page, "/app.js")[0] == 200
    page.close()
    assert get(page, "/app.js")[0] == 404
    assert not server.closed


def test_a_browser_is_led_to_the_page_by_a_file_of_the_users_own(session, monkeypatch):
    """The arguments of a browser can be read by everybody on the machine."""
    opened = []
    monkeypatch.setattr(page_module, "browse", opened.append)
    monkeypatch.setattr(page_module, "has_screen", lambda: True)
    monkeypatch.setattr(sys, "stderr", type("Terminal", (), {"isatty": lambda self: True, "write": lambda self, text: None})())
    page = view.start()
    assert len(opened) == 1 and page.token not in opened[0]
    way = page_module.way(page.port, page.server.file.parent)
    assert opened[0] == way.as_uri()
    assert f"url={page.url}" in way.read_text()
    assert stat.S_IMODE(way.stat().st_mode) == 0o600
    page.close()
    assert not way.exists()


def test_no_browser_is_opened_where_nobody_sits(session, monkeypatch):
    monkeypatch.setattr(page_module, "browse", lambda address: pytest.fail("opened"))
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    page = view.start(open_browser=True)
    assert page.open() is False
