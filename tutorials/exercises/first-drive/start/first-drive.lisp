(in-package :tut)

(defun drive-ahead (metres)
  (send-vel-cmd 1 0)
  (wait-duration 1))
