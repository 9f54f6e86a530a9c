(in-package :barista-costmap)

(define-cost-function near-to (x y place distance) (:score 5)
  "1 up to DISTANCE from PLACE, then 0."
  (if (<= (v-dist (make-3d-vector x y 0) (copy-3d-vector place :z 0)) distance) 1.0 0.0))

(define-cost-function far-from-p (x y place distance) (:score 4)
  (- 1 (funcall (function-of (near-to place distance)) x y)))

(define-cost-function gauss (x y place deviation) ()
  (let ((dx (- x (cl-transforms:x place))) (dy (- y (cl-transforms:y place))))
    (exp (- (/ (+ (expt dx 2) (expt dy 2)) (* 2 (expt deviation 2)))))))

(define-cost-function in-half-plane (x y axis &optional (side :positive) (border 0)) (:score 3)
  (flet ((on-side (coordinate)
           (ecase side
             ((:positive :left) (>= coordinate border))
             (:negative (<= coordinate border)))))
    (ccase axis
      (:x (if (on-side x) 1 0))
      (:y (if (on-side y) 1 0)))))
