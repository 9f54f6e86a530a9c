"""SB-CONCURRENCY: mailboxes and gates between threads, in virtual time. Queues are those of CUT, which has tests of its own."""

import pytest


@pytest.fixture
def lisp(session):
    from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
    from cramhy_runtime.repl.session import Session

    here = Session(time="virtual", turtlesim=False)
    here.evaluate_text("(asdf:load-system :sb-concurrency) (defpackage :sbq (:use :cl :sb-concurrency :sb-thread)) (in-package :sbq)")
    return lambda text: prin1_to_string(here.evaluate_text(text)[-1])


FORMS = {
    "messages come in order": (
        "(let ((m (make-mailbox :initial-contents '(1 2)))) (send-message m 3)"
        " (list (mailbox-count m) (list-mailbox-messages m) (receive-message m) (receive-pending-messages m 1)"
        "  (receive-pending-messages m) (mailbox-empty-p m) (multiple-value-list (receive-message-no-hang m))))",
        "(3 (1 2 3) 1 (2) (3) T (NIL NIL))",
    ),
    "an empty mailbox is waited on": (
        "(let* ((m (make-mailbox)) (r (make-thread (lambda () (multiple-value-list (receive-message m))))))"
        " (send-message m :late) (join-thread r))",
        "(:LATE T)",
    ),
    "the time is over": ("(multiple-value-list (receive-message (make-mailbox) :timeout 1))", "(NIL NIL)"),
    "NIL is a message": ("(let ((m (make-mailbox))) (send-message m nil) (multiple-value-list (receive-message m)))", "(NIL T)"),
    "a gate opens for all": (
        "(let* ((g (make-gate)) (ts (loop repeat 2 collect (make-thread (lambda () (wait-on-gate g))))))"
        " (list (gate-open-p g) (open-gate g) (open-gate g) (mapcar #'join-thread ts) (close-gate g) (close-gate g)"
        "  (wait-on-gate g :timeout 1)))",
        "(NIL T NIL (T T) T NIL NIL)",
    ),
    "a queue has its older package": (
        "(progn (asdf:load-system :sb-queue) (let ((q (make-queue :initial-contents '(1))))"
        ' (funcall (intern "ENQUEUE" :sb-queue) 2 q) (list-queue-contents q)))',
        "(1 2)",
    ),
}


@pytest.mark.parametrize("form", FORMS)
def test_mailboxes_and_gates(lisp, form):
    text, answer = FORMS[form]
    assert lisp(text) == answer
