;;;; What can go wrong.

(in-package #:courier-plans)

(define-condition courier-failure (error)
  ((attempts :initform 0 :accessor attempts :initarg :attempts))
  (:documentation "Failures that a plan may recover from."))

(defmacro define-failure (name (&rest parents) (&rest slots) control)
  "A failure whose slots have readers FAILURE-<slot>; CONTROL is a format string for the slots, in order."
  `(progn
     (define-condition ,name (,@(or parents '(courier-failure)))
       ,(loop for slot in slots
              collect `(,slot :initarg ,(intern (symbol-name slot) :keyword)
                              :initform nil
                              :reader ,(intern (format nil "FAILURE-~A" slot))))
       (:report (lambda (condition stream)
                  (with-slots ,slots condition
                    (format stream ,control ,@slots)))))
     (defun ,(intern (format nil "~A-P" name)) (thing) (typep thing ',name))))

(define-failure grasp-failed () (arm object) "The ~(~A~) arm could not grasp ~(~A~).")
(define-failure navigation-failed () (place reason) "~(~A~) was not reached~@[ (~A)~].")
(define-failure object-slipped (grasp-failed) (arm object height) "~*~:(~A~) slipped from ~,2F m.")
(define-failure robot-exhausted () (level) "The battery is at ~D %.")

(define-failure object-slipped-and-broke (object-slipped robot-exhausted) (object pieces) "~:(~A~) is in ~R piece~:P.")

(define-condition low-battery (warning)
  ((level :initarg :level :reader failure-level))
  (:report (lambda (condition stream) (format stream "Only ~D % are left." (failure-level condition)))))
