"""Tasks of the course are checked in a notebook, in both languages."""

from __future__ import annotations

import pytest

AROUND = {
    "lisp": ("(defun rectangle-around (width height) (* {} (+ width height)))", '(course:check "rectangle")'),
    "hy": (
        "%%hy\n(defn rectangle-around [width height] (* {} (+ width height)))",
        '%%hy\n(import cramhy-runtime.course.package [check])\n(check "rectangle" "hy")',
    ),
}


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_solution_in_a_cell_passes_and_a_wrong_one_does_not(cells, language):
    define, check = AROUND[language]
    cells.run(define.format(3))
    assert "(rectangle-around 2 3) should give 10, and gave 15." in cells.run(check).printed
    cells.run(define.format(2))
    answer = cells.run(check)
    assert "Well done" in answer.printed and answer.text == {"lisp": "T", "hy": "True"}[language]


def test_the_last_value_of_a_cell_of_hy_is_checked(cells):
    check = '%%hy\n(import cramhy-runtime.course.package [check])\n(check "seconds-of-a-day" "hy")'
    cells.run("%%hy\n(* 24 60 61)")
    assert "Not yet" in cells.run(check).printed
    cells.run("%%hy\n(* 24 60 60)")
    assert "Well done" in cells.run(check).printed


@pytest.mark.soak
def test_a_plan_that_never_ends_ends_the_check_and_not_the_notebook(cells):
    cells.run('(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)\n(in-package :tut)\n(init)')
    cells.run("(defun turn-left () (loop (sleep 1)))")
    assert "did not come to its end in 120 seconds" in cells.run('(course:check "turn-left")').printed
    cells.run("(defun turn-left () (send-vel-cmd 0 1.57) (sleep 1))")
    assert "Well done" in cells.run('(course:check "turn-left")').printed


CHECK = {
    "lisp": '(course:check "around-a-square")',
    "hy": '%%hy\n(import cramhy-runtime.course.package [check])\n(check "around-a-square" "hy")',
}
AROUND_A_SQUARE = {
    "lisp": ("(defparameter *side* 4) (defparameter *around* {})", "(* 4 *side*)"),
    "hy": ("%%hy\n(setv side 4)\n(setv around {})", "(* 4 side)"),
}


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_number_that_was_typed_is_not_one_that_was_computed(cells, language):
    cell, computed = AROUND_A_SQUARE[language]
    cells.run(cell.format(16))
    assert "for another side it would be wrong" in cells.run(CHECK[language]).printed
    cells.run(cell.format(computed))
    assert "Well done" in cells.run(CHECK[language]).printed
    whole = f"{cell.format(16)}\n{CHECK[language].removeprefix('%%hy')}"
    assert "for another side it would be wrong" in cells.run(whole).printed


@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_a_definition_in_vain_is_told(cells, language):
    define, check = AROUND[language]
    cells.run(define.format(2))
    cells.run(define.format("2 (undefined-here) #<" if language == "lisp" else "2 ]"))
    assert "Your last definition of rectangle-around was not taken" in cells.run(check).printed
    cells.run(define.format(2))
    assert "Well done" in cells.run(check).printed
