"""The room as CRAM's packages for mobile manipulation use it: the methods that they define and the clauses that they add.

What is shown here is not their code, but of the same shape: poses for designators (cram-tf), poses of objects
(cram-object-interfaces), a generator and a validator that share work by the first designator of a chain (costmaps), a predicate over
the properties of motions (cram-designator-specification), legacy property packages.
"""

import pytest


@pytest.fixture
def poses(lisp):
    lisp("""(defstruct point x)
            (defmethod reference :around ((d location-designator) &optional role)
              (declare (ignore role))
              (let ((found (call-next-method))) (if (numberp found) (make-point :x found) found)))
            (defmethod designator-solutions-equal ((a point) (b point)) (< (abs (- (point-x a) (point-x b))) 0.1))
            (defmethod designator-pose ((d location-designator)) (reference d))
            (defmethod designator-distance ((a location-designator) (b location-designator))
              (abs (- (point-x (reference a)) (point-x (reference b)))))
            (def-fact-group poses (location-grounding)
              (<- (location-grounding ?d ?pose) (current-designator ?d ?now) (desig-prop ?now (:pose ?pose))))""")
    yield lisp
    lisp("""(dolist (spec '((reference (:around) (location-designator)) (designator-solutions-equal nil (point point))
                            (designator-pose nil (location-designator))
                            (designator-distance nil (location-designator location-designator))))
              (destructuring-bind (name qualifiers classes) spec
                (remove-method (fdefinition name) (find-method (fdefinition name) qualifiers (mapcar #'find-class classes)))))""")


def test_poses_of_locations(poses):
    poses("(defvar *a* (a location (pose 1))) (defvar *b* (a location (pose 4)))")
    assert poses("(list (designator-pose *a*) (designator-distance *a* *b*))") == "(NIL NIL)"
    assert poses("(list (reference *a*) (reference *b*))") == "(#S(POINT :X 1) #S(POINT :X 4))"
    assert poses("(list (designator-pose *a*) (designator-distance *a* *b*) (eq (slot-value *a* 'desig::current-solution) 1))") == (
        "(#S(POINT :X 1) 3 T)"
    )


def test_near_solutions_count_as_equal(poses):
    poses("""(defun gen (d) (declare (ignore d)) (list (make-point :x 1.05) (make-point :x 9))) (register-location-generator 5 gen)
             (defvar *d* (let ((?p (make-point :x 1))) (a location (pose ?p))))""")
    assert poses("(solutions *d*)") == "(#S(POINT :X 1.05) #S(POINT :X 1))"


def test_a_location_of_an_object(lisp):
    lisp("""(def-fact-group objects (location-grounding desig-location-prop)
              (<- (desig-location-prop ?object ?pose) (obj-desig? ?object) (desig-prop ?object (:pose ?pose)))
              (<- (location-grounding ?d ?pose)
                (loc-desig? ?d) (desig-prop ?d (:of ?object)) (current-designator ?object ?now) (desig-location-prop ?now ?pose)))
            (defvar *cup* (an object (type cup)))
            (defvar *seen* (copy-designator *cup* :new-description '((:pose table))))""")
    assert lisp("(equate *cup* *seen*) (let ((?cup *cup*)) (reference (a location (of ?cup))))") == "TABLE"


def test_work_that_is_shared_by_a_chain(lisp):
    lisp("""(defvar *maps* (make-hash-table))
            (defun map-of (d)
              (let ((first (first-desig d)))
                (or (gethash first *maps*) (setf (gethash first *maps*) (note (list 3 1 2))))))
            (defun samples (d) (lazy-mapcar #'1+ (map-of d)))
            (defun on-the-map (d s) (cond ((not (numberp s)) :unknown) ((member (1- s) (map-of d)) :accept) (t :reject)))
            (register-location-generator 20 samples "Samples of a map.")
            (register-location-validation-function 20 on-the-map "On the map.")""")
    assert lisp("(list (solutions (a location (name here))) *notes*)") == "((4 2 3) ((3 1 2)))"


def test_a_checked_sibling_of_desig_prop(lisp):
    lisp("""(def-fact-group properties (property)
              (<- (property ?d (?key ?value))
                (lisp-type ?d designator) (desig-prop ?d (?key ?value)) (member ?key (:type :target)) (assert-type ?key symbol "PROPERTY")))
            (def-fact-group motions (motion-grounding)
              (<- (motion-grounding ?d (move-base ?target))
                (property ?d (:type :going)) (property ?d (:target ?location)) (desig-reference ?location ?target)))
            (def-fact-group places (location-grounding) (<- (location-grounding ?d kitchen) (desig-prop ?d (:name :kitchen))))""")
    assert lisp("(reference (a motion (type going) (target (a location (name kitchen)))))") == "(MOVE-BASE KITCHEN)"


def test_a_package_of_property_names(lisp):
    lisp("""(desig-props:def-desig-package legacy-props (:use :common-lisp) (:export #:fetch) (:desig-properties #:knob #:colour))""")
    assert lisp("(eq 'legacy-props::knob 'desig-props:knob)") == "T"
    assert lisp("(desig-prop-value (make-designator :object '((desig-props:knob 1))) 'legacy-props::knob)") == "1"
    assert lisp('(nth-value 1 (find-symbol "FETCH" :legacy-props))') == ":EXTERNAL"


UNDECLARED = (
    '"Designator property {} has not been declared properly. This may cause problems. To fix it, use the macro DEF-DESIG-PACKAGE and '
    'declare the symbol as a designator property."'
)


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    ("form", "name"),
    [
        ("(desig-prop-value (a motion) 'knob)", "KNOB"),
        ("(desig-prop-value nil 'knob)", "KNOB"),
        ("(desig-prop-values (a motion) 'knob)", "KNOB"),
        ("(prolog `(desig-prop ,(a motion) (knob ?v)))", "KNOB"),
        ("(prolog `(desig-prop ,(a motion) (knob ?v) ?time))", "KNOB"),
        ("(prolog `(and (== ?k knob) (desig-prop ,(a motion) (?k ?v))))", "KNOB"),
        ("(prolog `(knob-of ,(a motion) ?v))", "KNOB"),
        ("(prolog `(desig-prop ,(a motion) (?key ?v)))", "?KEY"),
        ("(prolog `(desig-prop ,(a motion) (?key ?v) ?time))", "?KEY"),
    ],
)
def test_a_property_name_that_is_no_keyword_is_warned_of(lisp, form, name):
    lisp("(def-fact-group knobs (knob-of) (<- (knob-of ?d ?v) (desig-prop ?d (knob ?v))))")
    assert lisp(f"(handler-case (force-ll {form}) (simple-warning (w) (princ-to-string w)))") == UNDECLARED.format(name)


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "form",
    [
        "(desig-prop-value (a motion (knob 1)) :knob)",
        "(desig-prop-value (a motion) '#:knob)",
        "(desig-prop-value (make-designator :motion '((desig-props::knob 1))) 'desig-props::knob)",
        "(with-desig-props (knob) (a motion (knob 1)) knob)",
        "(prolog `(any ,(a motion (knob 1)) ?v))",
        "(prolog `(desig-prop ,(a motion (knob 1)) (?_ ?v)))",
        "(prolog `(and (== ?k :knob) (desig-prop ,(a motion (knob 1)) (?k ?v))))",
        "(let ((?key :knob)) (a motion (?key 1)))",
        "(a motion (knob undeclared) (*key* *key*))",
    ],
)
def test_a_name_that_is_fine_is_not(lisp, form):
    lisp("(def-fact-group anything (any) (<- (any ?d ?v) (desig-prop ?d (?k ?v)))) (defvar *key* 'knob)")
    assert lisp(f"(handler-case (progn (force-ll (list {form})) :silent) (warning (w) (princ-to-string w)))") == ":SILENT"
