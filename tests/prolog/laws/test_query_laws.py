"""What a query returns: solutions, what is in them, their order, and when they are computed (invariants 1 to 7, 26 to 31, 37 to 40)."""

import pytest


@pytest.mark.law("prolog", 1)
def test_the_empty_conjunction_has_the_empty_binding_list_as_its_solution(lisp):
    assert lisp("(all '(and))") == "(NIL)"


@pytest.mark.law("prolog", 2)
def test_the_empty_disjunction_and_fail_have_no_solution(lisp):
    assert lisp("(list (prolog '(or)) (prolog '(fail)))") == "(NIL NIL)"


@pytest.mark.law("prolog", 3)
def test_consistent_equalities_give_both_variables_the_common_value(lisp):
    assert lisp("(all '(and (== ?x ?y) (== ?y 3) (== ?x 3)))") == "(((?X . 3) (?Y . 3)))"
    assert lisp("(all '(and (== ?x ?y) (== ?y 3) (== ?x 4)))") == "NIL"


@pytest.mark.law("prolog", 4)
def test_a_disjunction_of_constants_has_a_solution_for_each_that_holds(lisp):
    assert lisp("(all '(or (== 1 2) (== 1 1) (== 1 3)))") == "(NIL)"
    assert lisp("(all '(or (true) (true)))") == "(NIL NIL)"


@pytest.mark.law("prolog", 5)
def test_the_branches_of_a_disjunction_answer_in_the_order_of_the_text(lisp):
    assert lisp("(all '(or (== ?x 1) (== ?x 2)))") == "(((?X . 1)) ((?X . 2)))"


@pytest.mark.law("prolog", 6)
def test_not_of_what_fails_succeeds_once_and_of_what_succeeds_fails(lisp):
    assert lisp("(all '(not (== 1 2)))") == "(NIL)"
    assert lisp("(all '(not (member ?x (1 2))))") == "NIL"


@pytest.mark.law("prolog", 7)
def test_not_binds_nothing(lisp):
    assert lisp("(all '(and (not (and (== ?x 1) (fail))) (not (not (== ?y 2))) (== ?z 3)))") == "(((?Z . 3)))"
    assert lisp("(all '(and (not (== ?x 1)) (== ?x 2)))") == "NIL"


@pytest.mark.law("prolog", 26)
def test_lists_with_a_variable_on_each_side(lisp):
    assert lisp("(all '(== (a ?x c) (a b ?y)))") == "(((?X . B) (?Y . C)))"
    assert lisp("(all '(== (a ?x c) (z b ?y)))") == "NIL"


@pytest.mark.law("prolog", 27)
def test_dotted_patterns(lisp):
    assert lisp("(all '(== (?a . ?b) (1 2 3)))") == "(((?A . 1) (?B 2 3)))"
    assert lisp("(all '(== (?a . ?b) (1)))") == "(((?A . 1) (?B)))"
    assert lisp("(all '(== (?a . ?b) (1 . 2)))") == "(((?A . 1) (?B . 2)))"
    assert lisp("(all '(== (?a ?b) (1 . 2)))") == "NIL"


@pytest.mark.law("prolog", 28)
def test_the_anonymous_variable_matches_different_values_and_never_appears(lisp):
    assert lisp("(all '(== (?_ ?_ ?x) (1 2 3)))") == "(((?X . 3)))"
    assert lisp("(all '(and (member ?_ (1 2)) (== ?_ 5)))") == "(NIL NIL)"


@pytest.mark.law("prolog", 29)
def test_what_atoms_are_the_same(lisp):
    assert (
        lisp("""(list (all '(== "abc" "ABC")) (all '(== 1 1.0)) (all '(== 1.0 1.0d0)) (all '(== #\\a #\\A)) (all '(== a :a))
                         (all '(== #(1) #(1))))""")
        == "(NIL NIL NIL NIL NIL NIL)"
    )
    assert (
        lisp("""(list (all '(== "abc" "abc")) (all '(== 1/2 2/4)) (all '(== #\\a #\\a)) (all '(== nil ())) (all '(== t t)))""")
        == "((NIL) (NIL) (NIL) (NIL) (NIL))"
    )


@pytest.mark.law("prolog", 30)
def test_member_enumerates_in_order(lisp):
    assert lisp("(all '(member ?x (1 2 1)))") == "(((?X . 1)) ((?X . 2)) ((?X . 1)))"
    assert lisp("(list (all '(member ?x ())) (all '(member 1 (1 2 1))))") == "(NIL (NIL NIL))"


@pytest.mark.law("prolog", 31)
def test_a_rule_binds_list_and_element_of_its_caller(lisp):
    assert (
        lisp("""(def-fact-group g () (<- (element ?l ?x) (== ?l (1 2)) (member ?x ?l)))
                   (all '(element ?list ?element))""")
        == "(((?LIST 1 2) (?ELEMENT . 1)) ((?LIST 1 2) (?ELEMENT . 2)))"
    )


@pytest.mark.law("prolog", 37)
def test_an_undefined_functor_warns_and_fails_but_another_arity_fails_silently(lisp):
    assert lisp("(prolog '(nobody-defined-me ?x 1))") == "NIL"
    assert [text.splitlines()[0] for text in lisp.warnings] == [
        "Trying to prove goal (NOBODY-DEFINED-ME ?X 1) with undefined functor NOBODY-DEFINED-ME."
    ]
    lisp.warnings.clear()
    assert (
        lisp("(def-fact-group g () (<- (two 1 2))) (list (prolog '(two 1)) (prolog '(two 1 2 3)) (prolog '(length (1))))")
        == "(NIL NIL NIL)"
    )
    assert lisp.warnings == []


@pytest.mark.law("prolog", 37)
def test_a_functor_that_is_a_variable_is_undefined_even_if_it_is_bound(lisp):
    assert lisp("(all '(and (== ?f true) (?f)))") == "NIL"
    assert lisp("(prolog nil)") == "NIL"
    assert [text.splitlines()[0] for text in lisp.warnings] == [
        "Trying to prove goal (?F) with undefined functor ?F.",
        "Trying to prove goal NIL with undefined functor NIL.",
    ]


@pytest.mark.law("prolog", 38)
def test_only_what_the_first_solution_needs_runs(lisp):
    assert (
        lisp("""(defparameter *answers* (prolog '(or (lisp-pred note a) (lisp-pred note b))))
                   *notes*""")
        == "(A)"
    )
    assert lisp("(lazy-cdr *answers*) *notes*") == "(A B)"
    assert lisp("(length (force-ll *answers*))") == "2"


@pytest.mark.law("prolog", 39)
def test_nested_choices_run_their_side_effects_once_for_the_first_solution(lisp):
    assert (
        lisp("""(defparameter *answers*
                     (prolog '(and (member ?x (1 2)) (lisp-pred note ?x) (member ?y (a b)) (lisp-pred note ?y))))
                   *notes*""")
        == "(1 A)"
    )
    assert lisp("(force-ll *answers*) *notes*") == "(1 A B 2 A B)"


@pytest.mark.law("prolog", 40)
def test_variables_of_clauses_do_not_clash_with_those_of_the_query(lisp):
    assert (
        lisp("""(def-fact-group g () (<- (swapped ?x ?y) (== ?y (?x . ?z)) (== ?z 5)))
                   (all '(and (== ?z 1) (swapped ?y ?x)))""")
        == "(((?Z . 1) (?X ?Y . 5)))"
    )


# ------------------------------------------------------------------------------------ the rest of section 5, and of section 9


def test_bindings_are_in_the_order_of_the_text_and_given_ones_come_last(lisp):
    assert lisp("(all '(and (== ?b 2) (== ?a 1)))") == "(((?B . 2) (?A . 1)))"
    assert lisp("(all '(== ?x ?y) '((?y . 2) (?z . 3)))") == "(((?X . 2) (?Y . 2) (?Z . 3)))"
    assert lisp("(all '(== ?x ?z) '((?z . ?y)))") == "(((?X . ?Y) (?Z . ?Y)))"


def test_an_alias_is_kept(lisp):
    assert lisp("(all '(== ?x ?y))") == "(((?X . ?Y)))"


def test_what_a_clause_leaves_unbound_shows_as_an_uninterned_variable(lisp):
    assert (
        lisp("""(def-fact-group g () (<- (half ?x) (== ?x (1 ?rest))))
                   (let ((value (cdr (assoc '?a (first (all '(half ?a)))))))
                     (list (first value) (is-genvar (second value))))""")
        == "(1 T)"
    )


def test_a_query_that_is_no_list_is_a_type_error(lisp):
    assert lisp.error("(prolog 'foo)") == "The value\n  FOO\nis not of type\n  LIST"
    assert lisp.error("(prolog '?x)") == "The value\n  ?X\nis not of type\n  LIST"


def test_later_solutions_run_in_the_dynamic_environment_of_who_forces_them(lisp):
    assert (
        lisp("""(defvar *here* :top)
                   (defun here () *here*)
                   (let ((answers (let ((*here* :query)) (prolog '(and (member ?x (1 2)) (lisp-fun here ?h))))))
                     (let ((*here* :force)) (force-ll answers)))""")
        == "(((?X . 1) (?H . :QUERY)) ((?X . 2) (?H . :FORCE)))"
    )


def test_results_can_be_read_again(lisp):
    assert (
        lisp("""(let ((answers (prolog '(and (member ?x (1 2)) (lisp-pred note ?x)))))
                     (list (length (force-ll answers)) (length (force-ll answers)) *notes*))""")
        == "(2 2 (1 2))"
    )


def test_bindings_made_before_a_not_stay_in_a_clause(lisp):
    assert (
        lisp("""(def-fact-group g () (<- (p ?x ?y) (== ?x 1) (not (== ?x 2)) (== ?y ?x)))
                   (all '(p ?a ?b))""")
        == "(((?A . 1) (?B . 1)))"
    )


def test_the_hooks_around_a_proof(lisp):
    assert (
        lisp("""(defmethod cut::on-prepare-prolog-prove note-it (query binds) (note query) :id)
                   (defmethod cut::on-finish-prolog-prove note-it (log-id success) (note (list log-id success)))
                   (unwind-protect (progn (all '(true)) (all '(fail)))
                     (remove-method #'cut::on-prepare-prolog-prove
                                    (find-method #'cut::on-prepare-prolog-prove '(note-it) (list (find-class t) (find-class t))))
                     (remove-method #'cut::on-finish-prolog-prove
                                    (find-method #'cut::on-finish-prolog-prove '(note-it) (list (find-class t) (find-class t)))))
                   *notes*""")
        == "((TRUE) (:ID T) (FAIL) (:ID NIL))"
    )
