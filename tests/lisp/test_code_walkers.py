"""Every macro of Common Lisp expands until only special operators, functions and lambda expressions are left, and means the same then.

Programs that walk code (iterate, cl-cont, agnostic-lizard) expand forms in this way. The walker here knows the 25 special operators of
ANSI 3.1.2.1.2.1 and nothing of ours; it refuses an operator that is neither of these nor a macro nor a function.
"""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.packages import COMMON_LISP
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

WALKER = """
(defun walk-all (forms local) (mapcar (lambda (form) (walk form local)) forms))
(defun walk-body (forms local)
  (mapcar (lambda (form) (if (or (stringp form) (and (consp form) (eq (car form) 'declare))) form (walk form local))) forms))
(defun walk-lambda-list (list local)
  (mapcar (lambda (item) (if (and (consp item) (consp (cdr item))) (list* (car item) (walk (cadr item) local) (cddr item)) item)) list))
(defun walk-lambda (form local) (list* 'lambda (walk-lambda-list (cadr form) local) (walk-body (cddr form) local)))
(defun walk-bindings (bindings local)
  (mapcar (lambda (each) (if (consp each) (list* (car each) (walk-all (cdr each) local)) each)) bindings))
(defun walk-functions (definitions local)
  (mapcar (lambda (each) (list* (car each) (walk-lambda-list (cadr each) local) (walk-body (cddr each) local))) definitions))
(defun local-expander (definition)
  (let ((form (gensym)))
    (cons (car definition) (eval `(lambda (,form) (destructuring-bind ,(cadr definition) (cdr ,form) ,@(cddr definition)))))))
(defun walk (form local)
  (cond ((and (symbolp form) (assoc form (cdr local))) (walk (cadr (assoc form (cdr local))) local))
        ((symbolp form) (multiple-value-bind (expansion expanded) (macroexpand-1 form) (if expanded (walk expansion local) form)))
        ((atom form) form)
        ((and (consp (car form)) (eq (caar form) 'lambda)) (cons (walk-lambda (car form) local) (walk-all (cdr form) local)))
        ((not (symbolp (car form))) (error "no operator: ~s" form))
        ((assoc (car form) (car local))
         (let ((found (cdr (assoc (car form) (car local)))))
           (if (eq found :function) (cons (car form) (walk-all (cdr form) local)) (walk (funcall found form) local))))
        (t (case (car form)
             ((quote go) form)
             ((if progn catch throw progv multiple-value-call multiple-value-prog1 unwind-protect)
              (cons (car form) (walk-all (cdr form) local)))
             (tagbody (cons 'tagbody (mapcar (lambda (item) (if (atom item) item (walk item local))) (cdr form))))
             ((block return-from eval-when the) (list* (car form) (cadr form) (walk-all (cddr form) local)))
             (load-time-value (list* 'load-time-value (walk (cadr form) nil) (cddr form)))
             (setq (loop for (name value) on (cdr form) by #'cddr
                         collect (if (or (assoc name (cdr local)) (nth-value 1 (macroexpand-1 name)))
                                     (walk (list 'setf (walk name local) value) local)
                                     (list 'setq name (walk value local)))
                           into assignments
                         finally (return (cons 'progn assignments))))
             ((let let*) (list* (car form) (walk-bindings (cadr form) local) (walk-body (cddr form) local)))
             (locally (cons 'locally (walk-body (cdr form) local)))
             ((flet labels)
              (let ((inner (cons (append (mapcar (lambda (each) (cons (car each) :function)) (cadr form)) (car local)) (cdr local))))
                (list* (car form) (walk-functions (cadr form) (if (eq (car form) 'flet) local inner)) (walk-body (cddr form) inner))))
             (macrolet (cons 'locally
                             (walk-body (cddr form) (cons (append (mapcar #'local-expander (cadr form)) (car local)) (cdr local)))))
             (symbol-macrolet (cons 'locally (walk-body (cddr form) (cons (car local) (append (cadr form) (cdr local))))))
             (function (if (and (consp (cadr form)) (eq (caadr form) 'lambda)) (list 'function (walk-lambda (cadr form) local)) form))
             (t (cond ((special-operator-p (car form)) (error "a special operator of the implementation's own: ~s" form))
                      ((macro-function (car form))
                       (multiple-value-bind (expansion expanded) (macroexpand-1 form)
                         (unless expanded (error "a macro that does not expand: ~s" form))
                         (walk expansion local)))
                      ((fboundp (car form)) (cons (car form) (walk-all (cdr form) local)))
                      (t (error "neither a macro nor a function: ~s" form))))))))
"""

FORMS = {
    "AND": "(and 1 2)",
    "ASSERT": '(let ((x 1)) (assert (= x 1) (x) "no") x)',
    "CASE": "(case 3 ((1 2) :low) (3 :three) (t :high))",
    "CCASE": "(let ((x 3)) (ccase x (3 :three)))",
    "CHECK-TYPE": "(let ((x 3)) (check-type x integer) x)",
    "COND": "(list (cond (nil 1) (2)) (cond ((= 1 2) 3) (t 4 5)))",
    "CTYPECASE": "(let ((x 3)) (ctypecase x (integer :int)))",
    "DECF": "(let ((x (list 3))) (decf (car x) 2) x)",
    "DECLAIM": "(declaim (optimize safety))",
    "DEFCLASS": "(progn (defclass walked-class () ((a :initarg :a :initform (+ 1 1) :reader walked-a))) (walked-a (make-instance 'walked-class)))",
    "DEFCONSTANT": "(defconstant +walked+ 5)",
    "DEFGENERIC": "(progn (defgeneric walked-generic (x) (:method ((x integer)) (list x))) (walked-generic 1))",
    "DEFINE-COMPILER-MACRO": "(define-compiler-macro walked-cm (x) `(list ,x))",
    "DEFINE-CONDITION": "(progn (define-condition walked-c (error) ((a :initarg :a :reader walked-ca)) (:report (lambda (c s) (princ (walked-ca c) s))))"
    " (princ-to-string (make-condition 'walked-c :a 3)))",
    "DEFINE-METHOD-COMBINATION": "(define-method-combination walked-or :operator or)",
    "DEFINE-MODIFY-MACRO": "(progn (define-modify-macro walked-mulf (n) *) (let ((x 3)) (walked-mulf x 4) x))",
    "DEFINE-SETF-EXPANDER": "(define-setf-expander walked-place (x) (values nil nil nil nil x))",
    "DEFINE-SYMBOL-MACRO": "(define-symbol-macro walked-symbol (list 1 2))",
    "DEFMACRO": "(progn (defmacro walked-macro (a &optional (b 2) &rest c) `(list ,a ,b ,@c)) (macroexpand-1 '(walked-macro 1)))",
    "DEFMETHOD": "(progn (defmethod walked-method ((x integer) &optional (y (+ 1 2))) (list x y)) (walked-method 1))",
    "DEFPACKAGE": '(package-name (defpackage "WALKED" (:use :cl)))',
    "DEFPARAMETER": "(progn (defparameter *walked-p* (+ 1 2)) (symbol-value '*walked-p*))",
    "DEFSETF": "(progn (defsetf walked-car (x) (v) `(progn (rplaca ,x ,v) ,v)) (let ((l (list 1))) (setf (walked-car l) 5) l))",
    "DEFSTRUCT": "(progn (defstruct walked-s (a (+ 1 1)) b) (list (funcall 'make-walked-s :b 3)))",
    "DEFTYPE": "(progn (deftype walked-type (n) `(integer 0 ,n)) (typep 3 '(walked-type 4)))",
    "DEFUN": '(progn (defun walked-fun (x &key (y (1+ x))) "doc" (declare (integer x)) (return-from walked-fun (list x y))) (walked-fun 1))',
    "DEFVAR": "(progn (defvar *walked-v* (+ 1 2)) (symbol-value '*walked-v*))",
    "DESTRUCTURING-BIND": "(destructuring-bind (a (b &optional (c 3)) &key d) '(1 (2) :d 4) (list a b c d))",
    "DO": "(do ((i 0 (1+ i)) (l nil (cons i l))) ((= i 3) l) (declare (fixnum i)))",
    "DO*": "(do* ((i 0 (1+ i)) (j i i)) ((= i 3) (list i j)))",
    "DO-ALL-SYMBOLS": "(do-all-symbols (s 5) (return 6))",
    "DO-EXTERNAL-SYMBOLS": "(do-external-symbols (s :cl 5) (when (eq s 'car) (return 6)))",
    "DO-SYMBOLS": "(do-symbols (s :cl 5) (when (eq s 'car) (return 6)))",
    "DOLIST": "(let ((l nil)) (dolist (x '(1 2) (list x l)) (push x l)))",
    "DOTIMES": "(let ((l nil)) (dotimes (i 3 (list i l)) (push i l)))",
    "ECASE": "(ecase 3 (3 :three))",
    "ETYPECASE": "(etypecase 3 (integer :int))",
    "FORMATTER": '(format nil (formatter "~a-~a") 1 2)',
    "HANDLER-BIND": '(let ((l nil)) (block nil (handler-bind ((error (lambda (c) (push (princ-to-string c) l) (return l)))) (error "x"))))',
    "HANDLER-CASE": '(list (handler-case (error "x") (type-error () 1) (error (c) (princ-to-string c)))'
    " (handler-case (values 1 2) (error () 1) (:no-error (a b) (list a b))))",
    "IGNORE-ERRORS": '(list (ignore-errors (error "x")) (ignore-errors 5))',
    "IN-PACKAGE": "(package-name (in-package :cl-user))",
    "INCF": "(let ((x (list 3))) (incf (car x)) x)",
    "LAMBDA": "(funcall (lambda (x &optional (y (+ 1 1))) (list x y)) 1)",
    "LOOP": "(loop with a = 1 for x in '(1 2 3) for (b . c) = (cons x a) when (oddp x) collect (list x b c) into l else sum x into s"
    " finally (return (list l s)))",
    "MULTIPLE-VALUE-BIND": "(multiple-value-bind (a b) (values 1 2) (declare (ignorable b)) (list a b))",
    "MULTIPLE-VALUE-LIST": "(multiple-value-list (values 1 2))",
    "MULTIPLE-VALUE-SETQ": "(let (a b) (multiple-value-setq (a b) (values 1 2)) (list a b))",
    "NTH-VALUE": "(list (nth-value 1 (values 1 2)) (let ((n 0)) (nth-value n (values 1 2))))",
    "OR": "(or nil 2)",
    "POP": "(let ((l (list (list 1 2)))) (list (pop (car l)) l))",
    "PPRINT-LOGICAL-BLOCK": '(let ((*print-pretty* t)) (with-output-to-string (s) (pprint-logical-block (s \'(1 2) :prefix "<" :suffix ">")'
    " (pprint-exit-if-list-exhausted) (loop (princ (pprint-pop) s) (pprint-exit-if-list-exhausted) (princ #\\, s)))))",
    "PRINT-UNREADABLE-OBJECT": "(with-output-to-string (s) (print-unreadable-object (5 s :type t) (princ 1 s)))",
    "PROG": "(prog ((x 1)) again (incf x) (when (< x 4) (go again)) (return x))",
    "PROG*": "(prog* ((x 1) (y x)) (return (list x y)))",
    "PROG1": "(prog1 1 2)",
    "PROG2": "(prog2 1 2 3)",
    "PSETF": "(let ((l (list 1 2))) (psetf (car l) (cadr l) (cadr l) (car l)) l)",
    "PSETQ": "(let ((a 1) (b 2)) (psetq a b b a) (list a b))",
    "PUSH": "(let ((l (list nil))) (push 1 (car l)) l)",
    "PUSHNEW": "(let ((l (list nil))) (pushnew 1 (car l)) l)",
    "REMF": "(let ((l (list (list :a 1)))) (list (remf (car l) :a) l))",
    "RESTART-BIND": "(restart-bind ((r (lambda (x) (list x)))) (invoke-restart 'r 1))",
    "RESTART-CASE": '(restart-case (invoke-restart \'r 1) (r (x) :report "r" (list x)))',
    "RETURN": "(block nil (return 5) 6)",
    "ROTATEF": "(let ((l (list 1 2))) (rotatef (car l) (cadr l)) l)",
    "SETF": "(let ((l (list 1 2 3)) (x 8) (v (vector 1 2)) (h (make-hash-table))) (setf (car l) 5 (nth 1 l) 6 x 7 (aref v 0) 9 (ldb (byte 1 0) (caddr l)) 0"
    " (gethash 1 h) 2 (get 'walked-sym 'a) 3 (values (aref v 1) x) (values 4 5) (getf (cdddr l) :a) 1) (list l x v (gethash 1 h)))",
    "SHIFTF": "(let ((l (list 1 2))) (list (shiftf (car l) (cadr l) 9) l))",
    "TIME": "(let ((*trace-output* (make-broadcast-stream))) (time 5))",
    "TRACE": "(trace)",
    "TYPECASE": "(typecase 3 (string 1) ((or integer symbol) 2) (t 3))",
    "UNLESS": "(unless nil 1 2)",
    "UNTRACE": "(untrace)",
    "WHEN": "(when t 1 2)",
    "WITH-ACCESSORS": "(let ((l (list 1 2))) (with-accessors ((a car) (b cadr)) l (setf a 5) (list a b l)))",
    "WITH-COMPILATION-UNIT": "(with-compilation-unit () 5)",
    "WITH-CONDITION-RESTARTS": "(with-condition-restarts (make-condition 'error) nil 5)",
    "WITH-HASH-TABLE-ITERATOR": "(let ((h (make-hash-table))) (setf (gethash 1 h) 2) (with-hash-table-iterator (next h) (multiple-value-list (next))))",
    "WITH-INPUT-FROM-STRING": '(with-input-from-string (s "5 6") (list (read s) (read s)))',
    "WITH-OPEN-FILE": '(with-open-file (s "/nowhere/at/all" :if-does-not-exist nil) s)',
    "WITH-OPEN-STREAM": '(with-open-stream (s (make-string-input-stream "5")) (read s))',
    "WITH-OUTPUT-TO-STRING": "(with-output-to-string (s) (princ 5 s))",
    "WITH-PACKAGE-ITERATOR": "(with-package-iterator (next :cl :external) (symbolp (nth-value 1 (next))))",
    "WITH-SIMPLE-RESTART": '(multiple-value-list (with-simple-restart (r "r ~a" 1) (invoke-restart \'r)))',
    "WITH-SLOTS": "(progn (defclass walked-slots () ((a :initform 1) (b :initform 2))) (with-slots (a (c b)) (make-instance 'walked-slots) (setf a 5) (list a c)))",
    "WITH-STANDARD-IO-SYNTAX": "(with-standard-io-syntax (prin1-to-string 'a))",
}
WITHOUT_A_FORM = "CALL-METHOD DEFPACKAGE LOOP-FINISH PPRINT-EXIT-IF-LIST-EXHAUSTED PPRINT-POP STEP".split()


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.package = "COMMON-LISP-USER"
    made.evaluate_text(WALKER)
    yield made
    kernel.stop()


def values(session, text):
    return [prin1_to_string(value) for value in session.evaluate_text(text)]


@pytest.mark.soak(all_but=16)
@pytest.mark.parametrize("name", FORMS)
def test_a_macro_expands_to_what_every_walker_knows(session, name):
    wanted = values(session, FORMS[name])
    assert values(session, f"(eval (walk '{FORMS[name]} nil))") == wanted


def test_each_macro_of_the_standard_has_a_form_here(session):
    macros = {symbol.name for symbol in COMMON_LISP.external.values() if getattr(symbol, "macro", None) is not None}
    assert sorted(macros - set(FORMS) - set(WITHOUT_A_FORM)) == []
