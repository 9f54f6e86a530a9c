"""The page of a session that was started without one: it opens when somebody asks, from the prompt or from another terminal."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from test_page import READING, rows, wait_for_reading, wait_for_text
from test_page_of_a_session import plan_time, step

from cramhy_runtime.extras import install_command

ROOT = Path(__file__).parents[2]
ADDRESS = r"http://127\.0\.0\.1:\d+/#[\w-]+"
NODE = '(roslisp:start-ros-node "a")'
PLAN = """\
(cpl:top-level
  (cpl:par
    (cpl:wait-for (cpl:make-fluent :name 'never))
    (cpl:sleep 3000)))"""


def wait_for_address(session):
    """The address that the REPL prints as the value of a form."""
    session.wait_for("/#")
    session.wait_for('"\n')
    return re.search(ADDRESS, session.text)[0]


@pytest.fixture
def terminal(tmp_path):
    """``terminal("view")``: (output, complaints, status) of ``cramhy`` in another terminal, without a screen."""

    def run(*words):
        done = subprocess.run(
            [sys.executable, "-m", "cramhy_runtime.cli", *words],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            env={**os.environ, "XDG_RUNTIME_DIR": str(tmp_path), "DISPLAY": "", "WAYLAND_DISPLAY": ""},
            timeout=120,
        )
        return done.stdout, done.stderr, done.returncode

    return run


@pytest.mark.soak
def test_another_terminal_opens_the_page_of_a_plan_that_runs(repl, terminal, visit):
    session = repl("--serve", view=False)
    session.type(NODE)
    session.type(PLAN)
    session.wait_for("0\nCL-USER> ")
    out, complaints, status = terminal("view")
    assert re.fullmatch(f"The page: ({ADDRESS})\n", out) and (complaints, status) == ("", 0)
    page = visit(out.split()[-1])
    wait_for_reading(page, "x", "5.54")
    wait_for_text(page, "#tasks", "[PAR-CHILD-#2/2]")
    assert {row[1] for row in rows(page)} >= {"[TOP-LEVEL]", "[PAR-CHILD-#1/2]", "[PAR-CHILD-#2/2]"}
    page.keyboard.press("ArrowUp")
    page.wait_for_function("() => parseFloat(document.querySelector('[data-reading=x]').textContent) > 7.0")
    assert terminal("view") == (out, "", 0)  # the same page once more
    session.process.send_signal(signal.SIGINT)
    session.wait_for("; Interrupted.")


@pytest.mark.soak
@pytest.mark.parametrize("serve", [(), ("--serve",)])
def test_the_prompt_opens_the_page_and_other_terminals_find_it(repl, terminal, visit, serve, tmp_path):
    session = repl(*serve, view=False)
    session.type(NODE)
    session.type("(turtlesim:view)")
    address = wait_for_address(session)
    page = visit(address)
    wait_for_reading(page, "x", "5.54")
    assert terminal("view") == (f"The page: {address}\n", "", 0)
    assert terminal("ros", "rosnode", "list")[0] == "/a\n/rosout\n/turtlesim\n"
    session.type('(list "again" (turtlesim:view))')
    session.wait_for(f'("again" "{address}")')
    page.foresee("WebSocket connection to")
    session.type("(quit)")
    wait_for_text(page, "#connection", "connection lost")
    assert session.process.wait(60) == 0
    assert not [path for path in tmp_path.rglob("*") if path.is_file()]


@pytest.mark.soak
def test_virtual_time_passes_as_the_walls_from_then_on_and_can_be_paused_and_stepped(repl, terminal, visit):
    session = repl("--serve", "--time", "virtual", view=False)
    session.type("(progn (cpl:sleep 20) (print 'slept))")  # as fast as the machine computes
    session.wait_for("SLEPT")
    session.type(NODE)
    session.wait_for("0\nCL-USER> ")
    page = visit(terminal("view")[0].split()[-1])
    wait_for_reading(page, "x", "5.54")
    assert page.locator("#speed").input_value() == page.locator("#speed option", has_text="× 1").first.get_attribute("value")
    page.get_by_role("button", name="Pause").click()
    session.type("(cpl:sleep 1000)")
    page.locator("#step-size").select_option("1 s")
    for _ in range(2):
        step(page, 1)
    page.locator("#speed").select_option("unbounded")
    page.get_by_role("button", name="Resume").click()
    session.wait_for("NIL\nCL-USER> ")


@pytest.mark.soak
def test_make_view_draws_in_virtual_time_so_that_it_can_be_paused_and_stepped(repl, visit):
    (recipe,) = re.findall(r"^view: .*\n((?:\t.*\n)+)", (ROOT / "Makefile").read_text(), re.M)
    program, *words = shlex.split(recipe.replace("\\\n", " "))
    assert program == "@$(BIN)/roslisp_repl" and words[0] == "--view"
    begin = words.index("--eval")
    forms = words[begin + 1 :: 2]
    assert words[begin::2] == ["--eval"] * len(forms)
    session = repl(*words[1:begin])  # and the forms are typed, so that it is certain when they are paused
    page = visit(session.url)
    page.get_by_role("button", name="Pause").click()
    plan_time(page, "paused")
    session.type("\n".join(forms))
    page.locator("#step-size").select_option("1 s")
    while "TURTLESIM-NAVIGATION" not in page.inner_text("#modules"):
        step(page, 1)
    x = page.evaluate(READING, "x")
    while page.evaluate(READING, "x") == x:
        step(page, 1)
    page.locator("#speed").select_option("unbounded")
    page.get_by_role("button", name="Resume").click()
    session.type('(list "drawn")')
    session.wait_for('("drawn")')


@pytest.mark.soak
@pytest.mark.parametrize("missing", ["uvicorn", "websockets"])
def test_without_the_extra_the_error_says_what_to_install(repl, missing):
    session = repl(view=False, hidden=[missing])
    session.type("(turtlesim:view)")
    session.wait_for(f"The page needs uvicorn, websockets, and {missing} is not installed. Type: {install_command('web')}")
    session.type("0")
    session.type("(+ 1 2)")
    session.wait_for("3\n")


@pytest.mark.soak
def test_the_page_goes_with_the_turtle_to_the_session_of_the_prompt(repl, tmp_path, visit):
    """What the slides have: the simulator first, in a terminal of its own, and then the prompt."""
    simulator = subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", "ros", "rosrun", "turtlesim", "turtlesim_node"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "XDG_RUNTIME_DIR": str(tmp_path), "DISPLAY": "", "WAYLAND_DISPLAY": ""},
    )
    try:
        page = visit(re.fullmatch(f"; The page: ({ADDRESS})\n", simulator.stderr.readline())[1])
        wait_for_reading(page, "x", "5.54")
        before = page.url
        page.foresee("WebSocket connection to")
        session = repl("--serve", view=False)
        page.wait_for_url(lambda address: address != before)
        assert simulator.stderr.readline() == "; A session has started: the turtle lives there now.\n"
        assert simulator.stderr.readline().startswith(f"; /turtlesim runs in the session of process {session.process.pid} already.")
        assert simulator.stderr.readline() == f"; The page: {page.url}\n"
        page.wait_for_selector("#connection[data-state=open]")
        session.type(NODE)
        session.wait_for("0\nCL-USER> ")
        wait_for_reading(page, "x", "5.54")
        page.keyboard.press("ArrowUp")
        page.wait_for_function("() => parseFloat(document.querySelector('[data-reading=x]').textContent) > 7.0")
    finally:
        simulator.send_signal(signal.SIGINT)
        assert simulator.wait(60) == 0
        simulator.stderr.close()


@pytest.mark.soak
def test_the_page_goes_to_no_other_address(fake, visit):
    page = visit(fake.address)
    before = page.url
    for address in ("https://example.org/#x", "javascript:alert(1)", "http://127.0.0.1.example.org:80/#x", "http://127.0.0.1:8080/x#x"):
        fake.publish("/cramhy/moved", {"data": address})
    fake.say("the last of them")
    wait_for_text(page, "#log", "the last of them")
    assert page.url == before


@pytest.mark.soak
def test_without_a_session_a_simulator_of_its_own_is_shown_and_that_is_said(tmp_path, visit):
    process = subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", "view"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "XDG_RUNTIME_DIR": str(tmp_path), "DISPLAY": "", "WAYLAND_DISPLAY": ""},
    )
    try:
        assert process.stderr.readline() == (
            "; No session listens here, so this is a simulator of its own. To see the turtle of a prompt, type (turtlesim:view) there, "
            "or start it with roslisp_repl --serve.\n"
        )
        page = visit(re.fullmatch(f"; The page: ({ADDRESS})\n", process.stderr.readline())[1])
        wait_for_reading(page, "x", "5.54")
        page.foresee("WebSocket connection to")
    finally:
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 0
        process.stderr.close()


@pytest.mark.soak
@pytest.mark.parametrize(
    ("begins", "text"),
    [
        ("rosbridge.start()", "offers no page. Its program opens one by: from cramhy_runtime import view; view.start()"),
        ("rosbridge.start(); Host()", "does not open its page: The program that runs this session offers no page. cramhy repl, cramhy run"),
    ],
)
def test_a_program_in_python_that_offers_no_page_says_how_to_open_one(python, terminal, begins, text):
    program = python(begins)
    out, complaints, status = terminal("view")
    assert (out, status) == ("", 2)
    assert complaints.startswith(f"cramhy: The session of process {program.pid} {text}")


@pytest.mark.soak
def test_a_page_that_a_program_in_python_has_opened_is_found(python, terminal, visit):
    python("page = view.start()")
    out, complaints, status = terminal("view")
    assert (complaints, status) == ("", 0)
    visit(out.split()[-1]).foresee("WebSocket connection to")


@pytest.fixture
def python(tmp_path):
    """``python("rosbridge.start()")``: the process of a program that does so and goes on."""
    started = []

    def run(begins):
        program = f"""
import sys
from cramhy_runtime import kernel, rosbridge, view
from cramhy_runtime.ros_tools.hosting import Host
from cramhy_runtime.session import boot
kernel.start(clock="wall")
boot()
{begins}
print("ready", flush=True)
kernel.run_blocking(sys.stdin.read)
kernel.stop()
"""
        process = subprocess.Popen(
            [sys.executable, "-c", program],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "XDG_RUNTIME_DIR": str(tmp_path)},
        )
        started.append(process)
        assert process.stdout.readline() == "ready\n"
        return process

    yield run
    for process in started:
        process.communicate("", timeout=60)


IN_PYTHON = "from cramhy_runtime import kernel, turtlesim\nkernel.start(clock='wall')\n"


@pytest.mark.soak
@pytest.mark.parametrize(
    ("program", "name"),
    [
        ("(require cramhy *)\n(print (turtlesim:view))\n", "shown.hy"),
        ("(import cramhy cramhy_runtime [turtlesim])\n(print (turtlesim.view))\n", "shown.hy"),
        ("(print (turtlesim:view))\n", "shown.lisp"),
        (f"{IN_PYTHON}import cramhy\nprint(turtlesim.view())\nkernel.stop()\n", "shown.py"),
    ],
)
def test_a_program_opens_the_page_too(tmp_path, program, name):
    (tmp_path / name).write_text(program)
    runs = {"hy": ["-m", "hy", name], "lisp": ["-m", "cramhy_runtime.cli", "run", name], "py": [name]}
    environment = {**os.environ, "XDG_RUNTIME_DIR": str(tmp_path), "DISPLAY": "", "WAYLAND_DISPLAY": ""}
    words = [sys.executable, *runs[name.partition(".")[2]]]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, env=environment, timeout=120)
    assert re.search(ADDRESS, done.stdout) and (done.returncode, done.stderr) == (0, "")
    assert not list(tmp_path.rglob("session-*"))


@pytest.mark.soak
def test_a_python_program_that_offers_no_page_is_told_how_to_open_one(tmp_path):
    program = f"{IN_PYTHON}turtlesim.view()"
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 1 and done.stderr.splitlines()[-1] == (
        "cramhy_runtime.turtlesim.window.NoPage: The program that runs this session offers no page. cramhy repl, cramhy run and import cramhy "
        "do. A program in Python opens the page itself: from cramhy_runtime import view; print(view.start().url)"
    )
