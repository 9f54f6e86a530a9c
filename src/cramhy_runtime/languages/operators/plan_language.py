"""The operators of the plan language: packages CRAM-LANGUAGE-IMPLEMENTATION and CRAM-LANGUAGE (cpl.md 2 to 10)."""

from __future__ import annotations

from .declaration import BRANCHES, IN_PLACE, Table

PLAN_LANGUAGE = Table(
    "CRAM-LANGUAGE-IMPLEMENTATION",
    # ------------------------------------------------------------------------------------------ 5, 6: plans and branches
    (
        "(top-level form...)",
        "(%top-level (lambda () form...))",
        "Run the body as the root of a plan; its value. A failure that leaves it is signalled.",
        IN_PLACE,
        BRANCHES,
    ),
    (
        "(- named-top-level ([:name name]) form...)",
        "(%named-top-level (lambda () form...) 'name)",
        "As TOP-LEVEL, with a name under which the task tree is kept.",
        IN_PLACE,
        BRANCHES,
    ),
    ("(seq form...)", "(progn form...)", "One form after the other; the value of the last."),
    ("(par form...)", "(%par (lambda () form)...)", "All at once until all have ended; the value of the first.", BRANCHES),
    (
        "(pursue form...)",
        "(%pursue (lambda () form)...)",
        "All at once until one has ended; its value. The others are evaporated.",
        BRANCHES,
    ),
    ("(try-all form...)", "(%try-all (lambda () form)...)", "All at once until one succeeds; its value.", BRANCHES),
    (
        "(try-in-order form...)",
        "(block nil (%try-in-order (lambda () form)...))",
        "One after the other until one succeeds; its value.",
        IN_PLACE,
        BRANCHES,
    ),
    (
        "(try-each-in-order (variable list) form...)",
        "(block nil (%try-each-in-order list (lambda (variable) form...)))",
        "The body with one element after the other until it succeeds; its value.",
        IN_PLACE,
        BRANCHES,
    ),
    (
        "(par-loop (variable list) form...)",
        "(%par-loop list (lambda (variable) form...))",
        "The body with all elements at once; the value for the first.",
        BRANCHES,
    ),
    (
        "(partial-order (step...) (:order before after)...)",
        None,
        "As PAR, but the task AFTER begins when the task BEFORE is dead.",
        BRANCHES,
    ),
    (
        "(- with-parallel-childs name (running completed failed) (form...) watcher...)",
        None,
        "Forms at once, and a watcher that sees lists of the running, the completed and the failed tasks, and ends it all by a return.",
    ),
    ("(with-task-suspended (task [:reason text]) form...)", None, "The body while the task is suspended; afterwards it goes on.", IN_PLACE),
    ("(- with-task ([:class class] [:name name]) form...)", None, "The body as a task of its own; its value.", IN_PLACE, BRANCHES),
    # ------------------------------------------------------------------------------------------------------- 2: fluents
    ("(whenever (fluent) form...)", None, "The body each time that the fluent is true, until a return leaves it."),
    (
        '(def-cpl-parameter name [value ["documentation"]])',
        None,
        "A variable whose value is kept in a fluent, so that plans can wait for it.",
    ),
    # --------------------------------------------------------------------------------------------------------- 3: tasks
    (
        "(on-suspension form body-form...)",
        "(%on-suspension (lambda () form) (lambda () body-form...))",
        "The body; whenever the task is suspended meanwhile, FORM runs first.",
        IN_PLACE,
    ),
    (
        "(retry-after-suspension form...)",
        "(%retry-after-suspension (lambda () form...))",
        "The body; a suspension unwinds it, and after the wake-up it begins again.",
        IN_PLACE,
    ),
    (
        "(without-scheduling form...)",
        "(%without-scheduling (lambda () form...))",
        "The body; requests to suspend or evaporate the task wait until it is over.",
        IN_PLACE,
    ),
    (
        "(with-scheduling form...)",
        "(%with-scheduling (lambda () form...))",
        "The body inside of WITHOUT-SCHEDULING, open for requests again.",
        IN_PLACE,
    ),
    (
        '(define-task-variable name [value ["documentation"]] [:type type] [:init-function function])',
        None,
        "A special variable of which each task has its own value.",
    ),
    # ------------------------------------------------------------------------------------------------------ 4: failures
    (
        "(with-failure-handling ((failure-type (failure) form...)...) form...)",
        None,
        "The body; a failure of the type runs the forms before anything unwinds. They decline, or leave by RETRY or a return.",
        IN_PLACE,
    ),
    (
        "(with-retry-counters ((counter value)...) form...)",
        None,
        "Counters for the body, where (do-retry counter form...) runs its forms while the counter is above zero.",
    ),
    # --------------------------------------------------------------------------------------------- 7, 8: names of steps
    (
        "(with-tags form...)",
        None,
        "The body, in which (:tag name form...) runs its forms as the task NAME, a variable of the body.",
        IN_PLACE,
    ),
    (
        (
            "(with-task-tree-node ([:path-part path] [:name text] [:sexp form] [:lambda-list (parameter...)] [:parameters arguments] "
            "[:log-parameters arguments] [:log-pattern pattern]) form...)"
        ),
        None,
        "The body as a node of the task tree.",
        IN_PLACE,
    ),
    (
        "(replaceable-function name (parameter...) arguments path form...)",
        None,
        "The body as a node of the task tree whose code can be replaced.",
    ),
    (
        '(def-cram-function name (parameter...) ["documentation"] form...)',
        None,
        "Define a plan: a function whose calls are nodes of the task tree.",
    ),
    (
        '(def-top-level-cram-function name (parameter...) ["documentation"] form...)',
        None,
        "Define a plan that is the root of a task tree: each call is a TOP-LEVEL.",
    ),
    ('(def-plan name (parameter...) ["documentation"] form...)', None, "The old name of DEF-CRAM-FUNCTION."),
    ('(def-top-level-plan name (parameter...) ["documentation"] form...)', None, "The old name of DEF-TOP-LEVEL-CRAM-FUNCTION."),
    (
        "(declare-goal name (parameter...) form...)",
        None,
        "Declare a goal: a function that runs the body of the DEF-GOAL whose pattern fits its arguments.",
    ),
    ('(def-goal (name pattern...) ["documentation"] form...)', None, "Say how a goal is reached whose arguments fit the pattern."),
    # ------------------------------------------------------------------------------------------------------ 9: policies
    (
        '(make-policy name (parameter...) ["documentation"] clause...)',
        None,
        "A policy; its clauses are :init, :check, :recover, :clean-up.",
    ),
    (
        '(define-policy name (parameter...) ["documentation"] clause...)',
        None,
        "Define a policy, which WITH-NAMED-POLICY finds by its name.",
    ),
    (
        "(with-policy policy (argument...) form...)",
        None,
        "The body while the policy watches: when its check is true, the body ends with a policy failure.",
        IN_PLACE,
    ),
    ("(with-named-policy name (argument...) form...)", None, "As WITH-POLICY, of a policy that is named.", IN_PLACE),
    ("(with-policies ((policy (argument...))...) form...)", None, "WITH-POLICY for several policies, the first outermost.", IN_PLACE),
    (
        "(with-named-policies ((name (argument...))...) form...)",
        None,
        "WITH-NAMED-POLICY for several policies, the first outermost.",
        IN_PLACE,
    ),
    # ------------------------------------------------------------------------------------------------------ 10: logging
    (
        "(- log-event clause...)",
        None,
        "Print a line if one of the tags is enabled; the clauses are (:context control argument...), (:display ...) and (:tags tag...).",
    ),
    ("(- logging-enabled-p tag...)", None, "Whether lines of one of the tags are printed."),
    ("(- define-log-tags tag...)", None, "Let there be tags of log lines."),
    (
        "(- log-block begin-hook (parameter...) end-hook form...)",
        None,
        "The body between two hooks; the second hears whether it called LOG-SUCCEED last.",
    ),
)
