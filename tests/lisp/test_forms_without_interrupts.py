"""``without-interrupts`` and the forms that let interruptions in again. The answers are SBCL 2.2.9's."""

from __future__ import annotations

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

PROBE = """
(defvar *log* '())
(defun note (what) (push what *log*))
(defun nap () (loop repeat 30 do (sleep 0.01)) (note :slept))
(defun probe (body)
  (setf *log* '())
  (let ((thread (sb-thread:make-thread (lambda () (funcall body) (note :end)))))
    (sleep 0.1)
    (sb-thread:interrupt-thread thread (lambda () (note :hit)))
    (sb-thread:join-thread thread)
    (reverse *log*)))
"""


@pytest.fixture
def lisp(session):
    """A function: the printed values of the last form of a text, which may name SB-SYS's macros without a prefix."""
    session.package = "CL-USER"
    names = "without-interrupts with-interrupts with-local-interrupts allow-with-interrupts"
    session.evaluate_text(f"(defpackage naps (:use :cl) (:import-from :sb-sys {' '.join('#:' + name for name in names.split())}))")
    session.evaluate_text(f"(in-package :naps) {PROBE}")
    return lambda text: " ".join(prin1_to_string(value) for value in session.evaluate_text(text, "<test>"))


@pytest.mark.parametrize(
    ("body", "log"),
    [
        ("(nap)", "(:HIT :SLEPT :END)"),
        ("(without-interrupts (nap))", "(:SLEPT :HIT :END)"),
        ("(with-interrupts (nap))", "(:HIT :SLEPT :END)"),
        ("(without-interrupts (with-interrupts (nap)))", "(:SLEPT :HIT :END)"),
        ("(without-interrupts (allow-with-interrupts (nap)))", "(:SLEPT :HIT :END)"),
        ("(without-interrupts (allow-with-interrupts (with-interrupts (nap))) (note :inside))", "(:HIT :SLEPT :INSIDE :END)"),
        ("(without-interrupts (with-local-interrupts (nap)) (note :inside))", "(:HIT :SLEPT :INSIDE :END)"),
        (
            "(without-interrupts (nap) (with-local-interrupts (loop repeat 3 do (sleep 0.01)) (note :local)) (note :inside))",
            "(:SLEPT :HIT :LOCAL :INSIDE :END)",
        ),
        ("(without-interrupts (without-interrupts (with-local-interrupts (nap))) (note :inside))", "(:SLEPT :INSIDE :HIT :END)"),
        (
            "(without-interrupts (allow-with-interrupts (without-interrupts (with-local-interrupts (nap)))) (note :inside))",
            "(:HIT :SLEPT :INSIDE :END)",
        ),
        ("(without-interrupts (with-local-interrupts (without-interrupts (nap))) (note :inside))", "(:SLEPT :HIT :INSIDE :END)"),
        ("(without-interrupts (catch 'out (with-local-interrupts (throw 'out 1))) (nap) (note :inside))", "(:SLEPT :INSIDE :HIT :END)"),
    ],
)
def test_an_interruption_arrives_where_it_arrives_on_sbcl(lisp, body, log):
    assert lisp(f"(probe (lambda () {body}))") == log


@pytest.mark.parametrize("ends", ["sb-ext:with-timeout 1", "sb-sys:with-deadline (:seconds 1)"])
@pytest.mark.parametrize(
    "lets_in", ["(with-local-interrupts (sleep 9))", "(allow-with-interrupts (with-interrupts (sleep 9)))"], ids=["local", "allowed"]
)
def test_what_lets_interruptions_in_is_ended_by_a_limit_of_time(lisp, ends, lets_in):
    form = f"(handler-case ({ends} (without-interrupts {lets_in} :no)) (sb-ext:timeout () :over))"
    assert lisp(form) == ":OVER"
    assert kernel.now() == 1
    assert lisp("(progn (sb-thread:join-thread (sb-thread:make-thread #'nap)) :goes-on)") == ":GOES-ON"


def test_a_waiting_thread_is_terminated_and_its_cleanup_goes_through(lisp):
    """As in synchronization-tools' ENTER-BARRIER, which takes back its count when it is left so."""
    form = """(let* ((m (sb-thread:make-mutex)) (q (sb-thread:make-waitqueue)) (count 0) (ok nil)
           (thread (sb-thread:make-thread (lambda ()
             (sb-thread:with-mutex (m)
               (without-interrupts
                 (incf count)
                 (unwind-protect (progn (with-local-interrupts (loop (sb-thread:condition-wait q m))) (setf ok t))
                   (unless ok (sleep 1) (decf count)))))))))
      (sleep 1)
      (sb-thread:terminate-thread thread)
      (sb-thread:join-thread thread :default :ended)
      (list count (sb-thread:mutex-owner m)))"""
    assert lisp(form) == "(0 NIL)"
    assert kernel.now() == 2


@pytest.mark.parametrize("name", ["with-local-interrupts", "allow-with-interrupts"])
def test_what_belongs_inside_is_an_error_elsewhere(lisp, name):
    with pytest.raises(Condition) as caught:
        lisp(f"({name} 1)")
    lisp("(in-package :cl-user)")
    assert str(caught.value) == f"SB-SYS:{name.upper()} is valid only inside SB-SYS:WITHOUT-INTERRUPTS."


def test_the_values_of_the_body_come_through(lisp):
    assert lisp("(without-interrupts (with-local-interrupts (values 1 2)))") == "1 2"
    assert lisp("(without-interrupts (allow-with-interrupts (with-interrupts (values))))") == ""
