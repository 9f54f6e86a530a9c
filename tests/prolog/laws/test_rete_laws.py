"""The memory of facts, and productions (invariants 55 to 59; section 12)."""

import pytest

ON = "(def-production stacked (on ?a ?b) (on ?b ?c)) (defun tell (operation &rest values) (note (cons operation values)))"


@pytest.mark.law("prolog", 55)
def test_facts_of_a_body_fire_a_production_when_they_come_and_go(lisp):
    assert (
        lisp(f"""{ON}
                    (with-production-handlers ((stacked (operation &key ?a ?b ?c) (note (list operation ?a ?b ?c))))
                      (with-facts-asserted ('(on a b) (list 'on 'b 'c)) (note :body)))
                    *notes*""")
        == "((:ASSERT A B C) :BODY (:RETRACT A B C))"
    )
    assert lisp("(list (rete-holds '(on a b)) (rete-holds '(on b c)))") == "(NIL NIL)"


@pytest.mark.law("prolog", 55)
def test_facts_of_a_body_go_on_any_exit(lisp):
    assert lisp("(catch 'out (with-facts-asserted ('(a 1)) (throw 'out (prolog '(rete-holds (a ?x)))))) (rete-holds '(a 1))") == "NIL"
    assert lisp("(ignore-errors (with-facts-asserted ('(a 1) nil) (note :never))) (list (rete-holds '(a 1)) *notes*)") == "(NIL NIL)"


@pytest.mark.law("prolog", 56)
def test_a_repeated_variable_has_one_value(lisp):
    assert (
        lisp("""(def-production twins (?op ?a ?a))
                   (register-production-handler 'twins (lambda (operation &key ?op ?a) (note (list operation ?op ?a))))
                   (rete-assert '(x 1 1)) (rete-assert '(x 1 2)) (rete-assert (list 'x (copy-seq "ss") (copy-seq "ss")))
                   *notes*""")
        == '((:ASSERT X 1) (:ASSERT X "ss"))'
    )


@pytest.mark.law("prolog", 57)
def test_rete_prove_joins_patterns_that_share_a_variable(lisp):
    assert (
        lisp("""(rete-assert '(on a b)) (rete-assert '(on b c)) (rete-assert '(on c d))
                   (mapcar (lambda (b) (mapcar (lambda (v) (var-value v b)) '(?x ?y ?z)))
                           (force-ll (rete-prove '((on ?x ?y) (on ?y ?z)))))""")
        == "((B C D) (A B C))"
    )
    assert lisp("(list (rete-prove nil) (rete-prove nil '((?x . 1))) (rete-prove '((on d ?x))))") == "((NIL) (((?X . 1))) NIL)"
    assert lisp("(force-ll (rete-prove '((on ?x ?y)) '((?x . b))))") == "(((?Y . C) (?X . B)))"


@pytest.mark.law("prolog", 58)
def test_retracting_what_is_not_there(lisp):
    assert lisp.error("(rete-retract '(no such fact))") == "wme-memory already empty. Cannot retract."
    assert lisp.error("(rete-assert '(a)) (rete-retract '(a)) (rete-retract '(a))") == "wme-memory already empty. Cannot retract."


@pytest.mark.law("prolog", 59)
def test_a_handler_gets_keywords_with_their_question_mark(lisp):
    assert (
        lisp(f"""{ON} (register-production-handler 'stacked #'tell)
                    (rete-assert '(on a b)) (rete-assert '(on b c)) *notes*""")
        == "((:ASSERT :?A A :?B B :?C C))"
    )


# --------------------------------------------------------------------------------------------------------------------- facts


def test_facts_are_counted(lisp):
    assert (
        lisp("""(rete-assert '(x 1)) (rete-assert '(x 1)) (rete-retract '(x 1))
                   (list (rete-holds '(x 1)) (progn (rete-retract '(x 1)) (rete-holds '(x 1))))""")
        == "((NIL) NIL)"
    )


def test_rete_holds(lisp):
    assert lisp("""(rete-assert '(on a b)) (rete-assert '(on b b)) (rete-assert '(color a red))
                   (list (force-ll (rete-holds '(on ?x b))) (force-ll (rete-holds '(on ?x ?x))) (rete-holds '(on a b)) (rete-holds '(on a))
                         (force-ll (rete-holds '(on . ?r))) (force-ll (rete-holds '(?_ a ?x))))""") == (
        "((((?X . B)) ((?X . A))) (((?X . B))) (NIL) NIL (((?R B B)) ((?R A B))) (((?X . RED)) ((?X . B))))"
    )


def test_facts_with_content_are_compared_as_prolog_does(lisp):
    """A difference to the original, which compares by ``eql``, see docs/differences.md."""
    assert (
        lisp("""(rete-assert '(name "rob" 1.0 (a)))
                   (list (rete-holds '(name "rob" 1.0 (a))) (rete-holds '(name "rob" 1.0 (a)) #'cl:eql) (rete-holds '(name "bob" 1.0 (a)))
                         (force-ll (rete-holds '(name ?x 1.0 (?y)))))""")
        == '((NIL) NIL NIL (((?Y . A) (?X . "rob"))))'
    )
    assert lisp("(rete-assert '(n 1)) (list (rete-holds '(n 1.0)) (rete-holds '(n 1)))") == "(NIL (NIL))"


def test_object_id_says_what_is_the_same(lisp):
    assert (
        lisp("""(defclass cup () ((name :initarg :name :reader name)))
                   (defmethod object-id ((cup cup)) (name cup))
                   (rete-assert (list 'in (make-instance 'cup :name :red) :shelf))
                   (list (rete-holds (list 'in (make-instance 'cup :name :red) :shelf))
                         (rete-holds (list 'in (make-instance 'cup :name :blue) :shelf)) (object-id 5))""")
        == "((NIL) NIL 5)"
    )


@pytest.mark.parametrize(
    "form, text",
    [
        ("(rete-assert nil)", "The assertion FACT failed: a fact is a list with at least one element."),
        ("(rete-assert '(a ?_))", "The assertion (NOT (FIND '?_ FACT)) failed: the fact (A ?_) contains ?_."),
        ("(register-production-handler 'nobody #'list)", "Production `NOBODY' unknown."),
        ("(remove-production-handler 'nobody #'list)", "Production `NOBODY' unknown."),
    ],
)
def test_what_is_refused(lisp, form, text):
    assert lisp.error(form) == text


def test_the_size_of_the_network(lisp):
    assert lisp("(list (alpha-network-size) (progn (rete-assert '(a b)) (rete-assert '(a c)) (alpha-network-size)))") == "(1 4)"


def test_the_goal_rete_holds(lisp):
    assert lisp("""(rete-assert '(on a b)) (rete-assert '(on b c))
                   (list (all '(rete-holds (on ?x ?y))) (all '(and (== ?y b) (rete-holds (on ?x ?y))))
                         (all '(rete-holds (on c ?x))))""") == ("((((?X . B) (?Y . C)) ((?X . A) (?Y . B))) (((?Y . B) (?X . A))) NIL)")


# --------------------------------------------------------------------------------------------------------------- productions


def test_a_production_prints_its_definition(lisp):
    assert lisp("(def-production p (on ?a ?b) (on ?b ?c))").startswith("#S(CRAM-PROLOG::PRODUCTION-DEFINITION :NAME P :VAR-BINDINGS ")
    assert lisp("(def-production p (on ?a ?b))").endswith(":BODY ((ON ?A ?B)) :NODE NIL :CALLBACKS NIL)")
    assert lisp.warnings == ["Redefining production `P'."]


def test_the_first_handler_gets_the_matches_that_exist_and_the_newest_runs_first(lisp):
    assert (
        lisp("""(def-production p (at ?x)) (rete-assert '(at 1))
                   (register-production-handler 'p (lambda (op &key ?x) (note (list :first op ?x))))
                   (register-production-handler 'p (lambda (op &key ?x) (note (list :second op ?x))))
                   (rete-assert '(at 2)) *notes*""")
        == "((:FIRST :ASSERT 1) (:SECOND :ASSERT 2) (:FIRST :ASSERT 2))"
    )


def test_a_handler_may_be_named_by_a_symbol(lisp):
    assert (
        lisp("""(def-production p (at ?x)) (defun tell (op &key ?x) (note (list op ?x)))
                   (register-production-handler 'p 'tell) (rete-assert '(at 1))
                   (remove-production-handler 'p 'tell) (rete-assert '(at 2)) *notes*""")
        == "((:ASSERT 1))"
    )


def test_each_assertion_fires_and_each_retraction(lisp):
    assert (
        lisp("""(def-production p (at ?x)) (register-production-handler 'p (lambda (op &key ?x) (note (cons op ?x))))
                   (rete-assert '(at 1)) (rete-assert '(at 1)) (rete-retract '(at 1)) (rete-retract '(at 1)) *notes*""")
        == "((:ASSERT . 1) (:ASSERT . 1) (:RETRACT . 1) (:RETRACT . 1))"
    )


def test_a_handler_may_assert_and_retract(lisp):
    assert (
        lisp("""(def-production p (at ?x)) (def-production q (was ?x))
                   (register-production-handler 'p (lambda (op &key ?x) (when (eql op :assert) (rete-assert (list 'was ?x)))))
                   (register-production-handler 'q (lambda (op &key ?x)
                     (note (list op ?x)) (when (eql op :assert) (rete-retract (list 'at ?x)))))
                   (rete-assert '(at 1)) (list *notes* (rete-holds '(at 1)) (rete-holds '(was 1)))""")
        == "(((:ASSERT 1)) NIL (NIL))"
    )


def test_what_is_removed_does_not_fire(lisp):
    assert (
        lisp("""(def-production p (at ?x)) (register-production-handler 'p (lambda (op &key ?x) (note (list op ?x))))
                   (rete-assert '(at 1)) (remove-production 'p) (rete-assert '(at 2)) (rete-retract '(at 1))
                   (list *notes* (remove-production 'p))""")
        == "(((:ASSERT 1)) NIL)"
    )


def test_clearing_the_network_retracts_and_silences_productions(lisp):
    assert (
        lisp("""(def-production p (at ?x)) (register-production-handler 'p (lambda (op &key ?x) (note (list op ?x))))
                   (rete-assert '(at 1)) (clear-alpha-network) (rete-assert '(at 2))
                   (list *notes* (alpha-network-size) (rete-holds '(at 1)))""")
        == "(((:ASSERT 1) (:RETRACT 1)) 3 NIL)"
    )


def test_productions_for_a_body_shadow_without_a_warning(lisp):
    assert (
        lisp("""(def-production p (old ?x))
                   (with-productions ((p (new ?x)))
                     (with-production-handlers ((p (op &key ?x) (note (list op ?x))))
                       (rete-assert '(new 1)) (rete-assert '(old 1))))
                   (rete-assert '(new 2))
                   (with-production-handlers ((p (op &key ?x) (note (list :outer op ?x)))) nil)
                   *notes*""")
        == "((:ASSERT 1) (:OUTER :ASSERT 1))"
    )
    assert lisp.warnings == []
