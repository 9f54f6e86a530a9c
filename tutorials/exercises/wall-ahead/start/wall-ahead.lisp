(in-package :tut)

(define-condition wall-ahead (simple-plan-failure) ())

(defun explore ()
  (top-level
    (loop do
      (send-vel-cmd 1 0)
      (wait-duration 0.1))))
