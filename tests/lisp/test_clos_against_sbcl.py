"""CLOS, structures and conditions answer as in SBCL 2.2.9: see ``test_numbers_against_sbcl.py`` for how to read this."""

# ruff: noqa: E501

from __future__ import annotations

from test_numbers_against_sbcl import check

OBJECTS = r"""
(defclass a () ((x :initarg :x :accessor ax) (y :initform 2 :reader ay :writer set-ay) (z :allocation :class :initform 9)))
(defclass b (a) ((w :initarg :w)) (:default-initargs :x 77))
(defstruct tm speed (angle 2))
(defstruct (tn (:include tm (speed 7)) (:constructor mk (speed &optional angle &key (q 3)))) q)
(defstruct (tl (:type list) :named) p q)
(defstruct (ro (:constructor nil)) (a 1 :read-only t :type fixnum))
(defstruct (ty) (a 1 :type fixnum))
(define-condition my-c (error) ((who :initarg :who :reader who)) (:report (lambda (c s) (format s "who ~a" (who c)))))
(define-condition my-d (error) ((who :initarg :who :reader who)))
(defgeneric foo (x))
(defmethod foo ((x integer)) (list :int (if (next-method-p) (call-next-method) nil)))
(defmethod foo :before ((x string)) 1)
(foo 1)
=> (:INT NIL)
(foo 'a)
=> SB-PCL::NO-APPLICABLE-METHOD-ERROR: There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::FOO (2)> when called with arguments (A). See also: The ANSI Standard, Section 7.6.6
(foo "a")
=> SB-PCL::NO-PRIMARY-METHOD-ERROR: There is no primary method for the generic function #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::FOO (2)> when called with arguments ("a"). See also: The ANSI Standard, Section 7.6.6.2
(foo)
=> SB-INT:SIMPLE-PROGRAM-ERROR: invalid number of arguments: 0
(foo 1 2)
=> SB-INT:SIMPLE-PROGRAM-ERROR: invalid number of arguments: 2
(ax (make-instance 'a))
=> UNBOUND-SLOT: The slot COMMON-LISP-USER::X is unbound in the object #<A {}>.
(slot-value (make-instance 'a) 'nope)
=> SB-PCL::MISSING-SLOT: When attempting to read the slot's value (slot-value), the slot NOPE is missing from the object #<A {}>.
(setf (slot-value (make-instance 'a) 'nope) 1)
=> SB-PCL::MISSING-SLOT: When attempting to set the slot's value to 1 (SETF of SLOT-VALUE), the slot NOPE is missing from the object #<A {}>.
(slot-value 5 'x)
=> SB-PCL::MISSING-SLOT: When attempting to read the slot's value (slot-value), the slot X is missing from the object 5.
(ax 5)
=> SB-PCL::NO-APPLICABLE-METHOD-ERROR: There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::AX (1)> when called with arguments (5). See also: The ANSI Standard, Section 7.6.6
(setf (ax 5) 1)
=> SB-PCL::NO-APPLICABLE-METHOD-ERROR: There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION (COMMON-LISP:SETF COMMON-LISP-USER::AX) (1)> when called with arguments (1 5). See also: The ANSI Standard, Section 7.6.6
(make-instance 'a :foo 1)
=> SB-PCL::INITARG-ERROR: Invalid initialization argument: :FOO in call for class #<STANDARD-CLASS COMMON-LISP-USER::A>. See also: The ANSI Standard, Section 7.1.2
(make-instance 'a :foo 1 :bar 2)
=> SB-PCL::INITARG-ERROR: Invalid initialization arguments: :BAR, :FOO in call for class #<STANDARD-CLASS COMMON-LISP-USER::A>. See also: The ANSI Standard, Section 7.1.2
(make-instance 'a :x)
=> SB-INT:SIMPLE-PROGRAM-ERROR: odd number of &KEY arguments
(make-instance 'nope)
=> SB-PCL:CLASS-NOT-FOUND-ERROR: There is no class named COMMON-LISP-USER::NOPE.
(make-instance nil)
=> SB-PCL:CLASS-NOT-FOUND-ERROR: There is no class named COMMON-LISP:NIL.
(make-instance 5)
=> SB-PCL::NO-APPLICABLE-METHOD-ERROR: There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION COMMON-LISP:MAKE-INSTANCE (2)> when called with arguments (5). See also: The ANSI Standard, Section 7.6.6
(find-class 'nope)
=> SB-PCL:CLASS-NOT-FOUND-ERROR: There is no class named COMMON-LISP-USER::NOPE.
(find-class 'nope nil)
=> NIL
(ax (make-instance 'b))
=> 77
(slot-value (make-instance 'b) 'w)
=> UNBOUND-SLOT: The slot COMMON-LISP-USER::W is unbound in the object #<B {}>.
(slot-boundp (make-instance 'b) 'w)
=> NIL
(slot-boundp (make-instance 'b) 'nope)
=> SB-PCL::MISSING-SLOT: When attempting to test to see whether slot is bound (SLOT-BOUNDP), the slot NOPE is missing from the object #<B {}>.
(slot-exists-p (make-instance 'b) 'nope)
=> NIL
(slot-makunbound (make-instance 'b) 'nope)
=> SB-PCL::MISSING-SLOT: When attempting to make the slot unbound (SLOT-MAKUNBOUND), the slot NOPE is missing from the object #<B {}>.
(make-tm :speed 1)
=> #S(TM :SPEED 1 :ANGLE 2)
(make-tm 1)
=> SB-INT:SIMPLE-PROGRAM-ERROR: odd number of &KEY arguments
(mk 1)
=> #S(TN :SPEED 1 :ANGLE 2 :Q 3)
(mk 1 2)
=> #S(TN :SPEED 1 :ANGLE 2 :Q 3)
(tn-speed (mk 1))
=> 1
(tm-p (mk 1))
=> T
(make-tl :p 1)
=> (TL 1 NIL)
(tl-q '(1 2 3))
=> 3
(make-ty :a "s")
=> TYPE-ERROR: The value "s" is not of type FIXNUM when setting slot A of structure TY
(copy-structure 5)
=> TYPE-ERROR: The value 5 is not of type STRUCTURE-OBJECT when binding STRUCTURE
(error 'my-c :who 1)
=> MY-C: who 1
(error 'my-d)
=> MY-D: Condition COMMON-LISP-USER::MY-D was signalled.
(make-condition 'my-c :foo 1)
=> #<MY-C {}>
(who (make-condition 'my-d))
=> SIMPLE-ERROR: Unbound condition slot: WHO
(who 5)
=> SB-PCL::NO-APPLICABLE-METHOD-ERROR: There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::WHO (2)> when called with arguments (5). See also: The ANSI Standard, Section 7.6.6
(make-condition 'my-d :who 1)
=> #<MY-D {}>
(no-next 1)
=> UNDEFINED-FUNCTION: The function COMMON-LISP-USER::NO-NEXT is undefined.
(defgeneric nn (x))
(defmethod nn ((x integer)) (call-next-method))
(class-of 5)
=> #<BUILT-IN-CLASS COMMON-LISP:FIXNUM>
(class-of nil)
=> #<BUILT-IN-CLASS COMMON-LISP:NULL>
(class-of t)
=> #<BUILT-IN-CLASS COMMON-LISP:SYMBOL>
(class-of 'a)
=> #<BUILT-IN-CLASS COMMON-LISP:SYMBOL>
(class-of :a)
=> #<BUILT-IN-CLASS COMMON-LISP:SYMBOL>
(class-of 1.0)
=> #<BUILT-IN-CLASS COMMON-LISP:SINGLE-FLOAT>
(class-of 1d0)
=> #<BUILT-IN-CLASS COMMON-LISP:DOUBLE-FLOAT>
(class-of '(1))
=> #<BUILT-IN-CLASS COMMON-LISP:CONS>
(class-of #\a)
=> #<BUILT-IN-CLASS COMMON-LISP:CHARACTER>
(class-of #(1))
=> #<BUILT-IN-CLASS COMMON-LISP:SIMPLE-VECTOR>
(class-of (find-class 'a))
=> #<STANDARD-CLASS COMMON-LISP:STANDARD-CLASS>
(class-of (make-tm))
=> #<STRUCTURE-CLASS COMMON-LISP-USER::TM>
(class-of (find-class 'tm))
=> #<STANDARD-CLASS COMMON-LISP:STRUCTURE-CLASS>
(class-of (find-class 'my-c))
=> #<STANDARD-CLASS SB-PCL::CONDITION-CLASS>
(class-of 1/2)
=> #<BUILT-IN-CLASS COMMON-LISP:RATIO>
(class-of (expt 2 100))
=> #<BUILT-IN-CLASS COMMON-LISP:BIGNUM>
(class-of *package*)
=> #<STRUCTURE-CLASS COMMON-LISP:PACKAGE>
(class-of (make-instance 'a))
=> #<STANDARD-CLASS COMMON-LISP-USER::A>
#'foo
=> #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::FOO (2)>
(find-class 'a)
=> #<STANDARD-CLASS COMMON-LISP-USER::A>
(find-class 'integer)
=> #<BUILT-IN-CLASS COMMON-LISP:INTEGER>
(find-class 'my-c)
=> #<SB-PCL::CONDITION-CLASS COMMON-LISP-USER::MY-C>
(find-method #'foo nil (list (find-class 'integer)))
=> #<STANDARD-METHOD COMMON-LISP-USER::FOO (INTEGER) {}>
(find-method #'foo '(:before) (list (find-class 'string)))
=> #<STANDARD-METHOD COMMON-LISP-USER::FOO :BEFORE (STRING) {}>
(find-method #'foo nil (list (find-class 'cons)))
=> SIMPLE-ERROR: There is no method on #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::FOO (2)> with no qualifiers and specializers (#<BUILT-IN-CLASS COMMON-LISP:CONS>).
(find-method #'foo nil (list (find-class 'cons)) nil)
=> NIL
(defmethod foo ((x nope)) 1)
=> SB-PCL:CLASS-NOT-FOUND-ERROR: There is no class named COMMON-LISP-USER::NOPE.
(defmethod car ((x t)) 1)
=> SB-INT:SIMPLE-PROGRAM-ERROR: COMMON-LISP:CAR already names an ordinary function or a macro.
(defgeneric list (x))
=> SB-INT:SIMPLE-PROGRAM-ERROR: COMMON-LISP:LIST already names an ordinary function or a macro.
(defclass c (c1) ())
=> #<STANDARD-CLASS COMMON-LISP-USER::C>
(find-class 'c1)
=> #<SB-MOP:FORWARD-REFERENCED-CLASS COMMON-LISP-USER::C1>
(find-class 'c1 nil)
=> #<SB-MOP:FORWARD-REFERENCED-CLASS COMMON-LISP-USER::C1>
(make-instance 'd2)
=> SB-PCL:CLASS-NOT-FOUND-ERROR: There is no class named COMMON-LISP-USER::D2.
(defclass dd () (x x))
=> SB-INT:SIMPLE-PROGRAM-ERROR: Multiple slots named X in DEFCLASS DD.
(change-class (make-instance 'a) 'nope)
=> SB-PCL:CLASS-NOT-FOUND-ERROR: There is no class named COMMON-LISP-USER::NOPE.
(defmethod foo :bad ((x t)) 1)
=> #<STANDARD-METHOD COMMON-LISP-USER::FOO :BAD (T) {}>
(defgeneric foo (x y))
=> SIMPLE-ERROR: New lambda-list (X Y) is incompatible with existing methods of #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::FOO (3)>. Old lambda-list (X)
(defmethod bar ((x t)) 1)
=> #<STANDARD-METHOD COMMON-LISP-USER::BAR (T) {}>
(defmethod bar + ((x t)) 1)
=> #<STANDARD-METHOD COMMON-LISP-USER::BAR + (T) {}>
(defmethod bar + ((x integer)) 10)
=> #<STANDARD-METHOD COMMON-LISP-USER::BAR + (INTEGER) {}>
(defmethod bar :around (x) (list (call-next-method)))
=> #<STANDARD-METHOD COMMON-LISP-USER::BAR :AROUND (T) {}>
(defmethod kk ((x integer) &key a) a)
=> #<STANDARD-METHOD COMMON-LISP-USER::KK (INTEGER) {}>
(kk 1 :b 2)
=> SB-INT:SIMPLE-PROGRAM-ERROR: invalid keyword argument: :B (valid keys are :A).
(kk 1 :a)
=> SB-INT:SIMPLE-PROGRAM-ERROR: odd number of &KEY arguments
(kk 1 :a 5)
=> 5
(defmethod kk ((x number) &key b) b)
=> #<STANDARD-METHOD COMMON-LISP-USER::KK (NUMBER) {}>
(kk 1 :b 2)
=> NIL
(kk 1.0 :a 2)
=> SB-INT:SIMPLE-PROGRAM-ERROR: invalid keyword argument: :A (valid keys are :B).
(make-instance 'integer)
=> SIMPLE-ERROR: Cannot allocate an instance of #<BUILT-IN-CLASS COMMON-LISP:INTEGER>.
(allocate-instance (find-class 'a))
=> #<A {}>
(with-slots (q) (make-instance 'a) q)
=> SB-PCL::MISSING-SLOT: When attempting to read the slot's value (slot-value), the slot Q is missing from the object #<A {}>.
(typep 5 'nope)
=> SIMPLE-ERROR: unknown type specifier: NOPE
(typep 5 '(nope 1))
=> SIMPLE-ERROR: unknown type specifier: (NOPE 1)
(typep 5 5)
=> SIMPLE-ERROR: bad thing to be a type specifier: 5
(typep 5 '(satisfies nope))
=> UNDEFINED-FUNCTION: The function COMMON-LISP-USER::NOPE is undefined.
(let ((x (make-instance 'a))) (slot-makunbound x 'y) (ay x))
=> UNBOUND-SLOT: The slot COMMON-LISP-USER::Y is unbound in the object #<A {}>.
(reinitialize-instance (make-instance 'a) :foo 1)
=> SB-PCL::INITARG-ERROR: Invalid initialization argument: :FOO in call for class #<STANDARD-CLASS COMMON-LISP-USER::A>. See also: The ANSI Standard, Section 7.1.2
(reinitialize-instance (make-instance 'a) :y 1)
=> SB-PCL::INITARG-ERROR: Invalid initialization argument: :Y in call for class #<STANDARD-CLASS COMMON-LISP-USER::A>. See also: The ANSI Standard, Section 7.1.2
(class-name (find-class 'a))
=> A
(slot-value (make-instance 'a) 5)
=> TYPE-ERROR: The value 5 is not of type SYMBOL when binding SB-PCL::SLOT-NAME
(remove-method #'foo (find-method #'foo nil (list (find-class 'integer))))
=> #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::FOO (2)>
(compute-applicable-methods #'foo '(1))
=> (#<STANDARD-METHOD COMMON-LISP-USER::FOO :BAD (T) {}>)
(let ((x 5)) (check-type x string))
=> SIMPLE-TYPE-ERROR: The value of X is 5, which is not of type STRING.
(let ((x 5)) (check-type x string "a thing"))
=> SIMPLE-TYPE-ERROR: The value of X is 5, which is not a thing.
(defmethod foo2 ((x (eql 5))) 1)
=> #<STANDARD-METHOD COMMON-LISP-USER::FOO2 ((EQL 5)) {}>
(find-method #'foo2 nil '((eql 5)))
=> #<STANDARD-METHOD COMMON-LISP-USER::FOO2 ((EQL 5)) {}>
(foo2 6)
=> SB-PCL::NO-APPLICABLE-METHOD-ERROR: There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::FOO2 (1)> when called with arguments (6). See also: The ANSI Standard, Section 7.6.6
(defmethod (setf foo3) (n (x integer)) n)
=> #<STANDARD-METHOD (COMMON-LISP:SETF COMMON-LISP-USER::FOO3) (T INTEGER) {}>
(setf (foo3 "a") 1)
=> SB-PCL::NO-APPLICABLE-METHOD-ERROR: There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION (COMMON-LISP:SETF COMMON-LISP-USER::FOO3) (1)> when called with arguments (1 "a"). See also: The ANSI Standard, Section 7.6.6
(describe (make-tm))
=>
"""


def test_objects_and_their_errors_answer_as_in_sbcl():
    check(OBJECTS)
