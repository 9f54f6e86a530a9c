"""A file of Lisp as people write for robots: classes, structures, generic functions, macros, loops, conditions, plans, designators."""

PART = """
(defclass part-{n} ()
  ((name :initarg :name :accessor part-name-{n} :initform "part")
   (pose :initarg :pose :reader part-pose-{n})
   (weight :initarg :weight :accessor part-weight-{n} :initform 1.0))
  (:documentation "Something that an arm can hold."))

(defstruct (reading-{n} (:conc-name reading-{n}-))
  (time 0)
  (value 0.0)
  label)

(define-condition too-heavy-{n} (cpl:simple-plan-failure)
  ((part :initarg :part :reader too-heavy-part-{n}))
  (:report (lambda (condition stream)
             (format stream "~a is too heavy." (too-heavy-part-{n} condition)))))

(defgeneric grasp-{n} (part arm)
  (:documentation "Take PART with ARM."))

(defmethod grasp-{n} ((part part-{n}) arm)
  (format t "grasping ~a with the ~(~a~) arm~%" (part-name-{n} part) arm)
  (when (> (part-weight-{n} part) 5.0)
    (cpl:fail 'too-heavy-{n} :part part))
  (list part arm))

(defmethod grasp-{n} :before ((part part-{n}) (arm (eql :left)))
  (setf (part-weight-{n} part) (* 1.5 (part-weight-{n} part))))

(defmacro with-part-{n} ((variable &key (weight 1.0)) &body body)
  `(let ((,variable (make-instance 'part-{n} :weight ,weight)))
     (unwind-protect (progn ,@body)
       (setf (part-weight-{n} ,variable) 0.0))))

(defparameter *readings-{n}* (make-hash-table :test 'equal)
  "The last reading of each sensor.")

(defun distance-{n} (x1 y1 x2 y2)
  "The distance of two points."
  (let ((dx (- x1 x2))
        (dy (- y1 y2)))
    (sqrt (+ (* dx dx) (* dy dy)))))

(defun note-{n} (label value)
  (setf (gethash label *readings-{n}*)
        (make-reading-{n} :time (get-universal-time) :value value :label label)))

(defun best-{n} (items &key (test #'<) (key #'identity))
  "The item whose KEY is least under TEST."
  (let ((best nil)
        (best-value nil))
    (dolist (item items best)
      (let ((value (funcall key item)))
        (when (or (null best) (funcall test value best-value))
          (setf best item
                best-value value))))))

(defun scan-{n} (items limit)
  (loop with count = 0
        for item in items
        for i from 0 below limit
        when (evenp i) do (incf count)
        collect (cons item i) into pairs
        finally (return (values pairs count))))

(defun try-{n} (target)
  (handler-case
      (loop repeat 3
            do (grasp-{n} target :left))
    (too-heavy-{n} (condition)
      (format nil "failed: ~a" condition))
    (error () nil)))

(defun side-{n} (angle)
  (cond ((not (numberp angle)) :unknown)
        ((< angle (- pi)) (side-{n} (+ angle (* 2 pi))))
        ((minusp angle) :right)
        (t (case (round angle)
             (0 :front)
             ((1 2) :left)
             (otherwise :behind)))))

(defun place-{n} (?x ?y)
  (desig:a location (x ?x) (y ?y) (for (desig:an object (type part-{n})))))

(defvar *load-{n}* (cpl:make-fluent :name 'load-{n} :value 0))

(cpl:def-cram-function fetch-{n} (target)
  (let ((tries 2))
    (cpl:with-failure-handling
        ((too-heavy-{n} (failure)
           (declare (ignore failure))
           (when (plusp (decf tries))
             (cpl:retry))
           (return nil)))
      (cpl:par
        (cpl:seq
          (distance-{n} 0 0 1 2)
          (scan-{n} '(1 2 3) 2))
        (cpl:pursue
          (cpl:wait-for (cpl:> *load-{n}* 3))
          (with-part-{n} (part :weight 2.0)
            (grasp-{n} part target)))))))

(defun run-{n} (target)
  (cpl:top-level
    (fetch-{n} target)))
"""


def plan_text(lines, package):
    """A text of at least so many lines, blank ones not counted, in a package of that name."""
    parts, count = [f"(defpackage :{package} (:use :common-lisp))\n(in-package :{package})"], 2
    while count < lines:
        part = PART.replace("{n}", str(len(parts)))
        parts.append(part)
        count += sum(bool(line.strip()) for line in part.splitlines())
    return "\n".join(parts)
