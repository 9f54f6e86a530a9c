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


def test_a_plan_that_never_ends_ends_the_check_and_not_the_notebook(cells):
    cells.run('(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)\n(in-package :tut)\n(init)')
    cells.run("(defun turn-left () (loop (sleep 1)))")
    assert "was not over when the turtle's time was" in cells.run('(course:check "turn-left")').printed
    cells.run("(defun turn-left () (send-vel-cmd 0 1.57) (sleep 1))")
    assert "Well done" in cells.run('(course:check "turn-left")').printed
