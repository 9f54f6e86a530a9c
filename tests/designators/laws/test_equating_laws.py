"""Chains of designators for one thing: designators.md 13, invariants 36 to 40 and 50; section 6."""

import pytest

NAMED = """
(defun thing (name) (make-designator :object `((:name ,name))))
(defun names (designators) (mapcar (lambda (d) (desig-prop-value d :name)) designators))
(defun chain (d) (names (loop for m = (first-desig d) then (successor m) while m collect m)))
(defvar *a* (thing :a)) (defvar *b* (thing :b)) (defvar *c* (thing :c)) (defvar *d* (thing :d))
"""


@pytest.fixture
def things(lisp):
    lisp(NAMED)
    return lisp


@pytest.mark.law("designators", 36)
def test_equate_returns_the_successor_and_refuses_what_is_equal(things):
    assert things("(eq (equate *a* *b*) *b*)") == "T"
    for form in ("(equate *a* *b*)", "(equate *b* *a*)", "(equate *c* *c*)"):
        assert things.error(form) == "Cannot equate designators that are already equal."
        assert things(f"(typep (nth-value 1 (ignore-errors {form})) 'simple-error)") == "T"


@pytest.mark.law("designators", 37)
def test_the_members_of_a_chain_know_its_ends_and_share_their_id(things):
    things("(equate *a* *b*) (equate *a* *c*)")
    assert things("(list (chain *b*) (names (list (first-desig *c*) (current-desig *a*))))") == "((:A :B :C) (:A :C))"
    assert things("(list (desig-equal *a* *c*) (desig-equal *a* *d*) (desig-equal *a* 5) (desig-equal nil nil))") == "(T NIL NIL NIL)"
    assert things("(list (eq (object-id *a*) (object-id *c*)) (eq (object-id *a*) (object-id *d*)))") == "(T NIL)"
    assert things("(names (list (parent *b*) (successor *b*)))") == "(:A :C)"
    assert things("(list (parent *a*) (successor *c*) (current-desig nil))") == "(NIL NIL NIL)"


@pytest.mark.law("designators", 38)
def test_two_chains_become_one_with_the_ancestors_of_the_successor_in_front(things):
    things("""(defvar *1* (thing 1)) (defvar *2* (thing 2))
              (equate *1* *2*) (equate *a* *b*) (equate *b* *c*)
              (equate *1* *b*)""")
    assert things("(list (chain *1*) (chain *c*))") == "((:A 1 2 :B :C) (:A 1 2 :B :C))"
    assert things("(names (get-equal-designators *2*))") == "(:A 1 :C :B)"  # ancestors oldest first, successors youngest first
    assert things("(length (remove-duplicates (mapcar #'object-id (list *a* *b* *c* *1* *2*))))") == "1"


def test_a_new_member_goes_behind_the_youngest(things):
    things("(equate *a* *b*) (equate *a* *c*) (make-designator :object '((:name :e)) *a*)")
    assert things("(chain *a*)") == "(:A :B :C :E)"


@pytest.mark.law("designators", 39)
def test_callbacks_of_all_members_are_told_of_the_successor(things):
    things("""(flet ((noting (name) (lambda (new) (note (list name (desig-prop-value new :name))))))
                (register-equate-callback *a* (noting 1))
                (register-equate-callback *b* (noting 2)))
              (equate *a* *b*)""")
    assert things("*notes*") == "((1 :B) (2 :B))"
    assert things("(setf *notes* nil) (with-equate-callback (*a* (lambda (new) (note new))) (equate *b* *c*) :value)") == ":VALUE"
    assert things("(names (mapcar (lambda (x) (if (consp x) *d* x)) *notes*))") == "(:D :C :D)"
    assert things("(setf *notes* nil) (equate *c* *d*) *notes*") == "((1 :D) (2 :D))"


def test_a_callback_is_registered_once_and_forgotten_once(things):
    things("""(defvar *f* (lambda (new) (declare (ignore new)) (note 1)))
              (register-equate-callback *a* *f*) (register-equate-callback *a* *f*) (equate *a* *b*)""")
    assert things("*notes*") == "(1)"
    assert things("(unregister-equate-callback *a* *f*) (unregister-equate-callback *a* *f*) (equate *a* *c*) *notes*") == "(1)"
    assert things.error("(register-equate-callback *a* 'note)") == "The value NOTE is not of type FUNCTION"
    assert things.error("(register-equate-callback 5 #'note)").startswith("There is no applicable method")


def test_a_callback_that_fails_keeps_no_news_from_the_others(things):
    things("""(register-equate-callback *a* (lambda (new) (declare (ignore new)) (error "broken callback")))
              (register-equate-callback *b* (lambda (new) (note (desig-prop-value new :name))))""")
    assert things.error("(equate *a* *b*)") == "broken callback"
    assert things("(list *notes* (chain *a*))") == "((:B) (:A :B))"


def test_the_hook_is_called_before_the_link_is_made(things):
    things("""(defmethod cut::on-equate-designators laws (successor parent)
                (note (names (list successor parent))) (note (desig-equal successor parent)))
              (equate *a* *b*)""")
    try:
        assert things("*notes*") == "((:B :A) NIL)"
    finally:
        things("""(let ((hook #'cut::on-equate-designators))
                    (dolist (method (sb-mop:generic-function-methods hook))
                      (when (equal (method-qualifiers method) '(laws)) (remove-method hook method))))""")


@pytest.mark.law("designators", 40)
def test_the_youngest_that_is_effective(things):
    things("(equate *a* *b*) (equate *b* *c*)")
    assert things("(list (newest-effective-designator *b*) (newest-effective-designator nil))") == "(NIL NIL)"
    things("(setf (slot-value *a* 'data) 1 (slot-value *b* 'data) 2) (reference *a*) (reference *b*)")
    assert things("(names (list (newest-effective-designator *a*) (newest-effective-designator *c*)))") == "(:B :B)"


@pytest.mark.law("designators", 50)
def test_a_task_that_waits_for_the_fluent_wakes_when_the_chain_is_equated(things):
    assert (
        things("""(cpl:top-level
                       (cpl:par (with-equate-fluent (*a* equated)
                                  (note (list (cpl:value equated) (cpl-impl:name equated)))
                                  (cpl:wait-for (cpl:pulsed equated))
                                  (note (cut:current-timestamp)))
                                (progn (cpl:sleep 3) (equate *a* *b*))))
                     *notes*""")
        == "((NIL EQUATED) 3.0d0)"
    )
