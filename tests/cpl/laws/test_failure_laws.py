"""Failures and their handling as users write them: cpl.md section 4, invariants 65 to 77 and 120 to 121 of section 16."""

import pytest


@pytest.mark.law(65)
def test_error_and_plan_failure_do_not_catch_each_other(lisp):
    assert lisp.error('(top-level (with-failure-handling ((error (e) (return e))) (fail "no ~a" "fuel")))') == "no fuel"
    assert lisp.error('(top-level (with-failure-handling ((plan-failure (f) (return f))) (error "boo")))') == "boo"
    assert lisp("(list (subtypep 'plan-failure 'error) (subtypep 'plan-failure 'serious-condition))") == "(NIL T)"


@pytest.mark.law(66, 67, 68)
def test_an_error_several_levels_below_is_the_original_for_error_and_one_envelope_for_plan_failure(lisp):
    deep = "(par (sleep 9) (par (with-tags (:tag deep (pursue (error *problem*) (sleep 9))))))"
    lisp('(defvar *problem* (make-condition \'simple-error :format-control "deep"))')
    assert lisp(f"(top-level (with-failure-handling ((error (e) (return (eq e *problem*)))) {deep}))") == "T"
    assert (
        lisp(f"""(top-level (with-failure-handling ((plan-failure (f) (return (list (type-of f) (eq (envelop-error f) *problem*)))))
                                 {deep}))""")
        == "(COMMON-LISP-ERROR-ENVELOPE T)"
    )


@pytest.mark.law(69)
def test_a_handler_runs_before_cleanup_in_its_own_task_and_after_that_of_a_child(lisp):
    body = '(unwind-protect (fail "x") (note :cleanup))'
    for form in (body, f"(par {body})"):
        lisp(f"(top-level (with-failure-handling ((plan-failure (f) f (note :handler) (return))) {form}))")
    assert lisp("*notes*") == "(:HANDLER :CLEANUP :CLEANUP :HANDLER)"


@pytest.mark.law(70)
def test_who_declines_gives_the_same_condition_to_the_next_clause_and_then_to_the_outer_form(lisp):
    lisp("""(top-level (with-failure-handling ((plan-failure (f) (note :outer f) (return)))
              (with-failure-handling ((simple-plan-failure (f) (note :first f)) (error (e) (note :never e))
                                      ((or composite-failure plan-failure) (f) (note :second f)))
                (fail "x"))))""")
    assert lisp("(list (mapcar #'first *notes*) (length (remove-duplicates (mapcar #'second *notes*))))") == "((:FIRST :SECOND :OUTER) 1)"


@pytest.mark.law(71)
@pytest.mark.parametrize("again", ['(fail "again")', '(error "again")', "(car 1)"])
def test_what_a_handler_fails_with_is_for_the_forms_outside(lisp, again):
    lisp(f"""(top-level (with-failure-handling (((or plan-failure error) (f) f (note :outer) (return)))
               (with-failure-handling (((or plan-failure error) (f) f (note :inner) {again}))
                 (fail "first"))))""")
    assert lisp("*notes*") == "(:INNER :OUTER)"


@pytest.mark.law(72)
def test_retry_runs_the_body_from_its_start_and_keeps_what_is_bound_outside(lisp):
    assert (
        lisp("""(top-level (let ((outside 0))
                     (with-failure-handling ((plan-failure (f) f (retry)))
                       (let ((inside 0))
                         (incf inside) (incf outside)
                         (when (< outside 4) (fail "x"))
                         (list inside outside)))))""")
        == "(1 4)"
    )
    assert lisp("(let ((n 0)) (with-failure-handling () (when (< (incf n) 3) (retry)) n))") == "3"


def test_endless_retries_can_be_evaporated(lisp):
    assert lisp('(top-level (pursue (sleep 1) (with-failure-handling ((plan-failure (f) f (sleep 0.1) (retry))) (fail "x"))))') == "NIL"
    assert lisp('(top-level (pursue 5 (with-failure-handling ((plan-failure (f) f (retry))) (fail "x"))))') == "5"


COUNTED = """
(with-failure-handling ((plan-failure (f) f (note (get-counter tries)) (do-retry tries (retry)) (return :exhausted))) (fail "x"))"""


@pytest.mark.law(73)
def test_a_counter_allows_as_many_retries_as_it_says_and_as_many_again_when_it_was_reset(lisp):
    assert lisp(f"(with-retry-counters ((tries 2)) (list {COUNTED} (reset-counter tries) {COUNTED}))") == "(:EXHAUSTED 2 :EXHAUSTED)"
    assert lisp("*notes*") == "(2 1 0 2 1 0)"
    assert lisp('(with-retry-counters ((none 0)) (do-retry none (error "never")))') == "NIL"
    assert lisp("(with-retry-counters ((one 1)) (do-retry one 1 (values 2 3)))") == "2 ; 3"


def test_counters_around_stay_visible_and_the_inner_of_one_name_hides_the_outer(lisp):
    assert (
        lisp("""(with-retry-counters ((outer 2) (both 5))
                     (with-retry-counters ((inner 3) (both 7))
                       (do-retry outer (reset-counter inner))
                       (list (get-counter outer) (get-counter inner) (get-counter both))))""")
        == "(1 3 7)"
    )
    assert "There is no retry counter C here; WITH-RETRY-COUNTERS defines (" in lisp.error(
        "(with-retry-counters ((a 1)) (with-retry-counters ((b 1)) (do-retry c (retry))))"
    )


@pytest.mark.law(74)
def test_fail_alone_is_a_simple_plan_failure_that_says_so(lisp):
    assert lisp("(with-failure-handling ((simple-plan-failure (f) (return (princ-to-string f)))) (fail))") == '"Plan failure."'


@pytest.mark.law(75)
def test_an_error_leaves_top_level_as_itself(lisp):
    lisp('(defvar *problem* (make-condition \'simple-error :format-control "deep"))')
    assert lisp("(handler-case (top-level (par (par (error *problem*)))) (error (e) (eq e *problem*)))") == "T"


@pytest.mark.law(76)
def test_ignore_errors_lets_a_failure_pass(lisp):
    assert lisp.error('(top-level (ignore-errors (fail "through")) (note :never))') == "through"
    assert lisp("*notes*") == "NIL"


@pytest.mark.law(77)
def test_on_fail_gets_the_datum_before_any_handler(lisp):
    lisp("(defmethod on-fail laws (datum) (note datum))")
    try:
        lisp("""(top-level (with-failure-handling ((plan-failure (f) f (note :handler) (return))) (fail "text ~a" 1)))
                (top-level (with-failure-handling ((plan-failure (f) f (return))) (fail 'composite-failure :failures nil)))""")
    finally:
        lisp("(remove-method #'on-fail (find-method #'on-fail '(laws) (list t)))")
    assert lisp("*notes*") == '("text ~a" :HANDLER COMPOSITE-FAILURE)'


# ---------------------------------------------------------------------------------------------------- designators of conditions


def test_fail_takes_a_text_a_class_or_a_condition(lisp):
    def caught(arguments):
        return lisp(f"(with-failure-handling ((condition (c) (return (values (type-of c) (princ-to-string c))))) (fail {arguments}))")

    assert caught('"a ~a" 1') == 'SIMPLE-PLAN-FAILURE ; "a 1"'
    assert caught("'composite-failure") == 'COMPOSITE-FAILURE ; "Condition CRAM-LANGUAGE-IMPLEMENTATION:COMPOSITE-FAILURE was signalled."'
    assert caught('(make-condition \'simple-error :format-control "e")') == 'SIMPLE-ERROR ; "e"'
    assert caught("12") == 'SB-KERNEL:CASE-FAILURE ; "12 fell through ETYPECASE expression. Wanted one of (CONDITION SYMBOL STRING)."'
    assert caught("#'car").endswith('Wanted one of (CONDITION SYMBOL STRING)."')
    assert caught("(make-condition 'plan-failure) 1 2") == 'SIMPLE-ERROR ; "The assertion (NULL REST) failed with REST = (1 2)."'
    assert caught("'no-such").startswith("SIMPLE-TYPE-ERROR")


def test_a_failure_prints_its_control_string_and_shows_its_text(lisp):
    printed = lisp('(handler-case (fail "a ~a" 1) (plan-failure (f) (prin1-to-string f)))')
    assert printed.startswith(r'"#<SIMPLE-PLAN-FAILURE \"a ~a\" {')


@pytest.mark.parametrize("type", ["'my-condition", "'policy-condition", "'warning"])
def test_a_condition_of_another_family_reaches_the_parents_handlers_and_leaves_top_level_as_itself(lisp, type):
    lisp("(define-condition my-condition (condition) ())")
    assert lisp(f"(top-level (with-failure-handling ((condition (c) (return (type-of c)))) (par (error {type}))))") == type[1:].upper()
    assert lisp(f"(handler-case (top-level (par (error {type}))) (condition (c) (type-of c)))") == type[1:].upper()


def test_warnings_and_plain_signals_do_nothing_to_a_task(lisp):
    assert lisp('(top-level (signal \'plan-failure) (let ((*error-output* (make-broadcast-stream))) (warn "oops")) :alive)') == ":ALIVE"


def test_a_failure_without_scheduling_and_in_a_callback_is_a_failure(lisp):
    assert lisp.error('(top-level (par (without-scheduling (fail "inside"))))') == "inside"
    lisp('(defvar *door* (make-fluent :value nil)) (register-update-callback *door* \'cb (lambda (v) (fail "door ~a" v)))')
    assert (
        lisp("""(top-level (with-failure-handling ((plan-failure (f) (return (princ-to-string f))))
                     (par (sleep 9) (setf (value *door*) :open))))""")
        == '"door OPEN"'
    )


def test_restarts_belong_to_their_task_and_every_task_can_be_aborted(lisp):
    assert (
        lisp("""(top-level (with-simple-restart (skip "Skip it.")
                     (with-failure-handling ((plan-failure (f) f (invoke-restart 'skip))) (fail "x"))))""")
        == "NIL ; T"
    )
    assert lisp.error("""(with-simple-restart (skip "Skip it.") (top-level (invoke-restart 'skip)))""") == "No restart SKIP is active."
    assert (
        lisp("""(top-level (with-failure-handling ((plan-failure (f) (return (princ-to-string f))))
                     (par (with-failure-handling ((plan-failure (f) f (note :never)))
                            (unwind-protect (abort) (note :cleanup))))))""")
        == '"Aborted."'
    )
    assert lisp("*notes*") == "(:CLEANUP)"


# ------------------------------------------------------------------------------------------------------------------- clauses


@pytest.mark.parametrize(
    "clauses, why",
    [
        ("((plan-failure))", "(PLAN-FAILURE) is malformed: a clause is a list of a type, a parameter list and forms."),
        ("((plan-failure c 1))", "(PLAN-FAILURE C 1) is malformed: a clause is a list of a type, a parameter list and forms."),
        ("((plan-failure () 1))", "(PLAN-FAILURE NIL 1) is malformed: its parameter list must take one argument, the condition."),
        ("((error (a b) 1))", "(ERROR (A B) 1) is malformed: its parameter list must take one argument, the condition."),
        ("(((and error) (c) c))", "((AND ERROR) (C) C) is malformed: its type must be a name or (OR name*)."),
        ('(((or error "x") (c) c))', '((OR ERROR "x") (C) C) is malformed: OR takes names of condition types.'),
        ("plan-failure", "PLAN-FAILURE is malformed: the first part is a list of clauses."),
    ],
)
def test_a_clause_of_another_shape_is_refused_when_the_form_is_compiled(lisp, clauses, why):
    assert lisp.error(f"(defun never () (with-failure-handling {clauses} 1))") == f"WITH-FAILURE-HANDLING: {why}"


def test_the_last_of_two_clauses_for_a_type_counts_and_a_parameter_list_may_have_any_shape(lisp):
    assert lisp('(with-failure-handling ((plan-failure (f) f (return 1)) (plan-failure (f) f (return 2))) (fail "x"))') == "2"
    assert lisp('(with-failure-handling ((plan-failure (&rest all) (return (length all)))) (fail "x"))') == "1"


def test_the_wrapped_error_comes_first_and_for_its_first_clause_only(lisp):
    assert (
        lisp.error("""(top-level (with-failure-handling ((plan-failure (f) (note :failure (type-of f)))
                                                           (simple-error (e) (note :simple (type-of e)))
                                                           (error (e) (note :error e)))
                           (par (error "x"))))""")
        == "x"
    )
    assert lisp("*notes*") == "((:SIMPLE SIMPLE-ERROR) (:FAILURE COMMON-LISP-ERROR-ENVELOPE))"


def test_the_four_hooks_of_failure_handling_follow_it(lisp):
    hooks = {
        "begin": "(types) (note :begin types) 17",
        "handled": "(id) (note :handled id)",
        "rethrown": "(id) (note :rethrown id)",
        "end": "(id) (note :end id)",
    }
    for name, rest in hooks.items():
        parameters, body = rest.split(") ", 1)
        lisp(f"(defmethod cpl-impl::on-with-failure-handling-{name} laws {parameters}) {body})")
    try:
        lisp("""(with-failure-handling ((simple-plan-failure (f) f) ((or error plan-failure) (f) f (return))) (fail "x"))""")
        assert lisp("*notes*") == (
            '((:BEGIN ("SIMPLE-PLAN-FAILURE" "ERROR" "PLAN-FAILURE")) (:HANDLED 17) (:RETHROWN 17) (:HANDLED 17) (:END 17))'
        )
        lisp("(setf *notes* nil) (top-level 1)")
        assert lisp("*notes*") == '((:BEGIN ("PLAN-FAILURE" "ERROR")) (:END 17))'
    finally:
        for name in hooks:
            lisp(f"""(let ((hook #'cpl-impl::on-with-failure-handling-{name}))
                       (remove-method hook (find-method hook '(laws) (list t))))""")


# --------------------------------------------------------------------------------------------------------------- the debugger


def test_without_a_debugger_the_variables_of_debugging_change_nothing(lisp):
    assert lisp("(list *debug-on-lisp-errors* *break-on-plan-failures*)") == "(NIL NIL)"
    assert (
        lisp("""(let ((*debug-on-lisp-errors* t) (*break-on-plan-failures* 'plan-failure))
                     (top-level (with-failure-handling ((error (e) (return (princ-to-string e))))
                       (with-failure-handling ((plan-failure (f) (note (type-of f)))) (par (error "x"))))))""")
        == '"x"'
    )
    assert (
        lisp("""(let ((*break-on-plan-failures* t))
                     (top-level (with-failure-handling ((plan-failure (f) (return (princ-to-string f)))) (fail "y"))))""")
        == '"y"'
    )


def test_assertions_about_exits_show_the_forms(lisp):
    assert lisp.error("(cut:assert-no-returning (note 1) (+ 1 2))") == "Asserted ((NOTE 1) (+ 1 2)) not to return. But we did return."
    assert (
        lisp.error("(block nil (cut:assert-no-nlx (return 3)))")
        == "Asserted ((RETURN 3)) not to perform a non-local exit. Caught attempt to do so."
    )
    assert lisp("(cut:assert-no-nlx (values 1 2))") == "1 ; 2"
    assert lisp.error('(top-level (cut:assert-no-nlx (fail "as it is")))') == "as it is"


# ---------------------------------------------------------------------------------------------------------------- logging


@pytest.fixture
def no_tags_left(lisp):
    yield
    lisp("(cpl-impl:log-set nil)")


@pytest.mark.law(120)
def test_nothing_is_evaluated_or_written_for_inactive_tags(lisp, no_tags_left):
    event = '(cpl-impl:log-event (:context "C") (:display "~a" (note :evaluated)) (:tags :debug))'
    assert lisp(f"(cpl-impl:log-set '(:gc)) (with-output-to-string (*trace-output*) {event})") == '""'
    assert lisp("*notes*") == "NIL"
    assert "C" in lisp(f"(cpl-impl:log-set '(:debug)) (with-output-to-string (*trace-output*) {event})")
    assert lisp("*notes*") == "(:EVALUATED)"


@pytest.mark.law(121)
def test_the_functions_for_tags_give_the_active_ones_and_unknown_tags_change_nothing(lisp, no_tags_left):
    assert lisp("(cpl-impl:log-set '(:par :fail))") == "(:FAIL :PAR)"
    assert lisp("(cpl-impl:log-enable '(:debug))") == "(:DEBUG :FAIL :PAR)"
    assert lisp("(cpl-impl:log-disable '(:fail))") == "(:DEBUG :PAR)"
    for function in ("set", "enable", "disable"):
        assert (
            lisp.error(f"(cpl-impl:log-{function} '(:gc :no-such))")
            == "Do not know about log tag :NO-SUCH; you probably forgot to adjust DEFINE-LOG-TAGS."
        )
    assert lisp("(list (cpl-impl:list-active-log-tags) (cpl-impl:logging-enabled-p :gc :par))") == "((:DEBUG :PAR) T)"
    assert lisp.error('(cpl-impl:log-event (:display "x") (:tags :no-such))') == ":NO-SUCH not a known log tag. See DEFINE-LOG-TAGS."
    assert lisp.error('(cpl-impl:log-event (:display "x"))') == "Missing (:TAGS ...) clause."
