(require cramhy *)
(import random [uniform]
        cramhy_runtime.transforms.vectors [Vector3])

(setv world-size 11.0  ; width and height of the turtle's world in metres, about
      min-bound 0.5    ; the least x and y at which the turtle is well away from the walls
      max-bound 10.5)  ; the greatest x and y at which it is

(defn random-coordinate [third]
  "A random number in one of the thirds 0, 1 and 2 into which the world is divided."
  (setv size (/ world-size 3))
  (uniform (* third size) (* (+ third 1) size)))

(defn word [property]
  "The word of a property, which is a string, or a keyword if it stands in the designator itself."
  (.lower (.lstrip (str property) ":")))

(defn navigation-goal-generator [designator]
  "Five random points in the third of the world that the location `designator' describes."
  (with-desig-props [horizontal-position vertical-position] designator
    (when (and horizontal-position vertical-position)
      (setv column (get {"left" 0 "center" 1 "right" 2} (word horizontal-position))
            row (get {"bottom" 0 "center" 1 "top" 2} (word vertical-position)))
      (lfor _ (range 5)
        (make-3d-vector (random-coordinate column) (random-coordinate row) 0)))))

(register-location-generator
 5 navigation-goal-generator
 "Points in a third of the world, by horizontal and vertical position.")

(defn within-bounds-p [x y]
  "Whether a turtle at (x, y) is well away from the walls."
  (and (<= min-bound x max-bound)
       (<= min-bound y max-bound)))

(defn navigation-goal-validator [designator solution]
  "Accepts the points that the turtle can reach without touching a wall, and nothing else."
  (with-desig-props [horizontal-position vertical-position] designator
    (when (and horizontal-position vertical-position
               (isinstance solution Vector3)
               (within-bounds-p solution.x solution.y))
      :accept)))

(register-location-validation-function
 5 navigation-goal-validator
 "Points that are well away from the walls.")
