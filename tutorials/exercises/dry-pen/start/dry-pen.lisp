(in-package :tut)

(defun draw-line (metres)
  (top-level
    (dip-pen)
    (send-vel-cmd metres 0)
    (wait-duration 1.1)))
