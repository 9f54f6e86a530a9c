"""Lisp functions and objects as goals (invariants 8 to 19 and 45 to 49, and the rest of sections 7.3 to 8)."""

import pytest


@pytest.mark.law("prolog", 8)
def test_lisp_fun_with_a_result_that_is_bound_already(lisp):
    assert lisp("(all '(and (== ?l (1 2)) (lisp-fun list 1 2 ?l)))") == "(((?L 1 2)))"
    assert lisp("(all '(and (== ?l (1 2)) (lisp-fun list 1 3 ?l)))") == "NIL"


@pytest.mark.law("prolog", 9)
def test_lisp_fun_that_returns_nil_binds_nil(lisp):
    assert lisp("(all '(lisp-fun list ?x))") == "(((?X)))"
    assert lisp("(all '(and (lisp-fun list ?x) (lisp-pred identity ?x)))") == "NIL"


@pytest.mark.law("prolog", 10)
def test_lisp_fun_takes_the_first_of_several_values(lisp):
    assert lisp("(all '(lisp-fun floor 7 2 ?q))") == "(((?Q . 3)))"
    assert lisp("(defun none () (values)) (all '(lisp-fun none ?x))") == "(((?X)))"


@pytest.mark.law("prolog", 11)
def test_lisp_fun_passes_an_unbound_variable_as_its_symbol(lisp):
    assert lisp("(all '(lisp-fun symbol-name ?nobody ?n))") == '(((?N . "?NOBODY")))'


@pytest.mark.law("prolog", 12)
def test_lisp_fun_leaves_variables_in_a_literal_list_alone(lisp):
    assert lisp("(all '(and (== ?a 5) (lisp-fun note (?a b) ?r))) *notes*") == "((?A B))"
    assert lisp("(def-fact-group g () (<- (p ?a) (lisp-pred note (?a b)))) (all '(p 5)) (rest (second *notes*))") == "(B)"
    assert lisp("(is-var (first (second *notes*)))") == "T"


@pytest.mark.law("prolog", 12)
def test_variables_in_returned_data_are_those_of_the_proof(lisp):
    assert lisp("(all '(and (== ?a 5) (lisp-fun identity (?a b) ?r)))") == "(((?A . 5) (?R 5 B)))"


@pytest.mark.law("prolog", 13)
def test_lisp_fun_with_a_result_pattern(lisp):
    assert lisp("(all '(lisp-fun list 1 2 (?p ?q)))") == "(((?P . 1) (?Q . 2)))"
    assert (
        lisp("(list (all '(lisp-fun list 1 2 (?p ?p))) (all '(lisp-fun list 1 1 (?p ?p))) (all '(lisp-fun list 1 ?_)))")
        == "(NIL (((?P . 1))) (NIL))"
    )


@pytest.mark.law("prolog", 14)
def test_an_error_in_lisp_fun_is_one_warning_and_no_solution(lisp):
    assert lisp("(all '(lisp-fun + 1 a ?x))") == "NIL"
    assert lisp.flat_warnings() == ["An error occurred while executing the lisp function `+': `The value A is not of type NUMBER'"]


@pytest.mark.law("prolog", 15)
def test_with_break_on_lisp_errors_the_error_reaches_the_caller(lisp):
    assert lisp.error("(let ((*break-on-lisp-errors* t)) (all '(lisp-fun + 1 a ?x)))") == "The value\n  A\nis not of type\n  NUMBER"
    assert lisp("*break-on-lisp-errors*") == "NIL"
    assert lisp.error("""(let ((*break-on-lisp-errors* t)) (all '(error "no ~a" milk)))""") == "[PROLOG ERROR] no MILK"
    assert lisp.warnings == []


@pytest.mark.law("prolog", 16)
def test_lisp_pred(lisp):
    assert (
        lisp("(list (all '(lisp-pred evenp 3)) (all '(lisp-pred evenp 2)) (all '(and (== ?x 4) (lisp-pred evenp ?x))))")
        == "(NIL (NIL) (((?X . 4))))"
    )
    assert lisp("(all '(lisp-pred evenp a))") == "NIL"
    assert lisp.flat_warnings() == ["An error occurred while executing the lisp predicate `EVENP': `The value A is not of type INTEGER'"]


@pytest.mark.law("prolog", 17)
def test_lisp_pred_with_a_variable_as_predicate_fails_with_a_warning(lisp):
    assert lisp("(all '(and (== ?p evenp) (lisp-pred ?p 2)))") == "NIL"
    package = lisp("(package-name *package*)").strip('"')
    assert [text.splitlines()[0] for text in lisp.warnings] == [
        f"An error occurred while executing the lisp predicate `?P': `The function {package}::?P is undefined.'"
    ]
    assert lisp("(all '(and (== ?f +) (lisp-fun ?f 1 2 ?x) (== ?x 3)))") == "(((?F . +) (?X . 3)))"


@pytest.mark.law("prolog", 18)
def test_bound(lisp):
    assert lisp("(list (all '(bound ?x)) (all '(and (== ?x ?y) (bound ?x))))") == "(NIL NIL)"
    assert (
        lisp("(list (all '(bound 1)) (all '(bound (?x))) (all '(bound nil)) (all '(and (== ?x ?y) (== ?y 1) (bound ?x))))")
        == "((NIL) (NIL) (NIL) (((?X . 1) (?Y . 1))))"
    )


@pytest.mark.law("prolog", 19)
def test_ground(lisp):
    assert lisp("(list (all '(ground (1 ?x))) (all '(and (== ?y (1 ?x)) (ground ?y))) (all '(ground (1 . ?x))))") == "(NIL NIL NIL)"
    assert lisp("(list (all '(ground (1 2))) (all '(and (== ?x 1) (ground (1 (?x))))))") == "((NIL) (((?X . 1))))"


@pytest.mark.law("prolog", 45)
def test_instance_of_makes_and_checks_instances(lisp):
    lisp("(defclass thing () ((size :initform 7 :accessor size))) (defclass small (thing) ())")
    assert (
        lisp("""(all '(and (instance-of small ?o) (slot-value ?o size ?s) (instance-of small ?o) (instance-of thing ?o)
                              (not (instance-of integer ?o)) (filter-bindings (?s))))""")
        == "(((?S . 7)))"
    )
    assert lisp("(let ((g '(instance-of thing ?o))) (eq (query-var '?o #'prolog g) (query-var '?o #'prolog g)))") == "NIL"
    assert lisp("(list (all '(instance-of ?t ?o)) (all '(instance-of ?t 1)))") == "(NIL (((?T . BIT))))"


@pytest.mark.law("prolog", 46)
def test_slot_value_writes_and_get_slot_value_only_reads(lisp):
    lisp("(defclass thing () ((size :initform 7))) (defvar *thing* (make-instance 'thing))")
    assert lisp("(all '(and (symbol-value *thing* ?t) (slot-value ?t size 9) (get-slot-value ?t size 8)))") == "NIL"
    assert lisp("(slot-value *thing* 'size)") == "9"
    assert lisp("(all '(and (symbol-value *thing* ?t) (get-slot-value ?t size ?s) (filter-bindings (?s))))") == "(((?S . 9)))"
    assert lisp("(all '(and (symbol-value *thing* ?t) (slot-value ?t size ?s) (filter-bindings (?s))))") == "(((?S . 9)))"


@pytest.mark.law("prolog", 47)
def test_global_variables(lisp):
    assert lisp("(defvar *there* 1) (all '(and (symbol-value *there* ?x) (set-symbol-value *there* (a ?x))))") == "(((?X . 1)))"
    assert lisp("*there*") == "(A 1)"
    assert lisp("(let ((*there* 5)) (all '(symbol-value *there* ?x)))") == "(((?X . 5)))"
    assert lisp("(list (all '(symbol-value *there* 0)) (all '(symbol-value ?unbound ?x)))") == "(NIL NIL)"
    assert len(lisp.warnings) == 1


@pytest.mark.law("prolog", 48)
def test_string_concat(lisp):
    assert (
        lisp("""(list (all '(string-concat "ab" "cd" ?s)) (all '(string-concat "ab" "cd" "abcd"))
                         (all '(string-concat "a" "b" "x")))""")
        == '((((?S . "abcd"))) (NIL) NIL)'
    )
    assert lisp("""(all '(string-concat ?x "cd" "abcd"))""") == "NIL"
    assert lisp.warnings[0].startswith("An error occurred while executing the lisp function `APPLY': `[PROLOG ERROR] Not implemented.'")


@pytest.mark.law("prolog", 49)
def test_equal(lisp):
    assert (
        lisp("(list (all '(equal ?x 1)) (all '(equal (1 2) (1 2))) (all '(equal (1 ?x) (1 3))) (all '(equal 1 1.0)))")
        == "((((?X . 1))) (NIL) (((?X . 3))) NIL)"
    )


# ------------------------------------------------------------------------------------------- the rest of sections 7.3 to 8


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize(
    "goal, answer",
    [
        ("(< 1 2)", "(NIL)"),
        ("(> 1 2)", "NIL"),
        ("(<= 2 2)", "(NIL)"),
        ("(>= 2.0 2)", "(NIL)"),
        ("(< 1/3 0.5d0)", "(NIL)"),
        ("(length (1 2 3) ?n)", "(((?N . 3)))"),
        ("(length (1 2) 3)", "NIL"),
        ("(length ?l 2)", "NIL"),
        ("(length nil ?n)", "(((?N . 0)))"),
        ("(append (1) (2) ?c)", "(((?C 1 2)))"),
        ("(append (1) ?b (1 2))", "(((?B 2)))"),
        ("(append ?a ?b (1 2))", "(((?A) (?B 1 2)) ((?A 1) (?B 2)) ((?A 1 2) (?B)))"),
        ("(append ?a (2) (1 2))", "(((?A 1)))"),
        ("(append (1) (2) (1 3))", "NIL"),
        ("(append nil nil ?c)", "(((?C)))"),
        ("(append (1 2) ?b (1))", "NIL"),
        ("(sort (3 1 2) < ?s)", "(((?S 1 2 3)))"),
        ("(sort (3 1 2) > ?s)", "(((?S 3 2 1)))"),
        ("(sort ((b 2) (a 1)) < second ?s)", "(((?S (A 1) (B 2))))"),
        ("(sort nil < ?s)", "(((?S)))"),
        ("(sort ?l < ?s)", "NIL"),
        ("(sort (1) ?p ?s)", "NIL"),
        ("(reduce + (1 2 3) ?s)", "(((?S . 6)))"),
        ("(reduce + nil ?s)", "(((?S . 0)))"),
        ("(max (1 3 2) ?m)", "(((?M . 3)))"),
        ("(max (1 3 2) 2)", "NIL"),
        ("(lisp-type 1 ?t)", "(((?T . BIT)))"),
        ("(lisp-type 1 integer)", "(NIL)"),
        ("(lisp-type 1 string)", "NIL"),
        ("(lisp-type 1 no-such-type)", "NIL"),
        ("(lisp-type ?x integer)", "NIL"),
        ("(lisp-type a symbol)", "(NIL)"),
        ("(generate-values ?x (list 1 2))", "(((?X 1 2)))"),
        ("(and (== ?a 1) (generate-values (?x . ?_) (list (?a) 2)))", "(((?A . 1) (?X 1)))"),
        ("(and (== ?a 1) (generate-values 5 (list 1)))", "NIL"),
        ("(assert-type 1 string tag)", "(NIL)"),
        ("(lisp-fun apply + (1 2 3) ?x)", "(((?X . 6)))"),
        ("(lisp-fun list :a 1 ?x)", "(((?X :A 1)))"),
        ("(and (== ?l (3 1 2)) (sort ?l < ?s) (== ?l (3 1 2)))", "(((?L 3 1 2) (?S 1 2 3)))"),
        ("(lisp-fun list)", "(NIL)"),
        ("(lisp-fun random-nothing)", "NIL"),
        ("(and (== ?x 1) (take 2 (1 2 3) ?l) (== ?l (?a ?b)))", "(((?X . 1) (?L 1 2) (?A . 1) (?B . 2)))"),
        ("(and (== ?x 1) (take 2 (1 2 3) (4 ?y)))", "NIL"),
        ("(take 5 (1 2) (?a ?b))", "(((?A . 1) (?B . 2)))"),
        ("(take 0 (1 2) ?l)", "(((?L)))"),
    ],
)
def test_answers(lisp, goal, answer):
    assert lisp(f"(all '{goal})") == answer


def test_goals_that_print_warn_and_err(lisp):
    assert (
        lisp("""(with-output-to-string (*standard-output*) (all '(and (member ?x (1 2)) (format "~a and ~s~%" ?x "s"))))""")
        == '"1 and \\"s\\" 2 and \\"s\\" "'
    )
    assert (
        lisp("""(list (all '(warn "~a bottles" 3)) (all '(warn)) (all '(error "no ~a" milk)) (all '(error)))""") == "((NIL) (NIL) NIL NIL)"
    )
    assert lisp.warnings == [
        "[PROLOG WARNING] 3 bottles",
        "[PROLOG WARNING] ",
        "An error occurred while executing the lisp function `APPLY': `[PROLOG ERROR] no MILK'",
        "An error occurred while executing the lisp function `APPLY': `[PROLOG ERROR] '",
    ]


def test_assert_type_checks_only_while_errors_break(lisp):
    checked = "(let ((*break-on-lisp-errors* t)) (all '(assert-type {} tag)))"
    assert lisp(checked.format("1 integer")) == "(NIL)"
    assert lisp(checked.format("1 (or string integer)")) == "(NIL)"
    assert lisp.error(checked.format("1 string")) == "[TAG]: 1 had to be of type STRING"
    assert lisp.error(checked.format("1 (and integer)")) == "[TAG]: in (AND INTEGER), composite types can only be constructed with OR"


def test_generate_values_needs_a_function(lisp):
    assert lisp.error("(all '(generate-values ?x (no-such-generator 1)))") == "Generator function `NO-SUCH-GENERATOR' not valid"
    assert lisp.error("(all '(generate-values ?x (+ 1 a)))") == "The value\n  A\nis not of type\n  NUMBER"


def test_comparing_what_is_no_number_is_a_warning_and_fails(lisp):
    assert lisp("(all '(< a 2))") == "NIL"
    assert lisp.flat_warnings() == ["An error occurred while executing the lisp predicate `<': `The value A is not of type REAL'"]


def test_conditions_that_are_no_errors_pass_through(lisp):
    lisp("""(define-condition news (condition) ()) (defun tell () (signal 'news) :told)
            (defun leave () (throw 'out :left))""")
    assert lisp("(handler-case (all '(lisp-fun tell ?x)) (news () :heard))") == ":HEARD"
    assert lisp("(all '(lisp-fun tell ?x))") == "(((?X . :TOLD)))"
    assert lisp("(catch 'out (all '(lisp-fun leave ?x)))") == ":LEFT"


@pytest.mark.parametrize("around", ["{}", "(cpl:top-level {})"])
def test_plan_failures_pass_through(lisp, around):
    lisp("""(cpl:define-condition no-milk (cpl:simple-plan-failure) ()) (defun get-milk () (cpl:fail 'no-milk))""")
    form = around.format("(cpl:with-failure-handling ((no-milk (e) (declare (ignore e)) (return :failed))) (all '(lisp-fun get-milk ?x)))")
    assert lisp(form) == ":FAILED"
