"""Threads: functions that run beside the rest, what joins and kills them, and what ends those that nobody ends (cpl.md 13.3)."""

import re

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition

THREAD = '(defvar *thread*) (setf *thread* (cut:spawn-thread "worker" (lambda (x) (sleep x) (values x :done)) 3))'


def without_address(text):
    return re.sub(r" \{[0-9A-F]{10}\}", "", text)


def test_a_thread_runs_in_the_kernels_time_and_gives_its_values_to_who_joins_it(lisp):
    lisp(THREAD)
    assert without_address(lisp("*thread*")) == '#<SB-THREAD:THREAD "worker" RUNNING>'
    assert lisp("(cut:join-thread *thread*)") == "3 :DONE" and kernel.now() == 3
    assert without_address(lisp("*thread*")) == '#<SB-THREAD:THREAD "worker" FINISHED values: 3, :DONE>'
    assert lisp("(list (cut:thread-name *thread*) (cut:thread-alive-p *thread*))") == '("worker" NIL)'


def test_joining_with_a_timeout_gives_up_at_its_time(lisp):
    lisp(THREAD)
    assert lisp("(list (cut:join-thread *thread* :timeout 1) (cut:join-thread *thread* :timeout 1/2 :on-timeout nil))") == "(:TIMEOUT NIL)"
    assert kernel.now() == 1.5 and lisp("(cut:join-thread *thread* :timeout 9)") == "3 :DONE" and kernel.now() == 3


def test_a_killed_thread_runs_its_cleanup_and_its_join_fails(lisp):
    lisp(
        "(defvar *log* nil) (setf *log* nil)(defvar *thread*)"
        '(setf *thread* (cut:spawn-thread "w" (lambda () (unwind-protect (sleep 9) (sleep 1) (push :cleaned *log*)))))'
    )
    lisp("(sleep 2)")
    assert (
        lisp("(list (cut:kill-thread *thread*) (cut:join-thread *thread* :on-failure :gone) *log* (cut:kill-thread *thread*))")
        == "(T :GONE (:CLEANED) NIL)"
    )
    assert kernel.now() == 3 and "ABORTED" in lisp("*thread*")


@pytest.mark.parametrize(
    ("form", "text"),
    [
        (
            '(cut:join-thread (cut:spawn-thread "w" (lambda () (error "bad ~a" 1))))',
            'Joining thread failed: thread #<THREAD "w" ABORTED> did not return normally.\nIts error: bad 1',
        ),
        (
            '(cut:join-thread (cut:spawn-thread "w" (lambda () (sleep 5))) :timeout 1 :on-timeout :error)',
            'Joining thread timed out: thread #<THREAD "w" RUNNING> did not exit in time.',
        ),
        ("(cut:join-thread (cut:current-thread))", 'In thread #<THREAD "main" RUNNING>, attempt to join the current thread.'),
        (
            "(cut:kill-thread (cut:current-thread))",
            "The main thread cannot be killed: it evaluates what is typed. To end the session call (quit).",
        ),
    ],
)
def test_what_cannot_be_joined_or_killed_is_an_error(lisp, form, text):
    with pytest.raises(Condition) as caught:
        lisp(form)
    assert without_address(caught.value.report()) == text


def test_a_thread_sees_the_global_values_of_specials_and_no_task(lisp):
    lisp("(defvar *x* :global)")
    assert (
        lisp("""(top-level (let ((*x* :local))
      (list (cut:thread-local-binding-p '*x*) (cut:run-in-thread (lambda (a) (list a *x* *current-task* (top-level (par 5)))) 1))))""")
        == "(T (1 :GLOBAL NIL 5))"
    )


def test_several_threads_have_numbers_and_all_threads_lists_them(lisp):
    assert (
        lisp("""(let ((threads (cut:spawn-threads 2 "w" (lambda () (sleep 1) (cut:thread-name (cut:current-thread))))))
      (list (mapcar #'cut:thread-name (cut:all-threads)) (mapcar #'cut:join-thread threads)))""")
        == '(("main" "w-1" "w-2") ("w-1" "w-2"))'
    )


def test_a_thread_of_a_plan_ends_with_the_task_that_spawned_it_and_its_cleanup_is_awaited(lisp):
    lisp("(defvar *log* nil) (setf *log* nil)")
    assert (
        lisp("""(top-level
      (par (seq (cut:spawn-thread "w" (lambda () (unwind-protect (sleep 99) (sleep 1) (push :cleaned *log*))))
                (cut:spawn-thread "x" (lambda () (sleep 2) (push :done *log*)))
                (sleep 3)))
      *log*)""")
        == "(:CLEANED :DONE)"
    )
    assert kernel.now() == 4


def test_a_thread_of_a_plan_that_is_evaporated_ends_too(lisp):
    lisp("(defvar *log* nil) (setf *log* nil)")
    assert (
        lisp("""(top-level
      (pursue (progn (cut:spawn-thread "w" (lambda () (unwind-protect (sleep 99) (push :cleaned *log*)))) (sleep 9))
              (sleep 1))
      *log*)""")
        == "(:CLEANED)"
    )


def test_another_thread_lives_until_the_session_ends(lisp):
    lisp('(defvar *log* nil) (setf *log* nil) (cut:spawn-thread "w" (lambda () (unwind-protect (sleep 99) (push :cleaned *log*))))')
    assert lisp("(top-level (sleep 1)) *log*") == "NIL"
    kernel.stop()
    kernel.start()
    assert lisp("*log*") == "(:CLEANED)"


def test_an_error_of_a_thread_that_nobody_joins_is_told_with_its_place(lisp, capsys):
    lisp("""(progn
      (cut:spawn-thread "w" (lambda () (error "bad")))
      (sleep 1))""")
    assert (
        capsys.readouterr().err
        == """\
An error ended w, and nobody waited for it:
  bad
  at <repl 1>:2:40
          (cut:spawn-thread "w" (lambda () (error "bad")))
                                           ^
"""
    )


def test_an_error_of_a_plans_thread_is_told_too(lisp, capsys):
    lisp('(top-level (cut:spawn-thread "w" (lambda () (unwind-protect (sleep 9) (error "in cleanup")))) (sleep 1))')
    assert "An error ended w, and nobody waited for it:\n  in cleanup" in capsys.readouterr().err
