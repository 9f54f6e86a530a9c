(in-package :barista-threads)

(defvar *counter* 0)
(defvar *counter-lock* (make-mutex :name "counter lock"))
(sb-ext:defglobal **noted** (trivial-garbage:make-weak-hash-table :test 'eq :weakness :key))
(defvar *lock* (bordeaux-threads:make-lock "orders"))

(defun count-up (threads times)
  "Count to THREADS times TIMES, each of THREADS its part."
  (setf *counter* 0)
  (let ((all (loop for number below threads
                   collect (let ((number number)) ; LOOP changes its variable while the threads run
                             (make-thread (lambda ()
                                            (loop repeat times
                                                  do (with-mutex (*counter-lock*)
                                                       (incf *counter*)))
                                            number)
                                          :name (format nil "counter ~d" number))))))
    (list (mapcar #'join-thread all) *counter*)))

(defun note-thing (thing note)
  (setf (gethash thing **noted**) note))

(defun noted (thing)
  (values (gethash thing **noted** :nothing)))

(defun add-under-lock (orders order)
  (bordeaux-threads:with-lock-held (*lock*)
    (append orders (list order))))

(defun orders-with-mutex (drinks)
  "The drinks, brewed in parallel branches of a plan that share a mutex."
  (let ((mutex (make-mutex)) (orders '()))
    (cpl:top-level
      (cpl:par-loop (drink drinks)
        (with-mutex (mutex)
          (let ((before orders))
            (cpl:sleep 0.1)
            (setf orders (append before (list drink)))))))
    orders))

(defun watch-with-timeout (seconds)
  (handler-case (sb-ext:with-timeout seconds (cpl:sleep 10) :slept)
    (sb-ext:timeout () :timed-out)))
