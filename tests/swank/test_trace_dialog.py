"""SLIME's trace dialog: calls are recorded, read in pieces, and inspected."""

from __future__ import annotations

import pytest

PREPARE = "(progn (defun inner (x) (* 2 x)) (defun outer (x y) (list (inner x) (inner y))) (defun fails (x) (car x)))"
TRACE = '(swank-trace-dialog:dialog-toggle-trace (swank::from-string "{}"))'


@pytest.fixture
def traced(emacs):
    """An Emacs that has ``inner``, ``outer`` and ``fails`` traced for the dialog."""
    emacs.repl(PREPARE)
    for name in ("inner", "outer", "fails"):
        assert emacs.call(TRACE.format(name)) == f"{name.upper()} is now traced for trace dialog"
    yield emacs
    emacs.call("(swank-trace-dialog:dialog-untrace-all)")
    emacs.call("(swank-trace-dialog:clear-trace-tree)")


def fetch(emacs, key="a-key"):
    return emacs.call(f"(swank-trace-dialog:report-partial-tree '{key})")


def test_calls_come_as_a_tree(traced):
    assert traced.repl("(outer 3 4)") == "(6 8)\n"  # nothing is printed but the result
    assert traced.call("(swank-trace-dialog:report-total)") == 3
    name = "COMMON-LISP-USER::"
    assert fetch(traced) == [
        [
            [0, None, f"{name}OUTER", [[0, "3"], [1, "4"]], [[0, "(6 8)"]]],
            [1, 0, f"{name}INNER", [[0, "3"]], [[0, "6"]]],
            [2, 0, f"{name}INNER", [[0, "4"]], [[0, "8"]]],
        ],
        0,
        "a-key",
    ]
    assert fetch(traced) == [None, 0, "a-key"]  # each call comes once
    assert len(fetch(traced, "another-key")[0]) == 3  # a new dialog reads from the beginning


def test_the_traced_functions_are_listed_and_untraced(traced):
    names = ["COMMON-LISP-USER::FAILS", "COMMON-LISP-USER::INNER", "COMMON-LISP-USER::OUTER"]
    assert traced.call("(cl:progn nil (swank-trace-dialog:report-specs))") == names
    assert (
        traced.call("(cl:progn (swank-trace-dialog:dialog-untrace 'common-lisp-user::inner) (swank-trace-dialog:report-specs))")
        == names[::2]
    )
    traced.repl("(outer 1 2)")
    assert len(fetch(traced)[0]) == 1
    assert traced.repl("(trace)") == "NIL\n"  # these are not the functions of TRACE


def test_a_call_that_is_left(traced):
    number = traced.rex('(swank-repl:listener-eval "(fails 5)")', thread=":repl-thread")
    thread, *_ = traced.debugged()
    assert [call[4] for call in fetch(traced)[0]] == [[[0, "still inside"]]]
    traced.refused("(swank:sldb-abort)", thread=thread)
    traced.wait(number)
    assert [call[4] for call in fetch(traced)[0]] == [[[0, "exited non-locally"]]]  # it comes again when it has ended


def test_calls_of_branches_belong_to_the_call_that_started_them(traced):
    traced.repl("(defun plan () (cpl:top-level (cpl:par (inner 1) (inner 2))))")
    traced.call(TRACE.format("plan"))
    traced.repl("(plan)")
    assert [(call[1], call[2].rpartition(":")[2]) for call in fetch(traced)[0]] == [(None, "PLAN"), (0, "INNER"), (0, "INNER")]


def test_parts_are_inspected(traced):
    traced.repl("(outer 3 4)")
    assert traced.call("(swank-trace-dialog:inspect-trace-part 0 1 :arg)")[1] == "4"
    assert traced.call("(swank-trace-dialog:inspect-trace-part 0 0 :retval)")[1] == "(6 8)"
    assert traced.refused("(swank-trace-dialog:inspect-trace-part 0 7 :retval)") == "The call number 0 has no such part."
    pieces = traced.call("(swank::inspect-object (swank-trace-dialog::find-trace 1))")[5][0]
    assert pieces[0] == "The object is a recorded call.\n" and [":value", "(3)", 2] in pieces
    assert traced.call("(swank-trace-dialog:report-trace-detail 1)")[-1] == "1: INNER"
    assert traced.refused("(swank-trace-dialog:report-trace-detail 99)") == "The call number 99 is not kept any more."
    traced.call("(swank-trace-dialog:clear-trace-tree)")
    assert fetch(traced) == [None, 0, "a-key"]


def test_many_calls_come_in_pieces(traced):
    traced.repl("(dotimes (i 200) (inner i))")
    first, left, _ = fetch(traced)
    assert (len(first), left) == (150, 50)
    assert len(fetch(traced)[0]) == 50


def test_what_cannot_be_traced(emacs):
    assert "is no function that can be traced" in emacs.refused(TRACE.format("when"))
    assert emacs.refused(TRACE.format("no-such-name")) == "There is no symbol no-such-name in the package COMMON-LISP-USER."
    assert emacs.refused("(swank-trace-dialog:dialog-toggle-trace (swank::eval 1))").startswith(
        "cramhy evaluates no calls in the arguments"
    )
    assert emacs.refused("(cl:progn)") == "PROGN has no calls in it."


@pytest.mark.parametrize(
    ("spec", "shown"),
    [("(setf pace)", "(SETF PACE)"), ("(:defmethod honk (fast))", "HONK"), ("(:defgeneric honk)", "HONK"), ("honk", "HONK")],
)
def test_specs_of_slime_are_traced(emacs, spec, shown):
    emacs.repl("(progn (defgeneric honk (x)) (defmethod honk (x) x) (defun (setf pace) (new x) new))")
    assert emacs.call(f'(swank:swank-toggle-trace "{spec}")') == f"{shown} is now traced."
    assert emacs.call(f'(swank:swank-toggle-trace "{spec}")') == f"{shown} is no longer traced."
    assert emacs.refused('(swank:swank-toggle-trace "(:call a b)")') == (
        "cramhy traces functions by their names, and cannot trace (:call a b)."
    )
