"""Events and occasions: projection-and-events.md B1, B2, B3."""

import pytest

BEGINNING = """
(use-package :cram-occasions-events)
(defclass robot-moved (event) ((pose :initarg :pose :reader pose)))
(defclass robot-drove (robot-moved) ())
(defun answers (goal) (cut:force-ll (prolog:prolog goal)))
(defun all (occasion &optional time) (cut:force-ll (holds occasion time)))
"""


@pytest.fixture
def world(lisp):
    lisp(BEGINNING)
    return lisp


@pytest.fixture
def no_methods(world):
    yield world
    world("""(dolist (hook (list #'on-event #'clear-belief))
               (dolist (method (sb-mop:generic-function-methods hook))
                 (when (equal (method-qualifiers method) '(test)) (remove-method hook method))))
             (dolist (method (sb-mop:generic-function-methods #'on-event))
               (when (member (first (method-qualifiers method)) '(test one two)) (remove-method #'on-event method)))""")


@pytest.mark.law("projection-and-events", 15)
def test_all_methods_for_an_event_run_the_most_specific_first(no_methods):
    assert no_methods("(on-event (make-instance 'robot-drove))") == "NIL"
    no_methods("""(defmethod on-event one ((event robot-moved)) (note :moved) (list :moved (pose event)))
                  (defmethod on-event two ((event robot-drove)) (note :drove) :drove)""")
    assert no_methods("(list (on-event (make-instance 'robot-drove :pose 1)) (on-event (make-instance 'robot-moved :pose 2)))") == (
        "((:DROVE (:MOVED 1)) ((:MOVED 2)))"
    )
    assert no_methods("(notes)") == "(:DROVE :MOVED :MOVED)"
    assert no_methods("(on-event 5)") == "NIL"


def test_an_error_in_a_method_reaches_who_tells_of_the_event(no_methods):
    no_methods('(defmethod on-event test ((event robot-moved)) (error "no map"))')
    assert no_methods.error("(on-event (make-instance 'robot-drove))") == "no map"


@pytest.mark.law("projection-and-events", 16)
def test_an_event_happens_now_unless_its_time_is_given(world):
    world("(sleep 2)")
    world("(note (event-timestamp (make-instance 'event)) (event-timestamp (make-instance 'robot-moved :pose 1)))")
    assert world("(notes)") == "((2.0d0 2.0d0))"
    assert world("(typep (event-timestamp (make-instance 'robot-drove)) 'double-float)") == "T"
    assert world("(event-timestamp (make-instance 'robot-drove :timestamp 7.5d0))") == "7.5d0"


@pytest.mark.law("projection-and-events", 17)
def test_holds_enumerates_what_a_predicate_gives_and_an_undefined_one_warns(world):
    world("(prolog:def-fact-group kitchen () (prolog:<- (on cup table)) (prolog:<- (on plate table)))")
    assert world("(cut:force-ll (holds '(on ?thing table)))") == "(((?THING . CUP)) ((?THING . PLATE)))"
    assert world("(list (all '(on cup table)) (all '(on fork table)))") == "((NIL) NIL)"
    assert world("(cut:lazy-list-p (holds '(on ?thing table)))") == "T"
    (warning,) = [world("(warnings-of (note (all '(below ?thing table))))")]
    assert "BELOW" in warning and world("(notes)") == "(NIL)"


def test_other_packages_extend_holds_also_for_a_time(world):
    world("""(prolog:def-fact-group beliefs (holds)
               (prolog:<- (holds (in cup sink)))
               (prolog:<- (holds (in cup ?where) (at ?time)) (prolog:lisp-fun round-place ?time ?where))
               (prolog:<- (holds ?timeline (washed cup) (at ?time)) (prolog:lisp-pred > ?time 5)))
             (defun round-place (time) (if (< time 3) 'sink 'shelf))""")
    assert world("(all '(in ?what sink))") == "(((?WHAT . CUP)))"
    assert world("(list (all '(in cup ?where) '(at 1.0d0)) (all '(in cup ?where) '(at 4.0d0)))") == (
        "((((?WHERE . SINK))) (((?WHERE . SHELF))))"
    )
    assert world("(list (all '(washed cup) '(at 6.0d0)) (all '(washed cup) '(at 4.0d0)))") == "((NIL) NIL)"


def test_holds_is_a_generic_function_that_users_may_extend(world):
    world("(defmethod holds :around ((occasion cons) &optional time) (if (eq (car occasion) 'magic) '((:magic)) (call-next-method)))")
    try:
        assert world("(list (all '(magic)) (all '(prolog:true)))") == "(((:MAGIC)) (NIL))"
    finally:
        world("(remove-method #'holds (find-method #'holds '(:around) (list (find-class 'cons))))")


@pytest.mark.law("projection-and-events", 18)
def test_the_deprecated_functions_warn_and_keep_facts_in_the_rete_network(world):
    assert world("(warnings-of (dolist (fact '((on cup table) (on plate table) (in fork sink))) (assert-occasion fact)))") == (
        '("ASSERT-OCCASION is deprecated." "ASSERT-OCCASION is deprecated." "ASSERT-OCCASION is deprecated.")'
    )
    assert world("(prolog:rete-holds '(in fork sink))") == "(NIL)"
    assert world("(warnings-of (note (holds-occasion '(on ?thing table))))") == '("HOLDS-OCCASION is deprecated.")'
    assert world("(warnings-of (retract-occasion '(on ?thing table)))") == '("RETRACT-OCCASION is deprecated.")'
    assert world("(notes)") == "((((?THING . PLATE)) ((?THING . CUP))))"
    assert world("(list (prolog:rete-holds '(on ?thing table)) (prolog:rete-holds '(in fork sink)))") == "(NIL (NIL))"
    assert world("(handler-case (assert-occasion '(a)) (cut:deprecation-warning () :deprecated))") == ":DEPRECATED"


def test_designators_in_occasions_are_compared_by_what_they_are_equated_to(world):
    world("""(defvar *cup* (desig:a motion (type going))) (defvar *same* (desig:a motion (type going))) (desig:equate *cup* *same*)
             (defvar *other* (desig:a motion (type going)))
             (warnings-of (assert-occasion (list 'done *cup*)))""")
    world("(warnings-of (note (holds-occasion (list 'done *same*)) (holds-occasion (list 'done *other*))))")
    assert world("(notes)") == "(((NIL) NIL))"


@pytest.mark.law("projection-and-events", 19)
def test_clear_belief_empties_the_network_and_calls_all_methods(no_methods):
    no_methods("""(warnings-of (assert-occasion '(on cup table))) (prolog:rete-assert '(a b))
                  (defmethod clear-belief test () (note :cleared))
                  (clear-belief)""")
    assert no_methods("(list (prolog:rete-holds '(on ?x ?y)) (prolog:rete-holds '(a ?x)) (prolog:alpha-network-size) (notes))") == (
        "(NIL NIL 1 (:CLEARED))"
    )
    assert no_methods("(warnings-of (retract-occasion '(on ?x ?y)))") == '("RETRACT-OCCASION is deprecated.")'


def test_an_occasion_that_somebody_retracted_already(world):
    world("(warnings-of (assert-occasion '(on cup table))) (prolog:rete-retract '(on cup table))")
    assert world("(warnings-of (retract-occasion '(on cup table)))") == '("RETRACT-OCCASION is deprecated.")'


# -------------------------------------------------------------------------------------------------------------------- time


def includes(world, time):
    return world(f"(answers '(duration-includes (throughout 2.0d0 5.0d0) {time}))")


@pytest.mark.soak(all_but=4)
@pytest.mark.law("projection-and-events", 20)
@pytest.mark.parametrize(
    "time, included",
    [
        ("(at 2.0d0)", True),
        ("(at 4.9d0)", True),
        ("(at 5.0d0)", False),
        ("(at 1.9d0)", False),
        ("(throughout 2.0d0 5.0d0)", True),
        ("(throughout 3.0d0 4.0d0)", True),
        ("(throughout 1.9d0 4.0d0)", False),
        ("(throughout 3.0d0 5.1d0)", False),
        ("(throughout 4.0d0 3.0d0)", False),
        ("(throughout 3.0d0 3.0d0)", False),
        ("(during 1.0d0 2.1d0)", True),
        ("(during 4.9d0 9.0d0)", True),
        ("(during 0.0d0 9.0d0)", True),
        ("(during 1.0d0 2.0d0)", False),
        ("(during 5.0d0 6.0d0)", False),
        ("(during 4.0d0 3.0d0)", False),
        ("(after 3.0d0)", False),
        ("(at 3.0d0 4.0d0)", False),
        ("3.0d0", False),
        ("(throughout ?a ?b)", False),
        ("(throughout 3.0d0 ?b)", False),
    ],
)
def test_a_stretch_of_time_includes_its_start_and_not_its_end(world, time, included):
    assert includes(world, time) == ("(NIL)" if included else "NIL")


@pytest.mark.law("projection-and-events", 21)
def test_an_unbound_point_of_time_becomes_the_start(world):
    assert includes(world, "(at ?when)") == "(((?WHEN . 2.0d0)))"
    assert includes(world, "?time") == "(((?TIME AT 2.0d0)))"


@pytest.mark.parametrize("time", ["3", "3.0", "7/2"])
def test_times_of_another_type_fit_nothing_and_a_warning_says_what_to_write(world, time):
    double = {"3": "3.0d0", "3.0": "3.0d0", "7/2": "3.5d0"}[time]
    assert world(f"(warnings-of (note (answers '(duration-includes (throughout 2.0d0 5.0d0) (at {time})))))") == (
        f'("[PROLOG WARNING] The time {time} in (AT {time}) is not a double-float, so it fits nothing. Write {double}.")'
    )
    assert world("(notes)") == "(NIL)"


# --------------------------------------------------------------------------------------------------- perform with a :goal

ACTION = """
(defvar *drawn* nil)
(prolog:def-fact-group drawing (desig:action-grounding holds)
  (prolog:<- (desig:action-grounding ?a (draw ?shape)) (desig:desig-prop ?a (:shape ?shape)))
  (prolog:<- (drawn ?shape) (prolog:lisp-pred is-drawn ?shape)))
(defun is-drawn (shape) (member shape *drawn*))
(defun draw (shape) (note shape) (unless (eq shape :circle) (push shape *drawn*)) :drew)
(defun perform-it (shape &optional (perform #'exe:perform))
  (let ((?shape shape) (?goal (list 'drawn shape)))
    (funcall perform (desig:an action (type drawing) (shape ?shape) (goal ?goal)))))
"""


def test_an_action_with_a_goal_makes_an_occasion_of_the_users_hold(world):
    world(ACTION)
    assert world("(list (top-level (perform-it :house)) (notes))") == "(NIL (:HOUSE))"
    assert world("(list (top-level (warnings-of (perform-it :house #'exe:generic-perform))) (notes))") == (
        '(("Action goal `(DRAWN HOUSE)\' already achieved.") NIL)'
    )
    assert "was not achieved." in world.error("(top-level (perform-it :circle))")


def test_the_goal_is_asked_of_the_generic_function_holds(world):
    world(ACTION)
    world("(defmethod holds :around ((occasion cons) &optional time) (note occasion) (call-next-method))")
    try:
        assert world("(top-level (perform-it :house)) (notes)") == "((DRAWN :HOUSE) :HOUSE (DRAWN :HOUSE))"
    finally:
        world("(remove-method #'holds (find-method #'holds '(:around) (list (find-class 'cons))))")
