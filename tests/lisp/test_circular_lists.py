"""A circular list ends neither a plan nor the prompt: every function of lists passes checkpoints while it walks one.

Each form would run for ever. Beside it in `pursue` stands a branch that ends at once; it gets its turn because the walk is preempted,
and the walk is ended. Where a checkpoint is missing the test does not end.
"""

from __future__ import annotations

import pytest

from cramhy_runtime.kernel import budget, inbox, scheduler

FORMS = """
(length l)
(equal l k)
(equalp l k)
(copy-list l)
(copy-tree l)
(reverse l)
(nreverse l)
(append l '(2))
(nconc l '(2))
(last l)
(last l 2)
(butlast l)
(ldiff l k)
(tailp k l)
(revappend l nil)
(sort l #'<)
(mapcar #'1+ l)
(mapcar #'+ l l)
(mapc #'1+ l)
(maplist #'car l)
(map 'list #'1+ l)
(map nil #'1+ l)
(reduce #'+ l)
(every #'numberp l)
(some #'symbolp l)
(member 5 l)
(member 'a l)
(member-if #'symbolp l)
(assoc 3 pairs)
(rassoc 3 pairs)
(getf l :b)
(union l '(2))
(find 5 l)
(find 5 l :from-end t)
(position 5 l)
(count 5 l)
(remove 5 l)
(substitute 1 5 l)
(subseq l 5)
(concatenate 'list l '(1))
(coerce l 'vector)
(apply #'+ l)
(tree-equal l k)
(setf (gethash l (make-hash-table :test 'equal)) 1)
(princ-to-string l)
(let ((*print-pretty* t)) (princ-to-string l))
(format nil "~a" l)
(dolist (x l) x)
(loop for x in l do (list x))
(prolog:unify l k)
(cut:pat-match l k)
(list-length (list* 1 2 l))
(error "bad: ~a" l)
(check-type l null)
(destructuring-bind (a b) l (list a b))
(get-properties l '(:b))
(let ((p l)) (remf p :b))
(cut:force-ll l)
(cut:lazy-elt l 100000000)
(cut:lazy-skip 100000000 l)
(cut:copy-lazy-list l)
(cut:force-ll (cut:lazy-mapcar #'1+ l))
(cut:lazy-filter #'symbolp l)
(cut:lazy-mapcan (lambda (x) x nil) l)
(cut:lazy-fold #'+ l)
(cut:lazy-flatten '#4=(nil . #4#))
(cut:lazy-dolist (x l) x)
(cut:vars-in l)
(cut:vars-in '#5=(#5# . 1))
(cut:var-value '?x '#6=((?y . 1) . #6#))
(cut:substitute-vars l nil)
(cut:add-bdg '?x 1 '#7=((?y . 1) . #7#))
"""
ENDLESS = [form for form in FORMS.strip().splitlines()]


@pytest.fixture(autouse=True)
def short_slices(monkeypatch):
    """A task is preempted after a few checkpoints, so that the tests need not walk far."""
    for module in (budget, inbox, scheduler):
        monkeypatch.setattr(module, "SLICE", 2)
    budget.budget.renew()


@pytest.mark.soak(all_but=16)
@pytest.mark.parametrize("form", ENDLESS)
def test_a_walk_along_a_circular_list_can_be_ended(session, form):
    text = f"""(let ((l '#1=(1 . #1#)) (k '#2=(1 . #2#)) (pairs '#3=((1 . 2) . #3#)))
                 (declare (ignorable l k pairs))
                 (cpl:top-level (cpl:pursue (progn (ignore-errors {form}) :ended) :won)))"""
    (winner,) = session.evaluate_text(text)
    assert str(winner) == ":WON"


@pytest.mark.parametrize(
    "form, value",
    [
        ("(list-length l)", "NIL"),
        ("(let ((*print-circle* t)) (princ-to-string l))", '"#1=(1 . #1#)"'),
        ("(let ((*print-length* 3)) (princ-to-string l))", '"(1 1 1 ...)"'),
        ("(nth 10000 l)", "1"),
        ("(subst 9 1 '(1 . 1))", "(9 . 9)"),
        ("(equal '(1) l)", "NIL"),
        ("(typep l 'list)", "T"),
        ("(eq (nthcdr 9999 l) l)", "T"),
    ],
)
def test_what_ends_ends(session, form, value):
    (found,) = session.evaluate_text(f"(let ((l '#1=(1 . #1#))) (prin1-to-string {form}))")
    assert found == value


@pytest.mark.parametrize("long", ["(make-list 12000 :initial-element 1)", "'(1 (quote #1=(2 . #1#)))"], ids=["long", "quoted circle"])
def test_code_without_a_circle_of_its_own_is_compiled(session, long):
    """However long it is, and whatever its constants hold."""
    form = f"(funcall (compile nil (list 'lambda () (cons 'list {long}))))"
    assert session.evaluate_text(f"(car {form})") == [1]
