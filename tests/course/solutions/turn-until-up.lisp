(defun turn-until-up ()
  (unwind-protect
       (pursue
         (wait-for (> (fl-funcall #'turtlesim-msg:theta *turtle-pose*) 1.57))
         (loop do
           (send-vel-cmd 0 1)
           (wait-duration 0.1)))
    (send-vel-cmd 0 0)))
