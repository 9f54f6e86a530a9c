"""Tasks as objects of Lisp: how they are made, named, printed, asked and saved (cpl.md 3.1 to 3.3, 3.9, 3.13)."""

import re

import pytest

from cramhy_runtime import kernel


def test_a_task_has_the_constructor_keywords_of_the_original(lisp):
    assert lisp("""
        (top-level
          (let ((made (make-instance 'task :name "made" :path '((a) (b)) :run-thread nil :thread-fun (lambda () (note :ran) 1)))
                (run (make-instance 'task :name "run" :thread-fun (lambda () (values 1 2))))
                (empty (make-instance 'task :name "empty")))
            (list (later made) (task-path made) (later empty) (multiple-value-list (join-task run)) *notes*)))""") == (
        "(:CREATED ((A) (B)) :CREATED (1 2) NIL)"
    )


def test_the_path_of_a_task_is_by_default_that_of_the_form_that_starts_it(lisp):
    assert (
        lisp("""
        (def-cram-function step-one () (task-path (let ((task (in-child 1))) (join-task task) task)))
        (top-level (step-one))""")
        == "((STEP-ONE))"
    )


def test_task_and_toplevel_task_have_a_common_parent_and_are_not_of_each_others_type(lisp):
    assert (
        lisp("""
        (let ((task (make-instance 'task)) (root (make-instance 'toplevel-task)))
          (list (typep task 'task) (typep task 'toplevel-task) (typep root 'task) (typep root 'toplevel-task)
                (typep task 'cpl-impl::abstract-task) (typep root 'cpl-impl::abstract-task)
                (subtypep 'task 'cpl-impl::abstract-task)))""")
        == "(T NIL NIL T T T T)"
    )


def test_a_program_may_make_subclasses_of_task(lisp):
    assert (
        lisp("""
        (defclass named-task (task) ((purpose :initarg :purpose :initform :none :reader purpose)))
        (defmethod evaporate :before ((task named-task) &key reason sync) (declare (ignore reason sync)) (note (purpose task)))
        (top-level
          (let ((task (make-instance 'named-task :name "n" :purpose :fun :thread-fun (lambda () (sleep 10)))))
            (sleep 1)
            (evaporate task)
            (list (type-of task) (purpose task) (later task) *notes*)))""")
        == "(NAMED-TASK :FUN :EVAPORATED (:FUN))"
    )


def test_the_requests_are_generic_functions_and_say_what_they_cannot_be_called_with(lisp):
    for function in ("evaporate", "suspend", "wake-up", "join-task", "status", "result"):
        assert lisp(f"(typep #'{function} 'generic-function)") == "T"
        assert "no applicable method for the generic function" in lisp.error(f"({function} 5)")
    assert (
        lisp("""
        (defclass robot () ())
        (defmethod suspend ((robot robot) &key reason sync) (list :held reason sync))
        (suspend (make-instance 'robot) :reason "why" :sync nil)""")
        == '(:HELD "why" NIL)'
    )


@pytest.mark.parametrize("request_", ["evaporate", "suspend", "wake-up"])
def test_a_reason_is_nil_or_a_string(lisp, request_):
    assert lisp.error(f"({request_} (make-instance 'task) :reason :because)") == "The value :BECAUSE is not of type (OR NULL STRING)"


def test_a_task_prints_its_name_and_with_verbosity_its_status(lisp):
    assert re.fullmatch(r'#<TASK "A" \{[0-9A-F]+\}>', lisp('(make-instance \'task :name "A")'))
    assert re.fullmatch(r'#<TOPLEVEL-TASK "A" \{[0-9A-F]+\}>', lisp('(make-instance \'toplevel-task :name "A")'))
    assert re.fullmatch(
        r'"#<TASK \\"A\\" :CREATED \{[0-9A-F]+\}>"',
        lisp('(let ((*task-pprint-verbosity* 1)) (prin1-to-string (make-instance \'task :name "A")))'),
    )
    assert re.fullmatch(r'"UNKNOWN-\d+"', lisp("(name (make-instance 'task))"))


@pytest.mark.law(40)
def test_the_status_is_a_value_fluent_named_after_the_task(lisp):
    assert re.fullmatch(
        r'\(T T :CREATED "WORK-STATUS\d+" NIL\)',
        lisp("""
        (let* ((task (make-instance 'task :name "WORK")) (fluent (status task)))
          (list (typep fluent 'value-fluent) (cl:eq fluent (status task)) (value fluent) (princ-to-string (name fluent))
                (symbol-package (name fluent))))"""),
    )


def test_the_lists_of_statuses_and_the_type(lisp):
    assert lisp("(list +alive+ +dead+ +done+)") == (
        "((:CREATED :RUNNING :WAITING :SUSPENDED) (:FAILED :SUCCEEDED :EVAPORATED) (:SUCCEEDED :EVAPORATED))"
    )
    assert (
        lisp(
            "(mapcar (lambda (status) (typep status 'status-indicator)) '(:created :running :suspended :succeeded :failed "
            ":evaporated :waiting nil))"
        )
        == "(T T T T T T NIL NIL)"
    )


def test_the_readers_answer_for_created_running_and_dead_tasks(lisp):
    asks = """(flet ((ask (task)
                       (list (value (task-alive task)) (value (task-dead task)) (task-running-p task) (task-dead-p task)
                             (task-done-p task) (task-failed-p task) (multiple-value-list (result task)))))"""
    assert lisp(asks + " (ask (make-instance 'task)))") == "((:CREATED :RUNNING :WAITING :SUSPENDED) NIL T NIL NIL NIL NIL)"
    assert lisp(asks + " (top-level (ask (current-task))))") == "((:RUNNING :WAITING :SUSPENDED) NIL T NIL NIL NIL NIL)"
    assert lisp(asks + " (top-level (let ((task (in-child 7))) (join-task task) (ask task))))") == (
        "(NIL (:SUCCEEDED :EVAPORATED) NIL T T NIL (7))"
    )
    assert lisp(asks + " (let ((task (make-instance 'task))) (evaporate task) (ask task)))") == "(NIL (:EVAPORATED) NIL T T NIL NIL)"
    assert lisp(asks + ' (top-level (let ((task (in-child (fail "x")))) (sleep 1) (butlast (ask task)))))') == (
        "(NIL (:FAILED :SUCCEEDED :EVAPORATED) NIL T NIL T)"
    )


def test_outside_of_plans_current_task_is_a_fresh_dummy_that_is_running(lisp):
    assert (
        lisp("""
        (list *current-task* *current-path* *task-tree* (later (current-task)) (name (current-task)) (type-of (current-task))
              (eq (current-task) (current-task)))""")
        == '(NIL NIL NIL :RUNNING "main" TOPLEVEL-TASK NIL)'
    )


def test_executed_tasks_are_saved_in_order_while_the_variable_says_so(lisp):
    assert lisp("""
        (cpl-impl:clear-saved-tasks)
        (let ((*save-tasks* t)) (top-level (par 1 (par 2))))
        (top-level (par 1))
        (let ((names (mapcar #'name (list-saved-tasks))) (same (equal (cut:list-queue-contents *tasks*) (list-saved-tasks))))
          (cpl-impl:clear-saved-tasks)
          (list (mapcar (lambda (name) (subseq name 0 (position #\\- name :from-end t))) names) same (list-saved-tasks)))""") == (
        '(("[TOP-LEVEL]" "[PAR-CHILD-#1/2]" "[PAR-CHILD-#2/2]" "[PAR-CHILD-#1/1]") T NIL)'
    )


def test_tv_closure_binds_the_task_variables_as_they_are_seen_when_it_is_made(lisp):
    assert (
        lisp("""
        (define-task-variable *v* :global)
        (let ((closure (let ((*v* :bound)) (tv-closure (make-instance 'task) nil (lambda (&rest all) (list* *v* all))))))
          (list (funcall closure 1 2) *v*))""")
        == "((:BOUND 1 2) :GLOBAL)"
    )


@pytest.mark.law(62)
def test_define_task_variable_has_all_its_keywords(lisp):
    assert (
        lisp("""
        (define-task-variable *depth* 0 "How deep." :type integer :init-function (lambda (task parent value)
                                                                                   (declare (ignore task parent)) (1+ value)))
        (list *depth* (documentation '*depth* 'variable) (top-level (par (par *depth*))))""")
        == '(0 "How deep." 3)'
    )
    assert lisp.error("(setf *depth* :a)") == "The value :A is not of type INTEGER"
    assert lisp.error("(define-task-variable *d* 0 nil :colour :red)") == (
        "DEFINE-TASK-VARIABLE has no option :COLOUR: it has :TYPE, :INIT-FUNCTION, :IGNORE-PACKAGE-LOCKS."
    )
    assert (
        lisp("""
        (define-task-variable cl:*print-base* 10 nil :ignore-package-locks t)
        (let ((*print-base* 2)) (top-level (prin1-to-string 5)))""")
        == '"101"'
    )


def test_an_init_function_gets_the_task_its_parent_and_the_value_that_the_parent_sees(lisp):
    assert (
        lisp("""
        (defun seen (task parent value) (note (later task) (if parent (later parent) parent) value) value)
        (define-task-variable *w* 1 nil :init-function 'seen)
        (top-level (setf *w* 2) (par 1))
        *notes*""")
        == "((:CREATED NIL 1) (:CREATED :RUNNING 2))"
    )


@pytest.mark.law(55)
@pytest.mark.parametrize("where", ["(top-level {})", "{}"])
def test_sleep_takes_any_real_and_returns_nil(lisp, where):
    for seconds, passed in (("1/2", 0.5), ("2", 2), ("0.25", 0.25), ("1.5d0", 1.5), ("0", 0), ("-3", 0)):
        before = kernel.now()
        assert lisp(where.format(f"(sleep {seconds})")) == "NIL"
        assert kernel.now() - before == pytest.approx(passed, abs=0.011)
    assert "not of type" in lisp.error(where.format('(sleep "a")')) and "not of type" in lisp.error(where.format("(sleep #c(1 2))"))


# ------------------------------------------------------------------------------- requests to tasks that are not there (yet)


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("end, status", [("1", ":SUCCEEDED"), ("(fail)", ":FAILED"), ("(evaporate (current-task))", ":EVAPORATED")])
@pytest.mark.parametrize("where", ["{}", "(top-level {})"])
def test_no_call_on_a_dead_task_hangs_or_changes_anything(lisp, end, status, where):
    lisp(f"(defvar *dead* nil) (ignore-errors (top-level (setf *dead* (in-child {end})) (sleep 1)))")
    calls = """(progn (suspend *dead*) (wake-up *dead*) (evaporate *dead*) (evaporate *dead*) (suspend *dead* :sync nil)
                      (wait-for (task-dead *dead*))
                      (with-failure-handling ((plan-failure (e) (declare (ignore e)) (return))) (join-task *dead*))
                      (later *dead*))"""
    assert lisp(where.format(calls)) == status
    assert lisp("(multiple-value-list (top-level (with-task-suspended (*dead*) (values 1 2))))") == "(1 2)"


def test_a_request_to_suspend_a_task_that_is_not_started_is_obeyed_at_its_first_waiting_point(lisp):
    assert (
        lisp("""
        (let ((task (make-instance 'task :run-thread nil :thread-fun (lambda () (note :begins) (sleep 1) (note :goes-on)))))
          (suspend task)
          (note (later task))
          (top-level
            (execute task)
            (sleep 5)
            (note (later task))
            (wake-up task)
            (join-task task))
          *notes*)""")
        == "(:CREATED :BEGINS :SUSPENDED :GOES-ON)"
    )


def test_a_request_that_was_taken_back_before_the_start_is_forgotten(lisp):
    lisp("""
        (let ((task (make-instance 'task :run-thread nil :thread-fun (lambda () (sleep 1)))))
          (suspend task) (wake-up task)
          (top-level (execute task) (join-task task)))""")
    assert kernel.now() == 1


def test_a_task_evaporated_before_it_is_executed_never_runs_and_whoever_executes_it_goes_on(lisp):
    assert (
        lisp("""
        (let ((task (make-instance 'task :run-thread nil :thread-fun (lambda () (note :ran)))))
          (evaporate task)
          (note (later task))
          (top-level (execute task) (note (multiple-value-list (join-task task))))
          (top-level
            (with-tags
              (evaporate step)
              (note (multiple-value-list (:tag step (note :ran) 1)))
              (note (multiple-value-list (:tag step (note :again) 2)))))
          *notes*)""")
        == "(:EVAPORATED NIL NIL :AGAIN (2))"
    )


def test_a_task_that_suspends_itself_stops_at_its_next_waiting_point(lisp):
    assert (
        lisp("""
        (top-level
          (let ((task (in-child (suspend (current-task) :sync nil) (note :before) (sleep 1) (note :after))))
            (sleep 5)
            (note (later task))
            (wake-up task)
            (join-task task)))
        *notes*""")
        == "(:BEFORE :SUSPENDED :AFTER)"
    )
    assert (
        lisp("""
        (setf *notes* nil)
        (top-level
          (let ((task (in-child (suspend (current-task)) (note :after))))
            (sleep 5)
            (note (later task))
            (wake-up task)
            (join-task task)))
        *notes*""")
        == "(:SUSPENDED :AFTER)"
    )


def test_an_endless_loop_without_waits_can_be_suspended_and_evaporated(lisp):
    assert (
        lisp("""
        (top-level
          (let* ((count 0) (task (in-child (loop (incf count)))) (before 0))
            (sleep 1)
            (suspend task)
            (setf before count)
            (sleep 10)
            (note (= before count) (plusp count))
            (wake-up task)
            (sleep 1)
            (evaporate task)
            (note (> count before) (later task))))
        *notes*""")
        == "((T T) (T :EVAPORATED))"
    )


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("sync", ["t", "nil"])
def test_requests_work_from_callbacks_of_fluents_and_from_outside_of_plans(lisp, sync):
    assert (
        lisp(f"""
        (defvar *door* (make-fluent))
        (defvar *task* (make-instance 'toplevel-task :name "aside" :thread-fun
                         (lambda () (unwind-protect (sleep 100) (sleep 1) (note :cleanup)))))
        (sleep 1)
        (register-update-callback *door* 'guard (lambda (value) (funcall value *task* :sync {sync})))
        (setf (value *door*) #'suspend) (sleep 1) (note (later *task*))
        (setf (value *door*) #'wake-up) (sleep 1) (note (later *task*))
        (setf (value *door*) #'evaporate) (sleep 2) (note (later *task*))
        *notes*""")
        == "(:SUSPENDED :RUNNING :CLEANUP :EVAPORATED)"
    )


def test_a_failure_inside_of_without_scheduling_or_of_a_callback_is_a_failure(lisp):
    """Repaired: in the original it can become none (defect 23)."""
    assert lisp.error('(top-level (par (without-scheduling (fail "protected"))))') == "protected"
    assert (
        lisp.error("""
        (let ((door (make-fluent)))
          (register-update-callback door 'guard (lambda (value) (declare (ignore value)) (fail "guarded")))
          (top-level (par (setf (value door) 1))))""")
        == "guarded"
    )


def test_the_same_plan_function_may_be_called_twice_at_once(lisp):
    assert lisp("(def-cram-function f (x) (sleep 1) x) (multiple-value-list (top-level (par (f 1) (f 2) (f 3))))") == "(1)"
    assert kernel.now() == 1


def test_the_saved_tasks_are_in_a_queue_that_a_binding_replaces(lisp):
    assert (
        lisp("""
        (cpl-impl:clear-saved-tasks)
        (let ((*save-tasks* t) (*tasks* (cut:make-queue :name "mine")))
          (top-level (par 1))
          (list (cut:queue-name *tasks*) (cut:queue-count *tasks*)))""")
        == '("mine" 2)'
    )
    assert lisp("(list-saved-tasks)") == "NIL"


def test_a_task_has_the_slots_of_the_original(lisp):
    assert (
        lisp("""
        (top-level
          (let ((task (make-instance 'task :thread-fun (lambda () 1) :run-thread nil :name "t")))
            (list (slot-value task 'cpl-impl::name) (slot-value task 'cpl-impl::thread) (slot-value task 'cpl-impl::parent-task)
                  (typep (slot-value task 'cpl-impl::status) 'fluent) (functionp (slot-value task 'cpl-impl::thread-fun))
                  (slot-exists-p task 'cpl-impl::code))))""")
        == '("t" NIL NIL T T T)'
    )


@pytest.mark.parametrize("body", ["(list 1)", "(fail)", "(progn (evaporate *current-task*) (sleep 1))"])
def test_the_thread_of_a_task_returns_whatever_became_of_the_task(lisp, body):
    assert (
        lisp(f"""
        (let (task)
          (handler-case (top-level (par (progn (setf task *current-task*) {body})))
            (plan-failure () nil))
          (let ((thread (slot-value task 'cpl-impl::thread)))
            (list (equal (cut:thread-name thread) (name task)) (cut:thread-alive-p thread) (multiple-value-list (cut:join-thread thread))
                  (and (search "FINISHED" (princ-to-string thread)) t))))""")
        == "(T NIL NIL T)"
    )


def test_the_thread_of_a_task_that_kill_thread_ended_is_aborted(lisp):
    assert (
        lisp("""
        (let (thread)
          (top-level (pursue (progn (setf thread (cut:current-thread)) (sleep 5))
                             (progn (sleep 1) (cut:kill-thread thread) (sleep 1))))
          (list (cut:join-thread thread :on-failure :gone) (and (search "ABORTED" (princ-to-string thread)) t)))""")
        == "(:GONE T)"
    )
