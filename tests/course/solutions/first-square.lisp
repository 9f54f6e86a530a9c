(defun drive-square ()
  (dotimes (i 4)
    (ahead 2)
    (turn-left)))
