(require cramhy *)
(in-package :tut)

(defparameter *world-size* 11.0 "width and height of the turtle's world in metres, about")
(defparameter *min-bound* 0.5 "the least x and y at which the turtle is well away from the walls")
(defparameter *max-bound* 10.5 "the greatest x and y at which it is")

(defun random-coordinate (third)
  "A random number in one of the thirds 0, 1 and 2 into which the world is divided."
  (let ((size (/ *world-size* 3)))
    (+ (* third size) (random size))))

(defun navigation-goal-generator (designator)
  "Five random points in the third of the world that the location `designator' describes."
  (with-desig-props (horizontal-position vertical-position) designator
    (when (and horizontal-position vertical-position)
      (let ((column (ecase horizontal-position (:left 0) (:center 1) (:right 2)))
            (row (ecase vertical-position (:bottom 0) (:center 1) (:top 2))))
        (loop repeat 5
              collect (make-3d-vector (random-coordinate column) (random-coordinate row) 0))))))

(register-location-generator
 5 navigation-goal-generator
 "Points in a third of the world, by horizontal and vertical position.")

(defun within-bounds-p (x y)
  "Whether a turtle at (x, y) is well away from the walls."
  (and (<= *min-bound* x *max-bound*)
       (<= *min-bound* y *max-bound*)))

(defun navigation-goal-validator (designator solution)
  "Accepts the points that the turtle can reach without touching a wall, and nothing else."
  (with-desig-props (horizontal-position vertical-position) designator
    (when (and horizontal-position vertical-position
               (typep solution '3d-vector)
               (within-bounds-p (x solution) (y solution)))
      :accept)))

(register-location-validation-function
 5 navigation-goal-validator
 "Points that are well away from the walls.")
