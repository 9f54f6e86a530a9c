"""The operators of CRAM-PROLOG (prolog.md) and CRAM-UTILITIES (cpl.md 13)."""

from __future__ import annotations

from .declaration import IN_PLACE, Table

PROLOG = Table(
    "CRAM-PROLOG",
    (
        "(def-fact-group name (predicate...) fact...)",
        None,
        "Define facts and rules as a group. PREDICATE... are those of other groups to which it adds.",
    ),
    ("(<- head goal...)", "(%fact-outside-group '(head goal...))", "A fact, or a rule, of a fact group: the head holds if all goals hold."),
    (
        "(def-prolog-handler name (bindings pattern...) form...)",
        "(%define-prolog-handler 'name (%named-lambda name (bindings pattern...) form...))",
        "Define a predicate by code: the body gives the lazy list of its solutions, each a list of bindings.",
    ),
    (
        "(with-facts-asserted (fact...) form...)",
        "(%with-facts-asserted (list (lambda () fact)...) (lambda () form...))",
        "The body while the facts are asserted in the alpha network.",
        IN_PLACE,
    ),
    ("(trace-prolog functor...)", "(%trace-prolog '(functor...))", "Tell of each goal of these predicates, or of all."),
    ("(untrace-prolog functor...)", "(%untrace-prolog '(functor...))", "Tell of goals of these predicates no longer, or of none."),
    (
        "(def-production name pattern...)",
        "(register-production 'name '(pattern...))",
        "Define a production: handlers hear when facts fit all of its patterns, and when they no longer do.",
    ),
    ("(with-productions ((name pattern...)...) form...)", None, "The body while there are these productions."),
    ("(with-production-handlers ((name (parameter...) form...)...) form...)", None, "The body while these functions hear of productions."),
)

UTILITIES = Table(
    "CRAM-UTILITIES",
    (
        "(lazy-list (variable...) form...)",
        None,
        "A list whose elements are computed when they are asked for: (cont x ...) gives one, (next ...) none, (finish) ends it.",
    ),
    ("(with-lazy-list-dynamic-environment ((variable value)...) form...)", None, "Bindings that also hold while a lazy list goes on."),
    ("(lazy-dolist (variable list [result]) form...)", None, "The body with one element of a lazy list after the other."),
    ("(delay form...)", "(%delay (lambda () form...))", "A promise of the value of the body, which FORCE computes once."),
    ("(with-vars-bound (variable...) bindings form...)", None, "The body with Prolog variables bound as the bindings say."),
    ("(with-vars-strictly-bound (variable...) bindings form...)", None, "As WITH-VARS-BOUND; each variable must have a value."),
    ("(with-pat-vars-bound pattern sequence form...)", None, "The body with the variables of the pattern bound as the sequence fits."),
    ("(assert-no-returning form...)", "(%assert-no-returning '(form...) (lambda () form...))", "The forms, which must not return."),
    ("(assert-no-nlx form...)", "(%assert-no-nlx '(form...) (lambda () form...))", "The forms, which must return."),
    ("(flet* ((name (parameter...) form...)...) form...)", None, "As FLET, where each function sees the ones before."),
    ("(string-case string (key form...)...)", None, "The clause whose key is the string, whatever its case."),
    (
        "(destructure-case list ((key parameter...) form...)...)",
        None,
        "The clause whose key is the first of a list; its parameters are the rest.",
    ),
    ("(pop-if! predicate place)", "(setf place (delete-if predicate place :count 1))", "Take the first element away for which it is true."),
    (
        "(with-file-cache variable file form body-form...)",
        "(let ((variable (%file-value file (lambda () form)))) body-form...)",
        "The body with the value of FORM, computed again only when the file has changed.",
    ),
    (
        "(with-lock-held (lock [:whostate text]) form...)",
        "(%with-lock-held lock (lambda () form...))",
        "The body while the task holds the lock.",
        IN_PLACE,
    ),
    (
        "(with-hash-table-locked (table) form...)",
        "(%with-hash-table-locked table (lambda () form...))",
        "The body while nobody else changes the table.",
    ),
    ("(with-synchronization-barrier (variable count option...) form...)", None, "The body with a new barrier, which is broken at its end."),
    ("(with-synchronization-barriers ((variable count option...)...) form...)", None, "The body with several new barriers."),
    ("(choose tag [:parameters names] [:generators forms] [:body form])", None, "A tag that computes each parameter by its generator."),
    (
        "(define-hook name (parameter...) option...)",
        None,
        "A generic function that calls all methods that apply; the list of their results.",
    ),
)
