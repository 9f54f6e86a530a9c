"""What the compiler writes in place instead of calling a function: handlers of conditions, and functions of a lambda and a sequence.

``test_compiler_at_random.py`` compares nestings of them with an interpreter.
"""

from __future__ import annotations

import pytest

from cramhy_runtime.lisp_core import hash_tables
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

DEFINITIONS = """
(define-condition trouble (error) ((value :initarg :value :reader value-of)))
(define-condition notice (condition) ())
(defvar *log* nil)
(defun note (thing) (push thing *log*) nil)
(defun fails (&optional (value 1)) (error 'trouble :value value))
(defmacro logged (&body body) `(let ((*log* nil)) (let ((value (progn ,@body))) (list value (reverse *log*)))))
"""


@pytest.fixture
def evaluate(session):
    session.package = "CL-USER"
    session.evaluate_text(DEFINITIONS)

    def run(text):
        return " ; ".join(" ".join(prin1_to_string(value).split()) for value in session.evaluate_text(text))

    return run


def test_what_is_signalled_here_and_in_a_callee_is_handled_alike(evaluate):
    signals = ["(error 'trouble :value 7)", "(fails 7)", "(error (make-condition 'trouble :value 7))", "(signal 'trouble :value 7)"]
    for signal in signals:
        for form in [
            signal,
            f"(list 1 {signal})",
            f"(dolist (x '(1 2)) {signal})",
            f"(loop {signal})",
            f"(unwind-protect {signal} (note 1))",
        ]:
            assert evaluate(f"(handler-case (progn {form} 1) (type-error () 2) (trouble (c) (list (value-of c))))") == "(7)"


def test_cleanup_runs_before_the_clause_with_the_handlers_in_force(evaluate):
    form = "(handler-case (unwind-protect ~ (handler-case (fails 2) (notice () 5) (warning () 6))) (trouble (c) (note (value-of c)) 3))"
    for signal in ("(error 'trouble :value 1)", "(fails 1)"):
        assert evaluate(f"(logged {form.replace('~', signal)})") == "(3 (2))"


def test_a_clause_runs_when_its_handlers_are_not_in_force_any_more(evaluate):
    for signal in ("(error 'trouble :value 1)", "(fails 1)"):
        inner = f"(handler-case {signal} (trouble () {signal}))"
        assert evaluate(f"(handler-case {inner} (trouble () :outer))") == ":OUTER"
        assert (
            evaluate(
                f"(let ((n 0)) (handler-case (loop (incf n) (handler-case {signal} (trouble () (when (> n 3) {signal})))) (error () n)))"
            )
            == "4"
        )


def test_each_run_of_a_form_is_its_own(evaluate):
    evaluate("""(defun deep (n) (handler-case (if (= n 0) (error 'trouble :value n) (deep (1- n)))
                   (trouble (c) (if (< (value-of c) 3) (error 'trouble :value (1+ (value-of c))) (list n (value-of c))))))""")
    assert evaluate("(deep 5)") == "(3 3)"
    assert evaluate("(handler-case (deep 2) (trouble (c) (value-of c)))") == "3"


def test_restarts_are_seen_by_handlers_and_by_those_inside_first(evaluate):
    form = """(logged (restart-case
      (handler-bind ((trouble (lambda (c) (note :outer) (invoke-restart 'use (value-of c)))))
        (handler-case (handler-bind ((error (lambda (c) (note (value-of c))))) (fails 9)) (notice () :wrong)))
      (use (x) (list :used x))))"""
    assert evaluate(form) == "((:USED 9) (9 :OUTER))"


def test_a_handler_runs_before_the_stack_unwinds_and_may_decline(evaluate):
    form = """(logged (handler-case (handler-bind ((trouble (lambda (c) (note (list :handler (value-of c))))))
                                      (unwind-protect ~ (note :cleanup)))
                        (trouble () (note :clause) 1)))"""
    for signal in ("(error 'trouble :value 1)", "(fails 1)"):
        assert evaluate(form.replace("~", signal)) == "(1 ((:HANDLER 1) :CLEANUP :CLAUSE))"


def test_a_handler_may_be_named_and_is_looked_up_when_the_form_begins(evaluate):
    evaluate("(defun handle (c) (note (value-of c)))")
    for name in ("'handle", "#'handle", "(symbol-function 'handle)"):
        assert evaluate(f"(logged (ignore-errors (handler-bind ((trouble {name})) (fails 4))))") == "(NIL (4))"
    with pytest.raises(Condition) as caught:
        evaluate("(handler-bind ((trouble 5)) 1)")
    assert "The value\n  5\nis not of type\n  (OR FUNCTION SYMBOL)" in str(caught.value)


def test_variables_that_the_body_of_handler_bind_assigns(evaluate):
    form = "(let ((a 1) fs) (dolist (x '(1 2)) (handler-bind ((error (lambda (c) c (incf a x)))) (push (lambda () (incf x)) fs) (signal 'trouble :value 1)))"
    assert evaluate(f"{form} (list a (mapcar #'funcall fs)))") == "(4 (3 2))"
    assert evaluate("(block found (handler-bind ((trouble (lambda (c) (return-from found (value-of c))))) (fails 8)))") == "8"
    assert evaluate("(multiple-value-list (handler-bind ((error #'print)) (values 1 2)))") == "(1 2)"


def test_a_type_that_a_function_of_the_user_decides_is_asked_once_for_each_handler(evaluate):
    evaluate("(defun odd-trouble (c) (note :asked) (and (typep c 'trouble) (oddp (value-of c))))")
    for signal in ("(error 'trouble :value ~)", "(fails ~)"):
        form = "(logged (handler-case (handler-case " + signal + " ((satisfies odd-trouble) () :odd)) (trouble () :even)))"
        assert evaluate(form.replace("~", "1")) == "(:ODD (:ASKED))"
        assert evaluate(form.replace("~", "2")) == "(:EVEN (:ASKED))"


def test_a_class_that_is_defined_again_is_seen(evaluate):
    evaluate("""(define-condition bump (condition) ())
                (defun bumped (f) (handler-case (progn (funcall f) :declined) (error () :error) (bump () :bump)))
                (defun bumped-here () (handler-case (progn (error 'bump) :declined) (error () :error) (bump () :bump)))""")
    assert evaluate("(list (bumped (lambda () (signal 'bump))) (bumped-here))") == "(:BUMP :BUMP)"
    evaluate("(define-condition bump (error) ())")
    assert evaluate("(list (bumped (lambda () (signal 'bump))) (bumped-here))") == "(:ERROR :ERROR)"


def test_break_on_signals_stops_at_what_is_handled_here(evaluate):
    form = "(let ((*break-on-signals* 'trouble) (*debugger-hook* nil)) (handler-case (error 'trouble :value 1) (trouble () :handled)))"
    with pytest.raises(Condition) as caught:
        evaluate(form)
    assert "BREAK was entered because of *BREAK-ON-SIGNALS*" in str(caught.value)
    assert evaluate(form.replace("'trouble)", "'notice)", 1)) == ":HANDLED"


def test_tasks_have_handlers_of_their_own(evaluate):
    evaluate(
        """(defun waits (n) (handler-case (progn (cpl:sleep n) (error 'trouble :value n)) (trouble (c) (note (list n (value-of c))))))"""
    )
    form = """(progn (setf *log* nil)
       (handler-bind ((trouble (lambda (c) (note (list :outside (value-of c))))))
         (cpl:top-level (cpl:par (waits 3) (waits 1) (handler-bind ((trouble #'print)) (cpl:sleep 2)) (waits 2))))
       (reverse *log*))"""
    assert evaluate(form) == "((1 1) (2 2) (3 3))"


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "form",
    [
        "(ignore-errors (fails))",
        "(ignore-errors (error 'trouble :value 1))",
        "(handler-case (fails) (error () (values nil 2)))",
        "(block b (unwind-protect (return-from b (values nil 1)) (note 1)))",
        "(let ((*log* 1)) (values nil *log*))",
        "(catch 'x (throw 'x (values nil 1)))",
        "(handler-bind ((error #'print)) (values nil 1))",
        "(block b (dolist (x '(1 2)) (when (= x 2) (return-from b (values nil x)))))",
        "(multiple-value-prog1 (values nil 1) (note 1))",
    ],
)
def test_a_test_looks_at_the_first_of_several_values_however_a_form_delivers_them(evaluate, form):
    uses = [
        "(if ~ 1 2)",
        "(cond (~ 1) (t 2))",
        "(if (and t ~) 1 2)",
        "(if (or ~ nil) 1 2)",
        "(if (not ~) 2 1)",
        "(if (find-if (lambda (x) x ~) '(1)) 1 2)",
    ]
    for use in uses:
        assert evaluate(use.replace("~", form)) == "2"
        assert evaluate(use.replace("~", form.replace("nil", "'yes"))) == ("2" if form.startswith("(ignore-errors") else "1")


# --------------------------------------------------------------------------------------------------------- sequence functions

SEQUENCES = ["'(3 1 4 1 5)", "'#(3 1 4 1 5)", "'()", '"aBc"', "'#*10110", "(make-array 3 :fill-pointer 2 :initial-element 4)"]
CALLS = ["find-if", "position-if", "count-if", "some", "every", "notany", "notevery", "remove-if", "remove-if-not"]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", CALLS)
def test_in_place_and_called_they_are_the_same(evaluate, name):
    for sequence in SEQUENCES:
        for test in (
            "(lambda (x) (eql x 4))",
            "(lambda (x) (if (numberp x) (and (> x 1) (list x)) (upper-case-p x)))",
            "#'numberp",
            "(lambda (x) (values nil x))",
        ):
            called = evaluate(f"(locally (declare (notinline {name})) ({name} {test} {sequence}))")
            assert evaluate(f"({name} {test} {sequence})") == called, (test, sequence)


@pytest.mark.soak(all_but=10)
@pytest.mark.parametrize("name", CALLS)
@pytest.mark.parametrize("sequence", ["5", "'(1 2 . 3)", "'a"])
def test_what_is_no_sequence_is_told_alike(evaluate, name, sequence):
    texts = set()
    call = f"({name} (lambda (x) {'t' if 'every' in name else '(eql x 7)'}) {sequence})"
    for form in (call, f"(locally (declare (notinline {name})) {call})"):
        with pytest.raises(Condition) as caught:
            evaluate(form)
        texts.add((type(caught.value).__name__, str(caught.value)))
    assert len(texts) == 1


def test_ways_out_of_the_function(evaluate):
    evaluate("(defun first-big (list) (some (lambda (x) (when (> x 3) (return-from first-big (list :big x)))) list) :none)")
    assert evaluate("(list (first-big '(1 2)) (first-big '(1 4)))") == "(:NONE (:BIG 4))"
    assert evaluate("(let (fs) (every (lambda (x) (push (lambda () (incf x)) fs)) '(1 2 3)) (mapcar #'funcall fs))") == "(4 3 2)"
    assert evaluate("(tagbody (remove-if (lambda (x) (when (= x 2) (go end))) '(1 2)) (note 1) end)") == "NIL"


def test_the_element_that_is_found_is_not_what_the_function_made_of_its_variable(evaluate):
    assert evaluate("(find-if (lambda (x) (setq x (* x 10)) (> x 15)) '(1 2 3))") == "2"
    assert evaluate("(remove-if-not (lambda (x) (incf x) (> x 2)) '(1 2 3))") == "(2 3)"


def test_a_local_function_and_a_shadowed_one_are_not_the_standard_one(evaluate):
    assert evaluate("(flet ((check (x) (> x 1))) (find-if #'check '(1 2 3)))") == "2"
    assert evaluate("(list (mapcar #'1+ '(1 2)) (mapcar #'car '((1) (2))) (some #'null '(1 nil)))") == "((2 3) (1 2) T)"


# ------------------------------------------------------------------------------------------------------ reduce and maphash

REDUCED = [
    "(lambda (a b) (+ a (if (numberp b) b 1)))",
    "(lambda (a b) (list a b))",
    "(lambda (a b) (values (cons b (if (listp a) a nil)) :more))",
    "(lambda (a b) (setq b (list b) a (list a)) (append a b))",
    "(lambda (a b) (declare (ignore a)) b)",
    '(lambda (a b) "doc" (if (eql b 4) (throw \'out a) b))',
    "(lambda (*special* b) (if (numberp b) (see) *special*))",
    "(lambda (a b) (block nil (when (eql b 1) (return a)) (note b) a))",
    "(lambda (&rest all) all)",
    "(lambda (a &optional b) (list a b))",
    "#'list",
]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("function", REDUCED)
def test_reduce_is_the_same_in_place(evaluate, function):
    evaluate("(progn (defvar *special* 1) (defun see () *special*))")
    for sequence in SEQUENCES:
        for more in (
            ":initial-value 0",
            ":initial-value nil",
            ":initial-value (values 1 2)",
            ":initial-value 0 :from-end t",
            ":key #'identity",
        ):
            call = f"(reduce {function} {sequence} {more})"
            if "+" in function and ("nil" in more or "end" in more) or ":key" in more and ("+" in function or "'()" in sequence):
                continue
            called = evaluate(f"(logged (catch 'out (locally (declare (notinline reduce)) {call})))")
            assert evaluate(f"(logged (catch 'out {call}))") == called, call


ENTRIES = "(let ((h (make-hash-table))) (setf (gethash 1 h) :one (gethash 2 h) :two (gethash 3 h) :three) ~)"


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize(
    ("form", "answer"),
    [
        ("(let (all) (list (maphash (lambda (k v) (push (list k v) all)) h) all))", "(NIL ((3 :THREE) (2 :TWO) (1 :ONE)))"),
        ("(let (all) (maphash (lambda (k v) (push (lambda () (list (incf k) v)) all)) h) (mapcar #'funcall all))",
         "((4 :THREE) (3 :TWO) (2 :ONE))"),
        ("(progn (maphash (lambda (k v) v (remhash k h) (remhash 2 h)) h) (hash-table-count h))", "0"),
        ("(let (all) (maphash (lambda (k v) v (push k all) (remhash 2 h)) h) all)", "(3 1)"),
        ("(progn (maphash (lambda (k v) (setf (gethash k h) (list v))) h) (gethash 3 h))", "(:THREE) ; T"),
        ("(let (all) (maphash (lambda (k v) v (setf (gethash (+ k 10) h) k) (push k all)) h) (list all (hash-table-count h)))", "((3 2 1) 6)"),
        ("(block out (maphash (lambda (k v) (when (eql k 2) (return-from out v))) h) :none)", ":TWO"),
        ("(let ((n 0)) (tagbody (maphash (lambda (k v) v (incf n) (when (eql k 2) (go end))) h) (setf n :all) end) n)", "2"),
        ("(let (all) (maphash (lambda (k v) (maphash (lambda (l w) w (push (list k l) all)) h) v) h) (length all))", "9"),
        ("(let ((n 0)) (maphash #'(lambda (k v) (declare (ignore v)) (incf n k)) h) n)", "6"),
        ("(let (all) (maphash (lambda (k &optional v) (push (list k v) all)) h) (length all))", "3"),
        ("(let (all) (maphash (lambda (&rest both) (push both all)) h) (length all))", "3"),
        ("(let (all) (flet ((keep (k v) (push (list k v) all))) (maphash #'keep h)) (length all))", "3"),
        ("(let ((n 0)) (declare (notinline maphash)) (maphash (lambda (k v) v (incf n k)) h) n)", "6"),
        ("(handler-case (maphash (lambda (k) k) h) (program-error () :wrong))", ":WRONG"),
        ("(let (all) (maphash (lambda (k *special*) k (push (see) all)) h) all)", "(:THREE :TWO :ONE)"),
        ("(let ((k 0) (all nil)) (maphash (lambda (k v) v (setq k (list k)) (push k all)) h) (list k all))", "(0 ((3) (2) (1)))"),
    ],
)  # fmt: skip
def test_maphash_in_place(evaluate, form, answer):
    evaluate("(progn (defvar *special* 1) (defun see () *special*))")
    assert evaluate(ENTRIES.replace("~", form)) == answer


@pytest.mark.parametrize("name", ["maphash", "reduce"])
@pytest.mark.parametrize("thing", ["5", "'(1 2 . 3)", "'a", '"text"'])
def test_what_is_no_table_or_sequence_is_told_alike(evaluate, name, thing):
    texts = set()
    more = "" if name == "maphash" else ":initial-value 0"
    call = f"({name} (lambda (a b) b (list a)) {thing} {more})"
    for form in (call, f"(locally (declare (notinline {name})) {call})"):
        try:
            texts.add(evaluate(form))
        except Condition as told:
            texts.add((type(told).__name__, str(told)))
    assert len(texts) == 1


def test_arguments_of_loops_in_place_are_evaluated_in_order(evaluate):
    call = "(reduce (lambda (a b) (note (list a b)) b) (progn (note 1) '(5)) :initial-value (progn (note 2) 3))"
    assert evaluate(f"(logged {call})") == "(5 (1 2 (3 5)))"
    assert evaluate("(logged (let ((l '(1))) (reduce (lambda (a b) (+ a b)) l :initial-value (progn (setq l '(5)) 0))))") == "(1 NIL)"


def test_a_long_walk_over_a_table_passes_checkpoints(evaluate, monkeypatch):
    evaluate("(progn (defvar *table* (make-hash-table)) (dotimes (i 5000) (setf (gethash i *table*) i)))")
    passed = []
    monkeypatch.setattr(hash_tables, "checkpoint", lambda: passed.append(1))
    for notinline in ("maphash", "reduce"):
        evaluate(f"(locally (declare (notinline {notinline})) (maphash (lambda (k v) k v) *table*))")
        assert len(passed) == 2
        passed.clear()


@pytest.mark.soak
def test_loops_in_place_are_interrupted(session, evaluate):
    evaluate("(defvar *never* (let ((l (list 1))) (setf (cdr l) l)))")
    for name in ("some", "find-if", "notany"):
        form = f"(cpl:top-level (cpl:pursue (cpl:sleep 0.05) ({name} (lambda (x) (eql x 2)) *never*)) :ended)"
        assert evaluate(form) == ":ENDED"


# ---------------------------------------------------------------------------------------------------------------- slots by name

SLOTS = """
(defclass spot () ((x :initarg :x) (y :initform 2) (all :allocation :class :initform :shared)))
(defclass far-spot (spot) ((z :initform 3)))
(defun read-x (object) (slot-value object 'x))
(defun write-x (new object) (setf (slot-value object 'x) new))
(defun sum (object) (with-slots (x (second y)) object (setf x (+ x second)) (incf second) (list x second)))
"""


def test_slots_by_name_are_the_same_in_place(evaluate):
    evaluate(SLOTS)
    for cls in ("spot", "far-spot", "spot"):
        assert evaluate(
            f"(let ((spot (make-instance '{cls} :x 1))) (list (read-x spot) (write-x 5 spot) (sum spot) (sum spot) (read-x spot)))"
        ) == ("(1 5 (7 3) (10 4) 10)")
    assert evaluate("(let ((a (make-instance 'spot)) (b (make-instance 'spot))) (setf (slot-value a 'all) 1) (slot-value b 'all))") == "1"
    for _ in range(2):  # in the second turn the class is known
        assert evaluate("(handler-case (read-x (make-instance 'spot)) (unbound-slot (c) (cell-error-name c)))") == "X"
        assert evaluate("(write-x 3 (make-instance 'spot))") == "3"
    evaluate("(defmethod slot-unbound (class (object far-spot) name) (list :unbound name))")
    assert evaluate("(list (read-x (make-instance 'far-spot)) (read-x (make-instance 'far-spot)))") == "((:UNBOUND X) (:UNBOUND X))"


def test_classes_that_change_are_seen_by_slots_in_place(evaluate):
    evaluate(SLOTS)
    evaluate("(defparameter *spot* (make-instance 'spot :x 1)) (list (read-x *spot*) (write-x 2 *spot*) (read-x *spot*))")
    evaluate("(defclass other () ((x :initform :other)))")
    assert evaluate("(progn (change-class *spot* 'other) (list (read-x *spot*) (write-x 4 *spot*) (read-x *spot*)))") == "(2 4 4)"
    evaluate("(defclass other () ((w :initform 1)))")
    text = "When attempting to read the slot's value (slot-value), the slot X is missing from the object"
    for _ in range(2):
        with pytest.raises(Condition) as caught:
            evaluate("(read-x (make-instance 'other))")
        assert text in " ".join(str(caught.value).split())
    evaluate("(defclass other () ((x :initform :class :allocation :class)))")
    assert (
        evaluate("(list (read-x (make-instance 'other)) (write-x 7 (make-instance 'other)) (read-x (make-instance 'other)))")
        == "(:CLASS 7 7)"
    )


def test_slots_by_name_of_structures_and_conditions(evaluate):
    evaluate(SLOTS + "(defstruct place x y) (define-condition lost (error) ((x :initarg :x)))")
    for _ in range(2):
        assert evaluate("(let ((p (make-place :x 1))) (list (read-x p) (write-x 2 p) (read-x p)))") == "(1 2 2)"
        assert evaluate("(let ((c (make-condition 'lost :x 1))) (list (read-x c) (write-x 2 c) (read-x c)))") == "(1 2 2)"
    with pytest.raises(Condition):
        evaluate("(read-x 5)")
