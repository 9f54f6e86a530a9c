(in-package :bk)

(defvar *things* (make-hash-table :test #'eql) "Things by their names.")

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defvar *thing-types* '() "The kinds of things, with their parents.")
  (defun slot-definition-of (specification)
    (destructuring-bind (name &optional (initform nil) &rest options &key (type t) &allow-other-keys)
        (alexandria:ensure-list specification)
      (list* name :initarg (intern (string name) :keyword) :initform initform :type type
             (alexandria:remove-from-plist options :type)))))

(defmacro def-thing-type (name parents slots &rest options)
  "A class of things that Prolog knows."
  `(progn
     (eval-when (:compile-toplevel :load-toplevel :execute)
       (setf *thing-types* (acons ',name ',(or parents '(thing)) (remove ',name *thing-types* :key #'car))))
     (defclass ,name ,(or parents '(thing))
       ,(mapcar #'slot-definition-of slots)
       ,@options)
     ',name))

(defun thing-types ()
  (mapcar #'car (reverse *thing-types*)))

(defclass thing ()
  ((name :initarg :name :reader thing-name :initform (error "A thing needs a name."))
   (pose :initarg :pose :accessor thing-pose :initform nil)
   (count :allocation :class :initform 0 :accessor thing-count)))

(def-thing-type cup ()
  ((volume 0.2 :type real :reader cup-volume)
   (content 0 :accessor cup-content)
   (temperature 20 :accessor cup-temperature))
  (:documentation "Something to drink from."))

(def-thing-type mug (cup)
  ((volume 0.3)
   handle)
  (:default-initargs :handle :right))

(def-thing-type glass (cup) ())

(def-thing-type tray ()
  ((load nil :accessor tray-load)
   (places 4 :type (integer 1 *) :reader tray-places)))

(defgeneric thing-kind (thing)
  (:method ((thing thing)) (class-name (class-of thing))))

(defmethod initialize-instance :after ((thing thing) &rest initargs)
  (declare (ignore initargs))
  (incf (thing-count thing)))

(defmethod print-object ((thing thing) stream)
  (print-unreadable-object (thing stream :type t :identity nil)
    (princ (thing-name thing) stream)))

(defun add-thing (kind name &rest initargs)
  (when (gethash name *things*)
    (cerror "Replace it." "There is a thing called ~a already: ~a." name (gethash name *things*)))
  (setf (gethash name *things*) (apply #'make-instance kind :name name initargs)))

(defun find-thing (name &optional (error-p t))
  (or (gethash name *things*)
      (when error-p
        (restart-case (error 'bc:cup-not-found :name name)
          (use-value (thing) :report "Take another thing." thing)))))

(defun forget-things () (clrhash *things*) (setf (slot-value (allocate-instance (find-class 'thing)) 'count) 0))

(define-method-combination least :operator min :identity-with-one-argument t)

(defgeneric carry-limit (thing)
  (:method-combination least)
  (:documentation "Kilograms that may be carried with THING.")
  (:method least ((thing thing)) 5)
  (:method least ((thing cup)) 1/2)
  (:method least ((thing glass)) 0.4))

(define-method-combination guarded ()
  ((guards (:guard . *))
   (around (:around))
   (primary () :required t))
  "Every guard must say yes, the most general first."
  (let ((form `(if (and ,@(mapcar (lambda (method) `(call-method ,method)) (reverse guards)))
                   (call-method ,(first primary) ,(rest primary))
                   :refused)))
    (if around
        `(call-method ,(first around) (,@(rest around) (make-method ,form)))
        form)))

(defgeneric pour (drink cup amount)
  (:method-combination guarded)
  (:method :guard (drink cup amount) (plusp amount))
  (:method :guard (drink (cup glass) amount) (declare (ignore amount)) (not (eql drink :espresso)))
  (:method (drink (cup cup) amount)
    (let ((free (- (cup-volume cup) (cup-content cup))))
      (when (> amount (+ free 1e-6))
        (restart-case (error 'bc:pour-failed :amount amount :description (format nil "~a does not fit" amount))
          (pour-less () :report "Fill it up." (setf amount free))))
      (incf (cup-content cup) amount)))
  (:method ((drink (eql :ice)) (cup cup) amount)
    (decf (cup-temperature cup) 5)
    (call-next-method))
  (:method :around (drink (cup mug) amount)
    (list drink (call-next-method))))

(defgeneric weigh (thing)
  (:method ((thing thing)) 1)
  (:method ((thing cup)) (+ 1/4 (cup-content thing)))
  (:method ((thing tray)) (reduce #'+ (tray-load thing) :key #'weigh :initial-value (call-next-method))))

(defmethod (setf thing-pose) :before (pose (thing thing))
  (check-type pose (or null cl-transforms:pose)))

(defmethod (setf thing-pose) :after (pose (thing tray))
  (dolist (each (tray-load thing))
    (setf (thing-pose each) pose)))

(defmethod update-instance-for-different-class :after ((old glass) (new mug) &key (handle :glued))
  (setf (slot-value new 'handle) handle))
