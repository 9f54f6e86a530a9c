(defun middle (third)
  (* (/ 11 3) (+ third 0.5)))
(defun middle-generator (designator)
  (with-desig-props (horizontal-position vertical-position) designator
    (when (and horizontal-position vertical-position)
      (let ((column (ecase horizontal-position (:left 0) (:center 1) (:right 2)))
            (row (ecase vertical-position (:bottom 0) (:center 1) (:top 2))))
        (list (make-3d-vector (middle column) (middle row) 0))))))
(register-location-generator 1 middle-generator "The middle of a field.")
