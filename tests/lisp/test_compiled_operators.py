"""Operators that stand alone in the Python code mean what the functions of Common Lisp mean, at every edge."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session, condition_of


@pytest.fixture(scope="module")
def session():
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


def answer(session, text):
    try:
        return " ".join(prin1_to_string(value) for value in session.evaluate_text(text))
    except (Condition, Exception) as problem:
        condition = condition_of(problem)
        return f"{condition.lisp_name.rpartition(':')[2]}: {' '.join(condition.report().split())}"


@pytest.mark.soak(all_but=24)
@pytest.mark.parametrize(
    ("program", "wanted"),
    [
        # t is no number although Python's True is
        ("(let ((x t)) (+ x 1))", "TYPE-ERROR: The value T is not of type NUMBER"),
        ("(funcall (lambda (x) (* x 2)) t)", "TYPE-ERROR: The value T is not of type NUMBER"),
        ("(funcall (lambda (x y) (< x y)) 1 t)", "TYPE-ERROR: The value T is not of type REAL"),
        ("(funcall (lambda (x y) (+ (* x x) (* y y))) 2 t)", "TYPE-ERROR: The value T is not of type NUMBER"),
        ("(funcall (lambda (x) (zerop x)) nil)", "TYPE-ERROR: The value NIL is not of type NUMBER"),
        # the numeric tower
        ("(funcall (lambda (x y) (/ x y)) 6 4)", "3/2"),
        ("(funcall (lambda (x y) (/ x y)) 6.0 4)", "1.5"),
        ("(funcall (lambda (x y) (/ x y)) 6 0)", "DIVISION-BY-ZERO: arithmetic error DIVISION-BY-ZERO signalled Operation was (/ 6 0)."),
        (
            "(funcall (lambda (x y) (/ x y)) 6.0 0.0)",
            "DIVISION-BY-ZERO: arithmetic error DIVISION-BY-ZERO signalled Operation was (/ 6.0 0.0).",
        ),
        ("(funcall (lambda (x) (/ x 2)) 3)", "3/2"),
        ("(funcall (lambda (x) (/ x 2)) 3.0)", "1.5"),
        ("(let ((x 3) (y 2)) (/ x y))", "3/2"),
        ("(let ((x 3.0) (y 0.0)) (handler-case (/ x y) (division-by-zero () :zero)))", ":ZERO"),
        ("(funcall (lambda (x y) (+ (* x x) (* y y))) 1/2 0.5)", "0.5"),
        ("(funcall (lambda (x y) (+ (* x x) (* y y))) 2 1.5d0)", "6.25d0"),
        ("(funcall (lambda (x) (+ x 1)) 1.5d0)", "2.5d0"),
        ("(funcall (lambda (x) (- x 1)) 3/2)", "1/2"),
        ("(let ((x most-positive-fixnum)) (+ x 1))", "4611686018427387904"),
        ("(let ((p 1)) (dotimes (i 70 p) (setq p (* p 2))))", "1180591620717411303424"),
        ("(let ((x -0.0)) (list (* x 1) (- x) (+ x 0.0)))", "(-0.0 0.0 0.0)"),
        ("(funcall (lambda (x) (minusp x)) -0.0)", "NIL"),
        # floats that leave their range
        ("(let ((x 1.0)) (handler-case (dotimes (i 4 x) (setq x (* x 1e10))) (floating-point-overflow () :overflow)))", ":OVERFLOW"),
        (
            "(let ((x 1.0)) (dotimes (i 3) (setq x (* x 1e10))) (handler-case (* 1.0 (* x x)) (floating-point-overflow () :overflow)))",
            ":OVERFLOW",
        ),
        (
            "(let ((x 1.0)) (dotimes (i 3) (setq x (* x 1e10))) (funcall (lambda (x y) (handler-case (* (- y x) x) (error () :over))) x 1.0))",
            ":OVER",
        ),
        # several values: the first counts
        ("(+ (floor 7 2) (floor 9 2))", "7"),
        ("(let ((x 1)) (* (values 3 4) (values) x))", "TYPE-ERROR: The value NIL is not of type NUMBER"),
        ("(< (values 1 2) (floor 9 2) 7)", "T"),
        ("(if (values nil t) 1 2)", "2"),
        ("(if (funcall (lambda () (values))) 1 2)", "2"),
        ("(mod (floor 17 5) 2)", "1"),
        # order of evaluation, and variables that a later operand changes
        ("(let ((x 1)) (+ x (setq x 5) x))", "11"),
        ("(let ((x 1)) (flet ((f () (setq x 10))) (list (+ x (f)) x (< x (f)))))", "(11 10 NIL)"),
        (
            "(let ((s nil)) (flet ((f (x) (push x s) x)) (list (- (f 1) (f 2)) (< (f 3) (f 4)) (* (f 5) (- (f 6) (f 7))) s)))",
            "(-1 T -5 (7 6 5 4 3 2 1))",
        ),
        ("(let* ((x 1) (y x)) (setq x 2) (list x y))", "(2 1)"),
        ("(let ((x 1)) (let ((y x) (z (setq x 3))) (list x y z)))", "(3 1 3)"),
        # comparisons and predicates
        ("(list (evenp 4) (oddp 4) (evenp -3) (oddp -3))", "(T NIL NIL T)"),
        ("(funcall (lambda (x) (evenp x)) 2.0)", "TYPE-ERROR: The value 2.0 is not of type INTEGER"),
        ("(funcall (lambda (x) (list (eq x 'a) (eql x nil) (eq x 1) (eql x #\\a))) 'a)", "(T NIL NIL NIL)"),
        ("(funcall (lambda (x) (list (eql x 1) (eql x 1.0))) 1)", "(T NIL)"),
        ("(funcall (lambda (x) (list (eql x 0.0) (eql x -0.0))) -0.0)", "(NIL T)"),
        ("(funcall (lambda (x) (eql x 1)) t)", "NIL"),
        ("(list (car nil) (cdr nil) (funcall (lambda (x) (first x)) nil))", "(NIL NIL NIL)"),
        ("(funcall (lambda (x) (car x)) 5)", "TYPE-ERROR: The value 5 is not of type LIST when binding LIST"),
        ("(funcall (lambda (x) (mod x 3)) -7)", "2"),
        ("(funcall (lambda (x) (mod x 3)) -7.5)", "1.5"),
    ],
)
def test_the_operator_means_the_function(session, program, wanted):
    assert answer(session, program) == wanted


@pytest.mark.parametrize(
    ("program", "wanted"),
    [
        ("(let ((l nil)) (dotimes (i 3) (push (lambda () i) l)) (mapcar #'funcall l))", "(3 3 3)"),
        ("(let ((l nil)) (dotimes (i 3) (push (lambda () (incf i)) l)) (mapcar #'funcall l))", "(4 5 6)"),
        ("(let ((s 0)) (dotimes (i 5 (list i s)) (incf s i)))", "(5 10)"),
        ("(dotimes (i -3 i))", "0"),
        ("(let ((n 3) (s 0)) (dotimes (i n s) (setq n 100) (incf s)))", "3"),
        ("(let ((s 0)) (dotimes (i 10 s) (when (= i 4) (return (list :at i s))) (incf s i)))", "(:AT 4 6)"),
        ("(loop for i from 10 downto 1 by 3 collect i)", "(10 7 4 1)"),
        ("(loop for i from 1 below 2.5 collect i)", "(1 2)"),
        ("(loop for i from 1.0 to 2 by 1/2 collect i)", "(1.0 1.5 2.0)"),
        ("(loop for i from 0 below 5 finally (return i))", "5"),
        ("(loop for i from 0 below 5 do (setq i (+ i 1)) collect i)", "(1 3 5)"),
        ("(loop for i below 'a collect i)", "TYPE-ERROR: The value A is not of type REAL"),
        ("(loop for x across (vector 1 2.5 3/2) sum x)", "5.0"),
        ('(loop for c across "abc" collect c)', "(#\\a #\\b #\\c)"),
        ("(loop for x across (make-array 200 :initial-element 1) sum x)", "200"),
        ("(loop for x across (vector 1 2 3) for i from 0 collect (* x i))", "(0 2 6)"),
        ("(let ((v (make-array 5 :fill-pointer 2 :initial-element 7))) (loop for x across v collect x))", "(7 7)"),
        ("(loop for (a b) across (vector '(1 2) '(3 4)) sum (* a b))", "14"),
        ("(loop repeat 3 collect 1)", "(1 1 1)"),
        ("(let ((n 3)) (loop repeat n do (decf n)) n)", "0"),
        ("(loop for x in '(1 2 . 3) collect x)", "TYPE-ERROR: The value 3 is not of type LIST when binding SB-IMPL::OBJECT"),
        ("(loop for x in '(1 2 3 4) by #'cddr collect x)", "(1 3)"),
        (
            "(let ((r nil)) (dolist (x '(1 2 3 4 5) r) (when (= x 2) (go next)) (when (= x 5) (return (list :out r))) (push x r) next))",
            "(:OUT (4 3 1))",
        ),
        (
            "(let ((r nil)) (dotimes (i 3 r) (dotimes (j 3) (when (= j 1) (return)) (when (= i 2) (return-from nil)) (push (list i j) r))))",
            "((1 0) (0 0))",
        ),
        ("(block out (dotimes (i 3) (dotimes (j 3) (when (= (* i j) 2) (return-from out (list i j))))))", "(1 2)"),
        ("(block out (loop (unwind-protect (return-from out 1) (print 2))))", "1"),
        ("(let ((i 0) (r nil)) (tagbody a (incf i) b (push i r) (when (< i 3) (go a)) (when (< (length r) 6) (go b))) r)", "(3 3 3 3 2 1)"),
        ("(let ((x 0)) (tagbody (when (= x 0) (go end)) (setq x 1) end (setq x (+ x 5))) x)", "5"),
        ("(let ((r nil)) (loop for x = 1 then (* 2 x) while (< x 20) do (push x r)) r)", "(16 8 4 2 1)"),
        ("(loop for i from 1 to 3 for l on '(a b c d) collect (cons i l))", "((1 A B C D) (2 B C D) (3 C D))"),
        ("(do ((i 0 (1+ i)) (s 0 (+ s i))) ((>= i 5) (list i s)))", "(5 10)"),
        ("(let ((l (list 1 2 3))) (list (pop l) l (push 5 l) (push (pop l) l)))", "(1 (2 3) (5 2 3) (5 2 3))"),
    ],
)
def test_the_loop_means_what_it_says(session, program, wanted):
    assert answer(session, program) == wanted


def test_a_function_that_is_defined_again_is_seen_by_its_callers(session):
    session.evaluate_text("(defun inner (x) (+ x 1)) (defun outer (x) (* 2 (inner x)))")
    assert answer(session, "(outer 1)") == "4"
    session.evaluate_text("(defun inner (x) (+ x 10))")
    assert answer(session, "(outer 1)") == "22"


def test_an_accessor_of_the_same_name_for_a_slot_of_another_name_is_seen_by_its_callers(session):
    answer(session, "(defstruct (old-spot (:conc-name spot-)) x)")
    answer(session, "(defun x-of (spot) (incf (spot-x spot)) (spot-x spot))")
    assert answer(session, "(x-of (make-old-spot :x 1))") == "2"
    answer(session, "(defstruct (new-spot (:conc-name nil)) (y 5) spot-x)")
    assert answer(session, "(x-of (make-new-spot :spot-x 7))") == "8"


@pytest.mark.parametrize(
    "loop",
    [
        "(loop)",
        "(loop (setq x 1))",
        "(dotimes (i 1000000000) (setq x i))",
        "(loop for i from 0 do (setq x i))",
        "(tagbody a (go b) c b (go a))",
        "(loop for i below 1000000000 do (list i))",
        "(let ((l (list 1))) (setf (cdr l) l) (dolist (e l) e))",
    ],
)
def test_an_endless_loop_lets_others_run_and_can_be_ended(session, loop):
    plan = f"(cpl:top-level (let ((x 0)) (cpl:pursue (progn (cpl:sleep* 0.5) :slept) {loop})))"
    assert answer(session, plan) == ":SLEPT"


@pytest.mark.parametrize(
    ("program", "wanted"),
    [
        # slots of structures: taken directly, until the accessor is another function
        (
            "(defstruct spot x (y 0 :type integer)) (defstruct (deep (:include spot)) z)"
            "(defun sum-of (p) (+ (spot-x p) (spot-y p))) (defun put-x (p v) (setf (spot-x p) v) p) (defun put-y (p v) (setf (spot-y p) v) p)"
            "(list (sum-of (make-spot :x 1 :y 2)) (sum-of (make-deep :x 3 :y 4)) (sum-of (put-x (make-spot :x 1 :y 2) 5)))",
            "(3 7 7)",
        ),
        ("(sum-of 5)", "TYPE-ERROR: The value 5 is not of type COMMON-LISP-USER::SPOT"),
        ("(put-x nil 5)", "TYPE-ERROR: The value NIL is not of type COMMON-LISP-USER::SPOT"),
        ('(handler-case (put-y (make-spot :x 1) "a") (type-error () :wrong))', ":WRONG"),
        ("(sum-of (put-y (make-spot :x 1) 8))", "9"),
        ("(progn (defun spot-x (p) (declare (ignore p)) 100) (sum-of (make-spot :x 1 :y 2)))", "102"),
        # generic functions: methods and functions that come later are seen
        (
            "(defgeneric who (x)) (defmethod who ((x integer)) :integer) (defun ask (x) (who x)) (list (ask 1) (ask 2))",
            "(:INTEGER :INTEGER)",
        ),
        (
            "(progn (defmethod who ((x (eql 2))) :two) (defmethod who ((x symbol)) :symbol) (list (ask 1) (ask 2) (ask 'a) (ask nil)))",
            "(:INTEGER :TWO :SYMBOL :SYMBOL)",
        ),
        ("(handler-case (ask 1.5) (error () :none))", ":NONE"),
        ("(handler-case (who 1 2) (program-error () :count))", ":COUNT"),
        ("(progn (fmakunbound 'who) (defun who (x) (list :function x)) (ask 3))", "(:FUNCTION 3)"),
        # mapping functions, in place
        ("(mapcar (lambda (x y) (list x y)) '(1 2 3) '(a b))", "((1 A) (2 B))"),
        ("(mapcar #'(lambda (x) (values x 2)) '(1 2))", "(1 2)"),
        ("(mapc (lambda (x) x) '(1 2))", "(1 2)"),
        ("(mapcan (lambda (x) (if (oddp x) (list x x) nil)) (list 1 2 3))", "(1 1 3 3)"),
        ("(mapcar (lambda (x) x) 5)", "TYPE-ERROR: The value 5 is not of type LIST"),
        ("(mapcar (lambda (x) x) '(1 . 2))", "TYPE-ERROR: The value 2 is not of type LIST"),
        ("(mapcar #'funcall (mapcar (lambda (x) (lambda () (incf x))) '(1 2)))", "(2 3)"),
        ("(block b (mapcar (lambda (x) (when (= x 2) (return-from b :left)) x) '(1 2 3)))", ":LEFT"),
        ("(let ((x 10)) (mapcar (lambda (x) (declare (special x)) (symbol-value 'x)) '(1 2)))", "(1 2)"),
        ("(handler-case (mapcar (lambda (x y) (list x y)) '(1)) (error () :count))", ":COUNT"),
        # format with a constant control
        ('(format nil "~a ~s ~d%~%" "x" "y" 5)', '"x \\"y\\" 5%\n"'),
        ('(format nil "~a" (list 1 "a" \'b))', '"(1 a B)"'),
        ('(format nil "~d ~d" 1.5 (expt 10 30))', '"1.5 1000000000000000000000000000000"'),
        ('(let ((*print-base* 2)) (format nil "~a ~d ~s" 5 5 \'a))', '"101 5 A"'),
        ("(let ((*print-case* :downcase)) (format nil \"~a ~s ~s\" 'abc 'abc :key))", '"abc abc :key"'),
        ('(let ((r nil)) (list (format nil "~a ~a" (progn (push 1 r) \'(1)) (progn (push 2 r) 2)) r))', '("(1) 2" (2 1))'),
        ('(format nil "~a" nil)', '"NIL"'),
        ('(handler-case (format nil "~a ~a" 1) (error () :few))', ":FEW"),
        ('(format nil "~a ~s" 1.5 1.5d0)', '"1.5 1.5d0"'),
        ('(format nil "~a" (values 1 2))', '"1"'),
    ],
)
def test_what_stands_in_place_of_a_call_means_the_call(session, program, wanted):
    assert answer(session, program).endswith(wanted)


def test_both_operands_are_evaluated_once(session):
    program = "(let ((n 0)) (flet ((f () (incf n) 1.5) (g () (incf n) 2)) (list (* (f) (f)) (* (f) (g)) (* (g) (f)) (- (f) (g)) n)))"
    assert answer(session, program) == "(2.25 3.0 3.0 -0.5 8)"


@pytest.mark.parametrize(
    ("program", "wanted"),
    [
        ("(handler-case (car 5) (type-error (c) (list :te (type-error-datum c))) (error () :e))", "(:TE 5)"),
        ('(handler-case (error "x") (warning () :w) (error () :e))', ":E"),
        ("(handler-case (values 1 2) (error () :e))", "1 2"),
        ('(handler-case (error "x") (error () (values 3 4)))', "3 4"),
        ("(multiple-value-list (ignore-errors 1))", "(1)"),
        ('(let ((r (multiple-value-list (ignore-errors (error "x"))))) (list (car r) (typep (cadr r) \'simple-error)))', "(NIL T)"),
        ('(+ 1 (handler-case (error "x") (error () (values 3 4))))', "4"),
        # the handlers are not in force in a clause, nor in the handlers of an outer form
        ('(handler-case (handler-case (error "x") (error () (error "y"))) (error (c) (princ-to-string c)))', '"y"'),
        (
            '(handler-case (handler-bind ((error (lambda (c) (declare (ignore c)) (error "inner")))) (error "x")) '
            "(error (c) (princ-to-string c)))",
            '"inner"',
        ),
        # exits, cleanup and variables
        ('(let ((n 0)) (dotimes (i 5 n) (handler-case (if (oddp i) (error "x") (incf n)) (error () (incf n 10)))))', "23"),
        ('(block b (dotimes (i 5) (handler-case (if (= i 2) (return-from b i) (error "x")) (error () nil))) :end)', "2"),
        ('(block b (handler-case (error "x") (error () (return-from b :left))) :end)', ":LEFT"),
        ('(let ((r nil)) (handler-case (unwind-protect (error "x") (push 1 r)) (error () (push 2 r))) r)', "(2 1)"),
        (
            '(let ((fs nil)) (dotimes (i 3) (handler-case (error "~a" i) (error (c) (push (lambda () (princ-to-string c)) fs)))) '
            "(mapcar #'funcall fs))",
            '("2" "1" "0")',
        ),
        (
            '(let ((fs nil)) (dotimes (i 2) (handler-case (error "~a" i) (error (c) (push (lambda () (setq c (list c))) fs)))) '
            "(mapcar (lambda (f) (length (funcall f))) fs))",
            "(1 1)",
        ),
        (
            '(labels ((f (n) (handler-case (if (= n 0) (error "x") (f (- n 1))) (error (c) (if (= n 3) :three (error c)))))) (f 5))',
            ":THREE",
        ),
        ("(handler-case (signal 'condition) (error () :e))", "NIL"),
        ('(handler-case (let ((*print-base* 2)) (error "x")) (error () *print-base*))', "10"),
        (
            "(let ((s 0)) (dolist (a '(1 2)) (dolist (b '(1 2)) (dolist (c '(1 2)) (dolist (d '(1 2)) (dolist (e '(1 2)) (dolist (f '(1 2)) "
            '(dolist (g \'(1 2)) (handler-case (handler-case (if (= a b c d e f g) (error "x") (incf s)) (type-error () 5)) '
            "(error () (incf s 100))))))))))  s)",
            "326",
        ),
    ],
)
def test_handler_case_in_place(session, program, wanted):
    assert answer(session, program) == wanted


@pytest.mark.parametrize(
    ("program", "wanted"),
    [
        # sums that are known to be numbers, of whatever kind
        ("(funcall (lambda (l) (let ((s 0)) (dolist (x l s) (setq s (+ s (* x x)))))) '(1 1/2 1/2 0.5))", "1.75"),
        ("(funcall (lambda (l) (let ((s 1/2)) (dolist (x l s) (setq s (+ s x))))) '(1/2))", "1"),
        ("(funcall (lambda (l) (let ((s 0)) (dolist (x l s) (setq s (- s x))))) '(1 2.5d0 1))", "-4.5d0"),
        ("(funcall (lambda (l) (let ((s 0)) (dolist (x l s) (setq s (+ s x))))) '(1 t))", "TYPE-ERROR: The value T is not of type NUMBER"),
        (
            "(funcall (lambda (l) (let ((s 0)) (dolist (x l s) (setq s (+ x s))))) '(1 nil))",
            "TYPE-ERROR: The value NIL is not of type NUMBER",
        ),
        ("(funcall (lambda (l) (loop for x in l sum x into s maximize x into m finally (return (list s m)))) '(1 5/2 2))", "(11/2 5/2)"),
        ("(let ((s 1)) (dotimes (i 400) (setq s (* s 10))) (handler-case (funcall (lambda (x) (+ s x)) 1.5) (error () :error)))", ":ERROR"),
        ("(funcall (lambda (a b) (list (- a b) (+ a b) (< a b))) 3 4.0)", "(-1.0 7.0 T)"),
        ("(funcall (lambda (a b) (list (- a b) (+ a b) (< a b))) 1/2 3/2)", "(-1 2 T)"),
        ("(funcall (lambda (a b) (flet ((f () (setq a 10))) (list (- a 1) (f) (- a 1) (* a b)))) 1 2)", "(0 10 9 20)"),
        ("(let ((x 0)) (if (+ x (funcall (lambda () 0))) :true :false))", ":TRUE"),
    ],
)
def test_sums_of_numbers(session, program, wanted):
    assert answer(session, program) == wanted


@pytest.mark.parametrize(
    ("calls", "wanted"),
    [
        ("(keyed :a 1 :b 2) (keyed :a 3 :b 4)", "((1 2) (3 4))"),
        ("(keyed :b 1 :a 2) (keyed :b 3 :a 4) (keyed :b 5)", "((2 1) (4 3) (:NO 5))"),
        ("(keyed :b 1) (keyed :b 2) (keyed)", "((:NO 1) (:NO 2) (:NO :NO))"),
        ("(keyed :a 1) (keyed :a nil) (keyed :b nil :a 1)", "((1 :NO) (NIL :NO) (1 NIL))"),
        ("(keyed :a 1 :b 2 :allow-other-keys nil) (keyed :allow-other-keys t :a 1 :c 2)", "((1 2) (1 :NO))"),
        ("(funcall (lambda (x &rest all &key a (b a)) (list x all a b)) 0 :a 1) (keyed :a :b :b :a)", "((0 (:A 1) 1 1) (:B :A))"),
        ("(keyed :a)", "SIMPLE-PROGRAM-ERROR: odd number of &KEY arguments"),
        ("(keyed :b 1 2)", "SIMPLE-PROGRAM-ERROR: odd number of &KEY arguments"),
        ("(keyed :a 1 :b 2 :a 3) (keyed :a 4 :b 5 :a 6)", "((1 2) (4 5))"),
        ("(keyed :a 1 :b 2) (keyed :a 1 :b)", "SIMPLE-PROGRAM-ERROR: odd number of &KEY arguments"),
        ("(keyed :a 1 :b 2) (keyed :a 1 (list 1) 2)", "SIMPLE-PROGRAM-ERROR: unknown &KEY argument: (1)"),
        (
            "(keyed :a 1 :c 2 :allow-other-keys t) (keyed :a 1 :c 2 :allow-other-keys nil)",
            "SIMPLE-PROGRAM-ERROR: unknown &KEY argument: :C",
        ),
    ],
)
def test_keywords_are_sorted_the_second_time_as_the_first(session, calls, wanted):
    assert answer(session, f"(progn (defun keyed (&key (a :no) (b :no)) (list a b)) (list {calls}))") == wanted


@pytest.mark.parametrize(
    ("program", "wanted"),
    [
        ("(multiple-value-list (gethash :k h))", "(1 T)"),
        ("(multiple-value-list (gethash :none h 7))", "(7 NIL)"),
        ("(multiple-value-list (progn (gethash :none h)))", "(NIL NIL)"),
        ("(list (gethash :k h) (gethash :none h) (gethash :none h 7))", "(1 NIL 7)"),
        ("(let ((n 0)) (gethash (incf n) h (incf n)) n)", "2"),
        ("(progn (incf (gethash :k h)) (incf (gethash :new h 10) 2) (list (gethash :k h) (gethash :new h)))", "(2 12)"),
        ("(list (if (gethash :k h) 1 2) (if (gethash :none h) 1 2) (not (gethash :none h)) (+ 1 (gethash :k h)))", "(1 2 T 2)"),
        ("(progn (push 1 (gethash :l h)) (push 2 (gethash :l h)) (gethash :l h))", "(2 1) T"),
        ("(let ((v (gethash :k h)) (f (lambda () (gethash :k h)))) (list v (multiple-value-list (funcall f))))", "(1 (1 T))"),
        ("(list (gethash :k 3))", "TYPE-ERROR: The value 3 is not of type HASH-TABLE when binding HASH-TABLE"),
        ("(setf (gethash :k 3) 1)", "TYPE-ERROR: The value 3 is not of type HASH-TABLE when binding HASH-TABLE"),
        (
            '(let ((h (make-hash-table :test \'equalp))) (setf (gethash 1 h) :a (gethash 1.0 h) :b (gethash "X" h) 3) '
            '(list (gethash 1 h) (gethash "x" h) (hash-table-count h)))',
            "(:B 3 2)",
        ),
        ("(let ((h (make-hash-table :weakness :key))) (setf (gethash :a h) 1) (list (gethash :a h) (gethash :b h 2)))", "(1 2)"),
    ],
)
def test_gethash_gives_one_value_where_one_is_wanted(session, program, wanted):
    assert answer(session, f"(let ((h (make-hash-table))) (setf (gethash :k h) 1) {program})") == wanted
