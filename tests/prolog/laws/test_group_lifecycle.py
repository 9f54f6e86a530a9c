"""Fact groups at the REPL: what stays in force when a definition goes wrong, and what a proof that is under way sees."""

import pytest

FAMILY = "(def-fact-group family () (<- (parent tom bob)) (<- (parent bob ann)))"


@pytest.mark.parametrize(
    "definition",
    [
        "(def-fact-group family () (<- (parent a b)) (<- (?x 1)))",
        "(def-fact-group family () (<- (parent a b)) (<- parent))",
        "(def-fact-group family () (<- (parent a b)) (<- (member a b)))",
        "(def-fact-group family (5) (<- (parent a b)))",
        '(def-fact-group family () (<- (parent a b)) (error "No milk.") (<- (parent c d)))',
        "(def-fact-group family () (<- (parent a b)) (throw 'out nil) (<- (parent c d)))",
        "(def-fact-group family () (<- (parent a b)) (no-such-function))",
    ],
)
def test_a_definition_that_fails_leaves_the_old_group_in_force(lisp, definition):
    lisp(FAMILY)
    assert (
        lisp(f"(catch 'out (ignore-errors {definition}) :failed) (all '(parent ?x ?y))")
        == "(((?X . TOM) (?Y . BOB)) ((?X . BOB) (?Y . ANN)))"
    )


def test_a_definition_that_is_given_up_at_its_warning_changes_nothing(lisp):
    lisp(FAMILY)
    assert (
        lisp("""(handler-case (def-fact-group family () (<- (parent a b))) (style-warning () :left))
                   (length (all '(parent ?x ?y)))""")
        == "2"
    )


def test_a_group_stays_where_it_is_in_the_order_when_its_redefinition_fails(lisp):
    assert (
        lisp("""(def-fact-group one () (<- (p 1))) (def-fact-group two (p) (<- (p 2)))
                   (ignore-errors (def-fact-group one () (<- (p 3))))
                   (all '(p ?x))""")
        == "(((?X . 1)) ((?X . 2)))"
    )


def test_an_answer_that_is_still_being_searched_keeps_the_clauses_of_the_goals_it_has_entered(lisp):
    assert (
        lisp("""(def-fact-group g () (<- (p 1)) (<- (p 2)) (<- (p ?x) (== ?x 3)) (<- (q ?x ?y) (p ?x) (r ?y)) (<- (r old)))
                   (let ((answers (prolog '(q ?x ?y))))
                     (def-fact-group g () (<- (p new)) (<- (q new new)) (<- (r new)))
                     (list (mapcar (lambda (b) (cdr (assoc '?x b))) (force-ll answers)) (all '(q ?x ?y))))""")
        == "((1 2 3) (((?X . NEW) (?Y . NEW))))"
    )


def test_a_query_may_redefine_the_group_that_it_is_about(lisp):
    assert (
        lisp("""(defun redefine () (handler-bind ((warning #'muffle-warning)) (def-fact-group g () (<- (p 9)))) t)
                   (def-fact-group g () (<- (p 1)) (<- (p 2)) (<- (q ?x ?y) (p ?x) (lisp-pred redefine) (p ?y)))
                   (all '(q ?x ?y))""")
        == "(((?X . 1) (?Y . 9)) ((?X . 2) (?Y . 9)))"
    )


def test_a_built_in_group_that_was_redefined_can_be_given_back(lisp):
    assert (
        lisp("""(def-fact-group cram-prolog::string-utils () (<- (string-concat ?a ?b (?a ?b))))
                   (unwind-protect (all '(string-concat "a" "b" ?s)) (cram-prolog::restore-fact-group 'cram-prolog::string-utils))""")
        == '(((?S "a" "b")))'
    )
    assert lisp("""(all '(string-concat "a" "b" ?s))""") == '(((?S . "ab")))'
    assert (
        lisp("""(def-fact-group cram-prolog::list-utils ())
                   (unwind-protect (list (all '(member 1 (1))) (all '(== 1 1)))
                     (cram-prolog::restore-fact-group 'cram-prolog::list-utils))""")
        == "(NIL (NIL))"
    )
    assert lisp("(all '(member 1 (1)))") == "(NIL)"
    assert lisp.error("(cram-prolog::restore-fact-group 'my-group)") == "MY-GROUP is not a fact group that came with CRAM-PROLOG."


def test_a_big_group_is_defined_and_answers_by_any_argument(lisp):
    assert (
        lisp("""(defmacro squares (n) `(progn ,@(loop for i below n collect `(<- (square ,i ,(* i i))))))
                   (def-fact-group big () (squares 2000))
                   (list (all '(square 1999 ?x)) (all '(square ?x 1522756)))""")
        == "((((?X . 3996001))) (((?X . 1234))))"
    )
