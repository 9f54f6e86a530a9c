"""Tags, the task tree, plan functions and goals: invariants 98 to 106 of cpl.md section 16, as text that a user writes."""

import pytest

PATHS = "(defun paths (tree) (mapcar #'task-tree-node-path (flatten-task-tree tree)))"


# --------------------------------------------------------------------------------------------------------------------- tags


@pytest.mark.law(98)
def test_a_tag_variable_is_a_created_task_before_its_form_runs_and_dead_afterwards(plan_text):
    assert (
        plan_text("""(top-level (with-tags
        (let ((before (value (status a))))
          (par (:tag a (sleep 2)) (seq (sleep 1) (note (value (status a)))))
          (list before *notes* (value (status a)) (task-path a)))))""")
        == "(:CREATED (:RUNNING) :SUCCEEDED ((TAGGED A)))"
    )
    assert plan_text("(top-level (with-tags (when nil (:tag never 1)) (value (status never))))") == ":CREATED"


@pytest.mark.law(98)
def test_a_tag_returns_its_values_and_fails_with_its_failure(plan_text):
    assert plan_text("(top-level (with-tags (:tag a (values 1 2))))") == "1 ; 2"
    assert (
        plan_text("""(top-level (with-tags (handler-case (:tag a (fail "stuck"))
                                                (plan-failure (e) (format nil "~a" e)))))""")
        == '"stuck"'
    )


@pytest.mark.law(99)
def test_running_a_tag_again_makes_a_new_task_at_the_next_path_and_the_variable_names_it(plan_text):
    assert plan_text("""(top-level (with-tags
        (let ((tasks (list a)))
          (dotimes (i 2) (:tag a i) (pushnew a tasks))
          (:tag a :again)
          (pushnew a tasks)
          (list (mapcar #'task-path (reverse tasks)) (mapcar (lambda (task) (value (status task))) tasks) (result a)))))""") == (
        "((((TAGGED A)) ((TAGGED A :CALL 2)) ((TAGGED A :CALL 3))) (:SUCCEEDED :SUCCEEDED :SUCCEEDED) :AGAIN)"
    )


@pytest.mark.law(99)
def test_tags_in_one_with_tags_lie_side_by_side_and_an_inner_with_tags_lies_in_its_tag(plan_text):
    assert plan_text("(top-level (with-tags (:tag a (:tag b 1)) (task-path b)))") == "((TAGGED B))"
    assert plan_text("(top-level (with-tags (:tag a (with-tags (:tag b 1) (task-path b)))))") == "((TAGGED B) (TAGGED A))"


def test_a_tag_of_an_inner_with_tags_is_none_of_the_outer_one(plan_text):
    assert plan_text(PATHS + "(top-level (with-tags (with-tags (:tag b 1)) (:tag a 1) (paths *task-tree*)))") == (
        "(NIL ((TAGGED B)) ((TAGGED A)))"
    )


def test_tags_that_macros_make_are_found_global_and_local_ones(plan_text):
    plan_text("(defun step-form (name) (list :tag name '(note 1))) (defmacro step-of (name) (step-form name))")
    assert plan_text("(top-level (with-tags (step-of a) (dolist (x '(1)) (step-of b)) (list (task-path a) (task-path b))))") == (
        "(((TAGGED A)) ((TAGGED B)))"
    )
    assert plan_text("""(top-level (with-tags (macrolet ((local (name) `(:tag ,name (note 2)))) (local c)) (task-path c)))""") == (
        "((TAGGED C))"
    )
    assert plan_text("(top-level (with-tags (flet ((step-of (x) x)) (step-of 5))))") == "5"
    assert plan_text("(top-level (let ((a :mine)) (with-tags '(:tag a 1) a)))") == ":MINE"


def test_a_tag_in_a_symbol_macro_and_in_the_default_of_a_parameter_is_found(plan_text):
    assert plan_text("""(top-level (with-tags (symbol-macrolet ((now (:tag a (note 1)))) now)
                                     ((lambda (&optional (x (:tag b 2))) (list x (task-path a) (task-path b))))))""") == (
        "(2 ((TAGGED A)) ((TAGGED B)))"
    )


def test_the_hooks_of_a_tag_get_its_task_and_their_id(plan_text):
    from cramhy_runtime.cpl import hooks

    seen = []
    begin = hooks.on_begin_execute_tag_task.add(lambda task: (seen.append(task.path.car.cdr.car.name), len(seen))[1])
    finish = hooks.on_finish_execute_tag_task.add(lambda id: seen.append(id))
    try:
        plan_text("(top-level (with-tags (handler-case (:tag a (fail)) (plan-failure () (:tag b 1)))))")
    finally:
        hooks.on_begin_execute_tag_task.remove(begin)
        hooks.on_finish_execute_tag_task.remove(finish)
    assert seen == ["A", 1, "B", 3]


# ----------------------------------------------------------------------------------------------------------- plan functions


@pytest.mark.law(100)
def test_a_plan_function_called_twice_in_one_context_has_two_nodes(plan_text):
    assert plan_text(
        PATHS
        + """(def-cram-function f (x) (values x *current-path*))
        (def-cram-function g () (f 3) (f 4))
        (top-level (f 1) (f 2) (g) (paths *task-tree*))"""
    ) == ("(NIL ((G)) ((F :CALL 2) (G)) ((F) (G)) ((F :CALL 2)) ((F)))")
    assert plan_text("(top-level (f 1))") == "1 ; ((F))"


def test_a_plan_function_keeps_its_documentation_declarations_and_parameters(plan_text):
    assert (
        plan_text("""(def-cram-function f (x &optional (y 2) &key z) "Drives." (declare (type integer x)) (list x y z))
        (top-level (values (f 1) (f 1 3 :z 4) (documentation 'f 'function)))""")
        == '(1 2 NIL) ; (1 3 4) ; "Drives."'
    )
    assert "invalid number of arguments: 0" in plan_text.error("(top-level (f))")
    assert (
        plan_text("""(top-level (handler-case (f) (error () :same-task)
                                     (common-lisp-error-envelope (e) (type-of (envelop-error e)))))""")
        == "SB-INT:SIMPLE-PROGRAM-ERROR"
    )


def test_the_name_of_a_plan_function_tells_that_it_is_a_plan_also_when_its_file_was_loaded_from_the_cache(plan_text, tmp_path):
    properties = "(mapcar (lambda (property) (get 'f property)) '(cpl-impl:plan-type cpl-impl:plan-lambda-list cpl-impl:plan-sexp))"
    file = tmp_path / "plans.lisp"
    package = plan_text.session.package.name
    file.write_text(f'(in-package :{package})\n(def-cram-function f (x) "doc" (print x) (f x))\n(def-top-level-cram-function top () 1)')
    for _ in range(2):
        plan_text("(setf (symbol-plist 'f) nil (symbol-plist 'top) nil)")
        plan_text(f'(load "{file}")')
        assert plan_text(properties) == "(:PLAN (X) ((PRINT X) (F X)))"
        assert plan_text("(get 'top 'cpl-impl:plan-type)") == ":TOP-LEVEL-PLAN"


def test_defining_a_top_level_plan_calls_its_hook(plan_text):
    from cramhy_runtime.cpl import hooks

    seen = []
    method = hooks.on_def_top_level_plan_hook.add(lambda name: seen.append(name.name))
    try:
        plan_text("(def-top-level-cram-function lecture () 1) (def-cram-function drive () 1)")
    finally:
        hooks.on_def_top_level_plan_hook.remove(method)
    assert seen == ["LECTURE"]


def test_a_top_level_plan_function_opens_a_top_level_of_its_name(plan_text):
    assert (
        plan_text(
            PATHS
            + """(def-top-level-cram-function lecture (x) (values x *current-path*))
        (lecture 1)"""
        )
        == "1 ; ((TOP-LEVEL LECTURE))"
    )
    assert plan_text("(paths (get-top-level-task-tree 'lecture))") == "(NIL ((TOP-LEVEL LECTURE)))"
    assert "top-level calls cannot be nested." in plan_text.error("(top-level (lecture 1))")


@pytest.mark.parametrize(
    "old, new, call", [("DEF-PLAN", "DEF-CRAM-FUNCTION", "(top-level (f))"), ("DEF-TOP-LEVEL-PLAN", "DEF-TOP-LEVEL-CRAM-FUNCTION", "(f)")]
)
def test_the_old_names_of_plan_definitions_work_and_are_warned_of_at_their_place(plan_text, old, new, call, capsys):
    assert (
        plan_text(f"""(handler-bind ((style-warning (lambda (w) (note (format nil "~a" w)) (muffle-warning w))))
                           (macroexpand-1 '({old} f () 1)))
                         *notes*""")
        == f'("Use of deprecated form {old}. Please use {new} instead.")'
    )
    capsys.readouterr()
    assert plan_text(f"({old} f ()\n  7)\n{call}") == "7"
    told = capsys.readouterr().err
    assert f"Use of deprecated form {old}. Please use {new} instead.\n;   at <repl>:1:1\n" in told


def test_return_from_leaves_a_plan_function_and_return_from_a_branch_does_not(plan_text):
    assert (
        plan_text("(def-cram-function f (x) (dolist (y '(1 2)) (when (= x y) (return-from f (values y :found)))) :none)(top-level (f 2))")
        == "2 ; :FOUND"
    )
    assert plan_text.error("(def-cram-function g () (par (return-from g 1))) (top-level (g))").startswith(
        "cramhy: SB-INT:SIMPLE-CONTROL-ERROR\n  A branch of a plan tried to leave a form around it, by RETURN-FROM, RETURN, GO or THROW."
    )


def test_what_the_caller_binds_dynamically_is_not_seen_in_the_body(plan_text):
    assert (
        plan_text("""(defvar *height* 1) (def-cram-function f () *height*)
        (top-level (let ((*height* 2)) (list *height* (f) (par *height*) (with-tags (:tag a *height*)))))""")
        == "(2 1 1 1)"
    )


# --------------------------------------------------------------------------------------------------------------- task tree


@pytest.mark.law(101)
def test_the_tree_of_a_named_top_level_survives_and_what_the_next_run_leaves_out_is_stale(plan_text):
    assert plan_text(
        PATHS
        + """(def-cram-function f () 1) (def-cram-function g () 2)
        (defun run (both) (named-top-level (:name lecture) (f) (when both (g)) (f)))
        (run t)
        (let* ((tree (get-top-level-task-tree 'lecture)) (node (task-tree-node '((g)) tree)))
          (run nil)
          (list (paths tree) (eq tree (get-top-level-task-tree 'lecture)) (eq node (task-tree-node '((g)) tree))
                (mapcar #'stale-task-tree-node-p (rest (flatten-task-tree tree)))))"""
    ) == ("((NIL ((F :CALL 2)) ((G)) ((F))) T T (NIL T NIL))")
    assert (
        plan_text("""(let ((tree (get-top-level-task-tree 'lecture))) (remove-top-level-task-tree 'lecture)
                          (eq tree (get-top-level-task-tree 'lecture)))""")
        == "NIL"
    )


@pytest.mark.law(101)
def test_a_node_tells_what_ran_there_with_what_and_what_came_of_it(plan_text):
    assert plan_text("""(def-cram-function f (x y) (+ x y))
        (named-top-level (:name lecture) (f 1 2) (handler-case (f 3 nil) (common-lisp-error-envelope () nil)))
        (let* ((tree (get-top-level-task-tree 'lecture)) (node (task-tree-node '((f)) tree)) (second (task-tree-node '((f :call 2)) tree)))
          (list (task-tree-node-parameters node) (value (task-tree-node-status-fluent node)) (task-tree-node-result node)
                (code-sexp (task-tree-node-code node)) (eq (task-tree-node-parent node) tree)
                (mapcar #'car (task-tree-node-children tree)) (value (task-tree-node-status-fluent second))
                (type-of (task-tree-node-result second)) (task-tree-node-parameters second)))""") == (
        "((1 2) :SUCCEEDED 3 (REPLACEABLE-FUNCTION F (X Y) (+ X Y)) T ((F :CALL 2) (F)) :FAILED COMMON-LISP-ERROR-ENVELOPE (3 NIL))"
    )
    assert (
        plan_text("""(let ((node (task-tree-node '((f)) (clear-tasks (get-top-level-task-tree 'lecture)))))
        (list (task-tree-node-parameters node) (task-tree-node-status-fluent node) (task-tree-node-result node)
              (code-sexp (task-tree-node-code node)) (stale-task-tree-node-p node)))""")
        == "(NIL NIL NIL NIL T)"
    )


@pytest.mark.law(102)
def test_a_replacement_is_used_by_the_next_and_all_later_runs_and_the_original_is_stale_meanwhile(plan_text):
    plan_text("""(def-cram-function f (x) (list :original x)) (defun run () (named-top-level (:name lecture) (f 1)))
        (defun node () (task-tree-node '((f)) (get-top-level-task-tree 'lecture)))""")
    assert plan_text("(run)") == "(:ORIGINAL 1)"
    plan_text("(replace-task-code '(first) (lambda (x) (list :first x)) '((f)) (get-top-level-task-tree 'lecture))")
    assert plan_text("(list (run) (run))") == "((:FIRST 1) (:FIRST 1))"
    assert plan_text("(list (stale-task-tree-node-p (node)) (task-tree-node-result (node)) (task-tree-node-status-fluent (node)))") == (
        "(T NIL NIL)"
    )
    plan_text("(replace-task-code '(second) (lambda (x) (list :second x)) '((f)) (get-top-level-task-tree 'lecture))")
    assert plan_text("(run)") == "(:SECOND 1)"
    assert plan_text("(mapcar #'code-sexp (cpl-impl:task-tree-node-code-replacements (node)))") == "((SECOND) (FIRST))"
    assert plan_text("(code-sexp (task-tree-node-effective-code (node)))") == "(SECOND)"
    plan_text("(setf (cpl-impl:task-tree-node-code-replacements (node)) nil)")
    assert plan_text("(list (run) (stale-task-tree-node-p (node)))") == "((:ORIGINAL 1) NIL)"


def test_a_tag_can_be_replaced_and_code_can_be_registered_before_it_is_reached(plan_text):
    assert (
        plan_text("""(replace-task-code nil (lambda () :replaced) '((tagged a)) (get-top-level-task-tree 'lecture))
        (named-top-level (:name lecture) (with-tags (:tag a :original)))""")
        == ":REPLACED"
    )
    assert plan_text("""(top-level (let ((task (sub-task '((tagged b)))))
        (register-task-code '(registered) (lambda () :registered) :path '((tagged b)))
        (register-task-code nil (lambda () :too-late) :path '((tagged b)))
        (with-tags (list (eq b task) (:tag b :original) (code-sexp (task-tree-node-code (task-tree-node '((tagged b)))))))))""") == (
        "(T :REGISTERED (REGISTERED))"
    )


@pytest.mark.law(103)
def test_the_flat_tree_has_every_executed_path_once_parents_before_children_and_the_newest_child_first(plan_text):
    shown = plan_text(
        PATHS
        + """(def-cram-function leaf () (note *current-path*))
        (def-cram-function twig () (note *current-path*) (par (leaf) (:tag a (leaf)) (leaf)))
        (top-level (twig) (leaf) (twig)
          (let ((found (paths *task-tree*)))
            (list (length found) (length (remove-duplicates found :test #'equal)) (every (lambda (path)
                (find path found :test #'equal)) *notes*)
                  (loop for path in (rest found) always (cl:< (position (rest path) found :test #'equal)
                      (position path found :test #'equal)))
                  (mapcar #'car (remove-if #'cdr (rest found))))))"""
    )
    assert shown == "(12 12 T T ((TWIG :CALL 2) (LEAF) (TWIG)))"


def test_filter_task_tree_copies_what_satisfies_the_predicate_and_drops_the_rest_with_all_below(plan_text):
    plan_text(
        PATHS
        + """(def-cram-function a () 1) (def-cram-function b () (a)) (def-cram-function c () (b) (a))
        (named-top-level (:name lecture) (c))"""
    )
    assert plan_text("""(let* ((tree (get-top-level-task-tree 'lecture))
                               (copy (filter-task-tree (lambda (node) (not (equal (first (task-tree-node-path node)) '(b)))) tree)))
        (list (paths copy) (eq copy tree) (eq (task-tree-node-code (task-tree-node '((c)) copy)) (task-tree-node-code
            (task-tree-node '((c)) tree)))
              (eq copy (task-tree-node-parent (task-tree-node '((c)) copy))) (length (paths tree))))""") == (
        "((NIL ((C)) ((A) (C))) NIL T T 5)"
    )
    assert "The assertion (FUNCALL PREDICATE TREE) failed." in plan_text.error(
        "(filter-task-tree #'identity (filter-task-tree (lambda (n) (declare (ignore n)) nil) (get-top-level-task-tree 'lecture)))"
    )


def test_a_task_tree_node_prints_its_path_and_count_on_lines_of_their_own_if_one_is_too_short(plan_text):
    plan_text("""(def-cram-function drive-to-the-kitchen () 1)
        (named-top-level (:name lecture) (with-tags (:tag a 1) (drive-to-the-kitchen)))""")
    assert plan_text('(let ((*print-pretty* nil)) (subseq (format nil "~s" (get-top-level-task-tree \'lecture)) 0 43))') == (
        '"#<TASK-TREE-NODE :PATH NIL :CHILD-COUNT 2 {"'
    )
    [shown] = plan_text.session.evaluate_text("""(let ((*print-pretty* t) (*print-right-margin* 50))
        (format nil "~s" (task-tree-node '((drive-to-the-kitchen)) (get-top-level-task-tree 'lecture))))""")
    assert str(shown).rpartition("{")[0] == "#<TASK-TREE-NODE\n  :PATH ((DRIVE-TO-THE-KITCHEN))\n  :CHILD-COUNT 0 "
    assert (
        plan_text("""(let ((cpl-impl:*task-tree-node-print-path* :one) (cpl-impl:*task-tree-node-print-children* nil)
                              (cpl-impl:*task-tree-node-print-identity* nil))
        (format nil "~s" (task-tree-node '((tagged a)) (get-top-level-task-tree 'lecture))))""")
        == '"#<TASK-TREE-NODE :PATH (TAGGED A)>"'
    )


def test_nodes_and_codes_can_be_made_copied_and_changed_like_structures(plan_text):
    assert (
        plan_text("""(let* ((node (make-task-tree-node :path '((a)) :code (cpl-impl:make-code :sexp '(x) :parameters '(1))))
                              (copy (cpl-impl:copy-task-tree-node node)))
        (setf (task-tree-node-children node) (list (cons '(b) copy)) (code-sexp (task-tree-node-code node)) '(y))
        (list (task-tree-node-p node) (task-tree-node-p 1) (typep node 'task-tree-node) (typep (task-tree-node-code node) 'code)
              (task-tree-node-path copy) (code-sexp (task-tree-node-code copy)) (code-parameters (task-tree-node-code copy))
              (eq copy (task-tree-node '((b)) node)) (task-tree-node-children copy)))""")
        == "(T NIL T T ((A)) (Y) (1) T NIL)"
    )


def test_with_task_tree_node_runs_its_body_at_a_path_of_its_own_with_parameters(plan_text):
    assert plan_text("""(top-level (with-task-tree-node (:path-part '(foo 1) :name "FOO" :sexp '(bar) :lambda-list
        (a b) :parameters (list 1 2))
        (values (list a b) *current-path* (code-sexp (task-tree-node-code (task-tree-node *current-path*))))))""") == (
        "(1 2) ; ((FOO 1)) ; (BAR)"
    )
    assert (
        plan_text("""(top-level (list (replaceable-function f (x) (list 1) '(f) (+ x 1)) (code-sexp (task-tree-node-code
        (task-tree-node '((f)))))))
        """)
        == "(2 (REPLACEABLE-FUNCTION F (X) (+ X 1)))"
    )


def test_the_hooks_of_a_node_get_what_is_to_be_logged(plan_text):
    from cramhy_runtime.cpl import hooks
    from cramhy_runtime.lisp_core.data import list_from
    from cramhy_runtime.languages.commonlisp.printer.printer import princ_to_string

    seen = []
    begin = hooks.on_preparing_task_execution.add(lambda *facts: (seen.append(princ_to_string(list_from(facts))), 5)[1])
    finish = hooks.on_finishing_task_execution.add(lambda id: seen.append(id))
    try:
        plan_text("""(declare-goal at (x y)) (def-goal (at (loc ?x) ?y) (list ?x ?y))
            (top-level (with-task-tree-node (:path-part '(foo) :name "FOO" :lambda-list (a) :parameters '(1) :log-parameters '((:a 1))
                                             :log-pattern '(:a)) a)
                       (at '(loc 1) 2))""")
    finally:
        hooks.on_preparing_task_execution.remove(begin)
        hooks.on_finishing_task_execution.remove(finish)
    assert seen[0] == "(FOO ((A 1)) (A) (A) (1))" and seen[1] == seen[3] == 5
    assert seen[2].endswith(" ((LOC 1) 2) ((LOC ?X) ?Y) (?Y ?X) (2 1))")


# -------------------------------------------------------------------------------------------------------------------- goals


@pytest.mark.law(104)
def test_the_first_goal_body_that_matches_wins_and_redefining_one_keeps_its_place(plan_text):
    assert plan_text("""(declare-goal at (where) "Being there.")
        (def-goal (at kitchen) :kitchen) (def-goal (at ?x) (list :general ?x)) (def-goal (at hall) :never)
        (top-level (list (at 'kitchen) (at 'hall) (at 5) (documentation 'at 'function)))""") == (
        '(:KITCHEN (:GENERAL HALL) (:GENERAL 5) "Being there.")'
    )
    assert plan_text("""(handler-bind ((style-warning (lambda (w) (note (format nil "~a" w)) (muffle-warning w))))
                          (def-goal (at kitchen) :new-kitchen))
        (list *notes* (top-level (at 'kitchen)) (top-level (at 'hall)))""") == (
        '(("Redefining goal `(AT KITCHEN)\'") :NEW-KITCHEN (:GENERAL HALL))'
    )
    plan_text("(declare-goal at (where))")
    assert "No goal found that matches arguments: AT (KITCHEN)" in plan_text.error("(top-level (at 'kitchen))")


@pytest.mark.law(105)
def test_return_in_declare_goal_suppresses_the_bodies_and_succeed_gives_all_its_values(plan_text):
    assert (
        plan_text("""(declare-goal at (x) (note :asked) (when (eql x 1) (return (values :there :already))))
        (def-goal (at ?x) (note :body) (dolist (y '(1 2)) (flet ((leave () (succeed ?x y))) (leave))) :never)
        (top-level (at 1))""")
        == ":THERE ; :ALREADY"
    )
    assert plan_text("(top-level (at 2))") == "2 ; 1"
    assert plan_text("*notes*") == "(:ASKED :ASKED :BODY)"
    assert plan_text("(declare-goal on ()) (def-goal (on) (succeed)) (top-level (multiple-value-list (on)))") == "NIL"


@pytest.mark.soak(all_but=4)
@pytest.mark.law(106)
@pytest.mark.parametrize(
    "pattern, call, bindings",
    [
        ("(loc ?x ?y)", "'(loc 1 2)", "((?Y . 2) (?X . 1))"),
        ("?x", "'(a (b . c))", "((?X A (B . C)))"),
        ("kitchen", "'kitchen", "NIL"),
        ("!?x ?y", "1 2 3", "((?Y . 3))"),
        ("cut:?_ ?y", "1 2", "((?Y . 2) (?_ . ?_))"),
        ("", "", "NIL"),
    ],
)
def test_a_goal_node_tells_the_goal_as_it_was_called_and_what_its_variables_stood_for(plan_text, pattern, call, bindings):
    assert plan_text(f"""(declare-goal gg (&rest all)) (def-goal (gg {pattern}) :done)
        (named-top-level (:name lecture) (gg {call}))
        (let ((node (second (flatten-task-tree (get-top-level-task-tree 'lecture)))))
          (list (equal (goal-task-tree-node-goal node) (list 'gg {call})) (goal-task-tree-node-p node)
                (equal (goal-task-tree-node-pattern node) '(gg {pattern})) (goal-task-tree-node-parameter-bindings node)
                (equal (task-tree-node-path node) '((goal (gg {pattern}))))))""").replace("CRAM-UTILITIES:", "") == (
        f"(T T T {bindings} T)"
    )


@pytest.mark.law(106)
def test_performing_a_designator_is_a_goal_too(plan_text):
    assert (
        plan_text("""(defun performed (tree) (second (flatten-task-tree tree)))
        (named-top-level (:name lecture) (handler-case (exe:perform (desig:a motion (type driving))) ((or error plan-failure) () nil)))
        (let ((node (performed (get-top-level-task-tree 'lecture))))
          (list (first (goal-task-tree-node-goal node)) (typep (second (goal-task-tree-node-goal node)) 'desig:motion-designator)
                (length (goal-task-tree-node-parameter-bindings node))))""")
        == "(CRAM-EXECUTIVE:PERFORM T 1)"
    )


@pytest.mark.law(106)
def test_only_goals_are_goals(plan_text):
    plan_text("(named-top-level (:name lecture) (with-tags (:tag a 1)))")
    assert plan_text("(mapcar #'goal-task-tree-node-p (flatten-task-tree (get-top-level-task-tree 'lecture)))") == "(NIL NIL)"
    assert "The assertion (GOAL-TASK-TREE-NODE-P NODE) failed." in plan_text.error(
        "(goal-task-tree-node-pattern (get-top-level-task-tree 'lecture))"
    )


def test_a_goal_body_may_have_tags_declarations_and_a_doc_string_which_describe_goal_finds(plan_text):
    assert plan_text("""(declare-goal at (x y) (declare (ignore y)) x)
        (def-goal (at ?x ?unused) "Drive there." (declare (ignore ?unused)) (:tag drive (note ?x)) (task-path drive))
        (top-level (list (at 1 2) (describe-goal '(at ?a ?b)) (describe-goal '(at 1 ?b))))""") == (
        '(((TAGGED DRIVE) (GOAL (AT ?X ?UNUSED))) "Drive there." NIL)'
    )


def test_a_segment_variable_matches_but_is_not_bound_in_the_body(plan_text):
    assert plan_text("(declare-goal at (&rest all)) (def-goal (at !?before here !?after) :here) (top-level (at 1 2 'here 3))") == ":HERE"
    assert "The variable !?BEFORE is unbound." in plan_text.error("(def-goal (at !?before there) !?before) (top-level (at 'there))")


def test_a_goal_body_can_be_registered_as_a_function_of_the_bindings(plan_text):
    assert (
        plan_text("""(declare-goal at (x)) (register-goal 'at '(?x) (lambda (bindings) (list :got bindings)) "By hand.")
        (top-level (list (at 3) (describe-goal '(at ?z))))""")
        == '((:GOT ((?X . 3))) "By hand.")'
    )


def test_make_task_gives_the_waiting_task_of_a_node_and_that_of_the_next_repetition_once_it_was_executed(plan_text):
    assert plan_text("""(def-cram-function f () (task-path (make-task :function (lambda () 1))))
        (top-level (let ((first (make-task :name "FIRST" :path '((a)) :sexp '(x) :function #'list :parameters '(1 2))))
          (let ((same (make-task :path '((a)))))
            (cpl-impl:execute first)
            (list (eq first same) (name first) (multiple-value-list (join-task first)) (task-path first)
                  (code-sexp (task-tree-node-code (task-tree-node '((a))))) (task-path (make-task :path '((a)))) (f)))))""") == (
        '(T "FIRST" ((1 2)) ((A)) (X) ((A :CALL 2)) ((F :CALL 2)))'
    )


def test_a_task_named_by_its_path_can_be_waited_for_before_its_code_is_known(plan_text):
    assert (
        plan_text("""(def-cram-function fetch () (sleep 2) :fetched)
        (top-level (par (join-task (task '((fetch))))
                        (seq (sleep 1) (note (value (status (sub-task '((fetch)))))) (fetch))))""")
        == ":FETCHED"
    )
    assert plan_text("*notes*") == "(:CREATED)"
