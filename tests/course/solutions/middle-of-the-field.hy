(import turtlesim-in-hy.location-designators [word])
(defn middle [third]
  (* (/ 11 3) (+ third 0.5)))
(defn middle-generator [designator]
  (with-desig-props [horizontal-position vertical-position] designator
    (when (and horizontal-position vertical-position)
      (setv column (get {"left" 0 "center" 1 "right" 2} (word horizontal-position))
            row (get {"bottom" 0 "center" 1 "top" 2} (word vertical-position)))
      [(make-3d-vector (middle column) (middle row) 0)])))
(register-location-generator 1 middle-generator "The middle of a field.")
