"""The robot's world on the page: a picture in three dimensions, the view on it, what is marked, and objects that a hand moves."""

from __future__ import annotations

import io
import math

import pytest
from fake_session import TOPICS
from test_page import wait_for_text

np = pytest.importorskip("numpy", reason="pip install 'cramhy[robot]'")
images = pytest.importorskip("PIL.Image", reason="pip install pillow")

STILL = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
RED, GREEN, WHITE, BLUE = [0.9, 0.05, 0.05, 1.0], [0.05, 0.7, 0.1, 1.0], [0.95, 0.95, 0.95, 1.0], [0.1, 0.2, 0.8, 1.0]
COUNT = """window.frames_drawn = 0; const draw = WebGL2RenderingContext.prototype.clear;
WebGL2RenderingContext.prototype.clear = function (what) {
  if (what & this.COLOR_BUFFER_BIT) window.frames_drawn++;
  return draw.call(this, what);
};"""
BOTTLE = [0.5, 0.2, 0.85]


def shape(kind, size, colour, at=STILL, **more):
    return {"kind": kind, "size": list(size), "frame": list(at), "colour": colour, "points": [], "triangles": [], **more}


def link(name, shapes=(), parent=-1, at=STILL, joint=-1, axis=(0.0, 0.0, 1.0), slides=False):
    return {"name": name, "parent": parent, "frame": list(at), "joint": joint, "slides": slides, "axis": list(axis), "shapes": list(shapes)}


def thing(name, kind, *links, cameras=()):
    opening = math.radians(50)
    return {
        "name": name, "kind": kind, "types": [], "movable": kind == "object", "cameras": list(cameras), "opening": opening, "links": list(links),
    }  # fmt: skip


def state(name, x=0.0, y=0.0, z=0.0, joints=(), holder="", hand="", grip=()):
    return {
        "name": name, "pose": [x, y, z, 1.0, 0.0, 0.0, 0.0], "joints": list(joints), "holder": holder, "link": hand, "grip": list(grip),
    }  # fmt: skip


TABLE = thing("table", "furniture", link("top", [shape("box", (2.0, 2.0, 0.7), WHITE, [0.0, 0.0, 0.35, 1.0, 0.0, 0.0, 0.0])]))
RED_BOTTLE = thing("bottle", "object", link("", [shape("cylinder", (0.1, 0.3), RED)]))
ROBOT = thing(
    "robot",
    "robot",
    link("base", [shape("box", (0.5, 0.5, 0.4), BLUE, [0.0, 0.0, 0.2, 1.0, 0.0, 0.0, 0.0])]),
    link("arm", [shape("box", (0.6, 0.1, 0.1), GREEN, [0.3, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])], 0, [0.0, 0.0, 0.9, 1.0, 0.0, 0.0, 0.0], 0),
    link("eye_optical_frame", [], 0, [0.0, 0.0, 1.5, 0.5, -0.5, 0.5, -0.5]),  # it looks along the x of the base
    cameras=["eye_optical_frame"],
)


def kitchen(fake):
    """A table with a bottle, and a robot before it."""
    fake.world([])
    fake.state["world"]["simulator"] = ""
    fake.robots([TABLE, RED_BOTTLE, ROBOT], [(0.0, [state("table"), state("bottle", *BOTTLE), state("robot", -1.6, joints=[0.0])])])


class Picture:
    """What is seen of the room now."""

    def __init__(self, page):
        page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        drawn = images.open(io.BytesIO(page.locator("#room").screenshot())).convert("RGB")
        self.pixels = np.asarray(drawn, float).transpose(2, 0, 1)
        self.width = drawn.width

    def count(self, like):
        """How many pixels look like a colour, whatever the light."""
        return int(like(*self.pixels).sum())

    def middle(self, like):
        """The middle of these pixels, and how many they are."""
        y, x = np.nonzero(like(*self.pixels))
        assert len(x), "Nothing of that colour is seen."
        return x.mean(), y.mean(), len(x)


def red(r, g, b):
    return (r > 60) & (g < 0.62 * r) & (b < 0.62 * r)  # what is chosen is tinted


def green(r, g, b):
    return (g > 80) & (r < 0.5 * g) & (b < 0.6 * g)


def violet(r, g, b):
    return (b > 1.25 * g) & (r > 1.1 * g) & (b > 90)


def yellow(r, g, b):
    return (r > 150) & (g > 150) & (b < 110)


@pytest.fixture
def page(fake, visit):
    kitchen(fake)
    opened = visit("about:blank", 1020, 600, connected=False)  # software draws each pixel
    opened.add_init_script(COUNT)
    opened.goto(fake.address)
    opened.wait_for_selector("#room")
    opened.wait_for_function("window.frames_drawn > 0")
    return opened


def at_rest(page):
    """Wait until nothing is drawn any more; how many frames there were."""
    return page.evaluate(
        """() => new Promise((done) => { let last = -1, still = 0; const look = () => {
          still = window.frames_drawn === last ? still + 1 : 0;
          last = window.frames_drawn;
          if (still > 14) done(last); else requestAnimationFrame(look);
        }; look(); })"""
    )


@pytest.mark.soak
def test_the_room_on_one_page(page, fake):
    """Its parts are functions, since a page that draws without a graphics card takes seconds to begin."""
    for part in (
        the_room_is_drawn_and_the_view_turns_by_mouse_keys_and_buttons,
        fingers_turn_the_view_and_draw_near,
        marks_are_shown_when_they_are_wanted,
        motions_are_played_and_the_arm_keeps_its_length,
        an_object_is_dragged_over_what_it_can_stand_on,
    ):
        fake.robots([RED_BOTTLE], [(0.0, [state("table"), state("bottle", *BOTTLE), state("robot", -1.6, joints=[0.0])])])
        page.get_by_role("button", name="Whole view").click()
        part(page, fake)


def the_room_is_drawn_and_the_view_turns_by_mouse_keys_and_buttons(page, fake):
    drawn = at_rest(page)
    first = Picture(page)
    x, y, size = first.middle(red)
    assert first.count(green) and not page.locator("#paper").is_visible()
    assert at_rest(page) == drawn  # nothing has changed, so nothing was drawn
    page.locator("#room").focus()
    page.keyboard.press("+")
    page.keyboard.press("+")
    assert Picture(page).middle(red)[2] > 1.3 * size
    page.keyboard.press("0")
    assert Picture(page).middle(red)[:2] == pytest.approx((x, y), abs=2)
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowUp")
    assert Picture(page).middle(red)[:2] != pytest.approx((x, y), abs=4)
    assert not any(message["op"] == "publish" for message in fake.heard)  # there is no turtle that the arrows could drive
    page.get_by_role("button", name="Whole view").click()
    box = page.locator("#room").bounding_box()
    page.mouse.move(box["x"] + 20, box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + 120, box["y"] + 60, steps=4)
    page.mouse.up()
    turned = Picture(page).middle(red)
    assert turned[:2] != pytest.approx((x, y), abs=4)
    before = at_rest(page)
    page.mouse.wheel(0, -200)
    page.wait_for_function("(before) => window.frames_drawn > before", arg=before)  # the driver does not wait for that
    at_rest(page)
    assert Picture(page).middle(red)[2] > 1.3 * turned[2]
    page.locator("#room-view").select_option(label="robot: eye")
    seen = Picture(page)
    assert seen.middle(red)[0] < seen.width / 2 and not seen.count(green)  # to the left of its way, its own arm is below
    fake.robots(steps=[(0.0, [state("bottle", 0.5, -0.2, 0.85)])])
    at_rest(page)
    assert Picture(page).middle(red)[0] > seen.width / 2


TOUCH = """(points) => { const canvas = document.getElementById("room"); const box = canvas.getBoundingClientRect();
  canvas.setPointerCapture = () => {};
  for (const [type, id, x, y] of points) canvas.dispatchEvent(new PointerEvent(`pointer${type}`,
    { pointerId: id, pointerType: "touch", isPrimary: id === 1, clientX: box.left + x, clientY: box.top + y, buttons: type === "up" ? 0 : 1, bubbles: true })); }"""


def fingers_turn_the_view_and_draw_near(page, fake):
    x, y, size = Picture(page).middle(red)
    page.evaluate(TOUCH, [["down", 1, 20, 30], ["move", 1, 60, 50], ["move", 1, 110, 80], ["up", 1, 110, 80]])
    assert Picture(page).middle(red)[:2] != pytest.approx((x, y), abs=4)
    page.get_by_role("button", name="Whole view").click()
    two = [
        ["down", 1, 100, 100],
        ["down", 2, 140, 100],
        ["move", 2, 150, 100],
        ["move", 2, 200, 100],
        ["up", 1, 100, 100],
        ["up", 2, 200, 100],
    ]
    page.evaluate(TOUCH, two)
    assert Picture(page).middle(red)[2] > 1.5 * size


def motions_are_played_and_the_arm_keeps_its_length(page, fake):
    before = at_rest(page)
    fake.robots(steps=[(0.6, [state("robot", -1.6, joints=[1.5])]), (0.6, [state("robot", -1.6, 1.0, joints=[1.5])])])
    page.wait_for_function("(before) => window.frames_drawn > before + 8", arg=before)  # in between, too
    at_rest(page)
    fake.robots(steps=[(0.0, [state("bottle", *BOTTLE, holder="robot", hand="arm", grip=[0.6, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])])])
    page.get_by_role("button", name="bottle").click()
    wait_for_text(page, "[data-reading=room-held]", "robot")
    wait_for_text(page, "[data-reading=room-y]", "1.60")  # it goes with the link that holds it
    fake.robots(steps=[(0.0, [state("robot", -1.6, 0.0, joints=[0.0])])])
    wait_for_text(page, "[data-reading=room-x]", "−1.00")
    fake.robots(removed=["bottle"])
    wait_for_text(page, ".chosen", "nothing chosen")
    assert not Picture(page).count(red)


def marks_are_shown_when_they_are_wanted(page, fake):
    cells = [255 if column > 10 else 0 for _ in range(20) for column in range(20)]
    pose = [0.5, -0.6, 0.85, 1.0, 0.0, 0.0, 0.0]
    fake.robots(
        marks=[
            {
                "costmap": [{"x": -3.0, "y": -3.0, "resolution": 0.1, "columns": 20, "rows": 20, "cells": cells}],
                "grasps": [{"name": "robot", "pose": pose, "good": True}],
                "seen": [{"name": "bottle", "pose": pose, "good": True}],
            }
        ]
    )
    at_rest(page)
    seen = Picture(page)
    assert seen.count(yellow) > 100 and seen.count(violet) > 20
    page.locator("#room-costmap").click()
    page.locator("#room-belief").click()
    at_rest(page)  # it is fine then
    seen = Picture(page)
    assert not seen.count(yellow) and seen.count(violet) < 20
    greens = seen.count(green)
    page.locator("#room-grasps").click()
    at_rest(page)  # it is fine then
    assert Picture(page).count(green) > greens
    reds = Picture(page).count(red)
    page.locator("#room-frames").click()
    at_rest(page)  # it is fine then
    assert Picture(page).count(red) > reds


def drag(page, start, end):
    box = page.locator("#room").bounding_box()
    page.mouse.move(box["x"] + start[0], box["y"] + start[1])
    page.mouse.down()
    for share in (0.3, 0.6, 1.0):
        page.mouse.move(*(box[side] + one + (other - one) * share for side, one, other in zip("xy", start, end)))


def an_object_is_dragged_over_what_it_can_stand_on(page, fake):
    fake.services["/cramhy/move_thing"] = lambda request: (
        fake.robots(steps=[(0.2, [state("bottle", request["x"], request["y"], 0.85)])]) or request
    )
    at_rest(page)
    start = Picture(page).middle(red)[:2]
    end = start[0] - 60, start[1] - 10
    drag(page, start, end)
    assert Picture(page).middle(red)[:2] == pytest.approx(end, abs=7)  # before it is let go, too
    assert not [message for message in fake.heard if message.get("service") == "/cramhy/move_thing"]
    page.mouse.up()
    asked = fake.wait_for_call("/cramhy/move_thing")
    assert asked["name"] == "bottle" and asked["z"] == pytest.approx(0.86, abs=1e-3)
    at_rest(page)
    assert Picture(page).middle(red)[:2] == pytest.approx(end, abs=7)
    wait_for_text(page, "[data-reading=room-z]", "0.85")

    def refuse(request):
        raise ValueError("bottle cannot be moved by hand: somebody is faster.")

    fake.services["/cramhy/move_thing"] = refuse
    drag(page, end, start)
    page.mouse.up()
    wait_for_text(page, "#notice", "bottle cannot be moved by hand: somebody is faster.")
    at_rest(page)
    assert Picture(page).middle(red)[:2] == pytest.approx(end, abs=7)  # it is back
    fake.heard.clear()
    fake.robots(steps=[(0.0, [state("bottle", asked["x"], asked["y"], 0.85, holder="robot", hand="arm", grip=STILL)])])
    fake.robots(steps=[(0.0, [state("bottle", asked["x"], asked["y"], 0.85, holder="robot", hand="nowhere")])])
    at_rest(page)
    drag(page, end, start)
    page.mouse.up()
    wait_for_text(page, "#notice", "robot holds bottle with nowhere, so it cannot be moved by hand. Let the plan put it down first.")
    assert not [message for message in fake.heard if message.get("service") == "/cramhy/move_thing"]


@pytest.mark.soak
def test_a_session_of_turtles_loads_nothing_of_the_room_and_one_with_both_has_a_switch(fake, visit):
    loaded = []
    page = visit("about:blank", connected=False)
    page.on("request", lambda request: loaded.append(request.url))
    page.goto(fake.address)
    page.wait_for_selector("#connection[data-state=open]")
    assert page.locator("#paper").is_visible() and not page.locator("#worlds").is_visible()
    assert not any("room.js" in url or "renderer.js" in url for url in loaded)
    fake.publish(TOPICS["robots"], {"stamp": 0.0, "steps": [{"seconds": 1, "states": [state("unknown")]}]})
    fake.robots([RED_BOTTLE], [(0.0, [state("bottle", 0.0, 0.0, 0.15)])])
    page.wait_for_selector("#worlds:not([hidden])")
    page.get_by_role("group", name="World that is shown").get_by_role("button", name="Turtles").click()
    page.locator("#paper").wait_for(state="visible")
    page.get_by_role("group", name="World that is shown").get_by_role("button", name="Robot").click()
    page.locator("#room").wait_for(state="visible")
    assert not page.locator("#paper").is_visible()


@pytest.mark.soak
def test_on_a_phone_the_past_is_shown_too(fake, visit):
    kitchen(fake)
    page = visit(fake.address, 390, 760, has_touch=True, is_mobile=True, color_scheme="dark", reduced_motion="reduce")
    page.wait_for_selector("#room")
    page.evaluate("() => { " + COUNT + " }")
    page.get_by_role("button", name="Robot", exact=True).tap()
    page.get_by_role("button", name="Whole view").tap()
    before = Picture(page).middle(red)[:2]
    fake.stamp = 5.0
    fake.robots(steps=[(2.0, [state("bottle", -0.5, -0.5, 0.85)])])
    page.wait_for_function("window.frames_drawn > 1")
    at_rest(page)
    moved = Picture(page).middle(red)[:2]
    assert moved != pytest.approx(before, abs=4)
    page.evaluate(
        "() => { const slider = document.getElementById('moment'); slider.value = 1; slider.dispatchEvent(new Event('input', { bubbles: true })); }"
    )
    wait_for_text(page, ".room .past", "as it was at")
    assert Picture(page).middle(red)[:2] == pytest.approx(before, abs=2)
    page.get_by_role("button", name="Live").tap()
    assert Picture(page).middle(red)[:2] == pytest.approx(moved, abs=2)
