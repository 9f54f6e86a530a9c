"""The plan walker: ``walk-with-tag-handler``, ``expand-plan`` and its tree (cpl.md 12)."""

import pytest

from cramhy_runtime.languages.commonlisp.faces.cpl import walker
from cramhy_runtime.languages.commonlisp.compiler.analyze import SPECIAL_FORMS
from cramhy_runtime.languages.commonlisp.evaluation import compiler_parts  # noqa: F401  fills SPECIAL_FORMS

TAGS = """(defun tags (form)
            (let (found)
              (walker:walk-with-tag-handler form (lambda (name body) (push (cons name body) found)) nil)
              (nreverse found)))"""
CHILDREN = """(defun outline (node) (cons (list (plan-tree-node-path node) (plan-tree-node-sexp node))
                                          (mapcar #'outline (plan-tree-node-children node))))"""


def test_the_walker_knows_all_special_forms_of_the_compiler():
    assert set(SPECIAL_FORMS) == set(walker.SPECIAL_FORMS) - {walker.DECLARE}


@pytest.mark.law(119)
def test_tags_are_reported_outer_before_inner_in_textual_order_with_their_bodies(plan_text):
    assert plan_text(TAGS + "(tags '(progn (:tag a 1 (:tag b 2)) (when (:tag c 3) (dolist (x y) (:tag d x)))))") == (
        "((A 1 (:TAG B 2)) (B 2) (C 3) (D X))"
    )


@pytest.mark.law(119)
def test_every_tag_counts_under_local_definitions_of_tag_too(plan_text):
    assert (
        plan_text(
            TAGS
            + """(tags '(macrolet ((:tag (&rest x) (declare (ignore x)) nil)) (:tag a 1)
                                         (flet ((:tag (x) (:tag b x))) (:tag c 2))))"""
        )
        == "((A 1) (B X) (C 2))"
    )


def test_quoted_data_and_declarations_are_not_entered(plan_text):
    assert plan_text(TAGS + "(tags '(let ((x '(:tag a 1))) (declare (:tag b 2)) #'(:tag c 3) (quote (:tag d 4)) (:tag e x)))") == "((E X))"


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "form, found",
    [
        ("(let ((x (:tag a 1))) x)", "(A)"),
        ("(let* ((x (:tag a 1)) (y (:tag b x))) y)", "(A B)"),
        ("(flet ((f (&optional (x (:tag a 1))) (:tag b x))) (f))", "(A B)"),
        ("(labels ((f (&key ((:k k) (:tag a 1))) k)) (:tag b 2))", "(A B)"),
        ("(lambda (x &aux (y (:tag a x))) (:tag b y))", "(A B)"),
        ("((lambda (x) (:tag a x)) (:tag b 1))", "(A B)"),
        ("#'(lambda () (:tag a 1))", "(A)"),
        ("(block nil (return-from nil (:tag a 1)))", "(A)"),
        ("(tagbody one (:tag a 1) (go one))", "(A)"),
        ("(setq x (:tag a 1))", "(A)"),
        ("(catch (:tag a 1) (throw 'x (:tag b 2)))", "(A B)"),
        ("(unwind-protect (:tag a 1) (:tag b 2))", "(A B)"),
        ("(multiple-value-bind (x) (:tag a 1) (:tag b 2))", "(A B)"),
        ("(multiple-value-call #'list (:tag a 1))", "(A)"),
        ("(the integer (:tag a 1))", "(A)"),
        ("(eval-when (:execute) (:tag a 1))", "(A)"),
        ("(load-time-value (:tag a 1))", "(A)"),
        ("(progv '(x) (list (:tag a 1)) (:tag b 2))", "(A B)"),
        ("(if (:tag a 1) (:tag b 2) (:tag c 3))", "(A B C)"),
        ("(handler-case (:tag a 1) (error (e) (:tag b e)))", "(A B)"),
        ("(with-failure-handling ((plan-failure (e) (:tag a e))) (:tag b 1))", "(A B)"),
        ("(par (:tag a 1) (pursue (:tag b 2)))", "(A B)"),
        ("(symbol-macrolet ((x (:tag a 1))) (list x x))", "(A A)"),
        ("(macrolet ((m (y) `(:tag a ,y))) (m 3))", "(A)"),
        ("(flet ((when (x) x)) (when (:tag a 1)))", "(A)"),
        ("(loop for x in y do (:tag a x))", "(A)"),
        ("(setf (car (:tag a 1)) 2)", "(A)"),
        ("(defun f () (:tag a 1))", "(A)"),
    ],
)
def test_the_walk_goes_through_every_kind_of_form(plan_text, form, found):
    assert plan_text(TAGS + f"(sort (mapcar #'first (tags '{form})) #'string<)") == found


def test_the_expansion_has_no_macro_calls_left_and_its_tags_stay(plan_text):
    assert plan_text("(walker:walk-with-tag-handler '(when (unless a b) (:tag c (unless d e))) #'list nil)") == (
        "(IF (IF A NIL B) (:TAG C (IF D NIL E)))"
    )


def test_what_is_walked_means_the_same(plan_text):
    assert (
        plan_text("""(eval (walker:walk-with-tag-handler
        '(macrolet ((twice (x) `(list ,x ,x)))
           (let ((n 0))
             (symbol-macrolet ((next (incf n)))
               (flet ((f (&optional (y next) &key (z next)) (list y z)))
                 (setf n (+ n 10))
                 (list (twice next) (f) (f 1 :z 2) (loop for i below 3 collect (* i i)) (handler-case (error "x") (error () :caught))
                       (let ((next 5)) next) (multiple-value-list (values 1 2)) (case n (1 2) (t n)))))))
        #'list nil))""")
        == "((11 12) (13 14) (1 2) (0 1 4) :CAUGHT 5 (1 2) 14)"
    )


def test_a_walk_can_go_on_from_a_lexical_environment(plan_text):
    assert (
        plan_text("""(defmacro names (form &environment env)
                          (let (found) (walker:walk-with-tag-handler form (lambda (name body) (declare (ignore body))
                              (push name found)) env)
                            `',found))
        (macrolet ((m () '(:tag inside 1))) (names (m)))""")
        == "(INSIDE)"
    )


def test_a_form_that_cannot_be_called_is_an_error(plan_text):
    assert plan_text.error("(walker:walk-with-tag-handler '(progn (5 6)) #'list nil)").startswith(
        "cramhy: SIMPLE-ERROR\n  Invalid form (5 6).\n"
    )


def test_malformed_forms_are_walked_as_far_as_they_are_forms(plan_text):
    for form in (
        "(let x (:tag a 1))",
        "(let (x . y) (:tag a 1))",
        "(flet (5) (:tag a 1))",
        "(progn . (:tag a 1))",
        "(let)",
        "(lambda)",
        "(multiple-value-bind)",
        "(setq x)",
        "(block)",
        "(macrolet (5) 1)",
    ):
        plan_text(f"(walker:walk-with-tag-handler '{form} #'list nil)")


# ------------------------------------------------------------------------------------------------------------- expand-plan


def test_expand_plan_makes_a_node_for_each_tag_with_nested_ones_below(plan_text):
    assert plan_text(CHILDREN + "(outline (expand-plan '(par (:tag a (:tag b 1)) (:tag c 2))))") == (
        "((NIL (PAR (:TAG A (:TAG B 1)) (:TAG C 2))) ((((TAGGED A)) (:TAG A (:TAG B 1))) ((((TAGGED B) (TAGGED A)) (:TAG B 1)))) "
        "((((TAGGED C)) (:TAG C 2))))"
    )
    assert plan_text("(nth-value 1 (expand-plan '(when x (:tag a 1))))") == "(IF X (:TAG A 1) NIL)".replace(" NIL)", ")")
    assert (
        plan_text(
            "(let ((root (expand-plan '(:tag a 1)))) (list (plan-tree-node-parent root)"
            "(eq root (plan-tree-node-parent (first (plan-tree-node-children root))))))"
        )
        == "(NIL T)"
    )


def test_expand_plan_follows_the_calls_of_plan_functions(plan_text):
    """Repaired: the original looks for their properties under a symbol of the wrong package, and follows none."""
    assert plan_text(
        CHILDREN
        + """(def-cram-function fetch (x) (:tag grasp x)) (def-top-level-cram-function breakfast () (fetch 1))
        (mapcar (lambda (node) (outline node)) (plan-tree-node-children (expand-plan '(progn (fetch (:tag look 1)) (breakfast)))))"""
    ) == (
        "(((((FETCH)) (FETCH (:TAG LOOK 1))) ((((TAGGED GRASP) (FETCH)) (:TAG GRASP X)))) ((((TAGGED LOOK)) (:TAG LOOK 1))) "
        "((((TOP-LEVEL BREAKFAST)) (BREAKFAST)) ((((FETCH) (TOP-LEVEL BREAKFAST)) (FETCH 1)) "
        "((((TAGGED GRASP) (FETCH) (TOP-LEVEL BREAKFAST)) (:TAG GRASP X))))))"
    )


def test_expand_plan_does_not_follow_a_plan_function_that_a_local_function_hides(plan_text):
    assert plan_text("""(def-cram-function fetch () (:tag grasp 1))
        (list (plan-tree-node-children (expand-plan '(flet ((fetch () 1)) (fetch))))
              (mapcar #'plan-tree-node-path (plan-tree-node-children (expand-plan '(flet ((fetch () (fetch))) (fetch))))))""") == (
        "(NIL (((FETCH))))"
    )


def test_a_plan_that_calls_itself_ends_in_a_leaf(plan_text):
    assert plan_text(
        CHILDREN
        + """(def-cram-function ping () (pong)) (def-cram-function pong () (ping) (pong))
        (labels ((paths (node) (cons (plan-tree-node-path node) (mapcan #'paths (plan-tree-node-children node)))))
          (paths (expand-plan '(ping))))"""
    ) == ("(NIL ((PING)) ((PONG) (PING)) ((PING) (PONG) (PING)) ((PONG) (PONG) (PING)))")


def test_a_node_is_found_by_the_path_that_its_task_has_when_the_plan_runs(plan_text):
    assert plan_text("""(def-cram-function fetch () (:tag grasp (note *current-path*)))
        (defparameter *form* '(with-tags (:tag left (fetch))))
        (eval `(top-level ,*form*))
        (let* ((tree (expand-plan *form*)) (node (find-plan-node tree (first *notes*))))
          (list (plan-tree-node-sexp node) (eq tree (find-plan-node tree nil)) (find-plan-node tree '((nowhere)))))""") == (
        "((:TAG GRASP (NOTE *CURRENT-PATH*)) T NIL)"
    )


def test_a_plan_tree_node_prints_itself_and_what_is_below(plan_text):
    assert plan_text('(let ((*print-pretty* nil)) (format nil "~s" (expand-plan \'(progn (:tag a 1)))))') == (
        '"#(PLAN-TREE-NODE :SEXP (PROGN (:TAG A 1)) :PATH NIL '
        ':CHILDREN (#(PLAN-TREE-NODE :SEXP (:TAG A 1) :PATH ((TAGGED A)) :CHILDREN NIL)))"'
    )


# --------------------------------------------------------------------------------------------- what with-tags does with the walk


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "form, message, place",
    [
        ("(let x 1)", "LET needs a list where it has X.", "2:6"),
        ("(dolist 5 1)", "The DOLIST form (DOLIST 5 1) is malformed", "2:6"),
        ("(macrolet ((m (x y) (list x y))) (m 1))", "Error while parsing arguments to MACROLET M", "2:39"),
        ("(macrolet ((m (x) (setq x))) (m 1))", "SETQ takes pairs of a variable and a value", "2:24"),
        ("(macrolet ((m (x) (car x))) (m 1))", "Execution of a form compiled with errors.\n  Form:\n    (M 1)\n", "2:34"),
    ],
)
def test_an_error_in_a_body_with_tags_is_told_once_and_at_its_own_place(plan_text, form, message, place):
    shown = plan_text.error(f"(top-level (with-tags\n     {form}\n     (:tag a 1)))")
    assert message in shown
    assert f"  at <repl>:{place}\n" in shown


def test_a_warning_in_a_body_with_tags_is_told_once(plan_text, capsys):
    plan_text('(defmacro shout (x) (warn "~a is loud." x) x)')
    capsys.readouterr()
    assert plan_text("(top-level (with-tags (:tag a (let ((unused 1)) (shout 2)))))") == "2"
    told = capsys.readouterr().err
    assert told.count("is loud") == 1 and told.count("The variable UNUSED is defined but never used.") == 1


def test_a_with_tags_in_a_with_tags_is_not_walked_again_and_again(plan_text):
    depth = 12
    plan_text("(defvar *expansions* 0) (defmacro counted (x) (incf *expansions*) x)")
    assert plan_text("(top-level " + "(with-tags (:tag a " * depth + "(counted 7)" + "))" * depth + ")") == "7"
    assert int(plan_text("*expansions*")) <= 3


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "body, value",
    [
        ("`(1 ,(:tag a 2))", "(1 2)"),
        ("(list (symbol-macrolet ((x (:tag a 3))) x))", "(3)"),
        ("(list `#(1 ,(:tag a 4)))", "(#(1 4))"),
        ("(length '#1=(:tag . #1#))", None),
        ("(list (car '#1=(:tag . #1#)) (:tag a 5))", "(:TAG 5)"),
        ("(list (length #1=#(1 #1#)))", "(2)"),
    ],
)
def test_tags_are_found_wherever_code_is_and_data_that_contains_itself_ends_the_search(plan_text, body, value):
    if value is not None:
        assert plan_text(f"(top-level (with-tags {body}))") == value
    else:
        assert plan_text(f"(top-level (with-tags (when nil {body})))") == "NIL"


def test_a_global_symbol_macro_may_be_a_tag(plan_text):
    assert plan_text("(define-symbol-macro look-around (:tag look 6)) (top-level (with-tags (list look-around (task-path look))))") == (
        "(6 ((TAGGED LOOK)))"
    )


def test_choose_of_the_utilities_makes_a_tag(plan_text):
    assert (
        plan_text("""(top-level (with-tags (cut:choose pose :parameters (x) :generators ((list 1))
                                                           :body (list x (task-path pose)))))""")
        == "((1) ((TAGGED POSE)))"
    )


def test_a_macro_that_expands_into_itself_is_told_and_not_followed_for_ever(plan_text):
    plan_text("(defmacro again (x) `(again ,x))")
    for form in ("(expand-plan '(again 1))", "(top-level (with-tags (again 1)))"):
        assert "The expansion of AGAIN does not end: after 10000 expansions there is still a macro call." in plan_text.error(form)
