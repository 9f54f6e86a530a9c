"""Lazy lists, promises and pattern matching as a plan uses them: invariants 112 to 118 of the reference."""

import pytest


COUNTING = """
    (defvar *evaluations* 0)
    (setf *evaluations* 0)
    (defun numbers (&optional end)
      (cut:lazy-list ((i 0))
        (incf *evaluations*)
        (if (eql i end) nil (cut:cont i (1+ i)))))
    (defmacro counted (form) `(let ((value ,form)) (list value *evaluations*)))"""


@pytest.mark.law(112)
def test_creating_a_lazy_list_evaluates_its_body_once_and_looking_at_the_first_element_not_again(lisp):
    lisp(COUNTING)
    assert (
        lisp("(let ((l (numbers))) (list *evaluations* (counted (cut:lazy-car l)) (counted (cut:lazy-car (cut:lazy-cdr l)))))")
        == "(1 (0 1) (1 2))"
    )


@pytest.mark.law(112)
@pytest.mark.parametrize(
    "form",
    [
        "(cut:lazy-mapcar #'1+ (numbers))",
        "(cut:lazy-mapcan #'list (numbers))",
        "(cut:lazy-filter #'evenp (numbers))",
        "(cut:lazy-take 3 (numbers))",
    ],
)
def test_creating_a_list_from_a_lazy_one_evaluates_no_more_than_the_first_element(lisp, form):
    lisp(COUNTING)
    assert lisp(f"{form} *evaluations*") == "1"


@pytest.mark.law(112)
def test_forcing_a_list_of_three_takes_three_evaluations_and_one_that_finds_the_end_and_gives_a_plain_list(lisp):
    lisp(COUNTING)
    assert (
        lisp("(let ((l (numbers 3))) (list (equal (cut:force-ll l) '(0 1 2)) *evaluations* (cut:lazy-list-p l) (length l)))")
        == "(T 4 NIL 3)"
    )


@pytest.mark.law(112)
def test_finish_needs_no_evaluation_that_finds_the_end(lisp):
    lisp(COUNTING)
    assert (
        lisp("""(list (cut:force-ll (cut:lazy-list ((i 0)) (incf *evaluations*) (if (= i 2) (cut:finish i) (cut:cont i (1+ i)))))
                         *evaluations*)""")
        == "((0 1 2) 3)"
    )


@pytest.mark.law(113)
def test_what_one_holder_forces_all_others_see(lisp):
    lisp(COUNTING)
    assert (
        lisp("""
        (let* ((l (numbers 4)) (tail (cut:lazy-cdr l)) (holder (list l)) (copy (cut:copy-lazy-list l)))
          (cut:force-ll tail)
          (list l tail (first holder) *evaluations* (cut:force-ll copy) *evaluations*))""")
        == "((0 1 2 3) (1 2 3) (0 1 2 3) 5 (0 1 2 3) 5)"
    )


@pytest.mark.law(113)
def test_two_branches_that_read_one_lazy_list_compute_each_element_once(lisp):
    assert (
        lisp("""
        (let ((l (cut:lazy-list ((i 0)) (note i) (when (plusp i) (sleep 1)) (if (= i 3) nil (cut:cont i (1+ i))))))
          (top-level (par (cut:force-ll l) (cut:force-ll l)))
          (list l *notes*))""")
        == "((0 1 2) (0 1 2 3))"
    )


@pytest.mark.law(114)
def test_taking_n_of_an_endless_list_evaluates_exactly_n_elements(lisp):
    lisp(COUNTING)
    assert lisp("(counted (cut:force-ll (cut:lazy-take 3 (numbers))))") == "((0 1 2) 3)"
    lisp("(setf *evaluations* 0)")
    assert lisp("(counted (cut:force-ll (cut:lazy-take 1 (numbers))))") == "((0) 1)"


@pytest.mark.law(115)
def test_a_promise_is_computed_once_and_by_the_first_who_asks(lisp):
    assert (
        lisp("""
        (let ((promise (cut:delay (note :computed) 7)))
          (note :made)
          (list (cut:delay-p promise) (cut:force promise) (cut:force promise) (cut:force 5) *notes*))""")
        == "(T 7 7 5 (:MADE :COMPUTED))"
    )


@pytest.mark.law(115)
def test_two_branches_that_force_one_promise_compute_it_once(lisp):
    assert (
        lisp("""
        (let ((promise (cut:delay (note :computing) (sleep 1) 7)))
          (top-level (par (note (cut:force promise)) (note (cut:force promise))))
          *notes*)""")
        == "(:COMPUTING 7 7)"
    )


@pytest.mark.law(115)
def test_a_promise_whose_computing_branch_is_evaporated_is_computed_by_the_next(lisp):
    assert (
        lisp("""
        (let ((promise (cut:delay (note :computing) (sleep 2) 7)))
          (top-level (par (pursue (cut:force promise) (sleep 1)) (seq (sleep 0.5) (note (cut:force promise)))))
          *notes*)""")
        == "(:COMPUTING :COMPUTING 7)"
    )


@pytest.mark.law(116)
@pytest.mark.parametrize("data", ['(a (b 1 "s") . c)', "nil", "(nil (nil))", "7", "(#\\\\a :k 1.5)".replace("\\\\", "\\")])
def test_ground_data_matches_itself_without_bindings(lisp, data):
    lisp(f"(defvar *data* '{data})")
    assert lisp("(cut:pat-match *data* *data*)") == "NIL ; T"


@pytest.mark.law(116)
@pytest.mark.parametrize(
    ("data", "matches"), [("(1 1)", "T"), ("(1 2)", "NIL"), ("((a b) (a b))", "T"), ('("s" "s")', "T"), ("(a nil)", "NIL")]
)
def test_a_variable_used_twice_matches_only_equal_elements(lisp, data, matches):
    assert lisp(f"(cut:pat-match-p '(?x ?x) '{data})") == matches


@pytest.mark.law(117)
@pytest.mark.parametrize(
    ("pattern", "data"),
    [
        ("(go ?where (fast ?how))", "(go (1 2) (fast nil))"),
        ("(?x . ?rest)", "(a b c)"),
        ("(?x ?x)", "((a) (a))"),
        ("?all", "(a b)"),
        ("(a (?b ((?c))) ?b)", "(a (2 ((3))) 2)"),
    ],
)
def test_substituting_the_bindings_of_a_match_into_its_pattern_rebuilds_the_data(lisp, pattern, data):
    assert lisp(f"(equal (cut:substitute-vars '{pattern} (cut:pat-match '{pattern} '{data})) '{data})") == "T"


@pytest.mark.law(118)
def test_renaming_leaves_the_anonymous_variable_and_constants_alone(lisp):
    assert (
        lisp("""
        (destructuring-bind (x (y again) anonymous constant . rest) (cut:rename-vars '(?x (?y ?x) cut:?_ a . 3))
          (list (eq x again) (eq x y) (eq x '?x) (cut:is-genvar x) (cut:is-genvar y) anonymous constant rest))""")
        == "(T NIL NIL T T CRAM-UTILITIES:?_ A 3)"
    )


@pytest.mark.law(118)
@pytest.mark.parametrize("keywords", ["", ":gensym-var-names nil"])
def test_a_renamed_pattern_still_matches_what_the_pattern_matches(lisp, keywords):
    assert (
        lisp(f"""
        (let ((renamed (cut:rename-vars '(go ?x (cut:?_ ?y) ?x) {keywords})))
          (list (cut:pat-match-p renamed '(go 1 (2 3) 1)) (cut:pat-match-p renamed '(go 1 (2 3) 4))
                (mapcar #'cdr (cut:pat-match renamed '(go 1 (2 3) 1)))))""")
        == "(T NIL (3 1))"
    )
