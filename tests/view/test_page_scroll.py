"""The page never scrolls away: the document is as high as the window, with long lists, a wheel, fingers, large letters, at all sizes."""

from __future__ import annotations

import signal

import pytest
from fake_session import fluent, task
from test_page import show, wait_for_count, wait_for_text

SIZES = {"desktop": (1440, 900), "tablet": (820, 1180), "phone": (390, 844)}
OTHER_SIZES = [
    (1920, 1080),
    (1280, 720),
    (1000, 1300),
    (1000, 600),
    (1280, 400),
    (999, 700),
    (844, 390),
    (700, 1000),
    (320, 568),
    (320, 256),
]
LISTS = ("tasks", "modules", "fluents", "log")
BEYOND = "() => Math.max(document.scrollingElement.scrollHeight - innerHeight, document.scrollingElement.scrollWidth - innerWidth)"
STRAYS = """() => {
  const strays = [];
  for (const node of document.querySelectorAll("*")) {
    if (node instanceof SVGElement || getComputedStyle(node).position !== "absolute" || !node.checkVisibility()) continue;
    for (let box = node.parentElement; box && box !== node.offsetParent && box !== document.body; box = box.parentElement) {
      const { overflowX, overflowY } = getComputedStyle(box);
      if (/auto|scroll/.test(overflowX + overflowY)) strays.push(`${node.className} in ${box.id || box.className}`);
    }
  }
  return [...new Set(strays)];
}"""
FRAMES = """(count) => new Promise((done) => {
  const wait = () => (count-- > 0 ? requestAnimationFrame(wait) : done());
  wait();
})"""
WATCH = f"""() => {{
  window.seen = {{ beyond: 0, scrolled: 0, lines: 0, rows: 0 }};
  const look = () => {{
    seen.beyond = Math.max(seen.beyond, ({BEYOND})());
    seen.scrolled = Math.max(seen.scrolled, scrollY, document.body.scrollTop);
    seen.lines = Math.max(seen.lines, document.querySelectorAll("#log .line").length);
    seen.rows = Math.max(seen.rows, document.querySelectorAll("#tasks .task").length);
    requestAnimationFrame(look);
  }};
  look();
}}"""


def fill(fake, page, count=400):
    """Give the page more than it has room for, in every list. count: of the tasks that run."""
    waiting = [
        task(str(number), f"[PAR-CHILD-#{number}/{count}]", "top", "WAITING", "the fluent #<FLUENT GOAL>", "plan.lisp:3:5")
        for number in range(count)
    ]
    fake.tasks(task("top", "[TOP-LEVEL]"), *waiting)
    fake.fluents(*(fluent(f"f{number}", f"FLUENT-{number}", str(number), number) for number in range(100)))
    queue = ["#<MOTION ((TYPE DRIVING))>"] * 9
    fake.modules(*((f"MODULE-{number}", "RUNNING", "#<MOTION ((TYPE MOVING))>", queue) for number in range(20)))
    for number in range(200):
        fake.say(f"line {number} of a log that goes on and on, with some text in each of its lines")
    wait_for_text(page, "#log", "line 199")
    wait_for_count(page, "#tasks [role=treeitem]", count + 1)
    wait_for_text(page, "#fluents", "FLUENT-99")
    page.evaluate(FRAMES, 2)


NOW_IN_SIGHT = """(key) => {
  const list = document.getElementById("tasks").getBoundingClientRect();
  const row = document.querySelector(`#tasks [data-key=${key}]`)?.getBoundingClientRect();
  return row && row.top >= list.top - 1 && row.bottom <= list.bottom + 1;
}"""


def scroll_top(page, name):
    return page.evaluate("(name) => document.getElementById(name).scrollTop", name)


def wheel(page, selector, by):
    """Turn the wheel above the middle of what is seen of an element, and wait until the page has heard of it."""
    page.evaluate("() => { window.wheels = 0; addEventListener('wheel', () => { wheels += 1; }, { once: true, passive: true }); }")
    box = page.locator(selector).bounding_box()
    height = page.viewport_size["height"]
    page.mouse.move(box["x"] + box["width"] / 2, min(max(box["y"], 0) + 20, height - 5))
    page.mouse.wheel(0, by)
    page.wait_for_function("() => window.wheels > 0")


def swipe(page, x, y, by, steps=10):
    """Draw a finger over the glass; a negative BY draws it up, so that what is below comes."""
    session = page.context.new_cdp_session(page)
    session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [{"x": x, "y": y}]})
    for step in range(1, steps + 1):
        session.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": [{"x": x, "y": y + by * step / steps}]})
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    session.detach()


REACHED = """() => {
  const lost = [];
  for (const node of document.querySelectorAll("button, select, input, canvas, [tabindex='0']")) {
    if (node.disabled || !node.checkVisibility()) continue;
    node.focus();
    const { left, right, top, bottom } = node.getBoundingClientRect();
    const [x, y] = [Math.max(left, 0) + Math.min(right, innerWidth), Math.max(top, 0) + Math.min(bottom, innerHeight)];
    const seen = document.elementFromPoint(x / 2, y / 2);
    if (!node.contains(seen)) lost.push(`${node.id || node.textContent.trim()} is behind ${seen?.id || seen?.className}`);
  }
  return lost;
}"""


@pytest.mark.soak
@pytest.mark.parametrize("letters", ["usual", "twice as large", "a projector's"])
def test_the_document_is_as_high_as_the_window_and_every_control_can_be_reached(fake, visit, letters):
    page = visit(fake.address)
    fill(fake, page, 60)
    if letters == "twice as large":
        page.evaluate("() => { document.documentElement.style.fontSize = '187.5%'; }")
    elif letters == "a projector's":
        page.locator("#projector").click()
    for width, height in [*SIZES.values(), *OTHER_SIZES]:
        page.set_viewport_size({"width": width, "height": height})
        page.evaluate(FRAMES, 2)
        assert page.evaluate(BEYOND) == 0, (width, height)
        for name in ("Turtle", "Log", "Tasks"):
            if show(page, name):
                page.evaluate(FRAMES, 1)
            assert page.evaluate(BEYOND) == 0, (width, height, name)
            if letters == "usual" or height > 300:
                assert page.evaluate(REACHED) == [], (width, height, name)


@pytest.mark.soak
def test_what_is_placed_in_a_list_scrolls_with_the_list(fake, visit):
    page = visit(fake.address)
    fill(fake, page, 60)
    page.evaluate("() => { for (const node of document.querySelectorAll('[hidden]')) node.hidden = false; }")
    for width, height in SIZES.values():
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate(STRAYS) == []


@pytest.mark.soak
def test_the_wheel_scrolls_a_list_and_never_the_page(fake, visit):
    page = visit(fake.address, *SIZES["desktop"])
    fill(fake, page, 60)
    page.evaluate(WATCH)
    for name in LISTS:
        wheel(page, f"#{name}", -100_000)
        page.wait_for_function("(name) => document.getElementById(name).scrollTop === 0", arg=name)
        wheel(page, f"#{name}", 300)
        page.wait_for_function("(name) => document.getElementById(name).scrollTop > 0", arg=name)
        for _ in range(3):  # past its end
            wheel(page, f"#{name}", 100_000)
        page.wait_for_function(
            """(name) => {
          const { scrollTop, clientHeight, scrollHeight } = document.getElementById(name);
          return scrollHeight - scrollTop - clientHeight < 2;
        }""",
            arg=name,
        )
    for beside in ("#paper", ".bar", ".transport", ".panel.tasks h2"):
        for _ in range(3):
            wheel(page, beside, 5000)
    page.evaluate(FRAMES, 20)
    assert page.evaluate("() => [seen.scrolled, seen.beyond]") == [0, 0]


@pytest.mark.soak
@pytest.mark.parametrize("size", ["tablet", "phone"])
@pytest.mark.parametrize("hand", ["wheel", "finger"])
def test_on_a_small_screen_lists_scroll_and_the_page_does_not(fake, visit, size, hand):
    width, height = SIZES[size]
    page = visit(fake.address, width, height, has_touch=True, is_mobile=True)
    fill(fake, page, 60)
    page.evaluate(WATCH)
    page.locator("#follow").click()  # nobody but us scrolls
    for name in LISTS:
        assert show(page, name.capitalize())
        page.evaluate("(name) => { document.getElementById(name).scrollTop = 0; }", name)
        box = page.locator(f"#{name}").bounding_box()
        for x, y in ((4, height / 2), (width / 2, height - 20), (width / 2, 20)):  # beside the list
            if hand == "wheel":
                page.mouse.move(x, y)
                page.mouse.wheel(0, 2000)
            else:
                swipe(page, x, y, -height * 0.4)
        assert scroll_top(page, name) == 0
        if hand == "wheel":
            wheel(page, f"#{name}", 300)
        else:
            swipe(page, box["x"] + box["width"] / 2, box["y"] + box["height"] * 0.8, -box["height"] * 0.7)
        page.wait_for_function("(name) => document.getElementById(name).scrollTop > 40", arg=name)
    page.evaluate(FRAMES, 5)
    assert page.evaluate("() => [seen.scrolled, seen.beyond]") == [0, 0]


@pytest.mark.soak
@pytest.mark.parametrize("size", SIZES)
def test_the_focus_is_not_lost_when_its_row_ends(fake, visit, size):
    page = visit(fake.address, *SIZES[size])
    fill(fake, page)
    page.locator("#tasks [role=treeitem]").nth(5).click()
    assert page.evaluate("() => document.activeElement.dataset.key") == "4"
    fake.tasks(removed=["4"])
    wait_for_count(page, "#tasks [role=treeitem]", 400)
    page.evaluate(FRAMES, 5)
    assert page.evaluate("() => document.activeElement.dataset.key") == "top"
    assert page.evaluate("() => scrollY") == 0


@pytest.mark.soak
def test_what_runs_now_is_in_sight_and_marked_until_somebody_scrolls(fake, visit):
    page = visit(fake.address, *SIZES["desktop"])
    ended = [task(f"e{number}", f"[STEP-{number}]", "top", "FAILED", ended=1.0) for number in range(60)]
    fake.tasks(task("top", "[TOP-LEVEL]"), *ended, task("now", "[PURSUE-CHILD-#1/2]", "top", waits_for="the fluent #<FLUENT GOAL>"))
    page.wait_for_function(NOW_IN_SIGHT, arg="now")
    assert page.locator("#tasks [aria-current=true] .name").all_text_contents() == ["[PURSUE-CHILD-#1/2]"]
    wait_for_text(page, "#doing", "[PURSUE-CHILD-#1/2]")
    wheel(page, "#tasks", -100_000)
    page.wait_for_function("() => document.getElementById('tasks').scrollTop === 0")
    assert page.locator("#follow").get_attribute("aria-pressed") == "false"
    fake.tasks(task("now", "[PURSUE-CHILD-#1/2]", "top", "SUCCEEDED", ended=2.0), task("next", "[STEP]", "top", began=2.0))
    wait_for_text(page, "#tasks", "[STEP]")
    page.evaluate(FRAMES, 5)
    assert scroll_top(page, "tasks") == 0  # it stays where it was put
    page.locator("#follow").click()
    page.wait_for_function(NOW_IN_SIGHT, arg="next")
    assert page.locator("#tasks [aria-current=true] .name").all_text_contents() == ["[STEP]"]


# ------------------------------------------------------------------------------------------------------ with a real plan

LONG_PLAN = """\
(cpl:top-level
  (cpl:par-loop (i (loop for i below 120 collect i))
    (dotimes (step 100000)
      (roslisp:ros-info (long plan) "Branch ~a is at step ~a of a very long plan." i step)
      (cpl:sleep (+ 0.5 (* i 0.01))))))"""


@pytest.mark.soak
def test_during_a_long_plan_no_size_scrolls_away(repl, visit):
    """The plan of a real session, with 120 branches that all log, on three pages at once, each with its wheel."""
    session = repl("--time", "virtual")
    pages = {size: visit(session.url, *SIZES[size]) for size in SIZES}
    session.type('(roslisp:start-ros-node "long")')
    session.type(LONG_PLAN)
    for page in pages.values():
        wait_for_text(page, "#log", "Branch 119 is at step")
        page.evaluate(WATCH)
    for turn in range(6):
        for page in pages.values():
            name = "tasks" if turn % 2 else "log"
            show(page, name.capitalize())
            wheel(page, f"#{name}", 700 if turn % 3 else -400)
            page.mouse.move(4, 300)
            page.mouse.wheel(0, 3000)
    for size, page in pages.items():
        page.wait_for_function("() => seen.lines >= 500 && seen.rows >= 100")
        seen = page.evaluate("() => seen")
        assert (seen["beyond"], seen["scrolled"]) == (0, 0), size
    session.process.send_signal(signal.SIGINT)
