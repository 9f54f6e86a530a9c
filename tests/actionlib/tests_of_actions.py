"""What the tests of actions begin with: both libraries, a node, a server that counts, and a client."""

PRELUDE = """
(asdf:load-system :actionlib)
(defpackage {name} (:use :common-lisp :roslisp) (:import-from :cpl #:top-level #:pursue #:par)
  (:import-from :actionlib #:def-exec-callback #:start-action-server #:succeed-current #:abort-current #:preempt-current
                #:publish-feedback #:cancel-request-received))
(in-package {name})
(defvar *notes* nil)
(defun note (thing) (setf *notes* (append *notes* (list thing))) thing)
(start-ros-node "n")
(def-exec-callback count-up (order)
  (loop for i from 1 to order
        do (when (cancel-request-received) (preempt-current :sequence (vector i)))
           (wait-duration 1)
           (publish-feedback :sequence (vector i)))
  (when (= order 13) (abort-current))
  (when (= order 14) (error "no ~a" order))
  (unless (= order 15) (succeed-current :sequence (vector order order))))
(defvar *client* nil)
(defun serve () (start-action-server "count" "actionlib_tutorials/FibonacciAction" #'count-up :separate-thread t))
(defun client () (setf *client* (actionlib-lisp:make-simple-action-client "count" "actionlib_tutorials/FibonacciAction")))
(defun goal (n) (actionlib-lisp:make-action-goal-msg *client* :order n))
(defun both () (serve) (client) (actionlib-lisp:wait-for-server *client*))
(defun sequence-of (m) (and m (actionlib_tutorials-msg:sequence m)))
"""
