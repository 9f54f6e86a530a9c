"""The macros of SBCL's packages, as templates (`operators.declaration` says what a row means)."""

from __future__ import annotations

from ...operators.declaration import Table

TABLES = (
    Table(
        "SB-THREAD",
        (
            "(with-mutex (mutex option...) form...)",
            "(call-with-mutex (lambda () form...) mutex option...)",
            "The body while the thread has the mutex; nil if it cannot be had. Options: :WAIT-P, :TIMEOUT.",
        ),
        (
            "(with-recursive-lock (mutex option...) form...)",
            "(call-with-recursive-lock (lambda () form...) mutex option...)",
            "As WITH-MUTEX, but the thread may have the mutex already.",
        ),
        ("(with-spinlock (mutex) form...)", "(call-with-mutex (lambda () form...) mutex)", "WITH-MUTEX, as it was called once."),
        ("(return-from-thread values option...)", "(leave-thread (lambda () values))", "End this thread with these values."),
        ("(with-session-lock (session) form...)", "(progn form...)", "The body: there are no sessions."),
        ("(with-new-session (option...) form...)", "(progn form...)", "The body: there are no sessions."),
        ("(barrier (kind) form...)", "(progn form...)", "The body: one task runs at a time, so memory is always in order."),
    ),
    Table(
        "SB-EXT",
        (
            "(with-timeout seconds form...)",
            "(sb-thread::call-with-timeout seconds (lambda () form...))",
            "The body, in which the condition TIMEOUT is signalled after so many seconds.",
        ),
        (
            "(wait-for test option...)",
            "(sb-thread::wait-until (lambda () test) option...)",
            "Wait until the form is true. Option: :TIMEOUT.",
        ),
        (
            "(define-hash-table-test name function)",
            "(sb-thread::define-hash-table-test 'name 'function)",
            "Let NAME be a test of hash tables; FUNCTION gives equal numbers for keys that are the same.",
        ),
        (
            "(with-locked-hash-table (table) form...)",
            "(sb-thread::call-with-locked-table table (lambda () form...))",
            "The body, alone with the table.",
        ),
        ("(truly-the type form)", "(the type form)", "The form, whose value is of the type."),
        ("(with-current-source-form (source...) form...)", "(progn form...)", "The body."),
    ),
    Table(
        "SB-INT",
        (
            "(with-float-traps-masked (trap...) form...)",
            "(call-with-float-traps-masked '(trap...) (lambda () form...))",
            "The body, in which floats may become infinite: :OVERFLOW, :DIVIDE-BY-ZERO, :INVALID, :INEXACT.",
        ),
        ("(named-lambda name parameters form...)", "(lambda parameters form...)", "The function; its name is not kept."),
    ),
    Table(
        "SB-KERNEL",
        (
            "(with-array-data ((data array option...) (start from) (end to) option...) form...)",
            "(let* ((data array) (start from) (end (or to (length data)))) form...)",
            "The body with a vector, and where the part of it begins and ends.",
        ),
    ),
    Table(
        "SB-SYS",
        (
            "(with-deadline (option...) form...)",
            "(sb-thread::call-with-deadline (lambda () form...) option...)",
            "The body, in which waiting signals DEADLINE-TIMEOUT after so many seconds. Options: :SECONDS, :OVERRIDE.",
        ),
        (
            "(without-interrupts form...)",
            "(sb-thread::call-uninterrupted (lambda () form...))",
            "The body; interruptions wait until its end.",
        ),
        (
            "(with-interrupts form...)",
            "(sb-thread::call-interrupted (lambda () form...))",
            "The body; interruptions arrive in it, if that is allowed here.",
        ),
        (
            "(allow-with-interrupts form...)",
            "(sb-thread::call-allowing-interrupts (lambda () form...))",
            "The body, in a WITHOUT-INTERRUPTS: WITH-INTERRUPTS in it lets interruptions in.",
        ),
        (
            "(with-local-interrupts form...)",
            "(sb-thread::call-locally-interrupted (lambda () form...))",
            "The body, in a WITHOUT-INTERRUPTS: interruptions arrive in it.",
        ),
        ("(without-gcing form...)", "(progn form...)", "The body."),
        ("(with-pinned-objects (object...) form...)", "(progn form...)", "The body."),
    ),
)
