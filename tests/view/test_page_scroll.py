"""The page never scrolls away: with long lists, a mouse wheel and fingers, at several sizes, the document ends where its content ends."""

from __future__ import annotations

import signal

import pytest
from fake_session import fluent, task
from test_page import wait_for_count, wait_for_text

SIZES = {"desktop": (1440, 900), "tablet": (820, 1180), "phone": (390, 844)}
OTHER_SIZES = [(1920, 1080), (1280, 720), (1000, 600), (1280, 400), (999, 700), (700, 1000), (320, 568)]
LISTS = ("tasks", "modules", "fluents", "log")
BEYOND = """() => Math.max(0, document.documentElement.scrollHeight
    - Math.max(innerHeight, Math.ceil(document.body.getBoundingClientRect().height)))"""
STRAYS = """() => {
  const strays = [];
  for (const node of document.querySelectorAll("*")) {
    if (getComputedStyle(node).position !== "absolute") continue;
    for (let box = node.parentElement; box && box !== node.offsetParent; box = box.parentElement) {
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
    seen.scrolled = Math.max(seen.scrolled, scrollY);
    seen.lines = Math.max(seen.lines, document.querySelectorAll("#log .line").length);
    seen.rows = Math.max(seen.rows, document.querySelectorAll("#tasks .task").length);
    requestAnimationFrame(look);
  }};
  look();
}}"""


def fill(fake, page):
    """Give the page more than it has room for, in every list."""
    waiting = [task(str(number), f"[PAR-CHILD-#{number}/400]", "top", "WAITING", "the fluent #<FLUENT GOAL>", "plan.lisp:3:5")
               for number in range(400)]
    fake.tasks(task("top", "[TOP-LEVEL]"), *waiting)
    fake.fluents(*(fluent(f"f{number}", f"FLUENT-{number}", str(number), number) for number in range(100)))
    queue = ["#<MOTION ((TYPE DRIVING))>"] * 9
    fake.modules(*((f"MODULE-{number}", "RUNNING", "#<MOTION ((TYPE MOVING))>", queue) for number in range(20)))
    for number in range(200):
        fake.say(f"line {number} of a log that goes on and on, with some text in each of its lines")
    wait_for_text(page, "#log", "line 199")
    wait_for_count(page, "#tasks [role=treeitem]", 401)
    wait_for_text(page, "#fluents", "FLUENT-99")
    page.evaluate(FRAMES, 2)


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


@pytest.mark.parametrize(("width", "height"), [*SIZES.values(), *OTHER_SIZES])
def test_the_document_ends_where_its_content_ends(fake, visit, width, height):
    page = visit(fake.address, width, height)
    fill(fake, page)
    assert page.evaluate(BEYOND) == 0
    assert page.evaluate("() => document.documentElement.scrollWidth") == width
    if width >= 1000:
        assert page.evaluate("() => document.documentElement.scrollHeight") == max(height, 600)


@pytest.mark.parametrize(("width", "height"), SIZES.values(), ids=SIZES)
def test_what_is_placed_in_a_list_scrolls_with_the_list(fake, visit, width, height):
    page = visit(fake.address, width, height)
    fill(fake, page)
    page.evaluate("() => { for (const node of document.querySelectorAll('[hidden]')) node.hidden = false; }")
    assert page.evaluate(STRAYS) == []


@pytest.mark.parametrize("name", LISTS)
def test_the_wheel_scrolls_a_list_and_never_the_page(fake, visit, name):
    page = visit(fake.address, *SIZES["desktop"])
    fill(fake, page)
    page.evaluate(WATCH)
    wheel(page, f"#{name}", -100_000)
    page.wait_for_function("(name) => document.getElementById(name).scrollTop === 0", arg=name)
    wheel(page, f"#{name}", 300)
    page.wait_for_function("(name) => document.getElementById(name).scrollTop > 0", arg=name)
    for _ in range(3):  # past its end
        wheel(page, f"#{name}", 100_000)
    page.wait_for_function("""(name) => {
      const { scrollTop, clientHeight, scrollHeight } = document.getElementById(name);
      return scrollHeight - scrollTop - clientHeight < 2;
    }""", arg=name)
    page.evaluate(FRAMES, 20)
    assert page.evaluate("() => [seen.scrolled, seen.beyond]") == [0, 0]


@pytest.mark.parametrize("selector", ["#paper", ".bar", ".transport", ".panel.tasks h2"])
def test_the_wheel_beside_the_lists_moves_nothing(fake, visit, selector):
    page = visit(fake.address, *SIZES["desktop"])
    fill(fake, page)
    page.evaluate(WATCH)
    for _ in range(3):
        wheel(page, selector, 5000)
    page.evaluate(FRAMES, 20)
    assert page.evaluate("() => [seen.scrolled, seen.beyond]") == [0, 0]


@pytest.mark.parametrize("size", ["tablet", "phone"])
@pytest.mark.parametrize("hand", ["wheel", "finger"])
def test_where_the_panels_stand_in_a_column_the_page_ends_with_the_last(fake, visit, size, hand):
    width, height = SIZES[size]
    page = visit(fake.address, width, height, has_touch=True, is_mobile=True)
    fill(fake, page)
    page.evaluate(WATCH)
    for _ in range(60):
        if hand == "wheel":
            page.mouse.move(4, height / 2)  # beside the lists
            page.mouse.wheel(0, 2000)
            page.evaluate(FRAMES, 20)
        else:
            swipe(page, 4, height * 0.7, -height * 0.5)
            page.evaluate(FRAMES, 30)
        if page.evaluate("() => scrollY + innerHeight >= document.documentElement.scrollHeight - 1"):
            break
    ends = page.evaluate("""() => ({ log: document.querySelector(".panel.log").getBoundingClientRect().bottom,
                                    transport: document.querySelector(".transport").getBoundingClientRect().top })""")
    assert 0 < ends["log"] <= ends["transport"] <= height
    assert page.evaluate("() => seen.beyond") == 0


def test_a_finger_scrolls_a_list(fake, visit):
    page = visit(fake.address, *SIZES["phone"], has_touch=True, is_mobile=True)
    fill(fake, page)
    page.evaluate("() => document.getElementById('tasks').scrollIntoView({ block: 'center' })")
    page.evaluate(FRAMES, 2)
    box = page.locator("#tasks").bounding_box()
    before = page.evaluate("() => scrollY")
    swipe(page, box["x"] + box["width"] / 2, box["y"] + box["height"] * 0.7, -200)
    page.wait_for_function("() => document.getElementById('tasks').scrollTop > 100")
    assert page.evaluate("() => scrollY") == before


@pytest.mark.parametrize("size", SIZES)
def test_the_page_stays_where_it_is_when_the_row_with_the_focus_ends(fake, visit, size):
    page = visit(fake.address, *SIZES[size])
    fill(fake, page)
    page.locator("#tasks [role=treeitem]").nth(5).click()
    assert page.evaluate("() => document.activeElement.dataset.key") == "4"
    page.evaluate("() => scrollTo(0, document.body.scrollHeight)")
    page.evaluate(FRAMES, 2)
    before = page.evaluate("() => scrollY")
    assert (before > 500) == (size != "desktop")
    fake.tasks(removed=["4"])
    wait_for_count(page, "#tasks [role=treeitem]", 400)
    page.evaluate(FRAMES, 5)
    assert page.evaluate("() => document.activeElement.dataset.key") == "top"  # the focus is not lost
    assert page.evaluate("() => scrollY") == before


# ------------------------------------------------------------------------------------------------------ with a real plan

LONG_PLAN = """\
(cpl:top-level
  (cpl:par-loop (i (loop for i below 120 collect i))
    (dotimes (step 100000)
      (roslisp:ros-info (long plan) "Branch ~a is at step ~a of a very long plan." i step)
      (cpl:sleep (+ 0.5 (* i 0.01))))))"""


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
            wheel(page, "#tasks" if turn % 2 else "#log", 700 if turn % 3 else -400)
            page.mouse.move(4, 300)
            page.mouse.wheel(0, 3000)
    for size, page in pages.items():
        page.wait_for_function("() => seen.lines >= 500 && seen.rows >= 100")
        seen = page.evaluate("() => seen")
        assert seen["beyond"] == 0, size
        if size == "desktop":
            assert seen["scrolled"] == 0
        assert page.evaluate("() => document.querySelector('main').getBoundingClientRect().bottom") > 0
    session.process.send_signal(signal.SIGINT)
