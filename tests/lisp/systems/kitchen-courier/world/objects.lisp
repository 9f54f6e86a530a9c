;;;; The things in a kitchen: classes mixed from properties.

(in-package #:courier-world)

(defclass thing ()
  ((name :initarg :name :reader name :type symbol :initform (error "A thing needs a name."))
   (position :initarg :position :accessor position :initform (make-point 0 0))
   (weight :initarg :weight :accessor weight :initform 1/4 :documentation "in kilograms")
   (count :allocation :class :initform 0 :reader thing-count))
  (:documentation "Anything that the robot knows."))

(defclass movable ()
  ((grasps :initarg :grasps :accessor grasps :initform '(:top :side)))
  (:documentation "What a gripper can hold."))

(defclass fragile () ((limit :initarg :limit :initform 5 :reader breaking-force)))

(defclass openable () ((open :initform nil :accessor open-p)))

(defclass container ()
  ((contents :initform '() :accessor contents)
   (capacity :initarg :capacity :reader capacity :initform 4)))

(defclass perishable () ((shelf-life :initarg :shelf-life :accessor shelf-life :initform 7)))

(defclass surface (container thing) () (:default-initargs :capacity 6 :weight 20))
(defclass appliance (openable container thing) () (:default-initargs :weight 60))
(defclass crockery (movable fragile thing) ((clean :initarg :clean :initform t :accessor clean-p)))
(defclass food (movable thing) ())

(defclass cup (crockery container) () (:default-initargs :capacity 1 :grasps (list :side :top)))
(defclass plate (crockery) () (:default-initargs :weight 1/2 :grasps (list :top)))
(defclass bowl (cup) () (:default-initargs :weight 2/5))
(defclass milk (perishable food) () (:default-initargs :weight 1 :shelf-life 5))
(defclass cereal (food) () (:default-initargs :grasps (list :side)))
(defclass fridge (appliance) ())
(defclass dishwasher (appliance) () (:default-initargs :capacity 3))
(defclass cupboard (appliance) ())
(defclass table-top (surface) ())

;;; Initialization, printing.

(defmethod initialize-instance :after ((thing thing) &key x y)
  (incf (slot-value thing 'count))
  (when (and x y)
    (setf (position thing) (make-point x y))))

(defmethod initialize-instance :around ((thing milk) &rest initargs &key weight &allow-other-keys)
  (if (and weight (> weight 2))
      (apply #'call-next-method thing :weight 2 initargs)
      (call-next-method)))

(defmethod print-object ((thing thing) stream)
  (print-unreadable-object (thing stream :type t)
    (princ (name thing) stream)))

(defmethod (setf weight) :before (new (thing thing))
  (assert (plusp new) (new) "~A cannot weigh ~A." (name thing) new))

;;; Every method combination has its use.

(defgeneric hazards (thing)
  (:method-combination append)
  (:method append ((thing thing)) (when (> (weight thing) 10) '(heavy)))
  (:method append ((thing fragile)) '(breaks))
  (:method append ((thing perishable)) (list (list 'spoils-in (shelf-life thing) 'days)))
  (:method append ((thing openable)) (unless (open-p thing) '(closed)))
  (:method append ((thing container)) (and (contents thing) '(spills))))

(defgeneric total-weight (thing)
  (:method-combination +)
  (:method + ((thing thing)) (weight thing))
  (:method + ((thing container)) (reduce #'+ (contents thing) :key #'total-weight)))

(define-method-combination longest (&optional (test '>)) ((methods () :required t))
  "The longest of the strings that the methods give."
  `(reduce (lambda (a b) (if (,test (length b) (length a)) b a)) (list ,@(mapcar (lambda (method) `(call-method ,method)) methods))))

(defgeneric title (thing)
  (:method-combination longest)
  (:method ((thing thing)) (string-downcase (name thing)))
  (:method ((thing food)) "something to eat")
  (:method ((thing perishable)) "eat soon"))

(define-method-combination sentence :operator list :identity-with-one-argument nil)

(defgeneric describe-briefly (thing)
  (:method-combination sentence :most-specific-last)
  (:method sentence ((thing thing)) (format nil "~(~A~)" (class-name (class-of thing))))
  (:method sentence ((thing movable)) (format nil "held at the ~{~(~A~)~^ or ~}" (grasps thing)))
  (:method sentence ((thing container)) (format nil "holds ~[nothing~;one thing~:;~:*~R things~]" (length (contents thing))))
  (:method sentence ((thing crockery)) (if (clean-p thing) "clean" "dirty"))
  (:method :around ((thing thing)) (format nil "~A: ~{~A~^, ~}." (title thing) (call-next-method))))

(defgeneric volume (thing &key unit)
  (:method ((thing thing) &key (unit :litre) (detail nil detail-p))
    (list unit (weight thing) detail detail-p))
  (:method :around ((thing container) &rest options &key unit)
    (declare (ignore options))
    (if (eq unit :cells) (capacity thing) (call-next-method))))
