"""The debugger, over the protocol."""

from __future__ import annotations

import sys

import pytest

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.session.calls_on_stack import calls_on_stack


def fail(emacs, form="(broken 1 2)"):
    emacs.repl('(defun broken (speed angle*) (let ((sum (+ speed angle*))) (error "no ~a" sum)))')
    number = emacs.rex(f'(swank-repl:listener-eval "{form}")', thread=":repl-thread")
    return number, *emacs.debugged()


def of_type(answer, kind):
    """Whether ``answer`` says that a call was aborted on a condition of that type: SLIME shows it."""
    return answer[0] == ":abort" and answer[1].startswith(f"#<{kind}")


def test_what_is_told_first(emacs):
    _, thread, level, condition, restarts, frames = fail(emacs)
    assert level == 1 and condition[0].startswith("  no 3\n  at <repl ") and condition[1] == "   [Condition of type SIMPLE-ERROR]"
    assert restarts == [["ABORT", "Return to Emacs."]]
    assert frames == [[0, "(BROKEN 1 2)"], [1, "the form"]]
    assert emacs.call("(swank:backtrace 0 1)", thread=thread) == [[0, "(BROKEN 1 2)"]]
    assert emacs.call("(swank:backtrace 1 nil)", thread=thread) == [[1, "the form"]]
    info = emacs.call("(swank:debugger-info-for-emacs 0 10)", thread=thread)
    assert info[:3] == [condition, restarts, frames]


def test_locals_in_the_spelling_of_the_text(emacs):
    _, thread, *_ = fail(emacs)
    variables, tags = emacs.call("(swank:frame-locals-and-catch-tags 0)", thread=thread)
    assert [(entry[1], entry[5]) for entry in variables] == [("SPEED", "1"), ("ANGLE*", "2"), ("SUM", "3")] and tags is None
    assert emacs.call("(swank:frame-locals-and-catch-tags 1)", thread=thread) == [None, None]
    assert emacs.refused("(swank:frame-locals-and-catch-tags 9)", thread=thread) == "There is no frame 9."


def test_forms_in_a_frame(emacs):
    _, thread, *_ = fail(emacs)
    assert emacs.call('(swank:eval-string-in-frame "(list sum angle* (* 2 speed))" 0 "CL-USER")', thread=thread) == "=> (3 2 2)"
    assert emacs.call('(swank:pprint-eval-string-in-frame "(values sum 5)" 0 "CL-USER")', thread=thread) == "3\n5\n"
    assert emacs.call("(swank:frame-package-name 0)", thread=thread) == "CL-USER"
    assert emacs.call('(swank:inspect-in-frame "(list speed)" 0)', thread=thread)[1] == "(1)"
    assert emacs.call("(swank:inspect-frame-var 0 2)", thread=thread)[1] == "3"
    assert emacs.refused("(swank:inspect-frame-var 0 7)", thread=thread) == "This frame has no variable 7."
    assert emacs.call("(swank:inspect-current-condition)", thread=thread)[1].startswith("#<SIMPLE-ERROR")
    assert emacs.call("(swank:sdlb-print-condition)", thread=thread).startswith("  no 3")
    assert "LOAD_FAST" in emacs.call("(swank:sldb-disassemble 0)", thread=thread)


def test_the_place_of_a_frame(emacs, tmp_path):
    path = tmp_path / "file.lisp"
    path.write_text("(in-package :cl-user)\n\n(defun in-file (x)\n  (list\n    (car x)))\n")
    emacs.call(f'(swank:load-file "{path}")')
    emacs.rex('(swank-repl:listener-eval "(in-file 5)")', thread=":repl-thread")
    thread, *_ = emacs.debugged()
    where = emacs.call("(swank:frame-source-location 0)", thread=thread)
    assert where[:3] == [":location", [":file", str(path)], [":position", path.read_text().index("(car x)") + 1]]


def test_restarts(emacs):
    number = emacs.rex(
        '(swank-repl:listener-eval "(restart-case (error \\"x\\") (mine () :report \\"Take mine.\\" 17))")', thread=":repl-thread"
    )
    thread, _, _, restarts, _ = emacs.debugged()
    assert restarts == [["MINE", "Take mine."], ["ABORT", "Return to Emacs."]]
    assert emacs.refused("(swank:invoke-nth-restart-for-emacs 1 7)", thread=thread) == "There is no restart 7; they go from 0 to 1."
    assert emacs.refused("(swank:invoke-nth-restart-for-emacs 1 0)", thread=thread) == "The debugger was left."
    assert emacs.wait(number) == [":ok", None] and emacs.events[-1][1] == "17\n"
    assert [":debug-return", thread, 1, None] in emacs.events


def test_ways_out(emacs):
    number, thread, *_ = fail(emacs)
    assert emacs.refused("(swank:sldb-continue)", thread=thread) == "There is no restart CONTINUE here. Choose another one."
    emacs.refused("(swank:sldb-abort)", thread=thread)
    assert of_type(emacs.wait(number), "SIMPLE-ERROR")
    number, thread, *_ = fail(emacs)
    emacs.refused("(swank:throw-to-toplevel)", thread=thread)
    assert of_type(emacs.wait(number), "SIMPLE-ERROR")
    number, thread, *_ = fail(emacs, '(progn (cerror \\"go on\\" \\"stop\\") 8)')
    emacs.refused("(swank:sldb-continue)", thread=thread)
    assert emacs.wait(number) == [":ok", None]
    assert emacs.refused("(swank:sldb-abort)", thread=thread) == "This call belongs to a debugger, and there is none."


def test_levels(emacs):
    number, thread, *_ = fail(emacs)
    inner = emacs.rex('(swank:eval-string-in-frame "(car 5)" 0 "CL-USER")', thread=thread)
    thread_2, level, condition, restarts, _ = emacs.debugged()
    assert (thread_2, level) == (thread, 2) and "is not of type" in condition[0]
    assert [text for _, text in restarts] == ["Return to level 1 of the debugger.", "Return to Emacs."]
    emacs.refused("(swank:invoke-nth-restart-for-emacs 2 0)", thread=thread)
    assert of_type(emacs.wait(inner), "TYPE-ERROR")
    assert [event for event in emacs.events if event[0].startswith(":debug")] == [
        [":debug-return", thread, 2, None],
        [":debug-activate", thread, 1, None],
    ]
    assert emacs.call("(swank:backtrace 0 1)", thread=thread) == [[0, "(BROKEN 1 2)"]]
    emacs.refused("(swank:throw-to-toplevel)", thread=thread)
    assert of_type(emacs.wait(number), "SIMPLE-ERROR")


def test_an_interrupt_leaves_the_debugger(emacs):
    number, thread, *_ = fail(emacs)
    emacs.interrupt(thread)
    assert emacs.wait(number) == [":abort", "interrupted"]
    assert [":debug-return", thread, 1, None] in emacs.events


def test_what_python_cannot_do_is_refused(emacs):
    _, thread, *_ = fail(emacs)
    told = "BROKEN was not compiled so that its calls can be left. C-u C-c C-c in a definition compiles it for that; or take a restart."
    # SLIME shows the text only if it is no refusal.
    assert emacs.call('(swank:sldb-return-from-frame 0 "1")', thread=thread) == told
    assert emacs.call("(swank:restart-frame 0)", thread=thread) == told
    for name in ("sldb-step", "sldb-next", "sldb-out"):
        assert emacs.refused(f"(swank:{name} 0)", thread=thread).startswith("Compiled code cannot be stopped between its forms.")
    assert emacs.refused("(swank:sldb-break-on-return 0)", thread=thread).startswith("cramhy cannot stop where a frame returns.")
    assert emacs.refused("(swank:sldb-break-with-default-debugger t)", thread=thread) == "The session has no other debugger than this one."


def test_a_function_can_be_stopped_at(emacs):
    emacs.repl("(defun stop-here (x) x)")
    assert emacs.call('(swank:sldb-break "stop-here")').startswith("Calls of ")
    number = emacs.rex('(swank-repl:listener-eval "(stop-here 4)")', thread=":repl-thread")
    thread, _, condition, _, _ = emacs.debugged()
    assert "breaking before traced call to STOP-HERE" in condition[0]
    emacs.refused("(swank:sldb-continue)", thread=thread)
    assert emacs.wait(number) == [":ok", None]
    emacs.call("(swank:untrace-all)")


def test_an_error_in_a_plan_has_the_frames_of_its_task(emacs):
    number, thread, _, condition, _, frames = fail(emacs, "(cpl:top-level (cpl:par (sleep 1) (broken 3 4)))")
    assert condition[0].startswith("  no 7") and frames[0] == [0, "(BROKEN 3 4)"]
    emacs.refused("(swank:throw-to-toplevel)", thread=thread)
    assert of_type(emacs.wait(number), "SIMPLE-ERROR")


def test_a_debugger_that_the_plan_ends(emacs):
    """A branch stops in the debugger; the others end the plan, and the debugger with it."""
    emacs.repl("(setf cpl-impl::*debug-on-lisp-errors* t)")
    number = emacs.rex('(swank-repl:listener-eval "(cpl:top-level (cpl:pursue (sleep 5) (car 5)))")', thread=":repl-thread")
    thread, *_ = emacs.debugged()
    assert emacs.call('(swank:interactive-eval "(sleep 10)")') == "=> NIL"
    assert emacs.wait(number) == [":ok", None]
    assert [":debug-return", thread, 1, None] in emacs.events


def test_two_debuggers_at_a_time(emacs):
    number, first, *_ = fail(emacs)
    other = emacs.rex('(swank:interactive-eval "(car 7)")')
    second, level, *_ = emacs.debugged()
    assert second != first and level == 1
    emacs.refused("(swank:sldb-abort)", thread=second)
    assert of_type(emacs.wait(other), "TYPE-ERROR")
    emacs.refused("(swank:sldb-abort)", thread=first)
    assert of_type(emacs.wait(number), "SIMPLE-ERROR")


def test_errors_while_one_types_open_no_debugger(emacs):
    assert emacs.refused('(swank:describe-symbol "no-such-symbol")') == "There is no symbol no-such-symbol in the package COMMON-LISP-USER."
    assert not [event for event in emacs.events if event[0] == ":debug"]


def test_break_from_emacs(emacs):
    number = emacs.rex("(swank:simple-break)")
    thread, _, condition, restarts, _ = emacs.debugged()
    assert condition[0].startswith("  Break from Emacs.") and restarts[0][0] == "CONTINUE"
    emacs.refused("(swank:sldb-continue)", thread=thread)
    assert emacs.wait(number) == [":ok", None]


def compile_for_debugging(emacs, text):
    """``C-u C-c C-c`` in a definition."""
    from cramhy_runtime.swank.wire import write

    emacs.call(f"(swank:compile-string-for-emacs {write(text)} \"b\" '((:position 1) (:line 1 1)) nil '((cl:debug . 3)))")


def test_a_call_returns_what_the_user_says(emacs):
    compile_for_debugging(emacs, "(defun careful (x) (unwind-protect (+ 1 (car x)) (princ :cleaned)))")
    number = emacs.rex('(swank-repl:listener-eval "(list (careful 5) 2)")', thread=":repl-thread")
    thread, *_, frames = emacs.debugged()
    assert frames[0] == [0, "(CAREFUL 5)"]
    assert emacs.refused('(swank:sldb-return-from-frame 0 "(values (* 10 x) 7)")', thread=thread) == "The debugger was left."
    assert emacs.wait(number) == [":ok", None]
    assert "".join(event[1] for event in emacs.events if event[0] == ":write-string") == "CLEANED\n(50 2)\n"
    assert [":debug-return", thread, 1, None] in emacs.events


def test_a_call_begins_anew(emacs):
    """The definition of an inner function is repaired in the debugger, and the outer call begins anew with its arguments."""
    emacs.repl("(defun helper (x) (car x))")
    compile_for_debugging(emacs, "(defun outer (x &optional (y 2) &key (z 3)) (let ((w 4)) (list (helper x) y z w)))")
    number = emacs.rex('(swank-repl:listener-eval "(outer 5 6 :z 7)")', thread=":repl-thread")
    thread, *_, frames = emacs.debugged()
    emacs.call('(swank:interactive-eval "(defun helper (x) (* 100 x))")')
    position = next(index for index, text in frames if text.startswith("(OUTER"))
    assert emacs.refused(f"(swank:restart-frame {position})", thread=thread) == "The debugger was left."
    assert emacs.wait(number) == [":ok", None]
    assert emacs.events[-1][1] == "(500 6 7 4)\n"


def test_a_call_that_is_over_cannot_be_left(emacs, session):
    compile_for_debugging(emacs, "(defun caught (x) (car x))")
    with pytest.raises(Condition) as caught:
        session.evaluate_text("(caught 5)")
    frame = calls_on_stack(sys._getframe(), caught.value)[0]
    assert frame.text == "(CAUGHT 5)" and frame.why_it_stays == "The error has left the call of CAUGHT already."


def test_a_call_in_a_branch_begins_anew_while_the_others_go_on(emacs):
    emacs.repl("(setf cpl-impl::*debug-on-lisp-errors* t)")
    emacs.repl("(defvar *broken* t)")
    compile_for_debugging(emacs, "(defun in-branch (x) (if *broken* (car x) (* 2 x)))")
    form = "(cpl:top-level (cpl:par (sleep 1) (setf *broken* (in-branch 5))))"
    number = emacs.rex(f'(swank-repl:listener-eval "{form}")', thread=":repl-thread")
    thread, *_, frames = emacs.debugged()
    assert frames[0] == [0, "(IN-BRANCH 5)"]
    emacs.call('(swank:interactive-eval "(setf *broken* nil)")')
    emacs.refused("(swank:restart-frame 0)", thread=thread)
    assert emacs.wait(number) == [":ok", None] and emacs.repl("*broken*") == "10\n"
    emacs.repl("(setf cpl-impl::*debug-on-lisp-errors* nil)")
