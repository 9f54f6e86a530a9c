(import turtlesim-in-hy.location-designators [word])
(require hyrule [ecase])
(defn middle [third]
  (* (/ 11 3) (+ third 0.5)))
(defn middle-generator [designator]
  (with-desig-props [horizontal-position vertical-position] designator
    (when (and horizontal-position vertical-position)
      (setv column (ecase (word horizontal-position) "left" 0 "center" 1 "right" 2)
            row (ecase (word vertical-position) "bottom" 0 "center" 1 "top" 2))
      [(make-3d-vector (middle column) (middle row) 0)])))
(register-location-generator 1 middle-generator "The middle of a field.")
