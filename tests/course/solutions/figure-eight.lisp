(defun figure-eight ()
  (dotimes (i 6) (send-vel-cmd 1 1.047) (sleep 1))
  (dotimes (i 6) (send-vel-cmd 1 -1.047) (sleep 1)))
