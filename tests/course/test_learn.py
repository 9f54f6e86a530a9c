"""The prompt of ``cramhy learn``: its commands beside the forms, wrong input, files of the student, and what is kept between two runs."""

from __future__ import annotations

import contextlib
import io
import json

import pytest

from cramhy_runtime.course import learn, reading
from cramhy_runtime.course.guide import command, meant
from cramhy_runtime.course.progress import Progress
from cramhy_runtime.course.shown import Style, text
from cramhy_runtime.repl.session import Session

from .walking import Script


@pytest.fixture
def typed(tmp_path):
    """typed(lines, page, language, progress): what the screen shows."""

    def run(lines, page="first-forms", language="lisp", progress=None):
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
            learn.run(
                lambda closings: Session(time="virtual"),
                language,
                page,
                tmp_path / "files",
                progress or Progress(),
                Style(),
                Script(iter(lines)),
            )
        return out.getvalue()

    return run


@pytest.mark.parametrize(
    ("line", "found"),
    [
        (":next", ("next", "")),
        (" next ", ("next", "")),
        (":n", ("next", "")),
        ("n", None),
        (":PAGE 3", ("page", "3")),
        ("page lecture-34", ("page", "lecture-34")),
        (":page", ("page", "")),
        ("page", None),
        (":?", ("help", "")),
        ("next page", None),
        (":next 2", None),
        ("(next)", None),
        (":left", None),
        ("", None),
    ],
)
def test_lines_that_are_commands(line, found):
    assert command(line) == found


@pytest.mark.parametrize(
    ("line", "near"), [(":nxt", ":next"), (":chek", ":check"), (":hnit", ":hint"), (":left", None), ("nxt", None), ("(x)", None)]
)
def test_a_mistyped_command_is_guessed(line, near):
    told = meant(line)
    assert told is None if near is None else told.endswith(f"Did you mean {near}?")


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_commands_stand_beside_forms(typed, language):
    shown = typed(
        ["(+ 40 2)", ":next", ":back", ":back", ":hint", ":check", ":write", ":again", ":help", ":pages", ":quit", "(+ 1 1)"],
        language=language,
    )
    assert "\n42\n" in shown and "Page 1, step 2 of " in shown and shown.count("Page 1, step 1 of ") == 3
    assert "This is the first step of the first page." in shown
    for told in (
        "Only tasks have hints",
        "Only tasks are checked",
        "This step has no file",
        ":next    :n   the next step",
        "-->" not in shown and "-> ",
    ):
        assert told in shown
    assert "11  Tests" in shown and not shown.rstrip().endswith("2")


def test_what_was_copied_with_the_prompt_is_understood(typed):
    assert "\n42\n" in typed(["CL-USER> (+ 40 2)", ":quit"])
    assert "\n42\n" in typed(["=> (+ 40 2)", ":quit"], language="hy")


@pytest.mark.parametrize(("language", "define"), [("lisp", "(defvar next 42)"), ("hy", "(setv next 42)")])
def test_a_variable_of_the_students_is_no_command(typed, language, define):
    shown = typed([define, "next", ":next", ":quit"], language=language)
    assert "\n42\n" in shown and shown.count("--- Page") == 2


def test_a_command_in_the_middle_of_a_form_belongs_to_the_form(typed):
    assert "(1\n :NEXT)" in typed(["'(1", ":next", ")", ":quit"]).replace("(1 :NEXT)", "(1\n :NEXT)")


@pytest.mark.parametrize("language", ["lisp", "hy"])
@pytest.mark.parametrize(("line", "told"), [(":next", True), (":n", True), (":red", False), ("next", False)])
def test_a_command_in_an_open_form_is_told_to_be_none(typed, language, line, told):
    shown = typed(["(defn f []" if language == "hy" else "(defun f ()", line, "1)", ":quit"], language=language)
    assert ("A form is open, and :next is taken for a part of it." in shown) is told


def test_all_forms_typed_is_told_once(typed):
    shown = typed(["42", "(+ 1  2)", "(max 3 7 5)", "1", "1", ":quit"])
    assert shown.count("To see the next step, type :next") == 1


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_hints_come_one_after_the_other_and_begin_again(typed, language):
    shown = typed([":n", ":n", ":hint", ":h", "hint", ":hint", ":quit"], language=language)
    assert shown.count("Hint 1 of 2") == 2 and shown.count("Hint 2 of 2") == 1 and shown.count("There are no more hints.") == 1


def test_in_the_debugger_nothing_is_checked_and_hints_are_given(typed):
    shown = typed([":n", ":n", "(car 7)", ":check", ":hint", "q", "(* 24 60 60)", ":check", ":quit"])
    assert "The debugger is open. Leave it first" in shown and "Hint 1 of 2" in shown and "Well done" in shown


@pytest.mark.parametrize(
    ("page", "language", "there"),
    [("lecture-34", "lisp", "cram_my_beginner_tutorial/src/package.lisp"), ("lecture-34", "hy", "my_turtle/control_turtlesim.hy")],
)
def test_files_are_written_and_those_of_the_student_stay(typed, tmp_path, page, language, there):
    file = tmp_path / "files" / "lectures" / there
    number = 2 if language == "lisp" else 1
    assert f"Written: {there}" in typed([*[":next"] * number, ":quit"], page, language)
    written = file.read_text()
    file.write_text("; mine\n")
    shown = typed([*[":next"] * number, ":quit"], page, language)
    assert "with a text of your own. It stays." in shown and file.read_text() == "; mine\n"
    shown = typed([*[":next"] * (number - 1), ":write", ":write", ":quit"], page, language)
    assert file.read_text() == written and file.with_name(file.name + ".old").read_text() == "; mine\n"
    assert "is there already, as it is shown" in shown


def test_a_later_page_has_the_files_of_the_earlier_ones(typed, tmp_path):
    typed([":quit"], "lecture-38")
    place = tmp_path / "files" / "lectures" / "cram_my_beginner_tutorial"
    assert {path.name for path in (place / "src").iterdir()} == {
        "package.lisp",
        "control-turtlesim.lisp",
        "simple-plans.lisp",
        "motion-designators.lisp",
    }
    assert "motion-designators" in (place / "cram-my-beginner-tutorial.asd").read_text()


def test_a_page_begins_with_a_fresh_image(typed):
    shown = typed(["(defvar *old* 1)", ":page 2", "*old*", "3", ":quit"])
    assert "The variable *OLD* is unbound." in shown


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(reading.PageError, match=r"The folder .*file.* cannot be used .*cramhy learn --folder FOLDER"):
        learn.run(lambda closings: Session(time="virtual"), "lisp", "lecture-34", tmp_path / "file", Progress(), Style(), Script(iter([])))


def test_progress_is_kept_and_the_next_run_goes_on_there(typed, tmp_path):
    path = tmp_path / "state" / "learn.json"
    typed([":n", ":n", "(* 24 60 60)", ":check", ":n", ":quit"], progress=Progress(str(path)))
    again = Progress(str(path))
    assert (again.page, again.steps, again.solved) == ("first-forms", {"first-forms": 3}, {"seconds-of-a-day"})
    shown = typed([":pages", ":quit"], None, progress=again)
    assert "Page 1, step 4 of " in shown and "1 of 5 tasks solved" in shown


@pytest.mark.parametrize(
    "content",
    ["", "{", "[]", "null", '{"page": 3}', json.dumps({"page": "x", "steps": {"x": -1}, "solved": []}), '{"page": "a", "steps": [], "solved": 0}', "\0" * 100],
)  # fmt: skip
def test_a_file_of_progress_that_is_broken_is_no_progress(tmp_path, content, typed):
    path = tmp_path / "learn.json"
    path.write_text(content)
    progress = Progress(str(path))
    assert (progress.page, progress.steps, progress.solved) == (None, {}, set())
    assert "Page 1, step 1 of " in typed([":quit"], None, progress=progress)
    assert json.loads(path.read_text())["page"] == "first-forms"


def test_a_place_of_an_older_course_is_brought_into_this_one(typed):
    progress = Progress()
    progress.page, progress.steps = "gone", {"first-forms": 99}
    assert "Page 1, step " in typed([":quit"], None, progress=progress)


def test_text_for_a_terminal():
    markdown = "## Head\n\nA `word` and *more*,\n[a link](x.md#y), **strong**.\n\n* one\n* two\n\n1. `(* 2 *x*)`\n\n```lisp\n(a)\n```\n\n| a | b |\n|---|---|\n| `c` | d |"
    plain = text(markdown, Style(40))
    assert plain == "Head\n\nA word and more, a link, strong.\n\n  * one\n  * two\n\n  1. (* 2 *x*)\n\n    (a)\n\n  a  b\n  c  d"
    coloured = text("Type `(a b)` now.", Style(40, True))
    assert coloured == "Type \x1b[36m(a b)\x1b[0m now."


@pytest.mark.parametrize("width", [30, 40, 96])
def test_no_paragraph_is_wider_than_the_terminal(width):
    from cramhy_runtime.course.parts import Text

    for page in reading.pages():
        for part in page.parts:
            if isinstance(part, Text):
                shown = [line for line in text(part.markdown, Style(width)).split("\n") if not line.startswith("    ") and "  " not in line]
                assert not [line for line in shown if len(line) > width and len(max(line.split(), key=len)) < width]
