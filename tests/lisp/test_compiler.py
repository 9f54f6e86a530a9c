"""What the compiler says to a wrong program, and what it keeps for tasks, tracebacks and deep recursion.

What right programs mean is compared with SBCL in ``test_compiler_against_sbcl.py``.
"""

from __future__ import annotations

import warnings

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.compiler import facts, nodes, support
from cramhy_runtime.languages.commonlisp.compiler.generator import functions
from cramhy_runtime.lisp_core.conditions import CompileError, Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.packages.package_errors import SymbolPackageLockedError
from cramhy_runtime.repl.session import condition_of


@pytest.fixture
def evaluate(session):
    session.package = "CL-USER"

    def run(text):
        return " ; ".join(" ".join(prin1_to_string(value).split()) for value in session.evaluate_text(text))

    return run


SHAPE = "malformed: it has the wrong number of parts, or a part is not a list."
MALFORMED = [
    ("(let x 1)", "LET needs a list where it has X."),
    ("(let (x . y) 1)", "LET needs a list where it has (X . Y)."),
    ("(let ((x 1 2)) x)", "A binding is a variable or (variable value), not (X 1 2)."),
    ("(let ((x 1) (x 2)) x)", "The variable X occurs more than once in the LET."),
    ("(let ((nil 1)) 1)", "NIL cannot be bound: a variable must be a symbol that is not a constant."),
    ("(let ((:a 1)) 1)", ":A cannot be bound: a variable must be a symbol that is not a constant."),
    ("(let ((pi 3)) pi)", "The constant PI cannot be bound."),
    ("(setq pi 3)", "PI cannot be assigned."),
    ("(setq 5 1)", "5 cannot be assigned."),
    ("(setq x)", "SETQ takes pairs of a variable and a value, but here it is (SETQ X)."),
    ("(setf x)", "SETF takes pairs of a place and a value, but the last place of (SETF X) has no value."),
    ("(setf 5 1)", "5 is not a place that SETF can assign."),
    ("(if)", "IF takes 2 to 3 parts, but here it is (IF)."),
    ("(quote 1 2)", "QUOTE takes 1 part, but here it is (QUOTE 1 2)."),
    ("(return-from nowhere 1)", "return for unknown block: NOWHERE"),
    ("(return 1)", "return for unknown block: NIL"),
    ("(go nowhere)", "attempt to GO to nonexistent tag: NOWHERE"),
    ("(flet ((f)) 1)", "A local function is (name lambda-list . body), not (F)."),
    ("(flet ((5 () 1)) 1)", "5 is not a name of a function."),
    ("(function when)", "WHEN names a macro, not a function, so #' cannot refer to it."),
    ("(function 5)", "5 is not a name of a function."),
    ("(1 2)", "1 cannot be called: the head of a form must be a symbol or a lambda expression."),
    ("((f) 2)", "(F) cannot be called: the head of a form must be a symbol or a lambda expression."),
    ("(list . 5)", "The form (LIST . 5) ends in a dot."),
    ("(list 1 . 5)", "The form (LIST 1 . 5) ends in a dot."),
    ("(progn (declare (fixnum x)) 1)", None),
    ("(lambda (a a) 1)", "The variable A occurs more than once in the lambda list."),
    ("(lambda (&key a &optional b) 1)", "The lambda list (&KEY A &OPTIONAL B) is malformed: &OPTIONAL is misplaced or occurs twice."),
    ("(lambda (&rest) 1)", "The lambda list (&REST) is malformed: a variable must follow &REST."),
    ("(lambda (&rest a b) 1)", "The lambda list (&REST A B) is malformed: only one variable may follow &REST."),
    ("(lambda ((a)) 1)", "The lambda list ((A)) is malformed: a parameter must be a symbol."),
    ("(lambda (a . b) 1)", "The lambda list (A . B) is malformed: it ends in a dot."),
    ("(symbol-macrolet ((x)) 1)", "A symbol macro is (name expansion), not (X)."),
    ("(macrolet 5 1)", "MACROLET needs a list where it has 5."),
    ("(eval-when 5 5)", "EVAL-WHEN needs a list where it has 5."),
    ("(block 5 1)", "A block must be named by a symbol, not 5."),
    ("(dolist (x) 1)", f"The DOLIST form (DOLIST (X) 1) is {SHAPE}"),
    ("(push 1)", f"The PUSH form (PUSH 1) is {SHAPE}"),
    ("(handler-case 1 2)", f"The HANDLER-CASE form (HANDLER-CASE 1 2) is {SHAPE}"),
]


@pytest.mark.soak(all_but=15)
@pytest.mark.parametrize(("text", "report"), MALFORMED)
def test_a_malformed_form_is_a_compile_error_with_its_place(session, text, report):
    session.package = "CL-USER"
    with pytest.raises(CompileError) as caught:
        session.evaluate_text(text)
    assert caught.value.position[1:] == (1, 1) or report is None
    assert report is None or " ".join(caught.value.report().split()) == report


def test_a_name_of_common_lisp_is_locked(session):
    session.package = "CL-USER"
    with pytest.raises(SymbolPackageLockedError) as caught:
        session.evaluate_text("(defun car (x) x)")
    assert caught.value.position[1:] == (1, 1)
    assert " ".join(caught.value.report().split()) == (
        "Lock on package COMMON-LISP violated when setting fdefinition of CAR while in package COMMON-LISP-USER."
    )
    assert caught.value.hint == "Choose another name, or shadow the symbol: (:shadow #:car) in the definition of your package."


def test_the_place_is_that_of_the_innermost_form(session):
    session.package = "CL-USER"
    with pytest.raises(CompileError) as caught:
        session.evaluate_text("(defun f (x)\n  (when x\n    (list 1\n          (return-from g 2))))")
    assert caught.value.position[1:] == (4, 11)


def test_a_compile_error_costs_nothing(evaluate):
    with pytest.raises(CompileError):
        evaluate("(defun broken (x) (let ((x 1 2)) x))")
    assert evaluate("(fboundp 'broken)") == "NIL"
    assert evaluate("(handler-case (eval '(let ((x 1 2)) x)) (program-error () 'caught))") == "CAUGHT"


COUNTS = [
    ("(defun two (a b) (list a b))", "(two 1)", "1", "two takes 2 arguments."),
    ("(defun two (a b) (list a b))", "(two 1 2 3)", "3", "two takes 2 arguments."),
    ("(defun opt (a &optional b) (list a b))", "(opt)", "0", "opt takes 1 to 2 arguments."),
    ("(defun more (a &rest b) (list a b))", "(more)", "0", "more takes at least 1 argument."),
    ("(defun none () 1)", "(none 1)", "1", "none takes 0 arguments."),
    ("(defvar *kept* (list (lambda (a &rest b) (list a b))))", "(funcall (first *kept*))", "0", "the function takes at least 1 argument."),
    ("(defvar *both* (list (lambda (a b) (list a b))))", "(funcall (first *both*) 1)", "1", "the function takes 2 arguments."),
]


@pytest.mark.parametrize(("definition", "call", "given", "hint"), COUNTS)
def test_a_wrong_number_of_arguments(evaluate, definition, call, given, hint):
    evaluate(definition)
    with pytest.raises((TypeError, Condition)) as caught:
        evaluate(call)
    condition = condition_of(caught.value)
    assert (condition.report(), condition.hint.lower()) == (f"invalid number of arguments: {given}", hint)
    assert evaluate(f"(handler-case {call} (program-error (c) (princ-to-string c)))") == f'"invalid number of arguments: {given}"'


@pytest.mark.parametrize(
    "call",
    [
        "(funcall (lambda (a b) a) 1)",
        "(flet ((loc (a b) (list a b))) (loc 1))",
        "(mapcar (lambda (a b) a) '(1))",
        "(apply #'cons '(1))",
        "(let ((f (lambda (a b) a))) (block nil (funcall f 1)))",
    ],
)
def test_a_wrong_number_of_arguments_of_functions_without_a_name(evaluate, call):
    assert evaluate(f"(handler-case {call} (program-error (c) (princ-to-string c)))") == '"invalid number of arguments: 1"'


def test_recursion_is_as_deep_as_a_student_needs(evaluate):
    evaluate("(defun deep (n) (if (= n 0) 0 (+ 1 (deep (- n 1)))))")
    assert evaluate("(deep 4000)") == "4000"


def test_endless_recursion_is_a_storage_condition(evaluate):
    evaluate("(defun endless (n) (+ 1 (endless n)))")
    assert evaluate("(handler-case (endless 1) (storage-condition () 'exhausted))") == "EXHAUSTED"
    assert evaluate("(handler-case (endless 1) (error () 'error) (serious-condition () 'serious))") == "SERIOUS"
    assert evaluate("(+ 1 1)") == "2"


def test_a_special_variable_belongs_to_the_task_that_bound_it(session):
    session.package = "CRAM-USER"
    values = session.evaluate_text("""
      (progn
        (defvar *mine* 'global)
        (let ((seen nil))
          (top-level
            (let ((*mine* 'outer))
              (par
                (let ((*mine* 'first)) (sleep 1) (push (list 1 *mine*) seen))
                (let ((*mine* 'second)) (sleep 2) (push (list 2 *mine*) seen))
                (progn (sleep 3) (push (list 3 *mine*) seen))))
            (push *mine* seen))
          (reverse seen)))""")
    assert " ".join(prin1_to_string(values[0]).split()) == "((1 FIRST) (2 SECOND) (3 GLOBAL) GLOBAL)"


def test_definitions_in_a_scope_at_top_level_are_known_to_the_next_form(evaluate):
    assert evaluate("(macrolet ((def (n) `(defmacro ,n () ''hello))) (def greet) (greet))") == "HELLO"
    assert evaluate("(locally (declare (optimize speed)) (defmacro five () 5) (five))") == "5"
    assert evaluate("(symbol-macrolet ((a 1)) (defmacro six () 6) (list a (six)))") == "(1 6)"


def test_a_lisp_name_may_be_any_name_of_python(evaluate):
    assert (
        evaluate(
            "(let ((class 1) (def 2) (import 3) (none 5) (true 6) (lone 7) (k1 8) (int 9)) "
            "(list class def import none true lone k1 (+ int 1)))"
        )
        == "(1 2 3 5 6 7 8 10)"
    )
    assert (
        evaluate(
            "(let ((|Lone| 1) (|K1| 2) (|Lpc| 3) (|Lexit| 4) (|Lint| 5)) "
            "(list |Lone| |K1| |Lpc| |Lexit| (+ |Lint| 1) (car (list (floor 7 2)))))"
        )
        == "(1 2 3 4 6 3)"
    )
    assert evaluate("(let ((a-b 1) (a_b 2) (|a-b| 3)) (list a-b a_b |a-b|))") == "(1 2 3)"


def test_eval_of_an_eval_when_for_the_compiler_only_does_nothing(evaluate):
    assert evaluate('(eval-when (:compile-toplevel) (error "no"))') == "NIL"


def test_python_sees_the_lines_of_lisp_in_a_traceback(session):
    import traceback

    session.package = "CL-USER"
    session.evaluate_text("(defun outer (x)\n  (inner x))\n(defun inner (x)\n  (car x))")
    with pytest.raises(Condition) as caught:
        session.evaluate_text("(outer 5)")
    lines = [(frame.name, frame.lineno) for frame in traceback.extract_tb(caught.value.__traceback__) if frame.filename.startswith("<repl")]
    assert ("outer", 2) in lines and ("inner", 4) in lines


def test_progv_of_no_symbols_in_a_task_that_never_bound_anything():
    """A task gets its stack of bindings with its first binding, so here is none to take anything from."""
    kernel.start()
    try:
        assert kernel.current().dynamic is None
        assert support.progv(None, None, lambda: 42) == 42
    finally:
        kernel.stop()


def test_progv_that_meets_no_variable_leaves_nothing_bound(evaluate):
    assert evaluate("(defparameter *kept* 1) (list (ignore-errors (progv '(*kept* 5) '(2 3) 4)) *kept*)").endswith("(NIL 1)")
    assert "PROGV cannot bind 5" in evaluate("(handler-case (progv '(5) '(1) 2) (error (e) (princ-to-string e)))")
    assert evaluate("(progv '(*kept* *other*) '(7) (list *kept* (boundp '*other*)))") == "(7 NIL)"


def test_both_operands_of_a_quotient_are_evaluated(evaluate):
    assert (
        evaluate("""(labels ((mean (s) (/ (reduce #'+ s) (length s))) (part (s) (/ (car s) (length s)))
                              (whole (s) (/ (length s) (car s))))
                         (list (mean '(1 2)) (mean '(1.0 2)) (part '(1 2)) (whole '(1.0 2)) (whole '(4 5))))""")
        == "(3/2 1.5 1/2 2.0 1/2)"
    )


def nested(depth, around, body):
    """``body`` in ``depth`` copies of ``around``, where ``~`` stands for what is inside and ``#`` for the level."""
    for level in range(depth):
        body = around.replace("~", body).replace("#", str(level))
    return body


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "around",
    [
        "(loop for v# from 1 to 1 do (incf total) ~)",
        "(unwind-protect ~ (incf total))",
        "(let ((*print-base* 10)) (incf total) ~)",
        "(dotimes (i# 1) (incf total) (handler-case ~ (type-error () 1)))",
        "(block b# (tagbody again# (incf total) (loop while (< total 0) do (go again#)) ~))",
    ],
    ids=["loops", "cleanups", "specials", "handlers", "blocks"],
)
def test_forms_may_be_nested_deeper_than_pythons_blocks(evaluate, around):
    assert evaluate(f"(let ((total 0)) {nested(30, around, '(incf total 100)')} total)") == "130"


@pytest.mark.soak
def test_ways_out_of_deeply_nested_blocks(evaluate):
    around = "(dolist (x# '(1 2 3)) (unwind-protect (progn (when (= x# 2) (return)) ~) (incf ends)))"
    assert evaluate(f"(let ((ends 0) (found 0)) {nested(25, around, '(incf found)')} (list found ends))") == "(1 50)"
    assert evaluate(f"(defun deep (ends) {nested(25, around, '(return-from deep (list :out ends))')})") == "DEEP"
    assert evaluate("(deep 0)") == "(:OUT 0)"
    closures = nested(25, "(dolist (x# '(#)) (push (lambda () (incf x#)) calls) ~)", "(push (lambda () (list x0 x24)) calls)")
    assert evaluate(f"(let (calls) {closures} (mapcar #'funcall (list (car (last calls)) (first calls))))") == "(25 (0 25))"


@pytest.mark.parametrize(
    ("form", "value"),
    [
        ("(block nil (unwind-protect 1 (return 2)))", "2"),
        ("(let ((n 0)) (loop (unwind-protect (incf n) (if (< n 3) nil (return n)))))", "3"),
        ("(let (seen) (dolist (x '(1 2 3) seen) (tagbody (unwind-protect (push x seen) (go end)) end)))", "(3 2 1)"),
        ("(funcall (lambda (x) (block f (unwind-protect (car x) (return-from f :left)))) 5)", ":LEFT"),
        (f"(list {nested(25, '(block b# (unwind-protect ~ (return-from b# #)))', '1')})", "(24)"),
    ],
)
def test_python_does_not_complain_of_ways_out_of_cleanup(evaluate, form, value):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert evaluate(form) == value


@pytest.mark.parametrize(
    "form", ['(progn (defvar *pairs* #((1 2) ("x" 3))) *pairs*)', '(when t #((1 2) ("x" 3)))', '(dolist (x \'(1) #((1 2) ("x" 3))) x)']
)
def test_a_literal_vector_stays_one_in_the_macros_of_the_standard(evaluate, form):
    assert evaluate(form) == '#((1 2) ("x" 3))'


def test_gensym_names_with_the_counter_and_then_counts(evaluate):
    assert evaluate('(let ((*gensym-counter* 5)) (list (gensym "F") (gensym) *gensym-counter*))') == "(#:F5 #:G6 7)"


@pytest.mark.parametrize(
    "form, value",
    [
        ("(/ (+ 1 (atan -100)) 36893488147419103232)", "-1.5200423e-20"),
        ("(/ (+ -36893488147419103232 (atan -100)) -36893488147419103232)", "1.0"),
        ("(let ((x (sin 1d0)) (y (cos 2d0))) (/ (* x y 3) 36893488147419103232))", "-2.8474576893470936d-20"),
    ],
)
def test_an_operation_is_divided_by_an_integer_that_no_machine_word_holds(session, form, value):
    assert session.evaluate_text(f"(prin1-to-string (funcall (compile nil '(lambda () {form}))))") == [value]


def _nodes_anywhere(thing, found):
    """Those nodes that are reached first from any attribute of a node, a list, a tuple or parameters."""
    for part in thing if isinstance(thing, (list, tuple)) else vars(thing).values():
        if isinstance(part, nodes.Node):
            found.append(part)
        elif isinstance(part, (list, tuple, nodes.Parameters)):
            _nodes_anywhere(part, found)
    return found


def test_a_walk_meets_all_nodes_below_a_node(evaluate, monkeypatch):
    seen = []
    monkeypatch.setattr(functions, "study", lambda root: (seen.extend(facts.walk([root])), facts.study(root)))
    evaluate(
        """(defun walked (a &optional (b (list 1 a)) &rest r &key (c (car b)) d)
             (declare (type integer a))
             (flet ((f (x) (if x (1+ a) (return-from walked x))))
               (let ((n 0) (*print-base* 8))
                 (unwind-protect (dolist (i r) (setf (car b) (f i) n (+ n i)) (when d (go-on)))
                   (catch 'out (handler-case (funcall #'f n) (error (e) e)))))
               (multiple-value-bind (q s) (floor a 2) (block nil (tagbody again (when (plusp q) (decf q) (go again))) (list q s c)))
               (handler-bind ((warning (lambda (w) (muffle-warning w)))) (multiple-value-prog1 (values 1 2) (print (load-time-value (+ 1 2)))))
               (apply #'list a r)))
           (defun go-on ())"""
    )
    kinds = {node.__class__ for node in seen}
    assert {nodes.Lambda, nodes.Let, nodes.If, nodes.Call, nodes.TagbodyNode, nodes.UnwindProtect, nodes.Checked} <= kinds
    for node in seen:
        assert {id(each) for each in facts.children(node)} == {id(each) for each in _nodes_anywhere(node, [])}, node
