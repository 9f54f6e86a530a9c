"""Policies as users write them: cpl.md section 9, invariants 107 to 111 of section 16."""

import pytest

GUARD = """
(define-policy guard (limit) "Ends its body when LIMIT is reached."
  (:init (policy-setf 'looks 0) (note :init) t)
  (:check (policy-setf 'looks (1+ (policy-get 'looks))) (>= (value *load*) limit))
  (:recover (note :recover))
  (:clean-up (note :clean-up)))
(defvar *load* (make-fluent :value 0))
"""


@pytest.fixture
def guarded(lisp):
    lisp(GUARD)
    return lisp


@pytest.mark.law(107)
def test_a_body_that_ends_first_gives_its_values(guarded):
    assert guarded("(top-level (with-policy guard (5) (sleep 1) (values 1 2)))") == "1 ; 2"
    assert guarded("*notes*") == "(:INIT :CLEAN-UP)"


@pytest.mark.law(108)
def test_when_the_check_is_met_the_body_is_dead_before_recovery_and_the_condition_comes_last(guarded):
    assert (
        guarded("""(top-level
                        (with-failure-handling ((policy-check-condition-met (c)
                                                  (note :handler (parameters c))
                                                  (return (princ-to-string c))))
                          (with-policy guard ((+ 2 3))
                            (unwind-protect (par (progn (sleep 1) (setf (value *load*) 7) (sleep 9))
                                                 (unwind-protect (sleep 9) (sleep 1) (note :branch-dead)))
                              (note :body-dead)))))""")
        == '"Policy check condition met for policy GUARD. Parameters: ((+ 2 3)). "'
    )
    assert guarded("*notes*") == "(:INIT :BRANCH-DEAD :BODY-DEAD :RECOVER :CLEAN-UP (:HANDLER ((+ 2 3))))"


@pytest.mark.law(109)
def test_an_init_that_gives_nil_starts_nothing(lisp):
    lisp("(define-policy never (x) (:init (note x) nil) (:check (note :check)) (:clean-up (note :clean-up)))")
    assert (
        lisp("""(handler-case (top-level (with-policy never (3) (note :body)))
                     (policy-init-failed (c) (princ-to-string c)))""")
        == '"Initialization of policy NEVER failed. Parameters: (3) "'
    )
    assert lisp("*notes*") == "(3)"


@pytest.mark.law(110)
def test_a_timeout_ends_a_longer_body_and_leaves_a_shorter_one_alone(lisp):
    assert lisp("(top-level (with-policy timeout-policy (2) (sleep 1) :in-time))") == ":IN-TIME"
    assert (
        lisp("""(top-level (with-failure-handling ((policy-check-condition-met (c) (return (princ-to-string c))))
                     (unwind-protect (with-policy timeout-policy (0.2) (sleep 10)) (note :after))))""")
        == '"Policy check condition met for policy TIMEOUT-POLICY. Parameters: (0.2). "'
    )


@pytest.mark.law(111)
def test_a_failing_body_cleans_up_and_its_failure_is_unchanged(guarded):
    guarded('(defvar *failure* (make-condition \'simple-plan-failure :format-control "x"))')
    assert (
        guarded("""(top-level (with-failure-handling ((plan-failure (f) (note :handler) (return (eq f *failure*))))
                        (with-policy guard (5) (fail *failure*))))""")
        == "T"
    )
    assert guarded("*notes*") == "(:INIT :HANDLER :CLEAN-UP)"


def test_a_policy_condition_reaches_the_handlers_of_parents(guarded):
    assert (
        guarded("""(top-level (with-failure-handling ((policy-check-condition-met (c) (return (cpl-impl:name c))))
                        (par (sleep 9) (with-policy timeout-policy (1) (sleep 9)))))""")
        == "TIMEOUT-POLICY"
    )


def test_a_policy_without_check_runs_its_body_and_a_failing_recovery_cleans_up(lisp):
    lisp("""(define-policy plain () (:clean-up (note :clean-up)))
            (define-policy broken () (:check t) (:recover (fail "recovery")) (:clean-up (note :broken-clean-up)))""")
    assert lisp("(top-level (with-policy plain () (sleep 1) :done))") == ":DONE"
    assert lisp.error("(top-level (with-policy broken () (sleep 1)))") == "recovery"
    assert lisp("*notes*") == "(:CLEAN-UP :BROKEN-CLEAN-UP)"


def test_parameters_are_evaluated_at_each_call_of_a_clause(lisp):
    lisp("(defvar *n* 0) (define-policy counting (n) (:check (>= n 3)))")
    assert lisp.error("(top-level (with-policy counting ((incf *n*)) (sleep 9)))").startswith("Policy check condition met")
    assert lisp("*n*") == "3"


def test_several_policies_nest_the_first_outermost_and_none_is_only_the_body(lisp):
    lisp("""(define-policy a () (:init (note :a) t) (:clean-up (note :a-over)))
            (define-policy b () (:init (note :b) t) (:clean-up (note :b-over)))""")
    assert lisp("(top-level (with-policies ((a ()) (b ())) (values 1 2)))") == "1 ; 2"
    assert lisp("*notes*") == "(:A :B :B-OVER :A-OVER)"
    assert lisp("(top-level (with-named-policies (('b ()) ('a ())) 3))") == "3"
    assert lisp("(top-level (with-policies () 4))") == "4" and lisp("(top-level (with-named-policies () 5))") == "5"


def test_a_policy_can_be_read_and_found_by_its_name(guarded):
    assert (
        guarded("""(list (eq (named-policy 'guard) guard) (parameters guard) (cpl-impl:name guard) (cpl-impl:policy-name guard)
                            (functionp (cpl-impl::policy-check guard)))""")
        == "(T (LIMIT) GUARD GUARD T)"
    )
    assert guarded.error("(named-policy 'no-such)") == "Policy NO-SUCH not found."


@pytest.mark.parametrize(
    "form, why",
    [
        ("(define-policy p () (:chek t))", "(:CHEK T) is malformed: it is none of the clauses :INIT :CHECK :RECOVER :CLEAN-UP."),
        ("(define-policy p () (:check t) (:check t))", "(:CHECK T) is malformed: there is a clause of this name already."),
        ("(define-policy p t (:check t))", "T is malformed: after the name comes the list of its parameters."),
        ('(define-policy "p" ())', '"p" is malformed: its name must be a symbol.'),
    ],
)
def test_a_broken_clause_is_refused_when_the_policy_is_compiled(lisp, form, why):
    assert lisp.error(form) == f"DEFINE-POLICY: {why}"


def test_the_wrong_use_of_a_policy_says_what_is_wrong(guarded):
    assert guarded.error("(top-level (with-policy guard () 1))") == "invalid number of arguments: 0"
    assert guarded.error("(top-level (with-policy 'guard (1) 1))").startswith("The value GUARD is not of type")
    assert guarded.error("(with-policy guard 1 2)") == "WITH-POLICY: 1 is malformed: after the policy comes the list of its parameters."
    assert guarded.error("(with-policy guard (5) 1)") == "'PURSUE' form not inside a plan."
    assert guarded("*notes*") == "NIL"


def test_the_hooks_of_a_policy_begin_with_its_name_and_end_with_its_success(guarded):
    guarded("""(defmethod cpl-impl::on-with-policy-begin laws (name parameters) (note name parameters) 17)
               (defmethod cpl-impl::on-with-policy-end laws (id success) (note id success))""")
    try:
        guarded("(top-level (with-policy timeout-policy (2) 1))")
        guarded.error("(top-level (with-policy timeout-policy (2) (sleep 9)))")
    finally:
        guarded("""(dolist (hook (list #'cpl-impl::on-with-policy-begin #'cpl-impl::on-with-policy-end))
                     (remove-method hook (find-method hook '(laws) (list t t))))""")
    assert guarded("*notes*") == "((TIMEOUT-POLICY NIL) (17 T) (TIMEOUT-POLICY NIL) (17 NIL))"
