"""The page of a real session, from the prompt to the picture: a REPL with ``--view`` in a process of its own, and Chromium."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from test_page import READING, rows, wait_for_pixel, wait_for_reading, wait_for_text
from test_page_time import seek

COURSE = """(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)
(in-package :tut)
(start-ros-node "turtle1")
(init-ros-turtle "turtle1")"""
PAR = """\
(top-level
  (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
    (let ((goal (desig:a motion (type moving) (goal (9 9 0)))))
      (cpl:par
        (pm-execute 'turtlesim-navigation goal)
        (dotimes (i 4)
          (pm-execute 'turtlesim-pen-control
            (let ((?r (if (evenp i) 255 0)))
              (desig:a motion (type setting-pen) (r ?r) (g 40) (b 0) (width 8))))
          (sleep 0.5))))))"""


def plan_time(page, doing):
    """What the page's clock shows, in seconds, once it says that time stands still because of ``doing``; it draws both at once."""
    wait_for_text(page, "#doing", doing)
    return page.evaluate("() => parseFloat(document.getElementById('clock').textContent)")


def step(page, seconds):
    """Let that much time pass and wait until the clock shows it; the step size is set already."""
    stood = plan_time(page, "paused")
    page.get_by_role("button", name="Step").click()
    page.wait_for_function("(end) => Math.abs(parseFloat(document.getElementById('clock').textContent) - end) < 0.02", arg=stood + seconds)


@pytest.fixture
def course(repl, visit):
    """The REPL with the course's package, and its page."""
    session = repl("--time", "virtual")
    page = visit(session.url)
    session.type(COURSE)
    wait_for_reading(page, "x", "5.54")
    session.type('"ready"')
    session.wait_for('"ready"')
    wait_for_text(page, "#doing", "the prompt waits")
    return session, page


@pytest.mark.soak
def test_the_par_example_of_the_slides_is_seen_and_can_be_looked_back_at(course):
    session, page = course
    page.get_by_role("button", name="Pause").click()
    begin = plan_time(page, "paused")
    session.type(PAR)
    wait_for_text(page, "#tasks", "PAR-CHILD-#2/2")
    page.locator("#step-size").select_option("0.1 s")
    for _ in range(3):  # time passes by steps only, so that what is looked for stays until it was seen
        step(page, 0.1)
    wait_for_text(page, "#modules", "(GOAL (9 9 0))")
    wait_for_text(page, "#log", "TurtleSim pen control invoked with motion designator")
    wait_for_text(page, "#tasks", "(sleep 0.5)")
    shown = {row[1]: row[2:] for row in rows(page)}
    assert shown["[TOP-LEVEL]"][1] == "waits for the branches of PAR"
    assert shown["[PAR-CHILD-#2/2]"][1].endswith("(sleep 0.5)") and shown["[PAR-CHILD-#2/2]"][2] == "<repl 6>:10:11"
    assert "[TURTLESIM-NAVIGATION]" in shown
    page.locator("#speed").select_option("× 0.1")
    page.get_by_role("button", name="Resume").click()
    wait_for_text(page, "#doing", "a form runs")
    page.locator("#speed").select_option("unbounded")
    session.wait_for("\nT\nTUT> ")
    wait_for_text(page, "#tasks-count", "0 alive")
    wait_for_text(page, "#modules", "No process module is running.")
    wait_for_pixel(page, 6.0, 6.0, [255, 40, 0])
    seek(page, begin + 0.3)  # the turtle has driven half a metre
    wait_for_text(page, "#past", "as it was at")
    wait_for_pixel(page, 8.5, 8.5, [69, 86, 255])  # it is drawn with the next frame
    page.get_by_role("button", name="Live").click()
    session.type("(call-set-pen 0 0 0 1 0)")
    wait_for_reading(page, "pen", "1 px")


def test_the_keys_drive_the_turtle_while_the_prompt_waits(course):
    session, page = course
    page.keyboard.press("ArrowUp")
    wait_for_text(page, "#notice", "Virtual time stands still while the prompt waits. Step lets some of it pass.")
    session.type("(sleep 1.5)")
    page.wait_for_function("() => parseFloat(document.querySelector('[data-reading=x]').textContent) > 7.5")
    page.get_by_role("button", name="Clear paper").click()
    wait_for_pixel(page, 6.5, 5.544, [69, 86, 255])
    wait_for_text(page, "#log", "Clearing turtlesim.")
    page.get_by_role("button", name="Reset world").click()
    wait_for_reading(page, "x", "5.54")
    assert page.locator("#notice").get_attribute("data-kind") == "good"


@pytest.mark.soak
def test_a_step_moves_the_clock_though_nothing_else_happens(course):
    session, page = course
    page.get_by_role("button", name="Pause").click()
    page.locator("#step-size").select_option("1 s")
    step(page, 1)


@pytest.mark.soak
def test_a_page_that_comes_late_sees_what_was_before(course, visit):
    session, page = course
    session.type("(drive 2 2)\n(sleep 0.5)\n(call-set-pen 255 0 0 5 0)\n(drive 2 0)\n(sleep 1.5)")
    wait_for_reading(page, "pen", "5 px")
    wait_for_reading(page, "speed", "0.00")  # a second after the last command
    late = visit(session.url)
    wait_for_reading(late, "speed", "0.00")
    x = late.evaluate(READING, "x")
    wait_for_reading(page, "x", x)
    late.wait_for_function("() => Number(document.getElementById('moment').max) - Number(document.getElementById('moment').min) >= 1.9")
    seek(late, 0.5)
    late.wait_for_function("(x) => document.querySelector('[data-reading=x]').textContent !== x", arg=x)
    wait_for_reading(late, "pen", "3 px")


@pytest.mark.soak
def test_in_wall_time_the_turtle_moves_and_cannot_be_paused(repl, visit):
    session = repl("--time", "wall")
    page = visit(session.url)
    session.type('(roslisp:start-ros-node "wall")')
    wait_for_reading(page, "x", "5.54")
    page.keyboard.press("ArrowUp")
    page.wait_for_function("() => parseFloat(document.querySelector('[data-reading=x]').textContent) > 7.0")
    wait_for_reading(page, "speed", "0.00")  # it stops by itself, a second later
    assert page.locator("#pause").is_disabled()


@pytest.mark.soak
def test_when_the_session_ends_the_page_says_so(repl, visit):
    session = repl("--time", "virtual")
    page = visit(session.url)
    page.foresee("WebSocket connection to")
    session.type("(quit)")
    wait_for_text(page, "#connection", "connection lost")


@pytest.mark.soak
def test_a_session_that_is_stopped_is_said_to_be_lost_and_shown_again_when_it_goes_on(repl, visit):
    session = repl("--time", "wall")
    page = visit(session.url)
    page.foresee("WebSocket connection to")
    session.type('(roslisp:start-ros-node "wall")')
    wait_for_reading(page, "x", "5.54")
    page.keyboard.press("ArrowUp")
    page.wait_for_function("() => parseFloat(document.querySelector('[data-reading=x]').textContent) > 7.0")
    wait_for_reading(page, "speed", "0.00")
    x = page.inner_text("[data-reading=x]")
    session.process.send_signal(signal.SIGSTOP)
    page.wait_for_selector("#connection[data-state=lost]")
    wait_for_text(page, "#banner", "The connection to the session is lost. Trying again; what you see is the last that was heard.")
    assert page.inner_text("[data-reading=x]") == x
    session.process.send_signal(signal.SIGCONT)
    page.wait_for_selector("#connection[data-state=open]")
    wait_for_reading(page, "x", x)
    page.keyboard.press("ArrowUp")
    page.wait_for_function("(x) => document.querySelector('[data-reading=x]').textContent !== x", arg=x)


@pytest.mark.soak
def test_another_session_on_the_port_of_one_that_was_killed_is_not_mistaken_for_it(repl, visit):
    session = repl("--time", "wall")
    page = visit(session.url)
    page.foresee("WebSocket connection to")
    port = session.url.partition("127.0.0.1:")[2].partition("/")[0]
    session.process.kill()
    session.process.wait()
    page.wait_for_selector("#connection[data-state=lost]")
    other = repl("--time", "wall", "--port", port)
    wait_for_text(
        page,
        "#banner",
        "The session does not let this page in: The first message must be "
        '{"op": "auth", "token": "..."} with the token of this session. '
        "Open the address that it prints; it has a new token each time.",
    )
    visit(other.url)


@pytest.mark.soak
@pytest.mark.parametrize("way", ["silent", "no token", "half a request"])
def test_the_page_comes_though_strangers_take_all_the_connections_they_can_get(repl, visit, way):
    session = repl("--time", "wall")
    port = session.url.partition("127.0.0.1:")[2].partition("/")[0]
    stranger = Path(__file__).parents[1] / "rosbridge" / "strangers.py"
    program = subprocess.Popen([sys.executable, str(stranger), port, way, "300"], stdout=subprocess.PIPE)
    try:
        assert program.stdout.readline() == b"begins\n"
        visit(session.url)
    finally:
        program.kill()
        program.communicate()


ROOM = """(asdf:load-system :cram-bullet-reasoning)
(btr:add-object btr:*current-bullet-world* :static-plane :ground '((0 0 0) (0 0 0 1)) :normal '(0 0 1) :constant 0)
(btr:add-object btr:*current-bullet-world* :box :table '((0 0 0.35) (0 0 0 1)) :size '(2 2 0.7) :mass 0)
(btr:add-object btr:*current-bullet-world* :cylinder :bottle '((0.5 0.2 0.85) (0 0 0 1)) :size '(0.2 0.2 0.3) :mass 0.5 :color '(0.9 0.05 0.05))"""
WAITS = """(cpl:top-level (loop until (< (cl-transforms:y (cl-transforms:origin (btr:pose (btr:object btr:*current-bullet-world* :bottle)))) 0)
                 do (cpl:sleep 0.5)
                 finally (return :it-was-moved)))"""


@pytest.mark.soak
def test_an_object_that_is_dragged_arrives_in_the_world_while_a_plan_runs(repl, visit):
    pytest.importorskip("mujoco", reason="pip install 'cramhy[robot]'")
    from test_page_room import Picture, drag, red

    session = repl("--time", "virtual")
    page = visit(session.url, 1020, 600)
    session.type(ROOM)
    page.wait_for_selector("#room")
    page.get_by_role("button", name="bottle").wait_for()
    page.locator("#room").focus()
    session.type(WAITS)
    wait_for_text(page, "#doing", "a form runs")
    page.keyboard.press("0")
    start = Picture(page).middle(red)[:2]
    drag(page, start, (start[0] + 60, start[1] + 40))
    page.mouse.up()
    session.wait_for(":IT-WAS-MOVED")
    page.wait_for_function("() => parseFloat(document.querySelector('[data-reading=room-y]').textContent.replace('−', '-')) < 0")
    assert page.locator("[data-reading=room-z]").text_content() == "0.85"
