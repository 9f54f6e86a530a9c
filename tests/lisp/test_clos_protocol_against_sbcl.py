"""The protocols of CLOS (initialization, redefinition, method combination) answer as in SBCL 2.2.9.

See ``test_numbers_against_sbcl.py`` for how to read this.
"""

# ruff: noqa: E501

from __future__ import annotations

from test_numbers_against_sbcl import check

PROTOCOLS = r"""
(defvar *log* nil)
(defun note (x) (push x *log*))
(defmacro logged (form) `(let ((*log* nil)) (let ((r ,form)) (list r (reverse *log*)))))
(defclass animal () ((name :initarg :name :accessor name :initform "anon") (legs :initarg :legs :reader legs :initform 4)))
(defclass dog (animal) ((tricks :initform nil :accessor tricks)) (:default-initargs :legs 4))
(defclass puppy (dog) ())
(defgeneric speak (x) (:documentation "says") (:method ((x animal)) (note :animal) :generic))
(defmethod speak ((x dog)) (note :dog) (list :woof (call-next-method)))
(defmethod speak :before ((x animal)) (note :before-animal))
(defmethod speak :before ((x dog)) (note :before-dog))
(defmethod speak :after ((x animal)) (note :after-animal))
(defmethod speak :after ((x dog)) (note :after-dog))
(defmethod speak :around ((x puppy)) (note :around) (list :puppy (call-next-method)))
(logged (speak (make-instance 'animal)))
=> (:GENERIC (:BEFORE-ANIMAL :ANIMAL :AFTER-ANIMAL))
(logged (speak (make-instance 'dog)))
=> ((:WOOF :GENERIC) (:BEFORE-DOG :BEFORE-ANIMAL :DOG :ANIMAL :AFTER-ANIMAL :AFTER-DOG))
(logged (speak (make-instance 'puppy)))
=> ((:PUPPY (:WOOF :GENERIC)) (:AROUND :BEFORE-DOG :BEFORE-ANIMAL :DOG :ANIMAL :AFTER-ANIMAL :AFTER-DOG))
(documentation 'speak 'function)
=> "says"
(defmethod initialize-instance :after ((d dog) &key (extra 1)) (push extra (tricks d)))
(tricks (make-instance 'dog))
=> (1)
(tricks (make-instance 'dog :extra 5))
=> (5)
(make-instance 'animal :extra 5)
=> SB-PCL::INITARG-ERROR: Invalid initialization argument: :EXTRA in call for class #<STANDARD-CLASS COMMON-LISP-USER::ANIMAL>. See also: The ANSI Standard, Section 7.1.2
(tricks (make-instance 'puppy :extra 7 :name "x"))
=> (7)
(defmethod shared-initialize :before ((d puppy) slots &rest args) (note (list :shared slots args)))
(logged (name (make-instance 'puppy :name "z")))
=> ("z" ((:SHARED T (:NAME "z" :LEGS 4))))
(defmethod print-object ((a animal) stream) (print-unreadable-object (a stream :type t) (format stream "~a" (name a))))
(defgeneric area (s &key scale))
(defmethod area ((s integer) &key (scale 1)) (* s scale))
(defmethod area ((s string) &key scale other) (list scale other))
(area 3)
=> 3
(area 3 :scale 4)
=> 12
(area 3 :other 4)
=> SB-INT:SIMPLE-PROGRAM-ERROR: invalid keyword argument: :OTHER (valid keys are :SCALE).
(area "a" :other 4)
=> (NIL 4)
(area "a" :foo 4 :allow-other-keys t)
=> (NIL NIL)
(defgeneric both (a b))
(defmethod both ((a integer) (b t)) (list :int-t (if (next-method-p) (call-next-method) :none)))
(defmethod both ((a number) (b string)) (list :num-str (if (next-method-p) (call-next-method) :none)))
(defmethod both ((a t) (b t)) :any)
(defmethod both ((a (eql 3)) (b string)) (list :three (call-next-method)))
(both 1 "a")
=> (:INT-T (:NUM-STR :ANY))
(both 1.0 "a")
=> (:NUM-STR :ANY)
(both 3 "a")
=> (:THREE (:INT-T (:NUM-STR :ANY)))
(both 3 3)
=> (:INT-T :ANY)
(both nil nil)
=> :ANY
(both 4 "x")
=> (:INT-T (:NUM-STR :ANY))
(both 3 "b")
=> (:THREE (:INT-T (:NUM-STR :ANY)))
(defgeneric rev (a b) (:argument-precedence-order b a))
(defmethod rev ((a integer) (b t)) :a)
(defmethod rev ((a t) (b integer)) :b)
(rev 1 1)
=> :B
(defmethod cn ((x integer) y) (list :int x y))
(defmethod cn ((x (eql 5)) y) (list :five (call-next-method x :changed) (call-next-method)))
(cn 5 1)
=> (:FIVE (:INT 5 :CHANGED) (:INT 5 1))
(cn 6 1)
=> (:INT 6 1)
(defmethod kinds ((x list)) :list)
(defmethod kinds ((x null)) (list :null (call-next-method)))
(defmethod kinds ((x symbol)) (list :sym (and (next-method-p) (call-next-method))))
(defmethod kinds ((x string)) :string)
(defmethod kinds ((x vector)) :vector)
(defmethod kinds ((x number)) :number)
(defmethod kinds ((x float)) :float)
(defmethod kinds ((x function)) :function)
(defmethod kinds ((x character)) :char)
(defmethod kinds ((x hash-table)) :hash)
(defmethod kinds ((x (eql :k))) :k)
(defmethod kinds ((x double-float)) (list :double (call-next-method)))
(defmethod kinds ((x ratio)) :ratio)
(defmethod kinds ((x structure-object)) :struct)
(defmethod kinds ((x standard-object)) :std)
(defmethod kinds ((x condition)) :cond)
(defmethod kinds ((x class)) :class)
(defmethod kinds ((x stream)) :stream)
(defmethod kinds ((x package)) :package)
(defstruct st a)
(list (kinds nil) (kinds t) (kinds 'a) (kinds '(1)) (kinds "s") (kinds #(1)) (kinds 1) (kinds 1.0) (kinds 1d0) (kinds 1/2) (kinds #'car) (kinds #'kinds) (kinds #\a) (kinds (make-hash-table)) (kinds :k) (kinds :j) (kinds (make-st)) (kinds (make-instance 'dog)) (kinds (make-condition 'error)) (kinds (find-class 'dog)) (kinds *standard-output*) (kinds *package*))
=> ((:NULL (:SYM :LIST)) (:SYM NIL) (:SYM NIL) :LIST :STRING :VECTOR :NUMBER :FLOAT (:DOUBLE :FLOAT) :RATIO :FUNCTION :FUNCTION :CHAR :HASH :K (:SYM NIL) :STRUCT :STD :COND :CLASS :STREAM :PACKAGE)
(defclass p1 () ((x :initarg :x :accessor px) (y :initform 10 :accessor py)))
(defvar *p* (make-instance 'p1 :x 1))
(defclass p1 () ((x :initarg :x :accessor px) (z :initform 33 :accessor pz)))
(px *p*)
=> 1
(pz *p*)
=> 33
(slot-exists-p *p* 'y)
=> NIL
(slot-value *p* 'y)
=> SB-PCL::MISSING-SLOT: When attempting to read the slot's value (slot-value), the slot Y is missing from the object #<P1 {}>.
(py *p*)
=> SB-PCL::NO-APPLICABLE-METHOD-ERROR: There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::PY (0)> when called with arguments (#<P1 {}>). See also: The ANSI Standard, Section 7.6.6
(defclass p2 (p1) ((w :initform 5)))
(defvar *q* (make-instance 'p2 :x 1))
(defclass p1 () ((x :initarg :x :accessor px) (z :initform 33 :accessor pz) (v :initform 44 :accessor pv)))
(pv *q*)
=> 44
(slot-value *q* 'w)
=> 5
(pv *p*)
=> 44
(defmethod update-instance-for-redefined-class :after ((i p1) added discarded plist &rest args) (note (list added discarded plist)))
(defclass p1 () ((x :initarg :x :accessor px) (u :initform 1 :accessor pu)))
(defclass shape () ((count :allocation :class :initform 0 :accessor shape-count)))
(defclass circle (shape) ())
(progn (incf (shape-count (make-instance 'shape))) (incf (shape-count (make-instance 'circle))) (shape-count (make-instance 'shape)))
=> 2
(defclass ca () ((s :initform 1 :accessor cs) (t1 :initform 2)))
(defclass cb () ((s :initform 9 :accessor cs) (new :initform :new :initarg :new :reader cnew)))
(let ((i (make-instance 'ca))) (setf (cs i) 7) (change-class i 'cb) (list (cs i) (cnew i) (type-of i)))
=> (7 :NEW CB)
(let ((i (make-instance 'ca))) (change-class i 'cb :new 3) (cnew i))
=> 3
(defmethod slot-missing ((c t) (o p1) n op &optional v) (list :missing n op v))
(slot-value *p* 'foo)
=> (:MISSING FOO SLOT-VALUE NIL)
(slot-boundp *p* 'foo)
=> T
(defmethod slot-unbound ((c t) (o p1) n) (list :unbound n))
(slot-value (make-instance 'p1) 'x)
=> (:UNBOUND X)
(px (make-instance 'p1))
=> (:UNBOUND X)
(defmethod no-applicable-method ((gf (eql #'cn)) &rest args) (list :no-cn args))
(cn "a" 1)
=> (:NO-CN ("a" 1))
(with-slots (x (uu u)) *p* (setf x 9) (list x uu))
=> (9 1)
(with-accessors ((xx px)) *p* (incf xx) xx)
=> 10
(defgeneric c+ (x) (:method-combination +))
(defmethod c+ + ((x integer)) 1)
(defmethod c+ + ((x number)) 10)
(defmethod c+ + ((x t)) 100)
(defmethod c+ :around ((x float)) (list (call-next-method)))
(c+ 1)
=> 111
(c+ 1.0)
=> (110)
(c+ 'a)
=> 100
(defgeneric cl (x) (:method-combination list :most-specific-last))
(defmethod cl list ((x integer)) :int)
(defmethod cl list ((x t)) :t)
(cl 1)
=> (:T :INT)
(cl 'a)
=> (:T)
(defgeneric ca2 (x) (:method-combination and))
(defmethod ca2 and ((x integer)) (note :int) (> x 5))
(defmethod ca2 and ((x t)) (note :t) :yes)
(logged (ca2 1))
=> (NIL (:INT))
(logged (ca2 10))
=> (:YES (:INT :T))
(defgeneric co (x) (:method-combination or))
(defmethod co or ((x integer)) nil)
(defmethod co or ((x t)) :yes)
(co 1)
=> :YES
(defgeneric cap (x) (:method-combination append))
(defmethod cap append ((x integer)) '(1))
(defmethod cap append ((x t)) '(2))
(cap 1)
=> (1 2)
(define-method-combination my-max :operator max :identity-with-one-argument t)
(defgeneric mm (x) (:method-combination my-max))
(defmethod mm my-max ((x integer)) 5)
(defmethod mm my-max ((x t)) 9)
(mm 1)
=> 9
(define-method-combination hooks (&key (hook-combination 'list)) ((methods *)) `(,hook-combination ,@(mapcar #'(lambda (m) `(call-method ,m)) methods)))
(defgeneric hk (x) (:method-combination hooks))
(hk 1)
=> SB-PCL::NO-APPLICABLE-METHOD-ERROR: There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::HK (0)> when called with arguments (1). See also: The ANSI Standard, Section 7.6.6
(defmethod hk one ((x integer)) 1)
(defmethod hk two ((x t)) 2)
(hk 1)
=> (1 2)
(hk 'a)
=> (2)
(defgeneric hk2 (x) (:method-combination hooks :hook-combination append))
(defmethod hk2 one ((x integer)) '(1))
(defmethod hk2 two ((x t)) '(2))
(hk2 1)
=> (1 2)
(define-method-combination wrapping () ((around (:around)) (wrap (:wrap)) (primary () :required t)) (let ((form `(progn ,@(mapcar (lambda (m) `(call-method ,m)) wrap) (call-method ,(first primary) ,(rest primary))))) (if around `(call-method ,(first around) (,@(rest around) (make-method ,form))) form)))
(defgeneric wr (x) (:method-combination wrapping))
(defmethod wr ((x integer)) (note :prim) (list :prim (next-method-p)))
(defmethod wr :wrap ((x t)) (note :wrap))
(defmethod wr :around ((x t)) (list :around (call-next-method)))
(logged (wr 1))
=> ((:AROUND (:PRIM NIL)) (:WRAP :PRIM))
(defstruct (s3 (:conc-name s-) (:constructor new-s3 (a &key (b 2) c)) (:predicate is-s3) (:copier nil)) (a 0) b (c 9))
(new-s3 1)
=> #S(S3 :A 1 :B 2 :C 9)
(new-s3 1 :b 5 :c 6)
=> #S(S3 :A 1 :B 5 :C 6)
(is-s3 (new-s3 1))
=> T
(s-a (new-s3 4))
=> 4
(fboundp 'copy-s3)
=> NIL
(setf (s-b (new-s3 1)) 4)
=> 4
(defstruct (vec (:type vector)) x (y 5))
(make-vec :x 1)
=> #(1 5)
(vec-y (make-vec))
=> 5
(fboundp 'vec-p)
=> NIL
(defstruct (vl (:type list) :named (:initial-offset 1)) x y)
(make-vl :x 1)
=> (NIL VL 1 NIL)
(vl-p (make-vl))
=> T
(vl-p '(1 2))
=> NIL
(vl-y (make-vl :y 3))
=> 3
(defstruct (vm (:type list) (:include vl)) z)
(make-vm :z 3)
=> (NIL VL NIL NIL 3)
(vm-z (make-vm :z 4))
=> 4
(defstruct (pf (:print-function (lambda (o s d) (declare (ignore d)) (format s "<<~a>>" (pf-a o))))) a)
(make-pf :a 3)
=> <<3>>
(defstruct (pg (:print-object (lambda (o s) (format s "[[~a]]" (pg-a o))))) a)
(list (make-pg :a 3))
=> ([[3]])
(defmethod print-object ((x st) s) (format s "ST(~a)" (st-a x)))
(make-st :a 1)
=> ST(1)
(defstruct counter (n (incf *count*)))
(defvar *count* 0)
(list (counter-n (make-counter)) (counter-n (make-counter)))
=> (1 2)
(let ((c (make-counter))) (eql c (copy-counter c)))
=> NIL
(equalp (make-tm2) (make-tm2))
=> UNDEFINED-FUNCTION: The function COMMON-LISP-USER::MAKE-TM2 is undefined.
(defstruct (child (:include counter (n 100))) m)
(make-child)
=> #S(CHILD :N 100 :M NIL)
(counter-n (make-child))
=> 100
(child-n (make-child :n 3))
=> 3
(typep (make-child) 'counter)
=> T
(counter-p (make-child))
=> T
(child-p (make-counter))
=> NIL
(defstruct empty)
(make-empty)
=> #S(EMPTY)
(slot-value (make-child) 'm)
=> NIL
(with-slots (n m) (make-child :m 2) (list n m))
=> (100 2)
(define-condition nav-error (error) ((where :initarg :where :reader nav-where :initform :home) (why :initarg :why :accessor why)) (:report (lambda (c s) (format s "lost at ~a" (nav-where c)))))
(define-condition deep-error (nav-error simple-error) ((depth :initarg :depth :initform 3 :reader depth)) (:default-initargs :where :sea))
(define-condition plain (condition) () (:report "plain text"))
(format nil "~a" (make-condition 'nav-error))
=> "lost at HOME"
(format nil "~a" (make-condition 'deep-error))
=> "lost at SEA"
(depth (make-condition 'deep-error :depth 4))
=> 4
(format nil "~a" (make-condition 'plain))
=> "plain text"
(handler-case (error 'deep-error :where 1) (nav-error (c) (list :caught (nav-where c) (depth c))))
=> (:CAUGHT 1 3)
(handler-case (signal 'plain) (plain () :sig))
=> :SIG
(let ((c (make-condition 'nav-error))) (setf (why c) 3) (why c))
=> 3
(slot-value (make-condition 'nav-error :where 5) 'where)
=> 5
(simple-condition-format-control (make-condition 'deep-error :format-control "x"))
=> "x"
(typep (make-condition 'deep-error) 'simple-condition)
=> T
(defclass mixin () ())
(defclass left (mixin) ())
(defclass right (mixin) ())
(defclass bottom (left right) ())
(defmethod who ((x mixin)) (list :mixin))
(defmethod who ((x left)) (cons :left (call-next-method)))
(defmethod who ((x right)) (cons :right (call-next-method)))
(defmethod who ((x bottom)) (cons :bottom (call-next-method)))
(who (make-instance 'bottom))
=> (:BOTTOM :LEFT :RIGHT :MIXIN)
(defclass pie (apple cinnamon) ())
(defclass apple (fruit) ())
(defclass cinnamon (spice) ())
(defclass fruit (food) ())
(defclass spice (food) ())
(defclass food () ())
(defmethod chain ((x standard-object)) nil)
(defmethod chain ((x pie)) (cons :pie (call-next-method)))
(defmethod chain ((x apple)) (cons :apple (call-next-method)))
(defmethod chain ((x cinnamon)) (cons :cinnamon (call-next-method)))
(defmethod chain ((x fruit)) (cons :fruit (call-next-method)))
(defmethod chain ((x spice)) (cons :spice (call-next-method)))
(defmethod chain ((x food)) (cons :food (call-next-method)))
(chain (make-instance 'pie))
=> (:PIE :APPLE :FRUIT :CINNAMON :SPICE :FOOD)
(defclass dup () ((a :initarg :a :initarg :b :accessor dup-a)))
(dup-a (make-instance 'dup :b 1 :a 2))
=> 1
(dup-a (make-instance 'dup :a 1 :b 2))
=> 1
(defmethod (setf thing) (new (x dup)) (setf (dup-a x) (list new)))
(let ((d (make-instance 'dup))) (setf (thing d) 4) (dup-a d))
=> (4)
(defmethod opt ((x integer) &optional (y 5) &rest r) (list x y r))
(opt 1)
=> (1 5 NIL)
(opt 1 2 3 4)
=> (1 2 (3 4))
(let ((d (make-instance 'dup))) (reinitialize-instance d :a 3) (dup-a d))
=> 3
(defmethod allkeys ((x integer) &key a &allow-other-keys) a)
(allkeys 1 :zz 3 :a 2)
=> 2
(defmethod mv ((x integer)) (values 1 2))
(defmethod mv :after ((x integer)) 7)
(mv 1)
=> 1 | 2
(defmethod mv :around ((x integer)) (multiple-value-list (call-next-method)))
(mv 1)
=> (1 2)
(let ((m (find-method #'mv '(:around) '(integer)))) m)
=> #<STANDARD-METHOD COMMON-LISP-USER::MV :AROUND (INTEGER) {}>
(progn (remove-method #'mv (find-method #'mv '(:around) (list (find-class 'integer)))) (multiple-value-list (mv 1)))
=> (1 2)
(method-qualifiers (find-method #'mv '(:after) (list (find-class 'integer))))
=> (:AFTER)
(let ((f (make-instance 'dup :a 5))) (slot-makunbound f 'a) (slot-boundp f 'a))
=> NIL
(defgeneric redef (x))
(defmethod redef ((x t)) 1)
(redef 1)
=> 1
(defmethod redef ((x t)) 2)
(redef 1)
=> 2
(defmethod make-instance :around ((c (eql 'dup)) &rest args) (list :made (call-next-method)))
(first (make-instance 'dup))
=> :MADE
(progn (remove-method #'make-instance (find-method #'make-instance '(:around) '((eql dup)))) nil)
=> NIL
(defclass ini () ((a :initform (error "no a")) ))
(make-instance 'ini)
=> SIMPLE-ERROR: no a
(defclass req () ((a :initarg :a :initform (error "a is required") :type integer)))
(slot-value (make-instance 'req :a 1) 'a)
=> 1
(class-name (class-of (make-instance 'req :a 1)))
=> REQ
(mapcar #'class-name (list (find-class 't) (find-class 'list) (find-class 'standard-object)))
=> (T LIST STANDARD-OBJECT)
(setf (find-class 'alias) (find-class 'req))
=> #<STANDARD-CLASS COMMON-LISP-USER::REQ>
(type-of (make-instance 'alias :a 1))
=> REQ
"""


def test_protocols_answer_as_in_sbcl():
    check(PROTOCOLS)


ORDERS = r"""
(defun specialized (g) (mapcar (lambda (m) (let ((s (first (sb-mop:method-specializers m)))) (if (typep s 'class) (class-name s) (sb-mop:eql-specializer-object s)))) (sb-mop:generic-function-methods g)))
(defgeneric pick (x) (:method ((x integer)) 1) (:method ((x string)) 2) (:method ((x symbol)) 3))
(specialized #'pick)
=> (INTEGER STRING SYMBOL)
(defmethod pick ((x (eql 7))) 7)
(defmethod pick :around ((x integer)) (call-next-method))
(specialized #'pick)
=> (INTEGER 7 INTEGER STRING SYMBOL)
(defmethod pick ((x string)) 22)
(specialized #'pick)
=> (STRING INTEGER 7 INTEGER SYMBOL)
(let ((m (find-method #'pick nil (list (find-class 'symbol))))) (remove-method #'pick m) (add-method #'pick m))
(specialized #'pick)
=> (SYMBOL STRING INTEGER 7 INTEGER)
(mapcar #'method-qualifiers (compute-applicable-methods #'pick '(7)))
=> (NIL (:AROUND) NIL)
(defgeneric twice (x) (:method ((x integer)) 1) (:method ((x integer)) 2) (:method ((x string)) 3))
(list (twice 1) (length (sb-mop:generic-function-methods #'twice)))
=> (1 2)
(defgeneric again (x) (:method ((x integer)) 1) (:method ((x string)) 3))
(defmethod again ((x symbol)) 5)
(defgeneric again (x) (:method ((x float)) 1) (:method ((x list)) 3))
(specialized #'again)
=> (FLOAT LIST SYMBOL)
(define-method-combination gathered () ((all *)) `(list ,@(mapcar (lambda (m) `(call-method ,m)) all)))
(defgeneric gather (x) (:method-combination gathered) (:method :a ((x integer)) :a) (:method :b ((x integer)) :b))
(defmethod gather :c ((x integer)) :c)
(defmethod gather :d ((x number)) :d)
(defmethod gather :e ((x integer)) :e)
(gather 1)
=> (:E :C :A :B :D)
(defclass first-one () ((s :accessor shared)))
(defclass second-one (first-one) ((s :accessor shared)))
(defclass third-one (first-one) ())
(specialized #'shared)
=> (SECOND-ONE FIRST-ONE)
(mapcar #'class-name (sb-mop:class-direct-subclasses (find-class 'first-one)))
=> (THIRD-ONE SECOND-ONE)
"""


def test_methods_and_subclasses_stand_in_the_order_of_sbcl():
    """The newest first; CRAM's branch devel takes the grasps of an object in the order of the methods that give them."""
    check(ORDERS)
