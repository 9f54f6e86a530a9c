(in-package :tut)

(define-condition wall-ahead (simple-plan-failure) ())

(defun near-wall-p (pose)
  (with-fields (x y) pose
    (not (and (< 1 x 10) (< 1 y 10)))))

(defun explore ()
  (top-level
    (unwind-protect
         (pursue
           (seq
             (wait-for (fl-funcall #'near-wall-p *turtle-pose*))
             (fail 'wall-ahead))
           (loop do
             (send-vel-cmd 1 0)
             (wait-duration 0.1)))
      (send-vel-cmd 0 0))))
