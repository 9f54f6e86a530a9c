"""The first hour of a newcomer: README's commands, both lectures with mistakes, a second terminal, the page, exercises of one's own.

Each program is the one that README's commands have installed, and a shell or a terminal starts it. Nothing waits for the wall clock: the
lectures are typed in virtual time, and each wait is for something that is printed or shown.
"""

from __future__ import annotations

import itertools
import re
import runpy
import shutil
import signal
import subprocess
import sys
import time
import urllib.request

import pytest

if sys.platform == "win32":
    pytest.skip("README's commands are for a shell of POSIX", allow_module_level=True)

from browsers import chromium  # noqa: E402
from repl import terminal as terminals  # noqa: E402

from .conftest import commands_of_the_readme  # noqa: E402

SHIMS = 'eval "$(.venv/bin/cramhy ros-shims)"'


@pytest.fixture(autouse=True)
def patience(monkeypatch):
    """A machine that is busy with other things may take long for a program to start."""
    monkeypatch.setattr(terminals, "PATIENCE", 180)


class Prompt:
    """Somebody at the prompt of a terminal, who looks at each answer before typing the next form."""

    def __init__(self, terminal):
        self.terminal = terminal
        self.numbers = itertools.count(1)

    def say(self, form, *answers):
        """Type a form; the text up to the next prompt. answers: regular expressions for what comes, in order."""
        begin = self.terminal.seen
        self.terminal.type(form)
        for answer in answers:
            self.terminal.expect(answer)
        number = next(self.numbers)
        self.terminal.type(f"(list :typed {number})")  # what is typed is shown in small letters, what is answered in capitals
        self.terminal.expect(rf"\(:TYPED {number}\)")
        return self.terminal.text[begin : self.terminal.seen]


@pytest.mark.soak
def test_the_commands_of_the_readme_make_a_small_environment_and_a_picture(newcomer):
    assert [command.split()[0] for command in commands_of_the_readme()] == [
        "python3",
        ".venv/bin/pip",
        ".venv/bin/cramhy",
        ".venv/bin/roslisp_repl",
    ]
    assert (newcomer.clone / "spiral.replay.svg").read_text().rstrip().endswith("</svg>")
    assert sum(path.lstat().st_size for path in (newcomer.clone / ".venv").rglob("*")) < 100 * 2**20


def test_the_last_command_of_the_readme_opens_a_prompt_and_a_page(newcomer):
    with newcomer.terminal(commands_of_the_readme()[-1]) as terminal:
        terminal.expect(r"http://127\.0\.0\.1:\d+/\S+")
        terminal.expect("CL-USER> ")
        terminal.type("(exit)")
        assert terminal.status() == 0


@pytest.mark.soak
def test_make_tutorial_types_both_lectures(newcomer):
    printed = newcomer.run("make tutorial")
    assert "LECTURE 38" in printed.upper() and printed.rstrip().endswith("\nT")
    assert (newcomer.clone / "turtle.png").read_bytes().startswith(b"\x89PNG")
    assert sum(path.lstat().st_size for path in (newcomer.clone / ".venv").rglob("*")) < 100 * 2**20
    assert newcomer.start(".venv/bin/python -c 'import pytest'", stderr=subprocess.DEVNULL).wait(), "the tests' part is not needed"


@pytest.mark.soak
def test_two_commands_show_the_course_in_a_tab(newcomer):
    if not shutil.which("npm", path=newcomer.variables["PATH"]):
        pytest.skip("npm is not installed")
    assert "Wrote " in newcomer.run("make course")
    with newcomer.terminal(".venv/bin/cramhy browser --serve course-site") as terminal:
        address = terminal.expect(r"http://127\.0\.0\.1:\d+/").rpartition("http")[2]
        with urllib.request.urlopen(f"http{address}", timeout=60) as page:
            assert page.status == 200 and b"<html" in page.read() and page.headers["Content-Type"].startswith("text/html")
        terminal.control_c()
        assert terminal.status() == 0


def mistakes(prompt):
    """Mistype in the four ways of beginners, and go on after each."""
    shown = prompt.say("(vlaue *turtle-pose*)", "debugger invoked", r"\n0\] ")
    assert "Did you mean VALUE?" in shown
    out = re.search(r"(\d+): \[ABORT", shown)[1]
    prompt.say(out, "TUT> ")
    prompt.terminal.type("(drive 5 2")  # not yet a form
    assert "debugger" not in prompt.say(")", r"\n1\n")
    assert "DRIVE takes 2 arguments." in prompt.say("(drive 5)", "debugger invoked", r"\n0\] ")
    assert 'linear.x holds "fast"' in prompt.say('(drive "fast" 2)', "debugger invoked", r"\n1\] ")  # in the debugger of the last one
    shown = prompt.say("(list :unfinished :form))")  # one parenthesis too many
    assert "(:UNFINISHED :FORM)" in shown
    for level in ("0", "0"):
        prompt.say(level)
    assert "TUT> " in prompt.say("(car (list 1 2))", r"\n1\n")


@pytest.mark.soak
def test_both_lectures_by_hand_with_mistakes_and_a_second_terminal(newcomer, tmp_path):
    lectures = runpy.run_path(str(newcomer.clone / "tutorials" / "lectures.py"))
    forms = [*lectures["LECTURE_34"], *lectures["LECTURE_38"]]
    with newcomer.terminal(f"{SHIMS}; roslisp_repl --time virtual") as terminal:
        prompt = Prompt(terminal)
        terminal.expect("CL-USER> ")
        shown = [prompt.say(form) for form in forms[:5]]
        assert "Node startup complete" in shown[2] and '"/turtle1/set_pen"' in shown[3] and "5.544444561004639d0" in shown[4]
        mistakes(prompt)
        second_terminal(newcomer, prompt, tmp_path)
        for form in forms[5:]:
            assert "debugger invoked" not in prompt.say(form)
        pose = prompt.say("(value *turtle-pose*)", r"ANGULAR_VELOCITY:")
        x, y = re.findall(r"X:\s+([\d.]+)d0\s+Y:\s+([\d.]+)d0", pose)[-1]
        assert (round(float(x)), round(float(y))) == (9, 9)
        assert terminal.text.count("TurtleSim pen control invoked") == 10
        terminal.type("(exit)")
        assert terminal.status() == 0


def second_terminal(newcomer, prompt, folder):
    """Look at the session of the first terminal, and change it, from another one."""
    topics = newcomer.run(f"{SHIMS}; rostopic list").split()
    assert {"/turtle1/cmd_vel", "/turtle1/pose", "/rosout"} <= set(topics)
    with (folder / "echo").open("w") as output:
        echo = newcomer.start(f"{SHIMS}; rostopic echo -n 2 /turtle1/pose", stdout=output, stderr=subprocess.STDOUT)
        until = time.monotonic() + terminals.PATIENCE
        while echo.poll() is None:
            assert time.monotonic() < until, "nothing is heard"
            prompt.say("(sleep 0.1)")  # time passes only while a form runs
    assert echo.returncode == 0 and (folder / "echo").read_text().count("theta: ") == 2
    prompt.say("(sleep 2)")  # a turtle that was told to drive stops after a second
    assert newcomer.run(f"{SHIMS}; rosservice call /turtle1/teleport_absolute 2 3 0") == "\n"
    prompt.say("(sleep 0.1)")
    assert re.search(r"X:\s+2\.0d0\s+Y:\s+3\.0d0", prompt.say("(value *turtle-pose*)"))
    assert newcomer.run(f"cd /; {SHIMS.replace('.venv', str(newcomer.clone / '.venv'))}; rosservice call /reset") == "\n"


EXERCISE = """\
(in-package :cram-user)

(defvar *battery* (make-fluent :name 'battery :value 3))

(defun work ()
  (top-level
    (pursue
      (progn (wait-for (< *battery* 1)) :empty)
      (loop (sleep 1) (setf (value *battery*) (- (value *battery*) 1))))))

(format t "~a at ~a~%" (work) (value *battery*))
"""
TESTS = """\
(defpackage :my-tests (:use :cl :lisp-unit))
(in-package :my-tests)

(define-test the-battery-becomes-empty
  (assert-equal :empty (cram-user::work)))

(define-test a-mistake
  (assert-equal 4 (+ 1 2)))
"""
EXERCISE_IN_HY = """\
(require cramhy *)
(import cramhy_runtime.cpl [PlanFailure now])

(defn work []
  (with-retry-counters [[tries 2]]
    (with-failure-handling
      [[PlanFailure [failure]
         (do-retry tries (retry))
         (leave "closed")]]
      (sleep 1)
      (fail "Nobody opens."))))

(print (top-level (work)) (now))
"""


def test_exercises_of_ones_own(newcomer):
    folder = newcomer.home / "my plans"
    folder.mkdir()
    for name, text in (("battery.lisp", EXERCISE), ("waiting.hy", EXERCISE_IN_HY), ("tests.lisp", TESTS)):
        (folder / name).write_text(text)
    cramhy = f"'{newcomer.clone}/.venv/bin/cramhy'"
    assert newcomer.run(f"{cramhy} run battery.lisp", folder) == "EMPTY at 0\n"
    assert newcomer.run(f"{cramhy} run waiting.hy", folder) == "closed 3.0\n"
    with newcomer.start(f"{cramhy} test --load battery.lisp tests.lisp", folder, stdout=subprocess.PIPE) as process:
        shown = process.communicate()[0]
    assert process.returncode == 1 and "tests.lisp:8" in shown, shown
    (folder / "tests.lisp").write_text(TESTS.replace("4 (+ 1 2)", "3 (+ 1 2)"))
    newcomer.run(f"{cramhy} test --load battery.lisp tests.lisp", folder)


SCREENS = {"projector": (1920, 1080, {}), "laptop": (1280, 800, {}), "phone": (390, 844, {"has_touch": True, "is_mobile": True})}
STAYS = """() => {
  const { scrollHeight, scrollWidth, scrollTop } = document.scrollingElement;
  return [scrollHeight - innerHeight, scrollWidth - innerWidth, scrollTop, scrollY];
}"""


@pytest.mark.soak
def test_the_page_of_make_view_never_scrolls(newcomer):
    with chromium() as browser, newcomer.terminal("make view") as terminal:
        address = terminal.expect(r"http://127\.0\.0\.1:\d+/\S+").split()[-1]
        for name, (width, height, options) in SCREENS.items():
            context = browser.new_context(viewport={"width": width, "height": height}, **options)
            context.set_default_timeout(180_000)
            page = context.new_page()
            page.goto(address)
            page.wait_for_selector("#connection[data-state=open]")
            page.wait_for_selector("#doing:not(:empty)")
            page.wait_for_function("() => /\\d\\.\\d/.test(document.querySelector('[data-reading=x]')?.textContent)")
            for x, y in ((width // 5, height // 2), (width // 2, 20), (width - 20, height - 20)):
                for by in (2000, -2000):
                    scroll(page, x, y, by, "has_touch" in options)
                assert page.evaluate(STAYS) == [0, 0, 0, 0], (name, x, y)
            context.close()
        terminal.control_c()
        terminal.expect("TUT> ")
        terminal.type("(exit)")
        assert terminal.status() in (0, -signal.SIGINT)  # make, too, has heard Ctrl-C


def scroll(page, x, y, by, touch):
    """Turn the wheel, or draw a finger the other way, at a place of the page; it has been heard when this returns."""
    if not touch:
        page.mouse.move(x, y)
        page.mouse.wheel(0, by)
    else:
        session = page.context.new_cdp_session(page)
        for kind, points in (("Start", [(x, y)]), ("Move", [(x, y - by // 10)]), ("Move", [(x, y - by // 5)]), ("End", [])):
            session.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": [{"x": a, "y": b} for a, b in points]})
        session.detach()
    page.evaluate("() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))")
