(defpackage :plan-harness
  (:use :cpl)
  (:import-from :cpl-impl #:*tasks* #:*save-tasks*))

(in-package :plan-harness)

(5am:def-suite plans)
(5am:in-suite plans)

(defun threads (tasks)
  (mapcar (lambda (task) (slot-value task 'cpl-impl::thread)) (cut:list-queue-contents tasks)))

(defun call-watched (name seconds plan)
  "Call PLAN within SECONDS; its values. Then all tasks that it began must be dead, and have returned."
  (let ((*save-tasks* t)
        (*tasks* (cut:make-queue :name (format nil "tasks of ~a" name))))
    (multiple-value-prog1 (sb-ext:with-timeout seconds (funcall plan))
      (dolist (thread (threads *tasks*))
        (5am:is (not (eq :timeout (cut:join-thread thread :timeout 1.0))))
        (5am:is (not (cut:thread-alive-p thread)))))))

(defmacro watched (name &body body)
  `(5am:test ,name
     (call-watched ',name 10 (lambda () (5am:is (equal ,@body))))))

(watched values-of-branches '(1 3)
  (let (all)
    (top-level (par (push 3 all) (push 1 all)))
    (sort all #'<)))

(watched a-loser-is-evaporated :first
  (top-level (pursue (progn (sleep 1) :first) (progn (sleep 100) :second))))

(watched a-failure-is-taken '(:failed 2)
  (let ((tries 0))
    (top-level
      (with-failure-handling ((simple-plan-failure (problem)
                                (declare (ignore problem))
                                (when (< (incf tries) 2) (retry))
                                (return (list :failed tries))))
        (par (sleep 100) (fail 'simple-plan-failure))))))

(5am:test a-plan-that-takes-too-long
  (5am:signals sb-ext:timeout
    (call-watched 'too-long 2 (lambda () (top-level (sleep 100))))))
