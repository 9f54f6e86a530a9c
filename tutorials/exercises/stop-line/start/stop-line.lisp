(in-package :tut)

(defun drive-to-line (line)
  (top-level
    (send-vel-cmd 1 0)
    (wait-duration (- line 5.5))
    (send-vel-cmd 0 0)))
