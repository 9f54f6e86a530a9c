"""Projection environments: projection-and-events.md A1."""

import pytest

WORLD = """
(defvar *world* :real)
(define-projection-environment imagined :special-variable-initializers ((*world* (list :imagined))))
"""


@pytest.mark.law("projection-and-events", 1, 3)
def test_a_variable_has_its_initial_value_inside_and_its_old_one_outside_also_after_an_assignment(lisp):
    lisp(WORLD + "(with-projection-environment imagined (note *world*) (setf *world* 5) (note *world*))")
    assert lisp("(list (notes) *world*)") == "(((:IMAGINED) 5) :REAL)"


@pytest.mark.law("projection-and-events", 1)
def test_plans_inside_and_around_the_projection_see_its_variables(lisp):
    lisp(
        WORLD
        + """(with-projection-environment imagined (top-level (par (note *world*) (sleep 1))))
                    (top-level (with-projection-environment imagined (par (note *world*) (sleep 1))))"""
    )
    assert lisp("(list (notes) *world*)") == "(((:IMAGINED) (:IMAGINED)) :REAL)"


@pytest.mark.law("projection-and-events", 2, 3)
def test_a_special_projection_variable_is_bound_in_any_environment_and_evaluated_anew_each_time(lisp):
    lisp("""(defvar *belief* :outer) (defvar *count* 0)
            (define-special-projection-variable *belief* (incf *count*))
            (define-projection-environment one) (define-projection-environment two)""")
    lisp("(with-projection-environment one (note *belief*) (setf *belief* :lost)) (with-projection-environment two (note *belief*))")
    assert lisp("(list (notes) *belief*)") == "((1 2) :OUTER)"
    lisp("(define-special-projection-variable *belief* :replaced)")
    assert lisp("(with-projection-environment one *belief*)").count(":REPLACED") == 2


@pytest.mark.law("projection-and-events", 4)
def test_the_name_of_the_environment_is_known_inside_and_nil_outside(lisp):
    lisp(WORLD)
    assert lisp("(with-projection-environment imagined (note *projection-environment*) (top-level (note *projection-environment*)))")
    assert lisp("(list (notes) *projection-environment*)") == "((IMAGINED IMAGINED) NIL)"


@pytest.mark.law("projection-and-events", 5)
def test_startup_runs_before_the_body_and_shutdown_after_it_also_when_the_body_fails(lisp):
    lisp("""(define-projection-environment noted :startup (note :startup) :shutdown (progn (sleep 1) (note :shutdown)))""")
    lisp("(with-projection-environment noted (note :body))")
    assert lisp("(notes)") == "(:STARTUP :BODY :SHUTDOWN)"
    assert lisp.error('(top-level (with-projection-environment noted (fail "lost")))') == "lost"
    assert lisp("(notes)") == "(:STARTUP :SHUTDOWN)"
    assert lisp("(block nil (with-projection-environment noted (return 7)))") == "7"
    assert lisp("(notes)") == "(:STARTUP :SHUTDOWN)"


@pytest.mark.law("projection-and-events", 5)
def test_a_projection_that_is_evaporated_is_shut_down_before_its_task_is_dead(lisp):
    lisp("""(define-projection-environment noted :startup (note :startup) :shutdown (progn (sleep 3) (note :shutdown)))
            (top-level (pursue (sleep 1) (with-projection-environment noted (sleep 100))) (note (cut:current-timestamp)))""")
    assert lisp("(list (notes) *projection-environment*)") == "((:STARTUP :SHUTDOWN 4.0d0) NIL)"


@pytest.mark.law("projection-and-events", 6)
def test_the_result_lists_all_values_and_the_variables_at_the_end_of_the_body(lisp):
    package = "(let ((*print-pretty* nil)) (prin1-to-string {}))"
    lisp(WORLD + "(define-special-projection-variable *belief* 1)")
    assert lisp(package.format("(with-projection-environment imagined (setf *belief* 2 *world* '(a)) (values 1 2))")) == (
        '"#S(CRAM-PROJECTION::PROJECTION-ENVIRONMENT-RESULT :NAME IMAGINED :RESULT (1 2) :ENVIRONMENT ((*WORLD* A) (*BELIEF* . 2)))"'
    )
    assert lisp("(cram-projection::projection-environment-result-result (with-projection-environment imagined (values)))") == "NIL"
    assert lisp("(slot-value (with-projection-environment imagined 5) 'cram-projection::result)") == "(5)"


@pytest.mark.law("projection-and-events", 7)
def test_an_unknown_environment_is_an_error_that_names_the_nearest_one(lisp):
    lisp(WORLD)
    assert lisp.error("(with-projection-environment imagine 1)") == "Cannot find projection environment `IMAGINE'."
    assert lisp.shown_error("(with-projection-environment imagine 1)") == (
        "cramhy: SIMPLE-ERROR\n  Cannot find projection environment `IMAGINE'.\n  at <repl>:1:1\n"
        "    (with-projection-environment imagine 1)\n    ^\n  Did you mean IMAGINED?\n"
    )
    assert "  Defined are IMAGINED.\n" in lisp.shown_error("(with-projection-environment pr2 1)")


def test_an_error_says_how_to_define_the_first_environment(lisp):
    assert "  None is defined: write (define-projection-environment NAME ...).\n" in lisp.shown_error("(with-projection-environment pr2 1)")


def test_a_definition_that_is_malformed_says_what_is_wrong(lisp):
    assert lisp.error("(define-projection-environment e :starup (note 1))") == (
        "DEFINE-PROJECTION-ENVIRONMENT has no option :STARUP: it has :SPECIAL-VARIABLE-INITIALIZERS, :PROCESS-MODULE-DEFINITIONS, "
        ":STARTUP, :SHUTDOWN."
    )
    assert "is malformed" in lisp.error("(define-projection-environment e :special-variable-initializers (*world*))")


@pytest.mark.law("projection-and-events", 9)
def test_defining_an_environment_again_replaces_it(lisp):
    assert lisp(WORLD) == "(#<CRAM-PROJECTION::PROJECTION-ENVIRONMENT IMAGINED>)"
    assert lisp("(define-projection-environment other)") == (
        "(#<CRAM-PROJECTION::PROJECTION-ENVIRONMENT OTHER> #<CRAM-PROJECTION::PROJECTION-ENVIRONMENT IMAGINED>)"
    )
    lisp("(define-projection-environment imagined :special-variable-initializers ((*world* :again)))")
    assert lisp("(with-projection-environment imagined (note *world*)) (notes)") == "(:AGAIN)"


def test_initialisers_do_not_see_each_others_variables(lisp):
    lisp("""(defvar *a* 1) (defvar *b* 2)
            (define-projection-environment swapped :special-variable-initializers ((*a* *b*) (*b* *a*)))
            (define-special-projection-variable *c* (list *a* *b*))""")
    assert lisp("(with-projection-environment swapped (note *a* *b* *c*)) (notes)") == "((2 1 (2 1)))"


def test_startup_that_fails_is_shut_down_and_the_body_does_not_run(lisp):
    lisp("""(cpm:def-process-module arm (designator) designator)
            (define-projection-environment broken :process-module-definitions (arm) :startup (error "no simulator")
                                                  :shutdown (note :shutdown))""")
    assert lisp.error("(with-projection-environment broken (note :body))") == "no simulator"
    assert lisp("(list (notes) (cpm:get-running-process-module 'arm) *projection-environment*)") == "((:SHUTDOWN) NIL NIL)"


def test_an_initialiser_that_fails_starts_nothing(lisp):
    lisp("""(defvar *a* 1)
            (define-projection-environment broken :special-variable-initializers ((*a* (error "no value")))
                                                  :startup (note :startup) :shutdown (note :shutdown))""")
    assert lisp.error("(with-projection-environment broken (note :body))") == "no value"
    assert lisp("(list (notes) *a* *projection-environment*)") == "(NIL 1 NIL)"


def test_projections_side_by_side_have_their_own_variables(lisp):
    lisp("""(defvar *place* :here)
            (define-projection-environment left :special-variable-initializers ((*place* :left)))
            (define-projection-environment right :special-variable-initializers ((*place* :right)))
            (top-level
              (par (with-projection-environment left (sleep 1) (note *place* *projection-environment*) (setf *place* 1)
                     (par (sleep 3) (note *place*)))
                   (with-projection-environment right (sleep 2) (note *place* *projection-environment*))
                   (progn (sleep 3) (note *place* *projection-environment*))))""")
    assert lisp("(notes)") == "((:LEFT LEFT) 1 (:RIGHT RIGHT) (:HERE NIL))"


def test_a_projection_within_a_projection(lisp):
    lisp("""(defvar *place* :here) (defvar *depth* 0)
            (define-special-projection-variable *depth* (1+ *depth*))
            (define-projection-environment outer :special-variable-initializers ((*place* :outer)))
            (define-projection-environment inner :special-variable-initializers ((*place* (list *place*))))
            (with-projection-environment outer
              (with-projection-environment inner (note *place* *projection-environment* *depth*))
              (note *place* *projection-environment* *depth*))""")
    assert lisp("(notes)") == "(((:OUTER) INNER 2) (:OUTER OUTER 1))"


def test_environments_and_clocks_describe_themselves(lisp):
    lisp(WORLD)
    shown = lisp("(with-output-to-string (*standard-output*) (describe (first (define-projection-environment e :startup 1))))")
    assert "PROJECTION-ENVIRONMENT E>" in shown and "Has a startup form" in shown
    assert "Time" in lisp("(with-output-to-string (*standard-output*) (describe (make-instance 'linear-clock)))")
