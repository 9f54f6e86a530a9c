"""The page for everybody: by the keys alone, for readers of the screen, in the dark, on a phone; and fast enough for all."""

from __future__ import annotations

import math

import pytest
from fake_session import fluent, stroke, task, turtle
from test_page import par, show, wait_for_count, wait_for_reading, wait_for_text

FOCUSED = """() => {
  const { id, className, role, textContent } = document.activeElement;
  return id || document.activeElement.getAttribute("aria-label") || document.activeElement.dataset.key || textContent.trim();
}"""


def filled(fake):
    """A session in which every panel has something to show."""
    par(fake)
    fake.fluents(fluent("1", "A-FLUENT-WITH-A-NAME-THAT-DOES-NOT-WANT-TO-END-ANYWHERE", "x 5.544 y 5.544 theta 0 linear_velocity 0", 1.0))
    fake.modules(
        (
            "TURTLESIM-NAVIGATION",
            "RUNNING",
            "#<MOTION-DESIGNATOR ((TYPE MOVING) (GOAL (9 9 0)))>",
            ["#<MOTION-DESIGNATOR ((TYPE DRIVING))>"],
        )
    )
    fake.world([turtle(f"turtle{number}", number, number) for number in range(1, 9)])
    fake.say("Clamping/" * 40, level=4)


@pytest.mark.soak
def test_all_of_the_page_is_reached_and_used_with_the_keys_alone(fake, visit):
    page = visit(fake.address)
    filled(fake)
    wait_for_text(page, "#tasks", "PAR-CHILD-#2/2")
    wait_for_text(page, "#log", "Clamping")
    page.wait_for_function("() => document.getElementById('turtles').checkVisibility()")
    seen = []
    for _ in range(40):
        page.keyboard.press("Tab")
        seen.append(page.evaluate(FOCUSED))
        assert page.evaluate("() => getComputedStyle(document.activeElement).outlineStyle") != "none", f"{seen[-1]} does not show its focus"
        if seen[-1] == "live":
            break
    assert seen == [
        "projector",
        "theme",
        "paper",
        "turtle1",
        "forward",
        "turn left",
        "backward",
        "turn right",
        "clear",
        "reset",
        "show-grid",
        "show-goals",
        "show-way",
        "follow",
        "1",
        "modules",
        "fluents-all",
        "fluents",
        "level",
        "log",
        "pause",
        "step",
        "step-size",
        "speed",
        "moment",
        "live",
    ]


def test_the_task_tree_is_used_with_the_keys(fake, visit):
    page = visit(fake.address)
    par(fake)
    wait_for_text(page, "#tasks", "PAR-CHILD-#2/2")
    page.get_by_role("treeitem", name="TOP-LEVEL").focus()
    focused = lambda: page.evaluate("() => document.activeElement.dataset.key")  # noqa: E731
    for key, expected in (
        ("ArrowDown", "2"),
        ("ArrowDown", "3"),
        ("ArrowDown", "3"),
        ("ArrowLeft", "1"),
        ("End", "3"),
        ("Home", "1"),
        ("ArrowRight", "2"),
    ):
        page.keyboard.press(key)
        assert focused() == expected, key
    page.keyboard.press("Home")
    page.keyboard.press("ArrowLeft")
    assert page.locator("#tasks [role=treeitem]").count() == 1
    page.keyboard.press("Enter")
    assert page.locator("#tasks [role=treeitem]").count() == 3
    page.keyboard.press("End")
    fake.tasks(removed=["3"])  # the one that has the focus goes
    page.wait_for_function("() => document.activeElement.dataset.key === '1'")
    assert not [message for message in fake.heard if message["op"] == "publish"]  # no turtle was driven by that


@pytest.mark.soak
def test_buttons_drive_with_enter_and_the_space_bar(fake, visit):
    page = visit(fake.address)
    page.get_by_role("button", name="turn right").focus()
    page.keyboard.press("Enter")
    page.keyboard.press("Space")
    fake.wait(lambda message: len([one for one in fake.heard if one["op"] == "publish"]) == 2)


@pytest.mark.soak
def test_readers_of_the_screen_are_told_what_things_are(fake, visit):
    page = visit(fake.address)
    filled(fake)
    wait_for_text(page, "#tasks", "PAR-CHILD-#2/2")
    for role, name in (
        ("tree", "Tasks"),
        ("log", "Log"),
        ("slider", "Time line"),
        ("application", "The turtles' paper"),
        ("radiogroup", "Turtle that is"),
        ("heading", "Process modules"),
        ("status", None),
    ):
        page.get_by_role(role, name=name).first.wait_for(state="attached")
    top = page.locator("#tasks [role=treeitem]").first
    assert [top.get_attribute(f"aria-{name}") for name in ("level", "expanded", "posinset", "setsize")] == ["1", "true", "1", "1"]
    assert (
        page.evaluate("""() => [...document.querySelectorAll("button, select, input")].filter((control) =>
        control.checkVisibility() && !control.textContent.trim() && !control.getAttribute("aria-label") && !control.labels?.length
    ).map((control) => control.id)""")
        == []
    )
    assert page.evaluate("() => document.documentElement.lang") == "en"


CONTRAST = """() => {
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const rgb = (colour) => {
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data.slice(0, 3)];
  };
  const linear = (part) => part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  const light = (colour) => rgb(colour).reduce((sum, part, index) => sum + linear(part / 255) * [0.2126, 0.7152, 0.0722][index], 0);
  const ground = (node) => {
    for (; node; node = node.parentElement) {
      const { backgroundColor } = getComputedStyle(node);
      if (!/, 0\\)$|transparent/.test(backgroundColor)) return backgroundColor;
    }
  };
  const faults = [];
  for (const node of document.querySelectorAll("body *")) {
    if (!node.checkVisibility() || ![...node.childNodes].some((child) => child.nodeType === 3 && child.nodeValue.trim())) continue;
    if (node.closest(":disabled, .unseen, option")) continue;
    const [one, other] = [light(getComputedStyle(node).color), light(ground(node))].sort((a, b) => b - a);
    const contrast = (one + 0.05) / (other + 0.05);
    if (contrast < 4.5) faults.push(`${node.className || node.id || node.tagName} ${contrast.toFixed(2)}`);
  }
  return faults;
}"""


@pytest.mark.soak
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_can_be_read_in_both_themes(fake, visit, scheme):
    page = visit(fake.address, color_scheme=scheme)
    filled(fake)
    fake.tasks(task("9", "[OVER]", state="EVAPORATED", ended=1.0), task("8", "[BAD]", state="FAILED", result="X", ended=1.0))
    fake.say("bad", level=8)
    wait_for_text(page, "#log", "bad")
    wait_for_text(page, "#tasks", "BAD")
    page.wait_for_function("() => document.querySelector('#fluents .fluent')")
    assert page.evaluate(CONTRAST) == []
    ground = page.evaluate("() => getComputedStyle(document.body).backgroundColor")
    assert ground == {"light": "rgb(243, 241, 234)", "dark": "rgb(20, 23, 26)"}[scheme]


@pytest.mark.soak
def test_a_theme_can_be_chosen_and_is_kept(fake, visit):
    page = visit(fake.address, color_scheme="light")
    ground = lambda: page.evaluate("() => getComputedStyle(document.body).backgroundColor")  # noqa: E731
    button = page.locator("#theme")
    light = ground()
    button.click()
    button.click()
    assert button.text_content() == "theme: dark"
    assert ground() != light
    page.reload()
    page.wait_for_selector("#connection[data-state=open]")
    assert (button.text_content(), ground() != light) == ("theme: dark", True)


COVERED = """() => {
  const { top } = document.querySelector(".transport").getBoundingClientRect();
  return [...document.querySelectorAll("main button, main .panel, #paper")].filter((node) => node.getBoundingClientRect().bottom > top)
      .map((node) => node.id || node.className);
}"""


@pytest.mark.soak
@pytest.mark.parametrize("width", [360, 390, 768, 1024, 1280, 1920])
def test_nothing_sticks_out_at_any_width(fake, visit, width):
    page = visit(fake.address, width=width, height=800)
    filled(fake)
    wait_for_text(page, "#log", "Clamping")
    wait_for_text(page, "#tasks", "PAR-CHILD-#2/2")
    wait_for_text(page, "#modules", "TURTLESIM-NAVIGATION")
    wait_for_count(page, "#turtles [role=radio]", 8)
    assert page.evaluate("() => document.documentElement.scrollWidth") <= width
    outside = page.evaluate("""() => [...document.querySelectorAll("body *")]
        .filter((node) => node.checkVisibility() && !node.closest(".scroll, .turtles, .unseen, select, svg"))
        .filter((node) => { const { left, right } = node.getBoundingClientRect(); return right > innerWidth + 1 || left < -1; })
        .map((node) => node.id || node.className)""")
    assert outside == []
    paper = page.locator("#paper").bounding_box()
    assert abs(paper["width"] - paper["height"]) <= 1 and paper["width"] >= min(width - 40, 300)
    if width >= 1000:  # everything is in sight at once, and the panels scroll for themselves
        assert page.evaluate("() => document.documentElement.scrollHeight") <= 800
        assert page.evaluate(COVERED) == []
        page.foresee("WebSocket connection to")
        fake.close()
        page.locator("#banner").wait_for()
        assert page.evaluate(COVERED) == []


@pytest.mark.soak
def test_a_finger_drives_on_a_phone(fake, visit):
    page = visit(fake.address, width=360, height=740, has_touch=True, is_mobile=True)
    assert show(page, "Turtle")
    box = page.get_by_role("button", name="forward").bounding_box()
    assert min(box["width"], box["height"]) >= 44
    page.get_by_role("button", name="forward").tap()
    assert fake.wait(lambda message: message["op"] == "publish")["msg"]["linear"]["x"] == 2


MEASURE = """() => {
  const real = window.requestAnimationFrame.bind(window);
  window.frames_taken = [];
  window.requestAnimationFrame = (draw) => real((now) => {
    const begin = performance.now();
    draw(now);
    window.frames_taken.push(performance.now() - begin);
  });
}"""


@pytest.mark.soak
def test_twenty_turtles_are_drawn_within_a_frame(fake, visit):
    """Sixty frames a second leave 16 ms for each; what the page itself takes of that is measured, not what a busy machine leaves over."""
    page = visit(fake.address)
    page.evaluate(MEASURE)
    filled(fake)
    turtles = [
        turtle(f"turtle{number}", 5.5, 5.5, number * math.pi / 10, (number * 12, 255 - number * 12, 128), 3, number) for number in range(20)
    ]
    for count in range(500):
        strokes = []
        for one in turtles:
            old = one["x"], one["y"]
            one["theta"] += 0.02
            one["x"] += 0.03 * math.cos(one["theta"])
            one["y"] += 0.03 * math.sin(one["theta"])
            strokes.append(stroke(*old, one["x"], one["y"], (one["r"], one["g"], one["b"])))
        fake.world(turtles, strokes)
        if count % 10 == 0:
            fake.fluents(fluent("1", "COUNT", str(count), count))
    wait_for_reading(page, "x", f"{turtles[1]['x']:.2f}")
    page.wait_for_function("() => window.frames_taken.length > 60")
    frames = sorted(page.evaluate("() => window.frames_taken"))
    assert frames[len(frames) // 2] < 8, f"the middle one of {len(frames)} frames took {frames[len(frames) // 2]:.1f} ms"
