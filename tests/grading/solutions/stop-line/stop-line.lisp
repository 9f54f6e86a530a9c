(in-package :tut)

(defun behind-p (pose line)
  (with-fields (x) pose
    (> x line)))

(defun drive-to-line (line)
  (top-level
    (unwind-protect
         (pursue
           (wait-for (fl-funcall #'behind-p *turtle-pose* line))
           (loop do
             (send-vel-cmd 1 0)
             (wait-duration 0.1)))
      (send-vel-cmd 0 0))))
