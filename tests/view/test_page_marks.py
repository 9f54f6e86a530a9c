"""What can be shown on the paper, and how the page looks: grid, goals, way, coordinates, whose fluents, a projector."""

from __future__ import annotations

import pytest

from fake_session import fluent, task, turtle
from test_page import BLUE, near, pixel, wait_for_pixel, wait_for_reading, wait_for_text, wait_for_texts
from test_page_time import seek


def unlike(page, x, y, colour):
    """Wait until a place of the world has another colour."""
    page.wait_for_function(
        """([x, y, colour]) => {
      const canvas = document.getElementById("paper");
      const at = (part) => Math.round(part / 500 * canvas.width);
      const found = canvas.getContext("2d").getImageData(at(x * 45 + 0.5), at(499 - y * 45 + 0.5), 1, 1).data;
      return colour.some((part, index) => Math.abs(part - found[index]) > 8);
    }""",
        arg=[x, y, colour],
    )


@pytest.mark.soak
def test_a_grid_of_metres_can_be_shown_and_is_kept(fake, visit):
    page = visit(fake.address)
    fake.world([turtle(x=9.5, y=9.5)])
    wait_for_reading(page, "x", "9.50")
    assert near(pixel(page, 5, 2.5), BLUE)
    page.get_by_role("button", name="Grid").click()
    unlike(page, 5, 2.5, BLUE)
    assert near(pixel(page, 4.5, 2.5), BLUE)
    page.reload()
    page.wait_for_selector("#connection[data-state=open]")
    unlike(page, 5, 2.5, BLUE)
    page.get_by_role("button", name="Grid").press("Enter")
    wait_for_pixel(page, 5, 2.5, BLUE)


def goal(fake, *places):
    """Have a process module that goes to PLACES."""
    fake.modules(("NAVIGATION", "RUNNING", "#<MOTION>", []))
    module = fake.state["modules"]["modules"][0]
    module["goals"] = [number for place in places for number in place]
    fake.publish("/cramhy/process_modules", fake.state["modules"])


def test_goals_of_running_motions_are_marked_until_they_are_reached(fake, visit):
    page = visit(fake.address)
    goal(fake, (2.0, 8.0))
    unlike(page, 2.2, 8.0, BLUE)  # on the ring
    page.get_by_role("button", name="Goals").click()
    wait_for_pixel(page, 2.2, 8.0, BLUE)
    page.get_by_role("button", name="Goals").click()
    unlike(page, 2.2, 8.0, BLUE)
    goal(fake, (6.0, 2.0))
    wait_for_pixel(page, 2.2, 8.0, BLUE)
    unlike(page, 6.2, 2.0, BLUE)
    fake.modules()
    wait_for_pixel(page, 6.2, 2.0, BLUE)


@pytest.mark.soak
def test_the_way_is_shown_though_the_pen_is_up_and_as_it_was(fake, visit):
    page = visit(fake.address)
    for step in range(41):
        fake.world([turtle(x=2 + step * 0.125, y=3, pen=None)], passed=0.1)
    fake.world([turtle(x=9, y=9, pen=None)], passed=0.1)
    wait_for_reading(page, "x", "9.00")
    assert near(pixel(page, 3, 3), BLUE)
    page.get_by_role("button", name="Way").click()
    unlike(page, 3, 3, BLUE)
    unlike(page, 6, 3, BLUE)
    seek(page, 2.5)
    wait_for_pixel(page, 6, 3, BLUE)
    unlike(page, 3, 3, BLUE)
    page.keyboard.press("Escape")
    unlike(page, 6, 3, BLUE)
    fake.world([turtle(x=9, y=9, pen=None)], cleared=tuple(BLUE))
    wait_for_pixel(page, 3, 3, BLUE)


@pytest.mark.soak
def test_the_pointer_tells_where_it_is(fake, visit):
    page = visit(fake.address)
    box = page.locator("#paper").bounding_box()
    page.mouse.move(box["x"] + box["width"] * (4 * 45 + 0.5) / 500, box["y"] + box["height"] * (499.5 - 9 * 45) / 500)
    page.locator("#where").wait_for()
    x, y = (float(part) for part in page.locator("#where").text_content().split()[1::2])
    assert abs(x - 4) < 0.05 and abs(y - 9) < 0.05
    page.mouse.move(2, 2)
    page.locator("#where").wait_for(state="hidden")


def test_fluents_of_process_modules_are_shown_when_somebody_asks(fake, visit):
    page = visit(fake.address)
    fake.fluents({**fluent("1", "NAVIGATION-STATUS", ":WAITING"), "internal": True})
    wait_for_text(page, "#fluents", "The program has made no fluent. Process modules have.")
    fake.fluents({**fluent("2", "TURTLE-POSE", "x 1"), "internal": False})
    wait_for_texts(page, "#fluents .name", ["TURTLE-POSE"])
    wait_for_text(page, "#fluents-count", "1 of 2")
    page.locator("#fluents-all").press("Space")
    wait_for_texts(page, "#fluents .name", ["NAVIGATION-STATUS", "TURTLE-POSE"])


@pytest.mark.soak
def test_for_a_projector_letters_are_large_and_stay_so(fake, visit):
    page = visit(fake.address, width=1920, height=1080)
    size = lambda: page.evaluate("() => parseFloat(getComputedStyle(document.getElementById('pause')).fontSize)")  # noqa: E731
    usual = size()
    page.get_by_role("button", name="projector").press("Enter")
    assert size() >= 1.35 * usual
    page.reload()
    page.wait_for_selector("#connection[data-state=open]")
    assert size() >= 1.35 * usual
    colours = page.evaluate(
        "() => { const { color, backgroundColor } = getComputedStyle(document.body); return [color, backgroundColor]; }"
    )
    assert set(colours) == {"rgb(0, 0, 0)", "rgb(255, 255, 255)"}
    page.get_by_role("button", name="projector").press("Enter")
    assert size() == usual


@pytest.mark.soak
def test_a_name_has_one_line_however_long_it_is(fake, visit):
    page = visit(fake.address, width=1280, height=720)
    name = "[A-VERY-LONG-NAME-" * 20
    fake.tasks(task("1", name, waits_for=name, place=name), task("2", "[B]"))
    fake.fluents(fluent("1", name, "1"))
    fake.modules((name, "RUNNING", "", []))
    fake.say("text", name=name)
    for width, height in ((1280, 720), (390, 844)):
        page.set_viewport_size({"width": width, "height": height})
        for pane, selector in (("Tasks", "#tasks"), ("Fluents", "#fluents"), ("Modules", "#modules"), ("Log", "#log")):
            button = page.locator("#tabs").get_by_role("button", name=pane, exact=True)
            if button.is_visible():
                button.click()
            wait_for_text(page, selector, "A-VERY-LONG-NAME")
            node = page.locator(f"{selector} .name, {selector} .node").first
            height_of_line = node.evaluate("(node) => parseFloat(getComputedStyle(node).fontSize) * 2")
            assert node.bounding_box()["height"] <= height_of_line, (width, pane)
            assert page.locator(selector).evaluate("(list) => list.scrollWidth <= list.clientWidth"), (width, pane)
