(defun thick-line ()
  (call-set-pen 255 255 0 10 0)
  (send-vel-cmd 2 0)
  (sleep 1))
