"""An error in a process module whose designator cannot be printed reaches the caller as itself, and its report says what is what."""

import pytest

BROKEN = """
(defclass broken (desig:motion-designator) ())
(defvar *breaks* nil)
(defmethod print-object ((b broken) stream) (declare (ignore stream)) (funcall *breaks*))
(defun broken () (make-instance 'broken :description '((:type :driving))))
(defun call (name) (note (text-of (plan (nav nav-of-plans checked performed) (pm-execute name (broken))))))
(def-process-module nav (motion) (declare (ignore motion)) (error "the motor is hot"))
(def-process-module nav-of-plans (motion) (declare (ignore motion)) (fail "the motor is cold"))
(def-process-module checked (motion) (declare (ignore motion)) (the integer (car "motor")))
(def-process-module performed (motion) (declare (ignore motion)) (pm-execute 'nav (broken)))
"""
WAYS = {
    "an error": '(error "no print")',
    "a failure of a plan": '(fail "no print")',
    "a wrong call": "(car 3)",
    "what Python raises": '(python:eval "1/0")',
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("way", WAYS.values(), ids=list(WAYS))
def test_the_caller_gets_the_error_of_the_module(text, way):
    text(BROKEN + f"(setf *breaks* (lambda () {way}))")
    assert text("(call 'nav) (call 'nav-of-plans) (call 'performed) *notes*") == (
        '("the motor is hot" "the motor is cold" "the motor is hot")'
    )
    assert text("(subseq (call 'checked) 0 9)") == '"The value"'


def test_handlers_of_the_caller_are_asked_about_the_error_alone(text):
    text(BROKEN + '(setf *breaks* (lambda () (error "no print")))')
    text("""(handler-case (handler-bind ((error (lambda (e) (note (format nil "~a" e))))) (plan (nav) (pm-execute 'nav (broken))))
              (simple-error ()))""")
    assert text("*notes*") == '("the motor is hot")'


def test_the_report_says_that_it_cannot_be_printed(text):
    text(BROKEN + '(setf *breaks* (lambda () (error "no print")))')
    said = text.error("(plan (nav) (pm-execute 'nav (broken)))")
    assert "the motor is hot" in said and "executed #<error printing a BROKEN: no print (at " in said


def test_a_fluent_or_callback_whose_name_cannot_be_printed_keeps_its_error(text):
    text(BROKEN + '(setf *breaks* (lambda () (error "no print")))')
    text("(defvar *f* (make-fluent :name (broken) :value 1))")
    assert text('(text-of (cpl:fl-funcall (lambda (v) (declare (ignore v)) (error "the net tears")) *f*))') == '"the net tears"'


def test_a_candidate_that_cannot_be_printed_does_not_hide_why_there_is_no_place(text):
    text(BROKEN + '(setf *breaks* (lambda () (error "no print")))')
    text("""(defun gives-broken (d) (declare (ignore d)) (list (broken))) (defun refuses (d s) (declare (ignore d s)) :reject)
            (desig:register-location-generator 1 gives-broken) (desig:register-location-validation-function 1 refuses)""")
    said = text.error("(reference (a location (to stand)))")
    assert "Unable to resolve designator" in said and "#<error printing a broken: no print (at " in said.lower()
