(defun stop-at (line)
  (top-level
    (pursue
      (wait-for (> (fl-funcall #'turtlesim-msg:x *turtle-pose*) line))
      (loop (send-vel-cmd 2 0) (sleep 0.1)))
    (send-vel-cmd 0 0)))
