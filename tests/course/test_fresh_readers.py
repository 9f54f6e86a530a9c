"""What fresh readers stumbled at on the first pages: what the prompt of ``cramhy learn`` says then, and what it must not give away."""

from __future__ import annotations

import re

import pytest

from cramhy_runtime.course.guide import told_of_open_form
from cramhy_runtime.course.mistyped import of_error, of_form
from cramhy_runtime.course.slips import in_words_of_hy, in_words_of_lisp, of_failed_form, of_line

from .test_learn import LOAD, step_with, types, words

LANGUAGES = ("lisp", "hy")
START = {"lisp": LOAD, "hy": ["(import cram-my-beginner-tutorial :as tut)", "(tut.init)"]}


def defining(language, name, *forms, arguments=""):
    """A definition in a line."""
    inside = " ".join(forms).replace("(send-", "(tut.send-") if language == "hy" else " ".join(forms)
    return f"(defun {name} ({arguments}) {inside})" if language == "lisp" else f"(defn {name} [{arguments}] {inside})"


# ------------------------------------------------------------------------------------------------------- no answer is given away


@pytest.mark.parametrize(
    "line",
    [
        "24*60*60",
        "24 * 60 * 60",
        "(* 2 + width height)",
        "side = 4",
        "4 * side",
        "(24 * 60 * 60)",
        "(2 * (width + height))",
        "360 / corners",
    ],
)
@pytest.mark.parametrize("language", LANGUAGES)
def test_a_remark_in_a_task_has_other_numbers_and_names_than_the_line(line, language):
    told = of_line(line, language, in_task=True) or of_failed_form(line, language, in_task=True)
    if language == "lisp" and line.startswith(("(24", "(2 ")):
        assert told is None
    else:
        assert told is not None and not set(re.findall(r"\w+", line)) & set(re.findall(r"\w+", told)) - {"5"}, told


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("line", ["24*60*60", "* 24 60 60", "(24 * 60 * 60)", "24 * 60 * 60"])
def test_nothing_that_is_said_in_the_first_task_is_its_answer(typed, language, line):
    task = step_with(1, language, "seconds-of-a-day")
    shown = typed([task, line, *["q"] * (language == "lisp"), ":hint", ":hint", ":quit"], language=language)
    assert "(* 24 60 60)" not in shown and "(* 24 60" not in shown.replace(line, "")


def test_outside_of_a_task_the_students_own_line_is_written_right():
    assert "(* 24 60 60)" in of_line("24*60*60", "hy") and "(setv side 4)" in of_line("side = 4", "hy")


# -------------------------------------------------------------------------------------------------------- the forms of a step


@pytest.mark.parametrize("language", LANGUAGES)
def test_type_says_how_many_forms_are_left(typed, language):
    shown = typed([":type", ":type", ":type", ":quit"], language=language)
    told = [line for line in shown.splitlines() if line.startswith("; Left of this step")]
    assert told == ["; Left of this step: 2 forms. :type types the next one.", "; Left of this step: 1 form. :type types the next one."]
    assert shown.index("\n42\n", shown.index("; Type what")) < shown.index(told[0]) < shown.index(told[1]) < shown.index("To see the next")
    assert "Left of this step" not in typed(["42", "(+ 1 2)", ":quit"], language=language)


@pytest.mark.soak
@pytest.mark.parametrize("language", LANGUAGES)
def test_next_names_the_forms_that_were_not_typed(typed, language):
    assert "; Not typed: (+ 1 2), (max 3 7 5)\n" in typed(["42", ":next", ":quit"], language=language)
    assert "; Not typed: 42, (+ 1 2) and 1 more\n" in typed([":next", ":quit"], language=language)
    assert "Not typed" not in typed(["42", "(+ 1  2)", "(max 3 7 5)", ":next", ":quit"], language=language)
    start = START[language]
    load = step_with(1, language, lambda part: any(each.form == start[-1] for each in getattr(part, language, None) or ()))
    shown = words(typed([load, *start[:-1], ":next", ":quit"], language=language))
    assert f"Not typed: {start[-1]}. What comes later may need it: {load} leads back." in shown
    assert f"What comes later may need them: {load} leads back." in words(typed([load, ":next", ":quit"], language=language))


@pytest.mark.soak
@pytest.mark.parametrize("language", LANGUAGES)
def test_a_function_of_that_name_counts_as_typed_however_it_is_written(typed, language):
    head = {"lisp": "(defun ahead", "hy": "(defn ahead"}[language]
    step = step_with(1, language, lambda part: any(each.form.startswith(head) for each in getattr(part, language, None) or ()))
    lines = [step, defining(language, "ahead", "(send-vel-cmd way 0)", "(sleep 1)", arguments="way"), ":next", ":quit"]
    assert f"; Not typed: {head}" not in typed([*START[language], *lines], language=language)


@pytest.mark.soak
@pytest.mark.parametrize("language", LANGUAGES)
def test_what_was_typed_before_its_step_came_is_typed(typed, language):
    task = step_with(1, language, "turn-left")
    shown = typed([*START[language], task, ":check", ":quit"], language=language)
    assert "There is no function turn-left yet." in shown and "This page begins with" not in shown


# ------------------------------------------------------------------------------------------------- the debugger, and open forms


@pytest.mark.parametrize("step", ["1 1", step_with(1, "lisp", "turn-left").removeprefix(":page ")])
def test_type_waits_until_the_debugger_is_left(typed, step):
    shown = typed([f":page {step}", "(car 7)", ":type", ":t", "q", ":quit"])
    assert shown.count("; The debugger is open. Type q first, and then :type.") == 2 and shown.count("debugger invoked") == 1


def test_type_types_what_the_page_shows_behind_the_debuggers_prompt(typed):
    shown = typed([step_with(1, "lisp", types("(+ 1 two)")), ":type", ":type", ":type", ":quit"])
    assert "0] q" in shown.split("; Type what")[1] and "Type q first" not in shown


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("line", [":next", ":type", ":check", ":n", ":quit", ":page 3"])
def test_a_command_waits_until_the_open_form_is_closed_and_is_no_part_of_it(typed, language, line):
    begin = {"lisp": "(defun f (x)", "hy": "(defn f [x]"}[language]
    shown = typed([begin, line, "(* 2 x))", "(f 21)", ":quit"], language=language)
    name = {":n": ":next", ":page 3": ":page"}.get(line, line)
    assert f"A form is open, so {name} has to wait, and what you have typed stays. Close it by ), or press Ctrl-C" in words(shown)
    assert "\n42\n" in shown and shown.count("--- Page") == 1


@pytest.mark.parametrize(
    ("lines", "language", "told"),
    [
        (["(f (g", ":next"], "lisp", "A form is open, so :next has to wait, and what you have typed stays. Close it by )), or"),
        (["(for [i (range 4", ":type"], "hy", "Close it by )]), or"),
        (['(print "a', ":next"], "hy", 'A text is open, so :next has to wait, and what you have typed stays. End it by ", or'),
        (["(print ; (((", ""], "lisp", "A form is open. Close it by ), or press Ctrl-C to begin anew."),
        (["(print", "q"], "lisp", "A form is open, and q is taken for a part of it. Close it by ), or"),
    ],
)
def test_what_is_open_is_said_as_it_is_closed(lines, language, told):
    assert told in told_of_open_form(lines, language)


@pytest.mark.parametrize("line", [":red", "x", "(print x)", ":nxt", "next"])
def test_of_other_lines_of_an_open_form_nothing_is_said(line):
    assert told_of_open_form(["(f", line]) is None


# --------------------------------------------------------------------------------------------------- what is missing, and where


def test_a_function_behind_another_prompt_is_to_be_typed_again(typed):
    polygon = "(defun draw-polygon (corners) (dotimes (i corners) (print i)))"
    task = step_with(2, "lisp", "any-polygon")
    shown = words(typed([polygon, *LOAD, task, ":check", "(draw-polygon 3)", "q", ":quit"], "names-and-functions"))
    told = "draw-polygon was defined behind CL-USER>, in another package. The prompt is TUT> now: type the definition again here."
    assert shown.count(told) == 2
    assert "in another package" not in words(typed([*LOAD, polygon, task, ":check", ":quit"], "names-and-functions"))


def test_a_function_that_both_packages_have_is_not_said_to_be_in_another_one(typed):
    turn, square = "(defun turn-left () 1)", "(defun drive-square () (dotimes (i 4) (list turn-left)))"
    said = words(typed([turn, *LOAD, turn, square, step_with(1, "lisp", "first-square"), ":check", "(drive-square)", "q", ":quit"]))
    assert "The variable TURN-LEFT is unbound" in said
    assert "in another package" not in said


def test_a_function_of_the_courses_package_is_reached_by_its_way(typed):
    lines = [*LOAD, "(defun ahead (metres) metres)", "(in-package :cl-user)", "(ahead 1)", "q", ":quit"]
    told = "ahead is a function of another package: after (in-package :tut) the prompt is TUT> and knows it."
    assert told in words(typed(lines, "names-and-functions"))


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_check_of_the_square_names_the_task_of_a_missing_function(typed, language):
    task, other = step_with(1, language, "first-square"), step_with(1, language, "turn-left")
    loop = "(dotimes (i 4) (ahead 2) (turn-left))" if language == "lisp" else "(for [i (range 4)] (ahead 2) (turn-left))"
    ahead = defining(language, "ahead", "(send-vel-cmd metres 0)", "(sleep 1)", arguments="metres")
    shown = words(typed([*START[language], ahead, task, defining(language, "drive-square", loop), ":check", ":quit"], language=language))
    assert f"turn-left is the function of another task, Turn to the left: {other} leads to it." in shown
    assert "Does the loop do both" not in shown and "turn_left" not in shown and "is loaded by" not in shown


@pytest.mark.soak
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("task", ["turn-left", "first-square"])
def test_a_function_in_which_nothing_waits_is_named(typed, language, task):
    loop = "(dotimes (i 4) (ahead 2) (turn-left))" if language == "lisp" else "(for [i (range 4)] (ahead 2) (turn-left))"
    lines = [
        defining(language, "ahead", "(send-vel-cmd metres 0)", "(sleep 1)", arguments="metres"),
        defining(language, "turn-left", "(send-vel-cmd 0 1.57)"),
        defining(language, "drive-square", loop),
    ]
    shown = words(typed([*START[language], *lines, step_with(1, language, task), ":check", ":quit"], language=language))
    assert "Nothing waits in turn-left after send-vel-cmd. The turtle needs a second for what it is told." in shown
    lines[1] = defining(language, "turn-left", "(send-vel-cmd 0 1.2)", "(sleep 1)")
    shown = typed([*START[language], *lines, step_with(1, language, task), ":check", ":quit"], language=language)
    assert "Not yet." in shown and "Nothing waits" not in shown


def test_what_is_not_evaluated_is_told_when_the_debugger_opens(typed):
    shown = typed(["max 3 7 5", "(+ 1 1)", "q", ":quit"])
    opened, later = shown.split("0] (+ 1 1)")
    assert "; Not evaluated so far: 3 7 5\n" in opened and "Not evaluated" not in later


# ------------------------------------------------------------------------------------------------------------ calls, and words


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize(("line", "told"), [("max 3 7 5", "(max 3 7 5)"), ("* 2 3", "(* 2 3)"), ("max 3 7.5", "(max 3 7.5)")])
def test_a_call_without_parentheses_is_told_in_both_languages(typed, language, line, told):
    shown = words(typed([line, *["q"] * (language == "lisp"), ":quit"], language=language))
    assert f"took each of these words for a form of its own. A call has parentheses around it: {told}" in shown


def test_a_word_of_a_mistake_on_purpose_is_not_loaded_by_the_page(typed):
    load = step_with(1, "lisp", types("(ros-load:"))
    assert "is loaded by" not in typed([load, "(+ 1 two)", "q", ":quit"])


FORMS_OF_HY = {
    "(defn f)": "defn is written (defn name [arguments] ...)",
    "(defn f x x)": "defn is written (defn name [arguments] ...)",
    "(defn [x] x)": "defn is written (defn name [arguments] ...)",
    "(for i (range 4) (print i))": "for is written (for [i (range 4)] ...)",
    "(for [i in (range 4)] (print i))": "for is written (for [i (range 4)] ...)",
    "(for i in range(4) (print i))": "for is written (for [i (range 4)] ...)",
    "(for [i range 4] (print i))": "for is written (for [i (range 4)] ...)",
    "(for [i 4] (print i))": "(range 4) stands for four of them",
    "(for [i (range 2)]) (print i)": "This loop repeats nothing",
    "(setv x)": "setv is written (setv name value).",
    "(while)": "while is written (while condition ...)",
    "(for [i (range 2)] (print i))": None,
    "(for [x [1 2]] (print x))": None,
    "(for [i (range 2) j (range 2)] (print j))": None,
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("form", FORMS_OF_HY)
def test_a_form_of_hy_that_is_written_otherwise_is_told(typed, form):
    shown, told = words(typed([form, ":quit"], language="hy")), FORMS_OF_HY[form]
    assert told in shown if told else "is written" not in shown and "repeats nothing" not in shown and "stands for" not in shown


def test_only_hy_is_told_of_hy():
    assert of_error("parse error for pattern macro 'for'", "(for)", "lisp") is None and of_form("(for [i 4])", "lisp") is None


OF_ARGUMENTS = {
    "lisp": {
        "(defun ahead [metres] 1)": "The list of arguments [METRES] is malformed: the names of the arguments stand in a list, as in (metres).",
        "(defun f (x x) 1)": "The variable X occurs more than once in the list of arguments.",
        "(defun f (1) 1)": "The list of arguments (1) is malformed: an argument has to be a symbol.",
        "(defun f)": 'It is written (defun name (argument...) ["documentation"] form...).',
        "(defn f [x] x)": "In Lisp, defn is written (defun name (argument ...) form...).",
    },
    "hy": {
        "(defun f (x) x)": "In Hy, defun is written (defn name [argument ...] form...).",
        "(dotimes (i 4) (print i))": "In Hy, dotimes is written (for [name (range count)] form...).",
        "(defn go-there [x y] x)\n(go-there 1)": "go-there takes 2 arguments.",
    },
}


@pytest.mark.soak
@pytest.mark.parametrize(("language", "form"), [(language, form) for language, forms in OF_ARGUMENTS.items() for form in forms])
def test_messages_have_the_words_of_the_pages(typed, language, form):
    shown = words(typed([*START[language][:1], *form.split("\n"), "q", ":quit"], language=language))
    assert OF_ARGUMENTS[language][form] in shown
    assert "lambda list" not in shown and "parameter" not in shown and "Common Lisp" not in shown and "The function F" not in shown


def test_a_function_of_hy_is_named_as_hy_writes_it():
    told = "TypeError: f() missing 1 argument\n  The function GO-THERE takes 2 arguments.\n  CRAM-MY-TUTORIAL::SEND takes at least 1 argument.\n"
    assert in_words_of_hy(told).splitlines()[1:] == ["  go-there takes 2 arguments.", "  send takes at least 1 argument."]


def test_other_words_of_messages_stay():
    kept = "The parameter server has no parameter /x. TUT> takes 3."
    assert in_words_of_lisp(kept) == in_words_of_hy(kept) == kept


def test_a_warning_with_an_error_in_it_does_not_stand_at_the_right_edge(typed):
    rule = "(def-fact-group w (motion-grounding) (<- (motion-grounding ?desig (wait ?s)) (lisp-fun * 60 ?m ?s)))"
    begin = ["(defpackage :try (:use :cl :cram-prolog :cram-designators))", "(in-package :try)", rule]
    shown = typed([*begin, "(reference (desig:a motion (type waiting)))", "q", ":quit"])
    assert "WARNING: An error occurred while executing the lisp function `*': `The value" in words(shown)
    assert not [line for line in shown.split("debugger invoked")[0].splitlines() if line.startswith(" " * 40)]
