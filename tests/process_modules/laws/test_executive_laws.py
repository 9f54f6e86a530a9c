"""Choosing modules, and performing designators: invariants 29 to 40 of process-modules.md, as text that a user writes."""

import pytest

FACTS = """
(def-process-module nav (motion) (note (list :nav (goal-of motion))) (values (goal-of motion) :second))
(def-process-module arm (motion) (note (list :arm (goal-of motion))) :grasped)
(def-process-module pen (motion) (declare (ignore motion)) :drawn)
(def-fact-group modules (matching-process-module available-process-module)
  (<- (matching-process-module ?d nav) (desig-prop ?d (:type :driving)))
  (<- (matching-process-module ?d arm) (desig-prop ?d (:goal ?any)))
  (<- (matching-process-module ?d pen) (desig-prop ?d (:goal ?any)))
  (<- (available-process-module nav))
  (<- (available-process-module arm)))
(def-fact-group motions (motion-grounding)
  (<- (motion-grounding ?d (drive ?goal)) (desig-prop ?d (:type :driving)) (desig-prop ?d (:goal ?goal))))
(def-fact-group actions (action-grounding)
  (<- (action-grounding ?d (draw-a ?shape :size ?size)) (desig-prop ?d (:type :drawing)) (desig-prop ?d (:shape ?shape))
      (desig-prop ?d (:size ?size)))
  (<- (action-grounding ?d (no-such-plan)) (desig-prop ?d (:type :dreaming))))
(defun draw-a (shape &key size) (note (list :draw shape size)) (values shape size :drawn))
"""
HOUSE = "(an action (type drawing) (shape house) (size 3))"


@pytest.fixture
def text(text):
    text(FACTS)
    return text


@pytest.mark.law("process-modules", 29)
def test_no_matching_module_is_a_plan_failure_when_asked_for(text):
    assert text("(matching-process-module-names (motion))") == "(NAV ARM)"
    assert text("(matching-available-process-modules (motion))") == "NIL"
    assert text("(plan (nav pen) (matching-available-process-modules (motion) :fail-if-none t))") == "(NAV)"
    assert (
        text("""(top-level (format nil "~a" (failure-of (matching-available-process-modules (motion 2) :fail-if-none t))))""")
        == '"No process modules found for executing designator #<A MOTION (TYPE DRIVING) (GOAL 2)>"'
    )


@pytest.mark.law("process-modules", 30)
def test_a_module_that_matches_but_does_not_run_is_ignored(text):
    assert text("(plan (arm pen) (pm-execute-matching (motion)))") == ":GRASPED"
    assert text("(plan (pen) (matching-available-process-modules (motion)))") == "NIL"


@pytest.mark.law("process-modules", 31)
def test_when_one_module_fails_the_next_is_tried_and_when_all_fail_the_first_failure_counts(text):
    assert text("(plan (arm nav) (pm-execute-matching (motion 4)))") == "4"
    text('(def-process-module nav (motion) (declare (ignore motion)) (fail "no way"))')
    assert text("(plan (arm nav) (pm-execute-matching (motion)))") == ":GRASPED"
    text('(def-process-module arm (motion) (declare (ignore motion)) (fail "too heavy"))')
    assert text("""(plan (arm nav) (format nil "~a" (failure-of (pm-execute-matching (motion)))))""") == '"no way"'
    text("(def-process-module nav (motion) (car (goal-of motion)))")
    assert text("(plan (arm nav) (text-of (pm-execute-matching (motion 7))))") == '"The value 7 is not of type LIST when binding LIST"'


@pytest.mark.law("process-modules", 32)
def test_performing_a_motion_without_a_module_fails_before_it_is_resolved(text):
    text("""(def-fact-group asked (motion-grounding)
              (<- (motion-grounding ?d ?x) (prolog:lisp-fun note :resolved ?x)))""")
    assert (
        text("""(top-level (format nil "~a" (failure-of (perform (motion)))))""")
        == '"No matching process module found for #<A MOTION (TYPE DRIVING) (GOAL 1)>"'
    )
    assert text("(plan (pen) (type-of (failure-of (perform (motion)))))") == "SIMPLE-PLAN-FAILURE"
    assert text("*notes*") == "NIL"


@pytest.mark.law("process-modules", 33, 39)
def test_a_motion_that_cannot_be_resolved_is_a_reference_failure(text):
    text("(def-process-module arm (motion) (declare (ignore motion)) (note :never))")
    assert text("(defvar *failure* (plan (arm) (failure-of (perform (a motion (goal 5))))))") == "*FAILURE*"
    assert text("""(format nil "~a" *failure*)""") == '"Designator #<A MOTION (GOAL 5)> could not be resolved. Cannot perform motion."'
    assert (
        text("""(list (type-of *failure*) (typep *failure* 'plan-failure) (typep *failure* 'designator-error) (typep *failure* 'error)
                         (slot-value *failure* 'desig::designator) *notes*)""")
        == "(DESIGNATOR-REFERENCE-FAILURE T T T NIL NIL)"
    )
    assert text("(plan (arm) (handler-case (perform (a motion (goal 5))) (designator-error () :caught)))") == ":CAUGHT"
    assert (
        text("""(list (format nil "~a" (make-condition 'designator-reference-failure))
                         (format nil "~a" (make-condition 'designator-goal-parsing-failure)))""")
        == '("designator-failure" "designator-goal-parsing-failure")'
    )


@pytest.mark.law("process-modules", 33)
def test_a_motion_is_performed_by_its_module_and_only_the_first_value_comes_back(text):
    assert text("(plan (nav) (perform (motion 6)))") == "6"
    assert text("*notes*") == "((:NAV 6))"


@pytest.mark.law("process-modules", 34)
def test_an_action_calls_the_function_with_the_ground_arguments_and_returns_its_values(text):
    assert text(f"(top-level (perform {HOUSE}))") == ":HOUSE ; 3 ; :DRAWN"
    assert text("*notes*") == "((:DRAW :HOUSE 3))"


@pytest.mark.law("process-modules", 35)
def test_a_plan_function_that_nobody_defined_is_a_plan_failure(text):
    assert text("""(top-level (format nil "~a" (failure-of (perform (an action (type dreaming))))))""") == (
        "\"Action designator `#<A ACTION (TYPE DREAMING)>' resolved to cram function `NO-SUCH-PLAN', but it isn't defined. "
        'Cannot perform action."'
    )
    assert (
        text("""(top-level (format nil "~a" (failure-of (perform (an action (type sleeping))))))""")
        == '"Designator #<A ACTION (TYPE SLEEPING)> could not be resolved. "'
    )


OCCASIONS = """
(defvar *shapes* nil)
(def-fact-group occasions ()
  (<- (drawn ?shape) (prolog:lisp-fun symbol-value *shapes* ?shapes) (prolog:member ?shape ?shapes)))
(defun with-goal (goal) (make-designator :action `((:type :drawing) (:shape :house) (:size 3) (:goal ,goal))))
"""


@pytest.mark.law("process-modules", 36)
def test_an_action_whose_goal_holds_warns_and_does_not_call_the_plan(text):
    text(OCCASIONS + "(push :house *shapes*)")
    assert (
        text("""(top-level
                     (handler-bind ((warning (lambda (w) (note (list (type-of w) (format nil "~a" w))) (muffle-warning w))))
                       (generic-perform (with-goal '(drawn :house)))))""")
        == "NIL"
    )
    assert text("(handler-bind ((warning #'muffle-warning)) (top-level (perform (with-goal '(drawn :house)))))") == "NIL"
    assert text("*notes*") == '((SIMPLE-WARNING "Action goal `(DRAWN HOUSE)\' already achieved."))'


@pytest.mark.law("process-modules", 37)
def test_an_action_that_does_not_make_its_goal_hold_fails(text):
    text(OCCASIONS)
    assert text("""(top-level (format nil "~a" (failure-of (perform (with-goal '(drawn :house))))))""") == (
        "\"Goal `#<A ACTION (TYPE DRAWING) (SHAPE HOUSE) (SIZE 3) (GOAL (DRAWN HOUSE))>' of action `(DRAWN HOUSE)' was not achieved.\""
    )
    assert text("*notes*") == "((:DRAW :HOUSE 3))"
    text("(defun draw-a (shape &key size) (push shape *shapes*) size)")
    assert text("(top-level (perform (with-goal '(drawn :house))))") == "NIL"


@pytest.mark.law("process-modules", 38)
def test_a_malformed_goal_cannot_be_parsed(text):
    text(OCCASIONS)
    assert text("""(top-level (let ((failure (failure-of (perform (with-goal 5)))))
                                (list (type-of failure) (format nil "~a" failure))))""") == (
        '(DESIGNATOR-GOAL-PARSING-FAILURE "Designator goal 5 could not be parsed. Error while parsing arguments to '
        "DESTRUCTURING-BIND: invalid number of elements in 5 to satisfy lambda list (CRAM-EXECUTIVE::OCCASION &REST "
        'CRAM-EXECUTIVE::PARAMS): at least 1 expected, but got a non-list")'
    )
    assert text("*notes*") == "NIL"


@pytest.mark.law("process-modules", 39)
def test_the_two_failures_are_siblings(text):
    assert (
        text("""(mapcar (lambda (name) (mapcar #'class-name (sb-mop:class-direct-superclasses (find-class name))))
                           '(designator-reference-failure designator-goal-parsing-failure))""")
        == "((SIMPLE-PLAN-FAILURE DESIGNATOR-ERROR) (SIMPLE-PLAN-FAILURE DESIGNATOR-ERROR))"
    )
    assert (
        text("""(top-level (list (type-of (failure-of (perform (make-designator :action '((:type :drawing) (:goal 5))))))
                                    (handler-case (perform (an action (type sleeping))) (designator-error () :designator-error))))""")
        == "(DESIGNATOR-REFERENCE-FAILURE :DESIGNATOR-ERROR)"
    )


@pytest.mark.law("process-modules", 40)
@pytest.mark.parametrize(
    "thing, shown",
    [
        ("(make-designator :object '((:type :cup)))", "(#<A OBJECT\n      (TYPE CUP)>)"),
        ("5", "(5)"),
        ("(make-designator :location '((:on :table)))", "(#<A LOCATION\n      (ON TABLE)>)"),
    ],
)
def test_what_is_neither_motion_nor_action_cannot_be_performed(text, thing, shown):
    assert (
        text.error(f"(top-level (perform {thing}))")
        == f"""cramhy: SB-PCL::NO-APPLICABLE-METHOD-ERROR
  There is no applicable method for the generic function
    #<STANDARD-GENERIC-FUNCTION CRAM-EXECUTIVE:GENERIC-PERFORM (2)>
  when called with arguments
    {shown}.
  See also:
  The ANSI Standard, Section 7.6.6
  at <repl>:1:12
    (top-level (perform {thing}))
               ^
  What can be performed are motions and actions, (desig:a motion ...) and (desig:an action ...), and what a \
(defmethod exe:generic-perform ((designator ...)) ...) is for.
"""
    )
