(in-package :tut)

(defun draw-square (size)
  (top-level
    (with-fields (x y) (value *turtle-pose*)
      ;; the lower edge
      (move-to (make-3d-vector (+ x size) y 0)))))
