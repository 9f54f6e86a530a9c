"""Methods of users on ``reference``, and things whose printer fails: what cramhy keeps to with its own methods holds for theirs."""

import pytest

CLASS = """
(defclass mine (object-designator) ())
(defun mine () (make-instance 'mine :description '((:type :cup))))
(defvar *d* (mine))
"""

PRIMARY = "(defmethod reference ((d mine) &optional role) (declare (ignore role)) (note :called) (cpl:sleep 1) (list (length *notes*)))"
AROUND = "(defmethod reference :around ((d mine) &optional role) (declare (ignore role)) (note :called) (cpl:sleep 1) (call-next-method))"


@pytest.mark.parametrize(
    "method",
    [PRIMARY, f"(defmethod resolve-designator ((d mine) (role t)) (note :inner) :cup) {AROUND}", PRIMARY.replace("mine)", "(eql *d*))")],
)
def test_two_tasks_share_one_call_of_a_users_method(lisp, method):
    lisp(CLASS)
    lisp(method)
    assert lisp("(cpl:top-level (cpl:par (note (reference *d*)) (note (reference *d*)) (progn (cpl:sleep 0.5) (note (reference *d*)))))")
    assert lisp("(count :called *notes*)") == "1"
    assert lisp("(length (remove-duplicates (remove-if #'keywordp *notes* :key (lambda (n) (if (eq n :cup) 1 n)))))") == "1"


def test_a_later_call_asks_the_users_method_again(lisp):
    lisp(CLASS + PRIMARY)
    assert lisp("(cpl:top-level (list (reference *d*) (reference *d*)))") == "((1) (2))"


def test_two_designators_are_resolved_side_by_side(lisp):
    lisp(CLASS + PRIMARY)
    assert lisp(
        "(let ((start (roslisp:ros-time))) (cpl:top-level (cpl:par (reference *d*) (reference (mine)))) (round (- (roslisp:ros-time) start)))"
    )


def test_a_task_that_waits_resolves_itself_when_the_first_one_fails_or_is_evaporated(lisp):
    lisp(CLASS)
    lisp('(defmethod reference ((d mine) &optional role) (note :called) (cpl:sleep 1) (if (cdr *notes*) :cup (cpl:fail "first")))')
    assert (
        lisp("""(cpl:top-level (cpl:par (cpl:with-failure-handling ((cpl:plan-failure (e) (return (note :failed)))) (reference *d*))
                                           (note (reference *d*))))
                   *notes*""")
        == "(:CALLED :FAILED :CALLED :CUP)"
    )
    lisp("(setf *notes* nil)")
    lisp("(cpl:top-level (cpl:par (cpl:pursue (reference *d*) (cpl:sleep 0.5)) (progn (cpl:sleep 0.1) (reference *d*))))")
    assert lisp("*notes*") == "(:CALLED :CALLED)"


def test_the_method_may_ask_again_itself(lisp):
    """As it may in the original: for another role, or when it has noted what it found; a branch of a plan in it may, too."""
    lisp(CLASS)
    lisp(
        "(defmethod reference ((d mine) &optional role)"
        " (cond ((eq role :other) :cup) ((progn (note :asked) (cpl:sleep 1) (cpl:par (note (reference d :other)))))))"
    )
    assert lisp("(cpl:top-level (reference *d*))") == ":CUP"
    lisp(
        "(defvar *seen* nil) (defmethod reference ((d mine) &optional role) (if *seen* :again (progn (setf *seen* t) (cpl:par (note (reference d)))))) (setf *notes* nil)"
    )
    lisp("(cpl:top-level (reference *d*))")
    assert lisp("*notes*") == "(:AGAIN)"


def test_tasks_that_wait_for_each_others_calls_are_an_error(lisp):
    lisp(CLASS + "(defvar *e* (mine)) (defmethod reference ((d mine) &optional role) (cpl:sleep 1) (reference (if (eq d *d*) *e* *d*)))")
    assert "is needed to resolve itself" in lisp.error("(cpl:top-level (cpl:par (reference *d*) (reference *e*)))")


def test_the_roles_of_a_shared_call_are_kept_apart(lisp):
    lisp(CLASS + "(defmethod reference ((d mine) &optional role) (note role) (cpl:sleep 1) role)")
    assert (
        lisp("""(cpl:top-level (let (a b) (cpl:par (setf a (reference *d* :one)) (setf b (reference *d* :two))) (list a b)))""")
        == "(:ONE :TWO)"
    )
