"""What fluents were and tasks did, asked of Prolog: projection-and-events.md B4."""

import pytest

PLANS = """
(use-package :cram-occasions-events)
(defun answers (goal) (cut:force-ll (prolog:prolog goal)))
(defun about (goal) (cet:with-last-episode-knowledge (answers goal)))
(defun values-of (variable goal) (mapcar (lambda (bindings) (cut:var-value variable bindings)) (about goal)))
(defun paths-of (variable goal) (mapcar #'task-tree-node-path (values-of variable goal)))
(defvar *pose* (make-fluent :name 'pose :value 0))
(declare-goal reach (where)) (def-goal (reach ?where) (sleep 1) (setf (value *pose*) ?where) (values ?where :reached))
(def-cram-function grasp (thing) (sleep 2) (if (eq thing 'soap) (fail "~a slipped" thing) thing))
(def-cram-function wait () (sleep 100))
(def-top-level-cram-function fetch (thing)
  (reach 'shelf)
  (pursue (wait) (with-failure-handling ((plan-failure (f) (declare (ignore f)) (return :lost))) (grasp thing))))
(def-cram-function divide (x) (/ 1 x))
"""


@pytest.fixture
def plans(lisp):
    lisp(PLANS)
    return lisp


@pytest.fixture
def traced(plans):
    plans("(cet:enable-fluent-tracing) (fetch 'cup)")
    return plans


def test_fluents_are_known_by_name_and_any_symbol_may_be_one(traced):
    assert traced("(values-of '?f '(prolog:and (fluent ?f) (prolog:== ?f pose)))") == "(POSE)"
    assert traced("(about '(fluent anything))") == "(NIL)" and traced("(about '(fluent 5))") == "NIL"


def test_what_a_fluent_was_at_a_time(traced):
    for time, value in ((0.5, "0"), (0.9, "0"), (1.0, "SHELF"), (2.5, "SHELF")):
        assert traced(f"(values-of '?v '(holds (fluent-value pose ?v) (at {time}d0)))") == f"({value})"
    assert traced("(about '(holds (fluent-value pose ?v) (at 99.0d0)))") == "NIL"
    query = "(holds (fluent-value pose ?v) (at ?when))"
    assert traced(f"(list (values-of '?v '{query}) (values-of '?when '{query}))") == "((0 SHELF) (0.0d0 1.0d0))"
    assert traced("(values-of '?v '(holds (fluent-value pose ?v) (during 0.5d0 2.0d0)))") == "(0 SHELF)"
    assert traced("(values-of '?f '(prolog:and (holds (fluent-value ?f shelf) (at 2.0d0))))") == "(POSE)"
    assert traced("(about '(holds (fluent-value no-such-fluent ?v) (at 1.0d0)))") == "NIL"
    assert traced("(cet:with-last-episode-knowledge (cut:force-ll (holds '(fluent-value pose ?v) '(at 2.0d0))))") == "(((?V . SHELF)))"


def test_what_a_fluent_object_is_now(plans):
    assert plans("(setf (value *pose*) 7) (answers `(fluent-value ,*pose* ?v))") == "(((?V . 7)))"
    assert plans("(list (answers '(fluent-value pose ?v)) (answers '(fluent-value ?f ?v)))") == "(NIL NIL)"


def test_the_tasks_of_an_episode_parents_first(plans):
    plans("(fetch 'cup)")
    assert plans("(paths-of '?t '(top-level ?t))") == "(((TOP-LEVEL FETCH)))"
    assert plans("(mapcar #'first (paths-of '?t '(task ?t)))") == "((TOP-LEVEL FETCH) (GRASP) (WAIT) (GOAL (REACH ?WHERE)))"
    assert plans("(mapcar #'first (paths-of '?t '(goal-task ?t)))") == "((GOAL (REACH ?WHERE)))"
    assert plans("(values-of '?g '(task-goal ?t ?g))") == "((REACH SHELF))"
    assert plans("(values-of '?p '(prolog:and (goal-task ?t) (task-path ?t ?p)))") == "(((GOAL (REACH ?WHERE)) (TOP-LEVEL FETCH)))"
    assert plans("(length (about '(prolog:and (task ?t) (task ?t))))") == "4"


@pytest.mark.law("projection-and-events", 25)
def test_results_and_outcomes(plans):
    plans("(fetch 'cup)")
    assert plans("(values-of '?r '(task-result ?t ?r))") == "(CUP CUP NIL (SHELF :REACHED))"
    assert plans("(values-of '?o '(task-outcome ?t ?o))") == "(:SUCCEEDED :SUCCEEDED :EVAPORATED :SUCCEEDED)"
    assert plans("(mapcar #'first (paths-of '?t '(task-outcome ?t :evaporated)))") == "((WAIT))"
    plans("(fetch 'soap)")
    assert plans("(mapcar #'first (paths-of '?t '(task-outcome ?t :failed)))") == "((GRASP))"
    assert plans("(mapcar #'princ-to-string (values-of '?e '(task-error ?t ?e)))") == '("SOAP slipped")'
    assert plans("(values-of '?type '(prolog:and (task-error ?t ?e) (error-type ?e ?type)))") == "(SIMPLE-PLAN-FAILURE)"


def test_an_error_of_lisp_is_taken_out_of_its_envelope(plans):
    plans.error("(top-level (divide 0))")
    assert plans("(values-of '?type '(prolog:and (task-error ?t ?e) (error-type ?e ?type)))") == "(DIVISION-BY-ZERO)"


def test_the_type_of_an_unbound_error_is_a_warning_and_fails(plans):
    assert plans("(warnings-of (note (answers '(error-type ?e ?type))))") == (
        '("[PROLOG WARNING] Trying to call ERROR-TYPE on unbound variable.")'
    )
    assert plans("(list (notes) (answers '(error-type 5 ?type)))") == "((NIL) NIL)"


def test_who_is_below_whom_in_both_directions(plans):
    plans("(fetch 'cup) (defvar *root* (cet:episode-knowledge-task-tree cet:*last-episode-knowledge*))")
    plans("(defvar *grasp* (first (values-of '?t '(prolog:and (task-path ?t ((grasp) . ?_)))))) (top-level 1) (fetch 'cup)")
    assert plans("(mapcar #'first (paths-of '?s '(prolog:and (top-level ?t) (subtask ?t ?s))))") == "((GRASP) (WAIT) (GOAL (REACH ?WHERE)))"
    assert plans("(paths-of '?t '(prolog:and (task-outcome ?s :evaporated) (subtask ?t ?s)))") == "(((TOP-LEVEL FETCH)))"
    assert plans("(length (about '(subtask ?t ?s)))") == "3"
    plans("(def-top-level-cram-function deep () (outer)) (def-cram-function outer () (grasp 'cup)) (deep)")
    assert plans("(mapcar #'first (paths-of '?s '(prolog:and (top-level ?t) (subtask+ ?t ?s))))") == "((OUTER) (GRASP))"
    assert plans("(mapcar #'first (paths-of '?t '(prolog:and (task-path ?s ((grasp) . ?_)) (subtask+ ?t ?s))))") == (
        "((OUTER) (TOP-LEVEL DEEP))"
    )


def test_siblings_and_the_next_one(plans):
    plans("(fetch 'cup)")
    assert plans("(mapcar #'first (paths-of '?s '(prolog:and (goal-task ?t) (coe::task-sibling ?t ?s))))") == "((GRASP) (WAIT))"
    assert plans("(mapcar #'first (paths-of '?s '(prolog:and (goal-task ?t) (coe::task-next-sibling ?t ?s))))") == "((WAIT))"
    assert plans("(mapcar #'first (paths-of '?t '(prolog:and (task-outcome ?s :evaporated) (coe::task-next-sibling ?t ?s))))") == (
        "((GOAL (REACH ?WHERE)))"
    )


def test_statuses_at_a_time_and_the_times_of_tasks_as_traced(traced):
    query = "(prolog:and (goal-task ?t) (holds (task-status ?t ?s) {}))"
    assert traced(f"(values-of '?s '{query.format('(at 0.5d0)')})") == "(:RUNNING)"
    assert traced(f"(values-of '?s '{query.format('(at 2.5d0)')})") == "(:SUCCEEDED)"
    assert traced(f"(values-of '?s '{query.format('(during 0.0d0 9.0d0)')})") == "(:CREATED :RUNNING :SUCCEEDED)"
    assert traced("(mapcar #'first (paths-of '?t '(holds (task-status ?t :evaporated) (at 3.05d0))))") == "((WAIT))"
    assert (
        traced("""(about '(prolog:and (task-path ?t ((grasp) . ?_)) (task-created-at ?t ?c) (task-started-at ?t ?s)
                                         (task-ended-at ?t ?e)))""").count("1.0d0")
        == 1
    )
    assert traced("(values-of '?e '(prolog:and (goal-task ?t) (task-ended-at ?t ?e)))") == "(1.0d0)"
    assert traced("(values-of '?c '(prolog:and (goal-task ?t) (task-created-at ?t ?c)))") == "(0.0d0)"
    status = "(goal-task ?t) (task-status-fluent ?t ?f)"
    assert (
        traced(f"""(equal (values-of '?f '(prolog:and {status}))
                             (values-of '?f '(prolog:and {status} (holds (fluent-value ?f :running) (at 0.5d0)))))""")
        == "T"
    )


def test_statuses_and_times_are_known_without_tracing_too(plans):
    plans("(fetch 'cup)")
    assert plans("(values-of '?s '(prolog:and (goal-task ?t) (holds (task-status ?t ?s) (during 0.0d0 9.0d0))))") == "(:RUNNING :SUCCEEDED)"
    assert plans("(values-of '?s '(prolog:and (goal-task ?t) (task-started-at ?t ?s)))") == "(0.0d0)"
    assert plans("(values-of '?e '(prolog:and (goal-task ?t) (task-ended-at ?t ?e)))") == "(1.0d0)"
    assert plans("(about '(task-created-at ?t ?c))") == "NIL"


def test_a_plan_may_ask_about_itself_while_it_runs(plans):
    plans("""(def-top-level-cram-function watcher ()
               (grasp 'cup)
               (note (mapcar (lambda (b) (cut:var-value '?o b)) (answers '(task-outcome ?t ?o))))
               (note (mapcar (lambda (b) (cut:var-value '?s b))
                             (answers '(prolog:and (top-level ?t) (holds (task-status ?t ?s) (at 1.0d0)))))))
             (watcher)""")
    assert plans("(notes)") == "((:SUCCEEDED) (:RUNNING))"


@pytest.mark.law("projection-and-events", 26)
def test_the_same_questions_to_an_episode_from_a_file(traced):
    traced('(cet:save-last-episode-knowledge "fetch.ek")')
    asked = [
        "(task-outcome ?t ?x)",
        "(task-result ?t ?x)",
        "(prolog:and (goal-task ?t) (task-ended-at ?t ?x))",
        "(task-path ?t ?x)",
        "(holds (fluent-value pose ?x) (at 2.0d0))",
        "(prolog:and (goal-task ?t) (holds (task-status ?t ?x) (at 0.5d0)))",
        "(prolog:and (top-level ?t) (subtask ?t ?s) (task-path ?s ?x))",
        "(task-goal ?t ?x)",
    ]
    for goal in asked:
        live = traced(f"(values-of '?x '{goal})")
        loaded = traced(f"""(cet:with-offline-episode-knowledge "fetch.ek"
                              (mapcar (lambda (b) (cut:var-value '?x b)) (answers '{goal})))""")
        assert live == loaded != "NIL", goal


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "goal, name",
    [
        ("(task ?t)", "TASK"),
        ("(top-level ?t)", "TOP-LEVEL"),
        ("(task-outcome ?t ?o)", "TASK-OUTCOME"),
        ("(fluent ?f)", "FLUENT"),
        ("(holds (fluent-value pose ?v) (at 1.0d0))", "FLUENT-VALUE"),
        ("(subtask ?t ?s)", "SUBTASK"),
        ("(holds (task-status ?t ?s) ?time)", "TASK-STATUS"),
        ("(goal-task ?t)", "GOAL-TASK"),
    ],
)
def test_without_an_episode_there_is_a_warning_and_no_answer(plans, goal, name):
    assert plans(f"(warnings-of (note (answers '{goal})))") == (
        f'("[PROLOG WARNING] {name} asks an episode, and *EPISODE-KNOWLEDGE* is nil. Write (with-last-episode-knowledge ...) '
        'around the query.")'
    )
    assert plans("(notes)") == "(NIL)"


def test_a_lazy_list_of_answers_goes_on_asking_its_episode(plans):
    plans("""(fetch 'cup) (defvar *answers* (cet:with-last-episode-knowledge (prolog:prolog '(prolog:and (task ?t) (task-outcome ?t ?o)))))
             (top-level 1)""")
    assert plans("(warnings-of (note (length (cut:force-ll *answers*)))) (notes)") == "(4)"
