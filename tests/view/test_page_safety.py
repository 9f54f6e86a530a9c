"""The page and hostile sessions: names that are markup, messages that are none of its own, and a policy that lets nothing else in."""

from __future__ import annotations

import json
import re
from importlib import resources
from pathlib import Path

import pytest
from fake_session import fluent, task, turtle
from test_page import wait_for_count, wait_for_reading, wait_for_text

MARKUP = "<img src=x onerror='window.hit = 1'><script>window.hit = 1</script>"


@pytest.mark.soak
def test_names_that_are_markup_stay_names(fake, visit):
    page = visit(fake.address)
    fake.world([turtle(MARKUP, 2, 2), turtle("javascript:alert(1)", 4, 4)])
    fake.tasks(
        task("1", MARKUP, waits_for=MARKUP, place=MARKUP, operator=MARKUP), task("2", MARKUP, state="FAILED", result=MARKUP, ended=1.0)
    )
    fake.fluents(fluent(MARKUP, MARKUP, MARKUP))
    fake.modules((MARKUP, MARKUP, MARKUP, [MARKUP]))
    fake.say(MARKUP, name=MARKUP)
    fake.pace(recording="")
    for place in (
        "#turtles",
        "#tasks .name",
        "#tasks .waits",
        "#fluents .name",
        "#fluents .value",
        "#modules .name",
        "#modules .executes",
        "#modules .queue",
        "#log .text",
        "#log .node",
    ):
        wait_for_text(page, place, "<img src=x")

    def refuse(request):
        raise ValueError(MARKUP)

    fake.services["/clear"] = refuse
    page.get_by_role("button", name="Clear paper").click()
    wait_for_text(page, "#notice", MARKUP)
    assert page.evaluate("window.hit") is None
    assert page.evaluate("document.querySelectorAll('main img, main script, footer img, footer script').length") == 0


@pytest.mark.soak
def test_names_of_objects_properties_are_names_like_others(fake, visit):
    page = visit(fake.address)
    for name in ("__proto__", "constructor", "toString"):
        fake.tasks(task(name, name))
        fake.fluents(fluent(name, name, name, 1.0))
        fake.modules((name, "RUNNING", name, []))
        fake.world([turtle(name, 3, 3), turtle("other", 4, 4)])
        wait_for_text(page, "#modules .name", name)
        wait_for_text(page, "#turtles", name)
    wait_for_count(page, "#tasks [role=treeitem]", 3)
    wait_for_count(page, "#fluents .fluent", 3)


@pytest.mark.soak
def test_messages_that_are_none_leave_the_page_as_it_is(fake, visit):
    page = visit(fake.address)
    connection = next(iter(fake._connections))
    for text in ("", "{", "null", "[]", "17", '"text"'):
        connection.send(text)
    for message in (
        {"op": "publish"},
        {"op": "publish", "topic": "/other", "msg": {}},
        {"op": "call_service"},
        {"op": "status"},
        {"op": "service_response", "id": "none"},
        {"op": "publish", "topic": "/cramhy/world", "msg": None},
        {"op": "publish", "topic": "/cramhy/tasks", "msg": {"stamp": "x", "tasks": 5}},
        {"op": "publish", "topic": "/rosout"},
    ):
        connection.send(json.dumps(message))
    connection.send(b"\x00\xff")
    wait_for_text(page, "#notice", "A message of the session could not be read: ")
    fake.world([turtle(x=3, y=3)])
    wait_for_reading(page, "x", "3.00")


@pytest.mark.soak
def test_nothing_of_the_page_comes_from_elsewhere_or_stands_in_line(fake, visit):
    visit(fake.address)  # the fixture holds that the policy was not violated
    for file in (file for file in Path(str(resources.files("cramhy_runtime.view").joinpath("static"))).rglob("*") if file.is_file()):
        text = file.read_text()
        assert not re.findall(r"""https?://(?!www\.w3\.org/2000/svg")|//cdn|@import|url\(""", text), file.name
        assert not re.findall(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\b|new Function|srcdoc", text), file.name
        if file.name.endswith(".html"):
            assert not re.findall(r"\sstyle=|\son\w+=|<style|<script(?![^>]*\ssrc=)", text)


def test_the_page_asks_only_for_what_it_may(fake, visit):
    page = visit(fake.address)
    for name in ("Clear paper", "Reset world", "Pause", "Step"):
        page.get_by_role("button", name=name).click()
    page.keyboard.press("ArrowUp")
    fake.wait(lambda message: message["op"] == "publish")
    fake.wait_for_call("/cramhy/set_pace")
    assert {message["op"] for message in fake.heard} == {"subscribe", "call_service", "advertise", "publish"}
    assert {message["service"] for message in fake.heard if message["op"] == "call_service"} == {
        "/cramhy/get_state",
        "/cramhy/get_history",
        "/clear",
        "/reset",
        "/cramhy/step",
        "/cramhy/set_pace",
        "/rosapi/get_param",
    }
