(in-package :tut)

(defun race (points)
  (top-level
    (dolist (point points)
      (move-to (make-3d-vector (first point) (second point) 0)))))
