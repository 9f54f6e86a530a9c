"""The page in a real Chromium, with a session that says what the test wants: what it shows, and what it sends."""

from __future__ import annotations

import pytest
from fake_session import MIDDLE, fluent, stroke, task, turtle

PIXEL = """([x, y]) => {
  const canvas = document.getElementById("paper");
  const side = canvas.width;
  const [column, row] = [(x * 45 + 0.5) / 500 * side, (499 - y * 45 + 0.5) / 500 * side];
  return Array.from(canvas.getContext("2d").getImageData(Math.round(column), Math.round(row), 1, 1).data.slice(0, 3));
}"""
READING = "(name) => document.querySelector(`[data-reading=${name}]`).textContent"
BLUE = [69, 86, 255]


def pixel(page, x, y):
    """The colour that is seen at a place of the world."""
    return page.evaluate(PIXEL, [x, y])


def near(colour, other):
    """Whether two colours look alike: the picture is scaled to the screen."""
    return all(abs(one - two) <= 3 for one, two in zip(colour, other))


def wait_for_pixel(page, x, y, colour):
    page.wait_for_function(
        f"([place, colour]) => ({PIXEL})(place).every((part, index) => Math.abs(part - colour[index]) <= 3)", arg=[[x, y], colour]
    )


def wait_for_text(page, selector, text):
    page.wait_for_function("([selector, text]) => document.querySelector(selector)?.textContent.includes(text)", arg=[selector, text])


def wait_for_reading(page, name, text):
    page.wait_for_function(f"([name, text]) => ({READING})(name) === text", arg=[name, text])


def wait_for_texts(page, selector, texts):
    """Wait until the elements are seen that have these texts, and no others."""
    page.wait_for_function(
        """([selector, texts]) => JSON.stringify([...document.querySelectorAll(selector)]
        .filter((node) => node.checkVisibility()).map((node) => node.textContent)) === JSON.stringify(texts)""",
        arg=[selector, texts],
    )


def wait_for_count(page, selector, count):
    page.wait_for_function("([selector, count]) => document.querySelectorAll(selector).length === count", arg=[selector, count])


def show(page, name):
    """Choose a panel where there is room for one only; whether that is so."""
    button = page.locator("#tabs").get_by_role("button", name=name, exact=True)
    if not button.is_visible():
        return False
    button.click()
    return True


def rows(page, attributes=("name", "time", "waits", "place")):
    """The rows of the task tree, as (level, the texts of their parts)."""
    return page.evaluate(
        """(parts) => [...document.querySelectorAll("#tasks [role=treeitem]")].map((row) =>
        [Number(row.getAttribute("aria-level")), ...parts.map((part) => row.querySelector(`.${part}`)?.textContent ?? "")])""",
        list(attributes),
    )


# --------------------------------------------------------------------------------------------------------------- the world


@pytest.mark.soak
def test_the_turtle_moves_and_the_read_out_follows(fake, visit):
    page = visit(fake.address)
    wait_for_reading(page, "x", "5.54")
    fake.drive(50, speed=2.0)
    wait_for_reading(page, "x", "7.14")
    wait_for_reading(page, "speed", "2.00")
    assert near(pixel(page, MIDDLE, MIDDLE), [179, 184, 255])
    assert near(pixel(page, 9.0, 9.0), BLUE)


@pytest.mark.soak
def test_the_line_has_the_colour_and_the_width_of_the_pen(fake, visit):
    page = visit(fake.address)
    red = (255, 0, 0)
    fake.world([turtle(x=10.0, y=10.0)], [stroke(2, 2, 6, 2, red, 10), stroke(2, 4, 6, 4, (0, 255, 0), 1)])
    wait_for_pixel(page, 4, 2, list(red))
    assert all(near(pixel(page, 4, 2 + offset), red) for offset in (4 / 45, -4 / 45))
    assert all(near(pixel(page, 4, 2 + offset), BLUE) for offset in (7 / 45, -7 / 45))


@pytest.mark.soak
def test_a_clean_paper_has_its_own_colour(fake, visit):
    page = visit(fake.address)
    fake.world([turtle(x=10, y=10)], [stroke(1, 1, 9, 1, (255, 0, 0), 9)])
    wait_for_pixel(page, 4, 1, [255, 0, 0])
    fake.world([turtle(x=10, y=10)], [stroke(1, 5, 9, 5, (0, 0, 0), 9)], cleared=(20, 120, 40))
    wait_for_pixel(page, 4, 1, [20, 120, 40])
    assert near(pixel(page, 4, 5), [0, 0, 0])


def test_who_comes_late_sees_all_that_was_drawn(fake, visit):
    fake.world([turtle(x=10, y=10)], [stroke(1, 1, 9, 1, (255, 0, 0), 9)])
    page = visit(fake.address)
    wait_for_pixel(page, 4, 1, [255, 0, 0])


@pytest.mark.soak
def test_the_turtle_turns_with_its_heading(fake, visit):
    page = visit(fake.address)
    fake.world([turtle(x=5, y=5, theta=0.0)])
    wait_for_reading(page, "x", "5.00")
    page.wait_for_function(f"() => JSON.stringify(({PIXEL})([5.38, 5])) !== '{BLUE}'.replaceAll(' ', '')")
    assert near(pixel(page, 5.0, 4.56), BLUE)  # beside it, between its feet
    fake.world([turtle(x=5, y=5, theta=-1.5707963)])
    page.wait_for_function(f"() => JSON.stringify(({PIXEL})([5, 4.62])) !== '{BLUE}'.replaceAll(' ', '')")  # now the head is there


@pytest.mark.soak
def test_several_turtles_have_names_and_one_is_chosen(fake, visit):
    page = visit(fake.address)
    assert not page.locator("#turtles").is_visible()
    fake.world([turtle("turtle1", 2, 2), turtle("turtle2", 8, 8, picture=3)])
    page.get_by_role("radio", name="turtle2").click()
    wait_for_reading(page, "x", "8.00")
    page.keyboard.press("ArrowLeft")  # within the choice of turtles arrows choose
    wait_for_reading(page, "x", "2.00")
    box = page.locator("#paper").bounding_box()
    page.mouse.click(box["x"] + box["width"] * 8 * 45 / 500, box["y"] + box["height"] * (499 - 8 * 45) / 500)
    wait_for_reading(page, "x", "8.00")
    page.locator("#paper").press("ArrowUp")
    fake.wait(lambda message: message["op"] == "publish" and message["topic"] == "/turtle2/cmd_vel")
    fake.world([turtle("turtle1", 2, 2)])  # turtle2 was killed
    wait_for_reading(page, "x", "2.00")


@pytest.mark.soak
def test_turtles_stand_in_the_order_of_their_numbers_and_the_chosen_one_is_in_sight(fake, visit):
    page = visit(fake.address)
    names = [f"a{number}" for number in range(1, 13)]
    fake.world(sorted((turtle(name) for name in (*names, "turtle1")), key=lambda one: one["name"]))
    wait_for_count(page, "#turtles [role=radio]", 13)
    assert page.locator("#turtles [role=radio]").all_text_contents() == [*names, "turtle1"]
    page.wait_for_function("""() => {
        const list = document.querySelector('#turtles'), chosen = list.querySelector('[aria-checked=true]');
        return chosen.textContent === 'turtle1' && list.scrollLeft > 0
            && chosen.getBoundingClientRect().right <= list.getBoundingClientRect().right + 1;
    }""")


@pytest.mark.soak
def test_a_pose_that_is_no_number_is_said_and_hurts_nobody(fake, visit):
    page = visit(fake.address)
    fake.world([{**turtle(), "x": None, "y": None, "theta": None}])
    wait_for_reading(page, "x", "NaN")
    wait_for_pixel(page, 0.1, 0.1, BLUE)  # it is nowhere, also not in the corner
    fake.world([turtle(x=3, y=3)])
    wait_for_reading(page, "x", "3.00")


PAPERS = """async () => {
  const [{ Paper }, { Strokes }] = await Promise.all([import("/paper.js"), import("/strokes.js")]);
  const [all, some] = [new Strokes(Infinity), new Strokes(100)];
  const [whole, paper] = [new Paper(all), new Paper(some)];
  const line = (at) => ({ x1: at % 11, y1: 0, x2: 11 - at % 11, y2: 11, r: at % 256, g: 200, b: 100, width: 1 + at % 9 });
  const looked = []; // at the past, while the present goes on
  for (let at = 0; at < 1000; at++) {
    const message = { stamp: at, clears: at < 700 ? 1 : 2, r: 69, g: 86, b: 255, strokes: [line(at)] };
    all.add(message);
    some.add(message);
    if (some.full) paper.settle();
    if (at % 150 === 40) looked.push(paper.show(some.at(at - 10).strokes, some.at(at - 10).epoch));
  }
  const seen = (strokes, one) => {
    const { strokes: end, epoch } = strokes.at(1000);
    one.show(end, epoch);
    return one.pen.getImageData(0, 0, 1000, 1000).data;
  };
  const [expected, found] = [seen(all, whole), seen(some, paper)];
  return [looked.every(Boolean), some.length <= 100, expected.every((part, index) => Math.abs(part - found[index]) <= 2)];
}"""


@pytest.mark.soak
def test_of_very_many_lines_the_oldest_become_a_picture_also_while_the_past_is_looked_at(fake, visit):
    assert visit(fake.address).evaluate(PAPERS) == [True, True, True]


# -------------------------------------------------------------------------------------------------------------- driving


@pytest.mark.soak
@pytest.mark.parametrize(
    ("key", "linear", "angular"), [("ArrowUp", 2, 0), ("ArrowDown", -2, 0), ("ArrowLeft", 0, 2), ("ArrowRight", 0, -2)]
)
def test_the_arrow_keys_drive(fake, visit, key, linear, angular):
    page = visit(fake.address)
    page.keyboard.press(key)
    fake.wait(lambda message: message == {"op": "advertise", "topic": "/turtle1/cmd_vel", "type": "geometry_msgs/Twist"})
    sent = fake.wait(lambda message: message["op"] == "publish")
    assert sent["topic"] == "/turtle1/cmd_vel"
    assert sent["msg"] == {"linear": {"x": linear, "y": 0, "z": 0}, "angular": {"x": 0, "y": 0, "z": angular}}


@pytest.mark.soak
def test_turtles_are_driven_in_the_namespace_of_their_simulator_as_its_parameters_say(fake, visit):
    parameters = {"/house/scale_linear": "1.5", "/house/scale_angular": '"fast"'}
    fake.services["/rosapi/get_param"] = lambda request: {"value": parameters.get(request["name"], request["default"])}

    def refuse(request):
        raise ValueError("no paper")

    fake.services["/house/clear"] = refuse
    fake.state["world"]["simulator"] = "/house/sim"
    page = visit(fake.address)
    page.get_by_role("button", name="Clear paper").click()
    wait_for_text(page, "#notice", "no paper")  # and the answers that came before it have been heard
    page.keyboard.press("ArrowUp")
    page.keyboard.press("ArrowLeft")
    fake.wait(lambda message: message["op"] == "publish" and message["msg"]["angular"]["z"] == 2)
    sent = fake.wait(lambda message: message["op"] == "publish")
    assert (sent["topic"], sent["msg"]["linear"]["x"]) == ("/house/turtle1/cmd_vel", 1.5)


@pytest.mark.soak
def test_a_key_that_is_held_repeats(fake, visit):
    page = visit(fake.address)
    for _ in range(5):  # what the keyboard sends while a key is held
        page.keyboard.down("ArrowUp")
    page.keyboard.up("ArrowUp")
    fake.wait(lambda message: len([one for one in fake.heard if one["op"] == "publish"]) == 5)


@pytest.mark.soak
def test_a_button_that_is_held_repeats_until_it_is_let_go(fake, visit):
    page = visit(fake.address)
    page.get_by_role("button", name="turn left").hover()
    page.mouse.down()
    count = lambda: len([one for one in fake.heard if one["op"] == "publish"])  # noqa: E731
    fake.wait(lambda message: count() >= 4)
    page.mouse.up()
    page.evaluate("() => new Promise((done) => setTimeout(done, 0))")
    page.keyboard.press("ArrowUp")
    fake.wait(lambda message: message["op"] == "publish" and message["msg"]["linear"]["x"] == 2)
    sent = count()
    page.evaluate("() => new Promise((done) => setTimeout(done, 200))")  # four repetitions long
    assert count() == sent


@pytest.mark.soak
def test_clear_and_reset_call_their_services_and_say_what_went_wrong(fake, visit):
    page = visit(fake.address)
    page.get_by_role("button", name="Clear paper").click()
    assert fake.wait_for_call("/clear") == {}

    def refuse(request):
        raise ValueError("Service /reset is not there.")

    fake.services["/reset"] = refuse
    page.get_by_role("button", name="Reset world").click()
    wait_for_text(page, "#notice", "Service /reset is not there.")


# -------------------------------------------------------------------------------------------- tasks, fluents, modules, log


def par(fake):
    """The tasks of the par form on the slides."""
    fake.tasks(
        task("1", "[TOP-LEVEL]", waits_for="the branches of PAR", place="<repl 3>:3:9"),
        task("2", "[PAR-CHILD-#1/2]", "1", waits_for="the fluent #<FLUENT DONE [NIL]>", place="<repl 3>:4:13"),
        task("3", "[PAR-CHILD-#2/2]", "1", waits_for="the time 2 s (sleep 0.5)", place="/a/folder/plans.lisp:13:15"),
    )


def test_the_task_tree_shows_what_each_task_does(fake, visit):
    page = visit(fake.address)
    wait_for_text(page, "#no-tasks", "No plan has run yet.")
    fake.stamp = 1.5
    par(fake)
    wait_for_text(page, "#tasks", "PAR-CHILD-#2/2")
    assert rows(page) == [
        [1, "[TOP-LEVEL]", "1.50 s", "waits for the branches of PAR", "<repl 3>:3:9"],
        [2, "[PAR-CHILD-#1/2]", "1.50 s", "waits for the fluent #<FLUENT DONE [NIL]>", "<repl 3>:4:13"],
        [2, "[PAR-CHILD-#2/2]", "1.50 s", "waits for the time 2 s (sleep 0.5)", "plans.lisp:13:15"],
    ]
    wait_for_text(page, "#tasks-count", "3 alive, 0 ended")
    fake.tasks(task("3", "[PAR-CHILD-#2/2]", "1", "FAILED", began=0, ended=1.5, result="SIMPLE-PLAN-FAILURE: no way"))
    wait_for_text(page, "#tasks", "failed with SIMPLE-PLAN-FAILURE: no way")
    fake.tasks(removed=["2", "3"])
    wait_for_count(page, "#tasks [role=treeitem]", 1)


@pytest.mark.soak
def test_a_branch_can_be_closed_and_stays_closed(fake, visit):
    page = visit(fake.address)
    par(fake)
    page.get_by_role("treeitem", name="TOP-LEVEL").first.click()
    wait_for_count(page, "#tasks [role=treeitem]", 1)
    fake.tasks(task("4", "[PAR-CHILD-#3/3]", "1"))
    wait_for_text(page, "#tasks-count", "4 alive")
    assert len(rows(page)) == 1


@pytest.mark.soak
def test_thousands_of_tasks_do_not_stop_the_page(fake, visit):
    page = visit(fake.address)
    children = [task(str(number), f"[CHILD-{number}]", "top", "SUCCEEDED", ended=1.0) for number in range(3000)]
    fake.tasks(task("top", "[TOP-LEVEL]"), *children)
    wait_for_text(page, "#tasks-count", "1 alive, 3000 ended")
    assert len(rows(page)) == 3  # the plan, its newest, and a line for the others
    page.get_by_text("2,999 tasks more that ended").click()
    wait_for_count(page, "#tasks [role=treeitem]", 500)
    page.get_by_text("2,999 tasks more that ended").click()
    wait_for_count(page, "#tasks [role=treeitem]", 3)


@pytest.mark.soak
def test_fluents_have_their_values_and_a_line_of_the_recent_past(fake, visit):
    page = visit(fake.address)
    fake.fluents(fluent("1", "DISTANCE", "3.5", 3.5), fluent("2", "POSE", "x 1 y 2"))
    wait_for_text(page, "#fluents", "x 1 y 2")
    fake.stamp = 10.0
    fake.fluents(fluent("1", "DISTANCE", "1.25", 1.25))
    wait_for_text(page, "#fluents", "1.25")
    page.wait_for_function("() => document.querySelector('#fluents .drawn path').getAttribute('d') === 'M60.0 0.0H120.0V22.0H120'")
    assert page.locator("#fluents .spark:visible").count() == 1
    fake.fluents(removed=["1"])
    wait_for_count(page, "#fluents .fluent", 1)


@pytest.mark.soak
def test_process_modules_have_what_they_execute_and_their_queue(fake, visit):
    page = visit(fake.address)
    wait_for_text(page, "#modules", "No process module is running.")
    fake.modules(
        ("NAVIGATION", "RUNNING", "#<MOTION ((TYPE MOVING))>", ["#<MOTION ((TYPE DRIVING))>"] * 11), ("PEN-CONTROL", "WAITING", "", [])
    )
    wait_for_text(page, "#modules", "#<MOTION ((TYPE MOVING))>")
    assert page.locator("#modules .queue li").all_text_contents() == ["#<MOTION ((TYPE DRIVING))>"] * 8 + ["3 requests more"]
    wait_for_text(page, "#modules .module:nth-child(2)", "executes nothing")


@pytest.mark.soak
def test_the_log_has_the_levels_that_are_wanted(fake, visit):
    page = visit(fake.address)
    for level, text in ((1, "a detail"), (2, "as usual"), (4, "Oh no! I hit the wall!"), (8, "broken"), (16, "over")):
        fake.say(text, level)
    wait_for_text(page, "#log", "over")
    shown = lambda: page.locator("#log .line:visible .text").all_text_contents()  # noqa: E731
    assert shown() == ["as usual", "Oh no! I hit the wall!", "broken", "over"]
    page.locator("#level").select_option("errors")
    assert shown() == ["broken", "over"]
    page.locator("#level").select_option("debug")
    assert shown()[0] == "a detail"
    for number in range(1500):
        fake.say(f"line {number}")
    wait_for_text(page, "#log", "line 1499")
    assert page.locator("#log .line").count() <= 600
    page.wait_for_function("""() => {
      const { scrollTop, clientHeight, scrollHeight } = document.getElementById("log");
      return scrollHeight - scrollTop - clientHeight < 2;
    }""")
