"""What a user reads when a fluent, a net or a callback goes wrong: the original's text, the place, and what was being computed."""

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.languages.commonlisp.tools.advice import explanation
from cramhy_runtime.repl.session import Session, condition_of


@pytest.fixture
def session(request, fresh_kernel):
    made = Session(time="virtual", backend=request.node.callspec.params["fresh_kernel"], time_limit=3600, turtlesim=False)
    made.evaluate_text("(defpackage fluent-errors (:use :cpl)) (in-package fluent-errors)")
    return made


@pytest.fixture
def told(session):
    """What a user is told when the forms end with an error."""

    def tell(text):
        with pytest.raises((Condition, Exception)) as problem:
            session.evaluate_text(text, "<repl test>")
        return explanation(condition_of(problem.value))

    return tell


@pytest.fixture
def answer(session):
    from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

    return lambda text: prin1_to_string(session.evaluate_text(text, "<repl test>")[0])


def test_a_net_over_a_wrong_value_says_which_net_it_is_and_over_what(told):
    text = told("(defvar *speed* (make-fluent :name 'speed))\n(let ((limit (make-fluent :value 3 :name 'limit)))\n  (< *speed* limit))")
    lines = text.splitlines()
    assert [line.strip() for line in lines[:-1]] == [
        "The value",
        "NIL",
        "is not of type",
        "REAL",
        "at <repl test>:3:3",
        "(< *speed* limit))",
        "^",
    ]
    assert lines[-1].startswith("  while the net FN-FL<")
    assert lines[-1].endswith(" over the fluents SPEED and LIMIT was made: its first value is computed at once")


def test_an_assignment_that_a_net_cannot_take_is_the_place_of_the_error(told, answer):
    answer("(defparameter *f* (make-fluent :name 'f :value 2)) (defparameter *n* (< *f* 3)) (defparameter *m* (not *f*)) 1")
    lines = told('(progn\n  (setf (value *f*) "fast"))').splitlines()
    assert "  at <repl test>:2:3" in lines
    assert lines[-1].endswith(" over the fluent F, which keeps its old value, was computed anew")
    assert answer("(list (value *f*) (value *n*) (value *m*))") == '("fast" T NIL)'
    assert answer("(progn (setf (value *f*) 7) (value *n*))") == "NIL"


def test_an_error_of_a_callback_names_it_and_comes_after_the_others_were_told(told, answer):
    answer("""(defparameter *f* (make-fluent :name 'door :value 1)) (defparameter *seen* nil) (defparameter *n* (+ *f* 1))
              (register-update-callback *f* 'log (lambda (x) (push x *seen*)))
              (register-update-callback *f* 'broken (lambda (x) (error "No ~a." x)))
              (register-update-callback *f* 'log-too (lambda (x) (push x *seen*)))""")
    lines = told("(setf (value *f*)\n      5)").splitlines()
    assert lines[0] == "  No 5." and "  at <repl test>:3:65" in lines
    assert lines[-1] == "  in the callback BROKEN of the fluent DOOR, called at <repl test>:1:1"
    assert answer("(list *seen* (value *n*) (value *f*))") == "((5 5) 6 5)"


def test_an_error_in_the_function_of_a_net_says_what_called_it(told, answer):
    answer("(defparameter *f* (make-fluent :name 'f :value 1))\n(defparameter *n* (fl-funcall (lambda (x) (car x)) (not *f*)))")
    lines = told("(progn\n  (setf (value *f*) nil))").splitlines()
    assert "  at <repl test>:2:43" in lines
    assert lines[-1].startswith("  while the net FN-FL-FUNCALL") and lines[-1].endswith(" was computed anew, called at <repl test>:2:3")


def test_an_error_of_a_callback_of_a_net_is_no_error_of_the_net(told):
    text = told("""(let* ((f (make-fluent :name 'f :value 1)) (net (+ f 1)))
                     (register-update-callback net 'cb (lambda (x) (error "No ~a." x)))
                     (setf (value f) 2))""")
    assert "in the callback CB of the fluent FN-FL+" in text and "was computed" not in text


def test_no_error_of_an_observer_is_lost(told):
    text = told("""(let* ((f (make-fluent :name 'door :value 1)) (net (/ 1 f)))
                     (register-update-callback f 'first (lambda (x) (error "No ~a." x)))
                     (setf (value f) 0)
                     net)""")
    assert text.splitlines()[0] == "  arithmetic error DIVISION-BY-ZERO signalled"
    assert "  Another observer failed, too: No 0. (at <repl test>:2:" in text


def test_an_exit_taken_by_one_callback_does_not_hide_the_error_of_another(told):
    text = told("""(block out
                     (let ((f (make-fluent :value 1)))
                       (register-update-callback f 'failing (lambda (x) (error "No ~a." x)))
                       (register-update-callback f 'leaving (lambda (x) (return-from out x)))
                       (setf (value f) 2)))""")
    assert text.splitlines()[0] == "  No 2."


def test_a_callback_may_leave_for_a_block_around_the_assignment(answer):
    assert (
        answer("""(let ((f (make-fluent :value 1)))
                       (list (block out (register-update-callback f 'leave (lambda (x) (return-from out (list :left x))))
                                        (setf (value f) 2))
                             (value f)))""")
        == "((:LEFT 2) 2)"
    )


def test_a_callback_that_fails_in_a_branch_fails_the_branch_and_the_tree_is_closed_in_order(answer):
    assert (
        answer("""(let ((f (make-fluent :value 1)) (log nil))
                       (register-update-callback f 'refuse (lambda (x) (fail "Not ~a." x)))
                       (list (top-level
                               (with-failure-handling ((simple-plan-failure (e) (push :handled log) (return (princ-to-string e))))
                                 (par (unwind-protect (sleep 10) (push :sibling log))
                                      (unwind-protect (progn (sleep 1) (setf (value f) 2)) (push :own log)))))
                             (reverse log) (value f)))""")
        == '("Not 2." (:OWN :SIBLING :HANDLED) 2)'
    )


def test_a_failure_of_a_callback_is_handled_around_the_assignment_before_anything_unwinds(answer):
    assert (
        answer("""(let ((f (make-fluent :value 1)) (log nil))
                       (register-update-callback f 'refuse (lambda (x) (unwind-protect (fail "Not ~a." x) (push :unwound log))))
                       (list (top-level
                               (with-failure-handling ((plan-failure (e) (declare (ignore e)) (push :handled log) (return :kept)))
                                 (setf (value f) 2)))
                             (reverse log)))""")
        == "(:KEPT (:HANDLED :UNWOUND))"
    )


def test_requests_to_end_wait_for_the_callbacks_and_for_the_functions_of_nets(answer):
    """Scheduling is disabled while a fluent tells its observers, so that none of them is left without the news."""
    assert (
        answer("""(let* ((f (make-fluent :value 0)) (log nil)
                            (net (fl-funcall (lambda (x) (when (> x 0) (sleep 2)) (* 10 x)) f)))
                       (register-update-callback f 'slow (lambda (x) (sleep 2) (push x log)))
                       (top-level (pursue (progn (setf (value f) 1) (sleep 0.1) (push :never log)) (sleep 1)))
                       (list log (value net)))""")
        == "((1) 10)"
    )


def test_a_fluent_that_changes_itself_for_ever_is_an_error_and_the_session_goes_on(told, answer):
    text = told("""(let ((f (make-fluent :name 'f :value 0)))
                     (register-update-callback f 'on-and-on (lambda (x) (setf (value f) (1+ x))))
                     (setf (value f) 1))""")
    assert "calls itself too deeply" in text and "in the callback ON-AND-ON of the fluent F" in text
    assert answer("(+ 1 1)") == "2"


def test_no_failed_net_is_left_on_its_inputs(told, answer):
    answer("(defparameter *a* (make-fluent)) (defparameter *b* (make-fluent :value 1)) 1")
    told("(+ *a* *b*)")
    assert answer("(progn (setf (value *b*) 2) (setf (value *a*) 3))") == "3"


WRONG = [
    ("(make-fluent :foo 3 :bar 4)", "Invalid initialization arguments: :BAR, :FOO in call for class #<STANDARD-CLASS "
     "CRAM-LANGUAGE-IMPLEMENTATION:VALUE-FLUENT>. See also: The ANSI Standard, Section 7.1.2"),
    ("(make-fluent :value)", "odd number of &KEY arguments"),
    ("(make-fluent :class 'nonsense)", "There is no class named FLUENT-ERRORS::NONSENSE."),
    ("(make-fluent :test 5)", "The value 5 is not of type (OR FUNCTION SYMBOL)"),
    ("(setf (value 3) 4)", "There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION (COMMON-LISP:SETF "
     "CRAM-LANGUAGE-IMPLEMENTATION:VALUE) (1)> when called with arguments (4 3). See also: The ANSI Standard, Section 7.6.6"),
    ("(wait-for nil)", "wait-for called with nil argument."),
    ("(wait-for nil :timeout 1)", "wait-for called with nil argument."),
    ("(wait-for (make-fluent) :timeout \"soon\")", 'The value "soon" is not of type REAL'),
    ("(whenever (nil) 1)", "wait-for called with nil argument."),
    ("(sleep \"long\")", 'The value "long" is not of type REAL'),
    ("(pulsed 3)", "The value of FLUENT is 3, which is not of type FLUENT."),
    ("(fl-value-changed 3)", "The value of FLUENT is 3, which is not of type FLUENT."),
    ("(pulsed (make-fluent) :handle-missed-pulses :some)", ":SOME fell through ECASE expression. Wanted one of (:NEVER :ONCE :ALWAYS)."),
    ("(fl-funcall (make-fluent :name 'f) 1)", "The value #<FLUENT F [NIL]> is not of type (OR FUNCTION SYMBOL)"),
    ("(<= (make-fluent :name 'f :value 2) 2)", "The value #<FLUENT F [2]> is not of type REAL"),
    ("(< 1 'a)", "The value A is not of type REAL"),
    ("(register-update-callback (make-fluent) 'a 5)", "The value 5 is not of type (OR FUNCTION SYMBOL)"),
    ("(fl-funcall nil (make-fluent))", "The function COMMON-LISP:NIL is undefined."),
    ("(let ((f (make-fluent))) (register-update-callback f 'a nil) (pulse f))", "The function COMMON-LISP:NIL is undefined."),
    ("(cpl-impl:fl-apply #'list 3)", "The value 3 is not of type LIST"),
    ("(cpl-impl:fl-apply #'list (make-fluent :name 'f))", "The value #<FLUENT F [NIL]> is not of type LIST"),
    ("(cpl-impl:fl-apply #'+ 1 '(2 3))", "The value (2 3) is not of type NUMBER"),
]  # fmt: skip


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("form, text", WRONG)
def test_wrong_arguments_have_the_texts_of_the_original_and_a_place(told, form, text):
    lines = told(form)
    what, _, rest = lines.partition("  at <repl test>:1:")
    assert " ".join(what.split()) == text
    assert rest.splitlines()[1] == f"    {form}" and rest.splitlines()[2].endswith("^")


@pytest.mark.parametrize(
    "form",
    [
        "(pulse 3)",
        "(register-update-callback 3 'a #'car)",
        "(get-update-callback 3 'a)",
        "(remove-update-callback 3 'a)",
        "(setf (value (not (make-fluent))) 4)",
    ],
)
def test_what_is_no_fluent_has_no_applicable_method(told, form):
    assert " ".join(told(form).split()).startswith("There is no applicable method for the generic function")


KINDS = {"FLUENT-": "(make-fluent)", "FN-FL+": "(+ f 1)", "FN-FL-AND": "(fl-and f 1)", "FN-PULSE-FLUENT": "(pulsed f)",
         "FN-FL-UPDATED": "(fl-value-changed f)", "FN-FL-APPLY": "(cpl-impl:fl-apply #'list f nil)",
         "FN-FL-FUNCALL": "(fl-funcall #'1+ f)", "FN-FL-EQ": "(eq f 1)"}  # fmt: skip


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("name", KINDS)
def test_fluents_are_printed_as_in_the_original(answer, name):
    text = answer(f"(let ((f (make-fluent :value 1))) {KINDS[name]})")
    assert text.removeprefix(f"#<FLUENT {name}").removesuffix(">").removesuffix(" [NIL]").isdigit()


@pytest.mark.parametrize("form, given, operator", [("(eq 1)", 1, "EQ"), ("(eql 1 2 3)", 3, "EQL")])
def test_the_tests_take_two_arguments(told, form, given, operator):
    lines = told(form).splitlines()
    assert lines[0] == f"  invalid number of arguments: {given}"
    assert lines[-1] == f"  CRAM-LANGUAGE-IMPLEMENTATION:FL-{operator} takes 2 arguments."


def test_a_wait_ignores_every_argument_that_it_does_not_know(answer):
    assert answer('(wait-for (make-fluent :value 1) :colour :red "a" 3 \'b 4)') == "1"


def test_make_fluent_and_parameters_are_described_as_in_the_original(answer):
    assert (
        answer("""(progn (def-cpl-parameter *pace* 3 "How fast")
                       (list (documentation '*pace* 'variable)
                             (integerp (search "(CLASS 'VALUE-FLUENT)" (with-output-to-string (s) (describe 'make-fluent s))))))
                  """)
        == '("How fast" T)'
    )


def test_a_value_fluent_shows_its_value_readably(answer):
    assert (
        answer('(list (make-fluent :name \'foo :value 3) (make-fluent :name "str" :value "x"))')
        == '(#<FLUENT FOO [3]> #<FLUENT str ["x"]>)'
    )


def test_from_python_the_error_is_the_one_that_was_raised():
    fluent = cpl.make_fluent(value=1)
    cpl.register_update_callback(fluent, "divide", lambda value: 1 / (value - 2))
    with pytest.raises(ZeroDivisionError):
        fluent.set(2)
