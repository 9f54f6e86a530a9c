"""What goes wrong in a tab costs a message and at most the session: files are there afterwards. In Chromium and Firefox, with Python
behind the page.

Making the site takes half a minute of the processor, so `make soak` runs these.
"""

from __future__ import annotations

import pytest
from browsers import KINDS, browser
from test_site import enter, kind, made, served, transcript, visit, wait_for_prompt, wait_for_state  # noqa: F401  fixtures among them

pytestmark = [pytest.mark.soak, pytest.mark.timeout(3000)]
KEEP = '(with-open-file (out "kept.lisp" :direction :output) (print :kept out))'
READ = '(with-open-file (in "kept.lisp") (read in))'
DEAF = "No answer to Ctrl-C: the program computes outside of Lisp. Restart ends it; files are kept."


@pytest.fixture
def page(visit):  # noqa: F811
    """A page at its prompt, with a file. Afterwards the file is there."""
    found, _ = visit
    enter(found, KEEP)
    yield found
    assert enter(found, READ).splitlines()[-1] == ":KEPT"


def begin(page, text):
    """Enter a form, and do not wait for it."""
    line = page.locator("#repl-in")
    line.fill(text)
    line.press("Enter")
    wait_for_state(page, "busy")


def restart(page):
    prompts = page.locator("body").get_attribute("data-prompts")
    page.locator("#repl-restart").click()
    page.locator(f'body[data-prompt=waits]:not([data-prompts="{prompts}"])').wait_for()


RECURSIONS = {
    "a sum": ("(defun f (x) (+ 1 (f x)))", "(f 1)"),
    "a function of functions": ("(defun f (x) (mapcar #'f (list x)))", "(f 1)"),
    "handlers and methods": ("(defmethod f ((x integer)) (handler-case (+ 1 (f x)) (type-error () 1)))", "(f 1)"),
    "a deep list is printed": ("(defun f (x) (dotimes (i 100000) (setf x (list x))) x)", "(f 1)"),
    "in a task": ("(defun f (x) (+ 1 (f x)))", "(cpl:top-level (cpl:par (f 1) (cpl:sleep 1)))"),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("way", RECURSIONS)
def test_endless_recursion_opens_the_debugger(page, way):
    definition, call = RECURSIONS[way]
    enter(page, definition)
    assert "Control stack exhausted: a function calls itself too deeply, perhaps without end." in enter(page, call)
    enter(page, "0")
    assert enter(page, "(+ 1 2)").splitlines()[-1] == "3"


def test_memory_that_is_exhausted_opens_the_debugger(page):
    assert "Heap exhausted: there is no memory for this object." in enter(page, "(let ((all nil)) (loop (push (make-array 10000000) all)))")
    enter(page, "0")
    assert enter(page, "(+ 1 2)").splitlines()[-1] == "3"
    restart(page)


@pytest.mark.parametrize(("kind", "most"), [("chromium", "8,000"), ("firefox", "2,000")])
def test_ten_thousand_tasks_are_refused_and_the_session_goes_on(page, most):
    told = enter(page, "(cpl:top-level (cpl:par-loop (i (loop for i below 10000 collect i)) i (cpl:sleep 1)))")
    assert f"There is room for {most} tasks at a time in a browser, and all of it is taken. End some tasks before you start more." in told
    assert "debugger invoked on a STORAGE-CONDITION:" in told
    enter(page, "0")
    assert enter(page, "(cpl:top-level (cpl:par (cpl:sleep 1) (cpl:sleep 2)) 3)").splitlines()[-1] == "3"


@pytest.mark.parametrize("kind", KINDS)
def test_a_loop_of_python_that_hears_nothing_is_ended_by_a_restart(page):
    begin(page, '(py:call "builtins.exec" "while True: pass" (py:call "builtins.dict"))')
    page.locator("#repl-in").press("Control+c")
    page.locator("#repl-state", has_text=DEAF).wait_for()
    restart(page)
    assert "Started anew. What was defined is gone; files are kept." in transcript(page)


@pytest.mark.parametrize("kind", KINDS)
def test_a_tab_that_is_closed_while_a_form_runs_has_kept_what_was_written(made, kind):  # noqa: F811
    with served(made) as (address, _), browser(kind) as started:
        context = started.new_context()
        page = context.new_page()
        page.goto(address)
        wait_for_prompt(page)
        begin(page, f"(progn {KEEP} (loop (cpl:sleep 1)))")
        page.wait_for_timeout(5000)  # of the wall: the worker's timer keeps files every two seconds
        page.close()
        page = context.new_page()
        page.goto(address)
        wait_for_prompt(page)
        assert enter(page, READ).splitlines()[-1] == ":KEPT"
