"""The faces of the plan language: the packages CRAM-LANGUAGE-IMPLEMENTATION, CRAM-LANGUAGE and CRAM-USER (cpl.md section 1).

CRAM-LANGUAGE is what users use instead of COMMON-LISP: all of Common Lisp, eleven of its names replaced by fluent-aware ones, and
the plan language. Which symbol is which Python function stands in the tables below. Macros are only exported here; they are
defined in ``hy_src/cramhy/cpl.hy`` and ``hy_src/cramhy/plans.hy``.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons
from ...compiler.net_tests import make_nets, wait_for_nets
from ...packages.face_definition import define_face
from ...syntax.operator_macros import export
from ...types.types import define_type
from ....operators import PLAN_LANGUAGE
from cramhy_runtime.cpl import current, hooks, logging, statuses, task_variables
from cramhy_runtime.cpl.failures import handling as failures
from cramhy_runtime.cpl.fluents import operators as fluent_operators, fluents
from cramhy_runtime.cpl.forms import operators, plans, policies
from cramhy_runtime.cpl.tasks import suspension, task_readers, tasks, waiting
from cramhy_runtime.cpl.tree import task_tree as tree, tree_report
from . import plan_tree
from . import macro_support, markers, printing, readers, walker
from . import user_methods as _user_methods  # noqa: F401
from cramhy_runtime.cpl.symbols import CPL_IMPL, sym

OPERATORS = {
    "FL<": fluent_operators.fl_lt,
    "FL>": fluent_operators.fl_gt,
    "FL=": fluent_operators.fl_equals,
    "FL+": fluent_operators.fl_plus,
    "FL-": fluent_operators.fl_minus,
    "FL*": fluent_operators.fl_times,
    "FL/": fluent_operators.fl_divide,
    "FL-EQ": fluent_operators.fl_eq,
    "FL-EQL": fluent_operators.fl_eql,
    "FL-NOT": fluent_operators.fl_not,
    "FL-PULSED": fluent_operators.fl_pulsed,
    "FL-MEMBER": fluent_operators.fl_member,
}
"""The fluent operators under their names of CPL-IMPL."""

SHADOWING = {
    "<": "FL<",
    ">": "FL>",
    "=": "FL=",
    "+": "FL+",
    "-": "FL-",
    "*": "FL*",
    "/": "FL/",
    "EQ": "FL-EQ",
    "EQL": "FL-EQL",
    "NOT": "FL-NOT",
}
"""Names of Common Lisp that CPL replaces by fluent operators."""

FUNCTIONS = {
    fluents: "value peek-value pulse register-update-callback remove-update-callback get-update-callback",
    fluent_operators: "fl-and fl-or fl-funcall fl-value-changed fl-apply",
    waiting: "wait-for sleep*",
    tasks: "evaporate join-task execute",
    task_readers: "task-alive task-dead task-running-p task-dead-p task-done-p task-failed-p task-path status result "
    "list-saved-tasks clear-saved-tasks child-tasks parent-task task-constraints",
    suspension: "suspend wake-up",
    task_variables: "tv-closure",
    failures: "fail composite-failures envelop-error",
    tree: "make-task sub-task task-tree-node clear-tasks stale-task-tree-node-p flatten-task-tree filter-task-tree "
    "get-top-level-task-tree remove-top-level-task-tree task-tree-node-effective-code task-tree-node-parameters "
    "task-tree-node-status-fluent task-tree-node-result goal-task-tree-node-p goal-task-tree-node-pattern "
    "goal-task-tree-node-parameter-bindings goal-task-tree-node-goal replace-task-code register-task-code",
    readers: "name parameters policy-name policy-parameters policy-init policy-check policy-recover policy-clean-up "
    "make-code copy-code code-p code-sexp code-function code-task code-parameters "
    "make-task-tree-node copy-task-tree-node task-tree-node-p task-tree-node-path task-tree-node-code "
    "task-tree-node-code-replacements task-tree-node-parent task-tree-node-children "
    "make-plan-tree-node copy-plan-tree-node plan-tree-node-p plan-tree-node-sexp plan-tree-node-path plan-tree-node-parent "
    "plan-tree-node-children",
    plan_tree: "expand-plan find-plan-node",
    plans: "register-goal describe-goal",
    policies: "named-policy",
    operators: "mapcar-clean unwind-and-teardown",
    logging: "log-enable log-disable log-set list-available-log-tags list-active-log-tags",
}

IMPLEMENTATION_ONLY = """fl< fl> fl= fl+ fl- fl* fl/ fl-eq fl-eql fl-not fl-pulsed fl-apply *log-output* *log-right-margin*
    +log-all+ +log-default+
    +log-verbose+ +log-very-verbose+ +log-language+ list-available-log-tags list-active-log-tags log-enable log-disable log-set name
    *save-tasks* *tasks* list-saved-tasks"""
"""Exported by CPL-IMPL but not by CPL (cpl.md 1.4)."""

REACHED_FOR = """fl-member child-tasks parent-task task-constraints execute remove-top-level-task-tree replace-task-code register-task-code
    unwind-and-teardown log-succeed log-fail policy-name policy-parameters policy-init policy-check policy-recover policy-clean-up
    make-code copy-code code-p copy-task-tree-node task-tree-node-code-replacements make-plan-tree-node copy-plan-tree-node
    plan-tree-node-p plan-type plan-lambda-list plan-sexp *task-tree-node-print-path* *task-tree-node-print-code*
    *task-tree-node-print-children* *task-tree-node-print-identity* on-preparing-named-top-level on-finishing-named-top-level
    on-begin-execute-tag-task on-finish-execute-tag-task on-preparing-task-execution on-finishing-task-execution
    on-with-failure-handling-begin on-with-failure-handling-end on-with-failure-handling-handled on-with-failure-handling-rethrown
    on-with-policy-begin on-with-policy-end clear-saved-tasks"""
"""What other CRAM code reaches for with ``::`` (cpl.md 1.5): exported here, but not by CPL, whose users may have such names too."""

WALKER = """plan-tree-node plan-tree-node-sexp plan-tree-node-parent plan-tree-node-children plan-tree-node-path find-plan-node
    expand-plan make-plan-tree-node copy-plan-tree-node plan-tree-node-p"""
"""What CRAM-WALKER exports together with the plan language (cpl.md 12)."""

MACROS_AND_MARKERS = """fluent value-fluent current-task task toplevel-task status-indicator plan-failure simple-plan-failure
    composite-failure
    common-lisp-error-envelope retry do-retry reset-counter get-counter tag tagged code goal goal-context succeed policy-get
    policy-setf timeout-policy policy-condition policy-not-found policy-failure policy-init-failed policy-check-condition-met
    plan-tree-node"""


def define_faces():
    """Declare the packages. COMMON-LISP must be filled."""
    make_nets((*OPERATORS.values(), fluent_operators.fl_and, fluent_operators.fl_or), lambda thing: isinstance(thing, fluents.Fluent))
    wait_for_nets(CPL_IMPL.intern("WAIT-FOR"), sym("CRAMHY::WHENEVER"))
    for name, getter, setter in (
        ("*CURRENT-TASK*", current.current_task, None),
        ("*CURRENT-PATH*", tree.current_path, None),
        ("*TASK-TREE*", tree.current_tree, None),
    ):
        if not CPL_IMPL.present(name):
            task_variables.define_task_state(CPL_IMPL, name, getter, setter)
    hook_functions = {hook.name.name: hook.function for hook in vars(hooks).values() if isinstance(hook, hooks.Hook)}
    constants = {"+alive+": statuses.ALIVE, "+dead+": statuses.DEAD, "+done+": statuses.DONE}
    log_lists = {
        "+log-all+": logging.TAGS,
        "+log-default+": logging.DEFAULT,
        "+log-verbose+": logging.VERBOSE,
        "+log-very-verbose+": logging.VERY_VERBOSE,
        "+log-language+": logging.LANGUAGE,
    }
    define_face(
        "CRAM-LANGUAGE-IMPLEMENTATION",
        ["CPL-IMPL"],
        use=["COMMON-LISP"],
        functions={
            **FUNCTIONS,
            **OPERATORS,
            **hook_functions,
            "make-fluent": fluents.fluent_from_initargs,
            "current-task": tasks.current_task_or_dummy,
            "task": tree.task_at,
            "describe-task-tree": tree_report.describe_task_tree_in_lisp,
        },
        variables={
            "*task-pprint-verbosity*": 0,
            "*break-on-plan-failures*": None,
            "*debug-on-lisp-errors*": None,
            "*save-tasks*": None,
            "*record-task-tree*": None,
            "*log-output*": None,
            "*log-right-margin*": 130,
            **printing.SWITCHES,
            "timeout-policy": policies.TIMEOUT_POLICY,
            **{name: statuses.status_list(members) for name, members in constants.items()},
            **{name: logging.tag_list(tags) for name, tags in log_lists.items()},
        },
        generic="child-tasks parent-task task-constraints execute name parameters composite-failures envelop-error",
        export=f"{MACROS_AND_MARKERS} {REACHED_FOR} *current-task* *current-path* *task-tree* *tasks* *cleanup-time-limit*",
        internal="abstract-task",
    )
    for name, writer in readers.WRITERS.items():
        CPL_IMPL.intern(name).setf_function = writer
    real_statuses = statuses.status_list((*statuses.NEXT, *statuses.DEAD))
    define_type(CPL_IMPL.intern("STATUS-INDICATOR"), lambda form, env: Cons(sym("MEMBER"), real_statuses))
    export(PLAN_LANGUAGE)
    not_reexported = {name.upper() for name in f"{IMPLEMENTATION_ONLY} {REACHED_FOR}".split()}
    not_reexported |= {operator.name for operator in PLAN_LANGUAGE.values() if not operator.exported}
    shared = " ".join(name for name in CPL_IMPL.external if name not in not_reexported)
    define_face(
        "CRAM-LANGUAGE",
        ["CPL"],
        use=["COMMON-LISP"],
        shadow=[*SHADOWING, "SLEEP"],
        imports={"CPL-IMPL": shared},
        functions={
            **{name: OPERATORS[operator] for name, operator in SHADOWING.items()},
            "SLEEP": waiting.sleep_star,
            "PULSED": fluent_operators.fl_pulsed,
        },
        reexport=["COMMON-LISP"],
    )
    define_face(
        "CRAM-WALKER",
        ["WALKER"],
        use=["COMMON-LISP"],
        imports={"CPL-IMPL": WALKER},
        functions={"walk-with-tag-handler": walker.walk_with_tag_handler},
    )
    macro_support.define()
    markers.define()
    define_face("CRAM-USER", ["CPL-USER"], use=["CRAM-LANGUAGE"])


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_faces()
