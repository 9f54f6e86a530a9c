;;;; counted instances
(defclass counted-class (standard-class) ((counter :initform 0 :accessor counter)))
(defmethod sb-mop:validate-superclass ((c counted-class) (s standard-class)) t)
(defmethod make-instance :after ((class counted-class) &key) (incf (counter class)))
(defclass counted-rectangle () ((w :initarg :w :accessor w)) (:metaclass counted-class))
(make-instance 'counted-rectangle :w 3) (make-instance 'counted-rectangle)
(show (counter (find-class 'counted-rectangle)) (class-name (class-of (find-class 'counted-rectangle))) (w (make-instance 'counted-rectangle :w 9)) (counter (find-class 'counted-rectangle)))
;=> 2 COUNTED-CLASS 9 3

;;;; a subclass of a counted class counts alone
(defclass counted-class (standard-class) ((counter :initform 0 :accessor counter)))
(defmethod sb-mop:validate-superclass ((c counted-class) (s standard-class)) t)
(defmethod make-instance :around ((class counted-class) &key) (incf (counter class)) (call-next-method))
(defclass a () () (:metaclass counted-class)) (defclass b (a) () (:metaclass counted-class))
(make-instance 'a) (make-instance 'b) (make-instance 'b)
(show (counter (find-class 'a)) (counter (find-class 'b)) (typep (find-class 'b) 'counted-class) (typep (find-class 'b) 'standard-class) (typep (find-class 'b) 'class))
;=> 1 2 T T T

;;;; without validate-superclass
(defclass m (standard-class) ())
(show (handler-case (progn (defclass a () () (:metaclass m)) (sb-mop:finalize-inheritance (find-class 'a)) :made) (error () :refused)))
(defclass s () ())
(show (handler-case (progn (defclass b (s) () (:metaclass m)) (sb-mop:finalize-inheritance (find-class 'b)) :made) (error () :refused)))
;=> :REFUSED
;=> :REFUSED

;;;; a standard class may not inherit from one of another metaclass
(defclass m (standard-class) ())
(defmethod sb-mop:validate-superclass ((c m) (s standard-class)) t)
(defclass a () () (:metaclass m))
(show (handler-case (progn (defclass b (a) ()) (sb-mop:finalize-inheritance (find-class 'b)) :made) (error () :refused)))
;=> :REFUSED

;;;; slot attributes
(defclass attributes-class (standard-class) ())
(defmethod sb-mop:validate-superclass ((c attributes-class) (s standard-class)) t)
(defclass attributes-direct (sb-mop:standard-direct-slot-definition) ((attributes :initform nil :initarg :attributes :reader attributes)))
(defclass attributes-effective (sb-mop:standard-effective-slot-definition) ((attributes :initform nil :accessor attributes)))
(defmethod sb-mop:direct-slot-definition-class ((c attributes-class) &rest r) (declare (ignore r)) (find-class 'attributes-direct))
(defmethod sb-mop:effective-slot-definition-class ((c attributes-class) &rest r) (declare (ignore r)) (find-class 'attributes-effective))
(defmethod sb-mop:compute-effective-slot-definition ((c attributes-class) name direct)
  (let ((e (call-next-method))) (setf (attributes e) (remove-duplicates (apply #'append (mapcar #'attributes direct)))) e))
(defclass credit () ((level :attributes (date-set time-set) :initarg :level :accessor level) (plain)) (:metaclass attributes-class))
(defclass credit2 (credit) ((level :attributes (owner)))  (:metaclass attributes-class))
(sb-mop:finalize-inheritance (find-class 'credit)) (sb-mop:finalize-inheritance (find-class 'credit2))
(show (mapcar (lambda (s) (list (sb-mop:slot-definition-name s) (attributes s))) (sb-mop:class-slots (find-class 'credit))))
(show (mapcar (lambda (s) (list (sb-mop:slot-definition-name s) (sort (copy-list (attributes s)) #'string<))) (sb-mop:class-slots (find-class 'credit2))))
(show (level (make-instance 'credit2 :level 5)) (class-name (class-of (first (sb-mop:class-slots (find-class 'credit))))) (class-name (class-of (first (sb-mop:class-direct-slots (find-class 'credit))))))
;=> ((LEVEL (DATE-SET TIME-SET)) (PLAIN NIL))
;=> ((LEVEL (DATE-SET OWNER TIME-SET)) (PLAIN NIL))
;=> 5 ATTRIBUTES-EFFECTIVE ATTRIBUTES-DIRECT

;;;; monitored access
(defclass monitored (standard-class) ())
(defmethod sb-mop:validate-superclass ((c monitored) (s standard-class)) t)
(defvar *log* nil)
(defmethod sb-mop:slot-value-using-class :before ((c monitored) o s) (push (list :read (sb-mop:slot-definition-name s)) *log*))
(defmethod (setf sb-mop:slot-value-using-class) :before (new (c monitored) o s) (push (list :write (sb-mop:slot-definition-name s) new) *log*))
(defmethod sb-mop:slot-boundp-using-class :before ((c monitored) o s) (push (list :boundp (sb-mop:slot-definition-name s)) *log*))
(defmethod sb-mop:slot-makunbound-using-class :before ((c monitored) o s) (push (list :makunbound (sb-mop:slot-definition-name s)) *log*))
(defclass thing () ((x :initarg :x :accessor x) (y :initform 7 :accessor y)) (:metaclass monitored))
(defvar *t* (make-instance 'thing :x 3))
(setf *log* nil)
(show (x *t*) (setf (x *t*) 4) (slot-value *t* 'y) (setf (slot-value *t* 'y) 8) (slot-boundp *t* 'x) (eq *t* (slot-makunbound *t* 'x)) (slot-boundp *t* 'x))
(show (reverse *log*))
(with-slots (y) *t* (incf y))
(show (first *log*) (second *log*) (with-accessors ((z y)) *t* z))
(show (handler-case (x *t*) (unbound-slot (e) (cell-error-name e))))
;=> 3 4 7 8 T T NIL
;=> ((:READ X) (:WRITE X 4) (:READ Y) (:WRITE Y 8) (:BOUNDP X) (:MAKUNBOUND X)
;=>  (:BOUNDP X))
;=> (:WRITE Y 9) (:READ Y) 9
;=> X

;;;; slots kept in a table
(defclass table-class (standard-class) ())
(defmethod sb-mop:validate-superclass ((c table-class) (s standard-class)) t)
(defvar *table* (make-hash-table :test #'equal))
(defun key (o s) (list (slot-value o 'id) (sb-mop:slot-definition-name s)))
(defmethod sb-mop:slot-value-using-class ((c table-class) o s)
  (if (eq (sb-mop:slot-definition-name s) 'id) (call-next-method) (multiple-value-bind (v p) (gethash (key o s) *table*) (if p v (slot-unbound c o (sb-mop:slot-definition-name s))))))
(defmethod (setf sb-mop:slot-value-using-class) (new (c table-class) o s)
  (if (eq (sb-mop:slot-definition-name s) 'id) (call-next-method) (setf (gethash (key o s) *table*) new)))
(defmethod sb-mop:slot-boundp-using-class ((c table-class) o s)
  (if (eq (sb-mop:slot-definition-name s) 'id) (call-next-method) (nth-value 1 (gethash (key o s) *table*))))
(defmethod sb-mop:slot-makunbound-using-class ((c table-class) o s)
  (if (eq (sb-mop:slot-definition-name s) 'id) (call-next-method) (progn (remhash (key o s) *table*) o)))
(defclass person () ((id :initarg :id) (name :initarg :name :accessor name) (age :initform 30 :accessor age)) (:metaclass table-class))
(let ((p (make-instance 'person :id 1 :name "Ada")))
  (show (name p) (age p) (hash-table-count *table*))
  (incf (age p)) (show (gethash '(1 age) *table*))
  (let ((q (make-instance 'person :id 1))) (show (name q) (age q)))
  (slot-makunbound p 'name) (show (slot-boundp p 'name) (handler-case (name p) (unbound-slot () :unbound))))
;=> "Ada" 30 2
;=> 31
;=> "Ada" 31
;=> NIL :UNBOUND

;;;; singleton
(defclass singleton (standard-class) ((instance :initform nil)))
(defmethod sb-mop:validate-superclass ((c singleton) (s standard-class)) t)
(defmethod make-instance ((c singleton) &key) (or (slot-value c 'instance) (setf (slot-value c 'instance) (call-next-method))))
(defclass config () ((v :initarg :v :reader v)) (:metaclass singleton))
(show (eq (make-instance 'config :v 1) (make-instance 'config :v 2)) (v (make-instance 'config)))
;=> T 1

;;;; abstract classes
(defclass abstract-class (standard-class) ())
(defmethod sb-mop:validate-superclass ((c abstract-class) (s standard-class)) t)
(defmethod sb-mop:validate-superclass ((c standard-class) (s abstract-class)) t)
(defmethod make-instance ((c abstract-class) &key) (error "~s is abstract" (class-name c)))
(defclass shape () () (:metaclass abstract-class)) (defclass circle (shape) ((r :initarg :r :reader r)))
(show (handler-case (make-instance 'shape) (error (e) (princ-to-string e))) (r (make-instance 'circle :r 4)) (class-name (class-of (find-class 'circle))))
;=> "SHAPE is abstract" 4 STANDARD-CLASS

;;;; initialize-instance of a class
(defclass documented (standard-class) ((notes :initarg :notes :initform nil :reader notes)))
(defmethod sb-mop:validate-superclass ((c documented) (s standard-class)) t)
(defvar *seen* nil)
(defmethod initialize-instance :after ((c documented) &key name direct-slots &allow-other-keys) (push (list name (mapcar (lambda (s) (getf s :name)) direct-slots)) *seen*))
(defclass thing () (x y) (:metaclass documented) (:notes "one" two) (:documentation "A thing."))
(show *seen* (notes (find-class 'thing)) (documentation 'thing 'type) (documentation (find-class 'thing) t))
;=> ((THING (X Y))) ("one" TWO) "A thing." "A thing."

;;;; superclasses that a metaclass adds
(defclass base () ((stamp :initform 1 :accessor stamp)))
(defclass stamped (standard-class) ())
(defmethod sb-mop:validate-superclass ((c stamped) (s standard-class)) t)
(defmethod initialize-instance :around ((c stamped) &rest r &key direct-superclasses)
  (apply #'call-next-method c :direct-superclasses (append direct-superclasses (list (find-class 'base))) r))
(defclass thing () ((x :initform 2)) (:metaclass stamped))
(show (stamp (make-instance 'thing)) (mapcar #'class-name (sb-mop:class-direct-superclasses (find-class 'thing))) (typep (make-instance 'thing) 'base))
;=> 1 (BASE) T

;;;; make-instance of standard-class
(let ((c (make-instance 'standard-class :name 'made :direct-superclasses (list (find-class 'standard-object))
   :direct-slots (list (list :name 'x :initargs '(:x) :initform '3 :initfunction (lambda () 3) :readers '(x-of) :writers '((setf x-of)))))))
  (let ((i (make-instance c)) (j (make-instance c :x 8)))
    (show (x-of i) (x-of j) (setf (x-of i) 1) (x-of i) (class-name c) (find-class 'made nil) (eq (class-of i) c))))
;=> 3 8 1 1 MADE NIL T

;;;; ensure-class
(sb-mop:ensure-class 'point :direct-superclasses '(standard-object) :direct-slots (list '(:name x :initargs (:x) :readers (px)) (list :name 'y :initfunction (lambda () 5) :initform 5 :readers '(py))))
(show (px (make-instance 'point :x 2)) (py (make-instance 'point :x 2)) (class-name (find-class 'point)))
(sb-mop:ensure-class 'point :direct-superclasses '() :direct-slots (list '(:name z :initargs (:z) :readers (pz))))
(show (pz (make-instance 'point :z 1)) (mapcar #'sb-mop:slot-definition-name (sb-mop:class-slots (find-class 'point))))
;=> 2 5 POINT
;=> 1 (Z)

;;;; compute-slots
(defclass extra (standard-class) ())
(defmethod sb-mop:validate-superclass ((c extra) (s standard-class)) t)
(defmethod sb-mop:compute-slots ((c extra)) (append (call-next-method) (list (make-instance 'sb-mop:standard-effective-slot-definition :name 'secret :initform 42 :initfunction (lambda () 42)))))
(defclass thing () ((x :initform 1)) (:metaclass extra))
(let ((i (make-instance 'thing))) (show (slot-value i 'x) (slot-value i 'secret) (slot-exists-p i 'secret) (mapcar #'sb-mop:slot-definition-name (sb-mop:class-slots (class-of i)))))
;=> 1 42 T (X SECRET)

;;;; funcallable instances
(defclass counter (sb-mop:funcallable-standard-object) ((n :initform 0 :initarg :n :accessor n)) (:metaclass sb-mop:funcallable-standard-class))
(defmethod initialize-instance :after ((c counter) &key) (sb-mop:set-funcallable-instance-function c (lambda (&optional (by 1)) (incf (n c) by))))
(let ((c (make-instance 'counter :n 5)))
  (show (funcall c) (funcall c 10) (mapcar c '(1 2)) (n c) (functionp c) (typep c 'function) (typep c 'counter) (class-name (class-of (class-of c)))))
;=> 6 16 (17 19) 19 T T T SB-MOP:FUNCALLABLE-STANDARD-CLASS

;;;; a class of generic functions
(defclass counting-gf (standard-generic-function) ((calls :initform 0 :accessor calls)) (:metaclass sb-mop:funcallable-standard-class))
(defmethod sb-mop:compute-discriminating-function ((gf counting-gf)) (let ((next (call-next-method))) (lambda (&rest args) (incf (calls gf)) (apply next args))))
(defgeneric ack (x) (:generic-function-class counting-gf))
(defmethod ack ((x integer)) (* 2 x)) (defmethod ack ((x string)) (list x))
(show (ack 4) (ack "s") (calls #'ack) (class-name (class-of #'ack)) (typep #'ack 'standard-generic-function))
;=> 8 ("s") 2 COUNTING-GF T

;;;; methods of a class of one's own
(defclass my-method (standard-method) ((count :initform 0 :accessor method-count)))
(defgeneric f (x) (:method-class my-method))
(defmethod f ((x integer)) x)
(show (f 3) (class-name (class-of (first (sb-mop:generic-function-methods #'f)))) (method-count (first (sb-mop:generic-function-methods #'f))))
;=> 3 MY-METHOD 0

;;;; a class that is defined again keeps its metaclass's slots
(defclass counted-class (standard-class) ((counter :initform 0 :accessor counter)))
(defmethod sb-mop:validate-superclass ((c counted-class) (s standard-class)) t)
(defmethod make-instance :after ((class counted-class) &key) (incf (counter class)))
(defclass thing () ((x :initform 1 :accessor x)) (:metaclass counted-class))
(defvar *i* (make-instance 'thing))
(defclass thing () ((x :initform 1 :accessor x) (y :initform 2 :accessor y)) (:metaclass counted-class))
(show (counter (find-class 'thing)) (y *i*) (x *i*) (y (make-instance 'thing)) (counter (find-class 'thing)))
;=> 1 2 1 2 2

;;;; typed slots checked on writing
(defclass checked (standard-class) ())
(defmethod sb-mop:validate-superclass ((c checked) (s standard-class)) t)
(defmethod (setf sb-mop:slot-value-using-class) :around (new (c checked) o s)
  (if (typep new (sb-mop:slot-definition-type s)) (call-next-method) (error 'type-error :datum new :expected-type (sb-mop:slot-definition-type s))))
(defclass p () ((age :type integer :initarg :age :accessor age)) (:metaclass checked))
(let ((p (make-instance 'p :age 3)))
  (show (handler-case (setf (age p) "x") (type-error (e) (type-error-expected-type e))) (age p) (handler-case (make-instance 'p :age 'a) (type-error () :refused))))
;=> INTEGER 3 :REFUSED

;;;; virtual slots
(defclass virtual-class (standard-class) ())
(defclass virtual-direct (sb-mop:standard-direct-slot-definition) ((f :initarg :function :initform nil :reader slot-f)))
(defclass virtual-effective (sb-mop:standard-effective-slot-definition) ((f :initform nil :accessor slot-f)))
(defmethod sb-mop:validate-superclass ((c virtual-class) (s standard-class)) t)
(defmethod sb-mop:direct-slot-definition-class ((c virtual-class) &key function &allow-other-keys) (if function (find-class 'virtual-direct) (call-next-method)))
(defvar *eff* nil)
(defmethod sb-mop:effective-slot-definition-class ((c virtual-class) &key) (or *eff* (call-next-method)))
(defmethod sb-mop:compute-effective-slot-definition ((c virtual-class) name ds)
  (let ((v (find-if (lambda (d) (typep d 'virtual-direct)) ds)))
    (if v (let ((*eff* (find-class 'virtual-effective))) (let ((e (call-next-method))) (setf (slot-f e) (slot-f v)) e)) (call-next-method))))
(defmethod sb-mop:slot-value-using-class ((c virtual-class) o (s virtual-effective)) (funcall (coerce (slot-f s) 'function) o))
(defmethod sb-mop:slot-boundp-using-class ((c virtual-class) o (s virtual-effective)) t)
(defclass rect () ((w :initarg :w :accessor w) (h :initarg :h :accessor h) (area :function (lambda (r) (* (w r) (h r))) :reader area)) (:metaclass virtual-class))
(let ((r (make-instance 'rect :w 3 :h 4))) (show (area r) (progn (setf (w r) 10) (slot-value r 'area)) (slot-boundp r 'area) (slot-boundp r 'w)))
;=> 12 40 T T

;;;; lazy slots
(defclass lazy (standard-class) ())
(defmethod sb-mop:validate-superclass ((c lazy) (s standard-class)) t)
(defvar *n* 0)
(defmethod slot-unbound ((c lazy) o name) (incf *n*) (setf (slot-value o name) (list name *n*)))
(defclass thing () ((a :reader a) (b :reader b)) (:metaclass lazy))
(let ((i (make-instance 'thing))) (show (a i) (a i) (b i) (slot-value i 'a) *n*))
;=> (A 1) (A 1) (B 2) (A 1) 2

;;;; registry of classes
(defclass registered (standard-class) ((key :initarg :key :initform nil :reader key)))
(defmethod sb-mop:validate-superclass ((c registered) (s standard-class)) t)
(defvar *registry* nil)
(defmethod shared-initialize :after ((c registered) slots &key) (declare (ignore slots)) (pushnew c *registry*))
(defclass r1 () () (:metaclass registered) (:key :one)) (defclass r2 (r1) () (:metaclass registered) (:key :two))
(show (sort (mapcar #'class-name *registry*) #'string<) (key (find-class 'r2)) (key (find-class 'r1)))
(defclass r1 () (x) (:metaclass registered) (:key :three))
(show (length *registry*) (key (find-class 'r1)))
;=> (R1 R2) (:TWO) (:ONE)
;=> 2 (:THREE)

;;;; a metaclass of a metaclass's subclass
(defclass m1 (standard-class) ((a :initform 1 :accessor m-a))) (defclass m2 (m1) ((b :initform 2 :accessor m-b)))
(defmethod sb-mop:validate-superclass ((c m1) (s standard-class)) t)
(defclass x () () (:metaclass m1)) (defclass y (x) () (:metaclass m2))
(show (m-a (find-class 'y)) (m-b (find-class 'y)) (slot-exists-p (find-class 'x) 'b) (setf (m-a (find-class 'y)) 5) (m-a (find-class 'x)) (subtypep 'm2 'standard-class))
;=> 1 2 NIL 5 1 T

;;;; slot-value-using-class by slot class
(defclass hist-class (standard-class) ())
(defmethod sb-mop:validate-superclass ((c hist-class) (s standard-class)) t)
(defclass hist-d (sb-mop:standard-direct-slot-definition) ((h :initarg :history :initform nil :reader hist)))
(defclass hist-e (sb-mop:standard-effective-slot-definition) ((h :initform nil :accessor hist)))
(defmethod sb-mop:direct-slot-definition-class ((c hist-class) &rest i) (if (getf i :history) (find-class 'hist-d) (call-next-method)))
(defmethod sb-mop:effective-slot-definition-class ((c hist-class) &rest i) (declare (ignore i)) (find-class 'hist-e))
(defmethod sb-mop:compute-effective-slot-definition ((c hist-class) n ds) (let ((e (call-next-method))) (when (some (lambda (d) (typep d 'hist-d)) ds) (setf (hist e) t)) e))
(defvar *old* nil)
(defmethod (setf sb-mop:slot-value-using-class) :before (new (c hist-class) o (s hist-e))
  (when (and (hist s) (sb-mop:slot-boundp-using-class c o s)) (push (sb-mop:slot-value-using-class c o s) *old*)))
(defclass v () ((p :history t :initarg :p :accessor p) (q :initarg :q :accessor q)) (:metaclass hist-class))
(let ((i (make-instance 'v :p 1 :q 2))) (setf (p i) 10 (q i) 20 (p i) 100) (show *old* (p i) (q i)))
;=> (10 1) 100 20

;;;; standard-instance-access
(defclass thing () ((a :initform 1) (b :initform 2)))
(sb-mop:finalize-inheritance (find-class 'thing))
(let ((i (make-instance 'thing)) (s (find 'b (sb-mop:class-slots (find-class 'thing)) :key #'sb-mop:slot-definition-name)))
  (show (sb-mop:standard-instance-access i (sb-mop:slot-definition-location s)) (setf (sb-mop:standard-instance-access i (sb-mop:slot-definition-location s)) 9) (slot-value i 'b)))
;=> 2 9 9

;;;; reinitialize-instance of a class
(defclass noted (standard-class) ((note :initarg :note :initform :none :accessor note)))
(defmethod sb-mop:validate-superclass ((c noted) (s standard-class)) t)
(defclass thing () ((x :initform 3)) (:metaclass noted))
(reinitialize-instance (find-class 'thing) :note :again)
(show (note (find-class 'thing)) (slot-value (make-instance 'thing) 'x))
;=> :AGAIN 3

;;;; default initargs and class options
(defclass d (standard-class) ((table-name :initarg :table-name :reader table-name)))
(defmethod sb-mop:validate-superclass ((c d) (s standard-class)) t)
(defclass row () ((id :initarg :id :reader id)) (:metaclass d) (:table-name "rows" "more") (:default-initargs :id 77))
(show (table-name (find-class 'row)) (id (make-instance 'row)) (id (make-instance 'row :id 1)) (mapcar #'first (sb-mop:class-default-initargs (find-class 'row))))
;=> ("rows" "more") 77 1 (:ID)

;;;; an unknown class option is refused
(defclass d (standard-class) ())
(defmethod sb-mop:validate-superclass ((c d) (s standard-class)) t)
(show (handler-case (progn (eval '(defclass a () () (:metaclass d) (:colour 1))) :made) (error () :refused)))
(show (handler-case (progn (eval '(defclass a () ((x :colour 1)) (:metaclass d))) :made) (error () :refused)))
(show (handler-case (progn (eval '(defclass a () () (:colour 1))) :made) (error () :refused)))
;=> :REFUSED
;=> :REFUSED
;=> :REFUSED

;;;; compute-class-precedence-list
(defclass flat (standard-class) ())
(defmethod sb-mop:validate-superclass ((c flat) (s standard-class)) t)
(defclass a () ()) (defclass b () ())
(defmethod who ((x a)) :a) (defmethod who ((x b)) :b)
(defmethod sb-mop:compute-class-precedence-list ((c flat))
  (let ((l (call-next-method))) (if (and (find (find-class 'a) l) (find (find-class 'b) l)) (list* (first l) (find-class 'b) (find-class 'a) (remove (find-class 'a) (remove (find-class 'b) (rest l)))) l)))
(defclass c (a b) () (:metaclass flat)) (defclass c2 (a b) ())
(show (who (make-instance 'c)) (who (make-instance 'c2)) (mapcar #'class-name (subseq (sb-mop:class-precedence-list (find-class 'c)) 0 3)))
;=> :B :A (C B A)

;;;; compute-default-initargs
(defclass def (standard-class) ())
(defmethod sb-mop:validate-superclass ((c def) (s standard-class)) t)
(defmethod sb-mop:compute-default-initargs ((c def)) (cons (list :x 5 (lambda () 5)) (call-next-method)))
(defclass thing () ((x :initarg :x :reader x)) (:metaclass def))
(show (x (make-instance 'thing)) (x (make-instance 'thing :x 1)))
;=> 5 1

;;;; a funcallable class with a table
(defclass memo (sb-mop:funcallable-standard-object) ((table :initform (make-hash-table) :reader table) (f :initarg :f)) (:metaclass sb-mop:funcallable-standard-class))
(defmethod initialize-instance :after ((m memo) &key) (with-slots (table f) m
  (sb-mop:set-funcallable-instance-function m (lambda (x) (or (gethash x table) (setf (gethash x table) (funcall f x)))))))
(let* ((calls 0) (m (make-instance 'memo :f (lambda (x) (incf calls) (* x x)))))
  (setf (symbol-function 'squared) m)
  (show (squared 4) (funcall 'squared 4) (apply m '(5)) calls (hash-table-count (table m)) (reduce #'+ (mapcar #'squared '(1 2 3)))))
;=> 16 16 25 2 2 14

;;;; ensure-class-using-class
(defclass logged (standard-class) ())
(defmethod sb-mop:validate-superclass ((c logged) (s standard-class)) t)
(defvar *l* nil)
(defmethod sb-mop:ensure-class-using-class :before ((c logged) name &key &allow-other-keys) (push name *l*))
(defclass thing () () (:metaclass logged)) (show *l*) (defclass thing () (x) (:metaclass logged)) (show *l*)
;=> NIL
;=> (THING)

;;;; dependents
(defclass watcher () ((seen :initform nil :accessor seen)))
(defvar *w* (make-instance 'watcher))
(defmethod sb-mop:update-dependent ((c class) (w watcher) &rest args) (push (first args) (seen w)))
(defclass thing () ())
(sb-mop:add-dependent (find-class 'thing) *w*)
(defclass thing () (x))
(show (not (null (seen *w*))) (let (l) (sb-mop:map-dependents (find-class 'thing) (lambda (d) (push d l))) (length l)))
(sb-mop:remove-dependent (find-class 'thing) *w*) (setf (seen *w*) nil) (defclass thing () (x y)) (show (seen *w*))
;=> T 1
;=> NIL

;;;; reader and writer methods
(defclass thing () ((x :accessor x)))
(let ((m (first (sb-mop:generic-function-methods #'x))))
  (show (typep m 'sb-mop:standard-reader-method) (sb-mop:slot-definition-name (sb-mop:accessor-method-slot-definition m)) (typep (first (sb-mop:generic-function-methods #'(setf x))) 'sb-mop:standard-writer-method)))
;=> T X T

;;;; subclasses and direct methods
(defclass a () ()) (defclass b (a) ()) (defclass c (a) ())
(defgeneric f (x)) (defmethod f ((x a)) 1)
(show (sort (mapcar #'class-name (sb-mop:class-direct-subclasses (find-class 'a))) #'string<) (length (sb-mop:specializer-direct-methods (find-class 'a))) (mapcar #'sb-mop:generic-function-name (sb-mop:specializer-direct-generic-functions (find-class 'a))))
;=> (B C) 1 (F)

;;;; make-method-lambda and generic functions made by hand
(let ((gf (make-instance 'standard-generic-function :name 'by-hand :lambda-list '(x))))
  (add-method gf (make-instance 'standard-method :qualifiers nil :lambda-list '(x) :specializers (list (find-class 'integer)) :function (lambda (args next) (declare (ignore next)) (* 3 (first args)))))
  (show (funcall gf 5) (sb-mop:generic-function-name gf) (length (sb-mop:generic-function-methods gf)) (handler-case (funcall gf 'a) (error () :none))))
;=> 15 BY-HAND 1 :NONE

;;;; change-class between metaclasses
(defclass m (standard-class) ())
(defmethod sb-mop:validate-superclass ((c m) (s standard-class)) t)
(defclass a () ((x :initarg :x :accessor x)) (:metaclass m)) (defclass b () ((x :accessor x) (y :initform 2 :accessor y)) (:metaclass m))
(let ((i (make-instance 'a :x 5))) (change-class i 'b) (show (x i) (y i) (class-name (class-of i))))
;=> 5 2 B

;;;; which initargs a defclass form gives its metaclass
(defclass told-class (standard-class) ((extra :initarg :extra :initform nil)))
(defmethod sb-mop:validate-superclass ((a told-class) (b standard-class)) t)
(defvar *told* nil)
(defun told (keys) (push (loop for k in keys by #'cddr when (member k '(:name :direct-superclasses :direct-slots :documentation :direct-default-initargs :extra)) collect k) *told*))
(defmethod initialize-instance :around ((c told-class) &rest keys) (told keys) (call-next-method))
(defmethod reinitialize-instance :around ((c told-class) &rest keys) (told keys) (call-next-method))
(defclass a1 () () (:metaclass told-class))
(show (shiftf *told* nil))
(defclass a2 (a1) ((x :initarg :x)) (:metaclass told-class) (:documentation "d") (:default-initargs :x 1) (:extra 1 2))
(show (shiftf *told* nil))
(defvar *a2* (make-instance 'a2))
(defclass a2 () () (:metaclass told-class))
(show (shiftf *told* nil))
(show (slot-exists-p *a2* 'x) (sb-mop:class-direct-default-initargs (find-class 'a2)) (documentation 'a2 'type) (mapcar #'class-name (sb-mop:class-direct-superclasses (find-class 'a2))))
;=> ((:NAME :DIRECT-SUPERCLASSES :DIRECT-SLOTS :DIRECT-DEFAULT-INITARGS))
;=> ((:NAME :DIRECT-SUPERCLASSES :DIRECT-SLOTS :DOCUMENTATION :DIRECT-DEFAULT-INITARGS :EXTRA))
;=> ((:DIRECT-SUPERCLASSES :DIRECT-SLOTS :DIRECT-DEFAULT-INITARGS))
;=> NIL NIL "d" (STANDARD-OBJECT)
