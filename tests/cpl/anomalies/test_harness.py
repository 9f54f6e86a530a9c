"""The loop sees what it looks for: plans that do wrong are found out."""

from __future__ import annotations


from cramhy_runtime.testing import faults

from .harness import check_run, faults_of
from .plans import Plan


def wrong_with(text, value="NIL", **options):
    return check_run(Plan(text, text, value), **options)[1]


def test_a_cleanup_form_that_runs_twice():
    assert wrong_with("(let ((guard (anomalies:enter 'it))) (anomalies:leave guard) (anomalies:leave guard) (anomalies:left guard))") == [
        "the cleanup of it in main ran again"
    ]


def test_cleanup_in_the_wrong_order_and_cleanup_that_never_runs():
    assert wrong_with(
        "(let ((outer (anomalies:enter 'outer))) (anomalies:enter 'inner) (anomalies:leave outer) (anomalies:left outer))"
    ) == ["the cleanup of outer in main began before that of inner in main was over", "the cleanup of inner in main did not run"]


def test_a_result_that_nobody_allows():
    assert wrong_with("(top-level 2)", "1") == ["the outcome is 2"]
    assert wrong_with("(top-level (sleep 1000) 1)", "1")[0].startswith("the outcome is TimeLimit")


def test_observers_that_are_left():
    wrong = wrong_with("""(defvar *kept* nil)
                          (let ((flag (make-fluent :name 'flag)))
                            (register-update-callback flag 'note #'identity)
                            (setf *kept* (not flag))
                            nil)""")
    assert wrong[0] == "fluent #<FLUENT FLAG [None]> has callbacks: TESTING-USER::NOTE"
    assert wrong[1].startswith("fluent #<FLUENT FLAG [None]> has nets: #<FLUENT FN-FL-NOT") and "is still held by somebody" in wrong[2]


def test_a_plan_that_does_not_get_through_a_fault():
    careless = Plan("careless", "(top-level (par (sleep 1) (handler-case (sleep 2) (plan-failure () 5))) :done)", ":DONE")
    found = [(fault.action, wrong) for fault, _, wrong in faults_of(careless, "threads", ["fail", "evaporate"]) if wrong]
    assert not found
    wrong_value = Plan(
        "wrong-value",
        "(top-level (with-failure-handling ((plan-failure (e) (declare (ignore e)) (return :oops))) (par (sleep 1) (sleep 2)) :done))",
        ":DONE",
    )
    found = {(fault.action, *wrong) for fault, _, wrong in faults_of(wrong_value, "threads", faults.ACTIONS) if wrong}
    assert ("fail", "the outcome is :OOPS") in found
