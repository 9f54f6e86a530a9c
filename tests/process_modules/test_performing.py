"""perform as a goal of the language, methods of users around it, hooks, and what its errors say (process-modules.md sections 7 and 8)."""

import pytest

FACTS = """
(def-process-module nav (motion) (note (list :nav (goal-of motion))) (goal-of motion))
(def-fact-group modules (matching-process-module available-process-module)
  (<- (matching-process-module ?d nav) (desig-prop ?d (:type :driving)))
  (<- (matching-process-module ?d nav) (desig-prop ?d (:goal ?any)))
  (<- (available-process-module nav)))
(def-fact-group motions (motion-grounding)
  (<- (motion-grounding ?d (drive ?goal)) (desig-prop ?d (:type :driving)) (desig-prop ?d (:goal ?goal))))
(def-fact-group actions (action-grounding)
  (<- (action-grounding ?d (draw-a ?shape)) (desig-prop ?d (:type :drawing)) (desig-prop ?d (:shape ?shape)))
  (<- (action-grounding ?d (doodle-it ?shape ?shape ?shape)) (desig-prop ?d (:type :doodling)) (desig-prop ?d (:shape ?shape)))
  (<- (action-grounding ?d nothing-to-do) (desig-prop ?d (:type :idling)))
  (<- (action-grounding ?d (top-level)) (desig-prop ?d (:type :nesting))))
(defun draw-a (shape) (note (list :draw shape)) shape)
(defun doodle-it (shape) shape)
"""
HOUSE = "(an action (type drawing) (shape house))"


@pytest.fixture
def text(text):
    text(FACTS)
    return text


def test_perform_is_a_node_of_the_task_tree_with_the_designator_as_its_parameter(text):
    assert (
        text(f"""(top-level
                      (perform {HOUSE})
                      (perform {HOUSE})
                      (let ((nodes (remove-if-not #'goal-task-tree-node-p (flatten-task-tree *task-tree*))))
                        (note (reverse (mapcar #'task-tree-node-path nodes)))
                        (note (goal-task-tree-node-pattern (first nodes)))
                        (note (goal-task-tree-node-goal (first nodes)))
                        (note (mapcar (lambda (node) (value (task-tree-node-status-fluent node))) nodes))
                        (mapcar #'task-tree-node-result nodes)))""")
        == "(:HOUSE :HOUSE)"
    )
    assert text("(cddr *notes*)") == (
        "((((GOAL (PERFORM CRAM-EXECUTIVE::?DESIGNATOR))) ((GOAL (PERFORM CRAM-EXECUTIVE::?DESIGNATOR) :CALL 2))) "
        "(PERFORM CRAM-EXECUTIVE::?DESIGNATOR) (PERFORM #<A ACTION (TYPE DRAWING) (SHAPE HOUSE)>) (:SUCCEEDED :SUCCEEDED))"
    )


def test_users_may_define_the_goal_anew_and_ask_what_it_is_for(text):
    from cramhy_runtime.process_modules import executive

    assert text("(describe-goal '(perform ?x))") == '"Perform a motion or action designator."'
    text("""(handler-bind ((warning #'muffle-warning))
              (eval '(def-goal (perform exe::?designator) (note :logged) (generic-perform exe::?designator))))""")
    try:
        assert text(f"(top-level (perform {HOUSE}))") == ":HOUSE"
        assert text("*notes*") == "(:LOGGED (:DRAW :HOUSE))"
    finally:
        text("(setf *notes* nil)")
        executive.define_goal(executive.PERFORM, executive._PATTERN, executive._own_body.function, executive._own_body.documentation)
        executive.bodies_of(executive.PERFORM)[0] = executive._own_body
    assert text(f"(list (top-level (perform {HOUSE})) *notes*)") == "(:HOUSE ((:DRAW :HOUSE)))"


def test_methods_around_generic_perform_see_every_designator(text):
    text("""(defmethod generic-perform :before ((designator desig:action-designator)) (note (list :before (type-of designator))))
            (defmethod generic-perform :around ((designator desig:motion-designator)) (list :around (call-next-method)))""")
    try:
        assert text(f"(plan (nav) (list (perform {HOUSE}) (perform (motion 3))))") == "(:HOUSE (:AROUND 3))"
        assert (
            text("*notes*") == "((:BEFORE DESIG:ACTION-DESIGNATOR) (:DRAW :HOUSE) (:NAV 3))"
            or text("*notes*") == "((:BEFORE CRAM-DESIGNATORS:ACTION-DESIGNATOR) (:DRAW :HOUSE) (:NAV 3))"
        )
    finally:
        text("""(flet ((forget (qualifier class)
                         (remove-method #'generic-perform (find-method #'generic-perform (list qualifier) (list (find-class class))))))
                  (forget :before 'desig:action-designator)
                  (forget :around 'desig:motion-designator))""")


def test_hooks_tell_of_the_choice_of_modules_and_of_its_success(text):
    text("""(defvar *failing* nil)
            (def-process-module nav (motion) (if *failing* (fail "no way") (goal-of motion)))
            (defmethod cram-language::on-preparing-performing-action-designator test ((d desig:motion-designator) modules)
              (note (list :preparing (goal-of d) modules)) :id)
            (defmethod cram-language::on-finishing-performing-action-designator test ((id (eql :id)) success) (note (list id success)))""")
    try:
        text("(plan (nav) (pm-execute-matching (motion 1)))")
        text("(setf *failing* t)")
        text("(plan (nav) (failure-of (perform (motion 2))))")
        assert text("*notes*") == "((:PREPARING 1 (NAV)) (:ID T) (:PREPARING 2 (NAV)) (:ID NIL))"
    finally:
        text("""(remove-method #'cram-language::on-preparing-performing-action-designator
                               (first (sb-mop:generic-function-methods #'cram-language::on-preparing-performing-action-designator)))
                (remove-method #'cram-language::on-finishing-performing-action-designator
                               (first (sb-mop:generic-function-methods #'cram-language::on-finishing-performing-action-designator)))""")


def test_perform_outside_of_a_plan_says_where_it_belongs(text):
    assert (
        text.error(f"(perform {HOUSE})")
        == """cramhy: TYPE-ERROR
  The value
    NIL
  is not of type
    TASK-TREE-NODE
  (A plan function, goal or tag was used outside of a plan: call it inside (top-level ...), or from a function defined with \
def-top-level-cram-function.)
  at <repl>:1:1
    (perform (an action (type drawing) (shape house)))
    ^
"""
    )


def test_a_plan_function_that_takes_other_arguments_is_told_with_the_grounding(text):
    assert (
        text.error("(top-level (perform (an action (type doodling) (shape house))))")
        == """cramhy: SB-INT:SIMPLE-PROGRAM-ERROR
  invalid number of arguments: 3
  at <repl>:1:12
    (top-level (perform (an action (type doodling) (shape house))))
               ^
  while #<A ACTION (TYPE DOODLING) (SHAPE HOUSE)> was performed, whose grounding is (DOODLE-IT HOUSE HOUSE HOUSE)
  DOODLE-IT takes 1 argument.
"""
    )
    for call in ("(perform)", "(perform 1 2)"):
        assert text(f"(top-level (handler-case {call} (program-error () :arity)))") == ":ARITY"


def test_long_designators_and_groundings_are_cut_off_in_the_report_of_an_error(text):
    house = " ".join("house" for _ in range(200))
    said = text.error(f"(top-level (perform (an action (type doodling) (shape ({house})))))")
    (line,) = [line for line in said.splitlines() if "was performed" in line]
    assert line.startswith("  while #<A ACTION (TYPE DOODLING) (SHAPE (HOUSE HOUSE ") and len(line) < 300 and line.count(" ...") == 2


def test_a_grounding_that_is_no_list_is_a_destructuring_error(text):
    assert text("(top-level (text-of (generic-perform (an action (type idling)))))") == (
        '"Error while parsing arguments to DESTRUCTURING-BIND: invalid number of elements in NOTHING-TO-DO to satisfy lambda list '
        '(CRAM-EXECUTIVE::COMMAND &REST CRAM-EXECUTIVE::ARGUMENTS): at least 1 expected, but got a non-list"'
    )
    assert "while #<A ACTION (TYPE IDLING)> was performed, whose grounding is NOTHING-TO-DO" in text.error(
        "(top-level (perform (an action (type idling))))"
    )


def test_the_name_of_a_macro_counts_as_defined_and_fails_as_undefined_function(text):
    assert (
        text("(top-level (handler-case (generic-perform (an action (type nesting))) (undefined-function (c) (cell-error-name c))))")
        == "TOP-LEVEL"
    )


def test_a_designator_is_referenced_with_a_message_of_ones_own(text):
    assert text("(top-level (try-reference-designator (motion 4)))") == "(DRIVE 4)"
    assert (
        text("""(top-level (format nil "~a" (failure-of (try-reference-designator (a motion (goal 4)) "Sorry."))))""")
        == '"Designator #<A MOTION (GOAL 4)> could not be resolved. Sorry."'
    )


def test_goals_that_were_written_in_the_macro_are_keywords_and_hold_nowhere(text):
    said = text("""(handler-bind ((warning #'muffle-warning))
                     (top-level (text-of (generic-perform (an action (type drawing) (shape house) (goal (drawn house)))))))""")
    assert "of action `(DRAWN HOUSE)' was not achieved." in said and text("*notes*") == "((:DRAW :HOUSE))"


def test_a_module_that_matches_twice_is_tried_once(text):
    text('(def-process-module nav (motion) (note :tried) (goal-of motion) (fail "no way"))')
    assert text("(matching-process-module-names (motion))") == "(NAV)"
    assert text("""(plan (nav) (format nil "~a" (failure-of (perform (motion)))))""") == '"no way"' and text("*notes*") == "(:TRIED)"


def test_plans_are_nested_by_performing_in_performing(text):
    text("""(def-fact-group more (action-grounding)
              (<- (action-grounding ?d (tour ?goals)) (desig-prop ?d (:type :touring)) (desig-prop ?d (:goals ?goals))))
            (def-cram-function tour (goals)
              (par-loop (goal goals)
                (handler-bind ((warning #'muffle-warning)) (note (list :arrived (perform (motion goal)))))))""")
    text("""(def-process-module nav (motion) (sleep 1) (goal-of motion))
            (plan (nav) (perform (make-designator :action '((:type :touring) (:goals (1 2 3))))))""")
    assert text("*notes*") == "((:ARRIVED 1) (:ARRIVED 2) (:ARRIVED 3))"
