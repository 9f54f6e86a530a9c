;;;; The event log: what happened, when, and inside of what.

(in-package #:courier-plans)

(define-enumeration event-kind
  (:start "begins") (:end "ends") (:failure "fails") (:retry "tries again") (:note "notes"))

(defvar *event-depth* 0)

(defstruct (event (:conc-name event-) (:constructor make-event (kind what &rest data &aux (time (world-clock *world*))))
                  (:type vector) :named)
  (kind :note :type event-kind) what time data (depth *event-depth*))

(defclass event-log ()
  ((events :initform (make-array 4 :adjustable t :fill-pointer 0) :reader events)
   (listeners :initform '() :accessor listeners)
   (opened :initform 0 :accessor opened)))

(defvar *event-log* nil)

(defmacro with-event-log ((&key listener) &body body)
  "The values of BODY, and the log."
  `(let ((*event-log* (make-instance 'event-log)) (*event-depth* 0))
     ,@(when listener `((push ,listener (listeners *event-log*))))
     (multiple-value-prog1 (values (progn ,@body) *event-log*)
       (assert (zerop (opened *event-log*)) () "~D event~:P never ended." (opened *event-log*)))))

(defun log-event (kind what &rest data)
  (when *event-log*
    (let ((event (apply #'make-event kind what data)))
      (vector-push-extend event (events *event-log*))
      (dolist (listener (listeners *event-log*) event)
        (funcall listener event)))))

(defmacro logging-event ((what &rest data) &body body)
  "BODY between a start and an end; the end is logged however BODY is left."
  (with-gensyms (thing how)
    `(let ((,thing ,what) (,how :unwound))
       (log-event :start ,thing ,@data)
       (when *event-log* (incf (opened *event-log*)))
       (unwind-protect
            (let ((*event-depth* (1+ *event-depth*)))
              (multiple-value-prog1 (progn ,@body)
                (setf ,how :done)))
         (when *event-log* (decf (opened *event-log*)))
         (log-event :end ,thing ,how)))))

(defun count-events (kind &optional (log *event-log*))
  (count kind (events log) :key #'event-kind))

(defmethod print-object ((log event-log) stream)
  (print-unreadable-object (log stream :type t)
    (format stream "~D event~:P" (length (events log)))))

(defun event-line (event)
  (format nil "~3D ~V@T~(~A~) ~A~@[ ~{~(~A~)~^ ~}~]"
          (event-time event) (* 2 (event-depth event)) (princ-to-string (event-what event))
          (event-kind-label (event-kind event)) (event-data event)))
