"""``top-level`` and the control operators: invariants 78 to 97 of cpl.md section 16, as text that a user writes.

Law 93 is the repaired one: a ring of orderings is refused, and one that cannot be seen beforehand is reported as a deadlock.
"""

import pytest

from cramhy_runtime import cpl, kernel

TASKS = """(defun state (task) (value (status task)))
           (defmacro watching ((&rest names) &body body)
             `(with-tags (handler-case (progn ,@body) (plan-failure (e) (note (format nil "~a" e)))) (mapcar #'state (list ,@names))))"""
"""``(watching (a b) form...)``: run the forms, whose tags are a and b; the states of these tasks afterwards."""


# ---------------------------------------------------------------------------------------------------------------- top-level


@pytest.mark.law(78)
@pytest.mark.parametrize(
    "body, values", [("1", "1"), ("", "NIL"), ("(values 1 2)", "1 ; 2"), ("(values)", ""), ("1 2 (values nil t)", "NIL ; T")]
)
def test_top_level_returns_all_values_of_its_body(plan_text, body, values):
    assert plan_text(f"(top-level {body})") == plan_text(f"(named-top-level (:name x) {body})") == values


@pytest.mark.law(78)
def test_a_nested_top_level_is_an_error_that_its_task_can_handle(plan_text):
    assert plan_text('(top-level (handler-case (top-level 1) (error (e) (format nil "~a" e))))') == '"top-level calls cannot be nested."'
    assert (
        plan_text("""(top-level (with-failure-handling ((error (e) (return (format nil "~a" e))))
                          (par (named-top-level (:name x) 1))))""")
        == '"top-level calls cannot be nested."'
    )


@pytest.mark.law(78)
def test_two_flows_of_control_can_each_run_a_top_level():
    results = []
    others = [kernel.spawn(lambda n=n: results.append(cpl.top_level(lambda: (cpl.sleep(1), n)[1]))) for n in range(2)]
    for other in others:
        other.join()
    assert sorted(results) == [0, 1] and kernel.now() == 1


def test_two_runs_of_one_name_at_a_time_would_share_a_tree_and_the_second_is_refused(plan_text):
    name = plan_text.session.package.intern("LECTURE")
    first = kernel.spawn(lambda: cpl.named_top_level(lambda: (cpl.sleep(2), "first")[1], name))
    kernel.sleep(1)
    assert (
        plan_text.error("(named-top-level (:name lecture) 2)")
        == """cramhy: SIMPLE-ERROR
  A top-level named LECTURE is running already.
  at <repl>:1:1
    (named-top-level (:name lecture) 2)
    ^
  Two runs of one name would share, and disturb, one task tree: wait until the other has ended, or name this one differently.
"""
    )
    assert plan_text("(named-top-level (:name other) 3)") == "3"
    first.join()
    assert kernel.now() == 2 and plan_text("(named-top-level (:name lecture) 4)") == "4"


@pytest.mark.parametrize(
    "body, ends", [("(note :body)", "(:BODY)"), ("(seq (note :body) (fail))", "(:BODY)"), ("(seq (note :body) (car 1))", "(:BODY)")]
)
def test_the_hooks_of_a_top_level_run_in_order_around_its_body_however_it_ends(plan_text, body, ends):
    from cramhy_runtime.cpl import hooks
    from cramhy_runtime.lisp_core.data import lisp_list
    from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

    seen = []
    notes = plan_text.session.package.intern("*NOTES*")

    def at(name, result=None):
        def method(*arguments):
            seen.append((name, *[prin1_to_string(argument).split()[0] for argument in arguments], prin1_to_string(notes.value)))
            return result

        return method

    methods = [
        (hooks.on_preparing_named_top_level, at("preparing", 7)),
        (hooks.on_top_level_setup_hook, at("setup", lisp_list(None))),
        (hooks.on_finishing_named_top_level, at("finishing")),
        (hooks.on_top_level_cleanup_hook, at("cleanup")),
    ]
    for hook, method in methods:
        hook.add(method)
    try:
        plan_text(f"(handler-case (named-top-level (:name lecture) {body}) ((or error plan-failure) ()))")
    finally:
        for hook, method in methods:
            hook.remove(method)
    assert seen == [
        ("preparing", "LECTURE", "NIL"),
        ("setup", "LECTURE", "#<TASK-TREE-NODE", "NIL"),
        ("finishing", "7", ends),
        ("cleanup", "LECTURE", ends),
    ]


def test_what_the_setup_hook_binds_reaches_the_plan_if_it_is_a_task_variable(plan_text):
    from cramhy_runtime.cpl import hooks
    from cramhy_runtime.lisp_core.data import lisp_list

    plan_text("(define-task-variable *speed* 1) (defvar *plain* 1)")
    speed, plain = (plan_text.session.package.intern(name) for name in ("*SPEED*", "*PLAIN*"))
    method = hooks.on_top_level_setup_hook.add(lambda name, tree: lisp_list(lisp_list(speed, plain), 5, 5))
    try:
        assert plan_text("(list (top-level (par (list *speed* *plain*))) *speed* *plain*)") == "((5 1) 1 1)"
    finally:
        hooks.on_top_level_setup_hook.remove(method)


def test_handlers_around_a_top_level_run_before_it_is_finished_and_may_try_it_again(plan_text):
    assert (
        plan_text("""(let ((n 0))
                          (with-failure-handling ((plan-failure (e) (note e) (when (< n 3) (retry))))
                            (incf n)
                            (top-level (if (< n 3) (fail "no") n))))""")
        == "3"
    )


def test_the_tasks_of_a_plan_are_named_after_their_forms(plan_text):
    assert plan_text("""(defun kind (task) (let ((name (name task))) (subseq name 0 (1+ (position #\\] name)))))
        (def-cram-function drive () (kind (current-task)))
        (declare-goal at ()) (def-goal (at) (kind (current-task)))
        (list (top-level (kind (current-task)))
              (named-top-level (:name lecture) (kind (current-task)))
              (top-level (par (kind (current-task)) 2))
              (top-level (pursue 1 2 (kind (current-task))))
              (top-level (try-all (kind (current-task))))
              (top-level (drive)) (top-level (at))
              (top-level (with-task (:name "LOOK") (kind (current-task))))
              (top-level (with-task-tree-node (:path-part '(x)) (kind (current-task)))))""") == (
        '("[TOP-LEVEL]" "[LECTURE-TOP-LEVEL]" "[PAR-CHILD-#1/2]" "[PURSUE-CHILD-#3/3]" "[TRY-ALL-CHILD-#1/1]" '
        '"[REPLACEABLE-FUNCTION-DRIVE]" "[GOAL-AT]" "[LOOK]" "[WITH-TASK-TREE-NODE]")'
    )


# -------------------------------------------------------------------------------------------------------------- seq and par


@pytest.mark.law(80)
def test_seq_and_a_sequence_of_tags_are_strictly_sequential(plan_text):
    assert (
        plan_text("""(top-level (seq (seq (sleep 1) (note 1)) (note 2) (seq)))
                        (top-level (with-tags (:tag a (sleep 1) (note :a)) (:tag b (note :b))))
                        *notes*""")
        == "(1 2 :A :B)"
    )
    assert plan_text("(seq)") == "NIL" and plan_text("(seq 1 (values 2 3))") == "2 ; 3"
    assert plan_text.error('(seq (note :before) (fail "x") (note :never))').startswith(
        "cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n  x\n"
    )
    assert plan_text("*notes*") == "(1 2 :A :B :BEFORE)"


@pytest.mark.law(81)
def test_par_runs_its_forms_at_once(plan_text):
    assert (
        plan_text("""(let ((ball (make-fluent :value 0)))
                          (flet ((play (mine yours)
                                   (loop repeat 10 do (wait-for (fl-funcall #'eql ball mine)) (setf (value ball) yours))
                                   mine))
                            (top-level (par (play 0 1) (play 1 0)))))""")
        == "0"
    )


@pytest.mark.law(82)
@pytest.mark.parametrize("first", [1, 2, 3])
def test_par_returns_when_all_have_ended_with_the_values_of_its_first_form(plan_text, first):
    others = [2 * first, 3, 1]
    assert (
        plan_text(
            f"(top-level (par (seq (sleep {first}) (note 1) (values :one :two)) (seq (sleep {others[0]}) (note 2)) "
            "(seq (sleep 3) (note 3))))"
        )
        == ":ONE ; :TWO"
    )
    assert plan_text("(sort *notes* #'cl:<)") == "(1 2 3)" and kernel.now() == max(first, others[0], 3)


@pytest.mark.law(82)
def test_a_first_form_that_somebody_evaporated_gives_par_no_values(plan_text):
    assert plan_text("(top-level (with-tags (multiple-value-list (par (:tag a (sleep 9) 1) (seq (sleep 1) (evaporate a) 2)))))") == "NIL"


@pytest.mark.law(82)
def test_a_suspended_form_counts_as_running(plan_text):
    assert (
        plan_text("""(top-level (with-tags
        (par (:tag a (sleep 2) (note :a) :first) (seq (sleep 1) (suspend a) (note :suspended) (sleep 5) (note :waking) (wake-up a)))))
        """)
        == ":FIRST"
    )
    assert plan_text("*notes*") == "(:SUSPENDED :WAKING :A)"


@pytest.mark.law(83)
def test_a_failing_form_fails_par_and_ends_the_others_in_the_middle_of_their_work(plan_text):
    assert (
        plan_text(
            TASKS
            + """(top-level (watching (quick slow deep failing)
        (par (:tag quick (sleep 1) (note :quick))
             (:tag slow (sleep 10) (note :slow))
             (par (:tag deep (sleep 10) (note :deep)))
             (:tag failing (sleep 2) (fail "no fuel")))))"""
        )
        == "(:SUCCEEDED :EVAPORATED :EVAPORATED :FAILED)"
    )
    assert plan_text("*notes*") == '(:QUICK "no fuel")'


@pytest.mark.law(84)
def test_of_several_simultaneous_failures_par_reports_that_of_the_last_form(plan_text):
    assert (
        plan_text("""(top-level (handler-case (par (fail "a") (fail "b") (fail "c")) (plan-failure (e) (format nil "~a" e))))
                     """)
        == '"c"'
    )
    assert (
        plan_text("""(top-level (handler-case (par (fail "a") (seq (sleep 1) (fail "b"))) (plan-failure (e) (format nil "~a" e))))
                     """)
        == '"a"'
    )


@pytest.mark.law(97)
def test_all_children_have_started_before_the_first_decision(plan_text):
    for form in ("par", "pursue"):
        plan_text(f'(setf *notes* nil) (top-level (handler-case ({form} (fail "at once") (note 2) (note 3)) (plan-failure () nil)))')
        assert plan_text("(sort *notes* #'cl:<)") == "(2 3)"
    assert plan_text("(setf *notes* nil) (top-level (try-all (note 1) (note 2) (note 3))) (sort *notes* #'cl:<)") == "(1 2 3)"


# --------------------------------------------------------------------------------------------------------- pursue and try-all


@pytest.mark.law(85)
def test_pursue_returns_the_values_of_a_form_that_ended_when_all_others_are_dead_and_cleaned_up(plan_text):
    assert plan_text(
        TASKS
        + """(top-level (let (states)
        (with-tags
          (let ((values (multiple-value-list
                          (pursue (:tag slow (unwind-protect (sleep 10) (sleep 1) (note :cleaned-up)))
                                  (:tag stuck (loop))
                                  (:tag quick (sleep 1) (values 1 2))))))
            (list values *notes* (mapcar #'state (list slow stuck quick)))))))"""
    ) == ("((1 2) (:CLEANED-UP) (:EVAPORATED :EVAPORATED :SUCCEEDED))")
    assert plan_text("(top-level (pursue 1 2 3))") == "3"


@pytest.mark.law(85)
def test_a_form_of_pursue_that_somebody_evaporated_is_done_without_values(plan_text):
    """Repaired: the original raises an assertion about :SUCCEEDED and :EVAPORATED."""
    assert (
        plan_text("""(top-level (with-tags (pursue (:tag a (sleep 9))
                                                      (seq (sleep 1) (evaporate a) (sleep 9)))))""")
        == ""
    )
    assert kernel.now() == 1


@pytest.mark.law(86)
def test_pursue_fails_with_a_form_even_if_another_one_ends_at_the_same_time(plan_text):
    for forms in ('1 (fail "x")', '(fail "x") 1', '(seq (sleep 1) 1) (seq (sleep 1) (fail "x"))'):
        assert plan_text(f'(top-level (handler-case (pursue {forms} (sleep 9)) (plan-failure (e) (format nil "~a" e))))') == '"x"'
    assert plan_text(
        TASKS
        + """(top-level (watching (winner failing busy)
        (pursue (:tag winner (sleep 1) 1) (:tag failing (sleep 1) (fail "x")) (:tag busy (sleep 9)))))"""
    ) in ("(:SUCCEEDED :FAILED :EVAPORATED)", "(:SUCCEEDED :EVAPORATED :EVAPORATED)", "(:EVAPORATED :FAILED :EVAPORATED)")


@pytest.mark.law(87)
def test_try_all_succeeds_with_the_first_success_whatever_failed_before(plan_text):
    assert (
        plan_text("""(top-level (try-all (fail "a") (seq (sleep 1) (fail "b")) (seq (sleep 2) (values :c :d))
                                            (unwind-protect (sleep 9) (note :ended))))""")
        == ":C ; :D"
    )
    assert kernel.now() == 2 and plan_text("*notes*") == "(:ENDED)"
    assert plan_text("(top-level (try-all 1 2 3))") == "1"


@pytest.mark.law(88)
def test_try_all_of_failures_has_run_all_and_lists_each_the_last_form_first(plan_text):
    assert (
        plan_text("""(top-level (handler-case (try-all (seq (sleep 2) (note 1) (fail "a")) (seq (note 2) (fail "b"))
                                                          (seq (sleep 1) (note 3) (car 5)))
        (composite-failure (e) (mapcar (lambda (f) (type-of (if (typep f 'common-lisp-error-envelope) (envelop-error f) f)))
                                       (composite-failures e)))))""")
        == "(TYPE-ERROR SIMPLE-PLAN-FAILURE SIMPLE-PLAN-FAILURE)"
    )
    assert plan_text("*notes*") == "(2 3 1)"


# ------------------------------------------------------------------------------------------------ try-in-order and par-loop


@pytest.mark.law(89)
def test_try_in_order_runs_nothing_after_a_success_and_lists_failures_in_order(plan_text):
    assert plan_text('(top-level (try-in-order (fail "a") (values 2 3) (note :never)))') == "2 ; 3"
    assert (
        plan_text("""(top-level (handler-case (try-in-order (fail "a") (fail "b") (fail "c"))
        (composite-failure (e) (mapcar (lambda (f) (format nil "~a" f)) (composite-failures e)))))""")
        == '("a" "b" "c")'
    )
    assert plan_text("""(top-level (handler-case (try-in-order) (composite-failure (e) (composite-failures e))))""") == "NIL"
    assert plan_text("*notes*") == "NIL"


@pytest.mark.law(89)
def test_return_leaves_the_innermost_of_the_forms_with_a_block_named_nil(plan_text):
    assert plan_text("(top-level (list (try-in-order (return 1) (note 2))))") == "(1)"
    assert plan_text("(top-level (list (try-each-in-order (x '(1 2)) (return (list x :left)))))") == "((1 :LEFT))"
    assert plan_text("(top-level (dolist (x '(1 2)) (try-in-order (return x) 5) (note x)))") == "NIL"
    assert plan_text("(top-level (dolist (x '(1 2)) (with-failure-handling () (return x)) (note x)))") == "NIL"
    assert plan_text("(top-level (list (with-failure-handling () (try-in-order (return 1)) 2)))") == "(2)"
    assert plan_text("*notes*") == "(1 2 1 2)"


@pytest.mark.law(90)
def test_try_each_in_order_tries_elements_until_one_succeeds(plan_text):
    assert plan_text("""(top-level (try-each-in-order (x '(1 2 3 4)) (note x) (if (< x 3) (fail "no") (values :got x))))""") == ":GOT ; 3"
    assert plan_text("*notes*") == "(1 2 3)"
    assert (
        plan_text("""(top-level (handler-case (try-each-in-order (x '(1 2)) (fail "no ~a" x))
        (composite-failure (e) (mapcar (lambda (f) (format nil "~a" f)) (composite-failures e)))))""")
        == '("no 1" "no 2")'
    )
    assert plan_text("(top-level (handler-case (try-each-in-order (x '()) 1) (composite-failure (e) (composite-failures e))))") == "NIL"


@pytest.mark.law(91)
def test_nested_composites_stay_nested(plan_text):
    assert (
        plan_text("""(defun shape (f) (if (typep f 'composite-failure) (mapcar #'shape (composite-failures f)) (format nil "~a" f)))
        (top-level (handler-case (try-in-order (fail "a") (try-all (fail "b") (try-in-order (fail "c") (fail "d"))))
                     (composite-failure (e) (shape e))))""")
        == '("a" (("c" "d") "b"))'
    )


@pytest.mark.law(96)
def test_par_loop_runs_its_body_once_for_each_element_all_at_once(plan_text):
    assert plan_text("(top-level (par-loop (x '(3 1 2)) (sleep x) (note x) (values x :more)))") == "3 ; :MORE"
    assert plan_text("*notes*") == "(1 2 3)" and kernel.now() == 3
    assert (
        plan_text("""(top-level (handler-case (par-loop (x '(1 2)) (when (= x 2) (fail "two")))
                                     (plan-failure (e) (format nil "~a" e))))""")
        == '"two"'
    )


@pytest.mark.law(96)
def test_par_loop_over_nothing_runs_its_body_once_with_nil_as_in_the_original(plan_text):
    assert plan_text("(top-level (par-loop (x '()) (note x) (list x)))") == "(NIL)" and plan_text("*notes*") == "(NIL)"


# -------------------------------------------------------------------------------------------------------------- partial-order


@pytest.mark.law(92)
def test_a_constrained_step_starts_after_all_that_it_waits_for_and_the_others_do_not_wait(plan_text):
    assert (
        plan_text("""(top-level (with-tags
        (partial-order ((:tag last (note :last) (values :first-form 2))
                        (:tag a (sleep 2) (note :a))
                        (:tag b (sleep 1) (note :b))
                        (note :free))
          (:order a last)
          (:order b last))))""")
        == ":FIRST-FORM ; 2"
    )
    assert plan_text("*notes*") == "(:FREE :B :A :LAST)"


@pytest.mark.soak(all_but=3)
@pytest.mark.law(92)
@pytest.mark.parametrize("end", ["1", "(with-failure-handling ((plan-failure (e) (return e))) (fail))", "(evaporate first)"])
def test_dead_in_whatever_way_is_enough(plan_text, end):
    plan_text(f"""(top-level (with-tags (partial-order ((:tag next (note :next))
                                                       (par (:tag first (sleep 5)) (seq (sleep 1) (note :end) {end})))
                               (:order first next))))""")
    assert plan_text("*notes*") == "(:END :NEXT)" and kernel.now() == (1 if "evaporate" in end else 5)


@pytest.mark.law(92)
def test_a_step_whose_predecessor_fails_never_runs_its_body(plan_text):
    assert (
        plan_text(
            TASKS
            + """(top-level (watching (first next)
        (partial-order ((:tag next (note :never)) (:tag first (sleep 1) (fail "first")))
          (:order first next))))"""
        )
        == "(:FAILED :EVAPORATED)"
    )
    assert plan_text("*notes*") == '("first")'


@pytest.mark.law(92)
def test_steps_can_be_named_by_their_paths_before_they_are_known(plan_text):
    assert (
        plan_text("""(def-cram-function fetch () (sleep 1) (note :fetch))
        (top-level (with-tags (partial-order ((:tag serve (note :serve)) (fetch))
          (:order (sub-task '((fetch))) serve))))
        (top-level (with-tags (partial-order ((:tag serve (note :serve)) (fetch))
          (:order (task '((fetch))) (task '((tagged serve)))))))
        *notes*""")
        == "(:FETCH :SERVE :FETCH :SERVE)"
    )


@pytest.mark.law(94)
def test_a_constrained_task_is_running_while_it_waits(plan_text):
    assert (
        plan_text(
            TASKS
            + """(top-level (with-tags (partial-order ((:tag next (note :next)) (:tag first (sleep 2))
                                                                      (seq (sleep 1) (note (state next))))
                                  (:order first next)))) *notes*"""
        )
        == "(:RUNNING :NEXT)"
    )


@pytest.mark.law(95)
def test_an_ordering_by_a_fluent_releases_the_step_at_its_pulse_or_at_once_if_it_was_pulsed_before(plan_text):
    assert (
        plan_text("""(let ((ready (make-fluent)))
        (top-level (with-tags (partial-order ((:tag go (note :go)) (seq (sleep 2) (note :pulse) (pulse ready)))
                     (:order ready go))))
        (top-level (with-tags (partial-order ((:tag go (note :at-once)) (seq (sleep 1) (note :later))) (:order ready go)))))
        *notes*""")
        == "(:PULSE :GO :AT-ONCE :LATER)"
    )


# ----------------------------------------------------------------------------------------------- with-parallel-childs, with-task


def test_the_watcher_of_one_child_looks_twice_and_leaves_by_return(plan_text):
    assert (
        plan_text("""(top-level (with-parallel-childs nil (running done failed) ((seq (sleep 1) (values 1 2)))
                          (note (mapcar #'length (list running done failed)))
                          (when done (return (result (first done))))))""")
        == "1 ; 2"
    )
    assert plan_text("*notes*") == "((1 0 0) (0 1 0))"


@pytest.mark.parametrize(
    "forms, pictures",
    [
        ("1", "((1 0 0) (0 1 0))"),
        ("(sleep 1) (sleep 2) (sleep 3)", "((3 0 0) (3 0 0) (3 0 0) (2 1 0) (1 2 0) (0 3 0))"),
        ("(sleep 1) (seq (sleep 2) (fail))", "((2 0 0) (2 0 0) (1 1 0) (0 1 1))"),
    ],
)
def test_the_watcher_looks_once_for_each_change_of_each_child(plan_text, forms, pictures):
    assert (
        plan_text(f"""(top-level (with-parallel-childs nil (running done failed) ({forms})
                           (note (mapcar #'length (list running done failed)))
                           (unless running (return *notes*))))""")
        == pictures
    )


def test_a_watcher_that_never_leaves_waits_for_ever_which_is_told(plan_text):
    shown = plan_text.error("(top-level (with-parallel-childs nil (running done failed) (1) (list running done failed)))")
    assert shown.startswith("cramhy: CRAMHY::DEADLOCK\n") and "waits for a change of its children" in shown


def test_the_watcher_gets_its_children_the_last_form_first_and_what_is_left_of_them_ends_with_it(plan_text):
    assert (
        plan_text("""(top-level (with-parallel-childs "PAR" (running done failed)
                                     ((unwind-protect (sleep 9) (note :ended)) (seq (sleep 1) 2) (fail "c") 4)
                          (when (= 2 (length done))
                            (return (list (mapcar #'result done) (length running) (length failed))))))""")
        == "((4 2) 1 1)"
    )
    assert plan_text("*notes*") == "(:ENDED)" and kernel.now() == 1


def test_with_task_runs_its_body_in_a_task_of_the_class_and_name_given(plan_text):
    assert (
        plan_text("""(defclass drive-task (task) ())
        (top-level (with-task (:class 'drive-task :name "DRIVE") (values (type-of (current-task)) (subseq (name (current-task)) 0 7))))
        """)
        == 'DRIVE-TASK ; "[DRIVE]"'
    )
    assert plan_text("(top-level (with-task () (subseq (name (current-task)) 0 11)))") == '"[WITH-TASK]"'
