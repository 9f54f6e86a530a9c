(in-package :cram-tray-delivery)

(defclass delivery-log ()
  ((lock :reader log-lock :initform (sb-thread:make-mutex :name "delivery log"))
   (changed :reader log-changed :initform (sb-thread:make-waitqueue :name "deliveries"))
   (entries :accessor log-entries :initform '())
   (readers :accessor log-readers :initform 0))
  (:documentation "What was delivered, written by several threads."))

(defun make-delivery-log ()
  (make-instance 'delivery-log))

(defmacro with-log-locked ((log) &body body)
  `(sb-thread:with-recursive-lock ((log-lock ,log))
     ,@body))

(defun note-delivery (log tray)
  "Adds TRAY to LOG and wakes those who wait for it."
  (with-log-locked (log)
    (with-log-locked (log)
      (push tray (log-entries log)))
    (sb-thread:condition-broadcast (log-changed log))
    tray))

(defun deliveries (log)
  (sb-thread:with-mutex ((log-lock log))
    (reverse (log-entries log))))

(defun delivery-count (log)
  (length (deliveries log)))

(defun wait-for-deliveries (log number &key timeout)
  "Waits until NUMBER trays stand in LOG. T, or NIL after TIMEOUT seconds."
  (sb-thread:with-mutex ((log-lock log))
    (loop until (>= (length (log-entries log)) number)
          do (unless (sb-thread:condition-wait (log-changed log) (log-lock log) :timeout timeout)
               (return-from wait-for-deliveries nil)))
    t))
