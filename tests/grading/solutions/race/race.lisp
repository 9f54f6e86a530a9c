(in-package :tut)

(defun orders (points)
  (if (null points)
      (list nil)
      (loop for point in points
            append (mapcar (lambda (rest) (cons point rest))
                           (orders (remove point points :count 1))))))

(defun way-length (begin points)
  (loop for (x y) in points
        for (x0 y0) = begin then last-point
        for last-point = (list x y)
        sum (sqrt (+ (expt (- x x0) 2) (expt (- y y0) 2)))))

(defun shortest (begin points)
  (first (sort (orders points) #'< :key (lambda (order) (way-length begin order)))))

(defun turn-to (goal)
  "Turn to the goal in one command of a second."
  (send-vel-cmd 0 (/ (relative-angle-to goal (value *turtle-pose*)) 1.008))
  (wait-duration 1.1))

(defun race (points)
  (top-level
    (let ((begin (with-fields (x y) (value *turtle-pose*) (list x y))))
      (dolist (point (shortest begin points))
        (let ((goal (make-3d-vector (first point) (second point) 0)))
          (turn-to goal)
          (with-fields (x y) (value *turtle-pose*)
            (send-vel-cmd (/ (sqrt (+ (expt (- (first point) x) 2) (expt (- (second point) y) 2))) 1.008) 0))
          (wait-duration 1.1))))))
