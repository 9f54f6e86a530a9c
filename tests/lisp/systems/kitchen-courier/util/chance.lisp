;;;; Chance that is the same on every machine: a linear congruential generator as a closure.

(in-package #:courier-util)

(defconstant +multiplier+ 1103515245)
(defconstant +modulus+ (expt 2 31))

(defun make-chance (seed)
  "A closure: called with a limit it gives an integer below it; called with :STATE it tells, with :RESET it starts again."
  (let ((state seed))
    (lambda (request &optional (value seed))
      (case request
        (:state state)
        (:reset (setf state value))
        (otherwise
         (check-type request (integer 1))
         (setf state (mod (+ (* +multiplier+ state) 12345) +modulus+))
         (mod (ash state -8) request))))))

(defvar *chance* (make-chance 42))

(defmacro with-chance ((seed) &body body)
  `(let ((*chance* (make-chance ,seed))) ,@body))

(defun roll (limit) (funcall *chance* limit))

(defun chance (probability)
  "True with PROBABILITY, a rational between 0 and 1."
  (< (roll 1000) (* 1000 probability)))

(defun pick (sequence)
  (elt sequence (roll (length sequence))))

(defun shuffled (sequence)
  "A copy of SEQUENCE in another order, of the same type."
  (let ((things (coerce sequence 'simple-vector)))
    (setf things (copy-seq things))
    (loop for i from (1- (length things)) downto 1
          do (rotatef (svref things i) (svref things (roll (1+ i)))))
    (coerce things (typecase sequence (list 'list) (string 'string) (t 'vector)))))
