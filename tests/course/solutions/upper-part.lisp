(defparameter *high* (> (fl-funcall #'turtlesim-msg:y *turtle-pose*) 8))
