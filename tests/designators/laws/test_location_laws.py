"""How locations find places: designators.md 13, invariants 18 to 35, 48 and 52; section 8."""

import pytest

PLACES = """
(defvar *drawn* 0)
(defun gen-a (d) (declare (ignore d)) (list :a))
(defun gen-b (d) (declare (ignore d)) (list :b))
(defun numbers (d) (declare (ignore d)) (loop for i from 1 to 100 collect i))
(defun endless (d) (declare (ignore d))
  (lazy-list ((i 1)) (incf *drawn*) (cont i (1+ i))))
(defun place () (a location (name here)))
(defmacro accepting (name (solution) test) `(defun ,name (d ,solution) (declare (ignorable d ,solution)) (if ,test :accept :reject)))
(defun found (form) (handler-case (funcall form) (designator-error () :nothing)))
(defmacro try (form) `(found (lambda () ,form)))
"""


@pytest.fixture
def places(lisp):
    lisp(PLACES)
    return lisp


@pytest.mark.law("designators", 18)
def test_without_a_generator_there_is_no_place(places):
    assert places("(try (reference (place)))") == ":NOTHING"
    assert places.hint("(reference (place))") == (
        "None of the location generators gave a candidate: cram-designators::location-prolog-generator."
    )
    places("(delete-location-generator-function 'desig::location-prolog-generator)")
    assert places("(list (list-location-generators) (try (reference (place))))") == "(NIL :NOTHING)"
    assert places.hint("(reference (place))") == "No location generator is registered."


@pytest.mark.law("designators", 19)
def test_one_generator(places):
    assert places('(register-location-generator 1 gen-a "Always a.")') == "GEN-A"
    assert places("(let ((d (place))) (list (reference d) (next-solution d)))") == "(:A NIL)"


@pytest.mark.law("designators", 20)
def test_a_generator_that_comes_later_does_not_change_a_designator(places):
    places("(register-location-generator 1 gen-a) (defvar *d* (place)) (reference *d*) (register-location-generator 2 gen-b)")
    assert places("(list (reference *d*) (next-solution *d*) (solutions (place)))") == "(:A NIL (:A :B))"


@pytest.mark.law("designators", 21)
def test_solutions_in_the_order_of_priorities_and_one_object_for_each(places):
    places("(register-location-generator 2 gen-b) (register-location-generator 1 gen-a) (defvar *d* (place))")
    assert places("(reference *d*)") == ":A"
    assert places("(let ((n (next-solution *d*))) (list (eq n (next-solution *d*)) (effective n) (reference n) (next-solution n)))") == (
        "(T NIL :B NIL)"
    )
    assert places("(force-ll (designator-solutions (current-desig *d*) t))") == "(:A :B)"


def test_a_location_that_was_equated_by_hand_gives_that_one(places):
    places("(register-location-generator 1 numbers) (defvar *d* (place)) (defvar *e* (place)) (equate *d* *e*)")
    assert places("(eq (next-solution *d*) *e*)") == "T"


@pytest.mark.law("designators", 22)
def test_a_validator_takes_solutions_away(places):
    places("""(register-location-generator 1 gen-a) (register-location-generator 2 gen-b)
              (accepting only-a (s) (eq s :a)) (register-location-validation-function 1 only-a "A only.")""")
    assert places("(solutions (place))") == "(:A)"


@pytest.mark.law("designators", 23, 24)
def test_two_validators_must_both_accept(places):
    places("""(register-location-generator 1 numbers)
              (accepting small (s) (< s 6)) (accepting big (s) (> s 3))
              (register-location-validation-function 1 small) (register-location-validation-function 2 big)""")
    assert places("(solutions (place))") == "(4 5)"
    places("""(defun small (d s) (declare (ignore d)) (if (< s 3) :accept nil))
              (defun big (d s) (declare (ignore d)) (if (< s 3) nil :accept))""")
    assert places("(try (reference (place)))") == ":NOTHING"


@pytest.mark.law("designators", 25)
def test_deleting_a_validator_changes_what_is_resolved_afterwards(places):
    places("""(register-location-generator 1 gen-a) (register-location-generator 2 gen-b) (accepting only-a (s) (eq s :a))
              (register-location-validation-function 1 only-a)
              (defvar *d* (place)) (defvar *all* (solutions *d*)) (delete-location-validation-function 'only-a)""")
    assert places("(list *all* (solutions *d*) (solutions (place)))") == "((:A) (:A) (:A :B))"


@pytest.mark.law("designators", 26, 27)
def test_so_many_candidates_are_drawn_before_the_search_ends(places):
    places("""(register-location-generator 1 endless) (accepting from-52 (s) (> s 51)) (register-location-validation-function 1 from-52)""")
    assert places("(list *location-generator-max-retries* (try (reference (place))) *drawn*)") == "(30 :NOTHING 31)"
    for retries in (0, 3, 50):
        assert places(f"""(setf *drawn* 0)
                          (let ((*location-generator-max-retries* {retries})) (list (try (reference (place))) *drawn*))""") == (
            f"(:NOTHING {retries + 1})"
        )
    assert places("(setf *drawn* 0) (let ((*location-generator-max-retries* 51)) (list (reference (place)) *drawn*))") == "(52 52)"
    assert places.hint("(reference (place))") == (
        "31 candidates were refused, from endless (31). The last one, 31, was refused by from-52, which returned :reject. The search ends "
        "after 31, since *location-generator-max-retries* is 30."
    )


@pytest.mark.law("designators", 28)
def test_an_accepted_candidate_gives_new_retries(places):
    places("(register-location-generator 1 numbers) (accepting odd-ones (s) (oddp s)) (register-location-validation-function 1 odd-ones)")
    assert places("(let ((*location-generator-max-retries* 1)) (length (solutions (place))))") == "50"
    assert places("(let ((*location-generator-max-retries* 0)) (solutions (place)))") == "(1)"


def test_a_candidate_is_drawn_when_it_is_wanted(places):
    places("(register-location-generator 1 endless) (defvar *d* (place))")
    assert places("(list (reference *d*) *drawn* (reference (next-solution *d*)) *drawn*)") == "(1 1 2 2)"


VERDICTS = [
    ((":maybe-reject",), False), ((":unknown",), True), ((":accept",), True), ((":reject",), False), (("nil",), False), (("t",), False),
    (("5",), False), ((":maybe-reject", ":accept"), True), ((":accept", ":maybe-reject"), True), ((":unknown", ":maybe-reject"), False),
    ((":accept", ":unknown", ":reject"), False), ((), True),
]  # fmt: skip


@pytest.mark.soak(all_but=3)
@pytest.mark.law("designators", 29, 30)
@pytest.mark.parametrize("verdicts, valid", VERDICTS)
def test_verdicts(places, verdicts, valid):
    for index, verdict in enumerate(verdicts):
        places(f"(defun v{index} (d s) (declare (ignore d s)) {verdict}) (register-location-validation-function {index} v{index})")
    assert places("(if (validate-location-designator-solution (place) 1) :valid :invalid)") == (":VALID" if valid else ":INVALID")


@pytest.mark.law("designators", 31)
@pytest.mark.parametrize("verdict", ["t", "nil", ":reject", "'accept", '"accept"'])
def test_any_other_verdict_ends_the_questions(places, verdict):
    places(f"""(defun v1 (d s) (declare (ignore d s)) {verdict}) (defun v2 (d s) (declare (ignore d)) (note s) :accept)
               (register-location-validation-function 1 v1) (register-location-validation-function 2 v2)
               (register-location-generator 1 gen-a)""")
    assert places("(list (try (reference (place))) *notes*)") == "(:NOTHING NIL)"
    why = {
        "t": "was refused by v1: t is not a verdict, :accept is one",
        "nil": "was refused by v1, which returned nil",
        ":reject": "was refused by v1, which returned :reject",
        "'accept": "was refused by v1, which returned accept",
        '"accept"': 'was refused by v1, which returned "accept"',
    }[verdict]
    assert places.hint("(reference (place))") == f"1 candidate was refused, from gen-a (1). The last one, :a, {why}."


@pytest.mark.law("designators", 32)
def test_restarts_decide_where_a_validator_fails(places):
    places("""(defun broken (d s) (declare (ignore d)) (if (eq s :b) :accept (error "no map")))
              (register-location-validation-function 1 broken) (register-location-generator 1 gen-a)
              (register-location-generator 2 gen-b)""")
    for restart, solution in (("accept-solution", ":A"), ("reject-solution", ":B")):
        assert (
            places(f"""(handler-bind ((error (lambda (e) (declare (ignore e)) (invoke-restart '{restart}))))
                            (reference (place)))""")
            == solution
        )
    assert places("""(block shown (handler-bind ((error (lambda (e)
                       (return-from shown (loop for r in (compute-restarts e) repeat 2
                                                collect (list (restart-name r) (princ-to-string r)))))))
                       (reference (place))))""") == (
        '((ACCEPT-SOLUTION "Accept this designator solution") (REJECT-SOLUTION "Refuse this designator solution"))'
    )
    assert places.error("(reference (place))") == "no map"


@pytest.mark.law("designators", 33)
def test_what_is_disabled_is_skipped_and_still_listed(places):
    places("""(register-location-generator 1 gen-a) (register-location-generator 2 gen-b) (accepting none (s) nil)
              (register-location-validation-function 3 none) (disable-location-validation-function 'none)
              (disable-location-generator-function 'gen-a)""")
    assert places("(list (solutions (place)) (eq (first (list-location-generators)) #'gen-a))") == "((:B) T)"
    assert places("(not (null (member #'none (list-location-validation-functions))))") == "T"
    assert places("(enable-location-generator-function 'gen-a) (solutions (place))") == "(:A :B)"
    assert places("(enable-location-validation-function 'none) (try (reference (place)))") == ":NOTHING"
    assert (
        places(
            "(disable-location-generator-function 'gen-a) (delete-location-generator-function 'gen-a) "
            "(delete-location-validation-function 'none) (register-location-generator 1 gen-a) (solutions (place))"
        )
        == "(:A :B)"
    )


@pytest.mark.law("designators", 34)
def test_registering_again_moves_and_equal_priorities_put_the_newest_first(places):
    places("(register-location-generator 1 gen-a) (register-location-generator 2 gen-b) (register-location-generator 3 gen-a)")
    assert places("(list (solutions (place)) (length (list-location-generators)))") == "((:B :A) 3)"
    assert places("(register-location-generator 2 gen-a) (solutions (place))") == "(:A :B)"
    assert places("(defun gen-a (d) (declare (ignore d)) '(:new)) (solutions (place))") == "(:NEW :B)"  # the name is registered


@pytest.mark.law("designators", 35)
def test_filters_hold_in_their_extent(places):
    places("(register-location-generator 1 numbers) (defvar *d* (place))")
    assert (
        places("""(with-designator-solution-filter #'evenp
                       (with-designator-solution-filter (lambda (s) (> s 3)) (reference (place))))""")
        == "4"
    )
    assert places("(list (reference (place)) (reference *d*))") == "(1 1)"
    assert places("(reference (next-filtered-designator-solution *d* (lambda (s) (zerop (mod s 7)))))") == "7"
    assert places("""(let ((e (place)))
                       (list (reference e) (next-filtered-designator-solution e (lambda (s) (> s 200))) (next-solution e)))""") == (
        "(1 NIL NIL)"
    )


@pytest.mark.law("designators", 48)
def test_a_location_is_tried_again(places):
    places("(defvar *d* (place))")
    assert places("(try (reference *d*))") == ":NOTHING"
    places("(def-fact-group kitchens (location-grounding) (<- (location-grounding ?d kitchen) (desig-prop ?d (:name :here))))")
    assert places("(reference *d*)") == "KITCHEN"


@pytest.mark.law("designators", 52)
def test_what_prolog_knows_keeps_other_samples_out(places):
    places("""(def-fact-group kitchens (location-grounding) (<- (location-grounding ?d :b) (desig-prop ?d (:name :here))))
              (register-location-generator 1 gen-a) (register-location-generator 2 gen-b)""")
    assert places("(list (solutions (place)) (solutions (a location (name there))))") == "((:B :B) (:A :B))"
    assert places.hint("(let ((*location-generator-max-retries* 0)) (reference (place)))") == (
        "1 candidate was refused, from gen-a (1). The last one, :a, was accepted by no validator, and :maybe-reject came from one. The "
        "search ends after 1, since *location-generator-max-retries* is 0."
    )
    places("(defun lenient (d s) (declare (ignore d s)) :accept) (register-location-validation-function 5 lenient)")
    assert places("(solutions (place))") == "(:A :B :B)"
