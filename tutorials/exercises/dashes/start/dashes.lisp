(in-package :tut)

(defun draw-dashes (number)
  (send-vel-cmd number 0)
  (wait-duration 1.1))
