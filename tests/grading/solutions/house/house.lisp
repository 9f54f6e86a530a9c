(in-package :tut)

(defun draw-small-house (size)
  (top-level
    (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
      (with-fields (x y) (value *turtle-pose*)
        (flet ((corner (right up)
                 (list (+ x (* right size)) (+ y (* up size)) 0)))
          (draw-simple-shape
            (list (corner 1 0) (corner 1 1) (corner 0 1) (corner 0 0)))
          (navigate-without-pen (corner 0 1))
          (draw-simple-shape (list (corner 1/2 3/2) (corner 1 1)))
          (navigate-without-pen (corner 3/8 0))
          (draw-simple-shape (list (corner 3/8 1/2) (corner 5/8 1/2) (corner 5/8 0))))))))
