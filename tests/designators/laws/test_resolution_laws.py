"""From description to thing: designators.md 13, invariants 13 to 17, 45 to 47 and 49."""

import pytest

DRIVING = """
(def-fact-group driving (motion-grounding)
  (<- (motion-grounding ?d (drive ?speed)) (desig-prop ?d (:type :driving)) (desig-prop ?d (:speed ?speed)))
  (<- (motion-grounding ?d (turn ?angle)) (desig-prop ?d (:type :driving)) (desig-prop ?d (:angle ?angle))))
"""
TEXTS = {
    "object": "Designator `#<A OBJECT\n    (TYPE CUP)>' does not reference an object.",
    "human": "Designator `#<A HUMAN\n    (TYPE CUP)>' does not reference an human.",
    "action": "Cannot resolve action designator #<A ACTION\n    (TYPE CUP)>.",
    "motion": "Cannot resolve motion designator #<A MOTION\n    (TYPE CUP)>.",
    "location": "Unable to resolve designator `#<A LOCATION\n    (TYPE CUP)>'",
}


@pytest.fixture
def driving(lisp):
    lisp(DRIVING)
    return lisp


@pytest.mark.law("designators", 13)
def test_an_object_that_perception_has_not_found(lisp):
    assert lisp.text("(handler-case (reference (an object (type cup))) (designator-error (e) (princ-to-string e)))") == TEXTS["object"]
    assert lisp("(let ((d (an object (type cup)))) (setf (slot-value d 'data) 'found) (list (reference d) (effective d)))") == "(FOUND T)"


@pytest.mark.law("designators", 14)
@pytest.mark.parametrize("kind", ["human", "action", "motion", "location"])
def test_what_cannot_be_resolved_says_so(lisp, kind):
    lisp(f"(defvar *d* (a {kind} (type cup)))")
    for _ in range(2):
        assert lisp.text("(handler-case (reference *d*) (designator-error (e) (princ-to-string e)))") == TEXTS[kind]
        assert lisp("(list (effective *d*) (timestamp *d*))") == "(NIL NIL)"


def test_a_plan_may_go_on_after_a_designator_error(lisp):
    assert (
        lisp("(list (typep (nth-value 1 (ignore-errors (reference (an object)))) 'error) (subtypep 'designator-error 'cpl:plan-failure))")
        == "(T NIL)"
    )


@pytest.mark.law("designators", 15, 16)
def test_the_moment_of_the_first_reference_stays(driving):
    driving("(defvar *d* (a motion (type driving) (speed 5)))")
    assert driving("(list (effective *d*) (timestamp *d*))") == "(NIL NIL)"
    assert driving("(cpl:top-level (cpl:sleep 2) (list (reference *d*) (effective *d*) (timestamp *d*)))") == "((DRIVE 5) T 2.0d0)"
    assert driving("(cpl:top-level (cpl:sleep 2) (list (eq (reference *d*) (reference *d*)) (timestamp *d*)))") == "(T 2.0d0)"


@pytest.mark.law("designators", 17)
def test_tasks_that_need_one_designator_resolve_it_once(lisp):
    lisp("""(defun look (d) (declare (ignore d)) (note :looking) (cpl:sleep 1) (list (list 'pose)))
            (register-location-generator 5 look)
            (defvar *d* (a location (name here)))""")
    assert (
        lisp("""(let (found)
                     (cpl:top-level (cpl:par (push (reference *d*) found) (push (reference *d*) found) (push (reference *d*) found)))
                     (list *notes* (length found) (length (remove-duplicates found))))""")
        == "((:LOOKING) 3 1)"
    )


def test_when_the_task_that_resolves_is_evaporated_the_next_one_resolves(lisp):
    lisp("""(defun look (d) (declare (ignore d)) (note :looking) (cpl:sleep 2) (list 'pose))
            (register-location-generator 5 look)
            (defvar *d* (a location (name here)))""")
    assert (
        lisp("""(cpl:top-level
                     (cpl:par (cpl:pursue (reference *d*) (cpl:sleep 1))
                              (progn (cpl:sleep 0.5) (note (list (reference *d*) (cut:current-timestamp))))))
                   *notes*""")
        == "(:LOOKING :LOOKING (POSE 3.0d0))"
    )


def test_a_designator_that_its_own_resolution_needs(lisp):
    lisp("(defun look (d) (list (reference d))) (register-location-generator 5 look)")
    assert lisp.error("(reference (a location (n 1)))") == (
        "Recursive lock attempt: designator #<A LOCATION (N 1)> is needed to resolve itself."
    )
    assert lisp.hint("(reference (a location (n 1)))").endswith(
        "A clause, generator or validator asks for the designator that it is to resolve: look at its properties with desig-prop instead."
    )


def test_two_tasks_that_need_what_the_other_resolves_are_told(lisp):
    lisp("""(defvar *a* (a location (name here))) (defvar *b* (a location (name there)))
            (defun look (d) (cpl:sleep 1) (list (reference (if (eq d *a*) *b* *a*))))
            (register-location-generator 5 look)""")
    ring = "(cpl:top-level (cpl:par (reference *a*) (reference *b*)))"
    assert lisp.error(ring) == "Recursive lock attempt: designator #<A LOCATION (NAME HERE)> is needed to resolve itself."
    assert "The task that resolves it waits for #<A LOCATION (NAME THERE)>, which this task resolves" in lisp.hint(ring)
    assert lisp("(defun look (d) (declare (ignore d)) (list 1)) (list (reference *a*) (reference *b*))") == "(1 1)"


@pytest.mark.law("designators", 45)
def test_properties_in_prolog(lisp):
    lisp('(defvar *d* (make-designator :motion \'((:k 1) (:l "x") (:k (2 3)) (:m) (:n 1 2))))')
    assert lisp("(answers `(desig-prop ,*d* (:k ?v)))") == "(((?V . 1)) ((?V 2 3)))"
    assert lisp("(answers `(desig-prop ,*d* (?k ?v)))") == ('(((?K . :K) (?V . 1)) ((?K . :L) (?V . "x")) ((?K . :K) (?V 2 3)))')
    assert lisp("(answers `(desig-prop ,*d* (:k (?a . ?b))))") == "(((?A . 2) (?B 3)))"
    assert lisp("(list (answers `(desig-prop ,*d* (:k 1))) (answers `(desig-prop ,*d* (:k 9))) (answers `(desig-prop ,*d* (:m ?v))))") == (
        "((NIL) NIL NIL)"
    )
    assert lisp("(list (answers '(desig-prop ?d (?k ?v))) (answers '(desig-prop 5 (?k ?v))))") == "(NIL NIL)"


@pytest.mark.law("designators", 46)
def test_solutions_in_the_order_of_the_clauses(driving):
    driving("(defvar *d* (a motion (type driving) (angle 2) (speed 1)))")
    assert driving("(force-ll (designator-solutions *d*))") == "((DRIVE 1) (TURN 2))"
    driving("(defvar *e* (a motion (type driving) (angle 2) (speed 1))) (defvar *next* (next-solution *e*))")
    assert driving("(list (reference *e*) (effective *next*) (reference *next*) (next-solution *next*))") == "((DRIVE 1) NIL (TURN 2) NIL)"
    assert driving("(list (desig-equal *e* *next*) (eq (props *e*) (props *next*)))") == "(T T)"
    assert driving("(list (force-ll (designator-solutions *next*)) (force-ll (designator-solutions *next* t)))") == (
        "(((TURN 2)) ((DRIVE 1) (TURN 2)))"
    )
    assert driving("(designator-solutions (a motion (type flying)))") == "NIL"


@pytest.mark.law("designators", 47)
def test_an_action_without_solution_stays_without(lisp):
    lisp("(defvar *old* (an action (type drawing)))")
    assert lisp.error("(reference *old*)") == "Cannot resolve action designator #<A ACTION (TYPE DRAWING)>."
    lisp("(def-fact-group drawing (action-grounding) (<- (action-grounding ?d (draw)) (desig-prop ?d (:type :drawing))))")
    assert lisp.error("(reference *old*)") == "Cannot resolve action designator #<A ACTION (TYPE DRAWING)>."
    assert lisp("(list (reference (an action (type drawing))) (reference (copy-designator *old*)))") == "((DRAW) (DRAW))"


@pytest.mark.law("designators", 49)
def test_equal_solutions(lisp):
    assert (
        lisp("""(mapcar (lambda (pair) (designator-solutions-equal (first pair) (second pair)))
                           (list '("a" "A") '(("a") ("A")) '((1 (2)) (1 (2))) (list (vector 1 "a") (vector 1.0 "A")) '(1 1) '(1 1.0)
                                 '("a" a) '(nil nil)))""")
        == "(T NIL T T T NIL NIL T)"
    )


@pytest.mark.parametrize("kind", ["action", "motion"])
def test_a_solution_that_is_nil_or_unknown_is_none(lisp, kind):
    lisp(f"(def-fact-group odd ({kind}-grounding) (<- ({kind}-grounding ?d ?anything)) (<- ({kind}-grounding ?d nil)))")
    assert lisp(f"(typep (nth-value 1 (ignore-errors (reference (a {kind})))) 'designator-error)") == "T"
    lisp(f"(def-fact-group odd ({kind}-grounding) (<- ({kind}-grounding ?d ?anything)) (<- ({kind}-grounding ?d (go ?where))))")
    assert lisp(f"(let ((found (reference (a {kind})))) (list (first found) (symbol-package (second found))))") == "(GO NIL)"


def test_a_role_has_its_own_way_of_resolving_and_the_first_answer_stays(driving):
    driving("""(defmethod resolve-designator ((d motion-designator) (role (eql 'dream))) (list 'fly role))
               (defvar *d* (a motion (type driving) (speed 5))) (defvar *e* (a motion (type driving) (speed 5)))""")
    try:
        assert driving("(list (reference *d* 'dream) (reference *e* nil) (reference *e* 'dream))") == "((FLY DREAM) (DRIVE 5) (DRIVE 5))"
        assert driving("(let ((*default-role* 'dream)) (reference (a motion (type driving) (speed 5))))") == "(FLY DREAM)"
        assert driving("(reference (a motion (type driving) (speed 5)))") == "(DRIVE 5)"
    finally:
        driving(
            "(remove-method #'resolve-designator (find-method #'resolve-designator nil (list (find-class 'motion-designator) "
            "'(eql dream))))"
        )


def test_methods_on_reference_are_called_each_time(driving):
    driving("""(defvar *d* (a motion (type driving) (speed 5))) (reference *d*)
               (defmethod reference :around ((d motion-designator) &optional role)
                 (declare (ignore role)) (note (call-next-method)) 'around)
               (defmethod reference :before ((d designator) &optional role) (note role))""")
    try:
        assert driving("(list (reference *d*) (reference *d* 5) *notes*)") == "(AROUND AROUND (NIL (DRIVE 5) 5 (DRIVE 5)))"
        assert driving("(setf *notes* nil) (desig-prop-value (first (list *d*)) :speed) (answers `(desig-reference ,*d* ?r))") == (
            "(((?R . AROUND)))"
        )
    finally:
        driving("""(remove-method #'reference (find-method #'reference '(:around) (list (find-class 'motion-designator))))
                   (remove-method #'reference (find-method #'reference '(:before) (list (find-class 'designator))))""")
    assert driving("(setf *notes* nil) (list (reference *d*) *notes*)") == "((DRIVE 5) NIL)"


def test_next_solutions_of_what_has_none(lisp):
    assert lisp.error("(next-solution (an object (n 1)))") == (
        "There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION CRAM-DESIGNATORS:NEXT-SOLUTION (4)> when "
        "called with arguments (#<A OBJECT (N 1)>). See also: The ANSI Standard, Section 7.6.6"
    )
    assert lisp.hint("(next-solution (an object (n 1)))") == (
        "Only actions, motions and locations have further solutions. An object or a human stands for what perception put into its data; "
        "perceive again for another one."
    )
    assert lisp("(next-solution (make-effective-designator (an action (n 1)) :data-object '(go)))") == "NIL"


def test_grounding_without_any_clause_warns_of_nothing(lisp, capsys):
    lisp("(mapcar (lambda (d) (ignore-errors (reference d))) (list (a motion) (an action) (a location)))")
    assert "undefined functor" not in "".join(capsys.readouterr())
    assert lisp.error("(let ((*break-on-lisp-errors* t)) (prolog '(motion-grounding 5 ?x)))") == (
        "[default motion-grounding]: 5 had to be of type MOTION-DESIGNATOR"
    )
