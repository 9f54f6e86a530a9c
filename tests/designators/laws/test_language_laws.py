"""Designators inside plans: designators.md 13, invariant 51; section 10."""

import pytest


@pytest.mark.law("designators", 51)
def test_definitions_are_sequential_and_create_functions_may_decline(lisp):
    lisp("""(defun declining (name type properties) (note (list name type properties)) nil)
            (defun making (name type properties) (declare (ignore name properties)) (when (eq type :object) (an object (made by-hand))))
            (register-designator-create-function 'making) (register-designator-create-function 'declining)""")
    assert lisp("""(cpl:top-level (with-designators ((there :location '((:n 1))) (cup :object nil)
                                                      (go :motion `((:to ,there) (:with ,cup))))
                                    (list (eq there (desig-prop-value go :to)) (props cup) (type-of go))))""") == (
        "(T ((:MADE :BY-HAND)) MOTION-DESIGNATOR)"
    )
    assert lisp("(mapcar #'first *notes*)") == "(THERE CUP GO)"
    lisp("(register-designator-create-function 'making)")  # to the front again
    assert lisp("(setf *notes* nil) (cpl:top-level (with-designators ((cup :object nil)) *notes*))") == "NIL"


def test_the_form_is_a_node_of_the_task_tree(lisp):
    assert (
        lisp("""(cpl:top-level (with-designators ((a :motion nil))
                                    (with-designators ((b :motion nil)) (note (rest (first cpl:*current-path*))))))
                   *notes*""")
        == "(((WITH-DESIGNATORS (B))))"
    )
    assert lisp.error("(with-designators ((a :motion nil)) a)").startswith("The value NIL is not of type TASK-TREE-NODE")


def test_the_hook_sees_each_designator(lisp):
    lisp("(defmethod cpl::on-with-designator laws (designator) (note (type-of designator)))")
    try:
        assert lisp("(cpl:top-level (with-designators ((a :motion nil) (b :object nil)) *notes*))") == (
            "(MOTION-DESIGNATOR OBJECT-DESIGNATOR)"
        )
    finally:
        lisp("""(let ((hook #'cpl::on-with-designator))
                  (dolist (method (sb-mop:generic-function-methods hook))
                    (when (equal (method-qualifiers method) '(laws)) (remove-method hook method))))""")


@pytest.mark.parametrize("form", ["(with-designators ((x :motion)) x)", "(with-designators ((x :motion nil 5)) x)"])
def test_a_definition_has_three_parts(lisp, form):
    assert "is malformed: it has the wrong number of parts" in lisp.error(form)
    assert lisp.hint(form).startswith("It is written (with-designators ((name type properties)...) form...).")
