"""Names from the inside of SBCL that portable libraries take, as CL-STORE, Nibbles, MD5 and synchronization-tools do. The answers are those of
SBCL 2.2.9: see ``test_numbers_against_sbcl.py`` for how to read this."""

# ruff: noqa: E501

from __future__ import annotations

from test_numbers_against_sbcl import check

INSIDE = r"""
(sb-kernel:single-float-bits -0.0)
=> -2147483648
(list (sb-kernel:double-float-high-bits -1.5d0) (sb-kernel:double-float-low-bits 0.1d0) (sb-kernel:double-float-bits -1d0))
=> (-1074266112 2576980378 -4616189618054758400)
(sb-kernel:make-double-float (sb-kernel:double-float-high-bits 0.1d0) (sb-kernel:double-float-low-bits 0.1d0))
=> 0.1d0
(handler-case (sb-int:missing-arg) (error (c) (princ-to-string c)))
=> "A required &KEY or &OPTIONAL argument was not supplied."
(progn (defstruct part (size (sb-int:missing-arg) :type fixnum) (name "n")) (handler-case (make-part) (error (c) (princ-to-string c))))
=> "A required &KEY or &OPTIONAL argument was not supplied."
(funcall (sb-int:named-lambda called (x &optional (y 2)) (list x y)) 1)
=> (1 2)
(let ((v (vector 1 2 3 4 5 6 7))) (sb-kernel:with-array-data ((d v) (s 2) (e nil)) (list d s e)))
=> (#(1 2 3 4 5 6 7) 2 7)
(let ((v (make-array 5 :displaced-to (vector 9 8 7 6 5 4 3) :displaced-index-offset 2))) (sb-kernel:with-array-data ((d v) (s 1) (e 3)) (list (aref d s) (- e s))))
=> (6 2)
(let ((v (make-array 4 :initial-contents '(1 2 3 4)))) (sb-kernel:shrink-vector v 2))
=> #(1 2)
(let ((s (copy-seq "octets"))) (sb-kernel:%shrink-vector s 3))
=> "oct"
(let ((to (make-array 6 :element-type '(unsigned-byte 8) :initial-element 0))) (sb-kernel:ub8-bash-copy (coerce '(1 2 3 4) '(vector (unsigned-byte 8))) 1 to 2 3) to)
=> #(0 0 2 3 4 0)
(list (typep 0 'sb-int:index) (typep -1 'sb-int:index) (typep (1- array-dimension-limit) 'sb-int:index) (typep (1- (expt 2 64)) 'sb-vm:word) (typep (expt 2 64) 'sb-vm:word))
=> (T NIL T T NIL)
(mapcar #'sb-kernel:dsd-name (sb-kernel:dd-slots (sb-kernel:find-defstruct-description (progn (defstruct base (a 1 :type fixnum)) (defstruct (derived (:include base)) b) 'derived))))
=> (A B)
(mapcar #'sb-kernel:dsd-type (sb-kernel:dd-slots (sb-kernel:find-defstruct-description (progn (defstruct typed (a 1 :type fixnum) (b "" :type string) c) 'typed))))
=> (FIXNUM STRING T)
(mapcar (lambda (c) (subtypep c 'condition)) '(sb-c:compiler-error sb-c:fatal-compiler-error sb-int:bug sb-kernel:redefinition-warning sb-int:package-at-variance))
=> (T T T T T)
(typep (find-class 'simple-error) 'sb-pcl::condition-class)
=> T
(typep (find-class 'standard-object) 'sb-pcl::condition-class)
=> NIL
(mapcar #'sb-mop:slot-definition-name (sb-mop:compute-slots (progn (defclass two () (one two)) (make-instance 'two) (find-class 'two))))
=> (ONE TWO)
(sb-int:with-float-traps-masked (:overflow) (list (expt most-negative-single-float 2) (expt most-negative-single-float 3)))
=> (#.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY #.SB-EXT:SINGLE-FLOAT-NEGATIVE-INFINITY)
(sb-int:with-float-traps-masked (:overflow) (let ((x most-positive-double-float)) (list (* x 2) (+ x x) (- (- x) x) (/ x 1d-3))))
=> (#.SB-EXT:DOUBLE-FLOAT-POSITIVE-INFINITY #.SB-EXT:DOUBLE-FLOAT-POSITIVE-INFINITY #.SB-EXT:DOUBLE-FLOAT-NEGATIVE-INFINITY #.SB-EXT:DOUBLE-FLOAT-POSITIVE-INFINITY)
(sb-int:with-float-traps-masked (:overflow) (let ((x most-positive-single-float)) (list (* x 2) (+ x x) (- (- x) x) (/ x 1e-3))))
=> (#.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY #.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY #.SB-EXT:SINGLE-FLOAT-NEGATIVE-INFINITY #.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY)
(sb-int:with-float-traps-masked (:divide-by-zero) (list (/ 1.0 0.0) (/ -1d0 0d0) (/ 1 -0.0) (/ 3 0d0)))
=> (#.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY #.SB-EXT:DOUBLE-FLOAT-NEGATIVE-INFINITY #.SB-EXT:SINGLE-FLOAT-NEGATIVE-INFINITY #.SB-EXT:DOUBLE-FLOAT-POSITIVE-INFINITY)
(sb-int:with-float-traps-masked (:divide-by-zero :invalid) (list (/ 0d0 0d0) (/ 0.0 0.0)))
=> (#<DOUBLE-FLOAT quiet NaN> #<SINGLE-FLOAT quiet NaN>)
(sb-int:with-float-traps-masked (:overflow) (handler-case (/ 1.0 0.0) (error (c) (type-of c))))
=> DIVISION-BY-ZERO
(sb-int:with-float-traps-masked (:divide-by-zero) (handler-case (* most-positive-single-float 2) (error (c) (type-of c))))
=> FLOATING-POINT-OVERFLOW
(progn (sb-int:with-float-traps-masked (:overflow) (* most-positive-single-float 2)) (handler-case (let ((x most-positive-single-float)) (* x x)) (error (c) (type-of c))))
=> FLOATING-POINT-OVERFLOW
(sb-int:with-float-traps-masked (:overflow :divide-by-zero) (handler-case (/ 1 0) (error (c) (type-of c))))
=> DIVISION-BY-ZERO
(progn (defun square-of (x) (declare (double-float x)) (* x x)) (list (sb-int:with-float-traps-masked (:overflow) (square-of 1d200)) (handler-case (square-of 1d200) (error (c) (type-of c)))))
=> (#.SB-EXT:DOUBLE-FLOAT-POSITIVE-INFINITY FLOATING-POINT-OVERFLOW)
(progn (defun square-of-single (x) (declare (single-float x)) (* x x)) (list (sb-int:with-float-traps-masked (:overflow) (square-of-single 1e30)) (handler-case (square-of-single 1e30) (error (c) (type-of c)))))
=> (#.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY FLOATING-POINT-OVERFLOW)
(sb-int:with-float-traps-masked (:overflow) (list (exp 1000d0) (exp 1000.0) (scale-float 1d0 2000)))
=> (#.SB-EXT:DOUBLE-FLOAT-POSITIVE-INFINITY #.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY #.SB-EXT:DOUBLE-FLOAT-POSITIVE-INFINITY)
(sb-int:with-float-traps-masked (:overflow) (coerce (let ((x 1d300)) x) 'single-float))
=> #.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY
(getf (sb-int:get-floating-point-modes) :traps)
=> (:OVERFLOW :INVALID :DIVIDE-BY-ZERO)
(getf (sb-int:with-float-traps-masked (:overflow :inexact) (sb-int:get-floating-point-modes)) :traps)
=> (:INVALID :DIVIDE-BY-ZERO)
(unwind-protect (progn (sb-int:set-floating-point-modes :traps nil) (expt most-positive-single-float 3)) (sb-int:set-floating-point-modes :traps '(:overflow :invalid :divide-by-zero)))
=> #.SB-EXT:SINGLE-FLOAT-POSITIVE-INFINITY
(string= (sb-unix:posix-getcwd/) (concatenate 'string (sb-posix:getcwd) "/"))
=> T
(sb-introspect:function-lambda-list (progn (defun three (a &optional b &key c) (list a b c)) #'three))
=> (A &OPTIONAL B &KEY C)
(list (make-pathname :host "" :name "a") (handler-case (make-pathname :host "zz" :name "a") (error (c) (princ-to-string c))))
=> (#P"a" "logical host not yet defined: \"zz\"")
(list (nth-value 2 (function-lambda-expression #'car)) (nth-value 2 (function-lambda-expression #'(setf gethash))) (nth-value 2 (function-lambda-expression #'reduce)))
=> (CAR (SETF GETHASH) REDUCE)
(mapcar #'sb-mop:slot-definition-name (sb-mop:class-slots (progn (defstruct shelf boards (width 1 :type integer)) (find-class 'shelf))))
=> (BOARDS WIDTH)
(defconstant +legs+ 1)
=> +LEGS+
(handler-case (eval '(defconstant +legs+ 2)) (sb-ext:defconstant-uneql (c) (list (sb-ext:defconstant-uneql-name c) (sb-ext:defconstant-uneql-old-value c) (sb-ext:defconstant-uneql-new-value c))))
=> (+LEGS+ 1 2)
(list (handler-bind ((sb-ext:defconstant-uneql #'abort)) (eval '(defconstant +legs+ 2))) (symbol-value '+legs+))
=> (+LEGS+ 1)
(list (handler-bind ((sb-ext:defconstant-uneql #'continue)) (eval '(defconstant +legs+ 2))) (symbol-value '+legs+))
=> (+LEGS+ 2)
(eq 'sb-kernel:package-at-variance 'sb-int:package-at-variance)
=> T
"""


FUNCTION_TYPES = r"""
(deftype translator () '(function (fixnum t) t))
=> TRANSLATOR
(defun declared (x) (declare (type (or null (function (fixnum) t)) x)) x)
=> DECLARED
(list (declared nil) (functionp (declared #'car)) (handler-case (declared 3) (type-error () :no)))
=> (NIL T :NO)
(progn (defun by-name (x &key y z) (declare (type translator x) (type (or null translator) y) (type (not (function (t) t)) z)) (list (functionp x) y z)) (by-name #'car))
=> (T NIL NIL)
(handler-case (by-name 3) (type-error () :no))
=> :NO
(handler-case (by-name #'car :y 3) (type-error () :no))
=> :NO
(handler-case (by-name #'car :z #'car) (type-error () :no))
=> :NO
(progn (defstruct wheel (turn nil :type (or null (function (t) t)))) (list (wheel-turn (make-wheel)) (functionp (wheel-turn (make-wheel :turn #'car)))))
=> (NIL T)
(handler-case (typep 3 '(function (t) t)) (error () :refused))
=> :REFUSED
(handler-case (eval '(typep 3 '(or null (function (t) t)))) (error () :refused))
=> :REFUSED
"""


def test_declared_types_of_functions_are_tested_as_functions():
    """TYPEP refuses them; a declaration of one says that it is a function (ANSI 4.2.3)."""
    check(FUNCTION_TYPES)


def test_what_libraries_take_from_the_inside_of_sbcl_answers_as_there():
    check(INSIDE)
