"""Waits that cleanup is stuck in: they can be ended, and nothing else of the cleanup is disturbed (invariants 53 and 54, repaired).

In the original a ``wait-for`` in a cleanup form that never comes true blocks the task, its parent and the whole plan for ever
(defect 10).
"""

import re

import pytest

from cramhy_runtime import cpl, kernel

NEVER = "(defvar *never* (make-fluent :name 'never))\n"
WAITS = {
    "wait-for": "(wait-for *never*)",
    "wait-for with a timeout": "(wait-for *never* :timeout 1000)",
    "whenever": "(whenever (*never*))",
    "sleep": "(sleep 1000)",
    "a loop of sleeps": "(loop (sleep 1))",
    "join-task": "(join-task (start (lambda () (wait-for *never*))))",
    "join of a stranger": "(join-task *stranger*)",
    "par": "(par (wait-for *never*) (sleep 1))",
    "pursue": "(pursue (wait-for *never*) (join-task (start (lambda () (wait-for *never*)))))",
    "with-task-suspended": "(with-task-suspended ((start (lambda () (sleep 1000)))) (wait-for *never*))",
    "without-scheduling": "(without-scheduling (wait-for *never*))",
    "cleanup in cleanup": "(unwind-protect (wait-for *never*) (note :inner))",
}
waits = pytest.mark.parametrize("wait", WAITS.values(), ids=WAITS)


@pytest.mark.soak(all_but=4)
@pytest.mark.law(53, 54)
@waits
def test_a_second_request_ends_the_wait_and_the_outer_cleanup_runs_completely(lisp, wait):
    assert (
        lisp(
            NEVER
            + f"""
        (defvar *stranger* (make-instance 'toplevel-task :thread-fun (lambda () (wait-for *never*))))
        (top-level
          (let ((task (in-child
                        (unwind-protect
                          (unwind-protect (sleep 1000) (note :begins) {wait} (note :not-reached))
                          (sleep 1) (note :outer)))))
            (sleep 1)
            (evaporate task :sync nil)
            (sleep 9/2)
            (note (later task))
            (evaporate task)
            (note (later task))))
        (remove :inner *notes*)"""
        )
        == "(:BEGINS :RUNNING :OUTER :EVAPORATED)"
    )
    assert kernel.now() == 6.5


@pytest.mark.soak(all_but=10)
@pytest.mark.law(53, 54)
@waits
def test_the_limit_ends_the_wait_with_a_warning(lisp, wait):
    assert (
        lisp(
            NEVER
            + f"""
        (defvar *stranger* (make-instance 'toplevel-task :thread-fun (lambda () (wait-for *never*))))
        (let ((*cleanup-time-limit* 5))
          (top-level
            (pursue
              (handler-bind ((warning (lambda (warning) (note (princ-to-string warning)) (muffle-warning warning))))
                (unwind-protect
                  (unwind-protect (sleep 1000) {wait} (note :not-reached))
                  (sleep 1) (note :outer)))
              (sleep 1))))
        (let ((said (first *notes*)))
          (note (and (search "The cleanup of [PURSUE-CHILD-#1/2]" said) (search "<repl" said)
                     (search "The time of *CLEANUP-TIME-LIMIT*, 5 s, is over" said) t)))
        (rest (remove :inner *notes*))"""
        )
        == "(:OUTER T)"
    )
    assert kernel.now() == 7


@pytest.mark.law(54)
def test_the_request_goes_down_to_the_task_whose_cleanup_is_stuck(lisp):
    assert (
        lisp(
            NEVER
            + """
        (let (deepest)
          (top-level
            (let ((task (in-child
                          (unwind-protect
                            (par (pursue (unwind-protect (progn (setf deepest (current-task)) (sleep 1000))
                                           (wait-for *never*) (note :not-reached))
                                         (sleep 1)))
                            (sleep 1) (note :parent)))))
              (sleep 2)
              (evaporate task :sync nil)
              (sleep 1)
              (note (later deepest) (later task))
              (evaporate task)
              (note (later deepest) (later task)))))
        *notes*"""
        )
        == "((:RUNNING :RUNNING) :PARENT (:EVAPORATED :EVAPORATED))"
    )


@pytest.mark.law(54)
def test_one_explicit_request_and_any_number_from_forms_leave_waiting_cleanup_alone(lisp):
    assert (
        lisp("""
        (top-level
          (pursue
            (pursue
              (let ((task (in-child (unwind-protect (sleep 1000) (sleep 10) (note :complete)))))
                (sleep 1)
                (evaporate task))
              (sleep 2))
            (sleep 3)))
        *notes*""")
        == "(:COMPLETE)"
    )


@pytest.mark.law(54)
def test_a_second_request_leaves_a_protected_region_outside_of_cleanup_alone(lisp):
    assert (
        lisp("""
        (top-level
          (let ((task (in-child (without-scheduling (sleep 5) (note :complete)) (note :never))))
            (sleep 1) (evaporate task :sync nil) (sleep 1) (evaporate task :sync nil) (evaporate task)))
        *notes*""")
        == "(:COMPLETE)"
    )


@pytest.mark.law(53)
@pytest.mark.parametrize(
    "way_in, then",
    [
        ('(fail "why")', "why"),
        ('(error "why")', "why"),
        ("(values 1 2)", "(1 2)"),
        ("(return-from out :left)", "(:LEFT)"),
        ("(throw :out (values 3 4))", "(3 4)"),
    ],
)
def test_what_led_into_the_cleanup_goes_on_when_the_limit_has_ended_it(lisp, way_in, then):
    text = (
        NEVER
        + f"""
        (let ((*cleanup-time-limit* 5))
          (top-level (multiple-value-list (catch :out (block out
            (unwind-protect {way_in} (wait-for *never*) (note :not-reached)))))))"""
    )
    assert (lisp.error(text) if then == "why" else lisp(text)) == then
    assert kernel.now() == 5 and lisp("*notes*") == "NIL"


@pytest.mark.law(53)
def test_a_limit_that_is_not_reached_changes_nothing_and_each_cleanup_form_has_all_of_it(lisp):
    assert (
        lisp("""
        (let ((*cleanup-time-limit* 5))
          (top-level (pursue (unwind-protect (unwind-protect (sleep 1000) (sleep 4) (note 1)) (sleep 4) (note 2)) (sleep 1))))
        *notes*""")
        == "(1 2)"
    )
    assert kernel.now() == 9 and not [task for task in kernel.active().tasks if task is not kernel.active().main]


def test_the_limit_does_not_count_the_time_that_branches_of_the_cleanup_need_to_die(lisp):
    assert (
        lisp("""
        (let ((*cleanup-time-limit* 5))
          (top-level
            (unwind-protect 1
              (pursue (unwind-protect (sleep 1000) (sleep 4) (note :branch)) (sleep 4))
              (note :parent))))
        *notes*""")
        == "(:BRANCH :PARENT)"
    )


def test_a_limit_that_can_end_nothing_does_not_hide_a_deadlock(lisp):
    assert "Nothing can happen any more" in lisp.error(
        NEVER
        + """
        (let ((*cleanup-time-limit* 5))
          (top-level
            (unwind-protect 1
              (pursue (without-scheduling (wait-for *never*)) (sleep 1)))))"""
    )
    assert kernel.active().tasks == [kernel.active().main]


def test_a_limit_that_makes_no_sense_is_none(lisp):
    assert lisp('(dolist (x \'(:a -1 "5")) (let ((*cleanup-time-limit* x)) (top-level (unwind-protect 1 (sleep 9))))) 1') == "1"


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "plan",
    [
        "(unwind-protect (wait-for *never*) (note :a) (wait-for *never*) (note :not-reached))",
        "(par (unwind-protect (unwind-protect (wait-for *never*) (wait-for *never*)) (wait-for *never*)))",
        "(without-scheduling (wait-for *never*))",
        "(unwind-protect (wait-for *never*) (loop (unwind-protect nil (wait-for *never*))))",
    ],
)
def test_a_plan_that_can_go_nowhere_is_brought_down_whole(lisp, plan):
    """Law 1 holds for the deadlock report as well: when it is shown, no task of the plan is left."""
    assert "Nothing can happen any more" in lisp.error(NEVER + f"(top-level (unwind-protect {plan} (note :outer)))")
    assert kernel.active().tasks == [kernel.active().main]
    assert lisp("(top-level (sleep 1) :alive)") == ":ALIVE"


def test_a_plan_at_its_time_limit_is_brought_down_though_its_cleanup_computes_for_ever(lisp_for_ten_seconds):
    lisp = lisp_for_ten_seconds
    assert "time limit of 10 s" in lisp.error("(top-level (par (unwind-protect (sleep 1000) (loop)) (sleep 1000)))")
    assert kernel.active().tasks == [kernel.active().main]


def test_a_second_interrupt_gives_up_cleanup_and_nobody_is_left(lisp):
    lisp(NEVER)
    kernel.call_at(1, kernel.interrupt)
    kernel.call_at(2, kernel.interrupt)
    lisp.error("(top-level (par (unwind-protect (sleep 1000) (note :begins) (wait-for *never*) (note :not-reached))))")
    assert kernel.active().tasks == [kernel.active().main] and kernel.now() == 2
    assert lisp("*notes*") == "(:BEGINS)"


# ---------------------------------------------------------------------------------------------------------------- from Python


def test_a_plan_in_python_has_its_waits_ended_too():
    never, order = cpl.make_fluent(name="never"), []

    def worker():
        try:
            try:
                cpl.sleep(1000)
            finally:
                order.append("begins")
                cpl.wait_for(never)
                order.append("not reached")
        finally:
            cpl.sleep(1)
            order.append("outer")

    def body():
        task = cpl.Task(worker).execute()
        cpl.sleep(1)
        cpl.evaporate(task, sync=None)
        cpl.sleep(1)
        cpl.evaporate(task)
        return str(task.status)

    assert cpl.top_level(body) == ":EVAPORATED" and order == ["begins", "outer"] and kernel.now() == 3


def test_the_method_of_tasks_ends_waits_when_it_is_called_a_second_time():
    order = []

    def worker():
        try:
            cpl.sleep(1000)
        finally:
            cpl.sleep(1000)
            order.append("not reached")

    def body():
        task = cpl.Task(worker).execute()
        cpl.sleep(1)
        task.evaporate()
        cpl.sleep(1)
        task.evaporate()
        task.join()

    cpl.top_level(body)
    assert order == [] and kernel.now() == 2


def test_the_limit_can_be_set_from_python_and_the_failure_that_led_into_the_cleanup_is_kept():
    never = cpl.make_fluent(name="never")

    def body():
        try:
            cpl.fail("why")
        finally:
            with kernel.cleanup():
                cpl.wait_for(never)

    with cpl.cleanup_time_limit(2.5), pytest.raises(cpl.PlanFailure, match="why"):
        cpl.top_level(body)
    assert kernel.now() == 2.5


def test_a_finally_of_an_evaporated_task_is_limited_as_well():
    never, order = cpl.make_fluent(name="never"), []

    def worker():
        try:
            cpl.sleep(1000)
        finally:
            try:
                cpl.wait_for(never)
            finally:
                order.append(kernel.now())

    with cpl.cleanup_time_limit(2.5):
        cpl.top_level(lambda: cpl.pursue(worker, lambda: cpl.sleep(1)))
    assert order == [3.5]


def test_the_warning_says_whose_cleanup_waited_for_what_and_where(lisp, capsys):
    lisp(NEVER + "(let ((*cleanup-time-limit* 5)) (top-level (unwind-protect 1 (wait-for *never*))))")
    said = re.sub(r"-\d+ ", "-N ", " ".join(capsys.readouterr().err.split()))
    assert (
        "WARNING: The cleanup of [TOP-LEVEL]-N waited for the fluent #<FLUENT NEVER [NIL]>, at <repl 2>:2:62. "
        "The time of *CLEANUP-TIME-LIMIT*, 5 s, is over: the rest of this cleanup form is left out, and outer ones run."
    ) in said
