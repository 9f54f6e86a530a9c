(defun move-surely (goal)
  (rotate-to goal)
  (move-to goal))
