"""Every form that starts branches, left in every way there is: its branches are dead first, and then its own cleanup runs.

In the original cleanup runs before the branches have been told to end, and a form that fails waits for nobody (defects 8 and 9).
"""

import pytest

from cramhy_runtime import kernel

BRANCHES = """
(defvar *never* (make-fluent :name 'never))
(defun slow () (unwind-protect (sleep 1000) (sleep 1) (note :branch)))
(defun trigger () (sleep 1) (fail "trigger"))
(def-cram-function plan-function () (slow))
(declare-goal goal-function (x))
(def-goal (goal-function ?x) (slow))
"""
FORMS = {
    "par": "(par (slow) (slow))",
    "pursue": "(pursue (slow) (slow))",
    "try-all": "(try-all (slow) (slow))",
    "try-in-order": "(try-in-order (par (slow)) (note :not-tried))",
    "partial-order": "(with-tags (partial-order ((:tag a (slow)) (:tag b (note :not-started)) (slow)) (:order a b)))",
    "par-loop": "(par-loop (x '(1 2 3)) (slow))",
    "with-task": "(cpl-impl::with-task () (slow))",
    "tag": "(with-tags (:tag a (slow)))",
    "plan function": "(plan-function)",
    "goal": "(goal-function 1)",
    "policy": "(with-policy (make-policy p () (:check (sleep 1/2) nil)) () (slow))",
    "with-parallel-childs": "(cpl-impl::with-parallel-childs nil (running done failed) ((slow) (slow)) (list running done failed) nil)",
    "hand-made children": "(progn (start #'slow) (start #'slow) (sleep 1000))",
    "nested": "(par (pursue (with-tags (:tag a (slow))) (slow)) (plan-function))",
}
form = pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)


def check(lisp):
    """All branches were cleaned up, then their parent, and nobody is left."""
    notes = lisp("*notes*").strip("()").split()
    assert ":PARENT" in notes and ":BRANCH" in notes and set(notes) == {":BRANCH", ":PARENT"}
    assert notes.index(":PARENT") == len(notes) - 1
    assert kernel.active().tasks == [kernel.active().main]


@pytest.mark.soak(all_but=3)
@form
@pytest.mark.law(44, 53)
@pytest.mark.parametrize("requests", ["(evaporate p)", "(progn (suspend p) (sleep 1) (evaporate p))", "(evaporate p :sync nil)"])
def test_evaporated(lisp, form, requests):
    lisp(BRANCHES + f"(top-level (let ((p (in-child (unwind-protect {form} (note :parent))))) (sleep 1) {requests}))")
    check(lisp)


@pytest.mark.soak(all_but=3)
@form
@pytest.mark.law(46)
def test_ended_because_a_sibling_of_the_form_failed(lisp, form):
    assert lisp.error(BRANCHES + f"(top-level (par (unwind-protect {form} (note :parent)) (trigger)))") == "trigger"
    check(lisp)


@pytest.mark.soak(all_but=3)
@form
def test_ended_because_a_sibling_of_the_form_has_won(lisp, form):
    assert lisp(BRANCHES + f"(top-level (pursue (unwind-protect {form} (note :parent)) (progn (sleep 1) :won)))") == ":WON"
    check(lisp)


@pytest.mark.soak(all_but=3)
@form
@pytest.mark.parametrize("time", [0.0, 0.25, 1.0])
def test_interrupted(lisp, form, time):
    lisp(BRANCHES)
    kernel.call_at(kernel.now() + time, kernel.interrupt)
    lisp.error(
        f"(top-level (unwind-protect (progn (sleep 1/8) {form}) (note :parent)))"
        if time
        else f"(top-level (unwind-protect {form} (note :parent)))"
    )
    if time:
        check(lisp)
    assert kernel.active().tasks == [kernel.active().main]


@pytest.mark.soak(all_but=2)
@form
def test_ended_by_the_time_limit(lisp_for_ten_seconds, form):
    lisp = lisp_for_ten_seconds
    assert "The run reached its time limit of 10 s." in lisp.error(BRANCHES + f"(top-level (unwind-protect {form} (note :parent)))")
    check(lisp)


@pytest.mark.soak(all_but=3)
@form
def test_ended_because_of_a_deadlock(lisp, form):
    if "policy" in form:
        form = form.replace("(:check (sleep 1/2) nil)", "(:check (wait-for *never*))")
    text = BRANCHES.replace("(sleep 1000)", "(wait-for *never*)") + f"(top-level (unwind-protect {form} (note :parent)))"
    assert "Nothing can happen any more" in lisp.error(text.replace("(sleep 1000))", "(wait-for *never*))"))
    check(lisp)


FAILING = {
    "par": "(par (slow) (trigger) (slow))",
    "pursue": "(pursue (slow) (trigger) (slow))",
    "partial-order": "(with-tags (partial-order ((:tag a (slow)) (trigger)) (:order a (make-instance 'task))))",
    "par-loop": "(par-loop (x '(1 2 3)) (if (= x 2) (trigger) (slow)))",
    "tag": "(with-tags (:tag a (par (slow) (trigger))))",
}
HANDLERS = {
    "return": "(with-failure-handling ((plan-failure (e) (note :handler) (return))) {form})",
    "throw": "(catch :out (handler-bind ((plan-failure (lambda (e) (note :handler) (throw :out 1)))) {form}))",
    "return-from": "(block out (handler-bind ((plan-failure (lambda (e) (note :handler) (return-from out)))) {form}))",
    "go": "(tagbody (handler-bind ((plan-failure (lambda (e) (note :handler) (go out)))) {form}) out)",
    "restart": "(restart-case (handler-bind ((plan-failure (lambda (e) (note :handler) (invoke-restart 'skip)))) {form}) (skip () 1))",
    "handler-case": "(handler-case {form} (plan-failure (e) e (note :handler)))",
}


@pytest.mark.soak(all_but=4)
@pytest.mark.law(46)
@pytest.mark.parametrize("form", FAILING.values(), ids=FAILING)
@pytest.mark.parametrize("handler", HANDLERS.values(), ids=HANDLERS)
def test_left_by_a_handler_of_its_failure(lisp, form, handler):
    """The handler runs on top of the form's stack, when the branches are dead: nobody disturbs what it does next (defect 8)."""
    text = handler.replace("{form}", f"(unwind-protect {form} (note :parent))")
    lisp(BRANCHES + f"(top-level {text} (note :after (child-tasks (current-task))))")
    notes = lisp("*notes*")
    unwound_first = handler.startswith("(handler-case")
    ends = "(:PARENT :HANDLER (:AFTER NIL))" if unwound_first else "(:HANDLER :PARENT (:AFTER NIL))"
    assert notes.endswith(ends[1:]) and set(notes[: -len(ends)].strip("( ").split()) == {":BRANCH"}


@pytest.mark.law(72)
def test_tried_again_by_retry_one_attempt_is_over_before_the_next_begins(lisp):
    assert (
        lisp(
            BRANCHES
            + """
        (top-level
          (with-retry-counters ((attempts 2))
            (with-failure-handling ((plan-failure (e) (declare (ignore e)) (do-retry attempts (retry)) (return)))
              (note :attempt)
              (par (slow) (trigger)))))
        *notes*"""
        )
        == "(:ATTEMPT :BRANCH :ATTEMPT :BRANCH :ATTEMPT :BRANCH)"
    )


def test_a_form_whose_later_branch_cannot_be_started_ends_the_earlier_ones(lisp):
    assert lisp(
        BRANCHES
        + """
        (define-task-variable *broken* 0 "Fails for the third task." :init-function
          (lambda (task parent value) (declare (ignore task parent)) (if (= value 2) (error "no third") value)))
        (top-level
          (ignore-errors (par (progn (note :never)) (par (slow)) (progn 1)))
          (let ((n 0))
            (setf *broken* 2)
            (note (nth-value 1 (ignore-errors (par (slow) (slow))))))
          (note (child-tasks (current-task)))
          (mapcar (lambda (x) (if (typep x 'condition) (princ-to-string x) x)) *notes*))"""
    ).endswith('"no third" NIL)')
