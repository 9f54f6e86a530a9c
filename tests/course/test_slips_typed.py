"""What readers mistype, ten of a kind: the screen says what helps, and nothing is said of what is right."""

from __future__ import annotations

import pytest

from cramhy_runtime.course import bodies, contents, reading, rules
from cramhy_runtime.course.plan_places import in_check
from cramhy_runtime.course.shown import Style, fitted, text
from cramhy_runtime.course.slips import in_words_of_hy, in_words_of_lisp
from systems import SOAK, needs_processes

from .slips_typed import FOLDER, faults, slips_of, typed_slips
from .test_mistyped import forms_of_all_pages
from .tries import tries_at

SORTS = sorted(file.stem for file in FOLDER.glob("*.toml"))
ALL = [slip for sort in SORTS for slip in slips_of(sort)]
FUNCTIONS = {"ahead", "left", "turn-left", "sleep", "drive-to", "move-to", "send-vel-cmd", "max", "twice", "visit", "value"}
SAMPLED = ("names-and-functions", "motion-designators", "choosing-a-module")
"""The pages on which slips are typed, if not all are."""


@pytest.mark.parametrize("sort", SORTS)
def test_each_class_has_ten_of_a_kind_with_their_places(sort):
    slips = slips_of(sort)
    assert (
        len(slips) == 10
        and len({(slip.language, slip.text) for slip in slips}) == 10
        and all(slip.page in contents.NAMES for slip in slips)
    )
    assert all(slip.says or slip.silent for slip in slips)


@needs_processes
@pytest.mark.parametrize("language", ["lisp", "hy"])
@pytest.mark.parametrize("page", contents.NAMES[:8] if SOAK else SAMPLED)
def test_a_slip_is_told_where_it_is_typed(page, language):
    slips = [slip for slip in ALL if (slip.page, slip.language) == (page, language)]
    shown = typed_slips(slips if SOAK else slips[:4])
    assert shown and {slip.name: faults(slip, text) for slip, text in shown.items() if faults(slip, text)} == {}


def told(form, language, checked=False):
    return rules.of_form(form, language, checked) or bodies.of_form(form, language, FUNCTIONS, in_task=checked)


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_nothing_is_said_of_the_pages_and_of_right_solutions(language):
    assert [form for form in forms_of_all_pages(language) if told(form, language)] == []
    right = [each for page in reading.pages() for task in page.tasks for each in tries_at(task.name, language) if each.sort == "right"]
    assert {each.name: told(each.text, language, True) for each in right if told(each.text, language, True)} == {}


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_what_is_said_in_a_task_has_no_numbers_of_the_solution(language):
    form = "(left 360 / corners)"
    assert told(form, language) == "; Each / has parentheses of its own: (left (/ 360 corners))"
    assert told(form, language, True) == "; Each / has parentheses of its own, as in (left (/ 7 9))"
    bare = "(dotimes (i 4) ahead 2 turn-left)" if language == "lisp" else "(for [i (range 4)] ahead 2 turn-left)"
    assert told(bare, language, True).endswith("as in (ahead 7)")


@pytest.mark.parametrize(
    "form",
    [
        "(defun f (left) (when (> left 1) left))",
        "(defn f [ahead] (do ahead))",
        "(let ((left 1)) (progn left))",
        "(let [left 1] (do left))",
        "(dotimes (i 4) (mapcar 'left *x*) nil)",
        "(reduce + [1 2])",
        "(apply max + 1)",
        "(defn f [] (defn g [] 1) (g))",
        "(wait-for (> *x* 1.5))",
        "(print '(ahead 2 turn-left))",
        '(defun f () "(defun g" (ahead 1))',
    ],
)
def test_of_other_bodies_nothing_is_said(form):
    assert told(form, "hy") is None or form.startswith("(defun")
    assert told(form, "lisp") is None or "[" in form


SIBLINGS = {
    "(setv around side * 4)": "Each * has parentheses of its own: (setv around (* side 4))",
    "(defun f () (setf *around* *side* * 4))": "Each * has parentheses of its own: (setf *around* (* *side* 4))",
    "(def-fact-group g () (<- (p ?x ?y) (q ?x) (setv ?y (- ?x))))": "A rule computes by lisp-fun, as in (lisp-fun max 2 7 ?most).",
    "(def-fact-group g () (<- (p ?x) (q ?x) (lisp-fun - ?x ?y)))": "?y is computed, and nothing uses it.",
}


@pytest.mark.parametrize("form", SIBLINGS)
def test_siblings_that_a_second_look_has_found(form):
    said = [told(form, language, checked) or "" for language in ("lisp", "hy") for checked in (False, True)]
    assert any(SIBLINGS[form] in each for each in said), said


OUTSIDE = (
    "(go-home) ended with an error:\n  'PURSUE' form not inside a plan.\n  Plan forms run inside of a plan: write (top-level (pursue ...))."
)
NESTED = "{} ended with an error:\n  top-level calls cannot be nested.\n  This form runs inside a plan already: leave TOP-LEVEL away here, or ..."


def test_top_level_is_to_be_written_in_the_function_or_left_away_there():
    forms = {"turn": "(defun turn () (top-level (f)))", "drive": "(defun drive () (f))"}
    assert in_check(OUTSIDE, forms.get).endswith("\n  Write top-level inside of go-home, around its forms.")
    away = in_check(NESTED.format("(top-level (turn))"), forms.get)
    assert away.endswith("\n  Leave top-level away in turn: the plan that calls it has one.")
    other = NESTED.format("(top-level (drive))")
    assert in_check(other, forms.get) == other and in_check("It is 5.", forms.get) == "It is 5."


def test_a_line_of_an_error_fits_the_screen_and_its_mark_stands_below_the_right_word():
    line = "    (print " + " ".join(f"word{number}" for number in range(30)) + " here " + "more " * 20 + ")"
    shown = fitted(f"An error.\n{line}\n{' ' * line.index('here')}^^^^\n  {'never changes ' * 12}\n", Style(60)).split("\n")
    assert max(map(len, shown)) <= 60
    assert shown[1][shown[2].index("^") :].startswith("here") and shown[2].strip() == "^^^^"
    assert all(part.strip().startswith(("never", "changes")) for part in shown[3:-1])
    short = "  (f x)\n     ^\n"
    assert fitted(short, Style(60)) == short


def test_code_in_a_text_is_not_broken():
    shown = text("It gives ten: " + "a " * 18 + "`(rectangle-around 2 3)` and so on.", Style(60))
    assert "(rectangle-around 2 3)" in shown and max(map(len, shown.split("\n"))) <= 60


def test_messages_speak_the_language_of_the_course():
    place = "  at /a/b/cram_my_beginner_tutorial/src/simple-plans.hy:28:10"
    assert in_words_of_lisp(place) == "  at cram_my_beginner_tutorial/src/simple-plans:28:10"
    assert in_words_of_hy("  at my_turtle/simple_plans.hy:28:10") == "  at my_turtle/simple_plans.hy:28:10"
    assert in_words_of_hy("The Lisp function my-turtle::goal-vector signalled an error:") == "The function goal-vector signalled an error:"
    net = "while the net FN-FL>110 over the fluent TURTLE-POSE was made: its first value is computed at once"
    assert in_words_of_hy(net) == "while a fluent of the fluent TURTLE-POSE was made"
    assert in_words_of_lisp("It fails.\nSee also:\nThe ANSI Standard, Section 7.6.6.2\nMore") == "It fails.\nMore"
