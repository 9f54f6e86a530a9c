"""The tests of the page once more, with the transport of a browser's tab: a port to a worker in place of a WebSocket.

The worker (``relay.mjs``) leads to the same fake session. `make test` takes one of the tests, `make soak` all that have a fake session. Left
out are those about a token, since a worker asks for none.
"""

from __future__ import annotations

import importlib
import inspect
import types
from importlib import resources
from pathlib import Path

import pytest

MODULES = [f"test_page{what}" for what in ("", "_access", "_axe", "_marks", "_room", "_safety", "_scroll", "_time")]
FEW = {"test_the_task_tree_shows_what_each_task_does"}
OF_SERVERS = {"test_a_wrong_token_is_said_and_not_tried_again", "test_an_address_without_a_token_is_said"}
"""Tests that a worker cannot meet: it asks for no token."""


@pytest.fixture
def fake():
    """A session without plans, which a page reaches through a worker."""
    pytest.importorskip("websockets", reason="pip install websockets")
    from fake_session import FakeSession

    made = FakeSession(token="of this tab")
    static = resources.files("cramhy_runtime.browser").joinpath("static")
    transport = static.joinpath("transport.js").read_text() + "\ntab.begin();\n"  # the rest of a tab's page would do that
    for name, text in (
        ("transport.js", transport),
        ("tab.js", static.joinpath("begin.js").read_text() + static.joinpath("tab.js").read_text()),
        ("worker.mjs", Path(__file__).with_name("relay.mjs").read_text()),
    ):
        made._files[f"/{name}"] = text.encode(), "text/javascript"
    yield made
    made.close()


def _again(test):
    """A copy of a test for this module; it takes long unless it is one of `FEW`."""
    copy = types.FunctionType(test.__code__, test.__globals__, test.__name__, test.__defaults__, test.__closure__)
    copy.__dict__.update(test.__dict__)
    copy.__kwdefaults__, copy.__doc__ = test.__kwdefaults__, test.__doc__
    return copy if test.__name__ in FEW else pytest.mark.soak(copy)


for _module in map(importlib.import_module, MODULES):
    for _name, _value in vars(_module).items():
        if _name.startswith("test_") and inspect.isfunction(_value):
            if "fake" in inspect.signature(_value).parameters and _name not in OF_SERVERS:
                globals()[_name] = _again(_value)
        elif type(_value).__name__ == "FixtureFunctionDefinition" and _name != "fake":
            globals()[_name] = _value
