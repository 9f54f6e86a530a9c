"""Plans that are wrong: what ``cramhy run`` prints of them, with the place and what to try, and that nothing is left behind."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.operators import PLAN_LANGUAGE
from cramhy_runtime.languages.operators.grammar import WrongShape, match

OUTSIDE = """cramhy: SIMPLE-ERROR
  '{0}' form not inside a plan.
  at plan.lisp:2:3
      {1}
      ^
  Plan forms run inside of a plan: write (top-level ({2} ...)).
"""
PLAN_FORMS = {
    "PAR": "(par 1 2)",
    "PURSUE": "(pursue 1 2)",
    "TRY-ALL": "(try-all 1 2)",
    "TRY-IN-ORDER": "(try-in-order 1 2)",
    "TRY-EACH-IN-ORDER": "(try-each-in-order (x '(1)) x)",
    "PARTIAL-ORDER": "(partial-order (1 2))",
    "PAR-LOOP": "(par-loop (x '(1)) x)",
    "WITH-TAGS": "(with-tags (:tag a 1) 2)",
    "WITH-TASK-SUSPENDED": "(with-task-suspended (nil) 1)",
    "WITH-TASK": "(with-task () 1)",
    "PURSUE of a policy": "(with-policy timeout-policy (2) 1)",
}
TREE_NODE = """cramhy: TYPE-ERROR
  The value
    NIL
  is not of type
    TASK-TREE-NODE
  (A plan function, goal or tag was used outside of a plan: call it inside (top-level ...), or from a function defined with \
def-top-level-cram-function.)
  at plan.lisp:{0}
"""


def nothing_runs():
    return [task for task in kernel.active().tasks if task is not kernel.current()] == []


@pytest.mark.soak(all_but=5)
@pytest.mark.law(79)
@pytest.mark.parametrize("form", PLAN_FORMS)
def test_a_plan_form_outside_of_a_plan_says_so_in_its_own_name(plan_text, form):
    text = PLAN_FORMS[form]
    name = form.split()[0]
    assert plan_text.run(f"(defun drive ()\n  {text})\n(drive)") == OUTSIDE.format(name, text + ")", name.lower())


@pytest.mark.law(79)
@pytest.mark.parametrize(
    "form, value",
    [
        ("(seq 1 2)", "2"),
        ("(with-failure-handling ((plan-failure (e) (return e))) 1)", "1"),
        ("(with-retry-counters ((c 1)) (get-counter c))", "1"),
        ("(sleep 1)", "NIL"),
    ],
)
def test_what_needs_no_plan_works_anywhere(plan_text, form, value):
    assert plan_text(form) == value


@pytest.mark.law(78)
def test_a_nested_top_level_is_an_error_of_the_task_and_closes_the_plan_around_it(plan_text):
    assert (
        plan_text.run("""(defun drive ()
  (top-level (note :driven)))

(top-level
  (unwind-protect
      (par (unwind-protect (sleep 5)
             (note :branch-closed))
           (drive))
    (note :closed)))""")
        == """cramhy: SIMPLE-ERROR
  top-level calls cannot be nested.
  at plan.lisp:2:3
      (top-level (note :driven)))
      ^
  This form runs inside a plan already: leave TOP-LEVEL away here, or make what is called a plan function with DEF-CRAM-FUNCTION.
"""
    )
    assert plan_text("*notes*") == "(:BRANCH-CLOSED :CLOSED)" and nothing_runs()


def test_an_unknown_step_in_an_ordering_is_named_and_starts_nothing(plan_text):
    assert (
        plan_text.run("""(top-level
  (unwind-protect
      (with-tags
        (partial-order ((:tag pick (note :pick))
                        (:tag place (note :place)))
          (:order grasp place)))
    (note :closed)))""")
        == """cramhy: UNBOUND-VARIABLE
  The variable GRASP is unbound.
  at plan.lisp:6:19
              (:order grasp place)))
                      ^
  In (:ORDER before after) a step is a task: the name of a tag in the WITH-TAGS around, (task path) or (sub-task path).
"""
    )
    assert plan_text("*notes*") == "(:CLOSED)" and nothing_runs()


@pytest.mark.parametrize(
    "ordering, value, wanted, more",
    [
        ("(:order a 5)", "5", "TASK", ""),
        ("(:order (list 1) a)", "(1)", "(OR TASK VALUE-FLUENT)", " The first may be a value fluent."),
        ("(:order (fl+ (make-fluent :value 1) 1) a)", None, "(OR TASK VALUE-FLUENT)", ""),
    ],
)
def test_what_is_no_task_cannot_be_ordered(plan_text, ordering, value, wanted, more):
    shown = plan_text.run(f"""(top-level
  (with-tags
    (partial-order ((:tag a (note :a)))
      {ordering.replace("fl+", "cpl-impl:fl+")})))""")
    if value is not None:
        assert (
            shown
            == f"""cramhy: TYPE-ERROR
  The value
    {value}
  is not of type
    {wanted}
  (In (:ORDER before after) a step is a task: the name of a tag in the WITH-TAGS around, (task path) or (sub-task path).{more})
  at plan.lisp:3:5
        (partial-order ((:tag a (note :a)))
        ^
"""
        )
    else:
        assert wanted in shown
    assert plan_text("*notes*") == "NIL"


@pytest.mark.law(93)
def test_a_ring_of_orderings_is_named_before_a_step_starts(plan_text):
    assert (
        plan_text.run("""(top-level
  (unwind-protect
      (with-tags
        (partial-order ((:tag pick (note :pick))
                        (:tag place (note :place))
                        (:tag look (note :look))
                        (note :free))
          (:order pick place)
          (:order place look)
          (:order look pick)))
    (note :closed)))""")
        == """cramhy: SIMPLE-ERROR
  The orderings of PARTIAL-ORDER form a ring, so none of its steps could ever start: PLACE waits for PICK, PICK waits for LOOK, \
LOOK waits for PLACE.
  at plan.lisp:4:9
            (partial-order ((:tag pick (note :pick))
            ^
  Take one of these orderings away.
"""
    )
    assert plan_text("*notes*") == "(:CLOSED)" and nothing_runs()


@pytest.mark.law(93)
def test_a_step_that_waits_for_itself_is_a_ring(plan_text):
    assert "could ever start: A waits for itself." in plan_text.error(
        "(top-level (with-tags (partial-order ((:tag a 1) (:tag b 2)) (:order b a) (:order a a))))"
    )


@pytest.mark.law(93)
def test_a_ring_leaves_no_ordering_behind(plan_text):
    assert (
        plan_text("""(top-level
      (with-tags
        (handler-case (partial-order ((:tag a 1)) (:order a b) (:order b a))
          (error () (partial-order ((:tag a (note :a)) (:tag b (note :b)))
                      (:order b a))))
        *notes*))""")
        == "(:B :A)"
    )


@pytest.mark.law(93)
def test_a_ring_through_an_earlier_form_is_seen_as_long_as_its_steps_have_not_begun(plan_text):
    assert "A waits for B, B waits for A" in plan_text.error("""(top-level
      (with-tags
        (par (partial-order ((:tag b 1)) (:order a b))
             (partial-order ((:tag a 2)) (:order b a)))))""")


@pytest.mark.law(93)
def test_a_ring_through_a_step_of_a_step_is_reported_as_a_deadlock_with_what_everybody_waits_for(plan_text):
    shown = plan_text.run("""(top-level
  (with-tags
    (par (:tag a (partial-order ((:tag c (note :c)))
                   (:order d c)))
         (:tag d (wait-for (task-dead a))))))""")
    assert shown.startswith("cramhy: CRAMHY::DEADLOCK\n  Nothing can happen any more: every task waits")
    assert "[TAG-C]-" in shown and "at plan.lisp:3:34" in shown
    assert plan_text("*notes*") == "NIL" and nothing_runs()


@pytest.mark.parametrize("form", ["(par)", "(pursue)", "(try-all)", "(partial-order ())"])
def test_a_parallel_form_without_branches_closes_the_plan_in_order(plan_text, form):
    assert (
        plan_text.run(f"""(top-level
  (unwind-protect
      (pursue (unwind-protect (sleep 10)
                (note :branch-closed))
              (seq (sleep 1)
                   {form}))
    (note :closed)))""")
        == f"""cramhy: SIMPLE-ERROR
  wait-for called with nil argument.
  at plan.lisp:6:20
                       {form}))
                       ^
  There is no branch to wait for: {"PAR" if "partial" in form else form[1:-1].upper()} needs one form at least.
"""
    )
    assert plan_text("*notes*") == "(:BRANCH-CLOSED :CLOSED)" and nothing_runs()


@pytest.mark.parametrize("ordering", ["(:before a b)", "(:order a)", "(:order a b c)", "a"])
def test_a_malformed_ordering_is_an_error_of_the_expansion(plan_text, ordering):
    shown = ordering.upper()
    assert (
        plan_text.run(f"""(top-level
  (with-tags
    (partial-order ((:tag a 1) (:tag b 2))
      {ordering})))""")
        == f"""cramhy: CRAMHY::COMPILE-ERROR
  Malformed ordering constraint.
  at plan.lisp:3:5
        (partial-order ((:tag a 1) (:tag b 2))
        ^
  Instead of {shown} write (:order before after).
"""
    )


def test_a_tag_outside_of_with_tags_is_an_error_of_the_expansion(plan_text):
    assert (
        plan_text.run("""(defun drive ()
  (par (print 1)
       (:tag pick 2)))""")
        == """cramhy: CRAMHY::COMPILE-ERROR
  (:TAG PICK ..) used outside of WITH-TAGS.
  at plan.lisp:3:8
           (:tag pick 2)))
           ^
  Put (with-tags ...) around the forms that use the tag; the body of a plan function or goal is in one already.
"""
    )


@pytest.mark.parametrize(
    "text, place, line",
    [
        ("(def-cram-function drive (x) x)\n(defun main ()\n  (drive 1))\n(main)", "3:3", "(drive 1))"),
        ("(declare-goal drive (x))\n(def-goal (drive ?x) ?x)\n(defun main ()\n  (drive 1))\n(main)", "4:3", "(drive 1))"),
        ("(defun main ()\n  (with-task-tree-node (:path-part '(a)) 1))\n(main)", "2:3", "(with-task-tree-node (:path-part '(a)) 1))"),
    ],
)
def test_a_plan_function_or_goal_outside_of_a_plan_is_a_type_error_at_its_call(plan_text, text, place, line):
    assert plan_text.run(text) == TREE_NODE.format(place) + f"      {line}\n      ^\n"


def test_a_goal_without_a_body_for_its_arguments_names_the_patterns_that_it_has(plan_text):
    assert (
        plan_text.run("""(declare-goal at (x))
(def-goal (at kitchen) :there)
(def-goal (at (place ?x) !?more) ?x)
(top-level
  (par (at 'table) 2))""")
        == """cramhy: SIMPLE-ERROR
  No goal found that matches arguments: AT (TABLE)
  at plan.lisp:5:8
      (par (at 'table) 2))
           ^
  Bodies are defined for (AT KITCHEN), (AT (PLACE ?X) !?MORE).
"""
    )
    assert plan_text.error("(declare-goal off (x)) (top-level (off 1))").endswith("  No body is defined: write (def-goal (off ...) ...).\n")


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "form, name, advice",
    [
        ("(retry)", "RETRY", "(retry) belongs inside (with-failure-handling (clause...) ...), in a clause or in the body."),
        (
            "(do-retry c (retry))",
            "DO-RETRY",
            "(do-retry name form...) belongs inside (with-retry-counters ((name count)...) ...), for the name of one of its counters.",
        ),
        (
            "(reset-counter c)",
            "RESET-COUNTER",
            "(reset-counter name) belongs inside (with-retry-counters ((name count)...) ...), for the name of one of its counters.",
        ),
        (
            "(get-counter c)",
            "GET-COUNTER",
            "(get-counter name) belongs inside (with-retry-counters ((name count)...) ...), for the name of one of its counters.",
        ),
        ("(succeed 1)", "SUCCEED", "(succeed value...) belongs inside the body of a goal: (def-goal (name pattern...) ...)."),
        ("(tag a 1)", "TAG", "A tag is written with the keyword, (:tag name form...), inside (with-tags ...) or a plan function or goal."),
        ("(tagged a)", "TAGGED", "TAGGED is a mark in the paths of the task tree, as in (task '((tagged name))), and no function."),
        (
            "(goal (a b))",
            "GOAL",
            "GOAL is a mark in the paths of the task tree, as in ((goal (name . pattern))), and no function. "
            "A goal is called by its own name: (name argument...).",
        ),
        (
            "(goal-context 1)",
            "GOAL-CONTEXT",
            "GOAL-CONTEXT is a mark in the paths of the task tree, as in ((goal-context (name . pattern))), and no function.",
        ),
    ],
)
def test_a_marker_in_the_wrong_place_says_where_it_belongs(plan_text, form, name, advice):
    assert (
        plan_text.run(f"(top-level\n  {form})")
        == f"""cramhy: UNDEFINED-FUNCTION
  The function CRAM-LANGUAGE-IMPLEMENTATION:{name} is undefined.
  at plan.lisp:2:3
      {form})
      ^
  {advice}
"""
    )


def test_a_function_of_the_user_may_have_the_name_of_a_marker(plan_text):
    assert plan_text("(defun goal-context (x) (list x)) (defun use () (goal-context 1)) (use)") == "(1)"
    plan_text("(fmakunbound 'goal-context)")


@pytest.mark.parametrize(
    "form, message",
    [
        ("(with-task-tree-node () 1)", "Path parameter is required."),
        (
            "(with-task-tree-node (:path-part '(a) :paramters nil) 1)",
            "WITH-TASK-TREE-NODE has no option :PARAMTERS: it has :PATH-PART, :NAME, "
            ":SEXP, :LAMBDA-LIST, :PARAMETERS, :LOG-PARAMETERS, :LOG-PATTERN.",
        ),
        ('(with-task (:nam "x") 1)', "WITH-TASK has no option :NAM: it has :CLASS, :NAME."),
    ],
)
def test_malformed_forms_are_errors_of_the_expansion(plan_text, form, message):
    shown = plan_text.error(f"(top-level {form})")
    assert shown.startswith(f"cramhy: CRAMHY::COMPILE-ERROR\n  {message}\n  at <repl>:1:12\n")


def _needs_parts(operator):
    try:
        match(operator.pattern, None)
    except WrongShape:
        return True


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("shape", [operator.shape for operator in PLAN_LANGUAGE.values() if _needs_parts(operator)])
def test_a_macro_that_is_called_in_another_shape_says_how_it_is_written(plan_text, shape):
    name = shape.split()[0].strip("(")
    shown = plan_text.error(f"(top-level\n  (cpl-impl:{name}))")
    assert "  at <repl>:2:3\n" in shown and shown.endswith(f"\n  It is written {shape}.\n")


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "form",
    [
        "(par-loop x '(1 2) (print x))",
        "(try-each-in-order x '(1 2) x)",
        "(with-task-suspended 'grasp 1)",
        '(with-task-suspended (grasp "a break") 1)',
        "(with-task-suspended () 1)",
        "(def-goal at (x) x)",
        "(whenever () 1)",
    ],
)
def test_so_does_one_with_a_forgotten_pair_of_parentheses(plan_text, form):
    shown = plan_text.error(f"(top-level\n  {form})")
    name = form.split()[0]
    assert shown.startswith(f"cramhy: CRAMHY::COMPILE-ERROR\n  The {name[1:].upper()} form ") and f"\n  It is written {name} (" in shown


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("tag", ["(:tag 5 1)", "(:tag nil 1)", "(:tag t 1)", "(:tag :key 1)", "(:tag (a) 1)", "(:tag)"])
def test_a_tag_that_cannot_be_a_variable_is_told_at_its_place(plan_text, tag):
    assert (
        plan_text.error(f"(top-level (with-tags\n  {tag}))")
        == f"""cramhy: CRAMHY::COMPILE-ERROR
  {tag.upper()} is no tag: it is written (:tag name form...), and the name is a symbol that can be a variable.
  at <repl>:2:3
      {tag}))
      ^
"""
    )


def test_par_loop_and_try_each_in_order_take_lists_only(plan_text):
    for form in ("par-loop", "try-each-in-order"):
        assert "The value\n    #(1 2)\n  is not of type\n    LIST\n" in plan_text.error(f"(top-level ({form} (x #(1 2)) x))")


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "form, value, wanted",
    [
        ("(clear-tasks 5)", "5", "TASK-TREE-NODE"),
        ("(flatten-task-tree nil)", "NIL", "TASK-TREE-NODE"),
        ("(code-sexp 'x)", "X", "CODE"),
        ("(setf (code-sexp 'x) 1)", "X", "CODE"),
        ("(filter-task-tree #'identity 5)", "5", "TASK-TREE-NODE"),
        ("(task-tree-node '((a)) 5)", "5", "TASK-TREE-NODE"),
        ("(goal-task-tree-node-goal 5)", "5", "TASK-TREE-NODE"),
        ("(task-tree-node-path nil)", "NIL", "TASK-TREE-NODE"),
        ("(plan-tree-node-path nil)", "NIL", "PLAN-TREE-NODE"),
        ("(find-plan-node nil '((a)))", "NIL", "PLAN-TREE-NODE"),
        ("(name 5)", "5", "(OR FLUENT TASK POLICY PROCESS-MODULE)"),
        ("(top-level (task 5))", "5", "LIST"),
        ("(top-level (sub-task 'a))", "A", "LIST"),
        ("(describe-goal 'a)", "A", "CONS"),
    ],
)
def test_what_is_asked_of_a_thing_of_another_kind_says_what_it_is_not(plan_text, form, value, wanted):
    assert plan_text.error(form).startswith(f"cramhy: TYPE-ERROR\n  The value\n    {value}\n  is not of type\n    {wanted}\n")


def test_the_root_of_the_task_tree_has_no_task(plan_text):
    assert "There is no task at the root of the task tree: a path has one part at least." in plan_text.error("(top-level (task '()))")


def test_the_count_of_arguments_is_right_though_other_functions_are_called_alike(plan_text):
    """Compiled lambda expressions share their Python names; the one that misses the parameter is found among them."""
    plan_text("(defvar *others* (list (lambda (p) p) (lambda (q r) (list q r)) (lambda () nil)))")
    assert "invalid number of arguments: 1" in plan_text.error("(top-level (funcall (lambda (first second) (list first second)) 1))")


def test_each_failure_of_try_in_order_is_told_with_its_place(plan_text):
    told = plan_text.error('(top-level\n  (try-in-order\n    (fail "left")\n    (par (fail "right"))))')
    assert "Failure 1 of 2: left. (at <repl>:3:5)" in told
    assert "Failure 2 of 2: right. (at <repl>:4:10)" in told
