"""Asynchronous modules: invariants 24 to 28 of process-modules.md, as text that a user writes."""

import pytest

from cramhy_runtime import kernel

BELT = """
(def-asynchronous-process-module belt ((ready :initform (make-fluent :name 'ready :value t) :reader ready)))
(defmethod synchronization-fluent ((m belt) input) (declare (ignore input)) (ready m))
(defmethod on-input ((m belt) input) (note (list :took (goal-of input))) (sleep 2) (note (list :placed (goal-of input))))
(defmethod on-run ((m belt))
  (unwind-protect (loop (sleep 100)) (note :run-unwound)))
(defun belt () (get-running-process-module 'belt))
(defun finish (designator) (finish-process-module (belt) :designator designator))
"""


@pytest.fixture
def text(text):
    text(BELT)
    return text


@pytest.mark.law("process-modules", 24)
def test_pm_execute_returns_before_on_input_has_finished(text):
    assert text("(plan (belt) (let ((sent (motion 1))) (prog1 (eq sent (pm-execute 'belt sent)) (note :returned) (sleep 5))))") == "T"
    assert text("*notes*") in ("(:RETURNED (:TOOK 1) (:PLACED 1) :RUN-UNWOUND)", "((:TOOK 1) :RETURNED (:PLACED 1) :RUN-UNWOUND)")


@pytest.mark.law("process-modules", 25)
def test_two_inputs_are_processed_one_after_the_other_and_monitoring_all_waits_for_both(text):
    text("""(plan (belt)
              (let ((first (motion 1)) (second (motion 2)))
                (pm-execute 'belt first)
                (pm-execute 'belt second)
                (par (progn (monitor-process-module 'belt) (note :all-over))
                     (progn (sleep 5) (finish first) (sleep 5) (finish second) (sleep 1)))))""")
    assert text("*notes*") == "((:TOOK 1) (:PLACED 1) (:TOOK 2) (:PLACED 2) :ALL-OVER :RUN-UNWOUND)" and kernel.now() == 11


@pytest.mark.law("process-modules", 26)
@pytest.mark.parametrize("which", ["first", "(list second first)"])
def test_monitoring_one_designator_returns_before_a_slower_one_is_finished(text, which):
    assert (
        text(f"""(plan (belt)
                      (let ((first (motion 1)) (second (motion 2)))
                        (pm-execute 'belt first)
                        (pm-execute 'belt second)
                        (par (progn (monitor-process-module 'belt :designators {which}) (note :first-over) (value (pm-status 'belt)))
                             (progn (sleep 5) (finish first) (sleep 5) (note :slow-over) (finish second)))))""")
        == ":RUNNING"
    )
    assert text("(last *notes* 3)") == "(:FIRST-OVER :SLOW-OVER :RUN-UNWOUND)"


@pytest.mark.law("process-modules", 27)
def test_a_failure_reaches_exactly_the_monitors_of_its_designator(text):
    assert (
        text("""(let ((jammed (make-condition 'simple-error :format-control "jammed")))
                     (plan (belt)
                       (let ((first (motion 1)) (second (motion 2)))
                         (flet ((watch (designators)
                                  (handler-case (monitor-process-module 'belt :designators designators)
                                    (error (c) (if (eq c jammed) :jammed c))
                                    (:no-error (&rest values) (declare (ignore values)) :fine))))
                           (pm-execute 'belt first)
                           (pm-execute 'belt second)
                           (let ((results nil))
                             (par (push (list 1 (watch first)) results)
                                  (push (list 2 (watch (list second))) results)
                                  (progn (sleep 5) (fail-process-module (belt) jammed :designator first)
                                         (sleep 1) (finish second)))
                             (pm-execute 'belt first)
                             (sleep 3)
                             (fail-process-module (belt) jammed)
                             (push (list :any (watch nil) (watch nil)) results)
                             (reverse results))))))""")
        == "((1 :JAMMED) (2 :FINE) (:ANY :JAMMED :FINE))"
    )


@pytest.mark.law("process-modules", 28)
def test_finishing_or_failing_what_is_not_being_done_is_an_error(text):
    assert (
        text("""(plan (belt)
                     (let ((sent (motion 1)) (other (motion 2)))
                       (note (text-of (finish-process-module (belt))))
                       (pm-execute 'belt sent)
                       (sleep 1)
                       (note (text-of (finish other)))
                       (note (text-of (fail-process-module (belt) (make-condition 'simple-error) :designator other)))
                       (finish sent)))""")
        == "NIL"
    )
    first, _, foreign, failing, *_ = text.session.evaluate_text("*notes*")[0]
    shown = "#<A MOTION\n    (TYPE DRIVING)\n    (GOAL 2)>"
    assert first == "Cannot finish an already stopped process module."
    assert foreign == f"Cannot finish a designator that is not being processed: {shown}"
    assert failing == f"Cannot fail for designator that is not processed: {shown}"
