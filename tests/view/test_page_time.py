"""The page and time: pause, step and speed, the time line, a connection that is lost."""

from __future__ import annotations

import threading

import pytest
from fake_session import PATIENCE, fluent, stroke, task, turtle
from test_page import BLUE, near, pixel, rows, wait_for_count, wait_for_pixel, wait_for_reading, wait_for_text, wait_for_texts


def seek(page, stamp):
    """Move the slider of the time line."""
    page.evaluate(
        """(stamp) => {
      const slider = document.getElementById("moment");
      slider.value = stamp;
      slider.dispatchEvent(new Event("input"));
    }""",
        stamp,
    )


@pytest.mark.soak
def test_pause_step_and_speed_ask_the_session(fake, visit):
    page = visit(fake.address)
    page.get_by_role("button", name="Pause").click()
    assert fake.wait_for_call("/cramhy/set_pace") == {"paused": True, "speed": 1}
    page.locator("#pause[aria-pressed=true]", has_text="Resume").wait_for()
    page.locator("#step-size").select_option("1 s")
    page.get_by_role("button", name="Step").click()
    assert fake.wait_for_call("/cramhy/step") == {"seconds": 1}
    wait_for_text(page, "#clock", "1.00 s")
    fake.heard.clear()
    page.locator("#speed").select_option("× 5")
    assert fake.wait_for_call("/cramhy/set_pace") == {"paused": True, "speed": 5}
    fake.pace(speed=3.0)  # somebody else chose a speed that is not in the list
    page.wait_for_function("() => document.getElementById('speed').selectedOptions[0].text === '× 3'")


@pytest.mark.soak
def test_a_pace_that_is_refused_does_not_stay_chosen(fake, visit):
    def refuse(request):
        raise ValueError("A speed is a number above zero.")

    fake.services["/cramhy/set_pace"] = refuse
    page = visit(fake.address)
    page.locator("#speed").select_option("unbounded")
    wait_for_text(page, "#notice", "A speed is a number above zero.")
    assert page.locator("#speed").input_value() == "1"


@pytest.mark.soak
def test_what_is_asked_for_before_the_last_answer_came_keeps_what_was_asked_before(fake, visit):
    page = visit(fake.address)
    answer, set_pace = threading.Event(), fake.services["/cramhy/set_pace"]
    fake.services["/cramhy/set_pace"] = lambda request: answer.wait(PATIENCE) and set_pace(request)
    page.locator("#speed").select_option("× 5")
    page.get_by_role("button", name="Pause").click()
    answer.set()
    fake.wait(lambda message: message.get("service") == "/cramhy/set_pace" and message["args"] == {"paused": True, "speed": 5})
    page.locator("#pause", has_text="Resume").click()
    fake.wait(lambda message: message.get("service") == "/cramhy/set_pace" and message["args"] == {"paused": False, "speed": 5})


@pytest.mark.soak
def test_the_walls_time_cannot_be_held(fake, visit):
    fake.pace(virtual=False)
    page = visit(fake.address)
    page.wait_for_function("() => document.getElementById('pause').disabled && document.getElementById('speed').disabled")
    assert "--time virtual" in page.locator("#pause").get_attribute("title")


def past(fake):
    """Three moments: at 1 s a red line, at 2 s a plan, at 3 s a clean paper and the plan's end."""
    fake.stamp = 0.984
    fake.world([turtle(x=3, y=9)], [stroke(2, 9, 3, 9, (255, 0, 0), 9)])
    fake.fluents(fluent("1", "DISTANCE", "4", 4.0))
    fake.say("the first line")
    fake.stamp = 2.0
    fake.tasks(task("1", "[TOP-LEVEL]", began=2.0))
    fake.fluents(fluent("1", "DISTANCE", "2", 2.0))
    fake.modules(("NAVIGATION", "RUNNING", "#<MOTION>", []))
    fake.stamp = 2.984
    fake.world([turtle(x=9, y=9)], [stroke(2, 5, 3, 5, (0, 255, 0), 9)], cleared=(0, 0, 0))
    fake.tasks(task("1", "[TOP-LEVEL]", began=2.0, ended=3.0, state="SUCCEEDED", result="T"))
    fake.fluents(fluent("1", "DISTANCE", "0", 0.0))
    fake.modules()
    fake.say("the last line")


@pytest.mark.soak
def test_the_time_line_shows_everything_as_it_was(fake, visit):
    page = visit(fake.address)
    past(fake)
    wait_for_reading(page, "x", "9.00")
    wait_for_text(page, "#tasks", "gave T")
    wait_for_text(page, "#log", "the last line")
    seek(page, 1.5)
    wait_for_reading(page, "x", "3.00")
    wait_for_pixel(page, 2.2, 9, [255, 0, 0])
    assert near(pixel(page, 2.5, 5), BLUE)
    wait_for_count(page, "#tasks [role=treeitem]", 0)
    wait_for_text(page, "#clock", "1.50 s")
    wait_for_text(page, "#past", "as it was at 1.50 s")
    wait_for_text(page, "#fluents .value", "4")
    wait_for_texts(page, "#log .line", ["info/turtlesimthe first line"])
    seek(page, 2.5)
    wait_for_text(page, "#tasks .time", "0.50 s")
    wait_for_text(page, "#modules", "#<MOTION>")
    wait_for_text(page, "#fluents .value", "2")
    fake.tasks(task("2", "[TOP-LEVEL]", began=3.0))  # the session goes on meanwhile, and the past stays
    fake.world([turtle(x=10, y=9)], passed=1.0)
    page.wait_for_function("() => Number(document.getElementById('moment').max) >= 4")
    assert [row[1] for row in rows(page)] == ["[TOP-LEVEL]"]
    wait_for_reading(page, "x", "3.00")
    page.get_by_role("button", name="Live").click()
    wait_for_reading(page, "x", "10.00")
    wait_for_pixel(page, 2.2, 9, [0, 0, 0])
    wait_for_pixel(page, 2.5, 5, [0, 255, 0])
    wait_for_count(page, "#tasks [role=treeitem]", 2)
    assert not page.locator("#past").is_visible()


@pytest.mark.soak
def test_the_time_line_works_with_the_keys(fake, visit):
    page = visit(fake.address)
    past(fake)
    wait_for_reading(page, "x", "9.00")
    page.wait_for_function("() => Number(document.getElementById('moment').max) === 3")
    slider = page.get_by_role("slider", name="Time line")
    slider.press("PageDown")
    page.wait_for_function("() => document.getElementById('moment').getAttribute('aria-valuetext') === '2.70 s of 3.00 s'")
    slider.press("ArrowLeft")
    wait_for_text(page, "#clock", "2.67 s")
    slider.press("Home")
    wait_for_text(page, "#clock", "0.00 s")
    slider.press("End")
    page.wait_for_function("() => document.getElementById('moment').getAttribute('aria-valuetext') === 'live'")


@pytest.mark.soak
def test_what_was_before_the_page_came_is_asked_for(fake, visit):
    fake.chapter(2, 1, 2, 5.0, 10.0, fake.state, later_world=[])
    early = {**fake.state, "tasks": {**fake.state["tasks"], "tasks": [task("0", "[AN-EARLY-PLAN]", state="SUCCEEDED", ended=1.0)]}}
    world = fake.state["world"]
    fake.chapter(
        1,
        1,
        2,
        0.0,
        5.0,
        early,
        world=[{**world, "complete": False, "stamp": 1.0, "turtles": [turtle(x=1, y=1)], "strokes": [stroke(1, 1, 2, 1, (255, 0, 0), 9)]}],
    )
    fake.chapters[2]["begin"] = 5.0
    fake.stamp = 9.984
    fake.world([turtle(x=9, y=9)])
    page = visit(fake.address)
    page.get_by_role("button", name="earlier").click()
    page.wait_for_function("() => document.getElementById('moment').min === '0'")
    seek(page, 1.2)
    wait_for_reading(page, "x", "1.00")
    wait_for_pixel(page, 1.8, 1, [255, 0, 0])
    wait_for_text(page, "#tasks", "[AN-EARLY-PLAN]")
    assert not page.get_by_role("button", name="earlier").is_visible()


@pytest.mark.soak
def test_the_strip_shows_the_plans_of_the_time_line(fake, visit):
    page = visit(fake.address)
    past(fake)
    page.wait_for_function("() => document.querySelector('#strip rect')?.dataset.state === 'SUCCEEDED'")
    x, width = page.evaluate("(({ x, width }) => [x.baseVal.value, width.baseVal.value])(document.querySelector('#strip rect'))")
    assert (round(x), round(x + width)) == (667, 1000)


@pytest.mark.soak
def test_a_lost_connection_is_said_and_made_again(fake, visit):
    page = visit(fake.address)
    par = task("1", "[TOP-LEVEL]", began=0.0)
    fake.tasks(par)
    wait_for_text(page, "#tasks", "TOP-LEVEL")
    page.foresee("WebSocket connection to")
    fake.close()
    page.wait_for_selector("#connection[data-state=lost]")
    wait_for_text(page, "#banner", "The connection to the session is lost. Trying again; what you see is the last that was heard.")
    wait_for_text(page, "#tasks", "TOP-LEVEL")
    page.wait_for_function("() => document.getElementById('pause').disabled")
    fake.stamp = 4.0
    fake.tasks(task("1", "[TOP-LEVEL]", began=0.0, ended=4.0, state="SUCCEEDED", result="42"))  # nobody hears that
    fake.world([turtle(x=4, y=4)], [stroke(1, 4, 4, 4, (255, 0, 0), 9)])
    fake.open()
    page.wait_for_selector("#connection[data-state=open]")
    wait_for_text(page, "#tasks", "gave 42")
    wait_for_pixel(page, 2, 4, [255, 0, 0])
    assert not page.locator("#banner").is_visible()
    fake.world([turtle(x=5, y=4)])
    wait_for_reading(page, "x", "5.00")


@pytest.mark.soak
def test_another_session_at_the_same_address_begins_anew(fake, visit):
    page = visit(fake.address)
    fake.tasks(task("1", "[TOP-LEVEL]"), task("2", "[CHILD]", "1"))
    page.get_by_role("treeitem", name="TOP-LEVEL").first.click()
    wait_for_count(page, "#tasks [role=treeitem]", 1)
    fake.stamp = 100.0
    fake.world([turtle(x=9, y=9)], [stroke(1, 4, 4, 4, (255, 0, 0), 9)])
    wait_for_pixel(page, 2, 4, [255, 0, 0])
    page.foresee("WebSocket connection to")
    fake.close()
    page.wait_for_selector("#connection[data-state=lost]")
    fake.stamp = 1.0
    fake.state["world"].update(stamp=1.0, strokes=[], turtles=[turtle(x=2, y=2)])
    for kind in ("tasks", "fluents", "modules", "pace"):
        fake.state[kind]["stamp"] = 1.0
    fake.open()
    wait_for_pixel(page, 2.9, 4, BLUE)
    wait_for_reading(page, "x", "2.00")
    page.wait_for_function("() => Number(document.getElementById('moment').max) === 1")
    wait_for_count(page, "#tasks [role=treeitem]", 2)  # what was closed belonged to another plan


@pytest.mark.soak
def test_a_wrong_token_is_said_and_not_tried_again(fake, visit):
    page = visit(fake.address + "-wrong", connected=False)
    wait_for_text(
        page,
        "#banner",
        "The session does not let this page in: this token is not the session's. "
        "Open the address that it prints; it has a new token each time.",
    )
    assert page.locator("#connection").get_attribute("data-state") == "refused"


def test_a_page_that_cannot_start_says_so(fake, visit):
    fake._files = {path: file for path, file in fake._files.items() if path != "/shapes.json"}
    page = visit(fake.address, connected=False)
    page.foresee("404")
    wait_for_text(page, "#banner", "The page could not start: the server has no shapes.json (404). Load it again; if that does not help, ")


@pytest.mark.soak
def test_an_address_without_a_token_is_said(fake, visit):
    page = visit(fake.address.partition("#")[0], connected=False)
    wait_for_text(page, "#banner", "The session does not let this page in: this address has no token. Open the address that it prints;")
    assert not fake._connections


def test_a_recording_is_sought_in_by_the_session(fake, visit):
    fake.pace(recording="run.mcap", begin=0.0, end=60.0, virtual=False, paused=True)
    sought = []

    def seek_to(request):
        fake.stamp = request["stamp"]
        sought.append(fake.stamp)
        for kind in ("tasks", "fluents"):
            fake.state[kind].update(stamp=fake.stamp, complete=True)
            fake.publish(f"/cramhy/{kind}", fake.state[kind])
        fake.state["world"].update(stamp=fake.stamp, turtles=[turtle(x=fake.stamp / 10, y=1)], strokes=[])
        fake.publish("/cramhy/world", {**fake.state["world"], "complete": True})
        fake.pace()
        fake.say(f"the last line at {fake.stamp:g} s")
        return {"pace": fake.state["pace"]}

    fake.services["/cramhy/seek"] = seek_to
    page = visit(fake.address)
    page.wait_for_function("() => document.getElementById('moment').max === '60'")
    assert not page.get_by_role("button", name="Live").is_visible()
    assert page.locator("#pause").is_enabled()
    wait_for_text(page, "#doing", "replays run.mcap")
    assert not page.get_by_role("button", name="Reset world").is_visible()
    page.keyboard.press("ArrowUp")
    wait_for_text(page, "#notice", "This is a recording: what its turtles did is done, and they cannot be driven.")
    fake.say("before")
    wait_for_text(page, "#log", "before")
    seek(page, 45.0)
    wait_for_reading(page, "x", "4.50")
    wait_for_text(page, "#clock", "45.00 s")
    seek(page, 15.0)
    wait_for_reading(page, "x", "1.50")
    wait_for_text(page, "#clock", "15.00 s")
    wait_for_texts(page, "#log .text", ["the last line at 15 s"])
    assert sought == [45.0, 15.0]
