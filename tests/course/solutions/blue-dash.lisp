(defun blue-dash ()
  (perform-some-motion (desig:a motion (type setting-pen) (r 0) (g 0) (b 255) (width 3)))
  (perform-some-motion (desig:a motion (type driving) (speed 2))))
