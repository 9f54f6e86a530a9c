(in-package :tut)

(defun corner-generator (designator)
  (with-desig-props (corner) designator
    (when corner
      (list (ecase corner
              (:upper-left (make-3d-vector 2 9 0))
              (:upper-right (make-3d-vector 9 9 0))
              (:lower-left (make-3d-vector 2 2 0))
              (:lower-right (make-3d-vector 9 2 0)))))))

(register-location-generator
 3 corner-generator
 "The corners of the world.")

(defun corner-validator (designator solution)
  (declare (ignore solution))
  (with-desig-props (corner) designator
    (when corner
      :accept)))

(register-location-validation-function
 3 corner-validator
 "All corners are good.")

(defun go-to-corner (?corner)
  (top-level
    (move-to (reference (desig:a location (corner ?corner))))))
