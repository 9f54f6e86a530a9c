(in-package :tut)

(defun drive-ahead (metres)
  (send-vel-cmd metres 0)
  (wait-duration 1.1))
