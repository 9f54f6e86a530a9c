"""The page of a tab in Chromium (and parts of it in Firefox), with a worker that has no Python: what it shows, which keys it hears, and what it asks its session.

`test_tab_session.py` has Python behind it, and takes minutes.
"""

from __future__ import annotations

import contextlib
import functools
import json
import re
from pathlib import Path

import pytest
from browsers import browser
from node import node, pyodide
from test_site import served

from cramhy_runtime.browser import bundling, pyodide_files, site

LIMIT = 60_000  # ms; for a machine that is busy with other things
SQUARE = {
    "kind": "task",
    "name": "square",
    "title": "A square",
    "html": "<p>Drive a <em>square</em>.</p>",
    "start": {"lisp": "(defun square ())\n", "hy": "(defn square [])\n"},
    "hints": ["<p>Four sides.</p>", "<p>Four corners.</p>"],
}
COURSE = {
    "pages": [
        {
            "name": "first",
            "title": "1. A turtle",
            "parts": [
                {"kind": "text", "html": "<p>This starts a <b>node</b>.</p>"},
                {"kind": "code", "lisp": '(start-ros-node "turtle1")', "hy": '(start-node "turtle1")', "answer": "T\n", "answer_hy": ""},
                {"kind": "code", "lisp": "(lisp-alone)", "hy": "", "answer": "", "answer_hy": ""},
                {"kind": "file", "lisp": {"name": "walks/src/walk.lisp", "text": "(walk)\n"}, "hy": None},
                SQUARE,
            ],
        },
        {
            "name": "second",
            "title": "2. Plans",
            "parts": [
                {"kind": "text", "html": "<p>Plans.</p>"},
                {"kind": "code", "lisp": "(top-level)", "hy": "(top-level)", "answer": "", "answer_hy": ""},
            ],
        },
    ]
}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The folder of a site without Python."""
    program = node()
    pyodide()
    folder = tmp_path_factory.mktemp("page")
    site._write_page(folder)
    (folder / "editor.js").write_bytes(bundling.bundle(program, pyodide_files.FETCHED))
    (folder / "worker.mjs").write_bytes(Path(__file__).with_name("worker_without_python.mjs").read_bytes())
    (folder / "course.json").write_text(json.dumps(COURSE))
    (folder / "offline.js").unlink()
    return folder


@pytest.fixture(scope="module")
def browsers():
    """A function that returns the browser of a kind. Each is started once."""
    with contextlib.ExitStack() as open_ones:
        yield functools.cache(lambda kind: open_ones.enter_context(browser(kind)))


@pytest.fixture
def kind():
    """Which browser visits the page. A test that is parametrized with ``kind`` has others."""
    return "chromium"


@pytest.fixture
def visit(made, browsers, kind):
    """A function that opens the page and returns it at its first prompt. path: what follows the site's address. options: of the context."""
    with served(made) as (address, _):
        contexts = []

        def visit(path="", **options):
            context = browsers(kind).new_context(**{"viewport": {"width": 1500, "height": 900}, "locale": "en-US", **options})
            context.set_default_timeout(LIMIT)
            contexts.append(context)
            page = context.new_page()
            page.complaints = []
            page.on("pageerror", lambda error: page.complaints.append(str(error)))
            page.add_init_script(
                "window.violations = []; document.addEventListener('securitypolicyviolation', "
                "(event) => window.violations.push(`${event.violatedDirective} ${event.blockedURI}`));"
            )
            page.goto(address + path)
            page.locator("body[data-prompt=waits]").wait_for()
            page.locator("#lesson-page h2").wait_for(state="attached")
            return page

        yield visit
        for context in contexts:
            (page,) = context.pages
            assert (page.complaints, page.evaluate("window.violations")) == ([], [])
            context.close()


def transcript(page):
    return page.locator("#repl-out").text_content()


def wait_for(page, locator, text):
    page.locator(locator, has_text=text).first.wait_for()


def code(page):
    return page.locator("#code-in")


def text_of_editor(page):
    return "\n".join(code(page).locator(".cm-line").all_text_contents())


def open_file(page, name, text):
    """Open a file, in which TEXT stands."""
    page.locator("#code-file").select_option(name)
    wait_for(page, "#code-in .cm-line", text)


def choose(page, *words):
    page.locator("#code-menu summary").click()
    page.get_by_role("button", name=words[0], exact=True).click()


@pytest.mark.soak
def test_the_editor_evaluates_a_form_a_choice_and_a_file_at_the_prompt(visit):
    page = visit()
    wait_for(page, "#code-in .cm-line", "(defun one () 1)")
    code(page).click()
    page.keyboard.press("Control+End")
    page.keyboard.type('(in-package :tut)\n(drive "a)" 1)')
    page.keyboard.press("Control+c")
    page.keyboard.press("Control+c")
    wait_for(page, "#repl-out", '(drive "a)" 1)')
    assert transcript(page) == 'CL-USER> (in-package :tut)\nTUT> (drive "a)" 1)\n14\n'
    page.keyboard.press("Shift+Home")
    assert page.locator("#code-form").inner_text() == "Evaluate selection"
    page.keyboard.press("Alt+Enter")
    page.locator("#code-load").click()
    wait_for(page, "#repl-out", "(load")
    assert transcript(page).endswith('TUT> (drive "a)" 1)\n14\nTUT> (load "plans.lisp")\n19\n')
    code(page).press("Control+End")
    page.keyboard.type("\n\n  (where)")
    page.keyboard.press("Alt+Enter")
    wait_for(page, "#repl-out", '{"path":"plans.lisp","line":5,"column":3}')
    open_file(page, "turtle.hy", "(defn two [] 2)")
    code(page).click()
    page.keyboard.press("Alt+Enter")
    wait_for(page, "#repl-out", "=> (defn")
    assert transcript(page).endswith("TUT> (in-hy)\n=> (defn two [] 2)\n15\n")
    assert page.locator("#repl-title").inner_text() == "Hy"


@pytest.mark.soak
def test_tab_completes_in_the_language_and_package_of_the_cursor_and_the_call_is_shown(visit):
    page = visit()
    wait_for(page, "#code-in .cm-line", "(defun one () 1)")
    code(page).click()
    page.keyboard.press("Control+End")
    page.keyboard.type("(in-package :tut)\n(drive na")
    assert page.locator("#code-args b").inner_text() == "speed"
    assert page.locator("#code-args").inner_text() == "(drive speed &optional angle)"
    page.keyboard.press("Tab")
    page.locator(".cm-tooltip-autocomplete li").first.wait_for()
    assert page.locator(".cm-tooltip-autocomplete li").all_inner_texts() == ["name-in-tut", "lisp-namewhat it is"]
    page.keyboard.press("Enter")
    assert text_of_editor(page).endswith("(drive name-in-tut")
    line = page.locator("#repl-in")
    line.press_sequentially("(drive na")
    line.press("Tab")
    page.locator(".cm-tooltip-autocomplete li").first.wait_for()
    line.press("Escape")
    line.press("Enter")  # the form is open
    line.press_sequentially(")")
    line.press("Enter")
    wait_for(page, "#repl-out", "(drive na")
    line.press("ArrowUp")
    assert line.inner_text().split() == ["(drive", "na", ")"]


@pytest.mark.soak
def test_an_error_shows_its_restarts_and_its_calls_and_a_button_chooses(visit):
    page = visit()
    line = page.locator("#repl-in")
    line.press_sequentially("(error)")
    line.press("Enter")
    page.locator("#debugger").wait_for()
    assert page.locator("#debugger-title").inner_text() == "SIMPLE-ERROR"
    assert [" ".join(text.split()) for text in page.locator("#debugger-restarts button").all_inner_texts()] == [
        "0 CONTINUE Go on.",
        "1 ABORT Return to top level.",
    ]
    page.locator("#debugger-calls > summary").click()
    page.locator("#debugger-frames summary").click()
    assert " ".join(page.locator("#debugger-frames").inner_text().split()) == "(DRIVE 5) plans.lisp:3:1 SPEED 5"
    page.get_by_role("button", name="ABORT").click()
    page.locator("#debugger").wait_for(state="hidden")
    assert transcript(page).endswith("0] 1\n")


@pytest.mark.soak
def test_files_are_made_saved_renamed_deleted_and_come_back_after_a_restart(visit):
    page = visit()
    choose(page, "New file")
    page.keyboard.type("walk")
    page.keyboard.press("Enter")
    page.locator('#code-file option[value="walk.lisp"]').wait_for(state="attached")
    page.keyboard.type("(walk)")
    page.keyboard.press("Control+s")
    choose(page, "Rename")
    page.locator("dialog input").fill("run.hy")
    page.keyboard.press("Enter")
    page.locator('#code-file option[value="run.hy"]').wait_for(state="attached")
    assert page.locator("#code-file option").all_inner_texts() == ["picture.png", "plans.lisp", "run.hy", "turtle.hy"]
    choose(page, "Delete")
    page.get_by_role("button", name="Cancel").click()
    choose(page, "Delete")
    page.locator("dialog button.main").click()
    page.locator('#code-file option[value="run.hy"]').wait_for(state="detached")
    page.locator("#code-file").select_option("picture.png")
    wait_for(page, "#code-state", "picture.png is no text, so it is not shown here.")
    page.evaluate("localStorage.setItem('cramhy-draft:lost.lisp', '(lost)')")  # as when a tab is closed in the middle of a word
    page.locator("#repl-restart").click()
    page.locator('#code-file option[value="lost.lisp"]').wait_for(state="attached")
    open_file(page, "lost.lisp", "(lost)")
    assert page.evaluate("Object.keys(localStorage).filter((key) => key.startsWith('cramhy-draft:'))") == []


@pytest.mark.soak
def test_a_package_is_exported_and_imported_and_what_it_would_replace_is_asked(visit, tmp_path):
    page = visit()
    with page.expect_download() as saved:
        choose(page, "Export package")
        assert page.locator("dialog input").input_value() == "my_plans"
        page.keyboard.press("Enter")
    assert saved.value.suggested_filename == "my_plans.zip" and Path(saved.value.path()).read_text() == "of plans.lisp"
    page.locator("#code-zip").set_input_files({"name": "a.zip", "mimeType": "application/zip", "buffer": b"broken"})
    wait_for(page, "#code-state", "This file is broken.")
    page.locator("#code-zip").set_input_files({"name": "a.zip", "mimeType": "application/zip", "buffer": b"\x00\xff" * 20_000})
    wait_for(page, "dialog", "There is a folder my_plans already. Replace it? What is in it now is gone then.")
    page.locator("dialog button.main").click()
    wait_for(page, "#code-state", "2 files were imported.")
    wait_for(page, "#code-in .cm-line", ";; imported")


@pytest.mark.soak
def test_a_link_holds_a_file_which_is_shown_and_not_run_and_one_that_was_cut_is_told(visit):
    page = visit()
    wait_for(page, "#code-in .cm-line", "(defun one () 1)")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    code(page).click()
    page.keyboard.press("Control+Home")
    page.keyboard.type(";; ä 𝔘\n")
    choose(page, "Copy a link")
    wait_for(page, "#code-state", "A link that holds this file was copied.")
    link = page.evaluate("navigator.clipboard.readText()")
    path = link.partition("#")[2]
    other = visit(f"#{path}")
    wait_for(other, "#code-state", "This file came by a link. Look at it before you evaluate it.")
    assert text_of_editor(other) == ";; ä 𝔘\n(defun one () 1)\n"
    assert other.locator("#code-file").input_value() == "plans-2.lisp"  # the visitor's own stays
    assert transcript(other) == "" and "#" not in other.url
    for cut in (path[:-1], path[: len(path) // 2], path[:7], path.replace("code=1.", "code=1.x", 1)):
        other.evaluate("(hash) => (location.hash = hash)", cut)
        wait_for(other, "#code-state[data-kind=bad]", "This link is not whole")
        other.evaluate("document.getElementById('code-state').textContent = ''")


def test_the_lesson_is_read_typed_copied_and_its_task_is_hinted_at_and_checked(visit):
    page = visit()
    assert page.locator("#lesson-page h2").inner_text() == "1. A turtle"
    assert page.locator("#lesson-done").get_attribute("title") == "0 of 1 tasks are solved"
    page.get_by_role("button", name="Type it for me").first.click()
    wait_for(page, "#repl-out", "(start-ros-node")
    page.get_by_role("button", name="Copy into the editor").first.click()
    wait_for(page, "#code-in", '(start-ros-node "turtle1")')
    page.get_by_role("button", name="Write it for me").click()
    wait_for(page, "#code-in .cm-line", "(walk)")
    assert page.locator("#code-file").input_value() == "walks/src/walk.lisp"
    code(page).press("Control+End")
    page.keyboard.type("mine")
    page.get_by_role("button", name="Write it for me").click()
    wait_for(page, "dialog", "The file walks/src/walk.lisp has another text. Replace it?")
    page.get_by_role("button", name="Cancel").click()
    assert text_of_editor(page) == "(walk)\nmine"
    page.locator("#lesson-languages").get_by_text("Hy").click()
    assert page.locator(".sample code").all_inner_texts() == ['(start-node "turtle1")']
    page.get_by_role("button", name="Type it for me").click()
    wait_for(page, "#repl-out", "=> (start-node")
    page.get_by_role("button", name="Hint 1 of 2").click()
    assert page.locator(".hints").inner_text() == "Four sides."
    page.get_by_role("button", name="Hint 2 of 2").click()
    assert page.get_by_role("button", name="Hint").count() == 0
    page.get_by_role("button", name="Open in the editor").click()
    wait_for(page, "#code-in .cm-line", "(defn square [])")
    page.get_by_role("button", name="Check").click()
    wait_for(page, ".told.passed", "square is right.")
    assert transcript(page).endswith("=> (defn square [])\n\n17\n")
    page.get_by_role("button", name="The next page").click()
    assert page.locator("#lesson-page h2").inner_text() == "2. Plans"
    page.reload()
    page.locator("body[data-prompt=waits]").wait_for()
    page.locator("#lesson-page h2", has_text="2. Plans").wait_for()
    assert page.locator("#lesson-done").get_attribute("title") == "1 of 1 tasks are solved"


@pytest.mark.soak
def test_a_button_of_another_page_begins_a_session_and_to_look_at_it_costs_nothing(visit):
    page = visit()
    new = "This page begins a new session."

    def turn(to):
        page.get_by_role("button", name=f"The {to}").click()

    def see(text, times):
        page.locator("#repl-out", has_text=re.compile(rf"({re.escape(text)}.*){{{times}}}", re.S)).wait_for()

    def begin():
        page.get_by_role("button", name="Type it for me").first.click()

    begin()
    wait_for(page, "#repl-out", "(start-ros-node")
    turn("next page")  # and back: only looked at
    assert page.get_by_role("button", name="Begin this page anew").count() == 1
    turn("page before")
    begin()
    see("(start-ros-node", 2)
    assert new not in transcript(page)
    turn("next page")
    begin()
    wait_for(page, "#repl-out", "(top-level)")
    assert transcript(page).count(new) == 1 and page.get_by_role("button", name="Begin this page anew").count() == 0
    turn("page before")
    page.locator("#repl-in").press_sequentially("(by-hand)")
    page.keyboard.press("Enter")
    wait_for(page, "#repl-out", "(by-hand)\n")
    begin()
    see("(start-ros-node", 3)
    assert transcript(page).count(new) == 1
    turn("next page")
    page.get_by_role("button", name="Begin this page anew").click()
    see(new, 2)


def speak(page, language):
    page.locator("#lesson-languages").get_by_text(language).click()


def prompt(page, text):
    page.locator("#repl-prompt", has_text=re.compile(rf"^{re.escape(text)}\s*$")).wait_for()


@pytest.mark.soak
def test_the_prompt_speaks_the_language_of_the_lesson_and_no_page_owns_a_session_for_that(visit):
    page = visit()
    anew = page.get_by_role("button", name="Begin this page anew")
    prompt(page, "CL-USER>")
    speak(page, "Hy")
    prompt(page, "=>")
    speak(page, "Hy")  # again: nothing is typed
    page.get_by_role("button", name="The next page").click()
    assert anew.count() == 0
    page.reload()
    prompt(page, "=>")
    assert transcript(page).count("(in-hy)") == 1 and anew.count() == 0
    page.get_by_role("button", name="The page before").click()
    assert anew.count() == 0
    page.locator("#repl-in").press_sequentially("(by-hand)")
    page.keyboard.press("Enter")
    wait_for(page, "#repl-out", "=> (by-hand)\n")
    speak(page, "Lisp")
    prompt(page, "TUT>")
    page.get_by_role("button", name="The next page").click()
    assert anew.count() == 1
    speak(page, "Hy")
    anew.click()
    prompt(page, "=>")
    assert anew.count() == 0 and transcript(page).count("This page begins a new session.") == 1


@pytest.mark.soak
def test_the_prompt_keeps_its_language_until_the_debugger_is_left(visit):
    page = visit()
    page.locator("#repl-in").press_sequentially("(error)")
    page.keyboard.press("Enter")
    prompt(page, "0]")
    speak(page, "Hy")
    page.locator("#repl-in").press_sequentially("1")
    page.keyboard.press("Enter")
    prompt(page, "=>")
    assert transcript(page).endswith("0] 1\nCL-USER> (in-hy)\n")


@pytest.mark.soak
@pytest.mark.parametrize(
    ("width", "height", "beside"),
    [
        (768, 1024, {"lesson", "repl", "live"}),
        pytest.param(1500, 900, {"lesson", "code", "repl", "live"}, marks=pytest.mark.soak),
        pytest.param(1024, 768, {"lesson", "repl", "live"}, marks=pytest.mark.soak),
        pytest.param(390, 800, {"lesson"}, marks=pytest.mark.soak),
    ],
)
def test_the_page_fits_and_shows_what_there_is_room_for(visit, width, height, beside):
    page = visit(viewport={"width": width, "height": height}, color_scheme="dark", has_touch=True)
    parts = {"lesson": "#lesson", "code": "#code", "repl": "#repl", "live": ".live"}
    boxes = {name: page.locator(place).bounding_box() for name, place in parts.items() if page.locator(place).is_visible()}
    assert set(boxes) == beside
    assert page.evaluate("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]") == [width, height]
    for name, box in boxes.items():
        assert box["x"] >= 0 and box["y"] >= 0 and box["x"] + box["width"] <= width and box["y"] + box["height"] <= height, name
        assert box["width"] > 300 and box["height"] > 150, name
    for name in ("code", "repl", "live", "lesson"):
        button = page.locator(f':is(#parts, #books) button[data-part="{name}"]:visible')
        if button.count():
            button.tap()
            assert page.locator(parts[name]).is_visible() and button.get_attribute("aria-pressed") == "true"
        else:
            assert name in beside


def share(page, name):
    """(the share of the part before a bar in percent as the bar says, and its size in pixels)."""
    part = {"lesson": "#lesson", "repl": "#code", "live": ".desk"}[name]
    box = page.locator(part).bounding_box()
    return int(page.locator(f"#split-{name}").get_attribute("aria-valuenow")), round(box["height" if name == "repl" else "width"])


@pytest.mark.soak
@pytest.mark.parametrize("kind", ["chromium", pytest.param("firefox", marks=pytest.mark.soak)])
def test_parts_are_made_larger_by_mouse_and_by_keys_and_sizes_are_kept(visit, kind):
    page = visit()
    bar = page.locator("#split-live")
    assert (bar.get_attribute("aria-orientation"), bar.get_attribute("aria-valuemax")) == ("vertical", "91")
    began, width = share(page, "live")
    box = bar.bounding_box()
    page.mouse.move(box["x"] + 2, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] - 98, box["y"] + 300, steps=3)
    page.mouse.up()
    page.mouse.move(200, 200)  # which changes nothing any more
    percent, smaller = share(page, "live")
    assert abs(smaller - width + 100) <= 2 and percent < began
    rows = page.locator("#split-repl")
    assert rows.get_attribute("aria-orientation") == "horizontal"
    before, _ = share(page, "repl")
    for key, change in (("ArrowDown", 2), ("Shift+ArrowDown", 10), ("ArrowUp", -2), ("ArrowLeft", 0)):
        rows.press(key)
        after, _ = share(page, "repl")
        assert after - before == pytest.approx(change, abs=1), key
        before = after
    columns = page.locator("#split-lesson")
    columns.press("End")
    assert columns.get_attribute("aria-valuenow") == columns.get_attribute("aria-valuemax")
    assert round(page.locator("#code").bounding_box()["width"]) == 140
    columns.press("Home")
    assert round(page.locator("#lesson").bounding_box()["width"]) == 140
    assert page.locator("#notice").inner_text() == ""  # no key drove the turtle
    sizes = [share(page, name) for name in ("live", "repl", "lesson")]
    page.reload()
    page.locator("body[data-prompt=waits]").wait_for()
    assert [share(page, name) for name in ("live", "repl", "lesson")] == sizes
    columns.press("Enter")
    assert share(page, "lesson")[0] == 46
    bar.dblclick()
    assert share(page, "live") == (began, width)


@pytest.mark.soak
def test_a_finger_moves_the_bars_of_a_tablet_and_each_layout_has_its_sizes(visit):
    page = visit(viewport={"width": 768, "height": 1024}, has_touch=True)
    bar, live = page.locator("#split-live"), page.locator(".live")
    height = live.bounding_box()["height"]
    box = bar.bounding_box()
    touches = page.context.new_cdp_session(page)
    x, y = box["x"] + 300, box["y"] - 5  # a finger is not exact

    def touch(kind, *points):
        touches.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": place} for place in points]})

    touch("touchStart", y)
    for step in range(1, 6):
        touch("touchMove", y + 20 * step)
    touch("touchEnd")
    assert live.bounding_box()["height"] == pytest.approx(height + 100, abs=2)
    page.set_viewport_size({"width": 1024, "height": 768})
    page.locator("#split-live[aria-orientation=vertical]").wait_for()
    assert share(page, "live")[0] == 50
    page.set_viewport_size({"width": 768, "height": 1024})
    page.locator("#split-live[aria-orientation=horizontal]").wait_for()
    assert live.bounding_box()["height"] == pytest.approx(height + 100, abs=2)
    assert page.evaluate("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]") == [768, 1024]


@pytest.mark.soak
def test_the_page_speaks_the_language_of_the_system(visit):
    page = visit(locale="de-AT")
    assert page.locator("html").get_attribute("lang") == "de"
    assert page.locator("#code-load").inner_text() == "Datei laden"
    assert page.locator("#repl-stop").get_attribute("title") == "Ctrl-C: die laufende Form beenden"
    assert page.locator("#lesson-done").get_attribute("title") == "0 von 1 Aufgaben sind gelöst"
    assert page.locator("#show-grid").inner_text() == "Gitter"  # of the live page
    assert visit(locale="fr-FR").locator("#code-load").inner_text() == "Load file"


@pytest.mark.soak
def test_everything_is_reached_by_the_keyboard_and_has_a_name(visit):
    page = visit()
    wait_for(page, "#code-in .cm-line", "(defun one () 1)")
    unnamed = page.evaluate(
        """[...document.querySelectorAll("button, select, input, summary, [tabindex]")].filter((each) => each.checkVisibility() && !(
        each.textContent.trim() || each.labels?.length || each.ariaLabel || each.title || each.getAttribute("aria-labelledby"))).map((each) => each.outerHTML)"""
    )
    assert unnamed == []
    seen = set()
    page.locator("body").press("Tab")
    for _ in range(80):
        seen.add(page.evaluate("(document.activeElement.shadowRoot?.activeElement ?? document.activeElement).id"))
        if page.evaluate("Boolean(document.activeElement.shadowRoot)"):
            page.keyboard.press("Escape")  # the editor has Tab for itself, but after Escape
        page.keyboard.press("Tab")
    assert {
        "lesson-pages",
        "lesson-page",
        "code-file",
        "code-form",
        "code-in",
        "repl-out",
        "repl-in",
        "repl-restart",
        "paper",
        "pause",
        "moment",
    } <= seen
    page.locator("#repl-in").press("ArrowUp")
    assert page.locator("#notice").inner_text() == ""  # the arrow did not drive the turtle


@pytest.mark.soak
def test_the_packages_of_the_editor_are_those_that_npm_fetches():
    fetched = json.loads((Path(__file__).parents[2] / "webassembly" / "package.json").read_text())["dependencies"]
    assert {name: version for name, version in fetched.items() if name != "pyodide"} == bundling.PACKAGES


def test_the_licenses_of_what_is_in_the_editor_come_along():
    text = (
        bundling.licenses(pyodide_files.FETCHED)
        if (pyodide_files.FETCHED / "esbuild").is_dir()
        else pytest.skip("make pyodide fetches them")
    )
    assert [line for line in text.splitlines() if line in ("@codemirror/view", "@lezer/common", "crelt", "style-mod")] == [
        "@codemirror/view",
        "@lezer/common",
        "crelt",
        "style-mod",
    ]
    assert text.count("Permission is hereby granted") == text.count("THE SOFTWARE IS PROVIDED") >= 12


@pytest.mark.soak
def test_without_the_packages_of_the_editor_the_command_says_what_to_type(tmp_path):
    with pytest.raises(bundling.NoBundle) as refused:
        bundling.check(tmp_path)
    wanted = ", ".join(f"{name} {version}" for name, version in bundling.PACKAGES.items())
    assert str(refused.value) == (
        f"The page's editor is made of packages of npm, and {tmp_path} lacks {wanted}. In a clone of cramhy, type: make pyodide. "
        f"Elsewhere type, beside the package pyodide: npm install {wanted.replace(', ', ' ').replace(' 6', '@6').replace(' 1', '@1').replace(' 0', '@0')}"
    )


def test_what_the_page_says_is_in_the_table_of_the_other_language():
    folder = Path(site.__file__).parent
    table = (folder / "static" / "desk-german.js").read_text(encoding="utf-8")
    known = {json.loads(text) for text in re.findall(r'^  ("(?:[^"\\]|\\.)*"):', table, re.M)}
    scripts = "\n".join(file.read_text(encoding="utf-8") for file in (folder / "static").glob("*.js") if file.name != "desk-german.js")
    said = {json.loads(text) for text in re.findall(r'(?:\bt|\bthis\.say|UnfitLink)\(\s*("(?:[^"\\]|\\.)+")', scripts)}
    markup = (folder / "desk.html").read_text(encoding="utf-8")
    said |= {" ".join(text.split()) for text in re.findall(r">([^<>]*[a-z]{3}[^<>]*)<", markup)} - {"Lisp"}
    said |= set(re.findall(r'(?:title|aria-label)="([^"]+)"', markup))
    assert said - known == set() and len(said) > 70
