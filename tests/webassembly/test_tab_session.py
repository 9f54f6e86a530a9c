"""The page of a tab with Python behind it, in Chromium: editor, files, packages, languages, the debugger and the lesson's checks.

Making the site takes half a minute of the processor, so `make soak` runs these. `test_tab_page.py` is the same page without Python.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from browsers import KINDS
from test_site import enter, kind, made, transcript, visit, wait_for_prompt, wait_for_state  # noqa: F401  fixtures

SOLUTIONS = Path(__file__).parents[1] / "course" / "solutions"
pytestmark = [pytest.mark.soak, pytest.mark.timeout(3000)]


def write(page, text):
    """Make TEXT the content of the editor."""
    page.locator("#code-in").click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(text)


def wait_for(page, locator, text):
    page.locator(locator, has_text=text).first.wait_for()


def after(page, act):
    """What was printed until the prompt that comes after act(). Lines that were typed ahead get no prompt of their own."""
    before, number = len(transcript(page)), int(page.locator("body").get_attribute("data-prompts"))
    act()
    page.locator(f'body[data-prompt=waits][data-prompts="{number + 1}"]').wait_for()
    return transcript(page)[before:]


def choose(page, name):
    page.locator("#code-menu summary").click()
    page.get_by_role("button", name=name, exact=True).click()


def test_a_file_is_loaded_a_form_evaluated_in_its_package_and_names_completed(visit):  # noqa: F811
    page, _ = visit
    write(
        page, "(defpackage :walks (:use :cl))\n(in-package :walks)\n\n(defun stride-length (legs &key fast)\n  (if fast (* 2 legs) legs))\n"
    )
    assert after(page, page.locator("#code-load").click).endswith('CL-USER> (load "plans.lisp")\nT\n')
    page.locator("#code-in").press("Control+End")
    page.keyboard.type("(stride-l")
    page.keyboard.press("Tab")
    wait_for(page, ".cm-tooltip-autocomplete li", "stride-length")
    page.keyboard.press("Enter")
    page.keyboard.type(" 4")
    wait_for(page, "#code-args b", "legs")
    page.keyboard.type(" :fa")
    page.keyboard.press("Tab")
    wait_for(page, ".cm-tooltip-autocomplete li", ":fast")
    page.keyboard.press("Enter")
    page.keyboard.type(" t")
    wait_for(page, "#code-args b", "fast")
    page.keyboard.type(")")
    printed = after(page, lambda: page.keyboard.press("Alt+Enter"))
    assert printed == 'CL-USER> (in-package :walks)\n#<PACKAGE "WALKS">\nWALKS> (stride-length 4 :fast t)\n8\n'


def test_an_error_is_left_by_a_button_and_its_calls_show_their_variables(visit):  # noqa: F811
    page, _ = visit
    enter(page, "(defun walk (steps) (+ steps (car steps)))")
    enter(page, "(walk 5)")
    page.locator("#debugger-calls > summary").click()
    page.locator("#debugger-frames summary").first.click()
    assert " ".join(page.locator("#debugger-frames li").first.inner_text().split()) == "(WALK 5) <repl 1>:1:30 STEPS 5"
    assert after(page, page.get_by_role("button", name="ABORT").click) == "0] 0\n"
    assert not page.locator("#debugger").is_visible()
    enter(page, '(cpl:top-level (cpl:par (error "in a plan\'s task")))')
    page.locator("#debugger-title", has_text="SIMPLE-ERROR").wait_for()
    page.locator("#code-in").click()
    page.keyboard.type("(list")  # while a plan's task has the baton, questions are answered
    page.keyboard.press("Tab")
    wait_for(page, ".cm-tooltip-autocomplete li", "list-length")


@pytest.mark.parametrize("kind", KINDS)
def test_an_error_in_a_form_of_the_editor_names_its_line_in_the_file(visit):  # noqa: F811
    page, _ = visit
    write(page, "(defun one () 1)\n\n(defun walk (steps)\n  (car steps))")
    after(page, lambda: page.keyboard.press("Alt+Enter"))
    assert "  at plans.lisp:4:3\n      (car steps))\n      ^\n" in enter(page, "(walk 5)")
    enter(page, "0")
    page.locator("#code-in").press("Control+Home")
    page.keyboard.type(";; a line more\n")
    page.keyboard.press("Control+End")
    after(page, lambda: page.keyboard.press("Alt+Enter"))
    assert "  at plans.lisp:5:3\n      (car steps))\n      ^\n" in enter(page, "(walk 5)")
    enter(page, "0")


def test_hy_is_spoken_and_programs_read_lines(visit):  # noqa: F811
    page, _ = visit
    choose(page, "New file")
    page.keyboard.type("walk.hy")
    page.keyboard.press("Enter")
    page.locator('#code-file option[value="walk.hy"]').wait_for(state="attached")
    write(page, "(defn stride [legs]\n  (* 2 legs))\n\n(stride 4)")
    assert after(page, page.locator("#code-load").click).endswith("8\n")
    assert page.locator("#repl-prompt").inner_text() == "=>"
    page.locator("#repl-in").press_sequentially("(strid")
    page.locator("#repl-in").press("Tab")
    wait_for(page, ".cm-tooltip-autocomplete li", "stride")
    page.keyboard.press("Enter")
    page.keyboard.type(" 3)")
    assert after(page, lambda: page.keyboard.press("Enter")) == "=> (stride 3)\n6\n"
    enter(page, "(in-package :cl-user)")
    page.locator("#repl-in").press_sequentially("(list (read-line) 2)")
    page.locator("#repl-in").press("Enter")
    wait_for_state(page, "reads")
    assert enter(page, "hello").endswith('hello\n("hello" 2)\n')
    page.locator("#repl-in").press_sequentially("(read-line)")
    page.locator("#repl-in").press("Enter")
    wait_for_state(page, "reads")
    assert after(page, lambda: page.locator("#repl-in").press("Control+c")).endswith("; Interrupted.\n")


def test_files_survive_a_dead_python_a_reload_and_a_second_tab(visit):  # noqa: F811
    page, _ = visit
    write(page, ";; first\n")
    enter(page, "(in-hy)")
    page.locator("#repl-in").press_sequentially("(sum (range 100_000_000_000))")
    page.locator("#repl-in").press("Enter")
    wait_for_state(page, "busy")
    page.locator("#code-in").press("Control+End")
    page.keyboard.type(";; while Python is deaf")
    page.locator("#repl-stop").click()
    wait_for(page, "#repl-state", "No answer to Ctrl-C: the program computes outside of Lisp. Restart ends it; files are kept.")
    page.locator("#repl-restart").click()
    wait_for_state(page, "begins")
    wait_for_prompt(page)
    assert enter(page, '(with-open-file (in "plans.lisp") (list (read-line in) (read-line in)))').splitlines()[-1] == (
        '(";; first" ";; while Python is deaf")'
    )
    other = page.context.new_page()
    other.goto(page.url)
    wait_for_prompt(other)
    assert "This course is open in another tab, which keeps the files." in transcript(other)
    wait_for(other, "#code-in", ";; while Python is deaf")
    enter(other, '(with-open-file (out "lost.lisp" :direction :output) (print 1 out))')
    other.close()
    page.reload()
    wait_for_prompt(page)
    wait_for(page, "#code-in", ";; while Python is deaf")
    assert page.locator("#code-file option").all_inner_texts() == ["plans.lisp"]


def test_a_package_goes_out_and_comes_in_and_its_system_loads(visit, tmp_path):  # noqa: F811
    page, _ = visit
    write(page, "(defpackage :walks (:use :cl))\n(in-package :walks)\n(defun legs () 4)\n")
    with page.expect_download() as saved:
        choose(page, "Export package")
        page.keyboard.press("Enter")
    data = Path(saved.value.path()).read_bytes()

    def take(content):
        page.locator("#code-zip").set_input_files({"name": "a.zip", "mimeType": "application/zip", "buffer": content})

    take(data[:-30])
    wait_for(page, "#code-state[data-kind=bad]", "This file is not a zip file, or it is broken or cut short.")
    take(data)
    wait_for(page, "#code-state", "4 files were imported.")
    page.locator("#code-file").select_option("my_plans/my-plans.asd")
    wait_for(page, "#code-in", "(defsystem my-plans")
    assert after(page, page.locator("#code-load").click) == 'CL-USER> (ros-load:load-system "my_plans" :my-plans)\nT\n'
    assert enter(page, "(walks::legs)").endswith("4\n")


def test_time_is_the_walls_when_the_page_says_so(visit):  # noqa: F811
    page, _ = visit
    assert after(page, lambda: page.locator("#time-kind").select_option("wall")) == 'CL-USER> (cramhy:time "wall")\n"wall"\n'
    assert page.locator("#time-kind").input_value() == "wall"
    enter(page, '(cramhy:time "virtual")')
    assert page.locator("#time-kind").input_value() == "virtual"


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_tasks_of_the_course_are_solved_in_the_page(visit, language):  # noqa: F811
    page, _ = visit
    page.locator(f'#lesson-languages button[data-language="{language}"]').click()
    other = {"lisp": "hy", "hy": "lisp"}[language]
    for name, title in (("turn-left", "Turn to the left"), ("rectangle", "rectangle")):
        for button in page.get_by_role("button", name="Type it for me").all():
            after(page, button.click)
        assert page.locator(f'#lesson-page [data-only="{language}"]:visible').count() >= 3
        assert page.locator(f'#lesson-page [data-only="{other}"]:visible').count() == 0
        task = page.locator(".task-box", has_text=title)
        task.get_by_role("button", name="Check").click()
        task.locator(".told.missed").wait_for()
        task.get_by_role("button", name="Open in the editor").click()
        page.locator(f'#code-file option[value="{name}.{language}"]:checked').wait_for(state="attached")
        write(page, (SOLUTIONS / f"{name}.{language}").read_text())
        task.get_by_role("button", name="Check").click()
        task.locator(".told.passed").wait_for()
        page.locator("#lesson-after").click()
    assert page.locator("#lesson-done").get_attribute("title") == "2 of 34 tasks are solved"
