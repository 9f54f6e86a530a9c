"""The prompt of ``cramhy learn``: its commands beside the forms, wrong input, files of the student, and what is kept between two runs."""

from __future__ import annotations

import json
import sys
import types as python_types

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cramhy_runtime.course import contents, learn, reading
from cramhy_runtime.course.guide import Guide, command, meant
from cramhy_runtime.course.parts import Code, File, Page, Text, Typed
from cramhy_runtime.course.progress import Progress
from cramhy_runtime.course.shown import Style, filled, text
from cramhy_runtime.course.steps import answer_shown, steps
from cramhy_runtime.repl.session import Session

from .walking import Script


def step_with(page, language, wanted):
    """The command that leads to the first step of the page with that number whose part is as wanted, or has a task of that name."""
    found = steps(reading.page(contents.NAMES[page - 1]), language)
    for number, step in enumerate(found, 1):
        if getattr(step.part, "name", None) == wanted if isinstance(wanted, str) else wanted(step.part):
            return f":page {page} {number}"
    raise AssertionError(f"no step of page {page} is as wanted")


def types(beginning):
    """Whether a part of a page has a form that begins so."""
    return lambda part: any(typed.form.startswith(beginning) for typed in getattr(part, "lisp", None) or () if isinstance(part, Code))


TASK = {language: step_with(1, language, "seconds-of-a-day") for language in ("lisp", "hy")}
"""Leads to the first task of the first page."""


LAST = len(steps(reading.page("first-forms"), "lisp"))


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
        (":page 3 2", ("page", "3 2")),
        (":page 3 2 1", ("page", "")),
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
    ("line", "near"),
    [(":nxt", ":next"), (":chek", ":check"), (":hnit", ":hint"), (":left", None), (":left right", None), ("nxt", None), ("(x)", None)],
)
def test_a_mistyped_command_is_guessed(line, near):
    told = meant(line)
    assert told is None if near is None else told.endswith(f"Did you mean {near}?")


@pytest.mark.parametrize(
    ("line", "told"), [(":next 2", True), (":c seconds", True), (":page 3", False), (":red 2", False), ("next 2", False)]
)
def test_a_command_with_words_behind_it_is_told_to_stand_alone(line, told):
    assert (meant(line) is not None and "stands alone in its line" in meant(line)) is told


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
        ":page         go to a page, by its number: :page 3",
        "-->" not in shown and "-> ",
    ):
        assert told in shown
    assert "12  Tests" in shown and not shown.rstrip().endswith("2")


def test_what_was_copied_with_the_prompt_is_understood(typed):
    assert "\n42\n" in typed(["CL-USER> (+ 40 2)", ":quit"])
    assert "\n42\n" in typed(["=> (+ 40 2)", ":quit"], language="hy")


@pytest.mark.parametrize(("language", "define"), [("lisp", "(defvar next 42)"), ("hy", "(setv next 42)")])
def test_a_variable_of_the_students_is_no_command(typed, language, define):
    shown = typed([define, "next", ":next", ":quit"], language=language)
    assert "\n42\n" in shown and shown.count("--- Page") == 2


def test_a_command_in_the_middle_of_a_form_is_no_part_of_it(typed):
    assert ")\n(1)\n" in typed(["'(1", ":next", ")", ":quit"])
    assert "(1 :NEXT)" in typed(["'(1", " 2 :next", ")", ":quit"]).replace("(1 2 :NEXT)", "(1 :NEXT)")


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("language", ["lisp", "hy"])
@pytest.mark.parametrize(("line", "told"), [(":next", True), (":n", True), (":red", False), ("next", False)])
def test_a_command_in_an_open_form_is_told_to_be_none(typed, language, line, told):
    shown = typed(["(defn f []" if language == "hy" else "(defun f ()", line, "1)", ":quit"], language=language)
    assert ("A form is open, so :next has to wait" in shown) is told


def test_all_forms_typed_is_told_once(typed):
    shown = typed(["42", "(+ 1  2)", "(max 3 7 5)", "1", "1", ":quit"])
    assert shown.count("To see the next step, type :next") == 1


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_hints_come_one_after_the_other_and_begin_again(typed, language):
    shown = typed([TASK[language], ":hint", ":h", "hint", ":hint", ":quit"], language=language)
    assert shown.count("Hint 1 of 2") == 2 and shown.count("Hint 2 of 2") == 1 and shown.count("There are no more hints.") == 1


def test_in_the_debugger_nothing_is_checked_and_hints_are_given(typed):
    shown = typed([TASK["lisp"], "(car 7)", ":check", ":hint", "(car 8)", "q", "(* 24 60 60)", ":check", ":quit"])
    assert "; The debugger is open. Type q first, and then :check." in shown and "Hint 1 of 2" in shown and "Well done" in shown
    assert shown.count("; q leads back to the prompt. You need not read the choices.") == 2


def test_who_goes_on_in_the_debugger_is_told_once(typed):
    shown = typed(["(car 7)", "(+ 1 2)", "(+ 1 3)", ":next", "q", ":next", ":quit"])
    assert shown.count("; You are in the debugger still. q leads back to the prompt.") == 1
    assert "; The debugger is open. Type q first, and then :next." in shown and shown.count("--- Page 1, step 2") == 1
    assert "in the debugger still" not in typed(["(car 7)", "q", "(car 8)", "q", ":quit"])


@pytest.mark.parametrize(
    ("page", "language", "there"),
    [("lecture-34", "lisp", "cram_my_beginner_tutorial/src/package.lisp"), ("lecture-34", "hy", "my_turtle/control_turtlesim.hy")],
)
def test_files_are_written_and_those_of_the_student_stay(typed, tmp_path, page, language, there):
    file = tmp_path / "files" / "lectures" / there
    number = next(
        number for number, step in enumerate(steps(reading.page(page), language), 1)
        if step.piece and step.piece.number == step.piece.count and getattr(step.part, language)[0] == there
    )  # fmt: skip
    assert f"Written: files/lectures/{there}" in typed([*[":next"] * number, ":quit"], page, language)
    written = file.read_text()
    file.write_text("; mine\n")
    shown = typed([*[":next"] * number, ":quit"], page, language)
    assert "with a text of your own. It stays." in shown.replace("\n; ", " ") and file.read_text() == "; mine\n"
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


@pytest.mark.soak
def test_a_module_from_elsewhere_does_not_stand_for_the_courses(typed, monkeypatch):
    other = python_types.ModuleType("turtlesim_in_hy")
    monkeypatch.setitem(sys.modules, "turtlesim_in_hy", other)
    shown = typed(["(import turtlesim-in-hy.process-modules [init])", "(callable init)", ":quit"], "choosing-a-module", "hy")
    assert "\nTrue\n" in shown and sys.modules["turtlesim_in_hy"] is other


def test_a_page_begins_with_a_fresh_image(typed):
    shown = typed(["(defvar *old* 1)", ":page 2", "*old*", "3", ":quit"])
    assert "The variable *OLD* is unbound." in shown


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(reading.PageError, match=r"The folder .*file.* cannot be used .*cramhy learn --folder FOLDER"):
        learn.run(lambda closings: Session(time="virtual"), "lisp", "lecture-34", tmp_path / "file", Progress(), Style(), Script(iter([])))


def test_progress_is_kept_and_the_next_run_goes_on_there(typed, tmp_path):
    path = tmp_path / "state" / "learn.json"
    typed([TASK["lisp"], "(* 24 60 60)", ":check", ":n", ":quit"], progress=Progress(str(path)))
    again, place = Progress(str(path)), int(TASK["lisp"].split()[-1])
    assert (again.page, again.steps, again.solved) == ("first-forms", {"first-forms": place}, {"seconds-of-a-day"})
    shown = typed([":pages", ":quit"], None, progress=again)
    assert f"Page 1, step {place + 1} of " in shown and "1 of 3 tasks solved" in shown


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    ("first", "chosen", "shown"), [("hy", None, "hy"), ("lisp", None, "lisp"), ("hy", "lisp", "lisp"), (None, None, "lisp")]
)
def test_who_comes_back_learns_in_the_language_of_the_last_time(typed, tmp_path, first, chosen, shown):
    path = str(tmp_path / "learn.json")
    if first:
        typed([":quit"], None, first, Progress(path))
    typed([TASK[shown], ":quit"], None, chosen, Progress(path))
    assert Progress(path).language == shown
    assert list(Progress(path).typed)[-1].endswith(f" {shown}")


@pytest.mark.parametrize(
    "content",
    ["", "{", "[]", "null", '{"page": 3}', json.dumps({"page": "x", "steps": {"x": -1}, "solved": []}), '{"page": "a", "steps": {}, "solved": [], "typed": {"a": 7}}', '{"page": "a", "steps": [], "solved": 0}', '{"page": "a", "steps": {}, "solved": [], "language": "C"}', "\0" * 100],
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


# ------------------------------------------------------------------------------------------------------------------ from day to day

DEFINED = {
    "lisp": ["(defun twice (x)", "  (* 2 x))", "(defvar *n* (twice 4))", "(car 7)", "(print *n*)", "q", "(in-package :cl)", "'car"],
    "hy": ["(defn twice [x]", "  (* 2 x))", "(setv n (twice 4))", "(/ 1 0)", "(in-package :cl)", "'car"],
}
"""Texts of which one ends in an error: that one is not typed again."""


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_what_was_typed_in_an_earlier_session_is_typed_again(typed, tmp_path, language):
    path = str(tmp_path / "learn.json")
    lines = [":n", *DEFINED[language], ":quit"]
    shown = typed(lines, language=language, progress=Progress(path))
    assert "The session is a new one" not in shown
    value = "(list cl-user::*n* (cl-user::twice 21))" if language == "lisp" else "(in-hy)\n[n (twice 21)]"
    shown = typed([":replay", *value.split("\n"), ":replay", ":quit"], None, language, Progress(path))
    assert "; The session is a new one: what you defined on this page before is not there. :replay types it" in shown
    assert ("\n(8 42)\n" if language == "lisp" else "\n[8 42]\n") in shown, shown
    assert "(car 7)" not in shown and "(print" not in shown and "(/ 1 0)" not in shown
    assert ":: There is nothing to type again." in shown.replace("; There is", ":: There is")
    shown = typed([":replay", ":quit"], None, language, Progress(path))
    assert shown.count("(* 2 x)") == 1, "what was typed again was kept twice"


def test_who_begins_a_page_anew_has_nothing_typed_again(typed, tmp_path):
    path = str(tmp_path / "learn.json")
    typed([":n", "(defvar *n* 1)", ":b", ":quit"], progress=Progress(path))
    assert "The session is a new one" not in typed([":quit"], None, progress=Progress(path))
    assert "nothing to type again" in typed([":n", ":replay", ":quit"], None, progress=Progress(path))


def test_an_error_ends_what_is_typed_again(typed, tmp_path):
    progress = Progress()
    progress.steps, progress.typed = {"first-forms": 1}, {"first-forms lisp": ["(defvar *a* 1)", "(car 7)", "(defvar *b* 2)"]}
    shown = typed([":replay", "q", "(boundp '*a*)", "(boundp '*b*)", ":quit"], progress=progress)
    assert "\nT\n" in shown and "\nNIL\n" in shown


def test_tasks_that_are_left_unsolved_are_told(typed):
    shown = typed([TASK["lisp"], ":next", f":page 1 {LAST}", ":quit"])
    assert "You have not typed :check for this task: The seconds of a day. :back leads back to it." in shown
    end = shown[shown.index(f"step {LAST} of {LAST}") :]
    left = step_with(1, "lisp", "turn-left")
    assert f"; Not solved yet: The seconds of a day ({TASK['lisp']})\n; Not solved yet: Turn to the left ({left})\n" in end
    shown = typed([TASK["lisp"], "(* 24 60 60)", ":check", ":next", f":page 1 {LAST}", ":quit"])
    assert "The seconds of a day (:page" not in shown and ":back leads back" not in shown
    assert "The task is not solved yet: The seconds of a day." in typed([TASK["lisp"], "(* 24 60)", ":check", ":next", ":quit"])


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    ("argument", "told"),
    [("1 2", "Page 1, step 2 of"), ("2 3", "Page 2, step 3 of"), ("1 99", f"Page 1 has the steps 1 to {LAST}"), ("1 0", f"steps 1 to {LAST}"),
     ("2 x", "Page 2 has the steps 1 to "), ("99 1", "Which page?"), ("lecture-34 2", "Page 4, step 2 of")],
)  # fmt: skip
def test_a_step_of_a_page_is_reached_by_its_number(typed, argument, told):
    assert told in typed([f":page {argument}", ":quit"])


@pytest.mark.parametrize("line", ["* 24 60 60", "+ 1 2.5", "- 3 -4"])
def test_a_call_without_parentheses_is_told(typed, line):
    shown = typed([line, "*", ":quit"])
    assert (
        f"A call has parentheses around it: ({line})" in " ".join(shown.split()).replace("; ", "") and shown.count("form of its own") == 1
    )


def test_remarks_are_filled_to_the_width_of_the_terminal():
    assert filled("; one two three four five six seven eight", Style(30)) == "; one two three four five six\n; seven eight"
    assert filled("short", Style(30)) == "short" and filled("    code " * 9, Style(30)) == "    code " * 9


# ------------------------------------------------------------------------------------------------------------- what beginners run into


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_the_forms_of_a_step_are_typed_for_you(typed, language):
    shown = typed([":type", ":t", ":type", ":type", TASK[language], ":type", ":quit"], language=language)
    assert "(max 3 7 5)\n7\n" in shown and shown.count("To see the next step, type :next") == 1
    assert "This step has nothing more to type." in shown and "A task is for you to type." in shown
    begun = typed([step_with(2, language, "rectangle"), ":type", "(rectangle-around 2 3)", ":check", ":quit"], "first-forms", language)
    assert "(rectangle-around 2 3)\n5\n" in begun and "Not yet." in begun


def test_the_mistake_on_purpose_is_typed_too_and_left(typed):
    for out in ("q", "3", ":type"):
        shown = typed([step_with(1, "lisp", types("(+ 1 two)")), ":type", out, ":type", ":quit"])
        assert shown.count("To see the next step, type :next") == 1 and shown.count("debugger invoked on") == 2, out


def test_a_form_that_fails_is_still_to_be_typed(typed):
    lines = [
        step_with(1, "lisp", types("(ros-load:")),
        "(in-package :nowhere)",
        "q",
        '(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)',
    ]
    before = typed([*lines, "(init)", "q", "(in-package :tut)", ":quit"])
    assert "To see the next step" not in before
    assert "To see the next step" in typed([*lines, "(in-package :tut)", "(init)", ":quit"])


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("language", ["lisp", "hy"])
@pytest.mark.parametrize(
    ("line", "told"), [("", "A form is open. Close it by )), or"), ("q", "and q is taken for a part of it"), ("7", None)]
)
def test_who_does_not_see_that_a_form_is_open_is_told(typed, language, line, told):
    shown = typed(["(+ 1 (* 2 3", line, "))" if line != "q" else "(abs 1)))", ":quit"], language=language)
    assert (told in shown) if told else ("A form is open" not in shown)


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_function_that_was_defined_again_is_typed_again_as_it_was_last(typed, tmp_path, language):
    path = str(tmp_path / "learn.json")
    define = "(defun f (x) (* {} x))" if language == "lisp" else "(defn f [x] (* {} x))"
    typed(
        [":n", define.format(2), "(setf *a* 1)" if language == "lisp" else "(setv a 1)", define.format(3), ":quit"],
        language=language,
        progress=Progress(path),
    )
    shown = typed([":replay", "(f 7)", ":quit"], None, language, Progress(path))
    assert "; Typed again: 2 texts." in shown and "(* 2 x)" not in shown and "\n21\n" in shown


def test_hints_go_on_where_they_were(typed):
    shown = typed([TASK["lisp"], ":hint", ":next", ":back", ":hint", ":quit"])
    assert shown.count("Hint 1 of 2") == 1 and shown.count("Hint 2 of 2") == 1


LOAD = ['(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)', "(in-package :tut)", "(init)"]


def test_another_node_that_drives_the_turtle_is_named(typed):
    shown = typed([*LOAD, step_with(1, "lisp", "first-square"), "(turtlesim:draw-square)", "(defun drive-square () 1)", ":check", ":quit"])
    assert "The node /draw_square may drive the turtle, too. End it: rosnode kill /draw_square" in shown
    assert "may drive the turtle" not in typed(
        [*LOAD, step_with(1, "lisp", "first-square"), "(turtlesim:press :up)", "(defun drive-square () 1)", ":check", ":quit"]
    )


def test_many_lines_of_the_log_are_cut_where_a_step_is_shown(typed):
    shown = typed([step_with(1, "lisp", types("(ros-load:")), ":quit"])
    assert "[... some lines of the log]" in shown and "INFO]" not in shown


# ------------------------------------------------------------------------------------------------------------- the size of a step


@pytest.mark.soak(all_but=7)
@pytest.mark.parametrize("language", ["lisp", "hy"])
@pytest.mark.parametrize("name", contents.NAMES)
def test_each_step_fits_a_terminal_of_24_rows_of_80_columns_with_the_prompt(name, language):
    guide = Guide(name, language, Progress(), Style(79))
    for place in range(len(guide.steps)):
        guide.place = place
        rows = [
            row for line in guide.show().split("\n") for row in (filled(line, guide.style) if line.startswith("; ") else line).split("\n")
        ]
        assert len(rows) <= 23 and max(map(len, rows)) < 80, "\n".join(rows)


LONG = [f"(defun f{number} (x)\n  (+ x\n     {number}))" for number in range(20)]


@given(
    st.lists(st.sampled_from(["A paragraph of a few words. " * 9, "# Heading", "These are them:", "* one\n* two", "```\n" + "\n\n".join(LONG) + "\n```"])),
    st.lists(st.builds(Typed, st.just("CL-USER> "), st.sampled_from(LONG), st.integers(0, 40).map(lambda count: "line\n" * count)), max_size=9).map(tuple),
    st.sampled_from(["code", "file", "nothing"]),
)  # fmt: skip
def test_a_page_is_cut_into_steps_without_loss(texts, typed, kind):
    markdown, file = "\n\n".join(texts), ("f.lisp", "\n\n".join(each.form for each in typed) + "\n")
    parts = {"code": [Code(lisp=typed)], "file": [File(lisp=file)], "nothing": []}[kind] if typed else []
    found = steps(Page("p", "P", (Text(markdown), *parts)), "lisp")
    words = [word for step in found for text in step.texts for word in text.split() if word != "```"]
    assert words == [word for word in markdown.split() if word != "```"]
    assert tuple(each for step in found if isinstance(step.part, Code) for each in step.part.lisp) == (typed if kind == "code" else ())
    pieces = [step.piece for step in found if step.piece]
    assert "\n".join(piece.text for piece in pieces) == (file[1] if kind == "file" and typed else "")
    assert [piece.number for piece in pieces] == list(range(1, len(pieces) + 1))


def test_a_long_answer_is_shown_without_its_middle_and_an_error_from_its_beginning():
    answer = "one line\n" * 9 + "debugger invoked on a BAD:\n  It is bad.\n" + "a restart\n" * 9 + "last\n"
    assert answer_shown(Typed("CL-USER> ", "(bad)", answer)).splitlines() == [
        "[... 9 lines more when you type it]", "debugger invoked on a BAD:", "  It is bad.", *["a restart"] * 7,
        "[... 2 lines more when you type it]", "last",
    ]  # fmt: skip
    assert answer_shown(Typed("CL-USER> ", "(good)", "line\n" * 12)) == "line\n" * 12
    short = "one line\n" * 20 + "debugger invoked on a BAD:\n  It is bad.\n"
    told = "[... 20 lines more when you type it]\ndebugger invoked on a BAD:\n  It is bad.\n"
    assert answer_shown(Typed("CL-USER> ", "(bad)", short)) == told


def test_a_slip_is_told_below_the_answer_of_the_prompt(typed):
    assert "; Not evaluated: math\n; In Hy this is written (import math)\n=> " in typed(["import math", ":quit"], language="hy")
    told = typed(["max(3, 7, 5)", "q", ":quit"])
    assert "; In Lisp this is written (max 3 7 5)\n; q leads back to the prompt." in told and told.count("written (max 3 7 5)") == 1


@pytest.mark.parametrize(("language", "define", "leave"), [("lisp", "(defun ahead (metres)", ["q"]), ("hy", "(defn ahead [metres]", [])])
def test_a_form_that_was_passed_over_is_named_when_it_is_missed(typed, language, define, leave):
    place = step_with(1, language, lambda part: any(each.form.startswith(define) for each in getattr(part, language, None) or ()))
    told = " ".join(typed([place, ":next", "(ahead 1)", *leave, ":quit"], language=language).replace("\n;", " ").split())
    assert f"ahead is defined by a form that you have not typed: {define} ... {place} leads back to it." in told


def test_a_check_tells_no_warnings_of_the_compiler(typed):
    task = step_with(2, "lisp", "rectangle")
    told = typed([task, ":check", "(defun rectangle-around (width height) (* 4 width))", ":quit"], "names-and-functions")
    before, after = told.split("(defun rectangle-around (width height) (* 4", 1)
    assert "There is no function rectangle-around yet." in before and "STYLE-WARNING" not in before
    assert "The variable HEIGHT is defined but never used." in after


# --------------------------------------------------------------------------------------------- errors in files of the course

LOADING = {
    "lisp": LOAD[:2],
    "hy": ["(import turtlesim-in-hy.process-modules [init])", "(import turtlesim-in-hy.selecting-process-modules [perform-some-motion])"],
}
DRIVE = "(perform-some-motion (desig:a motion (type {}) (speed 3)))"


def words(shown):
    """The words of the guide's remarks, without the line ends that the width made."""
    return " ".join(shown.replace("\n;", " ").split())


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_an_error_in_a_file_leads_to_the_line_of_the_student(typed, language):
    name = {"lisp": "(defun dash ()", "hy": "(defn dash []"}[language]
    lines = [":page 8 99", *LOADING[language], "(init)", name, f"  {DRIVE.format('drving')})", "(dash)", "q" if language == "lisp" else "1"]
    shown = words(typed([*lines, ":quit"], "choosing-a-module", language))
    assert f"In what you have typed, this leads there: {DRIVE.format('drving')})" in shown
    direct = words(typed([*lines[:4], DRIVE.format("drving"), ":quit"], "choosing-a-module", language))
    assert "No matching process module found" in direct and "this leads there" not in direct


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_robot_that_was_not_started_is_told(typed, language):
    place = step_of_form(8, language, "(init)")
    shown = words(typed([place, ":next", *LOADING[language], DRIVE.format("driving"), ":quit"], "choosing-a-module", language))
    assert f"The robot is started by a form that you have not typed: (init). {place} leads back to it." in shown
    value = "(with-fields (x) (value *turtle-pose*) x)" if language == "lisp" else "(with-fields [x] turtle-pose.value x)"
    more = [] if language == "lisp" else ["(import turtlesim-in-hy.control-turtlesim [turtle-pose])"]
    shown = words(typed([place, ":next", *LOADING[language], *more, value, ":quit"], "choosing-a-module", language))
    assert "No message is there yet" in shown and f"(init). {place} leads back to it." in shown
    shown = typed([place, ":next", *LOADING[language], "(init)", DRIVE.format("driving"), ":quit"], "choosing-a-module", language)
    assert "The robot is started" not in shown


def test_a_keyword_in_the_place_of_a_text_is_told_in_hy(typed):
    shown = words(typed(["(defn go [where #^ int how] where)", "(go :right 7)", ":quit"], language="hy"))
    assert 'In Hy a word behind a colon says which argument comes next. Write a text if it is a value: "right"' in shown


@pytest.mark.soak
def test_a_package_of_names_that_was_not_chosen_is_told(typed):
    place = step_of_form(8, "hy", "(lisp-package :turtlesim-in-hy)")
    plan = "(top-level (with-process-modules-running [turtlesim-navigation] (sleep 0)))"
    shown = words(typed([place, ":next", *LOADING["hy"], plan, ":quit"], "choosing-a-module", "hy"))
    told = (
        f"The names of turtlesim-in-hy are there after a form that you have not typed: (lisp-package :turtlesim-in-hy). {place} leads back"
    )
    assert told in shown
    shown = typed([place, "(lisp-package :turtlesim-in-hy)", *LOADING["hy"], plan, ":quit"], "choosing-a-module", "hy")
    assert "that you have not typed" not in shown and "Unknown process module" not in shown


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_check_that_fails_names_what_the_page_begins_with(typed, language):
    first = {"lisp": LOAD[0], "hy": "(lisp-package :turtlesim-in-hy)"}[language]
    lines = [step_of_form(8, language, first), step_with(8, language, "dancing"), ":check", ":quit"]
    assert f"a form that you have not typed: {first}" in words(typed(lines, "choosing-a-module", language))


def step_of_form(page, language, form):
    """The command that leads to the first step of the page with that number that has the form."""
    return step_with(
        page, language, lambda part: isinstance(part, Code) and any(each.form == form for each in getattr(part, language) or ())
    )


def test_later_pages_have_the_package_of_the_course_beside_that_of_the_student(typed, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # below which the student's package lies, too
    typed([":quit"], "lecture-38")
    assert (tmp_path / "files/lectures/cram_my_beginner_tutorial/cram-my-beginner-tutorial.asd").is_file()
    load = '(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)'
    ask = "(matching-process-module-names (desig:a motion (type driving) (speed 3)))"
    for page in ("choosing-a-module", "location-designators"):
        assert "(TURTLESIM-NAVIGATION)" in typed([load, "(in-package :tut)", ask, ":quit"], page)
    assert "(TURTLESIM-NAVIGATION)" not in typed([load, "(in-package :tut)", ask, "q", ":quit"], "lecture-34")


@pytest.mark.parametrize(("page", "kept"), [("lecture-38", True), ("simple-plans", False)])
def test_a_file_of_the_page_to_which_a_student_comes_back_stays(typed, tmp_path, page, kept):
    asd = tmp_path / "files/lectures/cram_my_beginner_tutorial/cram-my-beginner-tutorial.asd"
    number, process_modules = contents.NAMES.index("lecture-38") + 1, '(:file "process-modules"'
    write = step_with(number, "lisp", lambda part: isinstance(part, File) and process_modules in (part.lisp or ("", ""))[1])
    typed([write, ":write", ":quit"], "lecture-38")
    assert process_modules in asd.read_text()
    typed([":quit"], page)
    assert (process_modules in asd.read_text()) == kept


def test_the_names_of_one_page_are_gone_on_the_next(typed):
    said = typed(["(setv of-this-page 5)", "of-this-page", ":page 2", "of-this-page", ":quit"], language="hy")
    assert said.count("\n5\n") == 1 and "name 'of-this-page' is not defined" in said.replace("of_this_page", "of-this-page")
