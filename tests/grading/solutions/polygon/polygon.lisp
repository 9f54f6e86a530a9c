(in-package :tut)

(defun draw-polygon (corners side)
  (dotimes (corner corners)
    (send-vel-cmd side 0)
    (wait-duration 1.1)
    (send-vel-cmd 0 (/ (* 2 pi) corners))
    (wait-duration 1.1)))
