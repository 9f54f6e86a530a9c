;;;; The robot: arms, battery, and how it performs steps.

(in-package #:courier-plans)

(defclass arm ()
  ((side :initarg :side :reader side :type (member :left :right))
   (load :initform nil :accessor arm-load)))

(defclass robot (thing)
  ((arms :reader arms)
   (battery :initarg :battery :initform 100 :accessor battery)
   (faults :initarg :faults :initform '() :accessor faults)
   (place :initform 'table :accessor robot-place)
   (mileage :initform 0 :accessor mileage))
  (:default-initargs :name 'carrier))

(defmethod shared-initialize :after ((robot robot) slots &key (sides '(:left :right)))
  (declare (ignore slots))
  (unless (slot-boundp robot 'arms)
    (setf (slot-value robot 'arms) (mapcar (lambda (side) (make-instance 'arm :side side)) sides))))

(defmethod print-object ((arm arm) stream)
  (with-slots (side load) arm
    (print-unreadable-object (arm stream)
      (format stream "~(~A~) ARM~@[ with ~A~]" side (and load (name load))))))

(defvar *robot*)

(defun make-robot (&rest initargs) (apply #'make-instance 'robot initargs))

(defmacro with-faults ((&rest faults) &body body)
  "FAULTS: (kind . times at which it happens), counted from one per kind."
  `(let ((old (faults *robot*)))
     (setf (faults *robot*) (list ,@(loop for (kind . times) in faults collect `(list* ',kind 0 ',times))))
     (unwind-protect (progn ,@body)
       (setf (faults *robot*) old))))

(defun fault-p (kind)
  "Whether this is one of the times at which KIND happens."
  (when-let (entry (assoc kind (faults *robot*)))
    (member (incf (second entry)) (cddr entry))))

(defgeneric drain (what amount)
  (:documentation "Use energy.")
  (:method ((what (eql :drive)) (amount real)) (drain *robot* (ceiling amount 2)))
  (:method ((what (eql :lift)) (amount thing)) (drain *robot* (ceiling (* 4 (total-weight amount)))))
  (:method ((what (eql :lift)) (amount null)) 0)
  (:method ((what robot) (amount integer))
    (let ((level (decf (battery what) amount)))
      (cond ((< level 5) (error 'robot-exhausted :level level))
            ((< level 20) (warn 'low-battery :level level)))
      level)))

(defun free-arm ()
  (or (find nil (arms *robot*) :key #'arm-load)
      (error 'grasp-failed :arm :any :object (mapcar (compose #'name #'arm-load) (arms *robot*)))))

(defun arm-holding (name)
  (find-if (lambda (arm) (and (arm-load arm) (eq name (name (arm-load arm))))) (arms *robot*)))

(defgeneric perform (action &rest arguments)
  (:documentation "Do one step of a plan.")
  (:argument-precedence-order action))

(defmethod perform :around (action &rest arguments)
  (logging-event ((cons action arguments))
    (advance-clock)
    (call-next-method)))

(defmethod perform ((action (eql 'go-to)) &rest arguments)
  (destructuring-bind (place &key (speed 1)) arguments
    (let ((way (distance (position (object-named (robot-place *robot*))) (position (object-named place)))))
      (when (fault-p :navigation)
        (error 'navigation-failed :place place :reason "somebody stood there"))
      (advance-clock (round way speed))
      (incf (mileage *robot*) way)
      (drain :drive way)
      (setf (robot-place *robot*) place))))

(defmethod perform ((action (eql 'open-it)) &rest arguments)
  (setf (open-p (object-named (first arguments))) t))

(defmethod perform ((action (eql 'close-it)) &rest arguments)
  (setf (open-p (object-named (first arguments))) nil))

(defmethod perform ((action (eql 'pick-up)) &rest arguments)
  (destructuring-bind (thing place &aux (object (object-named thing)) (arm (free-arm))) arguments
    (unless (eq place (location-of thing))
      (error 'navigation-failed :place place :reason (format nil "~(~A~) is not there" thing)))
    (restart-case
        (cond ((fault-p :slip) (error 'object-slipped :arm (side arm) :object thing :height 0.75))
              ((fault-p :grasp) (error 'grasp-failed :arm (side arm) :object thing)))
      (use-other-arm (&optional (other (find arm (arms *robot*) :test-not #'eq)))
        :report "Take the other arm."
        (log-event :retry 'pick-up (side other))
        (setf arm other)))
    (drain :lift object)
    (take-out object)
    (setf (arm-load arm) object)))

(defmethod perform ((action (eql 'put-down)) &rest arguments)
  (destructuring-bind (thing place) arguments
    (let ((arm (or (arm-holding thing) (error "~A is in no hand." thing))))
      (put-into (shiftf (arm-load arm) nil) place))))

(defmethod no-applicable-perform (action) (format nil "~A?" action))

(defmethod perform ((action symbol) &rest arguments)
  (declare (ignore arguments))
  (error "The robot cannot ~(~A~)." action))
