(in-package :tut)

(defun draw-square (size)
  (top-level
    (with-fields (x y) (value *turtle-pose*)
      (move-to (make-3d-vector (+ x size) y 0))
      (move-to (make-3d-vector (+ x size) (+ y size) 0))
      (move-to (make-3d-vector x (+ y size) 0))
      (move-to (make-3d-vector x y 0)))))
