"""Fact groups: definition, extension, redefinition, what is refused (invariants 32 to 36; section 6)."""

import pytest


@pytest.mark.law("prolog", 32)
def test_two_groups_may_define_one_predicate(lisp):
    assert (
        lisp("""(def-fact-group one () (<- (p 1)) (<- (p 2)))
                   (def-fact-group two (p) (<- (p 3)))
                   (all '(p ?x))""")
        == "(((?X . 1)) ((?X . 2)) ((?X . 3)))"
    )


@pytest.mark.law("prolog", 33)
def test_only_a_listed_predicate_may_be_extended(lisp):
    lisp("(def-fact-group one () (<- (p 1))) (def-fact-group two (p) (<- (p 2)))")
    assert lisp.error("(def-fact-group three (q) (<- (q 1)) (<- (p 3)))") == (
        "Functor P is being redefined in fact-group THREE.\n                Other definitions were in fact-groups (ONE TWO)."
    )
    assert lisp("(list (all '(p ?x)) (all '(q ?x)))") == "((((?X . 1)) ((?X . 2))) NIL)"
    assert lisp("(def-fact-group four (nobody-has-this) (<- (q 1))) (all '(q ?x))") == "(((?X . 1)))"


@pytest.mark.law("prolog", 34)
def test_a_redefinition_replaces_the_clauses_of_its_group_and_moves_it_to_the_end(lisp):
    assert (
        lisp("""(def-fact-group one () (<- (p 1)) (<- (q 1)))
                   (def-fact-group two (p) (<- (p 2)))
                   (def-fact-group one (p) (<- (p 3)))
                   (all '(p ?x))""")
        == "(((?X . 2)) ((?X . 3)))"
    )
    assert lisp.warnings == ["Redefining prolog fact-group ONE."]
    assert lisp("(handler-case (all '(q ?x)) (warning () :undefined))") == ":UNDEFINED"
    assert lisp("""(handler-case (def-fact-group two (p)) (style-warning (warning) (type-of warning)))""") == "SB-INT:SIMPLE-STYLE-WARNING"


@pytest.mark.law("prolog", 35)
def test_a_fact_outside_of_a_group(lisp):
    assert lisp.error("(<- (foo 1))") == "Facts cannot be declared outside fact-groups."
    assert lisp("(defun later () (<- (foo 1))) :compiled") == ":COMPILED"


@pytest.mark.law("prolog", 36)
@pytest.mark.parametrize("functor", ["?x", "5", "nil", '"foo"', "(a)"])
def test_a_head_needs_a_functor(lisp, functor):
    shown = lisp(f"(princ-to-string '{functor})").strip('"')
    assert (
        lisp.error(f"(def-fact-group g () (<- (fine 1)) (<- ({functor} 1)))") == f"Functor {shown} of fact head ({shown} 1) is not valid."
    )
    assert lisp("(handler-case (all '(fine ?x)) (warning () :undefined))") == ":UNDEFINED"


@pytest.mark.parametrize("name", ["?x", "5", "nil", '"foo"'])
def test_an_extendable_predicate_needs_a_functor(lisp, name):
    shown = lisp(f"(princ-to-string '{name})").strip('"')
    assert lisp.error(f"(def-fact-group g ({name}) (<- (fine 1)))") == (
        f"Extendible predicates in the definition of fact group G\n            contained an invalid functor {shown}."
    )


def test_a_head_that_is_an_atom_is_a_type_error(lisp):
    assert lisp.error("(def-fact-group g () (<- foo))") == "The value\n  FOO\nis not of type\n  LIST"


def test_the_value_of_a_group(lisp):
    assert lisp("(def-fact-group g () (<- (p 1)) (<- (q ?x) (p ?x)) (<- (p 2)))") == "((P ((P 1)) ((P 2))) (Q ((Q #:?X) (P #:?X))))"
    assert lisp("(def-fact-group g ())") == "NIL"


def test_facts_may_come_from_loops_and_macros(lisp):
    assert (
        lisp("""(defmacro numbers (&rest list) `(progn ,@(loop for n in list collect `(<- (number ,n)))))
                   (def-fact-group g () (numbers 1 2) (when (> 1 2) (<- (number 99))) (dotimes (i 2) (<- (twice yes))))
                   (list (all '(number ?n)) (length (all '(twice ?x))))""")
        == "((((?N . 1)) ((?N . 2))) 2)"
    )


def test_built_in_groups_can_be_extended_and_given_back(lisp):
    assert lisp.error("(def-fact-group g () (<- (member own ?_)))") == (
        "Functor MEMBER is being redefined in fact-group G.\n                Other definitions were in fact-groups (LIST-UTILS)."
    )
    assert lisp("(def-fact-group g (member) (<- (member own ?_))) (all '(member ?x (1)))") == "(((?X . 1)) ((?X . OWN)))"
    assert lisp("(def-fact-group g ()) (all '(member ?x (1)))") == "(((?X . 1)))"


def test_facts_added_by_a_query_are_not_seen_by_goals_already_entered(lisp):
    assert (
        lisp("""(def-fact-group one () (<- (p 1)) (<- (p 2)))
                   (let ((answers (prolog '(p ?x))))
                     (def-fact-group two (p) (<- (p 3)))
                     (list (length (force-ll answers)) (length (all '(p ?x)))))""")
        == "(2 3)"
    )


def test_a_handler_comes_before_the_facts_for_its_functor(lisp):
    assert (
        lisp("""(def-prolog-handler limited (bdgs n result)
                     (let ((n (var-value n bdgs)))
                       (lazy-mapcan (lambda (i) (multiple-value-bind (new ok) (unify result i bdgs) (when ok (list new))))
                                    (loop for i below n collect i))))
                   (def-fact-group g () (<- (limited ?_ none)))
                   (list (all '(limited 2 ?x)) (all '(limited 0 ?x)) (all '(and (== ?n 1) (limited ?n ?x)))
                         (all '(limited 3 2)))""")
        == "((((?X . 0)) ((?X . 1))) (((?X . NONE))) (((?N . 1) (?X . 0))) (NIL))"
    )


def test_a_handler_may_be_redefined(lisp):
    assert (
        lisp("""(def-prolog-handler mine (bdgs) (declare (ignore bdgs)) nil)
                   (def-prolog-handler mine (bdgs &rest pattern) (when pattern (list bdgs bdgs)))
                   (list (all '(mine)) (all '(mine 1)) (all '(mine 1 2)))""")
        == "(NIL (NIL NIL) (NIL NIL))"
    )


@pytest.mark.law("prolog", 60)
def test_query_var(lisp):
    assert (
        lisp("""(list (query-var '?x #'prolog '(member ?x (4 5))) (query-var '?x #'prolog '(fail))
                         (query-var '?x #'prolog '(== ?x ?y)))""")
        == "(4 NIL ?Y)"
    )
    assert lisp("(list (query-var '?z 'prolog '(== ?x 1)) (query-var '?x #'prolog '(== ?x ?y) '((?y . 2))))") == "(?Z 2)"
    assert lisp("(query-var '?x (lambda (&rest all) (list (list (cons '?x all)))) '(a) 1 2)") == "((A) 1 2)"


def test_the_function_filter_bindings(lisp):
    assert lisp("(filter-bindings '(foo ?x ?y) '((?z . 1) (?y . 2) (?x . ?z)))") == "((?X . 1) (?Y . 2))"
    assert lisp("(filter-bindings '?x '((?x . 1) (?y . 2)) '((?y . 2)))") == "((?X . 1) (?Y . 2))"
