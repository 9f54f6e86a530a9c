"""Tags, the task tree, plan functions, goals, policies: cpl.md section 16, invariants 98 to 111."""

import pytest
from small_plans import plan

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl.forms import plans, policies
from cramhy_runtime.cpl.tree import tags, task_tree as tree
from cramhy_runtime.cpl.failures.handling import attempt
from cramhy_runtime.cpl.statuses import CREATED, SUCCEEDED
from cramhy_runtime.lisp_core.conditions import Error
from cramhy_runtime.lisp_core.data import Cons, lisp_list
from cramhy_runtime.lisp_core.packages import intern, sym
from cramhy_runtime.languages.commonlisp.printer.printer import princ_to_string


def user(name):
    return intern(name, "CRAM-USER")


def paths(root):
    return [princ_to_string(node.path) for node in tree.flatten_task_tree(root)]


def run_tag(task, body=lambda: 1):
    task = tags.prepare_tag(task)
    return task, tags.execute_tag(task, body)


def test_a_tag_is_a_created_task_before_and_dead_after_and_repetition_makes_a_new_one():
    def body():
        first = tags.make_tag_task(user("A"))
        before = first.status
        again, value = run_tag(first, lambda: "values")
        second, _ = run_tag(again)
        third, _ = run_tag(second)
        return before, again is first, first.status, value, [princ_to_string(task.path) for task in (first, second, third)]

    assert plan(body) == (CREATED, True, SUCCEEDED, "values", ["((TAGGED A))", "((TAGGED A CALL 2))", "((TAGGED A CALL 3))"])


def test_a_sub_task_named_by_its_path_is_the_task_of_the_tag():
    def body():
        task = tags.make_tag_task(user("A"))
        return tree.sub_task(lisp_list(lisp_list(tags.TAGGED, user("A")))) is task

    assert plan(body)


def test_a_plan_function_runs_as_a_node_of_its_own_and_again_as_call_2():
    def f(x):
        return x, princ_to_string(cpl.current_task().path)

    def call(x):
        return plans.call_cram_function(user("F"), f, [x])

    assert plan(lambda: (call(1), call(2))) == ((1, "((F))"), (2, "((F CALL 2))"))
    assert plan(lambda: plans.call_cram_function(user("G"), lambda: call(3), [])) == (3, "((F) (G))")


def test_a_plan_function_outside_of_a_plan_is_a_type_error_that_says_what_to_do():
    with pytest.raises(Error) as problem:
        plans.call_cram_function(user("F"), lambda: 1, [])
    assert "TASK-TREE-NODE" in problem.value.report() and "(top-level" in problem.value.report()


def test_a_wrong_argument_count_is_an_error_of_the_new_task():
    failure = plan(lambda: attempt(lambda: plans.call_cram_function(user("F"), lambda x: x, [1, 2]))[1])
    assert isinstance(failure, cpl.CommonLispErrorEnvelope)


def test_the_tree_of_a_named_top_level_survives_and_what_did_not_run_again_is_stale():
    name = user("LECTURE")
    tree.remove_top_level_task_tree(name)

    def both():
        plans.call_cram_function(user("F"), lambda: 1, [])
        plans.call_cram_function(user("G"), lambda: 2, [])

    cpl.named_top_level(both, name)
    root = tree.get_top_level_task_tree(name)
    assert paths(root) == ["NIL", "((G))", "((F))"]
    cpl.named_top_level(lambda: plans.call_cram_function(user("F"), lambda: 3, []), name)
    f, g = (tree.task_tree_node(lisp_list(lisp_list(user(part))), root) for part in "FG")
    assert tree.stale_task_tree_node_p(f) is None and tree.stale_task_tree_node_p(g) is True
    assert tree.task_tree_node_result(f) == 3 and tree.task_tree_node_status_fluent(f).value is SUCCEEDED
    assert paths(tree.filter_task_tree(lambda node: node.path is None or node is f or None, root)) == ["NIL", "((F))"]


def test_a_replacement_is_called_by_this_and_all_later_runs():
    name = user("REPLACED")
    tree.remove_top_level_task_tree(name)

    def run():
        return cpl.named_top_level(lambda: plans.call_cram_function(user("F"), lambda x: ("original", x), [1]), name)

    assert run() == ("original", 1)
    root = tree.get_top_level_task_tree(name)
    node = tree.replace_task_code(None, lambda x: ("replacement", x), lisp_list(lisp_list(user("F"))), root)
    assert run() == ("replacement", 1) and run() == ("replacement", 1)
    assert tree.stale_task_tree_node_p(node) is True


def test_a_top_level_plan_function_is_a_named_top_level():
    name = user("LECTURE-38")
    tree.remove_top_level_task_tree(name)
    assert plans.call_top_level_cram_function(name, lambda x: x + 1, [1]) == 2
    assert paths(tree.get_top_level_task_tree(name)) == ["NIL", "((TOP-LEVEL LECTURE-38))"]


def test_the_first_goal_body_that_matches_wins_and_redefinition_keeps_its_place():
    name = user("GO-TO")
    plans.declare_goal(name)
    specific, general = lisp_list(user("KITCHEN")), lisp_list(user("?WHERE"))
    plans.register_goal(name, specific, lambda bindings: "kitchen", "to the kitchen")
    plans.register_goal(name, general, lambda bindings: princ_to_string(bindings))

    def call(where):
        return plan(lambda: plans.call_goal(name, lisp_list(where)))

    assert call(user("KITCHEN")) == "kitchen"
    assert call(5) == "((?WHERE . 5))"
    assert plans.describe_goal(Cons(name, specific)) == "to the kitchen"
    plans.declare_goal(name)
    with pytest.raises(Error) as problem:
        call(5)
    assert problem.value.report() == "No goal found that matches arguments: GO-TO (5)"


# ------------------------------------------------------------------------------------------------------------------ policies


def policy(log, check=None, init=None, recover=None):
    def note(name, function=None):
        def clause(store, *parameters):
            log.append(name)
            return function(store, *parameters) if function else True

        return clause

    return policies.make_policy(
        user("POLICY"),
        lisp_list(user("TIME")),
        init=note("init", init),
        check=check and note("check", check),
        recover=note("recover", recover),
        clean_up=note("clean-up"),
    )


def under(watched, body, *arguments):
    return plan(lambda: policies.with_policy(watched, lambda: arguments, body))


def test_a_body_that_ends_first_gives_its_values_and_only_clean_up_runs():
    log = []
    assert under(policy(log, check=lambda store, time: kernel.now() > time), lambda: (cpl.sleep(1), "done")[1], 5) == "done"
    assert log[0] == "init" and log[-1] == "clean-up" and "recover" not in log


def test_a_check_that_is_met_ends_the_body_then_recovers_cleans_up_and_signals():
    log = []

    def body():
        try:
            cpl.sleep(100)
        finally:
            log.append("body cleaned up")

    with pytest.raises(cpl.PolicyCheckConditionMet) as problem:
        under(policy(log, check=lambda store, time: kernel.now() > time or None), body, 1)
    assert [entry for entry in log if entry != "check"] == ["init", "body cleaned up", "recover", "clean-up"]
    assert problem.value.report() == "Policy check condition met for policy POLICY.\nParameters: (1).\n"


def test_an_init_that_gives_nil_starts_nothing():
    log = []
    with pytest.raises(cpl.PolicyInitFailed) as problem:
        under(policy(log, init=lambda store, time: None), lambda: log.append("body"), 1)
    assert log == ["init"]
    assert problem.value.report() == "Initialization of policy POLICY failed.\nParameters: (1)\n"


def test_a_policy_without_check_just_runs_its_body():
    log = []
    assert under(policy(log), lambda: (cpl.sleep(1), "done")[1], 1) == "done" and log == ["init", "clean-up"]


def test_a_failing_body_cleans_up_and_a_failing_recovery_does_too():
    log = []
    with pytest.raises(cpl.PlanFailure):
        under(policy(log, check=lambda store, time: None), lambda: cpl.fail("x"), 1)
    assert log[-1] == "clean-up" and "recover" not in log
    log.clear()
    with pytest.raises(cpl.PlanFailure):
        under(policy(log, check=lambda store, time: True, recover=lambda store, time: cpl.fail("y")), lambda: cpl.sleep(9), 1)
    assert log[-1] == "clean-up"


def test_a_timeout_ends_a_longer_body_and_its_condition_can_be_handled_in_a_parent():
    timeout = policies.named_policy(sym("CPL-IMPL::TIMEOUT-POLICY"))

    def timed(seconds):
        return policies.with_policy(timeout, lambda: [2], lambda: (cpl.sleep(seconds), "in time")[1])

    assert plan(lambda: timed(1)) == "in time"
    start = kernel.now()
    caught = plan(
        lambda: cpl.with_failure_handling(
            [(cpl.PolicyCheckConditionMet, lambda condition, retry: retry.leave("too late"))], lambda retry: cpl.par(lambda: timed(10))
        )
    )
    assert caught == "too late" and kernel.now() - start == pytest.approx(2)


def test_clauses_share_a_store_for_one_use():
    def check(store, time):
        store.set("n", (store.get("n") or 0) + 1)
        return store.get("n") == 3 or None

    log = []
    with pytest.raises(cpl.PolicyCheckConditionMet):
        under(policy(log, check=check), lambda: cpl.sleep(9), 1)
    assert log.count("check") == 3
