(in-package :tut)

(defun draw-polygon (corners side)
  ;; one side, and one turn of a square
  (send-vel-cmd side 0)
  (wait-duration 1.1)
  (send-vel-cmd 0 (/ pi 2))
  (wait-duration 1.1))
