"""A computation over many elements passes checkpoints, also where no code of the user's runs: Ctrl-C and other branches get their turn.

Each form would run for some time and end. Beside it in `pursue` stands a branch that ends at once; it wins, because the computation is
preempted. Circular lists are in ``test_circular_lists.py``.
"""

from __future__ import annotations

import pytest

from cramhy_runtime.kernel import budget, inbox, scheduler

FORMS = r"""
(sort v #'<)
(sort v #'> :key #'abs)
(sort v (lambda (a b) (< a b)))
(stable-sort l #'<)
(sort l #'string< :key #'princ-to-string)
(merge 'list l (copy-list l) #'<)
(reduce #'+ v)
(reduce #'max v :key #'abs)
(count -1 v)
(count-if #'minusp v)
(find -1 v)
(find-if #'minusp v :from-end t)
(position -1 v)
(position-if #'minusp v)
(every #'integerp v)
(some #'minusp v)
(notany #'minusp v)
(every #'= v v)
(map 'vector #'1+ v)
(map nil #'1+ v)
(map-into v #'1+ v)
(remove -1 v)
(remove-if #'minusp v)
(delete -1 v)
(substitute 0 -1 v)
(nsubstitute 0 -1 v)
(remove-duplicates v)
(remove-duplicates v :test #'equalp)
(delete-duplicates v :test (lambda (a b) (= a b)) :from-end t)
(search #(5 -1) v)
(search '(5 -1) l :from-end t)
(mismatch v v)
(mismatch v v :from-end t)
(union l l :test #'equalp)
(set-difference l l :test (lambda (a b) (= a b)))
(coerce v 'list)
(make-list 200000)
(butlast l)
(nth 29000 l)
(nthcdr 29000 l)
(elt l 29000)
(position #\b s :test #'char-equal)
(map 'list #'char-code s)
(string-capitalize s)
(parse-integer (substitute #\1 #\a s))
(read-from-string (substitute #\1 #\a s))
(princ-to-string (expt 7 20000))
(let ((*print-base* 3)) (princ-to-string (expt 7 2000)))
(format nil "~{~a ~}" l)
(format nil "~:{~a ~}" (mapcar #'list l))
(equalp v (copy-seq v))
(sxhash l)
(gethash l (make-hash-table :test 'equal))
(gethash l (make-hash-table :test 'equalp))
(copy-tree l)
(prin1-to-string l)
(prin1-to-string v)
"""
LONG = FORMS.strip().splitlines()


@pytest.fixture
def short_slices(monkeypatch):
    """A task is preempted after a few checkpoints, so that the tests need not compute for long."""
    for module in (budget, inbox, scheduler):
        monkeypatch.setattr(module, "SLICE", 2)
    budget.budget.renew()


@pytest.mark.soak(all_but=4)
@pytest.mark.usefixtures("short_slices")
@pytest.mark.parametrize("form", LONG)
def test_a_long_computation_can_be_ended(session, form):
    text = rf"""(let* ((l (loop for i below 30000 collect i)) (v (coerce l 'vector)) (s (make-string 30000 :initial-element #\a)))
                 (declare (ignorable l v s))
                 (cpl:top-level (cpl:pursue (progn {form} :ended) :won)))"""
    (winner,) = session.evaluate_text(text)
    assert str(winner) == ":WON"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "form",
    [
        "(equalp (sort (copy-seq v) #'<) (coerce (loop for i below 50001 collect i) 'vector))",
        "(equalp (sort (copy-seq v) #'>) (reverse (sort (copy-seq v) #'<)))",
        "(let ((s (stable-sort (map 'list (lambda (i) (cons (mod i 10) i)) (sort (copy-seq v) #'<)) #'> :key #'car)))"
        " (every (lambda (a b) (or (> (car a) (car b)) (and (= (car a) (car b)) (< (cdr a) (cdr b))))) s (cdr s)))",
        "(= (reduce #'+ v) 1250025000)",
        "(= (count-if #'evenp v) 25001)",
        "(= (length (make-list 40001 :initial-element 3)) (count 3 (make-list 40001 :initial-element 3)))",
        "(= (search (subseq v 49000 49005) v) 49000)",
        "(eql (mismatch v v :from-end t) nil)",
        "(= (mismatch v (substitute -1 (aref v 4001) v)) 4001)",
        r"(= (parse-integer (make-string 5000 :initial-element #\1)) (/ (1- (expt 10 5000)) 9))",
        "(= (elt (coerce v 'list) 41000) (nth 41000 (coerce v 'list)) (car (nthcdr 41000 (coerce v 'list))) (aref v 41000))",
    ],
)
def test_turns_do_not_change_the_result(session, form):
    (value,) = session.evaluate_text(f"(let ((v (make-array 50001))) (dotimes (i 50001) (setf (aref v i) (mod (* i 7919) 50001))) {form})")
    assert value is True
