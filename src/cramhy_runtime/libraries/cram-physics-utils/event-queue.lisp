;;;; A queue of events between threads: the first one that was posted comes first.

(in-package #:cram-physics-utils)

(defclass event-queue ()
  ((events :initform '() :accessor events)
   (lock :initform (sb-thread:make-mutex :name "events") :reader lock-of)
   (changed :initform (sb-thread:make-waitqueue) :reader changed-of))
  (:documentation "Events that were posted and that nobody has taken."))

(defgeneric post-event (queue event)
  (:documentation "Put EVENT, a list of a name and what belongs to it, behind the others.")
  (:method ((queue event-queue) event)
    (sb-thread:with-mutex ((lock-of queue))
      (setf (events queue) (append (events queue) (list event)))
      (sb-thread:condition-broadcast (changed-of queue)))))

(defun wait-until (queue condition timeout then)
  "What THEN returns when CONDITION holds, with the lock; nil if that takes longer than TIMEOUT seconds."
  (let ((end (and timeout (+ (roslisp:ros-time) timeout))))
    (sb-thread:with-mutex ((lock-of queue))
      (loop
        (when (funcall condition) (return (funcall then)))
        (let ((left (and end (- end (roslisp:ros-time)))))
          (when (and left (<= left 0)) (return nil))
          (sb-thread:condition-wait (changed-of queue) (lock-of queue) :timeout left))))))

(defgeneric get-next-event (queue &optional timeout)
  (:documentation "Wait for the next event and take it. Nil after TIMEOUT seconds, if it is given.")
  (:method ((queue event-queue) &optional timeout)
    (wait-until queue (lambda () (events queue)) timeout
                (lambda ()
                  (sb-thread:condition-broadcast (changed-of queue))
                  (pop (events queue))))))

(defgeneric wait-for-queue-empty (queue &optional timeout)
  (:documentation "Wait until all events are taken, at most TIMEOUT seconds, if it is given.")
  (:method ((queue event-queue) &optional timeout)
    (wait-until queue (lambda () (null (events queue))) timeout (constantly nil))))
