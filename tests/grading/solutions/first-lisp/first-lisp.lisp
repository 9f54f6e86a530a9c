(in-package :tut)

(defun distance (x1 y1 x2 y2)
  (sqrt (+ (expt (- x2 x1) 2) (expt (- y2 y1) 2))))

(defun way-length (points)
  (loop for ((x1 y1) (x2 y2)) on points
        while x2
        sum (distance x1 y1 x2 y2)))
