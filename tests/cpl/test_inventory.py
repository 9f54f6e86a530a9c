"""The names of the plan language: which package has them, whether they are exported, and what they name (cpl.md 1)."""

import pytest

from cramhy_runtime.languages.commonlisp.faces.cpl.markers import WHERE
from cramhy_runtime.languages.commonlisp.faces.cpl.package import IMPLEMENTATION_ONLY, REACHED_FOR
from cramhy_runtime.lisp_core.data import UNBOUND, UndefinedFunction
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.languages.commonlisp.syntax.macros import ensure_loaded
from cramhy_runtime.languages.commonlisp.objects.classes import find_class
from cramhy_runtime.lisp_core.packages import COMMON_LISP, find_package, keyword
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.types.types import is_known_type, typep
from cramhy_runtime.languages.operators import PLAN_LANGUAGE

NOT_EXPORTED = {operator.name for operator in PLAN_LANGUAGE.values() if not operator.exported}

FUNCTIONS = """value peek-value wait-for pulse make-fluent on-make-fluent-hook register-update-callback remove-update-callback
    get-update-callback fl-and fl-or fl-funcall fl-value-changed
    current-task task task-alive task-dead task-running-p task-dead-p task-done-p task-failed-p status result evaporate suspend wake-up
    join-task tv-closure task-path sleep*
    fail on-fail composite-failures envelop-error
    on-top-level-setup-hook on-top-level-cleanup-hook
    code-parameters code-sexp code-function code-task task-tree-node task-tree-node-p task-tree-node-path task-tree-node-code
    task-tree-node-parent task-tree-node-children task-tree-node-effective-code task-tree-node-parameters task-tree-node-status-fluent
    task-tree-node-result make-task-tree-node make-task sub-task clear-tasks stale-task-tree-node-p filter-task-tree flatten-task-tree
    get-top-level-task-tree goal-task-tree-node-p goal-task-tree-node-pattern goal-task-tree-node-parameter-bindings
    goal-task-tree-node-goal
    on-def-top-level-plan-hook register-goal describe-goal
    named-policy parameters
    plan-tree-node-sexp plan-tree-node-parent plan-tree-node-children plan-tree-node-path find-plan-node expand-plan
    mapcar-clean"""
MACROS = """whenever def-cpl-parameter define-task-variable without-scheduling with-scheduling retry-after-suspension on-suspension
    with-failure-handling with-retry-counters
    top-level seq par par-loop pursue try-all try-in-order try-each-in-order partial-order with-task-suspended with-tags
    with-task-tree-node replaceable-function
    def-cram-function def-top-level-cram-function def-plan def-top-level-plan declare-goal def-goal
    with-policy with-named-policy with-policies with-named-policies make-policy define-policy"""
VARIABLES = """*current-task* *current-path* *task-pprint-verbosity* +alive+ +dead+ +done+ *break-on-plan-failures* *debug-on-lisp-errors*
    *task-tree* timeout-policy"""
CLASSES = """fluent value-fluent task toplevel-task plan-failure simple-plan-failure composite-failure common-lisp-error-envelope
    code task-tree-node policy-condition policy-not-found policy-failure policy-init-failed policy-check-condition-met plan-tree-node"""
MARKERS = "tag tagged goal goal-context succeed retry do-retry reset-counter get-counter policy-get policy-setf"  # the last two: repaired
SHADOWED = "< > + - * / = eq eql not sleep"
ONLY_IMPLEMENTATION = {
    "function": """fl< fl> fl= fl+ fl- fl* fl/ fl-eq fl-eql fl-not fl-pulsed fl-apply name list-saved-tasks list-available-log-tags
        list-active-log-tags log-enable log-disable log-set""",
    "macro": "log-event logging-enabled-p",
    "variable": """*log-output* *log-right-margin* +log-all+ +log-default+ +log-verbose+ +log-very-verbose+ +log-language+ *save-tasks*
        *tasks*""",
}
REACHED_FOR_BY_OTHERS = {
    "function": """remove-top-level-task-tree unwind-and-teardown replace-task-code register-task-code execute child-tasks parent-task
        task-constraints policy-name policy-parameters on-preparing-named-top-level on-finishing-named-top-level
        on-begin-execute-tag-task on-finish-execute-tag-task on-preparing-task-execution on-finishing-task-execution
        on-with-failure-handling-begin on-with-failure-handling-end on-with-failure-handling-handled on-with-failure-handling-rethrown
        on-with-policy-begin on-with-policy-end""",
    "macro": "named-top-level log-block with-parallel-childs with-task",
}
NOT_IN_THE_LANGUAGE = "wait-duration suspend-protect without-suspension with-suspension lazy-cons wait-until"

LAMBDA_LISTS = {
    "task-path": "(TASK)",
    "status": "(TASK)",
    "result": "(TASK)",
    "current-task": "NIL",
    "join-task": "(TASK)",
    "evaporate": "(TASK &KEY REASON SYNC)",
    "suspend": "(TASK &KEY REASON SYNC)",
    "wake-up": "(TASK &KEY REASON SYNC)",
    "sleep*": "(SECONDS)",
    "make-task": "(&KEY NAME SEXP FUNCTION PATH PARAMETERS)",
    "task": "(PATH)",
    "sub-task": "(PATH)",
    "task-tree-node": "(PATH &OPTIONAL NODE)",
    "clear-tasks": "(NODE)",
    "filter-task-tree": "(PREDICATE TREE)",
    "flatten-task-tree": "(TREE)",
    "get-top-level-task-tree": "(NAME)",
    "goal-task-tree-node-goal": "(NODE)",
    "register-goal": "(NAME PATTERN GOAL-FUN &OPTIONAL DOC-STRING)",
    "describe-goal": "(GOAL)",
    "expand-plan": "(FORM)",
    "find-plan-node": "(PLAN-TREE PATH)",
    "register-update-callback": "(FLUENT NAME FUNCTION)",
    "replace-task-code": "(SEXP FUNCTION PATH &OPTIONAL TREE)",
    "register-task-code": "(SEXP FUNCTION &KEY PATH TASK-TREE REPLACE-REGISTERED)",
}

ensure_loaded()
CPL, CPL_IMPL, WALKER = (find_package(name) for name in ("CPL", "CPL-IMPL", "WALKER"))


@pytest.fixture(autouse=True, params=["once"])
def fresh_kernel():
    """Names need no back end."""


def kinds(symbol):
    """What ``symbol`` names, one after the other: to look for a class takes longest."""
    if symbol.macro is not None:
        yield "macro"
    if not isinstance(symbol.function, UndefinedFunction):
        yield "function"
    if symbol.special and symbol.value is not UNBOUND:
        yield "variable"
    if is_known_type(symbol):
        yield "class"


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("kind, names", [("function", FUNCTIONS), ("macro", MACROS), ("variable", VARIABLES), ("class", CLASSES)])
def test_both_packages_export_every_name_of_the_language_and_it_has_its_meaning(kind, names):
    for name in names.upper().split():
        symbol, status = CPL_IMPL.lookup(name)
        assert (status, CPL.lookup(name)) == ("external", (symbol, "external")), name
        assert kind in kinds(symbol), name


def test_a_class_of_the_language_is_a_class():
    for name in CLASSES.upper().split():
        assert find_class(CPL.lookup(name)[0]) is not None


def test_status_indicator_is_the_type_of_the_statuses_that_a_task_can_have():
    indicator = CPL.lookup("STATUS-INDICATOR")[0]
    assert typep(keyword("RUNNING"), indicator) and typep(keyword("CREATED"), indicator) and typep(keyword("EVAPORATED"), indicator)
    assert not typep(keyword("WAITING"), indicator)


def test_cpl_replaces_eleven_names_of_common_lisp_and_exports_all_others():
    own = {name for name in COMMON_LISP.external if CPL.lookup(name)[0] is not COMMON_LISP.external[name]}
    assert own == set(SHADOWED.upper().split())
    assert all(CPL.lookup(name)[1] == "external" for name in COMMON_LISP.external)
    assert CPL.lookup("PULSED")[1] == "external" and CPL_IMPL.lookup("PULSED")[1] is None


@pytest.mark.parametrize("kind", ONLY_IMPLEMENTATION)
def test_what_only_the_implementation_exports_is_no_name_of_cpl(kind):
    for name in ONLY_IMPLEMENTATION[kind].upper().split():
        symbol, status = CPL_IMPL.lookup(name)
        assert status == "external" and kind in kinds(symbol) and CPL.lookup(name)[0] is not symbol, name
    assert {name for names in ONLY_IMPLEMENTATION.values() for name in names.split()} - {name.lower() for name in NOT_EXPORTED} == set(
        IMPLEMENTATION_ONLY.split()
    )


@pytest.mark.parametrize("kind", REACHED_FOR_BY_OTHERS)
def test_what_other_cram_code_reaches_for_is_public(kind):
    for name in REACHED_FOR_BY_OTHERS[kind].upper().split():
        symbol, status = CPL_IMPL.lookup(name)
        assert status == "external" and CPL.lookup(name)[0] is not symbol, name
        assert kind in kinds(symbol), name
        assert name in NOT_EXPORTED or name.lower() in REACHED_FOR.split()


def test_the_markers_are_exported_and_are_all_that_has_no_meaning():
    markers = set(MARKERS.upper().split())
    assert markers == set(WHERE)
    without = {name for name, symbol in CPL_IMPL.external.items() if not any(kinds(symbol))}
    assert without - {"LOG-SUCCEED", "LOG-FAIL", "PLAN-TYPE", "PLAN-LAMBDA-LIST", "PLAN-SEXP"} == markers
    assert all(CPL.lookup(name)[1] == "external" for name in markers)


@pytest.mark.parametrize("name, lambda_list", LAMBDA_LISTS.items())
def test_functions_have_the_lambda_lists_of_the_original(name, lambda_list):
    shown = prin1_to_string(lambda_list_of(CPL_IMPL.lookup(name.upper())[0].function))
    assert shown.replace("#:", "") == lambda_list


def test_the_packages_have_their_nicknames():
    for name, nickname in [
        ("CRAM-LANGUAGE-IMPLEMENTATION", "CPL-IMPL"),
        ("CRAM-LANGUAGE", "CPL"),
        ("CRAM-USER", "CPL-USER"),
        ("CRAM-WALKER", "WALKER"),
        ("CRAM-UTILITIES", "CUT"),
    ]:
        assert find_package(name) is find_package(nickname) is not None
    assert CPL in find_package("CRAM-USER").use


def test_the_walker_exports_the_plan_tree_and_its_own_function():
    for name in (
        "PLAN-TREE-NODE PLAN-TREE-NODE-SEXP PLAN-TREE-NODE-PARENT PLAN-TREE-NODE-CHILDREN PLAN-TREE-NODE-PATH FIND-PLAN-NODE "
        "EXPAND-PLAN".split()
    ):
        assert WALKER.lookup(name) == (CPL.lookup(name)[0], "external")
    own, status = WALKER.lookup("WALK-WITH-TAG-HANDLER")
    assert status == "external" and "function" in kinds(own) and CPL.lookup(own.name)[1] is None


def test_what_only_documentation_mentions_does_not_exist():
    for name in NOT_IN_THE_LANGUAGE.upper().split():
        assert CPL.lookup(name)[1] is None and CPL_IMPL.lookup(name)[1] is None, name
