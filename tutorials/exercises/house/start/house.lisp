(in-package :tut)

(defun draw-small-house (size)
  (top-level
    (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
      (with-fields (x y) (value *turtle-pose*)
        (draw-simple-shape
          (list (list (+ x size) y 0)
                (list (+ x size) (+ y size) 0)
                (list x (+ y size) 0)
                (list x y 0)))))))
